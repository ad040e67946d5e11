"""What an importer must not do is refused with a status and a message, and the instance can still be used.

usage: fmu_refusals.py PLANT.fmu CONTROLLER.fmu
"""

import ctypes
import sys

from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave
from fmu_unit import Unit, instantiate

DISCARD, ERROR = 2, 3
messages = []


def refused(status, call, *arguments, **named):
    """The call has to be refused with this status."""
    try:
        call(*arguments, **named)
    except FMICallException as exception:
        assert exception.status == status, (call, exception)
        return
    raise AssertionError(f"{call} {arguments} {named} was not refused")


def null(path, message, **changed):
    """An instance that must not come to be."""
    about = read_model_description(path)
    arguments = dict(
        guid=about.guid,
        unzipDirectory=extract(path),
        modelIdentifier=about.coSimulation.modelIdentifier,
        instanceName="unit",
    )
    slave = FMU2Slave(**{**arguments, **changed})
    del messages[:]
    try:
        instantiate(slave, messages)
    except Exception:
        assert len(messages) == 1 and message in messages[0], messages
        return
    raise AssertionError(f"{message}: an instance was made")


def values(unit):
    """References and values of the wrong kind."""
    slave, reference = unit.slave, {name: v.valueReference for name, v in unit.variables.items()}
    for kind in ["Real", "Integer", "Boolean", "String"]:
        refused(ERROR, unit.function("get", kind), [100_000])
        refused(ERROR, unit.function("get", kind), [2**32 - 1])
    set_real = unit.function("set", "Real")
    refused(ERROR, set_real, [100_000], [1.0])
    refused(ERROR, unit.function("set", "Integer"), [0], [1])
    refused(ERROR, unit.function("set", "String"), [0], ["x"])
    refused(ERROR, unit.function("get", "Integer"), [0])
    for number in [float("nan"), float("inf"), 1e300]:
        refused(DISCARD, set_real, [0], [number])
    output = reference["lift_duty_percent" if "lift_duty_percent" in reference else "flow_lpm"]
    refused(ERROR, set_real, [output], [1.0])
    refused(ERROR, slave.setRealInputDerivatives, [output], [1], [1.0])
    refused(ERROR, slave.setRealInputDerivatives, [0], [2], [1.0])
    refused(ERROR, slave.getRealOutputDerivatives, [output], [1])
    # An array that is missing.
    one = (ctypes.c_uint * 1)(0)
    refused(ERROR, slave.fmi2GetReal, slave.component, one, 1, None)
    refused(ERROR, slave.fmi2GetReal, None, one, 1, (ctypes.c_double * 1)())


def steps(unit, wrong):
    """Steps that cannot be taken."""
    slave = unit.slave
    refused(ERROR, slave.enterInitializationMode)
    refused(ERROR, slave.exitInitializationMode)
    refused(ERROR, slave.cancelStep)
    refused(DISCARD, slave.getStatus, 0)
    refused(DISCARD, slave.getStringStatus, 1)
    refused(DISCARD, slave.getIntegerStatus, 0)
    for step_s in [0.0, -1e-3, float("nan"), float("inf"), 1e9, *wrong]:
        refused(ERROR, unit.step, 0.0, step_s)
    refused(ERROR, unit.step, 5.0, 1e-3)
    refused(ERROR, unit.step, float("nan"), 1e-3)
    unit.step(0.0, 1e-3)
    assert slave.getRealStatus(2) == 1e-3
    assert slave.getBooleanStatus(3) == 0
    unit.step(1e-3, 0.25)
    slave.terminate()
    refused(ERROR, unit.step, 0.251, 1e-3)
    slave.reset()
    refused(ERROR, unit.step, 0.0, 1e-3)
    unit.begin({}, {}, stop_s=1.0)
    unit.step(0.0, 1.0)
    refused(ERROR, unit.step, 1.0, 0.1)


def parameters(path):
    """Parameters are fixed, and have to fit together."""
    plant = Unit(path)
    refused(ERROR, plant.set, load_kg=100.0)
    plant.slave.reset()
    refused(DISCARD, plant.set, load_kg=-1.0)
    plant.set(**{"linkage.connecting_rod_m": 0.01})
    plant.slave.enterInitializationMode()
    refused(DISCARD, plant.get, "flow_lpm")
    refused(ERROR, plant.slave.exitInitializationMode)
    plant.slave.reset()
    plant.begin({"load_kg": 250.0, "start_angle_deg": 90.0}, {})
    heavy = plant.get("cylinder_pressure_bar")[0]
    plant.slave.reset()
    plant.begin({"load_kg": 250.0, "start_angle_deg": 90.0, "cylinder.bore_mm": 100.0}, {})
    assert plant.get("cylinder_pressure_bar")[0] < heavy / 1.5


plant_path, controller_path = sys.argv[1:]
for path, wrong in [(plant_path, []), (controller_path, [0.5e-3, 1.5e-3, 1e-4])]:
    null(path, "the GUID is", guid="{00000000-0000-0000-0000-000000000000}")
    null(path, "has no name", instanceName="")
    values(Unit(path))
    steps(Unit(path), wrong)
parameters(plant_path)
for path in [plant_path, controller_path]:
    unit = Unit(path)
    state = unit.state("get")
    refused(ERROR, unit.state, "serialize", state)
    refused(ERROR, unit.state, "set", None)
    unit.state("free", state)
print("refused: all of it")

"""What an importer must not do is refused with a status and a message, and the instance can still be used.

usage: fmu_refusals.py PLANT.fmu CONTROLLER.fmu     (both of FMI 2.0, or both of FMI 3.0)
"""

import ctypes
import re
import sys
from pathlib import Path

import fmpy
from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Model, FMU3ScheduledExecution, FMU3Slave
from fmu_unit import Unit, instantiate

DISCARD, ERROR = 2, 3
TYPES_OF_FMI3 = ["Float32", "Float64", "Boolean", "String"]
TYPES_OF_FMI3 += [f"{sign}Int{bits}" for sign in ["", "U"] for bits in [8, 16, 32, 64]]
messages = []


def refused(status, call, *arguments, **named):
    """The call has to be refused with this status."""
    try:
        call(*arguments, **named)
    except FMICallException as exception:
        assert exception.status == status, (call, exception)
        return
    raise AssertionError(f"{call} {arguments} {named} was not refused")


def null(path, message, make=None, options={}, **changed):
    """An instance that must not come to be."""
    about = read_model_description(path)
    make = make or (FMU3Slave if about.fmiVersion == "3.0" else FMU2Slave)
    arguments = dict(
        guid=about.guid,
        unzipDirectory=extract(path),
        modelIdentifier=about.coSimulation.modelIdentifier,
        instanceName="unit",
    )
    slave = make(**{**arguments, **changed})
    del messages[:]
    try:
        instantiate(slave, messages, **options)
    except Exception:
        assert len(messages) == 1 and message in messages[0], messages
        return
    raise AssertionError(f"{message}: an instance was made")


def kinds_of_fmi3(path):
    """Instances that FMI 3.0 knows, and no unit is."""
    null(path, "for co-simulation alone", FMU3Model)
    null(path, "for co-simulation alone", FMU3ScheduledExecution)
    null(path, "hasEventMode", options={"eventModeUsed": True})
    null(path, "providesIntermediateUpdate", options={"requiredIntermediateVariables": [0]})


def functions_in_header():
    """The functions of FMI 3.0: name, type of the result and arguments, from the standard's own header."""
    header = Path(fmpy.__file__).parent / "c-code" / "fmi3FunctionTypes.h"
    text = re.sub(r"/\*.*?\*/", "", header.read_text(), flags=re.DOTALL)
    functions = re.findall(r"typedef\s+([\w*\s]+?)\s+(fmi3\w+)TYPE\s*\((.*?)\);", text, re.DOTALL)
    assert len(functions) == 75, len(functions)
    return [(name, returned, [" ".join(each.split()) for each in of.split(",")]) for returned, name, of in functions]


def functions_of_fmi3(path):
    """Every function of FMI 3.0 is there, and takes null and zero for all its arguments."""
    del messages[:]
    unit = Unit(path, messages=messages)
    slave = unit.slave
    # These change the state of the instance, or have nothing to refuse.
    legal = ["fmi3Reset", "fmi3Terminate", "fmi3SetDebugLogging", "fmi3FreeFMUState"]
    empty = [f"fmi3{way}{kind}" for way in ["Get", "Set"] for kind in TYPES_OF_FMI3]
    refusing = 0
    for name, returned, arguments in functions_in_header():
        call = slave.dll[name]
        if returned != "fmi3Status":
            continue
        call.restype = ctypes.c_int
        reals = [re.fullmatch(r"fmi3Float64 \w+", argument) for argument in arguments[1:]]
        nothing = [ctypes.c_double(0.0) if real else None for real in reals]
        assert call(None, *nothing) == ERROR, name
        if name in legal:
            continue
        del messages[:]
        status = call(ctypes.c_void_p(slave.component), *nothing)
        if name in empty:
            assert (status, messages) == (0, []), name
            continue
        assert status == ERROR and len(messages) == 1, (name, status, messages)
        assert messages[0].startswith(f"{name}: "), messages
        refusing += 1
    print(f"refused: {refusing} functions of FMI 3.0")
    assert refusing >= 40, refusing
    # It can still be used.
    assert slave.getVersion() == "3.0"
    assert unit.step(0.0, 1e-3) == (False, False, False, 1e-3)
    assert unit.get("time") == [1e-3]
    refused(ERROR, unit.set, time=1.0)


def values_of_fmi3(unit):
    """Values of types that no variable has, and lists of different lengths."""
    slave = unit.slave
    for kind in TYPES_OF_FMI3:
        getter, setter = getattr(slave, f"get{kind}"), getattr(slave, f"set{kind}")
        for reference in [100_000, 2**32 - 1]:
            refused(ERROR, getter, [reference])
            refused(ERROR, setter, [reference], ["x" if kind == "String" else 1])
        if kind != "Float64":
            refused(ERROR, getter, [0])
            refused(ERROR, setter, [0], ["x" if kind == "String" else 1])
    refused(ERROR, slave.getFloat64, [0], 2)
    refused(ERROR, slave.setFloat64, [0], [1.0, 2.0])
    one = (ctypes.c_uint * 1)(0)
    refused(ERROR, slave.fmi3GetFloat64, slave.component, one, 1, None, 1)
    refused(ERROR, slave.fmi3SetFloat64, slave.component, None, 1, (ctypes.c_double * 1)(), 1)
    refused(ERROR, slave.fmi3SetString, slave.component, one, 1, (ctypes.c_char_p * 1)(), 1)
    refused(ERROR, slave.fmi3DoStep, slave.component, 0.0, 1e-3, True, None, None, None, None)
    refused(ERROR, slave.setDebugLogging, True, ["nonsense"])
    slave.setDebugLogging(True, ["logStatusError"])


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
    if unit.is_fmi3:
        values_of_fmi3(unit)
        return
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
    if not unit.is_fmi3:
        refused(ERROR, slave.cancelStep)
        refused(DISCARD, slave.getStatus, 0)
        refused(DISCARD, slave.getStringStatus, 1)
        refused(DISCARD, slave.getIntegerStatus, 0)
    for step_s in [0.0, -1e-3, float("nan"), float("inf"), 1e9, *wrong]:
        refused(ERROR, unit.step, 0.0, step_s)
    refused(ERROR, unit.step, 5.0, 1e-3)
    refused(ERROR, unit.step, float("nan"), 1e-3)
    answer = unit.step(0.0, 1e-3)
    if unit.is_fmi3:
        assert answer == (False, False, False, 1e-3), answer
    else:
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
is_fmi3 = read_model_description(plant_path).fmiVersion == "3.0"
for path, wrong in [(plant_path, []), (controller_path, [0.5e-3, 1.5e-3, 1e-4])]:
    token = "the instantiation token is" if is_fmi3 else "the GUID is"
    null(path, token, guid="{00000000-0000-0000-0000-000000000000}")
    null(path, "has no name", instanceName="")
    values(Unit(path))
    steps(Unit(path), wrong)
    if is_fmi3:
        kinds_of_fmi3(path)
        functions_of_fmi3(path)
parameters(plant_path)
for path in [plant_path, controller_path]:
    unit = Unit(path)
    state = unit.state("get")
    refused(ERROR, unit.state, "serialize", state)
    refused(ERROR, unit.state, "set", None)
    unit.state("free", state)
print("refused: all of it")

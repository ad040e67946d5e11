"""Couples the units of plant and controller, and moves the hitch with the lever.

usage: python3 fmu_loop.py PLANT.fmu CONTROLLER.fmu     (needs FMPy: pip install fmpy)
"""
import sys

try:
    from fmpy import extract, read_model_description
    from fmpy.fmi2 import FMU2Slave
except ModuleNotFoundError as missing:
    sys.exit(f"the Python package {missing.name} is missing: pip install fmpy")
if len(sys.argv) != 3:
    sys.exit("give the units: python3 fmu_loop.py PLANT.fmu CONTROLLER.fmu (from `hitch export-fmu`)")


def unit(path, **parameters):
    """An initialised unit, and the value references of its variables."""
    about = read_model_description(path)
    slave = FMU2Slave(guid=about.guid, unzipDirectory=extract(path), instanceName=about.modelName,
                      modelIdentifier=about.coSimulation.modelIdentifier)
    references = {variable.name: variable.valueReference for variable in about.modelVariables}
    slave.instantiate()
    slave.setupExperiment()
    slave.setReal([references[name] for name in parameters], list(parameters.values()))
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    return slave, references


(plant, of_plant), (controller, of_controller) = unit(sys.argv[1], start_angle_deg=90.0), unit(sys.argv[2])
SENSORS = ["rocker_angle_deg", "cylinder_pressure_bar", "pump_pressure_bar"]
CURRENTS = ["lift_current_a", "lower_current_a"]
controller.setBoolean([of_controller[f"{name}_valid"] for name in SENSORS], [True] * 3)
step = 0


def millisecond(lever_deg):
    """Sensors to the controller, its currents to the plant."""
    global step
    sensed = plant.getReal([of_plant[name] for name in SENSORS])
    controller.setReal([of_controller[name] for name in ["lever_deg", *SENSORS]], [lever_deg, *sensed])
    controller.doStep(step * 1e-3, 1e-3)
    plant.setReal([of_plant[name] for name in CURRENTS],
                  controller.getReal([of_controller[name] for name in CURRENTS]))
    plant.doStep(step * 1e-3, 1e-3)
    step += 1
    return plant.getReal([of_plant["rocker_angle_deg"]])[0]


# The lever has to be moved through the hitch first.
for lever_deg in [88.0] * 100 + [90.0] * 400:
    millisecond(lever_deg)
for target_deg in [110.0, 75.0, 80.0]:
    angle_deg = [millisecond(target_deg) for _ in range(4000)][-1]
    print(f"{target_deg:.0f} deg: at {angle_deg:.2f} deg")
    assert abs(angle_deg - target_deg) <= 0.5

"""FMPy as the importer of a plant: a log's currents in, a log out, as `hitch simulate` writes it.

usage: fmu_plant.py PLANT.fmu RUN.csv OUT.csv ends|slopes [PARAMETER=VALUE...]

A step ends at each sample of the log, however far apart they are. The currents are given at the end of each step, or at its
beginning with their slopes.
"""

import csv
import sys

from fmu_unit import Unit

CHANNELS = ["pump_pressure_bar", "cylinder_pressure_bar", "flow_lpm", "rocker_angle_deg"]

path, log, out, way, *settings = sys.argv[1:]
parameters = {name: float(value) for name, value in (setting.split("=") for setting in settings)}
parameters = {name: bool(value) if name == "flow_bench" else value for name, value in parameters.items()}
with open(log, newline="") as file:
    rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def currents(row):
    return {name: row[name] for name in ["lift_current_a", "lower_current_a"]}


def give(begin, end, step_s):
    """Gives the currents of a step."""
    if way == "ends":
        plant.set(**currents(end))
        return
    plant.set(**currents(begin))
    slopes = {name: (end[name] - begin[name]) / step_s for name in currents(end)}
    references = [plant.variables[name].valueReference for name in slopes]
    plant.slave.setRealInputDerivatives(references, [1] * len(slopes), list(slopes.values()))


plant = Unit(path, parameters, currents(rows[0]))
with open(out, "w", newline="") as file:
    writer = csv.writer(file)
    writer.writerow(["time_s", "lift_current_a", "lower_current_a", *CHANNELS])
    before_s = rows[0]["time_s"]
    at_s = 0.0
    for number, row in enumerate(rows):
        if number > 0:
            step_s = row["time_s"] - before_s
            give(rows[number - 1], row, step_s)
            plant.step(at_s, step_s)
            at_s += step_s
            before_s = row["time_s"]
        writer.writerow([row["time_s"], *currents(row).values(), *plant.get(*CHANNELS)])
print(f"simulated: {len(rows)} samples")

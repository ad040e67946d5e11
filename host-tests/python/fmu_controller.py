"""FMPy as the importer of a controller: lines of `hitch controller` in, its answers out.

usage: fmu_controller.py CONTROLLER.fmu LINES.csv
"""

import csv
import sys

from fmu_unit import Unit

SWITCHES = ["transport_lock", "hold", "quick_lift", "teach"]

path, lines = sys.argv[1:]
controller = Unit(path)
print("lift_current_a,lower_current_a,state")
with open(lines, newline="") as file:
    for number, row in enumerate(csv.DictReader(file)):
        del row["time_s"]
        for name, cell in row.items():
            if name in SWITCHES:
                controller.set(**{name: bool(cell) and float(cell) != 0})
                continue
            if cell:
                controller.set(**{name: float(cell)})
            controller.set(**{f"{name}_valid": bool(cell)})
        controller.step(number * 1e-3, 1e-3)
        lift_a, lower_a, state = controller.get("lift_current_a", "lower_current_a", "state")
        print(f"{lift_a:.3f},{lower_a:.3f},{state}")

"""FMPy as the importer of plant and controller, coupled over two coils and noisy instruments.

usage: fmu_loop.py PLANT.fmu CONTROLLER.fmu NOISE.csv LOAD_KG OIL_TEMPERATURE_C START_DEG OUT.csv

A line of NOISE.csv is a millisecond: the lever, and what each instrument shows beyond the truth.
"""

import csv
import math
import sys

from fmu_unit import Unit

SUPPLY_V = 13.8


class Coil:
    """The coil of `workbench/closed-loop/src/closed_loop/coil.rs`."""

    def __init__(self):
        self.current_a = 0.0

    def millisecond(self, duty):
        # Halves are rounded away from zero, as the timer's steps are there.
        duty = math.floor(min(max(duty, 0.0), 1.0) * 5250 + 0.5) / 5250
        rest_a = (duty * SUPPLY_V - (1 - duty) * 0.7) / 2.3
        keep = math.exp(-1e-3 / 8 * 2.3 / 0.012)
        total_a = 0.0
        for _ in range(8):
            before_a = self.current_a
            self.current_a = max(rest_a + (before_a - rest_a) * keep, 0.0)
            total_a += 0.5 * (before_a + self.current_a)
        return total_a / 8


plant_path, controller_path, noise, load_kg, oil_c, start_deg, out = sys.argv[1:]
parameters = {
    "load_kg": float(load_kg),
    "oil_temperature_c": float(oil_c),
    "start_angle_deg": float(start_deg),
}
plant = Unit(plant_path, parameters)
controller = Unit(controller_path)
fitted = [
    "cylinder_pressure_bar",
    "pump_pressure_bar",
    "oil_temperature_c",
    "supply_v",
    "measured_lift_current_a",
    "measured_lower_current_a",
]
controller.set(**{f"{name}_valid": True for name in fitted})
controller.set(oil_temperature_c=float(oil_c), supply_v=SUPPLY_V)
coils = [Coil(), Coil()]
currents_a = [0.0, 0.0]
truths = ["rocker_angle_deg", "cylinder_pressure_bar", "pump_pressure_bar"]
with open(noise, newline="") as file, open(out, "w", newline="") as result:
    writer = csv.writer(result)
    writer.writerow(["angle_deg", "lift_current_a", "lower_current_a"])
    for number, row in enumerate(csv.DictReader(file)):
        row = {name: float(cell) for name, cell in row.items()}
        truth = plant.get(*truths)
        told = {name: value + row[name] for name, value in zip(truths, truth)}
        for coil, current_a in zip(["lift", "lower"], currents_a):
            told[f"measured_{coil}_current_a"] = current_a + row[f"{coil}_current_a"]
        controller.set(lever_deg=row["lever_deg"], **told)
        controller.step(number * 1e-3, 1e-3)
        asked = controller.get("lift_current_a", "lower_current_a")
        duties = controller.get("lift_duty_percent", "lower_duty_percent")
        writer.writerow([plant.get("true_rocker_angle_deg")[0], *asked])
        # Counts of 0.001 %, as the firmware has them.
        shares = [round(duty * 1e3) * 1e-5 for duty in duties]
        currents_a = [coil.millisecond(share) for coil, share in zip(coils, shares)]
        plant.set(lift_current_a=currents_a[0], lower_current_a=currents_a[1])
        plant.step(number * 1e-3, 1e-3)
print("coupled")

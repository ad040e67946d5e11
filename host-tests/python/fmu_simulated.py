"""FMPy's own simulation of a plant: a log's currents in, a log out.

usage: fmu_simulated.py PLANT.fmu RUN.csv OUT.csv STEP_S

FMPy gives the inputs at the beginning of a step, so that the currents are late by a step.
"""

import sys

import numpy
from fmpy import simulate_fmu

path, log, out, step_s = sys.argv[1:]
run = numpy.genfromtxt(log, delimiter=",", names=True)
inputs = ["lift_current_a", "lower_current_a"]
signals = numpy.zeros(len(run), dtype=[("time", float), *((name, float) for name in inputs)])
signals["time"] = run["time_s"]
for name in inputs:
    signals[name] = run[name]
result = simulate_fmu(
    path,
    stop_time=run["time_s"][-1],
    output_interval=float(step_s),
    input=signals,
    output=["rocker_angle_deg"],
)
angle_deg = numpy.interp(run["time_s"], result["time"], result["rocker_angle_deg"])
numpy.savetxt(out, angle_deg, header="rocker_angle_deg", comments="")
print(f"simulated: {len(result)} samples")

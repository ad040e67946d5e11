"""Closes the loop around the firmware's controller with a plant of one's own.

usage: python3 own_plant.py [PATH_TO_HITCH]     (without it, hitch_program.py finds the program)

The plant is a toy: linear valves with a threshold, a lag of 60 ms, and an angle straight from the flow. `hitch controller`
answers each line (one a millisecond) with the coil currents it asks for.
A machine can be taught first where its valves open and where its ends are: `hitch controller --help` says how.
"""
import subprocess, sys, hitch_program

hitch = hitch_program.find(*sys.argv[1:2])
controller = subprocess.Popen([hitch, "controller"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
print("time_s,lever_deg,rocker_angle_deg", file=controller.stdin, flush=True)
assert controller.stdout.readline() == "lift_current_a,lower_current_a,state\n"

angle_deg, lift_a, lower_a, step = 90.0, 0.0, 0.0, 0


def millisecond(lever_deg):
    """Tells the controller lever and angle, and moves the plant by what it asks for; returns the controller's state."""
    global angle_deg, lift_a, lower_a, step
    print(f"{step / 1000:.3f},{lever_deg},{angle_deg:.3f}", file=controller.stdin, flush=True)
    lift, lower, state = controller.stdout.readline().strip().split(",")
    lift_a += (float(lift) - lift_a) / 60
    lower_a += (float(lower) - lower_a) / 60
    speed_deg_per_s = 45 * max(lift_a - 1.2, 0) - 70 * max(lower_a - 1.1, 0)
    angle_deg = min(max(angle_deg + speed_deg_per_s / 1000, 44.1), 135.9)
    step += 1
    return state


# The lever has to be moved through the hitch first.
for lever_deg in [85.0] * 100 + [91.0] * 10 + [90.0] * 400:
    millisecond(lever_deg)
for target_deg in [110.0, 75.0, 80.0]:
    states = [millisecond(target_deg) for _ in range(3000)]
    print(f"{target_deg:.0f} deg: at {angle_deg:.2f} deg, {states[-1]}")
    assert abs(angle_deg - target_deg) <= 0.5 and states[-1] == "holding"
controller.stdin.close()
sys.exit(controller.wait())

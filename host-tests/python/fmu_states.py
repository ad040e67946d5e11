"""A unit that goes back to a stored state repeats its steps exactly.

usage: fmu_states.py plant|controller UNIT.fmu [PARAMETER=VALUE...]
"""

import math
import sys

from fmu_unit import Unit


def currents(number):
    """Lifting and lowering with reversals: the hitch and the spools are in motion all the time."""
    wave = math.sin(number * 0.02) * 2.5
    return {"lift_current_a": max(wave, 0.0), "lower_current_a": max(-wave, 0.0)}


def lever(number):
    """The lever picks the hitch up, and asks it to lift."""
    return {"lever_deg": 85.0 if number < 100 else 90.0 if number < 400 else 110.0}


kind, path, *settings = sys.argv[1:]
give = currents if kind == "plant" else lever
unit = Unit(path, {name: float(value) for name, value in (setting.split("=") for setting in settings)})
outputs = [variable.name for variable in unit.description.modelVariables if variable.causality == "output"]


def steps(numbers):
    """The outputs of steps of a millisecond."""
    answers = []
    for number in numbers:
        unit.set(**give(number))
        unit.step(number * 1e-3, 1e-3)
        answers.append(unit.get(*outputs))
    return answers


steps(range(700))
state = unit.state("get")
first = steps(range(700, 1200))
assert first[0] != first[-1], first[-1]
unit.state("set", state)
assert steps(range(700, 1200)) == first
# A state is still there after it was restored, and storing again replaces it.
unit.state("set", state)
steps(range(700, 800))
later = unit.state("get")
unit.state("set", state)
assert steps(range(700, 1200)) == first
unit.state("set", later)
unit.state("free", state)
assert steps(range(800, 1200)) == first[100:]
# A reset does not harm it.
unit.slave.reset()
unit.begin({}, {})
unit.state("set", later)
assert steps(range(800, 1200)) == first[100:]
unit.state("free", later)
print(f"repeated: {len(first)} steps, {len(outputs)} outputs")

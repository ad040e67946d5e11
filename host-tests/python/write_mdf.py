"""asammdf as a measurement tool: writes a log of this project as MDF of several kinds, with other units and rates."""

import sys
from pathlib import Path

import numpy
from asammdf import MDF, Signal

PSI_KPA = 6.894757293168
VERSIONS = ["3.30", "4.10", "4.11"]
# As they are, deflated, and transposed and deflated.
COMPRESSIONS = [0, 1, 2]


def channels(log):
    """Groups of channels that were sampled together."""
    time_s, lift_a, lower_a, pressure_bar, angle_deg = log.T
    # The angle twice as often as the currents.
    often_s = numpy.linspace(time_s[0], time_s[-1], 2 * len(time_s) - 1)
    angle_rad = numpy.radians(numpy.interp(often_s, time_s, angle_deg))
    pressure_psi = pressure_bar * 100 / PSI_KPA
    return [
        [
            Signal(lift_a * 1000, time_s, name="LiftCurrent", unit="mA"),
            Signal(lower_a * 1000, time_s, name="LowerCurrent", unit="mA"),
        ],
        [Signal(angle_rad, often_s, name="RockerAngle", unit="rad")],
        [Signal(pressure_psi.astype("f4"), time_s, name="CylinderPressure", unit="psi")],
    ]


def main():
    path = Path(sys.argv[1])
    log = numpy.loadtxt(path, delimiter=",", skiprows=1)
    for version in VERSIONS:
        for compression in COMPRESSIONS if version.startswith("4") else COMPRESSIONS[:1]:
            with MDF(version=version) as mdf:
                for group in channels(log):
                    mdf.append(group)
                end = "mf4" if version.startswith("4") else "mdf"
                name = f"v{version}_{compression}.{end}"
                mdf.save(path.parent / name, compression=compression, overwrite=True)
                print(name)


main()

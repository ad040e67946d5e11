"""Other programs as loggers: SciPy, pyarrow and python-can write a log of this project as MAT, Parquet and BLF.

Arguments: the log, and the number of its rows to write, 0 for all. Prints each file with the options of its import."""

import struct
import sys
from pathlib import Path

import can
import numpy
import pyarrow
import pyarrow.parquet
import scipy.io

PSI_KPA = 6.894757293168
EPOCH_S = 1_763_700_000


def write_mat(folder, log):
    time_s, lift_a, lower_a, pressure_bar, angle_deg = log.T
    plain = {
        "Zeit_s": time_s,
        "Strom_Heben": lift_a * 1000,
        "Strom_Senken": (lower_a * 1000).round().astype("int16"),
        "Druck_Zylinder": pressure_bar.astype("f4"),
        "Winkel_deg": angle_deg,
        "Seriennummer": 17,
        "Bemerkung": "Öl warm",
    }
    for compressed in (False, True):
        name = f"vectors_{compressed}.mat"
        scipy.io.savemat(folder / name, plain, do_compression=compressed, oned_as="column")
        yield f"{name}"
    scipy.io.savemat(folder / "struct.mat", {"log": plain}, do_compression=True, oned_as="row")
    yield "struct.mat"
    # The angle twice as often as the currents.
    often_s = numpy.linspace(time_s[0], time_s[-1], 2 * len(time_s) - 1)
    angle_rad = numpy.radians(numpy.interp(often_s, time_s, angle_deg))

    def series(times, data, unit):
        return {"Time": times, "Data": data, "DataInfo": {"Units": unit}}

    timed = {
        "LiftCurrent": series(time_s, lift_a * 1000, "mA"),
        "LowerCurrent": series(time_s, lower_a * 1000, "mA"),
        "CylinderPressure": series(time_s, pressure_bar * 100 / PSI_KPA, "psi"),
        "RockerAngle": series(often_s, angle_rad, "rad"),
    }
    scipy.io.savemat(folder / "series.mat", timed, do_compression=True, oned_as="column")
    yield "series.mat"
    signals = numpy.zeros((4,), dtype=[("values", "O"), ("label", "O")])
    labels = ["lift current", "lower current", "cylinder pressure", "rocker angle deg"]
    for index, (label, values) in enumerate(zip(labels, log.T[1:])):
        signals[index] = (values.reshape(-1, 1), label)
    simulink = {"out": {"time": time_s.reshape(-1, 1), "signals": signals}}
    scipy.io.savemat(folder / "simulink.mat", simulink, do_compression=True)
    yield "simulink.mat"
    # Level 4 has matrices and texts only.
    scipy.io.savemat(folder / "level_4.mat", plain, format="4", oned_as="column")
    yield "level_4.mat"
    # ControlDesk of dSPACE: names and units are inside the structs; the angle has its own axis of times.
    axes = numpy.zeros((2,), dtype=[("Name", "O"), ("Data", "O"), ("Unit", "O")])
    axes[0] = ("xAxis", time_s * 1000, "ms")
    axes[1] = ("xAxis", often_s * 1000, "ms")
    fields = ["Name", "Data", "Unit", "XIndex"]
    traces = numpy.zeros((4,), dtype=[(field, "O") for field in fields])
    traces[0] = ("Model Root/Bench/Lift Current", lift_a * 1000, "mA", numpy.uint32(1))
    traces[1] = ("Model Root/Bench/Lower Current", lower_a, "A", numpy.uint32(1))
    traces[2] = ("Model Root/Bench/Cylinder Pressure", pressure_bar, "bar", numpy.uint32(1))
    traces[3] = ("Model Root/Bench/Rocker Angle", angle_rad, "rad", numpy.uint32(2))
    dspace = {"exp_001": {"X": axes, "Y": traces, "Description": {"General": "x"}}}
    scipy.io.savemat(folder / "dspace.mat", dspace, do_compression=True, oned_as="row")
    yield "dspace.mat"
    scipy.io.savemat(folder / "matrix.mat", {"m": log}, do_compression=True)
    units = ["time_s=m(:,1):s", "lift_current_a=m(:,2):A", "lower_current_a=m(:,3):A"]
    units += ["cylinder_pressure_bar=m(:,4):bar", "rocker_angle_deg=m(:,5):deg"]
    yield " ".join(["matrix.mat", *(f"--map {unit}" for unit in units)])


def write_parquet(folder, log):
    time_s, lift_a, lower_a, pressure_bar, angle_deg = log.T
    stamps = pyarrow.array((EPOCH_S * 10**9 + numpy.round(time_s * 1e9)).astype("i8"))
    # A gap in a current that does not change is bridged.
    gap = (time_s > 1.0) & (time_s < 1.1)
    table = pyarrow.table(
        {
            "Bemerkung": ["x"] * len(time_s),
            "Timestamp": stamps.cast(pyarrow.timestamp("ns", tz="UTC")),
            "LiftCurrent [mA]": pyarrow.array(lift_a * 1000, mask=gap),
            "LowerCurrent [mA]": (lower_a * 1000).round().astype("i4"),
            "Cylinder Pressure [psi]": (pressure_bar * 100 / PSI_KPA).astype("f4"),
            "Rocker Angle [deg]": angle_deg,
        }
    )
    for name, options in {
        "snappy": {},
        "gzip": {"compression": "gzip", "data_page_version": "2.0", "row_group_size": 1000},
        "plain": {"compression": None, "use_dictionary": False},
    }.items():
        pyarrow.parquet.write_table(table, folder / f"{name}.parquet", **options)
        yield f"{name}.parquet"
    # Not supported; the test checks the error message.
    pyarrow.parquet.write_table(table, folder / "refused.zstd.parquet", compression="zstd")


def write_blf(folder, log):
    for flexible in (False, True):
        name = f"bus_{flexible}.blf"
        with can.BLFWriter(folder / name, compression_level=-1 if flexible else 0) as writer:
            for time_s, lift_a, lower_a, pressure_bar, angle_deg in log:
                currents = struct.pack("<HH", round(lift_a * 1000), round(lower_a * 1000))
                motion = struct.pack("<HH", round(angle_deg * 100), round(pressure_bar * 100))
                for identifier, data in [(0x101, currents), (0x102, motion), (0x7FF, b"\x12\x03")]:
                    frame = can.Message(
                        timestamp=EPOCH_S + time_s,
                        arbitration_id=identifier,
                        is_extended_id=False,
                        is_fd=flexible,
                        data=data,
                    )
                    writer.on_message_received(frame)
        yield f"{name} rig.dbc"


def main():
    path, rows = Path(sys.argv[1]), int(sys.argv[2])
    log = numpy.loadtxt(path, delimiter=",", skiprows=1)[: rows or None]
    for write in (write_mat, write_parquet, write_blf):
        for file in write(path.parent, log):
            print(file)


main()

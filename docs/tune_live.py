"""Tunes a gain over XCP while the hitch moves, and shows what that does to its moves.

usage: python3 tune_live.py [PATH_TO_HITCH [OPTION OF `hitch ecu`...]]     (pip install pyxcp cantools "python-can[serial]")

pyxcp writes the gain, at the address that hitch.a2l gives it; python-can and cantools watch the hitch by hitch.dbc. A picture
of the moves is written to tuning.svg.
"""
import pathlib, re, struct, subprocess, sys, threading, time

import hitch_program

try:
    import can, cantools
    from pyxcp.config import create_application_from_config, set_application
    from pyxcp.master import Master
except ModuleNotFoundError as missing:
    sys.exit(f'the Python package {missing.name} is missing: pip install pyxcp cantools "python-can[serial]"')

FIRMWARE = pathlib.Path(__file__).resolve().parent.parent / "firmware"
LOW_DEG, HIGH_DEG = 80.0, 105.0
GAINS_PER_S = [60, 4, 60]
MOVE_S = 2.0

hitch, options = hitch_program.find(*sys.argv[1:2]), sys.argv[2:]
ecu = subprocess.Popen(
    [hitch, "ecu", "--can", "127.0.0.1:0", *options],
    stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
)
line = ""
while "CAN is open" not in line:
    before, line = line, ecu.stderr.readline()
    line or sys.exit(before.strip() or "hitch ecu has ended")
port = "socket://" + line.split()[-1]
threading.Thread(target=ecu.stderr.read, daemon=True).start()


def operator(order):
    ecu.stdin.write(order + "\n")
    ecu.stdin.flush()


# The watcher: time and rocker angle, as the ECU broadcasts them.
motion = cantools.database.load_file(FIRMWARE / "hitch.dbc").get_message_by_name("HitchMotion")
bus = can.Bus(interface="slcan", channel=port)
trace = []


def watched(message):
    if message.arbitration_id & 0xFFFF00 == motion.frame_id & 0xFFFF00:
        trace.append((time.monotonic(), motion.decode(message.data)["RockerAngle"]))


notifier = can.Notifier(bus, [watched])

# The tool: commands to address 128, answers to the tool's own, 249.
link = {"interface": "slcan", "channel": port, "bitrate": 250_000, "max_dlc_required": False,
        "can_id_master": 0x18EF80F9 | 1 << 31, "can_id_slave": 0x18EFF980 | 1 << 31}
application = create_application_from_config({"Transport": {"CAN": link}})
application.transport.layer = "CAN"
set_application(application)
description = (FIRMWARE / "hitch.a2l").read_text(encoding="utf-8")
address = int(re.search(r'CHARACTERISTIC position.approach_gain ".*"\s+VALUE (\w+)', description).group(1), 16)


def move(target_deg, tuned=lambda: None):
    """Moves the lever, calls `tuned` on the way, and gives the move: seconds since the lever was moved, and angle."""
    begun = time.monotonic()
    operator(f"lever {target_deg}")
    time.sleep(0.25)
    speed_deg_per_s = (trace[-1][1] - trace[-4][1]) / (trace[-1][0] - trace[-4][0])
    tuned()
    assert abs(speed_deg_per_s) > 5, f"the hitch moves at {speed_deg_per_s:.1f} deg/s only"
    time.sleep(MOVE_S - 0.25)
    return [(at - begun, angle_deg) for at, angle_deg in trace if at >= begun]


def settled_s(rows, target_deg):
    return max((at for at, angle_deg in rows if abs(angle_deg - target_deg) > 0.5), default=0.0)


def picture(moves):
    """One curve a gain."""
    def points(rows):
        return " ".join(f"{60 + 270 * at:.1f},{250 - 8 * (angle - LOW_DEG):.1f}" for at, angle in rows)
    colours = ["#888", "#c06", "#06c"]
    curves = "".join(
        f'<polyline fill="none" stroke="{colour}" stroke-width="1.5" points="{points(rows)}"/>'
        f'<text x="480" y="{120 + 18 * place}" fill="{colour}">{place + 1}: gain {gain} 1/s</text>'
        for place, (colour, (gain, rows)) in enumerate(zip(colours, moves)))
    ticks = "".join(f'<text x="{60 + 270 * second}" y="275">{second} s</text>' for second in range(3))
    ticks += "".join(f'<text x="5" y="{254 - 8 * (angle - LOW_DEG)}">{angle:.0f} deg</text>' for angle in (LOW_DEG, HIGH_DEG))
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="640" height="290" font-family="sans-serif" font-size="13">'
            f'<rect width="640" height="290" fill="#fff"/>{ticks}{curves}</svg>\n')


moves = []
with Master("CAN", config=application) as tool:
    tool.connect()
    operator("service on")
    move(LOW_DEG)
    for gain in GAINS_PER_S:
        def tuned():
            tool.setMta(address)
            tool.download(struct.pack("<i", gain))
        # Written while the hitch lifts with the gain of before; lowered and lifted again with the new one.
        move(HIGH_DEG, tuned)
        move(LOW_DEG)
        rows = move(HIGH_DEG)
        moves.append((gain, rows))
        print(f"gain {gain:2} 1/s: within 0.5 deg after {settled_s(rows, HIGH_DEG):.2f} s", flush=True)
        move(LOW_DEG)
    tool.disconnect()

notifier.stop()
bus.shutdown()
operator("quit")
ecu.wait()
pathlib.Path("tuning.svg").write_text(picture(moves))
before, slow, quick = (settled_s(rows, HIGH_DEG) for _, rows in moves)
assert slow > 1.5 * max(before, quick), "a small gain makes a slow approach, and it can be taken back"

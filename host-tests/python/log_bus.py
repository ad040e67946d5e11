"""python-can as a logger: takes what is on the bus into a candump log and one of Vector's, while the hitch moves."""

import collections
import time

import can

import shared

PGN_MOTION = 0xFF45
DEG_PER_BIT = 0.01
AT_REST_DEG = 0.5
LOGGED_S = 4.0


def main():
    arguments = shared.arguments()
    bus = shared.open_bus(arguments.bus)
    # A run begins at rest.
    angles = collections.deque(maxlen=25)

    def at_rest():
        message = bus.recv(0.2)
        if message is not None and (message.arbitration_id >> 8) & 0xFFFF == PGN_MOTION:
            angles.append(int.from_bytes(message.data[4:6], "little") * DEG_PER_BIT)
        return len(angles) == angles.maxlen and max(angles) - min(angles) < AT_REST_DEG

    shared.wait_for(at_rest, "hitch at rest")
    loggers = [can.Logger("bus-logs/run.log"), can.Logger("bus-logs/run.asc")]
    end = time.monotonic() + LOGGED_S
    count = 0
    while time.monotonic() < end:
        message = bus.recv(0.2)
        if message is not None:
            count += 1
            for logger in loggers:
                logger(message)
    for logger in loggers:
        logger.stop()
    bus.shutdown()
    print(f"logged: {count} frames")


main()

"""What the clients share: the bus, and patience."""

import argparse
import time

import can

ECU = 0x80
IMPLEMENT = 0x26


def arguments(*more):
    """HOST:PORT of the bus, the folder of the firmware with its description files, and `more`."""
    parser = argparse.ArgumentParser()
    parser.add_argument("bus", help="HOST:PORT")
    parser.add_argument("firmware", help="folder with hitch.dbc and hitch.a2l")
    for name in more:
        parser.add_argument(name)
    return parser.parse_args()


def open_bus(address):
    return can.Bus(interface="slcan", channel=f"socket://{address}")


def wait_for(condition, what, seconds=10.0):
    """What `condition` gives as soon as it gives something."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        found = condition()
        if found:
            return found
    raise AssertionError(f"in {seconds} s there was no {what}")

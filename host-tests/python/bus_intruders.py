"""What a node of the bus, a tool or a shorted wire does without the operator's consent. The hitch has to stay."""

import re
import struct
import time

import can
from pyxcp import types
from pyxcp.daq_stim import DaqOnlinePolicy

import shared
from hitch_messages import Implement, at_rest
from xcp_session import Description, open_master, read, refused, write

PGN_CLAIM, PGN_DM1, PGN_PACKETS, PGN_PACKET = 0xEE00, 0xFECA, 0xEC00, 0xEB00
NO_ADDRESS = 0xFE
ENGINE = 0x0CF00400
LOST_SPEED = (190, 9)
CONTRADICTING, CLOSED = (520205, 2), (520205, 4)
SAFETY_VALUES_DIFFER = (520206, 31)
# A hitch that moves by less stays, degrees.
STAYS_DEG = 1.0


class Intruder(Implement):
    """An implement that also reads rocker angle and trouble codes."""

    def __init__(self, arguments):
        super().__init__(arguments.bus, f"{arguments.firmware}/hitch.dbc")
        self.description = Description(f"{arguments.firmware}/hitch.a2l")
        self.a2l = open(f"{arguments.firmware}/hitch.a2l", encoding="utf-8").read()
        self.address = arguments.bus
        self.motion = self.database.get_message_by_name("HitchMotion")

    def messages(self, seconds, act=lambda: None):
        """What the bus says within a time, with `act` ten times a second: group, source and data."""
        end = time.monotonic() + seconds
        due = time.monotonic()
        while time.monotonic() < end:
            if time.monotonic() >= due:
                act()
                due += 0.1
            message = self.bus.recv(0.02)
            if message is not None:
                group = message.arbitration_id >> 8 & 0x3FFFF
                group &= 0x3FF00 if group >> 8 & 0xFF < 0xF0 else 0x3FFFF
                yield group, message.arbitration_id & 0xFF, bytes(message.data)

    def watch(self, seconds, act=lambda: None):
        """Lowest and highest rocker angle within a time, degrees, and the trouble codes of DM1."""
        angles_deg, codes, packets = [], set(), b""
        for group, source, data in self.messages(seconds, act):
            if source != shared.ECU:
                continue
            if group == self.motion.frame_id >> 8 & 0x3FFFF:
                angles_deg.append(self.motion.decode(data)["RockerAngle"])
            elif group == PGN_DM1:
                codes |= codes_of(data[2:6])
            elif group == PGN_PACKET:
                # Packets of one message; their first has two bytes for the lamps.
                packets = data[1:] if data[0] == 1 else packets + data[1:]
                codes |= codes_of(packets[2:])
        return min(angles_deg), max(angles_deg), codes - {(0, 0)}

    def stays(self, seconds, act=lambda: None):
        """The same of a hitch that does not move meanwhile; its trouble codes."""
        lowest_deg, highest_deg, codes = self.watch(seconds, act)
        assert highest_deg - lowest_deg < STAYS_DEG, (lowest_deg, highest_deg)
        return codes

    def send(self, identifier, data):
        self.bus.send(can.Message(arbitration_id=identifier, data=data, is_extended_id=True))

    def master(self):
        return open_master(self.address, DaqOnlinePolicy([]))


def codes_of(data):
    """SPN and FMI of each whole trouble code, without what fills up the last packet."""
    whole = (data[at : at + 4] for at in range(0, len(data) - 3, 4))
    return {(low | high << 8 | mixed >> 5 << 16, mixed & 31) for low, high, mixed, count in whole if count != 255}


def captured(node):
    """The status of a hitch that the operator has captured with the lever, at rest."""
    shared.wait_for(lambda: node.status()["RearHitchExitCode"] == "clear", "captured hitch")
    return shared.wait_for(lambda: at_rest(node), "hitch at rest")


def unclaimed_node(node):
    here = captured(node)["RearHitchPosition"]
    node.stays(0.7, lambda: node.command(here))
    codes = node.stays(3.0, lambda: node.command(80.0))
    status = node.status()
    assert status["RearHitchLimitStatus"] == "operator limited" and status["RearHitchExitCode"] == "clear", status
    assert not codes, codes


def hitch_without_address(node):
    here = captured(node)["RearHitchPosition"]
    node.claim()
    for address in range(128, 248):
        # A better NAME than any with an identity, a function and an industry group.
        node.send(0x18EEFF00 | address, address.to_bytes(8, "little"))
        time.sleep(0.002)
    claims = [source for group, source, _ in node.messages(1.0) if group == PGN_CLAIM]
    assert claims and claims[-1] == NO_ADDRESS, claims
    heard = list(node.messages(0.7, lambda: node.command(here)))
    heard += node.messages(3.0, lambda: node.command(80.0))
    # Its angle is no longer on the bus. The test checks the plant: the hitch stays.
    assert {source for _, source, _ in heard} <= {NO_ADDRESS}, heard


def lower_limit_as_lever(node):
    captured(node)
    limits_are_refused(node, {"position.lower_limit": 110_000})
    codes = node.stays(3.0)
    assert not codes and node.status()["RearHitchExitCode"] == "clear", codes


def upper_limit_as_lever(node):
    """The operator moves the lever to its upper end and back."""
    shared.wait_for(lambda: node.status()["RearHitchExitCode"] == "clear", "captured hitch")
    highest_deg = limits_are_refused(node, {"position.upper_limit": 60_000}) / 1e3
    limits_are_refused(node, {"position.upper_limit": 360_000})
    lowest_deg, top_deg, codes = node.watch(8.0)
    assert top_deg > 110 and top_deg < highest_deg + 0.5 and lowest_deg > 89, (lowest_deg, top_deg)
    assert not codes, codes


def limits_are_refused(node, values):
    """Writes values while the hitch is in operation; the last present one."""
    with node.master() as master:
        master.connect()
        for name, value in values.items():
            address, *_ = node.description.parameters[name]
            present = read(master, address)
            assert refused(write, master, address, value) == types.XcpError.ERR_ACCESS_DENIED
            assert read(master, address) == present, name
        master.disconnect()
    return present


def loosest_safety_values(node):
    """The A2L names the direction in which a value becomes looser."""
    pattern = r'CHARACTERISTIC ((?:safety|sensors)\.\w+) ".*\(Safety: .*(increased|reduced|changed) with the key only'
    directions = dict(re.findall(pattern, node.a2l))
    accepted, tried = [], 0
    with node.master() as master:
        master.connect()
        words = {name: node.description.parameters[name][0] for name in directions}
        before = {name: read(master, address) for name, address in words.items()}
        for name, direction in directions.items():
            address, low, high = node.description.parameters[name]
            loosest = low if direction == "reduced" else high
            if loosest == before[name]:
                continue
            tried += 1
            try:
                write(master, address, loosest)
                accepted.append(name)
            except types.XcpResponseError as error:
                assert error.get_error_code() == types.XcpError.ERR_ACCESS_LOCKED, (name, error)
        master.setRequest(1, 0)
        shared.wait_for(lambda: not master.getStatus().sessionStatus.storeCalRequest, "end of storing")
        assert {name: read(master, address) for name, address in words.items()} == before
        master.disconnect()
    codes = node.stays(3.0)
    assert tried >= 43 and not accepted, accepted
    assert SAFETY_VALUES_DIFFER not in codes, codes
    assert node.status()["RearHitchExitCode"] == "locked out"
    print(f"accepted: {len(accepted)} of {tried}")


def engine_speed_of_anybody(node):
    captured(node)

    def engine(source, rpm):
        speed = struct.pack("<H", 8 * rpm)
        node.send(ENGINE | source, b"\xff\xff\xff" + speed + b"\xff\xff\xff")

    engine(0x33, 1_600)
    codes = node.stays(3.0)
    assert not codes and node.status()["RearHitchExitCode"] == "clear", codes
    # From the engine's own address the lock closes with the silence, and says so until the engine is back.
    node.stays(1.0, lambda: engine(0, 1_600))
    codes = node.stays(4.0)
    assert codes == {LOST_SPEED}, codes
    assert node.status()["RearHitchExitCode"] == "locked out"
    node.stays(2.0, lambda: engine(0, 1_600))
    assert not node.stays(2.0, lambda: engine(0, 1_600))


def shorted_wire_of_two_contacts(node):
    captured(node)
    shared.wait_for(lambda: CONTRADICTING in node.stays(1.0), "code of contradicting contacts")
    assert CONTRADICTING in node.stays(8.0)


def shorted_wire_of_one_contact(node):
    """The bound is that of one press. The test checks it on the plant."""
    shared.wait_for(lambda: CLOSED in node.watch(1.0)[2], "code of a closed contact", 30.0)
    codes = node.stays(2.0)
    assert codes == {CLOSED, SAFETY_VALUES_DIFFER}, codes


ROWS = [
    unclaimed_node,
    hitch_without_address,
    lower_limit_as_lever,
    upper_limit_as_lever,
    loosest_safety_values,
    engine_speed_of_anybody,
    shorted_wire_of_two_contacts,
    shorted_wire_of_one_contact,
]


def main():
    arguments = shared.arguments("row")
    rows = {row.__name__: row for row in ROWS}
    node = Intruder(arguments)
    rows[arguments.row](node)
    node.bus.shutdown()
    print(f"kept: {arguments.row}")


if __name__ == "__main__":
    main()

"""can-j1939 as another node: takes the hitch's address, reads its trouble codes, and asks for what there isn't."""

import queue
import re
import time

import j1939

import shared

PGN_STATUS = 0xFE45
PGN_DM1 = 0xFECA
PGN_ACKNOWLEDGEMENT = 0xE800
PGN_SOFTWARE = 0xFEDA
PGN_UNKNOWN = 0xFEE5
SUPPLIED = (520198, 13)
LEVER = (520192, 31)


def main():
    arguments = shared.arguments()
    ecu = j1939.ElectronicControlUnit()
    ecu.connect(interface="slcan", channel=f"socket://{arguments.bus}")

    heard = queue.Queue()
    ecu.subscribe(lambda priority, pgn, source, timestamp, data: heard.put((pgn, source, bytes(data))))

    def next_of(pgn, source):
        """The data of the next message of a group."""
        try:
            message = heard.get(timeout=0.2)
        except queue.Empty:
            return None
        return message[2] if message[:2] == (pgn, source) else None

    shared.wait_for(lambda: next_of(PGN_STATUS, shared.ECU), "hitch at 0x80")

    # DM1 with two codes comes as a broadcast in packets, which can-j1939 puts together.
    codes = shared.wait_for(lambda: next_of(PGN_DM1, shared.ECU), "DM1")
    assert len(codes) == 10, codes.hex()
    found = {decoded(codes[at : at + 4]) for at in (2, 6)}
    assert found == {SUPPLIED, LEVER}, found
    print(f"DM1 by broadcast: {sorted(found)}")

    # A node with a better NAME, which doesn't give way, takes the address.
    name = j1939.Name(
        arbitrary_address_capable=0,
        industry_group=j1939.Name.IndustryGroup.AgriculturalAndForestry,
        vehicle_system_instance=0,
        vehicle_system=1,
        function=130,
        function_instance=0,
        ecu_instance=0,
        manufacturer_code=0,
        identity_number=1,
    )
    other = j1939.ControllerApplication(name, shared.ECU)
    ecu.add_ca(controller_application=other)
    other.start()
    shared.wait_for(lambda: other.state == j1939.ControllerApplication.State.NORMAL, "address for the other")
    assert other.device_address == shared.ECU
    shared.wait_for(lambda: next_of(PGN_STATUS, shared.ECU + 1), "hitch at 0x81")
    print("address: 0x80 was lost, 0x81 claimed")

    # Nobody uses an address twice.
    time.sleep(0.3)
    while not heard.empty():
        pgn, source, data = heard.get()
        assert source != shared.ECU, f"{pgn:X} from the lost address: {data.hex()}"

    # What the hitch doesn't know it refuses.
    other.send_request(0, PGN_UNKNOWN, shared.ECU + 1)
    refusal = shared.wait_for(lambda: next_of(PGN_ACKNOWLEDGEMENT, shared.ECU + 1), "refusal")
    assert refusal == bytes([1, 255, 255, 255, shared.ECU, 0xE5, 0xFE, 0x00]), refusal.hex()
    print("request: refused what isn't known")

    # DM1 for one node alone comes with its consent (RTS, CTS), and is the same.
    own = queue.Queue()
    other.subscribe(lambda priority, pgn, source, timestamp, data: own.put((pgn, bytes(data))))
    other.send_request(0, PGN_DM1, shared.ECU + 1)
    again = shared.wait_for(lambda: message_of(own, PGN_DM1), "DM1 for one")
    assert {decoded(again[at : at + 4]) for at in (2, 6)} == found
    print("DM1 by connection")

    # The software is the one that the description of its parameters belongs to.
    other.send_request(0, PGN_SOFTWARE, shared.ECU + 1)
    software = shared.wait_for(lambda: message_of(own, PGN_SOFTWARE), "identification")
    with open(f"{arguments.firmware}/hitch.a2l", encoding="utf-8") as description:
        identity = re.search(r'EPK "(.*?)"', description.read()).group(1)
    assert software == b"\x01" + identity.encode() + b"*", software
    print(f"software: {identity}")

    other.stop()
    ecu.disconnect()


def message_of(messages, pgn):
    try:
        found, data = messages.get(timeout=0.2)
    except queue.Empty:
        return None
    return data if found == pgn else None


def decoded(code):
    """SPN and FMI of a trouble code."""
    low, high, mixed, _ = code
    return (low | high << 8 | (mixed >> 5) << 16, mixed & 0x1F)


main()

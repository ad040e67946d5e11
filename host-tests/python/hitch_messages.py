"""python-can and cantools as an implement: reads the hitch's status by the DBC, and commands the hitch."""

import time

import can
import cantools

import shared

PGN_STATUS = 0xFE45
STATUS = "RearHitchStatus"
COMMAND = "HitchAndPtoCommands"
# Industry group 2, device class 6 (sprayer), function 128.
NAME = (2 << 60) | (6 << 49) | (128 << 40) | 77
CLAIM = 0x18EEFF26


def pgn(message):
    return (message.arbitration_id >> 8) & 0xFFFF


class Implement:
    def __init__(self, address, dbc):
        self.database = cantools.database.load_file(dbc)
        self.bus = shared.open_bus(address)
        self.due = time.monotonic()

    def claim(self):
        """Claims the address from which the commands come."""
        data = NAME.to_bytes(8, "little")
        self.bus.send(can.Message(arbitration_id=CLAIM, data=data, is_extended_id=True))

    def status(self, seconds=1.0):
        """The next status."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            message = self.bus.recv(0.2)
            if message is not None and pgn(message) == PGN_STATUS:
                assert message.is_extended_id and message.arbitration_id == 0x0CFE4580
                return self.database.decode_message(STATUS, message.data)
        raise AssertionError("no status")

    def command(self, percent):
        """Asks for a position of the rear hitch, and for nothing else."""
        message = self.database.get_message_by_name(COMMAND)
        nothing = {signal.name: 255 if signal.length == 8 else 2**signal.length - 1 for signal in message.signals}
        raw = dict(nothing, RearHitchPositionCommand=round(percent / 0.4))
        # "Nothing" is outside the range of what is something.
        data = message.encode(raw, scaling=False, strict=False)
        assert data == bytes([255, round(percent / 0.4), 255, 255, 255, 255, 255, 255])
        self.bus.send(can.Message(arbitration_id=message.frame_id, data=data, is_extended_id=True))

    def send(self, name, **signals):
        """A message of the DBC."""
        message = self.database.get_message_by_name(name)
        data = message.encode(signals, scaling=True, strict=False, padding=True)
        self.bus.send(can.Message(arbitration_id=message.frame_id, data=data, is_extended_id=True))

    def commanded(self, percent, until, what, seconds=10.0):
        """Commands ten times a second until a status is as wanted. A new set point keeps the rhythm."""

        def step():
            now = time.monotonic()
            if now >= self.due:
                self.command(percent)
                self.due = now + 0.1
            status = self.status()
            return status if until(status) else None

        return shared.wait_for(step, what, seconds)


def at_rest(implement):
    """The status, if ten of them are alike but for a bit of noise."""
    first = implement.status()
    here = first["RearHitchPosition"]
    return first if all(abs(implement.status()["RearHitchPosition"] - here) < 0.5 for _ in range(10)) else None


def check_rhythm(implement):
    begun = time.monotonic()
    count = 0
    while time.monotonic() < begun + 2.0:
        implement.status()
        count += 1
    # On a machine that is busy with other tests the ECU's time is slower.
    assert 10 <= count <= 23, f"{count} statuses in 2 s"
    print(f"status: {count} in 2 s")


def received(implement, name, seconds=1.0):
    """The next message of that name from the hitch, decoded."""
    wanted = implement.database.get_message_by_name(name)
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        message = implement.bus.recv(0.2)
        if message is not None and message.arbitration_id == wanted.frame_id:
            return wanted.decode(message.data)
    raise AssertionError(f"no {name}")


def check_partnership(implement):
    """What there is to be had is said, and who asks for the heartbeat gets it ten times a second."""
    send = implement.send
    send("RequiredFacilities", RequiredClass=3, RearInWork=0, RearPosition=1, RearDraft=0, RearLimitStatus=1, RearCommand=1)
    facilities = received(implement, "TractorFacilities")
    fitted = dict(TractorClass="not available", RearInWork=0, RearPosition=1, RearDraft=0, RearLimitStatus=1, RearCommand=1)
    assert facilities == fitted, facilities
    send("RepetitionRequest", RepeatedGroup=0xF0E4, RepetitionPeriod=0.1, Reserved=0xFFFFFF)
    numbers = [received(implement, "Heartbeat")["HeartbeatNumber"] for _ in range(4)]
    assert numbers == [251, 0, 1, 2], numbers
    print(f"facilities and heartbeat: {numbers}")


def check_management(implement):
    """Tractor Implement Management is refused: nobody has been authenticated."""
    send = implement.send
    send("TimClient", TimClientMessage=246, TimClientVersion=2, TimClientLowestVersion=1)
    version = received(implement, "TimServer")
    assert version["TimVersionError"] == 0 and version["TimVersion"] == version["TimLowestVersion"] == 1, version
    request = dict(TimRequests=1, TimRequestedFunction=0x43, TimRequestInformation=31, TimRequest="assign")
    send("TimClient", TimClientMessage=245, **request)
    refusal = received(implement, "TimServer")
    found = refusal["TimAssignedFunction"], refusal["TimAssignment"], refusal["TimAssignmentReason"]
    assert found == (0x43, "not successful", "client not certified"), refusal
    ready = dict(TimRequestCounter=1, TimRequestMessage=0, TimRequestReserved=0xFFFF, TimRearHitchRequest=645.11)
    send("TimClient", TimClientMessage=0x43, **ready)
    denied = shared.wait_for(lambda: acknowledgement(implement), "acknowledgement")
    assert denied == bytes([2, 0x43, 0xFF, 0xFF, 0x26, 0x00, 0x24, 0x00]), denied
    print(f"management: {found[1]}, {found[2]}")


def acknowledgement(implement):
    """The bytes of an acknowledgement to the implement, if one comes."""
    message = implement.bus.recv(0.2)
    return message.data if message is not None and message.arbitration_id == 0x18E82680 else None


def main():
    arguments = shared.arguments()
    implement = Implement(arguments.bus, f"{arguments.firmware}/hitch.dbc")
    shared.wait_for(
        lambda: implement.status()["RearHitchExitCode"] == "clear", "hitch that the operator has picked up"
    )
    status = shared.wait_for(lambda: at_rest(implement), "hitch at rest")
    check_rhythm(implement)
    check_partnership(implement)
    check_management(implement)
    here = status["RearHitchPosition"]
    assert status["RearHitchLimitStatus"] == "operator limited"
    assert status["RearDraft"] == 335350 and status["RearHitchInWork"] == "not available"

    # Remote control doesn't start from anywhere else.
    begun = time.monotonic()
    far = implement.commanded(here - 20, lambda _: time.monotonic() > begun + 0.5, "time")
    assert far["RearHitchLimitStatus"] == "operator limited" and abs(far["RearHitchPosition"] - here) < 0.5

    # Nor for a node without an address, whatever the operator does.
    begun = time.monotonic()
    unknown = implement.commanded(here, lambda _: time.monotonic() > begun + 2.5, "time")
    assert unknown["RearHitchLimitStatus"] == "operator limited" and unknown["RearHitchExitCode"] == "clear"

    # The operator presses the button every two seconds.
    implement.claim()
    implement.commanded(here, lambda now: now["RearHitchLimitStatus"] == "not limited", "consent of the operator")
    print("remote: consented")
    for target in (here - 20, here + 4):
        implement.commanded(
            target, lambda now: abs(now["RearHitchPosition"] - target) <= 0.8, f"hitch at {target} %"
        )
        print(f"remote: at {target} %")

    # Silence ends it; the reason is told.
    wait = shared.wait_for(
        lambda: (now := implement.status())["RearHitchExitCode"] == "timeout" and now, "time-out", 2.0
    )
    assert wait["RearHitchLimitStatus"] == "operator limited"
    print("remote: timed out")
    implement.bus.shutdown()


if __name__ == "__main__":
    main()

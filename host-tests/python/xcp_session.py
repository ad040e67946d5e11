"""pyxcp as a calibration tool: finds parameters and measurements by the A2L, changes, measures, and stores."""

import re
import struct
import time
import zlib

from pyxcp import types
from pyxcp.config import create_application_from_config, set_application
from pyxcp.daq_stim import DaqList, DaqOnlinePolicy
from pyxcp.master import Master

import shared

TOOL = 0xF9
EXTENDED = 1 << 31
WORKING, REFERENCE = 0, 1
FOR_TOOL = 2
A2L_TYPES = {"UBYTE": "U8", "UWORD": "U16", "SWORD": "I16", "ULONG": "U32", "SLONG": "I32", "FLOAT32_IEEE": "F32"}


class Description:
    """As much of the A2L as a session needs, read without a library."""

    def __init__(self, path):
        text = open(path, encoding="utf-8").read()
        self.identity = re.search(r'EPK "(.*?)"', text).group(1)
        self.identity_address = int(re.search(r"ADDR_EPK (\w+)", text).group(1), 16)
        segment = re.search(r"MEMORY_SEGMENT calibration .*? INTERN (\w+) (\w+)", text)
        self.calibration, self.length = (int(number, 16) for number in segment.groups())
        counts = dict(re.findall(r"COMPU_METHOD (\w+) .*\s+RAT_FUNC .*\s+COEFFS 0 (\d+) 0 0 0 1", text))
        self.parameters = {}
        pattern = r'CHARACTERISTIC (\S+) ".*"\s+VALUE (\w+) word 0 (\w+) (\S+) (\S+)'
        for name, address, method, low, high in re.findall(pattern, text):
            scale = int(counts[method])
            limits = round(float(low) * scale), round(float(high) * scale)
            self.parameters[name] = (int(address, 16), *limits)
        pattern = r'MEASUREMENT (\S+) ".*"\s+(\w+) (\w+) .*\s+ECU_ADDRESS (\w+)'
        self.measurements = {
            name: (int(address, 16), A2L_TYPES[kind]) for name, kind, _, address in re.findall(pattern, text)
        }


class Samples(DaqOnlinePolicy):
    """Keeps what is measured."""

    def __init__(self, lists):
        super().__init__(lists)
        self.rows = []

    def on_daq_list(self, daq_list, timestamp0, timestamp1, values):
        self.rows.append((daq_list, timestamp1, list(values)))


def open_master(address, policy):
    application = create_application_from_config(
        {
            "Transport": {
                "CAN": {
                    "interface": "slcan",
                    "channel": f"socket://{address}",
                    "bitrate": 250_000,
                    "can_id_master": 0x18EF00F9 | shared.ECU << 8 | EXTENDED,
                    "can_id_slave": 0x18EF0000 | TOOL << 8 | shared.ECU | EXTENDED,
                    "max_dlc_required": False,
                }
            },
            # Refusals are what is tested here.
            "General": {"disable_error_handling": True},
        }
    )
    application.transport.layer = "CAN"
    set_application(application)
    return Master("CAN", config=application, policy=policy)


def read(master, address):
    return struct.unpack("<i", master.shortUpload(4, address))[0]


def write(master, address, value):
    master.setMta(address)
    master.download(struct.pack("<i", value))


def refused(action, *arguments):
    """The error that a command is refused with."""
    try:
        action(*arguments)
    except types.XcpResponseError as error:
        return error.get_error_code()
    raise AssertionError(f"{action.__name__}{arguments} was obeyed")


def check_identity(master, description):
    name = master.identifier(types.XcpGetIdType.FILENAME)
    assert name == "hitch", name
    master.setMta(description.identity_address)
    identity = master.fetch(len(description.identity)).decode()
    assert identity == description.identity, (identity, description.identity)
    print(f"identity: {identity}")


def check_parameters(master, description):
    """Every parameter has its address and range, and what is out of it is refused and changes nothing."""
    for name, (address, low, high) in description.parameters.items():
        value = read(master, address)
        assert low <= value <= high, f"{name}: {value} is not in {low}..{high}"
        for outside in (low - 1, high + 1):
            error = refused(write, master, address, outside)
            assert error == types.XcpError.ERR_OUT_OF_RANGE, f"{name}: {error}"
        assert read(master, address) == value, name
    print(f"parameters: {len(description.parameters)} refuse what is out of range")


def check_pages(master, description):
    address, *_ = description.parameters["position.lift_speed"]
    before = read(master, address)
    write(master, address, before - 1_000)
    assert read(master, address) == before - 1_000
    master.setCalPage(FOR_TOOL, 0, REFERENCE)
    assert read(master, address) == before
    assert refused(write, master, address, before) == types.XcpError.ERR_WRITE_PROTECTED
    master.setCalPage(FOR_TOOL, 0, WORKING)
    assert read(master, address) == before - 1_000
    info = master.getPagInfo()
    assert info["maxSegments"] == 1 and info["segments"][0]["address"] == description.calibration
    print("pages: working and reference")


def check_checksum(master, description):
    master.setMta(description.calibration)
    block = master.fetch(description.length)
    master.setMta(description.calibration)
    found = master.buildChecksum(description.length)
    assert found.checksum == zlib.crc32(block), f"{found.checksum:08X}"
    print(f"checksum: {found.checksum:08X} of {len(block)} bytes")


def check_storing(master, description):
    """What is stored is on the reference page."""
    address, *_ = description.parameters["position.lift_speed"]
    master.setRequest(1, 0)
    shared.wait_for(lambda: not master.getStatus().sessionStatus.storeCalRequest, "end of storing")
    master.setCalPage(FOR_TOOL, 0, REFERENCE)
    stored = read(master, address)
    master.setCalPage(FOR_TOOL, 0, WORKING)
    assert stored == read(master, address)
    print("stored")


def check_measuring(master, samples, description):
    info = master.getDaqInfo()
    assert [channel["name"] for channel in info["channels"]] == ["1 ms", "10 ms", "100 ms"]
    samples.setup()
    samples.start()
    time.sleep(2.0)
    samples.stop()
    fast = [row for row in samples.rows if row[0] == 0]
    slow = [row for row in samples.rows if row[0] == 1]
    # On a machine that is busy with other tests the ECU's time is slower.
    assert 80 <= len(fast) <= 250, f"{len(fast)} rows in 2 s, one each 10 ms"
    assert 8 <= len(slow) <= 25, f"{len(slow)} rows in 2 s, one each 100 ms"
    # By the ECU's clock, in nanoseconds, not one is missing.
    gaps = {later[1] - earlier[1] for earlier, later in zip(fast, fast[1:])}
    assert gaps == {10_000_000}, gaps
    angle_deg = read(master, description.measurements["rocker_angle"][0]) / 1e3
    assert 40 < angle_deg < 140
    # The tool packs values as they fit.
    column = [name for name, _ in samples.daq_lists[0].headers].index("rocker_angle")
    assert all(abs(row[2][column] / 1e3 - angle_deg) < 0.5 for row in fast), fast[-1]
    column = [name for name, _ in samples.daq_lists[1].headers].index("angle_noise")
    noises_deg = [row[2][column] for row in slow]
    assert all(0 <= noise_deg < 0.5 for noise_deg in noises_deg), noises_deg
    print(f"measured: {len(fast)} and {len(slow)} rows, none missing")


def main():
    arguments = shared.arguments()
    description = Description(f"{arguments.firmware}/hitch.a2l")

    def measured(*names):
        chosen = ((name, description.measurements[name]) for name in names)
        return [(name, address, 0, kind) for name, (address, kind) in chosen]

    lists = [
        DaqList(
            name="fast",
            event_num=1,
            stim=False,
            enable_timestamps=True,
            measurements=measured("rocker_angle", "lever", "lift_current", "state"),
            priority=0,
            prescaler=1,
        ),
        DaqList(
            name="slow",
            event_num=2,
            stim=False,
            enable_timestamps=False,
            measurements=measured("supply", "cylinder_pressure", "angle_noise"),
            priority=0,
            prescaler=1,
        ),
    ]
    samples = Samples(lists)
    with open_master(arguments.bus, samples) as master:
        master.connect()
        check_identity(master, description)
        check_parameters(master, description)
        check_pages(master, description)
        check_checksum(master, description)
        check_storing(master, description)
        check_measuring(master, samples, description)
        master.disconnect()


if __name__ == "__main__":
    main()

//! The interface of a tool to the ECU: XCP on CAN, with the used part of its description language (AML).

use std::fmt::Write as _;

use hitch_protocols::j1939::{Id, PREFERRED_ADDRESS, Pgn};
use hitch_protocols::xcp::{Event, TOOL_ADDRESS};

/// Definition of the blocks below, after ASAM's AML for XCP 1.4.
pub const AML: &str = include_str!("xcp.aml");

/// The pages of the calibration.
pub const PAGES: &str = "    \
/begin IF_DATA XCP
      /begin SEGMENT 0 2 0 0 0
        /begin CHECKSUM XCP_CRC_32 MAX_BLOCK_SIZE 0x4000 /end CHECKSUM
        /begin PAGE 0 ECU_ACCESS_DONT_CARE XCP_READ_ACCESS_DONT_CARE XCP_WRITE_ACCESS_DONT_CARE /end PAGE
        /begin PAGE 1 ECU_ACCESS_DONT_CARE XCP_READ_ACCESS_DONT_CARE XCP_WRITE_ACCESS_NOT_ALLOWED /end PAGE
      /end SEGMENT
    /end IF_DATA
";

/// Optional commands that the slave supports.
const OPTIONAL_COMMANDS: [&str; 31] = [
    "GET_COMM_MODE_INFO",
    "GET_ID",
    "SET_REQUEST",
    "GET_SEED",
    "SET_MTA",
    "UPLOAD",
    "SHORT_UPLOAD",
    "BUILD_CHECKSUM",
    "DOWNLOAD",
    "DOWNLOAD_MAX",
    "SET_CAL_PAGE",
    "GET_CAL_PAGE",
    "GET_PAG_PROCESSOR_INFO",
    "GET_SEGMENT_INFO",
    "GET_PAGE_INFO",
    "COPY_CAL_PAGE",
    "SET_DAQ_PTR",
    "WRITE_DAQ",
    "SET_DAQ_LIST_MODE",
    "GET_DAQ_LIST_MODE",
    "START_STOP_DAQ_LIST",
    "START_STOP_SYNCH",
    "GET_DAQ_CLOCK",
    "READ_DAQ",
    "GET_DAQ_PROCESSOR_INFO",
    "GET_DAQ_RESOLUTION_INFO",
    "GET_DAQ_EVENT_INFO",
    "FREE_DAQ",
    "ALLOC_DAQ",
    "ALLOC_ODT",
    "ALLOC_ODT_ENTRY",
];

/// Bit of an identifier that marks 29 bits.
const EXTENDED: u32 = 0x8000_0000;

/// Protocol layer, measuring, pages and transport.
pub fn text() -> String {
    let mut commands = String::new();
    for command in OPTIONAL_COMMANDS {
        let _ = writeln!(commands, "    OPTIONAL_CMD {command}");
    }
    let mut events = String::new();
    for event in Event::ALL {
        let period = event.period_ms();
        let _ = writeln!(
            events,
            "    /begin EVENT \"{period} ms\" \"{period} ms\" {} DAQ 0xFF {period} 6 0 /end EVENT",
            event as u8
        );
    }
    format!(
        "/begin IF_DATA XCP\n  \
         /begin PROTOCOL_LAYER 0x0104 2000 2000 2000 2000 2000 2000 2000 8 8 BYTE_ORDER_MSB_LAST ADDRESS_GRANULARITY_BYTE\n\
         {commands}  /end PROTOCOL_LAYER\n  \
         /begin DAQ DYNAMIC 4 {event_count} 0 OPTIMISATION_TYPE_DEFAULT ADDRESS_EXTENSION_FREE\n    \
         IDENTIFICATION_FIELD_TYPE_ABSOLUTE GRANULARITY_ODT_ENTRY_SIZE_DAQ_BYTE 7 OVERLOAD_INDICATION_EVENT\n    \
         PRESCALER_SUPPORTED\n    \
         /begin TIMESTAMP_SUPPORTED 1 SIZE_DWORD UNIT_1US /end TIMESTAMP_SUPPORTED\n\
         {events}  /end DAQ\n  \
         /begin PAG 1 /end PAG\n  \
         /begin XCP_ON_CAN 0x0100\n    CAN_ID_MASTER 0x{to_ecu:08X}\n    CAN_ID_SLAVE 0x{from_ecu:08X}\n    BAUDRATE 250000\n  \
         /end XCP_ON_CAN\n/end IF_DATA\n",
        event_count = Event::ALL.len(),
        to_ecu = identifier(TOOL_ADDRESS, PREFERRED_ADDRESS),
        from_ecu = identifier(PREFERRED_ADDRESS, TOOL_ADDRESS),
    )
}

/// Identifier of a packet from `source` to `destination`.
fn identifier(source: u8, destination: u8) -> u32 {
    let id = Id {
        priority: 6,
        pgn: Pgn::PROPRIETARY_A,
        destination,
        source,
    };
    id.pack().as_raw() | EXTENDED
}

//! The interface of a tool to the ECU: XCP on CAN, with the used part of its description language (AML, after ASAM's for XCP 1.4).

use a2lfile::A2lFile;
use anyhow::{Context as _, Result, ensure};
use hitch_protocols::j1939::{Id, PREFERRED_ADDRESS, Pgn};
use hitch_protocols::xcp::map::{CALIBRATION_BASE, IDENTITY, IDENTITY_BASE};
use hitch_protocols::xcp::{Event, TOOL_ADDRESS};
use hitch_quantities::calibration::CALIBRATION_BYTES;

/// What no table of the firmware changes, with marks where one gives a value.
const FIXED: &str = include_str!("fixed.a2l");

/// Bit of an identifier that marks 29 bits.
const EXTENDED: u32 = 0x8000_0000;

/// A file with memory, layouts of records, and interface; without parameters and measurements.
pub fn file() -> Result<A2lFile> {
    let events = Event::ALL.map(|event| {
        let period = event.period_ms();
        format!(
            "    /begin EVENT \"{period} ms\" \"{period} ms\" {} DAQ 0xFF {period} 6 0 /end EVENT",
            event as u8
        )
    });
    let values = [
        (
            "{identity}",
            String::from_utf8_lossy(&IDENTITY).into_owned(),
        ),
        ("{identity_address}", format!("0x{IDENTITY_BASE:08X}")),
        (
            "{calibration}",
            format!("0x{CALIBRATION_BASE:08X} 0x{CALIBRATION_BYTES:X}"),
        ),
        ("{event_count}", events.len().to_string()),
        ("{events}", events.join("\n")),
        ("{to_ecu}", identifier(TOOL_ADDRESS, PREFERRED_ADDRESS)),
        ("{from_ecu}", identifier(PREFERRED_ADDRESS, TOOL_ADDRESS)),
    ];
    let text = values.iter().fold(FIXED.to_owned(), |text, (mark, value)| {
        text.replace(mark, value)
    });
    let (file, remarks) = a2lfile::load_from_string(&text, None, true).context("fixed.a2l")?;
    ensure!(remarks.is_empty(), "fixed.a2l: {remarks:?}");
    Ok(file)
}

/// Identifier of a packet from `source` to `destination`.
fn identifier(source: u8, destination: u8) -> String {
    let id = Id {
        priority: 6,
        pgn: Pgn::PROPRIETARY_A,
        destination,
        source,
    };
    format!("0x{:08X}", id.pack().as_raw() | EXTENDED)
}

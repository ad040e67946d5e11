//! Recording what the ECU measures, as a run of a campaign has it.

use std::time::{Duration, Instant};

use hitch_firmware::xcp::map::{MEASUREMENT_BASE, SLOT_BYTES};
use hitch_firmware::xcp::measurements::{INFO, Width};

use super::session::{Session, ToolError};

/// Columns of a log, with the measurement of each. The dither is in the measured currents as a ripple that no spool follows;
/// `explain` low-passes them.
pub const CHANNELS: [(&str, &str); 5] = [
    ("lift_current_a", "lift_current_measured"),
    ("lower_current_a", "lower_current_measured"),
    ("pump_pressure_bar", "pump_pressure"),
    ("cylinder_pressure_bar", "cylinder_pressure"),
    ("rocker_angle_deg", "rocker_angle"),
];
/// Sampled every other ten milliseconds: 50 Hz.
pub const PERIOD_MS: u64 = 20;
const EVENT_EVERY_10_MS: u8 = 1;
const PRESCALER: u8 = 2;
/// A tick of the ECU's clock, s.
const TICK_S: f64 = 1e-6;
const SILENT_AFTER: Duration = Duration::from_secs(1);

/// A row of a log: time, s, then the values of [`CHANNELS`].
pub type Row = (f64, [f64; CHANNELS.len()]);

/// One measurement: where it is, how long, and what a count of it is worth.
#[derive(Clone, Copy)]
struct Source {
    address: u32,
    bytes: u8,
    units_per_count: f64,
}

/// Records for `duration_s` of the ECU's time.
///
/// # Errors
/// If the ECU refuses or falls silent.
pub fn record(
    session: &mut Session,
    duration_s: f64,
    mut progress: impl FnMut(f64),
) -> Result<Vec<Row>, ToolError> {
    let sources = CHANNELS.map(|(_, measurement)| source(measurement));
    set_up(session, &sources)?;
    session.command(&[0xDE, 1, 0, 0])?;
    let mut rows: Vec<Row> = Vec::new();
    let mut sample = Sample::default();
    while rows.last().is_none_or(|(time_s, _)| *time_s < duration_s) {
        let packet = session.packet(Instant::now() + SILENT_AFTER)?;
        let packet = packet.ok_or(ToolError::Silent)?;
        if let Some((time_s, values)) = sample.take(&packet, &sources) {
            rows.push((time_s, values));
            progress(time_s);
        }
    }
    session.command(&[0xDE, 0, 0, 0])?;
    Ok(rows)
}

fn source(measurement: &str) -> Source {
    let slot = INFO.iter().position(|info| info.name == measurement);
    let slot = slot.expect("the table of channels names measurements that there are");
    let info = &INFO[slot];
    Source {
        address: MEASUREMENT_BASE + slot as u32 * SLOT_BYTES,
        bytes: match info.width {
            Width::U8 => 1,
            Width::U16 | Width::I16 => 2,
            Width::U32 | Width::I32 => 4,
        },
        units_per_count: 1.0 / f64::from(info.counts_per_unit),
    }
}

/// One list with a table for each measurement: whatever the sizes, each fits beside the time.
fn set_up(session: &mut Session, sources: &[Source]) -> Result<(), ToolError> {
    let tables = sources.len() as u8 + 1;
    session.command(&[0xD6])?;
    session.command(&[0xD5, 0, 1, 0])?;
    session.command(&[0xD4, 0, 0, 0, tables])?;
    for table in 0..tables {
        session.command(&[0xD3, 0, 0, 0, table, 1])?;
    }
    // The first table has the time, and room for two bytes more: a current, which is sampled again in its own.
    let first = sources.first().into_iter();
    for (table, source) in first.chain(sources).enumerate() {
        session.command(&[0xE2, 0, 0, 0, table as u8, 0])?;
        let [a, b, c, d] = source.address.to_le_bytes();
        session.command(&[0xE1, 0xFF, source.bytes, 0, a, b, c, d])?;
    }
    let with_time = 0x10;
    session.command(&[0xE0, with_time, 0, 0, EVENT_EVERY_10_MS, 0, PRESCALER, 0])?;
    Ok(())
}

/// A sample as it comes, packet by packet.
#[derive(Default)]
struct Sample {
    /// Time of the last sample by the ECU's clock, which wraps, and since the first, s.
    last_ticks: Option<u32>,
    time_s: f64,
    values: [f64; CHANNELS.len()],
    next: u8,
}

impl Sample {
    fn take(&mut self, packet: &[u8], sources: &[Source]) -> Option<Row> {
        let (&table, rest) = packet.split_first()?;
        if table == 0 {
            let ticks = u32::from_le_bytes(*rest.first_chunk()?);
            let since = self.last_ticks.map_or(0, |last| ticks.wrapping_sub(last));
            self.last_ticks = Some(ticks);
            self.time_s += f64::from(since) * TICK_S;
            self.next = 1;
            return None;
        }
        // A table that was lost spoils its sample.
        if table != self.next {
            self.next = 0;
            return None;
        }
        let index = usize::from(table) - 1;
        let source = sources.get(index)?;
        self.values[index] = counts(rest, source.bytes)? * source.units_per_count;
        self.next += 1;
        (index + 1 == sources.len()).then_some((self.time_s, self.values))
    }
}

fn counts(bytes: &[u8], length: u8) -> Option<f64> {
    Some(match length {
        1 => f64::from(*bytes.first()?),
        2 => f64::from(i16::from_le_bytes(*bytes.first_chunk()?)),
        _ => f64::from(i32::from_le_bytes(*bytes.first_chunk()?)),
    })
}

//! Records the measurements of the ECU as a run of a campaign.

use std::time::{Duration, Instant};

use hitch_protocols::xcp::map::{MEASUREMENT_BASE, SLOT_BYTES};
use hitch_protocols::xcp::measurements::{INFO, Width};

use super::session::{Session, ToolError};

/// Columns of a log, with the measurement of each.
pub const CHANNELS: [(&str, Reading); 5] = [
    ("lift_current_a", Reading::MeanOf("lift_charge")),
    ("lower_current_a", Reading::MeanOf("lower_charge")),
    ("pump_pressure_bar", Reading::Value("pump_pressure")),
    ("cylinder_pressure_bar", Reading::Value("cylinder_pressure")),
    ("rocker_angle_deg", Reading::Value("rocker_angle")),
];
/// Time between two samples, ms.
pub const PERIOD_MS: u64 = 10;
const EVENT_EVERY_10_MS: u8 = 1;
const PRESCALER: u8 = 1;
/// Bytes of a packet after its number, and bytes of the time in the first packet of a sample.
const PAYLOAD_BYTES: u8 = 7;
const TIME_BYTES: u8 = 4;
/// Resolution of the ECU's clock, s.
const TICK_S: f64 = 1e-6;
const SILENT_AFTER: Duration = Duration::from_secs(1);

/// Longest time between two samples of a charge, ticks: in a longer time its low word may wrap.
const LONGEST_TICKS: u32 = 15_000;
/// Lower limit for the increase of a charge's low word: noise may decrease the charge slightly at zero current.
const LEAST_GROWTH: u16 = 10_000;

/// Conversion of a measurement into a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reading {
    /// The value.
    Value(&'static str),
    /// Increase per time since the last sample: for a charge, the mean current without dither, or with it if the coil
    /// was switched off between two samples.
    MeanOf(&'static str),
}

/// A row of a log: time, s, then the values of [`CHANNELS`].
pub type Row = (f64, [f64; CHANNELS.len()]);

/// What was recorded.
pub struct Recording {
    /// The samples.
    pub rows: Vec<Row>,
    /// How the connection was lost, if it was.
    pub lost: Option<ToolError>,
}

/// One measurement: address, length, and scale of a count.
#[derive(Clone, Copy)]
struct Source {
    reading: Reading,
    address: u32,
    bytes: u8,
    units_per_count: f64,
}

/// Records for `duration_s` of ECU time.
///
/// A connection that is lost on the way ends the recording.
///
/// # Errors
/// If the ECU refuses a command or does not answer at the start.
pub fn record(
    session: &mut Session,
    duration_s: f64,
    mut progress: impl FnMut(f64),
) -> Result<Recording, ToolError> {
    let sources = CHANNELS.map(|(_, reading)| source(reading));
    let tables = tables(&sources);
    set_up(session, &tables)?;
    session.command(&[0xDE, 1, 0, 0])?;
    let mut rows: Vec<Row> = Vec::new();
    let mut sample = Sample::default();
    while rows.last().is_none_or(|(time_s, _)| *time_s < duration_s) {
        let packet = session.packet(Instant::now() + SILENT_AFTER);
        let packet = match packet.and_then(|packet| packet.ok_or(ToolError::Silent)) {
            Ok(packet) => packet,
            Err(fault) if rows.is_empty() => return Err(fault),
            Err(fault) => {
                let lost = Some(fault);
                return Ok(Recording { rows, lost });
            }
        };
        if let Some((time_s, values)) = sample.take(&packet, &tables) {
            rows.push((time_s, values));
            progress(time_s);
        }
    }
    let lost = session.command(&[0xDE, 0, 0, 0]).err();
    Ok(Recording { rows, lost })
}

fn source(reading: Reading) -> Source {
    let (Reading::Value(measurement) | Reading::MeanOf(measurement)) = reading;
    let slot = INFO.iter().position(|info| info.name == measurement);
    let slot = slot.expect("the table of channels names measurements that there are");
    let info = &INFO[slot];
    Source {
        reading,
        address: MEASUREMENT_BASE + slot as u32 * SLOT_BYTES,
        bytes: match (reading, info.width) {
            (Reading::MeanOf(_), _) | (_, Width::U16 | Width::I16) => 2,
            (_, Width::U8) => 1,
            (_, Width::U32 | Width::I32) => 4,
        },
        units_per_count: 1.0 / f64::from(info.counts_per_unit),
    }
}

/// Distributes the sources over as many tables (one packet each) as needed; the first one also has the time.
fn tables(sources: &[Source]) -> Vec<Vec<Source>> {
    let mut tables: Vec<Vec<Source>> = Vec::new();
    let mut room = 0;
    for &source in sources {
        if tables.is_empty() || source.bytes > room {
            room = match tables.len() {
                0 => PAYLOAD_BYTES - TIME_BYTES,
                _ => PAYLOAD_BYTES,
            };
            tables.push(Vec::new());
        }
        room = room.saturating_sub(source.bytes);
        if let Some(table) = tables.last_mut() {
            table.push(source);
        }
    }
    tables
}

fn set_up(session: &mut Session, tables: &[Vec<Source>]) -> Result<(), ToolError> {
    let numbered = || (0u8..).zip(tables);
    session.command(&[0xD6])?;
    session.command(&[0xD5, 0, 1, 0])?;
    session.command(&[0xD4, 0, 0, 0, tables.len() as u8])?;
    for (number, table) in numbered() {
        session.command(&[0xD3, 0, 0, 0, number, table.len() as u8])?;
    }
    for (number, table) in numbered() {
        session.command(&[0xE2, 0, 0, 0, number, 0])?;
        for source in table {
            let [a, b, c, d] = source.address.to_le_bytes();
            session.command(&[0xE1, 0xFF, source.bytes, 0, a, b, c, d])?;
        }
    }
    let with_time = 0x10;
    session.command(&[0xE0, with_time, 0, 0, EVENT_EVERY_10_MS, 0, PRESCALER, 0])?;
    Ok(())
}

/// A sample under assembly from packets.
#[derive(Default)]
struct Sample {
    /// Time of this sample by the ECU's clock, which wraps.
    ticks: u32,
    /// Time and counts of the last complete sample.
    last: Option<(u32, Vec<i32>)>,
    /// Time since the first complete sample, s.
    time_s: f64,
    counts: Vec<i32>,
    next: usize,
}

impl Sample {
    fn take(&mut self, packet: &[u8], tables: &[Vec<Source>]) -> Option<Row> {
        let (&number, mut rest) = packet.split_first()?;
        let number = usize::from(number);
        if number == 0 {
            let (time, values) = rest.split_first_chunk()?;
            self.ticks = u32::from_le_bytes(*time);
            self.counts.clear();
            self.next = 0;
            rest = values;
        }
        // A lost table invalidates its sample.
        if number != self.next {
            self.next = usize::MAX;
            return None;
        }
        for source in tables.get(number)? {
            let (value, others) = rest.split_at_checked(usize::from(source.bytes))?;
            self.counts.push(counts(value));
            rest = others;
        }
        self.next += 1;
        if self.next < tables.len() {
            return None;
        }
        self.finish(tables)
    }

    /// The row of a complete sample; none for the first sample and after a gap too long for a valid mean.
    fn finish(&mut self, tables: &[Vec<Source>]) -> Option<Row> {
        let counts = std::mem::take(&mut self.counts);
        let (then, earlier) = self.last.replace((self.ticks, counts.clone()))?;
        let ticks = self.ticks.wrapping_sub(then);
        self.time_s += f64::from(ticks) * TICK_S;
        if ticks > LONGEST_TICKS {
            return None;
        }
        let sources = tables.iter().flatten();
        let values: Vec<f64> = sources
            .zip(counts.iter().zip(&earlier))
            .map(|(source, (&now, &then))| match source.reading {
                Reading::Value(_) => f64::from(now) * source.units_per_count,
                // Microcoulombs in microseconds are amperes.
                Reading::MeanOf(_) => f64::from(growth(then, now)) / f64::from(ticks.max(1)),
            })
            .collect();
        Some((self.time_s, values.try_into().ok()?))
    }
}

/// Increase of the low word of a charge.
fn growth(then: i32, now: i32) -> i32 {
    let [then, now] = [then, now].map(|count| count as u16);
    let grown = now.wrapping_sub(then).wrapping_add(LEAST_GROWTH);
    i32::from(grown) - i32::from(LEAST_GROWTH)
}

/// A signed number, little-endian; all recorded values are signed.
fn counts(bytes: &[u8]) -> i32 {
    match *bytes {
        [a, b] => i16::from_le_bytes([a, b]).into(),
        [a, b, c, d] => i32::from_le_bytes([a, b, c, d]),
        _ => bytes.first().copied().map_or(0, i32::from),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_charge_that_goes_round_or_loses_a_little_to_noise_still_gives_its_growth() {
        for (then, grown) in [(0, 35_000), (60_000, 30_000), (65_535, 0), (3, -5)] {
            assert_eq!(growth(then, then + grown), grown, "{then}");
        }
    }

    /// Packets of a sample: time, then the charges, then the others.
    fn packets(ticks: u32, charges: [u16; 2]) -> [Vec<u8>; 4] {
        let [lift, lower] = charges.map(u16::to_le_bytes);
        let milli = |value: i32| value.to_le_bytes().to_vec();
        [
            [&[0][..], &ticks.to_le_bytes(), &lift].concat(),
            [&[1][..], &lower, &milli(20_000)].concat(),
            [&[2][..], &milli(16_000)].concat(),
            [&[3][..], &milli(90_000)].concat(),
        ]
    }

    fn rows(packets: impl IntoIterator<Item = Vec<u8>>) -> Vec<Row> {
        let tables = tables(&CHANNELS.map(|(_, reading)| source(reading)));
        let mut sample = Sample::default();
        let taken = packets.into_iter();
        taken.filter_map(|p| sample.take(&p, &tables)).collect()
    }

    #[test]
    fn rows_have_the_mean_currents_between_samples() {
        let all = [
            packets(u32::MAX - 4_999, [65_000, 10]),
            packets(5_000, [14_464, 10]),
            packets(15_000, [14_464, 10]),
        ];
        let rows = rows(all.into_iter().flatten());
        assert_eq!(rows[0].1, [1.5, 0.0, 20.0, 16.0, 90.0]);
        assert_eq!(rows[1].1[0], 0.0);
        assert!((rows[1].0 - rows[0].0 - 0.01).abs() < 1e-9);
    }

    #[test]
    fn a_sample_of_which_a_packet_was_lost_is_none_and_leaves_none_after_it() {
        let mut all: Vec<Vec<u8>> = (0..5)
            .flat_map(|k| packets(10_000 * k, [(15_000 * k) as u16, 0]))
            .collect();
        all.remove(4 * 2 + 1);
        let times: Vec<f64> = rows(all).iter().map(|row| (row.0 * 1e3).round()).collect();
        assert_eq!(times, [10.0, 40.0]);
    }
}

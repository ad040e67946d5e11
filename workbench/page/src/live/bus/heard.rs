//! What a hitch on the bus has sent: samples, status, trouble codes.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use hitch_protocols::can::Frame;
use hitch_protocols::j1939::hitch::StatusMessage;
use hitch_protocols::j1939::trouble::Code;
use hitch_protocols::j1939::{GLOBAL, Id, Pgn};

use super::clock::SampleClock;
use super::measured::{Measured, SamplePairs};
use super::trouble_codes::TroubleCodes;

/// Silence after which a node, or a group, is missing: a hitch sends its status ten times a second.
pub const MISSING_AFTER: Duration = Duration::from_secs(2);
/// Time for which codes stay active without a repetition; they are repeated each second, or later if they are many.
const CODES_LAST: Duration = Duration::from_secs(4);
/// Number of kept samples: more than the strip charts show at the usual 50 Hz.
const MOST_SAMPLES: usize = 1_500;

/// A sample with its time on the axis of the monitor, s.
pub type TimedSample = (f64, Measured);

/// All that was received, since the start of the monitor.
#[derive(Debug)]
pub struct Heard {
    begun: Instant,
    /// Time of the last frame of any node.
    pub any: Option<Instant>,
    hitch: Option<Hitch>,
    measured: Option<Instant>,
    clock: SampleClock,
    pairs: SamplePairs,
    samples: VecDeque<TimedSample>,
    /// Number of all samples so far.
    count: u64,
}

/// The hitch that is followed: the first one, until it is silent.
#[derive(Debug)]
pub struct Hitch {
    /// Its address.
    pub source: u8,
    /// Its last status.
    pub status: StatusMessage,
    heard: Instant,
    receiver: TroubleCodes,
    codes: Option<(Instant, Vec<Code>)>,
}

impl Heard {
    /// Nothing yet; times count from `begun`.
    pub fn new(begun: Instant) -> Self {
        Self {
            begun,
            any: None,
            hitch: None,
            measured: None,
            clock: SampleClock::default(),
            pairs: SamplePairs::default(),
            samples: VecDeque::new(),
            count: 0,
        }
    }

    /// Processes a frame.
    pub fn receive(&mut self, frame: &Frame, now: Instant) {
        self.any = Some(now);
        let Some(id) = frame.extended_data_id().map(Id::unpack) else {
            return;
        };
        if id.destination != GLOBAL {
            return;
        }
        if let (Pgn::REAR_HITCH_STATUS, Some(bytes)) = (id.pgn, frame.eight()) {
            self.status(id.source, StatusMessage::from_bytes(bytes), now);
        }
        let hitch = self.hitch.as_mut();
        let Some(hitch) = hitch.filter(|hitch| hitch.source == id.source) else {
            return;
        };
        if let Some(codes) = hitch.receiver.receive(id.pgn, frame.data()) {
            hitch.codes = Some((now, codes));
        }
        if let (Pgn::HITCH_MOTION | Pgn::HITCH_PRESSURES, Some(bytes)) = (id.pgn, frame.eight()) {
            self.measured = Some(now);
            let samples = self.pairs.receive(id.pgn, bytes);
            for (ecu_ms, values) in samples.into_iter().flatten() {
                self.sample(ecu_ms, values, now);
            }
        }
    }

    fn status(&mut self, source: u8, status: StatusMessage, now: Instant) {
        match &mut self.hitch {
            Some(hitch) if hitch.source == source => {
                (hitch.status, hitch.heard) = (status, now);
            }
            Some(hitch) if now.duration_since(hitch.heard) < MISSING_AFTER => {}
            _ => {
                self.hitch = Some(Hitch {
                    source,
                    status,
                    heard: now,
                    receiver: TroubleCodes::default(),
                    codes: None,
                });
                self.pairs = SamplePairs::default();
                self.clock.restart();
            }
        }
    }

    fn sample(&mut self, ecu_ms: u16, values: Measured, now: Instant) {
        let now_s = now.duration_since(self.begun).as_secs_f64();
        let Some(time) = self.clock.at(ecu_ms, now_s) else {
            return;
        };
        let last_s = self.samples.back().map(|(time_s, _)| *time_s);
        if let (false, Some(last_s)) = (time.continues, last_s) {
            // Interrupts the lines of the strip charts.
            self.keep((last_s, Measured::default()));
        }
        self.keep((time.time_s, values));
    }

    fn keep(&mut self, sample: TimedSample) {
        if self.samples.len() == MOST_SAMPLES {
            self.samples.pop_front();
        }
        self.samples.push_back(sample);
        self.count += 1;
    }

    /// The kept samples after the first `known` of all; and the number of all.
    pub fn samples_after(&self, known: u64) -> (Vec<TimedSample>, u64) {
        let new = usize::try_from(self.count.saturating_sub(known)).unwrap_or(usize::MAX);
        let skipped = self.samples.len().saturating_sub(new);
        (
            self.samples.iter().skip(skipped).copied().collect(),
            self.count,
        )
    }

    /// The hitch, unless it is silent.
    pub fn hitch(&self, now: Instant) -> Option<&Hitch> {
        let hitch = self.hitch.as_ref();
        hitch.filter(|hitch| now.duration_since(hitch.heard) < MISSING_AFTER)
    }

    /// Whether measured values arrive.
    pub fn is_measured(&self, now: Instant) -> bool {
        is_recent(self.measured, now)
    }

    /// Whether any node sends.
    pub fn is_alive(&self, now: Instant) -> bool {
        is_recent(self.any, now)
    }
}

impl Hitch {
    /// Its active trouble codes.
    pub fn codes(&self, now: Instant) -> &[Code] {
        match &self.codes {
            Some((heard, codes)) if now.duration_since(*heard) < CODES_LAST => codes,
            _ => &[],
        }
    }
}

fn is_recent(heard: Option<Instant>, now: Instant) -> bool {
    heard.is_some_and(|heard| now.duration_since(heard) < MISSING_AFTER)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitch_protocols::j1939::{ExitCode, HitchStatus, LimitStatus};

    fn frame(source: u8, pgn: Pgn, bytes: [u8; 8]) -> Frame {
        let id = Id {
            priority: 6,
            pgn,
            destination: GLOBAL,
            source,
        };
        id.frame(bytes)
    }

    fn status(source: u8) -> Frame {
        let status = HitchStatus::default();
        let message = StatusMessage::new(&status, LimitStatus::OperatorLimited, ExitCode::Clear);
        frame(source, Pgn::REAR_HITCH_STATUS, message.to_bytes())
    }

    fn sample(source: u8, time_ms: u16) -> [Frame; 2] {
        let [low, high] = time_ms.to_le_bytes();
        let bytes = [0, 125, 0, 125, 0, 100, low, high];
        [Pgn::HITCH_MOTION, Pgn::HITCH_PRESSURES].map(|pgn| frame(source, pgn, bytes))
    }

    #[test]
    fn only_the_frames_of_one_hitch_count_until_it_is_silent() {
        let begun = Instant::now();
        let mut heard = Heard::new(begun);
        let at = |heard: &mut Heard, ms: u64, frames: &[Frame]| {
            let now = begun + Duration::from_millis(ms);
            frames.iter().for_each(|frame| heard.receive(frame, now));
        };
        at(&mut heard, 0, &sample(0x80, 0));
        assert_eq!(
            heard.samples_after(0).1,
            0,
            "no node has said that it is a hitch"
        );
        at(&mut heard, 10, &[status(0x80), status(0x81)]);
        at(&mut heard, 20, &sample(0x80, 20));
        at(&mut heard, 20, &sample(0x81, 520));
        let (samples, count) = heard.samples_after(0);
        assert_eq!((samples.len(), count), (1, 1));
        assert_eq!(samples[0].1.lift_a, Some(0.0));
        at(&mut heard, 3_000, &[status(0x81)]);
        at(&mut heard, 3_000, &sample(0x81, 3_500));
        let now = begun + Duration::from_millis(3_000);
        assert_eq!(heard.hitch(now).map(|hitch| hitch.source), Some(0x81));
        // After an empty sample, which interrupts the lines.
        let (samples, count) = heard.samples_after(count);
        assert_eq!((samples.len(), count), (2, 3));
        assert_eq!(samples[0].1, Measured::default());
        assert!((samples[1].0 - 3.0).abs() < 1e-9);
        assert!(heard.is_measured(now) && heard.is_alive(now));
        let later = now + MISSING_AFTER;
        assert!(heard.hitch(later).is_none() && !heard.is_alive(later));
    }
}

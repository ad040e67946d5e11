//! The calibration block: what a machine has been taught, as the ECU stores it.
//!
//! [`Calibration`] is raw: anything may stand in it. [`ValidCalibration`] is one whose checksum, version,
//! ranges and curves have been checked; the controller takes no other.

mod block;
pub mod calibration_words;
pub mod class;
pub mod design_parameters;
pub mod field_parameters;
pub mod fitted;
pub mod linkage;
pub mod nominal;
pub mod parameter;
pub mod valve_table;

use super::crc32::Crc32;
use super::fixed::Divisor;
use super::units::{MicroLitrePerSecond, MilliAmp, Millisecond};
pub use block::{CALIBRATION_BYTES, CALIBRATION_VERSION, Calibration};
use block::{CURRENT_LIMIT, FLOW_LIMIT};
use calibration_words::CALIBRATION_WORDS;
use linkage::{LINKAGE_POINTS, LinkageTable};
use parameter::OutOfRange;
use valve_table::{VALVE_POINTS, ValveTable};

/// Why a calibration is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CalibrationError {
    /// The block has another layout.
    Version {
        /// Version found.
        found: u32,
    },
    /// The checksum doesn't fit: the block is damaged or was never written.
    Checksum {
        /// Checksum stored.
        stored: u32,
        /// Checksum of what is there.
        computed: u32,
    },
    /// A scalar is outside its range.
    Parameter {
        /// The group it belongs to.
        group: &'static str,
        /// The scalar and what was found.
        what: OutOfRange,
    },
    /// A valve table has fewer than two or more than [`VALVE_POINTS`] points.
    ValveSize {
        /// `lift` or `lower`.
        valve: &'static str,
    },
    /// A valve table doesn't start at zero flow, doesn't rise strictly in flow and current, or leaves the range of
    /// either.
    ValvePoint {
        /// `lift` or `lower`.
        valve: &'static str,
        /// The offending point.
        index: usize,
    },
    /// A point of a valve table is closer to the one before it than [`ValveTable::least_gap`] in flow.
    ValveGap {
        /// `lift` or `lower`.
        valve: &'static str,
        /// The offending point.
        index: usize,
    },
    /// The linkage table's step isn't positive, or its travel doesn't rise strictly.
    Linkage {
        /// The offending point.
        index: usize,
    },
    /// Two limits are crossed.
    Crossed {
        /// The group they belong to.
        group: &'static str,
        /// The limit that should be lower.
        low: &'static str,
        /// The limit that should be higher.
        high: &'static str,
    },
    /// `sensors.angle_lag` is too long for the onset speeds of `safety`: before motion is detected, a frozen angle would
    /// cost more than 5 degrees beyond what it does without a lag.
    AngleLag {
        /// What was found.
        found: Millisecond,
        /// Longest lag with these onset speeds.
        most: Millisecond,
    },
}

/// A calibration that has been checked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ValidCalibration(Calibration);

impl core::ops::Deref for ValidCalibration {
    type Target = Calibration;
    fn deref(&self) -> &Calibration {
        &self.0
    }
}

#[cfg(any(test, feature = "damage"))]
impl ValidCalibration {
    /// Flips a bit, as failing memory does.
    pub fn flip(&mut self, word: usize, bit: u32) {
        let mut index = 0;
        self.0.for_each_word(&mut |value| {
            *value ^= if index == word { 1 << bit } else { 0 };
            index += 1;
        });
    }
}

impl ValidCalibration {
    /// The calibration of an untaught machine.
    #[must_use]
    pub fn nominal() -> Self {
        // It passes validation, as a test says; there is nothing better to fall back to.
        Self(Calibration::nominal())
    }
}

impl Calibration {
    /// The calibration of an untaught machine, sealed.
    #[must_use]
    pub fn nominal() -> Self {
        Self::unsealed_nominal().sealed()
    }

    /// The same block with the checksum that belongs to it.
    #[must_use]
    pub fn sealed(mut self) -> Self {
        self.checksum = self.computed_checksum();
        self
    }

    /// Checks everything.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn validate(mut self) -> Result<ValidCalibration, CalibrationError> {
        if self.version != CALIBRATION_VERSION {
            return Err(CalibrationError::Version {
                found: self.version,
            });
        }
        let computed = self.computed_checksum();
        if self.checksum != computed {
            return Err(CalibrationError::Checksum {
                stored: self.checksum,
                computed,
            });
        }
        self.check()?;
        Ok(ValidCalibration(self))
    }

    /// Seals the block, if everything but the seal is right: the checksum is reckoned only once.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn seal(mut self) -> Result<ValidCalibration, CalibrationError> {
        self.version = CALIBRATION_VERSION;
        self.checksum = self.computed_checksum();
        self.check()?;
        Ok(ValidCalibration(self))
    }

    /// The block of these words, sealed if everything but version and seal is right. The checksum is of the words at hand:
    /// visiting those of the block costs as much as the checksum.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn seal_words(
        words: &[i32; CALIBRATION_WORDS],
    ) -> Result<ValidCalibration, CalibrationError> {
        let mut digest = Crc32::default();
        digest.update(&CALIBRATION_VERSION.to_le_bytes());
        for word in words.iter().take(CALIBRATION_WORDS - 1).skip(1) {
            digest.update(&word.to_le_bytes());
        }
        let mut block = Self::from_words(words);
        block.version = CALIBRATION_VERSION;
        block.checksum = digest.value();
        block.check()?;
        Ok(ValidCalibration(block))
    }

    /// Checks what is in a block that is sealed. By reference: a block that is handed on is a copy of it on the stack.
    fn check(&mut self) -> Result<(), CalibrationError> {
        self.check_parameters()?;
        check_valve("lift", &self.lift)?;
        check_valve("lower", &self.lower)?;
        check_linkage(&self.linkage)?;
        self.check_order()?;
        self.check_angle_lag()
    }

    /// By the ranges that tools are held to as well.
    fn check_parameters(&mut self) -> Result<(), CalibrationError> {
        match calibration_words::scalar_out_of_range(self) {
            Some((group, what)) => Err(CalibrationError::Parameter { group, what }),
            None => Ok(()),
        }
    }

    /// Limits that only make sense in one order.
    fn check_order(&self) -> Result<(), CalibrationError> {
        macro_rules! pairs {
            ($($group:ident: $low:ident < $high:ident;)+) => {[$((
                (stringify!($group), stringify!($low), stringify!($high)),
                self.$group.$low.0 < self.$group.$high.0,
            )),+]};
        }
        let pairs = pairs! {
            position: lower_limit < upper_limit;
            position: stop_band < restart_band;
            sensors: angle_min < angle_max;
            sensors: lever_min < lever_max;
            operator: float_lever < float_exit;
            current: lowest_resistance < highest_resistance;
            safety: supply_min < supply_max;
            safety: sensor_supply_min < sensor_supply_max;
            remote: lowest < highest;
            ride: end_speed < begin_speed;
            hydraulics: smallest_drop < largest_drop;
        };
        match pairs.into_iter().find(|(_, is_in_order)| !is_in_order) {
            Some(((group, low, high), _)) => Err(CalibrationError::Crossed { group, low, high }),
            None => Ok(()),
        }
    }

    /// While the sensor has yet to show a motion, the hitch goes on with an onset speed: lag times speed is at most the 5
    /// degrees that a time of the envelope may allow.
    fn check_angle_lag(&self) -> Result<(), CalibrationError> {
        /// 5 degrees at 1.92 mm a degree, in nm.
        const EXTRA_TRAVEL: i32 = 9_600_000;
        let safety = &self.safety;
        let speed = safety.lift_onset_speed.max(safety.lower_onset_speed);
        let found = self.sensors.angle_lag;
        // A speed in um/s is the way of a millisecond in nm.
        let most = Divisor::at_least_one(speed.0).quotient(EXTRA_TRAVEL.unsigned_abs());
        let most = Millisecond(most.cast_signed());
        if found > most {
            Err(CalibrationError::AngleLag { found, most })
        } else {
            Ok(())
        }
    }

    /// The memory image, words in little-endian order.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; CALIBRATION_BYTES] {
        let mut bytes = [0; CALIBRATION_BYTES];
        let targets = bytes.chunks_exact_mut(4);
        for (target, word) in targets.zip(self.to_words()) {
            target.copy_from_slice(&word.to_le_bytes());
        }
        bytes
    }

    /// The block of a memory image; nothing of it is checked.
    #[must_use]
    pub fn from_bytes(bytes: &[u8; CALIBRATION_BYTES]) -> Self {
        let mut words = [0; CALIBRATION_WORDS];
        for (word, source) in words.iter_mut().zip(bytes.as_chunks::<4>().0) {
            *word = i32::from_le_bytes(*source);
        }
        Self::from_words(&words)
    }

    /// The block is not changed.
    fn computed_checksum(&mut self) -> u32 {
        let mut digest = Crc32::default();
        let mut words_left = CALIBRATION_BYTES / 4 - 1;
        self.for_each_word(&mut |word| {
            if words_left > 0 {
                words_left -= 1;
                digest.update(&word.to_le_bytes());
            }
        });
        digest.value()
    }

    /// Visits every word in the order of the memory image. Not inlined: it is long and
    /// has many callers.
    #[inline(never)]
    pub(super) fn for_each_word(&mut self, visit: &mut dyn FnMut(&mut i32)) {
        // Hides from the compiler which visitor it is. It would make a copy for each visitor and inline the visitor at every
        // word: 44 KB of flash with version 6 of the block.
        let visit = core::hint::black_box(visit);
        visit_unsigned(&mut self.version, visit);
        visit_valve(&mut self.lift, visit);
        visit_valve(&mut self.lower, visit);
        visit(&mut self.linkage.first_angle.0);
        visit(&mut self.linkage.angle_step.0);
        self.linkage
            .travel
            .iter_mut()
            .for_each(|point| visit(&mut point.0));
        self.visit_scalars(visit);
        visit_unsigned(&mut self.checksum, visit);
    }
}

fn visit_unsigned(word: &mut u32, visit: &mut dyn FnMut(&mut i32)) {
    let mut signed = word.cast_signed();
    visit(&mut signed);
    *word = signed.cast_unsigned();
}

fn visit_valve(table: &mut ValveTable, visit: &mut dyn FnMut(&mut i32)) {
    visit_unsigned(&mut table.count, visit);
    for point in &mut table.points {
        visit(&mut point.flow.0);
        visit(&mut point.current.0);
    }
}

fn check_valve(valve: &'static str, table: &ValveTable) -> Result<(), CalibrationError> {
    let points = table.used();
    if points.len() < 2 || usize::try_from(table.count) != Ok(points.len()) {
        return Err(CalibrationError::ValveSize { valve });
    }
    let gap = table.least_gap();
    let mut last = None;
    for (index, &point) in points.iter().enumerate() {
        let rises = last.is_none_or(|last: valve_table::ValvePoint| {
            point.flow > last.flow && point.current > last.current
        });
        let starts = index > 0 || point.flow == MicroLitrePerSecond::ZERO;
        let in_range = point.flow <= FLOW_LIMIT
            && point.current >= MilliAmp::ZERO
            && point.current <= CURRENT_LIMIT;
        if !(rises && starts && in_range) {
            return Err(CalibrationError::ValvePoint { valve, index });
        }
        if last.is_some_and(|last| point.flow - last.flow < gap) {
            return Err(CalibrationError::ValveGap { valve, index });
        }
        last = Some(point);
    }
    Ok(())
}

fn check_linkage(linkage: &LinkageTable) -> Result<(), CalibrationError> {
    const FULL_TURN: i32 = 360_000;
    let step = linkage.angle_step.0;
    if !(1..=FULL_TURN).contains(&step) || linkage.first_angle.magnitude().0 > FULL_TURN {
        return Err(CalibrationError::Linkage { index: 0 });
    }
    let pairs = linkage.travel.iter().zip(linkage.travel.iter().skip(1));
    match pairs
        .into_iter()
        .position(|(lower, higher)| higher <= lower)
    {
        Some(index) => Err(CalibrationError::Linkage {
            index: index.saturating_add(1),
        }),
        None => Ok(()),
    }
}

const _: () = assert!(LINKAGE_POINTS >= 2 && VALVE_POINTS >= 2);
const _: () = assert!(CALIBRATION_BYTES.is_multiple_of(4));

//! The table of the envelope: what trips it, after how long, and whether that can be cleared.

use super::super::design_parameters::SafetyParameters;
use super::super::mode::Fault;
use super::super::units::Millisecond;

/// Number of rows.
pub const ROWS: usize = 20;

/// What tripped the envelope, with the code it has on links and in traces; the order of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Trip {
    /// No fresh command.
    Stale = 1,
    /// Both coils were asked for.
    BothCoils = 2,
    /// A step began too late or too early.
    Overrun = 3,
    /// The supply voltage is outside its limits.
    Supply = 4,
    /// The lever signal is missing or out of range.
    Lever = 5,
    /// The angle signal is missing or out of range.
    AngleMissing = 6,
    /// The angle signal jumps further than a hitch can move.
    AngleJumps = 7,
    /// The angle signal stands still to the last bit although the coil's current must have moved the hitch.
    AngleFrozen = 8,
    /// The angle signal is far noisier than its sensor.
    AngleNoisy = 9,
    /// The angle signal shows less travel than the coil's current must have caused.
    NotFollowing = 10,
    /// The hitch moves against the energised coil: coils or sensor are swapped.
    Against = 11,
    /// A coil has less current than it should: its wire is broken.
    CoilOpen = 12,
    /// A coil has more current than it should: it is shorted.
    CoilShort = 13,
    /// A coil has current although it is off: its driver is stuck.
    CoilStuck = 14,
    /// The converters' reference is off: currents and voltages can't be trusted.
    Reference = 15,
    /// The supply of the sensors is outside its limits.
    SensorSupply = 16,
    /// The tracks of the angle sensor disagree, or one of them is missing.
    AngleTracks = 17,
    /// The main clock has another rate than at the start.
    Clock = 18,
    /// The enable line of the coils' drivers: its read-back differs from its command.
    EnableLine = 19,
    /// The calibration in use no longer has its checksum: memory has lost a bit.
    Memory = 20,
}

impl Trip {
    /// The rows in their order.
    pub const ALL: [Self; ROWS] = [
        Self::Stale,
        Self::BothCoils,
        Self::Overrun,
        Self::Supply,
        Self::Lever,
        Self::AngleMissing,
        Self::AngleJumps,
        Self::AngleFrozen,
        Self::AngleNoisy,
        Self::NotFollowing,
        Self::Against,
        Self::CoilOpen,
        Self::CoilShort,
        Self::CoilStuck,
        Self::Reference,
        Self::SensorSupply,
        Self::AngleTracks,
        Self::Clock,
        Self::EnableLine,
        Self::Memory,
    ];

    /// True if only a restart clears it: the driver has to be tested, or the calibration read from flash, before it is
    /// trusted again.
    #[must_use]
    pub const fn is_final(self) -> bool {
        matches!(
            self,
            Self::CoilShort | Self::CoilStuck | Self::EnableLine | Self::Memory
        )
    }

    /// How long the row has to hold.
    fn time(self, parameters: &SafetyParameters) -> Millisecond {
        match self {
            Self::Stale => parameters.command_age,
            Self::Overrun => parameters.overrun_time,
            Self::Lever | Self::AngleMissing | Self::AngleJumps => parameters.sensor_time,
            Self::CoilOpen => parameters.open_time,
            Self::CoilShort | Self::CoilStuck => parameters.short_time,
            Self::Reference => parameters.reference_time,
            Self::SensorSupply => parameters.sensor_supply_time,
            Self::AngleTracks => parameters.track_time,
            Self::Clock => parameters.clock_time,
            // Both coils are never right, and the watches of the others measure the time themselves.
            Self::BothCoils
            | Self::Supply
            | Self::AngleFrozen
            | Self::AngleNoisy
            | Self::NotFollowing
            | Self::Against
            | Self::EnableLine
            | Self::Memory => Millisecond(1),
        }
    }

    /// The fault that the controller reports for it.
    #[must_use]
    pub const fn fault(self) -> Fault {
        match self {
            Self::Lever => Fault::Lever,
            Self::AngleMissing
            | Self::AngleJumps
            | Self::AngleFrozen
            | Self::AngleNoisy
            | Self::AngleTracks => Fault::Angle,
            Self::NotFollowing => Fault::NotFollowing,
            Self::Stale | Self::BothCoils | Self::Against => Fault::Envelope,
            Self::Overrun | Self::Clock => Fault::Overrun,
            Self::Reference => Fault::Reference,
            Self::SensorSupply => Fault::SensorSupply,
            Self::EnableLine => Fault::EnableLine,
            Self::Memory => Fault::Memory,
            Self::Supply => Fault::Supply,
            Self::CoilOpen | Self::CoilShort | Self::CoilStuck => Fault::Coil,
        }
    }
}

/// Rows that hold in a step: a bit each, the first row is bit 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rows(u32);

impl Rows {
    /// The rows of a list of conditions in the order of the table.
    #[must_use]
    pub fn of(holds: [bool; ROWS]) -> Self {
        let bits = holds.into_iter().rev().fold(0_u32, |bits, holds| {
            (bits << 1).saturating_add(u32::from(holds))
        });
        Self(bits)
    }

    const fn has(self, row: u32) -> bool {
        self.0 >> (row & 31) & 1 == 1
    }

    /// True if one of these holds.
    #[must_use]
    pub fn has_any(self, rows: &[Trip]) -> bool {
        // The first row is bit 0.
        rows.iter()
            .any(|&row| self.has((row as u32).saturating_sub(1)))
    }
}

/// How long each row has been holding.
///
/// A step in which a row holds counts two up, one in which it doesn't counts one down: what comes and goes trips
/// too, if it is there for more than a third of the time. A step that is out of time counts as many times as it has lost
/// milliseconds: no step looked at the machine in them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Debounce {
    counts: [i32; ROWS],
    /// Rows whose count isn't zero.
    counting: Rows,
}

impl Debounce {
    /// One step, which has lost `lost` if it is out of time; the first row that has been holding for its time, a final
    /// one before all others.
    pub fn judge(
        &mut self,
        holds: Rows,
        lost: Millisecond,
        parameters: &SafetyParameters,
    ) -> Option<Trip> {
        let mut found = None;
        // In a healthy machine there is none to do.
        let mut to_do = holds.0 | self.counting.0;
        while to_do != 0 {
            // The last one looked at is the first of the table.
            let row = 31_u32.saturating_sub(to_do.leading_zeros());
            to_do &= !(1 << (row & 31));
            // There are no more rows than these.
            let trip = Trip::ALL[row as usize % ROWS];
            let held = match trip {
                _ if !holds.has(row) => Millisecond::ZERO,
                Trip::Overrun => lost,
                _ => Millisecond(1),
            };
            let first = self.count(row, held, parameters);
            found = match found.is_some_and(Trip::is_final) {
                true => first.filter(|trip| trip.is_final()).or(found),
                false => first.or(found),
            };
        }
        found
    }

    /// Counts one row that has held for `held` since the last step; what it stands for if it has been holding for its
    /// time.
    fn count(
        &mut self,
        row: u32,
        held: Millisecond,
        parameters: &SafetyParameters,
    ) -> Option<Trip> {
        let index = row as usize % ROWS;
        let (count, trip) = (&mut self.counts[index], Trip::ALL[index]);
        let most = trip.time(parameters).0.max(1).saturating_mul(2);
        *count = match held > Millisecond::ZERO {
            true => count.saturating_add(held.0.saturating_mul(2)).min(most),
            false => count.saturating_sub(1).max(0),
        };
        let bit = 1 << (row & 31);
        match *count > 0 {
            true => self.counting.0 |= bit,
            false => self.counting.0 &= !bit,
        }
        Some(trip).filter(|_| *count >= most)
    }

    /// True if no row holds, nor has lately.
    #[must_use]
    pub fn is_calm(&self) -> bool {
        self.counting == Rows::default()
    }
}

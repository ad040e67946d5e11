//! The table of the envelope: what trips it, after how long, and whether that can be cleared.

use hitch_quantities::Trip;
use hitch_quantities::calibration::design_parameters::SafetyParameters;
use hitch_quantities::signals::trip::ROWS;
use hitch_quantities::units::Millisecond;

/// How long a row has to hold.
fn time(trip: Trip, parameters: &SafetyParameters) -> Millisecond {
    match trip {
        Trip::Stale => parameters.command_age,
        Trip::Overrun => parameters.overrun_time,
        Trip::Lever | Trip::AngleMissing | Trip::AngleJumps => parameters.sensor_time,
        Trip::CoilOpen => parameters.open_time,
        Trip::CoilShort | Trip::CoilStuck => parameters.short_time,
        Trip::Reference => parameters.reference_time,
        Trip::SensorSupply => parameters.sensor_supply_time,
        Trip::AngleTracks => parameters.track_time,
        Trip::Clock => parameters.clock_time,
        Trip::BeyondLimit | Trip::Ride => parameters.limit_time,
        // Both coils are never right, and the watches of the others measure the time themselves.
        Trip::BothCoils
        | Trip::Supply
        | Trip::AngleFrozen
        | Trip::AngleNoisy
        | Trip::NotFollowing
        | Trip::Against
        | Trip::EnableLine
        | Trip::Memory
        | Trip::NoConsent => Millisecond(1),
    }
}

/// Rows that hold in a step: a bit each, the first row is bit 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rows(u32);

impl Rows {
    /// The rows whose condition holds, of a list of all conditions.
    #[must_use]
    pub fn of(conditions: [(Trip, bool); ROWS]) -> Self {
        let holding = conditions.into_iter().filter(|(_, holds)| *holds);
        Self(holding.fold(0, |bits, (row, _)| bits | 1 << index(row)))
    }

    const fn has(self, row: u32) -> bool {
        self.0 >> (row & 31) & 1 == 1
    }

    /// True if one of these holds.
    #[must_use]
    pub fn has_any(self, rows: &[Trip]) -> bool {
        rows.iter().any(|&row| self.has(index(row)))
    }
}

/// Bit of a row: the first row is bit 0.
const fn index(row: Trip) -> u32 {
    (row as u32).saturating_sub(1) & 31
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
            found = if found.is_some_and(Trip::is_final) {
                first.filter(|trip| trip.is_final()).or(found)
            } else {
                first.or(found)
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
        let most = time(trip, parameters).0.max(1).saturating_mul(2);
        *count = if held > Millisecond::ZERO {
            count.saturating_add(held.0.saturating_mul(2)).min(most)
        } else {
            count.saturating_sub(1).max(0)
        };
        let bit = 1 << (row & 31);
        if *count > 0 {
            self.counting.0 |= bit
        } else {
            self.counting.0 &= !bit
        }
        Some(trip).filter(|_| *count >= most)
    }

    /// True if no row holds, nor has lately.
    #[must_use]
    pub fn is_calm(&self) -> bool {
        self.counting == Rows::default()
    }
}

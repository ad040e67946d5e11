//! The enable line of the coil drivers: tested before its first use, and monitored by its read-back afterwards.
//!
//! ```text
//!  power-up   +-----+  low for SETTLING   +----------+  first drive   +--------+  high after SETTLING   +--------+
//! ----------> | Low | ------------------> | Untested | -------------> | Raised | ---------------------> | Proven |
//!             +-----+                     +----------+                +--------+                        +--------+
//!                |                             |                          |  pulses at zero                  |
//!                +-----------------------------+--------------------------+----------------------------------+
//!                                              |  read-back differs for SETTLING
//!                                              v
//!                                          +--------+
//!                                          | Faulty |  until restart
//!                                          +--------+
//! ```
//!
//! A line that is stuck low is safe. One that is stuck high disables the second switch-off path, which is visible only
//! while the line is commanded low. Both levels therefore have to be read back before the first current.

use hitch_quantities::units::Millisecond;

use super::drive::{Compare, Drive};

/// Time for which the read-back has to agree, or may disagree: much longer than the delay of a driver's enable
/// input with its filter, and shorter than the response of a spool.
const SETTLING: Millisecond = Millisecond(5);

/// State of the test.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum EnableLineState {
    /// Low since power-up.
    #[default]
    Low,
    /// Low, confirmed by read-back.
    Untested,
    /// First time high, with both pulse widths at zero.
    Raised,
    /// Both levels confirmed.
    Proven,
    /// Its read-back differs from its command.
    Faulty,
}

/// Tests and monitors the line.
#[derive(Clone, Copy, Debug, Default)]
pub struct EnableLine {
    state: EnableLineState,
    /// Commanded level of the last millisecond.
    asked: bool,
    /// Time for which the read-back has agreed in the present state.
    agreed_for: Millisecond,
    /// Time for which it has disagreed.
    differed_for: Millisecond,
}

impl EnableLine {
    /// Start of a millisecond: processes the read-back of the line; a board without read-back counts as healthy.
    /// Returns whether the line is faulty.
    pub fn read(&mut self, feedback: Option<bool>) -> bool {
        let Some(level) = feedback else {
            return self.state == EnableLineState::Faulty;
        };
        let agrees = level == self.asked;
        self.agreed_for = self.agreed_for.counted_while(agrees);
        self.differed_for = self.differed_for.counted_while(!agrees);
        let settled = self.agreed_for >= SETTLING;
        self.state = match self.state {
            _ if self.differed_for >= SETTLING => EnableLineState::Faulty,
            EnableLineState::Low if settled => EnableLineState::Untested,
            EnableLineState::Raised if settled => EnableLineState::Proven,
            state => state,
        };
        self.state == EnableLineState::Faulty
    }

    /// The drive that is output for the requested one.
    pub fn pass(&mut self, wanted: Drive, has_feedback: bool) -> Drive {
        let drive = match self.state {
            EnableLineState::Faulty => Drive::OFF,
            _ if !has_feedback => wanted,
            EnableLineState::Low => Drive::OFF,
            EnableLineState::Untested if wanted.enable => {
                self.state = EnableLineState::Raised;
                self.agreed_for = Millisecond::ZERO;
                RAISED
            }
            EnableLineState::Raised if wanted.enable => RAISED,
            EnableLineState::Raised => {
                // Switched off before the line was proven: it is tested again with the next drive.
                self.state = EnableLineState::Untested;
                Drive::OFF
            }
            EnableLineState::Untested | EnableLineState::Proven => wanted,
        };
        self.asked = drive.enable;
        drive
    }
}

/// The line without pulses.
const RAISED: Drive = Drive {
    lift: Compare::OFF,
    lower: Compare::OFF,
    enable: true,
};

#[cfg(test)]
mod tests {
    use hitch_quantities::units::Duty;

    use super::*;

    fn wanted() -> Drive {
        Drive {
            lift: Compare::of(Duty(40_000), 5_250),
            lower: Compare::OFF,
            enable: true,
        }
    }

    /// Simulates a line with level `level(asked)`; returns the drive of each millisecond and whether the line was
    /// faulty at its start.
    fn run(
        line: &mut EnableLine,
        drives: &[Drive],
        level: impl Fn(bool) -> bool,
    ) -> std::vec::Vec<(Drive, bool)> {
        let mut asked = line.asked;
        drives
            .iter()
            .map(|&drive| {
                let faulty = line.read(Some(level(asked)));
                let given = line.pass(drive, true);
                asked = given.enable;
                (given, faulty)
            })
            .collect()
    }

    #[test]
    fn the_first_drive_waits_until_the_line_was_seen_low_and_high() {
        let mut line = EnableLine::default();
        let given = run(&mut line, &[wanted(); 20], |asked| asked);
        let drives: std::vec::Vec<Drive> = given.iter().map(|(drive, _)| *drive).collect();
        assert_eq!(drives[..4], [Drive::OFF; 4]);
        assert_eq!(drives[4..9], [RAISED; 5]);
        assert_eq!(drives[9..], [wanted(); 11]);
        assert!(given.iter().all(|(_, faulty)| !faulty));
        run(&mut line, &[Drive::OFF; 100], |asked| asked);
        let again = run(&mut line, &[wanted()], |asked| asked);
        assert_eq!(again[0], (wanted(), false), "tested once");
    }

    #[test]
    fn a_line_that_is_stuck_gets_no_pulse_until_restart() {
        for stuck in [false, true] {
            let mut line = EnableLine::default();
            let given = run(&mut line, &[wanted(); 100], |_| stuck);
            assert!(given.iter().all(|(drive, _)| drive.lift == Compare::OFF));
            assert!(given[20..].iter().all(|given| *given == (Drive::OFF, true)));
            let healed = run(&mut line, &[wanted(); 1_000], |asked| asked);
            assert!(healed.iter().all(|given| *given == (Drive::OFF, true)));
        }
    }

    #[test]
    fn a_read_back_that_disagrees_in_operation_trips_after_its_time() {
        for stuck in [false, true] {
            let mut line = EnableLine::default();
            run(&mut line, &[wanted(); 20], |asked| asked);
            let drive = if stuck { Drive::OFF } else { wanted() };
            run(&mut line, &[drive; 20], |asked| asked);
            let given = run(&mut line, &[drive; 20], |_| stuck);
            let tripped = given.iter().position(|(_, faulty)| *faulty);
            assert_eq!(tripped, Some(SETTLING.0 as usize - 1), "{stuck}");
            let mut line = EnableLine::default();
            run(&mut line, &[wanted(); 20], |asked| asked);
            run(&mut line, &[drive; 20], |asked| asked);
            run(&mut line, &[drive; 4], |_| stuck);
            let given = run(&mut line, &[drive; 20], |asked| asked);
            assert!(given.iter().all(|(_, faulty)| !faulty), "a short glitch");
        }
    }

    #[test]
    fn a_board_without_a_read_back_is_trusted() {
        let mut line = EnableLine::default();
        assert!(!line.read(None));
        assert_eq!(line.pass(wanted(), false), wanted());
    }
}

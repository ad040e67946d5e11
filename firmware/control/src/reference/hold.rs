//! The depth that is held after a function has ended, until the lever takes over.
//!
//! A function that the operator has switched off may be selected again, which resumes it; one that has ended with its sensor is not.
//!
//! The lever takes over as after any lock, when it is moved through the hitch, and also when it is raised above it: whoever
//! raises the lever wants the hitch to rise.

use hitch_quantities::calibration::design_parameters::LockParameters;
use hitch_quantities::units::MilliDegree;

use crate::operator::lock::StartLock;

/// A held depth.
#[derive(Clone, Copy, Debug)]
pub struct Hold {
    at: MilliDegree,
    lever_then: MilliDegree,
    lock: StartLock,
    resumes: bool,
}

impl Hold {
    /// Holds a set point from now on, with the lever where it is. `resumes`: selecting a function ends it as well.
    #[must_use]
    pub fn new(at: MilliDegree, lever: MilliDegree, resumes: bool) -> Self {
        Self {
            at,
            lever_then: lever,
            lock: StartLock::default(),
            resumes,
        }
    }

    /// Whether selecting a function ends it.
    #[must_use]
    pub const fn resumes(&self) -> bool {
        self.resumes
    }

    /// The held set point.
    #[must_use]
    pub const fn set_point(&self) -> MilliDegree {
        self.at
    }

    /// One step; true once the lever has taken over.
    pub fn is_over(&mut self, lever: MilliDegree, parameters: &LockParameters) -> bool {
        let raised = lever - self.lever_then >= parameters.lever_movement && lever > self.at;
        self.lock.picked_up(lever, self.at, parameters) || raised
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PARAMETERS: LockParameters = LockParameters::NOMINAL;

    fn ends(at: i32, levers: impl Iterator<Item = i32>) -> bool {
        let mut levers = levers.map(MilliDegree);
        let mut hold = Hold::new(MilliDegree(at), levers.next().unwrap(), false);
        levers.any(|lever| hold.is_over(lever, &PARAMETERS))
    }

    #[test]
    fn a_lever_at_rest_or_moved_away_below_takes_nothing_over() {
        assert!(!ends(60_000, (0..5_000).map(|step| 65_000 + step % 50)));
        assert!(!ends(60_000, (0..2_000).map(|step| 55_000 - 5 * step)));
    }

    #[test]
    fn a_lever_that_passes_the_hitch_or_rises_above_it_takes_over() {
        assert!(ends(60_000, (0..2_000).map(|step| 65_000 - 5 * step)));
        assert!(ends(60_000, (0..2_000).map(|step| 65_000 + step)));
        assert!(ends(60_000, (0..2_000).map(|step| 55_000 + 5 * step)));
    }
}

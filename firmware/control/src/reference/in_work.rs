//! In-work state: whether the implement works.
//!
//! ISO 11783-7 calls it the position of the hitch below or above a threshold. A hitch that works moves about its depth, so
//! there are two thresholds, and between them the draft decides:
//!
//! ```text
//! angle           work.angle       work.angle + work.band
//! ------------------|--------------------|----------------
//!      in work      |  draft: in soil    |  out of work
//!                   |  no draft: stays   |
//! ```
//!
//! The draft has a hysteresis of its own ([`super::draft_signal`]). At a stand there is no draft, but the position.

use hitch_quantities::calibration::field_parameters::WorkParameters;
use hitch_quantities::units::MilliDegree;

/// The state from step to step.
#[derive(Clone, Copy, Debug, Default)]
pub struct InWork {
    last: bool,
    /// That of this step; `None` without a threshold or an angle.
    now: Option<bool>,
}

impl InWork {
    /// One step. `in_soil`: what the draft says; `None` without plausible pins.
    pub fn step(
        &mut self,
        angle: Option<MilliDegree>,
        in_soil: Option<bool>,
        parameters: &WorkParameters,
    ) {
        let angle = angle.filter(|_| parameters.angle > MilliDegree::ZERO);
        self.now = angle.map(|angle| {
            if angle <= parameters.angle {
                true
            } else if angle > parameters.angle + parameters.band {
                false
            } else {
                in_soil.unwrap_or(self.last)
            }
        });
        self.last = self.now.unwrap_or(self.last);
    }

    /// Whether the implement works; `None` if that is not known.
    #[must_use]
    pub const fn now(&self) -> Option<bool> {
        self.now
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SET: WorkParameters = WorkParameters {
        angle: MilliDegree(95_000),
        ..WorkParameters::NOMINAL
    };

    fn states(
        angles_deg: &[i32],
        in_soil: Option<bool>,
        parameters: &WorkParameters,
    ) -> std::vec::Vec<Option<bool>> {
        let mut state = InWork::default();
        let step = |angle_deg: &i32| {
            state.step(Some(MilliDegree(angle_deg * 1_000)), in_soil, parameters);
            state.now()
        };
        angles_deg.iter().map(step).collect()
    }

    #[test]
    fn position_alone_has_a_hysteresis() {
        let found = states(&[110, 98, 95, 98, 100, 101, 98], None, &SET);
        let expected = [false, false, true, true, true, false, false];
        assert_eq!(found, expected.map(Some));
    }

    #[test]
    fn between_the_thresholds_the_draft_decides_and_beyond_them_it_does_not() {
        for in_soil in [false, true] {
            let found = states(&[110, 98, 90, 98, 110], Some(in_soil), &SET);
            assert_eq!(found, [false, in_soil, true, in_soil, false].map(Some));
        }
    }

    #[test]
    fn without_a_threshold_or_an_angle_it_is_not_known_and_a_gap_changes_nothing() {
        assert_eq!(
            states(&[50, 130], Some(true), &WorkParameters::NOMINAL),
            [None; 2]
        );
        let mut state = InWork::default();
        for (angle, expected) in [
            (Some(90_000), Some(true)),
            (None, None),
            (Some(98_000), Some(true)),
        ] {
            state.step(angle.map(MilliDegree), None, &SET);
            assert_eq!(state.now(), expected);
        }
    }
}

//! Plausibility of the sensors of draft and depth.
//!
//! A sample that may be wrong is not used: the signal is [`Signal::Suspect`] until the sensor is plausible again or has been
//! implausible for `check_time`. It is lost then, until it has been plausible for `healthy_time`.

use hitch_quantities::Trouble;
use hitch_quantities::calibration::field_parameters::DraftParameters;
use hitch_quantities::units::{Millisecond, SupplyShare};

/// A quantity in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Signal<Q> {
    /// Filtered quantity.
    Measured(Q),
    /// The sensor is implausible, but not for long enough to be lost.
    #[default]
    Suspect,
    /// The sensor is lost.
    Lost(Trouble),
}

impl<Q: Copy> Signal<Q> {
    /// The quantity, if the sensor is plausible.
    #[must_use]
    pub const fn measured(self) -> Option<Q> {
        match self {
            Self::Measured(quantity) => Some(quantity),
            Self::Suspect | Self::Lost(_) => None,
        }
    }

    /// Why the sensor is lost.
    #[must_use]
    pub const fn trouble(self) -> Option<Trouble> {
        match self {
            Self::Lost(trouble) => Some(trouble),
            Self::Measured(_) | Self::Suspect => None,
        }
    }
}

/// Plausibility from step to step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Plausibility {
    implausible_for: Millisecond,
    healthy_for: Millisecond,
    lost: Option<Trouble>,
}

impl Plausibility {
    /// One step: the quantity of a sample that is used, and whether it is the first one after a loss. `still`: for how long the
    /// sample has been the same where it should change, and the trouble that this is.
    pub fn step<Q>(
        &mut self,
        sample: Result<Q, Trouble>,
        (still, frozen): (Millisecond, Trouble),
        parameters: &DraftParameters,
    ) -> Result<(Q, bool), Signal<Q>> {
        match sample {
            Ok(quantity) if still < parameters.still_time => {
                let is_first = self.plausible(parameters).map_err(Signal::Lost)?;
                Ok((quantity, is_first))
            }
            Ok(_) => Err(self.implausible(frozen, still >= parameters.frozen_time)),
            Err(trouble) => {
                self.implausible_for = self.implausible_for.next().min(parameters.check_time);
                Err(self.implausible(trouble, self.implausible_for >= parameters.check_time))
            }
        }
    }

    /// A plausible sample: whether it is the first that is used after a loss.
    fn plausible(&mut self, parameters: &DraftParameters) -> Result<bool, Trouble> {
        self.implausible_for = Millisecond::ZERO;
        let Some(trouble) = self.lost else {
            return Ok(false);
        };
        self.healthy_for = self.healthy_for.next();
        if self.healthy_for < parameters.healthy_time {
            return Err(trouble);
        }
        self.lost = None;
        Ok(true)
    }

    fn implausible<Q>(&mut self, trouble: Trouble, for_long: bool) -> Signal<Q> {
        self.healthy_for = Millisecond::ZERO;
        if for_long && self.lost.is_none() {
            self.lost = Some(trouble);
        }
        self.lost.map_or(Signal::Suspect, Signal::Lost)
    }
}

/// For how long a sample has been the same.
#[derive(Clone, Copy, Debug, Default)]
pub struct Still {
    last: Option<SupplyShare>,
    since: Millisecond,
}

impl Still {
    /// One step.
    pub fn step(&mut self, sample: Option<SupplyShare>) -> Millisecond {
        self.since = if sample == self.last {
            self.since.next()
        } else {
            Millisecond::ZERO
        };
        self.last = sample;
        self.since
    }
}

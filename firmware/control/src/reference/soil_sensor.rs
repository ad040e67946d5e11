//! What the sensors of draft and depth have in common: plausibility, filter, and whether the implement is in the soil.
//!
//! A sample that may be wrong is not used: the signal is [`Signal::Suspect`] until the sensor is plausible again or has been
//! implausible for `check_time`. It is lost then, until it has been plausible for `healthy_time`.

use hitch_quantities::Trouble;
use hitch_quantities::calibration::field_parameters::DraftParameters;
use hitch_quantities::units::{MilliHertz, Millisecond, SupplyShare};

use super::low_pass::LowPass;

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

/// A sensor from step to step.
#[derive(Clone, Copy, Debug, Default)]
pub struct SoilSensor {
    filter: LowPass,
    implausible_for: Millisecond,
    healthy_for: Millisecond,
    lost: Option<Trouble>,
    in_soil: bool,
}

impl SoilSensor {
    /// One step: the filtered quantity. `still`: for how long the sample has been the same, and the trouble that this is in the
    /// soil. The implement `enters` the soil above one filtered quantity and `leaves` it at another.
    pub fn step<Q>(
        &mut self,
        sample: Result<i32, Trouble>,
        (still, frozen): (Millisecond, Trouble),
        corner: MilliHertz,
        [enters, leaves]: [i32; 2],
        parameters: &DraftParameters,
    ) -> Result<i32, Signal<Q>> {
        let still = if self.in_soil {
            still
        } else {
            Millisecond::ZERO
        };
        match sample {
            Ok(sample) if still < parameters.still_time => {
                self.plausible(parameters).map_err(Signal::Lost)?;
                let filtered = self.filter.step(sample, corner);
                self.in_soil = filtered > if self.in_soil { leaves } else { enters };
                Ok(filtered)
            }
            Ok(_) => Err(self.implausible(frozen, still >= parameters.frozen_time)),
            Err(trouble) => {
                self.implausible_for = self.implausible_for.next().min(parameters.check_time);
                Err(self.implausible(trouble, self.implausible_for >= parameters.check_time))
            }
        }
    }

    /// Whether the implement is in the soil.
    #[must_use]
    pub const fn is_in_soil(&self) -> bool {
        self.in_soil
    }

    /// A plausible sample; after a loss, the filter begins with the first one that is used.
    fn plausible(&mut self, parameters: &DraftParameters) -> Result<(), Trouble> {
        self.implausible_for = Millisecond::ZERO;
        let Some(trouble) = self.lost else {
            return Ok(());
        };
        self.healthy_for = self.healthy_for.next();
        if self.healthy_for < parameters.healthy_time {
            return Err(trouble);
        }
        self.lost = None;
        self.filter.reset();
        Ok(())
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
        self.since = self.since.counted_while(sample == self.last);
        self.last = sample;
        self.since
    }
}

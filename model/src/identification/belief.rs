//! What an effect has to show to be believed.

use super::candidate::{Candidate, systematic};
use super::experiment::Experiment;
use super::holdout::HeldOut;
use crate::effects::Effect;

/// Likelihood ratio that an effect needs: chi-squared with one degree of freedom at 5 % over some fifty tries.
pub const BELIEVED: f64 = 11.0;

/// What more it needs for each parameter of a shape that it brings.
const BELIEVED_PER_SHAPE: f64 = 3.0;

/// Share of what is left that an effect beside others has to explain. What explains less, and leaves the rest as it
/// was, patches what an effect before it has not quite the form for.
const NO_PATCH: f64 = 0.1;

/// Smallest detectability of an effect beside others where held-out runs leave no more than noise, sigmas. A few cells
/// may still have some of what the one before it lacks, as it rings on the ground: a threshold or a flow that is off by
/// next to nothing takes on 0.15 of that.
const VISIBLE_BESIDE: f64 = 0.2;

/// The same where there are no held-out runs to refute it, and the model leaves no more than noise: of a single log in
/// which currents move between samples 10 ms apart a droop takes on 0.2.
const VISIBLE_UNREFUTED: f64 = 0.3;

/// Width of a current path that is believed, in sigmas of the logged currents: as wide as what cleaning leaves of their
/// noise it holds the valves still that this would shake, and fits better though nothing is there.
const HELD_STILL: f64 = 1.5;

/// What a candidate has to show.
#[derive(Debug, Clone, Copy)]
pub(super) struct Proof {
    /// At least this detectability.
    visible: f64,
    /// Less than this left in held-out runs.
    held_out: HeldOut,
    /// At least this share of what the held-out runs have above their noise explained.
    share: f64,
}

impl Proof {
    /// After so many effects were added, before which held-out runs left so much; whether the model leaves no more than
    /// `noise`.
    pub fn new((visible, noise): (f64, bool), held_out: HeldOut, added: usize) -> Self {
        let least = if noise && held_out.error.is_nan() {
            VISIBLE_UNREFUTED
        } else if added > 0 && held_out.excess() <= 0.0 {
            VISIBLE_BESIDE
        } else {
            visible
        };
        Self {
            visible: visible.max(least),
            held_out,
            share: if added == 0 { 0.0 } else { NO_PATCH },
        }
    }

    /// Whether a candidate's evidence is strong enough, its signature large enough and its size surely not nothing.
    pub fn accepts(self, experiment: &Experiment, candidate: &Candidate) -> bool {
        candidate.likelihood_ratio >= believed(candidate.effect)
            && candidate.detectability >= self.visible
            && surely_there(experiment, candidate)
    }

    /// Whether what is left in held-out runs will do. A campaign of one run has none; it is not held against it.
    pub fn admits(self, held_out: HeldOut) -> bool {
        let before = self.held_out.excess();
        let explained = before - held_out.excess();
        explained.is_nan() || explained > (self.share * before).max(0.0)
    }
}

/// Whether a size is beyond what a log cannot say of it even with many samples. Its shape may be anything: ground that a
/// hitch only ever rests on is as likely soft and high as hard and low, but there it is.
fn surely_there(experiment: &Experiment, candidate: &Candidate) -> bool {
    let Some(added) = candidate.fit.estimate.effects.last() else {
        return false;
    };
    let size = &added.effect.parameters()[0];
    let off = (added.values[0] - size.null).abs();
    let of_noise = off / candidate.likelihood_ratio.sqrt();
    let sure = off - 1.96 * of_noise.hypot(systematic(added, 0));
    let is_width = size.unit == "A" && size.low == size.null;
    let noise = experiment.current_noise;
    let held_still_a = HELD_STILL * noise.lift_a.max(noise.lower_a);
    // A spool not surely later than the log knows when its currents jumped stands in for that.
    let is_lag = size.unit == "s" && size.null == 0.0;
    // One jump that the noise of a current decided is as much evidence as anybody could ask for, and says nothing.
    let (low, high) = candidate.intervals[0];
    let may_be_nothing = candidate.intervals.len() == 1 && low <= size.null && size.null <= high;
    !may_be_nothing
        && sure > 0.0
        && (!is_width || off > held_still_a)
        && (!is_lag || sure > experiment.jumps_within_s)
}

/// Likelihood ratio that an effect needs.
pub(super) fn believed(effect: &dyn Effect) -> f64 {
    BELIEVED + BELIEVED_PER_SHAPE * (effect.parameters().len() - 1) as f64
}

//! The state of the plant at one instant, for terms of a user's own.
//!
//! A term may depend on what it changes itself. What a place knows of the present instant and what it takes from the
//! end of the step before (10 ms in the steady plant, 2 ms in the dynamic one) is this:
//!
//! | place | now | of the step before |
//! |---|---|---|
//! | `lift-current`, `lower-current` | `i_lift`, `i_lower` without the terms | all else |
//! | `lift-flow-factor` | travel, `p_cyl`, currents; `q_lift` at the compensated drop, without the terms there | `p_pump`, `q_lower` |
//! | `lower-flow-factor` | travel, `p_cyl`, currents; `q_lower` over the whole of `p_cyl`, without the terms there | `p_pump`, `q_lift` |
//! | `leakage`, `compensator-margin` | travel, `p_cyl`, currents | `p_pump`, flows |
//! | `return-pressure` | travel, `p_cyl`, currents; `q_lower`, solved for | `p_pump`, `q_lift` |
//! | `friction` | travel, currents; `v`, solved for | `p_pump`, flows; in the steady plant `p_cyl` |
//! | `weight` | travel, currents; `f_weight` without the terms | `p_pump`, flows; in the steady plant `p_cyl` |
//! | sensors | all | |
//!
//! Travel stands for `x`, `rocker_angle` and `f_weight`. `v` is that of the step before in the steady plant (but for
//! friction), which has it from the flows, and that of now in the dynamic plant. `i_lift` and `i_lower` are those of
//! the end of the present step. `load`, `t_oil` and `nu` are the run's.
//!
//! A flow bench has no piston: `x`, `v`, `rocker_angle`, `load` and `f_weight` are not numbers there, and neither is a
//! term that depends on one of them, which therefore is absent. For the same reason a term is absent wherever its value
//! is not finite: a fit then sees a model without it and turns elsewhere.

use crate::hooks::effect_hooks::EffectHooks;
use crate::hooks::place::Place;
use crate::hooks::signals::Signals;
use crate::model::Model;
use crate::state::MechanicalState;

/// What is known of the plant at the present instant.
#[derive(Clone, Copy)]
pub struct Moment<'a> {
    /// The model.
    pub model: &'a Model,
    /// What the effects attach.
    pub hooks: &'a EffectHooks,
    /// The signals at the end of the step before, with the currents of this one.
    pub before: &'a Signals,
}

impl Moment<'_> {
    /// Sum of the terms at a place, in its SI unit, with the piston and its oil in a state; `refine` sets what is known
    /// better than from the step before.
    #[inline(always)]
    #[must_use]
    pub fn term(
        &self,
        place: Place,
        state: &MechanicalState,
        refine: impl FnOnce(&mut Signals),
    ) -> f64 {
        // Nearly every plant is without terms, and this is in its innermost loop.
        if self.hooks.terms.is_empty() {
            return 0.0;
        }
        self.present_term(place, state, refine)
    }

    #[cold]
    #[inline(never)]
    fn present_term(
        &self,
        place: Place,
        state: &MechanicalState,
        refine: impl FnOnce(&mut Signals),
    ) -> f64 {
        if !self.hooks.has_term(place) {
            return 0.0;
        }
        let mut signals = self.signals(state);
        refine(&mut signals);
        self.hooks.term(place, &signals)
    }

    /// The signals with the piston and its oil in a state.
    #[must_use]
    pub fn signals(&self, state: &MechanicalState) -> Signals {
        let mut signals = Signals {
            cylinder_pressure_pa: state.pressure_pa,
            ..*self.before
        };
        if signals.load_kg.is_finite() {
            let posture = self.model.linkage().at(state.piston_m);
            let masses = &self.model.constants().masses;
            signals.travel_m = state.piston_m;
            signals.speed_m_s = state.speed_m_s;
            signals.rocker_angle_rad = posture.rocker_angle_rad;
            let load_share = masses.load_share(signals.load_kg);
            signals.weight_n = masses.weight_force_n(signals.load_kg, posture.dh_dx)
                * self.hooks.weight_factor(state.piston_m, load_share);
        }
        signals
    }
}

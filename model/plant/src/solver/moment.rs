//! The state of the plant at one instant, for user-defined terms.
//!
//! A term may depend on quantities that it changes itself. This table lists which signals a place has from the present
//! instant, and which from the end of the previous step (10 ms in the steady plant, 2 ms in the dynamic one):
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
//! Travel stands for `x`, `rocker_angle` and `f_weight`. In the steady plant, `v` follows from the flows and is that of
//! the previous step (except for friction); in the dynamic plant it is the present one. `i_lift` and `i_lower` are
//! those at the end of the present step. `load`, `t_oil` and `nu` are constant over the run.
//!
//! A flow bench has no piston: `x`, `v`, `rocker_angle`, `load` and `f_weight` are NaN there. A term whose value is not
//! finite is skipped, so terms that depend on one of these are absent, and a fit that reaches a non-finite term sees
//! the model without it.

use crate::hooks::acting::Acting;
use crate::hooks::place::Place;
use crate::hooks::signals::Signals;
use crate::model::Model;
use crate::state::MechanicalState;

/// The state of the plant at the present instant.
#[derive(Clone, Copy)]
pub struct Moment<'a, const KINDS: u8> {
    /// The model.
    pub model: &'a Model,
    /// The attached effects.
    pub hooks: Acting<'a, KINDS>,
    /// The signals at the end of the previous step, with the currents of this one.
    pub before: &'a Signals,
}

impl<const KINDS: u8> Moment<'_, KINDS> {
    /// Sum of the terms at a place, in its SI unit, for a state of piston and oil; `refine` sets the signals that are
    /// known better than from the previous step.
    #[inline(always)]
    #[must_use]
    pub fn term(
        &self,
        place: Place,
        state: &MechanicalState,
        refine: impl FnOnce(&mut Signals),
    ) -> f64 {
        // Nearly all plants have no terms, and this is in the innermost loop.
        if self.hooks.own().terms.is_empty() {
            return 0.0;
        }
        self.present_term(place, *state, refine)
    }

    /// The state is passed by value, so that without terms the solver need not keep it in memory.
    #[cold]
    #[inline(never)]
    fn present_term(
        &self,
        place: Place,
        state: MechanicalState,
        refine: impl FnOnce(&mut Signals),
    ) -> f64 {
        if !self.hooks.own().has_term(place) {
            return 0.0;
        }
        let mut signals = self.signals(&state);
        refine(&mut signals);
        self.hooks.own().term(place, &signals)
    }

    /// The signals for a state of piston and oil.
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
            let load_kg = signals.load_kg;
            let load_share = || masses.load_share(load_kg);
            signals.weight_n = masses.weight_force_n(load_kg, posture.dh_dx)
                * self
                    .hooks
                    .piston()
                    .weight_factor(state.piston_m, load_share);
        }
        signals
    }
}

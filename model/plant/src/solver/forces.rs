//! The forces on the piston other than the oil pressure, including those of effects.

use crate::hooks::acting::Acting;
use crate::hooks::effect_hooks::EffectHooks;
use crate::hooks::elements::Ground;
use crate::hooks::place::Place;
use crate::hooks::signals::Signals;
use crate::model::Model;
use crate::solver::moment::Moment;
use crate::state::{HitchRig, MechanicalState};

/// Speed, m/s, at which a seal slides: the friction of the effects has passed its transition from rest.
const SLIDING_M_S: f64 = 0.012;

/// Forces on the piston of one hitch.
#[derive(Clone, Copy)]
pub struct Forces<'a, const KINDS: u8> {
    /// The model.
    pub model: &'a Model,
    /// The attached effects.
    pub hooks: Acting<'a, KINDS>,
    /// The load.
    pub rig: &'a HitchRig,
    /// The signals for terms.
    pub moment: Moment<'a, KINDS>,
}

impl<'a, const KINDS: u8> Forces<'a, KINDS> {
    /// The forces on the piston of a hitch with effects of `KINDS`; `before` are the signals for terms.
    #[inline(always)]
    #[must_use]
    pub fn new(
        model: &'a Model,
        hooks: &'a EffectHooks,
        before: &'a Signals,
        rig: &'a HitchRig,
    ) -> Self {
        let hooks = Acting::only(hooks);
        Self {
            model,
            hooks,
            rig,
            moment: Moment {
                model,
                hooks,
                before,
            },
        }
    }

    /// Static force of load and dead weight, N, downwards, at piston travel `piston_m`, all else as in the previous
    /// step.
    #[inline(always)]
    #[must_use]
    pub fn weight_n(&self, piston_m: f64) -> f64 {
        let dh_dx = self.model.linkage().dh_dx(piston_m);
        self.weight_at_n(dh_dx, &self.before(piston_m))
    }

    /// Static force of load and dead weight, N, downwards, in a state where the linkage has the transmission `dh_dx`.
    #[inline(always)]
    #[must_use]
    pub fn weight_at_n(&self, dh_dx: f64, state: &MechanicalState) -> f64 {
        let masses = &self.model.constants().masses;
        let load_share = || masses.load_share(self.rig.load_kg);
        let factor = self
            .hooks
            .piston()
            .weight_factor(state.piston_m, load_share);
        masses.weight_force_n(self.rig.load_kg, dh_dx) * factor
            + self.moment.term(Place::Weight, state, |_| ())
    }

    /// Additional inertia of the rocker shaft at the piston, kg, and half its derivative over piston travel, kg/m:
    /// `J (dphi/dx)^2`.
    #[inline(always)]
    #[must_use]
    pub fn shaft_inertia_kg(&self, piston_m: f64) -> (f64, f64) {
        let inertia_kg_m2 = self.hooks.piston().shaft_inertia_kg_m2;
        if inertia_kg_m2 == 0.0 {
            (0.0, 0.0)
        } else {
            self.some_shaft_inertia_kg(inertia_kg_m2, piston_m)
        }
    }

    #[cold]
    #[inline(never)]
    fn some_shaft_inertia_kg(&self, inertia_kg_m2: f64, piston_m: f64) -> (f64, f64) {
        let (turn_rad_m, bend_rad_m2) = self.model.linkage().shaft_transmission(piston_m);
        (
            inertia_kg_m2 * turn_rad_m * turn_rad_m,
            inertia_kg_m2 * turn_rad_m * bend_rad_m2,
        )
    }

    /// A state at a piston travel, with speed and pressure of the previous step.
    #[inline(always)]
    #[must_use]
    pub fn before(&self, piston_m: f64) -> MechanicalState {
        MechanicalState {
            piston_m,
            speed_m_s: self.moment.before.speed_m_s,
            pressure_pa: self.moment.before.cylinder_pressure_pa,
            ..MechanicalState::default()
        }
    }

    /// Force of the ground under the hitch, N, upwards, at a piston travel, m, and speed, m/s.
    #[inline(always)]
    #[must_use]
    pub fn ground_n(&self, piston_m: f64, speed_m_s: f64) -> f64 {
        match &self.hooks.piston().ground {
            Some(ground) => self.ground_contact_n(ground, piston_m, speed_m_s),
            None => 0.0,
        }
    }

    #[cold]
    #[inline(never)]
    fn ground_contact_n(&self, ground: &Ground, piston_m: f64, speed_m_s: f64) -> f64 {
        let posture = self.model.linkage().at(piston_m);
        ground.force_n(posture.height_m, speed_m_s * posture.dh_dx) * posture.dh_dx
    }

    /// Friction against the motion, N, in a state with a weight's force, N.
    #[inline(always)]
    #[must_use]
    pub fn friction_n(&self, state: &MechanicalState, weight_n: f64) -> f64 {
        self.hooks.piston().friction_n(state, weight_n)
            + self.hooks.piston().bristles_n(state.bristles_m)
            + self.moment.term(Place::Friction, state, |_| ())
    }

    /// Dry friction, N, in a state at rest: the largest force that a stuck piston carries in either direction. It is the
    /// friction above the transition from rest, extrapolated to no speed, so that a viscous part does not count.
    #[must_use]
    pub fn dry_friction_n(&self, at_rest: &MechanicalState, weight_n: f64) -> f64 {
        let at = |speed_m_s: f64| {
            let state = MechanicalState {
                speed_m_s,
                ..*at_rest
            };
            self.friction_n(&state, weight_n) - self.friction_n(at_rest, weight_n)
        };
        let smooth_n = 2.0 * at(SLIDING_M_S) - at(2.0 * SLIDING_M_S);
        let bristles_n = self
            .hooks
            .piston()
            .bristles
            .map_or(0.0, |bristles| bristles.force_n);
        (smooth_n + bristles_n).max(0.0)
    }

    /// Lowest travel of the piston, m: the end of the stroke, or where the ground carries the weight.
    #[must_use]
    pub fn lowest_m(&self) -> f64 {
        if self.hooks.piston().ground.is_none() {
            return 0.0;
        }
        let stroke_m = self.model.constants().cylinder.stroke_m;
        let excess = |piston_m: f64| self.weight_n(piston_m) - self.ground_n(piston_m, 0.0);
        crate::solver::root::rising(excess, 0.0, stroke_m, 1e-6)
    }
}

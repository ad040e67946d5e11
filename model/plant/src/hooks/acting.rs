//! The kinds of effects that act in a plant, as a constant of the solver.
//!
//! The equations of the solver contain every hook. Asking each of them at every stage of every step costs as much as the
//! physics, and most plants have few effects. The solver is therefore compiled once for each set of kinds, from the same
//! source: where a kind does not act, its hooks are those of [`NO_EFFECTS`], a constant that the compiler evaluates.

use crate::hooks::effect_hooks::EffectHooks;

/// Effects on pump, compensator, check valve and relief valve.
pub const SUPPLY: u8 = 1;
/// Forces and masses at the piston.
pub const PISTON: u8 = 2;
/// Effects on the oil, the hoses, leakage, the flow through the lowering valve and the line behind it.
pub const OIL: u8 = 4;
/// Every kind; only then, user-defined terms may act.
pub const EVERY: u8 = SUPPLY | PISTON | OIL;

/// The hooks without any effect.
const NO_EFFECTS: &EffectHooks = &EffectHooks::NONE;

/// The hooks of a plant in which only effects of some kinds act.
#[derive(Clone, Copy)]
pub struct Acting<'a, const KINDS: u8> {
    hooks: &'a EffectHooks,
}

impl<'a, const KINDS: u8> Acting<'a, KINDS> {
    /// The hooks where they act only in `KINDS`, which has to contain [`kinds`] of them.
    #[inline(always)]
    #[must_use]
    pub fn only(hooks: &'a EffectHooks) -> Self {
        Self { hooks }
    }

    /// The hooks of pump, compensator, check valve and relief valve.
    #[inline(always)]
    #[must_use]
    pub fn supply(self) -> &'a EffectHooks {
        self.if_all_of(SUPPLY)
    }

    /// The hooks of forces and masses at the piston.
    #[inline(always)]
    #[must_use]
    pub fn piston(self) -> &'a EffectHooks {
        self.if_all_of(PISTON)
    }

    /// The hooks of oil, hoses, leakage, the lowering valve and its return line.
    #[inline(always)]
    #[must_use]
    pub fn oil(self) -> &'a EffectHooks {
        self.if_all_of(OIL)
    }

    /// The hooks for user-defined terms.
    #[inline(always)]
    #[must_use]
    pub fn own(self) -> &'a EffectHooks {
        self.if_all_of(EVERY)
    }

    /// All hooks.
    #[inline(always)]
    #[must_use]
    pub fn all(self) -> &'a EffectHooks {
        self.hooks
    }

    #[inline(always)]
    fn if_all_of(self, kinds: u8) -> &'a EffectHooks {
        match KINDS & kinds == kinds {
            true => self.hooks,
            false => NO_EFFECTS,
        }
    }
}

/// The kinds of the effects that are attached to hooks.
#[must_use]
pub fn kinds(hooks: &EffectHooks) -> u8 {
    let supply = hooks.compensator_lag_s != 0.0
        || hooks.margin_lost_to_flow_pa_s_m3 != 0.0
        || hooks.idle_extra_pa != 0.0
        || hooks.cracking_extra_pa != 0.0
        || !hooks.check_valve.is_free()
        || !(hooks.margin.is_empty() && hooks.pump_slip.is_empty())
        || hooks.relief.is_some();
    let piston = hooks.inertia_share != 0.0
        || hooks.shaft_inertia_kg_m2 != 0.0
        || !(hooks.friction.is_empty() && hooks.weight_factor.is_empty())
        || hooks.bristles.is_some()
        || hooks.ground.is_some();
    let oil = hooks.hose != EffectHooks::NONE.hose
        || !hooks.return_line.is_free()
        || !(hooks.leakage.is_empty() && hooks.stiffness_factor.is_empty())
        || !(hooks.lower_drop_factor.is_empty() && hooks.lower_travel_factor.is_empty())
        || hooks.flow_number_1_a_sqrt_pa.is_some();
    let own = match hooks.terms.is_empty() {
        true => 0,
        false => EVERY,
    };
    let kind = |acts: bool, kind: u8| if acts { kind } else { 0 };
    own | kind(supply, SUPPLY) | kind(piston, PISTON) | kind(oil, OIL)
}

/// Evaluates an expression with a constant equal to the kinds in a variable.
macro_rules! with_kinds {
    ($kinds:expr, $constant:ident => $body:expr) => {
        $crate::hooks::acting::with_kinds!(@ $kinds, $constant, $body, 0 1 2 3 4 5 6)
    };
    (@ $kinds:expr, $constant:ident, $body:expr, $($set:literal)*) => {
        match $kinds {
            $($set => {
                const $constant: u8 = $set;
                $body
            })*
            _ => {
                const $constant: u8 = $crate::hooks::acting::EVERY;
                $body
            }
        }
    };
}

pub(crate) use with_kinds;

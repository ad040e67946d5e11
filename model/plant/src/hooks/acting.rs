//! The kinds of effects that act in a plant, as a constant of the solver.
//!
//! The equations of the solver contain every hook. Asking each of them at every stage of every step costs as much as the
//! physics, and most plants have few effects. The solver is therefore compiled once for each set of kinds, from the same
//! source: where a kind does not act, its hooks are those of `NO_EFFECTS`, a constant that the compiler evaluates.

use crate::hooks::effect_hooks::EffectHooks;
use crate::hooks::elements::Hose;

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
        if KINDS & kinds == kinds {
            self.hooks
        } else {
            NO_EFFECTS
        }
    }
}

/// The kinds of the effects that are attached to hooks.
///
/// Every hook is named, so that one that is added later cannot be left out.
#[must_use]
pub fn kinds(hooks: &EffectHooks) -> u8 {
    let EffectHooks {
        // Outside of the innermost loop.
        currents: _,
        lift_flow_factor: _,
        lower_flow_factor: _,
        spool_lag_extra_s: _,
        longest_step_s: _,
        largest_change_a: _,
        sensors: _,
        margin,
        idle_extra_pa,
        margin_lost_to_flow_pa_s_m3,
        compensator_lag_s,
        cracking_extra_pa,
        check_valve,
        pump_slip,
        relief,
        friction,
        bristles,
        weight_factor,
        inertia_share,
        shaft_inertia_kg_m2,
        ground,
        leakage,
        stiffness_factor,
        hose,
        return_line,
        lower_drop_factor,
        lower_travel_factor,
        flow_number_1_a_sqrt_pa,
        terms,
    } = hooks;
    let no_supply = [
        *idle_extra_pa,
        *margin_lost_to_flow_pa_s_m3,
        *compensator_lag_s,
        *cracking_extra_pa,
    ] == [0.0; 4]
        && margin.is_empty()
        && check_valve.is_free()
        && pump_slip.is_empty()
        && relief.is_none();
    let no_piston = [*inertia_share, *shaft_inertia_kg_m2] == [0.0; 2]
        && friction.is_empty()
        && bristles.is_none()
        && weight_factor.is_empty()
        && ground.is_none();
    let no_oil = *hose == Hose::STIFF
        && leakage.is_empty()
        && stiffness_factor.is_empty()
        && return_line.is_free()
        && lower_drop_factor.is_empty()
        && lower_travel_factor.is_empty()
        && flow_number_1_a_sqrt_pa.is_none();
    let unless = |absent: bool, kinds: u8| if absent { 0 } else { kinds };
    unless(no_supply, SUPPLY)
        | unless(no_piston, PISTON)
        | unless(no_oil, OIL)
        | unless(terms.is_empty(), EVERY)
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

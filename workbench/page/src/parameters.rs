//! Parameters of the effects of a model: set by hand, fixed, and freed.

use hitch_identification::estimate::Estimate;
use hitch_plant::{AddedEffect, Effect, full_name};

/// An estimate with one parameter set manually, limited to its range; `None` if the parameter does not exist.
pub fn moved(estimate: &Estimate, effect: usize, parameter: usize, value: f64) -> Option<Estimate> {
    let mut moved = estimate.clone();
    let added = moved.effects.get_mut(effect)?;
    let range = added.effect.parameters().get(parameter)?;
    *added.values.get_mut(parameter)? = value.max(range.low).min(range.high);
    Some(moved)
}

/// An estimate with a parameter of an effect fixed or freed, and the title of that step; `None` if there is no such parameter.
pub fn held(
    estimate: &Estimate,
    effect: &'static dyn Effect,
    parameter: usize,
    fixed: bool,
) -> Option<(Estimate, String)> {
    let name = effect.parameters().get(parameter)?.name;
    let mut held = estimate.clone();
    let key = (effect.id(), parameter);
    let verb = if fixed {
        held.fixed.insert(key);
        "Fixed"
    } else {
        held.fixed.remove(&key);
        "Freed"
    };
    Some((held, format!("{verb} {name} of {}", full_name(effect))))
}

/// Gives the fixed parameters of the present model their values in another estimate, where they are fixed too. A search may
/// have moved them, and has dropped those of removed effects.
pub fn keep_fixed(present: &Estimate, estimate: &mut Estimate) {
    let mut fixed = present.fixed.clone();
    fixed.retain(|&(id, parameter)| {
        let of = |added: &&AddedEffect| added.effect.id() == id;
        let known = present.effects.iter().find(of);
        let mut effects = estimate.effects.iter_mut();
        let own = effects.find(|added| added.effect.id() == id);
        let values = known.zip(own).and_then(|(known, own)| {
            let known = known.values.get(parameter)?;
            Some((known, own.values.get_mut(parameter)?))
        });
        values.is_some_and(|(known, own)| {
            *own = *known;
            true
        })
    });
    estimate.fixed = fixed;
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use hitch_identification::data::clocks::Clocks;
    use hitch_identification::estimate::Shared;

    use super::*;
    use hitch_results::arguments::effect::find;

    fn estimate(effects: Vec<AddedEffect>) -> Estimate {
        Estimate {
            effects,
            clocks: Clocks::default(),
            adopted: Vec::new(),
            fixed: BTreeSet::new(),
            constants: None,
            nuisances: Vec::new(),
            clocks_within_s: 0.0,
        }
    }

    #[test]
    fn a_fixed_parameter_is_no_free_one_and_returns_to_its_value() {
        let model = hitch_model_file::nominal();
        let added = |name: &str| AddedEffect::typical(find(&model, name).unwrap());
        let present = estimate(vec![added("lower-threshold-shift")]);
        let id = present.effects[0].effect.id();
        let (present, _) = held(&present, present.effects[0].effect, 0, true).unwrap();
        let is_own = |shared: &Shared| matches!(shared, Shared::Effect(..));
        assert!(!present.shared().iter().any(is_own));
        assert!(held(&present, present.effects[0].effect, 9, true).is_none());

        let mut other = estimate(vec![
            added("lift-threshold-shift"),
            added("lower-threshold-shift"),
        ]);
        other.effects[1].values[0] *= 0.5;
        keep_fixed(&present, &mut other);
        assert_eq!(other.effects[1].values, present.effects[0].values);
        let free: Vec<Shared> = other.shared().into_iter().filter(is_own).collect();
        assert!(
            free.iter()
                .all(|shared| matches!(shared, Shared::Effect(0, _)))
                && !free.is_empty()
        );

        let mut without = estimate(vec![added("lift-threshold-shift")]);
        keep_fixed(&present, &mut without);
        assert!(without.fixed.is_empty(), "{id} was removed");
    }
}

//! The size of an effect of a model.

use hitch_plant::{AddedEffect, Model};

/// First parameter of an effect of the model, in any form.
pub fn found(model: &Model, id: &str) -> Option<f64> {
    let added = model.effects.iter().find(|added| added.effect.id() == id)?;
    added.values.first().copied()
}

/// First parameter of an effect of the model in one form.
pub fn found_in(model: &Model, id: &str, form: Option<&str>) -> Option<f64> {
    let is_it = |added: &&AddedEffect| (added.effect.id(), added.effect.form()) == (id, form);
    let added = model.effects.iter().find(is_it)?;
    added.values.first().copied()
}

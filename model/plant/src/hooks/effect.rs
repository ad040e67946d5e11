//! What an effect is to the plant: texts, parameters, and a function that puts it at the hooks.

use std::any::Any;

use crate::channel::Channel;
use crate::constants::Dynamics;
use crate::hooks::effect_hooks::{EffectHooks, RunConditions};

/// Share of the end of a parameter's range, or of its typical value, within which a value counts as at that end.
const AT_A_LIMIT: f64 = 1e-3;

/// What a parameter is to a logger: it samples currents with noise and stamps them with a clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParameterKind {
    /// A coil current.
    Current,
    /// A time.
    Time,
    /// Any other quantity.
    Other,
}

/// One parameter of an effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Name, without the unit.
    pub name: &'static str,
    /// Unit as it is written in reports; empty for a pure number.
    pub unit: &'static str,
    /// Which kind of quantity it is.
    pub kind: ParameterKind,
    /// Key in a model file: the name with the unit in it.
    pub key: &'static str,
    /// What it is, in a few words.
    pub meaning: &'static str,
    /// Value that turns the effect off exactly; of no account for a parameter that is not the size.
    pub null: f64,
    /// A size that is often met, for starting values, signatures and tests.
    pub typical: f64,
    /// Smallest value that makes sense.
    pub low: f64,
    /// Largest value that makes sense.
    pub high: f64,
}

impl Parameter {
    /// Whether a value is at an end of the range, and that end does not turn the effect off.
    #[must_use]
    pub fn is_at_a_limit(&self, value: f64) -> bool {
        let near = |end: f64| AT_A_LIMIT * end.abs().max(self.typical.abs());
        let is_at = |end: f64| end != self.null && (value - end).abs() <= near(end);
        is_at(self.low) || is_at(self.high)
    }
}

/// How what the instruments show depends on the size of an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SizeResponse {
    /// Smoothly: from most sizes a least-squares fit leads to the best one.
    Smooth,
    /// The size decides when something switches: a size that is a few percent off switches at another time, and can
    /// explain less than none.
    Switching,
    /// In steps: whether a spool moves on a step of the current is the same for a range of sizes. The first shape is a
    /// share of the size, and the rest of the size is what shows.
    Stepped,
    /// The size is a place in the stroke, and nothing shows before the hitch gets there.
    Located,
}

impl SizeResponse {
    /// Whether the cost has many local minima along the size.
    #[must_use]
    pub fn is_rough(self) -> bool {
        self != Self::Smooth
    }
}

/// Ratio of the ends of a range from which a parameter is taken by its order of magnitude.
const DECADE: f64 = 10.0;

impl Parameter {
    /// Whether its range covers so much that its order of magnitude is what counts.
    #[must_use]
    pub fn is_by_magnitude(&self) -> bool {
        self.low > 0.0 && self.high.is_finite() && self.high > DECADE * self.low
    }

    /// The value that lies a share of its range above another, evenly or by its order of magnitude, within the range.
    #[must_use]
    pub fn moved(&self, value: f64, share: f64) -> f64 {
        let moved = if self.is_by_magnitude() {
            value * (self.high / self.low).powf(share)
        } else {
            value + share * (self.high - self.low)
        };
        moved.clamp(self.low, self.high)
    }

    /// A natural size of a step of it, in its unit: from nothing to the typical value, or what there is of that.
    #[must_use]
    pub fn scale(&self) -> f64 {
        let width = self.high - self.low;
        [self.typical - self.null, self.typical, 0.1 * width, 1.0]
            .into_iter()
            .map(f64::abs)
            .find(|size| *size > 0.0 && size.is_finite())
            .unwrap_or(1.0)
    }
}

/// A physical effect that a plant can have beyond the paper's model.
pub trait Effect: Any + Sync {
    /// Its name in files, commands and reports.
    fn id(&self) -> &'static str;
    /// Which of several equations it is where one effect is known in more than one form; `None` for the usual one.
    fn form(&self) -> Option<&'static str> {
        None
    }
    /// Its name in words.
    fn title(&self) -> &'static str;
    /// Its equation, as text.
    fn equation(&self) -> &'static str;
    /// Where the equation and the typical size come from.
    fn source(&self) -> &'static str;
    /// Where it shows and what it is easily taken for.
    fn shows(&self) -> &'static str;
    /// Its parameters; the first one is its size, and at its null value the effect is off whatever the others are.
    fn parameters(&self) -> &'static [Parameter];
    /// The channels that it changes directly on a lab campaign.
    fn channels(&self) -> &'static [Channel];
    /// The starting point that it needs, if not every one can show it.
    fn needs(&self) -> Option<Dynamics> {
        None
    }
    /// How what the instruments show depends on its size.
    fn size_response(&self) -> SizeResponse {
        SizeResponse::Smooth
    }
    /// Whether it only says more of what its effect's usual form says: it is looked for from what that one finds.
    fn refines(&self) -> bool {
        false
    }
    /// Its place in the order in which effects act where several act at one hook, from the coil to the instruments.
    fn rank(&self) -> usize {
        usize::MAX
    }
    /// Puts it into a plant, with a value for each parameter.
    fn attach(&self, values: &[f64], conditions: RunConditions<'_>, hooks: &mut EffectHooks);
}

impl std::fmt::Debug for dyn Effect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.id())
    }
}

/// The name of an effect with its form, as commands take it: `id`, or `id/form`.
#[must_use]
pub fn full_name(effect: &dyn Effect) -> String {
    let id = effect.id();
    effect
        .form()
        .map_or_else(|| id.to_owned(), |form| format!("{id}/{form}"))
}

/// Whether two effects are the same in the same form.
#[must_use]
pub fn is_same(one: &dyn Effect, other: &dyn Effect) -> bool {
    one.id() == other.id() && one.form() == other.form()
}

/// An effect with values for its parameters, as a model holds it.
#[derive(Debug, Clone)]
pub struct AddedEffect {
    /// Which effect.
    pub effect: &'static dyn Effect,
    /// One value a parameter, in the parameter's unit.
    pub values: Vec<f64>,
}

impl AddedEffect {
    /// The effect at its typical size.
    #[must_use]
    pub fn typical(effect: &'static dyn Effect) -> Self {
        let values = effect.parameters().iter().map(|p| p.typical).collect();
        Self { effect, values }
    }

    /// The same effect in another form: what both have keeps its value, the rest has its typical one.
    #[must_use]
    pub fn in_form(&self, form: &'static dyn Effect) -> Self {
        let own = self.effect.parameters().iter().zip(&self.values);
        let value = |other: &Parameter| {
            let same = own.clone().find(|(own, _)| own.name == other.name);
            same.map_or(other.typical, |(_, &value)| value)
        };
        Self {
            effect: form,
            values: form.parameters().iter().map(value).collect(),
        }
    }

    /// The effect turned off.
    #[must_use]
    pub fn null(effect: &'static dyn Effect) -> Self {
        let mut added = Self::typical(effect);
        added.values[0] = effect.parameters()[0].null;
        added
    }

    /// Whether its size is the null value.
    #[must_use]
    pub fn is_null(&self) -> bool {
        self.values[0] == self.effect.parameters()[0].null
    }

    /// Puts it into a plant; an effect at its null value is not there at all.
    pub fn attach(&self, conditions: RunConditions<'_>, hooks: &mut EffectHooks) {
        if !self.is_null() {
            self.effect.attach(&self.values, conditions, hooks);
        }
    }
}

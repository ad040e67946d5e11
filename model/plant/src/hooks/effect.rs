//! The interface of an effect: texts, parameters, and a function that attaches it to the hooks.

use std::any::Any;

use crate::channel::Channel;
use crate::constants::Dynamics;
use crate::hooks::effect_hooks::{EffectHooks, RunConditions};

/// Distance from an end of a parameter's range, relative to that end or to the typical value, within which a value
/// counts as at the end.
const AT_A_LIMIT: f64 = 1e-3;

/// Kind of a parameter with respect to a logger, which samples currents with noise and stamps them with a clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParameterKind {
    /// A coil current.
    Current,
    /// A time.
    Time,
    /// A pure number.
    Ratio,
    /// Any other quantity.
    Other,
}

/// One parameter of an effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Name, without the unit.
    pub name: &'static str,
    /// Unit in reports; empty for a pure number.
    pub unit: &'static str,
    /// Kind of the quantity.
    pub kind: ParameterKind,
    /// Key in a model file: the name including the unit.
    pub key: &'static str,
    /// Short description.
    pub meaning: &'static str,
    /// Value at which the effect is off exactly; only meaningful for the size.
    pub null: f64,
    /// Typical value, for start values, signatures and tests.
    pub typical: f64,
    /// Smallest allowed value.
    pub low: f64,
    /// Largest allowed value.
    pub high: f64,
}

impl Parameter {
    const fn of(
        kind: ParameterKind,
        name: &'static str,
        unit: &'static str,
        key: &'static str,
    ) -> Self {
        Self {
            name,
            unit,
            kind,
            key,
            meaning: "",
            null: 0.0,
            typical: 0.0,
            low: 0.0,
            high: 0.0,
        }
    }

    /// A ratio that is off at zero, without text and range.
    #[must_use]
    pub const fn ratio(name: &'static str) -> Self {
        Self::of(ParameterKind::Ratio, name, "", name)
    }

    /// The same of a time, s.
    #[must_use]
    pub const fn time(name: &'static str, key: &'static str) -> Self {
        Self::of(ParameterKind::Time, name, "s", key)
    }

    /// The same of a coil current, A.
    #[must_use]
    pub const fn current(name: &'static str, key: &'static str) -> Self {
        Self::of(ParameterKind::Current, name, "A", key)
    }

    /// The same of any other quantity with its unit.
    #[must_use]
    pub const fn quantity(name: &'static str, unit: &'static str, key: &'static str) -> Self {
        Self::of(ParameterKind::Other, name, unit, key)
    }

    /// Whether a value is at an end of the range other than the null value.
    #[must_use]
    pub fn is_at_a_limit(&self, value: f64) -> bool {
        let near = |end: f64| AT_A_LIMIT * end.abs().max(self.typical.abs());
        let is_at = |end: f64| end != self.null && (value - end).abs() <= near(end);
        is_at(self.low) || is_at(self.high)
    }
}

/// Response of the readings to the size of an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SizeResponse {
    /// Smooth: a least-squares fit converges from most sizes.
    Smooth,
    /// The size determines a switching instant: a size that is a few percent off switches at another time, and can fit
    /// worse than no effect.
    Switching,
    /// Piecewise constant: whether a spool moves on a step of the current is the same for a range of sizes. The first
    /// shape parameter is a share of the size, and the rest of the size is what the readings depend on.
    Stepped,
    /// The size is a position in the stroke, and the effect only acts there.
    Located,
}

impl SizeResponse {
    /// Whether the cost has many local minima along the size.
    #[must_use]
    pub fn is_rough(self) -> bool {
        self != Self::Smooth
    }
}

/// Ratio of the ends of a range above which a parameter is varied by its order of magnitude.
const DECADE: f64 = 10.0;

impl Parameter {
    /// Whether a parameter is varied by its order of magnitude.
    #[must_use]
    pub fn is_by_magnitude(&self) -> bool {
        self.low > 0.0 && self.high.is_finite() && self.high > DECADE * self.low
    }

    /// A value moved by a share of the range, linearly or by order of magnitude, clamped to the range.
    #[must_use]
    pub fn moved(&self, value: f64, share: f64) -> f64 {
        let moved = if self.is_by_magnitude() {
            value * (self.high / self.low).powf(share)
        } else {
            value + share * (self.high - self.low)
        };
        moved.clamp(self.low, self.high)
    }

    /// Scale of its steps, in its unit: the distance from the null to the typical value, or the first non-zero
    /// substitute.
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

/// A physical effect that extends the paper's model.
pub trait Effect: Any + Sync {
    /// Its id in files, commands and reports.
    fn id(&self) -> &'static str;
    /// Its form, if there are several equations for one effect; `None` for the usual one.
    fn form(&self) -> Option<&'static str> {
        None
    }
    /// Its title.
    fn title(&self) -> &'static str;
    /// Its equation, as text.
    fn equation(&self) -> &'static str;
    /// Source of the equation and of the typical size.
    fn source(&self) -> &'static str;
    /// Where it shows, and which effects it is easily confused with.
    fn shows(&self) -> &'static str;
    /// Its parameters. The first one is its size; at the size's null value the effect is off regardless of the others.
    fn parameters(&self) -> &'static [Parameter];
    /// The channels that it changes directly on a lab campaign.
    fn channels(&self) -> &'static [Channel];
    /// The dynamics that it requires, if any.
    fn needs(&self) -> Option<Dynamics> {
        None
    }
    /// Response of the readings to its size.
    fn size_response(&self) -> SizeResponse {
        SizeResponse::Smooth
    }
    /// Whether its form is a refinement of the effect's usual form: the search starts from the result of the usual one.
    fn refines(&self) -> bool {
        false
    }
    /// Rank in the order of effects at the same hook, from the coil to the instruments.
    fn rank(&self) -> usize;
    /// Attaches it to a plant, with a value for each parameter.
    fn attach(&self, values: &[f64], conditions: RunConditions<'_>, hooks: &mut EffectHooks);
}

impl std::fmt::Debug for dyn Effect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.id())
    }
}

/// The name of an effect with its form, as used in commands: `id`, or `id/form`.
#[must_use]
pub fn full_name(effect: &dyn Effect) -> String {
    let id = effect.id();
    effect
        .form()
        .map_or_else(|| id.to_owned(), |form| format!("{id}/{form}"))
}

/// Whether two effects have the same id and form.
#[must_use]
pub fn is_same(one: &dyn Effect, other: &dyn Effect) -> bool {
    one.id() == other.id() && one.form() == other.form()
}

/// An effect with parameter values, as part of a model.
#[derive(Debug, Clone)]
pub struct AddedEffect {
    /// The effect.
    pub effect: &'static dyn Effect,
    /// One value per parameter, in the parameter's unit.
    pub values: Vec<f64>,
}

impl AddedEffect {
    /// The effect at its typical size.
    #[must_use]
    pub fn typical(effect: &'static dyn Effect) -> Self {
        let values = effect.parameters().iter().map(|p| p.typical).collect();
        Self { effect, values }
    }

    /// The same effect in another form: common parameters keep their values, the others are typical.
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

    /// The effect at its null value.
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

    /// Attaches it to a plant, unless it is at its null value.
    pub fn attach(&self, conditions: RunConditions<'_>, hooks: &mut EffectHooks) {
        if !self.is_null() {
            self.effect.attach(&self.values, conditions, hooks);
        }
    }
}

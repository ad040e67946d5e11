//! A user-defined term as an effect, for plant, identification and reports.

use std::any::Any;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use hitch_input::Unit;
use hitch_plant::hooks::effect_hooks::{EffectHooks, RunConditions, TermFunction};
use hitch_plant::{Channel, Effect, Parameter, ParameterKind};

use crate::catalogue::CATALOGUE;
use crate::expression::{ParameterDefinition, Part, Term, TermDefinition, TermError};

/// Every term defined since the program started, by its definition as text.
static TERMS: Mutex<Option<HashMap<String, &'static TermEffect>>> = Mutex::new(None);

/// A user-defined term as an effect.
///
/// Effects live as long as the program, and so do terms: equal definitions share one term, so that reading a model file
/// repeatedly does not leak memory.
#[derive(Debug)]
pub struct TermEffect {
    term: Arc<Term>,
    id: &'static str,
    title: &'static str,
    equation: &'static str,
    parameters: &'static [Parameter],
}

impl TermEffect {
    /// The effect of a definition.
    ///
    /// # Errors
    /// A fault of the definition.
    pub fn define(definition: TermDefinition) -> Result<&'static Self, TermError> {
        if CATALOGUE.iter().any(|effect| effect.id() == definition.id) {
            let what = format!("{} is an effect of the catalogue", definition.id);
            return Err(TermError::new(Part::Id, what, "give the term another name"));
        }
        let key = format!("{definition:?}");
        let mut terms = TERMS.lock().unwrap_or_else(PoisonError::into_inner);
        let terms = terms.get_or_insert_default();
        if let Some(known) = terms.get(&key) {
            return Ok(known);
        }
        let term: &'static Self = Box::leak(Box::new(Self::new(Term::new(definition)?)));
        terms.insert(key, term);
        Ok(term)
    }

    /// The term of an effect; `None` for an effect of the catalogue.
    #[must_use]
    pub fn of(effect: &'static dyn Effect) -> Option<&'static Self> {
        (effect as &dyn Any).downcast_ref()
    }

    /// The term itself.
    #[must_use]
    pub fn term(&self) -> &Term {
        &self.term
    }

    /// The value of the term, in the SI unit of its place, with a value per parameter in the parameter's unit.
    #[must_use]
    pub fn function(&self, values: &[f64]) -> TermFunction {
        let parameters_si = self.term.si(values);
        let term = Arc::clone(&self.term);
        Box::new(move |signals| term.evaluate(&parameters_si, signals))
    }

    fn new(term: Term) -> Self {
        let definition = term.definition();
        let title = if definition.title.is_empty() {
            definition.id.replace('-', " ")
        } else {
            definition.title.clone()
        };
        let parameters: Vec<Parameter> = definition.parameters.iter().map(parameter).collect();
        Self {
            id: leaked(&definition.id),
            title: leaked(&title),
            equation: leaked(&format!(
                "{} = {}",
                definition.place.id(),
                definition.formula
            )),
            parameters: parameters.leak(),
            term: Arc::new(term),
        }
    }
}

fn parameter(definition: &ParameterDefinition) -> Parameter {
    Parameter {
        name: leaked(&definition.name),
        unit: leaked(&definition.unit),
        kind: kind(&definition.unit),
        key: leaked(&definition.key()),
        meaning: leaked(&definition.meaning),
        null: definition.null,
        typical: definition.start,
        low: definition.low,
        high: definition.high,
    }
}

/// Kind of a quantity by its unit, which is known to be valid.
fn kind(unit: &str) -> ParameterKind {
    if unit.is_empty() {
        return ParameterKind::Ratio;
    }
    let of = |unit: &str| Unit::parse(unit).ok().map(|unit| unit.dimension);
    match of(unit) {
        dimension if dimension == of("A") => ParameterKind::Current,
        dimension if dimension == of("s") => ParameterKind::Time,
        _ => ParameterKind::Other,
    }
}

fn leaked(text: &str) -> &'static str {
    text.to_owned().leak()
}

impl Effect for TermEffect {
    fn id(&self) -> &'static str {
        self.id
    }

    /// Behind the effects of the catalogue.
    fn rank(&self) -> usize {
        usize::MAX
    }

    fn title(&self) -> &'static str {
        self.title
    }

    fn equation(&self) -> &'static str {
        self.equation
    }

    fn source(&self) -> &'static str {
        "the model file"
    }

    fn shows(&self) -> &'static str {
        self.term.definition().place.meaning()
    }

    fn parameters(&self) -> &'static [Parameter] {
        self.parameters
    }

    fn channels(&self) -> &'static [Channel] {
        self.term.definition().place.channels()
    }

    fn attach(&self, values: &[f64], _: RunConditions<'_>, hooks: &mut EffectHooks) {
        let place = self.term.definition().place;
        hooks.terms.push((place, self.function(values)));
    }
}

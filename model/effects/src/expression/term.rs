//! A term: a formula with its parameters and the place where it acts, checked and ready to evaluate.

use hitch_input::Unit;
use hitch_plant::hooks::signals::Signals;

use crate::expression::definition::TermDefinition;
use crate::expression::evaluate::Code;

/// A term with valid syntax, units, ranges and null value.
#[derive(Debug)]
pub struct Term {
    pub(super) definition: TermDefinition,
    pub(super) units: Vec<Unit>,
    pub(super) code: Code,
}

impl Term {
    /// The definition.
    #[must_use]
    pub fn definition(&self) -> &TermDefinition {
        &self.definition
    }

    /// Values of the parameters in SI, from values in their units.
    #[must_use]
    pub fn si(&self, values: &[f64]) -> Vec<f64> {
        values
            .iter()
            .zip(&self.units)
            .map(|(value, unit)| value * unit.si)
            .collect()
    }

    /// The value, in the SI unit of its place.
    ///
    /// It is finite on the states and parameter values that were tested at its definition; elsewhere (a fraction whose
    /// denominator passes through zero) it may be infinite or NaN.
    #[inline]
    #[must_use]
    pub fn evaluate(&self, parameters_si: &[f64], signals: &Signals) -> f64 {
        self.code.evaluate(parameters_si, signals)
    }
}

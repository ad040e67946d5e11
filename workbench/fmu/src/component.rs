//! What a unit simulates.

use crate::variable::{Value, Variable};

/// Why a step was not taken; the time has not changed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal(pub String);

/// A simulated thing with variables.
pub trait Component: Send {
    /// Its variables. Their order never changes.
    fn variables(&self) -> &[Variable];

    /// Begins anew with the values of parameters and inputs, and calculates the outputs in `values`.
    ///
    /// # Errors
    /// If the values do not fit together; what is wrong and how to correct it.
    fn initialise(&mut self, values: &mut [Value]) -> Result<(), Refusal>;

    /// Advances by `dt_s`, which is positive and finite, and calculates the outputs in `values`.
    ///
    /// `slopes` are the rates of change of the inputs, 1/s, by index; zero for an input that is held.
    ///
    /// # Errors
    /// If the step is refused. Nothing has changed then.
    fn step(&mut self, values: &mut [Value], slopes: &[f64], dt_s: f64) -> Result<(), Refusal>;

    /// A copy of everything that it remembers.
    fn copy(&self) -> Box<dyn Component>;
}

/// The real number at an index; not a number for anything else.
#[must_use]
pub fn real(values: &[Value], index: usize) -> f64 {
    match values.get(index) {
        Some(Value::Real(value)) => *value,
        _ => f64::NAN,
    }
}

/// The truth value at an index; false for anything else.
#[must_use]
pub fn boolean(values: &[Value], index: usize) -> bool {
    matches!(values.get(index), Some(Value::Boolean(true)))
}

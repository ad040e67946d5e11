//! User-defined physical terms in a model file, fitted like effects of the catalogue.
//!
//! A formula such as `-c * ramp(1 - x / depth)` is made of
//! * numbers: `0.5`, `2e-3`, and with a unit `3[mm/s]`; without one they are pure numbers;
//! * [signals](hitch_plant::hooks::signals::SIGNALS) of the plant and the parameters of the term, by name;
//! * `+ - * / ^`, a minus in front and parentheses, with the precedence of mathematics: `-2^2` is -4, `2^3^2` is 512;
//! * [functions](operation::FUNCTIONS).
//!
//! Computation is in SI, regardless of the units of numbers and parameters, and the units are checked: a sum of a
//! length and a speed is rejected, with the column and a suggested correction. Angles are pure numbers. If the base of
//! a power has a unit, the exponent has to be a number literal.
//!
//! A formula is processed by [`token`], [`parse`], [`check`] and [`evaluate`]; [`Term`] combines them with the
//! [place](hitch_plant::Place) where the term acts and its parameters.

pub mod check;
mod define;
pub mod definition;
pub mod evaluate;
pub mod operation;
pub mod parse;
mod probe;
pub mod term;
pub mod token;
pub mod tree;

pub use definition::{ParameterDefinition, Part, TermDefinition, TermError};
pub use term::Term;

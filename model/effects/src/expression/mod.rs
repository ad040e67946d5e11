//! Physical terms that a user writes into a model file, to be fitted like an effect of the catalogue.
//!
//! A formula such as `-c * ramp(1 - x / depth)` is made of
//! * numbers: `0.5`, `2e-3`, and with a unit `3[mm/s]`; without one they are pure numbers;
//! * [signals](hitch_plant::hooks::signals::SIGNALS) of the plant and the parameters of the term, by name;
//! * `+ - * / ^`, a minus in front and parentheses, with the precedence of mathematics: `-2^2` is -4, `2^3^2` is 512;
//! * [functions](operation::FUNCTIONS).
//!
//! Everything is SI inside, whatever unit a number or a parameter is written in, and the units are checked: a sum of a
//! length and a speed is refused, with the column and a way to mend it. Angles are pure numbers. Where the base of a
//! power has a unit, the exponent is a written number.
//!
//! A text takes its way through [`token`], [`parse`], [`check`] and [`evaluate`]; [`Term`] puts them together with the
//! [place](hitch_plant::Place) where the term acts and its parameters.

pub mod check;
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

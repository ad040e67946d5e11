//! The plant of an electro-hydraulic three-point hitch, its effects, measurements and identification.
#![forbid(unsafe_code)]

pub mod campaign;
pub mod effects;
pub mod expression;
mod file_kind;
pub mod identification;
pub mod input_error;
pub mod model;
pub mod model_file;
pub mod naming;
pub mod paper;
pub mod plant;
pub mod simulation;
pub mod source_file;
mod starting_points;
pub mod toml_reader;
pub mod units;

pub use model::Model;

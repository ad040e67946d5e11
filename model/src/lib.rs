//! The plant of an electro-hydraulic three-point hitch, its effects, measurements and identification.
#![forbid(unsafe_code)]

pub mod campaign;
pub mod input_error;
pub mod naming;
pub mod source_file;
pub mod toml_reader;

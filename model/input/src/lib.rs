//! Text files as input.
//!
//! * [`source_file`]: the text of a file, with positions in it;
//! * [`input_error`]: faults: what, where, and a suggested correction;
//! * [`toml_reader`]: checked access to TOML;
//! * [`naming`]: messages about unknown names;
//! * [`mod@unit`] and [`dimension`]: units of measurement and their syntax;
//! * [`written_unit`]: units as logs and other tools write them.
//!
//! Depends on no other crate of the project.
#![forbid(unsafe_code)]

pub mod dimension;
pub mod fault;
pub mod file_kind;
pub mod input_error;
pub mod little_endian;
pub mod naming;
pub mod source_file;
pub mod toml_reader;
pub mod unit;
pub mod written_unit;

pub use dimension::Dimension;
pub use fault::Fault;
pub use unit::Unit;

//! Text files as input.
//!
//! * [`source_file`]: the text of a file, and where in it something stands;
//! * [`input_error`]: what is wrong, where, and how to mend it;
//! * [`toml_reader`]: checked access to TOML;
//! * [`naming`]: what is said of a name that is not known;
//! * [`mod@unit`] and [`dimension`]: units of measurement as they are written.
//!
//! Depends on no other crate of the project.
#![forbid(unsafe_code)]

pub mod dimension;
pub mod fault;
pub mod file_kind;
pub mod input_error;
pub mod naming;
pub mod source_file;
pub mod toml_reader;
pub mod unit;

pub use dimension::Dimension;
pub use fault::Fault;
pub use unit::Unit;

//! The workbench: everything behind the program `hitch`.
#![forbid(unsafe_code)]

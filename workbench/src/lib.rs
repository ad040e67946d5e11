//! The workbench: everything behind the program `hitch`.
#![forbid(unsafe_code)]

pub mod calibrate;
pub mod closed_loop;
pub mod valve_survey;

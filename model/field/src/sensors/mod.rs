//! Sensors of draft and slip control.

pub mod draft_pins;
pub mod lagged;

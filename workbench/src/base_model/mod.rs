//! The model before any effect: what it takes from data sheets, and the fit of its constants.

pub mod data_sheet;
pub mod fit;

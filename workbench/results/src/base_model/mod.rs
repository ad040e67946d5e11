//! The model before any effect: what it takes from data sheets, and the fit of its constants.

pub mod data_sheet;
pub mod fit;
pub mod flow_curve;
pub mod linkage_table;
mod number_table;

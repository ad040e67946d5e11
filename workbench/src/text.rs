//! Text for a terminal: tables, wrapped lines, numbers and colours.
pub mod colour;
mod table;
mod width;

pub use table::Table;
pub use width::{indented, visible, width, wrapped};

/// A number with a fixed number of decimals; a dash for NaN.
#[must_use]
pub fn known(value: f64, decimals: usize) -> String {
    if value.is_finite() {
        format!("{value:.decimals$}")
    } else {
        "-".to_owned()
    }
}

//! The evidence of a result: the error map, and every run measured against simulated.

use maud::{Markup, html};

use super::error_map::error_map;
use super::run_views::{State, run_views};
use super::runs::runs;

/// The sections, of the initial model and of the final one if it differs.
pub fn evidence(before: State<'_>, after: Option<State<'_>>) -> Markup {
    html! {
        (error_map(before, after))
        h2 { "Measured against simulated" }
        (runs(&run_views(before, after)))
    }
}

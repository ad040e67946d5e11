//! Figures of a scenario of the field as a table, for terminal and report.

use crate::closed_loop::ScenarioFigure;
use hitch_output::text::{Table, known};

/// Header of the table.
pub const HEADER: [&str; 3] = ["figure", "value", "required"];

/// Row of a figure under [`HEADER`].
#[must_use]
pub fn row(figure: &ScenarioFigure) -> [String; 3] {
    let with_unit = |value: f64| {
        format!("{} {}", known(value, 2), figure.unit)
            .trim_end()
            .to_owned()
    };
    let required = match (figure.required, figure.is_met()) {
        (None, _) => String::new(),
        (Some(most), true) => format!("at most {}", with_unit(most)),
        (Some(most), false) => format!("at most {}: missed", with_unit(most)),
    };
    [figure.name.clone(), with_unit(figure.value), required]
}

/// The figures as a table for a terminal.
#[must_use]
pub fn text(figures: &[ScenarioFigure]) -> String {
    format!("{}\n", Table::of(HEADER, figures.iter().map(row)))
}

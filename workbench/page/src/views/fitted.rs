//! The constants of the present model that a fit moves, and the fit of the first model, if there was one.

use hitch_identification::constants::movable::Movable;
use hitch_identification::constants::tolerances::Own;
use schemars::JsonSchema;
use serde::Serialize;

use crate::session::Session;
use hitch_output::text::significant;
use hitch_results::base_model::fit::{ShownBaseFit, ShownConstant, digits};

/// The constants of a session.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Constants {
    /// Those that a fit moves.
    pub movable: Vec<MovableConstant>,
    /// The fit of the first model's.
    pub fitted: Option<FittedConstants>,
}

/// A constant that a fit moves.
#[derive(Debug, Serialize, JsonSchema)]
pub struct MovableConstant {
    /// Its name in a model file.
    pub name: String,
    /// Its declared value with the unit, of currents the threshold; of a curve, that it is one.
    pub declared: String,
    /// Its usual tolerance, as a user gives one.
    pub usual: String,
}

/// Constants that were fitted.
#[derive(Debug, Serialize, JsonSchema)]
pub struct FittedConstants {
    /// Error of the declared model, sigma.
    pub error_before: f64,
    /// Error of the fitted model, sigma.
    pub error_after: f64,
    /// Headings of the table.
    pub headings: Vec<&'static str>,
    /// Its rows.
    pub rows: Vec<FittedRow>,
    /// Constants that the campaign does not determine.
    pub not_determined: Vec<String>,
    /// Constants at the end of their allowed deviation.
    pub at_an_end: Vec<String>,
}

/// A fitted constant.
#[derive(Debug, Serialize, JsonSchema)]
pub struct FittedRow {
    /// Cells as text.
    pub cells: Vec<String>,
    /// Whether it moved further than its tolerance.
    pub beyond: bool,
}

impl Constants {
    /// The constants of the present model, from which a fit starts.
    pub fn of(session: &Session) -> Self {
        let movable = Movable::all(session.rebuilt().constants());
        let fitted = session.subject().fitted.as_ref();
        Self {
            movable: movable.into_iter().map(MovableConstant::of).collect(),
            fitted: fitted.map(FittedConstants::of),
        }
    }
}

impl MovableConstant {
    fn of(one: Movable) -> Self {
        let declared = one.declared.map(digits);
        Self {
            name: one.name,
            declared: declared.map_or("a curve".to_owned(), |value| {
                format!("{value} {}", one.unit)
            }),
            usual: match one.usual {
                Own::Share(share) => format!("{} %", significant(100.0 * share, 2)),
                Own::Value(value) => significant(value, 2),
            },
        }
    }
}

impl FittedConstants {
    fn of(fit: &ShownBaseFit) -> Self {
        let determined = fit.constants.iter().filter(|one| one.determined);
        let row = |constant: &ShownConstant| FittedRow {
            cells: constant.cells().to_vec(),
            beyond: constant.is_beyond(),
        };
        Self {
            error_before: fit.error_before,
            error_after: fit.error_after,
            headings: ShownConstant::HEADINGS.to_vec(),
            rows: determined.map(row).collect(),
            not_determined: fit.not_determined.clone(),
            at_an_end: fit.at_an_end.clone(),
        }
    }
}

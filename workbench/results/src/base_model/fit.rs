//! Result of `hitch model fit`, as JSON and as text.

use std::fmt;

use hitch_identification::base::{BaseFit, CurvePoint, FittedConstant};
use hitch_identification::data::experiment::Experiment;
use hitch_plant::Model;
use schemars::JsonSchema;
use serde::Serialize;

use hitch_output::text::colour::sigma;
use hitch_output::text::{Table, joined, wrapped};

/// Result of `hitch model fit`.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ShownBaseFit {
    /// Name of the campaign.
    pub campaign: String,
    /// Name of the declared model.
    pub model: String,
    /// Error of the declared model, in sigma.
    pub error_before: f64,
    /// Error of the fitted model, in sigma.
    pub error_after: f64,
    /// The constants.
    pub constants: Vec<ShownConstant>,
    /// The flow curves, point by point.
    pub curves: Vec<ShownPoint>,
    /// Constants that the campaign does not determine.
    pub not_determined: Vec<String>,
    /// Constants at the end of their allowed deviation from the declared value.
    pub at_an_end: Vec<String>,
    /// The next command.
    pub next: String,
}

/// A constant.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ShownConstant {
    /// Name in a model file.
    pub name: String,
    /// Unit of the values.
    pub unit: &'static str,
    /// Declared value, in the unit.
    pub declared: f64,
    /// Fitted value, in the unit.
    pub fitted: f64,
    /// Tolerance of the declared value before the fit: one sigma, in the unit.
    pub tolerance: f64,
    /// Lower end of the 95 % interval, in the unit; `null` if it is unknown.
    #[schemars(with = "Option<f64>")]
    pub low: f64,
    /// Upper end of the 95 % interval, in the unit; `null` if it is unknown.
    #[schemars(with = "Option<f64>")]
    pub high: f64,
    /// Whether the campaign determines it.
    pub determined: bool,
}

/// A point of a flow curve.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ShownPoint {
    /// Table of the valve.
    pub valve: &'static str,
    /// Current, A.
    pub current_a: f64,
    /// Declared flow, l/min.
    pub declared_lpm: f64,
    /// Fitted flow, l/min.
    pub fitted_lpm: f64,
    /// Lower end of the 95 % interval, l/min; `null` if it is unknown.
    #[schemars(with = "Option<f64>")]
    pub low_lpm: f64,
    /// Upper end of the 95 % interval, l/min; `null` if it is unknown.
    #[schemars(with = "Option<f64>")]
    pub high_lpm: f64,
    /// Whether the campaign determines it.
    pub determined: bool,
}

impl ShownBaseFit {
    /// The result for display.
    #[must_use]
    pub fn new(experiment: &Experiment, declared: &Model, fit: &BaseFit, next: String) -> Self {
        let constants: Vec<ShownConstant> = fit.constants.iter().map(ShownConstant::new).collect();
        let curves: Vec<ShownPoint> = fit.curves.iter().map(ShownPoint::new).collect();
        let unknown_constants = constants.iter().filter(|constant| !constant.determined);
        let unknown_points = curves.iter().filter(|point| !point.determined);
        let not_determined = unknown_constants
            .map(|constant| constant.name.clone())
            .chain(
                unknown_points.map(|point| format!("{} at {:.3} A", point.valve, point.current_a)),
            )
            .collect();
        let ended = fit.constants.iter().filter(|constant| constant.at_an_end);
        Self {
            campaign: experiment.name.clone(),
            model: declared.name.clone(),
            error_before: fit.before.error(),
            error_after: fit.after.error(),
            not_determined,
            at_an_end: ended.map(|constant| constant.name.clone()).collect(),
            constants,
            curves,
            next,
        }
    }
}

impl ShownConstant {
    /// Column headings of [`ShownConstant::cells`].
    pub const HEADINGS: [&'static str; 6] = [
        "constant",
        "declared",
        "fitted",
        "95 % interval",
        "unit",
        "",
    ];

    /// Whether the fit moved it further than the tolerance of its data sheet.
    #[must_use]
    pub fn is_beyond(&self) -> bool {
        (self.fitted - self.declared).abs() > self.tolerance.abs()
    }

    /// The mark of a constant that [`ShownConstant::is_beyond`]; else empty.
    #[must_use]
    pub fn mark(&self) -> &'static str {
        if self.is_beyond() {
            "beyond its tolerance"
        } else {
            ""
        }
    }

    /// Its row in a table.
    #[must_use]
    pub fn cells(&self) -> [String; 6] {
        [
            self.name.clone(),
            digits(self.declared),
            digits(self.fitted),
            if self.low.is_nan() {
                "withheld".to_owned()
            } else {
                format!("{} to {}", digits(self.low), digits(self.high))
            },
            self.unit.to_owned(),
            self.mark().to_owned(),
        ]
    }

    /// The constant for display.
    #[must_use]
    pub fn new(fitted: &FittedConstant) -> Self {
        Self {
            name: fitted.name.clone(),
            unit: fitted.unit,
            declared: fitted.declared,
            fitted: fitted.fitted,
            tolerance: fitted.tolerance,
            low: fitted.interval.0,
            high: fitted.interval.1,
            determined: fitted.determined,
        }
    }
}

impl ShownPoint {
    /// The point for display.
    #[must_use]
    pub fn new(fitted: &CurvePoint) -> Self {
        Self {
            valve: fitted.valve.key(),
            current_a: fitted.current_a,
            declared_lpm: fitted.declared_lpm,
            fitted_lpm: fitted.fitted_lpm,
            low_lpm: fitted.interval_lpm.0,
            high_lpm: fitted.interval_lpm.1,
            determined: fitted.determined,
        }
    }
}

impl fmt::Display for ShownBaseFit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let head = format!(
            "Campaign {}, model {}: error {} sigma before the fit, {} sigma after it",
            self.campaign,
            self.model,
            sigma(self.error_before),
            sigma(self.error_after)
        );
        writeln!(f, "{}\n", wrapped(&head))?;
        let (determined, unknown): (Vec<&ShownConstant>, Vec<&ShownConstant>) = self
            .constants
            .iter()
            .partition(|constant| constant.determined);
        let constants = determined.into_iter().map(ShownConstant::cells);
        writeln!(f, "{}", Table::of(ShownConstant::HEADINGS, constants))?;
        let point = |point: &ShownPoint| {
            [
                point.valve.to_owned(),
                format!("{:.3}", point.current_a),
                digits(point.declared_lpm),
                digits(point.fitted_lpm),
                format!("{} to {}", digits(point.low_lpm), digits(point.high_lpm)),
                if point.determined {
                    String::new()
                } else {
                    "interpolated from neighbours".to_owned()
                },
            ]
        };
        let header = [
            "valve",
            "A",
            "declared l/min",
            "fitted",
            "95 % interval",
            "",
        ];
        writeln!(f, "{}", Table::of(header, self.curves.iter().map(point)))?;
        if !unknown.is_empty() {
            let line = format!(
                "Not determined by this campaign, declared value kept: {}.",
                joined(unknown.iter().map(|constant| &constant.name), ", ")
            );
            writeln!(f, "{}", wrapped(&line))?;
        }
        if !self.at_an_end.is_empty() {
            let line = format!(
                "At the limit of the allowed deviation from the declared value, check the data sheet: {}.",
                self.at_an_end.join(", ")
            );
            writeln!(f, "{}", wrapped(&line))?;
        }
        writeln!(f, "{}", wrapped(&format!("Next: {}", self.next)))
    }
}

/// A number with four significant digits.
#[must_use]
pub fn digits(value: f64) -> String {
    let size = value.abs().log10().floor();
    match size.is_finite() {
        true if size > 5.0 => format!("{value:.3e}"),
        true => format!("{value:.*}", (3.0 - size).max(0.0) as usize),
        false => format!("{value}"),
    }
}

//! What a plot is drawn from: a run with its channels, or rows with lines.
//!
//! `S` are the samples of a signal and `T` those of the abscissa: numbers on the page, [compact](crate::report) in a report,
//! whose script expands them.

use schemars::JsonSchema;
use serde::Serialize;

/// Samples of a signal, in its unit; `null` where there is none.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct Samples(#[schemars(with = "Vec<Option<f64>>")] pub Vec<f64>);

impl Samples {
    /// A copy of some samples.
    pub fn of(samples: &[f64]) -> Self {
        Self(samples.to_vec())
    }
}

/// A run as a plot.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "RunPlot")]
pub struct RunPlot<T, S> {
    /// Names of the lines, where they are not the usual ones.
    pub names: Option<LineNames>,
    /// Time stamps, s.
    pub time_s: T,
    /// Current of the lift valve, A.
    pub lift_current_a: S,
    /// Current of the lowering valve, A.
    pub lower_current_a: S,
    /// The measured channels.
    pub channels: Vec<RunChannel<S>>,
}

/// Names of the lines of a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, JsonSchema)]
pub struct LineNames {
    /// Of the first model.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first: Option<&'static str>,
    /// Of the model.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub simulated: Option<&'static str>,
    /// Of the second model.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub second: Option<String>,
}

/// A channel of a run: samples in its unit, residuals and errors in sigma.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "RunChannel")]
pub struct RunChannel<S> {
    /// Key.
    pub key: &'static str,
    /// Name for a reader.
    pub title: &'static str,
    /// Unit of the samples.
    pub unit: &'static str,
    /// Error of the model.
    pub error: f64,
    /// Measured.
    pub measured: S,
    /// Simulated by the model.
    pub simulated: S,
    /// Residuals of the model.
    pub residual: S,
    /// Simulated by the first model, if it is another one.
    pub first: Option<S>,
    /// Residuals of the first model.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first_residual: Option<S>,
    /// The second model.
    pub second: Option<SimulatedChannel<S>>,
}

/// A channel as a model simulates it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "SimulatedChannel")]
pub struct SimulatedChannel<S> {
    /// Samples, in the unit of the channel.
    pub simulated: S,
    /// Residuals, sigma.
    pub residual: S,
    /// Error, sigma.
    pub error: f64,
}

/// A plot with rows of its own.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "RowPlot")]
pub struct RowPlot<T, S> {
    /// Title of the abscissa, with its unit.
    pub x_title: String,
    /// Ends of the abscissa.
    pub span: [f64; 2],
    /// The common abscissa.
    pub time_s: T,
    /// The rows.
    pub rows: Vec<PlotRow<T, S>>,
}

/// A row of a plot.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "PlotRow")]
pub struct PlotRow<T, S> {
    /// Title.
    pub title: String,
    /// Unit of its values.
    pub unit: String,
    /// Preferred height, px.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
    /// Its lines.
    pub lines: Vec<PlotLine<T, S>>,
}

/// A line of a row.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "PlotLine")]
pub struct PlotLine<T, S> {
    /// Name.
    pub name: String,
    /// Lines with the same key share an entry of the legend.
    pub key: String,
    /// Name of its colour.
    pub colour: &'static str,
    /// Its dashes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dash: Option<&'static str>,
    /// Its width, px.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub width: Option<f64>,
    /// Its own abscissa.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x: Option<T>,
    /// Its values.
    pub y: S,
}

//! Test for an unsuitable base model: another machine, or a base that was never fitted.

use hitch_campaign::Bench;
use hitch_plant::Channel;

use crate::adequacy::lack_of_fit::{Cell, cells};
use crate::data::experiment::Experiment;
use crate::data::regime::Regime;
use crate::estimation::fit::Fit;

/// Root mean square error, in sigma, over all channels and in each channel, above which the base is suspected.
const FAR: f64 = 10.0;
const FAR_IN_A_CHANNEL: f64 = 3.0;

/// Share of the judged cells with lack of fit, before effects are added and with them, above which the base is
/// unsuitable.
const MOST: f64 = 0.9;
const STILL_MOST: f64 = 0.5;

/// Whether the error of `before` is large in every measured channel and in nearly every cell, and the effects of
/// `after` leave most cells with lack of fit.
#[must_use]
pub fn is_unsuitable(experiment: &Experiment, before: &Fit, after: &Fit) -> bool {
    let mut measured = (0..4).filter(|&channel| before.weights.counts[channel] > 0);
    let is_far = before.error() > FAR
        && measured.all(|channel| before.channel_error(channel) > FAR_IN_A_CHANNEL);
    is_far
        && wrong_share(&cells(experiment, before)) > MOST
        && wrong_share(&cells(experiment, after)) > STILL_MOST
}

/// Share of the judged cells with lack of fit.
#[must_use]
pub fn wrong_share(cells: &[Cell]) -> f64 {
    let judged: Vec<&Cell> = cells.iter().filter(|cell| is_judged(cell)).collect();
    let wrong = judged.iter().filter(|cell| cell.excess() > 1.0).count();
    wrong as f64 / judged.len().max(1) as f64
}

/// Whether a cell depends on the machine: any model fits a hitch at rest, and a flow bench prescribes the pressure at
/// its port.
fn is_judged(cell: &Cell) -> bool {
    let is_set =
        matches!(cell.bench, Bench::Flow { .. }) && cell.channel == Channel::CylinderPressure;
    cell.regime != Regime::Holding && !is_set
}

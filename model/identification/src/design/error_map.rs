//! Where a campaign's unexplained error is: by valve, opening and position.

use std::collections::BTreeMap;
use std::fmt;

use hitch_campaign::{Bench, Run};
use hitch_plant::{Channel, Currents, Model, Valve};

use crate::data::experiment::Experiment;
use crate::data::ready_run::ReadyRun;
use crate::design::levels::Levels;
use crate::design::plan::Manoeuvre;
use crate::estimation::fit::Fit;

/// Parts of a valve's range of currents, and of the swing.
const OPENINGS: f64 = 4.0;
const PLACES: f64 = 5.0;

/// Time in a cell, s, after which more of it shows nothing new.
const ENOUGH_S: f64 = 1.0;

/// State of the hitch, coarsely.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Cell {
    /// The driven valve, and which part of its range.
    driven: Option<(bool, u8)>,
    /// Part of the swing; `None` on a flow bench.
    place: Option<u8>,
}

/// Squared residuals beyond noise.
#[derive(Debug, Clone, Copy, Default)]
struct Error {
    squares: f64,
    samples: f64,
}

impl Error {
    fn mean(self) -> f64 {
        self.squares / self.samples.max(1.0)
    }
}

/// The error over the cells that a campaign visits.
#[derive(Debug)]
pub struct ErrorMap {
    errors: BTreeMap<Cell, Error>,
}

impl ErrorMap {
    /// The map of what a fit leaves.
    #[must_use]
    pub fn of(experiment: &Experiment, fit: &Fit, model: &Model, levels: &Levels) -> Self {
        let mut errors: BTreeMap<Cell, Error> = BTreeMap::new();
        for (run, residuals) in experiment.runs.iter().zip(&fit.residuals) {
            for sample in 0..run.len() {
                let all = residuals.iter().skip(sample).step_by(run.len());
                let compared = all.filter(|residual| **residual != 0.0);
                let error = errors
                    .entry(cell_of_sample(run, sample, model, levels))
                    .or_default();
                for residual in compared {
                    error.squares += residual * residual - 1.0;
                    error.samples += 1.0;
                }
            }
        }
        Self { errors }
    }

    /// What a simulated log of a manoeuvre shows of the error: the mean square beyond noise of each cell, times the time
    /// in it up to a second.
    #[must_use]
    pub fn shown_by(
        &self,
        manoeuvre: &Manoeuvre,
        model: &Model,
        levels: &Levels,
        rate_hz: f64,
    ) -> f64 {
        let mut times_s: BTreeMap<Cell, f64> = BTreeMap::new();
        for log in manoeuvre.log(model, rate_hz, Channel::ALL.map(|_| true)) {
            for sample in 0..log.time_s.len() {
                *times_s
                    .entry(cell_of_log(&log, sample, model, levels))
                    .or_default() += 1.0 / rate_hz;
            }
        }
        let shown = times_s.iter().map(|(cell, time_s)| {
            let error = self.errors.get(cell).copied().unwrap_or_default();
            error.mean().max(0.0) * time_s.min(ENOUGH_S)
        });
        shown.sum()
    }

    /// Where most of the error is, in words; `None` if it is not beyond noise anywhere.
    #[must_use]
    pub fn worst(&self) -> Option<String> {
        let largest = self
            .errors
            .iter()
            .max_by(|a, b| a.1.squares.total_cmp(&b.1.squares));
        largest
            .filter(|(_, error)| error.squares > 0.0)
            .map(|(cell, _)| cell.to_string())
    }
}

fn cell_of_sample(run: &ReadyRun, sample: usize, model: &Model, levels: &Levels) -> Cell {
    let angle_deg = run.measured[Channel::RockerAngle.index()]
        .as_ref()
        .map(|angle| angle[sample]);
    let on_hitch = run.on_hitch().then(|| angle_deg.unwrap_or(f64::NAN));
    cell(run.drive.currents[sample], on_hitch, model, levels)
}

fn cell_of_log(log: &Run, sample: usize, model: &Model, levels: &Levels) -> Cell {
    let currents = Currents {
        lift_a: log.lift_current_a[sample],
        lower_a: log.lower_current_a[sample],
    };
    let angle_deg = log.channel(Channel::RockerAngle).map(|angle| angle[sample]);
    let on_hitch = matches!(log.bench, Bench::Hitch { .. }).then(|| angle_deg.unwrap_or(f64::NAN));
    cell(currents, on_hitch, model, levels)
}

/// The cell of a sample; the angle is in degree on a hitch, and not a number if it is not measured.
fn cell(currents: Currents, angle_deg: Option<f64>, model: &Model, levels: &Levels) -> Cell {
    let part = |share: f64, parts: f64| (share * parts).floor().clamp(0.0, parts - 1.0) as u8;
    let shares = [
        (Valve::Lift, currents.lift_a),
        (Valve::Lower, currents.lower_a),
    ]
    .map(|(valve, current_a)| {
        let range = match valve {
            Valve::Lift => levels.lift,
            Valve::Lower => levels.lower,
        };
        (valve == Valve::Lift, range.opening(current_a))
    });
    let driven = shares.into_iter().find(|(_, share)| *share > 0.0);
    let (low_rad, high_rad) = model.linkage().swing_rad();
    let place = angle_deg.map(|deg| {
        if deg.is_nan() {
            0.5
        } else {
            (deg.to_radians() - low_rad) / (high_rad - low_rad)
        }
    });
    Cell {
        driven: driven.map(|(lifts, share)| (lifts, part(share, OPENINGS))),
        place: place.map(|share| part(share, PLACES)),
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.driven {
            None => f.write_str("with both valves off")?,
            Some((lifts, part)) => {
                let motion = if lifts { "lifting" } else { "lowering" };
                let opening = ["little", "less than half", "more than half", "nearly fully"];
                let opening = opening[usize::from(part).min(opening.len() - 1)];
                write!(f, "while {motion} with the valve {opening} open")?;
            }
        }
        match self.place {
            None => f.write_str(" on the flow bench"),
            Some(0) => f.write_str(" near the bottom"),
            Some(1..=3) => f.write_str(" at mid-stroke"),
            Some(_) => f.write_str(" near the top"),
        }
    }
}

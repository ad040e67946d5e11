//! Cylinder pressure at rest against the weight of the load.

use hitch_plant::{Channel, units};

use crate::lifting::lifting;
use crate::logs::{Logs, Open, extremes};
use crate::statistics::{median, spread_about};

/// Shortest rest whose median counts, samples.
const FEWEST: usize = 10;
/// Fewest runs for a line that two wrong runs do not bend: Theil and Sen's stands 29 % of wrong points.
const FEWEST_RUNS: usize = 7;

/// Pressure at rest of a run.
#[derive(Debug, Clone)]
pub(crate) struct Rest {
    /// Index of the run.
    pub run: usize,
    /// Load as weighed, kg.
    pub load_kg: f64,
    /// Its levels, in the order of time; the last one may be that of lifting.
    levels: Vec<Level>,
    /// The level that fits the other runs best.
    pub best: Level,
}

/// A pressure that a run holds for a while.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Level {
    /// Pressure, bar.
    pub measured_bar: f64,
    /// Pressure, bar, of the weight; without a model, the load in kg.
    pub weight: f64,
    /// Its derivative over the load, 1/kg.
    pub per_kg: f64,
}

/// Straight line of the pressures at rest over those of the weights.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line {
    /// Pressure without weight, bar.
    pub zero_bar: f64,
    /// Slope, bar per unit of weight.
    pub slope: f64,
    /// Robust standard deviation of the runs about it, bar.
    pub spread_bar: f64,
}

/// The pressures at rest, and their line. The ground may carry the load in some rests, and the end stop hold the relief pressure: of each
/// run, the level counts that fits the line best, at first that of its first rest.
pub(crate) fn rests(logs: &Logs) -> (Vec<Rest>, Option<Line>) {
    let hitches = logs.hitches().map(|(run, _, load_kg)| (run, load_kg));
    let rest = |(run, load_kg)| {
        let levels = levels(logs, run, load_kg);
        levels.first().copied().map(|best| Rest {
            run,
            load_kg,
            levels,
            best,
        })
    };
    let mut rests: Vec<Rest> = hitches.filter_map(rest).collect();
    let line = Line::through(&mut rests);
    (rests, line)
}

/// The levels of a run: its rests, and lifting.
fn levels(logs: &Logs, run: usize, load_kg: f64) -> Vec<Level> {
    let log = &logs.runs()[run];
    let Some(pressure) = log.channel(Channel::CylinderPressure) else {
        return Vec::new();
    };
    let settled = logs.settled(run, Open::Neither).into_iter();
    let rests = settled.map(Iterator::collect::<Vec<usize>>);
    let long = rests
        .chain([lifting(logs, run)])
        .filter(|samples| samples.len() >= FEWEST);
    let level = |samples: Vec<usize>| {
        let middle = |values: &[f64]| median(samples.iter().map(|&i| values[i]));
        let angle_deg = log.channel(Channel::RockerAngle).map(middle);
        let (weight, per_kg) = weight(logs, load_kg, angle_deg);
        Level {
            measured_bar: middle(pressure),
            weight,
            per_kg,
        }
    };
    long.map(level)
        .filter(|level| level.measured_bar.is_finite())
        .collect()
}

/// Weight of a load at an angle in degrees, and its derivative over the load.
fn weight(logs: &Logs, load_kg: f64, angle_deg: Option<f64>) -> (f64, f64) {
    let Some(model) = logs.model else {
        return (load_kg, 1.0);
    };
    let constants = model.constants();
    let middle_m = 0.5 * constants.cylinder.stroke_m;
    let known = angle_deg.filter(|deg| deg.is_finite());
    let piston_m = known.map_or(middle_m, |deg| model.linkage().piston_m(deg.to_radians()));
    let dh_dx = model.linkage().dh_dx(piston_m);
    let bar = |n: f64| units::bar_from_pa(n / constants.cylinder.area_m2());
    let force_n = constants.masses.weight_force_n(load_kg, dh_dx);
    (bar(force_n), bar(units::GRAVITY_M_S2 * dh_dx))
}

impl Line {
    /// The line of Theil and Sen through the best level of each run; `None` for few runs or a single load.
    pub fn through(rests: &mut [Rest]) -> Option<Self> {
        let mut line = Self::of(rests)?;
        for _ in 0..3 {
            for rest in rests.iter_mut() {
                let off = |level: &&Level| line.excess_bar(level).abs();
                let best = rest.levels.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
                rest.best = best.copied().unwrap_or(rest.best);
            }
            line = Self::of(rests)?;
        }
        Some(line)
    }

    fn of(rests: &[Rest]) -> Option<Self> {
        let mut slopes = Vec::new();
        for (at, a) in rests.iter().enumerate() {
            let apart = |b: &&Rest| (a.load_kg - b.load_kg).abs() > 0.1 * a.load_kg;
            let slope = |b: &Rest| {
                (a.best.measured_bar - b.best.measured_bar) / (a.best.weight - b.best.weight)
            };
            slopes.extend(rests[..at].iter().filter(apart).map(slope));
        }
        if rests.len() < FEWEST_RUNS || slopes.is_empty() {
            return None;
        }
        let slope = median(slopes);
        let level = |rest: &Rest| rest.best.measured_bar - slope * rest.best.weight;
        let zero_bar = median(rests.iter().map(level));
        let line = Self {
            zero_bar,
            slope,
            spread_bar: 0.0,
        };
        let excess = rests.iter().map(|rest| line.excess_bar(&rest.best));
        let spread_bar = spread_about(excess, 0.0);
        Some(Self { spread_bar, ..line })
    }

    /// Pressure on the line, bar.
    pub fn bar(&self, level: &Level) -> f64 {
        self.zero_bar + self.slope * level.weight
    }

    /// Pressure above the line, bar.
    pub fn excess_bar(&self, level: &Level) -> f64 {
        level.measured_bar - self.bar(level)
    }
}

impl Rest {
    /// Half the range of the run's levels about the line, bar: what friction may hold.
    pub fn band_bar(&self, line: &Line) -> f64 {
        let excess: Vec<f64> = self
            .levels
            .iter()
            .map(|level| line.excess_bar(level))
            .collect();
        let (low, high) = extremes(&excess);
        0.5 * (high - low)
    }
}

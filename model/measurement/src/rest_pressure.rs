//! Cylinder pressure at rest against the weight of the load.

use hitch_plant::{Channel, units};

use crate::lifting::lifting;
use crate::logs::{Logs, Open};
use crate::statistics::{median, median_of_several};

/// Fewest runs for a line that two wrong runs do not bend: Theil and Sen's stands 29 % of wrong points.
const FEWEST_RUNS: usize = 7;

/// The pressures that a run on a hitch holds. The ground may carry the load in some rests, and the end stop hold the relief pressure.
#[derive(Debug, Clone)]
pub(crate) struct Rest {
    /// Index of the run.
    pub run: usize,
    /// In the order of time; the last one may be that of lifting.
    levels: Vec<Level>,
}

/// A pressure that a run holds for a while.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Level {
    /// Load as weighed, kg.
    pub load_kg: f64,
    /// Pressure, bar.
    pub measured_bar: f64,
    /// Pressure, bar, of the weight; without a model, the load in kg.
    weight: f64,
    /// Its derivative over the load, 1/kg.
    per_kg: f64,
}

/// Straight line of the pressures at rest over those of the weights.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line {
    /// Pressure without weight, bar.
    zero_bar: f64,
    /// Slope, bar per unit of weight.
    slope: f64,
}

/// The pressures at rest of the runs on a hitch.
pub(crate) fn rests(logs: &Logs) -> Vec<Rest> {
    let hitches = logs.hitches();
    let rests = hitches.map(|(run, _, load_kg)| Rest {
        run,
        levels: levels(logs, run, load_kg).unwrap_or_default(),
    });
    rests.filter(|rest| !rest.levels.is_empty()).collect()
}

/// The levels of a run: its rests, and lifting.
fn levels(logs: &Logs, run: usize, load_kg: f64) -> Option<Vec<Level>> {
    let log = &logs.runs()[run];
    let pressure = log.channel(Channel::CylinderPressure)?;
    let settled = logs.settled(run, Open::Neither).into_iter();
    let samples = settled.map(Iterator::collect::<Vec<usize>>);
    let level = |samples: Vec<usize>| {
        let middle = |values: &[f64]| median_of_several(samples.iter().map(|&i| values[i]));
        let angle_deg = log.channel(Channel::RockerAngle).and_then(middle);
        let (weight, per_kg) = weight(logs, load_kg, angle_deg);
        Some(Level {
            load_kg,
            measured_bar: middle(pressure)?,
            weight,
            per_kg,
        })
    };
    Some(
        samples
            .chain([lifting(logs, run)])
            .filter_map(level)
            .collect(),
    )
}

/// Weight of a load at an angle in degrees, and its derivative over the load.
fn weight(logs: &Logs, load_kg: f64, angle_deg: Option<f64>) -> (f64, f64) {
    let Some(model) = logs.model else {
        return (load_kg, 1.0);
    };
    let constants = model.constants();
    let middle_m = 0.5 * constants.cylinder.stroke_m;
    let piston_m = angle_deg.map_or(middle_m, |deg| model.linkage().piston_m(deg.to_radians()));
    let dh_dx = model.linkage().dh_dx(piston_m);
    let bar = |n: f64| units::bar_from_pa(n / constants.cylinder.area_m2());
    let force_n = constants.masses.weight_force_n(load_kg, dh_dx);
    (bar(force_n), bar(units::GRAVITY_M_S2 * dh_dx))
}

impl Rest {
    /// The level nearest to a line.
    pub fn best(&self, line: &Line) -> Level {
        let off = |level: &Level| (level.measured_bar - line.bar(level)).abs();
        let nearer = |a: Level, b: Level| if off(&b) < off(&a) { b } else { a };
        self.levels
            .iter()
            .copied()
            .reduce(nearer)
            .unwrap_or(self.levels[0])
    }
}

impl Line {
    /// The weight itself.
    pub const WEIGHT: Self = Self {
        zero_bar: 0.0,
        slope: 1.0,
    };

    /// The line of Theil and Sen through the level of each run that is nearest to it, at first that of its first rest; `None` for few
    /// runs or a single load.
    pub fn through(rests: &[Rest]) -> Option<Self> {
        let first = Self::of(&rests.iter().map(|rest| rest.levels[0]).collect::<Vec<_>>())?;
        Self::of(
            &rests
                .iter()
                .map(|rest| rest.best(&first))
                .collect::<Vec<_>>(),
        )
    }

    fn of(levels: &[Level]) -> Option<Self> {
        let pairs = levels
            .iter()
            .flat_map(|a| levels.iter().map(move |b| (a, b)));
        let apart = pairs.filter(|(a, b)| b.load_kg < 0.9 * a.load_kg);
        let slopes = apart.map(|(a, b)| (a.measured_bar - b.measured_bar) / (a.weight - b.weight));
        let slope = median(slopes);
        let zero_bar = median(
            levels
                .iter()
                .map(|level| level.measured_bar - slope * level.weight),
        );
        (levels.len() >= FEWEST_RUNS && slope.is_finite()).then_some(Self { zero_bar, slope })
    }

    /// Pressure on the line, bar.
    pub fn bar(&self, level: &Level) -> f64 {
        self.zero_bar + self.slope * level.weight
    }

    /// Pressure of a kilogram, bar.
    pub fn bar_per_kg(&self, level: &Level) -> f64 {
        self.slope * level.per_kg
    }
}

//! Currents, loads and port pressures for the manoeuvres of one machine.

use hitch_campaign::Bench;
use hitch_plant::{Currents, HitchRig, Model, Plant, Rig, ValveCurve, units};

use crate::data::experiment::Experiment;
use crate::design::plan::USUAL_OIL_C;

/// Positions of the swing at which the load that the machine can lift is determined.
const POSITIONS: [f64; 3] = [0.06, 0.5, 0.94];

/// Share of the relief setting that a load may need at rest.
const USED: f64 = 0.9;

/// Ratio of the heaviest to the lightest load above which two loads show what depends on pressure.
const APART: f64 = 2.0;

/// Light and heavy load over the middle one, unless the campaign has different loads.
const LIGHT: f64 = 1.0 / 3.0;
const HEAVY: f64 = 5.0 / 3.0;

/// Middle load over the largest that the machine can lift, for a campaign without loads.
const MIDDLE: f64 = 0.3;

/// Levels of a machine.
#[derive(Debug, Clone, PartialEq)]
pub struct Levels {
    /// Currents of the lift valve.
    pub lift: ValveRange,
    /// Currents of the lowering valve.
    pub lower: ValveRange,
    /// Loads on the hitch, kg: those of the campaign if they are at least a factor of two apart.
    pub light_kg: f64,
    /// See `light_kg`.
    pub middle_kg: f64,
    /// See `light_kg`.
    pub heavy_kg: f64,
    /// Largest load that 90 % of the relief setting holds all over the swing, kg.
    pub capacity_kg: f64,
    /// Relief setting, bar.
    pub relief_bar: f64,
}

/// Currents of a valve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ValveRange {
    threshold_a: f64,
    full_a: f64,
    last_a: f64,
}

impl ValveRange {
    /// The range of a flow curve.
    #[must_use]
    pub fn of(curve: &ValveCurve) -> Self {
        let currents = curve.currents_a();
        Self {
            threshold_a: curve.threshold_a(),
            full_a: curve.full_opening_a(),
            last_a: currents[currents.len() - 1],
        }
    }

    /// Current at an opening, A: 0 is the threshold, 1 full opening; at most the last current of the flow curve. Rounded to
    /// what an engineer sets.
    #[must_use]
    pub fn current_a(self, opening: f64) -> f64 {
        let current_a = self.threshold_a + opening * (self.full_a - self.threshold_a);
        self.rounded(current_a.clamp(0.0, self.last_a))
    }

    /// The opening at a current, A: 0 at the threshold, 1 at full opening.
    #[must_use]
    pub fn opening(self, current_a: f64) -> f64 {
        (current_a - self.threshold_a) / (self.full_a - self.threshold_a).max(f64::MIN_POSITIVE)
    }

    /// Difference of two currents whose openings differ by this, A.
    #[must_use]
    pub fn span_a(self, openings: f64) -> f64 {
        self.rounded(openings * (self.full_a - self.threshold_a))
    }

    /// Rounded to a hundredth of the order of magnitude of the range.
    fn rounded(self, current_a: f64) -> f64 {
        let per_unit = 10_f64.powi(self.decimals() as i32);
        (current_a * per_unit).round() / per_unit
    }

    /// Decimals of its currents in A.
    #[must_use]
    pub fn decimals(self) -> usize {
        let range_a = (self.full_a - self.threshold_a).max(1e-3);
        (2.0 - range_a.log10().floor()).clamp(0.0, 6.0) as usize
    }
}

impl Levels {
    /// The levels of a machine with the loads of a campaign.
    #[must_use]
    pub fn new(experiment: &Experiment, model: &Model) -> Self {
        let constants = model.constants();
        let relief_bar = units::bar_from_pa(constants.relief_valve.set_pressure_pa);
        let capacity_kg = capacity_kg(model, USED * relief_bar);
        let [light_kg, middle_kg, heavy_kg] = loads_kg(experiment, capacity_kg);
        Self {
            lift: ValveRange::of(&constants.lift_valve.curve),
            lower: ValveRange::of(&constants.lower_valve.curve),
            light_kg,
            middle_kg,
            heavy_kg,
            capacity_kg,
            relief_bar,
        }
    }
}

/// Light, middle and heavy load.
fn loads_kg(experiment: &Experiment, capacity_kg: f64) -> [f64; 3] {
    let of_run = |bench: Bench| match bench {
        Bench::Hitch { load_kg } => Some(load_kg),
        Bench::Flow { .. } => None,
    };
    let runs = experiment.runs.iter();
    let mut loads: Vec<f64> = runs.filter_map(|run| of_run(run.bench)).collect();
    loads.sort_by(f64::total_cmp);
    loads.dedup();
    let Some((&lightest, &heaviest)) = loads.first().zip(loads.last()) else {
        return derived(two_digits(MIDDLE * capacity_kg), capacity_kg);
    };
    if heaviest < APART * lightest || heaviest <= 0.0 {
        return derived(loads[loads.len() / 2], capacity_kg);
    }
    let mean = (lightest + heaviest) / 2.0;
    let between = &loads[1..loads.len() - 1];
    let nearest = between.iter().copied().min_by(|a, b| {
        let distance = |load: f64| (load - mean).abs();
        distance(*a).total_cmp(&distance(*b))
    });
    [lightest, nearest.unwrap_or(mean), heaviest]
}

/// A light and a heavy load beside a middle one.
fn derived(middle_kg: f64, capacity_kg: f64) -> [f64; 3] {
    let heavy_kg = (HEAVY * middle_kg).min(capacity_kg).max(middle_kg);
    [
        two_digits(LIGHT * middle_kg),
        middle_kg,
        two_digits(heavy_kg),
    ]
}

/// Rounded to two digits.
fn two_digits(value: f64) -> f64 {
    if value <= 0.0 {
        return 0.0;
    }
    let unit = 10_f64.powf(value.log10().floor() - 1.0);
    (value / unit).round() * unit
}

/// Largest load whose pressure at rest stays below a limit, kg: the pressure at rest is linear in the load.
fn capacity_kg(model: &Model, limit_bar: f64) -> f64 {
    const TRIAL_KG: f64 = 100.0;
    let (low_rad, high_rad) = model.linkage().swing_rad();
    let pressure_bar = |load_kg: f64, position: f64| {
        let rig = Rig::Hitch(HitchRig {
            load_kg,
            start_angle_rad: low_rad + position * (high_rad - low_rad),
        });
        let plant = Plant::new(model, rig, USUAL_OIL_C, Currents::default());
        plant.reading().cylinder_pressure_bar
    };
    let at = |position: f64| {
        let empty = pressure_bar(0.0, position);
        let per_kg = (pressure_bar(TRIAL_KG, position) - empty) / TRIAL_KG;
        (limit_bar - empty) / per_kg
    };
    POSITIONS
        .into_iter()
        .map(at)
        .filter(|load_kg| load_kg.is_finite())
        .fold(f64::INFINITY, f64::min)
        .max(0.0)
}

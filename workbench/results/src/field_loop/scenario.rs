//! Scenarios of the field: what each function does on the soil, the road or the headland that it is meant for.

use std::ops::RangeInclusive;

use clap::ValueEnum;
use hitch_field::body::BodyConstants;
use hitch_field::draft::Texture;
use hitch_field::soil::{SoilPlan, Stretch};
use hitch_field::terrain::Terrain;
use hitch_field::tractor::{Outputs as Field, TractorConstants};
use hitch_plant::Model;
use hitch_quantities::units::Count;
use hitch_quantities::{Function, ValidCalibration};

use super::figures::Spread;
use super::pass::{Comparison, DEPTH_M, DRAFT_N, Pass, SPEED_M_S};
use super::transport::{Ride, RideComparison, class_c};
use super::undulation::{self, DepthFigures};
use crate::closed_loop::ScenarioFigure;
use hitch_closed_loop::Sample;
use hitch_closed_loop::field::{
    Coupling, FieldRig, FieldSample, LINK_DEPTH_M, RAISED_DEG, Settings, check_reach, fitted,
};

/// Number of seeds of soil and noise over which figures are means.
const SEEDS: u64 = 4;

/// A scenario.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum FieldScenario {
    /// Draft control in varying loam, and from coarse to fine soil
    Draft,
    /// Mix at 0.5 in varying loam
    Mix,
    /// Slip guard on a soft patch of 20 m
    Slip,
    /// Depth limit over an undulation of 10 m and 100 mm, and depth control if a sensor is fitted
    Depth,
    /// Ride damping with 600 kg on rough roads
    Transport,
    /// Draft control that is raised on a headland and lowered again
    Headland,
}

/// A driven scenario.
#[derive(Debug, Clone)]
pub struct FieldRun {
    /// Its figures.
    pub figures: Vec<ScenarioFigure>,
    /// Hitch and controller over one course of it, in steps of a millisecond.
    pub hitch: Vec<Sample>,
    /// Tractor and field of the same steps; empty on a road.
    pub field: Vec<Field>,
}

impl FieldRun {
    fn of(figures: Vec<ScenarioFigure>, course: &[FieldSample]) -> Self {
        Self {
            figures,
            hitch: course.iter().map(|sample| sample.hitch).collect(),
            field: course.iter().map(|sample| sample.field).collect(),
        }
    }
}

/// Drives a scenario on soils and noise of seeds from a first one on. What the calibration leaves off is switched on with its other
/// values.
///
/// # Errors
/// If the model cannot lower its links to the depths of the scenarios.
pub fn drive(
    scenario: FieldScenario,
    model: &Model,
    calibration: &ValidCalibration,
    first_seed: u64,
) -> Result<FieldRun, String> {
    check_reach(model).map_err(|error| error.to_string())?;
    let calibration = &fitted(calibration, |_| {}).map_err(|error| error.to_string())?;
    Ok(match scenario {
        FieldScenario::Draft => draft(model, calibration, first_seed),
        FieldScenario::Mix => mix(model, calibration, first_seed),
        FieldScenario::Slip => slip(model, calibration, first_seed),
        FieldScenario::Depth => depth(model, calibration, first_seed),
        FieldScenario::Transport => transport(model, calibration, first_seed),
        FieldScenario::Headland => headland(model, calibration, first_seed),
    })
}

fn settings(function: Function) -> Settings {
    Settings {
        function,
        draft_n: Some(DRAFT_N),
        depth_m: Some(DEPTH_M),
        mix: Some(0.5),
        ..Settings::default()
    }
}

fn pass(soil: SoilPlan, settings: Settings, work_s: f64, seed: u64) -> Pass {
    Pass {
        soil,
        settings,
        link_depth_m: LINK_DEPTH_M,
        work_s,
        seed,
    }
}

fn seeds(first: u64) -> RangeInclusive<u64> {
    first..=first + SEEDS - 1
}

/// Figures of a function in varying loam, and a course of it.
fn compared(
    model: &Model,
    calibration: &ValidCalibration,
    function: Function,
    first_seed: u64,
    [most_draft, most_depth]: [Option<f64>; 2],
) -> FieldRun {
    let found = Comparison::of(model, function, calibration, seeds(first_seed));
    let figures = vec![
        ScenarioFigure::new(
            "deviation of the draft over that of position control",
            found.draft_ratio,
            "",
            most_draft,
        ),
        ScenarioFigure::new(
            "the same through a low-pass of 3.2 Hz",
            found.filtered_ratio,
            "",
            None,
        ),
        ScenarioFigure::new(
            "deviation of the depth over its mean",
            found.depth_ratio * 100.0,
            "%",
            most_depth,
        ),
        ScenarioFigure::new(
            "coil activations",
            found.activations_per_min,
            "1/min",
            Some(30.0),
        ),
    ];
    let varying = SoilPlan::varying(Texture::Medium);
    let course =
        pass(varying, settings(function), 30.0, first_seed).drive(model, calibration, |_, _| {});
    FieldRun::of(figures, &course)
}

fn draft(model: &Model, calibration: &ValidCalibration, first_seed: u64) -> FieldRun {
    /// Set point that suits the coarse soil and the fine one, N.
    const SET_N: f64 = 11_900.0;
    let mut run = compared(
        model,
        calibration,
        Function::Draft,
        first_seed,
        [Some(0.5), None],
    );
    let mut soil = SoilPlan::uniform(Texture::Coarse);
    soil.texture_changes = vec![(60.0, Texture::Fine)];
    let settings = Settings {
        draft_n: Some(SET_N),
        ..settings(Function::Draft)
    };
    let samples = pass(soil, settings, 25.0, first_seed).drive(model, calibration, |_, _| {});
    let off: Vec<f64> = samples
        .iter()
        .map(|sample| sample.field.draft_n / SET_N - 1.0)
        .collect();
    let harder = off.iter().skip_while(|off| **off <= 0.5);
    let late = harder.clone().take_while(|off| off.abs() > 0.05).count();
    let lowest = harder.copied().fold(0.0, f64::min);
    run.figures.extend([
        ScenarioFigure::new(
            "from coarse to fine soil: within 5 % after",
            late as f64 * 1e-3,
            "s",
            Some(2.0),
        ),
        ScenarioFigure::new(
            "from coarse to fine soil: draft below its set point by",
            -lowest * 100.0,
            "%",
            Some(15.0),
        ),
    ]);
    run
}

fn mix(model: &Model, calibration: &ValidCalibration, first_seed: u64) -> FieldRun {
    compared(
        model,
        calibration,
        Function::Mix,
        first_seed,
        [Some(0.7), Some(6.0)],
    )
}

fn slip(model: &Model, calibration: &ValidCalibration, first_seed: u64) -> FieldRun {
    const LIMIT: f64 = 0.2;
    const PATCH_M: [f64; 2] = [60.0, 80.0];
    let settings = Settings {
        slip_limit: Some(LIMIT),
        ..settings(Function::Draft)
    };
    let over = |mut soil: SoilPlan| {
        soil.stretches = vec![Stretch::soft_patch(PATCH_M[0], PATCH_M[1] - PATCH_M[0])];
        pass(soil, settings, 30.0, first_seed).drive(model, calibration, |_, _| {})
    };
    let patch = |samples: &[FieldSample]| {
        PATCH_M.map(|at_m| samples.partition_point(|sample| sample.field.distance_m < at_m))
    };
    // `begins`: samples of the patch that are left out.
    let most_percent = |samples: &[FieldSample], begins: usize| {
        let [from, to] = patch(samples);
        let slips = samples.iter().take(to).skip(from + begins);
        slips.map(|sample| sample.field.slip).fold(0.0, f64::max) * 100.0
    };
    let samples = over(SoilPlan::uniform(Texture::Medium));
    let [from, to] = patch(&samples);
    let depth_m = |at: usize| {
        samples
            .get(at)
            .map_or(f64::NAN, |sample| sample.field.depth_m)
    };
    let change = (depth_m(to + 3_000) / depth_m(from.saturating_sub(1)) - 1.0).abs();
    let varying = over(SoilPlan::varying(Texture::Medium));
    let figures = vec![
        ScenarioFigure::new(
            "slip at most",
            most_percent(&samples, 0),
            "%",
            Some((LIMIT + 0.05) * 100.0),
        ),
        // The slip rises with the patch before the guard can act.
        ScenarioFigure::new(
            "slip at most, from 1.5 s on",
            most_percent(&samples, 1_500),
            "%",
            Some((LIMIT + 0.05) * 100.0),
        ),
        ScenarioFigure::new(
            "change of the depth 3 s after the patch",
            change * 100.0,
            "%",
            Some(5.0),
        ),
        ScenarioFigure::new(
            "slip at most in varying loam",
            most_percent(&varying, 0),
            "%",
            None,
        ),
    ];
    FieldRun::of(figures, &samples)
}

/// Drives with a lever over time, s, from a start with the implement raised.
fn driven(
    model: &Model,
    calibration: &ValidCalibration,
    (soil, terrain): (SoilPlan, Terrain),
    (settings, speed_m_s): (Settings, f64),
    (time_s, seed): (f64, u64),
    lever_deg: impl Fn(&Coupling<'_>, &[FieldSample]) -> f64,
) -> Vec<FieldSample> {
    let field = (TractorConstants::ploughing(), soil);
    let mut rig = FieldRig::new(model, calibration, field, terrain, seed);
    let mut samples = Vec::new();
    for _ in 0..(time_s * 1e3) as usize {
        let lever_deg = lever_deg(rig.coupling(), &samples);
        samples.push(rig.step(lever_deg, speed_m_s, &settings, |_| {}));
    }
    samples
}

fn depth(model: &Model, calibration: &ValidCalibration, first_seed: u64) -> FieldRun {
    let limited = undulation::drive(
        model,
        calibration,
        &settings(Function::DepthLimit),
        first_seed,
        |_, _| {},
    );
    let mut figures = of_depth("", &DepthFigures::of(&limited)).to_vec();
    let course = if calibration.depth.fitted == Count(0) {
        limited
    } else {
        let settings = settings(Function::Depth);
        let sensed = undulation::drive(model, calibration, &settings, first_seed, |_, _| {});
        let lever = undulation::drive(
            model,
            calibration,
            &Settings::default(),
            first_seed,
            |_, _| {},
        );
        figures.extend(of_sensor(&sensed, &lever));
        sensed
    };
    FieldRun::of(figures, &course[..course.len().min(30_000)])
}

/// Figures of the depth, whose names begin with what they are of.
fn of_depth(of: &str, found: &DepthFigures) -> [ScenarioFigure; 4] {
    let figure = |name, value, unit, required| {
        ScenarioFigure::new(&format!("{of}{name}"), value, unit, required)
    };
    let (out, beyond) = (found.out * 100.0, found.beyond * 100.0);
    let mean_cm = found.depth_m.mean * 100.0;
    [
        figure("out of the ground", out, "%", Some(0.0)),
        figure(
            "depth further than 10 % from its mean",
            beyond,
            "%",
            Some(5.0),
        ),
        figure("mean depth", mean_cm, "cm", None),
        figure("coil activations", found.activations_per_min, "1/min", None),
    ]
}

/// Figures of depth control with the external sensor, and of position control on the same way.
fn of_sensor(sensed: &[FieldSample], lever: &[FieldSample]) -> [ScenarioFigure; 5] {
    let [sensed, lever] = [sensed, lever].map(DepthFigures::of);
    let [out, beyond, mean, activations] = of_depth("depth sensor: ", &sensed);
    let deviation = ScenarioFigure::new(
        "depth sensor: deviation of the depth over that of position control",
        sensed.depth_m.deviation / lever.depth_m.deviation,
        "",
        None,
    );
    [out, beyond, mean, deviation, activations]
}

fn headland(model: &Model, calibration: &ValidCalibration, first_seed: u64) -> FieldRun {
    const HEADLAND_M: [f64; 2] = [60.0, 76.0];
    let mut soil = SoilPlan::varying(Texture::Medium);
    soil.stretches = vec![Stretch::headland(
        HEADLAND_M[0],
        HEADLAND_M[1] - HEADLAND_M[0],
    )];
    let is_headland =
        |sample: &FieldSample| (HEADLAND_M[0]..HEADLAND_M[1]).contains(&sample.field.distance_m);
    let samples = driven(
        model,
        calibration,
        (soil, Terrain::flat()),
        (settings(Function::Draft), SPEED_M_S),
        (65.0, first_seed),
        |coupling, samples| match samples.last() {
            Some(last) if samples.len() >= 10_000 && !is_headland(last) => {
                coupling.angle_deg(LINK_DEPTH_M)
            }
            _ => RAISED_DEG,
        },
    );
    let reached = samples
        .iter()
        .take_while(|sample| sample.field.distance_m < HEADLAND_M[0])
        .count();
    let (before, after) = samples.split_at(reached);
    let turned = after
        .iter()
        .take_while(|sample| is_headland(sample))
        .count();
    let (turn, work) = after.split_at(turned);
    let earlier = &before[before.len().saturating_sub(10_000)..];
    let depth_m = Spread::of(earlier.iter().map(|sample| sample.field.depth_m)).mean;
    let out = turn
        .iter()
        .take_while(|sample| sample.field.depth_m > 0.0)
        .count();
    let back = work
        .iter()
        .take_while(|sample| sample.field.depth_m < 0.9 * depth_m)
        .count();
    let deepest_m = work
        .iter()
        .map(|sample| sample.field.depth_m)
        .fold(0.0, f64::max);
    let figures = vec![
        ScenarioFigure::new(
            "out of the ground after the lever was raised",
            out as f64 * 1e-3,
            "s",
            None,
        ),
        ScenarioFigure::new(
            "back at 90 % of the depth after it was lowered",
            back as f64 * 1e-3,
            "s",
            None,
        ),
        ScenarioFigure::new(
            "deepest then, over the depth before",
            deepest_m / depth_m,
            "",
            None,
        ),
    ];
    FieldRun::of(figures, &samples[reached.saturating_sub(5_000)..])
}

fn transport(model: &Model, calibration: &ValidCalibration, first_seed: u64) -> FieldRun {
    let ride = |km_h: f64| Ride {
        body: BodyConstants::ploughing(),
        roughness: class_c(),
        speed_m_s: km_h / 3.6,
    };
    let mut figures = Vec::new();
    for km_h in [12.0, 20.0] {
        let found = RideComparison::of(model, &ride(km_h), calibration, seeds(first_seed));
        let damped = &found.damped;
        let name = |what: &str| format!("{km_h:.0} km/h: {what}");
        figures.extend([
            ScenarioFigure::new(
                &name("pitch acceleration over that of a hitch that holds"),
                found.pitch_ratio(),
                "",
                Some(0.75),
            ),
            ScenarioFigure::new(
                &name("pressure peak over the same"),
                found.peak_ratio(),
                "",
                Some(0.8),
            ),
            ScenarioFigure::new(
                &name("angle from the lever"),
                damped.off_deg,
                "deg",
                Some(3.0),
            ),
            ScenarioFigure::new(
                &name("square of the coil currents"),
                damped.coil_a2,
                "A2",
                None,
            ),
            ScenarioFigure::new(
                &name("coil activations"),
                damped.activations_per_min,
                "1/min",
                None,
            ),
        ]);
    }
    FieldRun {
        figures,
        hitch: ride(20.0).course(model, calibration, first_seed),
        field: Vec::new(),
    }
}

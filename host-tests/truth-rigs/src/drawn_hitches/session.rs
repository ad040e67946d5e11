//! One machine from power-up: lever capture, moves, and observation for one minute.

use hitch_control::commissioning::teach::{Taught, TeachError};
use hitch_controller::Controller;
use hitch_quantities::units::{MilliAmp, MilliBar, MilliCelsius, MilliDegree, MilliVolt};
use hitch_quantities::{Fault, Inputs, Trip, ValidCalibration};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use super::draw::{Drawn, Readings};
use super::shortest::{ARRIVED_DEG, Shortest};
use crate::second_rig::driven_hitch::DrivenHitch;

/// From the step of the lever: three times the shortest time, and this, s.
const WATCHED_S: f64 = 4.0;
/// After the last move, s.
const MINUTE_S: f64 = 60.0;
/// One sigma of the pressures, bar.
const PRESSURE_NOISE_BAR: f64 = 0.15;

/// Figures of one move.
#[derive(Debug, Clone, Copy)]
pub struct MoveFigures {
    /// The machine's seed.
    pub seed: u64,
    /// Whether the machine is a structured one.
    pub structured: bool,
    /// Which move of the machine it was; the first is 0.
    pub index: usize,
    /// Where it began, degree.
    pub from_deg: f64,
    /// Set point, degree.
    pub to_deg: f64,
    /// From the step of the set point until the angle stays within half a degree, s.
    pub time_s: f64,
    /// Shortest time that the machine allows, s.
    pub shortest_s: f64,
    /// Time over the shortest.
    pub ratio: f64,
    /// Furthest beyond the set point, degree.
    pub overshoot_deg: f64,
    /// Distance from the set point at the end, degree.
    pub final_error_deg: f64,
    /// How long a coil was on after arrival, s.
    pub active_after_s: f64,
    /// How often a coil was switched on after arrival.
    pub switched_on_after: u32,
    /// Peak to peak of the cylinder pressure over that of the shortest manoeuvre.
    pub swing_ratio: f64,
    /// The first fault, and the row of the envelope if it tripped.
    pub fault: Option<(Fault, Option<Trip>)>,
}

/// A millisecond as it truly was.
#[derive(Debug, Clone, Copy)]
pub struct Instant {
    /// Rocker angle, degree.
    pub rocker_deg: f64,
    /// Cylinder pressure, bar.
    pub cylinder_bar: f64,
    /// Coil currents, A.
    pub currents_a: [f64; 2],
    /// Piston travel as the controller estimates it, mm.
    pub estimated_mm: f64,
    /// Piston speed as the controller estimates it, and as it asks the valves for it, mm/s; up is positive.
    pub speeds_mm_s: [f64; 2],
    /// The controller's fault, and the row of the envelope if it tripped.
    pub fault: Option<(Fault, Option<Trip>)>,
}

/// Machine and controller.
pub struct Session<'a> {
    hitch: DrivenHitch<'a>,
    readings: Readings,
    oil_temperature_c: f64,
    controller: Controller,
    random: Pcg64Mcg,
}

impl<'a> Session<'a> {
    /// Power-up at the first angle.
    #[must_use]
    pub fn new(drawn: &'a Drawn, calibration: &ValidCalibration) -> Self {
        Self {
            hitch: DrivenHitch::new(&drawn.physics, drawn.conditions, drawn.angles_deg[0]),
            readings: drawn.readings,
            oil_temperature_c: drawn.conditions.oil_temperature_c,
            controller: Controller::new(calibration.clone()),
            random: Pcg64Mcg::seed_from_u64(drawn.seed),
        }
    }

    /// One millisecond with the lever at `lever_deg`.
    pub fn step(&mut self, lever_deg: f64) -> Instant {
        self.step_with(lever_deg, |_| ())
    }

    /// The same; `tell` can modify the controller's inputs.
    pub fn step_with(&mut self, lever_deg: f64, tell: impl FnOnce(&mut Inputs)) -> Instant {
        let mut inputs = self.inputs(lever_deg);
        tell(&mut inputs);
        let outputs = self.controller.step(&inputs);
        let ampere = |current: MilliAmp| f64::from(current.0) * 1e-3;
        let instant = Instant {
            rocker_deg: self.hitch.rocker_deg(),
            cylinder_bar: self.hitch.cylinder_bar(),
            currents_a: [outputs.lift_current, outputs.lower_current].map(ampere),
            estimated_mm: f64::from(outputs.travel.0) * 1e-3,
            speeds_mm_s: [outputs.speed, outputs.demanded_speed]
                .map(|speed| f64::from(speed.0) * 1e-3),
            fault: outputs.fault.map(|fault| (fault, outputs.trip)),
        };
        self.hitch.step(instant.currents_a);
        instant
    }

    /// The hitch as it is now.
    #[must_use]
    pub fn hitch(&self) -> &DrivenHitch<'a> {
        &self.hitch
    }

    /// The result of teaching, once it has ended.
    #[must_use]
    pub fn taught(&self) -> Option<Result<Taught, TeachError>> {
        self.controller.taught()
    }

    /// The inputs of a line of `hitch controller`: no measured currents, and only available sensors. The lever's scale is
    /// that of the angle sensor.
    fn inputs(&mut self, lever_deg: f64) -> Inputs {
        let milli = |value: f64| (value * 1e3).round() as i32;
        let mut noise = || -> f64 { StandardNormal.sample(&mut self.random) };
        let angle_deg = self.readings.shown_deg(self.hitch.shown_deg(), noise());
        let [cylinder, pump] = self
            .hitch
            .shown_bar()
            .map(|bar| MilliBar(milli(bar + PRESSURE_NOISE_BAR * noise())));
        let pressure = |bar: MilliBar| self.readings.pressures.then_some(bar);
        Inputs {
            lever: Some(MilliDegree(milli(self.hitch.shown_at_rest_deg(lever_deg)))),
            rocker_angle: Some(MilliDegree(milli(angle_deg))),
            // Only looked at with `sensors.second_track`.
            second_angle: Some(MilliDegree(milli(self.hitch.shown_deg()))),
            cylinder_pressure: pressure(cylinder),
            pump_pressure: pressure(pump),
            oil_temperature: Some(MilliCelsius(milli(self.oil_temperature_c))),
            supply: Some(MilliVolt(13_800)),
            ..Inputs::default()
        }
    }

    /// Moves the lever through the hitch, as an operator does after power-up, and leaves both at rest.
    pub fn pick_up(&mut self) {
        self.pick_up_with(|_| ());
    }

    /// The same; `tell` can modify the controller's inputs.
    pub fn pick_up_with(&mut self, tell: impl Fn(&mut Inputs)) {
        let here_deg = self.hitch.rocker_deg();
        for (steps, away_deg) in [(300, -3.0), (500, 0.0)] {
            for _ in 0..steps {
                self.step_with(here_deg + away_deg, &tell);
            }
        }
    }
}

/// Every move of a machine.
#[must_use]
pub fn drive(drawn: &Drawn, calibration: &ValidCalibration) -> Vec<MoveFigures> {
    drive_watched(drawn, calibration, |_, _| ())
}

/// The same; `watch` sees every millisecond of the moves, with the lever's angle, degree.
pub fn drive_watched(
    drawn: &Drawn,
    calibration: &ValidCalibration,
    mut watch: impl FnMut(f64, &Instant),
) -> Vec<MoveFigures> {
    let mut session = Session::new(drawn, calibration);
    session.pick_up();
    judged(drawn, |to_deg| {
        let instant = session.step(to_deg);
        watch(to_deg, &instant);
        instant
    })
}

/// Figures of every move of a machine; `step` is a millisecond towards a set point, degree.
pub(super) fn judged(drawn: &Drawn, mut step: impl FnMut(f64) -> Instant) -> Vec<MoveFigures> {
    let last = drawn.angles_deg.len() - 2;
    let figures = |index: usize| {
        let to_deg = drawn.angles_deg[index + 1];
        let mut instants = vec![step(to_deg)];
        let shortest = Shortest::find(drawn, instants[0].rocker_deg, to_deg);
        let after_s = if index == last { MINUTE_S } else { WATCHED_S };
        let steps = ((3.0 * shortest.time_s + after_s) * 1e3) as usize;
        instants.extend((1..steps).map(|_| step(to_deg)));
        judge(drawn, index, &instants, shortest)
    };
    (0..=last).map(figures).collect()
}

fn judge(drawn: &Drawn, index: usize, instants: &[Instant], shortest: Shortest) -> MoveFigures {
    let (from_deg, to_deg) = (instants[0].rocker_deg, drawn.angles_deg[index + 1]);
    let way = (to_deg - from_deg).signum();
    let beyond = |instant: &Instant| (instant.rocker_deg - to_deg) * way;
    let away = |instant: &Instant| beyond(instant).abs() > ARRIVED_DEG;
    let arrived = instants.iter().rposition(away).map_or(0, |at| at + 1);
    let is_on = |instant: &Instant| instant.currents_a.iter().any(|&a| a > 0.0);
    let after = &instants[arrived..];
    let bars = instants.iter().map(|instant| instant.cylinder_bar);
    let (low_bar, high_bar) = (
        bars.clone().fold(f64::INFINITY, f64::min),
        bars.fold(0.0, f64::max),
    );
    let time_s = arrived as f64 * 1e-3;
    MoveFigures {
        seed: drawn.seed,
        structured: drawn.structured,
        index,
        from_deg,
        to_deg,
        time_s,
        shortest_s: shortest.time_s,
        ratio: time_s / shortest.time_s,
        overshoot_deg: instants.iter().map(beyond).fold(0.0, f64::max),
        final_error_deg: instants.last().map_or(f64::NAN, |last| beyond(last).abs()),
        active_after_s: after.iter().filter(|instant| is_on(instant)).count() as f64 * 1e-3,
        switched_on_after: after
            .windows(2)
            .filter(|pair| !is_on(&pair[0]) && is_on(&pair[1]))
            .count() as u32,
        swing_ratio: (high_bar - low_bar) / shortest.swing_bar,
        fault: instants.iter().find_map(|instant| instant.fault),
    }
}

//! Manoeuvres of lab and field plans: loads, temperatures and current traces.

use hitch_campaign::Bench;
use rand::Rng;

use super::data_sheet::{
    AREA_M2, DEAD_WEIGHT_KG, GRAVITY_M_S2, LIFT_TABLE, LOWER_REFERENCE_PA, LOWER_TABLE, STROKE_M,
};
use super::linkage;
use crate::polyline::value_at;

/// Where and how a campaign is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Plan {
    /// Flow bench, single moves at several loads and currents, a hold, duty cycles at three temperatures.
    Lab,
    /// Duty cycles and a hold.
    Field,
}

/// Course of a current: straight lines between knots of time, s, and current, A.
#[derive(Debug, Clone, Default)]
pub struct Course(Vec<(f64, f64)>);

impl Course {
    /// Straight lines between knots of rising time, s, and current, A.
    #[must_use]
    pub fn through(knots: Vec<(f64, f64)>) -> Self {
        Self(knots)
    }

    /// Current at a time, A; before the first knot and behind the last one as there, zero without knots.
    #[must_use]
    pub fn at(&self, time_s: f64) -> f64 {
        value_at(&self.0, time_s)
    }

    /// Up to a current, along it, and down again; `hold_s` counts from the ramp's start to the next ramp's.
    fn pulse(&mut self, start_s: f64, hold_s: f64, current_a: f64) {
        let end_s = start_s + hold_s;
        self.0.extend([
            (start_s, 0.0),
            (start_s + RAMP_S, current_a),
            (end_s, current_a),
            (end_s + RAMP_S, 0.0),
        ]);
    }

    /// Levels held in turn, switched as fast as the current controller can.
    fn stairs(levels_a: &[f64], hold_s: f64) -> Self {
        let knots = levels_a.iter().enumerate().flat_map(|(k, &level_a)| {
            let start_s = k as f64 * hold_s;
            let from_s = if k == 0 {
                start_s
            } else {
                start_s + SWITCHED_S
            };
            [(from_s, level_a), (start_s + hold_s, level_a)]
        });
        Self(knots.collect())
    }
}

/// Normal manoeuvres ramp the current over this time, s.
const RAMP_S: f64 = 0.2;

/// Rise time of a current controller, s.
const SWITCHED_S: f64 = 0.008;

/// A run to be measured.
#[derive(Debug, Clone)]
pub struct Manoeuvre {
    /// File name.
    pub file: String,
    /// Bench, with the load as weighed.
    pub bench: Bench,
    /// Rocker angle of a hitch at the start, degree.
    pub start_deg: f64,
    /// Oil temperature, degC.
    pub oil_temperature_c: f64,
    /// Duration, s.
    pub duration_s: f64,
    /// Lift current.
    pub lift: Course,
    /// Lowering current.
    pub lower: Course,
}

/// Which valve a manoeuvre works.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    Lift,
    Lower,
}

impl Manoeuvre {
    fn of_one_valve(way: Way, course: Course, rest: Self) -> Self {
        match way {
            Way::Lift => Self {
                lift: course,
                ..rest
            },
            Way::Lower => Self {
                lower: course,
                ..rest
            },
        }
    }

    fn still(file: String, bench: Bench, oil_temperature_c: f64, duration_s: f64) -> Self {
        Self {
            file,
            bench,
            start_deg: f64::NAN,
            oil_temperature_c,
            duration_s,
            lift: Course::default(),
            lower: Course::default(),
        }
    }
}

/// The runs of a plan, with random details that differ between campaigns.
pub fn runs(plan: Plan, random: &mut impl Rng) -> Vec<Manoeuvre> {
    match plan {
        Plan::Lab => lab(random),
        Plan::Field => field(random),
    }
}

fn lab(random: &mut impl Rng) -> Vec<Manoeuvre> {
    let mut runs = flow_bench();
    for (way, current_a, load_kg, seconds) in [
        (Way::Lift, 1.5, 50.0, 5.0),
        (Way::Lift, 1.5, 250.0, 5.0),
        (Way::Lift, 2.1, 150.0, 1.9),
        (Way::Lower, 1.6, 50.0, 11.5),
        (Way::Lower, 1.6, 250.0, 6.2),
        (Way::Lower, 2.2, 50.0, 1.8),
        (Way::Lower, 2.2, 150.0, 1.3),
        (Way::Lower, 2.2, 250.0, 1.0),
    ] {
        runs.push(single_move(way, current_a, load_kg, seconds, random));
    }
    runs.push(hold(250.0, 101.2, random));
    for (load_kg, temperature_c) in [(50.0, 40.0), (250.0, 40.0), (150.0, 18.0), (150.0, 62.0)] {
        runs.push(duty(
            "duty",
            load_kg,
            temperature_c,
            30.0,
            (0.012, 0.146),
            random,
        ));
    }
    runs
}

fn field(random: &mut impl Rng) -> Vec<Manoeuvre> {
    let mut runs: Vec<Manoeuvre> = [
        (50.0, 25.0),
        (100.0, 40.0),
        (150.0, 40.0),
        (200.0, 55.0),
        (250.0, 40.0),
        (250.0, 60.0),
    ]
    .into_iter()
    .map(|(load_kg, temperature_c)| {
        duty(
            "field",
            load_kg,
            temperature_c,
            40.0,
            (0.004, 0.156),
            random,
        )
    })
    .collect();
    runs.push(hold(200.0, 95.9, random));
    runs
}

/// Staircases up and down at several port pressures.
fn flow_bench() -> Vec<Manoeuvre> {
    let there_and_back = |step_a: f64, from_a: f64, steps: usize| -> Vec<f64> {
        let up = (0..=steps).map(|k| from_a + step_a * k as f64);
        up.clone().chain(up.rev().skip(1)).collect()
    };
    let fine = there_and_back(0.1, 0.9, 26);
    let coarse: Vec<f64> = (0..11).map(|k| 1.0 + 0.25 * f64::from(k)).collect();
    let stairs = |way: Way, port_bar: f64, levels_a: &[f64], hold_s: f64| {
        let name = if way == Way::Lift { "lift" } else { "lower" };
        let file = format!("flow_{name}_{port_bar:03}bar.csv");
        let duration_s = levels_a.len() as f64 * hold_s;
        let bench = Bench::Flow {
            port_pressure_bar: port_bar,
        };
        let still = Manoeuvre::still(file, bench, 40.0, duration_s);
        Manoeuvre::of_one_valve(way, Course::stairs(levels_a, hold_s), still)
    };
    vec![
        stairs(Way::Lift, 20.0, &fine, 0.5),
        stairs(Way::Lift, 70.0, &coarse, 0.6),
        stairs(Way::Lift, 120.0, &coarse, 0.6),
        stairs(Way::Lift, 140.0, &coarse, 0.6),
        stairs(Way::Lower, 15.0, &fine, 0.5),
        stairs(Way::Lower, 5.0, &coarse, 0.6),
        stairs(Way::Lower, 40.0, &coarse, 0.6),
    ]
}

fn single_move(
    way: Way,
    current_a: f64,
    load_kg: f64,
    seconds: f64,
    random: &mut impl Rng,
) -> Manoeuvre {
    let (name, from_deg) = match way {
        Way::Lift => ("lift", 52.9),
        Way::Lower => ("lower", 130.6),
    };
    let start_deg = from_deg + random.random_range(-0.5..0.5);
    let mut course = Course::default();
    course.pulse(0.5, seconds, current_a);
    let file = format!("{name}_{current_a}A_{load_kg:03}kg.csv");
    let still = Manoeuvre::still(file, Bench::Hitch { load_kg }, 40.0, seconds + 2.0);
    let still = Manoeuvre { start_deg, ..still };
    Manoeuvre::of_one_valve(way, course, still)
}

fn hold(load_kg: f64, start_deg: f64, random: &mut impl Rng) -> Manoeuvre {
    let file = format!("hold_{load_kg}kg.csv");
    Manoeuvre {
        start_deg: start_deg + random.random_range(-0.5..0.5),
        ..Manoeuvre::still(file, Bench::Hitch { load_kg }, 40.0, 30.0)
    }
}

/// Moves up and down at random, planned by the data sheet to stay in a part of the stroke.
fn duty(
    name: &str,
    load_kg: f64,
    oil_temperature_c: f64,
    duration_s: f64,
    (low_m, high_m): (f64, f64),
    random: &mut impl Rng,
) -> Manoeuvre {
    let mut travel_m: f64 = 0.05 + random.random_range(-0.004..0.004);
    let file = format!("{name}_{load_kg:03}kg_{oil_temperature_c}C.csv");
    let bench = Bench::Hitch { load_kg };
    let mut run = Manoeuvre::still(file, bench, oil_temperature_c, duration_s);
    run.start_deg = linkage::at(travel_m).rocker_deg;
    let mut time_s = 0.5 + random.random_range(0.0..0.7);
    while time_s < duration_s - 2.0 {
        let upwards = 0.5 + 0.8 * (0.5 * STROKE_M - travel_m) / (0.5 * STROKE_M);
        let way = if random.random::<f64>() < upwards {
            Way::Lift
        } else {
            Way::Lower
        };
        let current_a = match way {
            Way::Lift => random.random_range(1.3..2.3),
            Way::Lower => random.random_range(1.6..2.4),
        };
        let longer = if random.random::<f64>() < 0.25 {
            3.0
        } else {
            1.0
        };
        let hold_s = longer * random.random_range(0.2..1.2);
        let ends_m = travel_m + expected_speed_m_s(way, current_a, load_kg) * hold_s;
        if !(low_m..high_m).contains(&ends_m) || time_s + hold_s + 2.0 * RAMP_S > duration_s {
            // A move that is not to be: time goes on so that the search for one ends.
            time_s += 0.02;
            continue;
        }
        match way {
            Way::Lift => run.lift.pulse(time_s, hold_s, current_a),
            Way::Lower => run.lower.pulse(time_s, hold_s, current_a),
        }
        travel_m = ends_m;
        time_s += hold_s + 0.4 + random.random_range(0.1..1.2);
    }
    run
}

/// Piston speed by the data sheet, m/s.
fn expected_speed_m_s(way: Way, current_a: f64, load_kg: f64) -> f64 {
    match way {
        Way::Lift => LIFT_TABLE.flow_m3_s(current_a) / AREA_M2,
        Way::Lower => {
            let holding_pa = (load_kg + DEAD_WEIGHT_KG) * GRAVITY_M_S2 * 4.3 / AREA_M2;
            let relative = holding_pa / LOWER_REFERENCE_PA;
            -LOWER_TABLE.flow_m3_s(current_a) * relative.sqrt() / AREA_M2
        }
    }
}

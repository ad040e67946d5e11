//! Numerics of the plant compared with an independent implementation of the same rig and a published stiff solver
//! (Radau IIA of order five, with step-size control to nine digits).

mod rig;

use differential_equations::prelude::{IVP, ImplicitRungeKutta};
use hitch_plant::{Currents, HitchRig, Plant};
use rig::{Rig, State, linkage};

/// The logger's rate, and therefore the longest step of the plant.
const SAMPLE_S: f64 = 0.02;

/// Time in s and both currents in A, linear in between.
type Manoeuvres = [(f64, [f64; 2])];

/// Lifts and lowerings with normal ramps and steep ones, and rests.
const NORMAL: &Manoeuvres = &[
    (0.0, [0.0, 0.0]),
    (0.2, [0.0, 0.0]),
    (0.3, [2.2, 0.0]),
    (0.8, [2.2, 0.0]),
    (1.0, [1.0, 0.0]),
    (1.3, [0.0, 0.0]),
    (1.32, [1.5, 0.0]),
    (1.6, [1.6, 0.0]),
    (1.62, [1.4, 0.0]),
    (2.0, [1.1, 0.0]),
    (2.1, [0.0, 0.0]),
    (2.4, [0.0, 0.9]),
    (2.6, [0.0, 1.9]),
    (2.8, [0.0, 1.9]),
    (2.95, [0.0, 1.0]),
    (3.4, [0.0, 0.0]),
];

/// A coil that is cut in full flight: the load flies on, tears the oil column and falls back on it.
const CUT: &Manoeuvres = &[
    (0.0, [0.0, 0.0]),
    (0.2, [2.2, 0.0]),
    (0.8, [2.2, 0.0]),
    (0.82, [0.0, 0.0]),
    (4.0, [0.0, 0.0]),
];

fn currents_at(manoeuvres: &Manoeuvres, time_s: f64) -> [f64; 2] {
    let last = manoeuvres.len() - 1;
    let after = manoeuvres
        .iter()
        .position(|point| point.0 >= time_s)
        .unwrap_or(last)
        .max(1);
    let ((t0, from), (t1, to)) = (manoeuvres[after - 1], manoeuvres[after]);
    let share = ((time_s - t0) / (t1 - t0)).clamp(0.0, 1.0);
    [0, 1].map(|coil| from[coil] + (to[coil] - from[coil]) * share)
}

/// Largest and root-mean-square difference.
#[derive(Default)]
struct Differences {
    largest: f64,
    squares: f64,
    count: f64,
}

impl Differences {
    fn add(&mut self, difference: f64) {
        self.largest = self.largest.max(difference.abs());
        self.squares += difference * difference;
        self.count += 1.0;
    }

    fn rms(&self) -> f64 {
        (self.squares / self.count).sqrt()
    }
}

fn advance(rig: &Rig, state: State) -> State {
    let method = ImplicitRungeKutta::radau5().rtol(1e-9).atol(1e-9).h0(1e-5);
    let solution = IVP::ode(rig, 0.0, SAMPLE_S, state)
        .method(method)
        .solve()
        .expect("the solver gets through");
    *solution.y.last().expect("a solution has an end")
}

/// How the plant and the second opinion differ over the manoeuvres.
struct Comparison {
    /// Cylinder pressure, bar.
    pressure: Differences,
    /// Rocker angle, degree.
    angle: Differences,
    /// Rocker angle at the end, degree.
    last_angle: f64,
    /// Whether the oil column tore.
    torn: bool,
}

fn compare(manoeuvres: &Manoeuvres, load_kg: f64) -> Comparison {
    let model = hitch_model_file::dynamic();
    let start = HitchRig {
        load_kg,
        start_angle_rad: 70.0_f64.to_radians(),
    };
    let mut plant = Plant::new(
        &model,
        hitch_plant::Rig::Hitch(start),
        40.0,
        Currents::default(),
    );
    let pin_at_zero = linkage::pin_at_zero();
    let travel = plant.state().piston_m * 1e3;
    let mut rig = Rig {
        load_kg,
        pin_at_zero,
        currents: [0.0; 2],
        slopes: [0.0; 2],
    };
    let mut state = [travel, 0.0, rig.holding_pressure(travel), 0.0, 0.0];
    let mut comparison = Comparison {
        pressure: Differences::default(),
        angle: Differences::default(),
        last_angle: 0.0,
        torn: false,
    };
    let samples = (manoeuvres[manoeuvres.len() - 1].0 / SAMPLE_S).round() as u32;
    for sample in 1..=samples {
        let next = currents_at(manoeuvres, f64::from(sample) * SAMPLE_S);
        rig.slopes = [0, 1].map(|coil| (next[coil] - rig.currents[coil]) / SAMPLE_S);
        state = advance(&rig, state);
        rig.currents = next;
        plant.step(
            Currents {
                lift_a: next[0],
                lower_a: next[1],
            },
            SAMPLE_S,
        );
        let reading = plant.reading();
        let angle = reading.rocker_angle_deg - linkage::rocker_degree(pin_at_zero + state[0]);
        comparison
            .pressure
            .add(reading.cylinder_pressure_bar - state[2].max(-1.0));
        comparison.angle.add(angle);
        comparison.last_angle = angle;
        comparison.torn |= state[2] < -1.0;
    }
    comparison
}

fn print(load_kg: f64, comparison: &Comparison) {
    println!(
        "{load_kg} kg: pressure {:.4} bar rms, {:.4} at most; angle {:.5} degree rms, {:.5} at most, {:.5} at the end",
        comparison.pressure.rms(),
        comparison.pressure.largest,
        comparison.angle.rms(),
        comparison.angle.largest,
        comparison.last_angle
    );
}

#[test]
fn the_dynamic_plant_agrees_with_a_published_solver() {
    for load_kg in [50.0, 150.0, 250.0] {
        let comparison = compare(NORMAL, load_kg);
        print(load_kg, &comparison);
        let (pressure, angle) = (comparison.pressure.rms(), comparison.angle.largest);
        assert!(
            !comparison.torn,
            "{load_kg} kg: the manoeuvres are not normal"
        );
        assert!(
            pressure <= 0.05,
            "{load_kg} kg: pressure is {pressure} bar rms off"
        );
        assert!(angle <= 0.005, "{load_kg} kg: angle is {angle} degrees off");
    }
}

#[test]
fn a_cavity_in_the_oil_closes_where_it_opened() {
    for load_kg in [50.0, 150.0, 250.0] {
        let comparison = compare(CUT, load_kg);
        print(load_kg, &comparison);
        let (angle, last) = (comparison.angle.largest, comparison.last_angle.abs());
        assert!(comparison.torn, "{load_kg} kg: nothing tears");
        assert!(angle <= 0.01, "{load_kg} kg: angle is {angle} degrees off");
        assert!(
            last <= 0.005,
            "{load_kg} kg: the hitch rests {last} degrees off"
        );
    }
}

#[test]
fn the_second_linkage_is_the_data_sheets() {
    let zero = linkage::pin_at_zero();
    // Travel in mm, rocker angle in degrees, height over C in mm.
    for (travel, angle, height) in [
        (0.0, 44.10, -855.6),
        (39.5, 69.31, -684.4),
        (79.0, 90.14, -516.4),
        (118.5, 111.41, -344.9),
        (158.0, 135.90, -175.9),
    ] {
        assert!(
            (linkage::rocker_degree(zero + travel) - angle).abs() < 0.01,
            "angle at {travel} mm"
        );
        assert!(
            (linkage::height(zero + travel) - height).abs() < 0.1,
            "height at {travel} mm"
        );
    }
}

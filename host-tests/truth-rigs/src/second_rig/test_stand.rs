//! One run on the second rig, sample by sample, as perfect instruments would show it.

use hitch_campaign::Bench;

use super::angle_sensor::AngleSensor;
use super::current_path::CurrentPath;
use super::data_sheet::{BAR, KNOWN_SPOOL_LAG_S, LPM};
use super::hydraulics::{Circuit, Spools};
use super::linkage;
use super::manoeuvres::Manoeuvre;
use super::mechanics::{Machine, Motion};
use super::physics::Physics;

/// Which of the two starting points the rig is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Family {
    /// Quasi-static.
    Steady,
    /// With inertia, compressible oil, spool lag and viscous friction, all known.
    Dynamic,
}

/// Samples per second of the logger.
pub const SAMPLE_RATE_HZ: f64 = 50.0;

/// Values of the four channels, bar, bar, l/min, degree, in the campaign format's order; the angle is not a number on
/// a flow bench.
pub type Reading = [f64; 4];

impl Family {
    /// Integration steps a sample: 1 ms, and 0.5 ms where pressures ring.
    fn steps(self) -> usize {
        match self {
            Self::Steady => 20,
            Self::Dynamic => 40,
        }
    }
}

/// Properties of a run that do not follow from physics and manoeuvre.
#[derive(Debug, Clone, Copy)]
pub struct Circumstances {
    /// Time since the campaign began, s.
    pub since_s: f64,
    /// True load relative to the weighed one.
    pub load_factor: f64,
}

/// Measures a run; one reading a sample, the first at time zero.
#[must_use]
pub fn measure(
    physics: &Physics,
    family: Family,
    run: &Manoeuvre,
    circumstances: Circumstances,
) -> Vec<Reading> {
    let mut rig = Rig::new(physics, family, run, circumstances);
    let samples = (run.duration_s * SAMPLE_RATE_HZ).round() as usize;
    let mut readings = vec![rig.read()];
    for sample in 0..samples {
        for step in 0..family.steps() {
            let done = sample as f64 + (step + 1) as f64 / family.steps() as f64;
            rig.advance(run, done / SAMPLE_RATE_HZ);
        }
        readings.push(rig.read());
    }
    readings
}

/// The rig in one run.
struct Rig<'a> {
    circuit: Circuit<'a>,
    paths: [CurrentPath; 2],
    spools: Spools,
    place: Place<'a>,
    family: Family,
    circumstances: Circumstances,
    pressure_offset_pa: f64,
    step_s: f64,
}

/// Bench of the valve block.
enum Place<'a> {
    Hitch(Machine<'a>, Motion, AngleSensor<'a>),
    Flow(f64),
}

impl<'a> Rig<'a> {
    fn new(
        physics: &'a Physics,
        family: Family,
        run: &Manoeuvre,
        circumstances: Circumstances,
    ) -> Self {
        let circuit = Circuit::new(physics, run.oil_temperature_c);
        let place = match run.bench {
            Bench::Flow { port_pressure_bar } => Place::Flow(port_pressure_bar * BAR),
            Bench::Hitch { load_kg } => {
                let load_kg = load_kg * circumstances.load_factor;
                let machine = Machine::new(physics, load_kg, circuit.fluidity());
                let start_m = linkage::travel_m(run.start_deg);
                let motion = machine.at_rest(match family {
                    Family::Steady => start_m,
                    Family::Dynamic => machine.out_of_the_ground_m(start_m),
                });
                let sensor = AngleSensor::new(&physics.sensors, motion.travel_m);
                Place::Hitch(machine, motion, sensor)
            }
        };
        let known_lag_s = match family {
            Family::Steady => 0.0,
            Family::Dynamic => KNOWN_SPOOL_LAG_S,
        };
        let mut rig = Self {
            circuit,
            paths: CurrentPath::both(physics, known_lag_s),
            spools: Spools::default(),
            place,
            family,
            circumstances,
            pressure_offset_pa: physics.sensors.pressure_offset_pa,
            step_s: 1.0 / SAMPLE_RATE_HZ / family.steps() as f64,
        };
        rig.come_to_rest(run);
        rig
    }

    /// Lets spools and compensator settle under the first currents; nothing moves yet.
    fn come_to_rest(&mut self, run: &Manoeuvre) {
        let (lift_a, lower_a) = (run.lift.at(0.0), run.lower.at(0.0));
        for _ in 0..2000 {
            self.spools = Spools {
                lift_a: self.paths[0].advance(lift_a, self.step_s),
                lower_a: self.paths[1].advance(lower_a, self.step_s),
            };
            let pressure_pa = self.pressure_pa();
            self.circuit.advance(self.spools, pressure_pa, self.step_s);
        }
        let travel_m = self.travel_m();
        self.circuit.set_slow(self.circumstances.since_s, travel_m);
    }

    /// Goes on by a step that ends at `time_s`.
    fn advance(&mut self, run: &Manoeuvre, time_s: f64) {
        let dt_s = self.step_s;
        let from = self.spools;
        self.spools = Spools {
            lift_a: self.paths[0].advance(run.lift.at(time_s), dt_s),
            lower_a: self.paths[1].advance(run.lower.at(time_s), dt_s),
        };
        let travel_m = self.travel_m();
        self.circuit
            .set_slow(self.circumstances.since_s + time_s, travel_m);
        let pressure_pa = self.pressure_pa();
        self.circuit.advance(self.spools, pressure_pa, dt_s);
        let spools = [from, self.spools];
        if let Place::Hitch(machine, motion, sensor) = &mut self.place {
            match self.family {
                Family::Steady => machine.step_steady(&self.circuit, motion, spools, dt_s),
                Family::Dynamic => machine.step_dynamic(&self.circuit, motion, spools, dt_s),
            }
            sensor.advance(motion.travel_m, dt_s);
        }
    }

    fn pressure_pa(&self) -> f64 {
        match &self.place {
            Place::Hitch(_, motion, _) => motion.pressure_pa,
            Place::Flow(port_pa) => *port_pa,
        }
    }

    fn travel_m(&self) -> f64 {
        match &self.place {
            Place::Hitch(_, motion, _) => motion.travel_m,
            Place::Flow(_) => f64::INFINITY,
        }
    }

    fn read(&self) -> Reading {
        let pressure_pa = self.pressure_pa();
        let flows = self.circuit.flows(self.spools, pressure_pa);
        let angle_deg = match &self.place {
            Place::Hitch(_, _, sensor) => sensor.shown_deg(),
            Place::Flow(_) => f64::NAN,
        };
        [
            flows.pump_pressure_pa / BAR,
            (pressure_pa + self.pressure_offset_pa) / BAR,
            flows.metered_m3_s / LPM,
            angle_deg,
        ]
    }
}

//! A manoeuvre of one machine: benches, loads, temperatures and current profiles; and its simulated log.

use hitch_campaign::{Bench, Run};
use hitch_plant::simulation::simulate;
use hitch_plant::{Channel, Currents, Model, Rig};

/// Time at rest before the first current rises, s, so that the run starts from an idle plant.
const REST_S: f64 = 0.5;

/// Minutes per run in addition to its duration: moving to the start, logging, naming the file.
const RUN_MIN: f64 = 0.5;

/// Minutes for a change of the load on the hitch.
const LOAD_MIN: f64 = 5.0;

/// Minutes for mounting the valve block on a flow bench and setting a port pressure.
const FLOW_BENCH_MIN: f64 = 15.0;

/// Minutes for a change of the oil temperature.
const OIL_MIN: f64 = 20.0;

/// Usual oil temperature of campaigns, degree Celsius.
pub(crate) const USUAL_OIL_C: f64 = 40.0;

/// One segment of a current profile: a linear ramp to these currents, then a plateau.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Currents at the end of the ramp, A.
    pub to: Currents,
    /// Duration of the ramp, s.
    pub ramp_s: f64,
    /// Duration of the plateau, s.
    pub stay_s: f64,
}

/// Test stand of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stand {
    /// Cylinder, linkage and a load.
    Hitch {
        /// Load at the hitch point, kg.
        load_kg: f64,
        /// Start position of the rocker as a share of its swing: 0 down, 1 up.
        start: f64,
    },
    /// A flow bench.
    Flow {
        /// Pressure at the cylinder port, bar.
        port_pressure_bar: f64,
    },
}

/// One run of a manoeuvre.
#[derive(Debug, Clone, PartialEq)]
pub struct RunPlan {
    /// Test stand.
    pub stand: Stand,
    /// Oil temperature, degree Celsius.
    pub oil_temperature_c: f64,
    /// Current profile.
    pub course: Vec<Segment>,
}

/// A manoeuvre that an engineer can carry out.
#[derive(Debug, Clone, PartialEq)]
pub struct Manoeuvre {
    /// Short name.
    pub name: &'static str,
    /// Instruction, one sentence without its full stop.
    pub instruction: String,
    /// The runs to log.
    pub runs: Vec<RunPlan>,
}

impl Manoeuvre {
    /// Rig time, minutes: the runs and their set-up.
    #[must_use]
    pub fn minutes(&self) -> f64 {
        let (mut minutes, mut load_kg, mut oil_c) = (0.0, f64::NAN, USUAL_OIL_C);
        for run in &self.runs {
            minutes += RUN_MIN + run.duration_s() / 60.0;
            match run.stand {
                Stand::Hitch { load_kg: kg, .. } if kg == load_kg => {}
                Stand::Hitch { load_kg: kg, .. } => {
                    minutes += LOAD_MIN;
                    load_kg = kg;
                }
                Stand::Flow { .. } => {}
            }
            if run.oil_temperature_c != oil_c {
                minutes += OIL_MIN;
                oil_c = run.oil_temperature_c;
            }
        }
        let on_flow_bench = |run: &RunPlan| matches!(run.stand, Stand::Flow { .. });
        if self.runs.iter().any(on_flow_bench) {
            minutes += FLOW_BENCH_MIN;
        }
        minutes
    }

    /// Simulated noise-free log of the manoeuvre with `model` as the rig, for the given channels, by
    /// [`Channel::index`], at a sample rate, Hz.
    #[must_use]
    pub fn log(&self, model: &Model, rate_hz: f64, channels: [bool; 4]) -> Vec<Run> {
        self.runs
            .iter()
            .enumerate()
            .map(|(number, run)| {
                let mut log = run.log(model, rate_hz, channels);
                log.file = format!("{}_{}.csv", self.name, number + 1);
                log
            })
            .collect()
    }
}

impl RunPlan {
    /// Time from first to last sample, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        let segments = self.course.iter();
        REST_S + segments.map(|s| s.ramp_s + s.stay_s).sum::<f64>()
    }

    /// Currents at a time, A.
    #[must_use]
    pub fn currents(&self, time_s: f64) -> Currents {
        let (mut start_s, mut from) = (REST_S, Currents::default());
        for segment in &self.course {
            if time_s <= start_s + segment.ramp_s {
                let share = ((time_s - start_s) / segment.ramp_s).clamp(0.0, 1.0);
                let between = |from_a: f64, to_a: f64| from_a + (to_a - from_a) * share;
                return Currents {
                    lift_a: between(from.lift_a, segment.to.lift_a),
                    lower_a: between(from.lower_a, segment.to.lower_a),
                };
            }
            start_s += segment.ramp_s + segment.stay_s;
            from = segment.to;
            if time_s <= start_s {
                break;
            }
        }
        from
    }

    /// The rig of the run.
    #[must_use]
    pub fn rig(&self, model: &Model) -> Rig {
        let (low_rad, _) = model.linkage().swing_rad();
        self.bench().rig(self.start_rad(model).unwrap_or(low_rad))
    }

    /// Rocker angle at the start, rad; `None` on a flow bench.
    #[must_use]
    pub fn start_rad(&self, model: &Model) -> Option<f64> {
        let (low_rad, high_rad) = model.linkage().swing_rad();
        match self.stand {
            Stand::Hitch { start, .. } => Some(low_rad + start * (high_rad - low_rad)),
            Stand::Flow { .. } => None,
        }
    }

    /// Time stamps of its samples, s, at a rate, Hz.
    #[must_use]
    pub fn time_s(&self, rate_hz: f64) -> Vec<f64> {
        let samples = (self.duration_s() * rate_hz).ceil() as usize;
        (0..=samples).map(|k| k as f64 / rate_hz).collect()
    }

    /// Simulated noise-free log of the run; see [`Manoeuvre::log`].
    #[must_use]
    pub fn log(&self, model: &Model, rate_hz: f64, channels: [bool; 4]) -> Run {
        let time_s = self.time_s(rate_hz);
        let currents: Vec<Currents> = time_s.iter().map(|&t| self.currents(t)).collect();
        let rig = self.rig(model);
        let mut trace = simulate(model, rig, self.oil_temperature_c, &time_s, &currents);
        let on_hitch = matches!(self.stand, Stand::Hitch { .. });
        let logged = Channel::ALL.map(|channel| {
            let has = channels[channel.index()] && (on_hitch || channel != Channel::RockerAngle);
            has.then(|| std::mem::take(&mut trace.channels[channel.index()]))
        });
        Run {
            file: String::new(),
            bench: self.bench(),
            oil_temperature_c: self.oil_temperature_c,
            oil_temperature_known: true,
            time_s,
            lift_current_a: currents.iter().map(|c| c.lift_a).collect(),
            lower_current_a: currents.iter().map(|c| c.lower_a).collect(),
            channels: logged,
            oil_temperature_log_c: None,
        }
    }

    fn bench(&self) -> Bench {
        match self.stand {
            Stand::Hitch { load_kg, .. } => Bench::Hitch { load_kg },
            Stand::Flow { port_pressure_bar } => Bench::Flow { port_pressure_bar },
        }
    }
}

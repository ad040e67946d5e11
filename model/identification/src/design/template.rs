//! A manoeuvre relative to the machine, and its conversion to currents, loads and pressures of one machine.

use hitch_plant::{Currents, Valve};

use crate::design::levels::{Levels, ValveRange};
use crate::design::plan::{Manoeuvre, RunPlan, Segment, Stand};

/// A load of the machine, see [`Levels`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Load {
    /// The light one.
    Light,
    /// The middle one.
    Middle,
    /// The heavy one.
    Heavy,
}

/// A segment of a current profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SegmentTemplate {
    /// The energised valve and its opening: 0 is the threshold, 1 full opening. `None`: both valves off.
    pub open: Option<(Valve, f64)>,
    /// Duration of the ramp, s.
    pub ramp_s: f64,
    /// Duration of the plateau, s.
    pub stay_s: f64,
}

/// Test stand of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StandTemplate {
    /// Cylinder, linkage and a load.
    Hitch {
        /// Load at the hitch point.
        load: Load,
        /// Start position of the rocker as a share of its swing: 0 down, 1 up.
        start: f64,
    },
    /// A flow bench.
    Flow {
        /// Pressure at the cylinder port over the relief setting.
        share_of_relief: f64,
    },
}

/// A run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunTemplate {
    /// Test stand.
    pub stand: StandTemplate,
    /// Oil temperature, degree Celsius.
    pub oil_temperature_c: f64,
    /// Current profile.
    pub course: &'static [SegmentTemplate],
}

/// A manoeuvre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Template {
    /// Short name.
    pub name: &'static str,
    /// Instruction, one sentence without its full stop. In braces: `{lift 0.2}` and `{lower 0.2}` are the currents at
    /// an opening, `{lift-span 0.1}` and `{lower-span 0.1}` differences of currents, `{light}`, `{middle}` and `{heavy}`
    /// loads, `{port 0.1}` a port pressure over the relief setting.
    pub instruction: &'static str,
    /// The runs to log.
    pub runs: &'static [RunTemplate],
}

impl Template {
    /// The manoeuvre on a machine.
    #[must_use]
    pub fn on(&self, levels: &Levels) -> Manoeuvre {
        Manoeuvre {
            name: self.name,
            instruction: levels.filled(self.instruction),
            runs: self.runs.iter().map(|run| run.on(levels)).collect(),
        }
    }
}

impl RunTemplate {
    fn on(&self, levels: &Levels) -> RunPlan {
        RunPlan {
            stand: match self.stand {
                StandTemplate::Hitch { load, start } => Stand::Hitch {
                    load_kg: levels.load_kg(load),
                    start,
                },
                StandTemplate::Flow { share_of_relief } => Stand::Flow {
                    port_pressure_bar: levels.port_pressure_bar(share_of_relief),
                },
            },
            oil_temperature_c: self.oil_temperature_c,
            course: self.course.iter().map(|part| part.on(levels)).collect(),
        }
    }
}

impl SegmentTemplate {
    fn on(&self, levels: &Levels) -> Segment {
        let only = |(valve, opening)| Currents::only(valve, levels.range(valve).current_a(opening));
        Segment {
            to: self.open.map_or_else(Currents::default, only),
            ramp_s: self.ramp_s,
            stay_s: self.stay_s,
        }
    }
}

impl Levels {
    fn range(&self, valve: Valve) -> ValveRange {
        match valve {
            Valve::Lift => self.lift,
            Valve::Lower => self.lower,
        }
    }

    fn load_kg(&self, load: Load) -> f64 {
        match load {
            Load::Light => self.light_kg,
            Load::Middle => self.middle_kg,
            Load::Heavy => self.heavy_kg,
        }
    }

    fn port_pressure_bar(&self, share_of_relief: f64) -> f64 {
        (share_of_relief * self.relief_bar).round()
    }

    /// An instruction with the values of the machine.
    fn filled(&self, instruction: &str) -> String {
        let mut parts = instruction.split('{');
        let mut text = parts.next().unwrap_or_default().to_owned();
        for part in parts {
            let (value, rest) = part.split_once('}').unwrap_or((part, ""));
            text += &self.value(value);
            text += rest;
        }
        text
    }

    /// A value of an instruction; the word itself if it is unknown.
    fn value(&self, word: &str) -> String {
        let (kind, number) = word.split_once(' ').unwrap_or((word, ""));
        let number: f64 = number.parse().unwrap_or(f64::NAN);
        match kind {
            "light" => format!("{:.0}", self.light_kg),
            "middle" => format!("{:.0}", self.middle_kg),
            "heavy" => format!("{:.0}", self.heavy_kg),
            "lift" => amperes(self.lift, self.lift.current_a(number)),
            "lower" => amperes(self.lower, self.lower.current_a(number)),
            "lift-span" => amperes(self.lift, self.lift.span_a(number)),
            "lower-span" => amperes(self.lower, self.lower.span_a(number)),
            "port" => format!("{:.0}", self.port_pressure_bar(number)),
            _ => word.to_owned(),
        }
    }
}

/// A current with as many decimals as it needs, at least one.
fn amperes(range: ValveRange, current_a: f64) -> String {
    let text = format!("{current_a:.*}", range.decimals());
    let short = text.trim_end_matches('0');
    match short.strip_suffix('.') {
        Some(whole) => format!("{whole}.0"),
        None => short.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use hitch_campaign::{Bench, Campaign, Noise, Run};
    use hitch_plant::{Model, ValveCurve};

    use super::*;
    use crate::data::experiment::Experiment;
    use crate::design::manoeuvre::TEMPLATES;

    /// An experiment with resting runs at these loads.
    fn experiment(model: &Model, loads_kg: &[f64]) -> Experiment {
        let run = |&load_kg: &f64| Run {
            file: format!("{load_kg}.csv"),
            bench: Bench::Hitch { load_kg },
            oil_temperature_c: 40.0,
            oil_temperature_known: true,
            time_s: (0..50).map(|k| f64::from(k) * 0.02).collect(),
            lift_current_a: vec![0.0; 50],
            lower_current_a: vec![0.0; 50],
            channels: [None, None, None, Some(vec![90.0; 50])],
            oil_temperature_log_c: None,
        };
        let campaign = Campaign {
            name: "levels".to_owned(),
            description: String::new(),
            sample_rate_hz: 50.0,
            synchronous: true,
            noise: Noise::default(),
            runs: loads_kg.iter().map(run).collect(),
        };
        Experiment::new(&campaign, model)
    }

    fn instruction(name: &str, model: &Model, loads_kg: &[f64]) -> String {
        let levels = Levels::new(&experiment(model, loads_kg), model);
        let template = TEMPLATES.iter().find(|template| template.name == name);
        template.unwrap().on(&levels).instruction
    }

    #[test]
    fn the_papers_machine_has_the_currents_of_its_valve_tables() {
        let model = hitch_model_file::nominal();
        assert_eq!(
            instruction("full-opening", &model, &[50.0, 150.0, 250.0]),
            "with 50 kg open the lift valve fully (3.3 A) for 0.7 s from near the bottom, then the lowering valve \
             (3.1 A) for 0.5 s from near the top"
        );
        let one_load = instruction("hold-at-two-loads", &model, &[150.0]);
        assert!(
            one_load.ends_with("once with 50 kg and once with 250 kg"),
            "{one_load}"
        );
        let bench = instruction("flow-bench-lift", &model, &[]);
        assert!(
            bench.ends_with("at port pressures of 20 and 140 bar"),
            "{bench}"
        );
    }

    /// Valves that are fully open at 1.6 A.
    fn small_valves() -> Model {
        let nominal = hitch_model_file::nominal();
        let mut constants = nominal.constants().clone();
        let flows = vec![0.0, 0.0, 1e-3, 1e-3];
        let curve = ValveCurve::new(vec![0.0, 0.6, 1.5, 1.6], flows).unwrap();
        constants.lift_valve.curve = curve.clone();
        constants.lower_valve.curve = curve;
        nominal.with_constants(constants).unwrap()
    }

    #[test]
    fn no_current_exceeds_the_flow_curve_and_no_load_the_relief_setting() {
        let model = small_valves();
        for loads_kg in [
            &[][..],
            &[100.0],
            &[80.0, 120.0],
            &[0.0, 300.0],
            &[90.0, 140.0, 240.0],
        ] {
            let levels = Levels::new(&experiment(&model, loads_kg), &model);
            for template in TEMPLATES {
                let manoeuvre = template.on(&levels);
                let text = &manoeuvre.instruction;
                assert!(
                    !text.contains(['{', '}']) && !text.contains("NaN"),
                    "{text}"
                );
                for run in &manoeuvre.runs {
                    let segments = run.course.iter();
                    let currents = segments.flat_map(|part| [part.to.lift_a, part.to.lower_a]);
                    let largest = currents.fold(0.0, f64::max);
                    assert!(largest <= 1.6, "{text}: {largest}");
                }
            }
            assert!(levels.light_kg < levels.middle_kg && levels.middle_kg < levels.heavy_kg);
            assert!(levels.heavy_kg <= levels.capacity_kg, "{levels:?}");
        }
    }
}

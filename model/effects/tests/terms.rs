//! User-defined terms in the plant: at every place, on the hitch and on the flow bench, steady and dynamic.

use hitch_effects::expression::{ParameterDefinition, TermDefinition};
use hitch_effects::{TermEffect, find};
use hitch_plant::simulation::{Trace, simulate};
use hitch_plant::units::pa_from_bar;
use hitch_plant::{AddedEffect, Currents, Effect, HitchRig, Model, Place, Rig};

const STEP_S: f64 = 0.01;

const HITCH: Rig = Rig::Hitch(HitchRig {
    load_kg: 150.0,
    start_angle_rad: 1.4,
});

fn bench() -> Rig {
    Rig::Flow {
        port_pressure_pa: pa_from_bar(15.0),
    }
}

/// A term with one parameter `c`, its size, at a value.
fn term(place: Place, formula: &str, unit: &str, value: f64) -> AddedEffect {
    let definition = TermDefinition {
        id: "of-my-own".to_owned(),
        title: String::new(),
        place,
        formula: formula.to_owned(),
        parameters: vec![ParameterDefinition {
            name: "c".to_owned(),
            unit: unit.to_owned(),
            meaning: String::new(),
            null: 0.0,
            start: value,
            low: -2.0 * value.abs(),
            high: 2.0 * value.abs(),
        }],
    };
    AddedEffect::typical(TermEffect::define(definition).unwrap())
}

/// Lifting and lowering with pauses; returns all instruments.
fn run(model: &Model, rig: Rig) -> Trace {
    let trapezoid = |time_s: f64, start_s: f64| {
        let (rise, fall) = ((time_s - start_s) / 0.15, (start_s + 1.0 - time_s) / 0.15);
        rise.min(fall).clamp(0.0, 1.0)
    };
    let time_s: Vec<f64> = (0..400).map(|step| f64::from(step) * STEP_S).collect();
    let currents: Vec<Currents> = time_s
        .iter()
        .map(|&time_s| Currents {
            lift_a: 1.6 * trapezoid(time_s, 0.2),
            lower_a: 1.8 * trapezoid(time_s, 2.0),
        })
        .collect();
    simulate(model, rig, 40.0, &time_s, &currents)
}

/// Largest difference of two traces, in the channels' units; NaN has to occur in both.
fn difference(a: &Trace, b: &Trace) -> f64 {
    let pairs = a.channels.iter().flatten().zip(b.channels.iter().flatten());
    pairs
        .filter(|(a, b)| !(a.is_nan() && b.is_nan()))
        .map(|(a, b)| {
            assert!(a.is_finite() && b.is_finite());
            (a - b).abs()
        })
        .fold(0.0, f64::max)
}

fn with(model: &Model, effect: AddedEffect) -> Model {
    model.with_effects(vec![effect])
}

fn models() -> [Model; 2] {
    [hitch_model_file::nominal(), hitch_model_file::dynamic()]
}

/// Place, formula, unit and value of a term, and an effect of the catalogue with its values.
type Twin = (
    Place,
    &'static str,
    &'static str,
    f64,
    &'static str,
    &'static [f64],
);

/// A formula and the equivalent effect of the catalogue, with its values.
#[rustfmt::skip]
const TWINS: [Twin; 9] = [
    (Place::LiftCurrent, "-c", "A", 0.05, "lift-threshold-shift", &[0.05]),
    (Place::LowerCurrent, "-c", "A", 0.05, "lower-threshold-shift", &[0.05]),
    (Place::LiftFlowFactor, "c", "", 0.1, "lift-flow-scale", &[0.1]),
    (Place::LowerFlowFactor, "c", "", 0.1, "lower-flow-scale", &[0.1]),
    (Place::Friction, "c * tanh(v / 3[mm/s])", "N", 400.0, "coulomb-friction", &[400.0]),
    (Place::Friction, "c * v", "N s/m", 5000.0, "viscous-friction", &[5000.0]),
    (Place::CylinderPressureSensor, "c", "bar", 0.5, "pressure-sensor-offset", &[0.5]),
    (Place::AngleSensor, "c * rocker_angle", "", 0.02, "angle-sensor-gain", &[0.02]),
    (Place::Leakage, "c * p_cyl", "l/min/bar", 0.02, "lowering-leakage", &[0.02]),
];

#[test]
fn a_term_that_writes_down_an_effect_is_that_effect() {
    for model in models() {
        for rig in [HITCH, bench()] {
            for (place, formula, unit, value, id, values) in TWINS {
                let own = run(&with(&model, term(place, formula, unit, value)), rig);
                let effect = AddedEffect {
                    effect: find(id).unwrap(),
                    values: values.to_vec(),
                };
                let twin = run(&with(&model, effect), rig);
                let away = difference(&own, &twin);
                // The dynamic plant cuts the end of an oscillation unless an effect sustains it.
                assert!(away < 1e-3, "{formula} is not {id}: {away}, {}", model.name);
            }
        }
    }
}

#[test]
fn a_term_acts_at_every_place() {
    for model in models() {
        let plain = run(&model, HITCH);
        for place in Place::all() {
            let (unit, value) = match place.unit() {
                "A" => ("A", 0.05),
                "1" => ("", 0.1),
                "m3/s" => ("l/min", 1.0),
                "N" => ("N", 500.0),
                "Pa" => ("bar", 1.0),
                _ => ("deg", 1.0),
            };
            let own = run(&with(&model, term(place, "c", unit, value)), HITCH);
            let away = difference(&own, &plain);
            assert!(away > 0.01, "{} in {}", place.id(), model.name);
        }
    }
}

#[test]
fn a_flow_is_limited_exactly() {
    let limit = "-step(c) * ramp(1 - 8[l/min] / max(q_lower, 1[l/min]))";
    for model in models() {
        for rig in [HITCH, bench()] {
            let limited = run(
                &with(&model, term(Place::LowerFlowFactor, limit, "", 1.0)),
                rig,
            );
            let free = run(&model, rig);
            let least = |trace: &Trace| trace.channels[2].iter().copied().fold(0.0, f64::min);
            assert!(least(&free) < -10.0);
            assert!((least(&limited) + 8.0).abs() < 1e-6, "{}", model.name);
        }
    }
}

#[test]
fn a_term_of_the_piston_is_absent_on_the_flow_bench() {
    let cushion = term(Place::LowerFlowFactor, "-c * ramp(1 - x / 40[mm])", "", 0.9);
    for model in models() {
        let own = run(&with(&model, cushion.clone()), bench());
        assert_eq!(difference(&own, &run(&model, bench())), 0.0);
    }
}

#[test]
fn a_driving_force_and_a_suction_are_followed() {
    for model in models() {
        let plain = run(&model, HITCH);
        for (place, formula, unit, value) in [
            (Place::Friction, "-c", "N", 2000.0),
            (Place::ReturnPressure, "-c", "bar", 2.0),
        ] {
            let own = run(&with(&model, term(place, formula, unit, value)), HITCH);
            let lowered = |trace: &Trace| trace.channels[2].iter().sum::<f64>();
            assert!((lowered(&own) - lowered(&plain)).abs() > 1.0, "{formula}");
        }
    }
}

#[test]
fn what_is_not_finite_or_beyond_all_bounds_stops_nothing() {
    for model in models() {
        for rig in [HITCH, bench()] {
            for place in Place::all() {
                for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e300] {
                    let lawless = Lawless { place, value };
                    let effect: &'static dyn Effect = Box::leak(Box::new(lawless));
                    let trace = run(
                        &with(
                            &model,
                            AddedEffect {
                                effect,
                                values: vec![1.0],
                            },
                        ),
                        rig,
                    );
                    let plain = run(&model, rig);
                    if !value.is_finite() {
                        // The start angle is found iteratively with the sensor's term, to 0.1 um of travel.
                        assert!(difference(&trace, &plain) < 1e-6, "{}", place.id());
                    }
                }
            }
        }
    }
}

/// An effect whose term has an invalid value.
#[derive(Debug)]
struct Lawless {
    place: Place,
    value: f64,
}

impl Effect for Lawless {
    fn id(&self) -> &'static str {
        "lawless"
    }

    fn rank(&self) -> usize {
        usize::MAX
    }

    fn title(&self) -> &'static str {
        ""
    }

    fn equation(&self) -> &'static str {
        ""
    }

    fn source(&self) -> &'static str {
        ""
    }

    fn shows(&self) -> &'static str {
        ""
    }

    fn parameters(&self) -> &'static [hitch_plant::Parameter] {
        find("coulomb-friction").unwrap().parameters()
    }

    fn channels(&self) -> &'static [hitch_plant::Channel] {
        &[]
    }

    fn attach(
        &self,
        _: &[f64],
        _: hitch_plant::hooks::effect_hooks::RunConditions<'_>,
        hooks: &mut hitch_plant::hooks::effect_hooks::EffectHooks,
    ) {
        let value = self.value;
        hooks.terms.push((self.place, Box::new(move |_| value)));
    }
}

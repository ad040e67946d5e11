//! Traces of every effect, bit for bit those recorded in `same_bits/traces.txt`.
//!
//! A change that is to make the plant faster must not change a bit. A change of the physics does: the test then writes the
//! traces of the changed plant to the folder of the build and names the file, which replaces the recorded one.
//!
//! Exponential, tangent and power are those of the C library, which differ between libraries and processors. The record
//! holds a check value of theirs; where it differs, the means of the traces are compared within [`OTHER_LIBRARY`].

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use hitch_effects::TermEffect;
use hitch_effects::expression::{ParameterDefinition, TermDefinition};
use hitch_plant::hooks::effect::full_name;
use hitch_plant::simulation::{Trace, simulate_in};
use hitch_plant::solver::dynamic::Steps;
use hitch_plant::units::pa_from_bar;
use hitch_plant::{
    AddedEffect, Currents, Effect, HitchRig, LinkageTable, Model, Place, Plant, PumpKind, Rig,
};

/// Largest relative difference of means computed with another C library.
const OTHER_LIBRARY: f64 = 1e-3;

const SEED: u64 = 58;

/// Uniform random numbers between 0 and 1 (Knuth's linear congruential generator).
struct Random(u64);

impl Random {
    fn share(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }
}

/// FNV-1a over the bits of numbers, and their mean.
struct Digest {
    hash: u64,
    sum: f64,
    count: f64,
}

impl Digest {
    fn new() -> Self {
        Self {
            hash: 0xcbf2_9ce4_8422_2325,
            sum: 0.0,
            count: 0.0,
        }
    }

    fn add(&mut self, value: f64) {
        // The sign of a NaN has no meaning.
        let bits = if value.is_nan() {
            f64::NAN.to_bits()
        } else {
            self.sum += value;
            self.count += 1.0;
            value.to_bits()
        };
        for byte in bits.to_le_bytes() {
            self.hash = (self.hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn mean(&self) -> f64 {
        self.sum / self.count.max(1.0)
    }
}

/// Check value of the functions of the C library that plant and effects use.
fn library() -> u64 {
    let mut digest = Digest::new();
    let mut random = Random(SEED);
    for _ in 0..2000 {
        let x = random.between(-8.0, 8.0);
        for value in [
            x.exp(),
            x.tanh(),
            x.sin(),
            x.cos(),
            x.abs().powf(0.83),
            x.abs().ln(),
            x.atan2(0.7),
        ] {
            digest.add(value);
        }
    }
    digest.hash
}

/// Random currents: pauses, ramps and jumps of either valve, sometimes of both, with and without noise.
fn currents(random: &mut Random, samples: usize) -> Vec<Currents> {
    let mut currents = Vec::with_capacity(samples);
    let mut level = Currents::default();
    while currents.len() < samples {
        let target = match (random.share() * 6.0) as u32 {
            0 | 1 => Currents::default(),
            2 => Currents {
                lift_a: random.between(0.8, 3.2),
                lower_a: random.between(0.8, 2.4),
            },
            3 => Currents {
                lift_a: 0.0,
                lower_a: random.between(0.9, 3.2),
            },
            _ => Currents {
                lift_a: random.between(0.9, 3.2),
                lower_a: 0.0,
            },
        };
        let length = random.between(4.0, 50.0) as usize;
        let ramp = [1.0, 5.0, 25.0][(random.share() * 3.0) as usize];
        let noise_a = [0.0, 0.03][(random.share() * 2.0) as usize];
        for sample in 0..length {
            let share = ((sample as f64 + 1.0) / ramp).min(1.0);
            let at = level.towards(target, share);
            currents.push(
                at.map(|_, current_a| (current_a + noise_a * random.between(-1.0, 1.0)).max(0.0)),
            );
        }
        level = target;
    }
    currents.truncate(samples);
    currents
}

fn add(digest: &mut Digest, trace: &Trace) {
    let channels = trace.channels.iter().chain([&trace.true_angle_deg]);
    for value in channels.flatten() {
        digest.add(*value);
    }
    digest.add(trace.idle_pressure_bar);
}

/// Runs of a model on hitch and flow bench at several loads, temperatures, rates and steps.
fn runs(model: &Model, random: &mut Random) -> Digest {
    let mut digest = Digest::new();
    for (steps, sample_s, samples) in [
        (Steps::FINE, 0.02, 400),
        (Steps::COARSE, 0.02, 300),
        (Steps::FINE, 0.002, 400),
        (Steps::FINE, 0.1, 100),
    ] {
        let hitch = Rig::Hitch(HitchRig {
            load_kg: random.between(0.0, 700.0),
            start_angle_rad: random.between(0.75, 2.4),
        });
        let bench = Rig::Flow {
            port_pressure_pa: pa_from_bar(random.between(2.0, 160.0)),
        };
        let time_s: Vec<f64> = (0..samples).map(|k| k as f64 * sample_s).collect();
        for rig in [hitch, bench] {
            let currents = currents(random, samples);
            let oil_c = random.between(20.0, 75.0);
            let trace = simulate_in(steps, model, rig, oil_c, &time_s, &currents);
            add(&mut digest, &trace);
        }
        changing(model, hitch, random, &mut digest);
    }
    digest
}

/// A run during which load and temperature change, and the whole state of which is compared.
fn changing(model: &Model, rig: Rig, random: &mut Random, digest: &mut Digest) {
    let currents = currents(random, 200);
    let mut plant = Plant::new(model, rig, 30.0, currents[0]);
    for (sample, at) in currents.iter().enumerate() {
        match sample {
            50 => plant.set_load_kg(random.between(0.0, 400.0)),
            120 => plant.set_oil_temperature_c(random.between(30.0, 70.0)),
            _ => {}
        }
        plant.step(*at, 0.01);
        let (state, flows) = (plant.state(), plant.flows());
        for value in [
            state.piston_m,
            state.speed_m_s,
            state.pressure_pa,
            state.void_m3,
            state.bristles_m,
            state.wall_behind_pa,
            state.compensator_pa,
            flows.pump_pressure_pa,
            flows.lift_m3_s,
            flows.lower_m3_s,
            flows.leakage_m3_s,
            plant.load_frequency_rad_s(),
            plant.dry_friction_pa(),
        ] {
            digest.add(value);
        }
    }
}

/// An effect with values within their ranges.
fn varied(effect: &'static dyn Effect, random: &mut Random) -> AddedEffect {
    let mut added = AddedEffect::typical(effect);
    for (value, parameter) in added.values.iter_mut().zip(effect.parameters()) {
        *value = parameter.moved(*value, random.between(-0.1, 0.1));
    }
    added
}

/// Terms at every place.
fn terms() -> Vec<AddedEffect> {
    let term = |place: Place, formula: &str, unit: &str, value: f64| {
        let definition = TermDefinition {
            id: format!("own-{}", place.id()),
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
    };
    vec![
        term(Place::LiftCurrent, "c * i_lift", "1", 0.03),
        term(Place::LowerCurrent, "c * i_lower", "1", -0.03),
        term(Place::LiftFlowFactor, "c * q_lift", "s/m3", 100.0),
        term(Place::LowerFlowFactor, "c * p_cyl", "1/Pa", 2e-8),
        term(Place::Leakage, "c * p_cyl", "m3/s/Pa", 1e-13),
        term(Place::Friction, "c * v", "N*s/m", 900.0),
        term(Place::Weight, "c * f_weight", "1", 0.05),
        term(Place::CylinderPressureSensor, "c * p_cyl", "1", 0.01),
        term(Place::ReturnPressure, "c * q_lower", "Pa*s/m3", 4e8),
        term(Place::CompensatorMargin, "c * p_cyl", "1", 0.01),
    ]
}

/// The effect of the catalogue with this full name.
fn named(name: &str) -> &'static dyn Effect {
    let mut effects = hitch_effects::CATALOGUE.iter();
    let found = effects.find(|effect| full_name(**effect) == name);
    *found.expect("an effect of the catalogue")
}

/// The models with other components than the two that come with the project.
fn other_machines(base: &Model) -> Vec<(&'static str, Model)> {
    let with = |change: &dyn Fn(&mut hitch_plant::Constants)| {
        let mut constants = base.constants().clone();
        change(&mut constants);
        base.with_constants(constants).unwrap()
    };
    let load_sensing = |response_s: f64| {
        with(&|constants| {
            constants.pump.kind = PumpKind::LoadSensing;
            constants.pump.standby_pressure_pa = pa_from_bar(22.0);
            constants.pump.response_time_s = response_s;
        })
    };
    let swap_transition = with(&|constants| {
        for valve in [&mut constants.lift_valve, &mut constants.lower_valve] {
            valve.transition_drop_pa = pa_from_bar(0.1) - valve.transition_drop_pa;
        }
    });
    let small_pump = with(&|constants| constants.pump.theoretical_flow_m3_s *= 0.4);
    let measured = with(&|constants| {
        let travel_m: Vec<f64> = (0..=10).map(|k| f64::from(k) * 0.0158).collect();
        let postures = travel_m.iter().map(|&x| base.linkage().at(x));
        let (angles, heights) = postures.map(|p| (p.rocker_angle_rad, p.height_m)).unzip();
        constants.linkage_table = Some(LinkageTable::new(travel_m, angles, heights).unwrap());
    });
    vec![
        ("load-sensing", load_sensing(0.0)),
        ("slow load-sensing", load_sensing(0.08)),
        ("other orifices", swap_transition),
        ("small pump", small_pump),
        ("measured linkage", measured),
    ]
}

/// Every model of the test with its name.
fn models() -> Vec<(String, Model)> {
    let mut random = Random(SEED);
    let mut models = Vec::new();
    let mut push = |name: String, model: Model| models.push((name, model));
    for base in [hitch_model_file::nominal(), hitch_model_file::dynamic()] {
        let name = |rest: &str| format!("{}: {rest}", base.name);
        for effect in hitch_effects::CATALOGUE {
            let id = full_name(*effect);
            push(
                name(&id),
                base.with_effects(vec![AddedEffect::typical(*effect)]),
            );
            let varied = varied(*effect, &mut random);
            push(
                name(&format!("{id} varied")),
                base.with_effects(vec![varied]),
            );
        }
        for number in 0..40 {
            let effects = hitch_effects::CATALOGUE;
            let mut drawn: Vec<AddedEffect> = Vec::new();
            for _ in 0..2 + number % 4 {
                let effect = effects[(random.share() * effects.len() as f64) as usize];
                if drawn.iter().all(|added| added.effect.id() != effect.id()) {
                    drawn.push(varied(effect, &mut random));
                }
            }
            push(name(&format!("mixture {number}")), base.with_effects(drawn));
        }
        for term in terms() {
            push(name(term.effect.id()), base.with_effects(vec![term]));
        }
        push(name("all terms"), base.with_effects(terms()));
        for (machine, model) in other_machines(&base) {
            let droop = named("compensator-droop/lagging");
            let slow = model.with_effects(vec![AddedEffect::typical(droop)]);
            push(name(machine), model);
            push(name(&format!("{machine}, lagging")), slow);
        }
        push(name("no effect"), base.clone());
    }
    models
}

/// A line of the record: hash and mean, by the name of the model.
type Record = BTreeMap<String, (u64, f64)>;

fn parsed(text: &str) -> Record {
    let line = |line: &str| {
        let (hash, rest) = line.split_once(' ')?;
        let (mean, name) = rest.split_once(' ')?;
        let values = (
            u64::from_str_radix(hash, 16).ok()?,
            mean.parse::<f64>().ok()?,
        );
        Some((name.to_owned(), values))
    };
    text.lines().filter_map(line).collect()
}

fn written(record: &Record) -> String {
    let mut text = String::new();
    for (name, (hash, mean)) in record {
        let _ = writeln!(text, "{hash:016x} {mean:e} {name}");
    }
    text
}

const LIBRARY: &str = "C library";

#[test]
fn traces_are_those_recorded() {
    println!("seed {SEED}");
    let mut now = Record::new();
    now.insert(LIBRARY.to_owned(), (library(), 0.0));
    for (number, (name, model)) in models().into_iter().enumerate() {
        let digest = runs(&model, &mut Random(SEED + number as u64));
        let before = now.insert(name.clone(), (digest.hash, digest.mean()));
        assert!(before.is_none(), "two models have the name {name}");
    }
    let recorded = parsed(include_str!("same_bits/traces.txt"));
    let same_library = recorded.get(LIBRARY) == now.get(LIBRARY);
    let agrees = |name: &String, (hash, mean): &(u64, f64)| match recorded.get(name) {
        Some((recorded, _)) if same_library => recorded == hash,
        Some((_, recorded)) => (recorded - mean).abs() <= OTHER_LIBRARY * recorded.abs().max(1.0),
        None => false,
    };
    let differing: Vec<&String> = now
        .iter()
        .filter(|(name, values)| *name != LIBRARY && !agrees(name, values))
        .map(|(name, _)| name)
        .collect();
    if !differing.is_empty() || recorded.len() != now.len() {
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("traces.txt");
        std::fs::write(&file, written(&now)).unwrap();
        panic!(
            "{} of {} traces differ (same C library: {same_library}): {differing:?}. If the physics was to change, replace \
             model/plant/tests/same_bits/traces.txt by {}",
            differing.len(),
            now.len(),
            file.display()
        );
    }
}

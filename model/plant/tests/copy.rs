//! A copy of a plant in motion goes on as the plant does.

use hitch_plant::{AddedEffect, Currents, HitchRig, Model, Plant, Reading, Rig};

const STEP_S: f64 = 0.002;

/// Lifting and lowering with reversals.
fn currents(step: u32) -> Currents {
    let wave_a = (f64::from(step) * 0.03).sin() * 2.5;
    Currents {
        lift_a: wave_a.max(0.0),
        lower_a: (-wave_a).max(0.0),
    }
}

fn advance(plant: &mut Plant<'_>, steps: std::ops::Range<u32>) -> Vec<Reading> {
    let step = |step| {
        plant.step(currents(step), STEP_S);
        plant.reading()
    };
    steps.map(step).collect()
}

/// Every effect, in all its forms, alone; and all that have one form, together.
fn models() -> Vec<Model> {
    let mut models = Vec::new();
    for base in [hitch_model_file::nominal(), hitch_model_file::dynamic()] {
        let typical = |effect: &&'static dyn hitch_plant::Effect| AddedEffect::typical(*effect);
        let every = hitch_effects::CATALOGUE.iter().map(typical);
        let alone = every.clone().map(|effect| base.with_effects(vec![effect]));
        models.extend(alone);
        let together = every.filter(|added| added.effect.form().is_none());
        models.push(base.with_effects(together.collect()));
        models.push(base);
    }
    models
}

#[test]
fn a_copy_goes_on_as_the_plant_does() {
    let hitch = Rig::Hitch(HitchRig {
        load_kg: 150.0,
        start_angle_rad: 90.0_f64.to_radians(),
    });
    let bench = Rig::Flow {
        port_pressure_pa: 4e6,
    };
    for model in models() {
        for rig in [hitch, bench] {
            let mut plant = Plant::new(&model, rig, 62.0, currents(0));
            advance(&mut plant, 0..150);
            let other = model.clone();
            let mut copy = plant.copied_onto(&other);
            let shown = |readings: Vec<Reading>| format!("{readings:?}");
            let expected = shown(advance(&mut plant, 150..400));
            assert_eq!(
                shown(advance(&mut copy, 150..400)),
                expected,
                "{:?}",
                model.effects
            );
            if rig == hitch {
                // It is in motion: a plant at rest goes on otherwise.
                let mut fresh = Plant::new(&model, rig, 62.0, currents(150));
                assert_ne!(shown(advance(&mut fresh, 150..400)), expected);
            }
        }
    }
}

//! The tractor at work.

use hitch_field::draft::Texture;
use hitch_field::noise::Noise;
use hitch_field::soil::{SoilPlan, Stretch};
use hitch_field::terrain::{RoughnessConstants, Terrain, Undulation};
use hitch_field::tractor::{Demand, Outputs, Tractor, TractorConstants};
use proptest::prelude::*;

use crate::{assert_near, cases};

const SEED: u64 = 20;

const PLOUGHING: Demand = Demand {
    link_depth_m: 0.25,
    speed_m_s: 6.5 / 3.6,
};

const RAISED: Demand = Demand {
    link_depth_m: -0.4,
    speed_m_s: 6.5 / 3.6,
};

fn tractor(soil: SoilPlan, terrain: Terrain) -> Tractor {
    Tractor::new(TractorConstants::ploughing(), soil, terrain, SEED)
}

fn uniform(texture: Texture) -> Tractor {
    tractor(SoilPlan::uniform(texture), Terrain::flat())
}

fn drive(tractor: &mut Tractor, demand: Demand, time_s: f64, dt_s: f64) -> Vec<Outputs> {
    let steps = (time_s / dt_s).round() as u32;
    (0..steps).map(|_| tractor.step(demand, dt_s)).collect()
}

fn settled(texture: Texture) -> Outputs {
    let mut tractor = uniform(texture);
    *drive(&mut tractor, PLOUGHING, 60.0, 0.005).last().unwrap()
}

#[test]
fn settled_work_is_the_standard_draft_at_the_depth_to_which_the_tractor_sinks() {
    let constants = TractorConstants::ploughing();
    for texture in [Texture::Fine, Texture::Medium, Texture::Coarse] {
        let state = settled(texture);
        let draft_n = constants
            .implement
            .draft_n(texture, state.depth_m, PLOUGHING.speed_m_s);
        println!(
            "{texture:?}: depth {:.3} m, draft {:.2} kN, vertical {:.2} kN, slip {:.1} %, front {:.1} kN, rear {:.1} kN",
            state.depth_m,
            state.draft_n / 1e3,
            state.vertical_n / 1e3,
            100.0 * state.slip,
            state.axle_loads.front_n / 1e3,
            state.axle_loads.rear_n / 1e3
        );
        assert_near(state.draft_n, draft_n, 1.0);
        assert_near(state.ground_speed_m_s, PLOUGHING.speed_m_s, 1e-3);
        assert_near(
            state.wheel_speed_m_s * (1.0 - state.slip),
            state.ground_speed_m_s,
            1e-9,
        );
        assert_near(state.depth_m, PLOUGHING.link_depth_m, 0.06);
    }
}

/// Slip and loads from the equations at the settled state, by hand.
#[test]
fn settled_loads_and_slip_balance() {
    let state = settled(Texture::Medium);
    let (weight_n, implement_n) = (4500.0 * 9.81, 600.0 * 9.81);
    let rear_n = weight_n * 1.5 / 2.551
        + (implement_n * (2.551 + 1.9)
            - state.vertical_n * (2.551 + 2.0)
            - state.draft_n * state.depth_m * 2.0 / 3.0)
            / 2.551;
    assert_near(state.axle_loads.rear_n, rear_n, 5.0);
    let front_n = weight_n + implement_n - state.vertical_n - rear_n;
    assert_near(state.axle_loads.front_n, front_n, 5.0);
    let bn = 700.0 * 0.467 * 1.65 / (rear_n / 2000.0) * 2.0 / (1.0 + 3.0 * 0.467 / 1.65);
    let gross = 0.88 * (1.0 - (-0.1 * bn).exp()) * (1.0 - (-7.5 * state.slip).exp()) + 0.04;
    let resistance = 1.0 / bn + 0.04 + 0.5 * state.slip / bn.sqrt();
    let pull_n = (gross - resistance) * rear_n;
    assert_near(pull_n, state.draft_n + 0.07 * front_n, 10.0);
}

#[test]
fn a_raised_implement_has_no_draft() {
    let mut tractor = uniform(Texture::Fine);
    drive(&mut tractor, PLOUGHING, 10.0, 0.005);
    for state in drive(&mut tractor, RAISED, 5.0, 0.005) {
        assert!(state.depth_m < 0.0);
        assert_eq!((state.draft_n, state.vertical_n), (0.0, 0.0));
    }
}

#[test]
fn slip_rises_on_a_soft_patch_and_falls_behind_it() {
    let mut soil = SoilPlan::uniform(Texture::Medium);
    soil.stretches = vec![Stretch::soft_patch(40.0, 20.0)];
    let mut tractor = tractor(soil, Terrain::flat());
    let states = drive(&mut tractor, PLOUGHING, 50.0, 0.005);
    let slip_at = |distance_m: f64| {
        let state = states.iter().find(|state| state.distance_m > distance_m);
        state.unwrap().slip
    };
    let [before, within, behind] = [38.0, 55.0, 75.0].map(slip_at);
    println!("slip before, on and behind the patch: {before:.3}, {within:.3}, {behind:.3}");
    assert!(within > 1.5 * before);
    assert_near(behind, before, 0.01);
}

#[test]
fn wheels_without_grip_spin_until_the_implement_is_raised() {
    let mut soil = SoilPlan::uniform(Texture::Fine);
    soil.cone_index_kpa = 150.0;
    let mut tractor = tractor(soil, Terrain::flat());
    let stuck = *drive(&mut tractor, PLOUGHING, 30.0, 0.005).last().unwrap();
    assert!(stuck.slip > 0.99 && stuck.ground_speed_m_s < 0.01);
    assert_eq!(stuck.wheel_speed_m_s, 4.0);
    let freed = *drive(&mut tractor, RAISED, 10.0, 0.005).last().unwrap();
    assert!(freed.slip < 0.3);
    assert_near(freed.ground_speed_m_s, RAISED.speed_m_s, 0.01);
}

#[test]
fn a_standing_tractor_has_neither_draft_nor_speed() {
    let mut tractor = uniform(Texture::Medium);
    drive(&mut tractor, PLOUGHING, 10.0, 0.005);
    let stop = Demand {
        speed_m_s: 0.0,
        ..PLOUGHING
    };
    let standing = *drive(&mut tractor, stop, 20.0, 0.005).last().unwrap();
    assert!(standing.depth_m > 0.2);
    assert_near(standing.draft_n, 0.0, 1.0);
    assert_near(standing.wheel_speed_m_s, 0.0, 1e-9);
}

fn varied() -> Tractor {
    let terrain = Terrain::flat()
        .with_undulation(Undulation {
            wavelength_m: 10.0,
            amplitude_m: 0.05,
        })
        .with_roughness(&RoughnessConstants::class_d(), &mut Noise::new(SEED, 9));
    tractor(SoilPlan::varying(Texture::Medium), terrain)
}

/// States each 50 ms of a run on varied soil and rough, undulating ground.
fn sampled(dt_s: f64) -> Vec<Outputs> {
    let skip = (0.05 / dt_s).round() as usize;
    let states = drive(&mut varied(), PLOUGHING, 40.0, dt_s);
    states.into_iter().skip(skip - 1).step_by(skip).collect()
}

/// Root mean square differences of depth, m, draft, as part of its mean, slip, and heave, m.
fn differences(coarse: &[Outputs], fine: &[Outputs]) -> [f64; 4] {
    let count = fine.len() as f64;
    let mean_n = fine.iter().map(|state| state.draft_n).sum::<f64>() / count;
    let quantities: [fn(&Outputs) -> f64; 4] = [
        |state| state.depth_m,
        |state| state.draft_n,
        |state| state.slip,
        |state| state.body.heave_m,
    ];
    let mut differences = quantities.map(|of| {
        let pairs = coarse.iter().zip(fine);
        let squares = pairs.map(|(coarse, fine)| (of(coarse) - of(fine)).powi(2));
        (squares.sum::<f64>() / count).sqrt()
    });
    differences[1] /= mean_n;
    differences
}

/// Differences fall with the step, and at 10 ms are below 1 mm of depth, 2 % of draft, 2 % of slip and 1 mm of heave.
#[test]
fn steps_of_1_to_10_ms_agree() {
    let fine = sampled(0.00025);
    let mut before = [0.0; 4];
    for dt_s in [0.001, 0.002, 0.005, 0.010] {
        let found = differences(&sampled(dt_s), &fine);
        println!(
            "seed {SEED}, {} ms: depth {:.3} mm, draft {:.2} %, slip {:.4}, heave {:.3} mm",
            1e3 * dt_s,
            1e3 * found[0],
            100.0 * found[1],
            found[2],
            1e3 * found[3]
        );
        for (coarse, fine) in found.iter().zip(before) {
            assert!(*coarse > fine);
        }
        before = found;
    }
    for (difference, limit) in before.into_iter().zip([0.001, 0.02, 0.02, 0.001]) {
        assert!(difference < limit, "{before:?}");
    }
}

#[test]
fn the_seed_determines_the_run() {
    let run = || drive(&mut varied(), PLOUGHING, 5.0, 0.01);
    assert_eq!(run(), run());
    let other = Tractor::new(
        TractorConstants::ploughing(),
        SoilPlan::varying(Texture::Medium),
        Terrain::flat(),
        SEED + 1,
    );
    let flat = tractor(SoilPlan::varying(Texture::Medium), Terrain::flat());
    let drafts = [other, flat].map(|mut tractor| {
        let states = drive(&mut tractor, PLOUGHING, 5.0, 0.01);
        states.last().unwrap().draft_n
    });
    assert_ne!(drafts[0], drafts[1]);
}

#[test]
fn draft_varies_as_the_soil_at_a_constant_link_depth() {
    let mut tractor = tractor(SoilPlan::varying(Texture::Medium), Terrain::flat());
    let states = drive(&mut tractor, PLOUGHING, 600.0, 0.01);
    let drafts: Vec<f64> = states[2000..].iter().map(|state| state.draft_n).collect();
    let mean = drafts.iter().sum::<f64>() / drafts.len() as f64;
    let variance = drafts
        .iter()
        .map(|draft| (draft - mean).powi(2))
        .sum::<f64>()
        / drafts.len() as f64;
    let variation = variance.sqrt() / mean;
    println!(
        "seed {SEED}: mean draft {:.2} kN, CV {:.1} %",
        mean / 1e3,
        100.0 * variation
    );
    assert!((0.08..0.19).contains(&variation));
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![any::<f64>(), -1.0..3.0_f64, Just(f64::NAN), Just(f64::MAX)]
}

fn numbers(state: &Outputs) -> Vec<f64> {
    let (body, readings) = (&state.body, &state.readings);
    vec![
        state.distance_m,
        state.draft_n,
        state.vertical_n,
        state.depth_m,
        state.wheel_speed_m_s,
        state.axle_loads.front_n,
        state.axle_loads.rear_n,
        body.heave_m,
        body.heave_m_s2,
        body.pitch_rad,
        body.pitch_rad_s2,
        readings.pins.left,
        readings.pins.right,
        readings.ground_speed_m_s,
        readings.wheel_speed_m_s,
        readings.depth_m,
        readings.acceleration_m_s2,
    ]
}

proptest! {
    #![proptest_config(cases(32, 1000))]

    #[test]
    fn outputs_are_finite_whatever_is_demanded(
        demands in prop::collection::vec((any_number(), any_number(), any_number(), 1..200_u32), 1..20)
    ) {
        let mut tractor = varied();
        for (link_depth_m, speed_m_s, dt_s, steps) in demands {
            for _ in 0..steps {
                let state = tractor.step(Demand { link_depth_m, speed_m_s }, dt_s);
                prop_assert!(numbers(&state).iter().all(|number| number.is_finite()), "{state:?}");
                prop_assert!((0.0..=1.0).contains(&state.slip), "{state:?}");
                prop_assert!(state.depth_m > 0.0 || state.draft_n == 0.0, "{state:?}");
                prop_assert!(state.draft_n >= 0.0 && state.wheel_speed_m_s >= state.ground_speed_m_s - 1e-12);
            }
        }
    }
}

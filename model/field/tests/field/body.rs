//! Heave, pitch and axle loads.

use std::f64::consts::TAU;

use hitch_field::body::{Body, BodyConstants, GRAVITY_M_S2, Ground, HitchLoad};
use proptest::prelude::*;

use crate::{assert_near, cases};

fn undamped() -> BodyConstants {
    BodyConstants {
        front_damping_n_s_m: 0.0,
        rear_damping_n_s_m: 0.0,
        ..BodyConstants::published_light()
    }
}

/// Frequencies of both modes in Hz with the pitch in rad for a heave of 1 m: eigenvalues of the coupled pair.
fn modes() -> [(f64, f64); 2] {
    let (front_m, rear_m) = (1.5_f64, 2.551 - 1.5);
    let heave = (40e3 + 50e3) / 1600.0;
    let pitch = (40e3 * front_m * front_m + 50e3 * rear_m * rear_m) / 1500.0;
    let coupling_n = 40e3 * front_m - 50e3 * rear_m;
    let half = 0.5 * (pitch - heave);
    let root = (half * half + coupling_n * coupling_n / (1600.0 * 1500.0)).sqrt();
    [-root, root].map(|root| {
        let square: f64 = heave + half + root;
        let pitch_per_heave = (square - heave) * 1600.0 / coupling_n;
        (square.sqrt() / TAU, pitch_per_heave)
    })
}

#[test]
fn the_published_tractor_heaves_at_1_19_and_pitches_at_1_57_hz() {
    for ((frequency_hz, pitch_per_heave), published_hz) in modes().into_iter().zip([1.19, 1.57]) {
        assert_near(frequency_hz, published_hz, 0.005);
        let heave_m = 0.01 / (1.0 + pitch_per_heave.abs());
        let pitch_rad = heave_m * pitch_per_heave;
        let mut body = Body::displaced(
            undamped(),
            Ground::default(),
            HitchLoad::default(),
            heave_m,
            pitch_rad,
        );
        let (dt_s, periods) = (0.001, 40.0);
        let size = |body: &Body| body.motion().heave_m / heave_m;
        let (mut crossings, mut last_s) = (0.0, 0.0);
        let mut before = size(&body);
        for step in 1..=(periods / frequency_hz / dt_s) as u32 {
            body.step(Ground::default(), HitchLoad::default(), dt_s);
            let now = size(&body);
            if now * before < 0.0 {
                crossings += 1.0;
                last_s = dt_s * (f64::from(step) - now / (now - before));
            }
            before = now;
        }
        // The first crossing is at a quarter of a period, the others follow by halves.
        let measured_hz = (2.0 * crossings - 1.0) / (4.0 * last_s);
        println!("{measured_hz:.4} Hz, closed form {frequency_hz:.4} Hz");
        assert_near(measured_hz, frequency_hz, 1e-4);
    }
}

#[test]
fn a_body_follows_slow_ground_and_stands_at_its_height() {
    let mut body = Body::at_rest(
        BodyConstants::published_light(),
        Ground::default(),
        HitchLoad::default(),
    );
    let ground = Ground {
        front_m: 0.10,
        rear_m: 0.04,
    };
    for step in 1..=40_000 {
        let part = (f64::from(step) / 20_000.0).min(1.0);
        let risen = Ground {
            front_m: part * ground.front_m,
            rear_m: part * ground.rear_m,
        };
        body.step(risen, HitchLoad::default(), 0.002);
    }
    assert_near(body.motion().height_m(1.5), ground.front_m, 1e-9);
    assert_near(body.motion().height_m(1.5 - 2.551), ground.rear_m, 1e-9);
}

fn loads() -> impl Strategy<Value = (f64, f64, f64, f64, f64)> {
    (
        0.0..1e4_f64,
        0.0..3.0_f64,
        -1e4..1e4_f64,
        0.0..3e4_f64,
        0.0..0.4_f64,
    )
}

proptest! {
    #![proptest_config(cases(64, 2000))]

    /// Moments about the contact of the front axle, of all forces one by one.
    #[test]
    fn static_loads_balance_forces_and_moments(
        (implement_n, centre_m, vertical_n, draft_n, depth_m) in loads()
    ) {
        let constants = BodyConstants::published_light();
        let hitch = HitchLoad::default()
            .with_force(-implement_n, centre_m)
            .with_force(vertical_n, 2.0)
            .with_draft(draft_n, depth_m);
        let loads = constants.static_loads(hitch);
        let weight_n = 1600.0 * GRAVITY_M_S2;
        assert_near(loads.front_n + loads.rear_n, weight_n + implement_n - vertical_n, 1e-6);
        // Nose up: what presses down behind the front axle. Draft pulls backwards below ground: nose down.
        let moment_n_m = weight_n * 1.5 + implement_n * (2.551 + centre_m) - vertical_n * (2.551 + 2.0)
            - draft_n * depth_m
            - loads.rear_n * 2.551;
        assert_near(moment_n_m, 0.0, 1e-6);
    }

    #[test]
    fn a_body_at_rest_stays_there_with_the_loads_of_statics(
        (implement_n, centre_m, _, draft_n, depth_m) in loads(), dt_s in 0.001..0.05_f64,
    ) {
        let constants = BodyConstants::ploughing();
        let hitch = HitchLoad::default()
            .with_force(-implement_n, centre_m)
            .with_draft(draft_n, depth_m);
        let ground = Ground { front_m: 0.03, rear_m: -0.02 };
        let statics = constants.static_loads(hitch);
        let mut body = Body::at_rest(constants, ground, hitch);
        for _ in 0..100 {
            body.step(ground, hitch, dt_s);
        }
        assert_near(body.axle_loads().front_n, statics.front_n.max(0.0), 0.01);
        assert_near(body.axle_loads().rear_n, statics.rear_n.max(0.0), 0.01);
    }

    #[test]
    fn energy_falls_without_input(
        heave_m in -0.2..0.2_f64, pitch_rad in -0.1..0.1_f64, dt_s in 1e-4..0.1_f64,
    ) {
        let (ground, hitch) = (Ground::default(), HitchLoad::default());
        let mut body =
            Body::displaced(BodyConstants::published_light(), ground, hitch, heave_m, pitch_rad);
        let first_j = body.energy_j();
        let mut before_j = first_j;
        for _ in 0..1000 {
            body.step(ground, hitch, dt_s);
            prop_assert!(body.energy_j() <= before_j + 1e-12 * first_j);
            before_j = body.energy_j();
        }
        prop_assert!(before_j < first_j);
    }
}

#[test]
fn energy_stays_without_dampers() {
    let (ground, hitch) = (Ground::default(), HitchLoad::default());
    let mut body = Body::displaced(undamped(), ground, hitch, 0.05, -0.03);
    let first_j = body.energy_j();
    for _ in 0..10_000 {
        body.step(ground, hitch, 0.005);
    }
    assert_near(body.energy_j() / first_j, 1.0, 1e-9);
}

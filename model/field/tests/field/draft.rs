//! Draft by the standard, and the vertical force by a balance at the tool's face.

use hitch_field::draft::{DraftCoefficients, Texture, vertical_force_n};
use hitch_field::noise::Noise;
use hitch_field::soil::{Soil, SoilPlan, Stone, Stretch};
use proptest::prelude::*;

use crate::{assert_near, cases};

const TEXTURES: [Texture; 3] = [Texture::Fine, Texture::Medium, Texture::Coarse];

#[test]
fn worked_examples_of_the_standard() {
    let speed_m_s = 6.5 / 3.6;
    let plough = DraftCoefficients::MOULDBOARD_PLOUGH;
    for (texture, draft_kn, slope_kn_per_cm) in [
        (Texture::Fine, 26.0, 1.04),
        (Texture::Medium, 18.2, 0.73),
        (Texture::Coarse, 11.7, 0.47),
    ] {
        let draft = |depth_m| plough.draft_n(texture, 1.2, depth_m, speed_m_s) / 1000.0;
        assert_near(draft(0.25), draft_kn, 0.05);
        assert_near(draft(0.26) - draft(0.25), slope_kn_per_cm, 0.005);
    }
    let chisel = DraftCoefficients::CHISEL_PLOUGH;
    let draft_n = chisel.draft_n(Texture::Fine, 11.0, 0.20, 8.0 / 3.6);
    assert_near(draft_n / 1000.0, 29.5, 0.05);
}

#[test]
fn tined_tools_lose_less_draft_in_light_soil_than_ploughs() {
    for tined in [
        DraftCoefficients::CHISEL_PLOUGH,
        DraftCoefficients::SWEEP_PLOUGH,
        DraftCoefficients::FIELD_CULTIVATOR,
    ] {
        assert_eq!(TEXTURES.map(|t| tined.soil_factor(t)), [1.0, 0.85, 0.65]);
    }
    for deep in [
        DraftCoefficients::SUBSOILER,
        DraftCoefficients::MOULDBOARD_PLOUGH,
    ] {
        assert_eq!(TEXTURES.map(|t| deep.soil_factor(t)), [1.0, 0.70, 0.45]);
    }
}

proptest! {
    #![proptest_config(cases(64, 2000))]

    /// On a face at the rake angle the soil presses with `N`, and drags it upwards with `N tan δ`.
    #[test]
    fn the_vertical_force_balances_pressure_and_friction_at_the_face(
        rake_deg in 10.0..150.0_f64, pressure_n in 1.0..1e5_f64, index in 0..3_usize,
    ) {
        let texture = TEXTURES[index];
        let friction_n = pressure_n * texture.friction_deg().to_radians().tan();
        let (sine, cosine) = rake_deg.to_radians().sin_cos();
        let draft_n = pressure_n * sine + friction_n * cosine;
        let upwards_n = friction_n * sine - pressure_n * cosine;
        assert_near(vertical_force_n(draft_n, rake_deg, texture), upwards_n, 1e-6 * pressure_n);
    }

    #[test]
    fn draft_grows_with_depth_and_speed_and_is_zero_above_ground(
        depth_m in 0.0..0.6_f64, deeper_m in 0.001..0.2_f64, speed_m_s in 0.0..4.0_f64,
    ) {
        for row in [DraftCoefficients::MOULDBOARD_PLOUGH, DraftCoefficients::CHISEL_PLOUGH] {
            let draft = |depth_m, speed_m_s| row.draft_n(Texture::Medium, 2.0, depth_m, speed_m_s);
            prop_assert!(draft(depth_m + deeper_m, speed_m_s) > draft(depth_m, speed_m_s));
            prop_assert!(draft(deeper_m, speed_m_s + 0.1) > draft(deeper_m, speed_m_s));
            prop_assert_eq!(draft(-depth_m, speed_m_s), 0.0);
        }
    }
}

fn soil(change: impl FnOnce(&mut SoilPlan)) -> Soil {
    let mut plan = SoilPlan::uniform(Texture::Fine);
    change(&mut plan);
    Soil::new(plan, Noise::new(1, 0))
}

#[test]
fn texture_changes_in_steps_along_the_field() {
    let soil =
        soil(|plan| plan.texture_changes = vec![(20.0, Texture::Medium), (40.0, Texture::Coarse)]);
    let textures = [0.0, 19.9, 20.0, 39.9, 40.0, 1e6].map(|distance_m| soil.texture(distance_m));
    let [fine, medium, coarse] = TEXTURES;
    assert_eq!(textures, [fine, fine, medium, medium, coarse, coarse]);
}

#[test]
fn a_soft_patch_halves_the_cone_index_and_a_headland_adds_draft() {
    let mut soil = soil(|plan| {
        plan.stretches = vec![
            Stretch::soft_patch(10.0, 20.0),
            Stretch::headland(50.0, 8.0),
        ]
    });
    let cones = [9.9, 10.0, 29.9, 30.0].map(|distance_m| soil.cone_index_kpa(distance_m));
    assert_eq!(cones, [700.0, 350.0, 350.0, 700.0]);
    let factors = [20.0, 49.9, 50.0, 57.9, 58.0].map(|distance_m| soil.draft_factor(distance_m));
    assert_eq!(factors, [1.0, 1.0, 1.3, 1.3, 1.0]);
    assert!(soil.is_headland(50.0) && !soil.is_headland(20.0));
}

#[test]
fn a_stone_does_the_work_of_half_a_sine_on_shares_as_deep_as_it() {
    let soil = soil(|plan| {
        plan.stones = vec![Stone {
            at_m: 5.0,
            length_m: 0.1,
            top_m: 0.15,
            peak_n: 12e3,
        }];
    });
    let work_j = |depth_m| {
        let forces = (0..10_000)
            .map(|index| soil.stone_force_n(4.95 + 0.2 * (f64::from(index) + 0.5) / 1e4, depth_m));
        forces.sum::<f64>() * 0.2 / 1e4
    };
    assert_near(work_j(0.20), 12e3 * 0.1 * 2.0 / std::f64::consts::PI, 0.1);
    assert_eq!(work_j(0.14), 0.0);
}

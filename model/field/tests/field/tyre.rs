//! Slip of the driven axle.

use hitch_field::tyre::{Grip, Tyre};
use proptest::prelude::*;

use crate::{assert_near, cases};

#[test]
fn ratios_at_a_mobility_number_of_20_and_a_slip_of_a_fifth() {
    let grip = Grip {
        mobility: 20.0,
        axle_load_n: 1.0,
    };
    // 0.88 (1 - e^-2) (1 - e^-1.5) + 0.04, and 1/20 + 0.04 + 0.1/√20.
    assert_near(grip.gross_traction_ratio(0.2), 0.63113, 1e-5);
    assert_near(grip.motion_resistance_ratio(0.2), 0.11236, 1e-5);
    assert_near(grip.pull_n(0.2), 0.51877, 1e-5);
}

#[test]
fn the_mobility_number_falls_with_the_load_and_with_soft_soil() {
    let tyre = Tyre::two_18_4_38();
    // 700 · 0.467 · 1.65 / 20 · 2 / (1 + 3 · 0.467 / 1.65)
    assert_near(tyre.mobility_number(700.0, 40e3), 29.17, 0.01);
    assert_near(tyre.mobility_number(350.0, 40e3), 14.58, 0.01);
    assert_near(tyre.mobility_number(700.0, 80e3), 14.58, 0.01);
}

#[test]
fn without_load_there_is_no_grip() {
    assert_eq!(Tyre::two_18_4_38().grip(700.0, 0.0), None);
}

fn grips() -> impl Strategy<Value = Grip> {
    (1.0..3000.0_f64, 1.0..2e5_f64).prop_map(|(cone_index_kpa, load_n)| {
        Tyre::two_18_4_38().grip(cone_index_kpa, load_n).unwrap()
    })
}

proptest! {
    #![proptest_config(cases(256, 4000))]

    #[test]
    fn slip_grows_with_pull(grip in grips(), ratio in -0.5..1.2_f64, more in 0.0..0.5_f64) {
        let slip = |ratio: f64| grip.slip(ratio * grip.axle_load_n);
        prop_assert!(slip(ratio + more) >= slip(ratio));
    }

    #[test]
    fn slip_gives_the_pull_it_was_solved_for(grip in grips(), ratio in -0.5..1.2_f64) {
        let pull_n = ratio * grip.axle_load_n;
        let slip = grip.slip(pull_n);
        let attainable = (0..=1000).map(|part| grip.pull_n(f64::from(part) / 1000.0));
        if slip == 1.0 {
            let largest_n = attainable.fold(f64::NEG_INFINITY, f64::max);
            prop_assert!(largest_n <= pull_n + 1e-9 * grip.axle_load_n);
        } else if slip == 0.0 {
            prop_assert!(pull_n <= grip.pull_n(0.0));
        } else {
            assert_near(grip.pull_n(slip), pull_n, 1e-9 * grip.axle_load_n);
            // The smallest of the slips with this pull.
            prop_assert!(grip.pull_n(0.5 * slip) < pull_n);
        }
    }
}

//! The way of an implement into the soil.

use hitch_field::implement::{Implement, Penetration};
use proptest::prelude::*;

use crate::{assert_near, cases};

#[test]
fn after_its_own_length_an_implement_is_at_63_percent_of_the_depth() {
    let plough = Implement::three_furrow_plough();
    for steps in [1, 7, 1000] {
        let mut share = Penetration::new(0.0);
        for _ in 0..steps {
            share.advance(0.25, plough.length_m, plough.length_m / f64::from(steps));
        }
        assert_near(share.depth_m() / 0.25, 0.632, 0.0005);
    }
}

#[test]
fn a_raised_implement_is_out_at_once_and_enters_from_the_surface() {
    let mut share = Penetration::new(0.25);
    share.advance(-0.1, 1.5, 0.0);
    assert_eq!(share.depth_m(), -0.1);
    share.advance(0.25, 1.5, 0.0);
    assert_eq!(share.depth_m(), 0.0);
}

proptest! {
    #![proptest_config(cases(64, 2000))]

    #[test]
    fn the_depth_stays_between_where_it_was_and_what_is_set(
        from_m in -1.0..1.0_f64, set_m in 0.001..1.0_f64, travel_m in 0.0..100.0_f64,
    ) {
        let mut share = Penetration::new(from_m);
        share.advance(set_m, 1.5, travel_m);
        let (low, high) = (from_m.max(0.0).min(set_m), from_m.max(set_m));
        prop_assert!((low - 1e-12..=high + 1e-12).contains(&share.depth_m()));
    }
}

//! Tests of the field against closed forms and published figures. Draws have fixed seeds.

mod body;
mod draft;
mod implement;
mod sensors;
mod strength;
mod terrain;
mod tractor;
mod tyre;

use proptest::test_runner::{Config, RngSeed};

/// Number of drawn cases: few by day, many with `HITCH_THOROUGH`.
fn cases(few: u32, many: u32) -> Config {
    let is_thorough = std::env::var_os("HITCH_THOROUGH").is_some();
    Config {
        cases: if is_thorough { many } else { few },
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(11),
        ..Config::default()
    }
}

/// Asserts that two numbers differ by at most `tolerance`.
#[track_caller]
fn assert_near(value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value - expected).abs() <= tolerance,
        "{value} instead of {expected} ± {tolerance}"
    );
}

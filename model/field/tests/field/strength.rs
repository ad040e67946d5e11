//! Statistics of the strength of the soil against the closed forms of its processes.

use hitch_field::noise::Noise;
use hitch_field::strength::{OrnsteinUhlenbeck, Strength, StrengthConstants};

use crate::assert_near;

const SEED: u64 = 4711;

/// Samples between two nodes.
const SAMPLES: u32 = 5;

/// Factors along a pass.
fn factors(constants: &StrengthConstants, nodes: u32) -> Vec<f64> {
    let mut strength = Strength::new(constants, Noise::new(SEED, 0));
    (0..SAMPLES * nodes)
        .map(|index| (f64::from(index) + 0.5) / f64::from(SAMPLES))
        .map(|node| strength.factor_at(constants.node_m * node))
        .collect()
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

/// Covariance of a series with itself, `lag` samples later.
fn covariance(values: &[f64], lag: usize) -> f64 {
    let average = mean(values.iter().copied());
    let later = values[lag..].iter();
    let products = values.iter().zip(later);
    mean(
        products
            .map(|(a, b)| (a - average) * (b - average))
            .collect::<Vec<_>>()
            .into_iter(),
    )
}

#[test]
fn the_coefficient_of_variation_is_the_requested_one_whatever_the_nodes() {
    for requested in [0.08, 0.12, 0.19] {
        for node_m in [0.05, 0.5, 5.0] {
            let constants = StrengthConstants {
                coefficient_of_variation: requested,
                node_m,
                ..StrengthConstants::default()
            };
            let values = factors(&constants, 100_000);
            let average = mean(values.iter().copied());
            let variation = covariance(&values, 0).sqrt() / average;
            println!("seed {SEED}, nodes each {node_m} m: CV {variation:.4} for {requested}");
            assert_near(average, 1.0, 0.02 * requested / 0.12);
            assert_near(variation, requested, 0.05 * requested);
        }
    }
}

#[test]
fn correlation_falls_with_both_lengths() {
    let constants = StrengthConstants::default();
    let values = factors(&constants, 400_000);
    let variance = covariance(&values, 0);
    for nodes in [2, 5, 10, 40, 120, 240_u32] {
        let distance_m = constants.node_m * f64::from(nodes);
        let lag = (SAMPLES * nodes) as usize;
        let expected =
            (0.0100 * (-distance_m / 6.0).exp() + 0.0036 * (-distance_m / 0.5).exp()) / 0.0152;
        let correlation = covariance(&values, lag) / variance;
        println!("seed {SEED}, {distance_m} m: {correlation:.4}, closed form {expected:.4}");
        assert_near(correlation, expected, 0.02);
    }
}

#[test]
fn one_long_step_of_a_process_is_as_good_as_many_short_ones() {
    let (length_m, deviation) = (2.0, 3.0);
    for parts in [1, 10] {
        let mut noise = Noise::new(SEED, 7);
        let products: Vec<[f64; 3]> = (0..200_000)
            .map(|_| {
                let mut process = OrnsteinUhlenbeck::new(length_m, deviation, &mut noise);
                let first = process.value();
                for _ in 0..parts {
                    process.advance(1.5 / f64::from(parts), &mut noise);
                }
                let last = process.value();
                [first * first, first * last, last * last]
            })
            .collect();
        let moment = |index: usize| mean(products.iter().map(|product| product[index]));
        assert_near(moment(0), 9.0, 0.1);
        assert_near(moment(1), 9.0 * (-0.75_f64).exp(), 0.1);
        assert_near(moment(2), 9.0, 0.1);
    }
}

#[test]
fn the_strength_is_a_function_of_the_distance() {
    let constants = StrengthConstants::default();
    let read = |step_m: f64| {
        let mut strength = Strength::new(&constants, Noise::new(SEED, 0));
        let mut distance_m = 0.0;
        while distance_m < 20.0 {
            strength.factor_at(distance_m);
            distance_m += step_m;
        }
        strength.factor_at(20.01)
    };
    assert_eq!(read(0.001), read(0.037));
    assert_eq!(read(0.001), read(1.3));
    let mut other = Strength::new(&constants, Noise::new(SEED + 1, 0));
    assert_ne!(read(0.001), other.factor_at(20.01));
    assert!(other.factor_at(1e300).is_finite());
    assert!(other.factor_at(f64::NAN).is_finite());
    assert!(other.factor_at(f64::MAX).is_finite());
}

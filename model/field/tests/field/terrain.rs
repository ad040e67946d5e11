//! Heights of the ground.

use hitch_field::noise::Noise;
use hitch_field::terrain::{RoughnessConstants, Terrain, Undulation};

use crate::assert_near;

const SEED: u64 = 99;

#[test]
fn an_undulation_repeats_after_its_wavelength_and_reaches_its_amplitude() {
    let terrain = Terrain::flat().with_undulation(Undulation {
        wavelength_m: 10.0,
        amplitude_m: 0.05,
    });
    assert_near(terrain.height_m(2.5), 0.05, 1e-12);
    assert_near(terrain.height_m(7.5), -0.05, 1e-12);
    assert_near(terrain.height_m(13.0), terrain.height_m(3.0), 1e-12);
    assert_eq!(Terrain::flat().height_m(17.0), 0.0);
}

fn rough(exponent: f64) -> RoughnessConstants {
    RoughnessConstants {
        exponent,
        ..RoughnessConstants::class_d()
    }
}

#[test]
fn the_variance_of_the_band_is_the_integral_of_the_spectrum() {
    for exponent in [1.0, 1.5, 2.0, 2.5] {
        let constants = rough(exponent);
        let (steps, low) = (1_000_000, constants.lowest_per_m);
        let width_per_m = (constants.highest_per_m - low) / f64::from(steps);
        let integral_m2: f64 = (0..steps)
            .map(|index| low + width_per_m * (f64::from(index) + 0.5))
            .map(|n| constants.density_m3 * (n / constants.reference_per_m).powf(-exponent))
            .sum();
        let integral_m2 = integral_m2 * width_per_m;
        assert_near(constants.variance_m2(), integral_m2, 1e-6 * integral_m2);
    }
    assert_near(rough(2.0).variance_m2().sqrt(), 0.0141, 0.0001);
}

#[test]
fn drawn_ground_has_the_variance_of_the_band() {
    for exponent in [1.0, 2.0, 2.5] {
        let constants = rough(exponent);
        let terrain = Terrain::flat().with_roughness(&constants, &mut Noise::new(SEED, 0));
        let samples = 400_000;
        let squares: f64 = (0..samples)
            .map(|index| terrain.height_m(0.1 * f64::from(index)).powi(2))
            .sum();
        let variance_m2 = squares / f64::from(samples);
        println!("seed {SEED}, exponent {exponent}: {variance_m2:.3e} m2");
        assert_near(variance_m2 / constants.variance_m2(), 1.0, 0.02);
    }
}

#[test]
fn the_seed_determines_the_ground() {
    let draw = |seed| {
        Terrain::flat().with_roughness(&RoughnessConstants::class_d(), &mut Noise::new(seed, 0))
    };
    assert_eq!(draw(1).height_m(12.3), draw(1).height_m(12.3));
    assert_ne!(draw(1).height_m(12.3), draw(2).height_m(12.3));
}

/// Power of the drawn heights in an octave, by the Fourier sum over a long stretch, against the octave's integral.
#[test]
fn an_octave_has_its_part_of_the_spectrum() {
    let constants = rough(2.0);
    let terrain = Terrain::flat().with_roughness(&constants, &mut Noise::new(SEED, 0));
    let (length_m, samples) = (1000.0, 8000);
    let heights: Vec<f64> = (0..samples)
        .map(|index| terrain.height_m(length_m * f64::from(index) / f64::from(samples)))
        .collect();
    // From 0.2 to 0.4 cycles per m.
    let power_m2: f64 = (200..400)
        .map(|wave| {
            let angle = |index: usize| {
                std::f64::consts::TAU * f64::from(wave) * index as f64 / f64::from(samples)
            };
            let parts = heights.iter().enumerate();
            let (cosine, sine) = parts.fold((0.0, 0.0), |(c, s), (index, height)| {
                let (sine, cosine) = angle(index).sin_cos();
                (c + height * cosine, s + height * sine)
            });
            2.0 * (cosine * cosine + sine * sine) / f64::from(samples).powi(2)
        })
        .sum();
    let expected_m2 = constants.density_m3 * 0.01 * (1.0 / 0.2 - 1.0 / 0.4);
    println!("seed {SEED}: {power_m2:.3e} m2 in the octave, {expected_m2:.3e} m2 of the spectrum");
    assert_near(power_m2 / expected_m2, 1.0, 0.15);
}

//! Parts of the estimation compared with closed forms: sensitivities, nuisance projection, evidence, whitening, and the
//! least-squares fit, on a campaign simulated with the fitted plant itself.

use std::sync::LazyLock;

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::estimate::Estimate;
use hitch_identification::estimation::fit::{Fit, evaluate, refine};
use hitch_identification::estimation::jacobian::Jacobian;
use hitch_identification::estimation::nuisance_projection::NuisanceProjection;
use hitch_identification::estimation::residual_columns::{difference, dot, residuals, square_sum};
use hitch_identification::selection::evidence::{
    detectability, log_odds, shares, variance_inflation,
};
use hitch_plant::{AddedEffect, Channel, Model};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use truth_rigs::simulated_lab::campaign;

/// Seed of the rig's noise and of every random series.
const SEED: u64 = 20_261_125;

/// Coulomb friction of the rig, N.
const TRUE_N: f64 = 300.0;

/// A campaign of the nominal plant with friction, prepared and fitted at the true friction.
struct Measured {
    experiment: Experiment,
    model: Model,
    fit: Fit,
}

fn friction(size_n: f64) -> AddedEffect {
    let effect = hitch_effects::find("coulomb-friction").expect("in the catalogue");
    let mut added = AddedEffect::typical(effect);
    added.values[0] = size_n;
    added
}

static MEASURED: LazyLock<Measured> = LazyLock::new(|| {
    println!("seed {SEED}");
    let model = hitch_model_file::nominal();
    let rig = model.with_effects(vec![friction(TRUE_N)]);
    let campaign: Campaign = campaign(&rig, &mut Pcg64::seed_from_u64(SEED));
    let experiment = Experiment::new(&campaign, &model);
    let start = Estimate::new(&experiment, vec![friction(TRUE_N)]);
    let fit = refine(Problem::new(&experiment, &model), start);
    Measured {
        experiment,
        model,
        fit,
    }
});

/// Independent standard normal values, in the shape of residuals.
fn white(experiment: &Experiment, random: &mut Pcg64) -> Vec<Vec<f64>> {
    let runs = experiment.runs.iter();
    runs.map(|run| {
        let values = 0..4 * run.len();
        values.map(|_| StandardNormal.sample(random)).collect()
    })
    .collect()
}

#[test]
fn a_column_of_the_jacobian_is_the_derivative_of_the_residuals() {
    let Measured {
        experiment,
        model,
        fit,
    } = &*MEASURED;
    let jacobian = Jacobian::new(Problem::new(experiment, model), &fit.weights, &fit.estimate);
    for (column, &shared) in jacobian.shared.iter().enumerate() {
        if shared.has_prior() {
            continue;
        }
        let scale = fit.estimate.scale(shared);
        let step = 0.01 * scale;
        let at = |sign: f64| {
            let mut estimate = fit.estimate.clone();
            estimate.set(shared, fit.estimate.get(shared) + sign * step);
            residuals(Problem::new(experiment, model), &fit.weights, &estimate)
        };
        // Columns are changes of the simulation: residuals fall where it rises.
        let central = difference(&at(-1.0), &at(1.0));
        let (mut off, mut whole) = (0.0, 0.0);
        for (run, central) in jacobian.runs.iter().zip(&central) {
            for (own, central) in run.shared[column].iter().zip(central) {
                let derivative = central / 0.02;
                off += (own - derivative).powi(2);
                whole += derivative * derivative;
            }
        }
        assert!(
            off < 0.03 * 0.03 * whole,
            "column {column}: off by {:.4} of its length",
            (off / whole).sqrt()
        );
    }
}

#[test]
fn a_projection_takes_out_its_own_columns_and_nothing_twice() {
    let Measured {
        experiment,
        model,
        fit,
    } = &*MEASURED;
    let jacobian = Jacobian::new(Problem::new(experiment, model), &fit.weights, &fit.estimate);
    let column = |k: usize| -> Vec<Vec<f64>> {
        let runs = jacobian.runs.iter();
        runs.map(|run| run.shared[k].clone()).collect()
    };
    let projection = NuisanceProjection::new(&jacobian, &fit.estimate, 0..0);
    let free = (0..jacobian.shared.len()).filter(|&k| !jacobian.shared[k].has_prior());
    for k in free {
        let left = projection.project(column(k));
        let share = square_sum(&left) / square_sum(&column(k));
        assert!(share < 1e-6, "column {k}: {share:e} of its square is left");
    }
    let mut random = Pcg64::seed_from_u64(SEED);
    let noise = white(experiment, &mut random);
    let (left, penalty) = projection.project_with_penalty(noise.clone());
    let (before, after) = (square_sum(&noise), square_sum(&left) + penalty);
    // One dimension for each free column and each load: noise loses about as many units of its square.
    let most = jacobian.shared.len() + jacobian.runs.len();
    assert!(after <= before);
    assert!(before - after < 4.0 * most as f64, "{before} to {after}");
}

#[test]
fn white_residuals_inflate_nothing_and_slow_ones_by_their_autocorrelation() {
    let experiment = &MEASURED.experiment;
    let mut random = Pcg64::seed_from_u64(SEED);
    let noise = white(experiment, &mut random);
    let constant: Vec<Vec<f64>> = noise.iter().map(|run| vec![1.0; run.len()]).collect();
    let inflation = variance_inflation(experiment, &noise, &constant);
    assert!((1.0..1.25).contains(&inflation), "white: {inflation}");

    // First-order autoregression: the mean of a long series has a variance that is (1 + rho) / (1 - rho) times that of
    // a white one.
    let rho = 0.8;
    let mut slow = noise;
    for (run, series) in experiment.runs.iter().zip(&mut slow) {
        for channel in series.chunks_mut(run.len()) {
            for sample in 1..channel.len() {
                channel[sample] =
                    rho * channel[sample - 1] + (1.0 - rho * rho).sqrt() * channel[sample];
            }
        }
    }
    let inflation = variance_inflation(experiment, &slow, &constant);
    let expected = (1.0 + rho) / (1.0 - rho);
    assert!(
        (0.75..1.2).contains(&(inflation / expected)),
        "{inflation}, expected {expected}"
    );

    // A signature that alternates in sign averages slow noise away.
    let alternating: Vec<Vec<f64>> = constant
        .iter()
        .map(|run| {
            (0..run.len())
                .map(|k| if k % 2 == 0 { 1.0 } else { -1.0 })
                .collect()
        })
        .collect();
    assert_eq!(variance_inflation(experiment, &slow, &alternating), 1.0);
}

#[test]
fn log_odds_are_schwarz_s_and_shares_are_a_softmax() {
    let (ratio, samples) = (30.0, 1000.0_f64);
    let bic = 0.5 * (ratio - 2.0 * samples.ln());
    assert!((log_odds(ratio, 2, samples) - bic).abs() < 1e-12);
    let shares = shares(&[0.0, 3.0_f64.ln(), f64::NEG_INFINITY]);
    for (share, expected) in shares.iter().zip([0.25, 0.75, 0.0]) {
        assert!((share - expected).abs() < 1e-12, "{shares:?}");
    }
}

#[test]
fn detectability_is_the_root_mean_square_of_the_signature() {
    let signature = vec![vec![3.0, 4.0], vec![0.0, 0.0]];
    assert!((detectability(&signature, 0.0, 4) - 2.5).abs() < 1e-12);
    assert!((detectability(&signature, 75.0, 4) - 5.0).abs() < 1e-12);
}

#[test]
fn residuals_of_the_true_plant_are_white_with_variance_one() {
    let Measured {
        experiment, fit, ..
    } = &*MEASURED;
    assert!((fit.error() - 1.0).abs() < 0.03, "error {}", fit.error());
    for channel in [Channel::CylinderPressure, Channel::RockerAngle] {
        let (mut square, mut lagged) = (0.0, 0.0);
        for (run, left) in experiment.runs.iter().zip(&fit.residuals) {
            let samples = run.len();
            let start = channel.index() * samples;
            let part = &left[start..start + samples];
            square += dot(part, part);
            lagged += dot(&part[1..], &part[..samples - 1]);
        }
        let correlation = lagged / square;
        assert!(correlation.abs() < 0.1, "{channel:?}: {correlation}");
    }
}

#[test]
fn a_fit_finds_the_friction_within_its_standard_error() {
    let Measured {
        experiment, model, ..
    } = &*MEASURED;
    let start = Estimate::new(experiment, vec![friction(2.0 * TRUE_N)]);
    let found = refine(Problem::new(experiment, model), start);
    let jacobian = Jacobian::new(
        Problem::new(experiment, model),
        &found.weights,
        &found.estimate,
    );
    let size = (0..jacobian.shared.len())
        .find(|&k| !jacobian.shared[k].has_prior())
        .expect("the size is free");
    let others = NuisanceProjection::new(&jacobian, &found.estimate, size..size + 1);
    let column = jacobian.runs.iter().map(|run| run.shared[size].clone());
    let signature = others.project(column.collect());
    let sigma_n = found.estimate.scale(jacobian.shared[size]) / square_sum(&signature).sqrt();
    let off_n = found.estimate.effects[0].values[0] - TRUE_N;
    println!("off by {off_n:.3} N, one sigma {sigma_n:.3} N");
    assert!(off_n.abs() < 4.0 * sigma_n && sigma_n < 0.02 * TRUE_N);
    // The cost is least there: it rises on both sides.
    for factor in [0.95, 1.05] {
        let mut beside = found.estimate.clone();
        beside.effects[0].values[0] *= factor;
        assert!(evaluate(Problem::new(experiment, model), beside).cost > found.cost);
    }
}

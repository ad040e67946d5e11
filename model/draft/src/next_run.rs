//! The run that would separate what a campaign leaves open.
//!
//! A run adds to the precision of the terms; the gain of a term is half the logarithm of its variance before over after, the
//! expected information on it. The run with the largest sum over the open terms is named.

use nalgebra::{DMatrix, DVector};

use crate::block::Block;
use crate::evidence::Estimate;
use crate::machine::{Machine, at_speed};
use crate::term::{Reference, Term, column};
use crate::whitening::{Row, whitened};

/// A run to be driven.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NextRun {
    /// Half a minute with the implement raised.
    Raised,
    /// A pass on a lane without wheel tracks.
    Pass {
        /// Depth, cm.
        depth_cm: f64,
        /// Speed, km/h.
        speed_km_h: f64,
    },
}

/// Length of a proposed pass, m, and with it the number of its blocks.
pub const PASS_M: u32 = 60;
/// Duration of a proposed run above the soil, s.
pub const RAISED_S: u32 = 30;

/// Depths and speeds of proposed passes over the campaign's mean.
const DEPTHS: [f64; 3] = [0.6, 1.0, 1.4];
const SPEEDS: [f64; 3] = [0.6, 1.0, 1.5];

/// What a proposed run is judged by.
#[derive(Debug, Clone, Copy)]
pub struct Knowledge<'a> {
    /// Implement and soil.
    pub machine: &'a Machine,
    /// The campaign's means.
    pub reference: Reference,
    /// Terms of the estimate.
    pub terms: &'a [Term],
    /// Places of the open ones among them.
    pub open: &'a [usize],
    /// Estimate of the model with all of them.
    pub estimate: &'a Estimate,
    /// Coefficients of the terms that multiply others.
    pub coefficients: [f64; 3],
    /// Deviation of a mean over a second above the soil, N.
    pub noise_n: f64,
}

/// The run with the largest gain; `None` if nothing is open.
#[must_use]
pub fn next_run(known: &Knowledge<'_>) -> Option<NextRun> {
    if known.open.is_empty() {
        return None;
    }
    let passes = DEPTHS.into_iter().flat_map(|deep| {
        SPEEDS.into_iter().map(move |fast| NextRun::Pass {
            depth_cm: deep * known.reference.depth_cm,
            speed_km_h: fast * known.reference.speed_km_h,
        })
    });
    let runs = std::iter::once(NextRun::Raised).chain(passes);
    let weighed = runs.filter_map(|run| Some((gain(known, run)?, run)));
    let best = weighed.max_by(|left, right| left.0.total_cmp(&right.0));
    best.map(|(_, run)| run)
}

fn gain(known: &Knowledge<'_>, run: NextRun) -> Option<f64> {
    let (row, weight) = row(known, run);
    let covariance = &known.estimate.covariance;
    // A run is a rank-one addition to the precision.
    let through = covariance * &row;
    let factor = weight / (1.0 + weight * row.dot(&through));
    let after: DMatrix<f64> = covariance - &through * through.transpose() * factor;
    let of_term =
        |place: &usize| 0.5 * (covariance[(*place, *place)] / after[(*place, *place)]).ln();
    let total: f64 = known.open.iter().map(of_term).sum();
    total.is_finite().then_some(total)
}

/// The draft that the run sees per unit of each term, and the precision of its mean.
fn row(known: &Knowledge<'_>, run: NextRun) -> (DVector<f64>, f64) {
    let (block, weight) = match run {
        NextRun::Raised => {
            let precision = f64::from(RAISED_S) / (known.noise_n * known.noise_n);
            (block(false, 0.0, known.reference.speed_km_h), precision)
        }
        NextRun::Pass {
            depth_cm,
            speed_km_h,
        } => {
            let rows: Vec<Row> = (0..PASS_M)
                .map(|at| Row {
                    run: 0,
                    at_m: f64::from(at),
                    values: vec![1.0],
                })
                .collect();
            let white = whitened(&rows, known.estimate.shape).rows;
            let samples: f64 = white.iter().map(|row| row[0] * row[0]).sum();
            let specific = at_speed(&known.coefficients, speed_km_h);
            let expected_n = specific * depth_cm * known.machine.width;
            let deviation_n = known.estimate.variation * expected_n;
            (
                block(true, depth_cm, speed_km_h),
                samples / (deviation_n * deviation_n),
            )
        }
    };
    // A lane of its own.
    let value = |term: &Term| {
        column(
            *term,
            &block,
            usize::MAX,
            known.machine,
            &known.coefficients,
        )
    };
    (
        DVector::from_iterator(known.terms.len(), known.terms.iter().map(value)),
        weight,
    )
}

fn block(in_soil: bool, depth_cm: f64, speed_km_h: f64) -> Block {
    let speeds = [1.0, speed_km_h, speed_km_h * speed_km_h];
    Block {
        run: 0,
        at_m: 0.0,
        in_soil,
        samples: 1,
        depth_cm,
        speeds,
        depth_speeds: speeds.map(|speed| depth_cm * speed),
        draft_n: 0.0,
        scatter_n: 0.0,
    }
}

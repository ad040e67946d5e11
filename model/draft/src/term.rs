//! The terms of the linear model of a draft, and the hidden effects among them: columns and priors.

use crate::block::Block;
use crate::machine::{Machine, at_speed};

/// A term of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Term {
    /// `F A`, `F B` or `F C`, by the power of the speed.
    Coefficient(usize),
    /// Offset of the draft sensor, N.
    DraftZero,
    /// Offset of the depth sensor, cm: what has to be added to its readings.
    DepthZero,
    /// Force on blunt edges, N per m or tool: proportional to the width, not to the depth, and absent above the soil.
    BluntShare,
    /// A lane in wheel tracks, by its index: relative increase of the draft, 1.
    WheelTrack(usize),
}

/// What is expected of a term before the campaign: a normal distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// Mean, in the unit of the term.
    pub mean: f64,
    /// Standard deviation.
    pub deviation: f64,
}

/// Factor between a standard deviation and the half of a 95 % interval.
pub const TWO_SIDED_95: f64 = 1.96;

/// Deviation of a draft sensor's zero, N: 1 % of the supply at both pins of 40 kN is 2.3 kN.
const DRAFT_ZERO_N: f64 = 2000.0;
/// Deviation of a depth sensor's zero, cm; chosen.
const DEPTH_ZERO_CM: f64 = 2.0;
/// Extra draft of blunt shares over that of sharp ones at the campaign's mean depth, 1: mean and deviation; chosen.
const BLUNT: [f64; 2] = [0.2, 0.1];
/// Extra draft in wheel tracks, 1: 30 % in total (Tullberg, J. agric. Engng Res. 2000, 75, 375); the deviation is chosen.
const TRACK: [f64; 2] = [0.3, 0.1];

/// What the priors refer to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// Mean speed in the soil, km/h.
    pub speed_km_h: f64,
    /// Mean depth in the soil, cm.
    pub depth_cm: f64,
}

impl Reference {
    /// The means of the blocks in the soil; `None` without any.
    #[must_use]
    pub fn of(blocks: &[Block]) -> Option<Self> {
        let in_soil: Vec<&Block> = blocks.iter().filter(|block| block.in_soil).collect();
        let mean = |value: fn(&Block) -> f64| {
            in_soil.iter().map(|block| value(block)).sum::<f64>() / in_soil.len() as f64
        };
        (!in_soil.is_empty()).then(|| Self {
            speed_km_h: mean(|block| block.speeds[1]),
            depth_cm: mean(|block| block.depth_cm),
        })
    }
}

/// The prior of a term.
///
/// The standard gives a range of the draft. At the campaign's mean speed the three coefficients have equal parts of its
/// variance, and together the range as a 95 % interval: a speed that the standard does not count may matter as well.
#[must_use]
pub fn prior(term: Term, machine: &Machine, reference: &Reference) -> Prior {
    let standard = machine.standard();
    let usual = at_speed(&standard, reference.speed_km_h);
    let range = machine.kind.row.range_percent / 100.0;
    match term {
        Term::Coefficient(power) => {
            let part = usual * range / TWO_SIDED_95 / 3.0_f64.sqrt();
            Prior {
                mean: standard[power],
                deviation: part / reference.speed_km_h.powi(power as i32),
            }
        }
        Term::DraftZero => Prior {
            mean: 0.0,
            deviation: DRAFT_ZERO_N,
        },
        Term::DepthZero => Prior {
            mean: 0.0,
            deviation: DEPTH_ZERO_CM,
        },
        Term::BluntShare => {
            let [mean, deviation] = BLUNT.map(|part| part * usual * reference.depth_cm);
            Prior { mean, deviation }
        }
        Term::WheelTrack(_) => Prior {
            mean: TRACK[0],
            deviation: TRACK[1],
        },
    }
}

/// The draft that a term adds in a block per unit of it, N. Terms that multiply others do so with these `coefficients`.
#[must_use]
pub fn column(
    term: Term,
    block: &Block,
    lane: usize,
    machine: &Machine,
    coefficients: &[f64; 3],
) -> f64 {
    let width = machine.width;
    let sum = |means: &[f64; 3]| -> f64 {
        let products = means.iter().zip(coefficients);
        width
            * products
                .map(|(mean, coefficient)| mean * coefficient)
                .sum::<f64>()
    };
    match term {
        Term::DraftZero => 1.0,
        _ if !block.in_soil => 0.0,
        Term::Coefficient(power) => width * block.depth_speeds[power],
        Term::DepthZero => sum(&block.speeds),
        Term::BluntShare => width,
        Term::WheelTrack(track) if track == lane => sum(&block.depth_speeds),
        Term::WheelTrack(_) => 0.0,
    }
}

//! Condensed runs: means over short stretches of samples with a constant slope of the currents.
//!
//! A search simulates thousands of changes. Most samples of a 50 Hz log are redundant, so a stretch is simulated and
//! compared as one sample, with the noise of its mean. After a jump of a current, where lags show, every sample is
//! kept. Fits and evidence use all samples.

use std::ops::Range;

use hitch_plant::Currents;

use crate::data::conditioning::Drive;
use crate::data::regime::Regime;
use crate::data::stretches::Stretches;

/// Longest stretch that is averaged, s.
const LONGEST_S: f64 = 0.1;

/// Time after a jump of a current during which every sample is kept, s: lags of spools and sensors show there.
const AFTER_A_JUMP_S: f64 = 0.12;

/// Change of a current's slope between two samples that counts as a jump, in sigmas of its noise.
const JUMP_SIGMAS: f64 = 3.0;

/// The stretches of a run. `noise` is one sigma of its currents, A; `alike` is true for two samples with the same
/// measured channels.
pub(crate) fn condensed(
    drive: &Drive,
    regimes: &[Regime],
    noise: Currents,
    alike: impl Fn(usize, usize) -> bool,
) -> Stretches {
    let samples = regimes.len();
    let jumps = jumps(drive, noise);
    let mut stretches: Vec<Range<usize>> = Vec::new();
    let mut jumped_s = f64::NEG_INFINITY;
    let time_s = &drive.time_s;
    for sample in 0..samples {
        if jumps[sample] {
            jumped_s = time_s[sample];
        }
        let straight = |stretch: &Range<usize>| {
            stretch.start > 0
                && sample + 1 < samples
                && !jumps[sample]
                && !jumps[sample + 1]
                && time_s[sample] - jumped_s > AFTER_A_JUMP_S
                && time_s[sample + 1] - time_s[stretch.start] < LONGEST_S * (1.0 + 1e-6)
                && time_s[stretch.start] - jumped_s > AFTER_A_JUMP_S
                && !drive.turns_before(sample)
                && regimes[sample] == regimes[stretch.start]
                && alike(stretch.start, sample)
        };
        match stretches.last_mut() {
            Some(last) if straight(last) => last.end = sample + 1,
            _ => stretches.push(sample..sample + 1),
        }
    }
    Stretches(stretches)
}

/// Whether a current jumps, per sample.
fn jumps(drive: &Drive, noise: Currents) -> Vec<bool> {
    let currents = &drive.currents;
    let bent = |before: f64, here: f64, after: f64, sigma_a: f64| {
        (before - 2.0 * here + after).abs() > JUMP_SIGMAS * sigma_a
    };
    let mut jumps = vec![false; currents.len()];
    for (before, around) in currents.windows(3).enumerate() {
        jumps[before + 1] = bent(
            around[0].lift_a,
            around[1].lift_a,
            around[2].lift_a,
            noise.lift_a,
        ) || bent(
            around[0].lower_a,
            around[1].lower_a,
            around[2].lower_a,
            noise.lower_a,
        );
    }
    jumps
}

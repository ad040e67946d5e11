//! Figures of a stretch of a pass.

use hitch_closed_loop::Sample;
use hitch_closed_loop::field::FieldSample;

/// Corner frequency of a low-pass, Hz. The draft is judged with and without it; the loop gets the filtered draft.
const JUDGED_HZ: f64 = 3.2;

/// Mean and standard deviation.
#[derive(Debug, Clone, Copy)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub deviation: f64,
}

impl Spread {
    /// Of values.
    #[must_use]
    pub fn of(values: impl Iterator<Item = f64> + Clone) -> Self {
        let count = values.clone().count() as f64;
        let mean = values.clone().sum::<f64>() / count;
        let variance = values.map(|value| (value - mean).powi(2)).sum::<f64>() / count;
        Self {
            mean,
            deviation: variance.sqrt(),
        }
    }
}

/// Figures of a stretch.
#[derive(Debug, Clone, Copy)]
pub struct Figures {
    /// Draft, N.
    pub draft_n: Spread,
    /// Draft through a low-pass of 3.2 Hz, N.
    pub filtered_n: Spread,
    /// Working depth, m.
    pub depth_m: Spread,
    /// Slip, 1.
    pub slip: Spread,
    /// Largest slip, 1.
    pub slip_max: f64,
    /// Number of times that a coil was switched on, per minute.
    pub activations_per_min: f64,
}

impl Figures {
    /// Of samples of a millisecond.
    #[must_use]
    pub fn of(samples: &[FieldSample]) -> Self {
        let field = samples.iter().map(|sample| sample.field);
        let draft = field.clone().map(|field| field.draft_n);
        let mut filtered = samples[0].field.draft_n;
        let share = 1.0 - (-std::f64::consts::TAU * JUDGED_HZ * 1e-3).exp();
        let filtered: Vec<f64> = draft
            .clone()
            .map(|draft_n| {
                filtered += share * (draft_n - filtered);
                filtered
            })
            .collect();
        let minutes = samples.len() as f64 * 1e-3 / 60.0;
        Self {
            draft_n: Spread::of(draft),
            filtered_n: Spread::of(filtered.iter().copied()),
            depth_m: Spread::of(field.clone().map(|field| field.depth_m)),
            slip: Spread::of(field.clone().map(|field| field.slip)),
            slip_max: field.map(|field| field.slip).fold(0.0, f64::max),
            activations_per_min: activations(samples.iter().map(|sample| &sample.hitch)) as f64
                / minutes,
        }
    }
}

/// How often a coil was switched on.
#[must_use]
pub fn activations<'s>(samples: impl Iterator<Item = &'s Sample> + Clone) -> usize {
    let on = |sample: &Sample| {
        let outputs = &sample.outputs;
        [outputs.lift_current.0 > 0, outputs.lower_current.0 > 0]
    };
    let pairs = samples.clone().zip(samples.skip(1));
    let switched = pairs.map(|(before, after)| {
        let coils = on(before).into_iter().zip(on(after));
        coils.filter(|(before, after)| !before & after).count()
    });
    switched.sum()
}

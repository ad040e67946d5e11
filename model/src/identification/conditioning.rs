//! Logged currents, cleaned once before they drive a model.
//!
//! A log carries 3 to 5 mA of noise on each current. Led through a valve of 40 l/min/A that is as much as the flow
//! meter's own noise, so it has to go; but a plain low-pass would bend the ramps. Each sample is therefore estimated
//! by the straight line through the widest window around it that the noise can explain (the idea of intersecting
//! confidence intervals, Goldenshluger & Nemirovski 1997): wide on plateaus and ramps, narrow at corners. No delay.

use crate::plant::Currents;

/// Reach of a window to either side of the sample, samples.
const REACHES: [usize; 7] = [0, 1, 2, 4, 8, 16, 32];

/// A current that jumps between two samples may have done so anywhere between them: one sigma of an even spread, as a
/// share of the jump.
const JUMP_SHARE: f64 = 0.29;

/// Cleaned currents and how well each is known.
#[derive(Debug, Clone)]
pub struct Drive {
    /// Time stamps, s.
    pub time_s: Vec<f64>,
    /// Cleaned currents, A.
    pub currents: Vec<Currents>,
    /// One sigma of the cleaned currents, A: what is left of the noise, and of when a jump happened.
    pub spread: Vec<Currents>,
}

impl Drive {
    /// Cleans the two logged currents, A, whose noise has the given sigmas, A; `slow_share` of its variance is so slow
    /// that no window takes it away.
    #[must_use]
    pub fn new(
        time_s: &[f64],
        lift_a: &[f64],
        lower_a: &[f64],
        sigma: Currents,
        slow_share: f64,
    ) -> Self {
        let (lift, lift_spread) = clean(lift_a, sigma.lift_a, slow_share);
        let (lower, lower_spread) = clean(lower_a, sigma.lower_a, slow_share);
        let join = |lift: Vec<f64>, lower: Vec<f64>| {
            lift.into_iter()
                .zip(lower)
                .map(|(lift_a, lower_a)| Currents { lift_a, lower_a })
                .collect()
        };
        Self {
            time_s: time_s.to_vec(),
            currents: join(lift, lower),
            spread: join(lift_spread, lower_spread),
        }
    }

    /// The currents as the valves felt them if the log's clock was ahead by `skew_s`, moved by `spreads` sigmas.
    #[must_use]
    pub fn shifted(&self, skew_s: f64, spreads: f64) -> Vec<Currents> {
        let moved = |sample: usize| {
            let (current, spread) = (self.currents[sample], self.spread[sample]);
            Currents {
                lift_a: current.lift_a + spreads * spread.lift_a,
                lower_a: current.lower_a + spreads * spread.lower_a,
            }
        };
        let last = self.time_s.len() - 1;
        let mut cell = 0;
        (0..=last)
            .map(|sample| {
                let at_s = self.time_s[sample] - skew_s;
                while cell > 0 && self.time_s[cell] > at_s {
                    cell -= 1;
                }
                while cell + 1 < last && self.time_s[cell + 1] <= at_s {
                    cell += 1;
                }
                let (from, to) = (moved(cell), moved((cell + 1).min(last)));
                let step_s = self.time_s[(cell + 1).min(last)] - self.time_s[cell];
                let share = if step_s > 0.0 {
                    ((at_s - self.time_s[cell]) / step_s).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                Currents {
                    lift_a: from.lift_a + (to.lift_a - from.lift_a) * share,
                    lower_a: from.lower_a + (to.lower_a - from.lower_a) * share,
                }
            })
            .collect()
    }
}

/// Height of the jump between the sample before and this one, if the current is flat on either side of it, else zero.
fn jump_before(current_a: &[f64], sample: usize) -> f64 {
    if sample < 2 || sample + 1 >= current_a.len() {
        return 0.0;
    }
    let rise = |to: usize| (current_a[to] - current_a[to - 1]).abs();
    let flat = 0.2 * rise(sample);
    if rise(sample - 1) < flat && rise(sample + 1) < flat {
        rise(sample)
    } else {
        0.0
    }
}

/// Cleans one current; returns it and its spread, A.
fn clean(logged_a: &[f64], sigma_a: f64, slow_share: f64) -> (Vec<f64>, Vec<f64>) {
    let samples = logged_a.len();
    let mut cleaned = logged_a.to_vec();
    let mut variance = vec![1.0; samples];
    if sigma_a > 0.0 {
        for behind in REACHES {
            for ahead in REACHES {
                if behind + ahead >= 2 {
                    try_window(
                        logged_a,
                        sigma_a,
                        behind,
                        ahead,
                        &mut cleaned,
                        &mut variance,
                    );
                }
            }
        }
    }
    let spread = (0..samples)
        .map(|sample| {
            (sigma_a * sigma_a * (variance[sample] + slow_share).min(1.0))
                .sqrt()
                .hypot(jump_before(&cleaned, sample) * JUMP_SHARE)
        })
        .collect();
    for current_a in &mut cleaned {
        *current_a = current_a.max(0.0);
    }
    (cleaned, spread)
}

/// Fits a line over `behind..=ahead` around every sample and keeps it where the noise explains what it leaves and the
/// estimate is better than what is there. `variance` is in units of the noise's.
fn try_window(
    logged: &[f64],
    sigma: f64,
    behind: usize,
    ahead: usize,
    cleaned: &mut [f64],
    variance: &mut [f64],
) {
    let count = behind + ahead + 1;
    let n = count as f64;
    let centre = (ahead as f64 - behind as f64) / 2.0;
    let spread = n * (n * n - 1.0) / 12.0;
    let gain = 1.0 / n + centre * centre / spread;
    let freedom = n - 2.0;
    let limit = (freedom + 3.0 * (2.0 * freedom).sqrt()) * sigma * sigma;
    for sample in behind..logged.len().saturating_sub(ahead) {
        if gain >= variance[sample] {
            continue;
        }
        let window = &logged[sample - behind..=sample + ahead];
        let mean = window.iter().sum::<f64>() / n;
        let slope = window
            .iter()
            .enumerate()
            .map(|(k, y)| (k as f64 - (n - 1.0) / 2.0) * y)
            .sum::<f64>()
            / spread;
        let mut square_sum = 0.0;
        let mut largest: f64 = 0.0;
        for (k, y) in window.iter().enumerate() {
            let left = y - mean - slope * (k as f64 - (n - 1.0) / 2.0);
            square_sum += left * left;
            largest = largest.max(left.abs());
        }
        if square_sum <= limit && largest <= 3.5 * sigma {
            cleaned[sample] = mean - slope * centre;
            variance[sample] = gain;
        }
    }
}

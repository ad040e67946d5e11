//! Conditioning of the logged currents before they drive a model.
//!
//! A log has 3 to 5 mA of noise on each current. At a valve gain of 40 l/min/A that is as much as the flow meter's own
//! noise, so it has to be removed, but a plain low-pass filter would distort the ramps. Each sample is therefore
//! estimated by a straight line through the widest window around it that is compatible with the noise (intersection of
//! confidence intervals, Goldenshluger & Nemirovski 1997): wide on plateaus and ramps, narrow at corners, without
//! delay.
//!
//! A ramp rarely begins at a sample. If the lines of two neighbouring samples intersect between them, the intersection
//! becomes a corner point of the current: a straight line from sample to sample would cut it off.

use std::borrow::Cow;

use hitch_plant::Currents;

use crate::data::stretches::Stretches;

/// Half-widths of a window to either side of the sample, samples.
const REACHES: [usize; 7] = [0, 1, 2, 4, 8, 16, 32];

/// Standard deviation of a uniform distribution, as a share of its width: a jump between two samples may have occurred
/// anywhere between them.
const JUMP_SHARE: f64 = 0.29;

/// Distance from a sample, as a share of the step, below which a corner is placed at the sample.
const NEAREST: f64 = 0.02;

/// Smallest significant difference of two slopes, in sigmas.
const CORNER_SIGMAS: f64 = 3.0;

/// Conditioned currents and their uncertainty.
#[derive(Debug, Clone)]
pub struct Drive {
    /// Time stamps, s.
    pub time_s: Vec<f64>,
    /// Conditioned currents, A.
    pub currents: Vec<Currents>,
    /// One sigma of the conditioned currents, A: remaining noise and uncertain instants of jumps.
    pub spread: Vec<Currents>,
    /// Samples, and corners between them.
    course: Course,
}

/// A piecewise linear current: points at the samples and at the corners between them.
#[derive(Debug, Clone)]
struct Course {
    /// Time, s.
    time_s: Vec<f64>,
    /// Current, A.
    currents: Vec<Currents>,
    /// One sigma of it, A.
    spread: Vec<Currents>,
    /// Which of the points are samples.
    samples: Vec<usize>,
}

impl Drive {
    /// Conditions the two logged currents, A, whose noise has the given sigmas, A. No window removes the share
    /// `slow_share` of the noise variance, which is slow.
    #[must_use]
    pub fn new(
        time_s: &[f64],
        lift_a: &[f64],
        lower_a: &[f64],
        sigma: Currents,
        slow_share: f64,
    ) -> Self {
        let lift = ConditionedCurrent::new(lift_a, sigma.lift_a, slow_share);
        let lower = ConditionedCurrent::new(lower_a, sigma.lower_a, slow_share);
        let join = |lift: &[f64], lower: &[f64]| -> Vec<Currents> {
            let both = lift.iter().zip(lower);
            both.map(|(&lift_a, &lower_a)| Currents { lift_a, lower_a })
                .collect()
        };
        let currents = join(&lift.current_a, &lower.current_a);
        let spread = join(&lift.spread_a, &lower.spread_a);
        let course = Course::new(time_s, &currents, &spread, [&lift, &lower]);
        Self {
            time_s: time_s.to_vec(),
            currents,
            spread,
            course,
        }
    }

    /// Times of the currents of [`Drive::shifted`], s.
    #[must_use]
    pub fn course_s(&self) -> &[f64] {
        &self.course.time_s
    }

    /// Indices of the samples among the points of [`Drive::course_s`].
    #[must_use]
    pub fn samples(&self) -> &[usize] {
        &self.course.samples
    }

    /// Whether there is a corner of a current between a sample and the previous one.
    #[must_use]
    pub fn turns_before(&self, sample: usize) -> bool {
        let at = &self.course.samples;
        sample > 0 && at[sample] > at[sample - 1] + 1
    }

    /// The drive averaged over stretches of samples; corners between them are kept.
    #[must_use]
    pub(crate) fn condensed(&self, stretches: &Stretches) -> Self {
        let time_s = stretches.means(&self.time_s);
        let currents = stretches.mean_currents(&self.currents);
        let spread = stretches.mean_currents(&self.spread);
        let mut course = Course::with_capacity(time_s.len());
        for (index, first) in stretches.firsts().enumerate() {
            if self.turns_before(first) {
                let corner = self.course.samples[first] - 1;
                let Course {
                    time_s,
                    currents,
                    spread,
                    ..
                } = &self.course;
                course.push(time_s[corner], currents[corner], spread[corner]);
            }
            course.samples.push(course.time_s.len());
            course.push(time_s[index], currents[index], spread[index]);
        }
        Self {
            time_s,
            currents,
            spread,
            course,
        }
    }

    /// The currents at the points of [`Drive::course_s`], delayed by `skew_s` and shifted by `spreads` sigmas.
    #[must_use]
    pub fn shifted(&self, skew_s: f64, spreads: f64) -> Cow<'_, [Currents]> {
        if skew_s == 0.0 && spreads == 0.0 {
            return Cow::Borrowed(&self.course.currents);
        }
        let Course {
            time_s,
            currents,
            spread,
            ..
        } = &self.course;
        let moved = |point: usize| Currents {
            lift_a: currents[point].lift_a + spreads * spread[point].lift_a,
            lower_a: currents[point].lower_a + spreads * spread[point].lower_a,
        };
        let last = time_s.len() - 1;
        let mut cell = 0;
        (0..=last)
            .map(|point| {
                let at_s = time_s[point] - skew_s;
                while cell > 0 && time_s[cell] > at_s {
                    cell -= 1;
                }
                while cell + 1 < last && time_s[cell + 1] <= at_s {
                    cell += 1;
                }
                let next = (cell + 1).min(last);
                let step_s = time_s[next] - time_s[cell];
                let share = if step_s > 0.0 {
                    ((at_s - time_s[cell]) / step_s).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                between(moved(cell), moved(next), share)
            })
            .collect()
    }
}

/// Largest common time error of all jumps of some currents, s: half a sample for a current that only jumps, zero for
/// one without jumps. If machine and bus log are synchronous, all jumps have the same error.
#[must_use]
pub fn jumps_within_s<'a>(drives: impl Iterator<Item = &'a Drive>) -> f64 {
    let (mut unplaced, mut all) = (0.0, 0.0);
    for drive in drives {
        for (sample, step) in drive.time_s.windows(2).enumerate() {
            for current_a in [|c: &Currents| c.lift_a, |c: &Currents| c.lower_a] {
                let at = |sample: usize| current_a(&drive.currents[sample]);
                let jump_a = jump_before(at, drive.currents.len(), sample + 1);
                unplaced += jump_a * jump_a * 0.5 * (step[1] - step[0]);
                all += (at(sample + 1) - at(sample)).powi(2);
            }
        }
    }
    if all > 0.0 { unplaced / all } else { 0.0 }
}

/// Linear interpolation between two currents.
fn between(from: Currents, to: Currents, share: f64) -> Currents {
    Currents {
        lift_a: from.lift_a + (to.lift_a - from.lift_a) * share,
        lower_a: from.lower_a + (to.lower_a - from.lower_a) * share,
    }
}

impl Course {
    fn with_capacity(points: usize) -> Self {
        Self {
            time_s: Vec::with_capacity(points),
            currents: Vec::with_capacity(points),
            spread: Vec::with_capacity(points),
            samples: Vec::with_capacity(points),
        }
    }

    fn new(
        time_s: &[f64],
        currents: &[Currents],
        spread: &[Currents],
        conditioned: [&ConditionedCurrent; 2],
    ) -> Self {
        let mut course = Self::with_capacity(time_s.len());
        for sample in 0..time_s.len() {
            course.samples.push(course.time_s.len());
            course.push(time_s[sample], currents[sample], spread[sample]);
            if sample + 1 == time_s.len() {
                break;
            }
            let step_s = time_s[sample + 1] - time_s[sample];
            let [lift, lower] = conditioned.map(|valve| valve.corner_after(sample));
            // At most one current has a corner within a step in any realistic log.
            let Some((share, corner_a)) = lift.or(lower) else {
                continue;
            };
            let mut corner = between(currents[sample], currents[sample + 1], share);
            if lift.is_some() {
                corner.lift_a = corner_a;
            } else {
                corner.lower_a = corner_a;
            }
            let spread = between(spread[sample], spread[sample + 1], share);
            course.push(time_s[sample] + share * step_s, corner, spread);
        }
        course
    }

    fn push(&mut self, time_s: f64, currents: Currents, spread: Currents) {
        self.time_s.push(time_s);
        self.currents.push(currents);
        self.spread.push(spread);
    }
}

/// Height of a jump between the previous sample and this one: the excess of its difference over the neighbouring ones.
fn jump_before(current_a: impl Fn(usize) -> f64, samples: usize, sample: usize) -> f64 {
    if sample < 2 || sample + 1 >= samples {
        return 0.0;
    }
    let rise = |to: usize| current_a(to) - current_a(to - 1);
    let (own, before, after) = (rise(sample), rise(sample - 1), rise(sample + 1));
    let more_than = |other: f64| own.abs() - other * own.signum();
    more_than(before)
        .min(more_than(after))
        .clamp(0.0, own.abs())
}

/// One conditioned current.
struct ConditionedCurrent {
    /// Current, A.
    current_a: Vec<f64>,
    /// One sigma of it, A.
    spread_a: Vec<f64>,
    /// Slope of the line fitted at each sample, A per sample.
    slope_a: Vec<f64>,
    /// One sigma of that, A.
    slope_spread_a: Vec<f64>,
}

impl ConditionedCurrent {
    fn new(logged_a: &[f64], sigma_a: f64, slow_share: f64) -> Self {
        let samples = logged_a.len();
        let mut lines = Lines {
            value: logged_a.to_vec(),
            variance: vec![1.0; samples],
            slope: vec![0.0; samples],
            slope_variance: vec![f64::INFINITY; samples],
        };
        if sigma_a > 0.0 {
            for window in windows() {
                lines.try_window(logged_a, sigma_a, window);
            }
        }
        let spread_a = (0..samples)
            .map(|sample| {
                (sigma_a * sigma_a * (lines.variance[sample] + slow_share).min(1.0))
                    .sqrt()
                    .hypot(jump_before(|at| lines.value[at], samples, sample) * JUMP_SHARE)
            })
            .collect();
        let slope_spread_a = lines.slope_variance.iter().map(|v| sigma_a * v.sqrt());
        Self {
            current_a: lines.value.iter().map(|a| a.max(0.0)).collect(),
            spread_a,
            slope_a: lines.slope,
            slope_spread_a: slope_spread_a.collect(),
        }
    }

    /// Position of a corner between a sample and the next, as a share of the step, and the current there, A.
    ///
    /// Only for corners of a ramp: two lines that differ in height alone are a jump, whose instant is unknown.
    fn corner_after(&self, sample: usize) -> Option<(f64, f64)> {
        let (before, after) = (self.slope_a[sample], self.slope_a[sample + 1]);
        let spread_a = self.slope_spread_a[sample].hypot(self.slope_spread_a[sample + 1]);
        if (before - after).abs() < CORNER_SIGMAS * spread_a || !spread_a.is_finite() {
            return None;
        }
        let (from_a, to_a) = (self.current_a[sample], self.current_a[sample + 1]);
        // from + before * share = to - after * (1 - share)
        let share = (to_a - from_a - after) / (before - after);
        let inside = (NEAREST..=1.0 - NEAREST).contains(&share);
        inside.then(|| (share, (from_a + before * share).max(0.0)))
    }
}

/// A window around a sample.
#[derive(Clone, Copy)]
struct Window {
    /// Samples before and after the sample.
    behind: usize,
    ahead: usize,
    /// Sum of the squared distances of its samples from its centre.
    spread: f64,
    /// Distance of its centre from the sample.
    centre: f64,
    /// Variance of the line's value at the sample, in units of the noise variance.
    variance: f64,
}

impl Window {
    fn new(behind: usize, ahead: usize) -> Self {
        let n = (behind + ahead + 1) as f64;
        let centre = (ahead as f64 - behind as f64) / 2.0;
        let spread = n * (n * n - 1.0) / 12.0;
        Self {
            behind,
            ahead,
            spread,
            centre,
            variance: 1.0 / n + centre * centre / spread,
        }
    }
}

/// All windows, those of the smallest variance first: the first one that is compatible with the noise is the result.
fn windows() -> Vec<Window> {
    let pairs = REACHES
        .iter()
        .flat_map(|&behind| REACHES.map(|ahead| (behind, ahead)));
    let mut windows: Vec<Window> = pairs
        .filter(|(behind, ahead)| behind + ahead >= 2)
        .map(|(behind, ahead)| Window::new(behind, ahead))
        .collect();
    windows.sort_by(|a, b| a.variance.total_cmp(&b.variance));
    windows
}

/// Fitted lines, one per sample; variances in units of the noise variance.
struct Lines {
    value: Vec<f64>,
    variance: Vec<f64>,
    slope: Vec<f64>,
    slope_variance: Vec<f64>,
}

impl Lines {
    /// Fits a line over a window around every sample. It replaces the present one if its residuals are compatible with the
    /// noise and its variance is smaller.
    fn try_window(&mut self, logged: &[f64], sigma: f64, window: Window) {
        let Window {
            behind,
            ahead,
            spread,
            centre,
            variance,
        } = window;
        let n = (behind + ahead + 1) as f64;
        let freedom = n - 2.0;
        let limit = (freedom + 3.0 * (2.0 * freedom).sqrt()) * sigma * sigma;
        for sample in behind..logged.len().saturating_sub(ahead) {
            if variance >= self.variance[sample] {
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
                self.value[sample] = mean - slope * centre;
                self.variance[sample] = variance;
                self.slope[sample] = slope;
                self.slope_variance[sample] = 1.0 / spread;
            }
        }
    }
}

//! The own rate of a channel that a writer put on the time base of a faster one.
//!
//! Such a writer repeats each sample until the next one (held), or puts values on straight lines between them. These values
//! are not measurements. An *event* is a row whose value differs from the one before it (held), or lies off the line between
//! its neighbours by more than the rounding of three values (lines). In a channel of a lower rate, all events are at the ideal
//! times `first + n * period`, within a window that is as wide as a step of the base, or as the jitter of the samples.
//!
//! If each row were a sample, the `m` events would be at any rows, and all of them within the windows, which contain a part
//! `p` of the rows, with a probability of at most `p^m`. `N` rows have at most `N^5` different sets of windows: `N^3 / 2`
//! orders of the rows by their distance from the ideal times, and `N^2 / 2` windows in each. Those that are each k-th row
//! are fewer than `N^2`. A set is accepted if its `p^m`, times the number of sets of its kind, is below [`FALSE_ALARMS`].
//!
//! `p` is counted in the rows within a period before an event, as all events may be in a short part of the log. Changes that
//! repeat the previous one, and corners that repeat one of the previous two, are not counted in `m`: a slow ramp in coarse
//! steps and a counter have them at regular times. They still have to be within the windows.
//!
//! Not recognised: lines at less than twice the rate of the samples, of which no three values are on one line; and lines whose
//! corners are below the rounding.

use crate::ideal_times::{Between, EQUAL, FEW, IdealTimes};
use crate::series::{Series, median_step_s};

/// Probability that a channel whose rows are all samples is taken for a slower one.
const FALSE_ALARMS: f64 = 1e-6;
/// Ratio of successive trial periods: a trial locks to a period within half of it.
const TRIAL_RATIO: f64 = 1.02;
/// Part of a value that conversions and sums may change.
const FUZZ: f64 = 1e-9;

/// The samples of a channel with a lower rate than its rows.
#[derive(Debug, Clone)]
pub struct OwnRate {
    /// The samples alone.
    pub samples: Series,
    /// Longest step between two samples in a regular part of the log, s.
    pub longest_step_s: f64,
    /// What the other rows contain.
    between: Between,
    rate_hz: f64,
    base_hz: f64,
}

impl OwnRate {
    /// What was recognised, for a reader of the log.
    pub fn note(&self, column: &str) -> String {
        let [rate, base] = [self.rate_hz, self.base_hz].map(rounded);
        let what = match self.between {
            Between::Held => format!("values of {rate} Hz held at {base} Hz"),
            Between::Lines => format!("values at {base} Hz on lines between samples of {rate} Hz"),
        };
        format!("{column}: {what}; its {rate} Hz samples are used")
    }
}

/// A rate with three digits.
fn rounded(rate_hz: f64) -> f64 {
    let unit = 10.0_f64.powf(rate_hz.log10().floor() - 2.0);
    let rate_hz = (rate_hz / unit).round() * unit;
    (rate_hz * 1e3).round() / 1e3
}

/// The samples of a channel with a lower rate than its rows; `None` if all rows are samples, or if that is not refuted.
pub fn own_rate(series: &Series) -> Option<OwnRate> {
    let known = (0..series.values.len()).filter(|&row| series.values[row].is_finite());
    let rows = distinct(&series.rows(known));
    let rises = rows.times_s.windows(2).all(|two| two[1] > two[0]);
    if !rises || rows.times_s.len() < FEW {
        return None;
    }
    let resolution = resolution(&rows.values);
    let held = of_events(&rows, Between::Held, held_events(&rows, resolution));
    held.or_else(|| of_events(&rows, Between::Lines, corners(&rows, resolution)))
}

/// The rows without those whose time is that of the row before them but for its rounding. A union of the time stamps of two clocks, as
/// asammdf makes it, has rows at 0.3 s and at 0.30000000000000004 s.
fn distinct(rows: &Series) -> Series {
    let least_s = EQUAL * median_step_s(&rows.times_s);
    let mut last_s = f64::NEG_INFINITY;
    let is_apart = |row: &usize| {
        let step_s = rows.times_s[*row] - last_s;
        // Times that fall are kept: they are no rows of one clock.
        let is_apart = !(0.0..least_s).contains(&step_s);
        if is_apart {
            last_s = rows.times_s[*row];
        }
        is_apart
    };
    rows.rows((0..rows.times_s.len()).filter(is_apart))
}

/// Rows at which the course of a channel changes, and how many of them are evidence.
struct Events {
    rows: Vec<usize>,
    evidence: usize,
}

/// Rows whose value differs from the one before it.
fn held_events(series: &Series, resolution: f64) -> Events {
    let mut last = 0.0_f64;
    let (mut rows, mut evidence) = (Vec::new(), 0);
    for (row, two) in series.values.windows(2).enumerate() {
        let change = two[1] - two[0];
        if change == 0.0 {
            continue;
        }
        let is_repeated = (change - last).abs() < 0.5 * resolution;
        evidence += usize::from(!is_repeated);
        rows.push(row + 1);
        last = change;
    }
    Events { rows, evidence }
}

/// Rows whose value is not on the line between its neighbours, by their times and by their number: a writer may have rounded
/// the times of regular rows.
fn corners(series: &Series, resolution: f64) -> Events {
    let largest = largest(&series.values);
    let rounding = resolution * (1.0 + 1e-6) + FUZZ * largest;
    let mut last = [0.0_f64; 2];
    let (mut rows, mut evidence) = (Vec::new(), 0);
    for row in 1..series.values.len() - 1 {
        let [before, value, after] = [row - 1, row, row + 1].map(|row| series.values[row]);
        let [before_s, at_s, after_s] = [row - 1, row, row + 1].map(|row| series.times_s[row]);
        let share = (at_s - before_s) / (after_s - before_s);
        let off = |share: f64| value - before - share * (after - before);
        if off(share).abs().min(off(0.5).abs()) <= rounding {
            continue;
        }
        let is_repeated = last
            .iter()
            .any(|last| (off(share) - last).abs() < 0.25 * resolution);
        evidence += usize::from(!is_repeated);
        rows.push(row);
        last = [off(share), last[0]];
    }
    Events { rows, evidence }
}

/// The smallest difference between two values of a channel, which is at least the step of its rounding.
fn resolution(values: &[f64]) -> f64 {
    let equal = FUZZ * largest(values);
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let steps = sorted.windows(2).map(|two| two[1] - two[0]);
    let smallest = steps
        .filter(|step| *step > equal)
        .fold(f64::INFINITY, f64::min);
    if smallest.is_finite() { smallest } else { 0.0 }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// Longest period with gaps between its windows that has at most `most` of the events in each, s: between the first and the
/// last of a few events there are so many windows that the periods without one of them are not longer than the time.
fn longest_s(at_s: &[f64], most: usize) -> f64 {
    let windows = (FEW - 1) / most - 1;
    let spans = at_s
        .windows(FEW)
        .map(|few| (few[FEW - 1] - few[0]) / windows as f64);
    spans.fold(f64::INFINITY, f64::min)
}

/// The samples whose events these are.
fn of_events(rows: &Series, between: Between, events: Events) -> Option<OwnRate> {
    let times_s = &rows.times_s;
    let count = times_s.len();
    let step_s = median_step_s(times_s);
    let at_s: Vec<f64> = events.rows.iter().map(|&row| times_s[row]).collect();
    // A corner between two rows is an event at both. Of several periods with the same windows the longest one has no
    // ideal time without an event; the windows of corners are the same only nearly, as some corners are small.
    let (most, same) = match between {
        Between::Held => (1, 0.0),
        Between::Lines => (2, 0.05),
    };
    // Even with windows of single rows, more events are needed at longer periods.
    let most_s = ((times_s[count - 1] - times_s[0]) / 10.0).min(longest_s(&at_s, most));
    let few = &at_s[..at_s.len().min(FEW)];
    let mut best: Option<(f64, IdealTimes)> = None;
    let (mut last_s, mut least) = (0.0, f64::INFINITY);
    let mut trial_s = (times_s[count - 1] - times_s[0]) / (count - 1) as f64 * TRIAL_RATIO;
    while events.evidence > 0 && trial_s < most_s * TRIAL_RATIO {
        // More events make the windows only wider.
        let first = IdealTimes::of(few, trial_s, step_s * EQUAL, most);
        let first = first.filter(|first| first.excludes_a_row(times_s, few));
        let ideal = first.and_then(|_| IdealTimes::of(&at_s, trial_s, step_s * EQUAL, most));
        // Several trials lead to the same period.
        if let Some(ideal) = ideal.filter(|ideal| ideal.period_s != last_s) {
            last_s = ideal.period_s;
            let alarms = ideal.log_false_alarms(times_s, &at_s, events.evidence);
            least = least.min(alarms);
            if alarms <= least + 1.0 + same * least.abs() {
                best = Some((alarms, ideal));
            }
        }
        trial_s *= TRIAL_RATIO;
    }
    let (_, ideal) = best.filter(|(alarms, _)| *alarms < FALSE_ALARMS.ln())?;
    let samples = ideal.samples(rows, &events.rows, between);
    Some(OwnRate {
        longest_step_s: ideal.period_s + ideal.latest_s - ideal.earliest_s,
        rate_hz: 1.0 / ideal.period_s,
        base_hz: (count - 1) as f64 / (times_s[count - 1] - times_s[0]),
        samples,
        between,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    /// The number of cases of a property: few by day, many with `HITCH_THOROUGH`.
    fn config() -> ProptestConfig {
        let is_thorough = std::env::var_os("HITCH_THOROUGH").is_some();
        ProptestConfig {
            cases: if is_thorough { 8_192 } else { 256 },
            rng_seed: RngSeed::Fixed(7),
            failure_persistence: None,
            ..ProptestConfig::default()
        }
    }

    /// A course in time, s: rest, then ramps, steps and ringing of drawn sizes.
    #[derive(Debug, Clone)]
    struct Course {
        ramp: f64,
        jump: f64,
        ringing: f64,
        ringing_hz: f64,
        turn_s: f64,
    }

    fn courses() -> impl Strategy<Value = Course> {
        let sizes = (-30.0..30.0, -40.0..40.0, 0.0..20.0, 0.3..8.0, 0.3..2.0);
        sizes.prop_map(|(ramp, jump, ringing, ringing_hz, turn_s)| Course {
            ramp,
            jump,
            ringing,
            ringing_hz,
            turn_s,
        })
    }

    impl Course {
        fn at(&self, time_s: f64) -> f64 {
            let Self { ramp, jump, .. } = self;
            let later_s = (time_s - self.turn_s).max(0.0);
            let jumped = if later_s > 0.0 { *jump } else { 0.0 };
            let angle = std::f64::consts::TAU * self.ringing_hz * later_s;
            let rings = self.ringing * (-later_s).exp() * angle.sin();
            50.0 + ramp * later_s.min(1.5) + jumped + rings
        }
    }

    /// Normal noise with a sigma of one: sums of twelve numbers of a linear congruential generator.
    fn noise(seed: u64, count: usize) -> Vec<f64> {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..count)
            .map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0)
            .collect()
    }

    fn round_to(value: f64, step: f64) -> f64 {
        (value / step).round() * step
    }

    fn series(times_s: Vec<f64>, values: Vec<f64>) -> Series {
        Series {
            bytes: vec![0; times_s.len()],
            times_s,
            values,
        }
    }

    fn base_s(rows: usize) -> Vec<f64> {
        (0..rows).map(|row| row as f64 * 0.02).collect()
    }

    /// The union of two clocks has rows at times that are equal but for their rounding.
    #[test]
    fn rows_of_one_instant_are_one() {
        let noise = noise(7, 200);
        let slow_s: Vec<f64> = (0..200).map(|n| f64::from(n) * 0.1).collect();
        let fast_s = (0..991).map(|row| f64::from(row) * 0.02);
        let mut times_s: Vec<f64> = fast_s.chain(slow_s.iter().copied().take(199)).collect();
        times_s.sort_by(f64::total_cmp);
        times_s.dedup();
        assert!(times_s.windows(2).any(|two| two[1] - two[0] < 1e-12));
        let value = |time_s: f64| {
            let n = ((time_s / 0.1 + 1e-9) as usize).min(198);
            let share = (time_s - slow_s[n]) / 0.1;
            noise[n] + share * (noise[n + 1] - noise[n])
        };
        let values = times_s.iter().map(|&time_s| value(time_s)).collect();
        let own = own_rate(&series(times_s, values)).expect("a lower rate");
        assert_eq!(own.between, Between::Lines);
        assert!((own.rate_hz - 10.0).abs() < 0.01, "{}", own.rate_hz);
    }

    proptest! {
        #![proptest_config(config())]

        /// Copies held or on lines at an integer ratio: exactly their samples, with the noise of the samples and a rounding.
        #[test]
        fn a_copy_gives_its_samples_back(
            course in courses(), seed in any::<u64>(), ratio in 2..11_usize, phase in 0..10_usize,
            decimals in 1..5_i32, is_line in any::<bool>(), sparse in 80..160_usize,
        ) {
            let step = 0.1_f64.powi(if is_line { decimals.max(2) } else { decimals - 1 });
            let phase = phase % ratio;
            let noise = noise(seed, sparse + 2);
            let sample = |n: usize| {
                let sigma = if is_line { 0.3 } else { step.max(0.1) };
                let value = course.at(n as f64 * ratio as f64 * 0.02) + sigma * noise[n];
                round_to(value, step)
            };
            let times_s = base_s(ratio * sparse);
            let values = (0..times_s.len()).map(|row| {
                let later = row + ratio - phase;
                let (n, rest) = (later / ratio, (later % ratio) as f64 / ratio as f64);
                let line = sample(n) + rest * (sample(n + 1) - sample(n));
                if is_line { round_to(line, step) } else { sample(n) }
            });
            let series = series(times_s, values.collect());
            let own = own_rate(&series).expect("a lower rate");
            let expected = series.rows((phase..series.values.len()).step_by(ratio));
            prop_assert_eq!(own.samples.values, expected.values);
            prop_assert_eq!(own.samples.times_s, expected.times_s);
            prop_assert_eq!(own.between, if is_line { Between::Lines } else { Between::Held });
        }

        /// Held at any ratio, with runs of different lengths: each sample once, within a row of its time.
        #[test]
        fn runs_of_unequal_length_give_their_samples_back(
            course in courses(), seed in any::<u64>(), ratio in 1.6..6.0_f64, phase in 0.0..1.0_f64,
        ) {
            let noise = noise(seed, 500);
            let sample = |n: usize| round_to(course.at(n as f64 * ratio * 0.02) + 0.1 * noise[n], 1e-3);
            let times_s = base_s(700);
            let index = |row: usize| (row as f64 / ratio + phase).floor() as usize;
            let values = (0..700).map(|row| sample(index(row)));
            let own = own_rate(&series(times_s, values.collect())).expect("a lower rate");
            let changes: Vec<f64> = (index(0)..=index(699)).map(sample).collect();
            let mut got = own.samples.values.clone();
            // The first sample may have been taken before the log.
            if got.len() < changes.len() { got.insert(0, changes[0]); }
            prop_assert_eq!(got, changes);
            for (n, time_s) in own.samples.times_s.iter().rev().enumerate() {
                let ideal_s = (index(699) - n) as f64 * ratio * 0.02 - phase * ratio * 0.02;
                prop_assert!((time_s - ideal_s).abs() < 0.021, "{} {}", time_s, ideal_s);
            }
        }

        /// Rows that are all samples: noise from half a step of the resolution on.
        #[test]
        fn noisy_samples_are_all_used(
            course in courses(), seed in any::<u64>(), step in 0.001..1.0_f64, sigma in 0.5..5.0_f64,
        ) {
            let noise = noise(seed, 600);
            let value = |row: usize| course.at(row as f64 * 0.02) + sigma * step * noise[row];
            let values = (0..600).map(|row| round_to(value(row), step));
            prop_assert!(own_rate(&series(base_s(600), values.collect())).is_none());
        }

        /// Courses without noise in coarse or fine steps: runs of equal values, of lengths that the signal determines.
        #[test]
        fn slow_signals_in_coarse_steps_are_used(
            course in courses(), slower in 1.0..50.0_f64, step in 0.01..5.0_f64,
        ) {
            let values = (0..2_000).map(|row| round_to(course.at(f64::from(row) * 0.02 / slower), step));
            let own = own_rate(&series(base_s(2_000), values.collect()));
            prop_assert!(own.is_none(), "{:?}", own.map(|own| (own.note(""), own.samples.values.len())));
        }

        /// Ramps, counters and constants.
        #[test]
        fn counters_and_ramps_are_used(slope in 0.0..3.0_f64, wraps in 2..400_u32, step in 0.5..2.0_f64) {
            let counters = [
                (0..1_000).map(|row| f64::from(row % wraps)).collect(),
                (0..1_000).map(|row| round_to(slope * f64::from(row), step)).collect(),
                vec![slope; 1_000],
            ];
            for values in counters {
                prop_assert!(own_rate(&series(base_s(1_000), values)).is_none());
            }
        }
    }
}

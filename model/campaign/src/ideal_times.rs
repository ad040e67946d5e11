//! Times at a constant period, each with a window around it, that a channel's events lead to.

use crate::series::Series;

/// Events after which a trial without windows is given up.
pub const FEW: usize = 64;
/// Part of a step within which times are equal.
pub const EQUAL: f64 = 1e-3;

/// What a writer put between the samples of a channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Between {
    /// Each sample again, until the next one.
    Held,
    /// Values on the straight lines from sample to sample.
    Lines,
}

/// The number of the ideal time of each event: the nearest one by the regression line through the events before it.
fn numbers(at_s: &[f64], trial_s: f64) -> Vec<f64> {
    /// Weight of the trial period, as a sum of squares of numbers: that of some ten events.
    const TRIAL: f64 = 100.0;
    let begin_s = at_s.first().copied().unwrap_or_default();
    let (mut first_s, mut period_s) = (0.0, trial_s);
    let [mut count, mut n_sum, mut nn, mut t_sum, mut nt] = [0.0_f64; 5];
    let number = |time_s: &f64| {
        let later_s = time_s - begin_s;
        let n = ((later_s - first_s) / period_s).round();
        (count, n_sum, nn) = (count + 1.0, n_sum + n, nn + n * n);
        (t_sum, nt) = (t_sum + later_s, nt + n * later_s);
        let square = nn + TRIAL - n_sum * n_sum / count;
        period_s = (nt + TRIAL * trial_s - n_sum * t_sum / count) / square;
        first_s = (t_sum - n_sum * period_s) / count;
        n
    };
    at_s.iter().map(number).collect()
}

/// The vertices of the upper convex hull of points whose abscissae do not fall; the lower one with `side` -1.
fn hull(points: &[(f64, f64)], side: f64) -> Vec<(f64, f64)> {
    let mut hull: Vec<(f64, f64)> = Vec::new();
    for &(x, y) in points {
        let is_below = |two: &[(f64, f64)]| {
            let [(ax, ay), (bx, by)] = [two[0], two[1]];
            side * ((by - ay) * (x - ax) - (y - ay) * (bx - ax)) <= 0.0
        };
        while hull.len() > 1 && is_below(&hull[hull.len() - 2..]) {
            hull.pop();
        }
        hull.push((x, y));
    }
    hull
}

/// Times `first + n * period`, and the window around each in which events are.
#[derive(Debug)]
pub struct IdealTimes {
    /// One of the ideal times, s.
    first_s: f64,
    /// Time from one to the next, s.
    pub period_s: f64,
    /// Begin of the window after the ideal time, s.
    pub earliest_s: f64,
    /// End of the window after the ideal time, s.
    pub latest_s: f64,
}

impl IdealTimes {
    /// Those of events, at most `most` in a window, with a period near `trial_s`; `None` without gaps between the windows.
    pub fn of(at_s: &[f64], trial_s: f64, equal_s: f64, most: usize) -> Option<Self> {
        let numbers = numbers(at_s, trial_s);
        if numbers.windows(most + 1).any(|same| same[0] >= same[most]) {
            return None;
        }
        let ideal = Self::narrowest(at_s, &numbers, equal_s)?;
        (ideal.latest_s - ideal.earliest_s < ideal.period_s).then_some(ideal)
    }

    /// The narrowest windows of events with these numbers: at the slope of an edge of their convex hull, as their width is a
    /// convex function of the period, and linear between these slopes.
    fn narrowest(at_s: &[f64], numbers: &[f64], equal_s: f64) -> Option<Self> {
        let (&begin_s, &from) = at_s.first().zip(numbers.first())?;
        let later = at_s.iter().zip(numbers);
        let points: Vec<(f64, f64)> = later.map(|(t, n)| (n - from, t - begin_s)).collect();
        let hulls = [hull(&points, -1.0), hull(&points, 1.0)];
        let window = |period_s: f64| {
            let least_s = |side: f64, hull: &[(f64, f64)]| {
                let later_s = hull
                    .iter()
                    .map(|(n, later_s)| side * (later_s - n * period_s));
                side * later_s.fold(f64::INFINITY, f64::min)
            };
            (least_s(1.0, &hulls[0]), least_s(-1.0, &hulls[1]))
        };
        let edges = hulls.iter().flat_map(|hull| hull.windows(2));
        let slopes = edges.map(|two| (two[1].1 - two[0].1) / (two[1].0 - two[0].0));
        let width_s = |period_s: f64| window(period_s).1 - window(period_s).0;
        let sound = slopes.filter(|period_s| period_s.is_finite() && *period_s > 0.0);
        let widths: Vec<(f64, f64)> = sound
            .map(|period_s| (period_s, width_s(period_s)))
            .collect();
        let narrowest_s = widths
            .iter()
            .fold(f64::INFINITY, |least, of| least.min(of.1));
        // Of several, the middle one.
        let is_narrowest = |of: &&(f64, f64)| of.1 <= narrowest_s + EQUAL * equal_s;
        let narrowest = widths.iter().filter(is_narrowest).map(|of| of.0);
        let (low_s, high_s) = narrowest.fold((f64::INFINITY, 0.0_f64), |range, period_s| {
            (range.0.min(period_s), range.1.max(period_s))
        });
        let period_s = f64::midpoint(low_s, high_s);
        if !period_s.is_finite() {
            return None;
        }
        let (earliest_s, latest_s) = window(period_s);
        let middle_s = f64::midpoint(earliest_s, latest_s);
        Some(Self {
            first_s: begin_s + middle_s,
            period_s,
            earliest_s: earliest_s - middle_s - equal_s,
            latest_s: latest_s - middle_s + equal_s,
        })
    }

    /// Whether a time is within a window.
    fn contains(&self, time_s: f64) -> bool {
        let periods = ((time_s - self.first_s) / self.period_s).round();
        let later_s = time_s - self.first_s - periods * self.period_s;
        (self.earliest_s..=self.latest_s).contains(&later_s)
    }

    /// Whether a row between the first and the last event is in no window.
    pub fn excludes_a_row(&self, times_s: &[f64], at_s: &[f64]) -> bool {
        let from = times_s.partition_point(|time_s| *time_s < at_s[0]);
        let rows = times_s[from..]
            .iter()
            .take_while(|time_s| Some(*time_s) <= at_s.last());
        rows.into_iter().any(|time_s| !self.contains(*time_s))
    }

    /// Logarithm of the expected number of sets of windows that contain all of these events, if each row were a sample.
    ///
    /// Only rows within a period before an event may have one: at rest, a channel may have none.
    pub fn log_false_alarms(&self, times_s: &[f64], at_s: &[f64], evidence: usize) -> f64 {
        let before_s = (1.0 - EQUAL) * self.period_s;
        let mut next = at_s.iter().peekable();
        let is_active = times_s.iter().map(|time_s| {
            while next.next_if(|event_s| *event_s < time_s).is_some() {}
            next.peek()
                .is_some_and(|event_s| **event_s < time_s + before_s)
        });
        let is_active: Vec<bool> = is_active.collect();
        let rows: Vec<usize> = (0..times_s.len())
            .filter(|&row| self.contains(times_s[row]))
            .collect();
        let step = |two: &[usize]| two[1] - two[0];
        let is_each_kth = rows.windows(3).all(|r| step(&r[..2]) == step(&r[1..]));
        let sets = if is_each_kth { 2.0 } else { 5.0 } * (times_s.len() as f64).ln();
        let within = rows.iter().filter(|row| is_active[**row]).count() as f64;
        let all = is_active.iter().filter(|active| **active).count() as f64;
        sets + evidence as f64 * (within / all).ln()
    }

    /// The sample of each ideal time.
    pub fn samples(&self, rows: &Series, events: &[usize], between: Between) -> Series {
        let times_s = &rows.times_s;
        let number = |time_s: f64| ((time_s - self.first_s) / self.period_s).floor() as i64;
        let numbers = number(times_s[0])..=number(times_s[times_s.len() - 1]) + 1;
        let mut taken: Vec<(usize, f64)> = Vec::new();
        for n in numbers {
            let ideal_s = self.first_s + n as f64 * self.period_s;
            let sample = match between {
                Between::Held => self.held_sample(times_s, events, ideal_s),
                Between::Lines => self.corner(times_s, ideal_s),
            };
            let is_next = |(row, _): &(usize, f64)| taken.last().is_none_or(|(last, _)| last < row);
            taken.extend(sample.filter(is_next));
        }
        let (taken, times_s): (Vec<usize>, Vec<f64>) = taken.into_iter().unzip();
        Series {
            times_s,
            ..rows.rows(taken)
        }
    }

    /// The row and the time, s, of a held sample: of the event in the window, else of the first row from the window on. It was
    /// taken after the row before it.
    fn held_sample(&self, times_s: &[f64], events: &[usize], ideal_s: f64) -> Option<(usize, f64)> {
        let (begin_s, end_s) = (ideal_s + self.earliest_s, ideal_s + self.latest_s);
        let first = times_s.partition_point(|time_s| *time_s < begin_s);
        let event = events.get(events.partition_point(|row| *row < first));
        let event = event.filter(|row| times_s[**row] <= end_s).copied();
        let row = event.unwrap_or(first);
        let &row_s = times_s.get(row)?;
        let is_before_log = row == 0 && row_s > end_s;
        // At the end of the log, an event may still follow in the window.
        let last_s = times_s[times_s.len() - 1] + EQUAL * self.period_s;
        let is_behind_log = event.is_none() && last_s < end_s;
        if is_before_log || is_behind_log || row_s - ideal_s > self.period_s {
            return None;
        }
        let before_s = times_s[row.saturating_sub(1)];
        let step_s = row_s - before_s;
        let is_at_row = end_s - begin_s < 0.1 * step_s;
        let sampled_s = begin_s.clamp(before_s + EQUAL * step_s, row_s);
        Some((row, if is_at_row { row_s } else { sampled_s }))
    }

    /// The row nearest to a corner, and its time, s.
    fn corner(&self, times_s: &[f64], ideal_s: f64) -> Option<(usize, f64)> {
        let next = times_s.partition_point(|time_s| *time_s < ideal_s);
        let distance_s = |row: usize| times_s.get(row).map(|time_s| (time_s - ideal_s).abs());
        let around = [next.saturating_sub(1), next].into_iter();
        let near = around.filter_map(|row| Some((row, distance_s(row)?)));
        let (row, distance_s) = near.min_by(|a, b| a.1.total_cmp(&b.1))?;
        (distance_s <= self.latest_s).then(|| (row, times_s[row]))
    }
}

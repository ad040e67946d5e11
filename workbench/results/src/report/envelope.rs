//! The samples of a long run as a screen shows them: the minimum and the maximum of each column of pixels.

use super::run_view::{ChannelView, RunView};
use crate::web::plot::SimulatedChannel;

/// A run with at most two samples in each of `columns` columns of equal numbers of samples; an unchanged one if it is shorter.
///
/// All signals keep a common time axis: of each column, the first and the middle time stamp. A signal has its minimum and its
/// maximum there, in the order in which they occur, so that no peak is lost and none moves by more than a column. A column
/// with a missing sample has one.
pub fn envelope(view: &RunView, columns: usize) -> RunView {
    let samples = view.time_s.len();
    if samples <= 2 * columns {
        return view.clone();
    }
    let size = samples.div_ceil(columns);
    let signal = |values: &[f64]| -> Vec<f64> { values.chunks(size).flat_map(pair).collect() };
    let times = |values: &[f64]| -> Vec<f64> {
        let ends = |part: &[f64]| [part[0], part[part.len() / 2]];
        values.chunks(size).flat_map(ends).collect()
    };
    let simulated = |of: &SimulatedChannel<Vec<f64>>| SimulatedChannel {
        simulated: signal(&of.simulated),
        residual: signal(&of.residual),
        error: of.error,
    };
    let channel = |of: &ChannelView| ChannelView {
        channel: of.channel,
        noise: of.noise,
        measured: signal(&of.measured),
        before: simulated(&of.before),
        after: of.after.as_ref().map(simulated),
    };
    RunView {
        index: view.index,
        file: view.file.clone(),
        conditions: view.conditions.clone(),
        time_s: times(&view.time_s),
        lift_current_a: signal(&view.lift_current_a),
        lower_current_a: signal(&view.lower_current_a),
        channels: view.channels.iter().map(channel).collect(),
    }
}

/// Minimum and maximum in the order in which they occur; the second is missing if a sample is.
fn pair(values: &[f64]) -> [f64; 2] {
    let known = || (0..values.len()).filter(|i| values[*i].is_finite());
    let by_value = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
    let (Some(least), Some(greatest)) = (known().min_by(by_value), known().max_by(by_value)) else {
        return [f64::NAN; 2];
    };
    if known().count() < values.len() {
        let size = |i: usize| values[i].abs();
        let larger = if size(greatest) >= size(least) {
            greatest
        } else {
            least
        };
        return [values[larger], f64::NAN];
    }
    [values[least.min(greatest)], values[least.max(greatest)]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(lift_current_a: Vec<f64>) -> RunView {
        RunView {
            index: 0,
            file: String::new(),
            conditions: String::new(),
            time_s: (0..lift_current_a.len())
                .map(|i| i as f64 * 0.001)
                .collect(),
            lower_current_a: vec![0.0; lift_current_a.len()],
            lift_current_a,
            channels: Vec::new(),
        }
    }

    #[test]
    fn peaks_stay_at_their_time_to_a_column() {
        let mut values = vec![0.0; 10_000];
        values[7_321] = 5.0;
        values[2_500] = -3.0;
        let columns = 400;
        let drawn = envelope(&run(values.clone()), columns);
        assert!(drawn.time_s.len() <= 2 * columns);
        assert_eq!(drawn.lift_current_a.len(), drawn.time_s.len());
        assert!(drawn.time_s.is_sorted());
        let column_s = 10.0 / columns as f64;
        for (value, at_s) in [(5.0, 7.321), (-3.0, 2.5)] {
            let place = drawn.lift_current_a.iter().position(|one| *one == value);
            let time_s = drawn.time_s[place.expect("the peak")];
            assert!((time_s - at_s).abs() <= column_s, "{time_s}");
        }
    }

    #[test]
    fn short_runs_and_dropouts_stay() {
        let short = envelope(&run(vec![1.0, 2.0, 3.0]), 2);
        assert_eq!(short.lift_current_a, [1.0, 2.0, 3.0]);
        let mut values = vec![1.0; 1_000];
        values[500] = f64::NAN;
        values[501] = 7.0;
        let drawn = envelope(&run(values), 100).lift_current_a;
        let missing: Vec<usize> = (0..drawn.len()).filter(|i| drawn[*i].is_nan()).collect();
        assert!(
            missing.len() == 1 && drawn[missing[0] - 1] == 7.0,
            "{missing:?}"
        );
    }
}

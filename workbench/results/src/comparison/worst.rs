//! The stretch of time in which a channel has its largest error: of all samples, and of each part of the data.

use hitch_identification::data::ready_run::ReadyRun;
use hitch_plant::Channel;
use schemars::JsonSchema;
use serde::Serialize;

use super::groups::Part;
use super::tally::{Tally, add_to};
use super::{Evaluated, Grouping};

/// Length of the worst stretch of a run, s.
const WORST_STRETCH_S: f64 = 1.0;

/// The stretch of time in which a channel has its largest error.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct WorstStretch {
    /// Key of the channel.
    pub channel: &'static str,
    /// File of the run.
    pub run: String,
    /// Start, s.
    pub from_s: f64,
    /// End, s.
    pub to_s: f64,
    /// Root mean square in sigma.
    pub error: f64,
}

/// A group of samples with the index of a run, and a stretch of it.
type Located<P> = (P, usize, WorstStretch);

/// The stretch with the largest error of a channel.
pub(super) fn worst(evaluated: &Evaluated, channel: Channel) -> Option<WorstStretch> {
    let located = worst_by(evaluated, channel, |_, _| Some(()));
    located.into_iter().next().map(|(_, _, stretch)| stretch)
}

/// The stretch in which each part of the data has its largest error in a channel: name of the part, index of the run, and
/// the stretch.
pub fn worst_by_part(
    evaluated: &Evaluated,
    by: Grouping,
    channel: Channel,
) -> Vec<(String, usize, WorstStretch)> {
    let located = worst_by(evaluated, channel, |run, sample| {
        by.part(&evaluated.groups, run, sample)
    });
    let named = |(part, run, stretch): Located<Part>| (part.name, run, stretch);
    located.into_iter().map(named).collect()
}

/// The stretch in which a part of the data has its largest error in a channel: index of the run, and the stretch.
pub fn worst_in_part(
    evaluated: &Evaluated,
    by: Grouping,
    part: &str,
    channel: Channel,
) -> Option<(usize, WorstStretch)> {
    let mut located = worst_by_part(evaluated, by, channel).into_iter();
    let (_, run, stretch) = located.find(|(name, ..)| name == part)?;
    Some((run, stretch))
}

fn worst_by<P: PartialEq>(
    evaluated: &Evaluated,
    channel: Channel,
    part: impl Fn(&ReadyRun, usize) -> Option<P>,
) -> Vec<Located<P>> {
    let mut worst: Vec<Located<P>> = Vec::new();
    for (index, run) in evaluated.experiment.runs.iter().enumerate() {
        let residuals = evaluated.residuals(index, channel);
        let time_s = &run.drive.time_s;
        for (start, end) in stretches(time_s) {
            for (part, error) in errors(&residuals, start..end, |sample| part(run, sample)) {
                let stretch = WorstStretch {
                    channel: channel.key(),
                    run: run.file.clone(),
                    from_s: time_s[start],
                    to_s: time_s[end - 1],
                    error,
                };
                match worst.iter_mut().find(|(known, ..)| *known == part) {
                    Some((_, _, known)) if known.error > error => {}
                    Some(known) => *known = (part, index, stretch),
                    None => worst.push((part, index, stretch)),
                }
            }
        }
    }
    worst
}

/// Root mean square of each part of a stretch.
fn errors<P: PartialEq>(
    residuals: &[f64],
    stretch: std::ops::Range<usize>,
    part: impl Fn(usize) -> Option<P>,
) -> Vec<(P, f64)> {
    let mut tallies: Vec<(P, Tally)> = Vec::new();
    for sample in stretch.filter(|&sample| residuals[sample].is_finite()) {
        if let Some(part) = part(sample) {
            add_to(&mut tallies, part, residuals[sample]);
        }
    }
    let figure = |(part, tally): (P, Tally)| (part, tally.rms());
    tallies.into_iter().map(figure).collect()
}

/// Consecutive stretches of a run, as ranges of samples.
pub(super) fn stretches(time_s: &[f64]) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut start = 0;
    for end in 1..=time_s.len() {
        if end == time_s.len() || time_s[end] - time_s[start] >= WORST_STRETCH_S {
            found.push((start, end));
            start = end;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stretch_has_a_figure_for_each_part() {
        let residuals = [3.0, 4.0, f64::NAN, 1.0];
        let part = |sample: usize| (sample != 1).then_some(sample / 2);
        assert_eq!(errors(&residuals, 0..4, part), [(0, 3.0), (1, 1.0)]);
    }

    #[test]
    fn stretches_cover_all_samples() {
        let time_s: Vec<f64> = (0..25).map(|sample| f64::from(sample) * 0.1).collect();
        assert_eq!(stretches(&time_s), [(0, 10), (10, 20), (20, 25)]);
        assert_eq!(stretches(&[]), []);
    }
}

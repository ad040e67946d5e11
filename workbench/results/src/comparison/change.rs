//! Change of the error from one model to another on the same campaign.

use hitch_plant::Channel;
use schemars::JsonSchema;
use serde::Serialize;

use super::worst::stretches;
use super::{Cell, Evaluated, Grouping};

/// Error of two models in one cell.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "CellChange")]
pub struct Change {
    /// Grouping of the samples.
    pub by: Grouping,
    /// Name of the group.
    pub part: String,
    /// Key of the channel.
    pub channel: &'static str,
    /// Error of the model before, root mean square in sigma.
    pub before: f64,
    /// Error of the model after, root mean square in sigma.
    pub after: f64,
}

/// The stretch of time that contributes most to the change of a cell.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ChangedStretch {
    /// Key of the channel.
    pub channel: &'static str,
    /// Start, s.
    pub from_s: f64,
    /// End, s.
    pub to_s: f64,
    /// Error before, root mean square in sigma.
    pub before: f64,
    /// Error after, root mean square in sigma.
    pub after: f64,
}

/// The cells of both models; a cell without samples in one of them is left out.
pub fn changes(before: &[Cell], after: &[Cell]) -> Vec<Change> {
    let key = |cell: &Cell| (cell.by, cell.part.clone(), cell.channel);
    let change = |was: &Cell| {
        let is = after.iter().find(|cell| key(cell) == key(was))?;
        Some(Change {
            by: was.by,
            part: was.part.clone(),
            channel: was.channel,
            before: was.error,
            after: is.error,
        })
    };
    before.iter().filter_map(change).collect()
}

/// The stretch that contributes most to the change of a part of the data, in the direction of that change: index of the run,
/// and the stretch. The groups are those of the model before.
pub fn largest_change_in_part(
    before: &Evaluated,
    after: &Evaluated,
    by: Grouping,
    part: &str,
    channel: Channel,
) -> Option<(usize, ChangedStretch)> {
    let mut found = Vec::new();
    for (index, run) in before.experiment.runs.iter().enumerate() {
        let (was, is) = (
            before.residuals(index, channel),
            after.residuals(index, channel),
        );
        let time_s = &run.drive.time_s;
        for (start, end) in stretches(time_s) {
            let within = (start..end).filter(|&sample| {
                let group = by.part(&before.groups, run, sample);
                group.is_some_and(|group| group.name == part)
            });
            let Some(sums) = Sums::of(within.map(|sample| (was[sample], is[sample]))) else {
                continue;
            };
            let stretch = ChangedStretch {
                channel: channel.key(),
                from_s: time_s[start],
                to_s: time_s[end - 1],
                before: (sums.before / sums.samples).sqrt(),
                after: (sums.after / sums.samples).sqrt(),
            };
            found.push((sums.after - sums.before, index, stretch));
        }
    }
    let whole: f64 = found.iter().map(|(change, ..)| change).sum();
    let most = found
        .into_iter()
        .max_by(|(a, ..), (b, ..)| (a * whole.signum()).total_cmp(&(b * whole.signum())));
    most.map(|(_, run, stretch)| (run, stretch))
}

/// Sums of squares over samples that both models compare.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Sums {
    before: f64,
    after: f64,
    samples: f64,
}

impl Sums {
    /// `None` without samples.
    fn of(residuals: impl Iterator<Item = (f64, f64)>) -> Option<Self> {
        let mut sums = Self {
            before: 0.0,
            after: 0.0,
            samples: 0.0,
        };
        for (before, after) in residuals {
            if before.is_finite() && after.is_finite() {
                sums.before += before * before;
                sums.after += after * after;
                sums.samples += 1.0;
            }
        }
        (sums.samples > 0.0).then_some(sums)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(part: &str, error: f64) -> Cell {
        Cell {
            by: Grouping::ALL[0],
            part: part.to_owned(),
            channel: "flow",
            error,
            bias: 0.0,
            samples: 1,
        }
    }

    #[test]
    fn only_cells_of_both_models_change() {
        let before = [cell("lift", 3.0), cell("hold", 1.0)];
        let after = [cell("lower", 2.0), cell("lift", 1.5)];
        let changes = changes(&before, &after);
        assert_eq!(changes.len(), 1);
        assert_eq!(
            (
                changes[0].part.as_str(),
                changes[0].before,
                changes[0].after
            ),
            ("lift", 3.0, 1.5)
        );
    }

    #[test]
    fn samples_that_one_model_leaves_out_do_not_count() {
        let residuals = [(3.0, 1.0), (f64::NAN, 9.0), (9.0, f64::NAN)];
        let sums = Sums::of(residuals.into_iter()).unwrap();
        assert_eq!((sums.before, sums.after, sums.samples), (9.0, 1.0, 1.0));
        assert_eq!(Sums::of([(f64::NAN, 1.0)].into_iter()), None);
    }
}

//! The time span of a run within its log: a long log may contain several runs.

use std::ops::RangeInclusive;

use hitch_input::toml_reader::TomlTable;

use crate::recorded::CampaignError;

/// Largest time after a log's first sample, s: four months.
const TIME_S: RangeInclusive<f64> = 0.0..=1e7;

/// Start and end of a run after the log's first sample, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cut {
    from_s: f64,
    to_s: f64,
}

impl Cut {
    /// Its keys in a `[[run]]` block.
    pub const KEYS: [&'static str; 2] = ["from_s", "to_s"];

    /// The whole log.
    pub const NONE: Self = Self {
        from_s: 0.0,
        to_s: f64::INFINITY,
    };

    /// The time span in a `[[run]]` block; the whole log if there is none.
    ///
    /// # Errors
    /// The time span is empty.
    pub fn read(run: &TomlTable<'_>) -> Result<Self, CampaignError> {
        let [from, to] = Self::KEYS;
        let from_s = run.number(from, TIME_S)?.unwrap_or(Self::NONE.from_s);
        let to_s = run.number(to, TIME_S)?.unwrap_or(Self::NONE.to_s);
        if from_s >= to_s {
            let what = format!("the run ends at {to_s} s, before its start at {from_s} s");
            let hint = "both are seconds after the log's first sample";
            return Err(run.error_at(to, what, hint));
        }
        Ok(Self { from_s, to_s })
    }

    /// Whether a sample belongs to the run, `time_s` after the log's first.
    pub fn contains(self, time_s: f64) -> bool {
        (self.from_s..=self.to_s).contains(&time_s)
    }

    /// Whether two runs of one log overlap.
    pub fn overlaps(self, other: Self) -> bool {
        self.from_s < other.to_s && other.from_s < self.to_s
    }

    /// Display name of a run with this part of `file`.
    pub fn name(self, file: &str) -> String {
        let Self { from_s, to_s } = self;
        match (self == Self::NONE, to_s.is_finite()) {
            (true, _) => file.to_owned(),
            (_, true) => format!("{file} {from_s} to {to_s} s"),
            (_, false) => format!("{file} from {from_s} s"),
        }
    }
}

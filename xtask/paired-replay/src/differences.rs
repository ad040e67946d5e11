//! The differences of two sides, grouped by the outputs that differ.

use std::collections::BTreeMap;
use std::fmt::Write;

use replay_side::{ABSENT, Event};

use super::Step;
use super::interface::Layout;

/// Title of the section of the safety page that explains differences.
pub const SECTION: &str = "## Changes of behaviour";

/// A step of a machine in which the sides differ.
#[derive(Debug)]
pub struct Comparison<'a> {
    /// Number of the step over all machines.
    pub step: u64,
    /// The machine.
    pub machine: usize,
    /// What was asked.
    pub asked: &'a Step,
    /// Common outputs of the earlier side.
    pub earlier: &'a [i32],
    /// The same of the present side.
    pub present: &'a [i32],
}

/// Differences in the same outputs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// How often.
    pub count: u64,
    /// The first one, in words.
    pub first: String,
}

/// All differences, by the names of the outputs that differ.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Differences {
    /// The groups.
    pub groups: BTreeMap<String, Group>,
}

impl Differences {
    /// Adds a step, if its answers differ.
    pub fn add(&mut self, layout: &Layout, comparison: &Comparison<'_>) {
        let answers = comparison.earlier.iter().zip(comparison.present);
        let names: Vec<&str> = answers
            .zip(&layout.outputs)
            .filter(|((earlier, present), _)| earlier != present)
            .map(|(_, name)| name.as_str())
            .collect();
        if names.is_empty() {
            return;
        }
        let group = self
            .groups
            .entry(names.join(", "))
            .or_insert_with(|| Group {
                count: 0,
                first: comparison.described(layout),
            });
        group.count += 1;
    }

    /// Takes in others. Of a group that both have, the own first difference stays.
    pub fn merge(&mut self, others: Self) {
        for (names, other) in others.groups {
            match self.groups.get_mut(&names) {
                Some(group) => group.count += other.count,
                None => {
                    self.groups.insert(names, other);
                }
            }
        }
    }

    /// The groups that the safety page does not explain for this commit. It explains a group in a line of its section
    /// that has the commit, abbreviated, and the names of the outputs, both in backticks.
    #[must_use]
    pub fn unexplained(&self, page: &str, commit: &str) -> Vec<&str> {
        let section = page
            .lines()
            .skip_while(|line| *line != SECTION)
            .skip(1)
            .take_while(|line| !line.starts_with("## "));
        let explained: Vec<Vec<&str>> = section
            .map(|line| line.split('`').skip(1).step_by(2).collect())
            .collect();
        let is_commit = |code: &&str| code.len() >= 7 && commit.starts_with(code);
        self.groups
            .keys()
            .map(String::as_str)
            .filter(|names| {
                !explained
                    .iter()
                    .any(|codes| codes.contains(names) && codes.iter().any(is_commit))
            })
            .collect()
    }
}

impl Comparison<'_> {
    fn described(&self, layout: &Layout) -> String {
        let mut text = format!("  first in step {}, machine {}\n", self.step, self.machine);
        if self.asked.event == Event::Calibrate {
            let (index, value) = self.asked.parameter;
            let name = layout
                .parameters
                .get(index)
                .map_or("?", |parameter| &parameter.name);
            let _ = writeln!(text, "  calibration: {name} = {value}");
        } else if self.asked.event == Event::PowerUp {
            text.push_str("  power-up\n");
        }
        let shown = |value: i32| match value {
            ABSENT => "none".to_owned(),
            value => value.to_string(),
        };
        let inputs = layout.inputs.iter().zip(&self.asked.inputs);
        let inputs: Vec<String> = inputs
            .map(|(name, value)| format!("{name} {}", shown(*value)))
            .collect();
        let [lift, lower, flags] = self.asked.command;
        let _ = writeln!(text, "  inputs: {}", inputs.join(", "));
        let _ = writeln!(
            text,
            "  command to the envelope: lift {lift}, lower {lower}, flags {flags}"
        );
        for (side, answer) in [("earlier", self.earlier), ("present", self.present)] {
            let outputs = layout.outputs.iter().zip(answer);
            let outputs: Vec<String> = outputs
                .map(|(name, value)| format!("{name} {value}"))
                .collect();
            let _ = writeln!(text, "  {side}: {}", outputs.join(", "));
        }
        text
    }
}

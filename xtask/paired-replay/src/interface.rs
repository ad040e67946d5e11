//! What a side takes and answers, by name, and how the words of two sides correspond.

use std::io::BufRead;

use anyhow::{Context, Result, bail, ensure};

use super::Step;

/// A parameter of the calibration.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Group and name.
    pub name: String,
    /// Default, smallest and largest value.
    pub nominal: i32,
    /// Smallest value.
    pub min: i32,
    /// Largest value.
    pub max: i32,
}

/// The inputs, outputs and parameters of a side.
#[derive(Clone, Debug, Default)]
pub struct Interface {
    /// Names of the inputs, in their order.
    pub inputs: Vec<String>,
    /// Names of the outputs.
    pub outputs: Vec<String>,
    /// Parameters.
    pub parameters: Vec<Parameter>,
}

impl Interface {
    /// Reads it up to its end.
    ///
    /// # Errors
    /// If it is incomplete or a line is unknown.
    pub fn read(input: &mut dyn BufRead) -> Result<Self> {
        let mut interface = Self::default();
        for line in input.lines() {
            let line = line.context("a side can't be read")?;
            let words: Vec<&str> = line.split(' ').collect();
            match words[..] {
                ["input", name] => interface.inputs.push(name.to_owned()),
                ["output", name] => interface.outputs.push(name.to_owned()),
                ["parameter", name, nominal, min, max] => interface.parameters.push(Parameter {
                    name: name.to_owned(),
                    nominal: nominal.parse()?,
                    min: min.parse()?,
                    max: max.parse()?,
                }),
                ["end"] => return Ok(interface),
                _ => bail!("a side says `{line}`"),
            }
        }
        bail!("a side ended before it told its interface")
    }
}

/// The order of words of one side.
#[derive(Clone, Debug)]
pub struct Order {
    /// For each of its inputs the place among the known ones.
    inputs: Vec<Option<usize>>,
    /// For each common output its place in an answer.
    outputs: Vec<usize>,
    /// For each common parameter its place.
    parameters: Vec<usize>,
    width: usize,
}

/// Names that are known to both sides or to one, and the order of each.
#[derive(Clone, Debug)]
pub struct Layout {
    /// Inputs that a side has, the earlier one's first.
    pub inputs: Vec<String>,
    /// Outputs that both have.
    pub outputs: Vec<String>,
    /// Parameters that both have, with the range of both.
    pub parameters: Vec<Parameter>,
    /// Names that one side alone has.
    pub alone: Vec<String>,
    /// Words of the earlier side.
    pub earlier: Order,
    /// Words of the present side.
    pub present: Order,
}

impl Layout {
    /// How two sides correspond.
    ///
    /// # Errors
    /// If they have no output in common.
    pub fn of(earlier: &Interface, present: &Interface) -> Result<Self> {
        let mut inputs = earlier.inputs.clone();
        inputs.extend(
            present
                .inputs
                .iter()
                .filter(|name| !earlier.inputs.contains(name))
                .cloned(),
        );
        let outputs: Vec<String> = earlier
            .outputs
            .iter()
            .filter(|name| present.outputs.contains(name))
            .cloned()
            .collect();
        ensure!(
            !outputs.is_empty(),
            "the two commits have no output in common"
        );
        let parameters: Vec<Parameter> = earlier
            .parameters
            .iter()
            .filter_map(|one| {
                let other = present
                    .parameters
                    .iter()
                    .find(|other| other.name == one.name)?;
                Some(Parameter {
                    min: one.min.max(other.min),
                    max: one.max.min(other.max),
                    ..one.clone()
                })
            })
            .filter(|common| common.min <= common.max)
            .collect();
        Ok(Self {
            alone: alone(earlier, present),
            earlier: Order::of(earlier, &inputs, &outputs, &parameters),
            present: Order::of(present, &inputs, &outputs, &parameters),
            inputs,
            outputs,
            parameters,
        })
    }

    /// The value of an output in an answer; 0 if not both sides have it.
    #[must_use]
    pub fn output(&self, answer: &[i32], name: &str) -> i32 {
        let place = self.outputs.iter().position(|output| output == name);
        place.map_or(0, |place| answer[place])
    }
}

/// What one side alone has, and parameters whose default or range differs.
fn alone(earlier: &Interface, present: &Interface) -> Vec<String> {
    let lines = |interface: &Interface| {
        let inputs = interface.inputs.iter().map(|name| format!("input {name}"));
        let outputs = interface
            .outputs
            .iter()
            .map(|name| format!("output {name}"));
        let parameters = interface.parameters.iter().map(|parameter| {
            let Parameter {
                name,
                nominal,
                min,
                max,
            } = parameter;
            format!("parameter {name} = {nominal}, {min} to {max}")
        });
        inputs
            .chain(outputs)
            .chain(parameters)
            .collect::<Vec<String>>()
    };
    let (one, other) = (lines(earlier), lines(present));
    let only = |side: &str, these: &[String], those: &[String]| {
        these
            .iter()
            .filter(|line| !those.contains(line))
            .map(|line| format!("{side} alone: {line}"))
            .collect::<Vec<String>>()
    };
    [only("earlier", &one, &other), only("present", &other, &one)].concat()
}

impl Order {
    fn of(
        side: &Interface,
        inputs: &[String],
        outputs: &[String],
        parameters: &[Parameter],
    ) -> Self {
        let place = |names: &[String], name: &String| names.iter().position(|known| known == name);
        Self {
            inputs: side.inputs.iter().map(|name| place(inputs, name)).collect(),
            outputs: outputs
                .iter()
                .filter_map(|name| place(&side.outputs, name))
                .collect(),
            parameters: parameters
                .iter()
                .filter_map(|common| {
                    side.parameters
                        .iter()
                        .position(|own| own.name == common.name)
                })
                .collect(),
            width: side.outputs.len(),
        }
    }

    /// The words of a round.
    #[must_use]
    pub fn words(&self, round: &[Step]) -> Vec<i32> {
        let mut words =
            Vec::with_capacity(round.len() * (self.inputs.len() + replay_side::HEAD_WORDS));
        for step in round {
            let (parameter, value) = step.parameter;
            let parameter = self
                .parameters
                .get(parameter)
                .map_or(-1, |place| i32::try_from(*place).unwrap_or(-1));
            words.extend([step.event as i32, parameter, value]);
            words.extend(step.command);
            words.extend(
                self.inputs
                    .iter()
                    .map(|place| place.map_or(0, |place| step.inputs[place])),
            );
        }
        words
    }

    /// The common outputs of the answers.
    #[must_use]
    pub fn common(&self, answers: &[i32]) -> Vec<i32> {
        answers
            .chunks_exact(self.width)
            .flat_map(|answer| self.outputs.iter().map(|place| answer[*place]))
            .collect()
    }
}

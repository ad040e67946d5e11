//! Summary over the lines of many campaigns: which machine has which effect, and which machines differ from the others.
pub mod read;
mod show;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Serialize;

/// Confidence from which an effect counts as present.
pub const PRESENT: f64 = 0.5;

/// Result of `hitch summary`.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct FleetSummary {
    /// The machines with a result, the largest remaining error first.
    pub machines: Vec<Machine>,
    /// The effects that a machine has, the most frequent first.
    pub effects: Vec<EffectOfFleet>,
    /// How many machines have each verdict.
    pub verdicts: BTreeMap<String, usize>,
    /// The campaigns without a result.
    pub failed: Vec<Failed>,
}

/// A machine.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Machine {
    /// Folder of its campaign.
    pub campaign: String,
    /// Its verdict.
    pub verdict: String,
    /// Error of the initial model, in sigma.
    #[schemars(with = "Option<f64>")]
    pub error_before: f64,
    /// Error of the final model, in sigma.
    #[schemars(with = "Option<f64>")]
    pub error_after: f64,
    /// Its effects by name.
    pub effects: BTreeMap<String, Found>,
}

/// An effect of a machine.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct Found {
    /// Its size: the value of its first parameter.
    #[schemars(with = "Option<f64>")]
    pub size: f64,
    /// End of the 95 % interval of the size; `null` if it is not known.
    pub low: Option<f64>,
    /// The other end.
    pub high: Option<f64>,
    /// Confidence that it is this effect, 0 to 1.
    pub confidence: f64,
    /// Whether the interval excludes the median of the fleet. Of equal machines, one in twenty does by chance.
    pub differs: bool,
}

/// An effect over all machines.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct EffectOfFleet {
    /// Name of the effect with its form.
    pub effect: String,
    /// Unit of its size.
    pub unit: String,
    /// How many machines have it.
    pub machines: usize,
    /// Median of the sizes of those machines.
    pub median: f64,
    /// Their smallest size.
    pub least: f64,
    /// Their largest size.
    pub most: f64,
    /// How many of those machines have an interval that excludes the median.
    pub differ: usize,
}

/// A campaign without a result.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Failed {
    /// Its folder.
    pub campaign: String,
    /// What is wrong.
    pub error: String,
}

/// A line.
#[derive(Debug, Clone)]
pub enum Line {
    /// A result.
    Result {
        /// The machine.
        machine: Machine,
        /// Units of its effects by name.
        units: BTreeMap<String, String>,
    },
    /// A campaign without a result.
    Failed(Failed),
}

impl FleetSummary {
    /// The summary of lines.
    #[must_use]
    pub fn of(lines: Vec<Line>) -> Self {
        let mut units = BTreeMap::new();
        let (mut machines, mut failed) = (Vec::new(), Vec::new());
        for line in lines {
            match line {
                Line::Failed(one) => failed.push(one),
                Line::Result { machine, units: of } => {
                    units.extend(of);
                    machines.push(machine);
                }
            }
        }
        let mut effects: Vec<EffectOfFleet> = units
            .into_iter()
            .filter_map(|(effect, unit)| over_all(&mut machines, effect, unit))
            .collect();
        effects.sort_by(|a, b| b.machines.cmp(&a.machines).then(a.effect.cmp(&b.effect)));
        machines.sort_by(|a, b| b.error_after.total_cmp(&a.error_after));
        let mut verdicts = BTreeMap::new();
        for machine in &machines {
            *verdicts.entry(machine.verdict.clone()).or_default() += 1;
        }
        Self {
            machines,
            effects,
            verdicts,
            failed,
        }
    }
}

/// An effect over the machines that have it, which are marked if they differ; `None` if no machine has it.
fn over_all(machines: &mut [Machine], effect: String, unit: String) -> Option<EffectOfFleet> {
    let mut having: Vec<&mut Found> = machines
        .iter_mut()
        .filter_map(|machine| machine.effects.get_mut(&effect))
        .filter(|found| found.confidence >= PRESENT && found.size.is_finite())
        .collect();
    having.sort_by(|a, b| a.size.total_cmp(&b.size));
    let (least, most) = (having.first()?.size, having.last()?.size);
    let median = f64::midpoint(
        having[(having.len() - 1) / 2].size,
        having[having.len() / 2].size,
    );
    for found in &mut having {
        found.differs = found.low.is_some_and(|low| median < low)
            || found.high.is_some_and(|high| median > high);
    }
    Some(EffectOfFleet {
        machines: having.len(),
        differ: having.iter().filter(|found| found.differs).count(),
        effect,
        unit,
        median,
        least,
        most,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn machine(campaign: &str, error_after: f64, sizes: &[(&str, f64, f64)]) -> Line {
        let found = |&(effect, size, half): &(&str, f64, f64)| {
            let found = Found {
                size,
                low: Some(size - half),
                high: Some(size + half),
                confidence: 0.9,
                differs: false,
            };
            (effect.to_owned(), found)
        };
        Line::Result {
            units: sizes
                .iter()
                .map(|(effect, ..)| ((*effect).to_owned(), "A".to_owned()))
                .collect(),
            machine: Machine {
                campaign: campaign.to_owned(),
                verdict: "explained".to_owned(),
                error_before: 3.0,
                error_after,
                effects: sizes.iter().map(found).collect(),
            },
        }
    }

    #[test]
    fn the_machine_apart_from_the_median_is_marked() {
        let lines = vec![
            machine("a", 1.0, &[("shift", 0.10, 0.02)]),
            machine("b", 1.2, &[("shift", 0.11, 0.02), ("droop", 1.0, 0.1)]),
            machine("c", 1.1, &[("shift", 0.20, 0.02)]),
            Line::Failed(Failed {
                campaign: "d".to_owned(),
                error: "no log".to_owned(),
            }),
        ];
        let summary = FleetSummary::of(lines);
        let order: Vec<&str> = summary
            .machines
            .iter()
            .map(|machine| machine.campaign.as_str())
            .collect();
        assert_eq!(order, ["b", "c", "a"]);
        let [shift, droop] = summary.effects.as_slice() else {
            panic!("two effects");
        };
        assert_eq!((shift.machines, shift.differ, droop.machines), (3, 1, 1));
        assert!((shift.median - 0.11).abs() < 1e-12);
        let marked = |machine: &&Machine| machine.effects.values().any(|found| found.differs);
        let marked: Vec<&Machine> = summary.machines.iter().filter(marked).collect();
        assert_eq!(marked.len(), 1);
        assert_eq!(marked[0].campaign, "c");
        assert_eq!(summary.failed.len(), 1);
    }

    #[test]
    fn an_effect_that_is_improbable_does_not_count() {
        let Line::Result { mut machine, units } = machine("a", 1.0, &[("shift", 0.1, 0.02)]) else {
            panic!("a result");
        };
        for found in machine.effects.values_mut() {
            found.confidence = 0.4;
        }
        let summary = FleetSummary::of(vec![Line::Result { machine, units }]);
        assert!(summary.effects.is_empty() && summary.machines[0].effects.len() == 1);
    }
}

//! Groupings of the samples of a campaign.

use hitch_campaign::Bench;
use hitch_identification::data::ready_run::ReadyRun;
use hitch_identification::data::regime::Regime;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::current_groups::CurrentGroups;

/// Width of the oil temperature groups, degrees Celsius.
const TEMPERATURE_STEP_C: f64 = 10.0;

/// Grouping of the samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Grouping {
    /// By regime.
    Regime,
    /// By the current of the energised valve.
    Current,
    /// By load, or by the port pressure of a flow bench.
    Load,
    /// By oil temperature.
    Temperature,
    /// By run.
    Run,
}

/// A group; groups are ordered by position.
#[derive(Debug, Clone, PartialEq, PartialOrd)]
pub struct Part {
    place: f64,
    /// Displayed name.
    pub name: String,
}

impl Grouping {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Regime,
        Self::Current,
        Self::Load,
        Self::Temperature,
        Self::Run,
    ];

    /// Displayed heading.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Regime => "by regime",
            Self::Current => "by current",
            Self::Load => "by load",
            Self::Temperature => "by oil temperature",
            Self::Run => "by run",
        }
    }

    /// The group of a sample.
    pub fn part(self, groups: &CurrentGroups, run: &ReadyRun, sample: usize) -> Option<Part> {
        match self {
            Self::Regime => regime(run, sample),
            Self::Current => Some(current(groups, run, sample)),
            Self::Load => Some(load(run.bench)),
            Self::Temperature => Some(temperature(run)),
            Self::Run => Some(Part {
                place: 0.0,
                name: run.file.clone(),
            }),
        }
    }
}

fn regime(run: &ReadyRun, sample: usize) -> Option<Part> {
    let regime = *run.regimes.get(sample)?;
    let place = Regime::ALL.iter().position(|known| *known == regime)?;
    Some(Part {
        place: place as f64,
        name: regime.name().to_owned(),
    })
}

fn current(groups: &CurrentGroups, run: &ReadyRun, sample: usize) -> Part {
    let currents = run.drive.currents[sample];
    let is_lift = currents.lift_a >= currents.lower_a;
    let (valve, amperes, place) = if is_lift {
        ("lift", currents.lift_a, 0.0)
    } else {
        ("lower", currents.lower_a, 10.0)
    };
    if amperes < groups.off_below_a {
        return Part {
            place: -1.0,
            name: "both off".to_owned(),
        };
    }
    let limits_a = groups.limits_a(is_lift);
    let step = limits_a.iter().filter(|limit| amperes >= **limit).count();
    let below = step.checked_sub(1).map(|before| limits_a[before]);
    let name = match (below, limits_a.get(step)) {
        (Some(low), Some(high)) => format!("{valve} {low} to {high} A"),
        (Some(low), None) => format!("{valve} over {low} A"),
        (None, Some(high)) => format!("{valve} under {high} A"),
        (None, None) => valve.to_owned(),
    };
    Part {
        place: place + step as f64,
        name,
    }
}

fn load(bench: Bench) -> Part {
    match bench {
        Bench::Hitch { load_kg } => Part {
            place: load_kg,
            name: format!("{load_kg:.0} kg"),
        },
        Bench::Flow { port_pressure_bar } => Part {
            place: 1e4 + port_pressure_bar,
            name: format!("flow bench, {port_pressure_bar:.0} bar"),
        },
    }
}

fn temperature(run: &ReadyRun) -> Part {
    if !run.oil_temperature_known {
        return Part {
            place: f64::NEG_INFINITY,
            name: "not measured".to_owned(),
        };
    }
    let low = (run.oil_temperature_c / TEMPERATURE_STEP_C).floor() * TEMPERATURE_STEP_C;
    Part {
        place: low,
        name: format!("{low:.0} to {:.0} C", low + TEMPERATURE_STEP_C),
    }
}

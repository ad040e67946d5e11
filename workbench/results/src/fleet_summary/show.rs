//! A summary as text.

use std::fmt;

use super::{EffectOfFleet, FleetSummary, Machine};
use hitch_output::text::{Table, joined, known, significant, wrapped};

/// Machines that are listed in a text; a report has all.
const LISTED: usize = 20;

impl fmt::Display for FleetSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}\n", wrapped(&self.sentence()))?;
        let effect = |effect: &EffectOfFleet| {
            let number = |value: f64| significant(value, 3);
            let sizes = [effect.median, effect.least, effect.most].map(number);
            let cells = [effect.effect.clone(), effect.machines.to_string()];
            let rest = [effect.unit.clone(), effect.differ.to_string()];
            cells.into_iter().chain(sizes).chain(rest)
        };
        if !self.effects.is_empty() {
            let effects = self.effects.iter().map(effect);
            writeln!(f, "{}", Table::of(EffectOfFleet::HEADINGS, effects))?;
        }
        let machine = |machine: &Machine| {
            let effects = machine.effects.iter().map(|(name, found)| {
                let mark = if found.differs { "*" } else { "" };
                format!("{name}{mark}")
            });
            [
                machine.campaign.clone(),
                machine.verdict.clone(),
                known(machine.error_before, 2),
                known(machine.error_after, 2),
                joined(effects, " "),
            ]
        };
        let header = ["machine", "verdict", "before", "after", "effects"];
        let machines = self.machines.iter().take(LISTED).map(machine);
        write!(f, "{}", Table::of(header, machines))?;
        if self.machines.len() > LISTED {
            writeln!(
                f,
                "  {} more; --report and --json have all",
                self.machines.len() - LISTED
            )?;
        }
        if self.effects.iter().any(|effect| effect.differ > 0) {
            writeln!(f, "\n{}", wrapped(Self::MARK))?;
        }
        for failed in &self.failed {
            writeln!(
                f,
                "{}",
                wrapped(&format!("{}: {}", failed.campaign, failed.error))
            )?;
        }
        Ok(())
    }
}

impl EffectOfFleet {
    /// Column headings of a table of effects.
    pub const HEADINGS: [&'static str; 7] = [
        "effect", "machines", "median", "least", "most", "unit", "differ",
    ];
}

impl FleetSummary {
    /// What the mark of a machine means.
    pub const MARK: &'static str = "*: the 95 % interval of the size excludes the median of the machines that have the effect. Of equal \
        machines, one in twenty does by chance.";

    /// Numbers of machines and verdicts.
    #[must_use]
    pub fn sentence(&self) -> String {
        let verdicts = self.verdicts.iter();
        let verdicts = verdicts.map(|(verdict, count)| format!("{count} {verdict}"));
        let failed = match self.failed.len() {
            0 => String::new(),
            count => format!("; {count} without a result"),
        };
        format!(
            "{} machines: {}{failed}. Errors in sigma, before and after; the largest first.",
            self.machines.len(),
            joined(verdicts, ", ")
        )
    }
}

//! The result of a draft campaign as text.

use std::fmt;

use super::{DraftResult, Interval};
use hitch_output::text::words::probable;
use hitch_output::text::{Table, significant, wrapped};

impl fmt::Display for DraftResult {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}\n", wrapped(&self.sentence()))?;
        let coefficients = Table::of(Self::COEFFICIENTS, self.coefficient_rows());
        let effects = Table::of(Self::EFFECTS, self.effect_rows());
        writeln!(f, "{coefficients}\n{effects}")?;
        for line in self.remarks() {
            writeln!(f, "{}", wrapped(&line))?;
        }
        Ok(())
    }
}

impl DraftResult {
    /// Header of the coefficients.
    pub const COEFFICIENTS: [&'static str; 5] = ["", "campaign", "95 %", "standard", "unit"];
    /// Header of the effects.
    pub const EFFECTS: [&'static str; 5] = ["effect", "probability", "size", "95 %", "unit"];

    /// Draft and soil in words.
    #[must_use]
    pub fn sentence(&self) -> String {
        let Interval { value, low, high } = self.mean_draft.times(1e-3);
        let ratio = self.over_standard;
        format!(
            "{}: without hidden effects, a {} of {} {} in {} soil has {value:.1} kN ({low:.1} to {high:.1}) at {:.1} cm and {:.1} km/h, \
             {:.2} times the standard's ({:.2} to {:.2}; its range is +-{} %).",
            self.campaign,
            self.implement,
            self.width,
            self.plural_unit(),
            self.texture,
            self.mean_depth_cm,
            self.mean_speed_km_h,
            ratio.value,
            ratio.low,
            ratio.high,
            self.standard_range_percent,
        )
    }

    fn plural_unit(&self) -> &str {
        match self.width_unit.as_str() {
            "tool" => "tools",
            unit => unit,
        }
    }

    /// Cells of the coefficients.
    #[must_use]
    pub fn coefficient_rows(&self) -> Vec<[String; 5]> {
        let mut rows: Vec<[String; 5]> = self
            .coefficients
            .iter()
            .map(|coefficient| {
                [
                    coefficient.name.clone(),
                    significant(coefficient.value.value, 3),
                    ends(&coefficient.value),
                    significant(coefficient.standard, 3),
                    coefficient.unit.clone(),
                ]
            })
            .collect();
        let standard = self.soil_factor.value / self.over_standard.value;
        for (name, value, standard, unit) in [
            (
                "F of the standard's implement",
                &self.soil_factor,
                significant(standard, 3),
                "1",
            ),
            ("draft per depth", &self.draft_per_cm, String::new(), "N/cm"),
        ] {
            rows.push([
                name.to_owned(),
                significant(value.value, 3),
                ends(value),
                standard,
                unit.to_owned(),
            ]);
        }
        rows
    }

    /// Cells of the effects.
    #[must_use]
    pub fn effect_rows(&self) -> Vec<[String; 5]> {
        let row = |effect: &super::HiddenEffect| {
            [
                effect.name.clone(),
                probable(effect.probability),
                significant(effect.size.value, 3),
                ends(&effect.size),
                effect.unit.clone(),
            ]
        };
        self.effects.iter().map(row).collect()
    }

    /// What the reader of the tables should know, a paragraph each.
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        let soil = &self.soil;
        let mut remarks = vec![format!(
            "The draft varies by {:.0} % between metres, over about {:.0} m: {} m in work determine its level as {:.0} independent samples do.",
            soil.variation_percent, soil.correlation_length_m, soil.metres, soil.effective_samples,
        )];
        if let Some(open) = &self.open {
            remarks.push(format!("Not decided: {}.", open.effects.join(", ")));
            for [left, right] in &open.confounded {
                remarks.push(format!(
                    "At least one of {left} and {right} is present; this campaign does not separate them."
                ));
            }
            remarks.push(format!(
                "The run that says most of this: {}.",
                open.next_run
            ));
        }
        remarks
    }
}

fn ends(interval: &Interval) -> String {
    let [low, high] = [interval.low, interval.high].map(|end| significant(end, 3));
    format!("{low} to {high}")
}

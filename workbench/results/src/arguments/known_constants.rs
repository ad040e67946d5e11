//! What a user knows of constants beside a model file: that they are exact, their tolerance, or their range.

use std::collections::BTreeSet;
use std::str::FromStr;

use hitch_identification::constants::tolerances::{Own, Tolerances};
use hitch_plant::Model;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use hitch_output::error::Error;

/// Constants that a user knows, by their names in a model file (`table.key`).
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct KnownConstants {
    /// Those that are exact.
    pub hold: Vec<String>,
    /// Others, each with a [`Within`] as text.
    pub within: Vec<(String, String)>,
}

/// Where a constant is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Within {
    /// Near its declared value: one standard deviation.
    Tolerance(Own),
    /// Between two values in the unit of its key; a fit starts in their middle.
    Range([f64; 2]),
}

/// What is wrong with what is known of a constant.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct ConstantFault {
    /// Name of the constant.
    pub name: String,
    /// What is wrong, and how to mend it.
    pub what: String,
}

impl From<ConstantFault> for Error {
    fn from(fault: ConstantFault) -> Self {
        Self::Usage(format!("{}: {}", fault.name, fault.what))
    }
}

impl FromStr for Within {
    type Err = String;

    /// Reads `2%`, `0.5` or `74..76`, the numbers with a point or a comma.
    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.trim().replace(',', ".").parse::<f64>().ok();
        let wrong = || {
            let text = text.trim();
            format!(
                "{text:?} is neither a tolerance (2%, or 0.5 in the unit of the constant) nor a range (74..76)"
            )
        };
        if let Some((low, high)) = text.split_once("..") {
            let (low, high) = number(low).zip(number(high)).ok_or_else(wrong)?;
            return Ok(Self::Range([low, high]));
        }
        let share = text.trim().strip_suffix('%');
        let value = number(share.unwrap_or(text)).ok_or_else(wrong)?;
        if !(value.is_finite() && value > 0.0) {
            return Err(format!(
                "a tolerance is a number above zero, not {value}; a constant without tolerance is exact"
            ));
        }
        Ok(Self::Tolerance(match share {
            Some(_) => Own::Share(0.01 * value),
            None => Own::Value(value),
        }))
    }
}

impl KnownConstants {
    /// The tolerances, and the model with its constants in the middle of their ranges, from which a fit starts.
    ///
    /// # Errors
    /// If a constant is not known or named twice, or a text is no tolerance and no range.
    pub fn applied_to(&self, model: Model) -> Result<(Tolerances, Model), Error> {
        let (own, model, faults) = self.judged(model);
        match faults.into_iter().next() {
            Some(fault) => Err(fault.into()),
            None => Ok((own, model)),
        }
    }

    /// Everything that is wrong for a model.
    #[must_use]
    pub fn faults(&self, model: &Model) -> Vec<ConstantFault> {
        let (_, _, faults) = self.judged(model.clone());
        faults
    }

    /// The tolerances and the model of what is right, and the faults of the rest.
    fn judged(&self, mut model: Model) -> (Tolerances, Model, Vec<ConstantFault>) {
        let mut own = Tolerances::default();
        let mut faults = Vec::new();
        let mut named = BTreeSet::new();
        let exact = self.hold.iter().map(|name| (name, None));
        let within = self.within.iter().map(|(name, text)| (name, Some(text)));
        for (name, text) in exact.chain(within) {
            let judged = match text {
                _ if !named.insert(name) => Err("it is named twice; give one of both".to_owned()),
                None => own.hold(name, model.constants()),
                Some(text) => placed(&mut own, &mut model, name, text),
            };
            faults.extend(judged.err().map(|what| ConstantFault {
                name: name.clone(),
                what,
            }));
        }
        (own, model, faults)
    }
}

/// Takes a tolerance or a range of a constant.
fn placed(own: &mut Tolerances, model: &mut Model, name: &str, text: &str) -> Result<(), String> {
    match text.parse()? {
        Within::Tolerance(value) => {
            let sigma = Tolerances::sigma_of(name, value, model.constants())?;
            own.set(name, sigma);
        }
        Within::Range(ends) => *model = own.bound(name, ends, model)?,
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn within(name: &str, text: &str) -> KnownConstants {
        KnownConstants {
            hold: Vec::new(),
            within: vec![(name.to_owned(), text.to_owned())],
        }
    }

    #[test]
    fn a_text_is_a_share_a_value_or_a_range() {
        for (text, meaning) in [
            ("2%", Within::Tolerance(Own::Share(0.02))),
            (" 2,5 % ", Within::Tolerance(Own::Share(0.025))),
            ("0.5", Within::Tolerance(Own::Value(0.5))),
            ("74..76", Within::Range([74.0, 76.0])),
            ("74,5 .. 76", Within::Range([74.5, 76.0])),
        ] {
            let read: Within = text.parse().unwrap();
            match (read, meaning) {
                (Within::Tolerance(Own::Share(one)), Within::Tolerance(Own::Share(other))) => {
                    assert!((one - other).abs() < 1e-12, "{text}");
                }
                (read, meaning) => assert_eq!(read, meaning, "{text}"),
            }
        }
    }

    #[test]
    fn what_is_no_tolerance_and_no_range_is_refused_with_the_forms() {
        for text in ["", "%", "wide", "74..", "..76", "2%%", "1..2..3", "5 mm"] {
            let fault = text.parse::<Within>().unwrap_err();
            assert!(fault.contains("74..76") && fault.contains("2%"), "{fault}");
        }
        for text in ["0", "-1", "0%", "inf", "NaN%"] {
            let fault = text.parse::<Within>().unwrap_err();
            assert!(fault.contains("above zero"), "{text}: {fault}");
        }
    }

    #[test]
    fn a_range_moves_the_start_to_its_middle() {
        let declared = hitch_model_file::nominal();
        let bore_mm = 1e3 * declared.constants().cylinder.bore_m;
        let (low, high) = (1.1 * bore_mm, 1.2 * bore_mm);
        let known = within("cylinder.bore_mm", &format!("{low}..{high}"));
        let (_, model) = known.applied_to(declared.clone()).unwrap();
        let start_mm = 1e3 * model.constants().cylinder.bore_m;
        assert!((start_mm - (low * high).sqrt()).abs() < 1e-9, "{start_mm}");
        let known = within("cylinder.bore_mm", "2%");
        let (_, model) = known.applied_to(declared).unwrap();
        assert_eq!(1e3 * model.constants().cylinder.bore_m, bore_mm);
    }

    #[test]
    fn each_fault_has_its_constant() {
        let known = KnownConstants {
            hold: ["cylinder.boer", "oil.viscosity", "masses.dead_weight_kg"]
                .map(str::to_owned)
                .to_vec(),
            within: [
                ("cylinder.bore_mm", "76..74"),
                ("lift_valve.flow_lpm", "3..4"),
                ("lower_valve.flow_lpm", "3"),
                ("relief_valve.set_pressure_bar", "about 200"),
                ("masses.dead_weight_kg", "2%"),
                ("linkage.rocker_arm_m", "50..60"),
                ("check_valve.cracking_pressure_bar", "20 %"),
            ]
            .map(|(name, text)| (name.to_owned(), text.to_owned()))
            .to_vec(),
        };
        let model = hitch_model_file::nominal();
        let faults = known.faults(&model);
        let said: Vec<(&str, &str)> = faults
            .iter()
            .map(|fault| (fault.name.as_str(), fault.what.as_str()))
            .collect();
        println!("{said:#?}");
        let words = [
            ("cylinder.boer", "cylinder.bore_mm"),
            ("oil.viscosity", "there are"),
            ("cylinder.bore_mm", "rising"),
            ("lift_valve.flow_lpm", "percent"),
            ("lower_valve.flow_lpm", "percent"),
            ("relief_valve.set_pressure_bar", "about 200"),
            ("masses.dead_weight_kg", "twice"),
            ("linkage.rocker_arm_m", "no linkage"),
        ];
        assert_eq!(said.len(), words.len());
        for ((name, what), (of, word)) in said.into_iter().zip(words) {
            assert!(name == of && what.contains(word), "{name}: {what}");
        }
        assert!(known.applied_to(model).is_err());
    }
}

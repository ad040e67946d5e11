//! A commented model file, to be filled in from data sheets.

use std::fmt::Write as _;

use hitch_input::input_error::InputError;
use hitch_input::naming::offer_names;
use hitch_input::source_file::SourceFile;
use hitch_plant::{Constants, LinkageTable, Model, PumpKind, Valve, ValveCurve};

use crate::constants::{
    CONSTANTS, CYLINDER_COUNT, Constant, Had, KINDS, TABLES, Variant, clear_others,
};
use crate::meaning::meaning_of;
use crate::quoted::quoted;
use crate::round_trip::decimal;
use crate::write::{dynamics_name, kind_name, table_lines};

/// Name of the pump's kind.
const PUMP_KIND: &str = "pump.kind";
/// Name of the number of cylinders.
const CYLINDER_NUMBER: &str = "cylinder.cylinders";
/// Usual standby pressure of a load-sensing pump, Pa.
const USUAL_STANDBY_PA: f64 = 20e5;
/// Usual time constant of a load-sensing pump, s.
const USUAL_RESPONSE_S: f64 = 0.05;

const HEAD: &str = "\
# Model of an electro-hydraulic tractor hitch. Replace the values by those of your data sheets.
# hitch compare CAMPAIGN --model THIS-FILE   shows how well it agrees with a campaign
# hitch model fit CAMPAIGN --model THIS-FILE --out FITTED-FILE   estimates the constants from a campaign
";

/// A model file under construction.
#[derive(Debug, Clone)]
pub struct Template {
    name: String,
    constants: Constants,
}

impl Template {
    /// A template with the constants of a model.
    #[must_use]
    pub fn of(name: &str, model: &Model) -> Self {
        Self {
            name: name.to_owned(),
            constants: model.constants().clone(),
        }
    }

    /// Value of a constant in the unit of its key, as written in a model file.
    ///
    /// # Errors
    /// There is no such constant: the fault and a suggested correction.
    pub fn get(&self, name: &str) -> Result<String, String> {
        match name {
            PUMP_KIND => return Ok(kind_name(self.constants.pump.kind).to_owned()),
            CYLINDER_NUMBER => return Ok(self.constants.cylinder.count.to_string()),
            _ => {}
        }
        let constant = self.find(name)?;
        let value = *(constant.place)(&mut self.constants.clone());
        Ok(decimal(value, constant.unit))
    }

    /// Sets a constant, `table.key`, in the unit of its key.
    ///
    /// # Errors
    /// There is no such constant, or the value is out of range: the fault and a suggested correction.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), String> {
        match name {
            PUMP_KIND => return self.set_pump_kind(value.trim()),
            CYLINDER_NUMBER => return self.set_cylinders(value.trim()),
            _ => {}
        }
        let constant = self.find(name)?;
        let number = value.trim().replace(',', ".").parse::<f64>().ok();
        match number.filter(|number| constant.range.contains(number)) {
            Some(number) => {
                *(constant.place)(&mut self.constants) = number * constant.unit;
                Ok(())
            }
            None => {
                let (low, high) = (constant.range.start(), constant.range.end());
                Err(format!(
                    "{name} is {value:?}; it is a number from {low} to {high}"
                ))
            }
        }
    }

    /// Chooses the kind of the pump; a load-sensing one starts with usual values.
    fn set_pump_kind(&mut self, value: &str) -> Result<(), String> {
        let Some((_, kind)) = KINDS.iter().find(|(written, _)| *written == value) else {
            return Err(format!(
                "{PUMP_KIND} is {value:?}; it is fixed-displacement or load-sensing"
            ));
        };
        let pump = &mut self.constants.pump;
        if *kind == PumpKind::LoadSensing && pump.kind != *kind {
            pump.standby_pressure_pa = USUAL_STANDBY_PA;
            pump.response_time_s = USUAL_RESPONSE_S;
        }
        pump.kind = *kind;
        clear_others(&mut self.constants);
        Ok(())
    }

    fn set_cylinders(&mut self, value: &str) -> Result<(), String> {
        let number = value.parse::<u8>().ok();
        let known = number.filter(|count| CYLINDER_COUNT.contains(&f64::from(*count)));
        self.constants.cylinder.count =
            known.ok_or_else(|| format!("{CYLINDER_NUMBER} is {value:?}; it is 1 to 4"))?;
        Ok(())
    }

    /// Replaces the dimensions of the linkage by a measured one, whose travel ends at the stroke.
    pub fn set_linkage(&mut self, linkage: LinkageTable) {
        self.constants.cylinder.stroke_m = linkage.span_m().1;
        self.constants.linkage_table = Some(linkage);
        clear_others(&mut self.constants);
    }

    /// The constant with the name `table.key`, if the machine has it.
    fn find(&self, name: &str) -> Result<&'static Constant, String> {
        let constant = find(name)?;
        match (constant.had, Variant::of(&self.constants).has(constant)) {
            (_, true) => Ok(constant),
            (Had::LoadSensing, _) => Err(format!(
                "{name} is of a load-sensing pump; set {PUMP_KIND}=load-sensing first"
            )),
            _ => Err(format!("{name} is replaced by the measured linkage")),
        }
    }

    /// The flow curve of a valve.
    #[must_use]
    pub fn curve(&self, valve: Valve) -> &ValveCurve {
        &valve.of(&self.constants).curve
    }

    /// Sets the flow curve of a valve.
    pub fn set_curve(&mut self, valve: Valve, curve: ValveCurve) {
        valve.of_mut(&mut self.constants).curve = curve;
    }

    /// The text of the model file.
    ///
    /// # Errors
    /// The constants do not form a valid model, with line and column of the text.
    pub fn text(&self) -> Result<String, InputError> {
        let text = self.written();
        crate::parse(&SourceFile {
            path: "model file".into(),
            text: text.clone(),
        })?;
        Ok(text)
    }

    /// The text. Writing to a string cannot fail, so the results are ignored.
    fn written(&self) -> String {
        let dynamics = dynamics_name(self.constants.dynamics);
        let mut text = format!(
            "{HEAD}format = 1\nname = {}\n# steady: no inertia, stiff oil; dynamic: spool lag, compressible oil, inertia.\ndynamics = \"{dynamics}\"\n",
            quoted(&self.name)
        );
        for table in TABLES {
            if let Some(meaning) = meaning_of(table, "") {
                let _ = write!(text, "\n# {}", meaning.what);
            }
            let _ = write!(text, "\n[{table}]\n");
            for (key, line) in table_lines(&self.constants, table, true) {
                comment(&mut text, table, key);
                text += &line;
            }
        }
        text
    }
}

fn comment(text: &mut String, table: &str, key: &str) {
    if let Some(meaning) = meaning_of(table, key) {
        let _ = writeln!(text, "# {}. {}.", meaning.what, meaning.found);
    }
}

/// The constant with the name `table.key`.
fn find(name: &str) -> Result<&'static Constant, String> {
    let mut all = CONSTANTS.iter();
    all.find(|constant| constant.name() == name).ok_or_else(|| {
        let known: Vec<String> = CONSTANTS.iter().map(Constant::name).collect();
        let known = known.iter().map(String::as_str);
        let known: Vec<&str> = known.chain([PUMP_KIND, CYLINDER_NUMBER]).collect();
        format!(
            "there is no constant {name:?}; {}",
            offer_names(name, &known)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    #[test]
    fn every_constant_has_a_meaning() {
        for table in TABLES {
            assert!(meaning_of(table, "").is_some(), "{table}");
            for measured_linkage in [false, true] {
                let variant = Variant {
                    load_sensing: true,
                    measured_linkage,
                };
                for key in variant.keys(table) {
                    assert!(meaning_of(table, key).is_some(), "{table}.{key}");
                }
            }
        }
    }

    #[test]
    fn a_template_is_the_model_that_it_was_made_of() {
        for model in [crate::nominal(), crate::dynamic()] {
            let text = Template::of("copy", &model).text().expect("a sound file");
            let read = crate::parse(&SourceFile {
                path: "copy.toml".into(),
                text,
            });
            assert_eq!(
                read.expect("a sound file").constants(),
                model.constants(),
                "{}",
                model.name
            );
        }
    }

    #[test]
    fn wrong_values_are_refused_with_what_would_do() {
        let mut template = Template::of("new", &crate::nominal());
        assert_eq!(template.set("cylinder.bore_mm", "80,5"), Ok(()));
        assert_eq!(template.get("cylinder.bore_mm").as_deref(), Ok("80.5"));
        let said = template.set("cylinder.bore_mm", "1").unwrap_err();
        assert!(said.ends_with("a number from 5 to 1000"), "{said}");
        let said = template.set("cylinder.boar_mm", "80").unwrap_err();
        assert!(said.contains("cylinder.bore_mm"), "{said}");
    }
}

//! Own tolerances of constants, from the command line.

use hitch_identification::constants::tolerances::Tolerances;
use hitch_plant::Model;

use super::known_constants::{KnownConstants, Within};
use hitch_output::error::Error;

/// Arguments of a fit of constants.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct ToleranceArgs {
    /// Constant that is exact, by its name in the model file; several times for several
    #[arg(long, value_name = "TABLE.KEY")]
    hold: Vec<String>,
    /// Own tolerance of a constant, one standard deviation: in percent, or in the unit of its key (cylinder.bore_mm=0.5)
    #[arg(long, value_name = "TABLE.KEY=VALUE[%]")]
    tolerance: Vec<String>,
    /// Keep a constant between two values in the unit of its key; the fit starts in their middle (cylinder.bore_mm=74..76)
    #[arg(long, value_name = "TABLE.KEY=LOW..HIGH")]
    bound: Vec<String>,
}

impl ToleranceArgs {
    /// The tolerances, and the model with its bounded constants in the middle of their bounds.
    ///
    /// # Errors
    /// If a constant is not known, or a value is not one.
    pub fn applied_to(&self, model: Model) -> Result<(Tolerances, Model), Error> {
        self.known()?.applied_to(model)
    }

    /// What the arguments say of constants.
    fn known(&self) -> Result<KnownConstants, Error> {
        let tolerance = |text: &String| {
            let (name, value) = parts(text, "--tolerance", "NAME=VALUE or NAME=SHARE%")?;
            match value.parse() {
                Ok(Within::Range(_)) => Err(Error::Usage(format!(
                    "--tolerance {text}: {value} is a range; give it with --bound"
                ))),
                Ok(Within::Tolerance(_)) => Ok((name.to_owned(), value.to_owned())),
                Err(what) => Err(Error::Usage(format!("--tolerance {text}: {what}"))),
            }
        };
        let bound = |text: &String| {
            let (name, value) = parts(text, "--bound", "NAME=LOW..HIGH")?;
            match value.parse() {
                Ok(Within::Range(_)) => Ok((name.to_owned(), value.to_owned())),
                _ => Err(Error::Usage(format!(
                    "--bound {text}: {value} is not LOW..HIGH"
                ))),
            }
        };
        let tolerances = self.tolerance.iter().map(tolerance);
        let within = tolerances.chain(self.bound.iter().map(bound));
        Ok(KnownConstants {
            hold: self.hold.clone(),
            within: within.collect::<Result<_, Error>>()?,
        })
    }
}

/// Name and value of an argument.
fn parts<'a>(text: &'a str, argument: &str, form: &str) -> Result<(&'a str, &'a str), Error> {
    let parts = text.split_once('=');
    parts.ok_or_else(|| Error::Usage(format!("{argument} {text}: the form is {form}")))
}

//! Own tolerances of constants, from the command line.

use hitch_identification::constants::tolerances::{Own, Tolerances};
use hitch_plant::Model;

use crate::error::Error;

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
        let (mut own, mut model) = (Tolerances::default(), model);
        for name in &self.hold {
            own.hold(name, model.constants()).map_err(of("--hold"))?;
        }
        for text in &self.tolerance {
            let (name, value) = parts(text, "--tolerance", "NAME=VALUE or NAME=SHARE%")?;
            let value = tolerance(value).ok_or_else(|| {
                Error::Usage(format!(
                    "--tolerance {text}: {value} is not a number above zero; --hold makes a constant exact"
                ))
            })?;
            let sigma = Tolerances::sigma_of(name, value, model.constants());
            own.set(name, sigma.map_err(of("--tolerance"))?);
        }
        for text in &self.bound {
            let (name, range) = parts(text, "--bound", "NAME=LOW..HIGH")?;
            let bounds = range.split_once("..").and_then(|(low, high)| {
                Some([low.trim().parse().ok()?, high.trim().parse().ok()?])
            });
            let bounds = bounds
                .ok_or_else(|| Error::Usage(format!("--bound {text}: {range} is not LOW..HIGH")))?;
            model = own.bound(name, bounds, &model).map_err(of("--bound"))?;
        }
        Ok((own, model))
    }
}

/// Name and value of an argument.
fn parts<'a>(text: &'a str, argument: &str, form: &str) -> Result<(&'a str, &'a str), Error> {
    let parts = text.split_once('=');
    parts.ok_or_else(|| Error::Usage(format!("{argument} {text}: the form is {form}")))
}

/// A tolerance above zero.
fn tolerance(text: &str) -> Option<Own> {
    let (number, is_share) = match text.trim().strip_suffix('%') {
        Some(share) => (share, true),
        None => (text, false),
    };
    let number: f64 = number.trim().parse().ok()?;
    let is_sound = number.is_finite() && number > 0.0;
    is_sound.then_some(if is_share {
        Own::Share(0.01 * number)
    } else {
        Own::Value(number)
    })
}

/// A fault of an argument.
fn of(argument: &'static str) -> impl Fn(String) -> Error {
    move |what| Error::Usage(format!("{argument} {what}"))
}

//! Constants of a model that a fit holds, as they are exact.

use hitch_identification::constants::parameter::parameters;
use hitch_plant::Model;

use crate::error::Error;

/// The option for constants that are exact.
#[derive(Debug, Clone, clap::Args)]
pub struct HoldArg {
    /// Constant that is exact, by its name in the model file; several times for several
    #[arg(long, value_name = "TABLE.KEY")]
    hold: Vec<String>,
}

impl HoldArg {
    /// The constants, if a fit of the model moves each of them.
    ///
    /// # Errors
    /// If one of them is not among those that are fitted.
    pub fn of(&self, model: &Model) -> Result<&[String], Error> {
        check(&self.hold, model)?;
        Ok(&self.hold)
    }
}

/// Names of the constants that a fit of the model moves, each once: `table.key`.
#[must_use]
pub fn fitted_names(model: &Model) -> Vec<String> {
    let mut known: Vec<String> = Vec::new();
    for parameter in parameters(model.constants()) {
        known.extend(parameter.name().filter(|name| !known.contains(name)));
    }
    known
}

/// Whether a fit of the model moves all these constants.
///
/// # Errors
/// If one of them is not among those that are fitted.
pub fn check(held: &[String], model: &Model) -> Result<(), Error> {
    let known = fitted_names(model);
    let unknown = held.iter().find(|name| !known.contains(name));
    unknown.map_or(Ok(()), |name| {
        Err(Error::Usage(format!(
            "--hold {name}: no constant that is fitted; there are {}",
            known.join(", ")
        )))
    })
}

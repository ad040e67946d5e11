//! The `[[run]]` block of a run, as a manifest is written.

use std::fmt;

use hitch_campaign::Bench;
use hitch_model_file::quoted;

/// The description of a run in `campaign.toml`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunBlock<'r> {
    /// Its log, relative to the campaign's folder or absolute.
    pub file: &'r str,
    /// The files in which its recording continues.
    pub then: &'r [String],
    /// Its test stand.
    pub bench: Bench,
    /// Its oil temperature, degrees Celsius; `None` if it is not known.
    pub oil_temperature_c: Option<f64>,
    /// Its begin and end after the first sample of the log, s; `None` for the whole log.
    pub span_s: Option<(f64, f64)>,
}

impl fmt::Display for RunBlock<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "\n[[run]]\nfile = {}", quoted(self.file))?;
        match self.bench {
            Bench::Hitch { load_kg } => writeln!(f, "bench = \"hitch\"\nload_kg = {load_kg}")?,
            Bench::Flow { port_pressure_bar } => {
                writeln!(
                    f,
                    "bench = \"flow\"\nport_pressure_bar = {port_pressure_bar}"
                )?;
            }
        }
        if let Some(oil_temperature_c) = self.oil_temperature_c {
            writeln!(f, "oil_temperature_c = {oil_temperature_c:?}")?;
        }
        if !self.then.is_empty() {
            let then: Vec<String> = self.then.iter().map(|file| quoted(file)).collect();
            writeln!(f, "then = [{}]", then.join(", "))?;
        }
        if let Some((from_s, to_s)) = self.span_s {
            writeln!(f, "from_s = {from_s}\nto_s = {to_s}")?;
        }
        Ok(())
    }
}

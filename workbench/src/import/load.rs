//! The test stand of an imported log.

use std::path::Path;

/// Bench of a log, with its load or pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Conditions {
    /// At the hitch.
    Hitch {
        /// Load, kg.
        load_kg: f64,
    },
    /// On the flow bench.
    Flow {
        /// Pressure at the cylinder port, bar.
        port_pressure_bar: f64,
    },
}

impl Conditions {
    /// The lines of a run that state them.
    #[must_use]
    pub fn lines(self) -> String {
        match self {
            Self::Hitch { load_kg } => format!("bench = \"hitch\"\nload_kg = {load_kg}\n"),
            Self::Flow { port_pressure_bar } => {
                format!("bench = \"flow\"\nport_pressure_bar = {port_pressure_bar}\n")
            }
        }
    }
}

/// The load in the name of a log: 150 kg in `lift_150kg.csv`.
#[must_use]
pub fn load_in_name(log: &Path) -> Option<f64> {
    let lower = log.file_stem()?.to_string_lossy().to_ascii_lowercase();
    let before = lower.split_once("kg")?.0.trim_end_matches([' ', '_']);
    let digits = before
        .rfind(|c: char| !c.is_ascii_digit() && c != '.')
        .map_or(0, |last| last + 1);
    before.get(digits..)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loads_stand_in_names() {
        let load = |name: &str| load_in_name(Path::new(name));
        assert_eq!(load("logs/lift_1.5A_050kg.csv"), Some(50.0));
        assert_eq!(load("150 kg heben.mf4"), Some(150.0));
        assert_eq!(load("monday.csv"), None);
        assert_eq!(load("kg.csv"), None);
    }
}

//! The load of an imported log.

use std::path::Path;

/// Loads in the name of a log, kg, each once: 150 in `lift_150kg.csv`, 50.5 in `lift_50,5kg.csv`, two in `50kg_150kg.csv`.
#[must_use]
pub fn loads_in_name(log: &Path) -> Vec<f64> {
    let name = log.file_stem().unwrap_or_default().to_string_lossy();
    let lower = name.to_ascii_lowercase();
    let mut loads = Vec::new();
    for (at, _) in lower.match_indices("kg") {
        let before = lower[..at].trim_end_matches([' ', '_']);
        let is_of_number = |c: char| c.is_ascii_digit() || c == '.' || c == ',';
        let digits = before.trim_end_matches(is_of_number).len();
        let number = before[digits..].trim_start_matches(['.', ',']);
        if let Ok(load_kg) = number.replace(',', ".").parse::<f64>()
            && !loads.contains(&load_kg)
        {
            loads.push(load_kg);
        }
    }
    loads
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loads_stand_in_names() {
        let loads = |name: &str| loads_in_name(Path::new(name));
        assert_eq!(loads("logs/lift_1.5A_050kg.csv"), [50.0]);
        assert_eq!(loads("150 kg heben.mf4"), [150.0]);
        assert_eq!(loads("lift_50,5kg.csv"), [50.5]);
        assert_eq!(loads("lift_50.5kg.csv"), [50.5]);
        assert_eq!(loads("lift_50kg_150kg.csv"), [50.0, 150.0]);
        assert_eq!(loads("50kg_again_50kg.csv"), [50.0]);
        assert_eq!(loads("1,5A,50kg.csv"), [50.0]);
        assert_eq!(loads("1.234,5kg.csv"), Vec::<f64>::new());
        assert_eq!(loads("monday.csv"), Vec::<f64>::new());
        assert_eq!(loads("kg.csv"), Vec::<f64>::new());
    }
}

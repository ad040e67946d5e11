//! The load of an imported log.

use std::path::Path;

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

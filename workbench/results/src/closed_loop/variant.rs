//! Variants of a calibration: named sets of settings.

use std::str::FromStr;

/// Name of the calibration that the variants start from.
pub const BASE: &str = "base";
/// Largest number of variants: a picture has a colour for each.
pub const MOST_VARIANTS: usize = 5;

/// A variant, as `NAME:group.key=value,group.key=value`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Variant {
    /// Its name.
    pub name: String,
    /// Settings, as `group.key=value`.
    pub settings: Vec<String>,
}

impl FromStr for Variant {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let form =
            "give a name and settings, as in soft:position.approach_gain=30,position.creep_speed=3";
        let (name, settings) = text.split_once(':').ok_or(form)?;
        let name = name.trim();
        if name.is_empty() || name.contains('=') {
            return Err(form.to_owned());
        }
        if name == BASE {
            return Err(format!(
                "{BASE:?} names the calibration without variant: choose another name"
            ));
        }
        let settings: Vec<String> = settings
            .split(',')
            .map(|one| one.trim().to_owned())
            .collect();
        if settings.iter().all(|setting| setting.contains('=')) {
            Ok(Self {
                name: name.to_owned(),
                settings,
            })
        } else {
            Err(form.to_owned())
        }
    }
}

/// Rejects variants with one name, and too many of them.
///
/// # Errors
/// What is wrong, and how to correct it.
pub fn check(variants: &[Variant]) -> Result<(), String> {
    if variants.len() > MOST_VARIANTS {
        return Err(format!(
            "{} variants are too many for one picture: give at most {MOST_VARIANTS}",
            variants.len()
        ));
    }
    let mut names: Vec<&str> = variants
        .iter()
        .map(|variant| variant.name.as_str())
        .collect();
    names.sort_unstable();
    match names.windows(2).find(|two| two[0] == two[1]) {
        Some(two) => Err(format!("the name {:?} is used twice: rename one", two[0])),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_variant_has_a_name_and_settings() {
        let soft: Variant = "soft: position.creep_speed=3, rate.trim_time=500"
            .parse()
            .unwrap();
        assert_eq!(soft.name, "soft");
        assert_eq!(
            soft.settings,
            ["position.creep_speed=3", "rate.trim_time=500"]
        );
        for bad in [
            "soft",
            "soft:",
            ":a.b=1",
            "a.b=1",
            "base:a.b=1",
            "soft:a.b=1,",
            "a.b=1:c.d=2",
        ] {
            assert!(bad.parse::<Variant>().is_err(), "{bad}");
        }
    }

    #[test]
    fn names_differ_and_a_picture_has_room() {
        let of = |names: &[&str]| -> Vec<Variant> {
            let variant = |name: &&str| format!("{name}:a.b=1").parse().unwrap();
            names.iter().map(variant).collect()
        };
        assert!(check(&of(&["a", "b"])).is_ok());
        assert!(check(&of(&["a", "b", "a"])).unwrap_err().contains("\"a\""));
        assert!(check(&of(&["a", "b", "c", "d", "e", "f"])).is_err());
    }
}

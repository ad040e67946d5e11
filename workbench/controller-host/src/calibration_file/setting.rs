//! Single scalars of a calibration, set by name on the command line: `position.approach_gain=30`.

use hitch_input::input_error::{InputError, quote};
use hitch_input::naming::offer_names;
use hitch_quantities::calibration::parameter::{ParameterGroup, ParameterInfo};
use hitch_quantities::{Calibration, ValidCalibration};

use super::key::{is_exact, key};
use super::objection::objection;

/// A scalar in engineering units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scalar {
    /// Its value.
    pub value: f64,
    /// Smallest allowed value.
    pub low: f64,
    /// Largest allowed value.
    pub high: f64,
    /// Suffix of the unit.
    pub suffix: &'static str,
}

impl Scalar {
    fn of(info: &ParameterInfo, counts: i32) -> Self {
        let unit = |raw: i32| f64::from(raw) / f64::from(info.counts_per_unit);
        Self {
            value: unit(counts),
            low: unit(info.min),
            high: unit(info.max),
            suffix: info.suffix,
        }
    }
}

/// Common alternative names of scalars: group, alternative, name.
const ALSO_CALLED: [(&str, &str, &str); 1] = [("position", "kp", "approach_gain")];

/// The calibration with settings from the command line, validated again.
///
/// # Errors
/// The fault of the first invalid setting, or of their combination.
pub fn with_settings(
    calibration: &Calibration,
    settings: &[String],
) -> Result<ValidCalibration, String> {
    let mut changed = calibration.clone();
    for setting in settings {
        set(&mut changed, setting)?;
    }
    changed.sealed().validate().map_err(|error| {
        let (_, what, hint) = objection(error);
        format!("{what}; {hint}")
    })
}

/// Sets one scalar, named with or without its unit or by an alternative name; returns its name without unit.
///
/// # Errors
/// The fault of the setting.
pub fn set(calibration: &mut Calibration, setting: &str) -> Result<String, String> {
    let parsed = setting.split_once('=').and_then(|(path, value)| {
        let (group, name) = path.trim().split_once('.')?;
        Some((group, name, value.trim()))
    });
    let Some((group, name, value)) = parsed else {
        let what = quote(setting);
        return Err(format!(
            "{what} does not have the form position.approach_gain=30"
        ));
    };
    let ours = ALSO_CALLED
        .iter()
        .find(|&&(of, theirs, _)| (of, theirs) == (group, name));
    let name = ours.map_or(name, |&(_, _, ours)| ours);
    let Ok(value) = value.parse::<f64>() else {
        let what = quote(value);
        return Err(format!("{what} is not a number; {group}.{name} is numeric"));
    };
    let mut found = None;
    visit_scalars(calibration, &mut |of, info, counts| {
        if of == group && (info.name == name || key(info) == name) {
            let raw = (value * f64::from(info.counts_per_unit)).round();
            let in_range = (f64::from(info.min)..=f64::from(info.max)).contains(&raw);
            if in_range && is_exact(info, value) {
                *counts = raw as i32;
            }
            found = Some((*info, in_range));
        }
    });
    match found {
        Some((info, true)) if !is_exact(&info, value) => Err(format!(
            "{group}.{} = {value} is not an integer; write for example {value:.0}",
            key(&info)
        )),
        Some((info, true)) => Ok(format!("{group}.{}", info.name)),
        Some((info, false)) => {
            let Scalar { low, high, .. } = Scalar::of(&info, info.nominal);
            let key = key(&info);
            Err(format!(
                "{group}.{key} = {value:?} is out of range; the range is {low} to {high}"
            ))
        }
        None => Err(unknown(calibration, group, name)),
    }
}

/// The message for an unknown name, with the most similar names.
fn unknown(calibration: &mut Calibration, group: &str, name: &str) -> String {
    let (mut groups, mut names) = (Vec::new(), Vec::new());
    visit_scalars(calibration, &mut |of, info, _| {
        if groups.last() != Some(&of) {
            groups.push(of);
        }
        if of == group {
            names.push(info.name);
        }
    });
    let offer = if names.is_empty() {
        offer_names(group, &groups)
    } else {
        offer_names(name, &names)
    };
    let what = quote(&format!("{group}.{name}"));
    format!("there is no {what}; {offer}")
}

/// The scalar `group.name`, if it exists.
#[must_use]
pub fn scalar(calibration: &Calibration, path: &str) -> Option<Scalar> {
    let (group, name) = path.split_once('.')?;
    let mut found = None;
    visit_scalars(&mut calibration.clone(), &mut |of, info, counts| {
        if of == group && info.name == name {
            found = Some(Scalar::of(info, *counts));
        }
    });
    found
}

/// Callback of [`visit_scalars`]: group name, scalar, and its counts.
pub(super) type Visit<'v> = &'v mut dyn FnMut(&'static str, &ParameterInfo, &mut i32);

/// Visits every scalar.
pub(super) fn visit_scalars(calibration: &mut Calibration, visit: Visit<'_>) {
    // The visitors share their signature with those that can fail.
    let _ = visit_groups(calibration, visit);
}

fn visit_groups(calibration: &mut Calibration, visit: Visit<'_>) -> Result<(), InputError> {
    with_groups!(calibration, visit_group, visit);
    Ok(())
}

#[allow(
    clippy::unnecessary_wraps,
    reason = "shares its signature with the visitors that can fail"
)]
fn visit_group<G: ParameterGroup>(group: &mut G, visit: Visit<'_>) -> Result<(), InputError> {
    for (index, info) in G::INFO.iter().enumerate() {
        let mut counts = group.get(index).unwrap_or(info.nominal);
        visit(G::NAME, info, &mut counts);
        group.set(index, counts);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_reach_their_scalar_or_say_why_not() {
        let mut calibration = Calibration::nominal();
        set(&mut calibration, "position.approach_gain=31").unwrap();
        let name = set(&mut calibration, "position.restart_band_mm = 0.5").unwrap();
        assert_eq!(name, "position.restart_band");
        assert_eq!(calibration.position.approach_gain.0, 31);
        assert_eq!(calibration.position.restart_band.0, 500);
        let name = set(&mut calibration, "position.kp=32").unwrap();
        assert_eq!(name, "position.approach_gain", "what others call it");
        assert_eq!(calibration.position.approach_gain.0, 32);
        for (bad, said) in [
            ("kp=3", "does not have the form"),
            (
                "position.ki=3",
                "there is no \"position.ki\"; known: lower_limit, ",
            ),
            ("rate.kp=3", "there is no \"rate.kp\""),
            ("position.aproach_gain=3", "did you mean approach_gain?"),
            ("postion.approach_gain=3", "did you mean position?"),
            ("position.approach_gain=x", "is not a number"),
            (
                "position.approach_gain=1e9",
                "position.approach_gain_per_s = 1000000000.0 is out of range; the range is 1 to 200",
            ),
            (
                "hold.corrections=5.5",
                "hold.corrections_count = 5.5 is not an integer",
            ),
            ("position.approach_gain=NaN", "is out of range"),
            ("position.approach_gain=1e300", "= 1e300 is out of range"),
        ] {
            let error = set(&mut calibration, bad).unwrap_err();
            assert!(error.contains(said), "{bad}: {error}");
        }
    }

    #[test]
    fn settings_that_contradict_each_other_are_refused() {
        let crossed = ["position.upper_limit=60", "position.lower_limit=120"].map(str::to_owned);
        let error = with_settings(&Calibration::nominal(), &crossed).map(drop);
        let said = "lower_limit of [position] is not below upper_limit; exchange them";
        assert_eq!(error, Err(said.to_owned()));
    }
}

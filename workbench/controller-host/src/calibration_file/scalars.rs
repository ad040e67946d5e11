//! The scalars of a calibration as written to a file, each with the reason for its value.

use std::fmt::Write as _;

use hitch_quantities::Calibration;
use hitch_quantities::calibration::parameter::ParameterInfo;

use super::key::key;
use super::setting::visit_scalars;

/// Writes all scalars; those that differ from `before` are marked as tuned. (Writing to a string cannot fail.)
pub fn write_scalars(calibration: &Calibration, before: Option<&Calibration>, text: &mut String) {
    let mut counts_before = Vec::new();
    let before = before.unwrap_or(calibration);
    visit_scalars(&mut before.clone(), &mut |_, _, counts| {
        counts_before.push(*counts)
    });
    let mut counts_before = counts_before.into_iter();
    let mut section = "";
    visit_scalars(&mut calibration.clone(), &mut |group, info, counts| {
        if group != section {
            let _ = write!(text, "\n[{group}]\n");
            section = group;
        }
        let was_tuned = counts_before.next().is_some_and(|before| before != *counts);
        let value = in_units(info, *counts);
        let reason = reason(info, *counts, was_tuned);
        let _ = write!(text, "#{reason}\n{} = {value:?}\n", key(info));
    });
}

/// The reason for the value of a scalar; it applies to the default value only.
fn reason(info: &ParameterInfo, counts: i32, was_tuned: bool) -> String {
    if counts == info.nominal {
        return info.reason.to_owned();
    }
    let by_whom = if was_tuned { "tuned" } else { "changed" };
    let [default, low, high] =
        [info.nominal, info.min, info.max].map(|counts| in_units(info, counts));
    format!(
        " {by_whom} ({low} to {high}); default {default}:{}",
        info.reason
    )
}

fn in_units(info: &ParameterInfo, counts: i32) -> f64 {
    f64::from(counts) / f64::from(info.counts_per_unit)
}

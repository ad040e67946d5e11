//! Values of draft and depth control that follow from an implement in its soil and the linkage.
//!
//! * The links change the depth by `k = dh/dα`, the mean over the lower half of the travel, where implements work.
//! * Draft over angle is the draft of a cm of depth times `k`.
//! * At its crossover `f` the loop moves the hitch like a sine of frequency `f`. Its largest deviation from the lever, `draft.margin`
//!   `a`, needs the speed `2π f a`; the slower of lifting and lowering has to reach it: `f ≤ v / (2π a)`.

use std::f64::consts::TAU;

use hitch_plant::Model;
use hitch_quantities::units::{
    Micrometre, MilliHertz, MillimetrePerSecond, Newton, NewtonPerDegree,
};
use hitch_quantities::{Calibration, ValidCalibration};

use super::CalibrateError;

/// Part of the working draft above which the implement counts as in the soil: that of the default, 1.5 of 18 kN.
const IN_SOIL: f64 = 1.0 / 12.0;

/// An implement at work.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorkingDraft {
    /// Draft of a cm of depth, N/cm.
    pub per_cm_n: f64,
    /// Draft at the usual depth, N.
    pub mean_n: f64,
    /// Usual speed, m/s.
    pub speed_m_s: f64,
}

/// The calibration with the values that follow from the implement, and a line for each: its name, the value before and after
/// it, its unit.
///
/// # Errors
/// The firmware refuses the result.
pub fn with_draft(
    model: &Model,
    calibration: &Calibration,
    work: &WorkingDraft,
) -> Result<(ValidCalibration, Vec<String>), CalibrateError> {
    let mut changed = calibration.clone();
    let depth_m = depth_per_degree_m(model, calibration);
    let whole = |value: f64| value.round() as i32;
    changed.depth.per_degree = Micrometre(whole(1e6 * depth_m));
    let draft = &mut changed.draft;
    draft.force_per_degree = NewtonPerDegree(whole(100.0 * depth_m * work.per_cm_n));
    draft.soil_draft = Newton(whole(IN_SOIL * work.mean_n));
    draft.assumed_speed = MillimetrePerSecond(whole(1e3 * work.speed_m_s));
    let margin_deg = 1e-3 * f64::from(draft.margin.0);
    if margin_deg > 0.0 {
        let fastest_hz = slower_deg_s(calibration) / (TAU * margin_deg);
        let reachable = MilliHertz(whole(1e3 * fastest_hz));
        draft.crossover = draft.crossover.min(reachable);
    }
    let (before, after) = (&calibration.draft, &changed.draft);
    let rows = [
        (
            "depth.per_degree",
            calibration.depth.per_degree.0,
            changed.depth.per_degree.0,
            "um/deg",
        ),
        (
            "draft.force_per_degree",
            before.force_per_degree.0,
            after.force_per_degree.0,
            "N/deg",
        ),
        (
            "draft.soil_draft",
            before.soil_draft.0,
            after.soil_draft.0,
            "N",
        ),
        (
            "draft.assumed_speed",
            before.assumed_speed.0,
            after.assumed_speed.0,
            "mm/s",
        ),
        (
            "draft.crossover",
            before.crossover.0,
            after.crossover.0,
            "mHz",
        ),
    ];
    let lines = rows.map(|(name, was, is, unit)| format!("{name}: {is} {unit} (was {was})"));
    let valid = changed
        .sealed()
        .validate()
        .map_err(CalibrateError::Refused)?;
    Ok((valid, lines.into()))
}

/// Depth per degree of the rocker, m: mean over the lower half of the travel.
fn depth_per_degree_m(model: &Model, calibration: &Calibration) -> f64 {
    let position = &calibration.position;
    let [low_deg, high_deg] =
        [position.lower_limit, position.upper_limit].map(|angle| 1e-3 * f64::from(angle.0));
    let middle_deg = 0.5 * (low_deg + high_deg);
    let linkage = model.linkage();
    let height_m = |deg: f64| linkage.at(linkage.piston_m(deg.to_radians())).height_m;
    (height_m(middle_deg) - height_m(low_deg)) / (middle_deg - low_deg)
}

/// The slower of the speeds of lifting and lowering with open valves, degree/s.
fn slower_deg_s(calibration: &Calibration) -> f64 {
    let tables = [&calibration.lift, &calibration.lower];
    let flows = tables.map(|table| f64::from(table.saturation().0));
    let slower_mm_s = flows.into_iter().fold(f64::INFINITY, f64::min)
        / f64::from(calibration.hydraulics.piston_area.0);
    // um/mdeg are mm/deg.
    slower_mm_s / super::travel_for_angle(&calibration.linkage)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn work(per_cm_n: f64) -> WorkingDraft {
        WorkingDraft {
            per_cm_n,
            mean_n: 18_000.0,
            speed_m_s: 1.8,
        }
    }

    /// The default is for 0.73 kN/cm at about 0.9 cm a degree.
    #[test]
    fn the_plough_of_the_defaults_gives_about_the_defaults() {
        let model = hitch_model_file::nominal();
        let base = Calibration::nominal();
        let (calibration, _) = with_draft(&model, &base, &work(730.0)).unwrap();
        let near = |is: i32, usual: i32| f64::from((is - usual).abs()) <= 0.2 * f64::from(usual);
        let (draft, usual) = (&calibration.draft, &base.draft);
        assert!(
            near(draft.force_per_degree.0, usual.force_per_degree.0),
            "{draft:?}"
        );
        assert!(near(
            calibration.depth.per_degree.0,
            base.depth.per_degree.0
        ));
        assert_eq!(draft.soil_draft, usual.soil_draft);
        assert_eq!(draft.assumed_speed, usual.assumed_speed);
        assert_eq!(
            draft.crossover, usual.crossover,
            "the valves are fast enough"
        );
    }

    /// A slow valve lowers the crossover in proportion, and twice the draft of a cm doubles the force of a degree.
    #[test]
    fn force_follows_the_implement_and_the_crossover_the_slower_valve() {
        let model = hitch_model_file::nominal();
        let mut base = Calibration::nominal();
        let of = |base: &Calibration, per_cm_n| {
            let (calibration, _) = with_draft(&model, base, &work(per_cm_n)).unwrap();
            (
                f64::from(calibration.draft.force_per_degree.0),
                f64::from(calibration.draft.crossover.0),
            )
        };
        let (once, twice) = (of(&base, 500.0).0, of(&base, 1000.0).0);
        assert!((twice / once - 2.0).abs() < 0.01, "{once} {twice}");
        let reach = 1e3 * slower_deg_s(&base) / (TAU * 5.0);
        base.draft.margin = hitch_quantities::units::MilliDegree(30_000);
        let (_, slow) = of(&base, 500.0);
        let expected = (reach / 6.0).min(300.0);
        assert!((slow - expected).abs() <= 1.0, "{slow} {expected}");
    }
}

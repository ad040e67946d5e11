//! Regime of the plant at a sample, determined from the log alone, so that models can be compared cell by cell.

use hitch_plant::Model;

use crate::data::conditioning::Drive;

/// Time after a valve was switched during which samples count as switching, s: spool lag and pressure oscillation occur
/// there.
const SWITCHING_S: f64 = 0.2;

/// Distance from an end of the swing that counts as near, rad.
const NEAR_END_RAD: f64 = 5.0 * std::f64::consts::PI / 180.0;

/// Regime of the plant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Regime {
    /// Both valves closed.
    Holding,
    /// A valve has just been opened or closed.
    Switching,
    /// Lift valve open.
    Lifting,
    /// Lowering valve open.
    Lowering,
    /// Any of these near an end of the stroke.
    NearEnd,
}

impl Regime {
    /// All regimes.
    pub const ALL: [Self; 5] = [
        Self::Holding,
        Self::Switching,
        Self::Lifting,
        Self::Lowering,
        Self::NearEnd,
    ];

    /// Name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Holding => "holding",
            Self::Switching => "switching",
            Self::Lifting => "lifting",
            Self::Lowering => "lowering",
            Self::NearEnd => "near the ends",
        }
    }
}

/// Regime of every sample of a run.
#[must_use]
pub fn regimes(model: &Model, drive: &Drive, rocker_angle_deg: Option<&[f64]>) -> Vec<Regime> {
    let lift_a = model.constants().lift_valve.curve.threshold_a();
    let lower_a = model.constants().lower_valve.curve.threshold_a();
    let (low_rad, high_rad) = model.linkage().swing_rad();
    let mut before = Regime::Holding;
    let mut switched_s = f64::NEG_INFINITY;
    let mut angle_rad = f64::NAN;
    drive
        .currents
        .iter()
        .enumerate()
        .map(|(sample, current)| {
            let now = if current.lift_a > lift_a {
                Regime::Lifting
            } else if current.lower_a > lower_a {
                Regime::Lowering
            } else {
                Regime::Holding
            };
            if now != before {
                switched_s = drive.time_s[sample];
                before = now;
            }
            // A row without an angle has the last measured one.
            if let Some(deg) = rocker_angle_deg
                .map(|deg| deg[sample])
                .filter(|deg| !deg.is_nan())
            {
                angle_rad = deg.to_radians();
            }
            if angle_rad < low_rad + NEAR_END_RAD || angle_rad > high_rad - NEAR_END_RAD {
                Regime::NearEnd
            } else if drive.time_s[sample] - switched_s < SWITCHING_S {
                Regime::Switching
            } else {
                now
            }
        })
        .collect()
}

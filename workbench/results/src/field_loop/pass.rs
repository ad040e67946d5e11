//! A pass over a field: the tractor drives off with a raised implement, lowers it, and works.

use std::fmt::{self, Display, Formatter};
use std::ops::RangeInclusive;

use hitch_field::draft::Texture;
use hitch_field::soil::SoilPlan;
use hitch_field::terrain::Terrain;
use hitch_field::tractor::TractorConstants;
use hitch_plant::Model;
use hitch_quantities::units::{Count, PerMille};
use hitch_quantities::{Calibration, Function, Inputs, ValidCalibration};
use rayon::prelude::*;

use super::figures::Figures;
use hitch_closed_loop::field::{FieldRig, FieldSample, LINK_DEPTH_M, RAISED_DEG, Settings};

/// Ground speed of the work, m/s.
pub const SPEED_M_S: f64 = 1.8;
/// Time of driving with the implement raised, s.
pub const RAISED_S: f64 = 10.0;
/// Time after the lever was lowered until the hitch works at its depth, s.
pub const ENTRY_S: f64 = 15.0;

/// The calibration of a machine with draft pins and slip guard.
///
/// # Panics
/// If it is not valid.
#[must_use]
pub fn fitted() -> ValidCalibration {
    fitted_with(|_| {})
}

/// The same with changes.
///
/// # Panics
/// If it is not valid.
#[must_use]
pub fn fitted_with(change: impl FnOnce(&mut Calibration)) -> ValidCalibration {
    let mut calibration = Calibration::nominal();
    calibration.draft.fitted = Count(1);
    calibration.slip.highest_limit = PerMille(300);
    change(&mut calibration);
    calibration.sealed().validate().expect("is valid")
}

/// A pass.
#[derive(Debug, Clone)]
pub struct Pass {
    /// Soil.
    pub soil: SoilPlan,
    /// Settings in the soil.
    pub settings: Settings,
    /// Depth of the links by the lever, m.
    pub link_depth_m: f64,
    /// Time of work after the entry, s.
    pub work_s: f64,
    /// Seed of soil and noise.
    pub seed: u64,
}

impl Pass {
    /// Drives the pass; the samples of the work after the entry. `tell` can modify the inputs at a time of work, s.
    #[must_use]
    pub fn drive(
        &self,
        model: &Model,
        calibration: &ValidCalibration,
        mut tell: impl FnMut(f64, &mut Inputs),
    ) -> Vec<FieldSample> {
        let constants = TractorConstants::ploughing();
        let field = (constants, self.soil.clone());
        let mut rig = FieldRig::new(model, calibration, field, Terrain::flat(), self.seed);
        let lever_deg = rig.coupling().angle_deg(self.link_depth_m);
        let mut drive = |from_s: f64, to_s: f64, lever_deg: f64| -> Vec<FieldSample> {
            ((from_s * 1e3) as i64..(to_s * 1e3) as i64)
                .map(|ms| {
                    let time_s = ms as f64 * 1e-3;
                    rig.step(lever_deg, SPEED_M_S, &self.settings, |inputs| {
                        tell(time_s, inputs);
                    })
                })
                .collect()
        };
        drive(-RAISED_S - ENTRY_S, -ENTRY_S, RAISED_DEG);
        drive(-ENTRY_S, 0.0, lever_deg);
        drive(0.0, self.work_s, lever_deg)
    }
}

/// Working depth of the passes, m.
pub const DEPTH_M: f64 = 0.25;
/// Draft at 25 cm in loam, N: set point of the passes.
pub const DRAFT_N: f64 = 18_200.0;

/// A function against position control in varying loam: means over seeds, a minute of work each.
#[derive(Debug, Clone, Copy)]
pub struct Comparison {
    /// The function; mix at 0.5.
    pub function: Function,
    /// Deviation of the draft over that of position control.
    pub draft_ratio: f64,
    /// The same of the draft through a low-pass of 3.2 Hz.
    pub filtered_ratio: f64,
    /// Deviation of the depth over its mean.
    pub depth_ratio: f64,
    /// Coil activations per minute.
    pub activations_per_min: f64,
}

impl Comparison {
    /// Drives all passes.
    #[must_use]
    pub fn of(
        model: &Model,
        function: Function,
        calibration: &ValidCalibration,
        seeds: RangeInclusive<u64>,
    ) -> Self {
        let figures = |function, seed| {
            let pass = Pass {
                soil: SoilPlan::varying(Texture::Medium),
                settings: Settings {
                    function,
                    draft_n: Some(DRAFT_N),
                    mix: Some(0.5),
                    ..Settings::default()
                },
                link_depth_m: LINK_DEPTH_M,
                work_s: 60.0,
                seed,
            };
            Figures::of(&pass.drive(model, calibration, |_, _| {}))
        };
        let pairs: Vec<[Figures; 2]> = seeds
            .into_par_iter()
            .map(|seed| [Function::Position, function].map(|function| figures(function, seed)))
            .collect();
        let mean = |of: fn(&Figures) -> f64, which: usize| {
            pairs.iter().map(|pair| of(&pair[which])).sum::<f64>() / pairs.len() as f64
        };
        let ratio = |of: fn(&Figures) -> f64| mean(of, 1) / mean(of, 0);
        Self {
            function,
            draft_ratio: ratio(|figures| figures.draft_n.deviation),
            filtered_ratio: ratio(|figures| figures.filtered_n.deviation),
            depth_ratio: mean(
                |figures| figures.depth_m.deviation / figures.depth_m.mean,
                1,
            ),
            activations_per_min: mean(|figures| figures.activations_per_min, 1),
        }
    }
}

impl Display for Comparison {
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        write!(
            out,
            "{:<11} deviation of draft {:.3}, through 3.2 Hz {:.3} of position control; of depth {:.1} %; {:.0} activations a minute",
            format!("{:?}", self.function),
            self.draft_ratio,
            self.filtered_ratio,
            self.depth_ratio * 100.0,
            self.activations_per_min,
        )
    }
}

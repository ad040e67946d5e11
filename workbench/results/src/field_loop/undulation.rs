//! Depth over an undulation of the ground.

use hitch_field::draft::Texture;
use hitch_field::soil::SoilPlan;
use hitch_field::terrain::{Terrain, Undulation};
use hitch_field::tractor::TractorConstants;
use hitch_plant::Model;
use hitch_quantities::{Inputs, ValidCalibration};

use super::figures::{Spread, activations};
use hitch_closed_loop::field::{FieldRig, FieldSample, LINK_DEPTH_M, RAISED_DEG, Settings};

/// Ground speed, m/s.
const SPEED_M_S: f64 = 2.7;
/// Time with the implement raised, ms.
const RAISED_MS: usize = 10_000;
/// Time from the start until the hitch works, ms.
const WORKS_FROM_MS: usize = 25_000;
/// Time of work, ms.
const WORK_MS: usize = 60_000;

/// Drives a minute of work over waves of 10 m and 100 mm from crest to trough, in varying loam, with the lever at 25 cm on level
/// ground; the samples of the work. `tell` can modify the inputs at a time of work, s.
#[must_use]
pub fn drive(
    model: &Model,
    calibration: &ValidCalibration,
    settings: &Settings,
    seed: u64,
    mut tell: impl FnMut(f64, &mut Inputs),
) -> Vec<FieldSample> {
    let field = (
        TractorConstants::ploughing(),
        SoilPlan::varying(Texture::Medium),
    );
    let terrain = Terrain::flat().with_undulation(Undulation {
        wavelength_m: 10.0,
        amplitude_m: 0.05,
    });
    let mut rig = FieldRig::new(model, calibration, field, terrain, seed);
    let deep_deg = rig.coupling().angle_deg(LINK_DEPTH_M);
    let mut samples: Vec<FieldSample> = (0..WORKS_FROM_MS + WORK_MS)
        .map(|ms| {
            let lever_deg = if ms < RAISED_MS { RAISED_DEG } else { deep_deg };
            let time_s = (ms as f64 - WORKS_FROM_MS as f64) * 1e-3;
            rig.step(lever_deg, SPEED_M_S, settings, |inputs| {
                tell(time_s, inputs);
            })
        })
        .collect();
    samples.split_off(WORKS_FROM_MS)
}

/// Figures of the depth.
#[derive(Debug, Clone, Copy)]
pub struct DepthFigures {
    /// Part of the way out of the ground, 1.
    pub out: f64,
    /// Part of the way further than 10 % from the mean depth, 1.
    pub beyond: f64,
    /// Depth, m.
    pub depth_m: Spread,
    /// Number of times that a coil was switched on, per minute.
    pub activations_per_min: f64,
}

impl DepthFigures {
    /// Of samples of a millisecond.
    #[must_use]
    pub fn of(work: &[FieldSample]) -> Self {
        let depths = work.iter().map(|sample| sample.field.depth_m);
        let depth_m = Spread::of(depths.clone());
        let count = work.len() as f64;
        let share = |of: &dyn Fn(f64) -> bool| {
            depths.clone().filter(|depth_m| of(*depth_m)).count() as f64 / count
        };
        Self {
            out: share(&|depth_m| depth_m <= 0.0),
            beyond: share(&|found_m| (found_m / depth_m.mean - 1.0).abs() > 0.1),
            depth_m,
            activations_per_min: activations(work.iter().map(|sample| &sample.hitch)) as f64
                / (count / 60e3),
        }
    }
}

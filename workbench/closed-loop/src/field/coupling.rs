//! What hitch and field do to each other.
//!
//! * The height of the lower links sets the depth: the share touches level ground at one angle of the rocker.
//! * The soil loads the links by its vertical force and by the draft. A draft acts along the ground at the hitch point, which
//!   moves to the rear by `dx` as it rises by `dh`, so it carries `D dx/dh` of the load (virtual work). The top link's part of
//!   the draft is neglected, as in the pins' constants.
//!
//! The force of the soil is a load in kg to the hitch, whose inertia it is not: at 4 kN and the accelerations of a slow loop
//! the error is small against the implement's mass.

use hitch_field::body::GRAVITY_M_S2;
use hitch_plant::Model;

/// Rocker angle at which the share touches the ground, degree.
pub const TOUCH_DEG: f64 = 95.0;
/// Rocker angle of the raised hitch at the start, degree.
pub const RAISED_DEG: f64 = 125.0;
/// Rocker angles just inside the ends of the travel, degree.
const ENDS_DEG: [f64; 2] = [44.1, 135.9];

/// Deepest links that the work on a field asks for, m.
const DEEPEST_M: f64 = 0.30;

/// The links are too short for the work on a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "the work on a field needs links that reach from {RAISED_DEG} degrees to {deepest_cm:.0} cm below the height at \
     {TOUCH_DEG} degrees; this model's do not",
    deepest_cm = DEEPEST_M * 100.0
)]
pub struct OutOfReach;

/// Checks that the links of a model reach from the raised hitch to the depths of the work.
///
/// # Errors
/// If they do not.
pub fn check_reach(model: &Model) -> Result<(), OutOfReach> {
    let coupling = Coupling::new(model, TOUCH_DEG, 0.0);
    if coupling.reaches(DEEPEST_M) && coupling.reaches(coupling.depth_m(RAISED_DEG)) {
        Ok(())
    } else {
        Err(OutOfReach)
    }
}

/// Geometry of the coupling.
#[derive(Debug, Clone, Copy)]
pub struct Coupling<'m> {
    model: &'m Model,
    touch_m: f64,
    implement_kg: f64,
}

impl<'m> Coupling<'m> {
    /// An implement whose share touches the ground at a rocker angle.
    #[must_use]
    pub fn new(model: &'m Model, touch_deg: f64, implement_kg: f64) -> Self {
        let mut coupling = Self {
            model,
            touch_m: 0.0,
            implement_kg,
        };
        coupling.touch_m = coupling.height_m(touch_deg);
        coupling
    }

    fn height_m(&self, angle_deg: f64) -> f64 {
        let linkage = self.model.linkage();
        linkage
            .at(linkage.piston_m(angle_deg.to_radians()))
            .height_m
    }

    /// Depth of the links at a rocker angle, m; negative above ground.
    #[must_use]
    pub fn depth_m(&self, angle_deg: f64) -> f64 {
        self.touch_m - self.height_m(angle_deg)
    }

    /// Whether the linkage lowers the links to a depth, m.
    #[must_use]
    pub fn reaches(&self, depth_m: f64) -> bool {
        let [lowest_deg, highest_deg] = ENDS_DEG;
        (self.depth_m(highest_deg)..=self.depth_m(lowest_deg)).contains(&depth_m)
    }

    /// Rocker angle at a depth of the links, m, degree.
    ///
    /// # Panics
    /// If the linkage does not reach it.
    #[must_use]
    pub fn angle_deg(&self, depth_m: f64) -> f64 {
        let [mut low, mut high] = ENDS_DEG;
        assert!(
            self.reaches(depth_m),
            "{depth_m} m are out of the linkage's reach"
        );
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.depth_m(middle) > depth_m {
                low = middle
            } else {
                high = middle
            }
        }
        low
    }

    /// Load of the hitch, kg, with forces of the soil: draft, and upwards, N.
    #[must_use]
    pub fn load_kg(&self, angle_deg: f64, draft_n: f64, vertical_n: f64) -> f64 {
        let rearwards_per_rise = match self.model.joints(angle_deg.to_radians()) {
            Ok(joints) => {
                let link = joints.hitch_point - joints.pivot;
                -link.y / link.x.abs()
            }
            // Beyond its ends the linkage has no posture; the plant does not go there.
            Err(_) => 0.0,
        };
        let carried_n = vertical_n + draft_n * rearwards_per_rise;
        (self.implement_kg - carried_n / GRAVITY_M_S2).max(0.0)
    }
}

//! Drawing of a measured linkage.

use nalgebra::{Point2, Vector2};

use crate::components::linkage::{Joints, Linkage};

/// Joints of a measured linkage, whose dimensions are not known: a sketch with the right angle of the rocker and the
/// right height of the hitch point.
#[must_use]
pub fn sketched(linkage: &Linkage, angle_rad: f64) -> Joints {
    let height_m = |angle_rad: f64| linkage.at(linkage.piston_m(angle_rad)).height_m;
    let (low_rad, high_rad) = linkage.swing_rad();
    let (lowest_m, highest_m) = (height_m(low_rad), height_m(high_rad));
    let along = |length_m: f64, angle_rad: f64| {
        let (sin, cos) = angle_rad.sin_cos();
        Point2::new(length_m * cos, length_m * sin)
    };
    let pivot = Point2::new(-0.13, -0.5);
    let rise_m = height_m(angle_rad) - 0.5 * (lowest_m + highest_m);
    let link_m = (0.8 * (highest_m - lowest_m)).max(0.7);
    let link = Vector2::new((link_m * link_m - rise_m * rise_m).sqrt(), rise_m);
    let rocker_end = along(0.11, angle_rad - std::f64::consts::PI);
    Joints {
        piston_pin: Point2::new(rocker_end.x - 0.22, -0.095),
        rocker_end,
        lift_arm_end: along(0.27, angle_rad - std::f64::consts::FRAC_PI_2),
        rod_joint: pivot + 0.57 * link,
        pivot,
        hitch_point: pivot + link,
    }
}

//! The nominal linkage table against the geometry of the rig, solved in f64.

use hitch_quantities::Calibration;
use hitch_quantities::units::{Micrometre, MilliDegree, MilliDegreePerSecond};

/// Rocker arm, m.
const ROCKER_M: f64 = 0.11;
/// Connecting rod, m.
const ROD_M: f64 = 0.22;
/// Height of the cylinder axis over the rocker shaft, m.
const AXIS_M: f64 = -0.095;
/// Stroke, m.
const STROKE_M: f64 = 0.158;

/// Where the piston pin is on its axis: the rod's circle about the rocker pin, ahead of it.
fn pin_m(angle_deg: f64) -> f64 {
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    let rise_m = -ROCKER_M * sin - AXIS_M;
    -ROCKER_M * cos - (ROD_M * ROD_M - rise_m * rise_m).sqrt()
}

/// Piston travel from the lower end, the stroke lying symmetrically about the rocker straight down.
fn travel_m(angle_deg: f64) -> f64 {
    let (mut low_deg, mut high_deg) = (30.0, 60.0);
    for _ in 0..60 {
        let half_deg = 0.5 * (low_deg + high_deg);
        if pin_m(90.0 + half_deg) - pin_m(90.0 - half_deg) > STROKE_M {
            high_deg = half_deg;
        } else {
            low_deg = half_deg;
        }
    }
    pin_m(angle_deg) - pin_m(90.0 - low_deg)
}

#[test]
fn the_table_is_within_20_micrometres_of_the_linkage() {
    let linkage = Calibration::nominal().linkage;
    let mut worst_um = 0.0f64;
    for angle in (44_096..=135_904).step_by(13) {
        let exact_um = 1e6 * travel_m(f64::from(angle) * 1e-3);
        let travel = linkage.travel(MilliDegree(angle));
        worst_um = worst_um.max((f64::from(travel.0) - exact_um).abs());
        let back = linkage.angle(travel);
        assert!(
            (back.0 - angle).abs() <= 1,
            "{angle} mdeg comes back as {back:?}"
        );
    }
    println!("linkage table: worst {worst_um:.1} um");
    assert!(worst_um <= 20.0, "{worst_um} um");
}

#[test]
fn rates_become_piston_speeds() {
    let linkage = Calibration::nominal().linkage;
    for angle in (45_000..135_000).step_by(500) {
        let angle_deg = f64::from(angle) * 1e-3;
        let slope_um_deg = 1e6 * (travel_m(angle_deg + 0.01) - travel_m(angle_deg - 0.01)) / 0.02;
        let speed = linkage.piston_speed(MilliDegree(angle), MilliDegreePerSecond(10_000));
        let error = (f64::from(speed.0) / (10.0 * slope_um_deg) - 1.0).abs();
        assert!(error < 0.03, "{angle_deg} deg: {error}");
    }
}

// REQ-SAFE-12
#[test]
fn no_angle_or_travel_makes_it_panic() {
    let linkage = Calibration::nominal().linkage;
    for extreme in [i32::MIN, -1, 0, i32::MAX] {
        let _ = linkage.travel(MilliDegree(extreme));
        let _ = linkage.angle(Micrometre(extreme));
        let _ = linkage.piston_speed(MilliDegree(extreme), MilliDegreePerSecond(i32::MIN));
    }
}

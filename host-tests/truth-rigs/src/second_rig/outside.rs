//! Physics outside the catalogue: the expected verdict is "unexplained".

use super::hidden::{Hide, Hideable, Sizes};

const fn outside(id: &'static str, unit: &'static str, sizes: Sizes, hide: Hide) -> Hideable {
    Hideable {
        comparable: false,
        ..Hideable::new(id, unit, sizes, hide)
    }
}

/// Every physics outside the catalogue.
pub static OUTSIDE: [Hideable; 6] = [
    outside("end-cushion", "m", (0.03, 0.09), |rig, size, _| {
        rig.cushion_m = size;
    }),
    outside("friction-bump", "N", (400.0, 2500.0), |rig, size, shape| {
        rig.friction.bump = (size, shape.between(0.05, 0.11));
    }),
    outside("cam-error", "deg", (0.2, 1.5), |rig, size, shape| {
        rig.sensors.cam = (size, shape.between(0.0, std::f64::consts::TAU));
    }),
    outside("flow-drift", "1/s", (1e-4, 6e-4), |rig, size, _| {
        rig.flow_drift_1_s = -size;
    }),
    outside("square-friction", "N s2/m2", (2e4, 3e5), |rig, size, _| {
        rig.friction.square_n_s2_m2 = size;
    }),
    outside("slow-check-seating", "s", (0.05, 0.4), |rig, size, _| {
        rig.check_seating_s = size;
    }),
];

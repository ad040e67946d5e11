//! All physics of the catalogue that can be hidden, implemented independently from the literature.
//!
//! One number is the size; the remaining shape is drawn. *Faithful* is the simplest textbook form. *Structured* has
//! more detail: rounded hysteresis loops, bristles instead of a hyperbolic tangent, oscillating spools,
//! temperature-dependent coefficients.

use super::data_sheet::{BAR, LPM};
use super::hidden::{Hide, Hideable, Shape, Sizes};
use super::outside::OUTSIDE;
use super::physics::{FlowForce, Ground, Physics, Play, SpoolMotion, Stiction};

/// Looks up a physics by its id, in the catalogue's or outside.
#[must_use]
pub fn find(id: &str) -> Option<&'static Hideable> {
    HIDEABLE
        .iter()
        .chain(&OUTSIDE)
        .find(|hideable| hideable.id == id)
}

const fn signed(id: &'static str, unit: &'static str, sizes: Sizes, hide: Hide) -> Hideable {
    Hideable {
        signed: true,
        ..Hideable::new(id, unit, sizes, hide)
    }
}

/// An effect whose size is stated in another way than the catalogue's.
const fn otherwise(id: &'static str, unit: &'static str, sizes: Sizes, hide: Hide) -> Hideable {
    Hideable {
        comparable: false,
        ..Hideable::new(id, unit, sizes, hide)
    }
}

const fn dynamic(id: &'static str, unit: &'static str, sizes: Sizes, hide: Hide) -> Hideable {
    Hideable {
        steady: false,
        ..Hideable::new(id, unit, sizes, hide)
    }
}

/// Every physics of the catalogue that can be hidden.
pub static HIDEABLE: [Hideable; 28] = [
    signed("lift-threshold-shift", "A", (0.03, 0.2), |rig, size, _| {
        rig.lift_shift_a = size;
    }),
    signed(
        "lower-threshold-shift",
        "A",
        (0.03, 0.25),
        |rig, size, _| {
            rig.lower_shift_a = size;
        },
    ),
    signed("lift-flow-scale", "", (0.02, 0.1), |rig, size, shape| {
        rig.lift_flow_error = flow_error(size, shape);
    }),
    signed("lower-flow-scale", "", (0.02, 0.1), |rig, size, shape| {
        rig.lower_flow_error = flow_error(size, shape);
    }),
    Hideable::new("solenoid-hysteresis", "A", (0.04, 0.35), hysteresis),
    Hideable::new("spool-stiction", "A", (0.04, 0.2), |rig, size, shape| {
        rig.stiction = Some(Stiction {
            band_a: size,
            jump_a: size * shape.usual_or_between(1.0, 0.5, 1.0),
            follows: shape.structured(),
        });
    }),
    Hideable::new("spool-lag", "s", (0.02, 0.12), |rig, size, shape| {
        rig.spool = spool(size, shape);
    }),
    Hideable::new("flow-force", "", (0.08, 0.6), |rig, size, shape| {
        rig.flow_force = FlowForce {
            strength: size,
            on_spool: shape.structured(),
        };
    }),
    Hideable::new(
        "compensator-droop",
        "bar/bar",
        (0.001, 0.01),
        |rig, size, shape| {
            rig.droop = size;
            rig.droop_with_flow = shape.usual_or_between(0.0, 0.0, 4.0 * size);
            rig.compensator_lag_s = shape.usual_or_between(0.0, 0.003, 0.012);
        },
    ),
    Hideable::new(
        "check-valve-loss",
        "bar",
        (0.05, 0.6),
        |rig, size, shape| {
            let with_flow = shape.usual_or_between(0.0, 0.0, 0.3);
            rig.check_loss_pa = (1.0 - with_flow) * size * BAR;
            rig.check_loss_pa_s_m3 = with_flow * size * BAR / (20.0 * LPM);
        },
    ),
    Hideable::new("pump-leakage", "l/min/bar", (0.03, 0.15), |rig, size, _| {
        rig.pump_slip_m3_s_pa = size * LPM / BAR;
    }),
    otherwise("relief-override", "bar", (8.0, 30.0), |rig, size, _| {
        rig.relief_override_pa = size * BAR;
    }),
    Hideable::new(
        "lowering-leakage",
        "l/min/bar",
        (0.0005, 0.008),
        |rig, size, shape| {
            rig.leakage_m3_s_pa = size * LPM / BAR;
            rig.leakage_thins = shape.structured();
        },
    ),
    Hideable::new("return-line-loss", "bar", (0.3, 4.0), |rig, size, shape| {
        let laminar = shape.usual_or_between(0.0, 0.05, 0.3);
        let flow = 40.0 * LPM;
        rig.return_turbulent = (1.0 - laminar) * size * BAR / (flow * flow);
        rig.return_laminar = laminar * size * BAR / flow;
    }),
    otherwise("oil-viscosity", "", (20.0, 200.0), |rig, size, _| {
        rig.laminar_flow_number = size;
    }),
    Hideable::new(
        "coulomb-friction",
        "N",
        (80.0, 900.0),
        |rig, size, shape| {
            rig.friction.coulomb_n = size;
            rig.friction.bristles = shape.structured();
            rig.friction.trembles = shape.structured() && shape.between(0.0, 1.0) < 0.5;
        },
    ),
    Hideable::new(
        "stribeck-friction",
        "N",
        (80.0, 700.0),
        |rig, size, shape| {
            rig.friction.coulomb_n = size;
            rig.friction.stribeck_n = size * shape.between(0.2, 0.8);
            rig.friction.stribeck_speed_m_s = shape.between(0.005, 0.02);
            rig.friction.gaussian = shape.structured();
        },
    ),
    Hideable::new(
        "viscous-friction",
        "N s/m",
        (800.0, 9000.0),
        |rig, size, shape| {
            rig.friction.viscous_n_s_m = size;
            rig.friction.thickens = shape.structured();
        },
    ),
    Hideable::new("pin-friction", "", (0.01, 0.08), |rig, size, shape| {
        rig.pin_friction = size;
        rig.pin_friction_ripple = shape.usual_or_between(0.0, -0.3, 0.3);
    }),
    Hideable::new("pin-backlash", "mm", (0.3, 3.0), |rig, size, _| {
        rig.sensors.backlash_m = 1e-3 * size;
    }),
    otherwise("load-arm", "m", (0.1, 0.6), |rig, size, _| {
        rig.load_arm_m = size;
    }),
    Hideable::new("ground-contact", "m", (0.06, 0.25), |rig, size, shape| {
        rig.ground = Some(Ground {
            height_m: size,
            stiffness_n_m: shape.usual_or_between(1e6, 2e5, 2e6),
            damping_n_s_m: shape.usual_or_between(0.0, 1e3, 1e4),
        });
    }),
    signed("angle-sensor-gain", "", (0.004, 0.04), |rig, size, _| {
        rig.sensors.angle_gain = size;
    }),
    Hideable::new(
        "angle-sensor-lag",
        "s",
        (0.015, 0.25),
        |rig, size, shape| {
            rig.sensors.angle_lag_s = size;
            rig.sensors.angle_delayed = shape.structured();
        },
    ),
    signed(
        "pressure-sensor-offset",
        "bar",
        (0.1, 2.0),
        |rig, size, _| {
            rig.sensors.pressure_offset_pa = size * BAR;
        },
    ),
    dynamic("entrained-air", "", (0.004, 0.06), |rig, size, shape| {
        // A volume share of the mixture; the equation uses the ratio to the oil.
        rig.air_ratio = size / (1.0 - size);
        rig.air_exponent = shape.usual_or_between(1.4, 1.0, 1.4);
    }),
    dynamic(
        "hose-compliance",
        "cm3/bar",
        (0.01, 0.08),
        |rig, size, shape| {
            rig.hose_m3_pa = 1e-6 * size / BAR;
            rig.hose_retardation_s = shape.usual_or_between(0.0, 0.02, 0.1);
        },
    ),
    dynamic("load-inertia", "", (0.1, 1.0), |rig, size, shape| {
        // Part of it may be rocker and arms, which no load makes heavier: at 150 kg some 2000 kg at the piston, and the
        // shaft turns by about 10 rad/m.
        let on_shaft = shape.usual_or_between(0.0, 0.1, 0.4);
        rig.inertia_share = (1.0 - on_shaft) * size;
        rig.rocker_inertia_kg_m2 = on_shaft * size * 20.0;
    }),
];

/// The same error at every opening, or one that grows or shrinks with it.
fn flow_error(size: f64, shape: &mut Shape) -> (f64, f64) {
    let full = size * shape.usual_or_between(1.0, 0.7, 1.3);
    (size, full)
}

/// One play of the full width, or three whose loop is as wide: `sum of share * width = size`.
fn hysteresis(rig: &mut Physics, size_a: f64, shape: &mut Shape) {
    if !shape.structured() {
        rig.plays = vec![Play {
            half_width_a: 0.5 * size_a,
            share: 1.0,
        }];
        return;
    }
    let widths = [0.3, 1.0, 1.8];
    let mut shares = widths.map(|_| shape.between(0.2, 1.0));
    let whole: f64 = shares.iter().sum();
    shares = shares.map(|share| share / whole);
    let loop_width: f64 = widths.iter().zip(shares).map(|(w, s)| w * s).sum();
    rig.plays = widths
        .into_iter()
        .zip(shares)
        .map(|(width, share)| Play {
            half_width_a: 0.5 * size_a * width / loop_width,
            share,
        })
        .collect();
}

/// A first-order lag, or a second-order one behind a dead time with the same delay on a ramp.
fn spool(size_s: f64, shape: &mut Shape) -> SpoolMotion {
    if !shape.structured() {
        return SpoolMotion::Lagging(size_s);
    }
    let dead_time_s = size_s * shape.between(0.1, 0.4);
    let damping = shape.between(0.7, 1.0);
    SpoolMotion::Swinging {
        frequency_rad_s: 2.0 * damping / (size_s - dead_time_s),
        damping,
        dead_time_s,
    }
}

//! The two starting points that come with the project (RIG.md).
use crate::model::{Constants, Dynamics, Model};
use crate::plant::*;
use crate::units::*;

impl Model {
    /// The paper's quasi-static model.
    #[must_use]
    pub fn nominal() -> Model {
        Model::new("nominal", constants(Dynamics::Steady)).expect("shipped constants")
    }

    /// The same with known dynamics.
    #[must_use]
    pub fn dynamic() -> Model {
        Model::new("dynamic", constants(Dynamics::Dynamic)).expect("shipped constants")
    }
}

fn curve(points: &[(f64, f64)]) -> ValveCurve {
    ValveCurve::new(
        points.iter().map(|p| p.0).collect(),
        points.iter().map(|p| m3_s_from_lpm(p.1)).collect(),
    )
    .expect("table 2")
}

fn constants(dynamics: Dynamics) -> Constants {
    let transition_drop_pa = if dynamics == Dynamics::Dynamic {
        pa_from_bar(0.1)
    } else {
        0.0
    };
    Constants {
        dynamics,
        pump: Pump {
            theoretical_flow_m3_s: m3_s_from_lpm(54.5),
            volumetric_efficiency: 0.88,
        },
        relief_valve: ReliefValve {
            set_pressure_pa: pa_from_bar(154.0),
        },
        compensator: Compensator {
            margin_pa: pa_from_bar(4.0),
        },
        check_valve: CheckValve {
            cracking_pressure_pa: pa_from_bar(2.5),
        },
        lift_valve: OrificeValve {
            curve: curve(&[
                (0.0, 0.0),
                (1.114, 0.0),
                (1.126, 0.0),
                (1.138, 0.143),
                (1.568, 8.128),
                (1.974, 15.829),
                (2.319, 22.389),
                (2.640, 28.521),
                (2.858, 32.513),
                (3.070, 36.506),
                (3.252, 39.929),
                (3.5, 39.929),
            ]),
            reference_drop_pa: pa_from_bar(1.5),
            transition_drop_pa,
        },
        lower_valve: OrificeValve {
            curve: curve(&[
                (0.0, 0.0),
                (0.242, 0.0),
                (0.969, 0.0),
                (0.999, 0.0),
                (1.017, 0.321),
                (1.042, 0.642),
                (1.072, 0.963),
                (1.138, 1.176),
                (1.502, 2.674),
                (1.544, 2.888),
                (1.574, 3.422),
                (1.744, 9.840),
                (2.035, 20.535),
                (2.271, 29.198),
                (2.567, 40.214),
                (3.022, 57.005),
                (3.040, 57.754),
                (3.070, 58.289),
                (3.119, 58.717),
                (3.5, 58.717),
            ]),
            reference_drop_pa: pa_from_bar(15.0),
            transition_drop_pa,
        },
        spool_time_constant_s: 0.045,
        cylinder: Cylinder {
            bore_m: 0.076,
            stroke_m: 0.158,
            dead_volume_m3: 0.30e-3,
            viscous_friction_n_s_m: 12_000.0,
            stop_stiffness_n_m: 5e7,
            stop_damping_n_s_m: 2e5,
        },
        oil: Oil {
            density_kg_m3: 877.3,
            bulk_modulus_pa: 1.2e9,
        },
        linkage: LinkageDimensions {
            rocker_arm_m: 0.11,
            lift_arm_m: 0.27,
            lift_rod_m: 0.51,
            lower_link_m: 0.70,
            lift_rod_joint_m: 0.40,
            connecting_rod_m: 0.22,
            pivot_x_m: -0.13,
            pivot_y_m: -0.50,
            cylinder_axis_y_m: -0.095,
        },
        masses: Masses {
            dead_weight_kg: 30.0,
            piston_kg: 20.0,
        },
    }
}

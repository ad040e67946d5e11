//! `load-inertia`: inertia force of the moving masses.
//!
//! `p A = F_weight + s M(x) dv/dt` with `M = (load + dead weight) (dh/dx)^2 + 20 kg`. A share of one is the inertia of
//! the known masses. In the dynamic model, which includes it, the share is additional: rocker, arms, mast. The inertia
//! of the rocker shaft, `J (dphi/dx)^2` at the piston, is independent of the load: it is stated as a part of the share
//! at 150 kg and mid-stroke, and is a larger one at lighter loads.

use hitch_plant::hooks::effect_hooks::{EffectHooks, RunConditions};
use hitch_plant::{Channel, Parameter};

use crate::described::Described;

/// Longest step that resolves the pressure of an accelerated load, s.
const STEP_S: f64 = 0.005;

/// Load at which the shaft's part is specified, kg.
const USUAL_LOAD_KG: f64 = 150.0;

const SHARE: Parameter = Parameter {
    meaning: "share of the inertia of load and dead weight",
    typical: 0.5,
    low: 0.0,
    high: 5.0,
    ..Parameter::ratio("share")
};

/// Inertia proportional to the load.
pub static OF_LOAD: Described = Described {
    id: "load-inertia",
    title: "Inertia of load and linkage",
    equation: "p A = F_weight + share M(x) dv/dt, M = m (dh/dx)^2 + 20 kg",
    source: "Lagrange's equation of the linkage; rocker and arms of 0.3 to 0.8 kg m2 add 30 to 80 kg \
         at the piston",
    shows: "peaks of cylinder pressure when a movement starts or stops, in proportion to the load; \
         on the dynamic starting point slower ringing",
    parameters: &[SHARE],
    channels: &[Channel::CylinderPressure],
    attach: |values, _, hooks| resist(values[0], 0.0, hooks),
    ..Described::USUAL
};

/// Inertia with a part on the rocker shaft.
pub static AND_SHAFT: Described = Described {
    form: Some("shaft"),
    title: "Inertia of load and linkage, partly on the rocker shaft",
    equation: "p A = F_weight + share ((1 - shaft) M(x) + shaft M_0 (dphi/dx)^2 / (dphi/dx)_0^2) dv/dt, \
         M = m (dh/dx)^2 + 20 kg, 0: 150 kg at mid stroke",
    parameters: &[
        SHARE,
        Parameter {
            meaning: "share of it on the rocker shaft, at 150 kg and mid-stroke",
            typical: 0.2,
            low: 0.0,
            high: 1.0,
            ..Parameter::ratio("shaft")
        },
    ],
    refines: true,
    attach: |values, conditions, hooks| {
        let RunConditions {
            constants, linkage, ..
        } = conditions;
        let middle_m = 0.5 * constants.cylinder.stroke_m;
        let (turn_rad_m, _) = linkage.shaft_transmission(middle_m);
        let of_load_kg = constants
            .masses
            .inertia_kg(USUAL_LOAD_KG, linkage.dh_dx(middle_m));
        let on_shaft = values[0] * values[1];
        resist(
            values[0] - on_shaft,
            on_shaft * of_load_kg / (turn_rad_m * turn_rad_m),
            hooks,
        );
    },
    ..OF_LOAD
};

fn resist(share: f64, shaft_kg_m2: f64, hooks: &mut EffectHooks) {
    hooks.inertia_share += share;
    hooks.shaft_inertia_kg_m2 += shaft_kg_m2;
    hooks.limit_step(STEP_S);
}

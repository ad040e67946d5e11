//! `oil-viscosity`: part of the lowering valve's flow is laminar.
//!
//! `Q = Q_table(I) [(1 - s) sqrt(dp/dp_ref) + s (dp/dp_ref) nu(40 C)/nu(T)]`: `s` is the laminar share of the flow at the
//! reference drop and 40 degrees (a series of the laminar-turbulent transition of McCloy & Martin about that point).
//! Viscosity falls by 4 to 6 % a kelvin: `nu = nu(40 C) exp(-fall (T - 40 C))`, a local form of Walther's equation.

use super::Parameter;
use super::described::Described;
use crate::campaign::Channel;

use crate::plant::sites::{RunConditions, Sites};

/// Temperature at which the valve's table holds, degree Celsius.
const REFERENCE_C: f64 = 40.0;

/// Laminar flow in the lowering valve.
pub static OIL_VISCOSITY: Described = Described {
    id: "oil-viscosity",
    title: "Laminar flow in the lowering valve",
    equation: "Q = Q_table(I) [(1 - share) sqrt(r) + share r exp(fall (T - 40 C))], r = dp / 15 bar",
    source: "laminar-turbulent transition, McCloy & Martin; SAE 30 loses 4 to 6 % of its viscosity a \
         kelvin",
    shows: "lowering slower when cold and faster when warm, and more than with the square root of \
         the pressure; at one temperature the opposite of a flow force",
    parameters: &[
        Parameter {
            name: "share",
            unit: "",
            key: "share",
            meaning: "laminar share of the flow at 15 bar and 40 C",
            null: 0.0,
            typical: 0.2,
            low: 0.0,
            high: 1.0,
        },
        Parameter {
            name: "fall",
            unit: "1/K",
            key: "fall_1_k",
            meaning: "fall of the viscosity with temperature",
            null: 0.0,
            typical: 0.042,
            low: 0.02,
            high: 0.08,
        },
    ],
    channels: &[Channel::Flow, Channel::RockerAngle],
    needs: None,
    erratic: false,
    attach,
};

fn attach(values: &[f64], conditions: RunConditions<'_>, sites: &mut Sites) {
    let share = values[0];
    let thinner = (values[1] * (conditions.oil_temperature_c - REFERENCE_C)).exp();
    let reference_pa = conditions.constants.lower_valve.reference_drop_pa;
    sites.lower_drop_factor.push(Box::new(move |drop_pa| {
        1.0 - share + share * thinner * (drop_pa.max(0.0) / reference_pa).sqrt()
    }));
}

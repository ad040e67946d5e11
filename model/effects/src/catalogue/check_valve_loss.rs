//! `check-valve-loss`: pressure loss of the open check valve.
//!
//! Beyond the nominal cracking pressure the poppet has a loss of `loss (steady + (1 - steady) (Q / 40 l/min)^2)`: a
//! throttling seat, and with the share `steady` a spring that is stiffer than in its data sheet. The compensator
//! controls the sum of all drops, so the drop of the lift orifice decreases from 1.5 bar. A poppet whose opening
//! increases with the flow has a linear loss instead, `Q / 40 l/min`. Throttling reduces large flows relatively more;
//! the spring alone reduces all flows by the same share and is equivalent to `lift-flow-scale`. It is a form of its own with a
//! single parameter, so that the equivalent effects are equally probable.

use hitch_plant::hooks::effect_hooks::EffectHooks;
use hitch_plant::units::{m3_s_from_lpm, pa_from_bar};
use hitch_plant::{Channel, Parameter};

use crate::described::Described;

/// Flow at which the loss is specified, l/min.
const RATED_LPM: f64 = 40.0;

const LOSS: Parameter = Parameter {
    meaning: "pressure loss at 40 l/min beyond the cracking pressure",
    typical: 0.4,
    low: 0.0,
    high: 10.0,
    ..Parameter::quantity("loss", "bar", "loss_bar")
};

const STEADY: Parameter = Parameter {
    meaning: "share of it that is independent of the flow",
    null: 0.5,
    typical: 0.0,
    low: 0.0,
    high: 1.0,
    ..Parameter::ratio("steady")
};

/// Pressure loss of a check valve with a throttling seat.
pub static THROTTLING: Described = Described {
    id: "check-valve-loss",
    title: "Pressure loss of the check valve",
    equation: "dp_orifice = p_P - p_C - p_crack - loss [steady + (1 - steady) (Q / 40 l/min)^2]; Q = \
         Q_table(I) sqrt(dp_orifice / dp_ref)",
    source: "orifice law of an open poppet; 0.3 to 1 bar at rated flow in data sheets of cartridge \
         check valves",
    shows: "large lift flows are too small while small ones fit, equally at every load; the pump pressure \
         does not change",
    parameters: &[LOSS, STEADY],
    channels: &[Channel::Flow, Channel::RockerAngle],
    attach: |values, _, hooks| {
        let varying_pa = stiffened(values, hooks);
        let rated_m3_s = m3_s_from_lpm(RATED_LPM);
        hooks.check_valve.turbulent_pa_s2_m6 += varying_pa / (rated_m3_s * rated_m3_s);
    },
    ..Described::USUAL
};

/// Pressure loss of a check valve whose poppet opens against its spring.
pub static LIFTING: Described = Described {
    form: Some("lifting"),
    title: "Pressure loss of the check valve, with flow-dependent poppet lift",
    equation: "dp_orifice = p_P - p_C - p_crack - loss [steady + (1 - steady) Q / 40 l/min]; Q = \
         Q_table(I) sqrt(dp_orifice / dp_ref)",
    source: "force balance of a poppet on its spring; 0.3 to 1 bar at rated flow in data sheets of \
         cartridge check valves",
    refines: true,
    attach: |values, _, hooks| {
        let varying_pa = stiffened(values, hooks);
        hooks.check_valve.laminar_pa_s_m3 += varying_pa / m3_s_from_lpm(RATED_LPM);
    },
    ..THROTTLING
};

/// Higher cracking pressure of a spring that is stiffer than in its data sheet.
pub static STIFF_SPRING: Described = Described {
    form: Some("stiff-spring"),
    title: "Pressure loss of the check valve, by a stiffer spring",
    equation: "dp_orifice = p_P - p_C - p_crack - loss; Q = Q_table(I) sqrt(dp_orifice / dp_ref)",
    source: "force balance of the closed poppet; spring tolerances of 5 to 10 %",
    shows: "all lift flows are too small by the same share at every load, as with another lift flow curve; the pump \
         pressure does not change",
    parameters: &[LOSS],
    attach: |values, _, hooks| hooks.cracking_extra_pa += pa_from_bar(values[0]),
    ..THROTTLING
};

/// Adds the steady share of a loss to the cracking pressure; returns the remaining loss at the rated flow, Pa.
fn stiffened(values: &[f64], hooks: &mut EffectHooks) -> f64 {
    let (loss_pa, steady) = (pa_from_bar(values[0]), values[1]);
    hooks.cracking_extra_pa += steady * loss_pa;
    (1.0 - steady) * loss_pa
}

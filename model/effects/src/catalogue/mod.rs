//! The catalogue of physical effects: one file per effect, one line in [`CATALOGUE`] each.
//!
//! # Adding an effect
//! 1. Add a file to this folder, named after the effect. Its doc comment states the equation, its source and the
//!    typical size of the effect.
//! 2. The file has one `pub static` of type `described::Described`: texts, parameters with unit, range, null value and
//!    typical size, the channels that the effect acts on in a lab campaign, the dynamics that it requires (if any), its
//!    size response, and `attach`. The first parameter is the size: at its null value the effect is absent, regardless
//!    of the other parameters. `flow_force.rs` is a short example, `pin_backlash.rs` one with state.
//! 3. `attach` receives a value for each parameter, in its unit, and the conditions of the run
//!    ([`RunConditions`](hitch_plant::hooks::effect_hooks::RunConditions)). It attaches numbers, closures or small
//!    components with state to the [`EffectHooks`](hitch_plant::hooks::effect_hooks::EffectHooks), in SI units. If no
//!    hook is suitable, add one to `EffectHooks` and evaluate it in the component concerned.
//! 4. Add one `mod`, one line in [`CATALOGUE`], and the id in `order.rs`.
//!
//! If the literature has two equations for one effect, each is an effect of its own with the same id and a `form`; the
//! usual one has none. A search tries all forms and keeps the best, see `oil_viscosity.rs` and `spool_stiction.rs`.
//!
//! No other change is necessary: plant, model files, identification, reports and `hitch effects` use the catalogue, and
//! so do the generic tests of `tests/effects.rs`: the null value changes nothing bit for bit, a size next to it almost
//! nothing, and a typical size shows in the named channels. A term that is to be tried without recompilation is defined
//! in a model file instead (see `term.rs`).

mod angle_sensor_gain;
mod angle_sensor_lag;
mod bulk_modulus;
mod check_valve_loss;
mod compensator_droop;
mod compensator_margin;
mod coulomb_friction;
mod entrained_air;
mod flow_force;
mod flow_scale;
mod ground_contact;
mod hose_compliance;
mod load_arm;
mod load_inertia;
mod lowering_leakage;
mod oil_viscosity;
mod over_the_stroke;
mod pin_backlash;
mod pin_friction;
mod pressure_sensor_offset;
mod pump_flow;
mod pump_leakage;
mod relief_override;
mod return_line_loss;
mod solenoid_hysteresis;
mod spool_lag;
mod spool_stiction;
mod stribeck_friction;
mod threshold_shift;
mod viscous_friction;

use hitch_plant::{Effect, Model};

/// Every effect that the project knows, in the order in which they act.
pub static CATALOGUE: &[&dyn Effect] = &[
    &threshold_shift::LIFT,
    &threshold_shift::LOWERING,
    &flow_scale::LIFT,
    &flow_scale::LIFT_UNEVEN,
    &flow_scale::LOWERING,
    &flow_scale::LOWERING_UNEVEN,
    &solenoid_hysteresis::SOLENOID_HYSTERESIS,
    &spool_stiction::STICKING,
    &spool_stiction::FOLLOWING,
    &spool_lag::CREEPING,
    &spool_lag::SWINGING,
    &flow_force::ON_FLOW,
    &flow_force::ON_TRAVEL,
    &oil_viscosity::SERIES,
    &oil_viscosity::FLOW_NUMBER,
    &compensator_droop::WITH_LOAD,
    &compensator_droop::WITH_FLOW,
    &compensator_droop::LAGGING,
    &compensator_margin::PRELOAD,
    &compensator_margin::BYPASS,
    &check_valve_loss::THROTTLING,
    &check_valve_loss::LIFTING,
    &check_valve_loss::STIFF_SPRING,
    &pump_leakage::PUMP_LEAKAGE,
    &pump_flow::PUMP_FLOW,
    &relief_override::RELIEF_OVERRIDE,
    &return_line_loss::TURBULENT,
    &return_line_loss::LAMINAR,
    &lowering_leakage::EVEN,
    &lowering_leakage::THINNING,
    &entrained_air::ENTRAINED_AIR,
    &bulk_modulus::BULK_MODULUS,
    &hose_compliance::ELASTIC,
    &hose_compliance::CREEPING,
    &coulomb_friction::SMOOTH,
    &coulomb_friction::BRISTLES,
    &stribeck_friction::STRIBECK_FRICTION,
    &viscous_friction::EVEN,
    &viscous_friction::THICKENING,
    &pin_friction::EVEN,
    &pin_friction::UNEVEN,
    &pin_backlash::PIN_BACKLASH,
    &load_inertia::OF_LOAD,
    &load_inertia::AND_SHAFT,
    &load_arm::WITH_WEIGHT,
    &load_arm::WITH_LOAD,
    &ground_contact::SPRINGY,
    &ground_contact::DAMPED,
    &angle_sensor_gain::ANGLE_SENSOR_GAIN,
    &angle_sensor_lag::FILTERING,
    &angle_sensor_lag::DELAYED,
    &pressure_sensor_offset::PRESSURE_SENSOR_OFFSET,
];

/// The effect with this id, in its usual form.
#[must_use]
pub fn find(id: &str) -> Option<&'static dyn Effect> {
    CATALOGUE.iter().copied().find(|effect| effect.id() == id)
}

/// Every effect that can be added to a model: the catalogue, then the model's own terms.
#[must_use]
pub fn available(model: &Model) -> Vec<&'static dyn Effect> {
    let own = model.terms.iter().copied();
    CATALOGUE.iter().copied().chain(own).collect()
}

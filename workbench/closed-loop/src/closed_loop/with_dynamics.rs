//! The machine that a closed loop drives: a model with dynamics.

use hitch_model_file::dynamic;
use hitch_plant::{Constants, Dynamics, LinkageError, Model, OrificeValve};

/// A quasi-static model with its declared inertia, compressibility and spool lag; a dynamic one unchanged.
///
/// # Errors
/// If its linkage cannot be assembled.
pub fn with_dynamics(model: &Model) -> Result<Model, LinkageError> {
    let constants = model.constants();
    if constants.dynamics == Dynamics::Dynamic {
        return Ok(model.clone());
    }
    let laminar = |valve: &OrificeValve, declared: &OrificeValve| OrificeValve {
        transition_drop_pa: valve.transition_drop_pa.max(declared.transition_drop_pa),
        ..valve.clone()
    };
    let declared = dynamic();
    let (lift, lower) = (
        &declared.constants().lift_valve,
        &declared.constants().lower_valve,
    );
    let constants = Constants {
        dynamics: Dynamics::Dynamic,
        lift_valve: laminar(&constants.lift_valve, lift),
        lower_valve: laminar(&constants.lower_valve, lower),
        ..constants.clone()
    };
    model.with_constants(constants)
}

//! The operator's locks, from the contacts and the engine speed: transport lock, hold, engine.

use hitch_quantities::Inputs;
use hitch_quantities::calibration::design_parameters::LockParameters;
use hitch_quantities::units::{Millisecond, RevolutionPerMinute};

/// What the locks forbid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lock {
    /// Nothing.
    Open,
    /// Motion by the lever: hold. The button still moves the hitch.
    Lever,
    /// Any motion: transport lock, or an engine that does not run.
    All,
}

/// The locks.
#[derive(Clone, Copy, Debug, Default)]
pub struct Locks {
    /// The engine speed has been received: from then on a missing one counts as a stopped engine.
    engine_known: bool,
    /// How long the engine has been running.
    running_for: Millisecond,
}

impl Locks {
    /// One step.
    pub fn judge(&mut self, inputs: &Inputs, parameters: &LockParameters) -> Lock {
        let runs = self.engine_runs(inputs.engine_speed, parameters);
        if inputs.switches.transport_lock || !runs {
            Lock::All
        } else if inputs.switches.hold {
            Lock::Lever
        } else {
            Lock::Open
        }
    }

    /// True once the engine has been running for long enough. A machine without this signal has a running engine,
    /// unless the calibration requires the signal.
    fn engine_runs(
        &mut self,
        speed: Option<RevolutionPerMinute>,
        parameters: &LockParameters,
    ) -> bool {
        self.engine_known |= speed.is_some();
        let required = self.engine_known || parameters.engine_required.0 != 0;
        let runs = speed.is_some_and(|speed| speed > parameters.engine_running);
        let running_for = self.running_for.counted_while(runs);
        self.running_for = running_for.min(parameters.engine_settling);
        !required || runs && self.running_for >= parameters.engine_settling
    }
}

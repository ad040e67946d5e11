//! Finds the troubles in what the controller reports.

use hitch_quantities::calibration::design_parameters::{LockParameters, OperatorParameters};
use hitch_quantities::signals::field;
use hitch_quantities::units::{MilliAmp, MilliVolt, Millisecond};
use hitch_quantities::{Fault, Inputs, Outputs, Trip};

use super::button_monitor::ButtonMonitor;
use super::trouble::{Trouble, Troubles};

/// Requested coil.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Coil {
    Lift,
    Lowering,
}

/// Converts the controller's results into troubles. The affected coil or the violated side of a limit is visible only
/// at the time of a trip, before both coils are off; it is latched then.
#[derive(Clone, Debug, Default)]
pub struct TroubleFinder {
    last_asked: Option<Coil>,
    tripped: Option<(Trip, Trouble)>,
    /// An engine speed has been received since power-up.
    engine_known: bool,
    engine_speed: Missing,
    /// The speeds of the slip guard.
    speeds: Missing,
    buttons: ButtonMonitor,
}

impl TroubleFinder {
    /// Processes the result of a step.
    pub fn update(
        &mut self,
        inputs: &Inputs,
        outputs: &Outputs,
        lock: &LockParameters,
        operator: &OperatorParameters,
    ) -> Troubles {
        self.of_controller(inputs, outputs)
            .union(self.of_engine(inputs, lock))
            .union(self.of_field(outputs.trouble))
            .union(self.buttons.update(inputs, operator))
    }

    /// An engine speed that the engine lock relies on.
    fn of_engine(&mut self, inputs: &Inputs, lock: &LockParameters) -> Troubles {
        let is_present = inputs.engine_speed.is_some();
        self.engine_known |= is_present;
        let is_needed = self.engine_known || lock.engine_required.0 != 0;
        let is_lost = self.engine_speed.is_lost(!is_present && is_needed);
        let found = is_lost.then_some(Trouble::EngineSpeedLost);
        found.map_or(Troubles::NONE, Troubles::from)
    }

    /// Lost sensors of draft, depth and slip control.
    fn of_field(&mut self, trouble: Option<field::Trouble>) -> Troubles {
        let is_missing = matches!(
            trouble,
            Some(field::Trouble::GroundSpeed | field::Trouble::WheelSpeed)
        );
        let is_lost = self.speeds.is_lost(is_missing);
        let found = trouble.and_then(|trouble| match trouble {
            field::Trouble::PinRange => Some(Trouble::DraftPinMissing),
            field::Trouble::PinsDisagree | field::Trouble::PinNoisy => Some(Trouble::DraftPins),
            field::Trouble::PinFrozen => Some(Trouble::DraftPinFrozen),
            field::Trouble::GroundSpeed => is_lost.then_some(Trouble::GroundSpeedLost),
            field::Trouble::WheelSpeed => is_lost.then_some(Trouble::WheelSpeedLost),
            field::Trouble::SpeedFrozen => Some(Trouble::SpeedFrozen),
            field::Trouble::DepthRange => Some(Trouble::DepthSensorMissing),
            field::Trouble::DepthFrozen => Some(Trouble::DepthSensorFrozen),
            field::Trouble::DepthNoisy => Some(Trouble::DepthSensorNoisy),
        });
        found.map_or(Troubles::NONE, Troubles::from)
    }

    fn of_controller(&mut self, inputs: &Inputs, outputs: &Outputs) -> Troubles {
        if outputs.lift_current > MilliAmp::ZERO {
            self.last_asked = Some(Coil::Lift);
        } else if outputs.lower_current > MilliAmp::ZERO {
            self.last_asked = Some(Coil::Lowering);
        }
        let Some(trip) = outputs.trip else {
            self.tripped = None;
            let fault = outputs.fault.map(|fault| of_fault(fault, inputs));
            return fault.map_or(Troubles::NONE, Troubles::from);
        };
        let trouble = match self.tripped {
            Some((known, trouble)) if known == trip => trouble,
            _ => self.of_trip(trip, inputs),
        };
        self.tripped = Some((trip, trouble));
        trouble.into()
    }

    fn of_trip(&self, trip: Trip, inputs: &Inputs) -> Trouble {
        match trip {
            Trip::Stale | Trip::BothCoils => Trouble::Controller,
            Trip::Overrun => Trouble::Overrun,
            Trip::Supply => of_supply(inputs),
            Trip::Lever => Trouble::LeverMissing,
            Trip::AngleMissing => Trouble::AngleMissing,
            Trip::AngleJumps => Trouble::AngleJumps,
            Trip::AngleFrozen => Trouble::AngleFrozen,
            Trip::AngleNoisy => Trouble::AngleNoisy,
            Trip::NotFollowing => Trouble::NotFollowing,
            Trip::Against => Trouble::Against,
            Trip::CoilOpen => match self.last_asked {
                Some(Coil::Lift) => Trouble::LiftCoilOpen,
                Some(Coil::Lowering) => Trouble::LoweringCoilOpen,
                None => Trouble::Coils,
            },
            Trip::CoilShort | Trip::CoilStuck => of_short(inputs),
            Trip::Reference => Trouble::Reference,
            Trip::SensorSupply => of_sensor_supply(inputs),
            Trip::AngleTracks => Trouble::AngleTracks,
            Trip::Clock => Trouble::Clock,
            Trip::EnableLine => Trouble::EnableLine,
            Trip::Memory => Trouble::Memory,
            Trip::BeyondLimit => Trouble::BeyondLimit,
            Trip::NoConsent => Trouble::NoConsent,
            Trip::Ride => Trouble::Ride,
        }
    }
}

/// How long a speed has to be missing: a start or a change of its sender is no fault.
const SPEED_LOST: Millisecond = Millisecond(1_000);

/// How long a speed has been missing.
#[derive(Clone, Copy, Debug, Default)]
struct Missing(Millisecond);

impl Missing {
    /// One millisecond; true once the speed is lost.
    fn is_lost(&mut self, is_missing: bool) -> bool {
        self.0 = self.0.counted_while(is_missing).min(SPEED_LOST);
        self.0 >= SPEED_LOST
    }
}

/// Threshold between supply too low and too high.
const MIDDLE_OF_SUPPLY: MilliVolt = MilliVolt(12_000);

fn of_supply(inputs: &Inputs) -> Trouble {
    match inputs.supply {
        Some(supply) if supply > MIDDLE_OF_SUPPLY => Trouble::SupplyHigh,
        _ => Trouble::SupplyLow,
    }
}

/// Threshold between sensor supply too low and too high.
const NOMINAL_SENSOR_SUPPLY: MilliVolt = MilliVolt(5_000);

fn of_sensor_supply(inputs: &Inputs) -> Trouble {
    match inputs.sensor_supply {
        Some(supply) if supply > NOMINAL_SENSOR_SUPPLY => Trouble::SensorSupplyHigh,
        _ => Trouble::SensorSupplyLow,
    }
}

/// The coil with the larger excess of current.
fn of_short(inputs: &Inputs) -> Trouble {
    match (inputs.lift_current, inputs.lower_current) {
        (Some(lift), Some(lower)) if lift > lower => Trouble::LiftCoilShort,
        (Some(lift), Some(lower)) if lower > lift => Trouble::LoweringCoilShort,
        (Some(_), None) => Trouble::LiftCoilShort,
        (None, Some(_)) => Trouble::LoweringCoilShort,
        _ => Trouble::Coils,
    }
}

fn of_fault(fault: Fault, inputs: &Inputs) -> Trouble {
    match fault {
        Fault::Lever => Trouble::LeverMissing,
        Fault::Angle => Trouble::AngleMissing,
        Fault::Sinking => Trouble::Sinking,
        Fault::NotMoving | Fault::NotFollowing => Trouble::NotFollowing,
        Fault::Envelope => Trouble::Controller,
        Fault::Coil => Trouble::Coils,
        Fault::Supply => of_supply(inputs),
        Fault::Overrun => Trouble::Overrun,
        Fault::Reference => Trouble::Reference,
        Fault::SensorSupply => of_sensor_supply(inputs),
        Fault::EnableLine => Trouble::EnableLine,
        Fault::Memory => Trouble::Memory,
    }
}

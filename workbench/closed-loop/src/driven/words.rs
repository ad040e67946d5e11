//! States and faults of the controller in words.

use hitch_quantities::{Fault, Reason, State, Trip, Trouble};

/// A state, and what the operator can do in it.
pub const fn state(state: State) -> &'static str {
    match state {
        State::Locked => "Locked: move the lever through the position of the hitch.",
        State::Holding => "Holding: both coils are off.",
        State::Lifting => "Lifting.",
        State::Lowering => "Lowering.",
        State::Settling => "Settling: the check valve closes.",
        State::Stalled => "Stalled: the hitch did not move; the next attempt follows.",
        State::Fault => "Fault: both coils are off.",
        State::TransportLock => "Transport lock: both coils are off.",
        State::Floating => "Floating: the hitch follows the ground.",
        State::Teaching => "Teaching.",
    }
}

/// A fault.
pub const fn fault(fault: Fault) -> &'static str {
    match fault {
        Fault::Lever => "the lever signal is missing or out of range",
        Fault::Angle => "the angle signal is missing, out of range, jumps or is frozen",
        Fault::Sinking => "the hitch sinks",
        Fault::NotMoving => "flow is demanded, and the hitch does not move",
        Fault::Envelope => "the safety envelope found a forbidden command or motion",
        Fault::NotFollowing => "the angle shows less travel than the current must have caused",
        Fault::Coil => "a coil, its wire or its driver is faulty",
        Fault::Supply => "the supply voltage is out of range",
        Fault::Overrun => "the controller is called too late, or its clock is wrong",
        Fault::Reference => "the reference of the converters is wrong",
        Fault::SensorSupply => "the supply of the sensors is out of range",
        Fault::EnableLine => "the enable line of the drivers is faulty",
        Fault::Memory => "the calibration in memory has changed",
    }
}

/// A row of the safety envelope.
pub const fn trip(trip: Trip) -> &'static str {
    match trip {
        Trip::Stale => "no fresh command",
        Trip::BothCoils => "both coils requested",
        Trip::Overrun => "step too late or too early",
        Trip::Supply => "supply out of range",
        Trip::Lever => "lever signal missing or out of range",
        Trip::AngleMissing => "angle signal missing or out of range",
        Trip::AngleJumps => "angle signal jumps",
        Trip::AngleFrozen => "angle signal frozen",
        Trip::AngleNoisy => "angle signal noisy",
        Trip::NotFollowing => "travel too small for the current",
        Trip::Against => "motion against the energised coil",
        Trip::CoilOpen => "coil open",
        Trip::CoilShort => "coil shorted",
        Trip::CoilStuck => "driver stuck",
        Trip::Reference => "reference wrong",
        Trip::SensorSupply => "sensor supply out of range",
        Trip::AngleTracks => "tracks of the angle sensor disagree",
        Trip::Clock => "clock wrong",
        Trip::EnableLine => "enable line faulty",
        Trip::Memory => "calibration memory damaged",
        Trip::BeyondLimit => "current beyond a limit of the travel",
        Trip::NoConsent => "current on a set point without consent",
        Trip::Ride => "current of ride damping that must not be",
    }
}

/// What determines the set point.
pub const fn reason(reason: Option<Reason>) -> &'static str {
    match reason {
        None => "the lever",
        Some(Reason::Draft) => "the draft",
        Some(Reason::Mix) => "draft and position, weighted by the mix dial",
        Some(Reason::DepthLimit) => "the draft, above the lever",
        Some(Reason::Floor) => "the lever, which is the lowest position and is reached",
        Some(Reason::Ceiling) => "the upper limit, which is reached",
        Some(Reason::Slip) => "the slip, which is above its limit",
        Some(Reason::AboveGround) => "the lever, until the implement works in the ground",
        Some(Reason::Holds) => "the present depth, held until the lever takes over",
        Some(Reason::Ride) => "ride damping about the lever",
        Some(Reason::Engages) => "quick engagement, which lowers into the soil",
        Some(Reason::Depth) => "the depth sensor",
    }
}

/// A lost sensor of draft, depth or slip control.
pub const fn trouble(trouble: Trouble) -> &'static str {
    match trouble {
        Trouble::PinRange => "a draft pin is missing or out of its range",
        Trouble::PinsDisagree => "the draft pins disagree",
        Trouble::PinFrozen => "a draft pin is frozen",
        Trouble::GroundSpeed => "the ground speed is missing",
        Trouble::WheelSpeed => "the wheel speed is missing",
        Trouble::SpeedFrozen => "a speed is frozen while the other one changes",
        Trouble::DepthRange => "the depth sensor is missing or out of its range",
        Trouble::DepthFrozen => "the depth sensor is frozen",
        Trouble::DepthNoisy => "the depth sensor is too noisy",
        Trouble::PinNoisy => "a draft pin is too noisy",
    }
}

//! Limit status, exit code and trouble codes of the bus in words.

use hitch_protocols::j1939::trouble::Code;
use hitch_protocols::j1939::{ExitCode, LimitStatus, Trouble};

/// Who commands the hitch.
pub const fn limit(limit: LimitStatus) -> &'static str {
    match limit {
        LimitStatus::NotLimited => "an implement commands the hitch",
        LimitStatus::OperatorLimited => "the operator commands the hitch",
        LimitStatus::LimitedHigh => "an implement commands the hitch, at its upper limit",
        LimitStatus::LimitedLow => "an implement commands the hitch, at its lower limit",
        LimitStatus::NonRecoverable => "a fault that only a restart clears",
        LimitStatus::Reserved | LimitStatus::NotAvailable => "not stated",
    }
}

/// Why an implement cannot command the hitch; `None` if it can.
pub const fn exit(exit: ExitCode) -> Option<&'static str> {
    Some(match exit {
        ExitCode::Clear | ExitCode::NotAvailable => return None,
        ExitCode::NoOperator => "no operator present",
        ExitCode::Released => "the implement has returned control",
        ExitCode::OperatorOverride => "the operator has control",
        ExitCode::ControlNotValid => "operator control in no valid position",
        ExitCode::Timeout => "the commands stopped",
        ExitCode::OutOfRange => "a command was out of range",
        ExitCode::NotCalibrated => "not calibrated",
        ExitCode::ControlFault => "operator control faulty",
        ExitCode::FunctionFault => "hitch faulty",
        ExitCode::SpeedTooHigh => "ground speed too high",
        ExitCode::OilLevelLow => "oil level too low",
        ExitCode::LockedOut => "hitch locked",
        ExitCode::Error => "error",
    })
}

/// A trouble code.
pub fn trouble(code: &Code) -> String {
    let known = Trouble::ALL.iter().find(|trouble| trouble.code() == *code);
    known.map_or_else(
        || format!("trouble SPN {} FMI {}", code.spn, code.fmi),
        |trouble| known_trouble(*trouble).to_owned(),
    )
}

const fn known_trouble(trouble: Trouble) -> &'static str {
    match trouble {
        Trouble::SupplyHigh => "supply voltage too high",
        Trouble::SupplyLow => "supply voltage too low",
        Trouble::LeverMissing => "lever signal missing or out of range",
        Trouble::LeverHigh => "voltage of the lever too high",
        Trouble::LeverLow => "voltage of the lever too low",
        Trouble::AngleMissing => "angle signal missing or out of range",
        Trouble::AngleHigh => "voltage of the angle sensor too high",
        Trouble::AngleLow => "voltage of the angle sensor too low",
        Trouble::AngleJumps => "angle signal jumps",
        Trouble::AngleFrozen => "angle signal frozen",
        Trouble::AngleNoisy => "angle signal noisy",
        Trouble::NotFollowing => "the hitch does not follow an open valve",
        Trouble::Sinking => "the hitch sinks",
        Trouble::Against => "motion against the energised coil",
        Trouble::LiftCoilOpen => "lift coil open",
        Trouble::LiftCoilShort => "lift coil shorted or its driver stuck",
        Trouble::LoweringCoilOpen => "lowering coil open",
        Trouble::LoweringCoilShort => "lowering coil shorted or its driver stuck",
        Trouble::Coils => "a coil or its driver faulty",
        Trouble::Overrun => "controller called too late",
        Trouble::Controller => "invalid request of the controller",
        Trouble::CalibrationLost => "no valid calibration: the factory calibration is in use",
        Trouble::CalibrationCopyLost => "one of the two stored calibrations damaged",
        Trouble::CylinderPressure => "cylinder pressure out of range",
        Trouble::PumpPressure => "pump pressure out of range",
        Trouble::Reference => "reference of the converters out of tolerance",
        Trouble::SensorSupplyHigh => "sensor supply too high",
        Trouble::SensorSupplyLow => "sensor supply too low",
        Trouble::AngleTracks => "tracks of the angle sensor disagree",
        Trouble::Clock => "clock rate wrong",
        Trouble::EnableLine => "enable line of the drivers faulty",
        Trouble::Memory => "calibration changed in memory",
        Trouble::BeyondLimit => "current beyond a limit of the travel",
        Trouble::NoConsent => "current on a set point without consent",
        Trouble::EngineSpeedLost => "engine speed no longer received",
        Trouble::SafetyValuesLost => "stored safety values lost: locked",
        Trouble::SafetyValuesDiffer => "safety values differ from the shipped ones",
        Trouble::ButtonClosed => "a contact of an external button stays closed",
        Trouble::ButtonContacts => "the contacts of an external button contradict each other",
        Trouble::Crystal => "crystal out of range: locked",
        Trouble::ImageUnsealed => "image without checksum",
        Trouble::ImageForDebugging => "image for debugging",
        Trouble::BusOff => "the ECU has left the bus after too many errors",
        Trouble::FramesLost => "the ECU has lost received frames",
        Trouble::DraftPinMissing => "a draft pin missing or out of range",
        Trouble::DraftPins => "the draft pins disagree, or one is too noisy",
        Trouble::DraftPinFrozen => "a draft pin frozen",
        Trouble::GroundSpeedLost => "ground speed not received",
        Trouble::WheelSpeedLost => "wheel speed not received",
        Trouble::SpeedFrozen => "ground speed or wheel speed frozen",
        Trouble::DepthSensorMissing => "the depth sensor missing or out of range",
        Trouble::DepthSensorFrozen => "the depth sensor frozen",
        Trouble::DepthSensorNoisy => "the depth sensor too noisy",
        Trouble::Ride => "current of ride damping that must not be",
    }
}

//! Draft, depth and slip control: what the operator selects, what determines the set point, and which sensor is missing.

use crate::codes;
use crate::units::Count;

/// Function of the hitch, with the code it has in inputs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Function {
    /// The lever is the position.
    #[default]
    Position = 0,
    /// The draft is regulated, within the calibrated distance below the lever.
    Draft = 1,
    /// Errors of draft and position are weighted by the mix dial.
    Mix = 2,
    /// The draft is regulated, and the lever is the lowest position.
    DepthLimit = 3,
    /// The depth of an external sensor is regulated, within the calibrated distance of the lever.
    Depth = 4,
}

impl Function {
    /// The function with a code; [`Self::Position`] for an unknown one, or without.
    #[must_use]
    pub const fn from_code(code: Option<Count>) -> Self {
        match code {
            Some(Count(1)) => Self::Draft,
            Some(Count(2)) => Self::Mix,
            Some(Count(3)) => Self::DepthLimit,
            Some(Count(4)) => Self::Depth,
            _ => Self::Position,
        }
    }
}

codes! {
    /// The function that sets the set point. Links and traces carry its code; code 0 is the lever alone.
    Reason: u8 {
        /// The draft.
        Draft = 1, "draft";
        /// Draft and position.
        Mix = 2, "mix";
        /// The draft, above the lever.
        DepthLimit = 3, "depth-limit";
        /// The lever is the lowest position, and is reached.
        Floor = 4, "floor";
        /// The upper limit is reached.
        Ceiling = 5, "ceiling";
        /// The slip is above its limit.
        Slip = 6, "slip";
        /// A function of the draft or the depth is selected, but the implement is above the ground, or the hitch has not rested for
        /// long enough for the depth sensor: the lever.
        AboveGround = 7, "above-ground";
        /// A function has ended or lost its sensor: the present depth is held until the lever takes over.
        Holds = 8, "holds";
        /// Ride damping moves the hitch about the lever's set point.
        Ride = 9, "ride";
        /// The switch of quick engagement is held: the hitch is lowered into the soil.
        Engages = 10, "engages";
        /// The depth of the external sensor.
        Depth = 11, "depth";
    }
}

codes! {
    /// Sensor of draft, depth or slip control that is lost, with the code it has on links and in traces; 0 is none.
    Trouble: u8 {
        /// A draft pin is missing or out of its range.
        PinRange = 1, "pin-range";
        /// The draft pins disagree.
        PinsDisagree = 2, "pins-disagree";
        /// A draft pin stands still to the last bit while the implement works.
        PinFrozen = 3, "pin-frozen";
        /// The ground speed is missing.
        GroundSpeed = 4, "ground-speed";
        /// The wheel speed is missing.
        WheelSpeed = 5, "wheel-speed";
        /// A speed stands still to the last bit while the other one changes.
        SpeedFrozen = 6, "speed-frozen";
        /// The depth sensor is missing or out of its range.
        DepthRange = 7, "depth-range";
        /// The depth sensor stands still to the last bit while the implement works.
        DepthFrozen = 8, "depth-frozen";
        /// The depth sensor is too noisy.
        DepthNoisy = 9, "depth-noisy";
        /// A draft pin is too noisy.
        PinNoisy = 10, "pin-noisy";
    }
}

/// Both in a byte: the reason in its low half, the trouble in its high half; 0 is none.
pub(super) fn to_byte(reason: Option<Reason>, trouble: Option<Trouble>) -> u8 {
    let reason = reason.map_or(0, |reason| reason as u8);
    let trouble = trouble.map_or(0, |trouble| trouble as u8);
    reason | trouble << 4
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_in_order_and_each_pair_has_its_own_byte() {
        let reasons = Reason::ALL.iter().enumerate();
        assert!(reasons.into_iter().all(|(at, of)| *of as usize == at + 1));
        let troubles = Trouble::ALL.iter().enumerate();
        assert!(troubles.into_iter().all(|(at, of)| *of as usize == at + 1));
        assert_eq!(to_byte(None, None), 0);
        assert_eq!(to_byte(Some(Reason::Slip), None), 6);
        assert_eq!(to_byte(Some(Reason::Holds), Some(Trouble::PinFrozen)), 0x38);
    }

    #[test]
    fn an_unknown_function_is_position_control() {
        for (code, function) in [
            (1, Function::Draft),
            (2, Function::Mix),
            (3, Function::DepthLimit),
            (0, Function::Position),
            (4, Function::Depth),
            (5, Function::Position),
            (-1, Function::Position),
        ] {
            assert_eq!(Function::from_code(Some(Count(code))), function);
        }
        assert_eq!(Function::from_code(None), Function::Position);
    }
}

//! The scaling of the board with the STM32F405.

use hitch_ecu::BoardScaling;
use hitch_quantities::calibration::fitted::Fitted;

/// The nominal board's, with a second track of the rocker-angle sensor on PA5.
pub const SCALING: BoardScaling = BoardScaling {
    fitted: Fitted {
        second_track: true,
        second_contact: true,
    },
    ..BoardScaling::NOMINAL
};

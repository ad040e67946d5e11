//! The scaling of the board with the STM32F405.

use hitch_ecu::BoardScaling;

/// The nominal board's, with a second track of the rocker-angle sensor on PA5.
pub const SCALING: BoardScaling = BoardScaling {
    second_track: true,
    ..BoardScaling::NOMINAL
};

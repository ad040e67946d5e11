//! The scaling of the board with the STM32G474.

use hitch_ecu::{AdcCode, BoardScaling};

/// The nominal board's, with a second track of the rocker-angle sensor on PA5.
pub const SCALING: BoardScaling = BoardScaling {
    // A band gap of 1.212 V, 1.182 to 1.232 V (DS12288, VREFINT).
    reference: AdcCode::new(1_504),
    second_track: true,
    ..BoardScaling::NOMINAL
};

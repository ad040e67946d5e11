//! The scaling of the board with the STM32G474.

use hitch_ecu::{AdcCode, BoardScaling};
use hitch_quantities::calibration::class::Fitted;

/// The nominal board's, with a second track of the rocker-angle sensor on PA5.
pub const SCALING: BoardScaling = BoardScaling {
    // A band gap of 1.212 V, 1.182 to 1.232 V (DS12288, VREFINT).
    reference: AdcCode::new(1_504),
    fitted: Fitted {
        second_track: true,
        second_contact: true,
    },
    ..BoardScaling::NOMINAL
};

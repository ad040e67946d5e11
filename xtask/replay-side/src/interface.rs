//! Inputs, outputs and limits of this commit as words; the conversions are written by `build.rs`.

use hitch_controller::Controller;
// Which units there are differs from commit to commit.
#[allow(clippy::wildcard_imports)]
use hitch_quantities::units::*;
use hitch_quantities::{Calibration, Inputs, Outputs, Switches, ValidCalibration};
use hitch_safety::Limits;

use crate::word;

include!(concat!(env!("OUT_DIR"), "/interface.rs"));

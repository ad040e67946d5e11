//! The code of the internal reference, as measured by the manufacturer for each part.

use hitch_ecu::{AdcCode, BoardScaling};

use super::part::SCALING;
use super::part::factory_reference::{FACTORY_REFERENCE, FACTORY_REFERENCE_MV};

/// Voltage of the converters' reference on the board, mV.
const REFERENCE_MV: u32 = 3_300;
/// Tolerance of the internal reference, per mille (DS8626 and DS12288: 2.5 %), plus one digit.
const TOLERANCE_PER_MILLE: u32 = 26;

/// The board's scaling with the code of the part. A part without a plausible value gets the typical one.
pub fn scaling() -> BoardScaling {
    // SAFETY: a half-word of the system memory, which is always there.
    let factory = u32::from(unsafe { (FACTORY_REFERENCE as *const u16).read_volatile() });
    let code = factory * FACTORY_REFERENCE_MV / REFERENCE_MV;
    let typical = u32::from(SCALING.reference.get());
    if code.abs_diff(typical) * 1_000 <= typical * TOLERANCE_PER_MILLE {
        BoardScaling {
            reference: AdcCode::new(code as u16),
            ..SCALING
        }
    } else {
        SCALING
    }
}

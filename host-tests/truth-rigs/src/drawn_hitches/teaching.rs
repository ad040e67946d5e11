//! Teaching of a drawn machine by the firmware, as in service.

use hitch_control::commissioning::teach::TeachError;
use hitch_quantities::ValidCalibration;
use hitch_quantities::units::MilliDegreePerSecond;

use super::draw::Drawn;
use super::session::Session;

/// Longest time for which switch and button are held, ms.
const LONGEST_MS: usize = 120_000;
/// Where the lever rests meanwhile, degree.
const LEVER_DEG: f64 = 60.0;

/// The `calibration`, taught on this machine from where it rests first.
pub fn taught(
    drawn: &Drawn,
    calibration: &ValidCalibration,
) -> Result<ValidCalibration, TeachError> {
    let mut session = Session::new(drawn, calibration);
    for _ in 0..100 {
        session.step(LEVER_DEG);
    }
    let found = (0..LONGEST_MS).find_map(|_| {
        session.step_with(LEVER_DEG, |inputs| {
            inputs.switches.teach = true;
            inputs.jog = Some(MilliDegreePerSecond(1));
        });
        session.taught()
    });
    found
        .unwrap_or(Err(TeachError::Aborted))?
        .applied_to(calibration)
        .validate()
        .map_err(|_| TeachError::OutOfRange)
}

//! Model of the hitch during teaching: the response of the calibrated valve to the same current.

use hitch_quantities::Calibration;
use hitch_quantities::fixed::{Divisor, behind};
use hitch_quantities::piston::piston_speed;
use hitch_quantities::units::{Micrometre, MilliAmp};

use crate::estimation::spool_lag::nominal_lags;
use crate::valve::drop_scale::DropScale;
use crate::valve::phase::Direction;

/// Valve, spool and piston according to the calibration.
#[derive(Clone, Copy, Debug, Default)]
pub struct Twin {
    spool_ua: i32,
    travel_nm: i32,
    filtered_nm: i32,
}

impl Twin {
    /// One step with a current; the travel, through the filter of the angle.
    pub fn step(
        &mut self,
        current_ua: i32,
        direction: Direction,
        scale: DropScale,
        calibration: &Calibration,
    ) -> Micrometre {
        let [lift_lag, lower_lag] = nominal_lags(&calibration.hydraulics);
        let lag = match direction {
            Direction::Lift => lift_lag,
            Direction::Lower => lower_lag,
        };
        self.spool_ua = behind(self.spool_ua, current_ua, lag.divisor());
        let spool = MilliAmp(Divisor::THOUSAND.divide(self.spool_ua));
        let flow = match direction {
            Direction::Lift => calibration.lift.flow(spool),
            Direction::Lower => scale.to_present(calibration.lower.flow(spool)),
        };
        let speed = piston_speed(flow, calibration.hydraulics.piston_area);
        self.travel_nm = self.travel_nm.saturating_add(speed.0);
        let time = calibration.teach.filter_time.divisor();
        self.filtered_nm = behind(self.filtered_nm, self.travel_nm, time);
        Micrometre(Divisor::THOUSAND.divide(self.filtered_nm))
    }
}

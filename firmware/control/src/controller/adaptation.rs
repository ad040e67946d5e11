//! State estimation and adaptation of one step.

use hitch_quantities::CoilCurrents;
use hitch_quantities::units::{Micrometre, Millisecond};

use super::Control;
use crate::estimation::delayed_output::LaggingAngle;
use crate::operator::mode::Mode;
use crate::sensing::sensors::Sensed;
use crate::valve::phase::Phase;

impl Control {
    /// Takes in the currents that are regulated in this step.
    pub fn set_regulated_currents(&mut self, currents: CoilCurrents) {
        // In jog mode the speed falls with the linkage ratio, not to zero: the bias does not decay then.
        let slowing = self.hysteresis.is_active() && matches!(self.mode, Mode::Position);
        self.motion.apply_currents(
            self.adaptation.offsets().to_nominal_currents(currents),
            slowing,
            self.scale,
            &self.calibration,
        );
    }

    /// Updates motion, load and rest position from the sensors and the last currents.
    pub(super) fn observe(&mut self, sensed: &Sensed) {
        let calibration = &self.calibration;
        let measured = calibration.linkage.travel(sensed.angle);
        let (phase, lag) = (self.phase, calibration.sensors.angle_lag);
        let lagging = LaggingAngle {
            angle: sensed.angle,
            lag,
            linkage: &calibration.linkage,
        };
        let lagging = (lag > Millisecond::ZERO).then_some(&lagging);
        self.motion
            .update(measured, lagging, phase, &calibration.motion);
        self.motion
            .update_spool_lag(measured, phase, &calibration.motion, lag);
        self.load.update(
            sensed.cylinder_pressure,
            self.phase,
            &self.motion,
            &calibration.hydraulics,
        );
        self.scale = self.curves.scale(self.load.drop());
        let rests = matches!(self.phase, Phase::Holding)
            && self.ride.demand().is_none()
            && self.angle_has_settled();
        self.rest
            .update(self.motion.position(), rests, &calibration.hold);
        self.drift.tick(&calibration.hold);
        self.adapt(rests);
    }

    /// True if the angle sensor shows where the hitch is. A lag that is a fifth off makes the estimate wrong by a fifth of
    /// the distance that the signal trails by: that may be half of the restart band, as much remains for the place where
    /// a move ends.
    pub(super) fn angle_has_settled(&self) -> bool {
        let band = self.position.bands(&self.calibration.position).restart_band;
        self.motion
            .is_shown_within(Micrometre(band.0.saturating_mul(5) / 2))
    }

    /// Adapts spool lag and threshold offset once a move is finished. `rests`: and the angle sensor shows it.
    fn adapt(&mut self, rests: bool) {
        let Some(recorder) = self.adaptation.follow(rests, &self.motion) else {
            return;
        };
        let calibration = &self.calibration;
        let rest = self.rest.position();
        let record = recorder.result(rest, self.scale, calibration.hydraulics.piston_area);
        let noise = self.distances.noise;
        let of_offset = self
            .adaptation
            .offsets()
            .attributed_to_offset(&record, noise);
        if self
            .motion
            .learn_from_move(&record, of_offset, rest, calibration)
        {
            self.adaptation.learn(&record, noise);
        }
    }
}

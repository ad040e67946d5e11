//! State estimation and adaptation of one step.

use hitch_quantities::CoilCurrents;

use super::Control;
use crate::operator::mode::Mode;
use crate::sensing::sensors::Sensed;

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
        self.motion
            .update(measured, self.phase, &calibration.motion);
        self.motion
            .update_spool_lag(measured, self.phase, &calibration.motion);
        self.load.update(
            sensed.cylinder_pressure,
            self.phase,
            &self.motion,
            &calibration.hydraulics,
        );
        self.scale = self.curves.scale(self.load.drop());
        self.rest
            .update(self.motion.position(), self.phase, &calibration.hold);
        self.drift.tick(&calibration.hold);
        self.adapt();
    }

    /// Adapts spool lag and threshold offset once a move is finished.
    fn adapt(&mut self) {
        let Some(recorder) = self.adaptation.follow(self.phase, &self.motion) else {
            return;
        };
        let calibration = &self.calibration;
        let rest = self.rest.position();
        let record = recorder.result(rest, self.scale, calibration.hydraulics.piston_area);
        let of_offset = self.adaptation.offsets().attributed_to_offset(&record);
        if self
            .motion
            .learn_from_move(&record, of_offset, rest, &calibration.motion)
        {
            self.adaptation.learn(&record);
        }
    }
}

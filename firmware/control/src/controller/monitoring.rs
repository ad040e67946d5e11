//! Stall and drift monitoring of moves.

use hitch_quantities::Fault;
use hitch_quantities::units::MicrometrePerSecond;

use super::Control;
use crate::motion::position::MoveReason;
use crate::operator::mode::Mode;
use crate::sensing::sensors::Sensed;
use crate::sequencing::stall_detector::is_at_end_of_travel;
use crate::valve::phase::{Direction, Phase};

impl Control {
    /// The hitch stands still and may be in contact with the ground: accepts its position as the set point.
    pub fn accept_ground_contact(&mut self) {
        self.stop();
        self.accept_obstacle(Direction::Lower);
    }

    /// Something is in the way of the hitch: accepts its position as the set point. A lever that was moved to the other side
    /// meanwhile is followed.
    fn accept_obstacle(&mut self, direction: Direction) {
        if direction.sign((self.target.1 - self.motion.position()).0) > 0 {
            self.position.accept();
        }
    }

    /// A move begins. Counts it as a correction if the lever did not demand it. Only a move to a set point is used for
    /// adaptation, because leakage contributes to a correction.
    pub(super) fn begin_move(&mut self, next: Phase) -> Result<(), Fault> {
        self.adaptation.discard_move();
        let Phase::Moving { direction, .. } = next else {
            return Ok(());
        };
        if !matches!(self.mode, Mode::Position) {
            return Ok(());
        }
        match self.position.start() {
            MoveReason::SetPoint => {
                self.motion.enable_closing_delay();
                self.adaptation.begin(direction, self.rest.position());
            }
            MoveReason::Drift => {
                let away = self.target.1 - self.rest.position();
                self.position
                    .begin_correction(direction, away, &self.calibration.position);
                self.drift.start_correction(&self.calibration.hold)?;
            }
        }
        Ok(())
    }

    /// Limits the travel of corrections.
    pub(super) fn check_drift(&mut self) -> Result<(), Fault> {
        let follows_lever = matches!(self.mode, Mode::Position);
        if self.phase.is_moving() && follows_lever && self.position.has_arrived() {
            let speed = self.motion.model_speed();
            self.drift.add_travel(speed, &self.calibration.hold)?;
        }
        Ok(())
    }

    /// Cuts the coil if flow is demanded and the hitch does not move.
    pub(super) fn check_stall(&mut self, sensed: &Sensed) -> Result<(), Fault> {
        let calibration = &self.calibration;
        let (phase, pump) = (self.phase, sensed.pump_pressure);
        if !self.stall.is_stalled(
            phase,
            &self.motion,
            pump,
            &calibration.saturation,
            &calibration.hydraulics,
        ) {
            return Ok(());
        }
        self.stop();
        let lifts = phase.speed() > MicrometrePerSecond::ZERO;
        if is_at_end_of_travel(lifts, sensed, &self.calibration) {
            self.accept_obstacle(Direction::of(phase.speed().0));
            return Ok(());
        }
        self.stall.start_retry_delay(&self.calibration.saturation)
    }

    /// Cuts the coil of a hitch that stands still. The move is not used for adaptation.
    fn stop(&mut self) {
        self.phase = self.phase.cut();
        self.adaptation.discard_move();
        self.motion.discard_move();
    }
}

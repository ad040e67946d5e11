//! A crude hitch for random steps: currents and angle that follow the coils well enough for the envelope to let it move.
//!
//! Rates are those of the nominal valves: 40 deg/s per ampere above the thresholds of 1.13 A and 1.0 A.

/// Thresholds of lift and lowering valve, mA.
const LIFT_THRESHOLD: i32 = 1_130;
const LOWER_THRESHOLD: i32 = 1_000;
/// Ends of travel, mdeg.
const ENDS: (f64, f64) = (46_000.0, 134_000.0);
/// Speed per current above the threshold, mdeg/ms per mA.
const GAIN: f64 = 0.04;
/// Share of the remaining difference that a coil current and the speed make up in a step: time constants of 10 and 40 ms.
const CURRENT_SHARE: f64 = 0.1;
const SPEED_SHARE: f64 = 0.025;

/// The hitch.
#[derive(Clone, Copy, Debug)]
pub struct Hitch {
    angle: f64,
    speed: f64,
    currents: [f64; 2],
}

impl Hitch {
    /// At rest at an angle, mdeg.
    #[must_use]
    pub const fn at(angle: f64) -> Self {
        Self {
            angle,
            speed: 0.0,
            currents: [0.0; 2],
        }
    }

    /// A millisecond under regulated currents, mA.
    pub fn step(&mut self, lift: i32, lower: i32) {
        for (current, target) in self.currents.iter_mut().zip([lift, lower]) {
            *current += CURRENT_SHARE * (f64::from(target) - *current);
        }
        let above = |current: f64, threshold: i32| (current - f64::from(threshold)).max(0.0);
        let target = GAIN
            * (above(self.currents[0], LIFT_THRESHOLD) - above(self.currents[1], LOWER_THRESHOLD));
        self.speed += SPEED_SHARE * (target - self.speed);
        self.angle = (self.angle + self.speed).clamp(ENDS.0, ENDS.1);
    }

    /// Angle, mdeg.
    #[must_use]
    pub fn angle(&self) -> i32 {
        self.angle as i32
    }

    /// Currents of lift and lowering coil, mA.
    #[must_use]
    pub fn currents(&self) -> [i32; 2] {
        self.currents.map(|current| current as i32)
    }
}

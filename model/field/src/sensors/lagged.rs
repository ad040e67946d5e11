//! A sensor with a first-order lag, errors of gain and zero, and noise: radar, wheel speed, depth, acceleration.

use crate::noise::Noise;

/// Constants of a sensor, in the unit of its quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct LaggedConstants {
    /// Time constant, s; 0 for none.
    pub lag_s: f64,
    /// Error of the gain, 1.
    pub gain_error: f64,
    /// Offset, in the unit of the quantity.
    pub offset: f64,
    /// One sigma of the noise of a reading, in the unit of the quantity.
    pub noise: f64,
}

impl LaggedConstants {
    /// Radar for the ground speed in m/s: 0.3 s, 0.03 m/s. As all of these constants, chosen.
    #[must_use]
    pub fn radar() -> Self {
        Self::new(0.3, 0.03)
    }

    /// Gear sensor for the wheel speed in m/s: 0.05 s, 0.01 m/s. An error of the rolling radius is one of the gain.
    #[must_use]
    pub fn wheel_speed() -> Self {
        Self::new(0.05, 0.01)
    }

    /// External depth sensor in m: 0.1 s, 5 mm.
    #[must_use]
    pub fn depth() -> Self {
        Self::new(0.1, 0.005)
    }

    /// Accelerometer in m/s²: 5 ms, 0.05 m/s².
    #[must_use]
    pub fn acceleration() -> Self {
        Self::new(0.005, 0.05)
    }

    fn new(lag_s: f64, noise: f64) -> Self {
        Self {
            lag_s,
            gain_error: 0.0,
            offset: 0.0,
            noise,
        }
    }
}

/// A sensor in use.
#[derive(Debug, Clone)]
pub struct Lagged {
    constants: LaggedConstants,
    followed: f64,
    noise: Noise,
}

impl Lagged {
    /// A sensor that has been at `value` for long.
    #[must_use]
    pub fn new(constants: LaggedConstants, value: f64, noise: Noise) -> Self {
        Self {
            constants,
            followed: value,
            noise,
        }
    }

    /// The reading `dt_s`, s, after the last, during which the quantity was `value`.
    pub fn read(&mut self, value: f64, dt_s: f64) -> f64 {
        let followed = if self.constants.lag_s > 0.0 {
            -(-dt_s / self.constants.lag_s).exp_m1()
        } else {
            1.0
        };
        self.followed += followed * (value - self.followed);
        (1.0 + self.constants.gain_error) * self.followed
            + self.constants.offset
            + self.constants.noise * self.noise.normal()
    }
}

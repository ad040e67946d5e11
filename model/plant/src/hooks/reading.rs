//! Readings of the instruments.

use crate::channel::Channel;

/// Readings of the instruments, in their units.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Reading {
    /// Pump pressure, bar.
    pub pump_pressure_bar: f64,
    /// Cylinder pressure, bar.
    pub cylinder_pressure_bar: f64,
    /// Flow into the cylinder, l/min.
    pub flow_lpm: f64,
    /// Rocker angle, degree; NaN on a flow bench.
    pub rocker_angle_deg: f64,
}

impl Reading {
    /// The reading of one channel, in the channel's unit.
    #[must_use]
    pub fn channel(&self, channel: Channel) -> f64 {
        match channel {
            Channel::PumpPressure => self.pump_pressure_bar,
            Channel::CylinderPressure => self.cylinder_pressure_bar,
            Channel::Flow => self.flow_lpm,
            Channel::RockerAngle => self.rocker_angle_deg,
        }
    }
}

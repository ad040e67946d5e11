//! What the instruments show of the plant.

use super::Plant;
use crate::campaign::Channel;
use crate::expression::Place;
use crate::units;

/// What the instruments show, in their units.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Reading {
    /// Pump pressure, bar.
    pub pump_pressure_bar: f64,
    /// Cylinder pressure, bar.
    pub cylinder_pressure_bar: f64,
    /// Flow into the cylinder, l/min.
    pub flow_lpm: f64,
    /// Rocker angle, degree; on a flow bench not a number.
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

impl Plant<'_> {
    /// The quantities themselves, in the instruments' units.
    pub(super) fn truth(&self) -> Reading {
        Reading {
            pump_pressure_bar: units::bar_from_pa(self.flows.pump_pressure_pa),
            cylinder_pressure_bar: units::bar_from_pa(self.state.pressure_pa),
            flow_lpm: units::lpm_from_m3_s(self.flows.metered_m3_s()),
            rocker_angle_deg: self.rocker_angle_rad().to_degrees(),
        }
    }

    /// A reading with what terms of a user's own add to it.
    pub(super) fn with_sensor_terms(&self, mut reading: Reading) -> Reading {
        let term = |place| self.sites.term(place, &self.signals);
        if !self.sites.terms.is_empty() {
            reading.pump_pressure_bar += units::bar_from_pa(term(Place::PumpPressureSensor));
            reading.cylinder_pressure_bar +=
                units::bar_from_pa(term(Place::CylinderPressureSensor));
            reading.flow_lpm += units::lpm_from_m3_s(term(Place::FlowSensor));
            reading.rocker_angle_deg += term(Place::AngleSensor).to_degrees();
        }
        reading
    }
}

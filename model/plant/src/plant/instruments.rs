//! Readings of the instruments.

use super::Plant;
use crate::hooks::place::Place;
use crate::hooks::reading::Reading;
use crate::units;

impl Plant<'_> {
    /// The true quantities, in the instruments' units.
    #[inline(always)]
    pub(crate) fn truth(&self) -> Reading {
        Reading {
            pump_pressure_bar: units::bar_from_pa(self.flows.pump_pressure_pa),
            cylinder_pressure_bar: units::bar_from_pa(self.state.pressure_pa),
            flow_lpm: units::lpm_from_m3_s(self.flows.metered_m3_s()),
            rocker_angle_deg: self.rocker_angle_rad().to_degrees(),
        }
    }

    /// A reading with user-defined terms added.
    pub(crate) fn with_sensor_terms(&self, mut reading: Reading) -> Reading {
        let term = |place| self.hooks.term(place, &self.signals);
        if !self.hooks.terms.is_empty() {
            reading.pump_pressure_bar += units::bar_from_pa(term(Place::PumpPressureSensor));
            reading.cylinder_pressure_bar +=
                units::bar_from_pa(term(Place::CylinderPressureSensor));
            reading.flow_lpm += units::lpm_from_m3_s(term(Place::FlowSensor));
            reading.rocker_angle_deg += term(Place::AngleSensor).to_degrees();
        }
        reading
    }
}

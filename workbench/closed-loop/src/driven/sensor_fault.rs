//! Faults of a sensor, as the controller sees them.

use hitch_quantities::Inputs;
use hitch_quantities::units::{MilliBar, MilliDegree};
use serde::Deserialize;

/// A sensor of the controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sensor {
    /// Rocker angle; offset in degree.
    Angle,
    /// Position of the lever; offset in degree.
    Lever,
    /// Cylinder pressure; offset in bar.
    CylinderPressure,
    /// Pump pressure; offset in bar.
    PumpPressure,
}

/// Kind of a fault.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// The signal keeps its value.
    Frozen,
    /// There is no signal.
    Open,
    /// The signal is too high by this many degrees or bar.
    Offset(f64),
}

/// A broken sensor.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct SensorFault {
    /// The sensor.
    pub sensor: Sensor,
    /// Its fault.
    pub kind: Kind,
}

impl Sensor {
    fn signal(self, inputs: &Inputs) -> Option<i32> {
        match self {
            Self::Angle => inputs.rocker_angle.map(|angle| angle.0),
            Self::Lever => inputs.lever.map(|angle| angle.0),
            Self::CylinderPressure => inputs.cylinder_pressure.map(|pressure| pressure.0),
            Self::PumpPressure => inputs.pump_pressure.map(|pressure| pressure.0),
        }
    }

    fn set(self, inputs: &mut Inputs, signal: Option<i32>) {
        match self {
            Self::Angle => inputs.rocker_angle = signal.map(MilliDegree),
            Self::Lever => inputs.lever = signal.map(MilliDegree),
            Self::CylinderPressure => inputs.cylinder_pressure = signal.map(MilliBar),
            Self::PumpPressure => inputs.pump_pressure = signal.map(MilliBar),
        }
    }
}

/// Applies a fault to the inputs of one controller; remembers the frozen value.
#[derive(Debug, Default)]
pub struct Wiring {
    frozen: Option<(Sensor, Option<i32>)>,
}

impl Wiring {
    /// The inputs of a step with a fault.
    pub fn apply(&mut self, fault: Option<SensorFault>, inputs: &mut Inputs) {
        let Some(SensorFault { sensor, kind }) = fault else {
            self.frozen = None;
            return;
        };
        let signal = sensor.signal(inputs);
        if kind != Kind::Frozen {
            self.frozen = None;
        }
        let shown = match kind {
            Kind::Open => None,
            Kind::Offset(by) => {
                let by = (by * 1e3).round() as i32;
                signal.map(|signal| signal.saturating_add(by))
            }
            Kind::Frozen => match self.frozen {
                Some((known, kept)) if known == sensor => kept,
                _ => {
                    self.frozen = Some((sensor, signal));
                    signal
                }
            },
        };
        sensor.set(inputs, shown);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(wiring: &mut Wiring, kind: Option<Kind>, angle: i32) -> Option<i32> {
        let sensor = Sensor::Angle;
        let mut inputs = Inputs {
            rocker_angle: Some(MilliDegree(angle)),
            ..Inputs::default()
        };
        wiring.apply(kind.map(|kind| SensorFault { sensor, kind }), &mut inputs);
        inputs.rocker_angle.map(|angle| angle.0)
    }

    #[test]
    fn a_frozen_signal_keeps_its_value_until_it_is_repaired() {
        let mut wiring = Wiring::default();
        assert_eq!(shown(&mut wiring, Some(Kind::Frozen), 80_000), Some(80_000));
        assert_eq!(shown(&mut wiring, Some(Kind::Frozen), 90_000), Some(80_000));
        assert_eq!(shown(&mut wiring, None, 90_000), Some(90_000));
        assert_eq!(shown(&mut wiring, Some(Kind::Frozen), 95_000), Some(95_000));
    }

    #[test]
    fn an_open_circuit_has_no_signal_and_an_offset_is_added() {
        let mut wiring = Wiring::default();
        assert_eq!(shown(&mut wiring, Some(Kind::Open), 80_000), None);
        let offset = Some(Kind::Offset(-2.5));
        assert_eq!(shown(&mut wiring, offset, 80_000), Some(77_500));
    }
}

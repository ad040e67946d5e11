//! `pressure-sensor-offset`: constant offset of the cylinder pressure sensor.
//!
//! `y = p + o`; 0.25 to 1 % of a full scale of 250 or 350 bar is 0.6 to 3.5 bar, more with temperature.

use hitch_plant::hooks::effect_hooks::{EffectHooks, RunConditions, SensorStage};
use hitch_plant::{Channel, Parameter, Reading};

use crate::described::Described;

/// Offset of the cylinder pressure sensor.
pub static PRESSURE_SENSOR_OFFSET: Described = Described {
    id: "pressure-sensor-offset",
    title: "Offset of the cylinder pressure sensor",
    equation: "y = p_C + offset",
    source: "data sheets of mobile pressure sensors, 0.25 to 1 % of full scale",
    shows: "constant deviation of the cylinder pressure while pump pressure and flows fit; in \
         pressure alone easily taken for dead weight",
    parameters: &[Parameter {
        meaning: "offset of the reading",
        typical: 0.8,
        low: -20.0,
        high: 20.0,
        ..Parameter::quantity("offset", "bar", "offset_bar")
    }],
    channels: &[Channel::CylinderPressure],
    attach,
    ..Described::USUAL
};

fn attach(values: &[f64], _: RunConditions<'_>, hooks: &mut EffectHooks) {
    hooks.sensors.push(Box::new(Offset {
        offset_bar: values[0],
    }));
}

#[derive(Debug, Clone)]
struct Offset {
    offset_bar: f64,
}

impl SensorStage for Offset {
    fn rest(&mut self, reading: &mut Reading) {
        reading.cylinder_pressure_bar += self.offset_bar;
    }

    fn advance(&mut self, reading: &mut Reading, _: f64) {
        self.rest(reading);
    }
}

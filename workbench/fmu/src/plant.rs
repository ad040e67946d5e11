//! The plant as a component.

use std::sync::Arc;

use hitch_model_file::{scalars, with_scalars};
use hitch_plant::units::{bar_from_pa, pa_from_bar};
use hitch_plant::{Channel, Currents, HitchRig, Model, Plant, Rig};

use crate::component::{Component, Refusal, boolean, real};
use crate::variable::{Causality, Value, Variable};

/// Longest communication step, s. It bounds the time of one call.
pub const LONGEST_STEP_S: f64 = 3600.0;

/// Indices of the variables. The model's own parameters are behind them.
mod index {
    pub const LIFT_CURRENT: usize = 0;
    pub const LOWER_CURRENT: usize = 1;
    /// Four channels, in their order.
    pub const CHANNELS: usize = 2;
    pub const TRUE_ANGLE: usize = 6;
    pub const ROCKER_SPEED: usize = 7;
    pub const TRAVEL: usize = 8;
    pub const PISTON_SPEED: usize = 9;
    pub const IDLE_PRESSURE: usize = 10;
    pub const LOAD: usize = 11;
    pub const OIL_TEMPERATURE: usize = 12;
    pub const START_ANGLE: usize = 13;
    pub const FLOW_BENCH: usize = 14;
    pub const PORT_PRESSURE: usize = 15;
    pub const MODEL: usize = 16;
}

self_cell::self_cell!(
    /// A plant with the model that it borrows.
    struct OwnedPlant {
        owner: Box<Model>,
        #[covariant]
        dependent: Plant,
    }
);

/// The plant of a model, with its parameters.
pub struct PlantComponent {
    model: Model,
    variables: Arc<[Variable]>,
    plant: Option<OwnedPlant>,
}

impl PlantComponent {
    /// The plant of a model, not yet begun.
    #[must_use]
    pub fn new(model: Model) -> Self {
        let mut variables = inputs().to_vec();
        variables.extend(outputs());
        variables.extend(conditions(&model));
        variables.extend(scalars(&model).into_iter().map(|scalar| {
            Variable::real(
                // Hyphens are no part of a structured name.
                &scalar.name.replace('-', "_"),
                Causality::Parameter,
                (scalar.value, scalar.unit),
                (scalar.low, scalar.high),
                &scalar.meaning,
            )
        }));
        Self {
            model,
            variables: variables.into(),
            plant: None,
        }
    }
}

fn inputs() -> [Variable; 2] {
    let current = |name, coil| {
        let text = format!(
            "current in the {coil} coil at the end of the step; it changes linearly from the last step's"
        );
        Variable::real(name, Causality::Input, (0.0, "A"), (-10.0, 10.0), &text)
    };
    [
        current("lift_current_a", "lift"),
        current("lower_current_a", "lowering"),
    ]
}

fn outputs() -> Vec<Variable> {
    let mut outputs: Vec<Variable> = Channel::ALL
        .into_iter()
        .map(|channel| {
            let text = match channel {
                Channel::PumpPressure => "pressure between pump and valve block",
                Channel::CylinderPressure => "pressure between valve block and cylinder",
                Channel::Flow => "flow between valve block and cylinder, positive into the cylinder",
                Channel::RockerAngle => {
                    "angle of the rocker arm as its sensor shows it; 90 is straight down, it grows as the hitch rises"
                }
            };
            Variable::output(channel.key(), channel.unit(), text)
        })
        .collect();
    let more = [
        (
            "true_rocker_angle_deg",
            "deg",
            "angle of the rocker arm without errors of its sensor",
        ),
        (
            "rocker_speed_deg_per_s",
            "deg/s",
            "angular speed of the rocker arm, positive as the hitch rises",
        ),
        (
            "piston_travel_mm",
            "mm",
            "travel of the piston; zero with the hitch fully down",
        ),
        (
            "piston_speed_mm_per_s",
            "mm/s",
            "speed of the piston, positive upwards",
        ),
        (
            "idle_pressure_bar",
            "bar",
            "pump pressure with the lift valve closed",
        ),
    ];
    outputs.extend(more.map(|(name, unit, text)| Variable::output(name, unit, text)));
    outputs
}

fn conditions(model: &Model) -> Vec<Variable> {
    let (low_rad, _) = model.linkage().swing_rad();
    let parameter =
        |name, start, range, text| Variable::real(name, Causality::Parameter, start, range, text);
    vec![
        parameter(
            "load_kg",
            (model.usual_loads_kg()[1], "kg"),
            (0.0, 20_000.0),
            "load at the hitch point",
        ),
        parameter(
            "oil_temperature_c",
            (40.0, "degC"),
            (-40.0, 150.0),
            "oil temperature",
        ),
        parameter(
            "start_angle_deg",
            (low_rad.to_degrees(), "deg"),
            (0.0, 180.0),
            "rocker angle at the start as its sensor shows it; beyond an end of the stroke it is that end",
        ),
        Variable::new(
            "flow_bench",
            Causality::Parameter,
            Value::Boolean(false),
            "",
            "true: a flow bench instead of cylinder, linkage and load; angles and travel are then not a number",
        ),
        parameter(
            "port_pressure_bar",
            (0.0, "bar"),
            (0.0, 400.0),
            "pressure at the cylinder port of a flow bench",
        ),
    ]
}

impl Component for PlantComponent {
    fn variables(&self) -> &[Variable] {
        &self.variables
    }

    fn initialise(&mut self, values: &mut [Value]) -> Result<(), Refusal> {
        let own: Vec<f64> = (index::MODEL..self.variables.len())
            .map(|index| real(values, index))
            .collect();
        let model = with_scalars(&self.model, &own).map_err(|error| {
            Refusal(format!(
                "the parameters of the linkage: {error}; change them"
            ))
        })?;
        let rig = rig(&model, values);
        let at_rest = Currents {
            lift_a: real(values, index::LIFT_CURRENT),
            lower_a: real(values, index::LOWER_CURRENT),
        };
        let oil_temperature_c = real(values, index::OIL_TEMPERATURE);
        let plant = OwnedPlant::new(Box::new(model), |model| {
            Plant::new(model, rig, oil_temperature_c, at_rest)
        });
        show(&plant, values);
        self.plant = Some(plant);
        Ok(())
    }

    fn step(&mut self, values: &mut [Value], slopes: &[f64], dt_s: f64) -> Result<(), Refusal> {
        if dt_s > LONGEST_STEP_S {
            return Err(Refusal(format!(
                "the communication step is {dt_s} s; take steps of at most {LONGEST_STEP_S} s"
            )));
        }
        let Some(plant) = &mut self.plant else {
            return Err(Refusal("the plant has not been initialised".to_owned()));
        };
        let at_end = |index: usize| real(values, index) + slopes.get(index).unwrap_or(&0.0) * dt_s;
        let currents = Currents {
            lift_a: at_end(index::LIFT_CURRENT),
            lower_a: at_end(index::LOWER_CURRENT),
        };
        plant.with_dependent_mut(|_, plant| plant.step(currents, dt_s));
        show(plant, values);
        Ok(())
    }

    fn copy(&self) -> Box<dyn Component> {
        let copied = |plant: &OwnedPlant| {
            OwnedPlant::new(plant.borrow_owner().clone(), |model| {
                plant.borrow_dependent().copied_onto(model)
            })
        };
        Box::new(Self {
            model: self.model.clone(),
            variables: Arc::clone(&self.variables),
            plant: self.plant.as_ref().map(copied),
        })
    }
}

fn rig(model: &Model, values: &[Value]) -> Rig {
    if boolean(values, index::FLOW_BENCH) {
        return Rig::Flow {
            port_pressure_pa: pa_from_bar(real(values, index::PORT_PRESSURE)),
        };
    }
    let (low_rad, high_rad) = model.linkage().swing_rad();
    let start_rad = real(values, index::START_ANGLE).to_radians();
    Rig::Hitch(HitchRig {
        load_kg: real(values, index::LOAD),
        start_angle_rad: start_rad.clamp(low_rad, high_rad),
    })
}

/// Puts the outputs among the values.
fn show(plant: &OwnedPlant, values: &mut [Value]) {
    let model = plant.borrow_owner();
    let plant = plant.borrow_dependent();
    let reading = plant.reading();
    let state = plant.state();
    let angle_rad = plant.rocker_angle_rad();
    let speed_m_s = state.speed_m_s;
    let (on_bench, turning_rad_s) = if angle_rad.is_nan() {
        (true, f64::NAN)
    } else {
        (
            false,
            speed_m_s * model.linkage().angle_slope_rad_m(angle_rad),
        )
    };
    let on_hitch = |value: f64| if on_bench { f64::NAN } else { value };
    let mut put = |index: usize, value: f64| {
        if let Some(place) = values.get_mut(index) {
            *place = Value::Real(value);
        }
    };
    for channel in Channel::ALL {
        put(index::CHANNELS + channel.index(), reading.channel(channel));
    }
    put(index::TRUE_ANGLE, angle_rad.to_degrees());
    put(index::ROCKER_SPEED, turning_rad_s.to_degrees());
    put(index::TRAVEL, on_hitch(state.piston_m * 1e3));
    put(index::PISTON_SPEED, on_hitch(speed_m_s * 1e3));
    put(index::IDLE_PRESSURE, bar_from_pa(plant.idle_pressure_pa()));
}

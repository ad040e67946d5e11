//! The loop, in steps of a millisecond.

use hitch_field::soil::SoilPlan;
use hitch_field::terrain::Terrain;
use hitch_field::tractor::{Demand, Outputs as Field, Readings, Tractor, TractorConstants};
use hitch_plant::Model;
use hitch_quantities::units::{MillimetrePerSecond, SupplyShare};
use hitch_quantities::{Inputs, ValidCalibration};

use super::coupling::{Coupling, RAISED_DEG, TOUCH_DEG};
use super::settings::Settings;
use crate::closed_loop::{ClosedLoop, Sample};

/// Depth of the links, m, with which a plough works at 25 cm in loam: the body sinks by the rest (docs/field.md).
pub const LINK_DEPTH_M: f64 = 0.228;
/// Output of the depth sensor over its supply at the ground, 1: `depth.zero` of a new machine.
const DEPTH_ZERO: f64 = 0.25;
/// Depth that adds the whole supply to it, m: four times `depth.span` of a new machine.
const DEPTH_SUPPLY_M: f64 = 0.8;
/// Outputs at the stops of its arm, 1: it hangs on one of them while the implement is raised.
const DEPTH_STOPS: [f64; 2] = [0.12, 0.88];
/// Step of a 12-bit converter that measures a sensor over its supply, thousandths of a percent.
const CONVERTER_STEP: f64 = 1e5 / 4096.0;
/// Period in which the bus tells the speeds, ms.
const BUS_PERIOD_MS: u64 = 100;
const STEP_S: f64 = 1e-3;
/// Oil temperature of a start that does not tell it, C.
const OIL_TEMPERATURE_C: f64 = 40.0;

/// How a rig starts.
#[derive(Debug, Clone, Copy)]
pub struct Start {
    /// Rocker angle, degree.
    pub angle_deg: f64,
    /// Oil temperature, C.
    pub oil_temperature_c: f64,
    /// Determines soil and noise.
    pub seed: u64,
}

impl Start {
    /// A raised hitch with warm oil.
    #[must_use]
    pub const fn raised(seed: u64) -> Self {
        Self {
            angle_deg: RAISED_DEG,
            oil_temperature_c: OIL_TEMPERATURE_C,
            seed,
        }
    }
}

/// A millisecond of the loop.
#[derive(Debug, Clone, Copy)]
pub struct FieldSample {
    /// Hitch and controller.
    pub hitch: Sample,
    /// Tractor and field.
    pub field: Field,
}

/// Hitch, controller, tractor and field.
pub struct FieldRig<'m> {
    hitch: ClosedLoop<'m>,
    tractor: Tractor,
    coupling: Coupling<'m>,
    readings: Option<Readings>,
    step: u64,
}

impl<'m> FieldRig<'m> {
    /// A tractor that stands with a raised implement, whose lever is at the hitch. The seed determines soil and noise.
    #[must_use]
    pub fn new(
        model: &'m Model,
        calibration: &ValidCalibration,
        field: (TractorConstants, SoilPlan),
        terrain: Terrain,
        seed: u64,
    ) -> Self {
        Self::starting(model, calibration, field, terrain, Start::raised(seed))
    }

    /// A tractor that stands, whose lever is at the hitch.
    #[must_use]
    pub fn starting(
        model: &'m Model,
        calibration: &ValidCalibration,
        (constants, soil): (TractorConstants, SoilPlan),
        terrain: Terrain,
        start: Start,
    ) -> Self {
        let implement_kg = constants.implement.mass_kg;
        let mut hitch = ClosedLoop::new(
            model,
            calibration,
            implement_kg,
            start.oil_temperature_c,
            start.angle_deg,
            start.seed,
        );
        hitch.pick_up();
        Self {
            hitch,
            tractor: Tractor::new(constants, soil, terrain, start.seed),
            coupling: Coupling::new(model, TOUCH_DEG, implement_kg),
            readings: None,
            step: 0,
        }
    }

    /// Geometry of hitch and ground.
    #[must_use]
    pub const fn coupling(&self) -> &Coupling<'m> {
        &self.coupling
    }

    /// The tractor.
    pub const fn tractor(&mut self) -> &mut Tractor {
        &mut self.tractor
    }

    /// Changes the oil temperature, C, while it runs.
    pub fn set_oil_temperature_c(&mut self, oil_temperature_c: f64) {
        self.hitch.set_oil_temperature_c(oil_temperature_c);
    }

    /// One millisecond; `tell` can modify the inputs of the controller (faults of sensors).
    pub fn step(
        &mut self,
        lever_deg: f64,
        speed_m_s: f64,
        settings: &Settings,
        tell: impl FnOnce(&mut Inputs),
    ) -> FieldSample {
        let readings = self.readings;
        let is_told = self.step.is_multiple_of(BUS_PERIOD_MS);
        let hitch = self.hitch.step_with(
            lever_deg,
            |inputs| {
                if let Some(readings) = readings {
                    add_readings(inputs, &readings, is_told);
                }
                settings.tell(inputs);
                tell(inputs);
            },
            |_, _| {},
        );
        let field = self.tractor.step(
            Demand {
                link_depth_m: self.coupling.depth_m(hitch.angle_deg),
                speed_m_s,
            },
            STEP_S,
        );
        let load_kg = self
            .coupling
            .load_kg(hitch.angle_deg, field.draft_n, field.vertical_n);
        self.hitch.set_load_kg(load_kg);
        self.readings = Some(field.readings);
        self.step += 1;
        FieldSample { hitch, field }
    }
}

fn add_readings(inputs: &mut Inputs, readings: &Readings, is_told: bool) {
    let output = |share: f64| {
        let read = (share * 1e5 / CONVERTER_STEP).round() * CONVERTER_STEP;
        Some(SupplyShare(read.round() as i32))
    };
    inputs.left_pin = output(readings.pins.left);
    inputs.right_pin = output(readings.pins.right);
    let depth = DEPTH_ZERO + readings.depth_m / DEPTH_SUPPLY_M;
    let [up, down] = DEPTH_STOPS;
    inputs.depth_sensor = output(depth.clamp(up, down));
    let speed =
        |m_s: f64| is_told.then_some(MillimetrePerSecond((m_s.max(0.0) * 1e3).round() as i32));
    inputs.ground_speed = speed(readings.ground_speed_m_s);
    inputs.wheel_speed = speed(readings.wheel_speed_m_s);
}

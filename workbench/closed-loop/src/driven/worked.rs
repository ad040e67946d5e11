//! A hitch of the page on its field.

use hitch_field::soil::Stretch;
use hitch_field::tractor::{Outputs as Field, TractorConstants};
use hitch_plant::Model;
use hitch_quantities::{Inputs, ValidCalibration};

use super::field_orders::FieldOrders;
use super::field_view::{FieldNow, FieldView};
use crate::closed_loop::Sample;
use crate::field::{FieldRig, FieldSample, Start};

/// Begin of a changed soil in front of the rear axle, m: it comes into the drawing, and the front axle is behind it.
const AHEAD_M: f64 = 4.0;
/// Length of a soft patch, m.
const PATCH_M: f64 = 20.0;

/// Hitch, controller, tractor and field with what the page has ordered last.
pub struct WorkedHitch<'m> {
    rig: FieldRig<'m>,
    known: FieldOrders,
    /// Samples of the strip charts since the last answer.
    samples: Vec<Field>,
    last: Option<FieldSample>,
}

impl<'m> WorkedHitch<'m> {
    /// A hitch at rest behind a tractor that stands.
    pub fn new(
        model: &'m Model,
        calibration: &ValidCalibration,
        orders: FieldOrders,
        start: Start,
    ) -> Self {
        let field = (TractorConstants::ploughing(), orders.plan());
        let terrain = orders.terrain(start.seed);
        Self {
            rig: FieldRig::starting(model, calibration, field, terrain, start),
            known: orders,
            samples: Vec::new(),
            last: None,
        }
    }

    /// Takes new orders; without any, the last ones stay. A changed soil, and a soft patch, begin in front of the tractor.
    pub fn order(&mut self, orders: Option<FieldOrders>) {
        let Some(orders) = orders else { return };
        let before = std::mem::replace(&mut self.known, orders);
        let from_m = self.last.map_or(0.0, |last| last.field.distance_m) + AHEAD_M;
        let soil = self.rig.tractor().soil_mut();
        if orders.soil != before.soil {
            soil.change_texture(from_m, orders.soil.texture());
        }
        if orders.soft_patches > before.soft_patches {
            soil.add_stretch(Stretch::soft_patch(from_m, PATCH_M));
        }
    }

    /// One millisecond; a sample of the strip charts is kept if `is_shown`.
    pub fn step(
        &mut self,
        lever_deg: f64,
        tell: impl FnOnce(&mut Inputs),
        is_shown: impl FnOnce(&Sample) -> bool,
    ) -> Sample {
        let (speed_m_s, settings) = (self.known.speed_m_s, self.known.settings());
        let sample = self.rig.step(lever_deg, speed_m_s, &settings, tell);
        if is_shown(&sample.hitch) {
            self.samples.push(sample.field);
        }
        self.last = Some(sample);
        sample.hitch
    }

    /// Changes the oil temperature, C.
    pub fn set_oil_temperature_c(&mut self, oil_temperature_c: f64) {
        self.rig.set_oil_temperature_c(oil_temperature_c);
    }

    /// What the page shows of the steps since the last call.
    pub fn view(&mut self) -> FieldView {
        let tractor = self.rig.tractor();
        let now = self
            .last
            .map(|last| FieldNow::of(&last.field, &last.hitch.outputs, tractor));
        FieldView::of(&std::mem::take(&mut self.samples), now)
    }
}

//! Both hitches of a page.

use super::hitch::Hitch;
use super::machine::Machine;
use super::orders::Orders;
use super::strip::HitchView;

/// A hitch with the calibration of the initial model, and one with that of the present model.
pub struct Pair<'m>([Hitch<'m>; 2]);

impl<'m> Pair<'m> {
    /// Both at rest at an angle, degree.
    #[must_use]
    pub fn new(machine: &'m Machine, orders: &Orders, angle_deg: f64) -> Self {
        let calibrations = machine.calibrations();
        Self(calibrations.map(|both| Hitch::new(&machine.plant, both, orders, angle_deg)))
    }

    /// Advances both by `steps` milliseconds; returns the samples and the state at the end of each.
    pub fn advance(&mut self, orders: &Orders, steps: u32) -> [HitchView; 2] {
        self.0.each_mut().map(|hitch| hitch.advance(orders, steps))
    }
}

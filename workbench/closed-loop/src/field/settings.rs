//! What the operator has set for the work.

use hitch_quantities::units::{Count, Micrometre, Newton, PerMille};
use hitch_quantities::{Function, Inputs};

/// What the operator has set.
#[derive(Debug, Clone, Copy, Default)]
pub struct Settings {
    /// Selected function.
    pub function: Function,
    /// Set point of the draft, N.
    pub draft_n: Option<f64>,
    /// Set point of the depth, m.
    pub depth_m: Option<f64>,
    /// Mix dial, 0 to 1.
    pub mix: Option<f64>,
    /// Slip limit, 0 to 1.
    pub slip_limit: Option<f64>,
    /// The switch of quick engagement is held.
    pub engage: bool,
}

impl Settings {
    /// Sets the inputs of the controller.
    pub fn tell(&self, inputs: &mut Inputs) {
        let share = |part: f64| PerMille((part * 1e3).round() as i32);
        inputs.function = Some(Count(self.function as i32));
        inputs.draft_set_point = self.draft_n.map(|force| Newton(force.round() as i32));
        inputs.depth_set_point = self
            .depth_m
            .map(|depth_m| Micrometre((depth_m * 1e6).round() as i32));
        inputs.mix = self.mix.map(share);
        inputs.slip_limit = self.slip_limit.map(share);
        inputs.switches.engage = self.engage;
    }
}

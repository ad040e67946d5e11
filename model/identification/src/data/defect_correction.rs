//! Defect correction: the difference between simulations with fine and coarse time steps.
//!
//! A search simulates thousands of changes, for which time steps of twice the length are almost as accurate at half the
//! cost. The error of the coarse steps (a phase error of ringing after some periods) is computed once, at the start of
//! the search, and added to every coarse simulation. At the start this reproduces the fine simulation, and nearby the
//! error of the steps cancels in all differences. Fits and evidence use fine simulations.

use hitch_plant::simulation::Trace;

/// Difference between a fine and a coarse simulation of a run.
#[derive(Debug, Clone)]
pub(crate) struct DefectCorrection(Trace);

impl DefectCorrection {
    /// The difference of a fine and a coarse simulation of the same model.
    pub fn new(fine: &Trace, coarse: &Trace) -> Self {
        let difference = |(fine, coarse): (&Vec<f64>, &Vec<f64>)| {
            let samples = fine.iter().zip(coarse);
            samples.map(|(fine, coarse)| fine - coarse).collect()
        };
        Self(Trace {
            channels: std::array::from_fn(|c| difference((&fine.channels[c], &coarse.channels[c]))),
            true_angle_deg: difference((&fine.true_angle_deg, &coarse.true_angle_deg)),
            idle_pressure_bar: 0.0,
        })
    }

    /// A coarse simulation with the correction added.
    pub fn added_to(&self, mut coarse: Trace) -> Trace {
        let difference = self.0.channels.iter().chain([&self.0.true_angle_deg]);
        let channels = coarse
            .channels
            .iter_mut()
            .chain([&mut coarse.true_angle_deg]);
        for (values, difference) in channels.zip(difference) {
            for (value, difference) in values.iter_mut().zip(difference) {
                *value += difference;
            }
        }
        coarse
    }
}

//! What drafts are short of fine simulations.
//!
//! A search asks thousands of times how a simulation changes with an effect, and the same integrator in steps twice as
//! long answers that nearly as well at half the penalty. What the long steps themselves make of a run (ringing that is
//! out of phase after some periods) is reckoned once, where the search starts, and added to every draft: there it is a
//! fine simulation, and nearby the error of the steps cancels in every difference. Fits and evidence take fine ones.

use hitch_plant::simulation::Trace;

/// What drafts of a run are short of fine simulations.
#[derive(Debug, Clone)]
pub(crate) struct DefectCorrection(Trace);

impl DefectCorrection {
    /// Between a fine simulation and a draft of the same.
    pub fn new(fine: &Trace, draft: &Trace) -> Self {
        let short = |(fine, draft): (&Vec<f64>, &Vec<f64>)| {
            let samples = fine.iter().zip(draft);
            samples.map(|(fine, draft)| fine - draft).collect()
        };
        Self(Trace {
            channels: std::array::from_fn(|c| short((&fine.channels[c], &draft.channels[c]))),
            true_angle_deg: short((&fine.true_angle_deg, &draft.true_angle_deg)),
            idle_pressure_bar: 0.0,
        })
    }

    /// A draft with as much added.
    pub fn added_to(&self, mut draft: Trace) -> Trace {
        let short = self.0.channels.iter().chain([&self.0.true_angle_deg]);
        let coarse_in_time = draft.channels.iter_mut().chain([&mut draft.true_angle_deg]);
        for (values, short) in coarse_in_time.zip(short) {
            for (value, short) in values.iter_mut().zip(short) {
                *value += short;
            }
        }
        draft
    }
}

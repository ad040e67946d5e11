//! Stretches of samples of a run, and means over them.

use std::ops::Range;

use hitch_plant::Currents;
use hitch_plant::simulation::Trace;

/// Stretches of samples of a run, one per sample of the condensed run.
#[derive(Debug, Clone)]
pub(crate) struct Stretches(pub Vec<Range<usize>>);

impl Stretches {
    /// Number of stretches.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// The first sample of each stretch.
    pub fn firsts(&self) -> impl Iterator<Item = usize> {
        self.0.iter().map(|stretch| stretch.start)
    }

    /// Number of samples in each stretch.
    pub fn sizes(&self) -> Vec<f64> {
        self.0.iter().map(|stretch| stretch.len() as f64).collect()
    }

    /// Mean over each stretch.
    pub fn means(&self, values: &[f64]) -> Vec<f64> {
        let mean = |stretch: &Range<usize>| {
            values[stretch.clone()].iter().sum::<f64>() / stretch.len() as f64
        };
        self.0.iter().map(mean).collect()
    }

    /// Mean over each stretch of both currents, A.
    pub fn mean_currents(&self, currents: &[Currents]) -> Vec<Currents> {
        let mean = |stretch: &Range<usize>| {
            let share = 1.0 / stretch.len() as f64;
            let own = currents[stretch.clone()].iter();
            own.fold(Currents::default(), |sum, current| Currents {
                lift_a: sum.lift_a + share * current.lift_a,
                lower_a: sum.lower_a + share * current.lower_a,
            })
        };
        self.0.iter().map(mean).collect()
    }

    /// Mean over each stretch of every channel of a trace.
    pub fn mean_trace(&self, trace: &Trace) -> Trace {
        Trace {
            channels: std::array::from_fn(|channel| self.means(&trace.channels[channel])),
            true_angle_deg: self.means(&trace.true_angle_deg),
            idle_pressure_bar: trace.idle_pressure_bar,
        }
    }
}

//! Simulation of a whole run: the plant driven by logged currents.

use crate::channel::Channel;
use crate::model::Model;
use crate::plant::Plant;
use crate::solver::dynamic::Steps;
use crate::state::Rig;
use crate::units::bar_from_pa;
use crate::valve::Currents;

/// Readings of the instruments over a run, by [`Channel::index`], in the channels' units.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trace {
    /// One value per sample for each channel.
    pub channels: [Vec<f64>; 4],
    /// True rocker angle, degree, without sensor errors; NaN on a flow bench.
    pub true_angle_deg: Vec<f64>,
    /// Pump pressure with the lift valve closed, bar.
    pub idle_pressure_bar: f64,
}

impl Trace {
    /// Simulated samples of one channel.
    #[must_use]
    pub fn channel(&self, channel: Channel) -> &[f64] {
        &self.channels[channel.index()]
    }

    /// Keeps some of the samples, given in ascending order.
    pub fn keep(&mut self, samples: &[usize]) {
        for channel in self.channels.iter_mut().chain([&mut self.true_angle_deg]) {
            for (to, &from) in samples.iter().enumerate() {
                channel[to] = channel[from];
            }
            channel.truncate(samples.len());
        }
    }
}

/// Simulates a run that starts at rest with its first currents.
///
/// `time_s` must increase; the currents are linear between samples.
#[must_use]
pub fn simulate(
    model: &Model,
    rig: Rig,
    oil_temperature_c: f64,
    time_s: &[f64],
    currents: &[Currents],
) -> Trace {
    simulate_in(Steps::FINE, model, rig, oil_temperature_c, time_s, currents)
}

/// [`simulate`] with other time steps.
#[must_use]
pub fn simulate_in(
    steps: Steps,
    model: &Model,
    rig: Rig,
    oil_temperature_c: f64,
    time_s: &[f64],
    currents: &[Currents],
) -> Trace {
    let mut trace = Trace {
        channels: std::array::from_fn(|_| Vec::with_capacity(time_s.len())),
        true_angle_deg: Vec::with_capacity(time_s.len()),
        idle_pressure_bar: f64::NAN,
    };
    let Some(first) = currents.first() else {
        return trace;
    };
    let mut plant = Plant::new(model, rig, oil_temperature_c, *first).in_steps(steps);
    trace.idle_pressure_bar = bar_from_pa(plant.idle_pressure_pa());
    for (sample, currents) in currents.iter().enumerate() {
        if sample > 0 {
            plant.step(*currents, time_s[sample] - time_s[sample - 1]);
        }
        let reading = plant.reading();
        trace
            .true_angle_deg
            .push(plant.rocker_angle_rad().to_degrees());
        for channel in Channel::ALL {
            trace.channels[channel.index()].push(reading.channel(channel));
        }
    }
    trace
}

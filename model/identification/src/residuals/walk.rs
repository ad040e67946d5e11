//! Random walk of a run's simulated angle.
//!
//! The angle integrates the flow, so errors of the logged currents accumulate. A stop ends the walk: the hitch arrives a
//! little earlier or later than simulated, and then stands at the stop.

use hitch_plant::simulation::Trace;
use hitch_plant::{Channel, Currents, Model, units};

use crate::data::experiment::Experiment;
use crate::data::ready_run::ReadyRun;

/// Distance from an end of the swing, degree, within which the hitch rests against the stop.
const AT_A_STOP_DEG: f64 = 0.2;

/// Standard deviations of the simulated angle within which a hitch near a stop may have reached it.
const SIGMAS: f64 = 2.0;

/// Time after leaving a stop during which the trapped oil still rings, s: a heavy load decays to a quarter in it.
const AFTER_A_STOP_S: f64 = 1.5;

/// Random walk of a run's simulated angle.
pub(crate) struct Walk {
    /// Standard deviation of the step at each sample, degree.
    pub steps_deg: Vec<f64>,
    /// Standard deviation of the simulated angle at each sample, degree. A stop ends the walk.
    pub deg: Vec<f64>,
    /// Samples at which the hitch may rest against a stop, and shortly after: pressure and flow then depend on the stop's
    /// stiffness and the impact.
    pub at_a_stop: Vec<bool>,
}

impl Walk {
    /// The walk that follows from the noise of the currents between two traces.
    ///
    /// The hitch arrives earlier or later than simulated, and may stand before a stop where the simulation has reached it. So
    /// it may rest at a stop wherever the distance is within [`SIGMAS`] standard deviations of the angle. The true simulated angle
    /// counts, not the reading of a sensor.
    pub fn new(
        experiment: &Experiment,
        run: &ReadyRun,
        model: &Model,
        traces: [&Trace; 2],
    ) -> Self {
        let free_deg = free_steps_deg(experiment, run, model, traces);
        let (low_rad, high_rad) = model.linkage().swing_rad();
        let stops_deg = [low_rad.to_degrees(), high_rad.to_degrees()];
        let measured_deg = run.measured[Channel::RockerAngle.index()].as_ref();
        let time_s = &run.drive.time_s;
        let mut walk = Self {
            steps_deg: Vec::with_capacity(run.len()),
            deg: Vec::with_capacity(run.len()),
            at_a_stop: Vec::with_capacity(run.len()),
        };
        let (mut deg, mut left_s) = (0.0_f64, f64::NEG_INFINITY);
        for (sample, &free_deg) in free_deg.iter().enumerate() {
            deg = deg.hypot(free_deg);
            let of_traces = traces.iter().map(|trace| trace.true_angle_deg[sample]);
            let angles_deg = of_traces.chain(measured_deg.map(|measured| measured[sample]));
            let distance_deg = angles_deg
                .flat_map(|angle_deg| stops_deg.map(|stop_deg| (angle_deg - stop_deg).abs()))
                .fold(f64::INFINITY, f64::min);
            if distance_deg < AT_A_STOP_DEG.max(SIGMAS * deg) {
                left_s = time_s[sample];
            }
            let at_a_stop = time_s[sample] - left_s <= AFTER_A_STOP_S;
            walk.at_a_stop.push(at_a_stop);
            walk.steps_deg.push(if at_a_stop && free_deg > 0.0 {
                AT_A_STOP_DEG.max(deg)
            } else {
                free_deg
            });
            if distance_deg < AT_A_STOP_DEG {
                deg = AT_A_STOP_DEG;
            }
            walk.deg.push(deg);
        }
        walk
    }
}

/// Standard deviation of the angle's random walk per sample between the stops, degree.
fn free_steps_deg(
    experiment: &Experiment,
    run: &ReadyRun,
    model: &Model,
    [below, above]: [&Trace; 2],
) -> Vec<f64> {
    let area_m2 = model.constants().cylinder.area_m2();
    let linkage = model.linkage();
    let time_s = &run.drive.time_s;
    let noise = experiment.current_noise;
    (0..run.len())
        .map(|sample| {
            if sample == 0 {
                return 0.0;
            }
            let flow_lpm = 0.5
                * (above.channel(Channel::Flow)[sample] - below.channel(Channel::Flow)[sample])
                    .abs();
            if flow_lpm == 0.0 {
                return 0.0;
            }
            let share = active(noise, run.drive.currents[sample])
                / active(run.drive.spread[sample], run.drive.currents[sample]);
            let angle_deg = above.channel(Channel::RockerAngle)[sample];
            let travel_m = units::m3_s_from_lpm(flow_lpm * share) / area_m2
                * (time_s[sample] - time_s[sample - 1]);
            // Variances of independent steps add up.
            travel_m / run.averaged[sample].sqrt()
                * linkage
                    .angle_slope_rad_m(angle_deg.to_radians())
                    .to_degrees()
        })
        .map(|step| step * experiment.current_persistence.sqrt())
        .collect()
}

/// The value of the valve that is driven.
fn active(values: Currents, currents: Currents) -> f64 {
    if currents.lift_a > currents.lower_a {
        values.lift_a
    } else {
        values.lower_a
    }
}

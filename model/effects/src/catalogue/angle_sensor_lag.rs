//! `angle-sensor-lag`: lag of the angle sensor or its filter.
//!
//! `tau y' + y = angle`, first order. Hall sensors lag by 2 to 10 ms; filtering in the logger adds up to about 0.2 s. A
//! sensor that averages over a window, or sends on a bus, also has a dead time before any filter.

use std::collections::VecDeque;

use hitch_plant::components::lag::Lag;
use hitch_plant::hooks::effect_hooks::{EffectHooks, SensorStage};
use hitch_plant::{Channel, Parameter, Reading};

use crate::described::Described;

/// Longest step of a sensor with lag, which interpolates the angle linearly between two steps, s. At the start and end
/// of a motion, steps of 20 ms cause errors as large as the sensor's own noise; whole samples of dead time are affected
/// least.
const STEP_S: f64 = 0.005;

/// A sensor with a filter.
pub static FILTERING: Described = Described {
    id: "angle-sensor-lag",
    title: "Lag of the rocker angle sensor",
    equation: "tau y' + y = angle",
    source: "first-order sensor or input filter; 2 to 10 ms for hall sensors, up to 0.2 s with \
         filtering",
    shows: "the angle trails its true course by speed times lag, in both directions; pressures and \
         flow stay right",
    parameters: &[Parameter {
        meaning: "time constant of the sensor",
        typical: 0.06,
        low: 0.0,
        high: 2.0,
        ..Parameter::time("time_constant", "time_constant_s")
    }],
    channels: &[Channel::RockerAngle],
    attach: |values, _, hooks| attach(values[0], 0.0, hooks),
    ..Described::USUAL
};

/// A sensor with a filter and a dead time.
pub static DELAYED: Described = Described {
    form: Some("delayed"),
    title: "Lag of the rocker angle sensor, with dead time",
    equation: "(1 - dead) lag y' + y = angle(t - dead lag)",
    source: "sensors that average over a window (half of it is dead time) or send on a bus: 5 to 50 ms",
    shows: "the angle trails its true course by speed times lag, and starts late; pressures and flow \
         stay right",
    parameters: &[
        Parameter {
            meaning: "delay behind a steady motion",
            typical: 0.06,
            low: 0.0,
            high: 2.0,
            ..Parameter::time("lag", "lag_s")
        },
        Parameter {
            meaning: "share of it that is dead time",
            typical: 0.5,
            low: 0.0,
            high: 1.0,
            ..Parameter::ratio("dead")
        },
    ],
    attach: |values, _, hooks| {
        let dead_s = values[0] * values[1];
        attach(values[0] - dead_s, dead_s, hooks);
    },
    ..FILTERING
};

fn attach(time_constant_s: f64, dead_s: f64, hooks: &mut EffectHooks) {
    if time_constant_s + dead_s > 0.0 {
        hooks.limit_step(STEP_S);
    }
    hooks.sensors.push(Box::new(DelayedAngle {
        time_constant_s,
        dead_s,
        filter: Lag::at_rest(time_constant_s, 0.0),
        past: VecDeque::new(),
    }));
}

/// A sensor with dead time before its filter.
#[derive(Debug, Clone)]
struct DelayedAngle {
    time_constant_s: f64,
    dead_s: f64,
    filter: Lag,
    /// Buffer of past angles: age, s, and angle, degree; the oldest first, the first at least as old as the dead time.
    past: VecDeque<(f64, f64)>,
}

impl DelayedAngle {
    /// The angle of `dead_s` ago, degree; the present angle is `now_deg`, `dt_s` after the previous one.
    fn delayed_deg(&mut self, now_deg: f64, dt_s: f64) -> f64 {
        for (ago_s, _) in &mut self.past {
            *ago_s += dt_s;
        }
        self.past.push_back((0.0, now_deg));
        while self.past.get(1).is_some_and(|next| next.0 >= self.dead_s) {
            self.past.pop_front();
        }
        match (self.past.front(), self.past.get(1)) {
            (Some(&(older_s, older_deg)), Some(&(newer_s, newer_deg))) => {
                let share = ((older_s - self.dead_s) / (older_s - newer_s)).clamp(0.0, 1.0);
                older_deg + share * (newer_deg - older_deg)
            }
            _ => now_deg,
        }
    }
}

impl SensorStage for DelayedAngle {
    fn rest(&mut self, reading: &mut Reading) {
        self.filter = Lag::at_rest(self.time_constant_s, reading.rocker_angle_deg);
        self.past = [self.dead_s, 0.0]
            .map(|ago_s| (ago_s, reading.rocker_angle_deg))
            .into();
    }

    fn advance(&mut self, reading: &mut Reading, dt_s: f64) {
        let angle_deg = if self.dead_s > 0.0 {
            self.delayed_deg(reading.rocker_angle_deg, dt_s)
        } else {
            reading.rocker_angle_deg
        };
        reading.rocker_angle_deg = self.filter.advance(angle_deg, dt_s);
    }
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;

    use super::DelayedAngle;
    use hitch_plant::Reading;
    use hitch_plant::components::lag::Lag;
    use hitch_plant::hooks::effect_hooks::SensorStage;

    /// A steady motion of 10 degree/s is delayed by the sum of filter lag and dead time; its start shows after the dead
    /// time, at most one step early.
    #[test]
    fn a_ramp_is_followed_as_late_as_the_parameters_say() {
        for (time_constant_s, dead_s) in [(0.0, 0.05), (0.02, 0.03), (0.01, 0.004)] {
            let mut sensor = DelayedAngle {
                time_constant_s,
                dead_s,
                filter: Lag::at_rest(time_constant_s, 0.0),
                past: VecDeque::new(),
            };
            let mut reading = Reading::default();
            sensor.rest(&mut reading);
            for step in 1..=100 {
                let time_s = 0.02 * f64::from(step);
                reading.rocker_angle_deg = 10.0 * time_s;
                sensor.advance(&mut reading, 0.02);
                if time_s <= dead_s - 0.02 {
                    assert!(reading.rocker_angle_deg.abs() < 1e-12);
                }
            }
            let expected = 10.0 * (2.0 - time_constant_s - dead_s);
            assert!((reading.rocker_angle_deg - expected).abs() < 1e-9);
        }
    }
}

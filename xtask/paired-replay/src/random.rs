//! Random steps of a machine: each signal rests, walks, jumps, fails or holds any value for a while.

use fastrand::Rng;
use replay_side::{ABSENT, Event};

use super::Step;
use super::hitch::Hitch;
use super::interface::{Layout, Parameter};

/// The known signals: name, value of a healthy machine, range of healthy values; a signal of another name is 0 or 1. Angles
/// and currents: what is added to the hitch's.
const KINDS: [(&str, i32, (i32, i32)); 19] = [
    ("lever", 90_000, (42_000, 138_000)),
    ("jog", ABSENT, (-20_000, 20_000)),
    ("rocker_angle", 0, (-300, 300)),
    ("cylinder_pressure", 60_000, (0, 180_000)),
    ("pump_pressure", 80_000, (0, 200_000)),
    ("oil_temperature", 50_000, (-20_000, 100_000)),
    ("supply", 13_000, (10_000, 15_500)),
    ("upper_limit", ABSENT, (60_000, 138_000)),
    ("lowering_dial", ABSENT, (0, 1_000)),
    ("engine_speed", 1_500, (700, 2_400)),
    ("lift_current", 0, (-20, 20)),
    ("lower_current", 0, (-20, 20)),
    ("step_time", 1_000, (990, 1_010)),
    ("second_angle", ABSENT, (-300, 300)),
    ("sensor_supply", 5_000, (4_900, 5_100)),
    ("reference", 1_000, (990, 1_010)),
    ("set_point", ABSENT, (50_000, 120_000)),
    ("clock_ratio", 1_000, (990, 1_010)),
    // A fault of it is final: it is left to the failures.
    ("enable_line_fault", 0, (0, 0)),
];
/// Contacts that are closed in a healthy machine.
const CLOSED: [&str; 2] = ["up_released", "down_released"];
/// In one of so many steps: a power-up, a change of the calibration.
const POWER_UP: u32 = 10_000;
const CALIBRATION: u32 = 5_000;
/// Healthy signals, of a hundred segments: the rest fails or takes any value.
const HEALTHY_PERCENT: u32 = 99;
/// Longest segment, and longest failure, ms.
const LONGEST: u32 = 3_000;
const LONGEST_FAILURE: u32 = 400;

/// What a signal does until the end of its segment.
#[derive(Clone, Copy, Debug)]
enum Behaviour {
    /// Keeps its value.
    Rest,
    /// Approaches a value by steps.
    Walk { to: i32, by: i32 },
    /// Another value of its range in each step.
    Noise,
}

/// A signal.
#[derive(Clone, Debug)]
struct Signal {
    healthy: i32,
    range: (i32, i32),
    value: i32,
    behaviour: Behaviour,
    left: u32,
}

impl Signal {
    fn named(name: &str) -> Self {
        let known = KINDS.into_iter().find(|(known, ..)| *known == name);
        let switch = (name, i32::from(CLOSED.contains(&name)), (0, 1));
        let (_, healthy, range) = known.unwrap_or(switch);
        Self {
            healthy,
            range,
            value: healthy,
            behaviour: Behaviour::Rest,
            left: 0,
        }
    }

    fn next(&mut self, random: &mut Rng) -> i32 {
        match self.left {
            0 => self.begin(random),
            _ => self.left -= 1,
        }
        match self.behaviour {
            Behaviour::Rest => {}
            Behaviour::Walk { to, by } => self.value += (to - self.value).clamp(-by, by),
            Behaviour::Noise => self.value = random.i32(self.range.0..=self.range.1),
        }
        self.value
    }

    fn begin(&mut self, random: &mut Rng) {
        let (low, high) = self.range;
        self.behaviour = Behaviour::Rest;
        self.left = random.u32(1..LONGEST);
        let is_switch = self.range == (0, 1);
        if !is_switch && random.u32(0..100) >= HEALTHY_PERCENT {
            self.left = random.u32(1..LONGEST_FAILURE);
            self.value = match random.u8(0..3) {
                0 => ABSENT,
                1 => random.i32(ABSENT + 1..),
                _ => {
                    let beyond = (high - low).max(10);
                    random.i32(low - beyond..=high + beyond)
                }
            };
            return;
        }
        let to = random.i32(low..=high);
        self.value = match random.u8(0..10) {
            0..5 => self.healthy,
            // What is not fitted, or not pressed, in most machines.
            5..8 if self.healthy == ABSENT => ABSENT,
            5..7 if !is_switch && (low..=high).contains(&self.value) => {
                let by = ((high - low) / random.i32(10..5_000)).max(1);
                self.behaviour = Behaviour::Walk { to, by };
                self.value
            }
            7 if !is_switch && self.healthy == 0 => {
                self.behaviour = Behaviour::Noise;
                to
            }
            8 if is_switch => to,
            5..8 if is_switch => self.healthy,
            _ => to,
        };
    }
}

/// A machine with its random signals.
#[derive(Clone, Debug)]
pub struct RandomMachine {
    signals: Vec<Signal>,
    parameters: Vec<Parameter>,
    /// Places of what the hitch measures: angle, second angle, currents.
    angles: [Option<usize>; 2],
    currents: [Option<usize>; 2],
    hitch: Hitch,
    /// Commands to the envelope.
    command: [Signal; 2],
    answered: [i32; 2],
    /// Hitch and measured currents follow the envelope that is stepped beside the controller.
    follows_envelope: bool,
    powers_up: bool,
}

impl RandomMachine {
    /// The hitch of every other machine follows the envelope, that of the rest the controller.
    #[must_use]
    pub fn new(index: usize, layout: &Layout) -> Self {
        let place = |name: &str| layout.inputs.iter().position(|input| input == name);
        let signals = layout.inputs.iter().map(|name| Signal::named(name));
        let current = Signal {
            range: (0, 3_000),
            ..Signal::named("lift_current")
        };
        Self {
            signals: signals.collect(),
            parameters: layout.parameters.clone(),
            angles: [place("rocker_angle"), place("second_angle")],
            currents: [place("lift_current"), place("lower_current")],
            hitch: Hitch::at(90_000.0),
            command: [current.clone(), current],
            answered: [0; 2],
            follows_envelope: index % 2 == 1,
            powers_up: true,
        }
    }

    /// The next step.
    pub fn step(&mut self, random: &mut Rng) -> Step {
        let (event, parameter) = self.event(random);
        let mut inputs: Vec<i32> = self
            .signals
            .iter_mut()
            .map(|signal| signal.next(random))
            .collect();
        let mut add = |place: Option<usize>, measured: i32| {
            if let Some(value) = place
                .map(|place| &mut inputs[place])
                .filter(|value| **value != ABSENT)
            {
                *value = value.saturating_add(measured);
            }
        };
        self.angles
            .into_iter()
            .for_each(|place| add(place, self.hitch.angle()));
        for (place, current) in self.currents.into_iter().zip(self.hitch.currents()) {
            add(place, current);
        }
        Step {
            event,
            parameter,
            command: self.command(random),
            inputs,
        }
    }

    fn event(&mut self, random: &mut Rng) -> (Event, (usize, i32)) {
        if std::mem::take(&mut self.powers_up) || random.u32(0..POWER_UP) == 0 {
            self.hitch = Hitch::at(f64::from(random.i32(46_000..134_000)));
            return (Event::PowerUp, (0, 0));
        }
        if self.parameters.is_empty() || random.u32(0..CALIBRATION) != 0 {
            return (Event::None, (0, 0));
        }
        let index = random.usize(0..self.parameters.len());
        let Parameter {
            nominal, min, max, ..
        } = self.parameters[index];
        let near = (nominal / 10).saturating_abs().max(1);
        let value = match random.u8(0..4) {
            0 => min,
            1 => max,
            2 => random.i32(min..=max),
            _ => nominal
                .saturating_add(random.i32(-near..=near))
                .clamp(min, max),
        };
        (Event::Calibrate, (index, value))
    }

    /// A command to the envelope. In machines that follow the controller it is what the controller did last.
    fn command(&mut self, random: &mut Rng) -> [i32; 3] {
        let rare = |random: &mut Rng, one_of: u32, flag: i32| match random.u32(0..one_of) {
            0 => flag,
            _ => 0,
        };
        // Stale, reset, disarmed, damaged. A damage is final, and a reset is what an operator does after each trip.
        let flags = rare(random, 20_000, 1)
            | rare(random, 100, 2)
            | rare(random, 20_000, 4)
            | rare(random, 100_000, 8);
        if !self.follows_envelope {
            return [self.answered[0], self.answered[1], flags];
        }
        let [lift, lower] = &mut self.command;
        let (lift, lower) = (lift.next(random), lower.next(random));
        // Both coils at once are a trip: seldom.
        match random.u32(0..20_000) {
            0 => [lift, lower, flags],
            _ if lift >= lower => [lift, 0, flags],
            _ => [0, lower, flags],
        }
    }

    /// Takes the answer of the earlier side; if the other one `differs`, the machine is powered up.
    pub fn follow(&mut self, layout: &Layout, answer: &[i32], differs: bool) {
        let both = |names: [&str; 2]| names.map(|name| layout.output(answer, name));
        self.answered = both(["lift_current", "lower_current"]);
        let [lift, lower] = if self.follows_envelope {
            both(["envelope.lift_current", "envelope.lower_current"])
        } else {
            self.answered
        };
        self.hitch.step(lift, lower);
        self.powers_up |= differs;
    }
}

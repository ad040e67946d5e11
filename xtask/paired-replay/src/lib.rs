//! Paired replay: the same steps through controller and envelope of two commits, and every difference of their answers.
//!
//! ```text
//! random signals, crude hitch (steps) --+--> side of the earlier commit --+--> comparison (differences)
//!                                       +--> side of the present one    --+
//! ```
//!
//! A side is a process that was built from the sources of its commit (`xtask/replay-side`); in the tests also the present
//! code in their process. A round steps [`MACHINES`] independent machines, so that the hitch of each can follow the answer
//! of the earlier side at little cost. A machine whose answers differ is powered up again in both sides: the consequences
//! of a difference are not listed.

pub mod differences;
pub mod hitch;
pub mod interface;
pub mod random;
pub mod side;
pub mod sources;
pub mod trace;

use anyhow::{Result, ensure};
use hitch_quantities::Inputs;
use replay_side::Event;

use differences::{Comparison, Differences};
use interface::Layout;
use random::RandomMachine;
use side::Side;

/// Machines of a round.
pub const MACHINES: usize = 64;

/// A step of a machine, apart from the order of the words.
#[derive(Clone, Debug)]
pub struct Step {
    /// What happens before it.
    pub event: Event,
    /// Parameter of the event, as an index into the common parameters, with its value.
    pub parameter: (usize, i32),
    /// Command to the envelope that is stepped beside the controller: lift, lower, mA, and flags.
    pub command: [i32; 3],
    /// Values of the known inputs, in their order; [`replay_side::ABSENT`] for a signal without a value.
    pub inputs: Vec<i32>,
}

/// The differences, and what the earlier side did, to judge the steps.
#[derive(Debug, Default)]
pub struct Replay {
    /// The differences.
    pub differences: Differences,
    /// What the steps have reached.
    pub reached: Reached,
}

/// What the steps have reached in the earlier side.
#[derive(Clone, Debug, Default)]
pub struct Reached {
    /// Steps of a machine.
    pub steps: u64,
    /// Steps with a coil current of the controller.
    pub moving: u64,
    /// Codes of the trips that were seen in the controller or the envelope, a bit each.
    pub trips: u64,
    /// Codes of the states, a bit each.
    pub states: u64,
    /// Accepted changes of the calibration.
    pub calibrations: u64,
}

/// Replays random steps, at least `steps` in all.
///
/// # Errors
/// If a side ends, or has no interface in common with the other.
pub fn random(
    earlier: &mut dyn Side,
    present: &mut dyn Side,
    seed: u64,
    steps: u64,
) -> Result<Replay> {
    let mut pair = Pair::new(earlier, present)?;
    let mut random = fastrand::Rng::with_seed(seed);
    let mut machines: Vec<RandomMachine> = (0..MACHINES)
        .map(|index| RandomMachine::new(index, &pair.layout))
        .collect();
    for _ in 0..steps.div_ceil(MACHINES as u64) {
        let round: Vec<Step> = machines
            .iter_mut()
            .map(|machine| machine.step(&mut random))
            .collect();
        pair.step(&round, |layout, index, answer, differs| {
            machines[index].follow(layout, answer, differs);
        })?;
    }
    Ok(pair.replay)
}

/// Replays the recorded closed loop of the repository.
///
/// # Errors
/// If a side ends, or has no interface in common with the other, or the recording can't be read.
pub fn recorded(earlier: &mut dyn Side, present: &mut dyn Side) -> Result<Replay> {
    let mut pair = Pair::new(earlier, present)?;
    let mut event = Event::PowerUp;
    for record in trace::recorded()? {
        let words = replay_side::words(&Inputs::from_bytes(&record));
        // The recording does not contain the fields that only the earlier side has.
        let value = |name: &String| {
            let place = replay_side::INPUTS.iter().position(|known| known == name);
            place.map_or(0, |place| words[place])
        };
        let step = Step {
            event,
            parameter: (0, 0),
            command: [0; 3],
            inputs: pair.layout.inputs.iter().map(value).collect(),
        };
        event = Event::None;
        pair.step(&[step], |_, _, _, differs| {
            event = if differs { Event::PowerUp } else { Event::None };
        })?;
    }
    Ok(pair.replay)
}

/// Two sides in lock step.
struct Pair<'a> {
    layout: Layout,
    earlier: &'a mut dyn Side,
    present: &'a mut dyn Side,
    replay: Replay,
}

impl<'a> Pair<'a> {
    fn new(earlier: &'a mut dyn Side, present: &'a mut dyn Side) -> Result<Self> {
        Ok(Self {
            layout: Layout::of(earlier.interface(), present.interface())?,
            earlier,
            present,
            replay: Replay::default(),
        })
    }

    /// A round. `follow` gets the index of each machine, the answer of the earlier side in the order of the common
    /// outputs, and whether the sides differ.
    fn step(
        &mut self,
        round: &[Step],
        mut follow: impl FnMut(&Layout, usize, &[i32], bool),
    ) -> Result<()> {
        self.earlier.send(&self.layout.earlier.words(round))?;
        self.present.send(&self.layout.present.words(round))?;
        let mut answers = self.earlier.receive(round.len())?;
        let mut others = self.present.receive(round.len())?;
        answers = self.layout.earlier.common(&answers);
        others = self.layout.present.common(&others);
        let width = self.layout.outputs.len();
        ensure!(
            answers.len() == width * round.len() && others.len() == answers.len(),
            "a side answers too little"
        );
        let pairs = answers.chunks_exact(width).zip(others.chunks_exact(width));
        for (index, (answer, other)) in pairs.enumerate() {
            let differs = answer != other;
            if differs {
                self.replay.differences.add(
                    &self.layout,
                    &Comparison {
                        step: self.replay.reached.steps,
                        machine: index,
                        asked: &round[index],
                        earlier: answer,
                        present: other,
                    },
                );
            }
            self.replay.reached.add(&self.layout, answer);
            follow(&self.layout, index, answer, differs);
        }
        Ok(())
    }
}

impl Reached {
    fn add(&mut self, layout: &Layout, answer: &[i32]) {
        let at = |name: &str| layout.output(answer, name);
        self.steps += 1;
        self.moving += u64::from(at("lift_current") > 0 || at("lower_current") > 0);
        self.trips |= 1 << (at("trip") & 63) | 1 << (at("envelope.trip") & 63);
        self.states |= 1 << (at("state") & 63);
        self.calibrations += u64::from(at("calibration.accepted") != 0);
    }

    /// The codes of a set of bits, without 0.
    #[must_use]
    pub fn codes(bits: u64) -> Vec<u32> {
        (1..64).filter(|code| bits >> code & 1 == 1).collect()
    }
}

#[cfg(test)]
mod tests;

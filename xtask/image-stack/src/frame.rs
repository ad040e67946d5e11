//! How deep a function makes the stack, and how deep it is at each of its calls.

use std::collections::{BTreeMap, btree_map::Entry};

use anyhow::{Context, Result, ensure};

use super::instruction::{Condition, Flow, Instruction, Outcome};
use super::program::{Function, Program};

/// What a call goes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Callee {
    /// The function at an address.
    Function(u32),
    /// Whichever has its address taken.
    ByAddress,
}

/// Where a way through a function has got to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Place {
    address: u32,
    /// What a test of the flags is known to come to, among instructions that depend on it: returns often are a pair of
    /// them, of which either both are carried out or none.
    known: Option<Outcome>,
}

/// Before an instruction: bytes on the stack since the function was entered, and where the frame pointer points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Depth {
    /// Bytes on the stack.
    pub bytes: i32,
    /// Bytes between the frame pointer and where the stack was; nothing if it isn't set up.
    pub frame_pointer: Option<i32>,
}

/// What a function does to the stack.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// Bytes where it is deepest.
    pub deepest: i32,
    /// Before each instruction that can be reached.
    pub depths: BTreeMap<u32, Depth>,
    /// What it calls, and the bytes that are on the stack meanwhile.
    pub calls: Vec<(Callee, i32)>,
    /// Whether it may come back to its caller.
    pub returns: bool,
}

/// Follows all ways through `function`. `returns` tells of each function whether it may come back: code behind a call
/// of one that doesn't belongs to something else.
pub fn frame(
    program: &Program<'_>,
    function: &Function,
    returns: &impl Fn(Callee) -> bool,
) -> Result<Frame> {
    let mut walk = Walk {
        program,
        function,
        returns,
        frame: Frame::default(),
        seen: BTreeMap::new(),
        to_do: Vec::new(),
    };
    walk.go(function.place.start, None, Depth::default());
    while let Some((place, depth)) = walk.to_do.pop() {
        walk.visit(place, depth)
            .with_context(|| format!("in {}, at {:#x}", function.name, place.address))?;
    }
    Ok(walk.frame)
}

struct Walk<'a, R> {
    program: &'a Program<'a>,
    function: &'a Function,
    returns: &'a R,
    frame: Frame,
    seen: BTreeMap<Place, Depth>,
    to_do: Vec<(Place, Depth)>,
}

impl<R: Fn(Callee) -> bool> Walk<'_, R> {
    fn go(&mut self, address: u32, known: Option<Outcome>, depth: Depth) {
        self.to_do.push((Place { address, known }, depth));
    }

    fn visit(&mut self, mut place: Place, depth: Depth) -> Result<()> {
        if !self.function.place.contains(&place.address) {
            return self.leave_for(place.address, depth.bytes);
        }
        let instruction = self.function.instructions.get(&place.address);
        let instruction = instruction.context("it is left for what is no instruction")?;
        if instruction.condition.is_none() {
            place.known = None;
            self.frame.depths.insert(place.address, depth);
        }
        match self.seen.entry(place) {
            Entry::Occupied(seen) => {
                let seen = seen.get().bytes;
                ensure!(
                    seen == depth.bytes,
                    "the stack is {seen} or {} bytes deep, depending on where one comes from",
                    depth.bytes
                );
                Ok(())
            }
            Entry::Vacant(new) => {
                new.insert(depth);
                self.decide(instruction, place.known, depth)
            }
        }
    }

    /// Carries an instruction out, leaves it out, or both, as far as is known of its condition.
    fn decide(
        &mut self,
        instruction: &Instruction,
        known: Option<Outcome>,
        depth: Depth,
    ) -> Result<()> {
        let next = instruction.address + instruction.length;
        let needed = match instruction.condition {
            None => return self.follow(instruction, known, depth),
            Some(Condition::Register) => {
                self.go(next, None, depth);
                return self.follow(instruction, None, depth);
            }
            Some(Condition::Flags(needed)) => needed,
        };
        let settled = known.filter(|known| known.test == needed.test);
        if settled.is_none_or(|known| known != needed) {
            let other = Outcome {
                holds: !needed.holds,
                ..needed
            };
            self.go(next, Some(other), depth);
        }
        if settled.is_none_or(|known| known == needed) {
            self.follow(instruction, Some(needed), depth)?;
        }
        Ok(())
    }

    fn follow(
        &mut self,
        instruction: &Instruction,
        known: Option<Outcome>,
        before: Depth,
    ) -> Result<()> {
        let next = instruction.address + instruction.length;
        let known = known.filter(|_| !instruction.sets_flags);
        let mut after = before;
        after.bytes += instruction.deeper;
        if let Some(above) = instruction.frame_pointer {
            after.frame_pointer = Some(before.bytes - above);
        }
        self.frame.deepest = self.frame.deepest.max(after.bytes);
        match instruction.flow {
            Flow::On => self.go(next, known, after),
            Flow::Jump(target) => self.go(target, None, after),
            Flow::Table { entry_bytes } => {
                let targets = self.program.table(next, entry_bytes, self.function)?;
                targets
                    .into_iter()
                    .for_each(|target| self.go(target, None, after));
            }
            Flow::Call(target) => self.call(Callee::Function(target), next, after)?,
            Flow::CallByAddress => self.call(Callee::ByAddress, next, after)?,
            Flow::JumpByAddress => {
                self.frame.calls.push((Callee::ByAddress, after.bytes));
                self.frame.returns = true;
            }
            Flow::Return => {
                ensure!(
                    after.bytes == 0,
                    "it returns with {} bytes on the stack",
                    after.bytes
                );
                self.frame.returns = true;
            }
            Flow::Nowhere => {}
        }
        Ok(())
    }

    fn call(&mut self, callee: Callee, next: u32, depth: Depth) -> Result<()> {
        if let Callee::Function(target) = callee {
            self.known(target)?;
        }
        self.frame.calls.push((callee, depth.bytes));
        if (self.returns)(callee) {
            self.go(next, None, depth);
        }
        Ok(())
    }

    /// A tail call: another function goes on in this one's place.
    fn leave_for(&mut self, target: u32, bytes: i32) -> Result<()> {
        self.known(target)?;
        let callee = Callee::Function(target);
        self.frame.calls.push((callee, bytes));
        self.frame.returns |= (self.returns)(callee);
        Ok(())
    }

    fn known(&self, target: u32) -> Result<()> {
        ensure!(
            self.program.functions.contains_key(&target),
            "it goes to {target:#x}, where no function begins"
        );
        Ok(())
    }
}

/// The frames of all functions.
pub fn frames(program: &Program<'_>) -> Result<BTreeMap<u32, Frame>> {
    let mut found: BTreeMap<u32, Frame> = BTreeMap::new();
    // Which functions return follows from which return: from none on, until no more are found.
    loop {
        let returns = |callee| match callee {
            Callee::Function(address) => found.get(&address).is_some_and(|frame| frame.returns),
            Callee::ByAddress => true,
        };
        let next: BTreeMap<u32, Frame> = program
            .functions
            .iter()
            .map(|(address, function)| Ok((*address, frame(program, function, &returns)?)))
            .collect::<Result<_>>()?;
        let count =
            |frames: &BTreeMap<u32, Frame>| frames.values().filter(|frame| frame.returns).count();
        let settled = count(&next) == count(&found);
        found = next;
        if settled {
            return Ok(found);
        }
    }
}

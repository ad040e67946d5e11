//! The deepest chain of calls from a function on.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use anyhow::{Result, bail};

use super::frame::{Callee, Frame};
use super::program::Function;

/// Calls, from the outermost in, each with the bytes that it leaves on the stack for the next.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Chain(Vec<(String, i32)>);

impl Chain {
    /// Bytes of the whole.
    pub fn bytes(&self) -> i32 {
        self.0.iter().map(|(_, bytes)| bytes).sum()
    }
}

impl fmt::Display for Chain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0
            .iter()
            .try_for_each(|(name, bytes)| writeln!(f, "{bytes:8} B  {name}"))
    }
}

/// How far a function has been looked into.
enum Search {
    Begun,
    Done(Chain),
}

/// Finds chains, and keeps what was found.
pub struct Chains<'a> {
    functions: &'a BTreeMap<u32, Function>,
    frames: &'a BTreeMap<u32, Frame>,
    /// What a call by address may reach.
    taken: &'a BTreeSet<u32>,
    known: BTreeMap<u32, Search>,
}

impl<'a> Chains<'a> {
    /// Nothing looked into. A call by address goes to one of `taken`.
    pub fn new(
        functions: &'a BTreeMap<u32, Function>,
        frames: &'a BTreeMap<u32, Frame>,
        taken: &'a BTreeSet<u32>,
    ) -> Self {
        Self {
            functions,
            frames,
            taken,
            known: BTreeMap::new(),
        }
    }

    /// The deepest chain from the function at `address` on; an error if it calls itself on any way.
    pub fn deepest(&mut self, address: u32) -> Result<Chain> {
        let (Some(function), Some(frame)) =
            (self.functions.get(&address), self.frames.get(&address))
        else {
            bail!("no function begins at {address:#x}");
        };
        match self.known.get(&address) {
            Some(Search::Done(chain)) => return Ok(chain.clone()),
            Some(Search::Begun) => bail!("{} calls itself, by way of others or not", function.name),
            None => {}
        }
        self.known.insert(address, Search::Begun);
        let mut deepest = Chain(vec![(function.name.clone(), frame.deepest)]);
        for (callee, bytes) in &frame.calls {
            for target in self.targets(*callee) {
                let inner = self.deepest(target)?;
                if bytes + inner.bytes() > deepest.bytes() {
                    let own = (function.name.clone(), *bytes);
                    deepest = Chain(std::iter::once(own).chain(inner.0).collect());
                }
            }
        }
        self.known.insert(address, Search::Done(deepest.clone()));
        Ok(deepest)
    }

    fn targets(&self, callee: Callee) -> Vec<u32> {
        match callee {
            Callee::Function(address) => vec![address],
            Callee::ByAddress => self.taken.iter().copied().collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OUTER: u32 = 0;
    const SHALLOW: u32 = 100;
    const DEEP: u32 = 200;

    fn functions() -> BTreeMap<u32, Function> {
        let named = [(OUTER, "outer"), (SHALLOW, "shallow"), (DEEP, "deep")];
        let function = |(start, name): (u32, &str)| {
            let function = Function {
                name: name.to_owned(),
                place: start..start + 100,
                instructions: BTreeMap::new(),
            };
            (start, function)
        };
        named.into_iter().map(function).collect()
    }

    fn frame(deepest: i32, calls: &[(Callee, i32)]) -> Frame {
        Frame {
            deepest,
            calls: calls.to_vec(),
            ..Frame::default()
        }
    }

    fn deepest(frames: [(u32, Frame); 3], taken: &[u32]) -> Result<Chain> {
        let (functions, frames) = (functions(), BTreeMap::from(frames));
        let taken = taken.iter().copied().collect();
        Chains::new(&functions, &frames, &taken).deepest(OUTER)
    }

    #[test]
    fn the_deepest_call_need_not_be_the_one_with_most_on_the_stack() {
        let outer = frame(
            40,
            &[(Callee::Function(SHALLOW), 40), (Callee::ByAddress, 16)],
        );
        let frames = [
            (OUTER, outer),
            (SHALLOW, frame(8, &[])),
            (DEEP, frame(80, &[])),
        ];
        let chain = deepest(frames, &[DEEP]).unwrap();
        assert_eq!(chain.bytes(), 96);
        assert_eq!(chain.to_string(), "      16 B  outer\n      80 B  deep\n");
    }

    #[test]
    fn a_leaf_under_a_frame_that_was_deeper_before_adds_nothing() {
        let outer = frame(40, &[(Callee::Function(SHALLOW), 8)]);
        let frames = [
            (OUTER, outer),
            (SHALLOW, frame(8, &[])),
            (DEEP, frame(80, &[])),
        ];
        assert_eq!(deepest(frames, &[]).unwrap().bytes(), 40);
    }

    #[test]
    fn recursion_is_refused_even_by_address() {
        let outer = frame(8, &[(Callee::Function(SHALLOW), 8)]);
        let inner = frame(8, &[(Callee::ByAddress, 8)]);
        let frames = [(OUTER, outer), (SHALLOW, inner), (DEEP, frame(0, &[]))];
        let error = deepest(frames, &[OUTER]).unwrap_err();
        assert!(error.to_string().contains("outer calls itself"), "{error}");
    }
}

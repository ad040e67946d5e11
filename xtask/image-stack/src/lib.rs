//! How much stack an image can need: a bound that is found in the linked image, for all inputs.
//!
//! ```text
//!   image -> functions -> instructions -> depth of each frame and at each call -> deepest chain of calls
//!                                         |                                       + exceptions, a level each
//!                                         compared with the unwind tables
//! ```
//!
//! All calls are known: those by address go to any function whose address the relocations say is taken. A recursion,
//! a jump that can't be followed or a stack pointer that moves by a computed distance is an error. So are a heap, and
//! floating point outside of the one function that is allowed it: nothing on the way to a coil computes in it.

mod chain;
mod frame;
mod instruction;
mod panics;
mod program;
mod unwind;

use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};

use chain::{Chain, Chains};
use frame::Frame;
use program::Program;

/// What an exception puts on the stack: registers, those of the floating-point unit, and a word to align it
/// (ARMv7-M Architecture Reference Manual, B1.5.6).
const EXCEPTION_BYTES: i32 = 0x68 + 4;

/// All that may compute in floating point: a display of a tool.
const FLOATING: [&str; 1] = ["hitch_protocols::xcp::angle_noise::rms_deg_bits"];

/// What allocates, by the names that allocators have.
const ALLOCATORS: [&str; 6] = [
    "__rust_alloc",
    "__rust_realloc",
    "__rg_alloc",
    "__rdl_alloc",
    "malloc",
    "realloc",
];

/// Library calls for floating point begin like these (Run-time ABI for the Arm architecture, tables 2 to 8).
const FLOATING_CALLS: [&str; 7] = [
    "__aeabi_f",
    "__aeabi_d",
    "__aeabi_i2",
    "__aeabi_ui2",
    "__aeabi_l2",
    "__aeabi_ul2",
    "__aeabi_h2",
];

/// What can be on the stack.
#[derive(Clone, Debug)]
pub struct Bound {
    /// What runs, and what may interrupt it, lowest priority first.
    levels: Vec<(&'static str, Chain)>,
    /// Functions that have been compared with the unwind tables, and all.
    compared: (usize, usize),
    /// Functions that may be called by address.
    by_address: Vec<String>,
    /// What panics in the image, with its callers; empty if nothing can.
    pub panics: Vec<String>,
}

impl Bound {
    /// Bytes.
    pub fn bytes(&self) -> u64 {
        let chains: i32 = self.levels.iter().map(|(_, chain)| chain.bytes()).sum();
        let interruptions = i32::try_from(self.levels.len().saturating_sub(1)).unwrap_or(i32::MAX);
        u64::from((chains + interruptions * EXCEPTION_BYTES).unsigned_abs())
    }
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, (name, chain)) in self.levels.iter().enumerate() {
            if index > 0 {
                writeln!(f, "{EXCEPTION_BYTES:8} B  on entry to an exception")?;
            }
            writeln!(f, "{name}:")?;
            write!(f, "{chain}")?;
        }
        let (compared, all) = self.compared;
        writeln!(f, "{:8} B  together", self.bytes())?;
        writeln!(
            f,
            "{compared} of {all} functions are in the unwind tables, and agree with them"
        )?;
        writeln!(
            f,
            "no heap, no floating point outside of {}",
            FLOATING.join(", ")
        )?;
        writeln!(f, "called by address: {}", self.by_address.join(", "))
    }
}

/// The bound of an image.
pub fn of(image: &Path) -> Result<Bound> {
    let bytes =
        fs::read(image).with_context(|| format!("can't read the image {}", image.display()))?;
    bound(&bytes).with_context(|| format!("can't bound the stack of {}", image.display()))
}

fn bound(bytes: &[u8]) -> Result<Bound> {
    let program = Program::parse(bytes)?;
    forbid_symbols(&program)?;
    let frames = frame::frames(&program)?;
    forbid_floating_point(&program, &frames)?;
    let compared = (unwind::check(&program, &frames)?, frames.len());
    let mut chains = Chains::new(&program.functions, &frames, &program.taken);
    let entries = &program.entries;
    let others = entries.others.iter();
    let others: Vec<Chain> = others
        .map(|entry| chains.deepest(*entry))
        .collect::<Result<_>>()?;
    let mut levels = vec![("program", chains.deepest(entries.reset)?)];
    // Nothing sets priorities, so what has one that can be chosen doesn't interrupt its like.
    levels.extend(
        others
            .into_iter()
            .max_by_key(Chain::bytes)
            .map(|worst| ("interrupt", worst)),
    );
    levels.push(("hard fault", chains.deepest(entries.hard_fault)?));
    levels.push((
        "non-maskable interrupt",
        chains.deepest(entries.non_maskable)?,
    ));
    let name = |address: &u32| {
        program
            .functions
            .get(address)
            .map(|function| function.name.clone())
    };
    Ok(Bound {
        levels,
        compared,
        by_address: program.taken.iter().filter_map(name).collect(),
        panics: panics::panics(&program, &frames),
    })
}

/// The images have none of it but in [`FLOATING`], so what is on the way to a coil has none.
fn forbid_floating_point(program: &Program<'_>, frames: &BTreeMap<u32, Frame>) -> Result<()> {
    for (address, function) in &program.functions {
        let depths = frames.get(address).map(|frame| &frame.depths);
        let mut reached = function.instructions.values().filter(|instruction| {
            depths.is_some_and(|depths| depths.contains_key(&instruction.address))
        });
        if FLOATING.contains(&function.name.as_str()) {
            continue;
        }
        if let Some(instruction) = reached.find(|instruction| instruction.floating) {
            bail!(
                "{} uses the floating-point unit at {:#x}",
                function.name,
                instruction.address
            );
        }
    }
    Ok(())
}

/// No heap, and no floating point that a library does.
fn forbid_symbols(program: &Program<'_>) -> Result<()> {
    for name in program.symbols() {
        ensure!(
            !ALLOCATORS.contains(&name),
            "it has a heap: {name} is linked in"
        );
        ensure!(
            !FLOATING_CALLS.iter().any(|start| name.starts_with(start)),
            "it calls a library for floating point: {name} is linked in"
        );
    }
    Ok(())
}

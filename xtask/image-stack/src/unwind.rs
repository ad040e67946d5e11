//! A second opinion on the stack's depth: the unwind tables that the compiler writes for debuggers.
//!
//! They have a row for each step of a prologue: how far the frame's end is from the stack pointer, or from the frame
//! pointer once that is set up. From then on they don't tell how deep the stack is, and epilogues and early returns
//! have no rows; that is why the bound isn't taken from them.

use std::collections::BTreeMap;

use anyhow::{Context, Result, ensure};
use gimli::{Arm, BaseAddresses, CfaRule, DebugFrame, LittleEndian, UnwindContext, UnwindSection};

use super::frame::{Depth, Frame};
use super::program::Program;

/// Compares; the number of functions that were.
pub fn check(program: &Program<'_>, frames: &BTreeMap<u32, Frame>) -> Result<usize> {
    let mut tables = DebugFrame::new(program.unwind_tables()?, LittleEndian);
    tables.set_address_size(4);
    let bases = BaseAddresses::default();
    let mut entries = tables.entries(&bases);
    let mut context = UnwindContext::new();
    let mut compared = 0;
    while let Some(entry) = entries.next()? {
        let gimli::CieOrFde::Fde(partial) = entry else {
            continue;
        };
        let description = partial.parse(DebugFrame::cie_from_offset)?;
        // What the linker has left out keeps its entry, at address 0.
        let Some(frame) = u32::try_from(description.initial_address())
            .ok()
            .and_then(|start| frames.get(&start))
        else {
            continue;
        };
        let mut rows = description.rows(&tables, &bases, &mut context)?;
        while let Some(row) = rows.next_row()? {
            let address = row.start_address() as u32;
            if let Some(depth) = frame.depths.get(&address) {
                agree(row.cfa(), *depth).with_context(|| {
                    format!("the unwind tables say something else at {address:#x}")
                })?;
            }
        }
        compared += 1;
    }
    ensure!(compared > 0, "the unwind tables know none of the functions");
    Ok(compared)
}

fn agree(rule: &CfaRule<usize>, depth: Depth) -> Result<()> {
    let CfaRule::RegisterAndOffset { register, offset } = rule else {
        return Ok(());
    };
    let found = match *register {
        Arm::R13 => Some(depth.bytes),
        Arm::R7 => depth.frame_pointer,
        _ => return Ok(()),
    };
    ensure!(
        found.map(i64::from) == Some(*offset),
        "{offset} bytes, and the code {found:?}"
    );
    Ok(())
}

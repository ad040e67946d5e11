//! A linked image as functions: where each begins and ends, which may be called by address, and which the processor
//! enters.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use anyhow::{Context, Result, ensure};
use object::read::elf::ElfFile32;
use object::{
    LittleEndian, Object, ObjectSection, ObjectSymbol, RelocationTarget, SectionKind, SymbolKind,
};

use super::instruction::{Decoder, Instruction};

/// Functions have odd addresses where an instruction set is chosen by them.
const THUMB: u32 = 1;
const VECTOR_BYTES: usize = 4;

/// A function.
#[derive(Clone, Debug)]
pub struct Function {
    /// Its name, without the hash.
    pub name: String,
    /// Its place.
    pub place: Range<u32>,
    /// Its instructions, by address.
    pub instructions: BTreeMap<u32, Instruction>,
}

/// Where the processor enters the image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entries {
    /// At power-up.
    pub reset: u32,
    /// By the interrupt that nothing holds back.
    pub non_maskable: u32,
    /// By a fault.
    pub hard_fault: u32,
    /// By whatever has a priority that can be chosen.
    pub others: BTreeSet<u32>,
}

/// An image.
pub struct Program<'a> {
    file: ElfFile32<'a, LittleEndian>,
    code: &'a [u8],
    code_address: u32,
    /// All functions, by the address they begin at.
    pub functions: BTreeMap<u32, Function>,
    /// Functions whose address is somewhere: calls by address go to one of them.
    pub taken: BTreeSet<u32>,
    /// Where the processor enters.
    pub entries: Entries,
}

impl<'a> Program<'a> {
    /// Reads an image that was linked with `--emit-relocs`.
    pub fn parse(bytes: &'a [u8]) -> Result<Self> {
        let file = ElfFile32::<LittleEndian>::parse(bytes).context("no ELF file of 32 bits")?;
        let text = file.section_by_name(".text").context("it has no code")?;
        let (code, code_address) = (text.data()?, u32::try_from(text.address())?);
        let mut program = Self {
            entries: entries(&file)?,
            functions: BTreeMap::new(),
            taken: BTreeSet::new(),
            code,
            code_address,
            file,
        };
        program.functions = program.find_functions()?;
        program.taken = program.find_taken()?;
        Ok(program)
    }

    /// The unwind tables.
    pub fn unwind_tables(&self) -> Result<&'a [u8]> {
        let section = self.file.section_by_name(".debug_frame");
        Ok(section.context("it has no unwind tables")?.data()?)
    }

    /// Names of all symbols.
    pub fn symbols(&self) -> impl Iterator<Item = &str> {
        self.file.symbols().filter_map(|symbol| symbol.name().ok())
    }

    /// The targets of a jump through the table at `address`: offsets in units of two bytes, as many as there is data.
    pub fn table(&self, address: u32, entry_bytes: usize, function: &Function) -> Result<Vec<u32>> {
        let end = function.instructions.range(address..).next();
        let end = end.map_or(function.place.end, |(next, _)| *next);
        let entries = self.code_at(address..end)?.chunks_exact(entry_bytes);
        let offsets = entries.map(|entry| match *entry {
            [byte] => u32::from(byte),
            [low, high] => u32::from(u16::from_le_bytes([low, high])),
            _ => 0,
        });
        // A table of bytes may end with one that fills its last half-word up; that one leads into the table itself.
        let targets = offsets.map(|offset| address + 2 * offset);
        let targets: Vec<u32> = targets.filter(|target| *target >= end).collect();
        ensure!(!targets.is_empty(), "no table of jumps at {address:#x}");
        Ok(targets)
    }

    fn code_at(&self, place: Range<u32>) -> Result<&'a [u8]> {
        let first = place.start.checked_sub(self.code_address);
        let range = first.map(|first| first as usize..(place.end - self.code_address) as usize);
        let code = range.and_then(|range| self.code.get(range));
        code.with_context(|| format!("no code at {:#x}", place.start))
    }

    fn find_functions(&self) -> Result<BTreeMap<u32, Function>> {
        let names = self.function_names();
        let marks = self.marks();
        let decoder = Decoder::new()?;
        let code_end = self.code_address + u32::try_from(self.code.len())?;
        let ends = names.keys().skip(1).copied().chain([code_end]);
        let mut functions = BTreeMap::new();
        for ((start, name), end) in names.iter().zip(ends) {
            let place = *start..end;
            let mut instructions = BTreeMap::new();
            for piece in pieces_of_code(&place, &marks) {
                let decoded = decoder.decode(self.code_at(piece.clone())?, piece.start);
                let decoded = decoded.with_context(|| format!("in {name}"))?;
                instructions.extend(decoded.into_iter().map(|one| (one.address, one)));
            }
            let name = name.clone();
            let function = Function {
                name,
                place,
                instructions,
            };
            functions.insert(*start, function);
        }
        Ok(functions)
    }

    /// Functions by address. Of several names the one with a size is the function's own; others stand in for it.
    fn function_names(&self) -> BTreeMap<u32, String> {
        let mut sized = BTreeMap::new();
        for symbol in self.file.symbols() {
            let name = symbol.name().unwrap_or_default();
            let address = symbol.address() as u32;
            let inside = address.checked_sub(self.code_address);
            let inside = inside.is_some_and(|offset| (offset as usize) < self.code.len());
            if symbol.kind() == SymbolKind::Text && inside && !name.starts_with('$') {
                let named = (
                    symbol.size(),
                    format!("{:#}", rustc_demangle::demangle(name)),
                );
                let known = sized.entry(address & !THUMB).or_insert((0, String::new()));
                *known = named.max(known.clone());
            }
        }
        let named = |(address, (_, name))| (address, name);
        sized.into_iter().map(named).collect()
    }

    /// Where code and data begin in turn, by the marks that the ABI for ARM demands (`$t` and `$d`).
    fn marks(&self) -> BTreeMap<u32, bool> {
        let mark = |name: &str| match name.get(..2) {
            Some("$t") => Some(true),
            Some("$d") => Some(false),
            _ => None,
        };
        let symbols = self.file.symbols();
        let marks = symbols.filter_map(|symbol| {
            let is_code = mark(symbol.name().ok()?)?;
            Some((symbol.address() as u32, is_code))
        });
        marks.collect()
    }

    /// Functions that a pointer in a constant, a variable or an instruction refers to. The vector table doesn't count.
    fn find_taken(&self) -> Result<BTreeSet<u32>> {
        let mut taken = BTreeSet::new();
        let mut relocations = 0;
        for section in self.file.sections() {
            let loaded = matches!(
                section.kind(),
                SectionKind::Text | SectionKind::Data | SectionKind::ReadOnlyData
            );
            if !loaded || section.name() == Ok(".vector_table") {
                continue;
            }
            for (_, relocation) in section.relocations() {
                relocations += 1;
                if !is_branch(relocation.flags())
                    && let RelocationTarget::Symbol(index) = relocation.target()
                {
                    let symbol = self.file.symbol_by_index(index)?;
                    let inside_code = symbol.section_index().is_some_and(|section| {
                        self.file
                            .section_by_index(section)
                            .is_ok_and(|section| is_code(&section))
                    });
                    ensure!(
                        !(inside_code && symbol.kind() == SymbolKind::Section),
                        "an address in the code is taken, but not by name"
                    );
                    let address = symbol.address() as u32 & !THUMB;
                    if inside_code && symbol.kind() == SymbolKind::Text {
                        taken.insert(address);
                    }
                }
            }
        }
        ensure!(
            relocations > 0,
            "it was linked without `--emit-relocs`, so which functions have their address taken isn't known"
        );
        Ok(taken)
    }
}

/// Whether a section holds code alone: functions that run from RAM are among the variables.
fn is_code<'a>(section: &impl ObjectSection<'a>) -> bool {
    let writable = matches!(
        section.flags(),
        object::SectionFlags::Elf { sh_flags, .. } if sh_flags.contains(object::elf::SHF_WRITE)
    );
    section.kind() == SectionKind::Text && !writable
}

/// Calls and jumps to a fixed address (ELF for the Arm architecture, table 5.6.1.6).
fn is_branch(flags: object::RelocationFlags) -> bool {
    use object::elf::{R_ARM_THM_JUMP24, R_ARM_THM_PC22};
    matches!(flags, object::RelocationFlags::Elf { r_type } if r_type == R_ARM_THM_PC22 || r_type == R_ARM_THM_JUMP24)
}

fn entries(file: &ElfFile32<'_, LittleEndian>) -> Result<Entries> {
    let table = file.section_by_name(".vector_table");
    let table = table.context("it has no vector table")?.data()?;
    let words = table.as_chunks::<VECTOR_BYTES>().0.iter();
    let vectors: Vec<u32> = words
        .map(|word| u32::from_le_bytes(*word) & !THUMB)
        .collect();
    // The first word is the stack's top.
    let [_, reset, non_maskable, hard_fault, others @ ..] = vectors.as_slice() else {
        anyhow::bail!("its vector table is too short");
    };
    Ok(Entries {
        reset: *reset,
        non_maskable: *non_maskable,
        hard_fault: *hard_fault,
        others: others
            .iter()
            .copied()
            .filter(|vector| *vector != 0)
            .collect(),
    })
}

/// The pieces of `place` that hold instructions.
fn pieces_of_code(place: &Range<u32>, marks: &BTreeMap<u32, bool>) -> Vec<Range<u32>> {
    let before = marks.range(..=place.start).next_back();
    let first = (place.start, before.is_none_or(|(_, is_code)| *is_code));
    let inside = marks.range(place.start + 1..place.end);
    let starts: Vec<(u32, bool)> = [first]
        .into_iter()
        .chain(inside.map(|(a, b)| (*a, *b)))
        .collect();
    let ends = starts
        .iter()
        .skip(1)
        .map(|(start, _)| *start)
        .chain([place.end]);
    let pieces = starts.iter().zip(ends).filter(|((_, is_code), _)| *is_code);
    pieces.map(|((start, _), end)| *start..end).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_between_instructions_are_left_out() {
        let marks = BTreeMap::from([(0, true), (8, false), (12, true), (40, false)]);
        assert_eq!(pieces_of_code(&(0..20), &marks), [0..8, 12..20]);
        let marks = BTreeMap::from([(0, true), (40, false)]);
        assert_eq!(pieces_of_code(&(14..48), &marks), vec![14..40; 1]);
    }
}

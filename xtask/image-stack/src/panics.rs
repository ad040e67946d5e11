//! Panics in an image: functions of `core` that panic, and the program's handler, which the linker keeps only if
//! something may call them.

use std::collections::BTreeMap;

use super::frame::{Callee, Frame};
use super::program::Program;

/// Parts of the names of functions that panic: of those in `core`, and of the handler.
const PANICS: [&str; 2] = ["core::panicking::", "rust_begin_unwind"];

/// The functions that panic, each with those that call it; empty if the image cannot panic.
pub fn panics(program: &Program<'_>, frames: &BTreeMap<u32, Frame>) -> Vec<String> {
    let names = program.symbols();
    let panicking = names.map(|name| format!("{:#}", rustc_demangle::demangle(name)));
    let mut panicking: Vec<String> = panicking.filter(|name| does_panic(name)).collect();
    panicking.sort();
    panicking.dedup();
    panicking
        .into_iter()
        .map(|name| {
            let callers = callers(&name, program, frames);
            format!("{name}, called by: {}", callers.join(", "))
        })
        .collect()
}

fn does_panic(name: &str) -> bool {
    PANICS.iter().any(|part| name.contains(part))
}

fn callers<'a>(
    name: &str,
    program: &'a Program<'_>,
    frames: &BTreeMap<u32, Frame>,
) -> Vec<&'a str> {
    let functions = program.functions.iter();
    let is_called = |address: &u32| {
        let callee = program.functions.get(address);
        callee.is_some_and(|callee| callee.name == name)
    };
    let calls = |address: &u32| {
        frames.get(address).is_some_and(|frame| {
            frame.calls.iter().any(|(callee, _)| match callee {
                Callee::Function(target) => is_called(target),
                Callee::ByAddress => false,
            })
        })
    };
    functions
        .filter(|(address, _)| calls(address))
        .map(|(_, function)| function.name.as_str())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::does_panic;

    #[test]
    fn what_panics_is_known_by_its_name() {
        for name in [
            "core::panicking::panic",
            "core::panicking::panic_const::panic_const_add_overflow",
            "__rustc::rust_begin_unwind",
        ] {
            assert!(does_panic(name), "{name}");
        }
        assert!(!does_panic("hitch_ecu::application::Ecu<F>::tick"));
    }
}

//! Evaluation of a term on many states of the plant: it has to be finite on all of them, and zero at its null value.

use std::fmt::Write as _;
use std::sync::LazyLock;

use hitch_plant::hooks::signals::{SIGNALS, Signal, Signals};

use crate::expression::definition::{Part, TermError};
use crate::expression::term::Term;
use crate::expression::tree::{Kind, Node};

/// Number of random states, in addition to rest and the two ends of every signal.
const DRAWN: usize = 200;

/// Test states.
static STATES: LazyLock<Vec<Signals>> = LazyLock::new(|| {
    let mut states = vec![
        state(|signal| 0.0_f64.clamp(signal.low, signal.high)),
        state(|signal| signal.low),
        state(|signal| signal.high),
    ];
    // Weyl sequences with a different irrational step per signal fill the ranges evenly and reproducibly.
    states.extend((1..=DRAWN).map(|k| {
        let mut step_squared = 1.0_f64;
        state(|signal| {
            step_squared += 1.618;
            let share = (k as f64 * step_squared.sqrt()).fract();
            signal.low + share * (signal.high - signal.low)
        })
    }));
    states
});

fn state(mut value: impl FnMut(&Signal) -> f64) -> Signals {
    let mut signals = Signals::default();
    for signal in &SIGNALS {
        *(signal.place)(&mut signals) = value(signal);
    }
    signals
}

/// Checks that a term is finite at its start values and at both ends of every parameter, and zero at its null value.
pub(crate) fn check(term: &Term, tree: &Node) -> Result<(), TermError> {
    let parameters = &term.definition().parameters;
    let start: Vec<f64> = parameters.iter().map(|parameter| parameter.start).collect();
    let mut settings = vec![start.clone()];
    for (index, parameter) in parameters.iter().enumerate() {
        settings.extend([parameter.low, parameter.high].map(|end| {
            let mut values = start.clone();
            values[index] = end;
            values
        }));
    }
    for values in &settings {
        finite(term, tree, values)?;
    }
    for values in &mut settings {
        values[0] = parameters[0].null;
        finite(term, tree, values)?;
        off(term, tree, values)?;
    }
    Ok(())
}

fn finite(term: &Term, tree: &Node, values: &[f64]) -> Result<(), TermError> {
    let what = "the term is not a finite number";
    let hint = "keep divisors away from zero, as in max(x, 1[mm]), and arguments of roots and logarithms positive; or narrow the \
                ranges of the parameters";
    refuse_where(term, tree, values, |value| !value.is_finite(), what, hint)
}

fn off(term: &Term, tree: &Node, values: &[f64]) -> Result<(), TermError> {
    let what = "the term is not zero at the null value of its size";
    let name = &term.definition().parameters[0].name;
    let hint =
        format!("multiply the whole formula by {name}, or correct null, or list the size first");
    refuse_where(term, tree, values, |value| value != 0.0, what, &hint)
}

fn refuse_where(
    term: &Term,
    tree: &Node,
    values: &[f64],
    wrong: fn(f64) -> bool,
    what: &str,
    hint: &str,
) -> Result<(), TermError> {
    let si = term.si(values);
    let state = STATES.iter().find(|state| wrong(term.evaluate(&si, state)));
    state.map_or(Ok(()), |state| {
        let what = format!("{what} at {}", circumstances(term, tree, values, state));
        Err(TermError::new(Part::Formula(0), what, hint))
    })
}

/// The values of the parameters and signals in a formula: `c = 0, v = -0.3 m/s`.
fn circumstances(term: &Term, tree: &Node, values: &[f64], state: &Signals) -> String {
    let mut text = String::new();
    let mut add = |name: &str, value: f64, unit: &str| {
        let comma = if text.is_empty() { "" } else { ", " };
        let gap = if unit.is_empty() { "" } else { " " };
        // Writing to a string cannot fail.
        let _ = write!(text, "{comma}{name} = {}{gap}{unit}", short(value));
    };
    for (parameter, value) in term.definition().parameters.iter().zip(values) {
        add(&parameter.name, *value, &parameter.unit);
    }
    for signal in SIGNALS.iter().filter(|signal| holds(tree, signal)) {
        add(signal.name, (signal.value)(state), signal.unit);
    }
    text
}

/// A number with four significant digits, without an exponent if it is readable that way.
fn short(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

fn holds(tree: &Node, wanted: &Signal) -> bool {
    tree.has(&|leaf| matches!(leaf, Kind::Signal(signal) if signal.name == wanted.name))
}

//! Random formulas: the compiled form against an independent evaluation; and texts that are not formulas.

use hitch_effects::expression::check;
use hitch_effects::expression::evaluate::Code;
use hitch_effects::expression::parse::parse;
use hitch_input::{Dimension, Fault};
use hitch_plant::hooks::signals::{SIGNALS, Signals};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

const NAMES: [&str; 2] = ["a", "b"];

/// A formula of pure numbers in the representation of the test.
#[derive(Debug, Clone)]
enum Tree {
    Number(f64),
    Name(usize),
    Angle,
    Negative(Box<Tree>),
    Infix(char, Box<Tree>, Box<Tree>),
    Call(&'static str, Vec<Tree>),
}

impl Tree {
    /// The value, directly from the definitions.
    fn value(&self, names: &[f64; 2], angle: f64) -> f64 {
        let of = |tree: &Tree| tree.value(names, angle);
        match self {
            Self::Number(value) => *value,
            Self::Name(index) => names[*index],
            Self::Angle => angle,
            Self::Negative(inner) => -of(inner),
            Self::Infix(sign, left, right) => infix(*sign, of(left), of(right)),
            Self::Call(name, arguments) => {
                call(name, &arguments.iter().map(of).collect::<Vec<_>>())
            }
        }
    }

    /// The text with the fewest parentheses, and its precedence: 1 for a sum to 5 for an atom.
    fn text(&self) -> (String, u8) {
        let within = |tree: &Tree, tightness: u8| match tree.text() {
            (text, own) if own >= tightness => text,
            (text, _) => format!("({text})"),
        };
        match self {
            Self::Number(value) => (format!("{value:?}"), 5),
            Self::Name(index) => (NAMES[*index].to_owned(), 5),
            Self::Angle => ("rocker_angle".to_owned(), 5),
            Self::Negative(inner) => (format!("-{}", within(inner, 3)), 3),
            Self::Infix(sign, left, right) => {
                let (own, from_left, from_right) = match sign {
                    '+' | '-' => (1, 1, 2),
                    '*' | '/' => (2, 2, 3),
                    _ => (4, 5, 3),
                };
                let (left, right) = (within(left, from_left), within(right, from_right));
                (format!("{left} {sign} {right}"), own)
            }
            Self::Call(name, arguments) => {
                let arguments: Vec<String> = arguments.iter().map(|a| a.text().0).collect();
                (format!("{name}({})", arguments.join(", ")), 5)
            }
        }
    }
}

fn infix(sign: char, a: f64, b: f64) -> f64 {
    match sign {
        '+' => a + b,
        '-' => a - b,
        '*' => a * b,
        '/' => a / b,
        _ if b == 2.0 => a * a,
        _ => a.powf(b),
    }
}

fn call(name: &str, of: &[f64]) -> f64 {
    let not_a_number = of.iter().any(|a| a.is_nan());
    match (name, of) {
        _ if not_a_number => f64::NAN,
        ("sqrt", [a]) => a.sqrt(),
        ("ssqrt", [a]) if *a < 0.0 => -(-a).sqrt(),
        ("ssqrt", [a]) => a.sqrt(),
        ("abs", [a]) => a.abs(),
        ("sgn", [a]) => f64::from(i8::from(*a > 0.0) - i8::from(*a < 0.0)),
        ("exp", [a]) => a.exp(),
        ("ln", [a]) => a.ln(),
        ("tanh", [a]) => a.tanh(),
        ("sin", [a]) => a.sin(),
        ("cos", [a]) => a.cos(),
        ("ramp", [a]) => greater(*a, 0.0),
        ("step", [a]) => f64::from(u8::from(*a > 0.0)),
        ("min", [a, b]) => less(*a, *b),
        ("max", [a, b]) => greater(*a, *b),
        ("clamp", [a, low, high]) => less(greater(*a, *low), *high),
        _ => unreachable!("{name} of {of:?}"),
    }
}

/// The smaller number; of two zeros the second one. `f64::min` may return either, and a division distinguishes them.
fn less(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger number, likewise.
fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

const OF_ONE: [&str; 11] = [
    "sqrt", "ssqrt", "abs", "sgn", "exp", "ln", "tanh", "sin", "cos", "ramp", "step",
];

fn trees() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        (0.0..10.0_f64).prop_map(Tree::Number),
        (0..5_u8).prop_map(|value| Tree::Number(f64::from(value))),
        (0..2_usize).prop_map(Tree::Name),
        Just(Tree::Angle),
    ];
    leaf.prop_recursive(6, 40, 3, |inner| {
        let sign = prop::sample::select(vec!['+', '-', '*', '/', '^']);
        let two = prop::sample::select(vec!["min", "max"]);
        prop_oneof![
            4 => (sign, inner.clone(), inner.clone())
                .prop_map(|(sign, a, b)| Tree::Infix(sign, a.into(), b.into())),
            1 => inner.clone().prop_map(|a| Tree::Negative(a.into())),
            2 => (prop::sample::select(OF_ONE.to_vec()), inner.clone())
                .prop_map(|(name, a)| Tree::Call(name, vec![a])),
            1 => (two, inner.clone(), inner.clone()).prop_map(|(name, a, b)| Tree::Call(name, vec![a, b])),
            1 => prop::collection::vec(inner, 3).prop_map(|of| Tree::Call("clamp", of)),
        ]
    })
}

/// All stages of a formula: parse, check, compile, evaluate.
fn evaluate(text: &str, names: &[f64; 2], signals: &Signals) -> Result<f64, Fault> {
    let tree = parse(text, &NAMES)?;
    check::dimension(&tree, text, &[Dimension::NUMBER; 2])?;
    Ok(Code::compile(&tree).evaluate(names, signals))
}

fn never_panics(text: &str) {
    if let Err(fault) = evaluate(text, &[0.5, -2.0], &Signals::default()) {
        assert!(
            fault.byte <= text.len() && text.is_char_boundary(fault.byte),
            "{fault}"
        );
        assert!(
            fault.column >= 1 && !fault.what.is_empty() && !fault.hint.is_empty(),
            "{fault}"
        );
    }
}

#[test]
fn nesting_and_length_are_bounded() {
    let deep = |open: &str, inner: &str, close: &str, times: usize| {
        let text = format!("{}{inner}{}", open.repeat(times), close.repeat(times));
        evaluate(&text, &[2.0, 3.0], &Signals::default())
    };
    for times in [1, 10, 19, 29, 58] {
        assert_eq!(deep("(", "a", ")", times), Ok(2.0));
        assert_eq!(deep("abs(", "a", ")", times), Ok(2.0));
        assert!(deep("a^", "a", "", times).is_ok());
        assert_eq!(deep("min(9, ", "b", ")", times), Ok(3.0));
        let sum = deep("(1 + ", "a", ")", times / 2);
        assert_eq!(sum, Ok(2.0 + (times / 2) as f64));
    }
    assert_eq!(deep("a + ", "a", "", 249), Ok(500.0));
    assert_eq!(deep("a * ", "a", "", 100), Ok(2_f64.powi(101)));
    for (open, close) in [
        ("(", ")"),
        ("-", ""),
        ("a^", ""),
        ("abs(", ")"),
        ("(", ""),
        ("min(1,", ")"),
    ] {
        for times in [61, 100, 150, 5000] {
            let fault = deep(open, "a", close, times).unwrap_err().what;
            assert!(
                fault.contains("more than 60 deep") || fault.contains("longer than 1000"),
                "{fault}"
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, rng_seed: RngSeed::Fixed(4), ..ProptestConfig::default() })]

    #[test]
    fn the_compiled_form_gives_what_the_definitions_give(
        tree in trees(), names in prop::array::uniform2(-5.0..5.0_f64), angle in 0.5..2.5_f64,
    ) {
        let (text, _) = tree.text();
        prop_assume!(text.len() <= 1000);
        let signals = Signals { rocker_angle_rad: angle, ..Signals::default() };
        let found = evaluate(&text, &names, &signals);
        let found = found.map_err(|fault| TestCaseError::fail(format!("{text}: {fault}")))?;
        let expected = tree.value(&names, angle);
        let same = found == expected || (found.is_nan() && expected.is_nan());
        prop_assert!(same, "{} = {}, not {}", text, found, expected);
    }

    #[test]
    fn any_text_is_evaluated_or_refused(text in ".{0,200}") {
        never_panics(&text);
    }

    #[test]
    fn any_bytes_are_evaluated_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        never_panics(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn any_tokens_are_evaluated_or_refused(tokens in prop::collection::vec(tokens(), 0..60)) {
        never_panics(&tokens.join(""));
        never_panics(&tokens.join(" "));
    }
}

fn tokens() -> impl Strategy<Value = String> {
    let signals = SIGNALS.iter().map(|signal| signal.name);
    let signs = [
        "+", "-", "*", "/", "^", "(", ")", ",", "[", "]", "[mm/s]", "[bar]", "[Pa^0.5]", "[", "é",
    ];
    let words = [
        "0", "1", "2", "0.5", "1e300", "3[mm]", "a", "b", "min", "max", "clamp", "e3", "_", ".",
    ];
    let all: Vec<String> = OF_ONE
        .into_iter()
        .chain(signs)
        .chain(words)
        .chain(signals)
        .map(str::to_owned)
        .collect();
    prop::sample::select(all)
}

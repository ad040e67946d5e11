//! Tests of user-defined terms: the formula language against closed forms and an independent evaluation, and its
//! messages.

use std::fs;

use hitch_effects::expression::{ParameterDefinition, Term, TermDefinition};
use hitch_plant::hooks::signals::{SIGNALS, Signals};
use hitch_plant::{Model, Place};
use tempfile::TempDir;

/// A parameter with a range of -10 to 10 in its unit.
fn parameter(name: &str, unit: &str) -> ParameterDefinition {
    ParameterDefinition {
        name: name.to_owned(),
        unit: unit.to_owned(),
        meaning: String::new(),
        null: 0.0,
        start: 1.0,
        low: -10.0,
        high: 10.0,
    }
}

fn definition(place: Place, formula: &str, parameters: &[(&str, &str)]) -> TermDefinition {
    TermDefinition {
        id: "trial".to_owned(),
        title: String::new(),
        place,
        formula: formula.to_owned(),
        parameters: parameters
            .iter()
            .map(|(name, unit)| parameter(name, unit))
            .collect(),
    }
}

/// Value of a formula of pure numbers without parameters.
fn value(formula: &str) -> f64 {
    let formula = format!("k * ({formula})");
    let term = Term::new(definition(Place::LiftFlowFactor, &formula, &[("k", "")]));
    term.unwrap_or_else(|error| panic!("{formula}: {error}"))
        .evaluate(&[1.0], &Signals::default())
}

#[test]
fn precedence_is_that_of_mathematics() {
    let cases = [
        ("-2^2", -4.0),
        ("(-2)^2", 4.0),
        ("2^3^2", 512.0),
        ("(2^3)^2", 64.0),
        ("2^-1", 0.5),
        ("2^-2^2", 0.0625),
        ("-2^-2", -0.25),
        ("8/4/2", 1.0),
        ("8/(4/2)", 4.0),
        ("8/4*2", 4.0),
        ("8-4-2", 2.0),
        ("8-(4-2)", 6.0),
        ("2+3*4^2", 50.0),
        ("2*3+4", 10.0),
        ("--2", 2.0),
        ("2*-3", -6.0),
        ("2--3", 5.0),
        ("-2*3^2", -18.0),
        ("exp(-2^2)", (-4.0_f64).exp()),
        ("exp(-(2^2))", (-4.0_f64).exp()),
        ("1/2", 0.5),
        ("-abs(-3)^2", -9.0),
        ("2*(1+1)^3", 16.0),
        ("1e-3*1e3", 1.0),
    ];
    for (formula, expected) in cases {
        assert_eq!(value(formula), expected, "{formula}");
    }
}

#[test]
fn functions_are_what_they_are_called() {
    let cases = [
        ("sqrt(9)", 3.0),
        ("ssqrt(-9)", -3.0),
        ("abs(-2)", 2.0),
        ("sgn(-2) + sgn(0) + 10*sgn(5)", 9.0),
        ("min(2, 3) + 10*max(2, 3)", 32.0),
        (
            "clamp(5, 0, 3) + 10*clamp(-1, 0, 3) + 100*clamp(2, 0, 3)",
            203.0,
        ),
        ("exp(1)", std::f64::consts::E),
        ("ln(exp(2))", 2.0),
        ("tanh(0.5)", 0.5_f64.tanh()),
        ("sin(30[deg])", 0.5_f64),
        ("cos(60[deg])", 0.5_f64),
        ("ramp(-1) + ramp(2)", 2.0),
        ("step(-1) + 10*step(0) + 100*step(1e-9)", 100.0),
    ];
    for (formula, expected) in cases {
        let found = value(formula);
        assert!(
            (found - expected).abs() < 1e-15 * expected.abs().max(1.0),
            "{formula} = {found}"
        );
    }
}

#[test]
fn everything_is_si_inside() {
    let signals = Signals {
        cylinder_pressure_pa: 40e5,
        speed_m_s: 0.006,
        travel_m: 0.01,
        ..Signals::default()
    };
    let cases: [(Place, &str, &str, f64); 6] = [
        (Place::Leakage, "k * p_cyl", "l/min/bar", 40e-3 / 60.0),
        (
            Place::Friction,
            "k * tanh(v / 3[mm/s])",
            "kN",
            1e3 * 2.0_f64.tanh(),
        ),
        (
            Place::LowerFlowFactor,
            "-k * ramp(1 - x / 20[mm])",
            "",
            -0.5,
        ),
        (
            Place::ReturnPressure,
            "k * (p_cyl / 10[bar])^0.5",
            "bar",
            2e5,
        ),
        (Place::FlowSensor, "k * ssqrt(p_cyl)", "m3/s/Pa^0.5", 2000.0),
        (
            Place::AngleSensor,
            "k * sin(x / 10[mm] * 90[deg])",
            "deg",
            1_f64.to_radians(),
        ),
    ];
    for (place, formula, unit, expected) in cases {
        let term = Term::new(definition(place, formula, &[("k", unit)])).unwrap();
        let found = term.evaluate(&term.si(&[1.0]), &signals);
        assert!(
            (found - expected).abs() < 1e-12 * expected.abs(),
            "{formula}: {found}"
        );
    }
}

/// The message for a friction formula with a size k in N and a length d in mm.
fn fault(formula: &str) -> String {
    let mut definition = definition(Place::Friction, formula, &[("k", "N"), ("d", "mm")]);
    definition.parameters[1].low = 0.5;
    read_with(&[definition])
        .err()
        .unwrap_or_else(|| "no fault".to_owned())
}

/// Reads a model file with terms. A formula starts in column 12.
fn read_with(terms: &[TermDefinition]) -> Result<Model, String> {
    let mut text = "format = 1\nbase = \"nominal\"\n".to_owned();
    for term in terms {
        text += &format!(
            "[[term]]\nid = \"{}\"\nplace = \"{}\"\nformula = '{}'\n",
            term.id,
            term.place.id(),
            term.formula
        );
        for (index, p) in term.parameters.iter().enumerate() {
            let null = if index == 0 {
                format!("null = {:?}\n", p.null)
            } else {
                String::new()
            };
            text += &format!(
                "[[term.parameter]]\nname = '{}'\nunit = '{}'\n{null}start = {:?}\nlow = {:?}\nhigh = {:?}\n",
                p.name, p.unit, p.start, p.low, p.high
            );
        }
    }
    read(&text)
}

fn read(text: &str) -> Result<Model, String> {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("m.toml");
    fs::write(&path, text).unwrap();
    let strip = |error: String| error.replace(&format!("{}/", dir.path().display()), "");
    hitch_model_file::read(&path).map_err(|error| strip(error.to_string()))
}

#[test]
fn syntax_faults_have_a_column_and_a_way_out() {
    let cases = [
        ("", "12: the formula is empty; write for example"),
        ("k +", "15: the formula ends too early; a number"),
        ("k * (x + d", "16: this parenthesis is not closed; add a )"),
        ("k * x)", "17: this parenthesis was not opened; delete it"),
        (
            "k * 0,5",
            "17: a comma is allowed only between the arguments of a function; a decimal number is written 0.5",
        ),
        (
            "k x",
            "14: an operator is missing before `x`; a product is written a * b",
        ),
        ("k * 2x", "16: `2x` is not a number; write it like 0.5"),
        (
            "k[mm]",
            "13: the unit `[mm]` does not follow a number; only numbers take a unit",
        ),
        (
            "k * / x",
            "16: found `/`, expected a number, a name or a parenthesis; ",
        ),
        ("k ** 2", "14: `**` is not known; a power is written x^2"),
        (
            "k * (v > 0)",
            "19: `>` does not belong in a formula; comparisons are not supported: write step(a - b)",
        ),
        (
            "k × x",
            "14: `×` does not belong in a formula; a product is written with *",
        ),
        (
            "k * 3[mm",
            "17: the unit has no closing bracket; write it like 3[mm/s]",
        ),
        ("k * 3[mm/q]", "21: unit `q` is not known; known: m, "),
        (
            "k * pcyl",
            "16: name `pcyl` is not known; did you mean p_cyl?",
        ),
        (
            "k * tanh",
            "16: name `tanh` is not known; it is a function: write tanh(...)",
        ),
        (
            "k * tan(x)",
            "16: function `tan` is not known; did you mean tanh?",
        ),
        (
            "k * d(x)",
            "16: function `d` is not known; a product is written d * (...)",
        ),
        (
            "k * min(x)",
            "16: min takes 2 arguments, not 1; min(a, b): the smaller one",
        ),
        ("k * abs()", "16: abs takes 1 argument, not 0; abs(a)"),
        ("k * abs(x, d)", "16: abs takes 1 argument, not 2; abs(a)"),
    ];
    for (formula, expected) in cases {
        assert_fault(formula, expected);
    }
}

#[test]
fn unit_faults_name_the_part_its_units_and_a_way_out() {
    let cases = [
        (
            "k * (rocker_angle + 3[bar])",
            "17: `rocker_angle + 3[bar]`: left is a pure number, right a pressure (Pa); multiply `3[bar]` by something \
             in 1/Pa",
        ),
        (
            "k * (x - 3) / d",
            "17: `x - 3`: left is a length (m), right a pure number; give the number a unit: 3[mm]",
        ),
        (
            "k * max(v, 0) / d",
            "16: `max(v, 0)`: one argument is a speed (m/s), another a pure number; give the number a \
             unit: 0[mm/s]",
        ),
        (
            "k * ramp(1 - p_cyl/20)",
            "21: `1 - p_cyl/20`: left is a pure number, right a pressure (Pa); give the number a unit: 20[bar]",
        ),
        (
            "k * (q_lift*p_cyl - 5)",
            "17: `q_lift*p_cyl - 5`: left is a power (W), right a pure number; give the number a unit: 5[W]",
        ),
        (
            "k * clamp(x / d, 0, 1[mm])",
            "16: `clamp(x / d, 0, 1[mm])`: one argument is a pure number, another a length",
        ),
        (
            "k * exp(-x)",
            "16: `exp(-x)`: the argument is a length (m), it has to be a pure number; divide it by something \
             in m",
        ),
        (
            "k * 2^x * d",
            "16: `2^x`: the exponent is a length (m), it has to be a pure number; ",
        ),
        (
            "k * x^(x/d)",
            "16: `x^(x/d)`: the base is a length (m), so its exponent has to be a written number",
        ),
        (
            "k * (x/d) * x^1.2",
            "24: `x^1.2`: the base is a length (m), which has no power of 1.2; write ((x) / 1[m])^(1.2)",
        ),
        (
            "k * x^60",
            "12: `k * x^60`: its unit has a power that no quantity has; ",
        ),
        (
            "k * x^61",
            "16: `x^61`: the base is a length (m), which has no power of 61; ",
        ),
        (
            "k * v",
            "12: the formula is a power (W), but friction takes a force (N); multiply it by something in s/m",
        ),
    ];
    for (formula, expected) in cases {
        assert_fault(formula, expected);
    }
}

fn assert_fault(formula: &str, expected: &str) {
    let found = fault(formula);
    assert!(
        found.starts_with(&format!("m.toml:6:{expected}")),
        "{formula}\nexpected {expected}\n     got {found}"
    );
}

/// The message for the definition of a friction term after a change.
fn definition_fault(change: impl FnOnce(&mut TermDefinition)) -> String {
    let mut definition = definition(
        Place::Friction,
        "k * tanh(v / w)",
        &[("k", "N"), ("w", "mm/s")],
    );
    definition.parameters[1].low = 0.5;
    change(&mut definition);
    read_with(&[definition])
        .err()
        .unwrap_or_else(|| "no fault".to_owned())
}

#[test]
fn a_definition_that_cannot_be_fitted_is_refused_where_it_stands() {
    assert_eq!(definition_fault(|_| ()), "no fault");
    type Change = fn(&mut TermDefinition);
    let cases: [(&str, &str, Change); 17] = [
        (
            "4:6: `End Cushion` is not a valid name of a term",
            "lower-case letters",
            |d| d.id = "End Cushion".into(),
        ),
        (
            "4:6: coulomb-friction is an effect of the catalogue",
            "another name",
            |d| d.id = "coulomb-friction".into(),
        ),
        (
            "3:1: the term has no parameter",
            "add a [[term.parameter]]",
            |d| d.parameters.clear(),
        ),
        ("3:1: the term has 9 parameters", "the maximum is 8", |d| {
            d.parameters = vec![parameter("a", ""); 9]
        }),
        (
            "8:8: `2k` is not a valid name of a parameter",
            "letters",
            |d| d.parameters[0].name = "2k".into(),
        ),
        (
            "8:8: `x` is a signal or a function already",
            "another",
            |d| d.parameters[0].name = "x".into(),
        ),
        (
            "8:8: `exp` is a signal or a function already",
            "another",
            |d| d.parameters[0].name = "exp".into(),
        ),
        ("15:8: `k` is there already", "another", |d| {
            d.parameters[1].name = "k".into()
        }),
        ("9:8: unit `Nm` is not known", "", |d| {
            d.parameters[0].unit = "Nm".into()
        }),
        ("12:7: the range of k, 10 to 10, is empty", "below", |d| {
            d.parameters[0].low = 10.0
        }),
        (
            "11:9: start = 11 of k is outside of -10 to 10",
            "widen",
            |d| d.parameters[0].start = 11.0,
        ),
        (
            "10:8: null = -11 of k is outside of -10 to 10",
            "widen",
            |d| d.parameters[0].null = -11.0,
        ),
        ("11:9: k starts at its null value", "expected", |d| {
            d.parameters[0].start = 0.0
        }),
        (
            "8:8: the formula does not contain the parameter `k`",
            "delete",
            |d| d.formula = "1[N] * tanh(v / w)".into(),
        ),
        (
            "6:12: the term is not zero at the null value of its size at k = 0 N, w = 1 mm/s, v = -0.3 m/s",
            "multiply the whole formula by k",
            |d| d.formula = "(k + 3[N]) * tanh(v / w)".into(),
        ),
        (
            "6:12: the term is not a finite number at k = 1 N, w = 1 mm/s, v = 0 m/s",
            "as in max(x, 1[mm])",
            |d| d.formula = "k * w / v".into(),
        ),
        (
            "6:12: the term is not a finite number at k = 1 N, w = 0 mm/s, v = 0 m/s",
            "narrow the ranges of the parameters",
            |d| d.parameters[1].low = 0.0,
        ),
    ];
    for (what, hint, change) in cases {
        let found = definition_fault(change);
        let where_and_what = format!("m.toml:{what}");
        assert!(
            found.starts_with(&where_and_what) && found.contains(hint),
            "expected {what}\n     got {found}"
        );
        assert_eq!(found.lines().count(), 1, "{found}");
    }
}

#[test]
fn every_signal_and_place_can_be_used() {
    for place in Place::all() {
        for signal in &SIGNALS {
            let unit = format!("({})/({})", place.unit(), signal.unit).replace("(rad)", "1");
            let formula = format!("k * {}", signal.name);
            let term = Term::new(definition(place, &formula, &[("k", &unit)]));
            assert!(
                term.is_ok(),
                "{} {formula} {unit}: {:?}",
                place.id(),
                term.err()
            );
        }
    }
}

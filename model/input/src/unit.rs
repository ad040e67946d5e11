//! Syntax of units: `bar`, `l/min/bar`, `N*s/m`, `kg/(m s2)`, `m3/s/Pa^0.5`.
//!
//! A unit is a product or quotient of named units; a slash divides by the single factor after it, as in arithmetic.
//! Integer exponents follow the name (`m2`) or `^` (`m^-2`, `Pa^0.5`, `m^(1/3)`).

use std::f64::consts::PI;

use crate::dimension::Dimension;
use crate::fault::{Fault, shown};
use crate::naming::offer_names;

/// Longest unit, in bytes; it also bounds the nesting.
const LONGEST: usize = 64;

/// A unit: its size in SI and its dimension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Its size in SI.
    pub si: f64,
    /// Its dimension.
    pub dimension: Dimension,
}

const fn named(name: &'static str, si: f64, powers: [i8; 5]) -> (&'static str, Unit) {
    let dimension = Dimension::whole(powers);
    (name, Unit { si, dimension })
}

/// Named units, each with its size in SI and its exponents of kg, m, s, A and K.
#[rustfmt::skip]
static NAMED: [(&str, Unit); 25] = [
    named("m", 1.0, [0, 1, 0, 0, 0]),
    named("mm", 1e-3, [0, 1, 0, 0, 0]),
    named("cm", 1e-2, [0, 1, 0, 0, 0]),
    named("l", 1e-3, [0, 3, 0, 0, 0]),
    named("s", 1.0, [0, 0, 1, 0, 0]),
    named("ms", 1e-3, [0, 0, 1, 0, 0]),
    named("min", 60.0, [0, 0, 1, 0, 0]),
    named("kg", 1.0, [1, 0, 0, 0, 0]),
    named("g", 1e-3, [1, 0, 0, 0, 0]),
    named("A", 1.0, [0, 0, 0, 1, 0]),
    named("mA", 1e-3, [0, 0, 0, 1, 0]),
    named("K", 1.0, [0, 0, 0, 0, 1]),
    // A step of one degree; values are in degree Celsius.
    named("degC", 1.0, [0, 0, 0, 0, 1]),
    named("rad", 1.0, [0; 5]),
    named("deg", PI / 180.0, [0; 5]),
    named("N", 1.0, [1, 1, -2, 0, 0]),
    named("kN", 1e3, [1, 1, -2, 0, 0]),
    named("Pa", 1.0, [1, -1, -2, 0, 0]),
    named("kPa", 1e3, [1, -1, -2, 0, 0]),
    named("MPa", 1e6, [1, -1, -2, 0, 0]),
    named("bar", 1e5, [1, -1, -2, 0, 0]),
    named("J", 1.0, [1, 2, -2, 0, 0]),
    named("W", 1.0, [1, 2, -3, 0, 0]),
    named("cSt", 1e-6, [0, 2, -1, 0, 0]),
    named("Hz", 1.0, [0, 0, -1, 0, 0]),
];

impl Unit {
    /// The unit of a pure number.
    pub const ONE: Self = Self {
        si: 1.0,
        dimension: Dimension::NUMBER,
    };

    /// Parses a unit; an empty text is a pure number.
    ///
    /// # Errors
    /// A fault and its position.
    pub fn parse(text: &str) -> Result<Self, Fault> {
        if text.len() > LONGEST {
            let what = format!("the unit is longer than {LONGEST} characters");
            return Err(Fault::at(text, 0, what, "write it with fewer factors"));
        }
        if text.trim().is_empty() {
            return Ok(Self::ONE);
        }
        let mut reader = Reader { text, at: 0 };
        let unit = reader.product()?;
        match reader.next() {
            None => Ok(unit),
            Some(_) => Err(reader.stray()),
        }
    }

    fn join(self, other: Self, divide: bool) -> Option<Self> {
        let (si, dimension) = if divide {
            (self.si / other.si, self.dimension.over(other.dimension))
        } else {
            (self.si * other.si, self.dimension.times(other.dimension))
        };
        Self::sound(si, dimension)
    }

    fn power(self, exponent: f64) -> Option<Self> {
        // `powi` gives exactly 1e-6 for mm2; `powf` may not.
        let si = if exponent.fract() == 0.0 && exponent.abs() < 64.0 {
            self.si.powi(exponent as i32)
        } else {
            self.si.powf(exponent)
        };
        Self::sound(si, self.dimension.power(exponent))
    }

    fn sound(si: f64, dimension: Option<Dimension>) -> Option<Self> {
        let dimension = dimension.filter(|_| si.is_normal())?;
        Some(Self { si, dimension })
    }
}

/// Parser of a unit, from left to right.
struct Reader<'t> {
    text: &'t str,
    at: usize,
}

impl<'t> Reader<'t> {
    /// The next non-blank character, without consuming it.
    fn next(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    fn eat(&mut self, wanted: char) -> bool {
        let found = self.next() == Some(wanted);
        if found {
            self.at += wanted.len_utf8();
        }
        found
    }

    fn take(&mut self, wanted: fn(char) -> bool) -> &'t str {
        let rest = &self.text[self.at..];
        let taken = &rest[..rest.find(|c| !wanted(c)).unwrap_or(rest.len())];
        self.at += taken.len();
        taken
    }

    fn stray(&self) -> Fault {
        let what = match self.text[self.at..].chars().next() {
            Some(c) => format!("{} does not belong in a unit", shown(&c.to_string())),
            None => "the unit ends too early".to_owned(),
        };
        Fault::at(
            self.text,
            self.at,
            what,
            "write it like m3/s, N*s/m or kg/(m s2)",
        )
    }

    fn product(&mut self) -> Result<Unit, Fault> {
        let mut unit = self.factor()?;
        loop {
            let divide = self.eat('/');
            let goes_on = divide
                || self.eat('*')
                || self.next().is_some_and(|c| c.is_alphanumeric() || c == '(');
            if !goes_on {
                return Ok(unit);
            }
            let at = self.at;
            let factor = self.factor()?;
            unit = unit.join(factor, divide).ok_or_else(|| self.beyond(at))?;
        }
    }

    fn factor(&mut self) -> Result<Unit, Fault> {
        if self.eat('(') {
            let unit = self.product()?;
            return if self.eat(')') {
                Ok(unit)
            } else {
                Err(self.stray())
            };
        }
        self.next();
        let at = self.at;
        let name = self.take(char::is_alphabetic);
        if name.is_empty() {
            return if self.eat('1') {
                Ok(Unit::ONE)
            } else {
                Err(self.stray())
            };
        }
        let unit = find(name).ok_or_else(|| unknown(self.text, at, name))?;
        let exponent = self.exponent()?;
        unit.power(exponent).ok_or_else(|| self.beyond(at))
    }

    fn exponent(&mut self) -> Result<f64, Fault> {
        if !self.eat('^') {
            let digits = self.take(|c| c.is_ascii_digit());
            return if digits.is_empty() {
                Ok(1.0)
            } else {
                self.number(digits)
            };
        }
        if !self.eat('(') {
            return self.signed();
        }
        let above = self.signed()?;
        let below = if self.eat('/') { self.signed()? } else { 1.0 };
        if self.eat(')') {
            Ok(above / below)
        } else {
            Err(self.stray())
        }
    }

    fn signed(&mut self) -> Result<f64, Fault> {
        let sign = if self.eat('-') { -1.0 } else { 1.0 };
        self.next();
        let digits = self.take(|c| c.is_ascii_digit() || c == '.');
        Ok(sign * self.number(digits)?)
    }

    fn number(&self, digits: &str) -> Result<f64, Fault> {
        digits.parse().map_err(|_| self.stray())
    }

    fn beyond(&self, at: usize) -> Fault {
        let what = "the exponent of the unit is out of range";
        Fault::at(
            self.text,
            at,
            what,
            "use exponents that are multiples of 1/12, up to 60",
        )
    }
}

fn find(name: &str) -> Option<Unit> {
    NAMED
        .iter()
        .find(|(known, _)| *known == name)
        .map(|(_, unit)| *unit)
}

fn unknown(text: &str, at: usize, name: &str) -> Fault {
    let names = NAMED.map(|(name, _)| name);
    let what = format!("unit {} is not known", shown(name));
    Fault::at(text, at, what, offer_names(name, &names))
}

#[cfg(test)]
mod tests {
    use super::*;
    const M3_S_PER_LPM: f64 = 1e-3 / 60.0;

    use proptest::prelude::*;

    #[test]
    fn sizes_and_dimensions() {
        let cases = [
            ("", 1.0, "1"),
            ("1", 1.0, "1"),
            ("bar", 1e5, "Pa"),
            ("kg/(m s2)", 1.0, "Pa"),
            ("kg/m/s^2", 1.0, "Pa"),
            ("l/min", M3_S_PER_LPM, "m3/s"),
            ("l/min/bar", M3_S_PER_LPM / 1e5, "m3/s/Pa"),
            ("l / (min bar)", 1e-3 / (60.0 * 1e5), "m3/s/Pa"),
            ("N*s/m", 1.0, "N*s/m"),
            ("mm/s", 1e-3, "m/s"),
            ("deg/s", PI / 180.0, "1/s"),
            ("cSt", 1e-6, "m2/s"),
            ("mm2", 1e-3_f64.powi(2), "m2"),
            ("1/mm", 1e3, "1/m"),
            ("m3/s/Pa^0.5", 1.0, "m^3.5/kg^0.5"),
            ("m^(1/3)", 1.0, "m^(4/12)"),
            ("s^-1", 1.0, "1/s"),
        ];
        for (text, si, dimension) in cases {
            let unit = Unit::parse(text).unwrap();
            assert_eq!(unit.si, si, "{text}");
            assert_eq!(
                unit.dimension,
                Unit::parse(dimension).unwrap().dimension,
                "{text}"
            );
        }
    }

    #[test]
    fn faults_say_where() {
        let cases = [
            (
                "Bar",
                "column 1: unit `Bar` is not known; did you mean bar?",
            ),
            (
                "l/Min",
                "column 3: unit `Min` is not known; did you mean min?",
            ),
            ("m/", "column 3: the unit ends too early; "),
            ("m/(s", "column 5: the unit ends too early; "),
            ("m%", "column 2: `%` does not belong in a unit; "),
            ("3 m", "column 1: `3` does not belong in a unit; "),
            ("m^", "column 3: the unit ends too early; "),
            (
                "m99",
                "column 1: the exponent of the unit is out of range; ",
            ),
            (
                "m^(1/0)",
                "column 1: the exponent of the unit is out of range; ",
            ),
            ("µm", "column 1: unit `µm` is not known; "),
        ];
        for (text, fault) in cases {
            let found = Unit::parse(text).unwrap_err().to_string();
            assert!(found.starts_with(fault), "{text}: {found}");
        }
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in ".{0,80}") {
            let _ = Unit::parse(&text);
        }

        #[test]
        fn what_looks_like_a_unit_is_read_or_refused(text in "[a-zA-Z0-9*/^(). -]{0,30}") {
            let _ = Unit::parse(&text);
        }

        #[test]
        fn a_dimension_reads_back_as_it_is_written(powers in prop::array::uniform5(-36..36_i16)) {
            let base = ["kg", "m", "s", "A", "K"].map(|name| find(name).unwrap().dimension);
            let product = base.iter().zip(powers).fold(Dimension::NUMBER, |product, (base, power)| {
                product.times(base.power(f64::from(power) / 12.0).unwrap()).unwrap()
            });
            prop_assert_eq!(Unit::parse(&product.to_string()).unwrap().dimension, product);
        }
    }
}

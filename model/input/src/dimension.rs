//! Physical dimensions: powers of metre, kilogram, second, ampere and kelvin.
//!
//! An angle is a pure number. Exponents are rational, as flow is proportional to the square root of pressure: they are
//! stored in twelfths, so halves, thirds and quarters are exact.

use std::fmt;

/// Denominator of the exponents.
const PARTS: i16 = 12;
/// Largest exponent, in twelfths. No physical quantity exceeds it.
const MOST: i16 = 60 * PARTS;
/// Symbols of the base units.
const SYMBOLS: [&str; 5] = ["kg", "m", "s", "A", "K"];

/// A product of powers of the base units.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Dimension([i16; 5]);

/// Named dimensions, with their usual unit.
const NAMED: [(Dimension, &str, &str); 20] = [
    (Dimension::whole([0, 1, 0, 0, 0]), "a length", "m"),
    (Dimension::whole([0, 2, 0, 0, 0]), "an area", "m2"),
    (Dimension::whole([0, 3, 0, 0, 0]), "a volume", "m3"),
    (Dimension::whole([1, 0, 0, 0, 0]), "a mass", "kg"),
    (Dimension::whole([0, 0, 1, 0, 0]), "a time", "s"),
    (Dimension::whole([0, 0, -1, 0, 0]), "a rate", "1/s"),
    (Dimension::whole([0, 0, 0, 1, 0]), "a current", "A"),
    (Dimension::whole([0, 0, 0, 0, 1]), "a temperature", "K"),
    (Dimension::whole([0, 1, -1, 0, 0]), "a speed", "m/s"),
    (
        Dimension::whole([0, 1, -2, 0, 0]),
        "an acceleration",
        "m/s2",
    ),
    (Dimension::whole([1, 1, -2, 0, 0]), "a force", "N"),
    (
        Dimension::whole([1, 2, -2, 0, 0]),
        "a torque or energy",
        "N*m",
    ),
    (Dimension::whole([1, 2, -3, 0, 0]), "a power", "W"),
    (Dimension::whole([1, 0, -2, 0, 0]), "a stiffness", "N/m"),
    (Dimension::whole([1, 0, -1, 0, 0]), "a damping", "N*s/m"),
    (Dimension::whole([1, -1, -2, 0, 0]), "a pressure", "Pa"),
    (Dimension::whole([0, 3, -1, 0, 0]), "a flow", "m3/s"),
    (
        Dimension::whole([0, 2, -1, 0, 0]),
        "a kinematic viscosity",
        "m2/s",
    ),
    (Dimension::whole([1, -3, 0, 0, 0]), "a density", "kg/m3"),
    (
        Dimension::whole([-1, 4, 1, 0, 0]),
        "a leakage conductance",
        "m3/s/Pa",
    ),
];

impl Dimension {
    /// The dimension of a pure number.
    pub const NUMBER: Self = Self([0; 5]);
    /// The dimension of a length.
    pub const LENGTH: Self = Self::whole([0, 1, 0, 0, 0]);

    /// Integer exponents of kilogram, metre, second, ampere and kelvin.
    #[must_use]
    pub const fn whole(powers: [i8; 5]) -> Self {
        let mut parts = [0; 5];
        let mut i = 0;
        while i < parts.len() {
            parts[i] = powers[i] as i16 * PARTS;
            i += 1;
        }
        Self(parts)
    }

    /// Exponents of kilogram, metre, second, ampere and kelvin; `None` if one is not whole.
    #[must_use]
    pub fn whole_powers(self) -> Option<[i8; 5]> {
        let mut powers = [0; 5];
        for (power, parts) in powers.iter_mut().zip(self.0) {
            if parts % PARTS != 0 {
                return None;
            }
            *power = i8::try_from(parts / PARTS).ok()?;
        }
        Some(powers)
    }

    /// Whether it is a pure number.
    #[must_use]
    pub fn is_number(self) -> bool {
        self == Self::NUMBER
    }

    /// Dimension of a product; `None` if an exponent is out of range.
    #[must_use]
    pub fn times(self, other: Self) -> Option<Self> {
        self.join(other, |a, b| a + b)
    }

    /// Dimension of a quotient; `None` if an exponent is out of range.
    #[must_use]
    pub fn over(self, other: Self) -> Option<Self> {
        self.join(other, |a, b| a - b)
    }

    /// Dimension of a power; `None` if an exponent is out of range or not a multiple of a twelfth.
    #[must_use]
    pub fn power(self, exponent: f64) -> Option<Self> {
        let mut result = Self::NUMBER;
        for (part, own) in result.0.iter_mut().zip(self.0) {
            let wanted = f64::from(own) * exponent;
            let nearest = wanted.round();
            // A third as a floating-point number differs only by its rounding error.
            let fits = (wanted - nearest).abs() <= 1e-9 && nearest.abs() <= f64::from(MOST);
            if !fits {
                return None;
            }
            *part = nearest as i16;
        }
        Some(result)
    }

    fn join(self, other: Self, join: fn(i16, i16) -> i16) -> Option<Self> {
        let mut result = self;
        for (part, other) in result.0.iter_mut().zip(other.0) {
            *part = join(*part, other);
        }
        result
            .0
            .iter()
            .all(|part| part.abs() <= MOST)
            .then_some(result)
    }

    /// Description of the dimension: `a pressure (Pa)`, `a pure number`.
    #[must_use]
    pub fn in_words(self) -> String {
        if self.is_number() {
            return "a pure number".to_owned();
        }
        match self.named() {
            Some((_, name, unit)) => format!("{name} ({unit})"),
            None => format!("in {self}"),
        }
    }

    fn named(self) -> Option<&'static (Self, &'static str, &'static str)> {
        NAMED.iter().find(|(dimension, ..)| *dimension == self)
    }
}

/// Writes a unit of the dimension in the syntax of [`crate::unit::Unit`]: `Pa`, `kg/(m s3)`, `1`.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((_, _, unit)) = self.named() {
            return f.write_str(unit);
        }
        let inverse = Self::NUMBER.over(*self).and_then(Self::named);
        if let Some((_, _, unit)) =
            inverse.filter(|(.., unit)| unit.chars().all(char::is_alphabetic))
        {
            return write!(f, "1/{unit}");
        }
        let side = |sign: i16| -> Vec<String> {
            let powers = SYMBOLS
                .iter()
                .zip(self.0)
                .filter(|(_, part)| part * sign > 0);
            powers
                .map(|(symbol, part)| power_text(symbol, part.abs()))
                .collect()
        };
        let (above, below) = (side(1), side(-1));
        let above = if above.is_empty() {
            "1".to_owned()
        } else {
            above.join(" ")
        };
        match below.as_slice() {
            [] => f.write_str(&above),
            [one] => write!(f, "{above}/{one}"),
            several => write!(f, "{above}/({})", several.join(" ")),
        }
    }
}

fn power_text(symbol: &str, parts: i16) -> String {
    match (parts / PARTS, parts % PARTS) {
        (1, 0) => symbol.to_owned(),
        (whole, 0) => format!("{symbol}{whole}"),
        _ if parts % 3 == 0 => format!("{symbol}^{}", f64::from(parts) / f64::from(PARTS)),
        _ => format!("{symbol}^({parts}/{PARTS})"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PRESSURE: Dimension = Dimension::whole([1, -1, -2, 0, 0]);

    #[test]
    fn reads_like_a_unit() {
        assert_eq!(PRESSURE.in_words(), "a pressure (Pa)");
        assert_eq!(Dimension::NUMBER.in_words(), "a pure number");
        assert_eq!(Dimension::NUMBER.to_string(), "1");
        assert_eq!(Dimension::whole([1, -1, -3, 0, 0]).to_string(), "kg/(m s3)");
        assert_eq!(PRESSURE.power(0.5).unwrap().to_string(), "kg^0.5/(m^0.5 s)");
        assert_eq!(
            Dimension::LENGTH.power(1.0 / 3.0).unwrap().to_string(),
            "m^(4/12)"
        );
        assert_eq!(Dimension::LENGTH.power(1.5).unwrap().to_string(), "m^1.5");
    }

    #[test]
    fn powers_stay_exact_and_bounded() {
        let root = PRESSURE.power(0.5).unwrap();
        assert_eq!(root.times(root), Some(PRESSURE));
        assert_eq!(PRESSURE.over(PRESSURE), Some(Dimension::NUMBER));
        assert_eq!(Dimension::LENGTH.power(1.2), None);
        assert_eq!(Dimension::LENGTH.power(1e300), None);
        assert_eq!(Dimension::LENGTH.power(f64::NAN), None);
        let most = Dimension::LENGTH.power(60.0).unwrap();
        assert_eq!(most.times(Dimension::LENGTH), None);
        assert_eq!(Dimension::NUMBER.power(1e300), Some(Dimension::NUMBER));
    }
}

//! Operations of formulas.
//!
//! NaN propagates through every operation, so that a fault is not hidden by a zero.

/// An operation on one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unary {
    /// Minus.
    Negative,
    /// Square root.
    Sqrt,
    /// Signed square root: flow through an orifice.
    SignedSqrt,
    /// Absolute value.
    Abs,
    /// -1, 0 or 1.
    Sign,
    /// Exponential function.
    Exp,
    /// Natural logarithm.
    Ln,
    /// Hyperbolic tangent.
    Tanh,
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// The number if positive, else 0.
    Ramp,
    /// 1 if the number is positive, else 0.
    Step,
}

/// An operation on two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Binary {
    /// Sum.
    Add,
    /// Difference.
    Subtract,
    /// Product.
    Multiply,
    /// Quotient.
    Divide,
    /// Power.
    Power,
    /// The smaller one.
    Min,
    /// The larger one.
    Max,
}

/// A function by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Function {
    /// Of one argument.
    Unary(Unary),
    /// Of two arguments.
    Binary(Binary),
    /// `clamp(x, low, high)`: x, but at least low and at most high.
    Clamp,
}

/// Every function, with its arguments and a description, for documents and messages.
pub const FUNCTIONS: [(&str, Function, &str); 14] = [
    (
        "sqrt",
        Function::Unary(Unary::Sqrt),
        "sqrt(a): square root; halves the unit",
    ),
    (
        "ssqrt",
        Function::Unary(Unary::SignedSqrt),
        "ssqrt(a): sgn(a) * sqrt(abs(a)); halves the unit",
    ),
    (
        "abs",
        Function::Unary(Unary::Abs),
        "abs(a): absolute value; keeps the unit",
    ),
    (
        "sgn",
        Function::Unary(Unary::Sign),
        "sgn(a): -1, 0 or 1, a pure number",
    ),
    (
        "min",
        Function::Binary(Binary::Min),
        "min(a, b): the smaller one, of the same unit",
    ),
    (
        "max",
        Function::Binary(Binary::Max),
        "max(a, b): the larger one, of the same unit",
    ),
    (
        "clamp",
        Function::Clamp,
        "clamp(a, low, high): a, but at least low and at most high, of the same unit",
    ),
    (
        "exp",
        Function::Unary(Unary::Exp),
        "exp(a): exponential of a pure number",
    ),
    (
        "ln",
        Function::Unary(Unary::Ln),
        "ln(a): natural logarithm of a pure number",
    ),
    (
        "tanh",
        Function::Unary(Unary::Tanh),
        "tanh(a): hyperbolic tangent of a pure number",
    ),
    (
        "sin",
        Function::Unary(Unary::Sin),
        "sin(a): sine of an angle",
    ),
    (
        "cos",
        Function::Unary(Unary::Cos),
        "cos(a): cosine of an angle",
    ),
    (
        "ramp",
        Function::Unary(Unary::Ramp),
        "ramp(a): a where it is positive, else 0; keeps the unit",
    ),
    (
        "step",
        Function::Unary(Unary::Step),
        "step(a): 1 where a is positive, else 0, a pure number",
    ),
];

impl Function {
    /// The function with this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let found = FUNCTIONS.iter().find(|(known, ..)| *known == name);
        found.map(|(_, function, _)| *function)
    }

    /// Number of its arguments.
    #[must_use]
    pub const fn arguments(self) -> usize {
        match self {
            Self::Unary(_) => 1,
            Self::Binary(_) => 2,
            Self::Clamp => 3,
        }
    }
}

impl Unary {
    /// The value.
    #[inline]
    #[must_use]
    pub fn of(self, a: f64) -> f64 {
        match self {
            Self::Negative => -a,
            Self::Sqrt => a.sqrt(),
            Self::SignedSqrt => a.abs().sqrt().copysign(a),
            Self::Abs => a.abs(),
            Self::Sign => sign(a),
            Self::Exp => a.exp(),
            Self::Ln => a.ln(),
            Self::Tanh => a.tanh(),
            Self::Sin => a.sin(),
            Self::Cos => a.cos(),
            Self::Ramp => Binary::Max.of(a, 0.0),
            Self::Step => Binary::Max.of(sign(a), 0.0),
        }
    }
}

impl Binary {
    /// The value.
    #[inline]
    #[must_use]
    pub fn of(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide => a / b,
            // Squares are common, and a product is faster than the general power.
            Self::Power if b == 2.0 => a * a,
            Self::Power => a.powf(b),
            // Not `f64::min`, which ignores NaN.
            Self::Min if a < b || a.is_nan() => a,
            Self::Max if a > b || a.is_nan() => a,
            Self::Min | Self::Max => b,
        }
    }
}

/// -1, 0 or 1; unlike `f64::signum`, 0 at 0.
fn sign(a: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a.signum() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_at_the_corners() {
        assert_eq!(Unary::SignedSqrt.of(-9.0), -3.0);
        assert_eq!(
            [-2.0, 0.0, -0.0, 5.0].map(|a| Unary::Sign.of(a)),
            [-1.0, 0.0, 0.0, 1.0]
        );
        assert_eq!([-2.0, 0.0, 5.0].map(|a| Unary::Step.of(a)), [0.0, 0.0, 1.0]);
        assert_eq!([-2.0, 0.0, 5.0].map(|a| Unary::Ramp.of(a)), [0.0, 0.0, 5.0]);
    }

    #[test]
    fn what_is_not_a_number_stays_so() {
        for (name, function, _) in FUNCTIONS {
            let stays = match function {
                Function::Unary(unary) => unary.of(f64::NAN).is_nan(),
                // Anything to the power of 0 is 1 by IEEE 754, but not to the power of 2.
                Function::Binary(binary) => {
                    binary.of(f64::NAN, 2.0).is_nan() && binary.of(2.0, f64::NAN).is_nan()
                }
                Function::Clamp => continue,
            };
            assert!(stays, "{name}");
        }
    }
}

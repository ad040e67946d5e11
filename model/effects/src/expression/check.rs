//! Dimensional analysis of a formula.

use hitch_input::fault::{Fault, shown};
use hitch_input::{Dimension, Unit};
use hitch_plant::hooks::signals::Signal;

use crate::expression::operation::{Binary, Unary};
use crate::expression::tree::{Kind, Node};

/// The dimension of a formula whose parameters have these dimensions.
///
/// # Errors
/// The innermost part whose units do not agree.
pub fn dimension(node: &Node, text: &str, parameters: &[Dimension]) -> Result<Dimension, Fault> {
    Checker { text, parameters }.dimension(node)
}

struct Checker<'t> {
    text: &'t str,
    parameters: &'t [Dimension],
}

impl Checker<'_> {
    fn dimension(&self, node: &Node) -> Result<Dimension, Fault> {
        match &node.kind {
            Kind::Number(_, dimension) => Ok(*dimension),
            Kind::Signal(signal) => Ok(signal_dimension(signal)),
            Kind::Parameter(index) => Ok(self.parameters[*index]),
            Kind::Unary(operation, inner) => self.unary(node, *operation, self.dimension(inner)?),
            Kind::Binary(operation, sides) => {
                let dimensions = [self.dimension(&sides[0])?, self.dimension(&sides[1])?];
                self.binary(node, *operation, sides, dimensions)
            }
        }
    }

    fn unary(&self, node: &Node, operation: Unary, inner: Dimension) -> Result<Dimension, Fault> {
        match operation {
            Unary::Negative | Unary::Abs | Unary::Ramp => Ok(inner),
            Unary::Sign | Unary::Step => Ok(Dimension::NUMBER),
            Unary::Sqrt | Unary::SignedSqrt => inner.power(0.5).ok_or_else(|| self.beyond(node)),
            Unary::Exp | Unary::Ln | Unary::Tanh | Unary::Sin | Unary::Cos if inner.is_number() => {
                Ok(inner)
            }
            Unary::Exp | Unary::Ln | Unary::Tanh | Unary::Sin | Unary::Cos => {
                let what = format!(
                    "the argument is {}, it has to be a pure number",
                    inner.in_words()
                );
                Err(self.fault(node, &what, format!("divide it by something in {inner}")))
            }
        }
    }

    fn binary(
        &self,
        node: &Node,
        operation: Binary,
        sides: &[Node; 2],
        [left, right]: [Dimension; 2],
    ) -> Result<Dimension, Fault> {
        match operation {
            Binary::Multiply => left.times(right).ok_or_else(|| self.beyond(node)),
            Binary::Divide => left.over(right).ok_or_else(|| self.beyond(node)),
            Binary::Power => self.power(node, sides, [left, right]),
            Binary::Add | Binary::Subtract | Binary::Min | Binary::Max if left == right => Ok(left),
            Binary::Add | Binary::Subtract => {
                let what = format!("left is {}, right {}", left.in_words(), right.in_words());
                Err(self.fault(node, &what, self.reconcile(sides, [left, right])))
            }
            Binary::Min | Binary::Max => {
                let what = format!(
                    "one argument is {}, another {}",
                    left.in_words(),
                    right.in_words()
                );
                Err(self.fault(node, &what, self.reconcile(sides, [left, right])))
            }
        }
    }

    /// A correction that makes the units of two sides agree. Beside a pure number, a quantity over a plain number is meant as their
    /// ratio, so the divisor lacks the unit; without such a divisor, the number itself.
    fn reconcile(&self, sides: &[Node; 2], dimensions: [Dimension; 2]) -> String {
        for (side, other) in [(0, 1), (1, 0)] {
            let quantity = &sides[other];
            let divisor = dimensions[side].is_number().then(|| divisor(quantity));
            let lacking = divisor
                .flatten()
                .or(is_plain(&sides[side]).then_some(&sides[side]));
            if let Some(node) = lacking {
                let number = &self.text[node.span.clone()];
                let unit = written_unit(quantity, dimensions[other]);
                return format!("give the number a unit: {number}[{unit}]");
            }
        }
        let piece = shown(&self.text[sides[1].span.clone()]);
        match dimensions[0].over(dimensions[1]) {
            Some(factor) => format!("multiply {piece} by something in {factor}"),
            None => "give both the same unit".to_owned(),
        }
    }

    fn power(
        &self,
        node: &Node,
        [base, exponent]: &[Node; 2],
        [base_dimension, exponent_dimension]: [Dimension; 2],
    ) -> Result<Dimension, Fault> {
        if !exponent_dimension.is_number() {
            let what = format!(
                "the exponent is {}, it has to be a pure number",
                exponent_dimension.in_words()
            );
            return Err(self.fault(
                node,
                &what,
                format!("divide it by something in {exponent_dimension}"),
            ));
        }
        if base_dimension.is_number() {
            return Ok(base_dimension);
        }
        let piece = |node: &Node| &self.text[node.span.clone()];
        let hint = || {
            format!(
                "write (({}) / 1[{base_dimension}])^({})",
                piece(base),
                piece(exponent)
            )
        };
        let Some(written) = written(exponent) else {
            let what = format!(
                "the base is {}, so its exponent has to be a written number such as 2, 0.5 or (1/3)",
                base_dimension.in_words()
            );
            return Err(self.fault(node, &what, hint()));
        };
        base_dimension.power(written).ok_or_else(|| {
            let what = format!(
                "the base is {}, which has no power of {written}",
                base_dimension.in_words()
            );
            self.fault(node, &what, hint())
        })
    }

    fn beyond(&self, node: &Node) -> Fault {
        self.fault(
            node,
            "its unit has a power that no quantity has",
            "divide by written quantities first",
        )
    }

    fn fault(&self, node: &Node, what: &str, hint: impl Into<String>) -> Fault {
        let piece = shown(&self.text[node.span.clone()]);
        Fault::at(self.text, node.span.start, format!("{piece}: {what}"), hint)
    }
}

fn signal_dimension(signal: &Signal) -> Dimension {
    Unit::parse(signal.unit)
        .expect("the units of the table are units")
        .dimension
}

/// Whether a node is a number literal without a unit.
fn is_plain(node: &Node) -> bool {
    matches!(node.kind, Kind::Number(_, dimension) if dimension.is_number())
}

/// The plain number that a quantity is divided by.
fn divisor(node: &Node) -> Option<&Node> {
    match &node.kind {
        Kind::Binary(Binary::Divide, sides) if is_plain(&sides[1]) => Some(&sides[1]),
        Kind::Unary(Unary::Negative | Unary::Abs | Unary::Ramp, inner) => divisor(inner),
        _ => None,
    }
}

/// The unit in which a number beside a quantity is written: that of its first signal of this dimension, else the SI unit.
fn written_unit(node: &Node, dimension: Dimension) -> String {
    signals(node)
        .into_iter()
        .find(|signal| signal_dimension(signal) == dimension)
        .map_or_else(
            || dimension.to_string(),
            |signal| signal.written_unit.to_owned(),
        )
}

/// The signals of a part of a formula, from left to right.
fn signals(node: &Node) -> Vec<&'static Signal> {
    match &node.kind {
        Kind::Number(..) | Kind::Parameter(_) => Vec::new(),
        Kind::Signal(signal) => vec![*signal],
        Kind::Unary(_, inner) => signals(inner),
        Kind::Binary(_, sides) => sides.iter().flat_map(signals).collect(),
    }
}

/// The value of an exponent that consists of number literals only.
fn written(node: &Node) -> Option<f64> {
    match &node.kind {
        Kind::Number(value, _) => Some(*value),
        Kind::Unary(operation, inner) => Some(operation.of(written(inner)?)),
        Kind::Binary(operation, sides) => {
            Some(operation.of(written(&sides[0])?, written(&sides[1])?))
        }
        Kind::Signal(_) | Kind::Parameter(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitch_plant::hooks::signals::SIGNALS;

    #[test]
    fn every_signal_has_a_dimension() {
        for signal in &SIGNALS {
            let written = Unit::parse(signal.written_unit).map(|unit| unit.dimension);
            assert_eq!(written, Ok(signal_dimension(signal)), "{}", signal.name);
        }
    }
}

//! A formula as a tree.

use std::ops::Range;

use hitch_input::Dimension;
use hitch_plant::hooks::signals::Signal;

use crate::expression::operation::{Binary, Function, Unary};

/// A node with all that is below it.
#[derive(Debug)]
pub struct Node {
    /// Its bytes in the formula.
    pub span: Range<usize>,
    /// Its bytes with the parentheses around it.
    pub outer: Range<usize>,
    /// What it is.
    pub kind: Kind,
}

/// What a node is.
#[derive(Debug)]
pub enum Kind {
    /// A written number: its value in SI and its dimension.
    Number(f64, Dimension),
    /// A signal of the plant.
    Signal(&'static Signal),
    /// A parameter, by its index.
    Parameter(usize),
    /// An operation on one part.
    Unary(Unary, Box<Node>),
    /// An operation on two parts.
    Binary(Binary, Box<[Node; 2]>),
}

impl Node {
    /// A node without parentheses around it.
    #[must_use]
    pub fn new(span: Range<usize>, kind: Kind) -> Self {
        let outer = span.clone();
        Self { span, outer, kind }
    }

    /// An operation on one part.
    #[must_use]
    pub fn unary(span: Range<usize>, operation: Unary, inner: Self) -> Self {
        Self::new(span, Kind::Unary(operation, Box::new(inner)))
    }

    /// An operator between its operands.
    #[must_use]
    pub fn infix(operation: Binary, left: Self, right: Self) -> Self {
        let span = left.outer.start..right.outer.end;
        Self::binary(span, operation, left, right)
    }

    /// A function of its arguments; `None` if it takes another number of them.
    #[must_use]
    pub fn call(span: Range<usize>, function: Function, arguments: Vec<Self>) -> Option<Self> {
        Some(match function {
            Function::Unary(operation) => {
                let [a] = <[Self; 1]>::try_from(arguments).ok()?;
                Self::unary(span, operation, a)
            }
            Function::Binary(operation) => {
                let [a, b] = <[Self; 2]>::try_from(arguments).ok()?;
                Self::binary(span, operation, a, b)
            }
            Function::Clamp => {
                let [a, low, high] = <[Self; 3]>::try_from(arguments).ok()?;
                let raised = Self::binary(span.clone(), Binary::Max, a, low);
                Self::binary(span, Binary::Min, raised, high)
            }
        })
    }

    /// Whether any of its numbers, signals and parameters is such a one.
    pub fn has(&self, such: &dyn Fn(&Kind) -> bool) -> bool {
        match &self.kind {
            Kind::Unary(_, inner) => inner.has(such),
            Kind::Binary(_, sides) => sides.iter().any(|side| side.has(such)),
            leaf => such(leaf),
        }
    }

    fn binary(span: Range<usize>, operation: Binary, left: Self, right: Self) -> Self {
        Self::new(span, Kind::Binary(operation, Box::new([left, right])))
    }
}

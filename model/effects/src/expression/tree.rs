//! Syntax tree of a formula.

use std::ops::Range;

use hitch_input::Dimension;
use hitch_plant::hooks::signals::Signal;

use crate::expression::operation::{Binary, Function, Unary};

/// A node with its subtree.
#[derive(Debug)]
pub struct Node {
    /// Its byte range in the formula.
    pub span: Range<usize>,
    /// Its byte range including its parentheses.
    pub outer: Range<usize>,
    /// Its kind.
    pub kind: Kind,
}

/// Kind of a node.
#[derive(Debug)]
pub enum Kind {
    /// A number literal: its value in SI and its dimension.
    Number(f64, Dimension),
    /// A signal of the plant.
    Signal(&'static Signal),
    /// A parameter, by its index.
    Parameter(usize),
    /// A unary operation.
    Unary(Unary, Box<Node>),
    /// A binary operation.
    Binary(Binary, Box<[Node; 2]>),
}

impl Node {
    /// A node without parentheses.
    #[must_use]
    pub fn new(span: Range<usize>, kind: Kind) -> Self {
        let outer = span.clone();
        Self { span, outer, kind }
    }

    /// A unary operation.
    #[must_use]
    pub fn unary(span: Range<usize>, operation: Unary, inner: Self) -> Self {
        Self::new(span, Kind::Unary(operation, Box::new(inner)))
    }

    /// A binary operation.
    #[must_use]
    pub fn infix(operation: Binary, left: Self, right: Self) -> Self {
        let span = left.outer.start..right.outer.end;
        Self::binary(span, operation, left, right)
    }

    /// A function call; `None` if the number of arguments is wrong.
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

    /// Whether any number, signal or parameter satisfies a predicate.
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

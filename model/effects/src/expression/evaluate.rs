//! Compiled formulas: a list of instructions for a small stack.
//!
//! The tree is flattened from the leaves to the root, so evaluation is one pass over a list. Constant subexpressions
//! are evaluated at compile time.

use hitch_plant::hooks::signals::{Signal, Signals};

use crate::expression::operation::{Binary, Unary};
use crate::expression::parse::DEEPEST;
use crate::expression::tree::{Kind, Node};

/// Stack size that is sufficient for most formulas; clearing a larger one costs time.
const FEW: usize = 8;
/// Stack size for the most deeply nested formula.
const MANY: usize = DEEPEST + 4;

/// A formula ready to evaluate.
#[derive(Debug)]
pub struct Code {
    steps: Box<[Instruction]>,
    /// Largest stack depth.
    depth: usize,
}

#[derive(Debug, Clone, Copy)]
enum Instruction {
    Number(f64),
    Signal(&'static Signal),
    Parameter(usize),
    Unary(Unary),
    Binary(Binary),
    /// An operation whose right operand is a number literal.
    BinaryNumber(Binary, f64),
}

impl Code {
    /// Compiles a tree.
    #[must_use]
    pub fn compile(tree: &Node) -> Self {
        let mut compiler = Compiler::default();
        compiler.node(tree);
        Self {
            steps: compiler.steps.into_boxed_slice(),
            depth: compiler.most,
        }
    }

    /// The value, SI; NaN or infinite if the formula is. Missing parameters count as NaN.
    #[inline]
    #[must_use]
    pub fn evaluate(&self, parameters: &[f64], signals: &Signals) -> f64 {
        if self.depth <= FEW {
            self.run::<FEW>(parameters, signals)
        } else {
            self.run::<MANY>(parameters, signals)
        }
    }

    fn run<const SIZE: usize>(&self, parameters: &[f64], signals: &Signals) -> f64 {
        let mut stack = [0.0; SIZE];
        // The top of the stack is kept in a variable, so that unary operations do not access the stack.
        let mut top = f64::NAN;
        let mut height = 0;
        for step in &self.steps {
            match *step {
                Instruction::Unary(operation) => top = operation.of(top),
                Instruction::BinaryNumber(operation, right) => top = operation.of(top, right),
                Instruction::Binary(operation) => {
                    height -= 1;
                    top = operation.of(stack[height], top);
                }
                Instruction::Number(_) | Instruction::Signal(_) | Instruction::Parameter(_) => {
                    stack[height] = top;
                    height += 1;
                    top = step.load(parameters, signals);
                }
            }
        }
        top
    }
}

impl Instruction {
    #[inline]
    fn load(&self, parameters: &[f64], signals: &Signals) -> f64 {
        match *self {
            Self::Number(value) => value,
            Self::Signal(signal) => (signal.value)(signals),
            Self::Parameter(index) => parameters.get(index).copied().unwrap_or(f64::NAN),
            Self::Unary(_) | Self::Binary(_) | Self::BinaryNumber(..) => f64::NAN,
        }
    }
}

#[derive(Default)]
struct Compiler {
    steps: Vec<Instruction>,
    height: usize,
    most: usize,
}

impl Compiler {
    fn node(&mut self, node: &Node) {
        match &node.kind {
            Kind::Number(value, _) => self.load(Instruction::Number(*value)),
            Kind::Signal(signal) => self.load(Instruction::Signal(signal)),
            Kind::Parameter(index) => self.load(Instruction::Parameter(*index)),
            Kind::Unary(operation, inner) => {
                self.node(inner);
                self.unary(*operation);
            }
            Kind::Binary(operation, sides) => {
                sides.iter().for_each(|side| self.node(side));
                self.height -= 1;
                self.binary(*operation);
            }
        }
    }

    fn load(&mut self, step: Instruction) {
        self.steps.push(step);
        self.height += 1;
        self.most = self.most.max(self.height);
    }

    fn unary(&mut self, operation: Unary) {
        if let Some(Instruction::Number(value)) = self.steps.last_mut() {
            *value = operation.of(*value);
        } else {
            self.steps.push(Instruction::Unary(operation));
        }
    }

    fn binary(&mut self, operation: Binary) {
        let Some(&Instruction::Number(right)) = self.steps.last() else {
            self.steps.push(Instruction::Binary(operation));
            return;
        };
        self.steps.pop();
        match self.steps.last_mut() {
            Some(Instruction::Number(left)) => *left = operation.of(*left, right),
            _ => self.steps.push(Instruction::BinaryNumber(operation, right)),
        }
    }
}

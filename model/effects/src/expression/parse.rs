//! Operator-precedence parser for formulas.
//!
//! From low to high precedence: `+ -`, then `* /`, both left-associative; then unary minus; then `^`,
//! right-associative. So `-2^2` is -4 and `2^3^2` is 512, as in mathematics.

use std::ops::Range;

use hitch_input::fault::{Fault, shown};
use hitch_input::naming::offer_names;
use hitch_input::{Dimension, Unit};
use hitch_plant::hooks::signals::SIGNALS;

use crate::expression::operation::{Binary, FUNCTIONS, Function, Unary};
use crate::expression::token::{Token, TokenKind, tokens};
use crate::expression::tree::{Kind, Node};

/// Deepest nesting. Each level holds one intermediate result, so it also bounds the stack of the evaluation.
pub const DEEPEST: usize = 60;

/// Precedence of unary minus.
const UNARY_MINUS: u8 = 5;

/// Parses a formula whose parameters have these names.
///
/// # Errors
/// A syntax error and its position. Units are not checked.
pub fn parse(text: &str, parameters: &[&str]) -> Result<Node, Fault> {
    let mut parser = Parser {
        text,
        parameters,
        tokens: tokens(text)?,
        at: 0,
        depth: 0,
    };
    if parser.peek().kind == TokenKind::End {
        return Err(Fault::at(
            text,
            0,
            "the formula is empty",
            "write for example size * x / 1[m]",
        ));
    }
    let node = parser.expression(0)?;
    match parser.peek().kind {
        TokenKind::End => Ok(node),
        _ => Err(parser.stray()),
    }
}

struct Parser<'t> {
    text: &'t str,
    parameters: &'t [&'t str],
    tokens: Vec<Token>,
    at: usize,
    depth: usize,
}

impl<'t> Parser<'t> {
    fn peek(&self) -> &Token {
        &self.tokens[self.at]
    }

    /// The next token; after the end, the end token again.
    fn next(&mut self) -> Token {
        let token = self.peek().clone();
        self.at = (self.at + 1).min(self.tokens.len() - 1);
        token
    }

    fn eat(&mut self, sign: char) -> bool {
        let found = self.peek().kind == TokenKind::Sign(sign);
        if found {
            self.next();
        }
        found
    }

    fn piece(&self, span: &Range<usize>) -> &'t str {
        &self.text[span.clone()]
    }

    fn fault(
        &self,
        span: &Range<usize>,
        what: impl Into<String>,
        hint: impl Into<String>,
    ) -> Fault {
        Fault::at(self.text, span.start, what, hint)
    }

    /// An expression whose operators all have at least this precedence.
    fn expression(&mut self, tightness: u8) -> Result<Node, Fault> {
        if self.depth == DEEPEST {
            let what = format!("the formula is nested more than {DEEPEST} deep");
            return Err(self.fault(&self.peek().span, what, "write it with fewer parentheses"));
        }
        self.depth += 1;
        let mut left = self.operand()?;
        while let TokenKind::Sign(sign) = self.peek().kind {
            let Some((operation, own, right)) = infix(sign) else {
                break;
            };
            if own < tightness {
                break;
            }
            self.next();
            let right = self.expression(right)?;
            left = Node::infix(operation, left, right);
        }
        self.depth -= 1;
        Ok(left)
    }

    fn operand(&mut self) -> Result<Node, Fault> {
        let token = self.next();
        match token.kind {
            TokenKind::Number(value) => self.number(value, token.span),
            TokenKind::Name if self.peek().kind == TokenKind::Sign('(') => self.call(&token.span),
            TokenKind::Name => self.name(token.span),
            TokenKind::Sign('-') => {
                let inner = self.expression(UNARY_MINUS)?;
                let span = token.span.start..inner.outer.end;
                Ok(Node::unary(span, Unary::Negative, inner))
            }
            TokenKind::Sign('(') => {
                let inner = self.expression(0)?;
                let outer = token.span.start..self.close(&token.span)?;
                Ok(Node { outer, ..inner })
            }
            TokenKind::End => {
                let hint = "a number, a name or a parenthesis has to follow";
                Err(self.fault(&token.span, "the formula ends too early", hint))
            }
            TokenKind::Sign(_) | TokenKind::Unit => {
                let piece = shown(self.piece(&token.span));
                let what = format!("found {piece}, expected a number, a name or a parenthesis");
                let hint = "write an operator between two operands, and a unit after a number";
                Err(self.fault(&token.span, what, hint))
            }
        }
    }

    fn number(&mut self, value: f64, span: Range<usize>) -> Result<Node, Fault> {
        if self.peek().kind != TokenKind::Unit {
            return Ok(Node::new(span, Kind::Number(value, Dimension::NUMBER)));
        }
        let brackets = self.next().span;
        let inside = brackets.start + 1..brackets.end - 1;
        let unit = Unit::parse(self.piece(&inside))
            .map_err(|fault| fault.inside(self.text, inside.start))?;
        let si = value * unit.si;
        if !si.is_finite() {
            return Err(self.fault(&span, "the number is too large", "write a smaller one"));
        }
        let kind = Kind::Number(si, unit.dimension);
        Ok(Node::new(span.start..brackets.end, kind))
    }

    fn name(&self, span: Range<usize>) -> Result<Node, Fault> {
        let name = self.piece(&span);
        if let Some(index) = self.parameters.iter().position(|known| *known == name) {
            return Ok(Node::new(span, Kind::Parameter(index)));
        }
        if let Some(signal) = SIGNALS.iter().find(|signal| signal.name == name) {
            return Ok(Node::new(span, Kind::Signal(signal)));
        }
        let what = format!("name {} is not known", shown(name));
        if Function::named(name).is_some() {
            let hint = format!("it is a function: write {name}(...)");
            return Err(self.fault(&span, what, hint));
        }
        let signals = SIGNALS.iter().map(|signal| signal.name);
        Err(self.unknown(
            &span,
            what,
            &self
                .parameters
                .iter()
                .copied()
                .chain(signals)
                .collect::<Vec<_>>(),
        ))
    }

    fn unknown(&self, span: &Range<usize>, what: String, known: &[&str]) -> Fault {
        self.fault(span, what, offer_names(self.piece(span), known))
    }

    fn call(&mut self, name_span: &Range<usize>) -> Result<Node, Fault> {
        let name = self.piece(name_span);
        let Some(function) = Function::named(name) else {
            return Err(self.no_function(name_span, name));
        };
        let open = self.next().span;
        let mut arguments = Vec::new();
        if self.peek().kind != TokenKind::Sign(')') {
            arguments.push(self.expression(0)?);
            while self.eat(',') {
                arguments.push(self.expression(0)?);
            }
        }
        let span = name_span.start..self.close(&open)?;
        let count = arguments.len();
        Node::call(span.clone(), function, arguments).ok_or_else(|| {
            let what = format!("{name} takes {}, not {count}", many(function.arguments()));
            let known = FUNCTIONS.iter().find(|(known, ..)| *known == name);
            self.fault(&span, what, known.map_or("", |(.., meaning)| *meaning))
        })
    }

    fn no_function(&self, span: &Range<usize>, name: &str) -> Fault {
        let what = format!("function {} is not known", shown(name));
        if self.name(span.clone()).is_ok() {
            return self.fault(span, what, format!("a product is written {name} * (...)"));
        }
        self.unknown(span, what, &FUNCTIONS.map(|(name, ..)| name))
    }

    /// Expects the closing parenthesis of the one at `open`; returns the byte after it.
    fn close(&mut self, open: &Range<usize>) -> Result<usize, Fault> {
        match self.peek().kind {
            TokenKind::Sign(')') => Ok(self.next().span.end),
            TokenKind::End => Err(self.fault(open, "this parenthesis is not closed", "add a )")),
            _ => Err(self.stray()),
        }
    }

    /// The fault that the next token is not allowed here.
    fn stray(&self) -> Fault {
        let span = &self.peek().span;
        let piece = shown(self.piece(span));
        match self.peek().kind {
            TokenKind::Sign(')') => self.fault(
                span,
                "this parenthesis was not opened",
                "delete it or add a (",
            ),
            TokenKind::Sign(',') => {
                let what = "a comma is allowed only between the arguments of a function";
                self.fault(span, what, "a decimal number is written 0.5")
            }
            TokenKind::Unit => {
                let what = format!("the unit {piece} does not follow a number");
                self.fault(
                    span,
                    what,
                    "only numbers take a unit; signals and parameters have their own",
                )
            }
            _ => {
                let what = format!("an operator is missing before {piece}");
                self.fault(span, what, "a product is written a * b")
            }
        }
    }
}

/// A binary operator with its precedence and that of its right operand.
fn infix(sign: char) -> Option<(Binary, u8, u8)> {
    Some(match sign {
        '+' => (Binary::Add, 1, 2),
        '-' => (Binary::Subtract, 1, 2),
        '*' => (Binary::Multiply, 3, 4),
        '/' => (Binary::Divide, 3, 4),
        '^' => (Binary::Power, 7, 7),
        _ => return None,
    })
}

fn many(arguments: usize) -> String {
    format!(
        "{arguments} argument{}",
        if arguments == 1 { "" } else { "s" }
    )
}

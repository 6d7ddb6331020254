//! Numbers, functions and arithmetic.

use super::Parser;
use crate::ast::{ArithmeticOp, AssignOp, Comparison, Decimal, FunctionTerm, NumericExpr};
use crate::codes;
use crate::diagnostic::Diagnostic;
use crate::sexpr::{Sexpr, Word};

pub(super) fn comparison(word: Word<'_>) -> Option<Comparison> {
    Some(match word.text {
        "<" => Comparison::Less,
        "<=" => Comparison::LessEqual,
        "=" => Comparison::Equal,
        ">=" => Comparison::GreaterEqual,
        ">" => Comparison::Greater,
        _ => return None,
    })
}

pub(super) fn assign_op(word: Word<'_>) -> Option<AssignOp> {
    const OPS: [(&str, AssignOp); 5] = [
        ("assign", AssignOp::Assign),
        ("increase", AssignOp::Increase),
        ("decrease", AssignOp::Decrease),
        ("scale-up", AssignOp::ScaleUp),
        ("scale-down", AssignOp::ScaleDown),
    ];
    OPS.iter().find(|(name, _)| word.is(name)).map(|(_, op)| *op)
}

fn arithmetic(word: Word<'_>) -> Option<ArithmeticOp> {
    Some(match word.text {
        "+" => ArithmeticOp::Add,
        "-" => ArithmeticOp::Subtract,
        "*" => ArithmeticOp::Multiply,
        "/" => ArithmeticOp::Divide,
        _ => return None,
    })
}

impl Parser {
    pub(super) fn decimal(&mut self, word: Word<'_>) -> Option<Decimal> {
        let finite = word.is_number() && word.text.parse::<f64>().is_ok_and(f64::is_finite);
        if !finite {
            let found =
                Diagnostic::error(codes::BAD_NUMBER, word.span, format!("`{}` is not a number", word.text));
            self.report.push(found.help("a finite number such as `3`, `0.5` or `-2`"));
            return None;
        }
        Some(Decimal(word.text.to_owned()))
    }

    pub(super) fn numeric(&mut self, sexpr: &Sexpr<'_>) -> Option<NumericExpr> {
        match sexpr {
            Sexpr::Word(word) if word.is_number() => self.decimal(*word).map(NumericExpr::Number),
            Sexpr::Word(word) if word.is_variable() || word.text == "#t" => {
                let what = format!("`{}` as a number", word.text);
                self.unsupported(word.span, &what, "use a number or a function, such as `(fuel ?truck)`");
                None
            }
            Sexpr::Word(_) => self.function_term(sexpr).map(NumericExpr::Function),
            Sexpr::List(list) => match list.head().and_then(arithmetic) {
                None => self.function_term(sexpr).map(NumericExpr::Function),
                Some(op) => {
                    let least = if op == ArithmeticOp::Subtract { 1 } else { 2 };
                    if list.rest().len() < least {
                        self.expected(list.place(), "two operands", "`(+ a b)`");
                        return None;
                    }
                    let operands: Vec<_> = list.rest().iter().map(|item| self.numeric(item)).collect();
                    let operands = operands.into_iter().collect::<Option<Vec<_>>>()?;
                    Some(NumericExpr::Operation(op, operands))
                }
            },
        }
    }

    /// `(f ?x)`, or `f` alone.
    pub(super) fn function_term(&mut self, sexpr: &Sexpr<'_>) -> Option<FunctionTerm> {
        let what = "a number or a function";
        match sexpr {
            Sexpr::Word(_) => Some(FunctionTerm { function: self.name(sexpr, what)?, args: Vec::new() }),
            Sexpr::List(list) => {
                let Some(head) = list.items.first() else {
                    self.expected(list.place(), what, "`3` or `(fuel ?truck)`");
                    return None;
                };
                let function = self.name(head, what)?;
                Some(FunctionTerm { function, args: self.terms(list.rest())? })
            }
        }
    }
}

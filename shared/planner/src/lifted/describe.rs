//! Conditions as text, for the reasons given to people.

use lamma_pddl::Name;
use lamma_pddl::ast::ArithmeticOp;

use super::{Expr, Formula, LiftedAtom, LiftedComparison, Symbols, Term};
use crate::numeric::Relation;

/// PDDL text of a formula; `names` are the names of the variable slots.
pub(crate) fn formula(of: &Formula, symbols: &Symbols, names: &[Name]) -> String {
    let list = |parts: &[Formula]| {
        parts.iter().map(|p| format!(" {}", formula(p, symbols, names))).collect::<String>()
    };
    let variables = |slots: &[u32]| {
        slots.iter().map(|&slot| format!("?{}", names[slot as usize])).collect::<Vec<_>>().join(" ")
    };
    match of {
        Formula::Literal { atom: of, positive } => negate(atom(of, symbols, names), *positive),
        Formula::Equal { left, right, positive } => {
            let text = format!("(= {} {})", term(*left, symbols, names), term(*right, symbols, names));
            negate(text, *positive)
        }
        Formula::Compare(LiftedComparison { relation, left, right }) => {
            compared(*relation, &expression(left, symbols, names), &expression(right, symbols, names))
        }
        Formula::And(parts) => format!("(and{})", list(parts)),
        Formula::Or(parts) => format!("(or{})", list(parts)),
        Formula::Exists(slots, inner) => {
            format!("(exists ({}) {})", variables(slots), formula(inner, symbols, names))
        }
        Formula::Forall(slots, inner) => {
            format!("(forall ({}) {})", variables(slots), formula(inner, symbols, names))
        }
    }
}

fn negate(text: String, positive: bool) -> String {
    if positive { text } else { format!("(not {text})") }
}

fn term(of: Term, symbols: &Symbols, names: &[Name]) -> String {
    match of {
        Term::Variable(slot) => format!("?{}", names[slot as usize]),
        Term::Object(object) => symbols.objects[object as usize].to_string(),
    }
}

fn atom(of: &LiftedAtom, symbols: &Symbols, names: &[Name]) -> String {
    named(&symbols.predicates[of.predicate as usize].name, of, symbols, names)
}

fn named(name: &Name, of: &LiftedAtom, symbols: &Symbols, names: &[Name]) -> String {
    let args: String = of.args.iter().map(|&arg| format!(" {}", term(arg, symbols, names))).collect();
    format!("({name}{args})")
}

fn expression(of: &Expr, symbols: &Symbols, names: &[Name]) -> String {
    match of {
        Expr::Number(value) => value.to_string(),
        Expr::Value(of) => named(&symbols.functions[of.predicate as usize].name, of, symbols, names),
        Expr::Operation(op, parts) => {
            let parts: String = parts.iter().map(|p| format!(" {}", expression(p, symbols, names))).collect();
            format!("({}{parts})", sign(*op))
        }
    }
}

/// The sign of an operation.
pub(crate) fn sign(op: ArithmeticOp) -> char {
    match op {
        ArithmeticOp::Add => '+',
        ArithmeticOp::Subtract => '-',
        ArithmeticOp::Multiply => '*',
        ArithmeticOp::Divide => '/',
    }
}

/// PDDL text of a comparison of two texts.
pub(crate) fn compared(relation: Relation, left: &str, right: &str) -> String {
    match relation {
        Relation::AtLeast => format!("(>= {left} {right})"),
        Relation::Above => format!("(> {left} {right})"),
        Relation::Differs => format!("(not (= {left} {right}))"),
    }
}

//! Conditions as text, for the reasons given to people.

use lamma_pddl::Name;
use lamma_pddl::ast::{ArithmeticOp, Comparison};

use super::{Expr, Formula, LiftedAtom, Symbols, Term};

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
        Formula::Compare { comparison, left, right, positive } => {
            let (left, right) = (expression(left, symbols, names), expression(right, symbols, names));
            negate(format!("({} {left} {right})", sign(*comparison)), *positive)
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
            let op = match op {
                ArithmeticOp::Add => '+',
                ArithmeticOp::Subtract => '-',
                ArithmeticOp::Multiply => '*',
                ArithmeticOp::Divide => '/',
            };
            let parts: String = parts.iter().map(|p| format!(" {}", expression(p, symbols, names))).collect();
            format!("({op}{parts})")
        }
    }
}

fn sign(comparison: Comparison) -> &'static str {
    match comparison {
        Comparison::Less => "<",
        Comparison::LessEqual => "<=",
        Comparison::Equal => "=",
        Comparison::GreaterEqual => ">=",
        Comparison::Greater => ">",
    }
}

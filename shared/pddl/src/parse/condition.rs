//! Conditions and facts.

use super::Parser;
use super::numeric::comparison;
use super::typed::Declares;
use crate::ast::{Atom, Comparison, Condition, GroundAtom, Term, TypedName};
use crate::sexpr::{List, Sexpr, Word};

/// PDDL 3's words for preferences and trajectories. They are words of the language only where a list follows,
/// so that a predicate may be called `within`.
const TRAJECTORY: &[&str] = &[
    "preference",
    "always",
    "sometime",
    "within",
    "at-most-once",
    "sometime-after",
    "sometime-before",
    "always-within",
    "hold-during",
    "hold-after",
];

/// Words of effects, and what to write in a condition instead. Like the above, before a list only.
const EFFECTS: &[(&str, &str)] = &[
    ("when", "`(imply A B)` is the condition \"B if A\""),
    ("increase", "compare numbers: `(>= (fuel ?t) 1)`"),
    ("decrease", "compare numbers: `(>= (fuel ?t) 1)`"),
    ("assign", "compare numbers: `(= (fuel ?t) 1)`"),
];

impl Parser {
    pub(super) fn condition(&mut self, sexpr: &Sexpr<'_>) -> Option<Condition> {
        let Some(list) = sexpr.as_list() else {
            let help = match sexpr.as_word().is_some_and(|word| word.is_keyword()) {
                true => "a `)` is missing before it",
                false => "conditions stand in parentheses: `(open ?x)`",
            };
            self.expected(sexpr.place(), "a condition", help);
            return None;
        };
        if list.items.is_empty() {
            return Some(Condition::TRUE);
        }
        let Some(head) = list.head() else {
            let help = "`(and (a) (b))` joins conditions; `((a) (b))` means nothing";
            self.expected(list.place(), "`and`, `or`, `not`, ... or a predicate", help);
            return None;
        };
        match head.text.to_ascii_lowercase().as_str() {
            "and" => self.conditions(list.rest()).map(Condition::And),
            "or" => self.conditions(list.rest()).map(Condition::Or),
            "not" => {
                let [inner] = self.operands(list, "one condition", "`(not (open ?x))`")?;
                Some(Condition::Not(Box::new(self.condition(inner)?)))
            }
            "imply" => {
                let [if_, then] = self.operands(list, "two conditions", "`(imply (hot ?x) (closed ?x))`")?;
                let (if_, then) = (self.condition(if_), self.condition(then));
                Some(Condition::Imply(Box::new(if_?), Box::new(then?)))
            }
            "exists" => self.quantified(list).map(|(params, body)| Condition::Exists(params, body)),
            "forall" => self.quantified(list).map(|(params, body)| Condition::Forall(params, body)),
            _ => self.simple_condition(head, list),
        }
    }

    fn simple_condition(&mut self, head: Word<'_>, list: &List<'_>) -> Option<Condition> {
        if let Some(op) = comparison(head) {
            return self.comparison(op, list);
        }
        let has_list = list.rest().iter().any(|item| item.as_list().is_some());
        if has_list && TRAJECTORY.iter().any(|word| head.is(word)) {
            let what = format!("`{}` (PDDL 3)", head.text);
            self.unsupported(head.span, &what, "state what shall hold at the end in `:goal`");
            return None;
        }
        if has_list && let Some((word, help)) = EFFECTS.iter().find(|(word, _)| head.is(word)) {
            self.expected(head.span, &format!("a condition, not the effect `{word}`"), help);
            return None;
        }
        self.atom(list).map(Condition::Atom)
    }

    /// Objects are compared by `=`, numbers by all; a list or a literal number tells which.
    fn comparison(&mut self, op: Comparison, list: &List<'_>) -> Option<Condition> {
        let [left, right] = self.operands(list, "two operands", "`(= ?a ?b)` or `(>= (fuel ?t) 1)`")?;
        let is_object = |sexpr: &Sexpr<'_>| sexpr.as_word().is_some_and(|word| !word.is_number());
        if op == Comparison::Equal && is_object(left) && is_object(right) {
            let (left, right) = (self.term(left), self.term(right));
            return Some(Condition::Equal(left?, right?));
        }
        let (left, right) = (self.numeric(left), self.numeric(right));
        Some(Condition::Compare(op, left?, right?))
    }

    fn conditions(&mut self, items: &[Sexpr<'_>]) -> Option<Vec<Condition>> {
        let read: Vec<_> = items.iter().map(|item| self.condition(item)).collect();
        read.into_iter().collect()
    }

    fn quantified(&mut self, list: &List<'_>) -> Option<(Vec<TypedName>, Box<Condition>)> {
        let (params, body) = self.quantifier(list)?;
        Some((params, Box::new(self.condition(body)?)))
    }

    /// The variables and the body of `(forall (?x - t) …)`.
    pub(super) fn quantifier<'t, 's>(
        &mut self,
        list: &'t List<'s>,
    ) -> Option<(Vec<TypedName>, &'t Sexpr<'s>)> {
        let form = "`(forall (?x - type) ...)`, with one formula after the variables";
        let [params, body] = self.operands(list, "variables and one formula", form)?;
        let Some(params) = params.as_list() else {
            self.expected(params.place(), "variables in parentheses", form);
            return None;
        };
        Some((self.typed_list(&params.items, Declares::Variables), body))
    }

    /// Exactly `N` items after the first.
    pub(super) fn operands<'t, 's, const N: usize>(
        &mut self,
        list: &'t List<'s>,
        what: &str,
        help: &str,
    ) -> Option<&'t [Sexpr<'s>; N]> {
        let operands = <&[Sexpr<'s>; N]>::try_from(list.rest()).ok();
        if operands.is_none() {
            let place = list.rest().get(N).map_or(list.place(), Sexpr::place);
            self.expected(place, &format!("{what} here, not {}", list.rest().len()), help);
        }
        operands
    }

    pub(super) fn atom(&mut self, list: &List<'_>) -> Option<Atom> {
        let Some(head) = list.items.first() else {
            self.expected(list.place(), "a predicate", "`(predicate argument ...)`");
            return None;
        };
        let predicate = self.name(head, "a predicate")?;
        Some(Atom { predicate, args: self.terms(list.rest())? })
    }

    pub(super) fn ground_atom(&mut self, sexpr: &Sexpr<'_>) -> Option<GroundAtom> {
        let Some(list) = sexpr.as_list() else {
            self.expected(sexpr.place(), "a fact", "facts stand in parentheses: `(at robot1 Fridge_1)`");
            return None;
        };
        let atom = self.atom(list)?;
        let args: Vec<_> = atom.args.into_iter().map(|term| self.constant(term)).collect();
        Some(GroundAtom { predicate: atom.predicate, args: args.into_iter().collect::<Option<_>>()? })
    }

    pub(super) fn constant(&mut self, term: Term) -> Option<crate::Name> {
        match term {
            Term::Constant(name) => Some(name),
            Term::Variable(name) => {
                self.expected(name.span(), "an object", "a fact is about objects, not variables");
                None
            }
        }
    }
}

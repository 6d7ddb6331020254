//! Effects.

use super::Parser;
use super::numeric::assign_op;
use crate::ast::Effect;
use crate::sexpr::{List, Sexpr, Word};

impl Parser {
    pub(super) fn effect(&mut self, sexpr: &Sexpr<'_>) -> Option<Effect> {
        let Some(list) = sexpr.as_list() else {
            self.expected(sexpr.place(), "an effect", "effects stand in parentheses: `(open ?x)`");
            return None;
        };
        if list.items.is_empty() {
            return Some(Effect::And(Vec::new()));
        }
        let Some(head) = list.head() else {
            let help = "`(and (a) (b))` joins effects; `((a) (b))` means nothing";
            self.expected(list.place(), "`and`, `not`, `when`, ... or a predicate", help);
            return None;
        };
        match head.text.to_ascii_lowercase().as_str() {
            "and" => {
                let read: Vec<_> = list.rest().iter().map(|item| self.effect(item)).collect();
                Some(Effect::And(read.into_iter().collect::<Option<_>>()?))
            }
            "forall" => {
                let (params, body) = self.quantifier(list)?;
                Some(Effect::Forall(params, Box::new(self.effect(body)?)))
            }
            "when" => {
                let help = "`(when (condition) (effect))`";
                let [condition, effect] = self.operands(list, "a condition and an effect", help)?;
                let (condition, effect) = (self.condition(condition), self.effect(effect));
                Some(Effect::When(condition?, Box::new(effect?)))
            }
            "not" => self.delete(list),
            _ => self.simple_effect(head, list),
        }
    }

    fn delete(&mut self, list: &List<'_>) -> Option<Effect> {
        let help = "an effect can only take back a fact: `(not (open ?x))`";
        let [inner] = self.operands(list, "one fact", help)?;
        let words = ["and", "or", "not", "forall", "exists", "when", "imply"];
        match inner.as_list() {
            Some(atom) if !words.iter().any(|word| atom.head_is(word)) => self.atom(atom).map(Effect::Delete),
            _ => {
                self.expected(inner.place(), "a fact after `not`", help);
                None
            }
        }
    }

    fn simple_effect(&mut self, head: Word<'_>, list: &List<'_>) -> Option<Effect> {
        let has_list = list.rest().iter().any(|item| item.as_list().is_some());
        if let Some(op) = assign_op(head)
            && (has_list || list.rest().last().and_then(Sexpr::as_word).is_some_and(|word| word.is_number()))
        {
            let [function, value] =
                self.operands(list, "a function and a number", "`(increase (fuel ?t) 1)`")?;
            let (function, value) = (self.function_term(function), self.numeric(value));
            return Some(Effect::Assign(op, function?, value?));
        }
        if has_list && (head.is("probabilistic") || head.is("oneof")) {
            let help = "every action has one outcome; model the choice as two actions";
            self.unsupported(head.span, &format!("`{}`", head.text), help);
            return None;
        }
        if head.is("or") || head.is("exists") || head.is("imply") {
            let help = "an effect says exactly what becomes true and what becomes false";
            self.expected(head.span, &format!("an effect, not `{}`", head.text), help);
            return None;
        }
        self.atom(list).map(Effect::Add)
    }
}

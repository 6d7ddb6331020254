//! Durative actions (PDDL 2.1; Fox & Long 2003), flattened to one step that has a duration.
//!
//! Sound for sequential plans: what an action achieves at its start counts for its later conditions, and where
//! it takes back at its end what it achieved at its start, the end decides.

use std::collections::BTreeSet;

use super::Parser;
use crate::ast::{Action, Atom, Condition, Effect, NumericExpr};
use crate::codes;
use crate::diagnostic::Diagnostic;
use crate::sexpr::{List, Sexpr};

#[derive(Clone, Copy, PartialEq, Eq)]
enum Time {
    Start,
    OverAll,
    End,
}

/// Conditions or effects with their times, in the order they were written.
type Timed<T> = Vec<(Time, T)>;

impl Parser {
    pub(super) fn durative_action(&mut self, list: &List<'_>) -> Option<Action> {
        let known = &[":agent", ":parameters", ":duration", ":condition", ":effect"];
        let fields = self.fields(list, known)?;
        let duration = match fields.get(":duration") {
            Some(duration) => self.duration(duration),
            None => {
                self.expected(list.place(), "a `:duration`", "`:duration (= ?duration 5)`");
                None
            }
        };
        let mut conditions = Vec::new();
        let conditions_read =
            fields.get(":condition").is_none_or(|c| self.timed_condition(c, &mut conditions));
        let mut effects = Vec::new();
        let effects_read = fields.get(":effect").is_none_or(|e| self.timed_effect(e, &mut effects));
        let (precondition, effect) = flatten(conditions, effects);
        (conditions_read && effects_read).then_some(())?;
        Some(Action {
            name: fields.name,
            agent: fields.agent,
            params: fields.params,
            precondition,
            effect,
            duration: Some(duration?),
        })
    }

    /// `(= ?duration e)`, or the lower bound of a range.
    fn duration(&mut self, sexpr: &Sexpr<'_>) -> Option<NumericExpr> {
        let help = "`:duration (= ?duration 5)`";
        let Some(list) = sexpr.as_list().filter(|list| !list.items.is_empty()) else {
            self.expected(sexpr.place(), "a duration", help);
            return None;
        };
        if list.head_is("and") {
            let bounds: Vec<&Sexpr<'_>> = list.rest().iter().collect();
            let lower =
                bounds.iter().find(|b| b.as_list().is_some_and(|b| b.head_is(">=") || b.head_is("=")));
            return match lower.or(bounds.first()) {
                Some(bound) => self.duration(bound),
                None => {
                    self.expected(list.place(), "a duration", help);
                    None
                }
            };
        }
        if list.head_is("at") && list.items.len() == 3 {
            return self.duration(&list.items[2]);
        }
        let [variable, value] = self.operands(list, "`?duration` and a number", help)?;
        let is_bound = ["=", ">=", "<="].iter().any(|op| list.head_is(op));
        if !is_bound || !variable.as_word().is_some_and(|word| word.is("?duration")) {
            self.expected(list.place(), "a duration", help);
            return None;
        }
        if !list.head_is("=") {
            let found = Diagnostic::warning(codes::DURATION_RANGE, list.place(), "the duration is a range");
            self.report.push(found.label("this bound is used").help(help));
        }
        self.numeric(value)
    }

    /// The time and the body of `(at start …)`, `(at end …)`, `(over all …)`.
    fn timed<'t, 's>(&mut self, list: &'t List<'s>) -> Option<(Time, &'t Sexpr<'s>)> {
        if let [Sexpr::Word(first), Sexpr::Word(second), body] = list.items.as_slice() {
            let times =
                [("at", "start", Time::Start), ("at", "end", Time::End), ("over", "all", Time::OverAll)];
            if let Some((.., time)) = times.iter().find(|(a, b, _)| first.is(a) && second.is(b)) {
                return Some((*time, body));
            }
        }
        let help = "in durative actions every condition and effect has its time: `(at start (idle ?r))`";
        self.expected(list.place(), "`(at start ...)`, `(over all ...)` or `(at end ...)`", help);
        None
    }

    /// Whether all of it could be read.
    fn timed_condition(&mut self, sexpr: &Sexpr<'_>, into: &mut Timed<Condition>) -> bool {
        let Some(list) = sexpr.as_list() else {
            self.expected(sexpr.place(), "a condition", "`(at start (idle ?r))`");
            return false;
        };
        if list.items.is_empty() {
            return true;
        }
        if list.head_is("and") {
            let unread = list.rest().iter().filter(|item| !self.timed_condition(item, into));
            return unread.count() == 0;
        }
        if list.head_is("forall") {
            let Some((params, body)) = self.quantifier(list) else { return false };
            let mut inner = Vec::new();
            let read = self.timed_condition(body, &mut inner);
            let wrap = |(time, c)| (time, Condition::Forall(params.clone(), Box::new(c)));
            into.extend(inner.into_iter().map(wrap));
            return read;
        }
        if list.head_is("preference") {
            self.unsupported(list.place(), "`preference` (PDDL 3)", "make it a condition, or leave it out");
            return false;
        }
        let condition = self.timed(list).and_then(|(time, body)| Some((time, self.condition(body)?)));
        let read = condition.is_some();
        into.extend(condition);
        read
    }

    /// Whether all of it could be read.
    fn timed_effect(&mut self, sexpr: &Sexpr<'_>, into: &mut Timed<Effect>) -> bool {
        let Some(list) = sexpr.as_list() else {
            self.expected(sexpr.place(), "an effect", "`(at end (idle ?r))`");
            return false;
        };
        if list.items.is_empty() {
            return true;
        }
        if list.head_is("and") {
            let unread = list.rest().iter().filter(|item| !self.timed_effect(item, into));
            return unread.count() == 0;
        }
        if list.head_is("forall") {
            let Some((params, body)) = self.quantifier(list) else { return false };
            return self.timed_inside(body, into, |e| Effect::Forall(params.clone(), Box::new(e)));
        }
        if list.head_is("when") {
            let help = "`(when (at start (condition)) (at end (effect)))`";
            let Some([condition, body]) = self.operands(list, "a condition and an effect", help) else {
                return false;
            };
            let mut conditions = Vec::new();
            let read = self.timed_condition(condition, &mut conditions);
            let condition = join(conditions.into_iter().map(|(_, c)| c).collect(), Condition::And);
            return self.timed_inside(body, into, |e| Effect::When(condition.clone(), Box::new(e))) && read;
        }
        let is_assignment = list.head().is_some_and(|head| super::numeric::assign_op(head).is_some());
        if is_assignment {
            self.unsupported(list.place(), "a continuous effect", "say `(at end (increase ...))`");
            return false;
        }
        let effect = self.timed(list).and_then(|(time, body)| Some((time, self.effect(body)?)));
        let read = effect.is_some();
        into.extend(effect);
        read
    }

    fn timed_inside(
        &mut self,
        body: &Sexpr<'_>,
        into: &mut Timed<Effect>,
        wrap: impl Fn(Effect) -> Effect,
    ) -> bool {
        let mut inner = Vec::new();
        let read = self.timed_effect(body, &mut inner);
        into.extend(inner.into_iter().map(|(time, effect)| (time, wrap(effect))));
        read
    }
}

fn flatten(conditions: Timed<Condition>, effects: Timed<Effect>) -> (Condition, Effect) {
    let achieved = atoms(&effects, Time::Start, true);
    let taken_back = atoms(&effects, Time::End, false);
    let (first, later): (Timed<Condition>, Timed<Condition>) =
        conditions.into_iter().partition(|(time, _)| *time == Time::Start);
    let later = later.into_iter().filter_map(|(_, condition)| still_needed(condition, &achieved));
    let precondition = first.into_iter().map(|(_, condition)| condition).chain(later).collect();
    let (start, end): (Timed<Effect>, Timed<Effect>) =
        effects.into_iter().partition(|(time, _)| *time == Time::Start);
    let start = start.into_iter().filter_map(|(_, effect)| lasting(effect, &taken_back));
    let effect = start.chain(end.into_iter().map(|(_, effect)| effect)).collect();
    (join(precondition, Condition::And), join(effect, Effect::And))
}

/// The condition without the atoms that the action has achieved itself.
fn still_needed(condition: Condition, achieved: &BTreeSet<Atom>) -> Option<Condition> {
    match condition {
        Condition::And(parts) => {
            Some(Condition::And(parts.into_iter().filter_map(|part| still_needed(part, achieved)).collect()))
        }
        Condition::Atom(atom) if achieved.contains(&atom) => None,
        other => Some(other),
    }
}

/// The effect without the atoms that the action takes back itself.
fn lasting(effect: Effect, taken_back: &BTreeSet<Atom>) -> Option<Effect> {
    match effect {
        Effect::And(parts) => {
            Some(Effect::And(parts.into_iter().filter_map(|part| lasting(part, taken_back)).collect()))
        }
        Effect::Add(atom) if taken_back.contains(&atom) => None,
        other => Some(other),
    }
}

/// The one, or all of them joined.
fn join<T>(mut parts: Vec<T>, and: impl Fn(Vec<T>) -> T) -> T {
    match parts.pop() {
        Some(only) if parts.is_empty() => only,
        last => {
            parts.extend(last);
            and(parts)
        }
    }
}

/// What is added (or deleted) at that time in any case.
fn atoms(effects: &Timed<Effect>, time: Time, added: bool) -> BTreeSet<Atom> {
    fn collect(effect: &Effect, added: bool, into: &mut BTreeSet<Atom>) {
        match effect {
            Effect::And(effects) => effects.iter().for_each(|effect| collect(effect, added, into)),
            Effect::Add(atom) if added => {
                into.insert(atom.clone());
            }
            Effect::Delete(atom) if !added => {
                into.insert(atom.clone());
            }
            _ => {}
        }
    }
    let mut found = BTreeSet::new();
    effects.iter().filter(|(t, _)| *t == time).for_each(|(_, effect)| collect(effect, added, &mut found));
    found
}

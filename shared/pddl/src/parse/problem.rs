//! Problem files.

use std::collections::HashMap;

use super::Parser;
use super::typed::Declares;
use crate::ast::{Condition, GroundAtom, Init, Metric, Problem};
use crate::codes;
use crate::diagnostic::Diagnostic;
use crate::name::{Name, Span};
use crate::sexpr::{List, Sexpr};

const SECTIONS: &[&str] = &[":domain", ":objects", ":init", ":goal", ":metric", ":requirements", ":length"];

impl Parser {
    pub(super) fn problem_file(&mut self, top: &[Sexpr<'_>]) -> Option<Problem> {
        let (name, sections) = self.define(top, "problem", "domain")?;
        let mut problem = Problem {
            name,
            domain: Name::new(""),
            objects: Vec::new(),
            init: Vec::new(),
            goal: Condition::TRUE,
            metric: None,
        };
        let mut goals = Vec::new();
        let mut seen = HashMap::new();
        for sexpr in sections {
            let Some((head, list)) = self.section(sexpr) else { continue };
            let keyword = head.text.to_ascii_lowercase();
            if let Some(section) = SECTIONS.iter().find(|section| **section == keyword) {
                self.once(&mut seen, section, list);
            }
            match keyword.as_str() {
                ":domain" => {
                    if let Some([name]) = self.operands(list, "the name of the domain", "`(:domain NAME)`") {
                        problem.domain = self.name(name, "the name of the domain").unwrap_or(problem.domain);
                    }
                }
                ":objects" => problem.objects.extend(self.typed_list(list.rest(), Declares::Objects)),
                ":init" => list.rest().iter().for_each(|item| problem.init.extend(self.init(item))),
                ":goal" => {
                    if let Some([goal]) = self.operands(list, "one condition", "`(:goal (and (a) (b)))`") {
                        goals.extend(self.condition(goal));
                    }
                }
                ":metric" => problem.metric = self.metric(list),
                ":requirements" => drop(self.requirements(list)),
                ":length" => {}
                _ => self.unknown_section(head, SECTIONS),
            }
        }
        self.missing_sections(&problem, &seen);
        problem.goal = match goals.pop() {
            Some(goal) if goals.is_empty() => goal,
            last => Condition::And(goals.into_iter().chain(last).collect()),
        };
        Some(problem)
    }

    fn missing_sections(&mut self, problem: &Problem, seen: &HashMap<&'static str, Span>) {
        let place = problem.name.span();
        if !seen.contains_key(":goal") {
            let found = Diagnostic::error(codes::MISSING_SECTION, place, "the problem has no `(:goal ...)`");
            self.report.push(found.help("say what shall hold at the end: `(:goal (and (open Fridge_1)))`"));
        }
        if !seen.contains_key(":domain") {
            let found =
                Diagnostic::error(codes::MISSING_SECTION, place, "the problem has no `(:domain NAME)`");
            self.report.push(found.help("name the domain directly behind `(problem NAME)`"));
        }
        if !seen.contains_key(":init") {
            let found =
                Diagnostic::warning(codes::MISSING_SECTION, place, "the problem has no `(:init ...)`");
            self.report.push(found.label("everything is false at the start"));
        }
    }

    /// A fact or a number of the initial state.
    fn init(&mut self, sexpr: &Sexpr<'_>) -> Option<Init> {
        let Some(list) = sexpr.as_list() else {
            self.expected(sexpr.place(), "a fact", "`(at robot1 Fridge_1)` or `(= (fuel truck1) 10)`");
            return None;
        };
        if list.head_is("=") {
            return self.initial_value(list);
        }
        if list.head_is("not") {
            let found =
                Diagnostic::warning(codes::NEGATIVE_INIT, list.place(), "`not` in `:init` says nothing");
            self.report.push(found.help("leave it out: what is not named is false"));
            return None;
        }
        let is_timed = list.head_is("at")
            && list.items.get(1).and_then(Sexpr::as_word).is_some_and(|word| word.is_number())
            && list.items.get(2).is_some_and(|item| item.as_list().is_some());
        if is_timed {
            let help = "only actions change the world; leave the fact out or make it initial";
            self.unsupported(list.place(), "a timed initial literal", help);
            return None;
        }
        if let Some(word) = ["and", "or", "oneof", "unknown", "forall"]
            .iter()
            .find(|word| list.head_is(word) && list.rest().iter().any(|item| item.as_list().is_some()))
        {
            let help = "`:init` is a plain list of facts: `(:init (a) (b))`";
            self.expected(list.place(), &format!("a fact, not `{word}`"), help);
            return None;
        }
        self.ground_atom(sexpr).map(Init::Fact)
    }

    fn initial_value(&mut self, list: &List<'_>) -> Option<Init> {
        let [function, value] = self.operands(list, "a function and a number", "`(= (fuel truck1) 10)`")?;
        let function = self.function_term(function)?;
        let Some(word) = value.as_word() else {
            self.expected(value.place(), "a number", "initial values are numbers: `(= (fuel truck1) 10)`");
            return None;
        };
        let value = self.decimal(word)?;
        let args: Vec<_> = function.args.into_iter().map(|term| self.constant(term)).collect();
        let args = args.into_iter().collect::<Option<_>>()?;
        Some(Init::Value(GroundAtom { predicate: function.function, args }, value))
    }

    fn metric(&mut self, list: &List<'_>) -> Option<Metric> {
        let help = "`(:metric minimize (total-cost))`";
        let [direction, expression] = self.operands(list, "`minimize` or `maximize` and a number", help)?;
        let minimize = match direction.as_word() {
            Some(word) if word.is("minimize") => true,
            Some(word) if word.is("maximize") => false,
            _ => {
                self.expected(direction.place(), "`minimize` or `maximize`", help);
                return None;
            }
        };
        Some(Metric { minimize, expression: self.numeric(expression)? })
    }
}

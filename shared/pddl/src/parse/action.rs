//! Actions.

use super::Parser;
use super::typed::Declares;
use crate::ast::{Action, Condition, Effect, TypedName};
use crate::codes;
use crate::diagnostic::Diagnostic;
use crate::name::Name;
use crate::sexpr::{List, Sexpr};
use crate::suggest::did_you_mean;

/// The keyword-value pairs of an action, not read yet.
pub(super) struct Fields<'t, 's> {
    pub name: Name,
    pub agent: Option<TypedName>,
    pub params: Vec<TypedName>,
    values: Vec<(&'static str, &'t Sexpr<'s>)>,
}

impl<'t, 's> Fields<'t, 's> {
    pub fn get(&self, keyword: &str) -> Option<&'t Sexpr<'s>> {
        self.values.iter().find(|(known, _)| *known == keyword).map(|(_, value)| *value)
    }
}

impl Parser {
    pub(super) fn action(&mut self, list: &List<'_>) -> Option<Action> {
        let known = &[":agent", ":parameters", ":precondition", ":effect"];
        let fields = self.fields(list, known)?;
        let precondition = fields.get(":precondition").map_or(Some(Condition::TRUE), |c| self.condition(c));
        let effect = fields.get(":effect").map_or(Some(Effect::And(Vec::new())), |e| self.effect(e));
        Some(Action {
            name: fields.name,
            agent: fields.agent,
            params: fields.params,
            precondition: precondition?,
            effect: effect?,
            duration: None,
        })
    }

    /// The name and the keyword-value pairs. `:agent` is followed by a typed variable without parentheses.
    pub(super) fn fields<'t, 's>(
        &mut self,
        list: &'t List<'s>,
        known: &[&'static str],
    ) -> Option<Fields<'t, 's>> {
        let Some(name) = list.items.get(1) else {
            self.expected(
                list.place(),
                "a name",
                "`(:action NAME :parameters (...) :precondition (...) :effect (...))`",
            );
            return None;
        };
        let name = self.name(name, "the name of the action")?;
        let mut fields = Fields { name, agent: None, params: Vec::new(), values: Vec::new() };
        let mut rest = &list.items[2..];
        while let Some((first, after)) = rest.split_first() {
            let keyword = self.field_keyword(first, known);
            let values =
                after.iter().take_while(|item| !item.as_word().is_some_and(|word| word.is_keyword()));
            let (values, next) = after.split_at(values.count());
            rest = next;
            let Some(keyword) = keyword else { continue };
            if keyword == ":agent" {
                fields.agent = self.agent(first, values);
                continue;
            }
            let [value] = values else {
                let place = values.get(1).map_or(first.place(), Sexpr::place);
                let help = "write `()` for none, and `(and ...)` around several";
                self.expected(place, &format!("one expression after `{keyword}`"), help);
                continue;
            };
            match (keyword, value) {
                (":parameters", Sexpr::List(params)) => {
                    fields.params.extend(self.typed_list(&params.items, Declares::Variables));
                }
                (":parameters", Sexpr::Word(word)) => {
                    self.expected(word.span, "parameters in parentheses", "`:parameters (?x - type)`");
                }
                _ => self.add_field(&mut fields, keyword, first, value),
            }
        }
        if let Some(agent) = &fields.agent
            && !fields.params.iter().any(|param| param.name == agent.name)
        {
            fields.params.insert(0, agent.clone());
        }
        Some(fields)
    }

    fn field_keyword(&mut self, sexpr: &Sexpr<'_>, known: &[&'static str]) -> Option<&'static str> {
        let found = sexpr.as_word().and_then(|word| known.iter().find(|keyword| word.is(keyword)));
        if found.is_none() {
            let names: Vec<Name> = known.iter().map(Name::new).collect();
            let text = sexpr.as_word().map_or("", |word| word.text);
            let help = did_you_mean(text, &names, format!("an action has {}", known.join(" ")));
            let message = match sexpr.as_word().filter(|word| word.is_keyword()) {
                Some(word) => format!("an action has no `{}`", word.text),
                None => format!("expected one of {}", known.join(" ")),
            };
            self.report.push(Diagnostic::error(codes::SYNTAX, sexpr.place(), message).help(help));
        }
        found.copied()
    }

    fn add_field<'t, 's>(
        &mut self,
        fields: &mut Fields<'t, 's>,
        keyword: &'static str,
        at: &Sexpr<'_>,
        value: &'t Sexpr<'s>,
    ) {
        if fields.get(keyword).is_some() {
            let found = Diagnostic::error(codes::DUPLICATE, at.place(), format!("a second `{keyword}`"));
            self.report.push(found.help("join the two with `(and ...)`"));
            return;
        }
        fields.values.push((keyword, value));
    }

    /// `:agent ?a - type`; some files put parentheses around it.
    fn agent(&mut self, keyword: &Sexpr<'_>, values: &[Sexpr<'_>]) -> Option<TypedName> {
        let values = match values {
            [Sexpr::List(list)] => &list.items,
            _ => values,
        };
        let mut variables = self.typed_list(values, Declares::Variables);
        if variables.len() != 1 {
            self.expected(keyword.place(), "one variable after `:agent`", "`:agent ?robot - robot`");
        }
        variables.pop()
    }
}

//! Typed lists, `a b - t c`, and the signatures made of them.

use std::collections::HashSet;

use super::Parser;
use crate::ast::{Private, Signature, TypedName};
use crate::codes;
use crate::diagnostic::Diagnostic;
use crate::name::{Name, Span};
use crate::sexpr::{List, MAX_TOKENS, Sexpr};

/// Variables one list may bind.
const MAX_VARIABLES: usize = 256;

/// What a typed list declares.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Declares {
    /// `?x`
    Variables,
    /// Types, which have supertypes.
    Types,
    /// Objects and constants, which may stand in `(:private …)`.
    Objects,
}

impl Parser {
    /// A typed list. Names that are not followed by a type have none.
    pub(super) fn typed_list(&mut self, items: &[Sexpr<'_>], declares: Declares) -> Vec<TypedName> {
        let objects = if declares == Declares::Objects { certain_objects(items) } else { HashSet::new() };
        let list = self.typed_items(items, declares, &objects);
        if let Some(over) = list.get(MAX_VARIABLES).filter(|_| declares == Declares::Variables) {
            self.error(
                codes::TOO_LARGE,
                over.name.span(),
                format!("more than {MAX_VARIABLES} variables in one list"),
            );
        }
        list
    }

    fn typed_items(
        &mut self,
        items: &[Sexpr<'_>],
        declares: Declares,
        objects: &HashSet<String>,
    ) -> Vec<TypedName> {
        let mut list: Vec<TypedName> = Vec::new();
        let mut untyped_from = 0;
        let mut at = 0;
        while let Some(item) = items.get(at) {
            at += 1;
            match item {
                Sexpr::Word(dash) if dash.text == "-" => {
                    let types = match items.get(at) {
                        Some(types) => self.types(types),
                        None => {
                            self.expected(dash.span, "a type after this", "`a b - type`");
                            None
                        }
                    };
                    at += 1;
                    if untyped_from == list.len() {
                        // Generated files have it where there are no objects of a type.
                        let found =
                            Diagnostic::warning(codes::SYNTAX, dash.span, "a type without a name before it");
                        self.report.push(found.help("remove it, or write `name - type`"));
                    }
                    let types =
                        self.affordable(types.unwrap_or_default(), list.len() - untyped_from, dash.span);
                    list[untyped_from..].iter_mut().for_each(|name| name.types = types.clone());
                    untyped_from = list.len();
                }
                Sexpr::List(private) if declares == Declares::Objects && private.head_is(":private") => {
                    self.private_objects(private, objects, &mut list);
                    untyped_from = list.len();
                }
                _ => {
                    let name = match declares {
                        Declares::Variables => self.variable(item),
                        Declares::Types => self.name(item, "a type"),
                        Declares::Objects => self.object(item),
                    };
                    list.extend(name.map(|name| TypedName { name, types: Vec::new(), private_to: None }));
                }
            }
        }
        list
    }

    /// Each name has its own copy of its types, so that long `either`s behind many names multiply.
    fn affordable(&mut self, types: Vec<Name>, names: usize, span: Span) -> Vec<Name> {
        self.typings = self.typings.saturating_add(types.len().saturating_mul(names));
        if self.typings > MAX_TOKENS {
            self.error(codes::TOO_LARGE, span, "too many names with too many types each");
            return Vec::new();
        }
        types
    }

    fn object(&mut self, item: &Sexpr<'_>) -> Option<Name> {
        let name = self.name(item, "an object")?;
        if name.as_str().starts_with(|c: char| c.is_ascii_digit()) {
            let message = format!("`{name}` begins with a digit");
            let found = Diagnostic::warning(codes::DIGIT_NAME, name.span(), message);
            self.report.push(found.help("begin names with a letter"));
        }
        Some(name)
    }

    /// One type or `(either a b)`.
    fn types(&mut self, sexpr: &Sexpr<'_>) -> Option<Vec<Name>> {
        match sexpr {
            Sexpr::Word(_) => Some(vec![self.name(sexpr, "a type")?]),
            Sexpr::List(list) if list.head_is("either") && list.items.len() > 1 => {
                list.rest().iter().map(|item| self.name(item, "a type")).collect()
            }
            Sexpr::List(list) => {
                self.expected(list.place(), "a type", "a name, or `(either type1 type2)`");
                None
            }
        }
    }

    /// `(:private …)` among objects. Whether its first word names the agent or is itself the first private
    /// object is not marked. But an agent is an object too, so its name also stands where objects do.
    fn private_objects(&mut self, private: &List<'_>, objects: &HashSet<String>, list: &mut Vec<TypedName>) {
        let mut items = private.rest();
        let mut owner = Private::Owner;
        if let [Sexpr::Word(first), second, ..] = items
            && second.as_word().is_some_and(|word| word.text != "-")
            && objects.contains(&first.text.to_ascii_lowercase())
            && let Some(agent) = self.name(&items[0], "an agent")
        {
            owner = Private::Agent(agent);
            items = &items[1..];
        }
        if let Some(nested) =
            items.iter().find(|item| item.as_list().is_some_and(|list| list.head_is(":private")))
        {
            self.expected(nested.place(), "no `(:private` inside another", "write them one after the other");
            return;
        }
        let inside = self.typed_items(items, Declares::Objects, objects);
        list.extend(inside.into_iter().map(|name| TypedName { private_to: Some(owner.clone()), ..name }));
    }

    /// The lists of `:predicates` or `:functions`, those in `(:private …)` included. Behind functions stands
    /// `- number`.
    pub(super) fn signatures(&mut self, items: &[Sexpr<'_>], functions: bool) -> Vec<Signature> {
        let mut signatures = Vec::new();
        let mut at = 0;
        while let Some(item) = items.get(at) {
            at += 1;
            match item {
                Sexpr::Word(dash) if functions && dash.text == "-" => {
                    if !items.get(at).and_then(Sexpr::as_word).is_some_and(|word| word.is("number")) {
                        let help = "declare a predicate instead, with the value as its last parameter";
                        self.unsupported(dash.span, "a function that is not a `number`", help);
                    }
                    at += 1;
                }
                Sexpr::List(list) if list.head_is(":private") => {
                    self.private_signatures(list, functions, &mut signatures)
                }
                Sexpr::List(list) if !list.items.is_empty() => signatures.extend(self.signature(list)),
                _ => {
                    self.expected(item.place(), "a declaration in parentheses", "`(name ?parameter - type)`");
                }
            }
        }
        signatures
    }

    /// `(name ?x - type)`
    pub(super) fn signature(&mut self, list: &List<'_>) -> Option<Signature> {
        let name = self.name(list.items.first()?, "a name")?;
        if name == "=" {
            // Some older files declare equality.
            return None;
        }
        let params = self.typed_list(list.rest(), Declares::Variables);
        Some(Signature { name, params, private_to: None })
    }

    fn private_signatures(&mut self, private: &List<'_>, functions: bool, signatures: &mut Vec<Signature>) {
        let is_type =
            |at: usize| at > 0 && private.rest()[at - 1].as_word().is_some_and(|word| word.text == "-");
        let items = private.rest().iter().enumerate();
        let declared = items.take_while(|(at, item)| item.as_word().is_some() || is_type(*at)).count();
        let (agent, inside) = private.rest().split_at(declared);
        let mut owner = Private::Owner;
        if let Some(agent_name) = agent.first() {
            let is_variable = agent_name.as_word().is_some_and(|word| word.is_variable());
            owner = if is_variable {
                let mut variable = self.typed_list(agent, Declares::Variables);
                variable.truncate(1);
                variable.pop().map_or(Private::Owner, |variable| Private::Variable(Box::new(variable)))
            } else {
                self.name(agent_name, "an agent").map_or(Private::Owner, Private::Agent)
            };
        }
        if let Some(nested) =
            inside.iter().find(|item| item.as_list().is_some_and(|list| list.head_is(":private")))
        {
            self.expected(nested.place(), "no `(:private` inside another", "write them one after the other");
            return;
        }
        let inside = self.signatures(inside, functions);
        if let Private::Variable(variable) = &owner {
            self.affordable(variable.types.clone(), inside.len(), private.place());
        }
        signatures.extend(inside.into_iter().map(|s| Signature { private_to: Some(owner.clone()), ..s }));
    }
}

/// The words, in lower case, that are certainly objects: those outside of `(:private …)`, and inside all but
/// the first, which may name the agent. Nothing if there is no `(:private …)`.
fn certain_objects(items: &[Sexpr<'_>]) -> HashSet<String> {
    let mut objects = HashSet::new();
    let is_private = |item: &Sexpr<'_>| item.as_list().is_some_and(|list| list.head_is(":private"));
    if items.iter().any(is_private) {
        let inside = items.iter().filter_map(Sexpr::as_list).flat_map(|list| {
            let is_object = list.items.get(2).and_then(Sexpr::as_word).is_none_or(|word| word.text == "-");
            list.items.get(if is_object { 1 } else { 2 }..).unwrap_or_default()
        });
        let words = items.iter().chain(inside).filter_map(Sexpr::as_word);
        objects.extend(words.map(|word| word.text.to_ascii_lowercase()));
    }
    objects
}

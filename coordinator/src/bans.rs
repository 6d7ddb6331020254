//! What nobody may do on the way: "without opening the drawer", "do not use the microwave".
//!
//! A ban is held by what planning is told of the world: a thing that may not be opened is planned for as one
//! that cannot be. So it holds for every robot and every way of cutting the work, and no action knows of it.
//! What cannot be reached under the bans is infeasible, like what cannot be reached for want of a skill.

use std::collections::BTreeSet;

use lamma_pddl::ast::GroundAtom;
use lamma_protocol::message::Act;

/// An act that nobody may do to a thing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ban {
    /// `OpenObject`
    pub skill: String,
    /// `Fridge_1`
    pub object: String,
    /// Only with this in hand: `Egg_1` may not be put into `Microwave_1`.
    pub item: Option<String>,
}

impl std::fmt::Display for Ban {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.skill)?;
        self.item.iter().try_for_each(|item| write!(f, " {item}"))?;
        write!(f, " {}", self.object)
    }
}

impl Ban {
    /// Whether an act is the one that is forbidden.
    pub fn forbids(&self, act: &Act) -> bool {
        let is = |arg: &String, name: &str| arg.eq_ignore_ascii_case(name);
        act.action.eq_ignore_ascii_case(&self.skill)
            && match &self.item {
                Some(item) => {
                    act.args.iter().any(|a| is(a, item))
                        && act.args.last().is_some_and(|a| is(a, &self.object))
                }
                None if self.skill == "PutObject" => act.args.last().is_some_and(|a| is(a, &self.object)),
                None => act.args.get(1).is_some_and(|a| is(a, &self.object)),
            }
    }

    /// Whether the forbidden act needs a fact that planning need not know of. `holds` tells what is so now: the
    /// fact that a thing can be opened serves for closing it as well, and one of the two may be wanted.
    fn hides(&self, fact: &GroundAtom, holds: &impl Fn(&str, &str) -> bool) -> bool {
        let about = |position: usize, name: &str| {
            fact.args.get(position).is_some_and(|arg| arg.as_str().eq_ignore_ascii_case(name))
        };
        let needed = match (self.skill.as_str(), fact.predicate.as_str()) {
            ("OpenObject", "can-open") | ("SwitchOn", "can-switch-on") => true,
            ("OpenObject", "openable") => !holds("open", &self.object),
            ("CloseObject", "openable") => holds("open", &self.object),
            ("SwitchOn", "toggleable") => !holds("toggled", &self.object),
            ("SwitchOff", "toggleable") => holds("toggled", &self.object),
            ("SliceObject", "sliceable") | ("BreakObject", "breakable") => true,
            ("PickupObject", "pickupable") | ("PushObject" | "PullObject", "pushable") => true,
            ("PutObject", "accepts" | "accepts-cut") => {
                return about(0, &self.object) && self.item.as_ref().is_none_or(|item| about(1, item));
            }
            _ => false,
        };
        needed && about(0, &self.object)
    }
}

/// The world as planning is told of it.
pub fn as_planned(facts: BTreeSet<GroundAtom>, bans: &[Ban]) -> BTreeSet<GroundAtom> {
    if bans.is_empty() {
        return facts;
    }
    let so: BTreeSet<(String, String)> = facts
        .iter()
        .filter(|fact| matches!(fact.predicate.as_str(), "open" | "toggled"))
        .filter_map(|fact| Some((fact.predicate.to_string(), fact.args.first()?.as_str().to_lowercase())))
        .collect();
    let holds = |predicate: &str, name: &str| so.contains(&(predicate.to_owned(), name.to_lowercase()));
    facts.into_iter().filter(|fact| !bans.iter().any(|ban| ban.hides(fact, &holds))).collect()
}

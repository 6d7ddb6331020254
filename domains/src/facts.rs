//! The facts that hold at the start of a run.

use std::collections::BTreeSet;

use lamma_pddl::ast::{GroundAtom, Init};

use crate::crews::{self, Crew};
use crate::goal::PropertyValue;
use crate::kinds::{self, Kinds};
use crate::property::Property;
use crate::robots::Robot;
use crate::world::{Rules, Thing};

/// All facts of the start, static ones first.
pub(crate) fn initial(things: &[Thing], team: &[Robot], crews: &[Crew], rules: &Rules) -> Vec<Init> {
    let mut facts = Facts(Vec::new());
    for thing in things {
        facts.statics(thing, rules);
    }
    facts.compatibility(things);
    facts.lifting(things, team, crews);
    for thing in things {
        facts.state(thing, things);
    }
    for robot in team {
        facts.robot(robot, things, rules);
    }
    facts.0.into_iter().map(Init::Fact).collect()
}

struct Facts(Vec<GroundAtom>);

impl Facts {
    fn add(&mut self, predicate: &str, args: &[&str]) {
        self.0.push(GroundAtom::new(predicate, args.iter().copied()));
    }

    fn when(&mut self, holds: bool, predicate: &str, args: &[&str]) {
        if holds {
            self.add(predicate, args);
        }
    }

    /// What never changes about one thing.
    fn statics(&mut self, thing: &Thing, rules: &Rules) {
        let (x, kind) = (thing.name.as_str(), thing.kind.as_str());
        let table = [
            ("openable", "openable"),
            ("toggleable", "toggleable"),
            ("sliceable", "sliceable"),
            ("breakable", "breakable"),
            ("dirtyable", "dirtyable"),
            ("canFillWithLiquid", "fillable"),
            ("receptacle", "receptacle"),
            ("isHeatSource", "heat-source"),
            ("isColdSource", "cold-source"),
        ];
        for (affordance, predicate) in table {
            self.when(thing.can(affordance), predicate, &[x]);
        }
        self.when(kinds::encloses(kind), "encloses", &[x]);
        self.when(!thing.can("pickupable"), "fixed", &[x]);
        self.when(thing.can("pickupable") || thing.can("moveable"), "pushable", &[x]);
        self.when(thing.can("breakable") && kinds::shatters(kind), "shatters", &[x]);
        self.when(kinds::cooks_when_cut(kind), "cooks-when-cut", &[x]);
        self.when(kinds::consumable(kind), "consumable", &[x]);
        self.when(rules.is_exclusive(thing), "exclusive", &[x]);
        self.when(kind == "CoffeeMachine", "brews", &[x]);
        self.when(kind == "Microwave", "runs-closed", &[x]);
        self.when(kinds::cutter(kind) && !rules.knife_free, "cutter", &[x]);
        for device in &thing.controls {
            self.add("controls", &[x, device]);
        }
        for basin in &thing.fills {
            self.add("fills", &[x, basin]);
        }
    }

    /// Which receptacle takes what.
    fn compatibility(&mut self, things: &[Thing]) {
        let kinds = Kinds::get();
        for place in things.iter().filter(|t| t.can("receptacle")) {
            for item in things.iter().filter(|t| t.can("pickupable") && t.name != place.name) {
                let args = [place.name.as_str(), item.name.as_str()];
                let cut = kinds.accepts_cut(&place.kind, &item.kind);
                let whole = kinds.accepts(&place.kind, &item.kind);
                self.when(whole || cut && item.flag("isSliced"), "accepts", &args);
                self.when(cut, "accepts-cut", &args);
            }
        }
    }

    /// Who can lift what, alone or with whom.
    fn lifting(&mut self, things: &[Thing], team: &[Robot], crews: &[Crew]) {
        let carries = ["PickupObject", "PutObject", "DropHandObject", "ThrowObject"];
        for thing in things.iter().filter(|t| t.can("pickupable")) {
            for robot in team.iter().filter(|r| carries.iter().any(|s| r.has(s))) {
                self.when(crews::lifts(robot, thing), "can-lift", &[&robot.name, &thing.name]);
            }
        }
        for crew in crews {
            for member in &crew.members {
                self.add("in-crew", &[&team[*member].name, &crew.name]);
            }
            for thing in &crew.lifts {
                self.add("can-lift-together", &[&crew.name, thing]);
            }
        }
        let helps: BTreeSet<(usize, &str)> = crews
            .iter()
            .flat_map(|c| c.members.iter().flat_map(|m| c.lifts.iter().map(|x| (*m, x.as_str()))))
            .collect();
        for (member, thing) in helps {
            self.add("can-help-lift", &[&team[member].name, thing]);
        }
    }

    /// The state of one thing.
    fn state(&mut self, thing: &Thing, things: &[Thing]) {
        let (x, kind) = (thing.name.as_str(), thing.kind.as_str());
        let movable = thing.can("pickupable");
        for (name, value) in &thing.is {
            self.property(x, name, value);
        }
        if let Some(parent) = thing.parent.as_deref().filter(|_| movable) {
            self.add("in", &[x, parent]);
        }
        self.when(kind != "Floor", "placed", &[x]);
        self.when(exposed(thing, things), "exposed", &[x]);
        let broken = thing.flag("isBroken");
        let door_open = !kinds::encloses(kind) || thing.flag("isOpen");
        self.when(thing.can("receptacle") && door_open && !broken, "accessible", &[x]);
        self.when(movable && !(broken && kinds::shatters(kind)), "pickupable", &[x]);
        let cut = thing.flag("isSliced") || broken;
        self.when(thing.can("cookable") || cut && kinds::cooks_when_cut(kind), "cookable", &[x]);

        let running = thing.flag("isToggled");
        let closed_only = kind == "Microwave";
        self.when(thing.can("openable") && !(closed_only && running), "can-open", &[x]);
        let ajar = closed_only && thing.flag("isOpen");
        self.when(thing.can("toggleable") && !broken && !ajar, "can-switch-on", &[x]);

        let runs = |d: &str| things.iter().any(|t| t.flag("isToggled") && t.controls.iter().any(|c| c == d));
        let in_source = |affordance: &str| {
            let parent = thing.parent.as_deref().and_then(|p| things.iter().find(|t| t.name == p));
            parent.filter(|p| movable && thing.can("receptacle") && p.can(affordance))
        };
        let heated = runs(x) || in_source("isHeatSource").is_some_and(|p| runs(&p.name));
        self.when(heated, "heating", &[x]);
        self.when(thing.can("isColdSource") || in_source("isColdSource").is_some(), "cooling", &[x]);
        let water = |t: &Thing| t.flag("isToggled") && t.fills.iter().any(|b| b == x);
        self.when(things.iter().any(water), "rinsing", &[x]);
        self.when(kind == "StoveBurner" && runs(x) && !running, "toggled", &[x]);
    }

    fn property(&mut self, x: &str, name: &str, value: &PropertyValue) {
        match (Property::parse(name), value) {
            (Ok(Property::Temperature), PropertyValue::Word(word)) => {
                self.when(word == "Hot", "hot", &[x]);
                self.when(word == "Cold", "cold", &[x]);
            }
            (Ok(Property::FillLiquid), PropertyValue::Word(word)) => {
                self.add("filled", &[x]);
                self.add("filled-with", &[x, word]);
            }
            (Ok(Property::Filled), PropertyValue::Flag(true)) => self.add("filled", &[x]),
            (Ok(flag), PropertyValue::Flag(true)) if !flag.predicate().is_empty() => {
                self.add(flag.predicate(), &[x]);
            }
            // False flags are facts that are absent; scenes hold no other properties (a test reads them all).
            _ => {}
        }
    }

    fn robot(&mut self, robot: &Robot, things: &[Thing], rules: &Rules) {
        let r = robot.name.as_str();
        for floor in things.iter().filter(|t| t.kind == "Floor") {
            self.add("at", &[r, &floor.name]);
        }
        for skill in &robot.skills {
            self.add("has", &[r, skill]);
        }
        self.add("hand-free", &[r]);
        self.add("mobile", &[r]);
        self.when(rules.knife_free, "armed", &[r]);
        const COUNT: [&str; 5] = ["none", "one", "two", "three", "four"];
        if robot.hands > 1 {
            self.add("many-handed", &[r]);
            self.add("free-hands", &[r, COUNT[usize::from(robot.hands.min(4))]]);
            for pair in COUNT.windows(2) {
                let next = GroundAtom::new("next", pair.iter().copied());
                if !self.0.contains(&next) {
                    self.0.push(next);
                }
            }
        } else {
            self.add("one-handed", &[r]);
        }
    }
}

/// Furniture is; a movable thing is where it stands on furniture or in open furniture.
fn exposed(thing: &Thing, things: &[Thing]) -> bool {
    let parent = thing.parent.as_deref().filter(|_| thing.can("pickupable"));
    match parent.and_then(|p| things.iter().find(|t| t.name == p)) {
        Some(parent) => {
            let shut = kinds::encloses(&parent.kind) && !parent.flag("isOpen");
            !parent.can("pickupable") && !shut
        }
        None => true,
    }
}

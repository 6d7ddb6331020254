//! The household's rules once more, written as a plain state machine.
//!
//! The simulator interprets the PDDL domain, so a wrong domain would be a wrong world and nobody would notice.
//! This is the second opinion: the rules of AI2-THOR 5.0 as the project states them (`domains/README.md`), on
//! structs instead of facts, and with nothing kept that can be looked up. Where the domain keeps a fact that
//! a thing can be reached, this looks at the doors. `tests/agreement.rs` holds the two against each other.

mod act;
mod facts;

pub use facts::COMPARED;

use std::collections::{BTreeMap, BTreeSet};

use lamma_domains::goal::PropertyValue;
use lamma_domains::kinds::{self, Kinds};
use lamma_domains::robots::Robot;
use lamma_domains::world::{Rules, Thing, WorldSetup};

/// Why an act is not possible.
pub type Refused = &'static str;

/// Where a thing is.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Place {
    /// It stays where it is.
    Fixed,
    /// In or on that thing.
    In(String),
    /// In that robot's hand.
    Held(String),
}

/// How warm a thing is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Warmth {
    Room,
    Hot,
    Cold,
}

/// A thing and its state.
#[derive(Clone, Debug)]
struct Object {
    thing: Thing,
    place: Place,
    open: bool,
    on: bool,
    sliced: bool,
    broken: bool,
    cooked: bool,
    dirty: bool,
    used_up: bool,
    moved: bool,
    filled: bool,
    liquid: Option<String>,
    warmth: Warmth,
}

/// A robot and its state.
#[derive(Clone, Debug)]
struct Agent {
    robot: Robot,
    /// What it stands at.
    at: BTreeSet<String>,
    /// The thing it offers a hand for, or helps to carry.
    offers: Option<String>,
    /// Whom it helps to carry that.
    follows: Option<String>,
    lost: bool,
}

/// The household.
#[derive(Clone, Debug)]
pub struct House {
    things: BTreeMap<String, Object>,
    agents: BTreeMap<String, Agent>,
    /// The names of crews and who is in them; what they can lift is worked out anew.
    crews: BTreeMap<String, BTreeSet<String>>,
    rules: Rules,
}

impl House {
    /// The house at the start.
    pub fn new(setup: &WorldSetup, team: &[Robot], rules: &Rules) -> House {
        let mut crews: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for fact in setup.facts().filter(|f| f.predicate == "in-crew") {
            crews.entry(fact.args[1].to_string()).or_default().insert(fact.args[0].to_string());
        }
        let mut house = House {
            things: setup.things.iter().map(|t| (t.name.clone(), Object::new(t))).collect(),
            agents: BTreeMap::new(),
            crews,
            rules: rules.clone(),
        };
        let floors: BTreeSet<String> = house.floors();
        for robot in team {
            let agent =
                Agent { robot: robot.clone(), at: floors.clone(), offers: None, follows: None, lost: false };
            house.agents.insert(robot.name.clone(), agent);
        }
        house
    }

    /// What the robot stands at.
    pub fn near(&self, robot: &str) -> impl Iterator<Item = &str> {
        self.agents.get(robot).into_iter().flat_map(|a| a.at.iter().map(String::as_str))
    }

    /// What the robot holds.
    pub fn held(&self, robot: &str) -> impl Iterator<Item = &str> {
        self.held_by(robot).into_iter().map(|o| o.thing.name.as_str())
    }

    /// What the thing lies in or on, if anything.
    pub fn container(&self, thing: &str) -> impl Iterator<Item = &str> {
        self.things.get(thing).and_then(|o| o.place.container()).into_iter()
    }

    /// The crews that the robot is in.
    pub fn crews_of(&self, robot: &str) -> impl Iterator<Item = &str> {
        self.crews.iter().filter(move |(_, members)| members.contains(robot)).map(|(name, _)| name.as_str())
    }

    fn floors(&self) -> BTreeSet<String> {
        self.things.values().filter(|o| o.thing.kind == "Floor").map(|o| o.thing.name.clone()).collect()
    }

    fn thing(&self, name: &str) -> Result<&Object, Refused> {
        self.things.get(name).ok_or("there is no such thing")
    }

    fn contents(&self, of: &str) -> Vec<String> {
        let inside = |o: &&Object| o.place == Place::In(of.to_string());
        self.things.values().filter(inside).map(|o| o.thing.name.clone()).collect()
    }

    /// Whether hands can get at the thing: it is furniture, or stands on furniture or in an open one.
    fn exposed(&self, name: &str) -> bool {
        match self.things.get(name).map(|o| &o.place) {
            Some(Place::Fixed) => true,
            Some(Place::In(container)) => self
                .things
                .get(container)
                .is_some_and(|c| c.place == Place::Fixed && (c.open || !kinds::encloses(&c.thing.kind))),
            Some(Place::Held(_)) | None => false,
        }
    }

    /// Whether things can be put into it and taken out of it, as far as its own door goes.
    fn accessible(&self, name: &str) -> bool {
        self.things.get(name).is_some_and(|c| {
            c.thing.can("receptacle") && !c.broken && (c.open || !kinds::encloses(&c.thing.kind))
        })
    }

    fn accepts(&self, container: &str, name: &str) -> bool {
        let (Some(c), Some(x)) = (self.things.get(container), self.things.get(name)) else { return false };
        let kinds = Kinds::get();
        c.thing.can("receptacle")
            && container != name
            && (kinds.accepts(&c.thing.kind, &x.thing.kind)
                || x.sliced && kinds.accepts_cut(&c.thing.kind, &x.thing.kind))
    }

    /// Whether the device is a heat source that is on, by its own switch or by its knob.
    fn is_hot_device(&self, name: &str) -> bool {
        self.things.values().any(|switch| switch.on && switch.thing.controls.iter().any(|d| d == name))
    }

    /// Whether what is put there becomes hot: a heat source that is on, or a vessel that stands in one.
    fn heats(&self, name: &str) -> bool {
        let Some(object) = self.things.get(name) else { return false };
        match &object.place {
            Place::In(source) => object.thing.can("receptacle") && self.is_hot_device(source),
            Place::Fixed => self.is_hot_device(name),
            Place::Held(_) => false,
        }
    }

    /// Whether what is put there becomes cold: a fridge, or a vessel that stands in one.
    fn cools(&self, name: &str) -> bool {
        let cold = |name: &str| self.things.get(name).is_some_and(|o| o.thing.can("isColdSource"));
        match self.things.get(name).map(|o| &o.place) {
            Some(Place::In(source)) => self.things[name].thing.can("receptacle") && cold(source),
            Some(Place::Fixed) => cold(name),
            Some(Place::Held(_)) | None => false,
        }
    }

    /// Whether water runs into it.
    fn rinses(&self, name: &str) -> bool {
        self.things.values().any(|tap| tap.on && tap.thing.fills.iter().any(|b| b == name))
    }

    fn held_by(&self, robot: &str) -> Vec<&Object> {
        self.things.values().filter(|o| o.place == Place::Held(robot.to_string())).collect()
    }

    /// Whether the robot has a hand for one more thing.
    fn has_hand(&self, robot: &str) -> bool {
        let Some(agent) = self.agents.get(robot) else { return false };
        let busy = self.held_by(robot).len() + usize::from(agent.offers.is_some());
        !agent.lost && busy < usize::from(agent.robot.hands)
    }

    fn is_armed(&self, robot: &str) -> bool {
        self.rules.knife_free || self.held_by(robot).iter().any(|o| kinds::cutter(&o.thing.kind))
    }

    fn is_strong_enough(&self, robot: &str, mass_kg: f64) -> bool {
        self.agents.get(robot).is_some_and(|a| mass_kg <= a.robot.capacity_kg + 1e-9)
    }

    /// Whether these robots lift the thing together, none of them could alone, and none could be left out.
    fn is_crew_for(&self, members: &BTreeSet<String>, name: &str) -> bool {
        let Some(object) = self.things.get(name).filter(|o| o.thing.can("pickupable")) else { return false };
        let mass = object.thing.mass_kg;
        let capacity = |m: &String| self.agents.get(m).map_or(0.0, |a| a.robot.capacity_kg);
        let together: f64 = members.iter().map(capacity).sum();
        let able = |m: &String| {
            self.agents.get(m).is_some_and(|a| a.robot.has("PickupObject") && capacity(m) + 1e-9 < mass)
        };
        members.len() > 1
            && members.iter().all(able)
            && mass <= together + 1e-9
            && members.iter().all(|m| together - capacity(m) + 1e-9 < mass)
    }

    /// Whether some crew of the team needs the robot for the thing.
    fn is_needed_for(&self, robot: &str, name: &str) -> bool {
        let others: Vec<&String> = self.agents.keys().filter(|a| *a != robot).collect();
        (0..1u32 << others.len().min(16)).any(|choice| {
            let chosen =
                others.iter().enumerate().filter(|(i, _)| choice >> i & 1 == 1).map(|(_, a)| (*a).clone());
            let members: BTreeSet<String> = chosen.chain([robot.to_string()]).collect();
            self.is_crew_for(&members, name)
        })
    }

    /// Those who offer a hand for the thing, or help to carry it.
    fn hands_on(&self, name: &str) -> BTreeSet<String> {
        let offers = |(robot, agent): (&String, &Agent)| {
            (agent.offers.as_deref() == Some(name)).then(|| robot.clone())
        };
        self.agents.iter().filter_map(offers).collect()
    }
}

impl Object {
    fn new(thing: &Thing) -> Object {
        let flag = |name: &str| thing.is.get(name) == Some(&PropertyValue::Flag(true));
        let word = |name: &str| match thing.is.get(name) {
            Some(PropertyValue::Word(word)) => Some(word.clone()),
            _ => None,
        };
        let place = match &thing.parent {
            Some(parent) if thing.can("pickupable") => Place::In(parent.clone()),
            _ => Place::Fixed,
        };
        let liquid = word("fillLiquid");
        Object {
            place,
            open: flag("isOpen"),
            on: flag("isToggled"),
            sliced: flag("isSliced"),
            broken: flag("isBroken"),
            cooked: flag("isCooked"),
            dirty: flag("isDirty"),
            used_up: flag("isUsedUp"),
            moved: false,
            filled: flag("isFilledWithLiquid") || liquid.is_some(),
            liquid,
            warmth: match word("temperature").as_deref() {
                Some("Hot") => Warmth::Hot,
                Some("Cold") => Warmth::Cold,
                _ => Warmth::Room,
            },
            thing: thing.clone(),
        }
    }

    fn is_item(&self) -> bool {
        self.thing.can("pickupable")
    }

    /// In pieces, it can be picked up no more.
    fn in_pieces(&self) -> bool {
        self.broken && kinds::shatters(&self.thing.kind)
    }

    fn cookable(&self) -> bool {
        self.thing.can("cookable") || (self.sliced || self.broken) && kinds::cooks_when_cut(&self.thing.kind)
    }

    fn warm(&mut self) {
        self.warmth = Warmth::Hot;
        self.cooked |= self.cookable();
    }

    fn fill(&mut self, liquid: &str) {
        if self.thing.can("canFillWithLiquid") && !self.filled {
            self.filled = true;
            self.liquid = Some(liquid.to_string());
        }
    }

    fn smash(&mut self) {
        self.broken = true;
        self.on = false;
        self.filled = false;
        self.liquid = None;
    }
}

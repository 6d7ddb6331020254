//! A world to act in: a scene, a team and a task's own objects as PDDL objects and facts.

use std::collections::{BTreeMap, BTreeSet};

use lamma_pddl::Name;
use lamma_pddl::ast::{Domain, GroundAtom, Init, TypedName};
use serde::{Deserialize, Serialize};

use crate::goal::PropertyValue;
use crate::kinds::{self, Kinds};
use crate::robots::{self, Robot};
use crate::scene::{self, SceneObject};
use crate::ways::Ways;
use crate::{HouseError, crews, facts, nearest, place, property};

/// Objects of a task's own: these many of a type, there, so.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObjectSpec {
    /// `Apple`; a type that cannot be picked up speaks of those the scene has.
    #[serde(rename = "type")]
    pub kind: String,
    /// How many.
    #[serde(default = "one")]
    pub count: u32,
    /// A receptacle type or object; chosen by the seed where missing.
    #[serde(default, rename = "in", skip_serializing_if = "Option::is_none")]
    pub place: Option<String>,
    /// Properties at the start, by their AI2-THOR names.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub is: BTreeMap<String, PropertyValue>,
}

fn one() -> u32 {
    1
}

/// The most objects of one line of a task's `objects`.
const MAX_COUNT: u32 = 50;

/// A thing of the world and what never changes about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Thing {
    /// `Apple_1`
    pub name: String,
    /// `Apple`
    pub kind: String,
    /// In kilograms; 0 for what is fixed.
    pub mass_kg: f64,
    /// Affordances by their AI2-THOR names.
    pub affordances: Vec<String>,
    /// What it is made of.
    pub materials: Vec<String>,
    /// Metres at the start: x, height, z.
    pub at: Option<[f64; 3]>,
    /// What it starts in or on. Of things that do not move it is not a fact of the world.
    pub parent: Option<String>,
    /// Properties at the start.
    pub is: BTreeMap<String, PropertyValue>,
    /// The heat sources that switching it runs.
    pub controls: Vec<String>,
    /// The basins it runs into.
    pub fills: Vec<String>,
    /// Where one stands at it, if it does not move.
    pub stand: Option<[f64; 2]>,
}

impl Thing {
    /// Whether it has the affordance.
    pub fn can(&self, affordance: &str) -> bool {
        self.affordances.iter().any(|a| a == affordance)
    }

    /// Whether the flag property is true at the start.
    pub(crate) fn flag(&self, property: &str) -> bool {
        self.is.get(property) == Some(&PropertyValue::Flag(true))
    }

    fn from_scene(object: &SceneObject) -> Self {
        let kind = Kinds::get().find(&object.kind);
        let affordances = object.affordances.clone().or(kind.map(|k| k.affordances.clone()));
        let mut thing = Thing {
            name: object.name.clone(),
            kind: object.kind.clone(),
            mass_kg: object.mass_kg,
            affordances: affordances.unwrap_or_default(),
            materials: kind.map(|k| k.materials.clone()).unwrap_or_default(),
            at: object.at,
            parent: object.parent.clone(),
            is: object.is.clone(),
            controls: object.controls.clone(),
            fills: object.fills.clone(),
            stand: object.stand,
        };
        if kinds::washable(&thing.kind) && !thing.can("dirtyable") {
            thing.affordances.push("dirtyable".to_string());
        }
        if thing.can("isHeatSource") && thing.can("toggleable") {
            thing.controls = vec![thing.name.clone()];
        }
        thing
    }
}

/// A robot of the team with the domain it plans in.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// `robot1`
    pub name: String,
    /// Its skills.
    pub skills: Vec<String>,
    /// The heaviest thing it can lift, in kilograms.
    pub capacity_kg: f64,
    /// How many things it can hold.
    pub hands: u8,
    /// The union domain without the actions it has no skill for.
    pub domain: Domain,
}

/// Everything a run needs to know of its world.
#[derive(Clone, Debug, PartialEq)]
pub struct WorldSetup {
    /// `FloorPlan6`
    pub scene: String,
    /// Every action of every robot.
    pub domain: Domain,
    /// The robots, then the things, then the crews, by name and type.
    pub objects: Vec<TypedName>,
    /// What holds at the start.
    pub init: Vec<Init>,
    /// The team.
    pub members: Vec<Member>,
    /// The action `(action robot)` for a robot whose process is gone.
    pub on_lost: Option<Name>,
    /// The things and what never changes about them, in the order of `objects`.
    pub things: Vec<Thing>,
    /// How far it is from thing to thing, where going takes its time.
    pub ways: Option<Ways>,
}

impl WorldSetup {
    /// The thing of that name, in any case.
    pub fn thing(&self, name: &str) -> Option<&Thing> {
        self.things.iter().find(|t| t.name.eq_ignore_ascii_case(name))
    }

    /// The domain of what the team can do: every action but those that happen without it.
    pub fn team_domain(&self) -> Domain {
        let skills = robots::actions_of(robots::SKILLS);
        let mut domain = self.domain.clone();
        domain.actions.retain(|action| skills.contains(&action.name.as_str()));
        domain
    }

    /// The facts that hold at the start.
    pub fn facts(&self) -> impl Iterator<Item = &GroundAtom> {
        self.init.iter().filter_map(|init| match init {
            Init::Fact(atom) => Some(atom),
            Init::Value(..) => None,
        })
    }
}

/// Rules of a task that differ from the usual.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Rules {
    /// Slicing needs no knife.
    #[serde(skip_serializing_if = "is_false")]
    pub knife_free: bool,
    /// Going takes a step for each cell on the way instead of one in all.
    #[serde(skip_serializing_if = "is_false")]
    pub travel: bool,
    /// Furniture and fixtures, by type or name, where only one robot at a time can stand.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub exclusive: Vec<String>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_false(flag: &bool) -> bool {
    !flag
}

impl Rules {
    /// Whether only one robot at a time can stand at the thing.
    pub(crate) fn is_exclusive(&self, thing: &Thing) -> bool {
        self.exclusive.iter().any(|name| *name == thing.kind || *name == thing.name)
    }

    /// Names in the rules that the world does not know.
    fn check(&self, things: &[Thing]) -> Result<(), HouseError> {
        for name in &self.exclusive {
            let Some(thing) = things.iter().find(|t| *name == t.kind || *name == t.name) else {
                let names: BTreeSet<&str> = things
                    .iter()
                    .filter(|t| !t.can("pickupable"))
                    .flat_map(|t| [t.name.as_str(), &t.kind])
                    .collect();
                let hint = nearest::hint(name, names);
                return Err(HouseError::BadRule(format!("exclusive: this scene has no `{name}`{hint}")));
            };
            if thing.can("pickupable") || thing.kind == "Floor" {
                let what =
                    format!("exclusive: `{name}` is no furniture or fixture; name one, such as Fridge");
                return Err(HouseError::BadRule(what));
            }
        }
        Ok(())
    }
}

/// The world of a scene and a team under the usual rules. `objects` replaces the scene's movable things;
/// `seed` places those that say no place.
pub fn setup(
    scene: &str,
    team: &[Robot],
    objects: Option<&[ObjectSpec]>,
    seed: u64,
) -> Result<WorldSetup, HouseError> {
    setup_with(scene, team, objects, seed, &Rules::default())
}

/// [`setup`] under a task's own rules.
pub fn setup_with(
    scene: &str,
    team: &[Robot],
    objects: Option<&[ObjectSpec]>,
    seed: u64,
    rules: &Rules,
) -> Result<WorldSetup, HouseError> {
    for robot in team {
        robot.check()?;
    }
    let scene = scene::load(scene)?;
    let mut things: Vec<Thing> = scene.objects.iter().map(Thing::from_scene).collect();
    if let Some(specs) = objects {
        replace_movables(&mut things, specs, &scene.scene, seed)?;
    }
    rules.check(&things)?;
    let domain = robots::union_domain().clone();
    let crews = crews::crews(&things, team);
    let taken = |name: &str| {
        things.iter().any(|t| t.name.eq_ignore_ascii_case(name))
            || domain.constants.iter().any(|c| c.name == *name)
            || crews.iter().any(|c| c.name.eq_ignore_ascii_case(name))
    };
    if let Some(robot) = team.iter().find(|r| taken(&r.name)) {
        let what = "a thing of the world has this name; choose another".to_string();
        return Err(HouseError::BadRobot { robot: robot.name.clone(), what });
    }
    let robot_objects = team.iter().map(|r| TypedName::new(&r.name, "robot"));
    let crew_objects = crews.iter().map(|c| TypedName::new(&c.name, "crew"));
    let thing_objects = things.iter().map(|t| TypedName::new(&t.name, &t.kind));
    let objects = robot_objects.chain(thing_objects).chain(crew_objects).collect();
    let members = team
        .iter()
        .map(|robot| Member {
            name: robot.name.clone(),
            skills: robot.skills.clone(),
            capacity_kg: robot.capacity_kg,
            hands: robot.hands,
            domain: robots::project(&domain, robot.skills.iter().map(String::as_str)),
        })
        .collect();
    Ok(WorldSetup {
        scene: scene.scene,
        objects,
        init: facts::initial(&things, team, &crews, rules),
        members,
        on_lost: Some(Name::new("RobotLost")),
        ways: rules.travel.then(|| Ways::new(&scene.floor, &things)),
        things,
        domain,
    })
}

/// Takes the scene's movable things away and puts the task's there.
fn replace_movables(
    things: &mut Vec<Thing>,
    specs: &[ObjectSpec],
    scene: &str,
    seed: u64,
) -> Result<(), HouseError> {
    things.retain(|t| !t.can("pickupable"));
    let mut count: BTreeMap<&str, u32> = BTreeMap::new();
    let mut new: Vec<(Thing, Option<String>)> = Vec::new();
    for spec in specs {
        let kind = check_spec(spec)?;
        if !kind.is("pickupable") {
            restate(things, spec)?;
            continue;
        }
        for _ in 0..spec.count {
            let number = count.entry(spec.kind.as_str()).or_default();
            *number += 1;
            let object = SceneObject {
                name: format!("{}_{number}", spec.kind),
                kind: spec.kind.clone(),
                mass_kg: kind.mass_kg,
                affordances: None,
                at: None,
                parent: None,
                is: spec.is.clone(),
                controls: Vec::new(),
                fills: Vec::new(),
                placed: None,
                stand: None,
            };
            new.push((Thing::from_scene(&object), spec.place.clone()));
        }
    }
    let wanted: Vec<(String, String, Option<String>)> =
        new.iter().map(|(t, place)| (t.name.clone(), t.kind.clone(), place.clone())).collect();
    let vessels: Vec<&Thing> = new.iter().map(|(t, _)| t).filter(|t| t.can("receptacle")).collect();
    let places = {
        let fixed: Vec<(&str, &str)> = things
            .iter()
            .chain(vessels.iter().copied())
            .filter(|t| t.can("receptacle"))
            .map(|t| (t.name.as_str(), t.kind.as_str()))
            .collect();
        place::place(&wanted, &fixed, scene, seed)
    };
    for (mut thing, wanted) in new {
        thing.parent = places.get(&thing.name).cloned();
        if thing.parent.is_none() {
            return Err(unplaced(&thing, wanted.as_deref(), things));
        }
        things.push(thing);
    }
    no_ring(things)?;
    things.sort_by_key(|t| natural(&t.name));
    chill(things);
    Ok(())
}

fn natural(name: &str) -> (String, u32) {
    let (kind, number) = name.rsplit_once('_').unwrap_or((name, "0"));
    (kind.to_string(), number.parse().unwrap_or(0))
}

/// What starts in the fridge starts cold, unless the task says otherwise.
fn chill(things: &mut [Thing]) {
    for thing in things.iter_mut().filter(|t| t.parent.as_ref().is_some_and(|p| p.starts_with("Fridge_"))) {
        thing.is.entry("temperature".to_string()).or_insert(PropertyValue::Word("Cold".to_string()));
    }
}

fn check_spec(spec: &ObjectSpec) -> Result<&'static kinds::Kind, HouseError> {
    let table = Kinds::get();
    let Some(kind) = table.find(&spec.kind).filter(|_| !table.is_cut(&spec.kind)) else {
        let hint = nearest::hint(&spec.kind, table.names().filter(|n| !table.is_cut(n)));
        return Err(HouseError::UnknownType { name: spec.kind.clone(), hint });
    };
    if spec.count > MAX_COUNT {
        return Err(HouseError::BadObject(format!("{} × {}; at most {MAX_COUNT}", spec.count, spec.kind)));
    }
    if let Err(what) = property::check_properties(&spec.kind, &spec.is) {
        return Err(HouseError::BadObject(what));
    }
    if spec.is.get("isPickedUp") == Some(&PropertyValue::Flag(true)) {
        return Err(HouseError::BadObject(format!("{}: nothing is held at the start", spec.kind)));
    }
    Ok(kind)
}

/// States of furniture and fixtures, which no task adds or removes.
fn restate(things: &mut [Thing], spec: &ObjectSpec) -> Result<(), HouseError> {
    let there = things.iter().filter(|t| t.kind == spec.kind).count();
    if there == 0 {
        return Err(HouseError::BadObject(format!(
            "this scene has no {}, and what cannot be picked up cannot be added",
            spec.kind
        )));
    }
    if spec.count as usize > there {
        return Err(HouseError::BadObject(format!(
            "this scene has {there} × {}, not {}, and what cannot be picked up cannot be added",
            spec.kind, spec.count
        )));
    }
    let found = things.iter_mut().filter(|t| t.kind == spec.kind);
    for thing in found.take(spec.count as usize) {
        thing.is.extend(spec.is.clone());
    }
    Ok(())
}

fn unplaced(thing: &Thing, wanted: Option<&str>, things: &[Thing]) -> HouseError {
    let Some(wanted) = wanted else {
        return HouseError::BadObject(format!("no place in this scene takes a {}", thing.kind));
    };
    let names: BTreeSet<&str> =
        things.iter().flat_map(|t| [t.name.as_str(), t.kind.as_str()]).filter(|n| *n != wanted).collect();
    if things.iter().any(|t| t.name == wanted || t.kind == wanted) {
        return HouseError::BadObject(format!("a {wanted} does not take a {}", thing.kind));
    }
    let hint = nearest::hint(wanted, names);
    HouseError::BadObject(format!("this scene has no `{wanted}` to put a {} in{hint}", thing.kind))
}

/// Vessels may lie in vessels, but not in a ring.
fn no_ring(things: &[Thing]) -> Result<(), HouseError> {
    let parents: BTreeMap<&str, &str> =
        things.iter().filter_map(|t| Some((t.name.as_str(), t.parent.as_deref()?))).collect();
    for thing in things {
        let mut at = thing.name.as_str();
        for _ in 0..=things.len() {
            match parents.get(at) {
                Some(parent) => at = parent,
                None => break,
            }
        }
        if parents.contains_key(at) {
            return Err(HouseError::BadObject(format!("{} would lie in itself", thing.name)));
        }
    }
    Ok(())
}

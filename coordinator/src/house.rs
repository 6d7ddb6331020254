//! A household's team and the obstacles that can be named in it.

use std::collections::BTreeMap;
use std::sync::Arc;

use lamma_domains::robots::{SKILLS, actions_of};
use lamma_domains::world::WorldSetup;
use lamma_pddl::Name;
use lamma_pddl::ast::GroundAtom;
use lamma_planner::travel::Travel;

use crate::team::{Member, Relaxation, Team};

/// The team as planning sees it.
pub fn team(world: &WorldSetup) -> Team {
    let members =
        world.members.iter().map(|m| Member { name: Name::new(&m.name), domain: Arc::new(m.domain.clone()) });
    Team {
        members: members.collect(),
        domain: Arc::new(world.team_domain()),
        objects: world.objects.clone(),
        relaxations: too_heavy(world).into_iter().chain([hands(world)]).collect(),
        numbers: Vec::new(),
        skill_facts: skill_facts(world),
        travel: travel(world).map(Arc::new),
    }
}

/// How long going takes in the household, where it takes its time.
pub fn travel(world: &WorldSetup) -> Option<Travel> {
    let ways = world.ways.as_ref()?;
    Some(Travel {
        action: Name::new("GoToObject"),
        at: Name::new("at"),
        inside: Name::new("in"),
        place_of: ways.place_of.iter().map(|(thing, place)| (Name::new(thing), *place)).collect(),
        elsewhere: ways.middle,
        steps: ways.steps.clone(),
    })
}

/// The world's own record of who has which skill, for every skill: `(has robot1 SliceObject)`.
fn skill_facts(world: &WorldSetup) -> BTreeMap<Name, Vec<GroundAtom>> {
    let mut facts: BTreeMap<Name, Vec<GroundAtom>> = BTreeMap::new();
    for skill in SKILLS {
        for action in actions_of([skill]) {
            let of = |m: &lamma_domains::world::Member| GroundAtom::new("has", [m.name.as_str(), skill]);
            facts.entry(Name::new(action)).or_default().extend(world.members.iter().map(of));
        }
    }
    // The world says what a member can lift only of those who can carry at all.
    for action in ["PickupObject", "PutObject"] {
        facts.entry(Name::new(action)).or_default().extend(liftable(world));
    }
    facts
}

/// `(can-lift robot thing)` as the capacities allow, whatever the skills.
fn liftable(world: &WorldSetup) -> Vec<GroundAtom> {
    let can = |m: &lamma_domains::world::Member, t: &lamma_domains::world::Thing| {
        t.can("pickupable") && t.mass_kg <= m.capacity_kg
    };
    let of = |m| {
        let things = world.things.iter().filter(move |t| can(m, t));
        things.map(move |t| GroundAtom::new("can-lift", [m.name.as_str(), t.name.as_str()]))
    };
    world.members.iter().flat_map(of).collect()
}

/// Things that nobody of the team can lift: obstacles with a name.
fn too_heavy(world: &WorldSetup) -> Vec<Relaxation> {
    let strongest = world.members.iter().map(|m| m.capacity_kg).fold(0.0, f64::max);
    world
        .things
        .iter()
        .filter(|t| t.can("pickupable") && t.mass_kg > strongest)
        .map(|t| Relaxation {
            reason: format!(
                "{} weighs {} kg and the strongest of the team lifts {strongest} kg",
                t.name, t.mass_kg
            ),
            facts: world
                .members
                .iter()
                .map(|m| GroundAtom::new("can-lift", [m.name.as_str(), t.name.as_str()]))
                .collect(),
            kept: Vec::new(),
        })
        .collect()
}

/// A robot holds only so many things at once.
fn hands(world: &WorldSetup) -> Relaxation {
    let names: Vec<String> = world.members.iter().map(|m| format!("{} has {}", m.name, m.hands)).collect();
    Relaxation {
        reason: format!("there is no free hand for it: of hands, {}", names.join(", ")),
        facts: Vec::new(),
        kept: vec![Name::new("hand-free")],
    }
}

//! Crews: robots that together can lift what none of them can lift alone, and none of them idle.

use std::collections::BTreeMap;

use crate::robots::Robot;
use crate::world::Thing;

/// Rounding in masses and capacities that is not meant, in kilograms.
const SLACK_KG: f64 = 1e-9;

/// The most robots that fit around one thing.
pub const MAX_CREW: usize = 6;

/// The most crews for one thing. A large team of weak robots has more combinations than anybody can use; the
/// strongest robots come first.
const MAX_CREWS: usize = 200;

/// Robots that can lift something together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Crew {
    /// The object that stands for it in the world: `crew_1`.
    pub name: String,
    /// Its robots, by their index in the team.
    pub members: Vec<usize>,
    /// The names of the things that they can lift together and no fewer of them could.
    pub lifts: Vec<String>,
}

/// Whether the robot lifts the thing alone.
pub(crate) fn lifts(robot: &Robot, thing: &Thing) -> bool {
    thing.mass_kg <= robot.capacity_kg + SLACK_KG
}

/// Every crew of the team that can lift something.
pub(crate) fn crews(things: &[Thing], team: &[Robot]) -> Vec<Crew> {
    let mut found: BTreeMap<Vec<usize>, Vec<String>> = BTreeMap::new();
    for thing in things.iter().filter(|t| t.can("pickupable")) {
        for members in minimal_crews(thing, team) {
            found.entry(members).or_default().push(thing.name.clone());
        }
    }
    let crew = |(index, (members, lifts))| Crew { name: format!("crew_{}", index + 1), members, lifts };
    found.into_iter().enumerate().map(crew).collect()
}

/// The sets of robots, none of which could be left out, whose capacities together are enough for the thing.
fn minimal_crews(thing: &Thing, team: &[Robot]) -> Vec<Vec<usize>> {
    let mut weak: Vec<usize> =
        (0..team.len()).filter(|&r| team[r].has("PickupObject") && !lifts(&team[r], thing)).collect();
    // From strong to weak: then a set is minimal if it is enough with its last and was not without it.
    weak.sort_by(|&a, &b| team[b].capacity_kg.total_cmp(&team[a].capacity_kg).then(a.cmp(&b)));
    let mut found = Vec::new();
    extend(thing.mass_kg - SLACK_KG, team, &weak, &mut Vec::new(), &mut found);
    found
}

/// Adds the crews that begin with `crew` and go on with some of `rest`; `missing` is what they still lack.
fn extend(missing: f64, team: &[Robot], rest: &[usize], crew: &mut Vec<usize>, found: &mut Vec<Vec<usize>>) {
    for (index, &robot) in rest.iter().enumerate() {
        let strongest: f64 =
            rest[index..].iter().take(MAX_CREW - crew.len()).map(|&r| team[r].capacity_kg).sum();
        if found.len() >= MAX_CREWS || strongest < missing {
            // The robots that follow are weaker still.
            return;
        }
        crew.push(robot);
        let missing = missing - team[robot].capacity_kg;
        if missing <= 0.0 {
            let mut members = crew.clone();
            members.sort_unstable();
            found.push(members);
        } else if crew.len() < MAX_CREW {
            extend(missing, team, &rest[index + 1..], crew, found);
        }
        crew.pop();
    }
}

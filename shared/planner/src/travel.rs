//! Durations that follow from where an agent is.
//!
//! PDDL can say how long an action takes by its parameters alone. Going takes as long as the way from wherever the
//! agent happens to be, which would need a parameter for that place: every action of going as often as there are
//! places. A table beside the domain says it once; the plain semantics looks up in the state where the agent is.

use std::collections::{BTreeMap, BTreeSet};

use lamma_pddl::Name;
use lamma_pddl::ast::GroundAtom;

use crate::plan::GroundAct;

/// Containers in containers go no deeper.
const DEEPEST: usize = 8;

/// How long going takes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Travel {
    /// The action: its first argument goes to its second.
    pub action: Name,
    /// `(at agent thing)`: the agent stands there.
    pub at: Name,
    /// `(in thing container)`: the thing is where the container is.
    pub inside: Name,
    /// Where things that do not move are.
    pub place_of: BTreeMap<Name, usize>,
    /// The place of everything else.
    pub elsewhere: usize,
    /// The time from place to place. No way around is shorter: `steps[a][c] <= steps[a][b] + steps[b][c]`.
    pub steps: Vec<Vec<u32>>,
}

impl Travel {
    /// How long the act takes in this state; `None` if it is not one of going. Going to what is at hand takes one
    /// step, as every action does.
    pub fn duration(&self, facts: &BTreeSet<GroundAtom>, act: &GroundAct) -> Option<f64> {
        let [agent, to] = act.args.as_slice() else { return None };
        if act.action != self.action {
            return None;
        }
        let (from, to) = (self.place_of_agent(facts, agent), self.place_of_thing(facts, to));
        Some(f64::from(self.steps(from, to).max(1)))
    }

    /// Steps between two places.
    pub fn steps(&self, from: usize, to: usize) -> u32 {
        self.steps.get(from).and_then(|row| row.get(to)).copied().unwrap_or(0)
    }

    /// Where the agent stands.
    pub fn place_of_agent(&self, facts: &BTreeSet<GroundAtom>, agent: &Name) -> usize {
        let places = values(facts, &self.at, agent).map(|thing| self.place_of_thing(facts, thing));
        places.into_iter().find(|place| *place != self.elsewhere).unwrap_or(self.elsewhere)
    }

    fn place_of_thing(&self, facts: &BTreeSet<GroundAtom>, thing: &Name) -> usize {
        let mut thing = thing;
        for _ in 0..DEEPEST {
            if let Some(place) = self.place_of.get(thing) {
                return *place;
            }
            match values(facts, &self.inside, thing).next() {
                Some(container) => thing = container,
                None => break,
            }
        }
        self.elsewhere
    }
}

/// The second arguments of the facts of the predicate whose first argument is this.
fn values<'a>(
    facts: &'a BTreeSet<GroundAtom>,
    predicate: &'a Name,
    first: &'a Name,
) -> impl Iterator<Item = &'a Name> {
    let from = GroundAtom { predicate: predicate.clone(), args: vec![first.clone()] };
    facts
        .range(from..)
        .take_while(move |fact| fact.predicate == *predicate && fact.args.first() == Some(first))
        .filter_map(|fact| fact.args.get(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facts(list: &[&[&str]]) -> BTreeSet<GroundAtom> {
        list.iter().map(|f| GroundAtom::new(f[0], f[1..].iter().copied())).collect()
    }

    #[test]
    fn the_time_is_that_of_the_way_from_where_the_agent_is() {
        let place = |name: &str, place| (Name::new(name), place);
        let travel = Travel {
            action: Name::new("go"),
            at: Name::new("at"),
            inside: Name::new("in"),
            place_of: [place("floor", 0), place("sink", 1), place("fridge", 2)].into(),
            elsewhere: 0,
            steps: vec![vec![0, 3, 4], vec![3, 0, 6], vec![4, 6, 0]],
        };
        let state = facts(&[
            &["at", "r1", "floor"],
            &["at", "r2", "floor"],
            &["at", "r2", "sink"],
            &["at", "r2", "cup"],
            &["in", "cup", "sink"],
            &["in", "egg", "bowl"],
            &["in", "bowl", "fridge"],
        ]);
        let time = |act: &[&str]| travel.duration(&state, &GroundAct::new(act[0], act[1..].iter().copied()));
        assert_eq!(time(&["go", "r1", "sink"]), Some(3.0));
        assert_eq!(time(&["go", "r1", "egg"]), Some(4.0), "the egg is in a bowl in the fridge");
        assert_eq!(time(&["go", "r2", "fridge"]), Some(6.0));
        assert_eq!(time(&["go", "r2", "cup"]), Some(1.0), "it stands there: no time but the action's own");
        assert_eq!(time(&["take", "r2", "cup"]), None, "not an action of going");
    }
}

//! One robot's PDDL problem, written from the state of the world (the paper's Problem Generator).
//!
//! `:init` always comes from the world, never from a language model.

use std::collections::BTreeSet;

use lamma_pddl::Name;
use lamma_pddl::ast::{Condition, GroundAtom, Init, Problem};

use crate::team::Team;

/// The problem of `member` alone: it is the only one that acts, so its team mates and all facts about
/// them are left out.
pub fn member_problem(team: &Team, member: usize, facts: &BTreeSet<GroundAtom>, goal: &Condition) -> Problem {
    let me = &team.members[member];
    let others = |name: &Name| *name != me.name && team.member(name).is_some();
    Problem {
        name: Name::new(format!("for-{}", me.name)),
        domain: me.domain.name.clone(),
        objects: team.objects.iter().filter(|o| !others(&o.name)).cloned().collect(),
        init: facts
            .iter()
            .filter(|f| !team.mentions_other(f, Some(&me.name)))
            .map(|f| Init::Fact(f.clone()))
            .collect(),
        goal: goal.clone(),
        metric: None,
    }
}

/// The problem of the whole team as one actor; `skills` are the facts of [`Team::joint`].
pub fn joint_problem(
    team: &Team,
    facts: &BTreeSet<GroundAtom>,
    skills: &[GroundAtom],
    goal: &Condition,
) -> Problem {
    Problem {
        name: Name::new("for-the-team"),
        domain: team.domain.name.clone(),
        objects: team.objects.clone(),
        init: facts
            .iter()
            .chain(skills)
            .map(|f| Init::Fact(f.clone()))
            .chain(team.numbers.iter().cloned())
            .collect(),
        goal: goal.clone(),
        metric: None,
    }
}

//! How soon a team can be done where going takes its time.
//!
//! No action takes less than a step, so what bounds the makespan in unit steps bounds it here, too: with shorter
//! durations the same order is never done later. This adds what the ways say.

use std::collections::BTreeSet;

use lamma_pddl::ast::GroundAtom;
use lamma_planner::travel::Travel;
use lamma_planner::{FactId, OperatorId, Task};

use crate::team::Team;

/// Not reached.
const NEVER: u32 = u32::MAX;

/// The earliest time at which every fact of the goal can hold; `None` if one never can. This is h_max (Bonet &
/// Geffner, "Planning as heuristic search", AIJ 129, 2001) with a release time for each place: whoever stands there
/// has come all the way from where it was at the start, whatever it did in between.
pub(crate) fn travel_floor(
    task: &Task,
    travel: &Travel,
    team: &Team,
    facts: &BTreeSet<GroundAtom>,
) -> Option<u32> {
    let all = || (0..task.facts.len() as u32).map(FactId);
    let mut earliest: Vec<u32> =
        all().map(|fact| if task.holds(&task.init, fact) { 0 } else { NEVER }).collect();
    let release: Vec<u32> = all().map(|fact| arrival(task, fact, travel, team, facts)).collect();
    loop {
        let mut changed = false;
        for operator in (0..task.operators.len() as u32).map(OperatorId) {
            let start = latest(&earliest, task.preconditions(operator));
            if start == NEVER {
                continue;
            }
            let always = task.effects(operator).iter().map(|fact| (start, *fact));
            let sometimes = task
                .conditional_effects(operator)
                .map(|(condition, fact)| (start.max(latest(&earliest, condition)), fact));
            let reached: Vec<(u32, FactId)> = always.chain(sometimes).collect();
            for (start, fact) in reached.into_iter().filter(|(start, _)| *start != NEVER) {
                let end = (start + 1).max(release[fact.index()]);
                if end < earliest[fact.index()] {
                    earliest[fact.index()] = end;
                    changed = true;
                }
            }
        }
        if !changed {
            break;
        }
    }
    Some(latest(&earliest, &task.goal)).filter(|end| *end != NEVER)
}

fn latest(earliest: &[u32], facts: &[FactId]) -> u32 {
    facts.iter().map(|fact| earliest[fact.index()]).max().unwrap_or(0)
}

/// For a member standing at a place: the way there from its start. From elsewhere may be nearer: an agent that has
/// been left with nothing at hand counts as being there.
fn arrival(task: &Task, fact: FactId, travel: &Travel, team: &Team, facts: &BTreeSet<GroundAtom>) -> u32 {
    let Some(literal) = task.literal(fact).filter(|l| l.holds && l.atom.predicate == travel.at) else {
        return 0;
    };
    let [agent, thing] = literal.atom.args.as_slice() else { return 0 };
    match travel.place_of.get(thing) {
        Some(place) if team.member(agent).is_some() => {
            let start = travel.place_of_agent(facts, agent);
            travel.steps(start, *place).min(travel.steps(travel.elsewhere, *place))
        }
        _ => 0,
    }
}

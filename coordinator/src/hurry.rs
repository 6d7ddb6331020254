//! A plan that is done earlier where going takes its time.
//!
//! Robots plan with few steps in mind, not with short ways. Here the team's plan is changed a little again and again:
//! some consecutive steps of a robot are left out, done at another place of the order, or done by somebody else. A
//! change is kept if the plan still reaches the goal, on the plain semantics, and is done earlier (or as early with
//! less time on the way). What comes out is a plan that no such change makes better, or the best found within the
//! budget, which is counted in steps looked at, so that it is the same on every machine.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use lamma_pddl::Name;
use lamma_planner::GroundAct;
use lamma_planner::interpreter::{GroundAction, GroundCondition, Interpreter, WorldState};
use lamma_planner::partial_order::{PartialOrder, TeamStep, deorder_along};

/// The most steps that are moved together: going somewhere, taking something, and bringing it elsewhere through a door.
const LONGEST_BLOCK: usize = 6;

/// What is searched and where.
pub(crate) struct Hurry<'a> {
    pub interpreter: &'a Interpreter,
    pub initial: &'a WorldState,
    pub goal: &'a GroundCondition,
    /// The names of those who may act, with their index in the team.
    pub members: Vec<(usize, Name)>,
    /// How much may be tried, in steps that are looked at.
    pub budget: u64,
}

/// A step as it is changed: who, and what.
type Doing = (usize, GroundAct);

/// A plan with the states it passes.
struct Candidate {
    doings: Vec<Doing>,
    states: Vec<WorldState>,
    order: PartialOrder,
    score: (f64, f64),
}

impl Hurry<'_> {
    /// The best order found, with the state it leads to, starting from the best of these plans.
    pub fn run(&self, plans: &[Vec<TeamStep>], cancel: &AtomicBool) -> Option<(PartialOrder, WorldState)> {
        let mut known = BTreeMap::new();
        let of = |steps: &Vec<TeamStep>| steps.iter().map(|s| (s.agent, s.action.act.clone())).collect();
        let mut left = self.budget;
        let starts =
            plans.iter().filter_map(|steps| self.candidate(of(steps), None, 0, &mut left, &mut known));
        let mut best = starts.min_by(|a, b| order(a.score, b.score))?;
        while let Some(better) = self.improve(&best, &mut left, &mut known, cancel) {
            best = better;
        }
        let end = best.states.pop()?;
        Some((best.order, end))
    }

    /// The first change that makes the plan better.
    fn improve(
        &self,
        from: &Candidate,
        left: &mut u64,
        known: &mut BTreeMap<GroundAct, Option<Arc<GroundAction>>>,
        cancel: &AtomicBool,
    ) -> Option<Candidate> {
        for (start, end) in blocks(&from.doings) {
            let mut rest = from.doings.clone();
            let block: Vec<Doing> = rest.drain(start..end).collect();
            let mut changes: Vec<(usize, Vec<Doing>)> = vec![(start, rest.clone())];
            for at in 0..=rest.len() {
                for (member, name) in &self.members {
                    if at == start && *member == block[0].0 {
                        continue;
                    }
                    let moved = block.iter().map(|doing| by(doing, *member, name));
                    let mut doings = rest.clone();
                    doings.splice(at..at, moved);
                    changes.push((at.min(start), doings));
                }
            }
            for (first, doings) in changes {
                if *left == 0 || cancel.load(Ordering::Relaxed) {
                    return None;
                }
                let tried = self.candidate(doings, Some(from), first, left, known);
                if let Some(better) = tried.filter(|c| order(c.score, from.score).is_lt()) {
                    return Some(better);
                }
            }
        }
        None
    }

    /// The plan, if it is one and may be better than `like`, with which it has the steps before `first` in common.
    fn candidate(
        &self,
        doings: Vec<Doing>,
        like: Option<&Candidate>,
        first: usize,
        left: &mut u64,
        known: &mut BTreeMap<GroundAct, Option<Arc<GroundAction>>>,
    ) -> Option<Candidate> {
        let mut states = like.map_or_else(|| vec![self.initial.clone()], |l| l.states[..=first].to_vec());
        let mut steps: Vec<TeamStep> = Vec::with_capacity(doings.len());
        let mut busy: BTreeMap<usize, f64> = BTreeMap::new();
        for (index, (agent, act)) in doings.iter().enumerate() {
            let action = known
                .entry(act.clone())
                .or_insert_with(|| self.interpreter.instantiate(act).ok().map(Arc::new))
                .clone()?;
            // Nobody is done before the time of its own steps.
            *busy.entry(*agent).or_insert(0.0) += self.interpreter.duration(&states[index], &action).ok()?;
            if like.is_some_and(|like| busy[agent] > like.score.0) {
                return None;
            }
            if index + 1 >= states.len() {
                *left = left.saturating_sub(1);
                let mut next = states[index].clone();
                self.interpreter.apply(&mut next, &action).ok()?;
                states.push(next);
            }
            steps.push(TeamStep { agent: *agent, action });
        }
        if !self.interpreter.holds(states.last()?, self.goal) {
            return None;
        }
        // Explaining a plan looks at each pair of its steps.
        *left = left.saturating_sub((steps.len() * steps.len() / 4) as u64);
        let order = deorder_along(self.interpreter, states.clone(), steps, self.goal, &[], &[]).ok()?;
        let score = (order.makespan(), order.durations.iter().sum());
        Some(Candidate { doings, states, order, score })
    }
}

fn order(a: (f64, f64), b: (f64, f64)) -> std::cmp::Ordering {
    a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
}

/// Consecutive steps of one robot, the longest first: an errand is better moved whole.
fn blocks(doings: &[Doing]) -> Vec<(usize, usize)> {
    let mut blocks = Vec::new();
    for length in (1..=LONGEST_BLOCK.min(doings.len())).rev() {
        for start in 0..=doings.len() - length {
            let agent = doings[start].0;
            if doings[start..start + length].iter().all(|(a, _)| *a == agent) {
                blocks.push((start, start + length));
            }
        }
    }
    blocks
}

/// The same done by somebody else.
fn by((_, act): &Doing, member: usize, name: &Name) -> Doing {
    let mut act = act.clone();
    if let Some(actor) = act.args.first_mut() {
        *actor = name.clone();
    }
    (member, act)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::sync::Arc;

    use lamma_pddl::ast::{GroundAtom, TypedName};
    use lamma_pddl::{Source, parse_condition, parse_domain};
    use lamma_planner::travel::Travel;

    use super::*;
    use crate::bound::makespan_lower_bound;
    use crate::team::{Member, Team};

    const DOMAIN: &str = "(define (domain street) (:requirements :adl) (:types robot house)
      (:predicates (at ?r - robot ?h - house) (in ?a ?b - object) (swept ?h - house))
      (:action go :parameters (?r - robot ?h - house) :precondition (and)
        :effect (and (forall (?o - house) (not (at ?r ?o))) (at ?r ?h)))
      (:action sweep :parameters (?r - robot ?h - house) :precondition (at ?r ?h) :effect (swept ?h)))";

    /// A street with houses two steps apart, and robots at its first.
    fn street(robots: &[&str]) -> (Team, BTreeSet<GroundAtom>) {
        let domain = Arc::new(parse_domain(&Source::new("street", DOMAIN)).unwrap().value);
        let houses = ["home", "a", "b", "c"];
        let place = |house: usize| (Name::new(houses[house]), house);
        let steps = |from: usize| (0..4).map(|to| 2 * from.abs_diff(to) as u32).collect();
        let travel = Travel {
            action: Name::new("go"),
            at: Name::new("at"),
            inside: Name::new("in"),
            place_of: (0..4).map(place).collect(),
            elsewhere: 0,
            steps: (0..4).map(steps).collect(),
        };
        let member = |name: &&str| Member { name: Name::new(name), domain: domain.clone() };
        let objects = robots.iter().map(|r| TypedName::new(*r, "robot"));
        let team = Team {
            members: robots.iter().map(member).collect(),
            objects: objects.chain(houses.iter().map(|h| TypedName::new(*h, "house"))).collect(),
            domain: domain.clone(),
            relaxations: Vec::new(),
            numbers: Vec::new(),
            skill_facts: Default::default(),
            travel: Some(Arc::new(travel)),
        };
        let facts = robots.iter().map(|r| GroundAtom::new("at", [*r, "home"])).collect();
        (team, facts)
    }

    /// The time the team needs when it starts from a plan in which the first robot goes to and fro, and the bound.
    fn hurried(robots: &[&str]) -> (f64, u32) {
        let (team, facts) = street(robots);
        let interpreter = team.interpreter().unwrap();
        let goal = parse_condition("(and (swept a) (swept b) (swept c))").unwrap();
        let ground = interpreter.ground_condition(&goal).unwrap();
        let initial = WorldState { facts: facts.clone(), values: Default::default() };
        let step = |house: &&str| {
            ["go", "sweep"].map(|action| {
                let action = interpreter.instantiate(&GroundAct::new(action, [robots[0], house])).unwrap();
                TeamStep { agent: 0, action: Arc::new(action) }
            })
        };
        let steps: Vec<TeamStep> = ["c", "a", "b"].iter().flat_map(step).collect();
        let members = (0..robots.len()).map(|m| (m, Name::new(robots[m]))).collect();
        let (interpreter, initial) = (&interpreter, &initial);
        let hurry = Hurry { interpreter, initial, goal: &ground, members, budget: 100_000 };
        let (order, end) = hurry.run(&[steps], &AtomicBool::new(false)).unwrap();
        assert!(interpreter.holds(&end, &ground));
        let available: Vec<usize> = (0..robots.len()).collect();
        (order.makespan(), makespan_lower_bound(&team, &available, &facts, &goal).unwrap())
    }

    #[test]
    fn errands_are_done_on_the_way_and_shared() {
        // Alone: 6 steps to the last house, and three to sweep.
        assert_eq!(hurried(&["r1"]), (9.0, 7));
        // One goes straight to the last house, the other does the rest meanwhile. No team is faster.
        assert_eq!(hurried(&["r1", "r2"]), (7.0, 7));
    }
}

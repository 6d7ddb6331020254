//! Proving a goal out of reach on a part of the task: what cannot be done even if all but a few variables did not
//! matter cannot be done at all (a projection; Culberson & Schaeffer, "Pattern databases", 1998, used as a proof of
//! unsolvability).
//!
//! The variables of the goal come first, then one after the other of those that operators ask for which change one of
//! these: two things in one hand, a door that must be shut and open. What is not kept may be anything.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use crate::task::{FactId, OperatorId, Task};

/// Steps that may be tried in abstract states, for each choice of variables: some hundredths of a second.
const WORK: usize = 1_000_000;

/// Choices of variables that are tried.
const TRIES: usize = 12;

/// Outcomes of an operator in an abstract state; where there may be more, nothing is proved.
const OUTCOMES: usize = 16;

/// How deep conditions on derived facts are followed.
const DEPTH: usize = 4;

/// Whether the goal is proved to be out of reach on some part of the task.
pub(super) fn is_out_of_reach(task: &Task) -> bool {
    if task.has_numbers() {
        return false;
    }
    let mut kept = goal_variables(task);
    let mut unhelpful = BTreeSet::new();
    let mut newest = None;
    for _ in 0..TRIES {
        match Projection::new(task, &kept).reaches_goal(WORK) {
            Some(false) => return true,
            Some(true) => {}
            None => {
                // Too much to look at with the newest one.
                let Some(newest) = newest else { return false };
                kept.remove(&newest);
                unhelpful.insert(newest);
            }
        }
        let Some((variable, distance)) = most_asked_for(task, &kept, &unhelpful) else { return false };
        kept.insert(variable, distance);
        newest = Some(variable);
    }
    false
}

/// The variables that parts of the goal, or the rules that derive them, speak of: at distance zero.
fn goal_variables(task: &Task) -> BTreeMap<u32, u32> {
    let mut found = BTreeMap::new();
    let mut open = task.goal.clone();
    let mut seen: BTreeSet<FactId> = open.iter().copied().collect();
    while let Some(fact) = open.pop() {
        let variable = task.facts[fact.index()].variable;
        if (variable as usize) < task.primary_variables {
            found.insert(variable, 0);
            continue;
        }
        let bodies = task.axioms.iter().filter(|axiom| axiom.head == fact);
        let needed = bodies.flat_map(|axiom| task.axiom_bodies.row(axiom.body as usize));
        open.extend(needed.copied().filter(|&fact| seen.insert(fact)));
    }
    found
}

/// Of the variables next to the goal the one that most operators ask for which change a kept one, and its distance.
fn most_asked_for(task: &Task, kept: &BTreeMap<u32, u32>, unhelpful: &BTreeSet<u32>) -> Option<(u32, u32)> {
    let variable = |fact: &FactId| task.facts[fact.index()].variable;
    let is_new =
        |v: &u32| (*v as usize) < task.primary_variables && !kept.contains_key(v) && !unhelpful.contains(v);
    let mut asked: BTreeMap<u32, (u32, u32)> = BTreeMap::new();
    for operator in (0..task.operators.len() as u32).map(OperatorId) {
        let mut asks: BTreeSet<u32> = BTreeSet::new();
        let mut nearest = task.effects(operator).iter().filter_map(|fact| kept.get(&variable(fact))).min();
        for (condition, fact) in task.conditional_effects(operator) {
            if let Some(distance) = kept.get(&variable(&fact)) {
                nearest = nearest.into_iter().chain([distance]).min();
                asks.extend(condition.iter().map(variable));
            }
        }
        let Some(nearest) = nearest else { continue };
        asks.extend(task.preconditions(operator).iter().map(variable));
        for v in asks.into_iter().filter(is_new) {
            let (distance, count) = asked.entry(v).or_insert((nearest + 1, 0));
            if *distance > nearest + 1 {
                (*distance, *count) = (nearest + 1, 0);
            }
            *count += u32::from(*distance == nearest + 1);
        }
    }
    // Of several the smallest, then the first.
    let rank = |v: u32, distance: u32, count: u32| {
        (distance, std::cmp::Reverse(count), task.variables[v as usize].size, v)
    };
    let best = asked.iter().min_by_key(|&(&v, &(distance, count))| rank(v, distance, count));
    best.map(|(&v, &(distance, _))| (v, distance))
}

/// An operator as the projection sees it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct Step {
    /// Kept variables and the values they must have.
    needs: Vec<(usize, u32)>,
    /// Kept variables that take a value for sure.
    sets: Vec<(usize, u32)>,
    may_set: Vec<Conditional>,
}

/// A kept variable that takes a value on a condition.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct Conditional {
    needs: Vec<(usize, u32)>,
    /// Whether that is all it hangs on.
    whole: bool,
    sets: (usize, u32),
}

struct Projection<'a> {
    task: &'a Task,
    kept: Vec<u32>,
    steps: Vec<Step>,
    /// Values of which at most one is ever taken.
    exclusive: Vec<Vec<(usize, u32)>>,
}

impl<'a> Projection<'a> {
    fn new(task: &'a Task, kept: &BTreeMap<u32, u32>) -> Self {
        let kept = kept.keys().copied().collect();
        let mut projection = Projection { task, kept, steps: Vec::new(), exclusive: Vec::new() };
        let places = |facts: &[FactId]| facts.iter().filter_map(|&fact| projection.place(fact)).collect();
        let groups: Vec<Vec<(usize, u32)>> = task.exclusive.rows().map(places).collect();
        let of_several = |group: &Vec<(usize, u32)>| group.iter().any(|place| place.0 != group[0].0);
        projection.exclusive = groups.into_iter().filter(of_several).collect();
        let operators = (0..task.operators.len() as u32).map(OperatorId);
        let steps: BTreeSet<Step> = operators.filter_map(|operator| projection.step(operator)).collect();
        projection.steps = steps.into_iter().collect();
        projection
    }

    /// The kept variable and the value that a fact is about.
    fn place(&self, fact: FactId) -> Option<(usize, u32)> {
        let variable = self.task.facts[fact.index()].variable;
        let at = self.kept.binary_search(&variable).ok()?;
        Some((at, fact.0 - self.task.variables[variable as usize].first.0))
    }

    /// `None` if it changes nothing that is kept.
    fn step(&self, operator: OperatorId) -> Option<Step> {
        let task = self.task;
        let places = |facts: &[FactId]| facts.iter().filter_map(|&fact| self.place(fact)).collect::<Vec<_>>();
        let conditional = task.conditional_effects(operator).filter_map(|(condition, fact)| {
            let needs = places(condition);
            Some(Conditional { whole: needs.len() == condition.len(), needs, sets: self.place(fact)? })
        });
        let step = Step {
            needs: places(task.preconditions(operator)),
            sets: places(task.effects(operator)),
            may_set: conditional.collect(),
        };
        (!step.sets.is_empty() || !step.may_set.is_empty()).then_some(step)
    }

    /// `None` if there is too much to look at.
    fn reaches_goal(&self, mut work: usize) -> Option<bool> {
        let start: Vec<u32> = self
            .kept
            .iter()
            .map(|&v| {
                let variable = &self.task.variables[v as usize];
                variable.fact(&self.task.init).0 - variable.first.0
            })
            .collect();
        let mut seen = HashSet::from([start.clone()]);
        let mut open = vec![start];
        while let Some(state) = open.pop() {
            if self.task.goal.iter().all(|&fact| self.may_hold(&state, fact, DEPTH)) {
                return Some(true);
            }
            for step in &self.steps {
                if step.needs.iter().all(|&(at, value)| state[at] == value) {
                    for next in outcomes(&state, step)? {
                        if self.is_possible(&next) && seen.insert(next.clone()) {
                            open.push(next);
                        }
                    }
                }
            }
            work = work.checked_sub(self.steps.len() + 1)?;
        }
        Some(false)
    }

    fn is_possible(&self, state: &[u32]) -> bool {
        let taken =
            |group: &Vec<(usize, u32)>| group.iter().filter(|&&(at, value)| state[at] == value).count();
        self.exclusive.iter().all(|group| taken(group) < 2)
    }

    /// Whether the fact holds in some state that looks like this.
    fn may_hold(&self, state: &[u32], fact: FactId, depth: usize) -> bool {
        if let Some((at, value)) = self.place(fact) {
            return state[at] == value;
        }
        let variable = self.task.facts[fact.index()].variable as usize;
        let mut bodies = self.task.axioms.iter().filter(|axiom| axiom.head == fact).peekable();
        // That a derived fact does not hold, comparisons of numbers, what is not kept: it may be so.
        if variable < self.task.primary_variables || depth == 0 || bodies.peek().is_none() {
            return true;
        }
        bodies.any(|axiom| {
            let body = self.task.axiom_bodies.row(axiom.body as usize);
            body.iter().all(|&fact| self.may_hold(state, fact, depth - 1))
        })
    }
}

/// The states that a step may lead to; `None` if there are too many.
fn outcomes(state: &[u32], step: &Step) -> Option<Vec<Vec<u32>>> {
    let mut values: Vec<Vec<u32>> = state.iter().map(|&value| vec![value]).collect();
    let mut sure = vec![false; state.len()];
    let may_happen = |effect: &&Conditional| effect.needs.iter().all(|&(at, value)| state[at] == value);
    let conditional: Vec<&Conditional> = step.may_set.iter().filter(may_happen).collect();
    let certain = conditional.iter().filter(|effect| effect.whole).map(|effect| &effect.sets);
    for &(at, value) in step.sets.iter().chain(certain) {
        // Of several values that are set for sure any may be the last.
        if !std::mem::replace(&mut sure[at], true) {
            values[at].clear();
        }
        values[at].push(value);
    }
    conditional.iter().for_each(|effect| values[effect.sets.0].push(effect.sets.1));
    let mut states = vec![Vec::with_capacity(state.len())];
    for mut choices in values {
        choices.sort_unstable();
        choices.dedup();
        if states.len() * choices.len() > OUTCOMES {
            return None;
        }
        let longer = |state: Vec<u32>| {
            choices.iter().map(move |&value| [state.as_slice(), &[value]].concat()).collect::<Vec<_>>()
        };
        states = states.into_iter().flat_map(longer).collect();
    }
    Some(states)
}

//! The Task Allocator: which robot does which sub-task, for the smallest makespan.
//!
//! Every robot bids for every sub-task with a plan of its own (so a bid is a proof of ability, skills and
//! capacity included); the assignment with the smallest estimated makespan wins, then the least total work,
//! then roster order. What nobody can do alone is split at the facts the robots hand over, and every robot
//! bids for the parts; later sub-tasks profit from what such a part opens up.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::AtomicBool;

use lamma_pddl::ast::Condition;
use lamma_planner::interpreter::{Interpreter, WorldState};
use lamma_planner::{GroundAct, Limits, Outcome, Plan, SearchOptions, plan_with};

use crate::allocation::{AllocateInput, Allocation, AllocationRule, Cut, NoAllocation, PackageSpec};
use crate::assign::{Work, assign};
use crate::bound::JointTask;
use crate::combine::world_state;
use crate::parts::{condition_from, independent_parts};
use crate::problem::member_problem;
use crate::reason::{Obstacles, why_infeasible, with_causes};
use crate::split::{segments, team_plan};
use crate::understand::Subgoal;

/// States estimated to make a bid shorter; about what robots spend on the plan itself.
const IMPROVEMENT: u64 = 600;

/// A sub-task, or a part of one between two hand-overs, with everybody's bids.
#[derive(Debug)]
struct Item {
    subgoal: usize,
    goal: Condition,
    /// Items it starts after, by hand-over or because it was asked for.
    after: Vec<usize>,
    /// Those it was asked to follow.
    asked: Vec<usize>,
    /// A plan per member that can do it alone.
    bids: BTreeMap<usize, Bid>,
    /// The member that the team's plan chose, and what that plan has it do.
    fallback: Option<(usize, Bid)>,
    /// Whether it brings the sub-task's goal about, and not only what others need.
    finishing: bool,
}

/// What a member would do, and how long that takes it.
#[derive(Debug)]
struct Bid {
    acts: Vec<GroundAct>,
    time: u64,
}

impl Item {
    /// A plan for it, to see where it leads.
    fn example(&self) -> &[GroundAct] {
        let shortest = self.bids.values().min_by_key(|bid| bid.time);
        shortest.or(self.fallback.as_ref().map(|(_, bid)| bid)).map_or(&[], |bid| &bid.acts)
    }
}

/// Allocates. Deterministic; the same input gives the same packages.
pub fn allocate(input: &AllocateInput, cancel: &AtomicBool) -> Result<Allocation, NoAllocation> {
    let interpreter = input.team.interpreter().map_err(|e| NoAllocation::GaveUp(e.to_string()))?;
    let mut allocator = Allocator { input, interpreter, items: Vec::new(), cancel };
    // What is out of reach is not bid for: the team's own way says why.
    let joint = JointTask::new(&input.team, &input.available, &input.facts, &input.final_goal);
    let floor = joint.map_or(Some(0), |joint| joint.floor_of(&input.team, &input.facts));
    if input.cut == Cut::Team || floor.is_none() {
        allocator.take_all_as_team()?;
    } else {
        for subgoal in 0..input.subgoals.len() {
            allocator.take(subgoal)?;
        }
    }
    let work: Vec<Work> = allocator.items.iter().map(work).collect();
    let members = assign(&work);
    let packages = packages(&allocator.items, &members);
    Ok(Allocation { packages, lower_bound: f64::from(floor.unwrap_or(0)) })
}

fn work(item: &Item) -> Work {
    let fallback = item.fallback.iter().map(|(member, bid)| (*member, bid.time));
    let bids = item.bids.iter().map(|(member, bid)| (*member, bid.time));
    // A bid of the member's own replaces the team's plan for it.
    Work { after: item.after.clone(), cost: fallback.chain(bids).collect() }
}

struct Allocator<'a> {
    input: &'a AllocateInput,
    interpreter: Interpreter,
    items: Vec<Item>,
    cancel: &'a AtomicBool,
}

impl Allocator<'_> {
    /// Makes a sub-task into items: its independent parts may go to different robots.
    fn take(&mut self, index: usize) -> Result<(), NoAllocation> {
        let subgoal = &self.input.subgoals[index];
        let infeasible = |e: String| NoAllocation::Infeasible(format!("\"{}\": {e}", subgoal.text));
        let ground =
            self.interpreter.ground_condition(&subgoal.goal).map_err(|e| infeasible(e.to_string()))?;
        let asked = self.asked(index);
        let state = self.state_after(&asked);
        let parts =
            if self.input.cut == Cut::Parts { independent_parts(&ground) } else { vec![ground.clone()] };
        for part in parts {
            if !subgoal.after.is_empty() || !self.interpreter.holds(&state, &part) {
                self.take_part(index, condition_from(&part), &asked, &state)?;
            }
        }
        Ok(())
    }

    /// The items that finish the sub-tasks which this one was asked to follow. One that needed nothing to be
    /// done stands for those it was to follow itself.
    fn asked(&self, index: usize) -> Vec<usize> {
        let mut asked = BTreeSet::new();
        let mut queue = self.input.subgoals[index].after.clone();
        while let Some(subgoal) = queue.pop() {
            let own: Vec<usize> =
                (0..self.items.len()).filter(|&i| self.items[i].subgoal == subgoal).collect();
            if own.is_empty() {
                queue.extend(&self.input.subgoals[subgoal].after);
            }
            asked.extend(own.into_iter().filter(|&i| self.items[i].finishing));
        }
        asked.into_iter().collect()
    }

    /// Every sub-task in turn, from where the ones before it lead, and without undoing them. Before that,
    /// what is out of reach from the start is proved to be so.
    fn take_all_as_team(&mut self) -> Result<(), NoAllocation> {
        let start = world_state(&self.input.facts);
        let lasting = self.input.subgoals.iter().filter(|s| s.lasting).map(|s| s.goal.clone());
        let everything = Condition::And(lasting.collect());
        for index in 0..self.input.subgoals.len() {
            let alone = self.plan_as_team(index, &self.input.subgoals[index].goal, &start, true, None);
            if let Err(proof @ NoAllocation::Infeasible(_)) = alone {
                return Err(proof);
            }
        }
        if self.is_out_of_reach(&everything, &start) {
            return Err(NoAllocation::Infeasible(self.excluding(&start)));
        }
        let mut kept: Vec<Condition> = Vec::new();
        for index in 0..self.input.subgoals.len() {
            let subgoal = &self.input.subgoals[index];
            let before: Vec<usize> = (0..self.items.len()).collect();
            let state = self.state_after(&before);
            self.split(index, &subgoal.goal, &before, &state, None, &kept)?;
            if subgoal.lasting {
                kept.push(subgoal.goal.clone());
            }
        }
        Ok(())
    }

    /// Which sub-tasks, each possible by itself, exclude each other: a smallest set, by leaving out one after the
    /// other.
    fn excluding(&self, start: &WorldState) -> String {
        let subgoals = &self.input.subgoals;
        let mut rest: Vec<usize> = (0..subgoals.len()).filter(|&s| subgoals[s].lasting).collect();
        let mut i = 0;
        while i < rest.len() {
            let one = rest.remove(i);
            let goal = Condition::And(rest.iter().map(|&s| subgoals[s].goal.clone()).collect());
            if !self.is_out_of_reach(&goal, start) {
                rest.insert(i, one);
                i += 1;
            }
        }
        let texts: Vec<String> = rest.iter().map(|&s| format!("\"{}\"", subgoals[s].text)).collect();
        let together = Condition::And(rest.iter().map(|&s| subgoals[s].goal.clone()).collect());
        let obstacles = Obstacles { team: &self.input.team, available: &self.input.available };
        let why = why_infeasible(obstacles, &start.facts, &together, &self.limits(), self.cancel);
        let why = why.map_or(String::new(), |why| format!(": {why}"));
        format!(
            "each sub-task is possible, but not all of them together: {} exclude each other{why}",
            texts.join(" and ")
        )
    }

    fn take_part(
        &mut self,
        index: usize,
        goal: Condition,
        asked: &[usize],
        state: &WorldState,
    ) -> Result<(), NoAllocation> {
        let (bids, gave_up) = self.bids(index, &goal, state);
        if !bids.is_empty() {
            self.push(index, goal, asked.to_vec(), asked.to_vec(), bids);
            return Ok(());
        }
        // What others were found to need may be all that is missing here, too.
        let opened: Vec<usize> = (0..self.items.len()).filter(|&i| !self.items[i].finishing).collect();
        let after = union(asked, &opened);
        if !opened.is_empty() {
            let (bids, _) = self.bids(index, &goal, &self.state_after(&after));
            if !bids.is_empty() {
                self.push(index, goal, after, asked.to_vec(), bids);
                return Ok(());
            }
        }
        self.split(index, &goal, asked, state, gave_up, &[])
    }

    fn push(
        &mut self,
        subgoal: usize,
        goal: Condition,
        after: Vec<usize>,
        asked: Vec<usize>,
        bids: BTreeMap<usize, Bid>,
    ) {
        self.items.push(Item { subgoal, goal, after, asked, bids, fallback: None, finishing: true });
    }

    /// The state once these items, and all before them, are done.
    fn state_after(&self, items: &[usize]) -> WorldState {
        let mut all = BTreeSet::new();
        let mut queue = items.to_vec();
        while let Some(i) = queue.pop() {
            if all.insert(i) {
                queue.extend(&self.items[i].after);
            }
        }
        let mut state = world_state(&self.input.facts);
        for act in all.into_iter().flat_map(|i| self.items[i].example()) {
            if let Ok(action) = self.interpreter.instantiate(act) {
                // A step that two items share fails the second time; what it achieves holds.
                let _ = self.interpreter.apply(&mut state, &action);
            }
        }
        state
    }

    /// The acts with the time they take from that state on.
    fn bid(&self, state: &WorldState, acts: Vec<GroundAct>) -> Bid {
        if self.input.team.travel.is_none() {
            return Bid { time: acts.len() as u64, acts };
        }
        let mut state = state.clone();
        let mut time = 0.0;
        for act in &acts {
            if let Ok(action) = self.interpreter.instantiate(act) {
                time += self.interpreter.duration(&state, &action).unwrap_or(1.0);
                // Steps of others between them may be missing here.
                let _ = self.interpreter.apply(&mut state, &action);
            }
        }
        Bid { acts, time: time as u64 }
    }

    /// Who may be given a sub-task.
    fn candidates(&self, subgoal: usize) -> Vec<usize> {
        let advice = &self.input.subgoals[subgoal].advice;
        let named = |&m: &usize| advice.iter().any(|name| self.input.team.members[m].name == name.as_str());
        let everybody = self.input.rule == AllocationRule::Shortest || advice.is_empty();
        self.input.available.iter().copied().filter(|m| everybody || named(m)).collect()
    }

    fn limits(&self) -> Limits {
        Limits { expansions: Some(self.input.expansions), ..Limits::default() }
    }

    /// A plan of every member that can do it alone, and why somebody gave up, if one did.
    fn bids(
        &self,
        subgoal: usize,
        goal: &Condition,
        state: &WorldState,
    ) -> (BTreeMap<usize, Bid>, Option<String>) {
        let team = &self.input.team;
        let options = SearchOptions { improvement: Some(IMPROVEMENT), ..SearchOptions::default() };
        let mut bids = BTreeMap::new();
        let mut gave_up = None;
        for member in self.candidates(subgoal) {
            if self.input.excluded.contains(&(subgoal, member)) {
                continue;
            }
            let problem = member_problem(team, member, &state.facts, goal);
            match plan_with(&team.members[member].domain, &problem, &options, &self.limits(), self.cancel) {
                Ok(Outcome::Found(plan)) => {
                    bids.insert(member, self.bid(state, plan.acts));
                }
                Ok(Outcome::Unsolvable(_)) => {}
                Ok(Outcome::GaveUp(why)) => gave_up = Some(why.to_string()),
                Err(error) => gave_up = Some(error.to_string()),
            }
        }
        (bids, gave_up)
    }

    /// What nobody can do alone becomes an item for each part between two hand-overs. What is in `kept`
    /// still holds at the end.
    fn split(
        &mut self,
        index: usize,
        goal: &Condition,
        asked: &[usize],
        state: &WorldState,
        gave_up: Option<String>,
        kept: &[Condition],
    ) -> Result<(), NoAllocation> {
        let all = Condition::And(std::iter::once(goal).chain(kept).cloned().collect());
        let plan = self.plan_as_team(index, &all, state, asked.is_empty(), gave_up)?;
        let team = &self.input.team;
        let segments =
            segments(team, &self.interpreter, &state.facts, &all, &plan).map_err(NoAllocation::GaveUp)?;
        let base = self.items.len();
        for segment in segments {
            let handed: Vec<usize> = segment.after.iter().map(|k| base + k).collect();
            let after = union(asked, &handed);
            let before = self.state_after(&after);
            let bids = if self.input.cut == Cut::Team {
                BTreeMap::new()
            } else {
                self.bids(index, &segment.goal, &before).0
            };
            self.items.push(Item {
                subgoal: index,
                goal: segment.goal,
                after,
                asked: asked.to_vec(),
                bids,
                fallback: Some((segment.member, self.bid(&before, segment.acts))),
                finishing: segment.finishing,
            });
        }
        Ok(())
    }

    /// Whether it is proved that all together cannot do it from there.
    fn is_out_of_reach(&self, goal: &Condition, state: &WorldState) -> bool {
        let (team, available) = (&self.input.team, &self.input.available);
        let outcome = team_plan(team, available, &state.facts, &[], goal, &self.limits(), self.cancel);
        matches!(outcome, Ok(Outcome::Unsolvable(_)))
    }

    fn plan_as_team(
        &self,
        index: usize,
        goal: &Condition,
        state: &WorldState,
        from_start: bool,
        gave_up: Option<String>,
    ) -> Result<Plan, NoAllocation> {
        let (team, available, limits) = (&self.input.team, &self.candidates(index), self.limits());
        let advised = available.len() < self.input.available.len();
        match team_plan(team, available, &state.facts, &[], goal, &limits, self.cancel) {
            Ok(Outcome::Found(plan)) => Ok(plan),
            Ok(Outcome::Unsolvable(_)) if advised => {
                let Subgoal { text, advice, .. } = &self.input.subgoals[index];
                let text = format!("\"{text}\" was given to {}, and they cannot do it", advice.join(" and "));
                Err(NoAllocation::GaveUp(text))
            }
            Ok(Outcome::Unsolvable(reason)) => {
                let obstacles = Obstacles { team, available };
                let why = why_infeasible(obstacles, &state.facts, goal, &limits, self.cancel)
                    .unwrap_or_else(|| with_causes(obstacles, &state.facts, goal, &reason));
                let text = &self.input.subgoals[index].text;
                let text = format!("nobody of the team can do \"{text}\": {why}");
                // From a state that other plans led to, it is no proof.
                Err(if from_start { NoAllocation::Infeasible(text) } else { NoAllocation::NotThisWay(text) })
            }
            Ok(Outcome::GaveUp(why)) => Err(NoAllocation::GaveUp(gave_up.unwrap_or(why.to_string()))),
            Err(why) => Err(NoAllocation::GaveUp(why)),
        }
    }
}

/// Items of one robot that follow the same others are planned together, so that its planner can do two
/// errands on one way.
fn packages(items: &[Item], members: &[usize]) -> Vec<PackageSpec> {
    let mut packages: Vec<PackageSpec> = Vec::new();
    let mut package_of: Vec<usize> = Vec::with_capacity(items.len());
    for (item, &member) in items.iter().zip(members) {
        let mapped = |list: &[usize]| union(&list.iter().map(|&i| package_of[i]).collect::<Vec<_>>(), &[]);
        let (after, asked) = (mapped(&item.after), mapped(&item.asked));
        let own: Vec<usize> = (0..packages.len()).filter(|&p| packages[p].member == member).collect();
        let joins = own.last().copied().filter(|&p| {
            // The robot's own earlier packages come before it in any case.
            let others: Vec<usize> = packages[p].after.iter().copied().filter(|a| !own.contains(a)).collect();
            let mine: Vec<usize> = after.iter().copied().filter(|a| !own.contains(a)).collect();
            others == mine && packages[p].asked_after == asked && !after.contains(&p)
        });
        if let Some(p) = joins {
            let package = &mut packages[p];
            package.subgoals.push(item.subgoal);
            package.fallback = None;
            let old = std::mem::replace(&mut package.goal, Condition::TRUE);
            package.goal = Condition::And(vec![old, item.goal.clone()]);
            package_of.push(p);
            continue;
        }
        package_of.push(packages.len());
        let fallback = item.fallback.as_ref().filter(|(owner, _)| *owner == member);
        packages.push(PackageSpec {
            member,
            goal: item.goal.clone(),
            subgoals: vec![item.subgoal],
            after: union(&after, &own),
            asked_after: asked,
            fallback: fallback.map(|(_, bid)| bid.acts.clone()),
        });
    }
    packages
}

fn union(a: &[usize], b: &[usize]) -> Vec<usize> {
    a.iter().chain(b).copied().collect::<BTreeSet<_>>().into_iter().collect()
}

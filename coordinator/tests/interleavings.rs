//! What the gates promise: however the robots' steps interleave, as long as the gates allow it, every step is
//! possible and the same goal is reached. Tried in full on teams' plans for made-up tasks of real scenes, and for
//! things that only several robots together can lift.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on says so by panicking")]

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use lamma_coordinator::AllocationRule;
use lamma_coordinator::allocate::allocate;
use lamma_coordinator::allocation::{AllocateInput, Cut, NoAllocation};
use lamma_coordinator::combine::{TeamPlan, combine, ground_act, world_state};
use lamma_coordinator::decompose::given;
use lamma_coordinator::house::team;
use lamma_coordinator::merge::Merger;
use lamma_coordinator::problem::member_problem;
use lamma_coordinator::shorten::{Shorten, Wanted, shorten};
use lamma_domains::{generate, tasks::Task};
use lamma_planner::interpreter::{GroundCondition, Interpreter, WorldState};
use lamma_planner::{Limits, MakespanLimits, Outcome, SearchOptions, plan_with};

/// Of one plan, so many ways to be underway are looked at; generated tasks have fewer.
const WAYS: usize = 20_000;

/// A team's plan for a task.
struct Planned {
    interpreter: Interpreter,
    initial: WorldState,
    goal: GroundCondition,
    /// As merged from the robots' own plans, and as made anew by the scheduler.
    plans: Vec<TeamPlan>,
}

/// Plans as a run does, with every robot's planning in this process. `None` where the team cannot do it.
fn planned(task: &Task) -> Option<Planned> {
    let never = AtomicBool::new(false);
    let (world, _) = task.world(0).unwrap();
    let understanding = given(&world, &task.goal).unwrap();
    let team = Arc::new(team(&world));
    let interpreter = Interpreter::new(&team.domain, &team.objects).unwrap();
    let final_goal = understanding.final_goal();
    let goal = interpreter.ground_condition(&final_goal).unwrap();
    let mut input = AllocateInput {
        cut: Cut::default(),
        rule: AllocationRule::Shortest,
        team: team.clone(),
        available: (0..team.members.len()).collect(),
        facts: world.facts().cloned().collect(),
        final_goal: final_goal.clone(),
        subgoals: understanding.subgoals.clone(),
        excluded: Default::default(),
        expansions: 2_000,
    };
    loop {
        let allocation = match allocate(&input, &never) {
            Ok(allocation) => Some(allocation),
            Err(NoAllocation::Infeasible(_)) => return None,
            Err(NoAllocation::NotThisWay(_) | NoAllocation::GaveUp(_)) => None,
        };
        let merged = allocation.and_then(|allocation| {
            let mut merger = Merger::new(world_state(&input.facts));
            for (index, package) in allocation.packages.iter().enumerate() {
                let problem = member_problem(&team, package.member, &merger.state.facts, &package.goal);
                let domain = &team.members[package.member].domain;
                let own = match plan_with(
                    domain,
                    &problem,
                    &SearchOptions::default(),
                    &Limits::default(),
                    &never,
                ) {
                    Ok(Outcome::Found(plan)) => Some(plan.acts),
                    _ => None,
                };
                let whole = package.fallback.clone().filter(|_| input.cut == Cut::Team);
                let acts = whole.or(own).or(package.fallback.clone())?;
                let goal = interpreter.ground_condition(&package.goal).unwrap();
                merger.merge(&interpreter, index, package.member, &acts, &goal).ok()?;
            }
            interpreter.holds(&merger.state, &goal).then_some((allocation, merger))
        });
        let Some((allocation, merger)) = merged else {
            input.cut = input.cut.coarser()?;
            continue;
        };
        let plan = combine(&team, &interpreter, &merger, &allocation.packages, &final_goal, &never).unwrap();
        let wanted = understanding.subgoals.iter();
        let how = Shorten {
            available: input.available.clone(),
            bound: allocation.lower_bound,
            wanted: Some(wanted.map(|s| Wanted { goal: s.goal.clone(), after: s.after.clone() }).collect()),
            limits: MakespanLimits { conflicts: 1_000, size: 400_000, ..MakespanLimits::default() },
        };
        let shorter = shorten(&team, &interpreter, &merger, plan.clone(), &final_goal, &how, &never);
        assert!(shorter.plan.makespan <= plan.makespan && shorter.bound <= shorter.plan.makespan);
        let initial = merger.initial.clone();
        return Some(Planned { interpreter, initial, goal, plans: vec![plan, shorter.plan] });
    }
}

/// Every way the steps can interleave: by how far everybody is, the states that the world can be in.
fn interleave(planned: &Planned, plan: &TeamPlan) -> Result<usize, String> {
    let Planned { interpreter, initial, goal, .. } = planned;
    let actions: Vec<Vec<_>> = plan
        .steps
        .iter()
        .map(|own| own.iter().map(|s| interpreter.instantiate(&ground_act(&s.act)).unwrap()).collect())
        .collect();
    let members = plan.steps.len();
    let mut seen: BTreeMap<Vec<usize>, Vec<WorldState>> = BTreeMap::new();
    let mut open = vec![(vec![0usize; members], initial.clone())];
    while let Some((done, state)) = open.pop() {
        let states = seen.entry(done.clone()).or_default();
        if states.contains(&state) {
            continue;
        }
        states.push(state.clone());
        let mut stuck = true;
        for member in 0..members {
            let Some(step) = plan.steps[member].get(done[member]) else { continue };
            if step.gates.iter().any(|gate| done[gate.agent.index()] < gate.step.index()) {
                continue;
            }
            stuck = false;
            let (mut after, mut further) = (state.clone(), done.clone());
            interpreter
                .apply(&mut after, &actions[member][done[member]])
                .map_err(|violation| format!("{} after {done:?}: {violation}", step.act))?;
            further[member] += 1;
            open.push((further, after));
        }
        let finished = done.iter().zip(&plan.steps).all(|(done, own)| *done == own.len());
        if stuck && !finished {
            return Err(format!("everybody waits after {done:?}"));
        }
        if finished && !interpreter.holds(&state, goal) {
            return Err(format!("the goal does not hold at some end: {goal}"));
        }
    }
    Ok(seen.values().map(Vec::len).sum())
}

fn check(task: &Task) -> bool {
    let Some(planned) = planned(task) else { return false };
    for plan in &planned.plans {
        let ways: usize = plan.steps.iter().map(|own| own.len() + 1).product();
        assert!(ways < WAYS, "{}: {ways} ways to be underway", task.id);
        let tried = interleave(&planned, plan);
        assert!(tried.is_ok(), "{}: {tried:?}\n{:#?}", task.id, plan.timeline);
    }
    true
}

#[test]
fn any_interleaving_of_a_generated_tasks_plan_reaches_the_goal() {
    let scenes = ["FloorPlan6", "FloorPlan201", "FloorPlan301", "FloorPlan401"];
    let tasks = scenes.iter().flat_map(|scene| generate::tasks(scene, 2, 11).unwrap());
    let done = tasks.filter(check).count();
    assert!(done >= 6, "only {done} tasks were planned for");
}

#[test]
fn any_interleaving_of_a_joint_lift_reaches_the_goal() {
    let robot = |name: &str, kg: f64| {
        format!(
            r#"{{"name": "{name}", "capacity_kg": {kg}, "hands": 1,
                "skills": ["GoToObject", "PickupObject", "PutObject", "OpenObject", "CloseObject"]}}"#
        )
    };
    let objects = r#"[{"type": "Mug", "count": 1, "in": "CounterTop", "is": {}},
        {"type": "Apple", "count": 1, "in": "CounterTop", "is": {}}]"#;
    for (kilos, goal) in [
        (vec![0.6, 0.6], r#"[{"object": "Sink", "contains": ["Mug"]}]"#),
        (vec![0.4, 0.4, 0.4], r#"[{"object": "Sink", "contains": ["Mug"]}]"#),
        (vec![0.6, 0.6], r#"[{"object": "Fridge", "contains": ["Mug", "Apple"]}]"#),
    ] {
        let team: Vec<String> =
            kilos.iter().enumerate().map(|(i, kg)| robot(&format!("r{}", i + 1), *kg)).collect();
        let text = format!(
            r#"{{"id": "lift {kilos:?}", "scene": "FloorPlan6", "instruction": "-", "team": [{}],
                "objects": {objects}, "goal": {goal}}}"#,
            team.join(", ")
        );
        let task: Task = serde_json::from_str(&text).unwrap();
        assert!(check(&task), "{}: no plan", task.id);
    }
}

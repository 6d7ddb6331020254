//! The task suite of the project: in the paper's proportions, not done at the start, and within the team's reach.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

use common::World;
use lamma_domains::generate;
use lamma_domains::robots;
use lamma_domains::tasks::{self, Task};
use lamma_domains::world::{WorldSetup, setup_with};
use lamma_domains::{Goal, condition};
use lamma_pddl::ast::Problem;
use lamma_planner::{Limits, Outcome, SearchOptions, ground, solve};

fn suite() -> Vec<Task> {
    tasks::read(include_str!("../tasks/mat-thor.jsonl")).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn the_suite_has_the_papers_proportions_and_scenes() {
    let mut categories: BTreeMap<String, usize> = BTreeMap::new();
    let mut scenes: BTreeMap<String, usize> = BTreeMap::new();
    for task in suite() {
        *categories.entry(task.category).or_default() += 1;
        *scenes.entry(task.scene).or_default() += 1;
        assert!((2..=4).contains(&task.team.len()), "{}: two to four robots", task.id);
    }
    let wanted = [("complex", 20), ("compound", 30), ("vague", 20)];
    assert_eq!(categories, BTreeMap::from(wanted.map(|(c, n)| (c.to_string(), n))));
    for plan in [6, 15, 21, 201, 209, 303, 414] {
        assert!(scenes.contains_key(&format!("FloorPlan{plan}")), "no task in FloorPlan{plan}");
    }
}

#[test]
fn no_fact_of_a_goal_but_a_door_or_a_switch_holds_at_the_start() {
    for task in suite() {
        let (setup, goal) = task.world(0).unwrap();
        let world = World::of(setup);
        assert!(!world.holds(&goal.condition()), "{}: done before it begins", task.id);
        for fact in goal.facts().filter(|f| world.holds(&f.condition)) {
            let left_so = ["is closed", "is off"].iter().any(|end| fact.text.ends_with(end));
            assert!(left_so, "{}: `{}` holds at the start", task.id, fact.text);
        }
    }
}

#[test]
fn every_goal_is_within_its_teams_reach_and_most_need_more_than_one_robot() {
    let mut together = 0;
    for task in suite() {
        let (setup, goal) = task.world(0).unwrap();
        assert!(plannable(&setup, &goal), "{}: the team cannot do it", task.id);
        let team = robots::team(&task.team).unwrap();
        let alone = team.iter().any(|robot| {
            let team = std::slice::from_ref(robot);
            let setup = setup_with(&task.scene, team, task.objects.as_deref(), 0, &task.rules).unwrap();
            let goal = condition(&task.goal, &setup).unwrap();
            plannable(&setup, &goal)
        });
        together += usize::from(!alone);
    }
    println!("{together} tasks need more than one robot");
    assert!(together >= 40, "only {together} tasks need more than one robot");
}

/// `lamma bench --tasks domains/tasks/mat-thor.jsonl --write-references` wrote them.
#[test]
fn every_task_has_a_reference_that_contradicts_nothing() {
    let mut tight = 0;
    for task in suite() {
        let reference = task.reference.unwrap_or_else(|| panic!("{}: no reference", task.id));
        let (makespan, bound) = (reference.makespan, reference.lower_bound);
        let robots = task.team.len() as u32;
        assert!(bound >= 1 && bound <= makespan, "{}: {reference:?}", task.id);
        let steps = reference.steps;
        assert!(makespan <= steps && steps <= makespan * robots, "{}: {reference:?}", task.id);
        tight += usize::from(bound == makespan);
    }
    println!("{tight} of 70 references are proved to be the shortest");
    assert!(tight >= 60, "only {tight} references are proved to be the shortest");
}

/// Two a scene, or as many as `GENERATED_TASKS` says.
#[test]
fn generated_tasks_of_every_scene_are_within_reach() {
    let count = std::env::var("GENERATED_TASKS").ok().and_then(|n| n.parse().ok()).unwrap_or(2);
    for scene in lamma_domains::scene::names() {
        for task in generate::tasks(&scene, count, 11).unwrap() {
            let (setup, goal) = task.world(0).unwrap_or_else(|e| panic!("{}: {e}", task.id));
            assert!(!task.goal.is_empty(), "{}: nothing to do", task.id);
            assert!(plannable(&setup, &goal), "{}: out of reach: {}", task.id, task.instruction);
        }
    }
    assert_eq!(generate::tasks("FloorPlan6", 5, 3).unwrap(), generate::tasks("FloorPlan6", 5, 3).unwrap());
}

/// Whether the robots of the world, each within its skills, can reach the goal.
fn plannable(setup: &WorldSetup, goal: &Goal) -> bool {
    let problem = Problem {
        name: "task".into(),
        domain: setup.domain.name.clone(),
        objects: setup.objects.clone(),
        init: setup.init.clone(),
        goal: goal.condition(),
        metric: None,
    };
    let task = ground(&setup.team_domain(), &problem, &Default::default()).unwrap_or_else(|e| panic!("{e}"));
    let limits = Limits { expansions: Some(200_000), ..Limits::default() };
    match solve(&task, &SearchOptions::default(), &limits, &AtomicBool::new(false)) {
        Outcome::Found(_) => true,
        Outcome::Unsolvable(_) => false,
        Outcome::GaveUp(why) => panic!("{}: gave up: {why:?}", setup.scene),
    }
}

//! Small worlds for the testbed.

use std::sync::Arc;

use lamma_coordinator::result::RunResult;
use lamma_coordinator::{
    AllocationRule, Coordinator, CoordinatorConfig, GoalGroup, GoalItem, Member, Method, Mission, Patience,
    ScoreGoal, Subgoal, Team, Understanding,
};
use lamma_pddl::ast::{Condition, Domain, Init, TypedName};
use lamma_pddl::{Name, Source, parse_condition, parse_domain, parse_ground_atom};
use lamma_planner::MakespanLimits;
use lamma_planner::interpreter::{Interpreter, WorldState};
use lamma_protocol::AgentId;
use lamma_robot::{Robot, RobotConfig};
use lamma_simulator::{AgentSpec, Arbiter, WorldConfig};

const MINI: &str = include_str!("../domains/mini.pddl");

/// A world, a team and a goal.
pub struct Scenario {
    /// The team.
    pub team: Arc<Team>,
    world: Domain,
    init: Vec<Init>,
    understanding: Understanding,
    interpreter: Interpreter,
    /// What never holds if the order that was asked for is kept.
    forbidden: Condition,
}

impl Scenario {
    /// Two things into a closed cupboard, then the light out. Nobody can do all of it: one opens, two
    /// carry, one switches.
    pub fn hand_over() -> Self {
        let robots: [(&str, &[&str]); 4] = [
            ("opener", &["Go", "Open"]),
            ("left", &["Go", "Pick", "Put"]),
            ("right", &["Go", "Pick", "Put"]),
            ("switcher", &["Go", "Darken"]),
        ];
        let objects = [
            ("apple", "item"),
            ("pear", "item"),
            ("table", "place"),
            ("cupboard", "door-place"),
            ("wall", "place"),
        ];
        let init = [
            "(in apple table)",
            "(in pear table)",
            "(open table)",
            "(open floor)",
            "(at opener wall)",
            "(at left wall)",
            "(at right table)",
            "(at switcher floor)",
            "(hand-free opener)",
            "(hand-free left)",
            "(hand-free right)",
            "(hand-free switcher)",
        ];
        let subgoals = [
            ("the apple into the cupboard", "(in apple cupboard)", vec![]),
            ("the pear into the cupboard", "(in pear cupboard)", vec![]),
            ("the light out", "(dark)", vec![0, 1]),
        ];
        let out_of_order = "(and (dark) (or (not (in apple cupboard)) (not (in pear cupboard))))";
        Scenario::build(&robots, &objects, &init, &subgoals, out_of_order)
    }

    /// One thing after the other, where the one in the middle needs nothing to be done: the order of the
    /// outer two must not get lost over it.
    pub fn chain() -> Self {
        let robots: [(&str, &[&str]); 2] =
            [("carrier", &["Go", "Open", "Pick", "Put"]), ("switcher", &["Go", "Darken"])];
        let objects = [("apple", "item"), ("table", "place"), ("cupboard", "door-place"), ("wall", "place")];
        let init = [
            "(in apple table)",
            "(open table)",
            "(open floor)",
            "(at carrier wall)",
            "(at switcher wall)",
            "(hand-free carrier)",
            "(hand-free switcher)",
        ];
        let subgoals = [
            ("the apple into the cupboard", "(in apple cupboard)", vec![]),
            ("a free hand", "(hand-free switcher)", vec![0]),
            ("the light out", "(dark)", vec![1]),
        ];
        Scenario::build(&robots, &objects, &init, &subgoals, "(and (dark) (not (in apple cupboard)))")
    }

    /// The order that was asked for is kept in this state.
    pub(crate) fn in_order(&self, state: &WorldState) -> bool {
        self.interpreter
            .ground_condition(&self.forbidden)
            .is_ok_and(|forbidden| !self.interpreter.holds(state, &forbidden))
    }

    fn build(
        robots: &[(&str, &[&str])],
        objects: &[(&str, &str)],
        init: &[&str],
        subgoals: &[(&str, &str, Vec<usize>)],
        forbidden: &str,
    ) -> Self {
        let world = parse_domain(&Source::new("mini.pddl", MINI)).expect("the domain parses").value;
        let project = |skills: &[&str]| {
            let mut domain = world.clone();
            domain.actions.retain(|a| skills.iter().any(|s| a.name == *s));
            domain
        };
        let objects: Vec<TypedName> = robots
            .iter()
            .map(|(name, _)| TypedName::new(*name, "robot"))
            .chain(objects.iter().map(|(name, kind)| TypedName::new(*name, *kind)))
            .collect();
        let members = robots
            .iter()
            .map(|(name, skills)| Member { name: Name::new(name), domain: Arc::new(project(skills)) });
        let all: Vec<&str> = robots.iter().flat_map(|(_, skills)| skills.iter().copied()).collect();
        let team = Arc::new(Team {
            members: members.collect(),
            domain: Arc::new(project(&all)),
            objects: objects.clone(),
            relaxations: Vec::new(),
            numbers: Vec::new(),
            skill_facts: Default::default(),
            travel: None,
        });
        let condition = |text: &str| parse_condition(text).expect("the goal parses");
        let group = |(text, goal, _): &(&str, &str, Vec<usize>)| GoalGroup {
            items: vec![GoalItem { text: (*text).into(), condition: condition(goal) }],
            joint: condition(goal),
        };
        let understanding = Understanding {
            subgoals: subgoals
                .iter()
                .enumerate()
                .map(|(i, (text, goal, after))| Subgoal {
                    id: format!("s{}", i + 1),
                    text: (*text).into(),
                    goal: condition(goal),
                    after: after.clone(),
                    lasting: true,
                    advice: Vec::new(),
                })
                .collect(),
            goal: ScoreGoal { groups: subgoals.iter().map(group).collect() },
            assumptions: Vec::new(),
            bans: Vec::new(),
        };
        let init = init.iter().map(|f| Init::Fact(parse_ground_atom(f).expect("the fact parses"))).collect();
        let interpreter = Interpreter::new(&world, &objects).expect("the domain makes sense");
        let forbidden = condition(forbidden);
        Scenario { team, world, init, understanding, interpreter, forbidden }
    }

    pub(crate) fn robot(&self, index: usize) -> Robot {
        Robot::new(RobotConfig {
            id: AgentId(index as u16),
            pid: 1000 + index as u32,
            domain: Ok(self.team.members[index].domain.clone()),
            expansions: 20_000,
            share: None,
        })
    }

    pub(crate) fn arbiter(&self) -> Arbiter {
        let agents = self.team.members.iter().map(|m| AgentSpec {
            name: m.name.clone(),
            skills: m.domain.actions.iter().map(|a| a.name.clone()).collect(),
        });
        Arbiter::new(WorldConfig {
            domain: self.world.clone(),
            objects: self.team.objects.clone(),
            init: self.init.clone(),
            agents: agents.collect(),
            on_lost: Some(Name::new("Lost")),
            step_ms: 0,
            events: Vec::new(),
            travel: None,
        })
        .expect("the world can be set up")
    }

    pub(crate) fn coordinator(&self) -> Coordinator {
        Coordinator::new(CoordinatorConfig {
            team: self.team.clone(),
            mission: Mission::Divide(Some(self.understanding.clone())),
            score: None,
            reference: None,
            method: Method::default(),
            rule: AllocationRule::Shortest,
            solve_only: false,
            expansions: 20_000,
            makespan: MakespanLimits::default(),
            time_limit_ms: 90_000,
            step_ms: 0,
            patience: Patience::default(),
        })
        .expect("the team makes sense")
    }

    pub(crate) fn goal_holds(&self, state: &WorldState) -> bool {
        self.interpreter
            .ground_condition(&self.understanding.goal.joint())
            .is_ok_and(|goal| self.interpreter.holds(state, &goal))
    }

    /// Whether the team without its lost members could still reach the goal: then "infeasible" is a lie.
    /// Judged by what the skills allow, not by a planner: opener, switcher and one carrier are needed.
    pub(crate) fn feasible_without(&self, result: &RunResult) -> bool {
        let lost = |name: &str| {
            result.faults.iter().any(|f| {
                f.text
                    .strip_prefix(name)
                    .is_some_and(|rest| rest.starts_with(" has died") || rest.starts_with(" does not answer"))
            })
        };
        let carriers_lost = lost("left") && lost("right");
        !(lost("opener") || lost("switcher") || carriers_lost)
    }
}

//! A world under the plain interpreter, in few words.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![allow(dead_code, reason = "each test file uses its part")]

use std::collections::BTreeMap;

use lamma_domains::robots::{Robot, SKILLS};
use lamma_domains::world::{ObjectSpec, Rules, WorldSetup, setup_with};
use lamma_pddl::ast::{Condition, GroundAtom};
use lamma_pddl::{parse_condition, parse_ground_atom};
use lamma_planner::{GroundAct, Interpreter, WorldState};

pub struct World {
    pub setup: WorldSetup,
    pub interpreter: Interpreter,
    pub state: WorldState,
}

pub fn robot(name: &str, capacity_kg: f64, hands: u8) -> Robot {
    Robot { name: name.into(), skills: SKILLS.map(String::from).to_vec(), capacity_kg, hands }
}

/// `r1`, `r2`, … that can do everything and lift 100 kg with one hand.
pub fn able(count: usize) -> Vec<Robot> {
    (1..=count).map(|i| robot(&format!("r{i}"), 100.0, 1)).collect()
}

pub fn specs(json: &str) -> Vec<ObjectSpec> {
    serde_json::from_str(json).unwrap()
}

impl World {
    pub fn new(scene: &str, team: &[Robot], objects: Option<&str>) -> Self {
        World::with(scene, team, objects, &Rules::default())
    }

    pub fn with(scene: &str, team: &[Robot], objects: Option<&str>, rules: &Rules) -> Self {
        let objects = objects.map(specs);
        let setup = setup_with(scene, team, objects.as_deref(), 1, rules).unwrap_or_else(|e| panic!("{e}"));
        World::of(setup)
    }

    pub fn of(setup: WorldSetup) -> Self {
        let interpreter = Interpreter::new(&setup.domain, &setup.objects).unwrap_or_else(|e| panic!("{e}"));
        let state = interpreter.initial(&setup.init).unwrap_or_else(|e| panic!("{e}"));
        World { setup, interpreter, state }
    }

    pub fn act(&mut self, act: &str) -> Result<(), String> {
        let mut words = act.split_whitespace();
        let act = GroundAct::new(words.next().unwrap(), words);
        let action = self.interpreter.instantiate(&act).map_err(|e| e.to_string())?;
        self.interpreter.apply(&mut self.state, &action).map(drop).map_err(|v| v.to_string())
    }

    /// Does the acts, one a line.
    pub fn run(&mut self, acts: &str) {
        for act in acts.lines().map(str::trim).filter(|l| !l.is_empty()) {
            self.act(act).unwrap_or_else(|why| panic!("{act}: {why}"));
        }
    }

    /// The act is refused, and the reason names this.
    pub fn refuses(&mut self, act: &str, because: &str) {
        let before = self.state.clone();
        match self.act(act) {
            Ok(()) => panic!("{act}: was done, though ({because}) should forbid it"),
            Err(why) => assert!(
                why.to_lowercase().contains(because),
                "{act}: refused, but not because of {because}: {why}"
            ),
        }
        assert!(self.state == before, "{act}: refused, but the world changed");
    }

    /// The crews by name, each with its robots.
    pub fn crews(&self) -> BTreeMap<String, Vec<String>> {
        let mut crews: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for fact in self.state.facts.iter().filter(|f| f.predicate == "in-crew") {
            crews.entry(fact.args[1].to_string()).or_default().push(fact.args[0].to_string());
        }
        crews
    }

    pub fn find_crew(&self, robots: &[&str]) -> Option<String> {
        self.crews().into_iter().find(|(_, members)| members == robots).map(|(name, _)| name)
    }

    /// `{before} {the crew of these robots} {after}`
    pub fn crew(&self, before: &str, robots: &[&str], after: &str) -> String {
        let crew =
            self.find_crew(robots).unwrap_or_else(|| panic!("no crew of {robots:?}: {:?}", self.crews()));
        format!("{before} {crew} {after}")
    }

    pub fn has(&self, fact: &str) -> bool {
        self.state.facts.contains(&atom(fact))
    }

    /// Checks facts; a leading `!` means that it does not hold.
    pub fn check(&self, facts: &[&str]) {
        for fact in facts {
            let (fact, wanted) = fact.strip_prefix('!').map_or((*fact, true), |f| (f, false));
            assert_eq!(self.has(fact), wanted, "{fact}");
        }
    }

    pub fn holds(&self, condition: &Condition) -> bool {
        let ground = self.interpreter.ground_condition(condition).unwrap_or_else(|e| panic!("{e}"));
        self.interpreter.holds(&self.state, &ground)
    }

    pub fn true_now(&self, condition: &str) -> bool {
        self.holds(&parse_condition(condition).unwrap_or_else(|r| panic!("{r}")))
    }
}

pub fn atom(text: &str) -> GroundAtom {
    parse_ground_atom(text).unwrap_or_else(|report| panic!("{report}"))
}

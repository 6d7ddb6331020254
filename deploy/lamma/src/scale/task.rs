//! The generated task: robots start anywhere in a yard, each plans its own way out of it and along a corridor,
//! and at every place of the corridor all meet.

use std::collections::BTreeSet;
use std::path::Path;

use lamma_pddl::ast::{Domain, GroundAtom, Init, TypedName};
use lamma_pddl::{Name, Source, check_domain, parse_domain};
use lamma_protocol::AgentId;
use lamma_simulator::{AgentSpec, WorldConfig};
use serde::{Deserialize, Serialize};

use crate::error::Failure;

/// The yard has this many places on each side.
const SIDE: u32 = 4;

/// The domain of every robot; each process reads and checks it for itself.
const DOMAIN: &str = "\
(define (domain rally)
  (:requirements :strips :typing)
  (:types robot place)
  (:predicates (at ?r - robot ?p - place) (way ?a ?b - place))
  (:action Move
    :parameters (?r - robot ?from ?to - place)
    :precondition (and (at ?r ?from) (way ?from ?to))
    :effect (and (not (at ?r ?from)) (at ?r ?to))))
";

/// The task of one run: everything follows from these numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Rally {
    /// The size of the team.
    pub agents: u16,
    /// How often all meet: the length of the corridor.
    pub rounds: u32,
    /// Where they start is drawn from it.
    pub seed: u64,
}

impl Rally {
    /// The first robot, which goes ahead: nobody follows it to a place of the corridor before it is there, and
    /// it leaves only when all have come.
    pub const LEAD: AgentId = AgentId(0);

    /// Writes the task and the robots' domain into the folder of the run.
    pub fn write(&self, folder: &Path) -> Result<(), Failure> {
        let write = |name: &str, text: String| {
            let path = folder.join(name);
            std::fs::write(&path, text).map_err(|e| Failure::io("write", &path, &e))
        };
        write("rally.json", serde_json::to_string(self).map_err(Failure::fault)?)?;
        write("rally.pddl", DOMAIN.to_owned())
    }

    /// Reads the task back.
    pub fn read(folder: &Path) -> Result<Rally, Failure> {
        let path = folder.join("rally.json");
        let text = std::fs::read_to_string(&path).map_err(|e| Failure::io("read", &path, &e))?;
        serde_json::from_str(&text).map_err(|e| Failure::fault(format!("{}: {e}", path.display())))
    }

    /// The robots' domain, as a robot finds it in the folder.
    pub fn domain(folder: &Path) -> Result<Domain, String> {
        let path = folder.join("rally.pddl");
        let text =
            std::fs::read_to_string(&path).map_err(|e| format!("cannot read {}: {e}", path.display()))?;
        let source = Source::new(path.display().to_string(), text);
        let domain = parse_domain(&source).map_err(|report| report.to_string())?.value;
        let report = check_domain(&domain, &source);
        if report.has_errors() { Err(report.to_string()) } else { Ok(domain) }
    }

    /// What robot `agent` is called in the world.
    pub fn name(agent: AgentId) -> String {
        format!("r{}", agent.0)
    }

    /// The place in the corridor that round `round` ends at; round 0 is its mouth.
    fn meeting(round: u32) -> String {
        format!("w{round}")
    }

    /// Where a robot starts.
    fn start(&self, agent: AgentId) -> String {
        // SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014).
        let mut z = self.seed.wrapping_add(u64::from(agent.0) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let cell = (z ^ (z >> 31)) % u64::from(SIDE * SIDE);
        format!("y{cell}")
    }

    fn places(&self) -> Vec<String> {
        let yard = (0..SIDE * SIDE).map(|cell| format!("y{cell}"));
        yard.chain((0..=self.rounds).map(Rally::meeting)).collect()
    }

    /// From where to where one can go.
    fn ways(&self) -> Vec<(String, String)> {
        let cell = |x: u32, y: u32| format!("y{}", y * SIDE + x);
        let mut ways = Vec::new();
        for (x, y) in (0..SIDE).flat_map(|x| (0..SIDE).map(move |y| (x, y))) {
            for (nx, ny) in [(x + 1, y), (x, y + 1)].into_iter().filter(|(x, y)| *x < SIDE && *y < SIDE) {
                ways.push((cell(x, y), cell(nx, ny)));
                ways.push((cell(nx, ny), cell(x, y)));
            }
        }
        ways.push((cell(SIDE - 1, SIDE - 1), Rally::meeting(0)));
        ways.extend((0..self.rounds).map(|k| (Rally::meeting(k), Rally::meeting(k + 1))));
        ways
    }

    /// The problem of one robot, as PDDL text.
    pub fn problem(&self, agent: AgentId) -> String {
        let ways: String = self.ways().iter().map(|(a, b)| format!("(way {a} {b})")).collect();
        let (me, places) = (Rally::name(agent), self.places().join(" "));
        let (start, goal) = (self.start(agent), Rally::meeting(self.rounds));
        format!(
            "(define (problem for-{me}) (:domain rally)\n(:objects {me} - robot {places} - place)\n\
             (:init (at {me} {start}){ways})\n(:goal (at {me} {goal})))\n"
        )
    }

    /// The world of all robots.
    pub fn world(&self, domain: Domain) -> WorldConfig {
        let agents: Vec<AgentId> = (0..self.agents).map(AgentId).collect();
        let object = |name: String, kind: &str| TypedName {
            name: Name::new(name),
            types: vec![Name::new(kind)],
            private_to: None,
        };
        let robots = agents.iter().map(|a| object(Rally::name(*a), "robot"));
        let places = self.places().into_iter().map(|p| object(p, "place"));
        let at = agents.iter().map(|a| GroundAtom::new("at", [Rally::name(*a), self.start(*a)]));
        let ways = self.ways().into_iter().map(|(a, b)| GroundAtom::new("way", [a, b]));
        let skills: BTreeSet<Name> = domain.actions.iter().map(|a| a.name.clone()).collect();
        WorldConfig {
            domain,
            objects: robots.chain(places).collect(),
            init: at.chain(ways).map(Init::Fact).collect(),
            agents: agents
                .iter()
                .map(|a| AgentSpec { name: Name::new(Rally::name(*a)), skills: skills.clone() })
                .collect(),
            on_lost: None,
            step_ms: 0,
            events: Vec::new(),
            travel: None,
        }
    }

    /// Whether the plan's last step ends the last round.
    pub fn ends_in_the_corridor(&self, plan: &[lamma_protocol::message::Act]) -> bool {
        let last = plan.len().checked_sub(self.rounds as usize).and_then(|first| plan.get(first..));
        last.is_some_and(|acts| {
            let mut rounds = 1u32..;
            acts.iter().all(|a| rounds.next().is_some_and(|k| a.args.get(2) == Some(&Rally::meeting(k))))
        })
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;

    use lamma_protocol::PackageId;
    use lamma_protocol::message::{Package, PlanResult};
    use lamma_robot::RobotJob;

    use super::*;

    #[test]
    fn every_robot_finds_its_way_through_the_corridor() {
        let rally = Rally { agents: 40, rounds: 5, seed: 7 };
        let domain = parse_domain(&Source::new("rally.pddl", DOMAIN)).expect("the domain parses").value;
        let mut lengths = BTreeSet::new();
        for agent in (0..rally.agents).map(AgentId) {
            let package = Package { id: PackageId(0), problem: rally.problem(agent) };
            let job = RobotJob { package, domain: Arc::new(domain.clone()), expansions: 10_000 };
            let PlanResult::Found(plan) = job.run(&AtomicBool::new(false)).result else {
                panic!("{agent:?} has no plan")
            };
            assert!(rally.ends_in_the_corridor(&plan), "{plan:?}");
            assert!(!rally.ends_in_the_corridor(&plan[..plan.len() - 1]), "{plan:?}");
            lengths.insert(plan.len());
        }
        assert!(lengths.len() > 3, "robots start in different places: {lengths:?}");
    }
}

//! The machines of a run with what they need from the outside: files, a language model, a clock.
//!
//! Each `…_parts` builds a machine and its workers from the spec; whether they then run as a process over
//! shared memory or as a thread is the caller's affair.

pub mod bridge;
pub mod child;
pub mod join;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use lamma_bus::driver::Worker;
use lamma_coordinator::decompose::{decompose, given, score_goal};
use lamma_coordinator::{
    Coordinator, CoordinatorConfig, CoordinatorDone, CoordinatorJob, Member, Relaxation, Team, Understood,
};
use lamma_domains::robots::{SKILLS, actions_of};
use lamma_domains::world::WorldSetup;
use lamma_lm::LanguageModel;
use lamma_pddl::ast::{Domain, GroundAtom};
use lamma_pddl::{Name, Source, check_domain, parse_domain};
use lamma_protocol::AgentId;
use lamma_robot::{Robot, RobotConfig, RobotDone, RobotJob};
use lamma_simulator::{AgentSpec, Arbiter, WorldConfig};

use crate::error::Failure;
use crate::events;
use crate::spec::{EXPANSIONS, RunSpec, Task, domain_file};

/// A machine and the workers that do its long work.
pub struct Parts<M, Job, Done> {
    /// The machine.
    pub machine: M,
    /// Its workers.
    pub workers: Vec<Worker<Job, Done>>,
}

/// The robot: it reads its own domain, and nothing of the others.
pub fn robot_parts(
    spec: &RunSpec,
    folder: &Path,
    agent: AgentId,
) -> Result<Parts<Robot, RobotJob, RobotDone>, Failure> {
    let member = spec.team.get(agent.index()).ok_or_else(|| {
        Failure::bad_input(format!(
            "the team of this run has {} robots, not {}",
            spec.team.len(),
            agent.0 + 1
        ))
    })?;
    let machine = Robot::new(RobotConfig {
        id: agent,
        pid: std::process::id(),
        domain: own_domain(folder, &member.name).map(Arc::new),
        expansions: EXPANSIONS,
    });
    let work = |job: RobotJob, cancel: &AtomicBool| {
        let start = Instant::now();
        let mut done = job.run(cancel);
        done.elapsed_us = u64::try_from(start.elapsed().as_micros()).unwrap_or(u64::MAX);
        done
    };
    Ok(Parts { machine, workers: vec![Box::new(work)] })
}

fn own_domain(folder: &Path, name: &str) -> Result<Domain, String> {
    let path = domain_file(folder, name);
    let text = std::fs::read_to_string(&path).map_err(|e| format!("cannot read {}: {e}", path.display()))?;
    let source = Source::new(path.display().to_string(), text);
    let domain = parse_domain(&source).map_err(|report| report.to_string())?.value;
    let report = check_domain(&domain, &source);
    if report.has_errors() { Err(report.to_string()) } else { Ok(domain) }
}

/// The simulator.
pub fn arbiter_parts(spec: &RunSpec, world: &WorldSetup) -> Result<Parts<Arbiter, (), ()>, Failure> {
    let agents = world.members.iter().map(|m| AgentSpec {
        name: Name::new(&m.name),
        skills: m.domain.actions.iter().map(|a| a.name.clone()).collect(),
    });
    let mut script = spec.events.clone();
    script.extend(events::random(world, spec.random_events, spec.seed));
    let machine = Arbiter::new(WorldConfig {
        domain: world.domain.clone(),
        objects: world.objects.clone(),
        init: world.init.clone(),
        agents: agents.collect(),
        on_lost: world.on_lost.clone(),
        step_ms: spec.step_ms,
        events: events::resolve(&script, world)?,
    })
    .map_err(Failure::fault)?;
    Ok(Parts { machine, workers: Vec::new() })
}

/// The coordinator with its language model.
pub fn coordinator_parts(
    spec: &RunSpec,
    world: Arc<WorldSetup>,
) -> Result<Parts<Coordinator, CoordinatorJob, CoordinatorDone>, Failure> {
    let understanding = match &spec.task {
        Task::Goal(entries) => Some(given(&world, entries).map_err(Failure::bad_input)?),
        Task::Instruction { .. } => None,
    };
    let score = match &spec.score {
        Some(entries) => Some(score_goal(&world, entries).map_err(Failure::bad_input)?),
        None => None,
    };
    let machine = Coordinator::new(CoordinatorConfig {
        team: Arc::new(team(&world)),
        given: understanding,
        score,
        reference: spec.reference,
        solve_only: spec.solve_only,
        expansions: EXPANSIONS,
        time_limit_ms: spec.time_limit_ms,
        step_ms: spec.step_ms,
        patience: spec.patience,
    })
    .map_err(Failure::fault)?;
    let mut model = language_model(spec)?;
    let instruction = spec.instruction();
    let work = move |job: CoordinatorJob, cancel: &AtomicBool| {
        let understand = |facts, cancel: &AtomicBool| match &instruction {
            Some(instruction) => decompose(model.as_mut(), &world, &facts, instruction, cancel),
            None => Understood::Failed("this run has no instruction".into()),
        };
        job.run(understand, cancel)
    };
    Ok(Parts { machine, workers: vec![Box::new(work)] })
}

/// The language model of the run. Its key, if it needs one, comes from the environment alone.
pub fn language_model(spec: &RunSpec) -> Result<Box<dyn LanguageModel>, Failure> {
    let options = lamma_lm::Options {
        base_url: spec.lm.url.clone(),
        model: spec.lm.model.clone(),
        seed: spec.seed,
        lexicon: spec.lm.lexicon.clone(),
        ..lamma_lm::Options::default()
    };
    lamma_lm::from_spec(&spec.lm.spec, &options).map_err(Failure::bad_input)
}

/// The team as planning sees it.
pub fn team(world: &WorldSetup) -> Team {
    let members =
        world.members.iter().map(|m| Member { name: Name::new(&m.name), domain: Arc::new(m.domain.clone()) });
    Team {
        members: members.collect(),
        domain: Arc::new(world.team_domain()),
        objects: world.objects.clone(),
        relaxations: too_heavy(world),
        skill_facts: skill_facts(world),
    }
}

/// The world's own record of who has which skill, for every skill: `(has robot1 SliceObject)`.
fn skill_facts(world: &WorldSetup) -> BTreeMap<Name, Vec<GroundAtom>> {
    let mut facts: BTreeMap<Name, Vec<GroundAtom>> = BTreeMap::new();
    for skill in SKILLS {
        for action in actions_of([skill]) {
            let of = |m: &lamma_domains::world::Member| GroundAtom::new("has", [m.name.as_str(), skill]);
            facts.entry(Name::new(action)).or_default().extend(world.members.iter().map(of));
        }
    }
    // The world says what a member can lift only of those who can carry at all.
    for action in ["PickupObject", "PutObject"] {
        facts.entry(Name::new(action)).or_default().extend(liftable(world));
    }
    facts
}

/// `(can-lift robot thing)` as the capacities allow, whatever the skills.
fn liftable(world: &WorldSetup) -> Vec<GroundAtom> {
    let can = |m: &lamma_domains::world::Member, t: &lamma_domains::world::Thing| {
        t.can("pickupable") && t.mass_kg <= m.capacity_kg
    };
    let of = |m| {
        let things = world.things.iter().filter(move |t| can(m, t));
        things.map(move |t| GroundAtom::new("can-lift", [m.name.as_str(), t.name.as_str()]))
    };
    world.members.iter().flat_map(of).collect()
}

/// Things that nobody of the team can lift: obstacles with a name.
fn too_heavy(world: &WorldSetup) -> Vec<Relaxation> {
    let strongest = world.members.iter().map(|m| m.capacity_kg).fold(0.0, f64::max);
    world
        .things
        .iter()
        .filter(|t| t.can("pickupable") && t.mass_kg > strongest)
        .map(|t| Relaxation {
            reason: format!(
                "{} weighs {} kg and the strongest of the team lifts {strongest} kg",
                t.name, t.mass_kg
            ),
            facts: world
                .members
                .iter()
                .map(|m| GroundAtom::new("can-lift", [m.name.as_str(), t.name.as_str()]))
                .collect(),
        })
        .collect()
}

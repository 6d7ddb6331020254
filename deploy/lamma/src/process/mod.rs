//! The machines of a run with what they need from the outside: files, a language model, a clock.
//!
//! Each `…_parts` builds a machine and its workers from the spec; whether they then run as a process over
//! shared memory or as a thread is the caller's affair.

pub mod bridge;
pub mod child;
pub mod join;

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use lamma_bus::driver::Worker;
use lamma_coordinator::decompose::{decompose, given, score_goal};
use lamma_coordinator::house::team;
use lamma_coordinator::{Coordinator, CoordinatorConfig, CoordinatorDone, CoordinatorJob, Understood};
use lamma_domains::world::WorldSetup;
use lamma_lm::LanguageModel;
use lamma_pddl::ast::Domain;
use lamma_pddl::{Name, Source, check_domain, parse_domain};
use lamma_planner::MakespanLimits;
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
        makespan: makespan_limits(spec),
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

/// What may be spent on a shorter plan. Without a wish of the person's no clock is asked, so that the same input
/// gives the same plan on every machine.
fn makespan_limits(spec: &RunSpec) -> MakespanLimits {
    match spec.makespan_ms {
        None => MakespanLimits { conflicts: 1_000, size: 1_000_000, time: None },
        Some(ms) => {
            MakespanLimits { conflicts: u64::MAX, size: 50_000_000, time: Some(Duration::from_millis(ms)) }
        }
    }
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

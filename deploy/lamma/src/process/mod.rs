//! The machines of a run with what they need from the outside: files, a language model, a clock.
//!
//! Each `…_parts` builds a machine and its workers from the spec; whether they then run as a process over
//! shared memory or as a thread is the caller's affair.

pub mod bridge;
pub mod child;
pub mod join;

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use lamma_bus::driver::Worker;
use lamma_coordinator::decompose::{Instruction, decompose, given, score_goal, write};
use lamma_coordinator::house::{team, travel};
use lamma_coordinator::written::{NotWritten, WriteInput};
use lamma_coordinator::{
    AllocationRule, Author, Coordinator, CoordinatorConfig, CoordinatorDone, CoordinatorJob, Mission,
    ScoreGoal, Team, Understanding, Understood,
};
use lamma_domains::world::WorldSetup;
use lamma_lm::{LanguageModel, Script};
use lamma_pddl::ast::{Domain, GroundAtom};
use lamma_pddl::multi_agent::{Part, TeamTask};
use lamma_pddl::{Name, Source, check_domain, parse_domain};
use lamma_planner::MakespanLimits;
use lamma_protocol::AgentId;
use lamma_protocol::message::Share;
use lamma_robot::{Robot, RobotConfig, RobotDone, RobotJob};
use lamma_simulator::{AgentSpec, Arbiter, WorldConfig};

use crate::cli::AllocatorArg;
use crate::error::Failure;
use crate::events;
use crate::spec::{EXPANSIONS, LmSpec, RunSpec, Task, domain_file};
use crate::world::{AgentFiles, Privacy, World, WorldSource};

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
    let names = spec.source.names();
    let name = names.get(agent.index()).ok_or_else(|| {
        Failure::bad_input(format!("the team of this run has {} robots, not {}", names.len(), agent.0 + 1))
    })?;
    let (domain, share) = match &spec.source {
        WorldSource::Household(_) | WorldSource::Pddl(_) => (own_domain(folder, name), None),
        WorldSource::Factored(files) => own_files(&files.agents[agent.index()], files.privacy),
    };
    let machine = Robot::new(RobotConfig {
        id: agent,
        pid: std::process::id(),
        domain: domain.map(Arc::new),
        expansions: EXPANSIONS,
        share,
    });
    Ok(Parts { machine, workers: vec![planner()] })
}

/// What plans a robot's packages, and takes the time.
pub fn planner() -> Worker<RobotJob, RobotDone> {
    Box::new(|job: RobotJob, cancel: &AtomicBool| {
        let start = Instant::now();
        let mut done = job.run(cancel);
        done.elapsed_us = u64::try_from(start.elapsed().as_micros()).unwrap_or(u64::MAX);
        done
    })
}

/// What an agent of a factored task has: its own two files. Of them it shares what its privacy allows.
fn own_files(files: &AgentFiles, privacy: Privacy) -> (Result<Domain, String>, Option<Share>) {
    let shared = |part: &Part| match privacy {
        Privacy::Trusted => files.text(),
        Privacy::Strict => Ok((part.domain.to_string(), part.problem().to_string())),
    };
    let both = files.part_for(privacy).and_then(|part| Ok((shared(&part)?, part.domain)));
    match both {
        Ok(((domain, problem), own)) => (Ok(own), Some(Share { domain, problem })),
        Err(failure) => (Err(failure.text), None),
    }
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
pub fn arbiter_parts(spec: &RunSpec, world: &World) -> Result<Parts<Arbiter, (), ()>, Failure> {
    let config = match world {
        World::Household(world) => household_world(spec, world)?,
        World::Team(task) => task_world(spec, task),
    };
    let machine = Arbiter::new(config).map_err(Failure::fault)?;
    Ok(Parts { machine, workers: Vec::new() })
}

fn household_world(spec: &RunSpec, world: &WorldSetup) -> Result<WorldConfig, Failure> {
    let mut script = spec.events.clone();
    script.extend(events::random(world, spec.random_events, spec.seed));
    let agents = world.members.iter().map(|m| AgentSpec {
        name: Name::new(&m.name),
        skills: m.domain.actions.iter().map(|a| a.name.clone()).collect(),
    });
    Ok(WorldConfig {
        domain: world.domain.clone(),
        objects: world.objects.clone(),
        init: world.init.clone(),
        agents: agents.collect(),
        on_lost: world.on_lost.clone(),
        step_ms: spec.step_ms,
        events: events::resolve(&script, world)?,
        travel: travel(world).map(Arc::new),
    })
}

fn task_world(spec: &RunSpec, task: &TeamTask) -> WorldConfig {
    let agents = task
        .agents
        .iter()
        .map(|agent| AgentSpec { name: agent.name.clone(), skills: agent.actions.iter().cloned().collect() });
    WorldConfig {
        domain: task.domain.clone(),
        objects: task.objects.clone(),
        init: task.init.clone(),
        agents: agents.collect(),
        // PDDL says nothing about what an agent lets go of.
        on_lost: None,
        step_ms: spec.step_ms,
        events: Vec::new(),
        travel: None,
    }
}

/// What the coordinator is there for, who acts, and what the outcome is judged by.
struct Briefing {
    team: Team,
    mission: Mission,
    score: Option<ScoreGoal>,
    /// For the language model.
    household: Option<Arc<World>>,
}

/// `world` is asked for only by a coordinator that may see it.
fn briefing(
    spec: &RunSpec,
    world: impl FnOnce() -> Result<Arc<World>, Failure>,
) -> Result<Briefing, Failure> {
    match &spec.source {
        WorldSource::Household(household) => {
            let world = world()?;
            let World::Household(setup) = &*world else {
                return Err(Failure::fault("a household's world is no PDDL task"));
            };
            let given = match &household.task {
                Task::Goal(entries) => Some(given(setup, entries).map_err(Failure::bad_input)?),
                Task::Instruction { .. } => None,
            };
            let score = household.score.as_ref().map(|entries| score_goal(setup, entries));
            Ok(Briefing {
                team: team(setup),
                mission: Mission::Divide(given),
                score: score.transpose().map_err(Failure::bad_input)?,
                household: Some(world.clone()),
            })
        }
        WorldSource::Pddl(_) => {
            let world = world()?;
            let World::Team(task) = &*world else {
                return Err(Failure::fault("a PDDL task's world is no household"));
            };
            let names: Vec<Name> = task.agents.iter().map(|agent| agent.name.clone()).collect();
            Ok(Briefing {
                team: Team::of_task(task, &names),
                mission: Mission::Joint(Understanding::of_goal(&task.goal)),
                score: None,
                household: None,
            })
        }
        WorldSource::Factored(_) => Ok(Briefing {
            team: Team::of_names(spec.source.names().into_iter().map(Name::new)),
            mission: Mission::JointAsTold,
            score: None,
            household: None,
        }),
    }
}

/// The coordinator with its language model.
pub fn coordinator_parts(
    spec: &RunSpec,
    world: impl FnOnce() -> Result<Arc<World>, Failure>,
) -> Result<Parts<Coordinator, CoordinatorJob, CoordinatorDone>, Failure> {
    let Briefing { team, mission, score, household } = briefing(spec, world)?;
    let machine = Coordinator::new(CoordinatorConfig {
        team: Arc::new(team),
        mission,
        score,
        reference: spec.reference,
        rule: match spec.allocator {
            AllocatorArg::Shortest => AllocationRule::Shortest,
            AllocatorArg::Lm => AllocationRule::AsAdvised,
        },
        method: spec.method,
        solve_only: spec.solve_only,
        expansions: EXPANSIONS,
        makespan: makespan_limits(spec, household.is_some()),
        time_limit_ms: spec.time_limit_ms,
        step_ms: spec.step_ms,
        patience: spec.patience,
    })
    .map_err(Failure::fault)?;
    // Who has nothing to read does not learn the words either.
    let reading = match spec.instruction() {
        Some(instruction) => Some((language_model(&spec.lm, spec.seed)?, instruction)),
        None => None,
    };
    let mut reader = Reader { reading, household };
    let work = move |job: CoordinatorJob, cancel: &AtomicBool| job.run(&mut reader, cancel);
    Ok(Parts { machine, workers: vec![Box::new(work)] })
}

/// Who asks the language model.
struct Reader {
    reading: Option<(Box<dyn LanguageModel>, Instruction)>,
    household: Option<Arc<World>>,
}

/// What is said where there is nothing to read.
const NO_INSTRUCTION: &str = "this run has no instruction";

impl Author for Reader {
    fn understand(&mut self, facts: BTreeSet<GroundAtom>, cancel: &AtomicBool) -> Understood {
        match (&mut self.reading, self.household.as_deref()) {
            (Some((model, instruction)), Some(World::Household(setup))) => {
                decompose(model.as_mut(), setup, &facts, instruction, cancel)
            }
            _ => Understood::Failed(NO_INSTRUCTION.into()),
        }
    }

    fn write(
        &mut self,
        input: &WriteInput,
        check: &dyn Fn(&Script) -> Vec<String>,
        cancel: &AtomicBool,
    ) -> Result<Script, NotWritten> {
        match (&mut self.reading, self.household.as_deref()) {
            (Some((model, instruction)), Some(World::Household(setup))) => {
                write(model.as_mut(), setup, input, instruction, check, cancel)
            }
            _ => Err(NotWritten::Failed(NO_INSTRUCTION.into())),
        }
    }
}

/// What may be spent on a shorter plan. Without a wish of the person's no clock is asked, so that the same input
/// gives the same plan on every machine. A household's formulas are small, and most are decided within this; it is two
/// or three seconds where they are not.
fn makespan_limits(spec: &RunSpec, household: bool) -> MakespanLimits {
    match spec.makespan_ms {
        None => MakespanLimits {
            conflicts: if household { 48_000 } else { 1_000 },
            size: 1_000_000,
            ..MakespanLimits::default()
        },
        Some(ms) => MakespanLimits {
            conflicts: u64::MAX,
            size: 50_000_000,
            work: u64::MAX,
            wide_work: u64::MAX,
            time: Some(Duration::from_millis(ms)),
        },
    }
}

/// The language model of the run. Its key, if it needs one, comes from the environment alone.
pub fn language_model(lm: &LmSpec, seed: u64) -> Result<Box<dyn LanguageModel>, Failure> {
    let defaults = lamma_lm::Options::default();
    let options = lamma_lm::Options {
        base_url: lm.url.clone(),
        model: lm.model.clone(),
        seed,
        lexicon: lm.lexicon.clone(),
        wording: lm.wording,
        fallback: !lm.alone,
        repairs: if lm.unchecked { 0 } else { defaults.repairs },
        ..defaults
    };
    lamma_lm::from_spec(&lm.spec, &options).map_err(Failure::bad_input)
}

//! A run, as it is written into its folder for the processes to find.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use lamma_bus::faulty::Plan;
use lamma_coordinator::decompose::Instruction;
use lamma_coordinator::{Method, Patience};
use lamma_domains::goal::GoalEntry;
use lamma_lm::Wording;
use serde::{Deserialize, Serialize};

use crate::cli::AllocatorArg;
use crate::error::Failure;
use crate::events::ScriptLine;
use crate::world::{World, WorldSource};

/// Everything the processes of a run need to know.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RunSpec {
    /// Names the run; unique on the host.
    pub id: String,
    /// Seed of everything drawn by chance.
    pub seed: u64,
    /// What it is about.
    pub source: WorldSource,
    /// Best known makespan and the robot-steps it needs.
    pub reference: Option<(f64, f64)>,
    /// Who decides which robot gets a sub-task.
    pub allocator: AllocatorArg,
    /// The way from the instruction to a plan.
    #[serde(default)]
    pub method: Method,
    /// Stop when the plan is combined.
    pub solve_only: bool,
    /// The language model.
    pub lm: LmSpec,
    /// What may be spent on a shorter plan and the proof of how short it can be, in milliseconds; a little if
    /// nothing is said.
    pub makespan_ms: Option<u64>,
    /// Give up after this many milliseconds.
    pub time_limit_ms: u64,
    /// How long a time step takes, in milliseconds.
    pub step_ms: u64,
    /// What happens without the team, by script.
    pub events: Vec<ScriptLine>,
    /// And so many events more, drawn by the seed.
    pub random_events: u32,
    /// How long the others are waited for.
    #[serde(default)]
    pub patience: Patience,
    /// Robots that live on other hosts, by the host's name.
    #[serde(default)]
    pub away: BTreeMap<String, Vec<u16>>,
    /// Faults that are injected into every process's bus, as `--fault-bus` takes them.
    #[serde(default)]
    pub fault_bus: Option<String>,
    /// Host the robots in so many processes instead of one each.
    #[serde(default)]
    pub workers: Option<u16>,
}

/// What is wanted.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Task {
    /// An instruction in plain English.
    Instruction {
        /// The sentence.
        text: String,
        /// Take the best reading instead of asking.
        assume: bool,
    },
    /// A goal, given directly.
    Goal(Vec<GoalEntry>),
}

/// Which language model, without its key.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct LmSpec {
    /// `offline`, `openai`, `record:FILE`, `replay:FILE`.
    pub spec: String,
    /// Base URL.
    pub url: Option<String>,
    /// Model name.
    pub model: Option<String>,
    /// A file that adds to the embedded lexicon.
    #[serde(default)]
    pub lexicon: Option<PathBuf>,
    /// What a chat model is told and asked for.
    #[serde(default)]
    pub wording: Wording,
    /// Its first answer is taken; none is sent back for repair.
    #[serde(default)]
    pub unchecked: bool,
    /// The embedded default does not step in for it.
    #[serde(default)]
    pub alone: bool,
}

impl LmSpec {
    /// Whether it is the embedded default as it comes.
    pub fn is_built_in(&self) -> bool {
        self.spec == "offline" && self.lexicon.is_none()
    }
}

/// The host of the coordinator and the simulator.
pub const HUB: &str = "hub";

/// Bound of one search in a robot or the coordinator, in expanded states.
pub const EXPANSIONS: u64 = 200_000;

impl RunSpec {
    /// The world of the run; the same for the same spec, in every process.
    pub fn world(&self) -> Result<World, Failure> {
        self.source.world(self.seed)
    }

    /// How many robots the team has.
    pub fn team_size(&self) -> u16 {
        u16::try_from(self.source.names().len()).unwrap_or(u16::MAX)
    }

    /// How many robots share a process.
    pub fn per_seat(&self) -> u16 {
        self.workers.map_or(1, |workers| self.team_size().div_ceil(workers.max(1)).max(1))
    }

    /// The instruction, if the task is one.
    pub fn instruction(&self) -> Option<Instruction> {
        let WorldSource::Household(household) = &self.source else { return None };
        match &household.task {
            Task::Instruction { text, assume } => Some(Instruction {
                text: text.clone(),
                assume: *assume,
                deadline: Duration::from_millis(self.time_limit_ms / 2),
            }),
            Task::Goal(_) => None,
        }
    }

    /// What is wrong with the bus by design.
    pub fn faults(&self) -> Result<Option<Plan>, Failure> {
        self.fault_bus.as_deref().map(str::parse).transpose().map_err(Failure::bad_input)
    }

    /// Writes the spec and each robot's own domain into the folder of the run.
    pub fn write(&self, folder: &Path, world: &World) -> Result<(), Failure> {
        let robots = folder.join("robots");
        fs::create_dir_all(&robots).map_err(|e| Failure::io("create", &robots, &e))?;
        let write =
            |path: PathBuf, text: String| fs::write(&path, text).map_err(|e| Failure::io("write", &path, &e));
        let json = serde_json::to_string_pretty(self).map_err(|e| Failure::fault(e.to_string()))?;
        write(folder.join("run.json"), json)?;
        match (&self.source, world) {
            (_, World::Household(setup)) => {
                for member in &setup.members {
                    write(domain_file(folder, &member.name), member.domain.to_string())?;
                }
            }
            // Each agent has its own files.
            (WorldSource::Factored(_), World::Team(_)) => {}
            (_, World::Team(task)) => {
                for agent in &task.agents {
                    write(domain_file(folder, agent.name.as_str()), task.domain_of(agent).to_string())?;
                }
            }
        }
        Ok(())
    }

    /// Reads the spec back.
    pub fn read(folder: &Path) -> Result<Arc<RunSpec>, Failure> {
        let path = folder.join("run.json");
        let text = fs::read_to_string(&path).map_err(|e| Failure::io("read", &path, &e))?;
        serde_json::from_str(&text)
            .map(Arc::new)
            .map_err(|e| Failure::fault(format!("{}: {e}", path.display())))
    }
}

/// Where a robot finds its own domain: the only file of the run that it reads beside the spec.
pub fn domain_file(folder: &Path, robot: &str) -> PathBuf {
    folder.join("robots").join(format!("{robot}.pddl"))
}

//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::method::{MethodArg, Without};
use crate::world::Privacy;

mod member;

pub use member::*;

/// Teams of robots that plan, act and survive.
#[derive(Debug, Parser)]
#[command(name = "lamma", version, about, max_term_width = 100, subcommand_required = true)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,

    /// More in the logs: -v for info, -vv for debug, -vvv for trace.
    #[arg(short, long, global = true, action = clap::ArgAction::Count)]
    pub verbose: u8,
}

/// The commands. Only the flags of the one asked for are built: a short `lamma plan` is mostly its start.
#[derive(Debug, Subcommand)]
#[command(defer = true)]
pub enum Command {
    /// Carry out an instruction with a team of robot processes.
    Run(RunArgs),
    /// Everything but execution: print the combined plan, its makespan and the lower bound.
    Solve(RunArgs),
    /// Plan one classical PDDL task and print the plan in the IPC format.
    Plan(PlanArgs),
    /// Check a plan against its task: 0 valid, 1 not, with the failing step and the missing fact.
    Validate(ValidateArgs),
    /// Run a suite of tasks and print the metric table.
    Bench(BenchArgs),
    /// Measure teams of growing size: start-up, memory, meetings of all, actions, and that nothing is left.
    Scale(ScaleArgs),
    /// Remove what crashed runs have left behind.
    Clean,
    /// Explain a diagnostic code, such as `pddl::unknown-predicate`.
    Explain {
        /// The code.
        code: String,
    },
    /// List scenes or robots.
    List {
        /// What to list.
        #[arg(value_enum, default_value = "scenes")]
        what: ListWhat,
    },
    /// Print a completion script for a shell.
    Completions {
        /// Which shell.
        shell: clap_complete::Shell,
    },
    /// Write the folder of a run, to be started by hand on several hosts.
    Prepare(PrepareArgs),
    /// One host's part of a prepared run whose team is spread over several hosts.
    Host(HostArgs),
    /// What carries between hosts (started by `lamma host`).
    #[command(hide = true)]
    Bridge(BridgeArgs),
    /// Make what a team of robots on several hosts needs to know each other: `lamma new --secure DIR`.
    New(NewArgs),
    /// A Zenoh router that the processes of a run on several hosts meet at.
    Router(RouterArgs),
    /// A robot process (`lamma run` starts them; by hand with --bus zenoh).
    Robot(ChildArgs),
    /// The coordinator process (`lamma run` starts it; by hand with --bus zenoh it prints the outcome).
    Coordinator(CoordinatorArgs),
    /// The simulator process (`lamma run` starts it; by hand with --bus zenoh).
    Simulator(ChildArgs),
    /// A process of `lamma scale`.
    #[command(hide = true)]
    Rally(RallyArgs),
}

impl Command {
    /// Whether the command has anything to log. Those that have not start faster without a logger.
    pub fn logs(&self) -> bool {
        !matches!(
            self,
            Command::Plan(_)
                | Command::Validate(_)
                | Command::Explain { .. }
                | Command::List { .. }
                | Command::Completions { .. }
        )
    }
}

/// See [`Command::List`].
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum ListWhat {
    /// The floor plans.
    Scenes,
    /// The robots of the catalogue, with skills and capacity.
    Robots,
}

/// What `run` and `solve` take.
#[derive(Debug, Args)]
pub struct RunArgs {
    /// The instruction, in plain English.
    #[arg(required_unless_present_any = ["pddl", "codmap"], conflicts_with_all = ["pddl", "codmap"])]
    pub instruction: Option<String>,
    /// The scene, such as FloorPlan6.
    #[arg(long, required_unless_present_any = ["pddl", "codmap"], conflicts_with_all = ["pddl", "codmap"])]
    pub scene: Option<String>,
    /// The robots, by their names in the catalogue, separated by commas.
    #[arg(
        long,
        value_delimiter = ',',
        required_unless_present_any = ["pddl", "codmap"],
        conflicts_with_all = ["pddl", "codmap"]
    )]
    pub team: Vec<String>,
    /// Instead of an instruction: a multi-agent PDDL task in one domain and one problem file. A classical task
    /// is a team of one.
    #[arg(long, num_args = 2, value_names = ["DOMAIN", "PROBLEM"])]
    pub pddl: Option<Vec<PathBuf>>,
    /// Instead of an instruction: a folder with domain-AGENT.pddl and problem-AGENT.pddl for each agent, who is
    /// given only its own two.
    #[arg(long, value_name = "DIR", conflicts_with = "pddl")]
    pub codmap: Option<PathBuf>,
    /// What leaves the agents of a factored task: all they know, for a coordinator they trust, or nothing with
    /// a private name.
    #[arg(long, value_enum, default_value = "trusted", requires = "codmap")]
    pub privacy: Privacy,
    /// Options shared with other commands.
    #[command(flatten)]
    pub common: CommonArgs,
}

/// Options of all commands that run teams.
#[derive(Clone, Debug, Args)]
pub struct CommonArgs {
    /// The transport between the processes; `inproc` runs the same machines in one process.
    #[arg(long, value_enum, default_value = "iceoryx2")]
    pub bus: BusArg,
    /// The language model: offline, openai, record:FILE or replay:FILE.
    #[arg(long, default_value = "offline")]
    pub lm: String,
    /// Base URL of the chat-completions endpoint, for `--lm openai` [env: OPENAI_BASE_URL].
    #[arg(long)]
    pub lm_url: Option<String>,
    /// Model name, for `--lm openai` [env: LAMMA_LM_MODEL].
    #[arg(long)]
    pub lm_model: Option<String>,
    /// A TOML file that adds words, verbs and situations to the embedded lexicon (domains/README.md).
    #[arg(long)]
    pub lexicon: Option<PathBuf>,
    /// Seed of everything that is placed or drawn by chance.
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Where logs and artefacts of the run go [default: .lamma/runs/<id>].
    #[arg(long)]
    pub run_dir: Option<PathBuf>,
    /// How to print the result.
    #[arg(long, value_enum, default_value = "text")]
    pub format: Format,
    /// Take the best reading of the instruction instead of asking.
    #[arg(long)]
    pub assume: bool,
    /// Who decides which robot gets a sub-task: the shortest makespan, or the language model where it names
    /// robots (to compare with).
    #[arg(long, value_enum, default_value = "shortest")]
    pub allocator: AllocatorArg,
    /// Give up after this many seconds.
    #[arg(long, default_value_t = 120.0, value_parser = seconds)]
    pub time_limit: f64,
    /// Spend up to so many seconds on a shorter plan and on the proof of how short it can be [default: a few
    /// tenths of a second].
    #[arg(long, value_parser = seconds)]
    pub makespan_limit: Option<f64>,
    /// Host the robots in so many processes instead of one each, for teams beyond what the host allows.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub workers: Option<u16>,
    /// How long the simulator takes for each action, in milliseconds: to watch, or to interfere.
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u64).range(..=60_000))]
    pub step_ms: u64,
    /// Going takes a step for each quarter of a metre on the way, instead of one step in all.
    #[arg(long)]
    pub travel: bool,
    /// A script of what happens without the team (JSON Lines): `{"robot": "robot1", "before_step": 3, "fail": true}`,
    /// or instead of `fail`: `"move": "Apple_1", "to": "DiningTable_1"`, or `"close": "Fridge_1"`.
    #[arg(long, value_name = "FILE")]
    pub events: Option<PathBuf>,
    /// Let so many such events happen, drawn by the seed.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(..=100))]
    pub random_events: u32,
    /// How long nobody may move before those who could are given up, in seconds.
    #[arg(long, default_value_t = 4.0, value_parser = seconds)]
    pub stall_limit: f64,
    /// How long everybody has to join, in seconds.
    #[arg(long, default_value_t = 15.0, value_parser = seconds)]
    pub join_limit: f64,
    /// Make the bus bad by design: loss=0.1,dup=0.1,reorder=0.1,corrupt=0.01,delay=20ms,partition=robot-1@2s+5s.
    #[arg(long, value_name = "FAULTS")]
    pub fault_bus: Option<lamma_bus::faulty::Plan>,
}

/// Who allocates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, serde::Serialize, serde::Deserialize)]
pub enum AllocatorArg {
    /// The allocator, for the shortest makespan.
    Shortest,
    /// The language model, taken as it is.
    Lm,
}

/// Transports.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BusArg {
    /// Shared memory between processes on one host.
    #[value(name = "iceoryx2")]
    Iceoryx2,
    /// One process, one thread per machine.
    Inproc,
    /// Zenoh, between hosts.
    Zenoh,
}

impl BusArg {
    /// As it is written on the command line.
    pub fn name(self) -> &'static str {
        match self {
            BusArg::Iceoryx2 => "iceoryx2",
            BusArg::Inproc => "inproc",
            BusArg::Zenoh => "zenoh",
        }
    }
}

/// Output formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For people.
    Text,
    /// One JSON object on standard output.
    Json,
}

/// See [`Command::Plan`].
#[derive(Debug, Args)]
pub struct PlanArgs {
    /// The domain file.
    pub domain: PathBuf,
    /// The problem file.
    pub problem: PathBuf,
    /// The search: auto, anytime (better and better plans until the limit or Ctrl-C), or a name the planner
    /// lists when it does not know one.
    #[arg(long, default_value = "auto")]
    pub search: String,
    /// Give up after this many seconds.
    #[arg(long, value_parser = seconds)]
    pub time_limit: Option<f64>,
    /// Give up above this much memory, in MiB.
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    pub memory_limit: Option<u32>,
    /// Write the plan to this file too; with `--search anytime` each better one when it is found.
    #[arg(long)]
    pub plan_file: Option<PathBuf>,
    /// Print the grounded task instead of planning.
    #[arg(long)]
    pub sas: bool,
    /// How to print the result.
    #[arg(long, value_enum, default_value = "text")]
    pub format: Format,
}

/// See [`Command::Validate`].
#[derive(Debug, Args)]
pub struct ValidateArgs {
    /// The domain file.
    pub domain: PathBuf,
    /// The problem file.
    pub problem: PathBuf,
    /// The plan file.
    pub plan: PathBuf,
    /// How to print the result.
    #[arg(long, value_enum, default_value = "text")]
    pub format: Format,
}

/// See [`Command::Bench`].
#[derive(Debug, Args)]
pub struct BenchArgs {
    /// A task file, one JSON object a line.
    #[arg(long, conflicts_with_all = ["mat_thor", "codmap"], required_unless_present_any = ["mat_thor", "generated", "codmap"])]
    pub tasks: Option<PathBuf>,
    /// A folder of multi-agent PDDL tasks, laid out as CoDMAP's: unfactored/DOMAIN/PROBLEM/ and
    /// factored/DOMAIN/PROBLEM/, with reference_values.json if there is one.
    #[arg(long, value_name = "DIR", conflicts_with = "mat_thor")]
    pub codmap: Option<PathBuf>,
    /// Carry out the factored tasks, one process per agent, instead of solving the unfactored ones.
    #[arg(long, requires = "codmap")]
    pub factored: bool,
    /// With --factored: see `lamma run --help`.
    #[arg(long, value_enum, default_value = "trusted", requires = "factored")]
    pub privacy: Privacy,
    /// A folder of MAT-THOR task files, read as they were released.
    #[arg(long)]
    pub mat_thor: Option<PathBuf>,
    /// The robots of the MAT-THOR files [default: the catalogue].
    #[arg(long, requires = "mat_thor")]
    pub robots: Option<PathBuf>,
    /// So many tasks made up for each of the 120 floor plans, by the seed.
    #[arg(long, value_name = "N", conflicts_with_all = ["tasks", "mat_thor"], value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub generated: Option<u16>,
    /// Only tasks whose id contains this.
    #[arg(long)]
    pub only: Option<String>,
    /// Tasks at once.
    #[arg(long, default_value_t = 1)]
    pub jobs: usize,
    /// Write results.json, results.csv (the same for the same seed) and timings.json to this folder.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// The method: LaMMA-P, or one to compare it with, which needs a chat model (--lm).
    #[arg(long, value_enum, default_value = "lamma-p")]
    pub method: MethodArg,
    /// Run the suite again without some of LaMMA-P's modules, and print the table of the ablation: P (precondition
    /// identifier), V (PDDL validator), G (problem generator), D (decomposition). `P,V` is two runs, `PV` one
    /// without both.
    #[arg(long, value_delimiter = ',', value_name = "MODULES")]
    pub without: Vec<Without>,
    /// Plan for the tasks' own goals instead of understanding their sentences.
    #[arg(long)]
    pub goals_given: bool,
    /// Also print what the formulas of the released MAT-THOR evaluator give, for comparison only.
    #[arg(long)]
    pub compat: bool,
    /// Instead of a run: work out the best schedule and the proved bound of each task, and write them into the file.
    #[arg(long, requires = "tasks", conflicts_with_all = ["goals_given", "compat", "only"])]
    pub write_references: bool,
    /// Options shared with other commands.
    #[command(flatten)]
    pub common: CommonArgs,
}

/// See [`Command::Scale`].
#[derive(Debug, Args)]
pub struct ScaleArgs {
    /// The sizes of the teams, separated by commas.
    #[arg(long, value_delimiter = ',', default_value = "2,16,64", value_parser = clap::value_parser!(u16).range(1..))]
    pub agents: Vec<u16>,
    /// The transport between the processes.
    #[arg(long, value_enum, default_value = "iceoryx2")]
    pub bus: BusArg,
    /// Host the robots in so many processes instead of one each.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub workers: Option<u16>,
    /// How often all meet [default: 2000 shared among the robots, at least 20, at most 200].
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub rounds: Option<u32>,
    /// Where the robots start is drawn from it.
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Give a team up after this many seconds.
    #[arg(long, default_value_t = 120.0, value_parser = seconds)]
    pub time_limit: f64,
    /// Write the plot to this file.
    #[arg(long, default_value = "scale.svg")]
    pub plot: PathBuf,
    /// Where logs and artefacts go [default: .lamma/runs/<id>].
    #[arg(long)]
    pub run_dir: Option<PathBuf>,
    /// How to print the result.
    #[arg(long, value_enum, default_value = "text")]
    pub format: Format,
}

/// What a process of `lamma scale` needs to know.
#[derive(Debug, Args)]
pub struct RallyArgs {
    /// What it is.
    #[arg(long, value_enum)]
    pub role: RallyRole,
    /// As every process; a process of many robots is called by the first of them.
    #[command(flatten)]
    pub child: ChildArgs,
    /// When the coordinator gives up.
    #[arg(long, default_value_t = 120_000)]
    pub limit_ms: u64,
}

/// See [`RallyArgs`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RallyRole {
    /// The coordinator.
    Coordinator,
    /// The simulator.
    Simulator,
    /// One robot, or all that share a process.
    Robots,
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(s) if s.is_finite() && s > 0.0 && s < 1e9 => Ok(s),
        _ => Err("a positive number of seconds is expected".into()),
    }
}

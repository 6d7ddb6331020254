//! `lamma run` and `lamma solve`.

use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::sync::Arc;

use lamma_coordinator::{Method, Patience};
use lamma_domains::robots::{Member, team};
use lamma_domains::world::Rules;

use crate::cli::{CommonArgs, Format, RunArgs};
use crate::error::Failure;
use crate::events;
use crate::exit;
use crate::json;
use crate::launch::{Launched, launch};
use crate::out::say;
use crate::show;
use crate::spec::{LmSpec, RunSpec, Task};
use crate::supervise::RunDir;
use crate::watch::{Lines, Watcher};
use crate::world::{Household, World, WorldSource};

/// Runs the instruction (or, for `solve_only`, stops at the plan) and prints the outcome.
pub fn run(args: &RunArgs, solve_only: bool) -> Result<u8, Failure> {
    let mut spec = spec_of(args)?;
    spec.solve_only = solve_only;
    let world = Arc::new(spec.world()?);
    if let World::Household(setup) = &*world {
        events::resolve(&spec.events, setup)?;
    }
    let launched = in_folder(spec, world, &args.common, lines(args.common.format).as_mut())?;
    print(&launched, &args.common)?;
    Ok(exit::of(launched.result.outcome))
}

/// The run that the arguments ask for, checked as far as that needs no world.
pub fn spec_of(args: &RunArgs) -> Result<RunSpec, Failure> {
    let mut spec = spec_from(&args.common, source(args)?);
    // Where nobody reads, the embedded default is not loaded; what else was asked for is checked all the same.
    if spec.instruction().is_some() || !spec.lm.is_built_in() {
        check_lm(&args.common)?;
    }
    spec.events = script(&args.common)?;
    Ok(spec)
}

/// What the run is about.
fn source(args: &RunArgs) -> Result<WorldSource, Failure> {
    if args.common.travel && args.scene.is_none() {
        return Err(Failure::bad_input(
            "--travel is for a scene: PDDL files state their own durations (:durative-action)",
        ));
    }
    if let Some([domain, problem]) = args.pddl.as_deref() {
        return WorldSource::pddl(domain, problem);
    }
    if let Some(folder) = &args.codmap {
        return WorldSource::factored(folder, args.privacy);
    }
    let text = instruction(args.instruction.as_deref().unwrap_or_default())?;
    let members: Vec<Member> = args.team.iter().map(|name| Member::Named(name.trim().to_string())).collect();
    Ok(WorldSource::Household(Household {
        scene: args.scene.clone().unwrap_or_default(),
        team: team(&members).map_err(Failure::bad_input)?,
        objects: None,
        rules: Rules { travel: args.common.travel, ..Rules::default() },
        task: Task::Instruction { text, assume: args.common.assume },
        score: None,
    }))
}

fn instruction(text: &str) -> Result<String, Failure> {
    match text.trim() {
        "" => Err(Failure::bad_input("the instruction is empty; say what the team shall do")),
        text => Ok(text.to_string()),
    }
}

/// A spec with what the common options say.
pub fn spec_from(common: &CommonArgs, source: WorldSource) -> RunSpec {
    RunSpec {
        id: String::new(),
        seed: common.seed,
        source,
        reference: None,
        allocator: common.allocator,
        method: Method::default(),
        solve_only: false,
        lm: lm_spec(common),
        // Bounded by the parser of the option.
        makespan_ms: common.makespan_limit.map(|s| (s * 1e3) as u64),
        time_limit_ms: (common.time_limit * 1e3) as u64,
        step_ms: common.step_ms,
        events: Vec::new(),
        random_events: common.random_events,
        workers: common.workers,
        patience: Patience {
            join_ms: (common.join_limit * 1e3) as u64,
            stall_ms: (common.stall_limit * 1e3) as u64,
        },
        away: BTreeMap::new(),
        fault_bus: common.fault_bus.as_ref().map(ToString::to_string),
    }
}

/// The script of `--events`, if there is one.
pub fn script(common: &CommonArgs) -> Result<Vec<events::ScriptLine>, Failure> {
    common.events.as_deref().map_or(Ok(Vec::new()), events::read)
}

/// A wrong `--lm` is the user's mistake and is told before anything starts.
pub fn check_lm(common: &CommonArgs) -> Result<(), Failure> {
    crate::process::language_model(&lm_spec(common), common.seed).map(drop)
}

fn lm_spec(common: &CommonArgs) -> LmSpec {
    LmSpec {
        spec: common.lm.clone(),
        url: common.lm_url.clone(),
        model: common.lm_model.clone(),
        lexicon: common.lexicon.clone(),
        ..LmSpec::default()
    }
}

/// Makes the run's folder and launches.
pub fn in_folder(
    mut spec: RunSpec,
    world: Arc<World>,
    common: &CommonArgs,
    watcher: &mut dyn Watcher,
) -> Result<Launched, Failure> {
    let folder = new_folder(common)?;
    spec.id = folder.id().to_string();
    let path: PathBuf = folder.path().to_path_buf();
    let launched = launch(spec, world, common.bus, &path, watcher)?;
    let text = serde_json::to_string_pretty(&json::run(&launched, common)).map_err(Failure::fault)?;
    let file = path.join("result.json");
    std::fs::write(&file, text).map_err(|e| Failure::io("write", &file, &e))?;
    Ok(launched)
}

/// A folder that holds no run yet.
pub fn new_folder(common: &CommonArgs) -> Result<RunDir, Failure> {
    let folder = RunDir::create(common.run_dir.as_deref()).map_err(Failure::bad_input)?;
    if folder.path().join("run.json").exists() {
        let path = folder.path().display();
        return Err(Failure::bad_input(format!("{path} holds a run already: choose another --run-dir")));
    }
    Ok(folder)
}

/// Progress goes to standard output with the rest, or to standard error where that is kept for JSON.
pub fn lines(format: Format) -> Box<dyn Watcher> {
    match format {
        Format::Text => Box::new(Lines::new(anstream::stdout())),
        Format::Json if std::io::stderr().is_terminal() => Box::new(Lines::new(anstream::stderr())),
        Format::Json => Box::new(crate::watch::Silent),
    }
}

fn print(launched: &Launched, common: &CommonArgs) -> Result<(), Failure> {
    match common.format {
        Format::Text => {
            say(show::result(&launched.result).trim_end());
            say(format_args!("         run folder {}", launched.folder.display()));
        }
        Format::Json => {
            let json = json::run(launched, common);
            say(serde_json::to_string(&json).map_err(Failure::fault)?);
        }
    }
    Ok(())
}

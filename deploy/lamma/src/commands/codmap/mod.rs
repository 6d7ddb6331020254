//! `lamma bench --codmap`: a folder of multi-agent PDDL tasks, each solved or carried out, against reference
//! values.

mod cpu;
mod set;
mod table;

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use lamma_coordinator::result::{ActionResult, OutcomeKind, RunResult};
use lamma_pddl::Name;
use lamma_planner::GroundAct;
use serde_json::{Value, json};

use crate::batch;
use crate::cli::{BenchArgs, Format};
use crate::commands::pddl_task::read_task;
use crate::commands::run::spec_from;
use crate::error::Failure;
use crate::exit;
use crate::json;
use crate::launch::launch;
use crate::method::Variant;
use crate::out::say;
use crate::supervise::RunDir;
use crate::watch::Silent;
use crate::world::World;
use set::{Set, TaskFolder};

/// One finished task.
pub struct Finished {
    /// Its result.
    pub result: RunResult,
    /// As the contract prints it.
    pub json: Value,
    /// From the call to the end of the teardown, in seconds.
    pub wall_s: f64,
    /// Processor time of all processes, in seconds; only where one task runs at a time.
    pub cpu_s: Option<f64>,
    /// Why the plan is none, if a validator says so.
    pub invalid: Option<String>,
}

impl Finished {
    /// Solved, with a plan that stands.
    pub fn is_solved(&self) -> bool {
        self.result.outcome == OutcomeKind::Success && self.invalid.is_none()
    }
}

/// Runs the set; 0 if every task could be run and no plan was wrong, whatever else came of it.
pub fn bench(args: &BenchArgs, folder: &Path) -> Result<u8, Failure> {
    Variant::of(args)?;
    if args.common.travel {
        return Err(Failure::bad_input(
            "--travel is for household scenes: PDDL files state their own durations",
        ));
    }
    let mut set = set::read(folder, args.factored, args.only.as_deref())?;
    let runs = RunDir::create(args.common.run_dir.as_deref()).map_err(Failure::bad_input)?;
    let names: Vec<String> = set.tasks.iter().map(|task| task.id.clone()).collect();
    let start = Instant::now();
    let batch =
        batch::each(&names, args.jobs, |i| one(args, runs.path(), &set.tasks[i]), |i, f| line(&names[i], f));
    let seconds = start.elapsed().as_secs_f64();
    let (done, finished): (BTreeSet<usize>, Vec<Finished>) = batch.done.into_iter().unzip();
    let mut index = 0..;
    set.tasks.retain(|_| index.next().is_some_and(|i| done.contains(&i)));
    report(args, &set, &finished, seconds)?;
    let broken = |f: &Finished| f.result.outcome == OutcomeKind::Error || f.invalid.is_some();
    Ok(exit::of_batch(finished.iter().any(broken), batch.interrupted))
}

fn one(args: &BenchArgs, runs: &Path, task: &TaskFolder) -> Finished {
    let (start, before) = (Instant::now(), cpu::used());
    let tried = attempt(args, &runs.join(&task.id), task);
    let cpu_s =
        if args.jobs == 1 { cpu::used().zip(before).map(|(after, before)| after - before) } else { None };
    let wall_s = start.elapsed().as_secs_f64();
    let (result, mut json, invalid) = tried.unwrap_or_else(|failure| {
        let result = RunResult::unfinished(OutcomeKind::Error, failure.text);
        let json = serde_json::to_value(&result).unwrap_or_default();
        (result, json, None)
    });
    if let Value::Object(object) = &mut json {
        object.insert("id".into(), json!(task.id));
        object.insert("category".into(), json!(task.domain));
        object.insert("wall_s".into(), json!(wall_s));
        object.insert("cpu_s".into(), json!(cpu_s));
        object.insert("invalid".into(), json!(invalid));
        object.insert("best_makespan".into(), json!(task.reference.map(|r| r.best_makespan)));
    }
    Finished { result, json, wall_s, cpu_s, invalid }
}

type Tried = (RunResult, Value, Option<String>);

fn attempt(args: &BenchArgs, folder: &Path, task: &TaskFolder) -> Result<Tried, Failure> {
    let mut spec = spec_from(&args.common, task.source(args.privacy)?);
    spec.id = task.id.clone();
    // The factored form is carried out; of the unfactored one only the plan is wanted.
    spec.solve_only = !args.factored;
    let plain = spec.source.unveiled();
    let world = Arc::new(spec.world()?);
    std::fs::create_dir_all(folder.join("logs")).map_err(|e| Failure::io("create", folder, &e))?;
    let launched = launch(spec, world, args.common.bus, folder, &mut Silent)?;
    let json = json::run(&launched, &args.common);
    let invalid = match launched.result.outcome {
        OutcomeKind::Success => check(task, &plain.world(args.common.seed)?, &launched.result),
        _ => None,
    };
    Ok((launched.result, json, invalid))
}

/// What a validator says against the plan: on our own compilation, and on the set's if it has one.
fn check(task: &TaskFolder, world: &World, result: &RunResult) -> Option<String> {
    let World::Team(team) = world else { return None };
    let compiled = |a: &ActionResult| {
        let (action, args) = team.compiled_act(&a.robot, &a.action, &a.args);
        GroundAct { action, args }
    };
    let own_acts: Vec<GroundAct> = result.plan.actions.iter().map(compiled).collect();
    let verdict = lamma_planner::validate(&team.domain, &team.problem(), &own_acts);
    let own = match verdict {
        Ok(verdict) if verdict.is_valid() => None,
        Ok(verdict) => Some(verdict.to_string()),
        Err(error) => Some(error.to_string()),
    };
    own.or_else(|| {
        let (domain, problem) = task.classical.as_ref()?;
        let classical = read_task(domain, problem).ok()?;
        match lamma_planner::validate(&classical.domain, &classical.problem, &classical_acts(result)) {
            Ok(verdict) if verdict.is_valid() => None,
            Ok(verdict) => Some(format!("on the set's own compilation: {verdict}")),
            Err(error) => Some(format!("on the set's own compilation: {error}")),
        }
    })
}

/// The plan in the set's own compilation: who acts is the first argument.
fn classical_acts(result: &RunResult) -> Vec<GroundAct> {
    let act = |a: &ActionResult| {
        let args = std::iter::once(&a.robot).chain(&a.args);
        GroundAct { action: Name::new(&a.action), args: args.map(Name::new).collect() }
    };
    result.plan.actions.iter().map(act).collect()
}

/// A file for each plan, `DOMAIN/PROBLEM.plan`, as other validators read it.
fn write_plans(folder: &Path, set: &Set, finished: &[Finished]) -> std::io::Result<()> {
    for (task, f) in set.tasks.iter().zip(finished).filter(|(_, f)| f.is_solved()) {
        let path = folder.join(format!("{}.plan", task.id));
        path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
        let lines = classical_acts(&f.result).into_iter().map(|act| format!("{act}\n"));
        std::fs::write(path, lines.collect::<String>())?;
    }
    Ok(())
}

fn line(name: &str, f: &Finished) -> String {
    let outcome = serde_json::to_value(f.result.outcome).unwrap_or_default();
    let outcome = outcome.as_str().unwrap_or("?");
    let plan = &f.result.plan;
    let rest = match (&f.invalid, f.result.outcome) {
        (Some(why), _) => format!("INVALID: {why}"),
        (None, OutcomeKind::Success) => {
            format!("makespan {} (at least {})", plan.makespan, plan.makespan_lower_bound)
        }
        (None, _) => f.result.reason.clone().unwrap_or_default(),
    };
    format!("{name:<32} {outcome:<12} {:7.2} s  {rest}", f.wall_s)
}

fn report(args: &BenchArgs, set: &Set, finished: &[Finished], seconds: f64) -> Result<(), Failure> {
    let rows = table::rows(set, finished);
    let value = json!({
        "suite": set.name,
        "form": if args.factored { "factored" } else { "unfactored" },
        "tasks": finished.iter().map(|f| &f.json).collect::<Vec<_>>(),
        "table": rows.iter().map(|r| (r.name.clone(), r.json())).collect::<serde_json::Map<_, _>>(),
    });
    if let Some(out) = &args.out {
        let fail = |e: &std::io::Error| Failure::bad_input(format!("cannot write to {}: {e}", out.display()));
        std::fs::create_dir_all(out).map_err(|e| fail(&e))?;
        let text = serde_json::to_string_pretty(&value).map_err(Failure::fault)?;
        std::fs::write(out.join("results.json"), text).map_err(|e| fail(&e))?;
        std::fs::write(out.join("results.csv"), table::csv(set, finished)).map_err(|e| fail(&e))?;
        write_plans(&out.join("plans"), set, finished).map_err(|e| fail(&e))?;
    }
    match args.common.format {
        Format::Json => say(serde_json::to_string(&value).map_err(Failure::fault)?),
        Format::Text => {
            say(table::text(&set.name, &rows).trim_end());
            let what = if args.factored { "carried out by one process per agent" } else { "solved" };
            let limit = args.common.time_limit;
            let n = finished.len();
            let effort = match args.common.makespan_limit {
                None => "default effort for the makespan".to_string(),
                Some(seconds) => format!("up to {seconds} s of it for the makespan"),
            };
            say(format_args!(
                "{n} tasks {what} in {seconds:.1} s; limit {limit} s each, {effort}; plans validated"
            ));
        }
    }
    Ok(())
}

//! `lamma bench`: a suite of tasks, each a run of its own, and the metric table.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use lamma_coordinator::result::{OutcomeKind, RunResult};
use lamma_domains::robots::team;
use lamma_domains::world::Rules;
use serde_json::{Value, json};

use crate::batch::{self, Batch};
use crate::cli::{BenchArgs, Format};
use crate::commands::run::{check_lm, script, spec_from};
use crate::compat::{self, Compat};
use crate::error::Failure;
use crate::exit;
use crate::json;
use crate::launch::launch;
use crate::method::Variant;
use crate::out::say;
use crate::spec::{RunSpec, Task};
use crate::suite::{self, Entry, Suite};
use crate::supervise::RunDir;
use crate::table;
use crate::watch::Silent;
use crate::world::{Household, World, WorldSource};
use crate::{ablation, events, published, references, results};

/// One finished task.
pub struct Finished {
    /// Which.
    pub index: usize,
    /// Its result.
    pub result: RunResult,
    /// As the contract prints it.
    pub json: Value,
    /// What the released evaluator would say, where it was asked for.
    pub compat: Option<Compat>,
}

/// Runs the suite; 0 if every task could be run, whatever came of it. Interrupted, it reports what was done.
pub fn bench(args: &BenchArgs) -> Result<u8, Failure> {
    if let Some(folder) = &args.codmap {
        return super::codmap::bench(args, folder);
    }
    let variants = Variant::of(args)?;
    let mut suite = suite::read(args)?;
    if let Some(only) = &args.only {
        suite.entries.retain(|e| e.task.id.contains(only.as_str()));
        if suite.entries.is_empty() {
            return Err(Failure::bad_input(format!("no task of {} has {only:?} in its id", suite.name)));
        }
    }
    if args.write_references
        && let Some(file) = &args.tasks
    {
        let tasks: Vec<_> = suite.entries.into_iter().map(|e| e.task).collect();
        return references::write(file, &tasks);
    }
    check_lm(&args.common)?;
    for note in &suite.notes {
        eprintln!("{note}");
    }
    let folder = RunDir::create(args.common.run_dir.as_deref()).map_err(Failure::bad_input)?;
    let start = Instant::now();
    let (mut runs, mut interrupted) = (Vec::new(), false);
    for variant in variants {
        let runs_in = match args.without.is_empty() {
            true => folder.path().to_path_buf(),
            false => folder.path().join(variant.to_string()),
        };
        let batch = run_all(args, &variant, &runs_in, &suite);
        interrupted = batch.interrupted;
        runs.push((variant, batch.done.into_iter().map(|(_, finished)| finished).collect()));
        if interrupted {
            break;
        }
    }
    report(args, &suite, &runs, start.elapsed().as_secs_f64())?;
    let broken = |f: &Finished| f.result.outcome == OutcomeKind::Error;
    let broken = runs.iter().flat_map(|(_, f): &(_, Vec<Finished>)| f).any(broken);
    Ok(exit::of_batch(broken, interrupted))
}

fn run_all(args: &BenchArgs, variant: &Variant, folder: &Path, suite: &Suite) -> Batch<Finished> {
    let names: Vec<String> = suite.entries.iter().map(|entry| entry.task.id.clone()).collect();
    let work = |index: usize| run_one(args, variant, folder, index, &suite.entries[index]);
    batch::each(&names, args.jobs, work, |index, f| line(&suite.entries[index], &f.result))
}

fn line(entry: &Entry, result: &RunResult) -> String {
    let outcome = serde_json::to_value(result.outcome).unwrap_or_default();
    let outcome = outcome.as_str().unwrap_or("?");
    let reason = result.reason.as_deref().unwrap_or("");
    let makespan = if result.outcome == OutcomeKind::Success {
        format!("makespan {} (at least {})", result.plan.makespan, result.plan.makespan_lower_bound)
    } else {
        String::new()
    };
    format!("{:<28} {outcome:<20} {makespan}{reason}", entry.task.id)
}

fn run_one(args: &BenchArgs, variant: &Variant, folder: &Path, index: usize, entry: &Entry) -> Finished {
    let folder = folder.join(folder_name(index, &entry.task.id));
    let (result, mut json, compat) = match try_one(args, variant, &folder, entry) {
        Ok(run) => run,
        Err(failure) => {
            let kind =
                if failure.code == exit::BAD_INPUT { OutcomeKind::Infeasible } else { OutcomeKind::Error };
            let result = RunResult::unfinished(kind, failure.text);
            let json = serde_json::to_value(&result).unwrap_or_default();
            (result, json, None)
        }
    };
    if let Value::Object(object) = &mut json {
        object.insert("id".into(), json!(entry.task.id));
        object.insert("category".into(), json!(entry.task.category));
        object.insert("instruction".into(), json!(entry.task.instruction));
        if !entry.repairs.is_empty() {
            object.insert("repairs".into(), json!(entry.repairs));
        }
        if let Some(compat) = compat {
            object.insert("compat".into(), compat.json());
        }
        if let Some(why) = &entry.set_aside {
            object.insert("set_aside".into(), json!(why));
        }
    }
    Finished { index, result, json, compat }
}

/// The folder of a task's run: its id, if that is a name and no path.
fn folder_name(index: usize, id: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    match id.chars().all(plain) && !id.starts_with('.') && !id.is_empty() && id.len() <= 100 {
        true => id.to_string(),
        false => format!("task-{}", index + 1),
    }
}

fn try_one(
    args: &BenchArgs,
    variant: &Variant,
    folder: &Path,
    entry: &Entry,
) -> Result<(RunResult, Value, Option<Compat>), Failure> {
    if let Some(why) = &entry.impossible {
        return Err(Failure::bad_input(format!("the goal cannot hold in this scene: {why}")));
    }
    let mut spec = spec(args, entry)?;
    variant.apply(&mut spec);
    let world = Arc::new(spec.world()?);
    let World::Household(setup) = &*world else {
        return Err(Failure::fault("a suite's task is a household's"));
    };
    events::resolve(&spec.events, setup)?;
    std::fs::create_dir_all(folder.join("logs")).map_err(|e| Failure::io("create", folder, &e))?;
    let launched = launch(spec, world.clone(), args.common.bus, folder, &mut Silent)?;
    let json = json::run(&launched, &args.common);
    let compat = args.compat.then(|| compat::score(setup, &launched.result, &entry.truth)).flatten();
    Ok((launched.result, json, compat))
}

fn spec(args: &BenchArgs, entry: &Entry) -> Result<RunSpec, Failure> {
    let task = &entry.task;
    let wanted = if args.goals_given {
        Task::Goal(task.goal.clone())
    } else {
        Task::Instruction { text: task.instruction.clone(), assume: args.common.assume }
    };
    let household = Household {
        scene: task.scene.clone(),
        team: team(&task.team).map_err(Failure::bad_input)?,
        objects: task.objects.clone(),
        rules: Rules { travel: task.rules.travel || args.common.travel, ..task.rules.clone() },
        task: wanted,
        score: Some(task.goal.clone()),
    };
    let mut spec = spec_from(&args.common, WorldSource::Household(household));
    spec.id = task.id.clone();
    spec.events = script(&args.common)?;
    // The file's reference is in unit steps, unless the task itself asks for travel.
    let known = task.reference.filter(|_| !args.common.travel || task.rules.travel);
    spec.reference = known.map(|r| (f64::from(r.makespan), f64::from(r.steps)));
    Ok(spec)
}

fn report(
    args: &BenchArgs,
    suite: &Suite,
    runs: &[(Variant, Vec<Finished>)],
    seconds: f64,
) -> Result<(), Failure> {
    let values: Vec<Value> = runs.iter().map(|(variant, f)| value(args, variant, suite, f)).collect();
    if let Some(out) = &args.out {
        for ((variant, finished), value) in runs.iter().zip(&values) {
            let out = if runs.len() == 1 { out.clone() } else { out.join(variant.to_string()) };
            results::write(&out, value, suite, finished)?;
        }
    }
    match args.common.format {
        Format::Json => {
            // One object, as ever; an ablation has one for each of its rows.
            let json = match values.as_slice() {
                [one] => one.clone(),
                several => json!({ "suite": suite.name, "seed": args.common.seed, "ablation": several }),
            };
            say(serde_json::to_string(&json).map_err(Failure::fault)?);
        }
        Format::Text => {
            for (variant, finished) in runs {
                print(args, variant, suite, finished);
            }
            if runs.len() > 1 {
                let rows: Vec<_> = runs.iter().map(|(v, f)| (v, table::rows(suite, f))).collect();
                say(ablation::text(&rows).trim_end());
            }
            if suite.has_the_papers_categories() {
                say(published::text().trim_end());
            }
            let n: usize = runs.iter().map(|(_, f)| f.len()).sum();
            say(format_args!(
                "{n} tasks in {seconds:.1} s; seed {}; goals judged on the simulator's state",
                args.common.seed
            ));
        }
    }
    Ok(())
}

fn value(args: &BenchArgs, variant: &Variant, suite: &Suite, finished: &[Finished]) -> Value {
    let rows = table::rows(suite, finished);
    let mut value = json!({
        "suite": suite.name,
        "seed": args.common.seed,
        "tasks": finished.iter().map(|f| &f.json).collect::<Vec<_>>(),
        "table": rows.iter().map(|r| (r.name.clone(), r.json())).collect::<serde_json::Map<_, _>>(),
    });
    if *variant != Variant::default() || !args.without.is_empty() {
        value["method"] = json!(variant.to_string());
    }
    value
}

fn print(args: &BenchArgs, variant: &Variant, suite: &Suite, finished: &[Finished]) {
    let name = match *variant == Variant::default() {
        true => suite.name.clone(),
        false => format!("{}, {variant} with {}", suite.name, args.common.lm),
    };
    say(table::text(&name, &table::rows(suite, finished)).trim_end());
    say(table::references(suite, finished.len(), args.common.travel));
    if args.compat {
        say(table::compat(finished));
    }
    say("M/LB, proved: makespan / proved lower bound, and the share of successes where they meet");
}

//! The makespan of a multi-agent task in its classical form, where the first argument of an action is the
//! agent: the proved bound and the best schedule.
//!
//! `cargo run --release -p lamma-planner --example makespan -- DOMAIN PROBLEM [SECONDS]` for one task;
//! `… -- --all DIR [SECONDS] [--only TEXT]` for a folder that holds a folder for each domain (`domain.pddl` and
//! problems) and beside it, if there are any, `reference_values.json`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use lamma_pddl::{Name, Source, parse_domain, parse_problem};
use lamma_planner::heuristic::{Costs, Estimate, Heuristic, LandmarkCut};
use lamma_planner::{GroundLimits, MakespanLimits, OperatorId, Scheduler, Task, ground};

fn main() -> Result<(), String> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let seconds = |at: usize| args.get(at).and_then(|s| s.parse::<f64>().ok()).unwrap_or(10.0);
    match args.first().map(String::as_str) {
        Some("--all") if args.len() >= 2 => {
            let only = args.iter().position(|a| a == "--only").and_then(|at| args.get(at + 1));
            all(Path::new(&args[1]), seconds(2), only.map_or("", String::as_str))
        }
        Some(domain) if args.len() >= 2 => {
            println!("{}", one(Path::new(domain), Path::new(&args[1]), seconds(2))?.text());
            Ok(())
        }
        _ => Err("DOMAIN PROBLEM [SECONDS], or --all DIR [SECONDS] [--only TEXT]".into()),
    }
}

struct Row {
    agents: usize,
    size: String,
    floor: u32,
    bound: u32,
    makespan: Option<u32>,
    seconds: f64,
}

impl Row {
    fn text(&self) -> String {
        let makespan = self.makespan.map_or("-".into(), |m| m.to_string());
        format!(
            "agents {} floor {} bound {} makespan {makespan} {:.2}s ({})",
            self.agents, self.floor, self.bound, self.seconds, self.size
        )
    }
}

fn agents(task: &Task) -> (Vec<u32>, usize) {
    let mut known: BTreeMap<Name, u32> = BTreeMap::new();
    let mut of = Vec::with_capacity(task.operators.len());
    for operator in (0..task.operators.len() as u32).map(OperatorId) {
        let name = task.act(operator).args.first().cloned().unwrap_or_else(|| Name::new("nobody"));
        let next = known.len() as u32;
        of.push(*known.entry(name).or_insert(next));
    }
    (of, known.len())
}

fn one(domain: &Path, problem: &Path, seconds: f64) -> Result<Row, String> {
    let read = |path: &Path| {
        let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        Ok::<Source, String>(Source::new(path.display().to_string(), text))
    };
    let domain = parse_domain(&read(domain)?).map_err(|e| format!("{e:?}"))?.value;
    let problem = parse_problem(&read(problem)?).map_err(|e| format!("{e:?}"))?.value;
    let start = Instant::now();
    let task = ground(&domain, &problem, &GroundLimits::default()).map_err(|e| e.to_string())?;
    let (agent_of, agents) = agents(&task);
    let work = match LandmarkCut::new(&task, Costs::Unit).estimate(&task.init, &mut Vec::new()) {
        Estimate::Cost(actions) => actions.div_ceil(agents as u32),
        Estimate::DeadEnd => 0,
    };
    let scheduler = Scheduler::new(&task, &agent_of).ok_or("the goal is out of reach")?;
    let floor = work.max(scheduler.depth());
    let limits = MakespanLimits {
        conflicts: u64::MAX,
        size: 60_000_000,
        time: Some(Duration::from_secs_f64(seconds)),
    };
    let found = scheduler.shortest(floor, None, &limits, &AtomicBool::new(false));
    Ok(Row {
        agents,
        size: task.to_string(),
        floor,
        bound: found.lower_bound.unwrap_or(0),
        makespan: found.schedule.map(|s| s.makespan()),
        seconds: start.elapsed().as_secs_f64(),
    })
}

fn all(folder: &Path, seconds: f64, only: &str) -> Result<(), String> {
    let list = |folder: &Path| -> Result<Vec<PathBuf>, String> {
        let entries = std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        let mut paths: Vec<PathBuf> = entries.filter_map(|e| e.ok().map(|e| e.path())).collect();
        paths.sort();
        Ok(paths)
    };
    for domain in list(folder)?.into_iter().filter(|p| p.is_dir()) {
        for problem in list(&domain)?.into_iter().filter(|p| !p.ends_with("domain.pddl")) {
            let name = format!(
                "{}/{}",
                domain.file_name().unwrap_or_default().to_string_lossy(),
                problem.file_stem().unwrap_or_default().to_string_lossy()
            );
            if name.contains(only) {
                match one(&domain.join("domain.pddl"), &problem, seconds) {
                    Ok(row) => println!("{name} {}", row.text()),
                    Err(why) => println!("{name} {why}"),
                }
            }
        }
    }
    Ok(())
}

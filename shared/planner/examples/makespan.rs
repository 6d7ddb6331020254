//! The makespan of a multi-agent task in its classical form, where the first argument of an action is the
//! agent: the plan found first, how far it can be shortened, and the proved bound.
//!
//! `cargo run --release -p lamma-planner --example makespan -- DOMAIN PROBLEM [WORK]` for one task, with so many
//! million units of work (some are a second); `… -- --all DIR [WORK] [--only TEXT] [--places 1,6]` for a folder that holds a folder for each domain
//! (`domain.pddl` and problems), of each the problems at these places, and beside it, if there are any,
//! `reference_values.json`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use lamma_pddl::{Name, Source, parse_domain, parse_problem};
use lamma_planner::{
    GroundLimits, Limits, MakespanLimits, OperatorId, Outcome, Scheduler, SearchOptions, Task, ground, solve,
};

/// How long to look for a first plan.
const WALK: Duration = Duration::from_secs(30);

fn main() -> Result<(), String> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let work = |at: usize| args.get(at).and_then(|s| s.parse::<u64>().ok()).unwrap_or(20) * 1_000_000;
    let option = |name: &str| args.iter().position(|a| a == name).and_then(|at| args.get(at + 1));
    match args.first().map(String::as_str) {
        Some("--all") if args.len() >= 2 => {
            let only = option("--only").map_or("", String::as_str);
            let places = option("--places").map(|p| p.split(',').filter_map(|n| n.parse().ok()).collect());
            all(Path::new(&args[1]), work(2), only, places)
        }
        Some(domain) if args.len() >= 2 => {
            println!("{}", one(Path::new(domain), Path::new(&args[1]), work(2))?.text(None));
            Ok(())
        }
        _ => Err("DOMAIN PROBLEM [WORK], or --all DIR [WORK] [--only TEXT] [--places 1,6]".into()),
    }
}

struct Row {
    agents: usize,
    size: String,
    floor: u32,
    bound: u32,
    /// Of the plan found first, and when that was.
    first: Option<(u32, f64)>,
    makespan: Option<u32>,
    seconds: f64,
}

impl Row {
    fn text(&self, best: Option<f64>) -> String {
        let number = |n: Option<f64>| n.map_or("-".into(), |n| format!("{n}"));
        let (first, found) = self.first.unzip();
        format!(
            "best {} first {} makespan {} bound {} floor {} | plan {:.2}s all {:.2}s | agents {} ({})",
            number(best),
            number(first.map(f64::from)),
            number(self.makespan.map(f64::from)),
            self.bound,
            self.floor,
            found.unwrap_or(0.0),
            self.seconds,
            self.agents,
            self.size
        )
    }
}

/// Seconds of processor time of this process, where the system tells.
fn processor_time() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = stat.rsplit_once(')').map_or("", |(_, rest)| rest).split_whitespace();
    fields.skip(11).take(2).filter_map(|ticks| ticks.parse::<f64>().ok()).sum::<f64>() / 100.0
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

fn one(domain: &Path, problem: &Path, work: u64) -> Result<Row, String> {
    let read = |path: &Path| {
        let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        Ok::<Source, String>(Source::new(path.display().to_string(), text))
    };
    let domain = parse_domain(&read(domain)?).map_err(|e| format!("{e:?}"))?.value;
    let problem = parse_problem(&read(problem)?).map_err(|e| format!("{e:?}"))?.value;
    let start = processor_time();
    let task = ground(&domain, &problem, &GroundLimits::default()).map_err(|e| e.to_string())?;
    let (agent_of, agents) = agents(&task);
    let scheduler = Scheduler::new(&task, &agent_of).ok_or("the goal is out of reach")?;
    let floor = scheduler.work(64).max(scheduler.depth());
    let cancel = AtomicBool::new(false);
    let limits = Limits { time: Some(WALK), ..Limits::default() };
    let plan = match solve(&task, &SearchOptions::default(), &limits, &cancel) {
        Outcome::Found(plan) => task.trace(&plan),
        Outcome::GaveUp(_) | Outcome::Unsolvable(_) => None,
    };
    let found = processor_time() - start;
    let first = plan.as_ref().and_then(|plan| scheduler.makespan_of(plan));
    let limits = match work {
        // As the coordinator does it.
        0 => MakespanLimits { conflicts: u64::MAX, size: 1_000_000, ..MakespanLimits::default() }
            .worth(task.operators.len(), first.unwrap_or(0)),
        _ => MakespanLimits { conflicts: u64::MAX, size: 60_000_000, work, ..MakespanLimits::default() },
    };
    let never = AtomicBool::new(false);
    let proof = match (&plan, first) {
        (Some(plan), Some(first)) => scheduler.improve(plan, first, floor, &limits, &never),
        _ => scheduler.shortest(floor, None, &MakespanLimits { conflicts: 20_000, ..limits }, &never),
    };
    let shorter = proof.schedule.map(|s| s.makespan());
    Ok(Row {
        agents,
        size: task.to_string(),
        floor,
        bound: proof.lower_bound.unwrap_or(0),
        first: first.map(|first| (first, found)),
        makespan: shorter.or(first),
        seconds: processor_time() - start,
    })
}

fn all(folder: &Path, work: u64, only: &str, places: Option<Vec<usize>>) -> Result<(), String> {
    let list = |folder: &Path| -> Result<Vec<PathBuf>, String> {
        let entries = std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        let mut paths: Vec<PathBuf> = entries.filter_map(|e| e.ok().map(|e| e.path())).collect();
        paths.sort();
        Ok(paths)
    };
    let name = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let best = references(folder);
    let mut sums = Sums::default();
    for domain in list(folder)?.into_iter().filter(|p| p.is_dir()) {
        let problems = list(&domain)?.into_iter().filter(|p| !p.ends_with("domain.pddl"));
        for (place, problem) in problems.enumerate() {
            let id = format!("{}/{}", name(&domain), name(&problem));
            let wanted = places.as_ref().is_none_or(|places| places.contains(&(place + 1)));
            if !wanted || !id.contains(only) {
                continue;
            }
            match one(&domain.join("domain.pddl"), &problem, work) {
                Ok(row) => {
                    let best = best.get(&id).copied();
                    println!("{id} {}", row.text(best));
                    sums.add(&row, best);
                }
                Err(why) => println!("{id} {why}"),
            }
        }
    }
    println!("{}", sums.text());
    Ok(())
}

/// The shortest makespans known, by problem, from the file beside the domains or one folder above.
fn references(folder: &Path) -> BTreeMap<String, f64> {
    let paths = [folder.to_path_buf(), folder.join("..")].map(|f| f.join("reference_values.json"));
    let text = paths.iter().find_map(|path| std::fs::read_to_string(path).ok()).unwrap_or_default();
    let mut best = BTreeMap::new();
    let mut problem = String::new();
    // A reader for this one file: keys in quotes, one to a line.
    for line in text.lines() {
        let Some((key, value)) = line.trim().split_once(':') else { continue };
        let key = key.trim_matches('"');
        if key.contains('/') {
            problem = key.to_string();
        } else if key == "best_makespan"
            && let Ok(value) = value.trim().trim_end_matches(',').parse()
        {
            best.insert(problem.clone(), value);
        }
    }
    best
}

/// What the issue asks: ratios over all problems.
#[derive(Default)]
struct Sums {
    tasks: usize,
    solved: usize,
    to_best: Vec<f64>,
    best_to_bound: Vec<f64>,
    to_bound: Vec<f64>,
}

impl Sums {
    fn add(&mut self, row: &Row, best: Option<f64>) {
        self.tasks += 1;
        self.solved += usize::from(row.makespan.is_some());
        if let (Some(makespan), Some(best)) = (row.makespan, best) {
            self.to_best.push(f64::from(makespan) / best);
        }
        let bound = f64::from(row.bound.max(1));
        self.best_to_bound.extend(best.map(|best| best / bound));
        self.to_bound.extend(row.makespan.map(|makespan| f64::from(makespan) / bound));
    }

    fn text(&self) -> String {
        let median = |values: &[f64]| {
            let mut values = values.to_vec();
            values.sort_by(f64::total_cmp);
            values.get(values.len() / 2).copied().unwrap_or(0.0)
        };
        let count = self.to_best.len().max(1) as f64;
        let mean = (self.to_best.iter().map(|r| r.ln()).sum::<f64>() / count).exp();
        let good = self.to_best.iter().filter(|r| **r <= 1.0).count() as f64 / count;
        format!(
            "{} tasks, {} solved; makespan to best: geometric mean {mean:.3}, no worse on {:.1} %; \
             best to bound: median {:.2}; makespan to bound: median {:.2}",
            self.tasks,
            self.solved,
            100.0 * good,
            median(&self.best_to_bound),
            median(&self.to_bound)
        )
    }
}

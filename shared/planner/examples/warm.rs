//! How long planning takes inside a process that is already there, as a robot's is: `warm [ROUNDS] DOMAIN PROBLEM…`
//!
//! Every problem is planned ROUNDS times (default 200), reading, checking, grounding, searching and validating
//! anew each time, as a robot does with each package. Printed are the median and the 99th percentile of each stage,
//! over all rounds but the first, which warms the process, and over all problems; and how many steps the plans have.

use std::error::Error;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use lamma_pddl::ast::Domain;
use lamma_pddl::{Source, check_domain, check_problem, parse_domain, parse_problem};
use lamma_planner::{GroundLimits, Limits, Outcome, SearchOptions, ground, solve, validate};

const STAGES: [&str; 5] = ["read", "ground", "search", "validate", "all"];

fn main() -> Result<(), Box<dyn Error>> {
    let mut args: Vec<String> = std::env::args().skip(1).collect();
    let rounds = match args.first().and_then(|first| first.parse().ok()) {
        Some(rounds) => {
            args.remove(0);
            rounds
        }
        None => 200,
    };
    let [domain, problems @ ..] = &args[..] else {
        return Err("usage: warm [ROUNDS] DOMAIN PROBLEM…".into());
    };
    let source = Source::read(domain)?;
    let domain = parse_domain(&source).map_err(|report| report.render())?.value;
    let report = check_domain(&domain, &source);
    if report.has_errors() {
        return Err(report.render().into());
    }
    let mut micros: [Vec<f64>; STAGES.len()] = Default::default();
    let mut steps = 0;
    for problem in problems {
        let text = Source::read(problem)?;
        for round in 0..=rounds {
            let (stages, length) = once(&domain, &text).map_err(|error| format!("{problem}: {error}"))?;
            if round > 0 {
                micros.iter_mut().zip(stages).for_each(|(all, one)| all.push(one));
            } else {
                steps += length;
            }
        }
    }
    println!("{} problems, {rounds} rounds each, {steps} steps in all their plans; microseconds", problems.len());
    println!("{:10} {:>9} {:>9} {:>9}", "stage", "p50", "p99", "most");
    for (stage, micros) in STAGES.iter().zip(&mut micros) {
        micros.sort_by(f64::total_cmp);
        let at = |share: f64| micros.get((share * micros.len() as f64) as usize).copied().unwrap_or(f64::NAN);
        let most = micros.last().copied().unwrap_or(f64::NAN);
        println!("{stage:10} {:>9.1} {:>9.1} {most:>9.1}", at(0.5), at(0.99));
    }
    Ok(())
}

/// The microseconds of every stage, and the length of the plan.
fn once(domain: &Domain, source: &Source) -> Result<([f64; STAGES.len()], usize), String> {
    let mut laps = [0.0; STAGES.len()];
    let start = Instant::now();
    let mut last = start;
    let mut lap = |stage: usize| {
        let now = Instant::now();
        laps[stage] = (now - last).as_secs_f64() * 1e6;
        last = now;
    };
    let problem = parse_problem(source).map_err(|report| report.render())?.value;
    let report = check_problem(domain, &problem, source);
    if report.has_errors() {
        return Err(report.render());
    }
    lap(0);
    let task = ground(domain, &problem, &GroundLimits::default()).map_err(|error| error.to_string())?;
    lap(1);
    let cancel = AtomicBool::new(false);
    let Outcome::Found(plan) = solve(&task, &SearchOptions::default(), &Limits::default(), &cancel) else {
        return Err("no plan".into());
    };
    lap(2);
    let verdict = validate(domain, &problem, &plan.acts).map_err(|error| error.to_string())?;
    if !verdict.is_valid() {
        return Err(format!("a wrong plan: {verdict}"));
    }
    lap(3);
    laps[4] = start.elapsed().as_secs_f64() * 1e6;
    Ok((laps, plan.acts.len()))
}

//! Times grounding and search of one task: `solve DOMAIN PROBLEM [SECONDS [ENGINE]]`.

use std::error::Error;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use lamma_pddl::{Source, parse_domain, parse_problem};
use lamma_planner::search::{Statistics, solve_with_statistics};
use lamma_planner::{Engine, GroundLimits, Limits, Outcome, SearchOptions, ground};

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().collect();
    let [_, domain, problem, rest @ ..] = &args[..] else {
        return Err("usage: solve DOMAIN PROBLEM [SECONDS]".into());
    };
    let seconds: f64 = rest.first().map_or(Ok(30.0), |s| s.parse())?;
    let start = Instant::now();
    let domain = parse_domain(&Source::read(domain)?).map_err(|report| report.render())?.value;
    let problem = parse_problem(&Source::read(problem)?).map_err(|report| report.render())?.value;
    let parsed = start.elapsed();
    let task = ground(&domain, &problem, &GroundLimits::default())?;
    let grounded = start.elapsed();
    let limits = Limits {
        time: Some(Duration::from_secs_f64(seconds)),
        memory_bytes: Some(2 << 30),
        expansions: None,
    };
    let mut statistics = Statistics::default();
    let engine =
        rest.get(1).map_or(Some(Engine::Portfolio), |name| Engine::named(name)).ok_or("unknown engine")?;
    let options = SearchOptions { engine, ..SearchOptions::default() };
    let cancel = AtomicBool::new(false);
    let outcome = solve_with_statistics(&task, &options, &limits, &cancel, &mut statistics);
    let total = start.elapsed();
    let ms = |d: Duration| format!("{:.2}", d.as_secs_f64() * 1e3);
    match &outcome {
        Outcome::Found(plan) => {
            plan.acts.iter().for_each(|act| println!("{act}"));
            println!("; cost = {} ({} actions)", plan.cost, plan.acts.len());
        }
        Outcome::Unsolvable(why) => println!("; unsolvable: {why}"),
        Outcome::GaveUp(why) => println!("; gave up: {why}"),
    }
    println!("; {task}");
    println!("; {statistics:?}");
    println!(
        "; parse {} ms, ground {} ms, search {} ms",
        ms(parsed),
        ms(grounded - parsed),
        ms(total - grounded)
    );
    Ok(())
}

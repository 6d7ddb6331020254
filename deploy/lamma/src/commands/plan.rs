//! `lamma plan`: the planner alone.

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use lamma_pddl::ast::{Domain, Problem};
use lamma_pddl::{Report, check_domain, check_problem, parse_domain, parse_problem};
use lamma_planner::validate::CostKind;
use lamma_planner::{
    Engine, GroundError, Limits, Outcome, SearchOptions, ground, solve, write_plan, write_sas,
};

use crate::cli::PlanArgs;
use crate::commands::read_source;
use crate::error::Failure;
use crate::exit;
use crate::out::say;

/// A classical planning task as the user gave it.
pub struct Task {
    /// The domain.
    pub domain: Domain,
    /// The problem.
    pub problem: Problem,
}

/// Reads and checks domain and problem; warnings go to standard error, errors are the failure.
pub fn read_task(domain: &Path, problem: &Path) -> Result<Task, Failure> {
    let (domain_source, problem_source) = (read_source(domain)?, read_source(problem)?);
    let domain = parse_domain(&domain_source).map_err(Failure::bad_input)?;
    let problem = parse_problem(&problem_source).map_err(Failure::bad_input)?;
    warn(&domain.warnings);
    warn(&problem.warnings);
    for report in [
        check_domain(&domain.value, &domain_source),
        check_problem(&domain.value, &problem.value, &problem_source),
    ] {
        if report.has_errors() {
            return Err(Failure::bad_input(report));
        }
        warn(&report);
    }
    Ok(Task { domain: domain.value, problem: problem.value })
}

/// Prints what is odd but no error.
pub fn warn(report: &Report) {
    if !report.is_empty() {
        eprintln!("{report}");
    }
}

/// `auto`, or an engine by name.
fn engine(name: &str) -> Result<Engine, Failure> {
    let known = || Engine::ALL.map(|(name, _)| name).join(", ");
    match name {
        "auto" => Ok(Engine::default()),
        name => Engine::named(name).ok_or_else(|| {
            Failure::bad_input(format!("no search is called {name:?}: use auto, {}", known()))
        }),
    }
}

fn cost_kind(problem: &Problem) -> CostKind {
    if problem.metric.is_some() { CostKind::Metric } else { CostKind::Unit }
}

/// Plans; prints the plan in the IPC format.
pub fn plan(args: &PlanArgs) -> Result<u8, Failure> {
    let task = read_task(&args.domain, &args.problem)?;
    let limits = Limits {
        expansions: None,
        time: args.time_limit.map(Duration::from_secs_f64),
        memory_bytes: args.memory_limit.map(|mib| mib << 20),
    };
    let options = SearchOptions { engine: engine(&args.search)?, ..SearchOptions::default() };
    let cancel = AtomicBool::new(false);
    let grounding = limits.for_grounding(&cancel);
    let grounded = match ground(&task.domain, &task.problem, &grounding) {
        Err(reason @ (GroundError::GaveUp(_) | GroundError::TooLarge { .. })) => {
            eprintln!("gave up: {reason}");
            return Ok(exit::GAVE_UP);
        }
        grounded => grounded.map_err(Failure::bad_input)?,
    };
    if args.sas {
        say(write_sas(&grounded).trim_end());
        return Ok(exit::SUCCESS);
    }
    let outcome = solve(&grounded, &options, &limits.after(&grounding), &cancel);
    match outcome {
        Outcome::Found(plan) => {
            let verdict = lamma_planner::validate::validate(&task.domain, &task.problem, &plan.acts)
                .map_err(Failure::fault)?;
            if !verdict.is_valid() {
                return Err(Failure::fault(format!("the planner found a wrong plan: {verdict}")));
            }
            let text = write_plan(&plan, cost_kind(&task.problem));
            say(text.trim_end());
            if let Some(path) = &args.plan_file {
                std::fs::write(path, &text)
                    .map_err(|e| Failure::bad_input(format!("cannot write {}: {e}", path.display())))?;
            }
            Ok(exit::SUCCESS)
        }
        Outcome::Unsolvable(reason) => {
            eprintln!("unsolvable: {reason}");
            Ok(exit::INFEASIBLE)
        }
        Outcome::GaveUp(limit) => {
            eprintln!("gave up: {limit}");
            Ok(exit::GAVE_UP)
        }
    }
}

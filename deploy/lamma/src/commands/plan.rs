//! `lamma plan`: the planner alone.

mod answer;

use std::mem::ManuallyDrop;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use lamma_pddl::parse_ground_atom;
use lamma_planner::{
    Engine, GroundError, GroundLimits, Limits, Outcome, Plan, SearchOptions, Task, Unsolvable,
    explain_unreachable, ground, never_together, solve, solve_anytime, write_sas,
};

use self::answer::Answer;
use crate::cli::PlanArgs;
use crate::commands::pddl_task::{PddlTask, read_task};
use crate::error::Failure;
use crate::exit;
use crate::guard::{Allowance, guard};
use crate::out::say;

/// The part of the time limit that the work gets: ending takes time, too.
const PUNCTUALITY: f64 = 0.985;

/// The reachable states that may be looked at to say which goals exclude each other: some tenths of a second.
const STATES_TO_EXPLAIN: usize = 200_000;

/// How to search.
#[derive(Clone, Copy)]
enum Search {
    /// Until the engine is content.
    Engine(Engine),
    /// Until the best plan is proved to be one, or the limits end it.
    Anytime,
}

impl Search {
    fn named(name: &str) -> Result<Search, Failure> {
        let known = || Engine::ALL.map(|(name, _)| name).join(", ");
        match name {
            "auto" => Ok(Search::Engine(Engine::default())),
            "anytime" => Ok(Search::Anytime),
            name => Engine::named(name).map(Search::Engine).ok_or_else(|| {
                Failure::bad_input(format!("no search is called {name:?}: use auto, anytime, {}", known()))
            }),
        }
    }
}

/// Plans; prints the plan in the IPC format.
pub fn plan(args: &PlanArgs) -> Result<u8, Failure> {
    let started = Instant::now();
    let search = Search::named(&args.search)?;
    let memory_bytes = args.memory_limit.map(|mib| mib as usize * (1 << 20));
    let allowance = Allowance {
        deadline: args.time_limit.and_then(|s| started.checked_add(Duration::from_secs_f64(s * PUNCTUALITY))),
        memory_bytes,
    };
    let answer = Arc::new(Mutex::new(Answer::new(args, started)));
    let last_word = Arc::clone(&answer);
    guard(allowance, move |stop| {
        let mut answer = last_word.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(code) = answer.stopped(&stop.to_string()) {
            std::process::exit(i32::from(code));
        }
    })?;
    // The guard holds the limit, by what is resident. What a search counts includes memory that it reserved and
    // has not used, so it counts against more.
    let limits =
        Limits { memory_bytes: memory_bytes.map(|bytes| bytes.saturating_mul(2)), ..Limits::default() };
    let code = search_and_tell(args, search, &limits, &answer);
    // Whoever comes too late has nothing to say.
    answer.lock().unwrap_or_else(PoisonError::into_inner).close();
    code
}

fn search_and_tell(
    args: &PlanArgs,
    search: Search,
    limits: &Limits,
    answer: &Mutex<Answer>,
) -> Result<u8, Failure> {
    // The process ends with this call: giving back what these hold piece by piece would be time lost.
    let task = ManuallyDrop::new(read_task(&args.domain, &args.problem)?);
    let told = || answer.lock().unwrap_or_else(PoisonError::into_inner);
    told().read(&task);
    let grounded = match ground(&task.domain, &task.problem, &GroundLimits::default()) {
        Ok(grounded) => ManuallyDrop::new(grounded),
        Err(error @ (GroundError::Malformed(_) | GroundError::Unsupported(_))) => {
            return Err(Failure::bad_input(error));
        }
        Err(error) => return Ok(told().gave_up(&error.to_string())),
    };
    told().grounded(&grounded.warnings);
    if args.sas {
        if grounded.has_numbers() {
            return Err(Failure::bad_input("the format of --sas has no numbers, and this task reads some"));
        }
        say(write_sas(&grounded).trim_end());
        return Ok(exit::SUCCESS);
    }
    let mut wrong = None;
    let mut found = |plan: &Plan| match checked(&task, plan) {
        Ok(plan) => told().found(plan),
        Err(failure) => {
            wrong = Some(failure);
            Ok(())
        }
    };
    let cancel = AtomicBool::new(false);
    let mut written = Ok(());
    let (outcome, optimal) = match search {
        Search::Engine(engine) => {
            let options = SearchOptions { engine, ..SearchOptions::default() };
            let outcome = solve(&grounded, &options, limits, &cancel);
            if let Outcome::Found(plan) = &outcome {
                written = found(plan);
            }
            (outcome, engine != Engine::Portfolio)
        }
        Search::Anytime => {
            let end = solve_anytime(&grounded, limits, &cancel, &mut |plan| {
                let before = std::mem::replace(&mut written, Ok(()));
                written = before.and_then(|()| found(plan));
            });
            (end.outcome, end.optimal)
        }
    };
    if let Some(failure) = wrong {
        return Err(failure);
    }
    written?;
    let mut answer = told();
    Ok(match outcome {
        Outcome::Found(_) => answer.done(optimal && grounded.warnings.is_empty()),
        Outcome::Unsolvable(reason) => answer.unsolvable(&because(&task, &grounded, &reason)),
        Outcome::GaveUp(limit) => answer.gave_up(&limit.to_string()),
    })
}

/// The reason with the cause of each part, where there is a single one, or with the parts that exclude each other.
fn because(task: &PddlTask, grounded: &Task, reason: &Unsolvable) -> String {
    let Unsolvable::Unreachable(facts) = reason else {
        let apart = never_together(grounded, STATES_TO_EXPLAIN).map(|parts| match &parts[..] {
            [alone] => format!("\n  this part of it never holds: {alone}"),
            parts => format!("\n  these parts of it never hold together: {}", parts.join(", ")),
        });
        return format!("{reason}{}", apart.unwrap_or_default());
    };
    let causes = facts.iter().filter_map(|fact| {
        let atom = parse_ground_atom(fact).ok()?;
        let cause = explain_unreachable(&task.domain, &task.problem, &atom)?;
        Some(format!("\n  {fact}: {cause}"))
    });
    format!("{reason}{}", causes.collect::<String>())
}

/// The plan with its true cost, as the plain interpreter sees both.
fn checked(task: &PddlTask, plan: &Plan) -> Result<Plan, Failure> {
    match lamma_planner::validate(&task.domain, &task.problem, &plan.acts).map_err(Failure::fault)? {
        lamma_planner::Verdict::Valid { cost, .. } => Ok(Plan { acts: plan.acts.clone(), cost }),
        wrong => Err(Failure::fault(format!("the planner found a wrong plan: {wrong}"))),
    }
}

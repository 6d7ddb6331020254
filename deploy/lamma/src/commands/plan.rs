//! `lamma plan`: the planner alone.

mod answer;

use std::mem::ManuallyDrop;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use lamma_pddl::parse_ground_atom;
use lamma_planner::{
    Engine, GaveUp, GroundError, GroundLimits, Limits, Outcome, Plan, SearchOptions, Task, Unsolvable,
    explain_unreachable, ground, never_together, solve, solve_anytime, write_sas,
};

use self::answer::Answer;
use crate::cli::PlanArgs;
use crate::commands::pddl_task::{PddlTask, read_task};
use crate::error::Failure;
use crate::exit;
use crate::guard::{Allowance, Guard, Stop};
use crate::out::say;

/// The part of the time limit that the work gets: ending takes time, too.
const PUNCTUALITY: f64 = 0.985;

/// The reachable states that may be looked at to say which goals exclude each other: some tenths of a second.
const STATES_TO_EXPLAIN: usize = 200_000;

/// Files of up to so many bytes are read, and tasks of up to so many operators searched, without steps longer than
/// some milliseconds.
const SHORT_FILE_BYTES: u64 = 1 << 18;
const FEW_OPERATORS: usize = 5_000;

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
    let guard = Guard::new(allowance, move |stop| {
        let mut answer = last_word.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(code) = answer.stopped(&stop.to_string()) {
            std::process::exit(i32::from(code));
        }
    })?;
    // The guard holds the limit, by what is resident. What a search counts includes memory that it reserved and
    // has not used, so it counts against more.
    let limits =
        Limits { memory_bytes: memory_bytes.map(|bytes| bytes.saturating_mul(2)), ..Limits::default() };
    let code = Work { args, limits, answer: &answer, guard }.run(search);
    // Whoever comes too late has nothing to say.
    answer.lock().unwrap_or_else(PoisonError::into_inner).close();
    code
}

/// What the command does, under the guard.
struct Work<'a> {
    args: &'a PlanArgs,
    limits: Limits,
    answer: &'a Mutex<Answer>,
    guard: Guard,
}

impl<'a> Work<'a> {
    fn told(&self) -> MutexGuard<'a, Answer> {
        self.answer.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn run(mut self, search: Search) -> Result<u8, Failure> {
        let short = is_short(&self.args.domain) && is_short(&self.args.problem);
        if matches!(search, Search::Anytime) || !short {
            self.guard.watch()?;
        }
        // The process ends with this call: giving back what these hold piece by piece would be time lost.
        let task = ManuallyDrop::new(read_task(&self.args.domain, &self.args.problem)?);
        self.told().read(&task);
        let grounding = GroundLimits { cancel: Some(self.guard.signalled()), ..GroundLimits::default() };
        let grounded = match ground(&task.domain, &task.problem, &grounding) {
            Ok(grounded) => ManuallyDrop::new(grounded),
            Err(error @ (GroundError::Malformed(_) | GroundError::Unsupported(_))) => {
                return Err(Failure::bad_input(error));
            }
            Err(GroundError::GaveUp(GaveUp::Cancelled)) => return Ok(self.interrupted()),
            Err(error) => return Ok(self.told().gave_up(&error.to_string())),
        };
        if grounded.operators.len() > FEW_OPERATORS {
            self.guard.watch()?;
        }
        self.told().grounded(&grounded.warnings);
        if self.args.sas {
            return print_sas(&grounded);
        }
        let (outcome, optimal) = self.search(search, &task, &grounded)?;
        Ok(match outcome {
            Outcome::Found(_) => self.told().done(optimal && grounded.warnings.is_empty()),
            Outcome::Unsolvable(reason) => {
                self.guard.watch()?;
                let cause = because(&task, &grounded, &reason);
                self.told().unsolvable(&cause)
            }
            Outcome::GaveUp(GaveUp::Cancelled) => self.interrupted(),
            Outcome::GaveUp(limit) => self.told().gave_up(&limit.to_string()),
        })
    }

    /// How the search ended, and whether no plan is cheaper than the last one found. Each plan is checked and told.
    fn search(&self, search: Search, task: &PddlTask, grounded: &Task) -> Result<(Outcome, bool), Failure> {
        let mut told = Ok(());
        let mut found = |plan: &Plan| {
            let before = std::mem::replace(&mut told, Ok(()));
            told = before.and_then(|()| checked(task, plan)).and_then(|plan| self.told().found(plan));
        };
        let end = match search {
            Search::Engine(engine) => {
                let options = SearchOptions { engine, ..SearchOptions::default() };
                let outcome = solve(grounded, &options, &self.limits, self.guard.signalled());
                if let Outcome::Found(plan) = &outcome {
                    found(plan);
                }
                (outcome, engine != Engine::Portfolio)
            }
            // It is the guard that says with which plan this one was interrupted.
            Search::Anytime => {
                let end = solve_anytime(grounded, &self.limits, &AtomicBool::new(false), &mut found);
                (end.outcome, end.optimal)
            }
        };
        told.map(|()| end)
    }

    /// The search saw the signal before the guard did. Where the guard has answered it ends the process, too.
    fn interrupted(&self) -> u8 {
        self.told().stopped(&Stop::Signal.to_string()).unwrap_or(exit::GAVE_UP)
    }
}

/// Whether reading a file takes no time to speak of. A pipe may keep its reader waiting.
fn is_short(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|metadata| metadata.is_file() && metadata.len() <= SHORT_FILE_BYTES)
}

fn print_sas(task: &Task) -> Result<u8, Failure> {
    if task.has_numbers() {
        return Err(Failure::bad_input("the format of --sas has no numbers, and this task reads some"));
    }
    say(write_sas(task).trim_end());
    Ok(exit::SUCCESS)
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

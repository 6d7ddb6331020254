//! The one answer of `lamma plan`, whoever gives it: the search when it is done, or the guard when a limit is
//! reached.

use std::path::{Path, PathBuf};
use std::time::Instant;

use lamma_planner::validate::CostKind;
use lamma_planner::{Plan, write_plan};
use serde_json::{Value, json};

use crate::cli::{Format, PlanArgs};
use crate::commands::pddl_task::PddlTask;
use crate::error::Failure;
use crate::exit;
use crate::out::say;

/// What is known so far.
pub struct Answer {
    format: Format,
    /// Say of each plan when it was found.
    announce: bool,
    plan_file: Option<PathBuf>,
    started: Instant,
    kind: CostKind,
    diagnostics: Vec<Value>,
    /// Milliseconds until the task was read and until it was grounded.
    read_ms: Option<f64>,
    grounded_ms: Option<f64>,
    best: Option<Plan>,
    closed: bool,
}

impl Answer {
    /// Nothing is known.
    pub fn new(args: &PlanArgs, started: Instant) -> Self {
        Answer {
            format: args.format,
            announce: args.search == "anytime",
            plan_file: args.plan_file.clone(),
            started,
            kind: CostKind::Unit,
            diagnostics: Vec::new(),
            read_ms: None,
            grounded_ms: None,
            best: None,
            closed: false,
        }
    }

    fn elapsed_ms(&self) -> f64 {
        self.started.elapsed().as_secs_f64() * 1e3
    }

    /// The task was read.
    pub fn read(&mut self, task: &PddlTask) {
        self.read_ms = Some(self.elapsed_ms());
        self.diagnostics.clone_from(&task.warnings);
        self.kind = if task.problem.metric.is_some() { CostKind::Metric } else { CostKind::Unit };
    }

    /// The task was grounded.
    pub fn grounded(&mut self, warnings: &[String]) {
        self.grounded_ms = Some(self.elapsed_ms());
        for warning in warnings {
            eprintln!("warning: {warning}");
            self.diagnostics.push(json!({ "severity": "warning", "message": warning }));
        }
    }

    /// A plan better than those before. The plan file always holds the best one, whole.
    pub fn found(&mut self, plan: Plan) -> Result<(), Failure> {
        if self.announce {
            let seconds = self.elapsed_ms() / 1e3;
            eprintln!(
                "found a plan of cost {} with {} actions after {seconds:.2} s",
                plan.cost,
                plan.acts.len()
            );
        }
        if let Some(path) = &self.plan_file {
            replace(path, &write_plan(&plan, self.kind))
                .map_err(|e| Failure::bad_input(format!("cannot write {}: {e}", path.display())))?;
        }
        self.best = Some(plan);
        Ok(())
    }

    /// The search is over. The exit code.
    pub fn done(&mut self, optimal: bool) -> u8 {
        if self.announce && optimal {
            eprintln!("no plan is cheaper");
        }
        self.tell("success", None, optimal);
        exit::SUCCESS
    }

    /// There is no plan. The exit code.
    pub fn unsolvable(&mut self, reason: &str) -> u8 {
        eprintln!("unsolvable: {reason}");
        self.tell("infeasible", Some(reason), false);
        exit::INFEASIBLE
    }

    /// The search stopped of itself. The exit code.
    pub fn gave_up(&mut self, reason: &str) -> u8 {
        eprintln!("gave up: {reason}");
        self.tell("gave_up", Some(reason), false);
        exit::GAVE_UP
    }

    /// A limit is reached: the best plan so far is the answer. The exit code; none if the answer was given
    /// already.
    pub fn stopped(&mut self, reason: &str) -> Option<u8> {
        if self.closed {
            return None;
        }
        if self.best.is_none() {
            return Some(self.gave_up(reason));
        }
        eprintln!("stopped: {reason}");
        self.tell("success", None, false);
        Some(exit::SUCCESS)
    }

    /// Nothing more is said.
    pub fn close(&mut self) {
        self.closed = true;
    }

    fn tell(&mut self, outcome: &str, reason: Option<&str>, optimal: bool) {
        self.close();
        match (self.format, &self.best) {
            (Format::Text, Some(plan)) => say(write_plan(plan, self.kind).trim_end()),
            (Format::Text, None) => {}
            (Format::Json, best) => {
                let mut answer = json!({
                    "outcome": outcome,
                    "optimal": optimal,
                    "plan": best.as_ref().map(|plan| self.plan(plan)),
                    "diagnostics": self.diagnostics,
                    "time_ms": { "read": self.read_ms, "grounded": self.grounded_ms, "total": self.elapsed_ms() },
                });
                if let Some(reason) = reason {
                    answer["reason"] = json!(reason);
                }
                say(answer);
            }
        }
    }

    fn plan(&self, plan: &Plan) -> Value {
        let action = |act: &lamma_planner::GroundAct| {
            let args: Vec<&str> = act.args.iter().map(|arg| arg.as_str()).collect();
            json!({ "action": act.action.as_str(), "args": args })
        };
        json!({
            "actions": plan.acts.iter().map(action).collect::<Vec<_>>(),
            "length": plan.acts.len(),
            "cost": plan.cost,
            "cost_kind": self.kind.to_string(),
        })
    }
}

/// Writes a file whole or not at all, so that a reader never sees half a plan.
fn replace(path: &Path, text: &str) -> std::io::Result<()> {
    // A pipe or a terminal is written to as it is.
    if path.metadata().is_ok_and(|metadata| !metadata.is_file()) {
        return std::fs::write(path, text);
    }
    let mut partial = path.as_os_str().to_owned();
    partial.push(".part");
    std::fs::write(&partial, text)?;
    std::fs::rename(&partial, path)
}

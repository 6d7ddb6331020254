//! `lamma validate`: the validator alone.

use lamma_planner::Verdict;
use serde_json::json;

use crate::cli::{Format, ValidateArgs};
use crate::commands::pddl_task::read_task;
use crate::commands::read_source;
use crate::error::Failure;
use crate::exit;
use crate::out::say;

/// Checks the plan; 0 if it is valid, 1 with the reason if not.
pub fn validate(args: &ValidateArgs) -> Result<u8, Failure> {
    let task = read_task(&args.domain, &args.problem)?;
    let source = read_source(&args.plan)?;
    let acts = lamma_planner::read_plan(&source)
        .map_err(|report| Failure::diagnosed(&report, task.warnings.clone()))?;
    let verdict = lamma_planner::validate(&task.domain, &task.problem, &acts).map_err(Failure::bad_input)?;
    match args.format {
        Format::Text => say(format_args!("{verdict}")),
        Format::Json => {
            let (cost, step) = match &verdict {
                Verdict::Valid { cost, .. } => (Some(*cost), None),
                Verdict::Impossible { step, .. } => (None, Some(step + 1)),
                Verdict::GoalNotReached { .. } => (None, None),
            };
            say(json!({
                "outcome": if verdict.is_valid() { "success" } else { "goal_not_reached" },
                "valid": verdict.is_valid(),
                "reason": verdict.to_string(),
                "cost": cost,
                "step": step,
                "diagnostics": task.warnings,
            }));
        }
    }
    Ok(if verdict.is_valid() { exit::SUCCESS } else { exit::NOT_REACHED })
}

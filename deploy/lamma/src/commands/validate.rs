//! `lamma validate`: the validator alone.

use crate::cli::ValidateArgs;
use crate::commands::plan::read_task;
use crate::commands::read_source;
use crate::error::Failure;
use crate::exit;
use crate::out::say;

/// Checks the plan; 0 if it is valid, 1 with the reason if not.
pub fn validate(args: &ValidateArgs) -> Result<u8, Failure> {
    let task = read_task(&args.domain, &args.problem)?;
    let source = read_source(&args.plan)?;
    let acts = lamma_planner::read_plan(&source).map_err(Failure::bad_input)?;
    let verdict = lamma_planner::validate(&task.domain, &task.problem, &acts).map_err(Failure::bad_input)?;
    say(format_args!("{verdict}"));
    Ok(if verdict.is_valid() { exit::SUCCESS } else { exit::NOT_REACHED })
}

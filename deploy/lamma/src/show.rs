//! A result for people: the outcome, the timeline, the metrics.

use std::fmt::Write;

use anstyle::{AnsiColor, Style};
use lamma_coordinator::result::{ActionResult, OutcomeKind, RunResult};

const GOOD: Style = AnsiColor::Green.on_default().bold();
const BAD: Style = AnsiColor::Red.on_default().bold();
const HEAD: Style = Style::new().bold();

/// The whole text, with colours that the stream may strip.
pub fn result(result: &RunResult) -> String {
    let mut out = String::new();
    // Writing to a string does not fail.
    let _ = outcome(&mut out, result);
    if let Some(ask) = &result.clarification {
        let _ = clarification(&mut out, ask);
    }
    if !result.plan.actions.is_empty() {
        let _ = timeline(&mut out, &result.plan.actions);
    }
    if result.outcome != OutcomeKind::NeedsClarification {
        let _ = numbers(&mut out, result);
    }
    out
}

fn outcome(out: &mut String, result: &RunResult) -> std::fmt::Result {
    let word = match result.outcome {
        OutcomeKind::Success => "success",
        OutcomeKind::GoalNotReached => "goal not reached",
        OutcomeKind::Infeasible => "infeasible",
        OutcomeKind::GaveUp => "gave up",
        OutcomeKind::NeedsClarification => "needs clarification",
        OutcomeKind::Error => "error",
    };
    let style = if result.outcome == OutcomeKind::Success { GOOD } else { BAD };
    writeln!(
        out,
        "\n{style}{word}{style:#}{}",
        result.reason.as_ref().map(|r| format!(": {r}")).unwrap_or_default()
    )
}

fn clarification(out: &mut String, ask: &serde_json::Value) -> std::fmt::Result {
    for (key, title) in [("understood", "understood"), ("not_understood", "not understood")] {
        let list = ask.get(key).and_then(|v| v.as_array()).into_iter().flatten();
        for item in list.filter_map(|v| v.as_str()) {
            writeln!(out, "  {title}: {item}")?;
        }
    }
    let readings = ask.get("readings").and_then(|v| v.as_array()).into_iter().flatten();
    for (i, reading) in readings.enumerate() {
        let subtasks = reading.get("subtasks").and_then(|v| v.as_array()).into_iter().flatten();
        let texts: Vec<&str> = subtasks.filter_map(|s| s.get("text")?.as_str()).collect();
        writeln!(out, "  reading {}: {}", i + 1, texts.join("; "))?;
    }
    writeln!(out, "  (say it in other words, or pass --assume to take the best reading)")
}

/// One row per robot, one column per step.
fn timeline(out: &mut String, actions: &[ActionResult]) -> std::fmt::Result {
    let mut robots: Vec<&str> = actions.iter().map(|a| a.robot.as_str()).collect();
    robots.sort_unstable();
    robots.dedup();
    let name_width = robots.iter().map(|r| r.len()).max().unwrap_or(0);
    writeln!(out, "\n{HEAD}timeline{HEAD:#} (start in steps)")?;
    for robot in robots {
        write!(out, "  {robot:name_width$}")?;
        for action in actions.iter().filter(|a| a.robot == robot) {
            write!(out, "  {}:{}({})", action.start, action.action, action.args.join(", "))?;
        }
        writeln!(out)?;
    }
    Ok(())
}

fn bound(result: &RunResult) -> String {
    let (makespan, bound) = (result.plan.makespan, result.plan.makespan_lower_bound);
    match () {
        () if result.outcome != OutcomeKind::Success => String::new(),
        () if makespan <= bound => " (proved shortest)".into(),
        () => format!(" (no plan is shorter than {bound})"),
    }
}

fn numbers(out: &mut String, result: &RunResult) -> std::fmt::Result {
    let plan = &result.plan;
    writeln!(
        out,
        "\n{HEAD}plan{HEAD:#}     {} steps, makespan {}{}",
        plan.length,
        plan.makespan,
        bound(result)
    )?;
    let goal = &result.goal;
    writeln!(out, "{HEAD}goal{HEAD:#}     {} of {} facts hold", goal.reached, goal.total)?;
    for missing in &goal.missing {
        writeln!(out, "         missing: {missing}")?;
    }
    let m = &result.metrics;
    let optional = |v: Option<f64>| v.map_or("-".to_string(), |v| format!("{v:.2}"));
    writeln!(
        out,
        "{HEAD}metrics{HEAD:#}  SR {:.2}  GCR {:.2}  Exe {}  RU {}  Eff {}",
        m.sr,
        m.gcr,
        if plan.length > 0 { format!("{:.2}", m.exe) } else { "-".into() },
        optional(m.ru),
        optional(m.eff)
    )?;
    let t = &result.time_ms;
    writeln!(
        out,
        "{HEAD}time{HEAD:#}     start {:.0} ms, decompose {:.1}, allocate {:.1}, plan {:.1}, combine {:.1}, execute {:.1}; total {:.0} ms",
        t.start, t.decompose, t.allocate, t.plan, t.combine, t.execute, t.total
    )
}

//! The metric table, laid out like the paper's: one row per category.

use std::collections::BTreeMap;
use std::fmt::Write;

use lamma_coordinator::result::OutcomeKind;
use serde_json::{Value, json};

use crate::commands::bench::Finished;
use crate::suite::Suite;

/// A row: means over the tasks of a category; RU and Eff over its successes.
#[derive(Clone, Debug, Default)]
pub struct Row {
    /// The category.
    pub name: String,
    /// How many tasks.
    pub n: usize,
    /// The paper's metrics.
    pub sr: f64,
    /// See [`Row::sr`].
    pub exe: f64,
    /// See [`Row::sr`].
    pub gcr: f64,
    /// See [`Row::sr`]; over successes.
    pub ru: Option<f64>,
    /// See [`Row::sr`]; over successes.
    pub eff: Option<f64>,
    /// Makespan / proved lower bound, over successes.
    ratio: Option<f64>,
    /// Share of the successes whose makespan is the proved lower bound.
    proved: Option<f64>,
}

/// The rows: a category each, all together, and for imported suites those that were not set aside.
pub fn rows(suite: &Suite, finished: &[Finished]) -> Vec<Row> {
    let mut by_category: BTreeMap<&str, Vec<&Finished>> = BTreeMap::new();
    for f in finished {
        by_category.entry(suite.entries[f.index].task.category.as_str()).or_default().push(f);
    }
    let mut rows: Vec<Row> = by_category.iter().map(|(name, tasks)| Row::of(name, tasks)).collect();
    let all: Vec<&Finished> = finished.iter().collect();
    rows.push(Row::of("all", &all));
    if suite.imported {
        let kept = |f: &&Finished| suite.entries[f.index].set_aside.is_none();
        for (name, tasks) in &by_category {
            let kept: Vec<&Finished> = tasks.iter().copied().filter(kept).collect();
            rows.push(Row::of(&format!("{name}, goal agrees"), &kept));
        }
        let agreeing: Vec<&Finished> = all.iter().copied().filter(kept).collect();
        rows.push(Row::of("all, goal agrees", &agreeing));
    }
    // With their own goals given, those that are not reached and not proved out of reach are failures.
    if suite.imported && suite.goals_given {
        let reachable: Vec<&Finished> =
            all.into_iter().filter(|f| f.result.outcome != OutcomeKind::Infeasible).collect();
        rows.push(Row::of("all, not proved out of reach", &reachable));
    }
    rows
}

impl Row {
    fn of(name: &str, tasks: &[&Finished]) -> Row {
        let mean = |values: Vec<f64>| {
            if values.is_empty() { None } else { Some(values.iter().sum::<f64>() / values.len() as f64) }
        };
        let metric = |f: fn(&Finished) -> f64| mean(tasks.iter().map(|t| f(t)).collect()).unwrap_or(0.0);
        Row {
            name: name.to_string(),
            n: tasks.len(),
            sr: metric(|t| t.result.metrics.sr),
            exe: metric(|t| t.result.metrics.exe),
            gcr: metric(|t| t.result.metrics.gcr),
            ru: mean(tasks.iter().filter_map(|t| t.result.metrics.ru).collect()),
            eff: mean(tasks.iter().filter_map(|t| t.result.metrics.eff).collect()),
            ratio: mean(tasks.iter().filter_map(|t| ratio(t)).collect()),
            proved: mean(
                tasks.iter().filter_map(|t| ratio(t)).map(|r| f64::from(u8::from(r <= 1.0))).collect(),
            ),
        }
    }

    /// As the contract prints it.
    pub fn json(&self) -> Value {
        json!({
            "n": self.n, "sr": self.sr, "exe": self.exe, "gcr": self.gcr, "ru": self.ru, "eff": self.eff,
            "makespan_ratio": self.ratio, "proved": self.proved,
        })
    }

    /// One line per task, for spreadsheets.
    pub fn csv(suite: &Suite, finished: &[Finished]) -> String {
        let mut out = String::from(
            "id,category,outcome,sr,gcr,exe,ru,eff,steps,makespan,makespan_lower_bound,set_aside\n",
        );
        for f in finished {
            let (entry, m, plan) = (&suite.entries[f.index], &f.result.metrics, &f.result.plan);
            let outcome = serde_json::to_value(f.result.outcome).unwrap_or_default();
            let optional = |v: Option<f64>| v.map(|v| v.to_string()).unwrap_or_default();
            // Writing to a string does not fail.
            let _ = writeln!(
                out,
                "{},{},{},{},{},{},{},{},{},{},{},{}",
                entry.task.id,
                entry.task.category,
                outcome.as_str().unwrap_or_default(),
                m.sr,
                m.gcr,
                m.exe,
                optional(m.ru),
                optional(m.eff),
                plan.length,
                plan.makespan,
                plan.makespan_lower_bound,
                u8::from(entry.set_aside.is_some()),
            );
        }
        out
    }
}

/// Makespan / proved lower bound of a success; 1 where there was nothing to do.
fn ratio(finished: &Finished) -> Option<f64> {
    let plan = &finished.result.plan;
    let success = finished.result.outcome == OutcomeKind::Success;
    success
        .then(|| if plan.makespan > 0.0 { plan.makespan / plan.makespan_lower_bound.max(1.0) } else { 1.0 })
}

/// The table for people.
pub fn text(name: &str, rows: &[Row]) -> String {
    let width = rows.iter().map(|r| r.name.len()).max().unwrap_or(0).max(8);
    let mut out =
        format!("\n{name}\n{:width$}    n    SR    RU   GCR   Eff   Exe  M/LB  proved\n", "category");
    let optional = |v: Option<f64>| v.map_or("   -".to_string(), |v| format!("{v:.2}"));
    for r in rows {
        let _ = writeln!(
            out,
            "{:width$}  {:3}  {:.2}  {}  {:.2}  {}  {:.2}  {}    {}",
            r.name,
            r.n,
            r.sr,
            optional(r.ru),
            r.gcr,
            optional(r.eff),
            r.exe,
            optional(r.ratio),
            optional(r.proved),
        );
    }
    out
}

/// What RU and Eff were measured against.
pub fn references(suite: &Suite, n: usize, travel: bool) -> String {
    if travel {
        return "RU and Eff: against the run's own first plan (--travel: the references of files are in unit steps)".into();
    }
    let known = || suite.entries.iter().filter_map(|e| e.task.reference);
    let tight = known().filter(|r| r.makespan == r.lower_bound).count();
    format!(
        "RU and Eff: against the best schedule known: for {} of {n} tasks the file's (for {tight} of them proved to be \
         the shortest), else the run's own first plan",
        known().count()
    )
}

/// What the released evaluator's formulas give, over the runs that they can be applied to.
pub fn compat(finished: &[Finished]) -> String {
    let scores: Vec<_> = finished.iter().filter_map(|f| f.compat).collect();
    let n = scores.len().max(1) as f64;
    let (tc, gcr) = scores.iter().fold((0.0, 0.0), |(tc, gcr), s| (tc + s.tc, gcr + s.gcr));
    format!(
        "released evaluator's formulas, for comparison only: TC {:.2}  GCR {:.2} (can exceed 1) over {} of {} runs; \
         its Eff does not exist and its RU counts blank lines of generated Python",
        tc / n,
        gcr / n,
        scores.len(),
        finished.len()
    )
}

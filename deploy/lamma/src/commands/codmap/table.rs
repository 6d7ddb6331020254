//! The table: coverage, time, and makespans beside the reference and the proved bound, one row per domain.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde_json::{Value, json};

use super::Finished;
use super::set::{Set, TaskFolder};

/// A row.
pub struct Row {
    /// The domain, or `all`.
    pub name: String,
    n: usize,
    solved: usize,
    median_s: Option<f64>,
    median_cpu_s: Option<f64>,
    /// Makespan / best known makespan, geometric mean over those solved here and there.
    to_best: Option<f64>,
    /// Share of them with a makespan no longer than the best known.
    no_worse: Option<f64>,
    /// Makespan / proved lower bound, median.
    to_bound: Option<f64>,
    /// The reference's best makespan / proved lower bound, median.
    best_to_bound: Option<f64>,
    /// Share of makespans that are proved shortest.
    proved: Option<f64>,
}

type Pair<'a> = (&'a TaskFolder, &'a Finished);

/// A row for each domain, and one for all.
pub fn rows(set: &Set, finished: &[Finished]) -> Vec<Row> {
    let mut domains: BTreeMap<&str, Vec<Pair<'_>>> = BTreeMap::new();
    for pair in set.tasks.iter().zip(finished) {
        domains.entry(&pair.0.domain).or_default().push(pair);
    }
    let mut rows: Vec<Row> = domains.iter().map(|(name, pairs)| Row::of(name, pairs)).collect();
    let all: Vec<Pair<'_>> = set.tasks.iter().zip(finished).collect();
    rows.push(Row::of("all", &all));
    rows
}

impl Row {
    fn of(name: &str, pairs: &[Pair<'_>]) -> Row {
        let solved: Vec<&Pair<'_>> = pairs.iter().filter(|(_, f)| f.is_solved()).collect();
        let makespan = |f: &Finished| f.result.plan.makespan;
        let to_best: Vec<f64> = solved
            .iter()
            .filter_map(|(task, f)| {
                let best = task.reference?.best_makespan.filter(|best| *best > 0.0)?;
                Some(makespan(f) / best)
            })
            .collect();
        let to_bound: Vec<f64> = solved
            .iter()
            .filter(|(_, f)| f.result.plan.makespan_lower_bound > 0.0)
            .map(|(_, f)| makespan(f) / f.result.plan.makespan_lower_bound)
            .collect();
        let best_to_bound: Vec<f64> = pairs
            .iter()
            .filter(|(_, f)| f.result.plan.makespan_lower_bound > 0.0)
            .filter_map(|(task, f)| Some(task.reference?.best_makespan? / f.result.plan.makespan_lower_bound))
            .collect();
        Row {
            name: name.to_string(),
            n: pairs.len(),
            solved: solved.len(),
            median_s: median(solved.iter().map(|(_, f)| f.wall_s).collect()),
            median_cpu_s: median(solved.iter().filter_map(|(_, f)| f.cpu_s).collect()),
            no_worse: share(&to_best),
            to_best: geometric_mean(&to_best),
            proved: share(&to_bound),
            to_bound: median(to_bound),
            best_to_bound: median(best_to_bound),
        }
    }

    /// As the contract prints it.
    pub fn json(&self) -> Value {
        json!({
            "n": self.n,
            "solved": self.solved,
            "median_s": self.median_s,
            "median_cpu_s": self.median_cpu_s,
            "makespan_to_best_geomean": self.to_best,
            "share_no_worse_than_best": self.no_worse,
            "makespan_to_bound_median": self.to_bound,
            "best_to_bound_median": self.best_to_bound,
            "share_proved_shortest": self.proved,
        })
    }
}

/// The share of ratios that are at most 1.
fn share(ratios: &[f64]) -> Option<f64> {
    let good = ratios.iter().filter(|ratio| **ratio <= 1.0 + 1e-9).count();
    (!ratios.is_empty()).then(|| good as f64 / ratios.len() as f64)
}

fn geometric_mean(ratios: &[f64]) -> Option<f64> {
    let logs: Vec<f64> = ratios.iter().filter(|ratio| **ratio > 0.0).map(|ratio| ratio.ln()).collect();
    (!logs.is_empty()).then(|| (logs.iter().sum::<f64>() / logs.len() as f64).exp())
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let (low, high) = (values.get(values.len().checked_sub(1)? / 2)?, values.get(values.len() / 2)?);
    Some((low + high) / 2.0)
}

/// The table for people.
pub fn text(name: &str, rows: &[Row]) -> String {
    let width = rows.iter().map(|r| r.name.len()).max().unwrap_or(0).max(8);
    let mut out = format!(
        "\n{name}\n{:width$}  solved   median s  CPU s   makespan/best  no worse  makespan/bound  best/bound  proved\n",
        "domain"
    );
    let number = |v: Option<f64>| v.map_or("-".to_string(), |v| format!("{v:.2}"));
    for r in rows {
        // Writing to a string does not fail.
        let _ = writeln!(
            out,
            "{:width$}  {:3}/{:<3}  {:>8}  {:>6}  {:>13}  {:>8}  {:>14}  {:>10}  {:>6}",
            r.name,
            r.solved,
            r.n,
            number(r.median_s),
            number(r.median_cpu_s),
            number(r.to_best),
            number(r.no_worse),
            number(r.to_bound),
            number(r.best_to_bound),
            number(r.proved),
        );
    }
    out
}

/// One line per task, for spreadsheets.
pub fn csv(set: &Set, finished: &[Finished]) -> String {
    let mut out = String::from(
        "id,domain,outcome,valid,wall_s,cpu_s,steps,makespan,makespan_lower_bound,best_makespan\n",
    );
    let optional = |v: Option<f64>| v.map(|v| v.to_string()).unwrap_or_default();
    for (task, f) in set.tasks.iter().zip(finished) {
        let outcome = serde_json::to_value(f.result.outcome).unwrap_or_default();
        let plan = &f.result.plan;
        let _ = writeln!(
            out,
            "{},{},{},{},{:.3},{},{},{},{},{}",
            task.id,
            task.domain,
            outcome.as_str().unwrap_or_default(),
            u8::from(f.invalid.is_none()),
            f.wall_s,
            optional(f.cpu_s),
            plan.length,
            plan.makespan,
            plan.makespan_lower_bound,
            optional(task.reference.and_then(|r| r.best_makespan)),
        );
    }
    out
}

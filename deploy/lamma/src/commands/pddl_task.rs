//! Reading a classical PDDL task: two files, checked together.

use std::path::Path;

use lamma_pddl::ast::{Domain, Problem};
use lamma_pddl::{Report, check_domain, check_problem, parse_domain, parse_problem};
use serde_json::Value;

use crate::commands::read_source;
use crate::error::{Failure, diagnostics};

/// A classical planning task as the user gave it.
pub struct PddlTask {
    /// The domain.
    pub domain: Domain,
    /// The problem.
    pub problem: Problem,
    /// What is odd about them, as data.
    pub warnings: Vec<Value>,
}

/// Reads and checks domain and problem; warnings go to standard error, errors are the failure.
pub fn read_task(domain: &Path, problem: &Path) -> Result<PddlTask, Failure> {
    let (domain_source, problem_source) = (read_source(domain)?, read_source(problem)?);
    let mut warnings = Vec::new();
    let domain = parse_domain(&domain_source).map_err(|report| Failure::diagnosed(&report, Vec::new()))?;
    note(&domain.warnings, &mut warnings)?;
    let problem =
        parse_problem(&problem_source).map_err(|report| Failure::diagnosed(&report, warnings.clone()))?;
    note(&problem.warnings, &mut warnings)?;
    note(&check_domain(&domain.value, &domain_source), &mut warnings)?;
    note(&check_problem(&domain.value, &problem.value, &problem_source), &mut warnings)?;
    Ok(PddlTask { domain: domain.value, problem: problem.value, warnings })
}

/// Takes down what a report says; its errors are the failure.
fn note(report: &Report, warnings: &mut Vec<Value>) -> Result<(), Failure> {
    if report.has_errors() {
        return Err(Failure::diagnosed(report, std::mem::take(warnings)));
    }
    if !report.is_empty() {
        eprintln!("{report}");
        warnings.extend(diagnostics(report));
    }
    Ok(())
}

//! A package's problem, planned in the robot's own domain.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use lamma_pddl::ast::Domain;
use lamma_pddl::{Source, check_problem, parse_problem};
use lamma_planner::validate::validate;
use lamma_planner::{Limits, Outcome, SearchOptions, plan_with};
use lamma_protocol::message::{Act, Package, PackageReport, PlanResult};

/// States estimated to make a plan shorter: some ten milliseconds in a kitchen, and well spent, since each
/// step saved is a time step of the whole team.
pub const IMPROVEMENT: u64 = 600;

/// Work that the robot hands out: plan one package.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotJob {
    /// The package.
    pub package: Package,
    /// The robot's own domain.
    pub domain: Arc<Domain>,
    /// Bounds of the search; counts only, so that every run of the same problem ends the same way.
    pub expansions: u64,
}

/// What comes back.
pub type RobotDone = PackageReport;

impl RobotJob {
    /// Parses, plans and checks the plan with the lifted interpreter. Touches nothing but its arguments;
    /// `elapsed_us` is left at 0 for whoever has a clock.
    pub fn run(self, cancel: &AtomicBool) -> RobotDone {
        let result = self.plan(cancel);
        PackageReport { id: self.package.id, result, elapsed_us: 0 }
    }

    fn plan(&self, cancel: &AtomicBool) -> PlanResult {
        let source = Source::new(format!("package {}", self.package.id.0), self.package.problem.as_str());
        let problem = match parse_problem(&source) {
            Ok(parsed) => parsed.value,
            Err(report) => return PlanResult::Malformed(report.to_string()),
        };
        let report = check_problem(&self.domain, &problem, &source);
        if report.has_errors() {
            return PlanResult::Malformed(report.to_string());
        }
        let options = SearchOptions { improvement: Some(IMPROVEMENT), ..SearchOptions::default() };
        let limits = Limits { expansions: Some(self.expansions), ..Limits::default() };
        match plan_with(&self.domain, &problem, &options, &limits, cancel) {
            Err(error) => PlanResult::Malformed(error.to_string()),
            Ok(Outcome::Unsolvable(reason)) => PlanResult::Infeasible(reason.to_string()),
            Ok(Outcome::GaveUp(limit)) => PlanResult::GaveUp(limit.to_string()),
            Ok(Outcome::Found(plan)) => match validate(&self.domain, &problem, &plan.acts) {
                Ok(verdict) if verdict.is_valid() => {
                    PlanResult::Found(plan.acts.iter().map(|a| Act::new(&a.action, &a.args)).collect())
                }
                Ok(invalid) => PlanResult::GaveUp(format!("the plan found is not valid: {invalid}")),
                Err(error) => PlanResult::Malformed(error.to_string()),
            },
        }
    }
}

//! Plans read, checked and written.

use lamma_pddl::{Source, parse_domain, parse_problem};

use super::*;
use crate::plan::Plan;

const DOMAIN: &str = "(define (domain gripper) (:types room ball)
    (:predicates (at ?r - room) (in ?b - ball ?r - room) (held ?b - ball) (empty))
    (:functions (total-cost))
    (:action move :parameters (?a ?b - room) :precondition (at ?a)
      :effect (and (not (at ?a)) (at ?b) (increase (total-cost) 3)))
    (:action pick :parameters (?b - ball ?r - room) :precondition (and (empty) (at ?r) (in ?b ?r))
      :effect (and (held ?b) (not (empty)) (not (in ?b ?r)) (increase (total-cost) 1)))
    (:action drop :parameters (?b - ball ?r - room) :precondition (and (held ?b) (at ?r))
      :effect (and (in ?b ?r) (empty) (not (held ?b)) (increase (total-cost) 1))))";

fn problem(metric: &str) -> String {
    format!(
        "(define (problem p) (:domain gripper) (:objects a b - room x - ball)
         (:init (at a) (in x a) (empty)) (:goal (and (in x b) (at b))) {metric})"
    )
}

fn verdict(metric: &str, plan: &str) -> Verdict {
    let domain = parse_domain(&Source::new("domain", DOMAIN)).expect("a domain").value;
    let problem = parse_problem(&Source::new("problem", problem(metric))).expect("a problem").value;
    let acts = read_plan(&Source::new("plan", plan)).expect("a plan");
    validate(&domain, &problem, &acts).expect("a meaningful task")
}

#[test]
fn a_valid_plan_has_a_cost() {
    let plan = "(pick x a)\n(MOVE a b) ; over there\n(drop x b)";
    assert_eq!(verdict("", plan), Verdict::Valid { cost: 3.0, kind: CostKind::Unit });
    let metric = "(:metric minimize (total-cost))";
    assert_eq!(verdict(metric, plan), Verdict::Valid { cost: 5.0, kind: CostKind::Metric });
    let metric = "(:metric minimize (+ (* 2 (total-cost)) (total-time)))";
    assert_eq!(verdict(metric, plan), Verdict::Valid { cost: 13.0, kind: CostKind::Metric });
}

#[test]
fn a_failing_step_and_a_missed_goal_are_named() {
    let told = |plan: &str| verdict("", plan).to_string();
    assert_eq!(told("(move a b)\n(pick x a)"), "step 2 (pick x a): (at a) does not hold");
    assert_eq!(
        told("(move a b)\n(pik x a)"),
        "step 2 (pik x a): the domain has no action `pik`; did you mean `pick`?"
    );
    assert_eq!(told("(move a b)"), "the goal is not reached: (in x b) does not hold");
    assert!(!verdict("", "").is_valid());
}

fn read(text: &str) -> Result<String, String> {
    let shown = |acts: Vec<GroundAct>| acts.iter().map(GroundAct::to_string).collect::<Vec<_>>().join(" ");
    read_plan(&Source::new("plan.txt", text)).map(shown).map_err(|report| report.to_string())
}

#[test]
fn plans_are_read_in_the_forms_planners_write() {
    assert_eq!(read("; nothing\n\n").as_deref(), Ok(""));
    assert_eq!(read("( a  x y )\r\n(b)(c) ;; end").as_deref(), Ok("(a x y) (b) (c)"));
    assert_eq!(read("2.0: (b) [1.0]\n 0.000: ( A x ) [ 1e0 ]\n2: (c)").as_deref(), Ok("(A x) (b) (c)"));
}

#[test]
fn faults_in_plans_are_shown_at_their_place() {
    let report = read("(a x)\n(b (c))\nstep 3: (d\n()\n(é)\n0: (e) [-1]").expect_err("five faults");
    insta::assert_snapshot!(report);
}

#[test]
fn what_is_written_is_read_again() {
    let plan =
        Plan { acts: vec![GroundAct::new("pick", ["x", "a"]), GroundAct::new("wait", [""; 0])], cost: 2.0 };
    let text = write_plan(&plan, CostKind::Unit);
    assert_eq!(text, "(pick x a)\n(wait)\n; cost = 2 (unit cost)\n");
    assert_eq!(read_plan(&Source::new("plan", text)).expect("a plan"), plan.acts);
}

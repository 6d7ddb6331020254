//! Traps of files in use: each is read, and read as it was meant.

use lamma_pddl::ast::{Condition, Domain, Effect, Init, NumericExpr, Private, Problem};
use lamma_pddl::{Name, Report, Source, check_domain, check_problem, parse_domain, parse_problem};

fn domain_and_warnings(text: &str) -> (Domain, Report) {
    match parse_domain(&Source::new("d", text)) {
        Ok(parsed) => (parsed.value, parsed.warnings),
        Err(report) => panic!("{report}"),
    }
}

fn domain(text: &str) -> Domain {
    let (domain, warnings) = domain_and_warnings(&format!("(define (domain d) {text})"));
    assert!(warnings.is_empty(), "{warnings}");
    domain
}

fn problem_and_warnings(text: &str) -> (Problem, Report) {
    match parse_problem(&Source::new("p", format!("(define (problem p) {text})"))) {
        Ok(parsed) => (parsed.value, parsed.warnings),
        Err(report) => panic!("{report}"),
    }
}

fn codes(report: &Report) -> Vec<&'static str> {
    report.diagnostics().iter().map(|found| found.code).collect()
}

/// The codes of checking a domain that can be read.
fn checked(text: &str) -> Vec<&'static str> {
    let source = Source::new("d", format!("(define (domain d) {text})"));
    match parse_domain(&source) {
        Ok(parsed) => codes(&check_domain(&parsed.value, &source)),
        Err(report) => panic!("{report}"),
    }
}

fn names<'a>(names: impl IntoIterator<Item = &'a Name>) -> String {
    names.into_iter().map(Name::as_str).collect::<Vec<_>>().join(" ")
}

#[test]
fn upper_case_tabs_form_feeds_and_trailing_comments() {
    let text = "; head\r\n(DEFINE\t(DOMAIN Blocks)\x0c(:REQUIREMENTS :STRIPS)\n(:PREDICATES (On ?X ?y))\n\
        (:ACTION Put :PARAMETERS (?x ?Y) :PRECONDITION () :EFFECT (AND (ON ?X ?y) (NOT (on ?Y ?x)))))\n; (tail";
    let (domain, warnings) = domain_and_warnings(text);
    assert!(warnings.is_empty(), "{warnings}");
    assert!(check_domain(&domain, warnings.source()).is_empty(), "names do not distinguish case");
    assert_eq!(domain.actions[0].precondition, Condition::TRUE);
}

#[test]
fn a_parenthesis_too_many_at_the_end_is_a_warning() {
    assert_eq!(codes(&domain_and_warnings("(define (domain d)))\n)").1), ["pddl::stray-parenthesis"; 2]);
}

#[test]
fn untyped_and_either() {
    let domain = domain(
        "(:types a b - (either c d) e) (:predicates (p ?x ?y - (either a b) ?z)) (:action f :parameters (?x ?y))",
    );
    let types = |at: usize| names(&domain.types[at].types);
    assert_eq!((types(0), types(1), types(2)), ("c d".into(), "c d".into(), String::new()));
    let params = &domain.predicates[0].params;
    assert_eq!((names(&params[0].types), names(&params[2].types)), ("a b".into(), String::new()));
    assert_eq!(domain.actions[0].params.len(), 2);
}

#[test]
fn undeclared_requirements_and_types_of_predicates_are_warnings() {
    let text = "(:predicates (p ?x - ghost)) (:functions (total-cost)) (:action a :parameters (?x)
        :precondition (or (not (p ?x)) (exists (?y) (= ?x ?y))) :effect (and (when (p ?x) (not (p ?x))) (increase (total-cost) 1)))";
    let source = Source::new("d", format!("(define (domain d) {text})"));
    let parsed = parse_domain(&source).expect("readable");
    let report = check_domain(&parsed.value, &source);
    assert!(!report.has_errors(), "{report}");
    let missing = codes(&report).iter().filter(|code| **code == "pddl::undeclared-requirement").count();
    assert_eq!(missing, 7, "typing, not, or, =, exists, when, costs: {report}");
}

#[test]
fn an_undeclared_predicate_is_an_error_and_said_once() {
    let text = "(:predicates (p)) (:action a :parameters () :precondition (holding) :effect (holding))";
    assert_eq!(checked(text), ["pddl::unknown-predicate"]);
}

#[test]
fn costs_with_spaces_bare_names_and_types_of_functions() {
    let domain = domain(
        "(:functions ( total-cost ) - number (d ?x) (e ?x) - number) (:action a :parameters (?x)
           :effect (and (increase ( total-cost ) ( d ?x )) (increase total-cost 10) (decrease (d ?x) total-cost)))",
    );
    assert_eq!(names(domain.functions.iter().map(|f| &f.name)), "total-cost d e");
    let Effect::And(parts) = &domain.actions[0].effect else { panic!("an `and`") };
    let is_assignment = |effect: &Effect| matches!(effect, Effect::Assign(_, f, NumericExpr::Function(_) | NumericExpr::Number(_)) if f.args.len() < 2);
    assert!(parts.iter().all(is_assignment), "{parts:?}");
}

#[test]
fn functions_that_are_not_numbers_are_refused() {
    let refused = parse_domain(&Source::new("d", "(define (domain d) (:functions (place ?x) - location))"));
    assert_eq!(codes(&refused.expect_err("an object fluent")), ["pddl::unsupported"]);
}

#[test]
fn problems_with_another_domain_name_duplicate_objects_and_words_run_together() {
    let domain = domain("(:constants a) (:predicates (p ?x) (q ?x ?y))");
    let (problem, warnings) = problem_and_warnings(
        "(:domain other) (:requirements :strips) (:objects A b) (:init (p a) (= (total-cost) 0)(q a b))
         (:goal (AND (p b))) (:metric MINIMIZE (total-time)) (:length (:serial 3))",
    );
    assert!(warnings.is_empty(), "{warnings}");
    assert_eq!(problem.init.len(), 3);
    let found = check_problem(&domain, &problem, warnings.source());
    assert_eq!(codes(&found), ["pddl::domain-mismatch", "pddl::unknown-function"]);
    let (run_together, _) = domain_and_warnings("(define (domain d) (:predicates (aircraft?a?b)))");
    assert_eq!(run_together.predicates[0].params.len(), 2);
}

#[test]
fn initial_values_may_be_negative_or_fractions() {
    let (problem, _) = problem_and_warnings("(:domain d) (:init (= (f a) -1.50) (= g 2)) (:goal ())");
    let values: Vec<f64> = problem
        .init
        .iter()
        .map(|init| match init {
            Init::Value(_, value) => value.value(),
            Init::Fact(fact) => panic!("{fact} is a value"),
        })
        .collect();
    assert_eq!(values, [-1.5, 2.0]);
}

#[test]
fn unfactored_multi_agent_files() {
    let domain = domain(
        "(:requirements :typing :multi-agent :unfactored-privacy) (:types truck thing)
         (:predicates (at ?x - thing) (:private ?agent - truck (fuel ?agent - truck) (full ?agent - truck)) (done))
         (:action go :agent ?t - truck :parameters (?x - thing) :precondition (fuel ?t) :effect (at ?x))
         (:action stay :agent ?t - truck :parameters (?x - thing ?t - truck) :effect (done))
         (:action rest :agent ?t - truck :effect (done))",
    );
    assert!(check_domain(&domain, &Source::new("d", "")).is_empty());
    let is_private = |at: usize| matches!(&domain.predicates[at].private_to, Some(Private::Variable(a)) if a.name == "agent");
    assert_eq!([is_private(0), is_private(1), is_private(2), is_private(3)], [false, true, true, false]);
    let params = |at: usize| names(domain.actions[at].params.iter().map(|param| &param.name));
    assert_eq!((params(0), params(1), params(2)), ("t x".into(), "x t".into(), "t".into()));

    let (problem, _) = problem_and_warnings(
        "(:domain d) (:objects x - thing (:private t1 t1 - truck y z - thing) (:private t2 t2 - truck) w - thing) (:init) (:goal ())",
    );
    let owners: Vec<String> = problem
        .objects
        .iter()
        .map(|object| match &object.private_to {
            Some(Private::Agent(agent)) => format!("{}:{agent}", object.name),
            _ => object.name.to_string(),
        })
        .collect();
    assert_eq!(owners, ["x", "t1:t1", "y:t1", "z:t1", "t2:t2", "w"]);
}

#[test]
fn factored_multi_agent_files() {
    let (problem, _) = problem_and_warnings(
        "(:domain d) (:objects x - thing (:private t1 - truck) (:private a b - thing)) (:init) (:goal ())",
    );
    assert_eq!(names(problem.objects.iter().map(|object| &object.name)), "x t1 a b");
    assert!(problem.objects[1..].iter().all(|object| object.private_to == Some(Private::Owner)));
    let domain = domain("(:predicates (p) (:private (q ?x) (r))) (:functions (f) (:private (g)))");
    assert_eq!(domain.predicates[2].private_to, Some(Private::Owner));
    assert_eq!(domain.functions[1].private_to, Some(Private::Owner));
}

#[test]
fn durations_may_be_ranges_and_parts_may_be_quantified() {
    let (domain, warnings) = domain_and_warnings(
        "(define (domain d) (:predicates (p ?x) (q)) (:functions (f))
         (:durative-action a :parameters () :duration (and (>= ?duration 2) (<= ?duration (f)))
           :condition (and (at start (q)) (forall (?x) (over all (p ?x))))
           :effect (and (at start (not (q))) (at end (q)) (forall (?x) (when (at start (p ?x)) (at end (not (p ?x))))))))",
    );
    assert_eq!(codes(&warnings), ["pddl::duration-range"]);
    let action = &domain.actions[0];
    assert_eq!(action.precondition.to_string(), "(and (q) (forall (?x) (p ?x)))");
    assert_eq!(action.effect.to_string(), "(and (not (q)) (q) (forall (?x) (when (p ?x) (not (p ?x)))))");
    assert_eq!(action.duration.as_ref().map(ToString::to_string).as_deref(), Some("2"));
}

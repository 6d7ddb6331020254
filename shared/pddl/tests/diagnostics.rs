//! What people and language models read when a text is wrong: the whole report, word for word.

use lamma_pddl::{Report, Source, check_domain, check_problem, parse_condition, parse_domain, parse_problem};

/// The findings of reading, or of checking where it could be read.
fn domain(text: &str) -> Report {
    let source = Source::new("domain.pddl", text);
    match parse_domain(&source) {
        Ok(parsed) => {
            let mut report = parsed.warnings;
            report.extend(check_domain(&parsed.value, &source));
            report
        }
        Err(report) => report,
    }
}

fn problem(domain_text: &str, text: &str) -> Report {
    let domain = parse_domain(&Source::new("domain.pddl", domain_text)).expect("the domain is good").value;
    let source = Source::new("problem.pddl", text);
    match parse_problem(&source) {
        Ok(parsed) => {
            let mut report = parsed.warnings;
            report.extend(check_problem(&domain, &parsed.value, &source));
            report
        }
        Err(report) => report,
    }
}

#[test]
fn a_missing_parenthesis_is_found_where_the_next_section_begins() {
    insta::assert_snapshot!(domain(
        "(define (domain kitchen)
  (:predicates (open ?x) (closed ?x))
  (:action Open
    :parameters (?x)
    :precondition (and (closed ?x)
    :effect (open ?x))
  (:action Close
    :parameters (?x)
    :precondition (open ?x)
    :effect (closed ?x) (not (open ?x))))
"
    ));
}

#[test]
fn a_parenthesis_too_many_is_found_where_the_definition_ends() {
    insta::assert_snapshot!(domain(
        "(define (domain kitchen)
  (:predicates (open ?x)))
  (:action Open :parameters (?x) :effect (open ?x)))
"
    ));
}

#[test]
fn several_mistakes_are_reported_at_once() {
    insta::assert_snapshot!(domain(
        "(define (domain kitchen)
  (:requirments :typing)
  (:predicates (open ?x - thing) fridge)
  (:action Open
    :parameters (x - thing)
    :precondition (and (not (open ?x) (open ?x)) (oder (open ?x)))
    :efect (open ?x))
  (:action Close
    :parameters (?x \u{2013} thing)
    :precondition (open \"?x\")
    :effect (or (open ?x)))
  (:constraints (always (open ?x))))
"
    ));
}

#[test]
fn names_that_mean_nothing_come_with_a_suggestion() {
    insta::assert_snapshot!(domain(
        "(define (domain kitchen)
  (:requirements :strips :typing :negativ-preconditions)
  (:types robot thing - object cup fridge - thing)
  (:predicates (at ?r - robot ?x - thing) (open ?f - fridge) (holding ?r - robot ?x - thing))
  (:functions (fuel ?r - robot))
  (:action Open
    :parameters (?r - robot ?f - frigde)
    :precondition (and (at ?r ?fridge) (not (opne ?f)))
    :effect (and (open ?f) (decrease (feul ?r) 1) (object-open ?r)))
  (:action Pick
    :parameters (?r - robot ?c - cup ?x - thing ?r - robot)
    :precondition (and (at ?r) (open ?c) (open ?x) (at Fridge_1 ?x))
    :effect (forall (?x - thing) (holding ?r ?x))))
"
    ));
}

#[test]
fn contradicting_declarations_are_reported() {
    insta::assert_snapshot!(domain(
        "(define (domain kitchen)
  (:requirements :adl :typing :derived-predicates)
  (:types cup - thing thing - item item - cup box - container cup - object)
  (:constants a - cup a - box b b)
  (:predicates (p ?x) (P ?x ?y) (q) (q) (r) (s))
  (:derived (r) (not (s)))
  (:derived (s) (r))
  (:action Do :parameters () :effect (r))
  (:action do :parameters () :effect ()))
"
    ));
}

const GOOD: &str = "(define (domain kitchen)
  (:types robot thing - object cup fridge - thing)
  (:constants sink - thing)
  (:predicates (at ?r - robot ?x - thing) (open ?f - fridge))
  (:functions (fuel ?r - robot)))";

#[test]
fn problems_are_checked_against_their_domain() {
    insta::assert_snapshot!(problem(
        GOOD,
        "(define (problem breakfast) (:domain kitchn)
  (:objects r1 - robot f1 - fridge c1 - kup f1 - cup sink - fridge)
  (:init (at r1 f1) (at f1 r1) (open c1) (open r1) (= (fuel r1) 3) (= (fuel r1) 4) (not (open f1)) (= (full r1) 1))
  (:goal (and (open f2) (exists (?f - fridge) (opened ?f)))))
"
    ));
}

#[test]
fn files_in_the_wrong_order_and_parts_that_are_missing_are_told() {
    let both = format!(
        "{}\n{}\n{}\n{}",
        parse_problem(&Source::new("domain.pddl", GOOD)).expect_err("not a problem"),
        parse_domain(&Source::new("notes.txt", "Dear planner,\nplease tidy up.")).expect_err("no PDDL"),
        parse_domain(&Source::new("empty.pddl", "; nothing here\n")).expect_err("empty"),
        problem(GOOD, "(define (problem x) (:objects a))"),
    );
    insta::assert_snapshot!(both);
}

#[test]
fn parts_of_pddl_that_are_not_supported_are_named() {
    insta::assert_snapshot!(problem(
        GOOD,
        "(define (problem x) (:domain kitchen)
  (:init (at 5 (open f1)) (= (fuel r1) 1e999))
  (:goal (and (preference p1 (open f1)) (always (open f1))))
  (:constraints (always (open f1)))
  (:metric minimize (is-violated p1)))
"
    ));
}

#[test]
fn one_long_line_is_shown_in_part() {
    let text = format!("(and {} (not) {})", "(open Fridge_1) ".repeat(500), "(open Fridge_2) ".repeat(500));
    insta::assert_snapshot!(parse_condition(&text).expect_err("`not` of nothing"));
}

#[test]
fn reports_as_data_have_lines_and_columns() {
    let report = domain(
        "(define (domain d)\n  (:predicates (open ?x))\n  (:action a :parameters (?x) :effect (opne ?x)))",
    );
    insta::assert_snapshot!(serde_json::to_string_pretty(&report.to_json()).expect("JSON is text"));
}

#[test]
fn coloured_reports_say_the_same() {
    let report = domain("(define (domain d) (:predicates (p)) (:action a :parameters () :effect (q)))");
    let coloured = report.render_coloured();
    assert!(coloured.contains('\u{1b}') && coloured.contains("unknown predicate `q`"), "{coloured}");
    assert!(report.render().is_ascii(), "{report}");
}

#[test]
fn a_flood_of_findings_is_bounded() {
    let report = domain(&format!("(define (domain d) {})", "x ".repeat(100_000)));
    assert_eq!(report.diagnostics().len(), Report::MAX_DIAGNOSTICS);
    assert_eq!(report.omitted(), 100_000 - Report::MAX_DIAGNOSTICS);
}

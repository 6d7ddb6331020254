//! The semantics by example.

use lamma_pddl::ast::{Domain, GroundAtom, Problem};
use lamma_pddl::{Source, parse_condition, parse_domain, parse_ground_atom, parse_problem};

use super::*;
use crate::plan::Literal;

fn domain(text: &str) -> Domain {
    match parse_domain(&Source::new("domain", format!("(define (domain d) {text})"))) {
        Ok(parsed) => parsed.value,
        Err(report) => panic!("{report}"),
    }
}

fn problem(text: &str) -> Problem {
    match parse_problem(&Source::new(
        "problem",
        format!("(define (problem p) (:domain d) (:goal ()) {text})"),
    )) {
        Ok(parsed) => parsed.value,
        Err(report) => panic!("{report}"),
    }
}

/// An interpreter and an initial state.
fn world(domain_text: &str, problem_text: &str) -> (Interpreter, WorldState) {
    let problem = problem(problem_text);
    let interpreter = Interpreter::new(&domain(domain_text), &problem.objects).expect("a meaningful domain");
    let state = interpreter.initial(&problem.init).expect("a meaningful state");
    (interpreter, state)
}

fn act(text: &str) -> GroundAct {
    let atom = parse_ground_atom(text).expect("an act");
    GroundAct { action: atom.predicate, args: atom.args }
}

fn facts(state: &WorldState) -> String {
    state.facts.iter().map(|fact| fact.to_string()).collect::<Vec<_>>().join(" ")
}

fn holds(interpreter: &Interpreter, state: &WorldState, condition: &str) -> bool {
    let condition = parse_condition(condition).expect("a condition");
    interpreter.holds(state, &interpreter.ground_condition(&condition).expect("a closed condition"))
}

fn apply(interpreter: &Interpreter, state: &mut WorldState, text: &str) -> Result<Change, String> {
    let action = interpreter.instantiate(&act(text)).map_err(|error| error.to_string())?;
    interpreter.apply(state, &action).map_err(|violation| violation.to_string())
}

const KITCHEN: &str = "
    (:types robot thing - object cup fridge - thing)
    (:predicates (at ?r - robot ?x - thing) (holding ?r - robot ?x - thing) (open ?x - thing) (free ?r - robot))
    (:action GoTo :parameters (?r - robot ?x - thing)
      :effect (and (at ?r ?x) (forall (?y - thing) (when (at ?r ?y) (not (at ?r ?y))))))
    (:action Pick :parameters (?r - robot ?x - cup)
      :precondition (and (at ?r ?x) (free ?r) (not (exists (?y - fridge) (and (at ?r ?y) (not (open ?y))))))
      :effect (and (holding ?r ?x) (not (free ?r))))
    (:action Open :parameters (?r - robot ?x - fridge) :precondition (at ?r ?x) :effect (open ?x))";
const KITCHEN_OBJECTS: &str = "(:objects r1 - robot c1 c2 - cup f1 - fridge)";

#[test]
fn objects_are_of_their_types_and_of_all_above() {
    let (interpreter, _) = world(KITCHEN, KITCHEN_OBJECTS);
    let of = |name: &str| interpreter.objects_of(&Name::new(name)).map(Name::as_str).collect::<Vec<_>>();
    assert_eq!(of("thing"), ["c1", "c2", "f1"]);
    assert_eq!(of("OBJECT"), ["r1", "c1", "c2", "f1"]);
    assert_eq!(of("robot"), ["r1"]);
    assert_eq!(of("spaceship"), [""; 0]);
}

#[test]
fn deletes_come_before_adds_and_conditions_are_about_the_state_before() {
    let (interpreter, mut state) = world(KITCHEN, &format!("{KITCHEN_OBJECTS} (:init (at r1 c1))"));
    let change = apply(&interpreter, &mut state, "(goto r1 f1)").expect("possible");
    assert_eq!(facts(&state), "(at r1 f1)");
    assert_eq!(change.added, [GroundAtom::new("at", ["r1", "f1"])]);
    assert_eq!(change.deleted, [GroundAtom::new("at", ["r1", "c1"])]);
    let change = apply(&interpreter, &mut state, "(GoTo r1 f1)").expect("possible");
    assert_eq!(facts(&state), "(at r1 f1)", "deleted and added again");
    assert_eq!(change, Change::default(), "nothing is different afterwards");
}

#[test]
fn a_violation_names_what_is_missing_and_changes_nothing() {
    let (interpreter, mut state) = world(KITCHEN, &format!("{KITCHEN_OBJECTS} (:init (at r1 f1))"));
    let before = state.clone();
    let refused = apply(&interpreter, &mut state, "(Pick r1 c1)").expect_err("not there");
    assert_eq!(
        refused,
        "(Pick r1 c1) is not possible: (at r1 c1) does not hold, (free r1) does not hold, \
         (or (not (at r1 f1)) (open f1)) does not hold"
    );
    assert_eq!(state, before);
}

#[test]
fn acts_that_name_no_action_are_refused_with_a_suggestion() {
    let (interpreter, mut state) = world(KITCHEN, KITCHEN_OBJECTS);
    let mut refused = |text: &str| apply(&interpreter, &mut state, text).expect_err("no such action");
    assert_eq!(refused("(Pikc r1 c1)"), "the domain has no action `Pikc`; did you mean `Pick`?");
    assert_eq!(refused("(Pick r1)"), "(Pick r1) has 1 arguments; `Pick` takes 2");
    assert_eq!(
        refused("(Pick r1 c9)"),
        "there is no object `c9`, which (Pick r1 c9) names; did you mean `c1`?"
    );
    assert_eq!(refused("(Pick r1 f1)"), "`f1` in (Pick r1 f1) is not of the type cup that ?x needs");
}

#[test]
fn conditions_are_expanded_over_the_objects() {
    let (interpreter, state) = world(KITCHEN, &format!("{KITCHEN_OBJECTS} (:init (at r1 c1) (open f1))"));
    assert!(holds(&interpreter, &state, "(exists (?x - cup) (at r1 ?x))"));
    assert!(!holds(&interpreter, &state, "(forall (?x - cup) (at r1 ?x))"));
    assert!(holds(&interpreter, &state, "(forall (?x - cup) (imply (at r1 ?x) (= ?x c1)))"));
    assert!(holds(
        &interpreter,
        &state,
        "(forall (?x - (either cup fridge)) (or (open ?x) (not (= ?x f1))))"
    ));
    assert!(holds(
        &interpreter,
        &state,
        "(not (exists (?x ?y - cup) (and (at r1 ?x) (at r1 ?y) (not (= ?x ?y)))))"
    ));
    assert!(holds(&interpreter, &state, "(forall (?x - robot) (exists (?x - cup) (at r1 ?x)))"), "shadowed");
    let ground = |text: &str| {
        let condition = parse_condition(text).expect("a condition");
        interpreter.ground_condition(&condition).expect("closed").to_string()
    };
    assert_eq!(
        ground("(not (or (open c1) (and (open c2) (not (open f1)))))"),
        "(and (not (open c1)) (or (not (open c2)) (open f1)))"
    );
    assert_eq!(ground("(forall (?x - cup) (= ?x ?x))"), "(and)");
    assert_eq!(ground("(exists (?x - cup) (not (= ?x ?x)))"), "(or)");
}

#[test]
fn names_that_mean_nothing_are_refused() {
    let (interpreter, _) = world(KITCHEN, KITCHEN_OBJECTS);
    let refused = |text: &str| {
        let condition = parse_condition(text).expect("a condition");
        interpreter.ground_condition(&condition).expect_err("no meaning").to_string()
    };
    assert!(refused("(closed f1)").contains("the predicate `closed` is not declared"));
    assert!(refused("(open f1 f1)").contains("takes 1 arguments, not 2"));
    assert!(refused("(open ?x)").contains("`?x` is not bound"));
    assert!(refused("(open f2)").contains("the object `f2` is not declared"));
    assert!(refused("(exists (?x - car) (open ?x))").contains("the type `car` is not declared"));
    let bad = domain("(:predicates (p)) (:action a :parameters () :effect (q))");
    assert!(Interpreter::new(&bad, &[]).is_err(), "an effect on an undeclared predicate");
}

#[test]
fn a_witness_holds_and_suffices() {
    let (interpreter, state) = world(KITCHEN, &format!("{KITCHEN_OBJECTS} (:init (at r1 c1) (open f1))"));
    let witness = |text: &str| {
        let condition =
            interpreter.ground_condition(&parse_condition(text).expect("a condition")).expect("closed");
        condition.witness(&state)
    };
    let literal = |text: &str, holds| Literal { atom: parse_ground_atom(text).expect("a fact"), holds };
    let found = witness("(and (or (open c1) (at r1 c1) (open f1)) (not (free r1)))");
    assert_eq!(
        found,
        Some(vec![literal("(at r1 c1)", true), literal("(free r1)", false)]),
        "the first true branch"
    );
    assert_eq!(witness("(or (open c1) (free r1))"), None);
}

#[test]
fn numbers_change_and_are_compared() {
    let (interpreter, mut state) = world(
        "(:predicates (p)) (:functions (fuel ?x) (cap) (total-cost))
         (:action use :parameters (?x) :precondition (>= (fuel ?x) 2)
           :effect (and (decrease (fuel ?x) 2) (decrease (fuel ?x) 1) (increase (total-cost) (* 2 (cap)))))
         (:action fill :parameters (?x) :effect (and (assign (fuel ?x) (cap)) (scale-up (cap) 2)))
         (:action half :parameters () :effect (scale-down (cap) (- (cap) (cap))))",
        "(:objects a b) (:init (= (fuel a) 2.5) (= (cap) 10))",
    );
    apply(&interpreter, &mut state, "(use a)").expect("enough fuel");
    assert!(holds(&interpreter, &state, "(= (fuel a) -0.5)"), "both decreases count");
    assert!(holds(&interpreter, &state, "(= (total-cost) 20)"), "costs start at 0");
    let refused = apply(&interpreter, &mut state, "(use a)").expect_err("too little fuel");
    assert_eq!(refused, "(use a) is not possible: (>= (fuel a) 2) does not hold");
    let refused = apply(&interpreter, &mut state, "(use b)").expect_err("fuel unknown");
    assert_eq!(refused, "(use b) is not possible: (fuel b) has no value");
    apply(&interpreter, &mut state, "(fill b)").expect("possible");
    assert!(holds(&interpreter, &state, "(and (= (fuel b) 10) (= (cap) 20) (not (= (fuel a) (fuel b))))"));
    let refused = apply(&interpreter, &mut state, "(half)").expect_err("a division by 0");
    assert!(refused.contains("is not a finite number"), "{refused}");
}

#[test]
fn derived_facts_follow_in_strata() {
    let (interpreter, mut state) = world(
        "(:predicates (on ?x ?y) (above ?x ?y) (top ?x))
         (:derived (above ?x ?y) (or (on ?x ?y) (exists (?z) (and (on ?x ?z) (above ?z ?y)))))
         (:derived (top ?x) (not (exists (?y) (above ?y ?x))))
         (:action take :parameters (?x ?y) :precondition (and (top ?x) (on ?x ?y)) :effect (not (on ?x ?y)))",
        "(:objects a b c) (:init (on a b) (on b c))",
    );
    assert!(holds(&interpreter, &state, "(and (above a c) (top a) (not (top b)) (not (above c a)))"));
    let refused = apply(&interpreter, &mut state, "(take b c)").expect_err("a is on b");
    assert_eq!(refused, "(take b c) is not possible: (top b) does not hold");
    apply(&interpreter, &mut state, "(take a b)").expect("a is on top");
    assert!(holds(&interpreter, &state, "(and (top b) (not (above a c)))"));
    assert_eq!(facts(&state), "(on b c)", "derived facts are not kept");

    let circle = domain("(:predicates (p) (q)) (:derived (p) (not (q))) (:derived (q) (p))");
    assert!(matches!(Interpreter::new(&circle, &[]), Err(InterpretError::Unstratified { .. })));
    let set = domain("(:predicates (p) (q)) (:derived (p) (q)) (:action a :parameters () :effect (p))");
    assert!(matches!(Interpreter::new(&set, &[]), Err(InterpretError::DerivedEffect { .. })));
}

#[test]
fn durative_actions_are_steps_with_a_duration() {
    let (interpreter, mut state) = world(
        "(:predicates (idle ?x) (busy ?x) (done ?x)) (:functions (speed ?x))
         (:durative-action work :parameters (?x) :duration (= ?duration (/ 6 (speed ?x)))
           :condition (and (at start (idle ?x)) (over all (busy ?x)))
           :effect (and (at start (and (not (idle ?x)) (busy ?x))) (at end (not (busy ?x)))
                        (at end (and (idle ?x) (done ?x)))))
         (:action rest :parameters (?x))",
        "(:objects a) (:init (idle a) (= (speed a) 4))",
    );
    let work = interpreter.instantiate(&act("(work a)")).expect("an action");
    assert_eq!(interpreter.duration(&state, &work), Ok(1.5));
    interpreter.apply(&mut state, &work).expect("what it achieves itself is no precondition");
    assert_eq!(facts(&state), "(done a) (idle a)");
    let rest = interpreter.instantiate(&act("(rest a)")).expect("an action");
    assert_eq!(interpreter.duration(&state, &rest), Ok(1.0), "1 where the domain says nothing");
}

#[test]
fn an_object_that_is_also_a_constant_is_of_both_types() {
    let text = "(:types a b) (:constants x - a) (:predicates (p ?x)) (:action f :parameters (?x - b) :effect (p ?x))";
    let (interpreter, mut state) = world(text, "(:objects X - b)");
    apply(&interpreter, &mut state, "(f x)").expect("x is a b too");
    assert_eq!(interpreter.objects_of(&Name::new("object")).count(), 1);
}

#[test]
fn circles_of_types_and_huge_quantifiers_end() {
    let names: Vec<TypedName> = (0..300).map(|i| TypedName::new(format!("o{i}"), "a")).collect();
    let text = "(:types a - b b - a) (:predicates (p ?x ?y ?z))";
    let interpreter = Interpreter::new(&domain(text), &names).expect("a circle is a warning at most here");
    let condition = parse_condition("(forall (?x ?y ?z) (p ?x ?y ?z))").expect("a condition");
    assert_eq!(interpreter.ground_condition(&condition), Err(InterpretError::TooLarge));
}

#[test]
fn recursion_negation_and_quantifiers_in_axioms_meet() {
    let (interpreter, mut state) = world(
        "(:types node) (:predicates (wire ?a ?b - node) (source ?a) (live ?a) (dark ?a) (alone ?a) (all-live) (odd ?a))
         (:functions (load ?a))
         (:derived (live ?a) (or (source ?a) (exists (?b - node) (and (live ?b) (wire ?b ?a)))))
         (:derived (dark ?a - node) (not (live ?a)))
         (:derived (alone ?a - node) (forall (?b - node) (imply (wire ?a ?b) (dark ?b))))
         (:derived (all-live) (forall (?a - node) (and (live ?a) (< (load ?a) 3))))
         (:derived (odd ?a) (exists (?b ?a - node) (and (wire ?b ?a) (not (= ?a ?b)))))
         (:action cut :parameters (?a ?b) :effect (not (wire ?a ?b)))
         (:action more :parameters (?a) :effect (increase (load ?a) 1))",
        "(:objects a b c d - node)
         (:init (source a) (wire a b) (wire b c) (wire c b) (wire c d) (= (load a) 2) (= (load b) 0) (= (load c) 0)
                (= (load d) 0))",
    );
    assert!(holds(&interpreter, &state, "(and (live d) (all-live) (alone d) (not (alone a)))"));
    assert!(holds(&interpreter, &state, "(forall (?x - node) (odd ?x))"), "the inner ?a hides the head's");
    apply(&interpreter, &mut state, "(more a)").expect("possible");
    assert!(holds(&interpreter, &state, "(and (live d) (not (all-live)))"), "a number decides");
    apply(&interpreter, &mut state, "(cut a b)").expect("possible");
    assert!(
        holds(&interpreter, &state, "(and (dark b) (dark c) (dark d) (alone a) (not (live b)))"),
        "no ground for b and c"
    );
}

#[test]
fn large_axiom_domains_are_worked_out_by_looking_facts_up() {
    let nodes = 400;
    let objects: String = (0..nodes).map(|i| format!("n{i} ")).collect();
    let edges: String = (1..nodes).map(|i| format!("(edge n{} n{i}) ", i - 1)).collect();
    let (interpreter, state) = world(
        "(:predicates (edge ?a ?b) (reach ?a ?b) (mid ?a ?b ?c))
         (:derived (reach ?a ?b) (or (edge ?a ?b) (exists (?c) (and (reach ?a ?c) (edge ?c ?b)))))
         (:derived (mid ?a ?b ?c) (and (edge ?a ?b) (edge ?b ?c) (not (reach ?c ?a))))",
        &format!("(:objects {objects}) (:init {edges})"),
    );
    // Trying every object for every variable would take 400³ looks a round, 400 rounds.
    assert!(holds(&interpreter, &state, "(and (reach n0 n399) (not (reach n9 n3)) (mid n1 n2 n3))"));
}

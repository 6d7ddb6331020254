//! From the files of a team to one classical task.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on says so by panicking")]

use lamma_pddl::ast::{Domain, Problem};
use lamma_pddl::multi_agent::{Part, TeamTask, TeamTaskError, Veil, own_name, unfactored, union};
use lamma_pddl::{Name, Source, check_domain, check_problem, parse_domain, parse_problem};

fn domain(text: &str) -> Domain {
    parse_domain(&Source::new("domain", text)).unwrap_or_else(|report| panic!("{report}")).value
}

fn problem(text: &str) -> Problem {
    parse_problem(&Source::new("problem", text)).unwrap_or_else(|report| panic!("{report}")).value
}

/// Two porters with words of their own for what they hold, and a packer whose table nobody else knows.
fn porter(name: &str, from: &str, to: &str) -> Part {
    let domain = domain(
        "(define (domain parcels) (:requirements :typing :factored-privacy)
           (:types place parcel tool - object)
           (:predicates (lies ?p - parcel ?at - place) (packed ?p - parcel)
             (:private (stands ?at - place) (holds ?p - parcel) (free) (works ?t - tool)))
           (:action go :parameters (?from ?to - place ?t - tool)
             :precondition (and (stands ?from) (works ?t)) :effect (and (stands ?to) (not (stands ?from))))
           (:action take :parameters (?p - parcel ?at - place)
             :precondition (and (lies ?p ?at) (stands ?at) (free))
             :effect (and (holds ?p) (not (lies ?p ?at)) (not (free))))
           (:action leave :parameters (?p - parcel ?at - place)
             :precondition (and (holds ?p) (stands ?at))
             :effect (and (lies ?p ?at) (free) (not (holds ?p)))))",
    );
    let problem = problem(&format!(
        "(define (problem {name}) (:domain parcels)
           (:objects {from} {to} - place box - parcel (:private cart - tool))
           (:init (stands {from}) (free) (works cart) (lies box dock))
           (:goal (and (lies box shop))))"
    ));
    Part::new(&Name::new(name), &domain, &problem)
}

fn packer() -> Part {
    let domain = domain(
        "(define (domain parcels) (:requirements :typing :factored-privacy)
           (:types place parcel tool - object) (:constants ann - object)
           (:predicates (lies ?p - parcel ?at - place) (packed ?p - parcel) (:private (skilled ?who - object)))
           (:action pack_ann :parameters (?p - parcel)
             :precondition (and (lies ?p hall) (skilled ann)) :effect (packed ?p)))",
    );
    let problem = problem(
        "(define (problem ann) (:domain parcels) (:objects hall - place box - parcel)
           (:init (skilled ann)) (:goal (and (lies box shop) (packed box))))",
    );
    Part::new(&Name::new("ann"), &domain, &problem)
}

fn team() -> TeamTask {
    union(&[porter("p1", "dock", "hall"), porter("p2", "hall", "shop"), packer()]).unwrap()
}

fn action<'t>(task: &'t TeamTask, name: &str) -> &'t lamma_pddl::ast::Action {
    let all: Vec<&str> = task.domain.actions.iter().map(|a| a.name.as_str()).collect();
    task.domain.actions.iter().find(|a| a.name == *name).unwrap_or_else(|| panic!("{name} in {all:?}"))
}

#[test]
fn private_words_of_two_agents_are_two_things_and_public_words_one() {
    let task = team();
    let predicates: Vec<&str> = task.domain.predicates.iter().map(|p| p.name.as_str()).collect();
    assert!(predicates.contains(&"holds--p1") && predicates.contains(&"holds--p2"), "{predicates:?}");
    assert_eq!(predicates.iter().filter(|p| **p == "lies").count(), 1);
    let objects: Vec<&str> = task.objects.iter().map(|o| o.name.as_str()).collect();
    assert!(objects.contains(&"cart--p1") && objects.contains(&"cart--p2"), "{objects:?}");
    assert_eq!(objects.iter().filter(|o| **o == "box").count(), 1);
    assert_eq!(own_name("cart--p1", "p1"), "cart");
    assert_eq!(own_name("cart--p1", "p2"), "cart--p1");
}

#[test]
fn who_acts_is_the_first_parameter_also_where_the_files_do_not_say() {
    let task = team();
    let pack = action(&task, "pack");
    assert_eq!(pack.params.len(), 2, "{pack}");
    let text = pack.precondition.to_string();
    assert!(text.contains(&format!("(skilled ?{})", pack.params[0].name)), "{text}");
    let names: Vec<&str> = task.agents.iter().map(|a| a.name.as_str()).collect();
    assert_eq!(names, ["p1", "p2", "ann"]);
    let (act, args) = task.compiled_act("p1", "take", &["box".into(), "dock".into()]);
    assert_eq!((act.as_str(), args.len()), ("take--p1", 3));
}

/// p1 does not know the shop, so it cannot act there, whatever the others know.
#[test]
fn agents_act_on_what_their_own_files_name() {
    let task = team();
    let text = action(&task, "leave--p1").precondition.to_string();
    assert!(text.contains("(knows ?agent ?at)"), "{text}");
    let init: Vec<String> = task.facts().map(ToString::to_string).collect();
    assert!(init.iter().any(|f| f == "(knows p1 hall)"), "{init:?}");
    assert!(!init.iter().any(|f| f == "(knows p1 shop)"), "{init:?}");
}

#[test]
fn everybodys_goals_are_the_teams_and_the_compilation_is_sound_pddl() {
    let task = team();
    assert_eq!(task.goal.to_string(), "(and (lies box shop) (packed box))");
    let (domain_text, problem_text) = (task.domain.to_string(), task.problem().to_string());
    let domain = domain(&domain_text);
    // Objects of the team stand in the problem, also where actions name them.
    let report = check_problem(&domain, &problem(&problem_text), &Source::new("problem", problem_text));
    assert!(!report.has_errors(), "{report}");
}

#[test]
fn contradictions_between_parts_are_told() {
    let twice = union(&[porter("p1", "dock", "hall"), porter("P1", "hall", "shop")]);
    assert_eq!(twice.unwrap_err(), TeamTaskError::Twice(Name::new("p1")));
    let other =
        domain("(define (domain parcels) (:predicates (lies ?p)) (:action a :parameters () :effect (and)))");
    let empty = problem("(define (problem x) (:domain parcels) (:init) (:goal (and)))");
    let other = Part::new(&Name::new("q"), &other, &empty);
    let error = union(&[porter("p1", "dock", "hall"), other]).unwrap_err();
    assert!(error.to_string().contains("lies"), "{error}");
    assert_eq!(union(&[]).unwrap_err(), TeamTaskError::NoAgents);
}

#[test]
fn under_the_veil_no_private_word_is_left_and_the_task_is_the_same() {
    let parts = [porter("p1", "dock", "hall"), porter("p2", "hall", "shop"), packer()];
    let veiled: Vec<Part> = parts.iter().map(|part| Veil::of(part).over(part)).collect();
    for part in &veiled {
        let text = format!("{}{}", part.domain, part.problem());
        for word in
            ["holds", "stands", "free", "works", "cart", "take", "leave", "go", "pack", "skilled", "from"]
        {
            let named = text.split(|c: char| !c.is_alphanumeric() && c != '-' && c != '_').any(|w| w == word);
            assert!(!named, "{word} in {text}");
        }
        assert!(text.contains("lies"), "{text}");
        // What is read back from the text is the same part.
        let back =
            Part::new(&part.agent, &domain(&part.domain.to_string()), &problem(&part.problem().to_string()));
        assert_eq!(back.domain.actions, part.domain.actions);
    }
    let task = union(&veiled).unwrap();
    assert_eq!(task.domain.actions.len(), team().domain.actions.len());
    let veil = Veil::of(&parts[0]);
    assert_eq!(veil.lifted("veiled-a1"), "take");
    assert_eq!(veil.lifted("veiled-o0--p1"), "cart");
    assert_eq!(veil.lifted("box"), "box");
}

#[test]
fn in_the_unfactored_form_the_agents_are_who_can_fill_the_agent() {
    let domain_text = "(define (domain d) (:requirements :typing :multi-agent :unfactored-privacy)
        (:types robot place - object)
        (:predicates (at ?r - robot ?p - place) (lit) (:private ?agent - robot (charged ?agent - robot)))
        (:action go :agent ?r - robot :parameters (?from ?to - place)
          :precondition (and (at ?r ?from) (charged ?r)) :effect (and (at ?r ?to) (not (at ?r ?from))))
        (:action dawn :parameters () :effect (lit)))";
    let domain = domain(domain_text);
    let problem = problem(
        "(define (problem p) (:domain d) (:objects a b - place (:private r1 r1 - robot) (:private r2 r2 - robot))
           (:init (at r1 a) (at r2 a) (charged r1)) (:goal (and (at r1 b) (lit))))",
    );
    let task = unfactored(&domain, &problem).unwrap();
    let names: Vec<&str> = task.agents.iter().map(|a| a.name.as_str()).collect();
    assert_eq!(names, ["r1", "r2", "solo"], "who does what the files give to nobody is a member too");
    assert_eq!(task.agentless, [Name::new("dawn")]);
    let text = task.domain.to_string();
    let report = check_domain(&task.domain, &Source::new("team", text.clone()));
    assert!(!report.has_errors() && !text.contains(":private") && !text.contains(":agent"), "{report}{text}");
}

//! Wrong input: the exit code of the contract, and a text that names the place and the cure.

use crate::tools::{Folder, README, json, output, processes_of, run_args};

struct Case {
    what: &'static str,
    args: Vec<String>,
    code: i32,
    says: &'static [&'static str],
}

fn case(what: &'static str, args: &[&str], code: i32, says: &'static [&'static str]) -> Case {
    Case { what, args: args.iter().map(|a| (*a).to_string()).collect(), code, says }
}

const DOMAIN: &str = "(define (domain d) (:requirements :strips)
  (:predicates (p) (q))
  (:action a :parameters () :precondition (p) :effect (q)))";

#[test]
fn wrong_input_is_told_with_place_and_cure() {
    let folder = Folder::new("bad");
    let domain = folder.file("domain.pddl", DOMAIN);
    let unbalanced = folder.file("unbalanced.pddl", "(define (domain d)\n  (:predicates (p)");
    let misspelt = folder.file("misspelt.pddl", &DOMAIN.replace(":effect (q)", ":effect (qq)"));
    let problem = folder.file("problem.pddl", "(define (problem x) (:domain d) (:init (p)) (:goal (q)))");
    let unsolvable = folder.file("hopeless.pddl", "(define (problem x) (:domain d) (:init) (:goal (q)))");
    let tasks = folder.file("tasks.jsonl", "{\"id\": \"a\", \"secne\": \"FloorPlan6\"}\n");
    let empty = folder.file("empty.jsonl", "\n");
    let plan = folder.file("plan.txt", "(a)\n");
    let wrong_plan = folder.file("wrong.txt", "; nothing\n");
    let apple = "Put the apple in the fridge";
    let cases = [
        case(
            "unknown scene",
            &["run", README, "--scene", "FlorPlan6", "--team", "robot1"],
            20,
            &["FlorPlan6", "FloorPlan6"],
        ),
        case(
            "unknown robot",
            &["run", README, "--scene", "FloorPlan6", "--team", "robot1,robo2"],
            20,
            &["robo2", "robot2"],
        ),
        case(
            "empty instruction",
            &["run", "  ", "--scene", "FloorPlan6", "--team", "robot1"],
            20,
            &["instruction is empty"],
        ),
        case("no team", &["run", README, "--scene", "FloorPlan6"], 20, &["--team"]),
        case(
            "unknown flag",
            &["run", README, "--secne", "FloorPlan6", "--team", "robot1"],
            20,
            &["--secne", "--scene"],
        ),
        case(
            "unknown model",
            &["run", README, "--scene", "FloorPlan6", "--team", "robot1", "--lm", "gpt"],
            20,
            &["gpt", "offline"],
        ),
        case(
            "unknown model, and nothing to read",
            &["run", "--pddl", &domain, &problem, "--lm", "gpt"],
            20,
            &["gpt", "offline"],
        ),
        case("unknown command", &["rnu"], 20, &["rnu"]),
        case("missing domain file", &["plan", "nowhere.pddl", &problem], 20, &["nowhere.pddl"]),
        case("a folder for a file", &["plan", ".", &problem], 20, &["cannot read"]),
        case("unbalanced parenthesis", &["plan", &unbalanced, &problem], 20, &["unbalanced.pddl"]),
        case("misspelt predicate", &["plan", &misspelt, &problem], 20, &["misspelt.pddl:3", "qq"]),
        case("solvable", &["plan", &domain, &problem], 0, &["(a)", "; cost = 1"]),
        case("cheapest", &["plan", &domain, &problem, "--search", "astar-lmcut"], 0, &["(a)", "; cost = 1"]),
        case(
            "unknown search",
            &["plan", &domain, &problem, "--search", "astra"],
            20,
            &["astra", "astar-lmcut"],
        ),
        case(
            "grounded",
            &["plan", &domain, &problem, "--sas"],
            0,
            &["begin_version", "begin_operator", "atom q()"],
        ),
        case("unsolvable", &["plan", &domain, &unsolvable], 10, &["unsolvable"]),
        case("valid plan", &["validate", &domain, &problem, &plan], 0, &["valid"]),
        case("wrong plan", &["validate", &domain, &problem, &wrong_plan], 1, &["(q)"]),
        case(
            "misspelt key of a task",
            &["bench", "--tasks", &tasks],
            20,
            &["tasks.jsonl", "line 1", "secne", "scene"],
        ),
        case("no task", &["bench", "--tasks", &empty], 20, &["empty.jsonl"]),
        case("no suite", &["bench"], 20, &["--tasks"]),
        case("missing suite folder", &["bench", "--mat-thor", "nowhere"], 20, &["nowhere"]),
        case("unknown diagnostic", &["explain", "nonsense"], 20, &["nonsense"]),
        case(
            "skill nobody has",
            &["run", apple, "--scene", "FloorPlan6", "--team", "robot24"],
            10,
            &["PickupObject"],
        ),
        case(
            "too heavy for the team",
            &["run", apple, "--scene", "FloorPlan6", "--team", "robot10"],
            10,
            &["Apple_1", "kg"],
        ),
        case(
            "object that is not there",
            &["run", "Turn on the television", "--scene", "FloorPlan6", "--team", "robot1"],
            12,
            &["television"],
        ),
        case(
            "nonsense",
            &["run", "Frobnicate the zorp", "--scene", "FloorPlan6", "--team", "robot1"],
            12,
            &["frobnicate"],
        ),
    ];
    for c in cases {
        let args: Vec<&str> = c.args.iter().map(String::as_str).collect();
        let out = output(&folder, &args);
        let text =
            format!("{}{}", String::from_utf8_lossy(&out.stdout), String::from_utf8_lossy(&out.stderr));
        assert_eq!(out.status.code(), Some(c.code), "{}: {text}", c.what);
        assert!(!text.contains("panicked"), "{}: {text}", c.what);
        let lower = text.to_lowercase();
        for says in c.says {
            assert!(lower.contains(&says.to_lowercase()), "{}: {says:?} is not in: {text}", c.what);
        }
    }
    assert_eq!(processes_of(&folder), [], "a process is left");
}

#[test]
fn json_is_printed_for_failures_too() {
    let folder = Folder::new("bad-json");
    let mut args = run_args(README, "robot1", &[]);
    args[3] = "FloorPlan9999";
    let (code, result) = json(&output(&folder, &args));
    assert_eq!((code, &result["outcome"]), (20, &"error".into()));
    assert!(result["reason"].as_str().unwrap().contains("FloorPlan9999"));
    let (code, result) = json(&output(&folder, &run_args("Frobnicate the zorp", "robot1", &[])));
    assert_eq!((code, &result["outcome"]), (12, &"needs_clarification".into()));
    assert!(
        result["clarification"]["not_understood"].as_array().is_some_and(|l| !l.is_empty()),
        "{result:#}"
    );
}

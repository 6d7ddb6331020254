//! Multi-agent PDDL tasks: one process per agent, each with its own files.

use std::collections::BTreeSet;
use std::time::Duration;

use serde_json::Value;

use crate::tools::{
    Folder, eventually, finish, json, lamma, output, pid_of, processes_of, shared_memory_of, signal, start,
    tag_of,
};

const FERRY: &str = "(define (domain harbour)
  (:requirements :typing :factored-privacy)
  (:types quay crate engine - object)
  (:predicates (lies ?c - crate ?q - quay) (stamped ?c - crate)
    (:private (moored ?q - quay) (aboard ?c - crate) (runs ?e - engine)))
  (:action sail :parameters (?from ?to - quay ?e - engine)
    :precondition (and (moored ?from) (runs ?e))
    :effect (and (moored ?to) (not (moored ?from))))
  (:action load :parameters (?c - crate ?q - quay)
    :precondition (and (lies ?c ?q) (moored ?q)) :effect (and (aboard ?c) (not (lies ?c ?q))))
  (:action unload :parameters (?c - crate ?q - quay)
    :precondition (and (aboard ?c) (moored ?q)) :effect (and (lies ?c ?q) (not (aboard ?c)))))";

const CLERK: &str = "(define (domain harbour)
  (:requirements :typing :factored-privacy)
  (:types quay crate engine desk - object)
  (:predicates (lies ?c - crate ?q - quay) (stamped ?c - crate)
    (:private (office ?d - desk ?q - quay) (inked ?d - desk)))
  (:action dip :parameters (?d - desk) :precondition (and) :effect (inked ?d))
  (:action stamp :parameters (?d - desk ?c - crate ?q - quay)
    :precondition (and (lies ?c ?q) (office ?d ?q) (inked ?d))
    :effect (and (stamped ?c) (not (inked ?d)))))";

/// Words that no message may hold under strict privacy.
const PRIVATE: [&str; 11] = [
    "moored",
    "aboard",
    "runs",
    "sail",
    "unload",
    "office",
    "inked",
    "dip",
    "north-engine",
    "oak-desk",
    "south-engine",
];

/// The problem of a ferry. The crates are known to lie where the north ferry begins.
fn ferry(name: &str, from: &str, to: &str, more: &str) -> String {
    format!(
        "(define (problem {name}) (:domain harbour)
          (:objects {from} {to} - quay tea salt - crate (:private {name}-engine - engine))
          (:init (moored {from}) (runs {name}-engine) {more})
          (:goal (and (lies tea village) (lies salt village))))"
    )
}

fn clerk(init: &str) -> String {
    format!(
        "(define (problem clerk) (:domain harbour)
          (:objects island village - quay tea salt - crate (:private oak-desk - desk))
          (:init {init}) (:goal (and (stamped tea))))"
    )
}

/// North ferry: mainland to island; south ferry: island to village; the clerk on the island stamps. Nobody can
/// do it alone, and nobody knows all quays.
fn harbour(folder: &Folder) -> String {
    let path = folder.0.join("harbour");
    std::fs::create_dir_all(&path).unwrap();
    let write = |name: &str, text: &str| std::fs::write(path.join(name), text).unwrap();
    write("domain-north.pddl", FERRY);
    // The goal names a quay that the north ferry does not know: it wants only what it can understand.
    let north = ferry("north", "mainland", "island", "(lies tea mainland) (lies salt mainland)");
    let north = north.split("(:goal").next().unwrap().to_string() + "(:goal (and (stamped tea))))";
    write("problem-north.pddl", &north);
    write("domain-south.pddl", FERRY);
    write("problem-south.pddl", &ferry("south", "island", "village", ""));
    write("domain-clerk.pddl", CLERK);
    write("problem-clerk.pddl", &clerk("(office oak-desk island)"));
    path.display().to_string()
}

fn run(folder: &Folder, args: &[&str]) -> (i32, Value) {
    json(&output(folder, &[args, &["--format", "json"]].concat()))
}

#[test]
fn a_factored_task_is_carried_out_by_one_process_per_agent() {
    let folder = Folder::new("codmap");
    let dir = harbour(&folder);
    let (code, result) = run(&folder, &["run", "--codmap", &dir]);
    assert_eq!((code, &result["outcome"]), (0, &"success".into()), "{result:#}");
    let pids: BTreeSet<u64> =
        result["processes"].as_array().unwrap().iter().map(|p| p["pid"].as_u64().unwrap()).collect();
    assert_eq!(pids.len(), 5, "three agents, the coordinator and the simulator: {result:#}");
    assert_eq!(result["goal"]["total"], 3, "{result:#}");
    assert_eq!(result["metrics"]["exe"], 1.0, "{result:#}");
    let plan = &result["plan"];
    assert!(plan["makespan"].as_f64() >= plan["makespan_lower_bound"].as_f64(), "{plan:#}");
    assert!(plan["makespan_lower_bound"].as_f64() > Some(0.0), "{plan:#}");
    let actions = plan["actions"].as_array().unwrap();
    assert!(actions.iter().any(|a| a["robot"] == "clerk" && a["action"] == "stamp"), "{plan:#}");
    // The agents' own words, although two of them use the same ones.
    assert!(actions.iter().any(|a| a["action"] == "sail" && a["args"][2] == "north-engine"), "{plan:#}");
    assert_eq!(processes_of(&folder), []);
    let (code, solved) = run(&folder, &["solve", "--codmap", &dir, "--bus", "inproc"]);
    assert_eq!((code, &solved["plan"]["makespan"]), (0, &plan["makespan"]), "{solved:#}");
}

/// Under strict privacy nothing that a process hears holds a private word.
#[test]
fn under_strict_privacy_no_private_word_leaves_an_agent() {
    let folder = Folder::new("strict");
    let dir = harbour(&folder);
    let (code, result) = run(&folder, &["run", "--codmap", &dir, "--privacy", "strict"]);
    assert_eq!((code, &result["outcome"]), (0, &"success".into()), "{result:#}");
    // The person who started it may see the whole: the launcher has all the files.
    let actions = result["plan"]["actions"].as_array().unwrap();
    assert!(actions.iter().any(|a| a["action"] == "sail" && a["args"][2] == "south-engine"), "{result:#}");
    for (privacy, hidden) in [("strict", true), ("trusted", false)] {
        let words = words_of(&folder, &dir, privacy);
        assert!(words.contains("lies") && words.contains("stamped"), "public words are said: {words:?}");
        let said: Vec<&&str> = PRIVATE.iter().filter(|word| words.contains(**word)).collect();
        assert_eq!(said.is_empty(), hidden, "{privacy}: {said:?}");
    }
}

/// Every word in the shared memory of a slow run, sampled while it lasts: all that is said lies there.
fn words_of(folder: &Folder, dir: &str, privacy: &str) -> BTreeSet<String> {
    let mut child = start(folder, &["run", "--codmap", dir, "--privacy", privacy, "--step-ms", "100"]);
    let mut words = BTreeSet::new();
    let begun = std::time::Instant::now();
    while child.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < Duration::from_secs(60), "the run does not end");
        for file in tag_of(folder).iter().flat_map(|tag| shared_memory_of(tag)) {
            words_in(&std::fs::read(file).unwrap_or_default(), &mut words);
        }
        std::thread::sleep(Duration::from_millis(100));
    }
    words
}

/// The memory is mostly empty pages, which say nothing.
fn words_in(memory: &[u8], words: &mut BTreeSet<String>) {
    const PAGE: usize = 4096;
    let pages: Vec<&[u8]> = memory.chunks(PAGE).collect();
    for run in pages.split(|page| **page == [0; PAGE][..page.len()]) {
        let text = run.concat();
        let text = String::from_utf8_lossy(&text);
        let split = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '-' && c != '_');
        words.extend(split.filter(|word| word.len() > 2).map(String::from));
    }
}

#[test]
fn a_killed_agent_ends_the_run_with_a_reason() {
    let folder = Folder::new("codmap-kill");
    let dir = harbour(&folder);
    let run_dir = folder.0.join("run").display().to_string();
    let args = ["run", "--codmap", &dir, "--step-ms", "400", "--run-dir", &run_dir, "--format", "json"];
    let child = start(&folder, &args);
    let pid = || pid_of(&folder, "robot", Some(2));
    let south = eventually(Duration::from_secs(20), "the team starts", pid);
    std::thread::sleep(Duration::from_millis(1500));
    signal(south, "KILL");
    let (code, result) = json(&finish(child, Duration::from_secs(15)));
    assert_eq!((code, &result["outcome"]), (10, &"infeasible".into()), "{result:#}");
    let reason = result["reason"].as_str().unwrap();
    assert!(reason.contains("south has died"), "{reason}");
    assert_eq!(processes_of(&folder), []);
}

const DRONES: &str = "(define (domain fields)
  (:requirements :typing :multi-agent :unfactored-privacy)
  (:types drone field - object)
  (:predicates (over ?d - drone ?f - field) (sprayed ?f - field)
    (:private ?agent - drone (full ?agent - drone)))
  (:action fly :agent ?d - drone :parameters (?from ?to - field)
    :precondition (over ?d ?from) :effect (and (over ?d ?to) (not (over ?d ?from))))
  (:action spray :agent ?d - drone :parameters (?f - field)
    :precondition (and (over ?d ?f) (full ?d)) :effect (and (sprayed ?f) (not (full ?d)))))";

const FIELDS: &str = "(define (problem two) (:domain fields)
  (:objects east west - field (:private d1 d1 - drone) (:private d2 d2 - drone))
  (:init (over d1 east) (over d2 east) (full d1) (full d2))
  (:goal (and (sprayed east) (sprayed west))))";

#[test]
fn an_unfactored_task_is_solved_and_carried_out() {
    let folder = Folder::new("ma-pddl");
    let (domain, problem) = (folder.file("domain.pddl", DRONES), folder.file("problem.pddl", FIELDS));
    let (code, result) = run(&folder, &["run", "--pddl", &domain, &problem]);
    assert_eq!((code, &result["outcome"]), (0, &"success".into()), "{result:#}");
    // One drone sprays here while the other flies: two steps, and no plan is shorter.
    assert_eq!(result["plan"]["makespan"], 2.0, "{result:#}");
    assert_eq!(result["plan"]["makespan_lower_bound"], 2.0, "{result:#}");
    assert_eq!(result["understood"]["subtasks"][0]["robots"].as_array().map(Vec::len), Some(2), "{result:#}");
    let (code, solved) = run(&folder, &["solve", "--pddl", &domain, &problem]);
    assert_eq!((code, &solved["plan"]["length"]), (0, &3.into()), "{solved:#}");
}

/// A classical task is a team of one.
#[test]
fn a_classical_task_is_a_team_of_one() {
    let folder = Folder::new("classical");
    let domain = folder.file(
        "domain.pddl",
        "(define (domain d) (:predicates (p ?x) (q ?x))
           (:action turn :parameters (?x) :precondition (p ?x) :effect (and (q ?x) (not (p ?x)))))",
    );
    let problem = folder.file(
        "problem.pddl",
        "(define (problem x) (:domain d) (:objects a b) (:init (p a) (p b)) (:goal (and (q a) (q b))))",
    );
    let (code, result) = run(&folder, &["run", "--pddl", &domain, &problem]);
    assert_eq!((code, &result["plan"]["makespan"]), (0, &2.0.into()), "{result:#}");
    assert_eq!(result["plan"]["actions"][0]["robot"], "solo", "{result:#}");
    assert_eq!(result["plan"]["actions"][0]["args"].as_array().map(Vec::len), Some(1), "{result:#}");
}

#[test]
fn wrong_team_files_are_told_with_place_and_cure() {
    let folder = Folder::new("codmap-bad");
    let dir = harbour(&folder);
    let file = |name: &str| std::path::Path::new(&dir).join(name);
    let say = |args: &[&str]| {
        let out = lamma(&folder, args).output().unwrap();
        let text =
            format!("{}{}", String::from_utf8_lossy(&out.stdout), String::from_utf8_lossy(&out.stderr));
        assert!(!text.contains("panicked"), "{text}");
        (out.status.code(), text)
    };
    let expect = |args: &[&str], code: i32, words: &[&str]| {
        let (found, text) = say(args);
        assert_eq!(found, Some(code), "{args:?}: {text}");
        for word in words {
            assert!(text.contains(word), "{args:?}: {word:?} is not in {text}");
        }
    };
    expect(&["run", "--codmap", "nowhere"], 20, &["nowhere"]);
    let empty = folder.0.join("empty");
    std::fs::create_dir_all(&empty).unwrap();
    expect(&["solve", "--codmap", &empty.display().to_string()], 20, &["no agents", "domain-AGENT.pddl"]);
    expect(&["run", "--codmap", &dir, "--pddl", "a", "b"], 20, &["--pddl"]);
    expect(&["run", "--codmap", &dir, "Do something"], 20, &["--codmap"]);
    expect(&["run", "--pddl", "one.pddl"], 20, &["--pddl"]);
    expect(&["bench", "--codmap", &empty.display().to_string()], 20, &["no unfactored task", "domain.pddl"]);
    let write = |name: &str, text: &str| std::fs::write(file(name), text).unwrap();
    write("problem-clerk.pddl", &clerk("(inked oak-desk)"));
    expect(&["run", "--codmap", &dir], 10, &["infeasible", "stamped tea"]);
    write("problem-clerk.pddl", &clerk("(stampd tea)"));
    expect(&["run", "--codmap", &dir], 20, &["problem-clerk.pddl:3", "stampd", "stamped"]);
    std::fs::remove_file(file("problem-clerk.pddl")).unwrap();
    expect(&["run", "--codmap", &dir], 20, &["clerk has no problem", "problem-clerk.pddl"]);
    std::fs::remove_file(file("domain-clerk.pddl")).unwrap();
    let other = FERRY
        .replace("(lies ?c - crate ?q - quay)", "(lies ?c - crate)")
        .replace("(lies ?c ?q)", "(lies ?c)");
    write("domain-south.pddl", &other);
    write("problem-south.pddl", "(define (problem s) (:domain harbour) (:init) (:goal (and)))");
    expect(&["run", "--codmap", &dir], 20, &["lies", "north", "south"]);
}

/// A small suite in the layout of the competition: the table, and the files.
#[test]
fn the_bench_prints_its_table_and_writes_its_files() {
    let folder = Folder::new("codmap-bench");
    let set = folder.0.join("set");
    let task = set.join("unfactored/fields/two");
    std::fs::create_dir_all(&task).unwrap();
    std::fs::write(task.join("domain.pddl"), DRONES).unwrap();
    std::fs::write(task.join("problem.pddl"), FIELDS).unwrap();
    let reference = r#"{"problems": {"fields/two": {"best_makespan": 4, "agents": 2}}}"#;
    std::fs::write(set.join("reference_values.json"), reference).unwrap();
    let (set, out) = (set.display().to_string(), folder.0.join("out").display().to_string());
    let (code, result) = run(&folder, &["bench", "--codmap", &set, "--out", &out]);
    assert_eq!(code, 0, "{result:#}");
    let row = &result["table"]["all"];
    assert_eq!((&row["n"], &row["solved"]), (&1.into(), &1.into()), "{result:#}");
    assert_eq!(row["makespan_to_best_geomean"], 0.5, "{row:#}");
    let csv = std::fs::read_to_string(std::path::Path::new(&out).join("results.csv")).unwrap();
    assert!(csv.contains("fields/two,fields,success,1,"), "{csv}");
}

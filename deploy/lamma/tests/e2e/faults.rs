//! Kills in real runs. A slow simulator gives the time to interfere.

use std::time::Duration;

use crate::tools::{
    Folder, README, eventually, finish, json, output, pid_of, processes_of, run_args, shared_memory_of,
    signal, start, tag_of,
};

const SOON: Duration = Duration::from_secs(20);

/// Starts the README's run slowly, and waits until robots act.
fn slow_run(folder: &Folder, team: &str) -> std::process::Child {
    let run_dir = folder.0.join("run").display().to_string();
    let args = run_args(README, team, &["--step-ms", "400", "--run-dir", &run_dir]);
    let child = start(folder, &args);
    eventually(SOON, "the team starts", || pid_of(folder, "robot", Some(0)));
    child
}

/// Must show: `kill -9` of a robot in a real run; the others finish.
#[test]
fn a_killed_robot_is_replaced_by_those_who_can() {
    let folder = Folder::new("kill-robot");
    let child = slow_run(&folder, "robot1,robot17,robot24");
    std::thread::sleep(Duration::from_millis(1500));
    signal(pid_of(&folder, "robot", Some(1)).unwrap(), "KILL");
    let (code, result) = json(&finish(child, Duration::from_secs(15)));
    assert_eq!((code, &result["outcome"]), (0, &"success".into()), "{result:#}");
    let faults = result["faults"].as_array().unwrap();
    assert!(faults.iter().any(|f| f["text"].as_str().unwrap().contains("robot17 has died")), "{faults:?}");
    assert!(!result["recoveries"].as_array().unwrap().is_empty());
    assert_eq!(processes_of(&folder), []);
}

/// Must show: when nobody else can, the run ends infeasible with the reason, within 10 s.
#[test]
fn without_the_killed_robots_skill_the_run_is_infeasible() {
    let folder = Folder::new("kill-only");
    let child = slow_run(&folder, "robot17,robot24");
    std::thread::sleep(Duration::from_millis(1000));
    signal(pid_of(&folder, "robot", Some(1)).unwrap(), "KILL");
    let (code, result) = json(&finish(child, Duration::from_secs(10)));
    assert_eq!((code, &result["outcome"]), (10, &"infeasible".into()), "{result:#}");
    let reason = result["reason"].as_str().unwrap();
    assert!(reason.contains("SwitchOff") && reason.contains("robot24"), "{reason}");
}

#[test]
fn a_stopped_robot_does_not_hold_up_the_others_for_ever() {
    let folder = Folder::new("stop-robot");
    let child = slow_run(&folder, "robot1,robot17,robot24");
    std::thread::sleep(Duration::from_millis(1000));
    signal(pid_of(&folder, "robot", Some(1)).unwrap(), "STOP");
    let (code, result) = json(&finish(child, Duration::from_secs(25)));
    assert_eq!((code, &result["outcome"]), (0, &"success".into()), "{result:#}");
    assert_eq!(processes_of(&folder), [], "also a stopped process is gone");
}

#[test]
fn without_its_simulator_a_run_ends_with_a_fault() {
    let folder = Folder::new("kill-simulator");
    let child = slow_run(&folder, "robot1,robot24");
    signal(pid_of(&folder, "simulator", None).unwrap(), "KILL");
    let (code, result) = json(&finish(child, Duration::from_secs(10)));
    assert_eq!((code, &result["outcome"]), (30, &"error".into()), "{result:#}");
    assert!(result["reason"].as_str().unwrap().contains("simulator"));
    assert_eq!(processes_of(&folder), []);
}

#[test]
fn ctrl_c_ends_everything_and_leaves_nothing() {
    let folder = Folder::new("ctrl-c");
    let child = slow_run(&folder, "robot1,robot17,robot24");
    let tag = tag_of(&folder).unwrap();
    assert!(!shared_memory_of(&tag).is_empty(), "the run uses shared memory");
    signal(child.id(), "INT");
    let (code, result) = json(&finish(child, Duration::from_secs(10)));
    assert_eq!((code, &result["reason"]), (11, &"interrupted".into()));
    assert_eq!(processes_of(&folder), []);
    assert_eq!(shared_memory_of(&tag), Vec::<std::path::PathBuf>::new());
}

#[test]
fn after_kill_of_the_launcher_children_end_and_clean_removes_the_rest() {
    let folder = Folder::new("kill-launcher");
    let child = slow_run(&folder, "robot1,robot17,robot24");
    let tag = tag_of(&folder).unwrap();
    signal(child.id(), "KILL");
    let _ = finish(child, Duration::from_secs(5));
    eventually(Duration::from_secs(5), "the children end", || processes_of(&folder).is_empty().then_some(()));
    let out = output(&folder, &["clean"]);
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    assert_eq!(shared_memory_of(&tag), Vec::<std::path::PathBuf>::new());
}

//! Teams of many robots: one process each, many in one process, and some that stand still.

use std::time::Duration;

use crate::tools::{
    Folder, README, eventually, finish, json, output, processes_of, run_args, shared_memory_of, signal,
    start, tag_of,
};

/// Every robot plans, acts and meets all others, and nothing is left.
fn check_scale(folder: &Folder, more: &[&str], processes: u64) {
    let mut args = vec!["scale", "--agents", "2,32", "--rounds", "5", "--format", "json"];
    args.extend(more);
    let (code, result) = json(&output(folder, &args));
    assert_eq!(code, 0, "{result:#}");
    let levels = result["levels"].as_array().unwrap();
    let agents: Vec<u64> = levels.iter().map(|l| l["agents"].as_u64().unwrap()).collect();
    assert_eq!(agents, [2, 32]);
    let large = &levels[1];
    assert_eq!(large["processes"], processes, "{large:#}");
    assert!(large["actions"].as_u64().unwrap() >= 32 * (5 + 1), "everybody has acted: {large:#}");
    assert_eq!(large["barriers"], 4, "between five entries of the lead lie four meetings");
    assert_eq!((&large["processes_left"], &large["files_left"]), (&0.into(), &0.into()));
    assert!(large["private_kib"]["p50"].as_f64().unwrap() > 0.0);
    let plot = std::fs::read_to_string(folder.0.join("scale.svg")).unwrap();
    assert!(plot.starts_with("<svg") && plot.ends_with("</svg>\n"));
    assert_eq!(processes_of(folder), []);
}

#[test]
fn teams_of_processes_plan_act_meet_and_leave_nothing() {
    check_scale(&Folder::new("scale"), &[], 32);
}

#[test]
fn workers_host_many_robots_each() {
    check_scale(&Folder::new("scale-workers"), &["--workers", "3"], 3);
}

/// The same household run with all robots in two processes: the same plan, whoever hosts the robots.
#[test]
fn a_run_with_workers_makes_the_same_plan() {
    let folder = Folder::new("workers");
    let team = "robot1,robot17,robot24";
    let (_, apart) = json(&output(&folder, &run_args(README, team, &[])));
    let (code, hosted) = json(&output(&folder, &run_args(README, team, &["--workers", "2"])));
    assert_eq!((code, &hosted["outcome"]), (0, &"success".into()), "{hosted:#}");
    assert_eq!(hosted["plan"], apart["plan"]);
    let robots = hosted["processes"].as_array().unwrap().iter().filter(|p| p["role"] == "robot");
    let pids: std::collections::BTreeSet<u64> = robots.map(|p| p["pid"].as_u64().unwrap()).collect();
    assert_eq!(pids.len(), 2, "two processes host three robots");
}

#[test]
fn workers_are_refused_where_there_are_no_processes() {
    let folder = Folder::new("workers-inproc");
    let (code, result) =
        json(&output(&folder, &run_args(README, "robot1", &["--bus", "inproc", "--workers", "2"])));
    assert_eq!(code, 20, "{result:#}");
    assert!(result["reason"].as_str().unwrap().contains("--workers"), "{result:#}");
}

/// A third of the team stands still for a while: the others wait where they must, nothing that was said to the
/// stopped meanwhile is lost, and the team comes to its end.
#[test]
fn robots_that_stood_still_catch_up() {
    let folder = Folder::new("scale-stop");
    let run_dir = folder.0.join("run").display().to_string();
    let args = ["scale", "--agents", "16", "--rounds", "200", "--format", "json", "--run-dir", &run_dir];
    let child = start(&folder, &args);
    let limit = Duration::from_secs(30);
    let all = eventually(limit, "the team starts", || {
        let robots = processes_of(&folder).into_iter().filter(|(_, line)| line.contains("--role robots"));
        let robots: Vec<u32> = robots.map(|(pid, _)| pid).collect();
        (robots.len() == 16).then_some(robots)
    });
    let tag = tag_of(&folder).unwrap();
    let stopped = &all[3..9];
    stopped.iter().for_each(|pid| signal(*pid, "STOP"));
    std::thread::sleep(Duration::from_millis(1500));
    stopped.iter().for_each(|pid| signal(*pid, "CONT"));
    let (code, result) = json(&finish(child, Duration::from_secs(60)));
    assert_eq!(code, 0, "{result:#}");
    assert_eq!(result["levels"][0]["barriers"], 199);
    assert_eq!(processes_of(&folder), []);
    assert_eq!(shared_memory_of(&tag), Vec::<std::path::PathBuf>::new());
}

//! Runs that end well, and leave nothing.

use std::collections::BTreeSet;

use crate::tools::{Folder, README, json, output, processes_of, run_args, start, workspace_data};

fn skills(robot: &str) -> &'static [&'static str] {
    match robot {
        "robot17" => &["GoToObject", "OpenObject", "CloseObject", "PickupObject", "PutObject"],
        "robot24" => &["GoToObject", "SwitchOn", "SwitchOff"],
        _ => {
            &["GoToObject", "OpenObject", "CloseObject", "PickupObject", "PutObject", "SwitchOn", "SwitchOff"]
        }
    }
}

#[test]
fn the_readme_command_is_carried_out_by_a_team_of_processes() {
    let folder = Folder::new("readme");
    let run_dir = folder.0.join("run").display().to_string();
    let out = output(&folder, &run_args(README, "robot1,robot17,robot24", &["--run-dir", &run_dir]));
    let (code, result) = json(&out);
    assert_eq!((code, &result["outcome"]), (0, &"success".into()), "{result:#}");
    assert_eq!(result["bus"], "iceoryx2");
    let processes = result["processes"].as_array().unwrap();
    let pids: BTreeSet<u64> = processes.iter().map(|p| p["pid"].as_u64().unwrap()).collect();
    assert_eq!((processes.len(), pids.len()), (5, 5), "each process has its own pid: {processes:?}");
    let actions = result["plan"]["actions"].as_array().unwrap();
    let acting: BTreeSet<&str> = actions.iter().map(|a| a["robot"].as_str().unwrap()).collect();
    assert!(acting.len() >= 2, "several robots act: {acting:?}");
    for action in actions {
        let (robot, skill) = (action["robot"].as_str().unwrap(), action["action"].as_str().unwrap());
        assert!(skills(robot).contains(&skill), "{robot} acts outside its skills: {skill}");
    }
    let plan = &result["plan"];
    assert!(plan["makespan"].as_f64().unwrap() >= plan["makespan_lower_bound"].as_f64().unwrap());
    assert!(plan["makespan_lower_bound"].as_f64().unwrap() >= 1.0);
    assert_eq!(result["goal"]["reached"], result["goal"]["total"]);
    assert_eq!(result["metrics"]["exe"], 1.0);
    let last = actions.iter().filter_map(|a| a["start"].as_f64()).fold(0.0, f64::max);
    let dark = actions.iter().find(|a| a["action"] == "SwitchOff").unwrap();
    assert_eq!(dark["start"], last, "the light goes off last, as asked");
    assert!(folder.0.join("run/robots/robot17.pddl").exists() && folder.0.join("run/result.json").exists());
}

#[test]
fn one_process_reaches_the_same_outcome() {
    let folder = Folder::new("inproc");
    let (code, result) =
        json(&output(&folder, &run_args(README, "robot1,robot17,robot24", &["--bus", "inproc"])));
    assert_eq!((code, &result["outcome"]), (0, &"success".into()), "{result:#}");
}

#[test]
fn the_same_run_twice_makes_the_same_plan() {
    let folder = Folder::new("twice");
    let plan = || json(&output(&folder, &run_args(README, "robot1,robot17,robot24", &[]))).1["plan"].clone();
    assert_eq!(plan(), plan());
}

#[test]
fn solve_prints_the_plan_and_changes_nothing() {
    let folder = Folder::new("solve");
    let mut args = run_args("Put the apple in the fridge", "robot1", &[]);
    args[0] = "solve";
    let (code, result) = json(&output(&folder, &args));
    assert_eq!((code, &result["outcome"]), (0, &"success".into()), "{result:#}");
    assert!(result["plan"]["makespan"].as_f64().unwrap() > 0.0);
    assert_eq!(result["time_ms"]["execute"], 0.0);
}

/// Must show: 50 runs in a row and 4 runs at once leave no process, shared memory or socket.
#[test]
fn fifty_runs_in_a_row_and_four_at_once_leave_nothing() {
    let folder = Folder::new("fifty");
    let instruction = "Switch off the light";
    for i in 0..46 {
        let (code, result) = json(&output(&folder, &run_args(instruction, "robot1,robot24", &[])));
        assert_eq!(code, 0, "run {i}: {result:#}");
    }
    let at_once: Vec<_> =
        (0..4).map(|_| start(&folder, &run_args(README, "robot1,robot17,robot24", &[]))).collect();
    for child in at_once {
        let (code, result) = json(&child.wait_with_output().unwrap());
        assert_eq!(code, 0, "{result:#}");
    }
    assert_eq!(processes_of(&folder), [], "a process is left");
    let runs = std::fs::read_dir(folder.0.join(".lamma/runs")).unwrap().count();
    assert_eq!(runs, 50, "each run has its own folder");
    let mine = |f: &std::path::PathBuf| {
        std::fs::read_dir(folder.0.join(".lamma/runs"))
            .unwrap()
            .flatten()
            .any(|run| f.display().to_string().contains(run.file_name().to_str().unwrap_or("?")))
    };
    let left: Vec<_> = ["/dev/shm", "/tmp"]
        .iter()
        .flat_map(|d| std::fs::read_dir(d).into_iter().flatten().flatten())
        .map(|f| f.path())
        .filter(mine)
        .collect();
    assert!(left.is_empty(), "{left:?}");
}

/// Must show: all 51 released MAT-THOR lines are read or reported, none crashes, and SR on the lines whose goal
/// can hold and agrees with the sentence is at least 0.70.
#[test]
fn the_released_mat_thor_lines_are_benchmarked() {
    let Some(data) = workspace_data() else {
        println!("skipped: ../shared/data is not there");
        return;
    };
    let folder = Folder::new("mat-thor");
    let tasks = data.join("mat-thor/tasks").display().to_string();
    let robots = data.join("mat-thor/robots.json").display().to_string();
    let out = output(
        &folder,
        &["bench", "--mat-thor", &tasks, "--robots", &robots, "--format", "json", "--jobs", "2"],
    );
    let (code, result) = json(&out);
    assert_eq!(code, 0, "{}", String::from_utf8_lossy(&out.stderr));
    assert_eq!(result["tasks"].as_array().unwrap().len(), 51);
    let table = &result["table"];
    println!("{table:#}");
    assert!(table["all, goal agrees"]["sr"].as_f64().unwrap() >= 0.70, "{table:#}");
}

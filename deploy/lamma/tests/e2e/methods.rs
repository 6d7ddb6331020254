//! The methods to compare with and the ablation, with a chat-completions server that plays the model.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};

use serde_json::{Value, json};

use crate::tools::{Folder, json, output};

/// One task that two robots share well.
const TASK: &str = r#"{"id": "tomato", "category": "compound", "scene": "FloorPlan6", "instruction": "Put the tomato in the fridge.",
    "team": ["robot1", "robot2"], "goal": [{"object": "Fridge", "contains": ["Tomato"]}]}"#;

/// What the model says of the instruction, and whom it would send.
const SUBTASKS: &str = r#"{"subtasks": [{"id": "s1", "text": "store the tomato", "goal": [{"object": "Fridge", "contains": ["Tomato"]}],
    "after": [], "robots": ["robot1", "robot2"], "lasting": true}], "confidence": 0.9}"#;

fn step(at: u32, robot: &str, action: &str, args: &[&str]) -> Value {
    json!({"at": at, "robot": robot, "action": action, "args": args})
}

/// A plan of four time steps.
fn good_plan() -> Vec<Value> {
    vec![
        step(0, "robot1", "GoToObject", &["Tomato_1"]),
        step(0, "robot2", "GoToObject", &["Fridge_1"]),
        step(1, "robot1", "PickupObject", &["Tomato_1", "Sink_1"]),
        step(1, "robot2", "OpenObject", &["Fridge_1"]),
        step(2, "robot1", "GoToObject", &["Fridge_1"]),
        step(3, "robot1", "PutObject", &["Tomato_1", "Fridge_1"]),
    ]
}

/// A server that answers each request by what is asked for; its URL.
fn model(answer: impl Fn(&str, &Value) -> String + Send + 'static) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let url = format!("http://{}/v1", listener.local_addr().unwrap());
    std::thread::spawn(move || {
        for stream in listener.incoming().flatten() {
            let _ = serve(stream, &answer);
        }
    });
    url
}

fn serve(mut stream: TcpStream, answer: &dyn Fn(&str, &Value) -> String) -> Option<()> {
    let mut bytes = Vec::new();
    let mut buffer = [0; 4096];
    let body = loop {
        let n = stream.read(&mut buffer).ok().filter(|n| *n > 0)?;
        bytes.extend_from_slice(&buffer[..n]);
        let text = String::from_utf8_lossy(&bytes);
        let Some((head, body)) = text.split_once("\r\n\r\n") else { continue };
        let head = head.to_lowercase();
        let length = head.lines().find_map(|line| line.strip_prefix("content-length:"))?;
        if body.len() >= length.trim().parse().ok()? {
            break serde_json::from_str::<Value>(body).ok()?;
        }
    };
    let asked = body["response_format"]["json_schema"]["name"].as_str().unwrap_or_default();
    let content = answer(asked, &body);
    let reply = json!({"choices": [{"message": {"content": content}}]}).to_string();
    let head = format!("HTTP/1.1 200 OK\r\ncontent-length: {}\r\nconnection: close\r\n\r\n", reply.len());
    stream.write_all(format!("{head}{reply}").as_bytes()).ok()
}

fn plan_of(steps: &[Value]) -> String {
    json!({"reasoning": "…", "steps": steps}).to_string()
}

fn bench(folder: &Folder, url: &str, more: &[&str]) -> (i32, Value) {
    let tasks = folder.file("tasks.jsonl", &TASK.replace('\n', " "));
    let mut args =
        vec!["bench", "--tasks", &tasks, "--lm-url", url, "--lm-model", "tiny", "--format", "json"];
    args.extend(more);
    json(&output(folder, &args))
}

#[test]
fn a_plan_in_one_answer_is_carried_out_and_can_be_replayed() {
    let folder = Folder::new("cot");
    let url = model(|asked, _| if asked == "plan" { plan_of(&good_plan()) } else { "?".into() });
    let (code, recorded) = bench(&folder, &url, &["--method", "cot", "--lm", "record:cassette.jsonl"]);
    let task = &recorded["tasks"][0];
    assert_eq!((code, task["outcome"].as_str()), (0, Some("success")), "{recorded:#}");
    assert_eq!(recorded["method"], "cot");
    assert_eq!((&task["plan"]["makespan"], &task["plan"]["length"]), (&json!(4.0), &json!(6)), "{task:#}");
    assert_eq!(task["metrics"]["exe"], 1.0);
    let (_, replayed) = bench(&folder, "", &["--method", "cot", "--lm", "replay:cassette.jsonl"]);
    assert_eq!(replayed["tasks"][0]["plan"], task["plan"], "{replayed:#}");
}

/// As in the simulators of these methods: what fails is left out and the rest is tried.
#[test]
fn a_step_that_is_refused_is_left_out() {
    let folder = Folder::new("cot-refused");
    let url = model(|_, _| {
        let mut steps = good_plan();
        steps.insert(0, step(0, "robot1", "PickupObject", &["Apple_1", "CounterTop_1"]));
        steps.push(step(4, "robot2", "SwitchOn", &["Fridge_1"]));
        plan_of(&steps)
    });
    let (code, result) = bench(&folder, &url, &["--method", "cot", "--lm", "openai"]);
    let task = &result["tasks"][0];
    assert_eq!((code, task["outcome"].as_str()), (0, Some("success")), "{result:#}");
    assert_eq!(task["metrics"]["exe"], 0.75, "6 of 8 steps were possible: {task:#}");
    assert_eq!(task["faults"].as_array().map(Vec::len), Some(2), "{task:#}");
}

#[test]
fn a_plan_that_stops_short_fails_with_what_is_missing() {
    let folder = Folder::new("smart");
    let url = model(|asked, body| match asked {
        "plan" => {
            let told = body["messages"][1]["content"].as_str().unwrap_or_default();
            assert!(told.contains("1. store the tomato (robot1, robot2)"), "{told}");
            plan_of(&good_plan()[..5])
        }
        _ => SUBTASKS.into(),
    });
    let (code, result) = bench(&folder, &url, &["--method", "smart-llm", "--lm", "openai"]);
    let task = &result["tasks"][0];
    assert_eq!((code, task["outcome"].as_str()), (0, Some("goal_not_reached")), "{result:#}");
    assert_eq!(task["understood"]["subtasks"][0]["robots"], json!(["robot1", "robot2"]), "{task:#}");
    assert_eq!(task["metrics"]["gcr"], 0.0);
}

/// The model forgets to open the fridge, and mends it when told. Only with the validator is it told.
#[test]
fn the_ablation_has_a_row_for_each_set_of_modules() {
    let folder = Folder::new("ablation");
    let url = model(|asked, body| {
        let told_off = body["messages"].as_array().is_some_and(|m| m.len() > 2);
        match asked {
            "plan" if told_off => plan_of(&good_plan()),
            "plan" => {
                let open = |step: &Value| step["action"] != "OpenObject";
                plan_of(&good_plan().into_iter().filter(open).collect::<Vec<_>>())
            }
            _ => SUBTASKS.into(),
        }
    });
    let (code, result) = bench(&folder, &url, &["--without", "P,V,G,D,GV", "--lm", "openai", "--out", "out"]);
    assert_eq!(code, 0, "{result:#}");
    let row =
        |r: &Value| (r["method"].as_str().unwrap().to_string(), r["table"]["all"]["sr"].as_f64().unwrap());
    let rows: Vec<(String, f64)> = result["ablation"].as_array().unwrap().iter().map(row).collect();
    let wanted = [
        ("", 1.0),
        ("-without-P", 1.0),
        ("-without-V", 1.0),
        ("-without-G", 1.0),
        ("-without-D", 1.0),
        ("-without-VG", 0.0),
    ];
    assert_eq!(rows, wanted.map(|(name, sr)| (format!("lamma-p{name}"), sr)));
    let makespan = |row: usize| &result["ablation"][row]["tasks"][0]["plan"]["makespan"];
    assert!(makespan(4).as_f64() > makespan(0).as_f64(), "undivided, one robot does it all: {result:#}");
    for variant in ["lamma-p", "lamma-p-without-VG"] {
        assert!(folder.0.join("out").join(variant).join("results.csv").exists(), "{variant}");
    }
}

#[test]
fn what_a_switch_cannot_do_is_said_before_anything_runs() {
    let folder = Folder::new("methods-wrong");
    let tasks = folder.file("tasks.jsonl", &TASK.replace('\n', " "));
    for (args, wanted) in [
        (&["--method", "cot"][..], "cot needs a chat model"),
        (&["--method", "smart-llm", "--without", "D"], "--method lamma-p"),
        (&["--without", "P"], "lamma-p-without-P needs a chat model"),
        (&["--without", "X"], "`X` is no module"),
        (&["--without", "D,D"], "named twice"),
        (&["--method", "cto"], "smart-llm"),
        (
            &[
                "--method",
                "cot",
                "--lm",
                "openai",
                "--lm-url",
                "http://127.0.0.1:1/v1",
                "--lm-model",
                "m",
                "--goals-given",
            ],
            "leave --goals-given out",
        ),
    ] {
        let done = output(&folder, &[&["bench", "--tasks", &tasks], args].concat());
        let errors = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(20), "{args:?}: {errors}");
        assert!(errors.contains(wanted), "{args:?}: {errors}");
    }
    let done = output(&folder, &["bench", "--tasks", &tasks, "--without", "D", "--bus", "inproc"]);
    assert_eq!(done.status.code(), Some(0), "decomposition can be left out with any model");
    assert!(String::from_utf8_lossy(&done.stdout).contains("x x x -"), "{:?}", done.stdout);
}

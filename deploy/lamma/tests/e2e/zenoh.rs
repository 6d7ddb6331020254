//! Runs over Zenoh: all on one host, and started by hand as if on several.

use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Child, Stdio};
use std::time::Duration;

use crate::tools::{
    Folder, README, eventually, finish, json, lamma, output, pid_of, processes_of, run_args, signal, start,
};

const SOON: Duration = Duration::from_secs(30);
const TEAM: &str = "robot1,robot17,robot24";

/// The folder of the socket that the processes of a run meet at.
fn socket_folder(folder: &Folder) -> Option<PathBuf> {
    processes_of(folder).into_iter().find_map(|(_, line)| {
        let path = line.split("unixsock-stream/").nth(1)?.split(' ').next()?;
        Some(PathBuf::from(path).parent()?.to_path_buf())
    })
}

fn slow_run(folder: &Folder) -> Child {
    let run_dir = folder.0.join("run").display().to_string();
    let more = ["--bus", "zenoh", "--step-ms", "400", "--run-dir", &run_dir];
    let child = start(folder, &run_args(README, TEAM, &more));
    eventually(SOON, "the team starts", || pid_of(folder, "robot", Some(0)));
    child
}

#[test]
fn the_readme_command_is_carried_out_over_zenoh_and_leaves_nothing() {
    let folder = Folder::new("zenoh");
    let run_dir = folder.0.join("run").display().to_string();
    let (code, result) =
        json(&output(&folder, &run_args(README, TEAM, &["--bus", "zenoh", "--run-dir", &run_dir])));
    assert_eq!((code, &result["outcome"]), (0, &"success".into()), "{result:#}");
    assert_eq!((&result["bus"], result["processes"].as_array().unwrap().len()), (&"zenoh".into(), 5));
    let (_, shared) = json(&output(&folder, &run_args(README, TEAM, &[])));
    assert_eq!(result["plan"], shared["plan"], "the same plan as over shared memory");
    assert_eq!(processes_of(&folder), []);
}

#[test]
fn a_killed_robot_is_replaced_over_zenoh_too() {
    let folder = Folder::new("zenoh-kill");
    let child = slow_run(&folder);
    let socket = socket_folder(&folder).unwrap();
    assert!(socket.is_dir(), "{}", socket.display());
    std::thread::sleep(Duration::from_millis(1500));
    signal(pid_of(&folder, "robot", Some(1)).unwrap(), "KILL");
    let (code, result) = json(&finish(child, SOON));
    assert_eq!((code, &result["outcome"]), (0, &"success".into()), "{result:#}");
    let faults = result["faults"].as_array().unwrap();
    assert!(faults.iter().any(|f| f["text"].as_str().unwrap().contains("robot17 has died")), "{faults:?}");
    assert_eq!(processes_of(&folder), []);
    assert!(!socket.exists(), "{} is left", socket.display());
}

#[test]
fn what_a_killed_launcher_leaves_of_its_router_is_cleaned() {
    let folder = Folder::new("zenoh-launcher");
    let child = slow_run(&folder);
    let socket = socket_folder(&folder).unwrap();
    signal(child.id(), "KILL");
    let _ = finish(child, SOON);
    eventually(SOON, "the children end", || processes_of(&folder).is_empty().then_some(()));
    assert!(output(&folder, &["clean"]).status.success());
    assert!(!socket.exists(), "{} is left", socket.display());
}

#[test]
fn a_run_gets_through_a_bad_network() {
    let folder = Folder::new("bad-network");
    let faults = "loss=0.1,dup=0.1,reorder=0.1,corrupt=0.02,delay=5ms";
    for bus in ["inproc", "iceoryx2", "zenoh"] {
        let more = ["--bus", bus, "--fault-bus", faults, "--seed", "3"];
        let (code, result) = json(&output(&folder, &run_args(README, TEAM, &more)));
        assert_eq!((code, &result["outcome"]), (0, &"success".into()), "{bus}: {result:#}");
    }
    let out = output(&folder, &run_args(README, TEAM, &["--fault-bus", "los=0.1"]));
    assert_eq!(out.status.code(), Some(20));
    assert!(String::from_utf8_lossy(&out.stderr).contains("no such fault"));
}

/// Processes started by hand, ended with the test.
struct Hosts<'a> {
    folder: &'a Folder,
    run: String,
    connect: String,
    identity: Vec<String>,
    children: Vec<(String, Child)>,
}

impl<'a> Hosts<'a> {
    /// Prepares a run and starts a router for it.
    fn new(folder: &'a Folder, secure: bool) -> Hosts<'a> {
        let run = folder.0.join("run").display().to_string();
        let mut prepare = run_args(README, TEAM, &["--run-dir", &run, "--step-ms", "100"]);
        prepare[0] = "prepare";
        assert!(output(folder, &prepare).status.success());
        let mut hosts =
            Hosts { folder, run, connect: String::new(), identity: Vec::new(), children: Vec::new() };
        let mut listen = vec!["router".to_owned(), "--listen".into(), "tcp/127.0.0.1:0".into()];
        if secure {
            let identity = folder.0.join("identity").display().to_string();
            let made = output(folder, &["new", "--secure", &identity, "--agents", "3"]);
            assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
            hosts.identity = vec!["--identity".into(), identity];
            listen[2] = "tls/127.0.0.1:0".into();
            listen.extend(hosts.identity.clone());
        }
        let args: Vec<&str> = listen.iter().map(String::as_str).collect();
        let mut router = lamma(folder, &args).stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(router.stdout.take().unwrap()).read_line(&mut line).unwrap();
        hosts.connect = line.trim().rsplit(' ').next().unwrap().to_owned();
        hosts.children.push(("router".into(), router));
        hosts
    }

    fn arguments(&self, role: &str, agent: u16) -> Vec<String> {
        let agent = agent.to_string();
        let args = [role, "--run-dir", &self.run, "--bus", "zenoh", "--connect", &self.connect];
        let mut args: Vec<String> = args.map(String::from).into();
        if role == "robot" {
            args.extend(["--agent".into(), agent]);
        }
        args
    }

    fn spawn(&self, args: &[String]) -> Child {
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        lamma(self.folder, &args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    }

    fn start(&mut self, role: &str, agent: u16) {
        let mut args = self.arguments(role, agent);
        args.extend(self.identity.clone());
        let child = self.spawn(&args);
        self.children.push((format!("{role} {agent}"), child));
    }

    /// The coordinator's result, when all but the router have ended.
    fn finish(&mut self) -> (i32, serde_json::Value) {
        let mut args = self.arguments("coordinator", 0);
        args.extend(self.identity.clone());
        args.extend(["--format".into(), "json".into()]);
        let result = json(&finish(self.spawn(&args), SOON * 2));
        for (name, child) in &mut self.children[1..] {
            eventually(SOON, &format!("{name} ends"), || child.try_wait().unwrap());
        }
        result
    }
}

impl Drop for Hosts<'_> {
    fn drop(&mut self) {
        for (_, child) in &mut self.children {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

#[test]
fn processes_started_by_hand_meet_at_a_router() {
    let folder = Folder::new("by-hand");
    let mut hosts = Hosts::new(&folder, false);
    hosts.start("simulator", 0);
    (0..3).for_each(|agent| hosts.start("robot", agent));
    let (code, result) = hosts.finish();
    assert_eq!((code, &result["outcome"]), (0, &"success".into()), "{result:#}");
}

/// Must show: a robot with another robot's certificate, or none, is refused, and the run is not disturbed.
#[test]
fn who_is_not_who_it_says_is_refused_and_the_run_goes_on() {
    let folder = Folder::new("secure");
    let mut hosts = Hosts::new(&folder, true);
    let identity = hosts.identity.clone();
    let impostor = |more: &[String]| {
        let mut args = hosts.arguments("robot", 1);
        args.extend(["--connect-limit".into(), "2".into()]);
        args.extend(more.iter().cloned());
        hosts.spawn(&args)
    };
    let other = [identity.clone(), vec!["--identity-name".into(), "robot-2".into()]].concat();
    let strange = folder.0.join("strange").display().to_string();
    assert!(output(&folder, &["new", "--secure", &strange, "--agents", "3"]).status.success());
    let intruders = [
        ("another robot's certificate", impostor(&other)),
        ("no certificate", impostor(&[])),
        ("another authority's certificate", impostor(&["--identity".into(), strange])),
    ];
    hosts.start("simulator", 0);
    (0..3).for_each(|agent| hosts.start("robot", agent));
    let (code, result) = hosts.finish();
    assert_eq!((code, &result["outcome"]), (0, &"success".into()), "{result:#}");
    assert_eq!(result["faults"].as_array().unwrap().len(), 0, "{result:#}");
    for (what, child) in intruders {
        let out = finish(child, SOON);
        let errors = String::from_utf8_lossy(&out.stderr);
        // With a certificate of the team a session stands, but not as somebody else's.
        let why = if what == "another robot's certificate" { "refuses this session" } else { "cannot join" };
        assert_eq!(out.status.code(), Some(30), "{what}: {errors}");
        assert!(errors.contains(why), "{what}: {errors}");
    }
}

/// Two hosts' parts of one run, each with shared memory of its own, and a bridge between them.
#[test]
fn a_team_spread_over_two_hosts_is_bridged() {
    let folder = Folder::new("two-hosts");
    let run = folder.0.join("run").display().to_string();
    let mut prepare = run_args(README, TEAM, &["--run-dir", &run, "--away", "west=robot17+robot24"]);
    prepare.extend(["--stall-limit", "20"]);
    prepare[0] = "prepare";
    let prepared = output(&folder, &prepare);
    assert!(prepared.status.success(), "{}", String::from_utf8_lossy(&prepared.stderr));
    // A port that was free a moment ago: the two parts must be told the same one.
    let port = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let at = format!("tcp/127.0.0.1:{port}");
    let west = start(&folder, &["host", "west", "--run-dir", &run, "--connect", &at]);
    let hub = start(&folder, &["host", "hub", "--run-dir", &run, "--listen", &at, "--format", "json"]);
    let (code, result) = json(&finish(hub, SOON * 2));
    assert_eq!((code, &result["outcome"]), (0, &"success".into()), "{result:#}");
    let acting = result["plan"]["actions"].as_array().unwrap().iter().map(|a| a["robot"].as_str().unwrap());
    let acting: std::collections::BTreeSet<&str> = acting.collect();
    assert!(acting.contains("robot1") && acting.len() > 1, "robots of both hosts act: {acting:?}");
    let out = finish(west, SOON);
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    assert_eq!(processes_of(&folder), []);
}

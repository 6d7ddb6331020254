//! Real processes: each child is this test executable again, told by an environment variable what to be.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

use lamma_bus::Bus;
use lamma_bus::iceoryx::{Endpoint, Run, Scope, sweep_stale};
use lamma_bus::process::{exit_when_stdin_closes, tie_to_parent};
use lamma_protocol::{AgentId, Node, Topic};
use rustix::process::{Pid, Signal, kill_process};

use super::*;

const ROLE: &str = "LAMMA_TEST_ROLE";
const FOLDER: &str = "LAMMA_TEST_FOLDER";
const SCOPE: &str = "LAMMA_TEST_SCOPE";
const NODE: &str = "LAMMA_TEST_NODE";
const HANG: Duration = Duration::from_secs(60);

/// What a child does; a no-op when this is run as a test.
#[test]
fn child() {
    let Ok(role) = std::env::var(ROLE) else { return };
    match role.as_str() {
        "fail" => std::process::exit(7),
        "hang" => std::thread::sleep(HANG),
        "orphan" => {
            exit_when_stdin_closes().unwrap();
            std::thread::sleep(HANG);
        }
        "member" => member(),
        "launcher" => launcher(),
        other => panic!("no role `{other}`"),
    }
}

/// A process of a run that says something and listens.
fn member() {
    exit_when_stdin_closes().unwrap();
    let scope: Scope = std::env::var(SCOPE).unwrap().parse().unwrap();
    let index: usize = std::env::var(NODE).unwrap().parse().unwrap();
    let mut bus = Endpoint::open(&scope, Topic::nodes(scope.agents())[index]).unwrap();
    std::fs::write(folder().join(format!("joined-{index}")), "").unwrap();
    loop {
        if bus.node() == Node::Simulator {
            bus.publish_frame(&lamma_protocol::frame::write_frame(&Default::default(), &[])).unwrap();
        }
        bus.receive(&mut |_| {});
        bus.wait(Some(Duration::from_millis(5))).unwrap();
    }
}

/// A whole run as the launcher does it, until it is told to end.
fn launcher() {
    let run_dir = RunDir::create(Some(&folder())).unwrap();
    let run = Run::create(2).unwrap();
    let bus = run.open(Node::Supervisor).unwrap();
    let (supervisor, events) = Supervisor::start(Some(bus.waker())).unwrap();
    let mut text = run.scope().to_string();
    for (index, node) in Topic::nodes(2).into_iter().enumerate().skip(1) {
        let mut spec = spec("member", &node.to_string(), &run_dir);
        spec.env.push((SCOPE.into(), run.scope().to_string().into()));
        spec.env.push((NODE.into(), index.to_string().into()));
        text += &format!(" {}", supervisor.spawn(spec).unwrap());
    }
    publish_file("ready", &text);
    run_until_interrupted(bus, &events);
    supervisor.end(Patience { ask: Duration::ZERO, term: Duration::from_secs(5) });
    let ended = events.try_iter().filter(|e| matches!(e, Event::Ended { .. })).count();
    run.end().unwrap();
    publish_file("ended", &ended.to_string());
}

/// What wakes the launcher is one bell for messages and events alike.
fn run_until_interrupted(mut bus: Endpoint, events: &Receiver<Event>) {
    loop {
        bus.receive(&mut |_| {});
        match events.try_iter().next() {
            Some(Event::Interrupted { .. }) => return,
            Some(Event::Ended { name, how, .. }) => {
                publish_file("lost", &format!("{name} {how}"));
            }
            None => {
                bus.wait(None).unwrap();
            }
        }
    }
}

fn folder() -> PathBuf {
    std::env::var_os(FOLDER).unwrap().into()
}

/// Writes a file that is there at once and whole.
fn publish_file(name: &str, text: &str) {
    let path = folder().join(name);
    std::fs::write(path.with_extension("part"), text).unwrap();
    std::fs::rename(path.with_extension("part"), path).unwrap();
}

fn spec(role: &str, name: &str, run: &RunDir) -> Spec {
    let args = ["--exact", "supervise::tests::child", "--nocapture", "--test-threads=1"];
    Spec {
        name: name.to_owned(),
        program: None,
        args: args.map(OsString::from).into(),
        env: vec![(ROLE.into(), role.into()), (FOLDER.into(), run.path().into())],
        log: log_file(run.path(), name),
        ties_itself: false,
    }
}

/// A folder of its own for each test, gone with it.
struct Folder(RunDir);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("lamma-{name}-{}", std::process::id()));
        Folder(RunDir::create(Some(&path)).unwrap())
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(self.0.path());
    }
}

fn eventually(what: &str, mut holds: impl FnMut() -> bool) {
    let end = Instant::now() + HANG;
    while !holds() {
        assert!(Instant::now() < end, "still not so: {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn await_file(path: &Path) -> String {
    eventually(&format!("{} exists", path.display()), || path.exists());
    std::fs::read_to_string(path).unwrap()
}

/// Whether the process runs: not when it is gone or only waits to be reaped.
fn alive(pid: i32) -> bool {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
    stat.rsplit_once(") ").is_some_and(|(_, rest)| !rest.starts_with('Z'))
}

fn leftovers(scope: &Scope) -> Vec<PathBuf> {
    let entries = ["/dev/shm", "/tmp"].iter().filter_map(|f| std::fs::read_dir(f).ok()).flatten().flatten();
    let ours = entries.filter(|e| e.file_name().to_string_lossy().contains(scope.tag()));
    ours.map(|e| e.path()).chain(Some(scope.root().to_owned()).filter(|r| r.exists())).collect()
}

fn signal(pid: i32, signal: Signal) {
    kill_process(Pid::from_raw(pid).unwrap(), signal).unwrap();
}

/// A launcher process with its four members, all of which have joined.
struct Launched {
    folder: Folder,
    process: std::process::Child,
    scope: Scope,
    members: Vec<i32>,
}

impl Launched {
    fn new(name: &str) -> Launched {
        let folder = Folder::new(name);
        let spec = spec("launcher", "launcher", &folder.0);
        let mut command = Command::new(std::env::current_exe().unwrap());
        command.args(spec.args).envs(spec.env).stdout(Stdio::null()).stderr(Stdio::null());
        let process = tie_to_parent(&mut command).spawn().unwrap();
        let text = await_file(&folder.0.path().join("ready"));
        let (scope, pids) = text.split_once(' ').unwrap();
        let members: Vec<i32> = pids.split(' ').map(|p| p.parse().unwrap()).collect();
        for index in 1..=members.len() {
            await_file(&folder.0.path().join(format!("joined-{index}")));
        }
        Launched { scope: scope.parse().unwrap(), folder, process, members }
    }

    fn pid(&self) -> i32 {
        self.process.id().cast_signed()
    }

    /// All members have ended and nothing of the run is left.
    fn assert_gone(&self) {
        eventually("all members have ended", || self.members.iter().all(|p| !alive(*p)));
        assert_eq!(leftovers(&self.scope), Vec::<PathBuf>::new());
    }
}

#[test]
fn the_owner_hears_how_each_child_ended() {
    let folder = Folder::new("endings");
    let (supervisor, events) = Supervisor::start(None).unwrap();
    let pid = supervisor.spawn(spec("fail", "a", &folder.0)).unwrap();
    let ended = Event::Ended { name: "a".into(), pid, how: Ending::Exited(7) };
    assert_eq!(events.recv_timeout(HANG).unwrap(), ended);

    let pid = supervisor.spawn(spec("hang", "a", &folder.0)).unwrap();
    let twice = supervisor.spawn(spec("hang", "a", &folder.0)).unwrap_err().to_string();
    assert!(twice.contains("runs already"), "{twice}");
    supervisor.signal("a", Signal::KILL).unwrap();
    let how = Ending::Killed(9);
    assert_eq!(how.to_string(), "was killed by SIGKILL");
    assert_eq!(events.recv_timeout(HANG).unwrap(), Event::Ended { name: "a".into(), pid, how });
    assert!(matches!(supervisor.signal("a", Signal::KILL), Err(SuperviseError::Unknown { .. })));

    let nowhere = Spec { program: Some("/nonexistent".into()), ..spec("fail", "b", &folder.0) };
    assert!(matches!(supervisor.spawn(nowhere), Err(SuperviseError::Spawn { .. })));
    supervisor.end(Patience::NONE);
}

#[test]
fn what_a_child_says_is_in_its_log() {
    let folder = Folder::new("log");
    let (supervisor, events) = Supervisor::start(None).unwrap();
    let sh = Spec {
        program: Some("/bin/sh".into()),
        args: ["-c", "echo out; echo err >&2"].map(OsString::from).into(),
        ..spec("", "sh", &folder.0)
    };
    for _ in 0..2 {
        supervisor.spawn(sh.clone()).unwrap();
        events.recv_timeout(HANG).unwrap();
    }
    assert_eq!(std::fs::read_to_string(log_file(folder.0.path(), "sh")).unwrap(), "out\nerr\nout\nerr\n");
}

#[test]
fn the_ladder_ends_the_deaf_and_the_stopped_with_all_they_started() {
    let folder = Folder::new("ladder");
    let (supervisor, events) = Supervisor::start(None).unwrap();
    let pids = folder.0.path().join("grandchild");
    let script = format!("trap '' TERM; sleep 1000 & echo $! > {}; wait; sleep 1000", pids.display());
    let deaf = Spec {
        program: Some("/bin/sh".into()),
        args: vec!["-c".into(), script.into()],
        ..spec("", "deaf", &folder.0)
    };
    supervisor.spawn(deaf).unwrap();
    supervisor.spawn(spec("hang", "stopped", &folder.0)).unwrap();
    supervisor.signal("stopped", Signal::STOP).unwrap();
    eventually("the grandchild runs", || std::fs::read_to_string(&pids).is_ok_and(|t| t.ends_with('\n')));
    let grandchild: i32 = std::fs::read_to_string(&pids).unwrap().trim().parse().unwrap();
    supervisor.end(Patience { ask: Duration::from_millis(10), term: Duration::from_millis(10) });
    let ended: Vec<_> = events.iter().collect();
    assert_eq!(ended.len(), 2, "{ended:?}");
    eventually("the grandchild has ended", || !alive(grandchild));
}

#[test]
fn a_polite_child_is_not_killed() {
    let folder = Folder::new("polite");
    let (supervisor, events) = Supervisor::start(None).unwrap();
    let quick = Spec { program: Some("/bin/true".into()), args: vec![], ..spec("", "quick", &folder.0) };
    let pid = supervisor.spawn(quick).unwrap();
    supervisor.end(Patience { ask: HANG, term: HANG });
    let how = Ending::Exited(0);
    assert_eq!(events.iter().collect::<Vec<_>>(), [Event::Ended { name: "quick".into(), pid, how }]);
}

#[test]
fn a_child_whose_launcher_is_gone_ends_by_its_stdin() {
    // Without the parent-death signal: this is what is left where that does not work.
    let mut command = Command::new(std::env::current_exe().unwrap());
    let folder = Folder::new("orphan");
    let spec = spec("orphan", "orphan", &folder.0);
    command.args(spec.args).envs(spec.env).stdin(Stdio::piped()).stdout(Stdio::null());
    let mut child = command.stderr(Stdio::null()).spawn().unwrap();
    drop(child.stdin.take());
    assert_eq!(child.wait().unwrap().code(), Some(30));
}

#[test]
fn a_dropped_supervisor_leaves_nobody() {
    let folder = Folder::new("dropped");
    let (supervisor, _events) = Supervisor::start(None).unwrap();
    let pid = supervisor.spawn(spec("hang", "a", &folder.0)).unwrap().cast_signed();
    assert!(alive(pid));
    drop(supervisor);
    assert!(!alive(pid));
}

#[test]
fn an_interrupted_run_ends_in_order_and_leaves_nothing() {
    for end in [Signal::INT, Signal::TERM, Signal::HUP] {
        let mut run = Launched::new("interrupted");
        signal(run.pid(), end);
        assert!(run.process.wait().unwrap().success(), "the launcher ends in order after {end:?}");
        let ended = std::fs::read_to_string(run.folder.0.path().join("ended")).unwrap();
        assert_eq!(ended, "4", "all members' ends were told");
        run.assert_gone();
    }
}

#[test]
fn a_run_with_a_killed_member_leaves_nothing() {
    let mut run = Launched::new("member-killed");
    signal(run.members[2], Signal::KILL);
    let lost = await_file(&run.folder.0.path().join("lost"));
    assert_eq!(lost, format!("{} was killed by SIGKILL", Node::Robot(AgentId(0))));
    signal(run.pid(), Signal::TERM);
    assert!(run.process.wait().unwrap().success());
    run.assert_gone();
}

#[test]
fn a_killed_launcher_leaves_no_process_and_what_it_leaves_is_swept() {
    let mut run = Launched::new("launcher-killed");
    let living = Launched::new("living");
    run.process.kill().unwrap();
    run.process.wait().unwrap();
    eventually("all members have ended", || run.members.iter().all(|p| !alive(*p)));
    // Another test process may sweep at the same time: what counts is that nothing is left in the end.
    let swept = sweep_stale().unwrap();
    assert!(!swept.iter().any(|tag| tag == living.scope.tag()), "a living run is not touched");
    eventually("nothing is left", || leftovers(&run.scope).is_empty());
    assert!(living.members.iter().all(|p| alive(*p)), "the other run goes on");
    let mut living = living;
    signal(living.pid(), Signal::TERM);
    assert!(living.process.wait().unwrap().success());
    living.assert_gone();
}

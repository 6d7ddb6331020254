//! The shared-memory transport between real processes: killed, stopped and orphaned ones, and what is
//! left behind. A child is this test executable again, told by an environment variable what to be.
#![expect(clippy::unwrap_used, reason = "a failure here is a failed test")]

use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::RecvTimeoutError;
use std::time::{Duration, Instant};

use lamma_bus::iceoryx::{Endpoint, OpenError, Run, Scope, sweep, sweep_stale};
use lamma_bus::process::tie_to_parent;
use lamma_bus::{Bus, Received};
use lamma_protocol::message::{Ack, Verdict};
use lamma_protocol::{
    AgentId, Envelope, Epoch, FrameHeader, Message, Node, Revision, StepIndex, Topic, frame,
};
use rustix::process::{Pid, Signal, kill_process};

const ROLE: &str = "LAMMA_TEST_ROLE";
const SCOPE: &str = "LAMMA_TEST_SCOPE";
const R0: AgentId = AgentId(0);
const PATIENCE: Duration = Duration::from_secs(60);

fn words(version: u64) -> Vec<u64> {
    frame::write_frame(&FrameHeader { version, facts: 1000, ..FrameHeader::default() }, &[7; 16])
}

fn ack(number: u64) -> Envelope {
    let verdict = Verdict::Applied { version: number };
    let message = Message::Ack(Ack { epoch: Epoch(1), step: StepIndex(0), verdict });
    Envelope { revision: Revision { incarnation: 0, number }, message }
}

/// Waits until `bus` has a frame of this version or a later one.
fn await_frame(bus: &mut Endpoint, version: u64) {
    let end = Instant::now() + PATIENCE;
    let mut newest = 0;
    while newest < version {
        assert!(Instant::now() < end, "frame {version} did not arrive, the newest is {newest}");
        bus.receive(&mut |r| {
            if let Received::Frame(frame) = r {
                newest = frame.version();
            }
        });
        bus.wait(Some(Duration::from_millis(20))).unwrap();
    }
}

/// What a child does; a no-op when this is run as a test.
#[test]
fn child() {
    let Ok(role) = std::env::var(ROLE) else { return };
    let scope = || std::env::var(SCOPE).unwrap().parse::<Scope>().unwrap();
    let ready = |text: &str| println!("\nready {text}");
    match role.as_str() {
        "reader" => {
            let mut bus = Endpoint::open(&scope(), Node::Robot(R0)).unwrap();
            await_frame(&mut bus, 1);
            ready("");
            loop {
                bus.receive(&mut |_| {});
                bus.wait(None).unwrap();
            }
        }
        "writer" => {
            let mut bus = Endpoint::open(&scope(), Node::Simulator).unwrap();
            for version in 1.. {
                bus.publish_frame(&words(version)).unwrap();
                if version == 5 {
                    ready("");
                }
                bus.wait(Some(Duration::from_millis(5))).unwrap();
            }
        }
        "owner" => {
            let run = Run::create(2).unwrap();
            let mut reader = spawn("reader", Some(run.scope()));
            let mut bus = run.open(Node::Simulator).unwrap();
            bus.publish_frame(&words(1)).unwrap();
            await_ready(&mut reader, || {
                bus.wait(Some(Duration::from_millis(5))).unwrap();
            });
            ready(&format!("{} {}", run.scope(), reader.id()));
            let _ = reader.wait();
        }
        other => panic!("no role `{other}`"),
    }
}

fn spawn(role: &str, scope: Option<&Scope>) -> Child {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--exact", "child", "--nocapture", "--test-threads=1"]).env(ROLE, role);
    command.env(SCOPE, scope.map(Scope::to_string).unwrap_or_default());
    // The test's own thread lives until the test ends, and the test kills its children anyway.
    tie_to_parent(&mut command).stdout(Stdio::piped()).spawn().unwrap()
}

/// Waits for the child to be ready and gives what it says. Publishers must live on `meanwhile`, so that
/// who joins is handed what they said.
fn await_ready(child: &mut Child, mut meanwhile: impl FnMut()) -> String {
    let lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let (tell, told) = std::sync::mpsc::channel();
    std::thread::spawn(move || lines.map_while(Result::ok).try_for_each(|line| tell.send(line)));
    loop {
        meanwhile();
        match told.recv_timeout(Duration::from_millis(1)) {
            Ok(line) => {
                if let Some(text) = line.strip_prefix("ready") {
                    return text.trim().to_owned();
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => panic!("the child has ended early"),
        }
    }
}

fn signal(pid: u32, signal: Signal) {
    kill_process(Pid::from_raw(pid.cast_signed()).unwrap(), signal).unwrap();
}

fn kill(mut child: Child) {
    child.kill().unwrap();
    child.wait().unwrap();
}

/// Everything on this host that carries the run's tag.
fn leftovers(scope: &Scope) -> Vec<PathBuf> {
    let folders = ["/dev/shm", "/tmp", "/tmp/iceoryx2", "/tmp/iceoryx2/nodes", "/tmp/iceoryx2/services"];
    let entries = folders.iter().filter_map(|f| std::fs::read_dir(f).ok()).flatten().flatten();
    let ours = entries.filter(|e| e.file_name().to_string_lossy().contains(scope.tag()));
    ours.map(|e| e.path()).chain(Some(scope.root().to_owned()).filter(|r| r.exists())).collect()
}

#[test]
fn nothing_is_left_after_a_run_in_order() {
    let run = Run::create(3).unwrap();
    let scope = run.scope().clone();
    assert!(!leftovers(&scope).is_empty(), "the search finds a living run");
    for node in Topic::nodes(3) {
        let mut end = run.open(node).unwrap();
        end.receive(&mut |_| {});
    }
    run.end().unwrap();
    assert_eq!(leftovers(&scope), Vec::<PathBuf>::new());
}

#[test]
fn an_endpoint_that_outlives_its_run_leaves_nothing() {
    let run = Run::create(2).unwrap();
    let scope = run.scope().clone();
    let mut simulator = run.open(Node::Simulator).unwrap();
    let mut robot = run.open(Node::Robot(R0)).unwrap();
    run.end().unwrap();
    simulator.publish_frame(&words(1)).unwrap();
    robot.receive(&mut |_| {});
    simulator.wait(Some(Duration::ZERO)).unwrap();
    drop((simulator, robot));
    assert_eq!(leftovers(&scope), Vec::<PathBuf>::new());
    let joined = Endpoint::open(&scope, Node::Simulator);
    assert!(matches!(joined, Err(OpenError::Ended { .. })), "an ended run cannot be joined");
    assert_eq!(leftovers(&scope), Vec::<PathBuf>::new());
}

#[test]
fn a_killed_reader_delays_nobody_and_its_successors_find_room() {
    let run = Run::create(2).unwrap();
    let scope = run.scope().clone();
    let mut simulator = run.open(Node::Simulator).unwrap();
    simulator.publish_frame(&words(1)).unwrap();
    // More often than there are spare ports, so that room must have been made.
    for _ in 0..12 {
        let mut reader = spawn("reader", Some(&scope));
        await_ready(&mut reader, || {
            simulator.wait(Some(Duration::from_millis(5))).unwrap();
        });
        kill(reader);
        for number in 1..=50 {
            simulator.publish_frame(&words(number)).unwrap();
            simulator.publish(Topic::Ack(R0), &ack(number)).unwrap();
        }
        run.bury_the_dead();
    }
    drop(simulator);
    run.end().unwrap();
    assert_eq!(leftovers(&scope), Vec::<PathBuf>::new());
}

#[test]
fn a_stopped_reader_delays_nobody_and_wakes_to_the_newest() {
    let run = Run::create(2).unwrap();
    let scope = run.scope().clone();
    let mut simulator = run.open(Node::Simulator).unwrap();
    simulator.publish_frame(&words(1)).unwrap();
    let mut reader = spawn("reader", Some(&scope));
    await_ready(&mut reader, || {
        simulator.wait(Some(Duration::from_millis(5))).unwrap();
    });
    signal(reader.id(), Signal::STOP);
    // A send that waits for the stopped reader would hang here for ever.
    for number in 1..=5_000 {
        simulator.publish_frame(&words(number)).unwrap();
        simulator.publish(Topic::Ack(R0), &ack(number)).unwrap();
    }
    signal(reader.id(), Signal::CONT);
    kill(reader);
    drop(simulator);
    run.end().unwrap();
    assert_eq!(leftovers(&scope), Vec::<PathBuf>::new());
}

#[test]
fn a_killed_publisher_is_followed_by_another() {
    let run = Run::create(2).unwrap();
    let scope = run.scope().clone();
    let mut robot = run.open(Node::Robot(R0)).unwrap();
    for _ in 0..12 {
        let mut writer = spawn("writer", Some(&scope));
        await_ready(&mut writer, || {});
        await_frame(&mut robot, 5);
        kill(writer);
        run.bury_the_dead();
        robot.receive(&mut |_| {});
    }
    drop(robot);
    run.end().unwrap();
    assert_eq!(leftovers(&scope), Vec::<PathBuf>::new());
}

#[test]
fn a_member_killed_at_any_moment_of_its_start_leaves_the_run_whole() {
    let run = Run::create(2).unwrap();
    let scope = run.scope().clone();
    let mut simulator = run.open(Node::Simulator).unwrap();
    for delay in 0..30 {
        let reader = spawn("reader", Some(&scope));
        // The sweep over moments is the point, not any one of them: starting takes about 20 ms.
        std::thread::sleep(Duration::from_micros(1_000 * delay));
        kill(reader);
        run.bury_the_dead();
        simulator.publish_frame(&words(delay + 1)).unwrap();
        simulator.wait(Some(Duration::ZERO)).unwrap();
    }
    let mut reader = spawn("reader", Some(&scope));
    await_ready(&mut reader, || {
        simulator.wait(Some(Duration::from_millis(5))).unwrap();
    });
    kill(reader);
    drop(simulator);
    run.end().unwrap();
    assert_eq!(leftovers(&scope), Vec::<PathBuf>::new());
}

#[test]
fn shared_memory_that_its_maker_left_without_a_size_is_removed_with_the_dead() {
    let run = Run::create(1).unwrap();
    let half_made = PathBuf::from(format!("/dev/shm/lamma-{}_half", run.scope().tag()));
    std::fs::write(&half_made, "").unwrap();
    run.bury_the_dead();
    assert!(!half_made.exists(), "who opens it would wait for ever");
    run.open(Node::Simulator).unwrap().publish_frame(&words(1)).unwrap();
}

#[test]
fn a_killed_owner_takes_its_children_along_and_only_its_run_is_swept() {
    let living = Run::create(1).unwrap();
    let mut owner = spawn("owner", None);
    let text = await_ready(&mut owner, || {});
    let (scope, reader) = text.split_once(' ').unwrap();
    let (scope, reader): (Scope, i32) = (scope.parse().unwrap(), reader.parse().unwrap());
    assert_ne!(scope.tag(), living.scope().tag());
    assert!(!sweep_stale().unwrap().iter().any(|t| t == scope.tag() || t == living.scope().tag()));
    kill(owner);
    let end = Instant::now() + PATIENCE;
    while alive(reader) {
        assert!(Instant::now() < end, "the child outlives its parent");
        std::thread::yield_now();
    }
    // Another test process may sweep at the same time: what counts is that nothing is left in the end.
    let swept = sweep_stale().unwrap();
    assert!(!swept.iter().any(|t| t == living.scope().tag()), "a living run is not touched");
    while !leftovers(&scope).is_empty() {
        assert!(Instant::now() < end, "left: {:?}", leftovers(&scope));
        std::thread::yield_now();
    }
    sweep(&scope).unwrap();
    let mut end = living.open(Node::Simulator).unwrap();
    end.publish_frame(&words(1)).unwrap();
}

/// Whether the process runs: not when it is gone or only waits to be reaped.
fn alive(pid: i32) -> bool {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
    stat.rsplit_once(") ").is_some_and(|(_, rest)| !rest.starts_with('Z'))
}

#[test]
fn a_frame_is_read_where_it_was_written() {
    let run = Run::create(1).unwrap();
    let (mut simulator, mut robot) = (run.open(Node::Simulator).unwrap(), run.open(Node::Robot(R0)).unwrap());
    simulator.publish_frame(&words(1)).unwrap();
    simulator.wait(Some(Duration::ZERO)).unwrap();
    let addresses = AtomicU64::new(0);
    let end = Instant::now() + PATIENCE;
    while addresses.load(Ordering::Relaxed) == 0 {
        assert!(Instant::now() < end, "no frame");
        robot.receive(&mut |r| {
            if let Received::Frame(frame) = r {
                addresses.store(frame.words().as_ptr() as u64, Ordering::Relaxed);
            }
        });
        robot.wait(Some(Duration::from_millis(5))).unwrap();
    }
    let address = addresses.load(Ordering::Relaxed);
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
    let holds = |line: &&str| {
        let (from, to) = line.split(' ').next().unwrap().split_once('-').unwrap();
        (u64::from_str_radix(from, 16).unwrap()..u64::from_str_radix(to, 16).unwrap()).contains(&address)
    };
    let map = maps.lines().find(holds).unwrap();
    assert!(map.contains("/dev/shm/") && map.contains(run.scope().tag()), "the words lie in {map}");
}

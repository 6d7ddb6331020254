//! What coordinator and simulator pay for a send while robots are stopped (SIGSTOP): no send may wait for one.
//!
//! `cargo run --release -p lamma-bus --example stopped_peers [robots] [sends]`
//!
//! For no, some and all robots stopped: the greatest time of any send, and how often the sender gave up its
//! processor of its own accord while sending, which is what waiting for anything looks like to the kernel.
//! (The greatest time also holds what the machine gave to other programs meanwhile.)
#![expect(clippy::unwrap_used, reason = "an example that fails says where")]

use std::io::BufRead;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use lamma_bus::Bus;
use lamma_bus::iceoryx::{Endpoint, Run, Scope};
use lamma_bus::process::{raise_open_files_limit, tie_to_parent};
use lamma_protocol::message::{Ack, Directive, Grant, Order, Verdict, Vocabulary};
use lamma_protocol::{
    AgentId, Envelope, Epoch, FrameHeader, Message, Node, Revision, StepIndex, Topic, frame,
};
use rustix::process::{Pid, Signal, kill_process};

fn main() {
    raise_open_files_limit().unwrap();
    let args: Vec<String> = std::env::args().collect();
    if args.get(1).is_some_and(|a| a == "robot") {
        return robot(&args[2].parse().unwrap(), args[3].parse().unwrap());
    }
    let robots = args.get(1).map_or(64, |n| n.parse().unwrap());
    let sends = args.get(2).map_or(20_000, |n| n.parse().unwrap());
    let run = Run::create(robots).unwrap();
    let mut children: Vec<Child> = (0..robots).map(|a| spawn(run.scope(), a)).collect();
    for child in &mut children {
        let mut line = String::new();
        std::io::BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut line).unwrap();
    }
    let mut coordinator = run.open(Node::Coordinator).unwrap();
    let mut simulator = run.open(Node::Simulator).unwrap();
    println!("{robots} robots, {sends} sends each time");
    println!("stopped   p50 us   p99 us   max us   over 1 ms   gave up the processor");
    for every in [0, 7, 2, 1] {
        let stopped: Vec<&Child> = children
            .iter()
            .enumerate()
            .filter(|(i, _)| every > 0 && i % every == 0)
            .map(|(_, c)| c)
            .collect();
        stopped.iter().for_each(|c| signal(c, Signal::STOP));
        measure(&mut coordinator, &mut simulator, robots, sends, stopped.len());
        stopped.iter().for_each(|c| signal(c, Signal::CONT));
    }
    for child in &mut children {
        drop(child.stdin.take());
        child.wait().unwrap();
    }
    drop((coordinator, simulator));
    run.end().unwrap();
}

/// Reads what comes, until the parent has gone.
fn robot(scope: &Scope, agent: u16) {
    let mut bus = Endpoint::open(scope, Node::Robot(AgentId(agent))).unwrap();
    let waker = bus.waker();
    let over = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(false));
    let told = std::sync::Arc::clone(&over);
    std::thread::spawn(move || {
        std::io::stdin().lines().for_each(drop);
        told.store(true, std::sync::atomic::Ordering::Release);
        waker.wake();
    });
    println!("ready");
    while !over.load(std::sync::atomic::Ordering::Acquire) {
        bus.receive(&mut |_| {});
        bus.wait(None).unwrap();
    }
}

fn spawn(scope: &Scope, agent: u16) -> Child {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["robot", &scope.to_string(), &agent.to_string()]);
    command.stdin(Stdio::piped()).stdout(Stdio::piped());
    tie_to_parent(&mut command).spawn().unwrap()
}

fn signal(child: &Child, signal: Signal) {
    kill_process(Pid::from_child(child), signal).unwrap();
}

/// How often this thread has given up its processor of its own accord.
fn waits() -> u64 {
    let text = std::fs::read_to_string("/proc/thread-self/status").unwrap();
    let line = text.lines().find_map(|l| l.strip_prefix("voluntary_ctxt_switches:")).unwrap();
    line.trim().parse().unwrap()
}

fn measure(coordinator: &mut Endpoint, simulator: &mut Endpoint, robots: u16, sends: u32, stopped: usize) {
    let directive = Message::Directive(Directive { epoch: Epoch(1), order: Order::Stand });
    let grant = Message::Grant(Grant { epoch: Epoch(1), lost: Vec::new() });
    let facts: Vec<String> = (0..1000).map(|i| format!("(at robot{i} place{i})")).collect();
    let vocabulary = Message::Vocabulary(Vocabulary { facts });
    let progress = vec![StepIndex(0); robots.into()];
    let mut times: Vec<Duration> = Vec::new();
    let before = waits();
    for n in 0..sends {
        let robot = AgentId(u16::try_from(n % u32::from(robots)).unwrap());
        let verdict = Verdict::Applied { version: n.into() };
        let ack = Message::Ack(Ack { epoch: Epoch(1), step: StepIndex(n), verdict });
        let envelope = |message: &Message| Envelope {
            revision: Revision { incarnation: 0, number: n.into() },
            message: message.clone(),
        };
        let header = FrameHeader {
            version: n.into(),
            facts: 1000,
            progress: progress.clone(),
            ..FrameHeader::default()
        };
        let words = frame::write_frame(&header, &[0; 16]);
        let message = match n % 4 {
            0 => envelope(&directive),
            1 => envelope(&ack),
            2 if n % 100 == 2 => envelope(&vocabulary),
            _ => envelope(&grant),
        };
        let start = Instant::now();
        match n % 4 {
            0 => coordinator.publish(Topic::Directive(robot), &message).unwrap(),
            1 => simulator.publish(Topic::Ack(robot), &message).unwrap(),
            2 if n % 100 == 2 => simulator.publish(Topic::Vocabulary, &message).unwrap(),
            2 => coordinator.publish(Topic::Grant, &message).unwrap(),
            _ => simulator.publish_frame(&words).unwrap(),
        }
        times.push(start.elapsed());
    }
    let waited = waits() - before;
    times.sort_unstable();
    let at = |permille: usize| times[(times.len() - 1) * permille / 1000].as_secs_f64() * 1e6;
    let late = times.iter().filter(|t| **t > Duration::from_millis(1)).count();
    println!(
        "{stopped:>7}  {:>7.1}  {:>7.1}  {:>7.1}   {late:>9}   {waited:>21}",
        at(500),
        at(990),
        at(1000)
    );
}

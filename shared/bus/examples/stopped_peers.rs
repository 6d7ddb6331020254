//! What coordinator and simulator pay for a send while robots are stopped (SIGSTOP): no send may wait for one.
//!
//! `cargo run --release -p lamma-bus --example stopped_peers [robots,robots] [sends] [iceoryx2|zenoh]`
//!
//! For no, some and all robots stopped: the greatest time of any send, how often the sender gave up its
//! processor of its own accord while sending, which is what waiting for anything looks like to the kernel, and how
//! long the slowest of the robots that were not stopped took to see the last frame. (The greatest time also holds
//! what the machine gave to other programs meanwhile, the robots that it woke among them. *Running* is the sender's
//! own processor time for its dearest send; `chrt -f 5` in front of the command keeps the others from the sender.)
#![expect(clippy::unwrap_used, reason = "an example that fails says where")]

mod common;

use std::process::Child;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use common::{Children, quantile, until_let_go};
use lamma_bus::iceoryx::{self, Run, Scope};
use lamma_bus::process::{raise_open_files_limit, thread_time};
#[cfg(feature = "zenoh")]
use lamma_bus::zenoh::{self, Join, Router};
use lamma_bus::{Bus, Received};
use lamma_protocol::message::{Ack, Directive, Grant, Order, Request, Verdict, Vocabulary};
use lamma_protocol::{
    AgentId, Envelope, Epoch, FrameHeader, Message, Node, Revision, StepIndex, Topic, frame,
};
use rustix::process::{Pid, Signal, kill_process};

fn main() {
    raise_open_files_limit().unwrap();
    let args: Vec<String> = std::env::args().collect();
    if args.get(1).is_some_and(|a| a == "robot") {
        let agent = args[4].parse().unwrap();
        return robot(open(&args[2], &args[3], Node::Robot(AgentId(agent))), AgentId(agent));
    }
    let sizes = args.get(1).map_or("64", String::as_str);
    let sends = args.get(2).map_or(20_000, |n| n.parse::<u32>().unwrap()).next_multiple_of(4);
    let bus = args.get(3).map_or("iceoryx2", String::as_str);
    println!(
        "bus       robots  stopped   p50 us   p99 us   max us  over 1 ms  running us  over 1 ms  gave way  last seen by ms"
    );
    for robots in sizes.split(',').map(|n| n.parse().unwrap()) {
        match bus {
            "iceoryx2" => {
                let run = Run::create(robots).unwrap();
                stop_some(bus, &run.scope().to_string(), robots, sends);
                run.end().unwrap();
            }
            #[cfg(feature = "zenoh")]
            _ => {
                let router = Router::local().unwrap();
                stop_some(bus, &format!("{robots}:{}", router.endpoint()), robots, sends);
            }
            #[cfg(not(feature = "zenoh"))]
            _ => panic!("this build has no Zenoh"),
        }
    }
}

/// The endpoint of a node, from the text that says where to join.
fn open(bus: &str, place: &str, node: Node) -> Box<dyn Bus> {
    match bus {
        "iceoryx2" => Box::new(iceoryx::Endpoint::open(&place.parse::<Scope>().unwrap(), node).unwrap()),
        #[cfg(feature = "zenoh")]
        _ => {
            let (agents, connect) = place.split_once(':').unwrap();
            let patience = Duration::from_secs(20);
            let (run, agents) = ("stopped".parse().unwrap(), agents.parse().unwrap());
            let join = Join { run, agents, connect: connect.into(), identity: None, patience };
            Box::new(zenoh::Endpoint::open(&join, node).unwrap())
        }
        #[cfg(not(feature = "zenoh"))]
        _ => panic!("this build has no Zenoh"),
    }
}

fn stop_some(bus: &str, place: &str, robots: u16, sends: u32) {
    let robot = |a: u16| vec!["robot".into(), bus.into(), place.into(), a.to_string()];
    let children = Children::start((0..robots).map(robot));
    let mut coordinator = open(bus, place, Node::Coordinator);
    let mut simulator = open(bus, place, Node::Simulator);
    let mut last = 0;
    for every in [0, 7, 2, 1] {
        let is_stopped = |agent: &usize| every > 0 && agent.is_multiple_of(every);
        let all = children.processes().enumerate();
        let stopped: Vec<&Child> = all.filter(|(i, _)| is_stopped(i)).map(|(_, c)| c).collect();
        stopped.iter().for_each(|c| signal(c, Signal::STOP));
        let mut sent = send(coordinator.as_mut(), simulator.as_mut(), robots, sends, last);
        last += u64::from(sends);
        let awake: Vec<usize> = (0..usize::from(robots)).filter(|i| !is_stopped(i)).collect();
        let seen = await_answers(simulator.as_mut(), &awake, last);
        stopped.iter().for_each(|c| signal(c, Signal::CONT));
        let late = |times: &[Duration]| times.iter().filter(|t| **t > Duration::from_millis(1)).count();
        println!(
            "{bus:8}  {robots:>6}  {:>7}  {:>7.1}  {:>7.1}  {:>7.1}  {:>9}  {:>10.1}  {:>9}  {:>8}  {:>15.1}",
            stopped.len(),
            quantile(&mut sent.times, 500),
            quantile(&mut sent.times, 990),
            quantile(&mut sent.times, 1000),
            late(&sent.times),
            quantile(&mut sent.running, 1000),
            late(&sent.running),
            sent.waits,
            seen.as_secs_f64() * 1e3
        );
    }
    drop((coordinator, simulator));
    children.end();
}

/// Reads what comes, and answers each frame with its version, until the parent lets it go.
fn robot(mut bus: Box<dyn Bus>, id: AgentId) {
    let waker = bus.waker();
    let over = Arc::new(AtomicBool::new(false));
    let told = Arc::clone(&over);
    std::thread::spawn(move || {
        until_let_go();
        told.store(true, Ordering::Release);
        waker.wake();
    });
    println!("ready");
    let mut answered = 0;
    while !over.load(Ordering::Acquire) {
        let mut seen = 0;
        bus.receive(&mut |r| {
            if let Received::Frame(frame) = r {
                seen = frame.version();
            }
        });
        if seen > answered {
            answered = seen;
            let act = lamma_protocol::message::Act::new("Move", ["r1"]);
            let (epoch, step) = (Epoch(1), StepIndex(0));
            let message = Message::Request(Request { epoch, step, act, gates: Vec::new() });
            let revision = Revision { incarnation: 0, number: seen };
            bus.publish(Topic::Request(id), &Envelope { revision, message }).unwrap();
        } else {
            bus.wait(None).unwrap();
        }
    }
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

struct Sent {
    times: Vec<Duration>,
    running: Vec<Duration>,
    waits: u64,
}

/// Says all kinds of things to all robots; frames have the versions after `last`.
fn send(coordinator: &mut dyn Bus, simulator: &mut dyn Bus, robots: u16, sends: u32, last: u64) -> Sent {
    let directive = Message::Directive(Directive { epoch: Epoch(1), order: Order::Stand });
    let grant = Message::Grant(Grant { epoch: Epoch(1), lost: Vec::new() });
    let facts: Vec<String> = (0..1000).map(|i| format!("(at robot{i} place{i})")).collect();
    let vocabulary = Message::Vocabulary(Vocabulary { facts });
    let progress = vec![StepIndex(0); robots.into()];
    let mut sent = Sent { times: Vec::new(), running: Vec::new(), waits: 0 };
    let before = waits();
    for n in 1..=sends {
        let robot = AgentId(u16::try_from(n % u32::from(robots)).unwrap());
        let number = last + u64::from(n);
        let verdict = Verdict::Applied { version: number };
        let ack = Message::Ack(Ack { epoch: Epoch(1), step: StepIndex(n), verdict });
        let envelope = |message: &Message| Envelope {
            revision: Revision { incarnation: 0, number },
            message: message.clone(),
        };
        let progress = progress.clone();
        let header = FrameHeader { version: number, facts: 1000, progress, ..FrameHeader::default() };
        let words = frame::write_frame(&header, &[0; 16]);
        let message = match n % 4 {
            1 => envelope(&directive),
            2 => envelope(&ack),
            3 if n % 100 == 3 => envelope(&vocabulary),
            _ => envelope(&grant),
        };
        let (start, ran) = (Instant::now(), thread_time());
        match n % 4 {
            1 => coordinator.publish(Topic::Directive(robot), &message).unwrap(),
            2 => simulator.publish(Topic::Ack(robot), &message).unwrap(),
            3 if n % 100 == 3 => simulator.publish(Topic::Vocabulary, &message).unwrap(),
            3 => coordinator.publish(Topic::Grant, &message).unwrap(),
            _ => simulator.publish_frame(&words).unwrap(),
        }
        sent.times.push(start.elapsed());
        sent.running.push(thread_time() - ran);
    }
    sent.waits = waits() - before;
    sent
}

/// How long it takes until all of these have answered the last frame.
fn await_answers(simulator: &mut dyn Bus, awake: &[usize], last: u64) -> Duration {
    let start = Instant::now();
    let mut left: std::collections::BTreeSet<usize> = awake.iter().copied().collect();
    while !left.is_empty() {
        assert!(start.elapsed() < Duration::from_secs(20), "not heard of: {left:?}");
        simulator.wait(Some(Duration::from_millis(20))).unwrap();
        simulator.receive(&mut |r| {
            if let Received::Message(Topic::Request(a), e) = r
                && e.revision.number >= last
            {
                left.remove(&a.index());
            }
        });
    }
    start.elapsed()
}

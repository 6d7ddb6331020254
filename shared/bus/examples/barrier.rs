//! How long it takes until all robots of a team have met, beside the bare transport.
//!
//! `cargo run --release -p lamma-bus --example barrier [sizes] [rounds]`, such as `2,16,64 400`
//!
//! - *ours*: a simulator publishes a frame; every robot, a process each, wakes, reads it in place and
//!   publishes a `Request`; the simulator sleeps on its bell until it has all of them.
//! - *raw events*: one iceoryx2 event service each way; the release wakes all listeners, every process
//!   answers with its own event id, and the coordinator sleeps until it has all of them.
//!
//! Both carry out the same cycle in the same processes. They take turns, so that a busy machine is equally
//! busy for both.
#![expect(clippy::unwrap_used, reason = "an example that fails says where")]

use std::collections::BTreeSet;
use std::io::BufRead;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use iceoryx2::port::listener::Listener;
use iceoryx2::port::notifier::Notifier;
use iceoryx2::prelude::*;
use lamma_bus::iceoryx::{Endpoint, Run, Scope};
use lamma_bus::process::{raise_open_files_limit, tie_to_parent};
use lamma_bus::{Bus, Received};
use lamma_protocol::message::{Act, Request};
use lamma_protocol::{
    AgentId, Envelope, Epoch, FrameHeader, Message, Node as Member, Revision, StepIndex, Topic, frame,
};

/// Cycles of one kind before the other has its turn.
const TURN: u64 = 10;

/// Facts of the world that is shown.
const FACTS: u32 = 1000;

fn main() {
    raise_open_files_limit().unwrap();
    let args: Vec<String> = std::env::args().collect();
    if args.get(1).is_some_and(|a| a == "robot") {
        return robot(&args[2].parse().unwrap(), args[3].parse().unwrap(), args[4].parse().unwrap());
    }
    let sizes = args.get(1).map_or("2,16,64", String::as_str);
    println!("robots  ours p50 us   (p99)   raw p50 us   (p99)  ratio p50  p99   us/robot");
    for agents in sizes.split(',').map(|n| n.parse().unwrap()) {
        let rounds = args.get(2).map_or(4000 / u64::from(agents), |r| r.parse().unwrap()).clamp(40, 2000);
        measure(agents, rounds);
    }
}

/// The bare transport of one process: what wakes it, and what it wakes.
struct Raw {
    bell: Listener<ipc::Service>,
    ring: Notifier<ipc::Service>,
    _node: Node<ipc::Service>,
}

impl Raw {
    /// `names`: of the service that it hears, and of the one that it rings.
    fn new(scope: &Scope, names: [&str; 2]) -> Raw {
        let mut config = Config::default();
        config.global.set_root_path(&Path::new(scope.root().to_str().unwrap().as_bytes()).unwrap());
        config.global.prefix = FileName::new(format!("lamma-{}_", scope.tag()).as_bytes()).unwrap();
        // As in our own transport: else a thousand processes take minutes to start.
        config.global.node.cleanup_dead_nodes_on_creation = false;
        config.global.node.cleanup_dead_nodes_on_destruction = false;
        config.global.service.cleanup_dead_nodes_on_open = false;
        let node = NodeBuilder::new().config(&config).create::<ipc::Service>().unwrap();
        let room = usize::from(scope.agents()) + 8;
        let service = |name: &str| {
            let name = ServiceName::new(&format!("raw-barrier/{name}")).unwrap();
            let builder = node.service_builder(&name).event();
            let builder = builder.max_listeners(room).max_notifiers(room).max_nodes(room);
            builder.event_id_max_value(room).open_or_create().unwrap()
        };
        let bell = service(names[0]).listener_builder().create().unwrap();
        let ring = service(names[1]).notifier_builder().create().unwrap();
        Raw { bell, ring, _node: node }
    }

    /// Sleeps until `count` different ids have rung.
    fn await_rings(&self, count: usize) {
        let mut rung = BTreeSet::new();
        while rung.len() < count {
            self.bell.blocking_wait(|event| _ = rung.insert(event.id.as_value())).unwrap();
        }
    }
}

fn request(round: u64) -> Envelope {
    let act = Act { action: "Move".into(), args: vec!["r1".into(), "w1".into(), "w2".into()] };
    let step = StepIndex(u32::try_from(round).unwrap());
    let request = Request { epoch: Epoch(1), step, act, gates: Vec::new() };
    Envelope { revision: Revision { incarnation: 0, number: round }, message: Message::Request(request) }
}

/// One robot: answers in the same turns.
fn robot(scope: &Scope, agent: u16, rounds: u64) {
    let id = AgentId(agent);
    let mut bus = Endpoint::open(scope, Member::Robot(id)).unwrap();
    let raw = Raw::new(scope, ["release", "arrive"]);
    println!("ready");
    for turn in 0..rounds.div_ceil(TURN) {
        for round in turn * TURN + 1..=(turn + 1) * TURN {
            let mut seen = 0;
            while seen < round {
                bus.receive(&mut |r| {
                    if let Received::Frame(frame) = r {
                        seen = frame.version();
                    }
                });
                if seen < round {
                    bus.wait(None).unwrap();
                }
            }
            bus.publish(Topic::Request(id), &request(round)).unwrap();
        }
        for _ in 0..TURN {
            raw.await_rings(1);
            raw.ring.notify_with_custom_event_id(EventId::new(agent.into())).unwrap();
        }
    }
    // Until the parent closes it: an early end would disturb the others' last rounds.
    std::io::stdin().lines().for_each(drop);
}

fn spawn(scope: &Scope, agent: u16, rounds: u64) -> Child {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["robot", &scope.to_string(), &agent.to_string(), &rounds.to_string()]);
    command.stdin(Stdio::piped()).stdout(Stdio::piped());
    tie_to_parent(&mut command).spawn().unwrap()
}

fn measure(agents: u16, rounds: u64) {
    let run = Run::create(agents).unwrap();
    let mut bus = run.open(Member::Simulator).unwrap();
    let raw = Raw::new(run.scope(), ["arrive", "release"]);
    let mut children: Vec<Child> = (0..agents).map(|a| spawn(run.scope(), a, rounds)).collect();
    for child in &mut children {
        let mut line = String::new();
        std::io::BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut line).unwrap();
        assert_eq!(line, "ready\n");
    }
    let bits = vec![0; FACTS.div_ceil(64) as usize];
    let progress = vec![StepIndex(0); agents.into()];
    let (mut ours, mut bare) = (Vec::new(), Vec::new());
    for turn in 0..rounds.div_ceil(TURN) {
        for round in turn * TURN + 1..=(turn + 1) * TURN {
            let start = Instant::now();
            let header = FrameHeader {
                version: round,
                facts: FACTS,
                progress: progress.clone(),
                ..FrameHeader::default()
            };
            bus.publish_frame(&frame::write_frame(&header, &bits)).unwrap();
            let mut there = vec![false; agents.into()];
            let mut left = agents;
            while left > 0 {
                let count = bus.receive(&mut |r| {
                    if let Received::Message(Topic::Request(a), e) = r
                        && e.revision.number == round
                        && !std::mem::replace(&mut there[a.index()], true)
                    {
                        left -= 1;
                    }
                });
                if left > 0 && count == 0 {
                    bus.wait(None).unwrap();
                }
            }
            ours.push(start.elapsed());
        }
        for _ in 0..TURN {
            let start = Instant::now();
            raw.ring.notify_with_custom_event_id(EventId::new(0)).unwrap();
            raw.await_rings(agents.into());
            bare.push(start.elapsed());
        }
    }
    for child in &mut children {
        drop(child.stdin.take());
    }
    children.iter_mut().for_each(|c| _ = c.wait().unwrap());
    drop((bus, raw));
    run.end().unwrap();
    report(agents, ours, bare);
}

fn report(agents: u16, mut ours: Vec<Duration>, mut bare: Vec<Duration>) {
    let at = |times: &mut Vec<Duration>, percent: usize| {
        times.sort_unstable();
        times[(times.len() - 1) * percent / 100].as_secs_f64() * 1e6
    };
    let (o50, o99) = (at(&mut ours, 50), at(&mut ours, 99));
    let (r50, r99) = (at(&mut bare, 50), at(&mut bare, 99));
    println!(
        "{agents:>6}  {o50:>11.1} {o99:>8.1}  {r50:>11.1} {r99:>8.1}  {:>9.2} {:>5.2}  {:>8.2}",
        o50 / r50,
        o99 / r99,
        o50 / f64::from(agents)
    );
}

//! How long it takes until all robots of a team have met, beside the bare transport.
//!
//! `cargo run --release -p lamma-bus --example barrier [sizes] [rounds]`, such as `2,16,64,256,1000`
//!
//! - *ours*: a simulator publishes a frame; every robot, a process each, wakes, reads it in place and
//!   publishes a `Request`; the simulator sleeps on its bell until it has all of them.
//! - *raw events*: one iceoryx2 event service each way; the release wakes all listeners, every process
//!   answers with its own event id, and the coordinator sleeps until it has all of them.
//!
//! Both carry out the same cycle in the same processes. They take turns, so that a busy machine is equally
//! busy for both.
#![expect(clippy::unwrap_used, reason = "an example that fails says where")]

mod common;

use std::time::Duration;

use common::{Children, RawEvents, quantile, raw_node, time, until_let_go};
use lamma_bus::iceoryx::{Endpoint, Run, Scope};
use lamma_bus::process::raise_open_files_limit;
use lamma_bus::{Bus, Received};
use lamma_protocol::message::{Act, Request};
use lamma_protocol::{
    AgentId, Envelope, Epoch, FrameHeader, Message, Node, Revision, StepIndex, Topic, frame,
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

fn request(round: u64) -> Envelope {
    let act = Act { action: "Move".into(), args: vec!["r1".into(), "w1".into(), "w2".into()] };
    let step = StepIndex(u32::try_from(round).unwrap());
    let request = Request { epoch: Epoch(1), step, act, gates: Vec::new() };
    Envelope { revision: Revision { incarnation: 0, number: round }, message: Message::Request(request) }
}

/// One robot: answers in the same turns.
fn robot(scope: &Scope, agent: u16, rounds: u64) {
    let id = AgentId(agent);
    let mut bus = Endpoint::open(scope, Node::Robot(id)).unwrap();
    let node = raw_node(scope);
    let raw = RawEvents::new(&node, ["release", "arrive"], scope.agents().into());
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
            raw.ring(agent.into());
        }
    }
    until_let_go();
}

fn measure(agents: u16, rounds: u64) {
    let run = Run::create(agents).unwrap();
    let mut bus = run.open(Node::Simulator).unwrap();
    let node = raw_node(run.scope());
    let raw = RawEvents::new(&node, ["arrive", "release"], agents.into());
    let place = run.scope().to_string();
    let robot = |a: u16| vec!["robot".into(), place.clone(), a.to_string(), rounds.to_string()];
    let children = Children::start((0..agents).map(robot));
    let (mut ours, mut bare) = (Vec::new(), Vec::new());
    for turn in 0..rounds.div_ceil(TURN) {
        for round in turn * TURN + 1..=(turn + 1) * TURN {
            time(&mut ours, || meet(&mut bus, agents, round));
        }
        for _ in 0..TURN {
            time(&mut bare, || {
                raw.ring(0);
                raw.await_rings(agents.into());
            });
        }
    }
    children.end();
    drop((bus, raw, node));
    run.end().unwrap();
    report(agents, &mut ours, &mut bare);
}

/// Shows all a frame, and sleeps until each has answered.
fn meet(bus: &mut Endpoint, agents: u16, round: u64) {
    let progress = vec![StepIndex(0); agents.into()];
    let header = FrameHeader { version: round, facts: FACTS, progress, ..FrameHeader::default() };
    bus.publish_frame(&frame::write_frame(&header, &[])).unwrap();
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
}

fn report(agents: u16, ours: &mut [Duration], bare: &mut [Duration]) {
    let (o50, o99) = (quantile(ours, 500), quantile(ours, 990));
    let (r50, r99) = (quantile(bare, 500), quantile(bare, 990));
    println!(
        "{agents:>6}  {o50:>11.1} {o99:>8.1}  {r50:>11.1} {r99:>8.1}  {:>9.2} {:>5.2}  {:>8.2}",
        o50 / r50,
        o99 / r99,
        o50 / f64::from(agents)
    );
}

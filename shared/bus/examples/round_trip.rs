//! How long a request and its acknowledgement take between two processes, beside the bare transport.
//!
//! `cargo run --release -p lamma-bus --example round_trip [rounds]`
//!
//! - *ours*: a robot publishes a `Request`, sleeps on its bell, and reads the `Ack` of a simulator that
//!   does the same.
//! - *raw data + event*: two iceoryx2 services of as many bytes each way, each send followed by a ring of
//!   the other's event service, whose listener sleeps.
//! - *raw event*: the two event services alone.
//!
//! The three take turns, so that a busy machine is equally busy for all.
#![expect(clippy::unwrap_used, reason = "an example that fails says where")]

mod common;

use common::{Children, RawEvents, quantile, raw_node, time};
use iceoryx2::port::publisher::Publisher;
use iceoryx2::port::subscriber::Subscriber;
use iceoryx2::prelude::*;
use lamma_bus::iceoryx::{Endpoint, Run, Scope};
use lamma_bus::{Bus, Received};
use lamma_protocol::message::{Ack, Act, Gate, Request, Verdict};
use lamma_protocol::{AgentId, Envelope, Epoch, Message, Node as Member, Revision, StepIndex, Topic, codec};

const R0: AgentId = AgentId(0);
/// Rounds of each kind before the next kind has its turn.
const TURN: usize = 200;

fn main() {
    let args: Vec<String> = std::env::args().collect();
    match args.get(1).map(String::as_str) {
        Some("peer") => peer(&args[2].parse().unwrap(), args[3].parse().unwrap()),
        rounds => measure(rounds.map_or(10_000, |r| r.parse().unwrap())),
    }
}

fn request(number: u64) -> Envelope {
    let act = Act { action: "PutObject".into(), args: vec!["Apple_1".into(), "Fridge_1".into()] };
    let gates = vec![Gate { agent: AgentId(1), done: StepIndex(3) }];
    let request = Request { epoch: Epoch(2), step: StepIndex(5), act, gates };
    Envelope { revision: Revision { incarnation: 0, number }, message: Message::Request(request) }
}

fn ack(number: u64) -> Envelope {
    let verdict = Verdict::Applied { version: number };
    let ack = Ack { epoch: Epoch(2), step: StepIndex(5), verdict };
    Envelope { revision: Revision { incarnation: 0, number }, message: Message::Ack(ack) }
}

/// Sleeps until a message of this number has come.
fn await_message(bus: &mut Endpoint, number: u64) {
    loop {
        let mut came = false;
        bus.receive(&mut |r| {
            came |= matches!(r, Received::Message(_, e) if e.revision.number == number);
        });
        if came {
            return;
        }
        bus.wait(None).unwrap();
    }
}

/// One side of the bare transport.
struct Raw {
    out: Publisher<ipc::Service, [u8], ()>,
    back: Subscriber<ipc::Service, [u8], ()>,
    events: RawEvents,
    _node: Node<ipc::Service>,
}

impl Raw {
    /// `names`: of what it hears, and of what it says.
    fn new(scope: &Scope, names: [&str; 2]) -> Raw {
        let node = raw_node(scope);
        let data = |name: &str| {
            let name = ServiceName::new(&format!("raw/{name}")).unwrap();
            node.service_builder(&name).publish_subscribe::<[u8]>().open_or_create().unwrap()
        };
        let back = data(names[0]).subscriber_builder().create().unwrap();
        let out = data(names[1]).publisher_builder().initial_max_slice_len(1024).create().unwrap();
        Raw { out, back, events: RawEvents::new(&node, names, 1), _node: node }
    }

    fn send(&self, bytes: &[u8]) {
        self.out.loan_slice_uninit(bytes.len()).unwrap().write_from_slice(bytes).send().unwrap();
        self.events.ring(0);
    }

    /// One ring for each sample: a ring left over would be taken for an answer later.
    fn await_data(&self) {
        self.events.await_rings(1);
        assert!(self.back.receive().unwrap().is_some(), "a ring comes after its sample");
    }
}

/// The other process: answers in the same turns.
fn peer(scope: &Scope, rounds: usize) {
    let mut bus = Endpoint::open(scope, Member::Simulator).unwrap();
    let raw = Raw::new(scope, ["out", "back"]);
    let ack_bytes = codec::encode(&ack(1)).unwrap();
    println!("ready");
    let mut number = 0;
    for _ in 0..rounds.div_ceil(TURN) {
        for _ in 0..TURN {
            number += 1;
            await_message(&mut bus, number);
            bus.publish(Topic::Ack(R0), &ack(number)).unwrap();
        }
        for _ in 0..TURN {
            raw.await_data();
            raw.send(&ack_bytes);
        }
        for _ in 0..TURN {
            raw.events.await_rings(1);
            raw.events.ring(0);
        }
    }
}

fn measure(rounds: usize) {
    let run = Run::create(1).unwrap();
    let mut bus = run.open(Member::Robot(R0)).unwrap();
    let raw = Raw::new(run.scope(), ["back", "out"]);
    let children = Children::start([vec!["peer".into(), run.scope().to_string(), rounds.to_string()]]);

    let bytes = codec::encode(&request(1)).unwrap();
    let mut number = 0;
    let mut kinds = [("ours: request, ack", vec![]), ("raw data + event", vec![]), ("raw event", vec![])];
    for _ in 0..rounds.div_ceil(TURN) {
        for _ in 0..TURN {
            number += 1;
            time(&mut kinds[0].1, || {
                bus.publish(Topic::Request(R0), &request(number)).unwrap();
                await_message(&mut bus, number);
            });
        }
        for _ in 0..TURN {
            time(&mut kinds[1].1, || {
                raw.send(&bytes);
                raw.await_data();
            });
        }
        for _ in 0..TURN {
            time(&mut kinds[2].1, || {
                raw.events.ring(0);
                raw.events.await_rings(1);
            });
        }
    }
    children.end();
    drop((bus, raw));
    run.end().unwrap();

    println!(
        "{rounds} rounds each, {} bytes out, {} back",
        bytes.len(),
        codec::encode(&ack(1)).unwrap().len()
    );
    let base = quantile(&mut kinds[1].1, 500);
    for (name, times) in &mut kinds {
        let (p50, p99) = (quantile(times, 500), quantile(times, 990));
        println!("{name:20} p50 {p50:7.1} us   p99 {p99:7.1} us   {:.2} x raw data + event", p50 / base);
    }
}

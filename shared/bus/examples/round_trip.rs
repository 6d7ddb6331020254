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

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use iceoryx2::port::listener::Listener;
use iceoryx2::port::notifier::Notifier;
use iceoryx2::port::publisher::Publisher;
use iceoryx2::port::subscriber::Subscriber;
use iceoryx2::prelude::*;
use lamma_bus::iceoryx::{Endpoint, Run, Scope};
use lamma_bus::process::tie_to_parent;
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
    ring: Notifier<ipc::Service>,
    bell: Listener<ipc::Service>,
    _node: Node<ipc::Service>,
}

impl Raw {
    fn new(scope: &Scope, names: [&str; 2]) -> Raw {
        let mut config = Config::default();
        config.global.set_root_path(&Path::new(scope.root().to_str().unwrap().as_bytes()).unwrap());
        config.global.prefix = FileName::new(format!("lamma-{}_", scope.tag()).as_bytes()).unwrap();
        let node = NodeBuilder::new().config(&config).create::<ipc::Service>().unwrap();
        let data = |name: &str| {
            let name = ServiceName::new(&format!("raw/{name}")).unwrap();
            node.service_builder(&name).publish_subscribe::<[u8]>().open_or_create().unwrap()
        };
        let event = |name: &str| {
            let name = ServiceName::new(&format!("raw-bell/{name}")).unwrap();
            node.service_builder(&name).event().open_or_create().unwrap()
        };
        let out = data(names[0]).publisher_builder().initial_max_slice_len(1024).create().unwrap();
        let back = data(names[1]).subscriber_builder().create().unwrap();
        let ring = event(names[0]).notifier_builder().create().unwrap();
        let bell = event(names[1]).listener_builder().create().unwrap();
        Raw { out, back, ring, bell, _node: node }
    }

    fn send(&self, bytes: &[u8]) {
        self.out.loan_slice_uninit(bytes.len()).unwrap().write_from_slice(bytes).send().unwrap();
        self.ring.notify().unwrap();
    }

    /// One ring for each sample: a ring left over would be taken for an answer later.
    fn await_data(&self) {
        self.await_ring();
        assert!(self.back.receive().unwrap().is_some(), "a ring comes after its sample");
    }

    fn await_ring(&self) {
        let mut rung = 0;
        while rung == 0 {
            rung = self.bell.blocking_wait(|_| {}).unwrap();
        }
    }
}

/// The other process: answers in the same turns.
fn peer(scope: &Scope, rounds: usize) {
    let mut bus = Endpoint::open(scope, Member::Simulator).unwrap();
    let raw = Raw::new(scope, ["back", "out"]);
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
            raw.await_ring();
            raw.ring.notify().unwrap();
        }
    }
}

fn measure(rounds: usize) {
    let run = Run::create(1).unwrap();
    let mut bus = run.open(Member::Robot(R0)).unwrap();
    let raw = Raw::new(run.scope(), ["out", "back"]);
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["peer", &run.scope().to_string(), &rounds.to_string()]).stdout(Stdio::piped());
    let mut child = tie_to_parent(&mut command).spawn().unwrap();
    let mut line = String::new();
    let mut stdout = std::io::BufReader::new(child.stdout.take().unwrap());
    std::io::BufRead::read_line(&mut stdout, &mut line).unwrap();

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
                raw.ring.notify().unwrap();
                raw.await_ring();
            });
        }
    }
    child.wait().unwrap();
    drop((bus, raw));
    run.end().unwrap();

    println!(
        "{rounds} rounds each, {} bytes out, {} back",
        bytes.len(),
        codec::encode(&ack(1)).unwrap().len()
    );
    for (_, times) in &mut kinds {
        times.sort_unstable();
    }
    let at =
        |times: &[Duration], percent: usize| times[(times.len() - 1) * percent / 100].as_secs_f64() * 1e6;
    let base = at(&kinds[1].1, 50);
    for (name, times) in &kinds {
        let (p50, p99) = (at(times, 50), at(times, 99));
        println!("{name:20} p50 {p50:7.1} us   p99 {p99:7.1} us   {:.2} x raw data + event", p50 / base);
    }
}

fn time(times: &mut Vec<Duration>, round: impl FnOnce()) {
    let start = Instant::now();
    round();
    times.push(start.elapsed());
}

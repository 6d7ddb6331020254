//! What the Zenoh transport costs beside bare Zenoh, in one run, as ratios.
//!
//! `cargo run --release -p lamma-bus --example zenoh_beside_raw [rounds [N,N,...]]`
//!
//! - *request, ack*: a robot publishes a `Request` and sleeps until the simulator's `Ack` has come; bare, two keys
//!   with as many bytes each way, a subscription with a callback that wakes the sleeper.
//! - *barrier over N*: the simulator publishes a frame, each of N robots answers with its `Request`, the simulator
//!   sleeps until all have come; bare, one key that all subscribe to, and one key for each to answer on. Bare
//!   Zenoh uses its blocking congestion control here: with the dropping one a barrier over 64 loses a message.
//!
//! All are clients of one router in this process, over the same kind of link; the other ends are in one other
//! process, each with a session and a thread of its own. The kinds take turns, so that a busy machine is equally
//! busy for all.
#![expect(clippy::unwrap_used, reason = "an example that fails says where")]

mod common;

use std::collections::BTreeSet;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use common::{Children, quantile, time};
use lamma_bus::process::raise_open_files_limit;
use lamma_bus::zenoh::{Endpoint, Join, Router};
use lamma_bus::{Bus, Received};
use lamma_protocol::message::{Ack, Act, Gate, Request, Verdict};
use lamma_protocol::{
    AgentId, Envelope, Epoch, FrameHeader, Message, Node, Revision, StepIndex, Topic, codec, frame,
};
use zenoh::bytes::ZBytes;
use zenoh::pubsub::{Publisher, Subscriber};
use zenoh::qos::CongestionControl;
use zenoh::{Session, Wait};

/// Rounds of each kind before the next kind has its turn.
const TURN: u64 = 50;
/// Longer than any round; a lost message fails the run instead of hanging it.
const PATIENCE: Duration = Duration::from_secs(20);

fn main() {
    let args: Vec<String> = std::env::args().collect();
    raise_open_files_limit().unwrap();
    match args.get(1).map(String::as_str) {
        Some("peer") => peer(&args[2], args[3].parse().unwrap(), args[4].parse().unwrap()),
        rounds => {
            let rounds = rounds.map_or(2_000, |r| r.parse().unwrap());
            let sizes = args.get(2).map_or("2,16,64", String::as_str);
            measure(rounds, 0);
            sizes.split(',').for_each(|n| measure(rounds / 4, n.parse().unwrap()));
        }
    }
}

fn request(agent: u16, number: u64) -> Envelope {
    let act = Act { action: "PutObject".into(), args: vec!["Apple_1".into(), "Fridge_1".into()] };
    let gates = vec![Gate { agent: AgentId(agent), done: StepIndex(3) }];
    let request = Request { epoch: Epoch(2), step: StepIndex(5), act, gates };
    Envelope { revision: Revision { incarnation: 0, number }, message: Message::Request(request) }
}

fn ack(number: u64) -> Envelope {
    let verdict = Verdict::Applied { version: number };
    let ack = Ack { epoch: Epoch(2), step: StepIndex(5), verdict };
    Envelope { revision: Revision { incarnation: 0, number }, message: Message::Ack(ack) }
}

fn words(version: u64) -> Vec<u64> {
    frame::write_frame(&FrameHeader { version, facts: 1000, ..FrameHeader::default() }, &[7; 16])
}

fn join(router: &str, agents: u16) -> Join {
    let run = "beside-raw".parse().unwrap();
    Join { run, agents, connect: router.into(), identity: None, patience: PATIENCE }
}

/// Sleeps until `wanted` holds of what has come.
fn await_all(bus: &mut Endpoint, mut wanted: impl FnMut(Received<'_>), mut done: impl FnMut() -> bool) {
    let end = Instant::now() + PATIENCE;
    loop {
        bus.receive(&mut wanted);
        if done() {
            return;
        }
        assert!(Instant::now() < end, "something was lost");
        bus.wait(Some(PATIENCE)).unwrap();
    }
}

fn await_number(bus: &mut Endpoint, number: u64) {
    let came = std::cell::Cell::new(false);
    let look = |r: Received<'_>| match r {
        Received::Message(_, e) if e.revision.number == number => came.set(true),
        Received::Frame(f) if f.version() == number => came.set(true),
        _ => {}
    };
    await_all(bus, look, || came.get());
}

/// One session of bare Zenoh: a key to speak on, and an ear that wakes who sleeps on it.
struct Raw {
    out: Publisher<'static>,
    ear: Receiver<ZBytes>,
    _subscriber: Subscriber<()>,
    _session: Session,
}

impl Raw {
    fn new(router: &str, out: String, hear: String) -> Raw {
        let mut config = zenoh::Config::default();
        for (key, value) in [
            ("mode", "\"client\"".to_owned()),
            ("connect/endpoints", format!("[\"{router}\"]")),
            ("scouting/multicast/enabled", "false".to_owned()),
            ("scouting/gossip/enabled", "false".to_owned()),
        ] {
            config.insert_json5(key, &value).unwrap();
        }
        let session = zenoh::open(config).wait().unwrap();
        let (tell, ear) = channel();
        let heard = move |sample: zenoh::sample::Sample| drop(tell.send(sample.payload().clone()));
        let subscriber = session.declare_subscriber(hear).callback(heard).wait().unwrap();
        let out = session.declare_publisher(out).congestion_control(CongestionControl::Block).express(true);
        Raw { out: out.wait().unwrap(), ear, _subscriber: subscriber, _session: session }
    }

    fn say(&self, bytes: &[u8]) {
        self.out.put(bytes).wait().unwrap();
    }

    fn hear(&self) {
        self.ear.recv_timeout(PATIENCE).expect("something was lost");
    }
}

/// The other process. Without agents: a simulator that acknowledges. With: that many robots at a barrier.
fn peer(router: &str, agents: u16, rounds: u64) {
    if agents == 0 {
        let mut bus = Endpoint::open(&join(router, 1), Node::Simulator).unwrap();
        let raw = Raw::new(router, "raw/back".into(), "raw/out".into());
        let bytes = codec::encode(&ack(1)).unwrap();
        println!("ready");
        for turn in 0..rounds / TURN {
            for number in turn * TURN + 1..=(turn + 1) * TURN {
                await_number(&mut bus, number);
                bus.publish(Topic::Ack(AgentId(0)), &ack(number)).unwrap();
            }
            for _ in 0..TURN {
                raw.hear();
                raw.say(&bytes);
            }
        }
        // What was lost is said again by who waits.
        bus.wait(Some(Duration::from_millis(300))).unwrap();
        return;
    }
    let (tell, told) = channel();
    std::thread::scope(|scope| {
        for agent in 0..agents {
            let tell = tell.clone();
            scope.spawn(move || {
                let mut bus = Endpoint::open(&join(router, agents), Node::Robot(AgentId(agent))).unwrap();
                let raw = Raw::new(router, format!("raw/arrive/{agent}"), "raw/release".into());
                let bytes = codec::encode(&request(agent, 1)).unwrap();
                tell.send(()).unwrap();
                for turn in 0..rounds / TURN {
                    for number in turn * TURN + 1..=(turn + 1) * TURN {
                        await_number(&mut bus, number);
                        bus.publish(Topic::Request(AgentId(agent)), &request(agent, number)).unwrap();
                    }
                    for _ in 0..TURN {
                        raw.hear();
                        raw.say(&bytes);
                    }
                }
                // What was lost is said again by who waits.
                bus.wait(Some(Duration::from_millis(300))).unwrap();
            });
        }
        (0..agents).for_each(|_| told.recv_timeout(PATIENCE).unwrap());
        println!("ready");
    });
}

fn measure(rounds: u64, agents: u16) {
    let rounds = rounds.div_ceil(TURN) * TURN;
    let router = Router::local().unwrap();
    let at = router.endpoint();
    let children = Children::start([vec!["peer".into(), at.clone(), agents.to_string(), rounds.to_string()]]);
    let (node, out, back) = match agents {
        0 => (Node::Robot(AgentId(0)), "raw/out", "raw/back"),
        _ => (Node::Simulator, "raw/release", "raw/arrive/*"),
    };
    let mut bus = Endpoint::open(&join(&at, agents.max(1)), node).unwrap();
    let raw = Raw::new(&at, out.into(), back.into());
    // A declared publisher learns of subscriptions in its own time.
    std::thread::sleep(Duration::from_millis(500));

    let bytes = match agents {
        0 => codec::encode(&request(1, 1)).unwrap(),
        _ => words(1).iter().flat_map(|w| w.to_le_bytes()).collect(),
    };
    let (mut ours, mut bare) = (Vec::new(), Vec::new());
    for turn in 0..rounds / TURN {
        for number in turn * TURN + 1..=(turn + 1) * TURN {
            time(&mut ours, || match agents {
                0 => {
                    bus.publish(Topic::Request(AgentId(0)), &request(1, number)).unwrap();
                    await_number(&mut bus, number);
                }
                _ => {
                    bus.publish_frame(&words(number)).unwrap();
                    let missing: std::cell::RefCell<BTreeSet<u16>> =
                        (0..agents).collect::<BTreeSet<_>>().into();
                    let look = |r: Received<'_>| {
                        if let Received::Message(Topic::Request(a), e) = r
                            && e.revision.number == number
                        {
                            missing.borrow_mut().remove(&a.0);
                        }
                    };
                    await_all(&mut bus, look, || missing.borrow().is_empty());
                }
            });
        }
        for _ in 0..TURN {
            time(&mut bare, || {
                raw.say(&bytes);
                (0..agents.max(1)).for_each(|_| raw.hear());
            });
        }
    }
    children.end();
    let (o50, o99) = (quantile(&mut ours, 500), quantile(&mut ours, 990));
    let (r50, r99) = (quantile(&mut bare, 500), quantile(&mut bare, 990));
    let what = if agents == 0 { "request, ack".to_owned() } else { format!("barrier over {agents}") };
    println!(
        "{what:18} ours p50 {o50:9.1} us p99 {o99:9.1} us   bare p50 {r50:9.1} us p99 {r99:9.1} us   \
         ratio p50 {:.2} p99 {:.2}",
        o50 / r50,
        o99 / r99
    );
}

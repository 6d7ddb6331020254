//! Two hosts, each with a bus of its own, and a bridge between them over a wire that loses every fifth parcel.
#![expect(clippy::unwrap_used, reason = "a failure here is a failed test")]

use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use lamma_bus::bridge::{Away, Bridge};
use lamma_bus::driver::Stop;
use lamma_bus::inproc::{Hub, Inproc};
use lamma_bus::{Bus, Received};
use lamma_protocol::message::{Act, Command, Request};
use lamma_protocol::{
    AgentId, Envelope, Epoch, FrameHeader, Message, Node, Revision, StepIndex, Topic, frame,
};

const PATIENCE: Duration = Duration::from_secs(60);

fn robots(from: u16, to: u16) -> Vec<Node> {
    (from..to).map(|a| Node::Robot(AgentId(a))).collect()
}

fn words(version: u64) -> Vec<u64> {
    frame::write_frame(&FrameHeader { version, facts: 64, ..FrameHeader::default() }, &[version])
}

fn request(agent: u16, number: u64) -> (Topic, Envelope) {
    let act = Act { action: "Wait".into(), args: vec![] };
    let message = Message::Request(Request { epoch: Epoch(1), step: StepIndex(0), act, gates: vec![] });
    (Topic::Request(AgentId(agent)), Envelope { revision: Revision { incarnation: 0, number }, message })
}

/// Runs `test` while the bridges of both hosts work. Every `nth` parcel is lost.
fn with_bridges(agents: u16, nth: u64, test: impl FnOnce(&Hub, &Hub, [&Bridge; 2])) {
    let (near, far) = (Hub::new(agents), Hub::new(agents));
    // One each: a bridge ends by itself when it has carried the supervisor's last word, the other when it has said it.
    let stops = [Stop::default(), Stop::default()];
    let authorities = vec![Node::Supervisor, Node::Coordinator, Node::Simulator];
    let at_near = Bridge::new(Away::from([("far".into(), robots(0, agents))]), 1, stops[0].clone());
    let at_far = Bridge::new(Away::from([("near".into(), authorities)]), 2, stops[1].clone());
    let count = AtomicU64::new(1);
    std::thread::scope(|scope| {
        for (from, to, name, hub) in [(&at_near, &at_far, "near", &near), (&at_far, &at_near, "far", &far)] {
            let count = &count;
            scope.spawn(move || {
                let open = |node| hub.open(node).ok_or("no such node".to_owned());
                let send = |_: &str, bytes: Vec<u8>| {
                    if count.fetch_add(1, Ordering::Relaxed) % nth != 0 {
                        to.receive(name, &bytes);
                    }
                };
                from.run(open, send).unwrap();
            });
        }
        let bridges: [&Arc<Bridge>; 2] = [&at_near, &at_far];
        test(&near, &far, bridges.map(|b| &**b));
        stops.iter().for_each(Stop::stop);
    });
}

fn until(bus: &mut Inproc, mut seen: impl FnMut(&Received<'_>) -> bool) {
    let end = Instant::now() + PATIENCE;
    let mut done = false;
    while !done {
        assert!(Instant::now() < end, "{} has waited in vain", bus.node());
        bus.receive(&mut |r| done |= seen(&r));
        if !done {
            bus.wait(Some(Duration::from_millis(50))).unwrap();
        }
    }
}

#[test]
fn what_is_said_on_one_host_is_heard_on_the_other() {
    with_bridges(3, 5, |near, far, _| {
        let (mut simulator, mut supervisor) =
            (near.open(Node::Simulator).unwrap(), near.open(Node::Supervisor).unwrap());
        let mut robots: Vec<Inproc> = robots(0, 3).into_iter().map(|n| far.open(n).unwrap()).collect();
        for number in 1..=30 {
            simulator.publish_frame(&words(number)).unwrap();
            for (agent, robot) in (0..).zip(&mut robots) {
                until(robot, |r| matches!(r, Received::Frame(f) if f.version() == number));
                let (topic, envelope) = request(agent, number);
                robot.publish(topic, &envelope).unwrap();
            }
            let mut missing: BTreeSet<AgentId> = (0..3).map(AgentId).collect();
            until(&mut simulator, |r| {
                if let Received::Message(Topic::Request(a), e) = r
                    && e.revision.number == number
                {
                    missing.remove(a);
                }
                missing.is_empty()
            });
        }
        let revision = Revision { incarnation: 0, number: 1 };
        let message = Message::Command(Command { lost: vec![], stop: true });
        supervisor.publish(Topic::Command, &Envelope { revision, message }).unwrap();
        for robot in &mut robots {
            until(robot, |r| matches!(r, Received::Message(Topic::Command, _)));
        }
    });
}

/// Must show: a barrier across hosts costs one message per host, or two, whatever the number of robots there.
#[test]
fn a_barrier_over_many_robots_costs_a_few_parcels() {
    const AGENTS: u16 = 64;
    const ROUNDS: u64 = 10;
    with_bridges(AGENTS, u64::MAX, |near, far, bridges| {
        let mut simulator = near.open(Node::Simulator).unwrap();
        let mut ends: Vec<Inproc> = robots(0, AGENTS).into_iter().map(|n| far.open(n).unwrap()).collect();
        let before = bridges.map(Bridge::sent);
        for number in 1..=ROUNDS {
            simulator.publish_frame(&words(number)).unwrap();
            for (agent, robot) in (0..).zip(&mut ends) {
                until(robot, |r| matches!(r, Received::Frame(f) if f.version() == number));
                let (topic, envelope) = request(agent, number);
                robot.publish(topic, &envelope).unwrap();
            }
            let mut missing: BTreeSet<AgentId> = (0..AGENTS).map(AgentId).collect();
            until(&mut simulator, |r| {
                if let Received::Message(Topic::Request(a), e) = r
                    && e.revision.number == number
                {
                    missing.remove(a);
                }
                missing.is_empty()
            });
        }
        let [down, up] = [0, 1].map(|i| bridges[i].sent() - before[i]);
        println!("{AGENTS} robots, {ROUNDS} rounds: {down} parcels there, {up} back");
        // Messages one by one would be 640 each way. On a busy machine robots answer late, and their answers
        // go in parcels of their own.
        assert!(down + up < ROUNDS * u64::from(AGENTS), "{down} there, {up} back");
    });
}

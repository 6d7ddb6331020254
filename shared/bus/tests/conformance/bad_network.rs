//! What levels are for: through a network that loses, repeats, delays, reorders and corrupts, who keeps saying
//! what holds and keeps the greatest revision agrees in the end.
#![expect(clippy::unwrap_used, reason = "a failure here is a failed test")]

use std::time::{Duration, Instant};

use lamma_bus::faulty::{FaultyBus, Plan};
use lamma_bus::{Bus, Received};
use lamma_protocol::message::Grant;
use lamma_protocol::{Envelope, Epoch, Message, Node, Revision, Topic};

use super::Fixture;

const PATIENCE: Duration = Duration::from_secs(60);
const LAST: u64 = 60;

/// Says epoch `epoch`, with the revision that counts all that was said.
fn say<B: Bus>(coordinator: &mut B, said: &mut u64, epoch: u64) {
    *said += 1;
    let revision = Revision { incarnation: 0, number: *said };
    let message = Message::Grant(Grant { epoch: Epoch(epoch), lost: vec![] });
    coordinator.publish(Topic::Grant, &Envelope { revision, message }).unwrap();
}

/// Takes what has come, and keeps the greatest revision.
fn hear<B: Bus>(simulator: &mut B, newest: &mut Option<(Revision, Epoch)>) {
    simulator.receive(&mut |received| {
        if let Received::Message(Topic::Grant, Envelope { revision, message: Message::Grant(grant) }) =
            received
            && newest.is_none_or(|(seen, _)| revision > seen)
        {
            *newest = Some((revision, grant.epoch));
        }
    });
}

pub fn levels_converge<F: Fixture>() {
    let plan: Plan = "loss=0.3,dup=0.2,reorder=0.2,corrupt=0.1,delay=3ms".parse().unwrap();
    for seed in 0..3 {
        let bus = F::new(1);
        let mut simulator = FaultyBus::new(bus.open(Node::Simulator), plan.clone(), seed);
        let mut coordinator = FaultyBus::new(bus.open(Node::Coordinator), plan.clone(), seed);
        let (mut said, mut newest) = (0, None);
        let end = Instant::now() + PATIENCE;
        let mut epoch = 0;
        while newest.is_none_or(|(_, seen)| seen != Epoch(LAST)) {
            assert!(Instant::now() < end, "seed {seed}: epoch {LAST} was not heard; {newest:?}");
            epoch = LAST.min(epoch + 1);
            say(&mut coordinator, &mut said, epoch);
            coordinator.wait(Some(Duration::from_millis(1))).unwrap();
            hear(&mut simulator, &mut newest);
        }
        let faults = coordinator.faults();
        assert!(faults.lost > 0 && faults.repeated > 0 && faults.corrupted > 0, "seed {seed}: {faults:?}");
        assert!(faults.reordered > 0 && faults.delayed > 0 && faults.cut == 0, "seed {seed}: {faults:?}");
    }
}

pub fn a_partition_heals<F: Fixture>() {
    let bus = F::new(1);
    let plan: Plan = "partition=coordinator@0s+200ms".parse().unwrap();
    let mut simulator = bus.open(Node::Simulator);
    let mut coordinator = FaultyBus::new(bus.open(Node::Coordinator), plan, 0);
    let (mut said, mut newest) = (0, None);
    let end = Instant::now() + PATIENCE;
    while newest.is_none() {
        assert!(Instant::now() < end, "the partition does not end");
        say(&mut coordinator, &mut said, 1);
        coordinator.wait(Some(Duration::from_millis(5))).unwrap();
        hear(&mut simulator, &mut newest);
    }
    assert!(coordinator.faults().cut > 0, "something was said while it was cut off");
}

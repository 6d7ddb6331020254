//! A large world frame read by many processes: in place, and by readers that copy it.
//!
//! `cargo run --release -p lamma-bus --example frame_readers [readers] [facts,facts] [rounds]`
//!
//! One half of the readers looks at the frame where the simulator wrote it, the other half copies it first, as
//! any transport without shared memory must. Both then look at the same thousand facts. What a process
//! spends on one frame is its own processor time, and what it holds is its own private memory, so neither
//! depends on how busy the machine is.
//!
//! - *KiB more*: private memory of a reader after the frames, less that before the first.
//! - *read from*: the files of shared memory (by inode) in which the words lay that the readers looked at. One for
//!   all of them means that there is one frame, whoever reads it.
#![expect(clippy::unwrap_used, reason = "an example that fails says where")]

mod common;

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use common::{Children, until_let_go};
use lamma_bus::iceoryx::{Endpoint, Run, Scope};
use lamma_bus::process::raise_open_files_limit;
use lamma_bus::{Bus, Received};
use lamma_protocol::{AgentId, Frame, FrameHeader, Node, StepIndex, frame};

/// Facts that a reader looks at.
const LOOKS: u32 = 1000;

fn main() {
    raise_open_files_limit().unwrap();
    let args: Vec<String> = std::env::args().collect();
    if args.get(1).is_some_and(|a| a == "reader") {
        return reader(&args[2].parse().unwrap(), args[3].parse().unwrap(), args[4].parse().unwrap());
    }
    let readers = args.get(1).map_or(64, |n| n.parse().unwrap());
    let facts = args.get(2).map_or("100000,10000000", String::as_str);
    let rounds = args.get(3).map_or(200, |n| n.parse().unwrap());
    facts.split(',').for_each(|facts| measure(readers, facts.parse().unwrap(), rounds));
}

/// Every third fact of a spread over the frame.
fn look(frame: &Frame<'_>) -> usize {
    let step = (frame.facts() / LOOKS).max(1);
    (0..LOOKS).filter(|i| frame.holds(i * step)).count()
}

fn reader(scope: &Scope, agent: u16, rounds: u64) {
    let mut bus = Endpoint::open(scope, Node::Robot(AgentId(agent))).unwrap();
    // What is looked at below for the first time is no cost of a frame.
    assert_eq!(inode_of(std::ptr::from_ref(&rounds)), None);
    let before = private_kib();
    println!("ready");
    let copies = agent % 2 == 1;
    let (mut seen, mut frames, mut spent) = (0, 0u32, Duration::ZERO);
    let (mut copy, mut found, mut place) = (Vec::new(), 0, std::ptr::null());
    while seen < rounds {
        bus.receive(&mut |r| {
            let Received::Frame(frame) = r else { return };
            let start = Instant::now();
            if copies {
                copy = frame.words().to_vec();
                found += look(&Frame::new(&copy).unwrap());
                place = copy.as_ptr();
            } else {
                found += look(&frame);
                place = frame.words().as_ptr();
            }
            spent += start.elapsed();
            seen = frame.version();
            frames += 1;
        });
        if seen < rounds {
            bus.wait(None).unwrap();
        }
    }
    assert!(found > 0, "some facts hold");
    let more = private_kib().saturating_sub(before);
    let inode = inode_of(place).map_or("none".to_owned(), |inode| inode.to_string());
    println!("{} {more} {inode}", spent.as_secs_f64() * 1e9 / f64::from(frames.max(1)));
    until_let_go();
    drop(copy);
}

fn private_kib() -> u64 {
    let text = std::fs::read_to_string("/proc/self/smaps_rollup").unwrap();
    let own = text.lines().filter(|l| l.starts_with("Private_"));
    own.filter_map(|l| l.split_whitespace().nth(1)?.parse::<u64>().ok()).sum()
}

/// The file of shared memory that is mapped at this address, if any.
fn inode_of(place: *const u64) -> Option<u64> {
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
    let address = |text: &str| u64::from_str_radix(text, 16).unwrap();
    let holds = |line: &&str| {
        let (from, to) = line.split(' ').next().unwrap().split_once('-').unwrap();
        (address(from)..address(to)).contains(&(place as u64))
    };
    let map = maps.lines().find(holds).unwrap();
    map.contains("/dev/shm/").then(|| map.split_whitespace().nth(4).unwrap().parse().unwrap())
}

fn measure(readers: u16, facts: u32, rounds: u64) {
    let run = Run::create(readers).unwrap();
    let mut bus = run.open(Node::Simulator).unwrap();
    let reader = |a: u16| vec!["reader".into(), run.scope().to_string(), a.to_string(), rounds.to_string()];
    let mut children = Children::start((0..readers).map(reader));
    let bits = vec![0x5555_5555_5555_5555; facts.div_ceil(64) as usize];
    let mut published = Duration::ZERO;
    let mut words = 0;
    for version in 1..=rounds {
        let progress = vec![StepIndex(0); readers.into()];
        let header = FrameHeader { version, facts, progress, ..FrameHeader::default() };
        let frame = frame::write_frame(&header, &bits);
        words = frame.len();
        let start = Instant::now();
        bus.publish_frame(&frame).unwrap();
        published += start.elapsed();
        // Readers need only the newest: let them see most.
        bus.wait(Some(Duration::from_millis(2))).unwrap();
        bus.receive(&mut |_| {});
    }
    let mut kinds = [Vec::new(), Vec::new()];
    for (agent, line) in children.lines().into_iter().enumerate() {
        let mut figures = line.split(' ').map(str::to_owned);
        let mut next = || figures.next().unwrap();
        let (ns, kib): (f64, f64) = (next().parse().unwrap(), next().parse().unwrap());
        kinds[agent % 2].push((ns, kib, next()));
    }
    children.end();
    drop(bus);
    run.end().unwrap();
    let size = words as f64 * 8.0 / 1024.0;
    println!("{facts} facts, {size:.1} KiB a frame, {readers} readers, {rounds} frames");
    println!("publishing once for all: {:.1} us", published.as_secs_f64() * 1e6 / rounds as f64);
    let middle = |values: Vec<f64>| {
        let mut values = values;
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or(0.0)
    };
    for (name, kind) in ["in place", "copying"].iter().zip(&kinds) {
        let ns = middle(kind.iter().map(|k| k.0).collect());
        let kib = middle(kind.iter().map(|k| k.1).collect());
        let places: BTreeSet<&str> = kind.iter().map(|k| k.2.as_str()).collect();
        let us = ns / 1e3;
        println!("{name:>9}: {us:8.2} us a frame, {kib:7.0} KiB more in each reader, read from {places:?}");
    }
}

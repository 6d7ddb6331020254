//! A large world frame read by many processes: in place, and by readers that copy it.
//!
//! `cargo run --release -p lamma-bus --example frame_readers [readers] [facts] [rounds]`
//!
//! One half of the readers looks at the frame where the simulator wrote it, the other half copies it first, as
//! any transport without shared memory must. Both then look at the same thousand facts. What a process
//! spends on one frame is its own processor time, and what it holds is its own private memory, so neither
//! depends on how busy the machine is.
#![expect(clippy::unwrap_used, reason = "an example that fails says where")]

use std::io::{BufRead, Write};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use lamma_bus::iceoryx::{Endpoint, Run, Scope};
use lamma_bus::process::{raise_open_files_limit, tie_to_parent};
use lamma_bus::{Bus, Received};
use lamma_protocol::{AgentId, Frame, FrameHeader, Node, StepIndex, frame};

/// Facts that a reader looks at.
const LOOKS: u32 = 1000;

fn main() {
    raise_open_files_limit().unwrap();
    let args: Vec<String> = std::env::args().collect();
    let number = |i: usize, default: u64| args.get(i).map_or(default, |n| n.parse().unwrap());
    if args.get(1).is_some_and(|a| a == "reader") {
        return reader(&args[2].parse().unwrap(), number(3, 0) as u16, number(4, 0));
    }
    measure(number(1, 64) as u16, number(2, 100_000) as u32, number(3, 200));
}

/// Every third fact of a spread over the frame.
fn look(frame: &Frame<'_>) -> usize {
    let step = (frame.facts() / LOOKS).max(1);
    (0..LOOKS).filter(|i| frame.holds(i * step)).count()
}

fn reader(scope: &Scope, agent: u16, rounds: u64) {
    let mut bus = Endpoint::open(scope, Node::Robot(AgentId(agent))).unwrap();
    println!("ready");
    let copies = agent % 2 == 1;
    let (mut seen, mut frames, mut spent) = (0, 0u32, Duration::ZERO);
    let mut copy = Vec::new();
    let mut found = 0;
    while seen < rounds {
        bus.receive(&mut |r| {
            let Received::Frame(frame) = r else { return };
            let start = Instant::now();
            if copies {
                copy = frame.words().to_vec();
                found += look(&Frame::new(&copy).unwrap());
            } else {
                found += look(&frame);
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
    let private = private_kib();
    println!("{} {private}", spent.as_secs_f64() * 1e9 / f64::from(frames.max(1)));
    std::io::stdout().flush().unwrap();
    std::io::stdin().lines().for_each(drop);
    drop(copy);
}

fn private_kib() -> u64 {
    let text = std::fs::read_to_string("/proc/self/smaps_rollup").unwrap();
    let own = text.lines().filter(|l| l.starts_with("Private_"));
    own.filter_map(|l| l.split_whitespace().nth(1)?.parse::<u64>().ok()).sum()
}

fn spawn(scope: &Scope, agent: u16, rounds: u64) -> Child {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["reader", &scope.to_string(), &agent.to_string(), &rounds.to_string()]);
    command.stdin(Stdio::piped()).stdout(Stdio::piped());
    tie_to_parent(&mut command).spawn().unwrap()
}

fn measure(readers: u16, facts: u32, rounds: u64) {
    let run = Run::create(readers).unwrap();
    let mut bus = run.open(Node::Simulator).unwrap();
    let mut children: Vec<Child> = (0..readers).map(|a| spawn(run.scope(), a, rounds)).collect();
    let mut outputs: Vec<_> =
        children.iter_mut().map(|c| std::io::BufReader::new(c.stdout.take().unwrap()).lines()).collect();
    for output in &mut outputs {
        assert_eq!(output.next().unwrap().unwrap(), "ready");
    }
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
    for (agent, output) in outputs.iter_mut().enumerate() {
        let line = output.next().unwrap().unwrap();
        let (ns, kib) = line.split_once(' ').unwrap();
        kinds[agent % 2].push((ns.parse::<f64>().unwrap(), kib.parse::<f64>().unwrap()));
    }
    for child in &mut children {
        drop(child.stdin.take());
        child.wait().unwrap();
    }
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
        println!("{name:>9}: {:8.2} us a frame, {kib:7.0} KiB private to each reader", ns / 1e3);
    }
}

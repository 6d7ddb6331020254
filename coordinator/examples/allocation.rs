//! How allocation scales: exact with a proof while it is small, by auction and local improvement with the gap
//! to a lower bound when it is large; on random instances of several kinds.
//!
//! `cargo run --release -p lamma-coordinator --example allocation [-- --seeds N] [--svg FILE]`

use std::collections::BTreeMap;
use std::time::Instant;

use lamma_coordinator::assign::{Work, assign_proved};
use lamma_plot::{Chart, Series};

/// Sub-tasks and robots where a proof is asked for.
const EXACT: [(usize, usize); 4] = [(5, 2), (10, 3), (15, 4), (20, 6)];
/// Sub-tasks and robots where the gap to the bound is what there is.
const LARGE: [(usize, usize); 4] = [(125, 12), (250, 25), (500, 50), (1000, 100)];

/// Kinds of instances, with a colour for the plot.
const KINDS: [(&str, &str, Draw); 5] = [
    ("unrelated", "#1f77b4", unrelated),
    ("related", "#ff7f0e", related),
    ("skills 70 %", "#2ca02c", skilled),
    ("capacity", "#d62728", capacity),
    ("precedence", "#9467bd", precedence),
];

type Draw = fn(&mut Random, usize, usize) -> Vec<Work>;

fn main() -> std::io::Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let value = |flag: &str| args.iter().position(|a| a == flag).and_then(|at| args.get(at + 1));
    let seeds: u64 = value("--seeds").and_then(|n| n.parse().ok()).unwrap_or(50);
    println!("{seeds} instances of each kind and size");
    println!(
        "{:<14}{:>12}{:>10}{:>10}{:>10}{:>10}{:>10}",
        "kind", "size", "p50 ms", "max ms", "proved", "mean gap", "max gap"
    );
    let mut charts = Vec::new();
    for (title, sizes, seeds) in [
        ("exact: slowest of all, ms", EXACT, seeds),
        ("auction: slowest of all, ms", LARGE, seeds.div_ceil(5)),
    ] {
        let series = KINDS.map(|(kind, colour, draw)| {
            let points =
                sizes.map(|(pieces, members)| (pieces as f64, measure(kind, draw, pieces, members, seeds)));
            Series { name: kind, colour, points: points.to_vec() }
        });
        charts.push(Chart { title, over: "sub-tasks", series: series.into() });
    }
    if let Some(file) = value("--svg") {
        std::fs::write(file, lamma_plot::svg(&charts))?;
        println!("plot in {file}");
    }
    Ok(())
}

/// Prints a line of the table; returns the longest time in milliseconds.
fn measure(kind: &str, draw: Draw, pieces: usize, members: usize, seeds: u64) -> f64 {
    let (mut times, mut gaps, mut proved) = (Vec::new(), Vec::new(), 0);
    for seed in 1..=seeds {
        let work = draw(&mut Random::new(seed), pieces, members);
        let start = Instant::now();
        let found = assign_proved(&work);
        times.push(start.elapsed().as_secs_f64() * 1e3);
        proved += u64::from(found.is_proved());
        gaps.push(found.makespan as f64 / found.bound.max(1) as f64 - 1.0);
    }
    times.sort_by(f64::total_cmp);
    gaps.sort_by(f64::total_cmp);
    let (slowest, widest) = (times[times.len() - 1], gaps[gaps.len() - 1]);
    println!(
        "{kind:<14}{:>12}{:>10.2}{slowest:>10.2}{:>10}{:>9.2}%{:>9.2}%",
        format!("{pieces} x {members}"),
        times[times.len() / 2],
        format!("{proved}/{seeds}"),
        gaps.iter().sum::<f64>() / gaps.len() as f64 * 100.0,
        widest * 100.0
    );
    slowest
}

/// Xorshift: the same instances everywhere.
struct Random(u64);

impl Random {
    fn new(seed: u64) -> Self {
        Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    fn below(&mut self, n: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) % n
    }
}

fn free(cost: BTreeMap<usize, u64>) -> Work {
    Work { after: Vec::new(), cost }
}

/// Every robot takes its own time for everything: 3 to 20 steps.
fn unrelated(random: &mut Random, pieces: usize, members: usize) -> Vec<Work> {
    (0..pieces).map(|_| free((0..members).map(|m| (m, 3 + random.below(18))).collect())).collect()
}

/// Robots differ in pace, sub-tasks in size.
fn related(random: &mut Random, pieces: usize, members: usize) -> Vec<Work> {
    let pace: Vec<u64> = (0..members).map(|_| 10 + random.below(11)).collect();
    let piece =
        |size: u64| free(pace.iter().enumerate().map(|(m, p)| (m, (size * p).div_ceil(10))).collect());
    (0..pieces).map(|_| piece(3 + random.below(12))).collect()
}

/// A robot has seven skills of ten; what it can do takes it about as long as the others.
fn skilled(random: &mut Random, pieces: usize, members: usize) -> Vec<Work> {
    let mut piece = || {
        let steps = 3 + random.below(12);
        let able: Vec<usize> = (0..members).filter(|_| random.below(10) < 7).collect();
        let mut cost: BTreeMap<usize, u64> = able.into_iter().map(|m| (m, steps + random.below(7))).collect();
        cost.entry(random.below(members as u64) as usize).or_insert(steps);
        free(cost)
    };
    (0..pieces).map(|_| piece()).collect()
}

/// What a robot can lift differs; the strongest can do everything.
fn capacity(random: &mut Random, pieces: usize, members: usize) -> Vec<Work> {
    let lifts: Vec<u64> = (0..members).map(|m| if m == 0 { 100 } else { 10 + random.below(90) }).collect();
    let mut piece = || {
        let (mass, steps) = (random.below(100), 3 + random.below(12));
        let able = lifts.iter().enumerate().filter(|(_, lifts)| **lifts >= mass).map(|(m, _)| m);
        free(able.map(|m| (m, steps)).collect())
    };
    (0..pieces).map(|_| piece()).collect()
}

/// As `skilled`, and four of ten wait for an earlier sub-task.
fn precedence(random: &mut Random, pieces: usize, members: usize) -> Vec<Work> {
    let mut work = skilled(random, pieces, members);
    for (i, piece) in work.iter_mut().enumerate().skip(1) {
        if random.below(10) < 4 {
            piece.after.push(random.below(i as u64) as usize);
        }
    }
    work
}

//! How allocation scales: exact with a proof while it is small, by auction and local improvement with the gap
//! to a lower bound when it is large.
//!
//! `cargo run --release -p lamma-coordinator --example allocation [-- --svg FILE]`

use std::collections::BTreeMap;
use std::fmt::Write;
use std::time::Instant;

use lamma_coordinator::assign::{Assignment, Work, assign_proved};

/// Instances of each size.
const SEEDS: u64 = 10;

struct Measured {
    label: String,
    pieces: usize,
    worst_ms: f64,
    mean_ms: f64,
    proved: u64,
    gap: f64,
}

fn main() -> std::io::Result<()> {
    let svg = std::env::args().skip_while(|a| a != "--svg").nth(1);
    println!("sub-tasks x robots, {SEEDS} instances each: 70 % skills, 3 to 20 steps, uneven robots");
    println!("{:<34} {:>9} {:>9} {:>7} {:>8}", "", "mean ms", "worst ms", "proved", "mean gap");
    let exact = [(5, 2), (10, 3), (15, 4), (20, 6)];
    let chained = [(5, 2), (10, 3), (15, 4), (20, 6)];
    let large = [(125, 12), (250, 25), (500, 50), (1000, 100)];
    let mut rows: Vec<Vec<Measured>> = Vec::new();
    for (name, sizes, chain) in [("exact", exact, 0), ("exact, ordered", chained, 8), ("auction", large, 0)] {
        let measured: Vec<Measured> = sizes.iter().map(|&(n, m)| measure(name, n, m, chain)).collect();
        for row in &measured {
            println!(
                "{:<34} {:>9.2} {:>9.2} {:>4}/{SEEDS} {:>7.2}%",
                row.label,
                row.mean_ms,
                row.worst_ms,
                row.proved,
                row.gap * 100.0
            );
        }
        rows.push(measured);
    }
    if let Some(file) = svg {
        std::fs::write(&file, plot(&rows))?;
        println!("plot in {file}");
    }
    Ok(())
}

/// `chain`: of ten pieces, so many wait for an earlier one, at most.
fn measure(name: &str, pieces: usize, members: usize, chain: u64) -> Measured {
    let (mut times, mut gaps, mut proved) = (Vec::new(), Vec::new(), 0);
    for seed in 1..=SEEDS {
        let work = instance(seed, pieces, members, chain);
        let start = Instant::now();
        let found: Assignment = assign_proved(&work);
        times.push(start.elapsed().as_secs_f64() * 1e3);
        proved += u64::from(found.is_proved());
        gaps.push(found.makespan as f64 / found.bound.max(1) as f64 - 1.0);
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    Measured {
        label: format!("{name}: {pieces} x {members}"),
        pieces,
        worst_ms: times.iter().copied().fold(0.0, f64::max),
        mean_ms: mean(&times),
        proved,
        gap: mean(&gaps),
    }
}

fn instance(seed: u64, pieces: usize, members: usize, chain: u64) -> Vec<Work> {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut below = |n: u64| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) % n
    };
    (0..pieces)
        .map(|i| {
            let steps = 3 + below(12);
            let mut cost: BTreeMap<usize, u64> = BTreeMap::new();
            for member in 0..members {
                if below(10) < 7 {
                    cost.insert(member, steps + below(7));
                }
            }
            cost.entry(below(members as u64) as usize).or_insert(steps);
            let waits = i > 0 && below(10) < chain / 2;
            let after = if waits { vec![below(i as u64) as usize] } else { Vec::new() };
            Work { after, cost }
        })
        .collect()
}

/// Both axes logarithmic; a line for each series.
fn plot(rows: &[Vec<Measured>]) -> String {
    let x = |pieces: usize| 60.0 + (pieces as f64 / 4.0).log10() / 250f64.log10() * 520.0;
    let y = |ms: f64| 340.0 - (ms.max(0.001) / 0.001).log10() / 6.0 * 300.0;
    let mut out = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 400\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"640\" height=\"400\" fill=\"white\"/>\n\
         <text x=\"60\" y=\"22\">Allocation: mean time by number of sub-tasks (both logarithmic)</text>\n",
    );
    for (ms, label) in [(0.001, "1 µs"), (0.1, "0.1 ms"), (10.0, "10 ms"), (1000.0, "1 s")] {
        let at = y(ms);
        let _ = writeln!(
            out,
            "<path d=\"M60 {at:.1}H600\" stroke=\"#ddd\"/><text x=\"8\" y=\"{:.1}\">{label}</text>",
            at + 4.0
        );
    }
    for pieces in [5, 10, 20, 125, 250, 500, 1000] {
        let _ =
            writeln!(out, "<text x=\"{:.1}\" y=\"362\" text-anchor=\"middle\">{pieces}</text>", x(pieces));
    }
    for (series, colour) in rows.iter().zip(["#06c", "#c60", "#090"]) {
        let points: Vec<String> =
            series.iter().map(|r| format!("{:.1},{:.1}", x(r.pieces), y(r.mean_ms))).collect();
        let _ =
            writeln!(out, "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\"/>", points.join(" "));
        for row in series {
            let _ = writeln!(
                out,
                "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"3\" fill=\"{colour}\"><title>{}: {:.2} ms</title></circle>",
                x(row.pieces),
                y(row.mean_ms),
                row.label,
                row.mean_ms
            );
        }
        if let Some(last) = series.last() {
            let name = last.label.split(':').next().unwrap_or_default();
            let _ = writeln!(
                out,
                "<text x=\"{:.1}\" y=\"{:.1}\" fill=\"{colour}\">{name}</text>",
                x(last.pieces) - 30.0,
                y(last.mean_ms) - 10.0
            );
        }
    }
    out.push_str("</svg>\n");
    out
}

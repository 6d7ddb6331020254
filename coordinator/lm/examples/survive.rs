//! Reads random and mutated inputs and prints how many were survived and what a sentence takes:
//! `survive [COUNT] [SEED]`.
//!
//! Half of the inputs are lines of `tests/data/household.txt` with words and letters dropped, doubled, swapped
//! and taken from other lines; the rest are characters drawn at random, of all planes of Unicode.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

use lamma_lm::{Offline, Request};

type Failure = Box<dyn std::error::Error>;

const LINES: &str = include_str!("../tests/data/household.txt");

/// Xorshift (G. Marsaglia, "Xorshift RNGs", JSS 8(14), 2003).
struct Draw(u64);

impl Draw {
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 >> 11).unwrap_or(0) % bound.max(1)
    }
}

fn main() -> Result<(), Failure> {
    let mut arguments = std::env::args().skip(1);
    let count: usize = arguments.next().and_then(|n| n.parse().ok()).unwrap_or(10_000);
    let seed: u64 = arguments.next().and_then(|n| n.parse().ok()).unwrap_or(1);
    let offline = match std::env::var_os("LEXICON") {
        Some(folder) => Offline::from_folder(Path::new(&folder))?,
        None => Offline::new()?,
    };
    let mut scenes = Vec::new();
    for name in ["FloorPlan6", "FloorPlan201", "FloorPlan303", "FloorPlan414"] {
        let world = lamma_domains::world::setup(name, &[], None, 0)?;
        scenes.push(lamma_domains::view::views(&world, world.facts()));
    }
    let sentences: Vec<&str> = LINES
        .lines()
        .filter(|line| !line.starts_with('#'))
        .filter_map(|line| line.split(" | ").nth(1))
        .collect();
    let words: Vec<&str> = sentences.iter().flat_map(|sentence| sentence.split(' ')).collect();
    let mut draw = Draw(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    let mut times: Vec<Duration> = Vec::with_capacity(count);
    let mut broken = 0;
    for number in 0..count {
        let instruction = match number % 2 {
            0 => mutated(&sentences, &words, &mut draw),
            _ => random(&mut draw),
        };
        let request = Request {
            instruction,
            objects: scenes[draw.below(scenes.len())].clone(),
            robots: Vec::new(),
            assume: draw.below(2) == 0,
            deadline: Duration::from_secs(5),
        };
        let started = Instant::now();
        if catch_unwind(AssertUnwindSafe(|| offline.read(&request))).is_err() {
            broken += 1;
            println!("PANIC {:?}", request.instruction);
        }
        times.push(started.elapsed());
    }
    times.sort();
    println!("{} of {count} inputs survived (seed {seed})", count - broken);
    let p99 = times.get(times.len() * 99 / 100);
    let (Some(p50), Some(p99), Some(worst)) = (times.get(times.len() / 2), p99, times.last()) else {
        return Ok(());
    };
    println!(
        "p50 {p50:?}, p99 {p99:?}, worst {worst:?}, mean {:?}",
        times.iter().sum::<Duration>() / count.max(1) as u32
    );
    if broken > 0 { Err("some inputs were not survived".into()) } else { Ok(()) }
}

fn mutated(sentences: &[&str], pool: &[&str], draw: &mut Draw) -> String {
    let sentence = sentences[draw.below(sentences.len())];
    let mut words: Vec<String> = sentence.split(' ').map(str::to_owned).collect();
    for _ in 0..draw.below(9) {
        let at = draw.below(words.len());
        let other = draw.below(words.len());
        match draw.below(6) {
            0 if words.len() > 1 => drop(words.remove(at)),
            1 => words.insert(at, pool[draw.below(pool.len())].to_owned()),
            2 => words[at] = words[at].chars().rev().collect(),
            3 => words.swap(at, other),
            4 => words[at] = words[at].chars().skip(1).collect(),
            _ => {
                let again = words[at].clone();
                words.insert(other, again);
            }
        }
    }
    words.join(" ")
}

fn random(draw: &mut Draw) -> String {
    let length = draw.below(160);
    let ascii = draw.below(2) == 0;
    let highest = if ascii { 0x7f } else { 0x2_0000 };
    (0..length).filter_map(|_| char::from_u32(u32::try_from(draw.below(highest)).unwrap_or(0))).collect()
}

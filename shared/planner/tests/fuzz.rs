//! Broken tasks and plans through everything that takes them: reading, checking, grounding, searching and
//! validating answer or refuse; they never end the process, hang, or fill the memory; and a plan that is found
//! for a task nobody meant is still a valid one.
//!
//! By default some hundred cases. `LAMMA_FUZZ_SECONDS=600 cargo test -p lamma-planner --test fuzz -- --nocapture`
//! goes on for ten minutes; `LAMMA_FUZZ_SEED` begins elsewhere. A case that fails names its seed, and with that
//! seed it is the first one.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use lamma_pddl::{Source, check_domain, check_problem, parse_domain, parse_problem};
use lamma_planner::{
    GroundLimits, Limits, Outcome, SearchOptions, ground, read_plan, solve, validate, write_plan,
};

const CASES: u64 = 300;

/// Nothing here is large, so nothing may take longer.
const LONGEST_CASE: Duration = Duration::from_secs(30);

/// The whole process, in kibibytes.
const MOST_MEMORY: u64 = 2 << 20;

/// SplitMix64.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) % n.max(1) as u64) as usize
    }
}

/// A task of the corpus, with a plan for it.
struct Specimen {
    domain: String,
    problem: String,
    plan: String,
}

fn corpus() -> Vec<Specimen> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/planner/tasks");
    let mut folders: Vec<PathBuf> =
        std::fs::read_dir(&root).expect("part of the project").flatten().map(|entry| entry.path()).collect();
    folders.sort();
    let read =
        |path: PathBuf| std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let texts =
        folders.into_iter().map(|folder| (read(folder.join("domain.pddl")), read(folder.join("p1.pddl"))));
    texts
        .map(|(domain, problem)| {
            let plan = plan_of(&domain, &problem, 200_000).unwrap_or_else(|| panic!("no plan for {problem}"));
            Specimen { domain, problem, plan }
        })
        .collect()
}

/// Reads, checks, grounds and plans; what was found is valid. The plan's text, if there is one.
fn plan_of(domain: &str, problem: &str, expansions: u64) -> Option<String> {
    let (domain_source, problem_source) = (Source::new("domain", domain), Source::new("problem", problem));
    let domain = parse_domain(&domain_source).ok()?.value;
    let problem = parse_problem(&problem_source).ok()?.value;
    let sound = !check_domain(&domain, &domain_source).has_errors()
        && !check_problem(&domain, &problem, &problem_source).has_errors();
    #[allow(clippy::needless_update, reason = "whatever other limits there are stay as they are")]
    let limits =
        GroundLimits { facts: 50_000, instances: 50_000, steps: 2_000_000, ..GroundLimits::default() };
    // What the checker refuses may still be grounded by a caller that does not ask it.
    let task = ground(&domain, &problem, &limits).ok()?;
    let limits = Limits { expansions: Some(expansions), memory_bytes: Some(64 << 20), ..Limits::default() };
    let Outcome::Found(plan) = solve(&task, &SearchOptions::default(), &limits, &AtomicBool::new(false))
    else {
        return None;
    };
    if sound {
        let verdict = validate(&domain, &problem, &plan.acts);
        assert!(
            verdict.as_ref().is_ok_and(|verdict| verdict.is_valid()),
            "a wrong plan: {verdict:?}\n{plan:?}\n{domain}\n{problem}"
        );
    }
    Some(write_plan(&plan, lamma_planner::validate::CostKind::Unit))
}

fn validate_text(domain: &str, problem: &str, plan: &str) {
    let acts = read_plan(&Source::new("plan", plan));
    let domain = parse_domain(&Source::new("domain", domain));
    let problem = parse_problem(&Source::new("problem", problem));
    if let (Ok(acts), Ok(domain), Ok(problem)) = (acts, domain, problem) {
        // Either answer is one.
        drop(validate(&domain.value, &problem.value, &acts));
    }
}

/// Words and parentheses.
fn tokens(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut word = String::new();
    for line in text.lines() {
        let line = line.split(';').next().unwrap_or_default();
        for character in line.chars().chain([' ']) {
            if character.is_whitespace() || matches!(character, '(' | ')') {
                if !word.is_empty() {
                    found.push(std::mem::take(&mut word));
                }
                if !character.is_whitespace() {
                    found.push(character.to_string());
                }
            } else {
                word.push(character);
            }
        }
    }
    found
}

/// Where the expression that begins at `start` ends.
fn end_of(tokens: &[String], start: usize) -> usize {
    let mut depth = 0usize;
    for (at, token) in tokens.iter().enumerate().skip(start) {
        match token.as_str() {
            "(" => depth += 1,
            ")" => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 {
            return at + 1;
        }
    }
    tokens.len()
}

/// Words that mean something, or should not.
const SPICE: &[&str] = &[
    "not",
    "and",
    "or",
    "imply",
    "forall",
    "exists",
    "when",
    "increase",
    "decrease",
    "assign",
    "scale-up",
    "scale-down",
    "=",
    "<",
    "<=",
    ">",
    ">=",
    "+",
    "-",
    "*",
    "/",
    "0",
    "-1",
    "1e300",
    "0.1",
    "total-cost",
    "object",
    "either",
    ":derived",
    ":durative-action",
    ":duration",
    "at",
    "start",
    "end",
    "over",
    "all",
    "?x",
    "?duration",
    "(",
    ")",
    "()",
    ":private",
    ":metric",
    "maximize",
    "total-time",
];

/// Breaks a text in a few places: expressions are dropped, doubled, exchanged, or words replaced.
fn broken(random: &mut Random, text: &str, other: &str) -> String {
    let mut tokens = tokens(text);
    let foreign = self::tokens(other);
    for _ in 0..1 + random.below(4) {
        let at = random.below(tokens.len());
        let end = end_of(&tokens, at);
        match random.below(7) {
            0 => drop(tokens.drain(at..end)),
            1 => {
                let copy = tokens[at..end].to_vec();
                drop(tokens.splice(at..at, copy));
            }
            2 => {
                let from = random.below(foreign.len());
                drop(tokens.splice(at..end, foreign[from..end_of(&foreign, from)].to_vec()));
            }
            3 | 4 => tokens[at] = SPICE[random.below(SPICE.len())].to_owned(),
            5 => {
                let from = random.below(tokens.len());
                tokens[at] = tokens[from].clone();
            }
            _ => {
                let from = random.below(tokens.len());
                let copy = tokens[from..end_of(&tokens, from)].to_vec();
                drop(tokens.splice(at..end, copy));
            }
        }
        if tokens.is_empty() || tokens.len() > 20_000 {
            break;
        }
    }
    tokens.join(" ")
}

/// The most memory this process ever used, in kibibytes, where the host says.
fn peak_kib() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_ascii_whitespace().nth(1)?.parse().ok()
}

#[test]
fn broken_tasks_and_plans_are_answered_or_refused() {
    let setting = |name: &str| std::env::var(name).ok().and_then(|value| value.parse::<u64>().ok());
    let deadline = setting("LAMMA_FUZZ_SECONDS").map(|s| Instant::now() + Duration::from_secs(s));
    let first = setting("LAMMA_FUZZ_SEED").unwrap_or(0);
    let corpus = corpus();
    let (mut cases, mut planned, mut longest) = (0u64, 0u64, Duration::ZERO);
    for seed in first.. {
        match deadline {
            Some(deadline) if Instant::now() >= deadline => break,
            None if cases >= CASES => break,
            _ => {}
        }
        cases += 1;
        let started = Instant::now();
        let outcome = std::panic::catch_unwind(|| one_case(&corpus, seed));
        let took = started.elapsed();
        longest = longest.max(took);
        match outcome {
            Ok(found) => planned += u64::from(found),
            Err(_) => panic!("LAMMA_FUZZ_SEED={seed} brings this case back"),
        }
        assert!(took < LONGEST_CASE, "seed {seed} took {took:?}");
    }
    let peak = peak_kib();
    println!("{cases} cases, {planned} with a plan, the longest {longest:?}, at most {peak:?} KiB");
    assert!(
        planned > cases / 50,
        "{planned} of {cases} broken tasks have a plan: they are too broken to tell much"
    );
    assert!(peak.is_none_or(|peak| peak < MOST_MEMORY), "{peak:?} KiB");
}

fn one_case(corpus: &[Specimen], seed: u64) -> bool {
    let random = &mut Random(seed);
    let specimen = &corpus[random.below(corpus.len())];
    let other = &corpus[random.below(corpus.len())];
    let mut domain = specimen.domain.clone();
    let mut problem = specimen.problem.clone();
    if random.below(3) > 0 {
        domain = broken(random, &domain, &other.domain);
    }
    if random.below(3) > 0 {
        problem = broken(random, &problem, &other.problem);
    }
    let plan = broken(random, &specimen.plan, &other.plan);
    validate_text(&specimen.domain, &specimen.problem, &plan);
    validate_text(&domain, &problem, &specimen.plan);
    plan_of(&domain, &problem, 2_000).is_some()
}

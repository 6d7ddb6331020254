//! Text from outside may be anything: it is read or refused, never the end of the process.

use std::path::PathBuf;

use lamma_pddl::{
    Report, Source, check_domain, check_problem, parse_condition, parse_domain, parse_ground_atom,
    parse_problem,
};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn corpus() -> Vec<String> {
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/corpus"));
    let files = std::fs::read_dir(folder).expect("part of the project").flatten().map(|entry| entry.path());
    let mut files: Vec<PathBuf> = files.collect();
    files.sort();
    files.iter().map(|path| std::fs::read_to_string(path).expect("a text")).collect()
}

/// Everything that takes text, and everything that takes what was read.
fn try_all(bytes: &[u8]) {
    let source = Source::from_bytes("fuzz", bytes);
    let show = |report: &Report| (report.render(), report.to_json());
    let domain = parse_domain(&source);
    match &domain {
        Ok(parsed) => {
            show(&check_domain(&parsed.value, &source));
            let again = parse_domain(&Source::new("printed", parsed.value.to_string()));
            assert!(
                again.is_ok_and(|again| again.value == parsed.value),
                "printing lost something of\n{}",
                source.text
            );
        }
        Err(report) => drop(show(report)),
    }
    match parse_problem(&source) {
        Ok(parsed) => {
            if let Ok(domain) = &domain {
                show(&check_problem(&domain.value, &parsed.value, &source));
            }
            let again = parse_problem(&Source::new("printed", parsed.value.to_string()));
            assert!(
                again.is_ok_and(|again| again.value == parsed.value),
                "printing lost something of\n{}",
                source.text
            );
        }
        Err(report) => drop(show(&report)),
    }
    drop((parse_condition(&source.text), parse_ground_atom(&source.text)));
}

/// What a mutation puts in.
const PIECES: &[&str] = &[
    "(",
    ")",
    "?",
    "-",
    " - ",
    ":",
    ";",
    "\n",
    "\u{0}",
    "é",
    "\"",
    "()",
    "(and)",
    "(not)",
    "(either)",
    "(either a b)",
    "(:private",
    ":agent",
    ":effect",
    ":parameters",
    "(at start",
    "(over all",
    "(= ?duration",
    "?x",
    "?",
    "object",
    "number",
    "1e999",
    "-1.5",
    "(forall (?x)",
    "(exists ()",
    "(when",
    "(increase",
    "(= ",
    "(define",
    "(domain d)",
    "(problem p)",
    "(:init",
    "(:goal",
    "(:metric minimize",
    "(:types a - a)",
    "(:derived (p) (not (p)))",
];

/// Cuts out a range, puts a piece or another range of the text in its place.
fn mutate(text: &mut Vec<u8>, (at, length, from, piece): (usize, usize, usize, usize)) {
    let at = at % (text.len() + 1);
    let end = (at + length % 12).min(text.len());
    let insert = match PIECES.get(piece % (PIECES.len() + 8)) {
        Some(piece) => piece.as_bytes().to_vec(),
        None => {
            let from = from % (text.len() + 1);
            text[from..(from + length).min(text.len())].to_vec()
        }
    };
    text.splice(at..end, insert);
}

/// The same cases in every run; `PROPTEST_RNG_SEED` and `PROPTEST_CASES` ask for others.
fn config(cases: u32) -> ProptestConfig {
    let default = ProptestConfig::default();
    let fixed = std::env::var_os("PROPTEST_RNG_SEED").is_none();
    let cases = if std::env::var_os("PROPTEST_CASES").is_none() { cases } else { default.cases };
    let rng_seed = if fixed { RngSeed::Fixed(20_251) } else { default.rng_seed };
    ProptestConfig { cases, rng_seed, failure_persistence: None, ..default }
}

proptest! {
    #![proptest_config(config(400))]

    #[test]
    fn random_bytes(bytes in vec(any::<u8>(), 0..400)) {
        try_all(&bytes);
    }

    #[test]
    fn random_pieces(pieces in vec(0..PIECES.len(), 0..80)) {
        let text: Vec<&str> = pieces.iter().map(|piece| PIECES[*piece]).collect();
        try_all(text.join(" ").as_bytes());
        try_all(format!("(define (domain d) {}", text.join(" ")).as_bytes());
        try_all(format!("(define (problem d) (:domain d) {}", text.join(" ")).as_bytes());
    }

    #[test]
    fn mutated_files(
        file in any::<usize>(),
        mutations in vec((any::<usize>(), 0usize..100, any::<usize>(), any::<usize>()), 1..8),
    ) {
        let corpus = corpus();
        let mut text = corpus[file % corpus.len()].clone().into_bytes();
        mutations.into_iter().for_each(|mutation| mutate(&mut text, mutation));
        try_all(&text);
    }
}

#[test]
fn hostile_shapes_end_quickly() {
    let many = |piece: &str, times: usize| piece.repeat(times);
    let domain = |body: String| format!("(define (domain d) {body})");
    for text in [
        many("(", 1_000_000),
        many(")", 1_000_000),
        many("(a ", 255),
        domain(format!("(:types {} - (either {}))", many("t ", 50_000), many("u ", 50_000))),
        domain(format!(
            "(:types {})",
            (0..50_000).map(|i| format!("t{i} - t{} ", i + 1)).collect::<String>()
        )),
        domain(format!("(:constants {} - x)", (0..100_000).map(|i| format!("c{i} ")).collect::<String>())),
        domain(format!("(:constants {})", many("(:private a b - c) ", 50_000))),
        domain(
            format!("(:predicates {})", (0..50_000).map(|i| format!("(p{i}) ")).collect::<String>())
                + &format!(
                    "(:action a :effect (and {}))",
                    (0..50_000).map(|i| format!("(q{i}) ")).collect::<String>()
                ),
        ),
        domain(format!("(:action a :parameters ({}))", many("?x ", 100_000))),
        domain(format!("(:action a :precondition {}(p){})", many("(not ", 250), many(")", 250))),
        domain(format!("(:predicates (p)) (:derived (p) (and {}))", many("(p) ", 100_000))),
    ] {
        try_all(text.as_bytes());
    }
}

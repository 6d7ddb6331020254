//! The embedded default on our own development sentences: what it understood it goes on understanding.

mod judge;

use judge::Kind;
use lamma_lm::Offline;

/// Sentences, and which part of them at least must be read as they are meant.
const FILES: [(&str, &[(Kind, f64)]); 12] = [
    (include_str!("data/household.txt"), &[(Kind::Plain, 0.95), (Kind::Vague, 0.95), (Kind::Asks, 0.85)]),
    (include_str!("data/workers.txt"), &[(Kind::Plain, 0.88), (Kind::Vague, 0.77), (Kind::Asks, 0.95)]),
    (include_str!("data/mixed.txt"), &[(Kind::Plain, 0.65), (Kind::Vague, 0.5)]),
    (include_str!("data/writers.txt"), &[(Kind::Plain, 0.65), (Kind::Vague, 0.8)]),
    (include_str!("data/strangers.txt"), &[(Kind::Plain, 0.65)]),
    (include_str!("data/authors.txt"), &[(Kind::Plain, 0.66)]),
    (include_str!("data/homes.txt"), &[(Kind::Plain, 0.85), (Kind::Vague, 0.95)]),
    (include_str!("data/crowd.txt"), &[(Kind::Plain, 0.56), (Kind::Vague, 0.78)]),
    (include_str!("data/guests.txt"), &[(Kind::Plain, 0.7), (Kind::Vague, 0.55)]),
    (include_str!("data/visitors.txt"), &[(Kind::Plain, 0.66), (Kind::Vague, 0.7)]),
    (include_str!("data/wordings.txt"), &[(Kind::Plain, 0.93), (Kind::Vague, 0.93)]),
    (include_str!("data/commands.txt"), &[(Kind::Vague, 0.86)]),
];

#[test]
fn our_sentences_are_read_as_they_are_meant() {
    let offline = Offline::new().expect("the built-in lexicon reads");
    for (lines, least) in FILES {
        are_read(lines, least, &offline);
    }
}

fn are_read(lines: &str, least: &[(Kind, f64)], offline: &Offline) {
    let outcomes = judge::outcomes(lines, offline).expect("every line has a scene, a sentence and a goal");
    for &(kind, least) in least {
        let all: Vec<_> = outcomes.iter().filter(|outcome| outcome.kind == kind).collect();
        let bad: Vec<String> = all
            .iter()
            .filter(|outcome| !outcome.good)
            .map(|outcome| {
                let judge::Outcome { line, sentence, goal, told, .. } = outcome;
                format!("{line}: {sentence}\n    want {goal}\n    {told}")
            })
            .collect();
        let rate = 1.0 - bad.len() as f64 / all.len() as f64;
        assert!(rate >= least, "{kind:?}: {rate:.3}\n{}", bad.join("\n"));
    }
}

//! The embedded default on our own development sentences: what it understood it goes on understanding.

mod judge;

use judge::Kind;
use lamma_lm::Offline;

const LINES: &str = include_str!("data/household.txt");

#[test]
fn our_sentences_are_read_as_they_are_meant() {
    let offline = Offline::new().expect("the built-in lexicon reads");
    let outcomes = judge::outcomes(LINES, &offline).expect("every line has a scene, a sentence and a goal");
    for (kind, least) in [(Kind::Plain, 0.95), (Kind::Vague, 0.95), (Kind::Asks, 0.85)] {
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

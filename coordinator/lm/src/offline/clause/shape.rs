//! What clauses are like: whether they deny, put things somewhere, or speak only of what was spoken of before.

use super::super::lexicon::Act;
use super::super::syntax::{Clause, Head, Relation};

/// Whether words deny what they say: "does not go here", but not "goes here, not there".
pub fn is_denied(said: &[String]) -> bool {
    const DENIALS: [&str; 5] = ["not", "doesnt", "shouldnt", "mustnt", "dont"];
    (0..said.len()).any(|at| {
        let contrast = at > 0 && [",", "and", "but"].contains(&said[at - 1].as_str());
        DENIALS.contains(&said[at].as_str()) && !contrast
    })
}

/// Whether a clause says where something goes.
pub fn goes_somewhere(clause: &Clause<'_>) -> bool {
    clause.places.iter().any(|place| matches!(place.relation, Relation::In | Relation::To))
}

/// "the fork goes in the drawer", "the bat leans on the wall": verbs of where things are to be.
pub fn is_going(word: &str) -> bool {
    const GOING: [&str; 15] = [
        "goes", "go", "belongs", "belong", "leans", "lean", "stays", "stay", "hangs", "moves", "move",
        "comes", "come", "lands", "land",
    ];
    GOING.contains(&word)
}

/// Whether something is done to what was spoken of before, and nothing is said of where.
pub fn only_pronouns(clause: &Clause<'_>) -> bool {
    clause.places.is_empty()
        && !clause.objects.is_empty()
        && clause.objects.iter().all(|phrase| matches!(phrase.head, Head::Pronoun { .. }))
}

/// Whether a clause's verb puts things somewhere.
pub fn places(clause: &Clause<'_>) -> bool {
    clause.verbs.iter().any(|verb| verb.act == Act::Place)
}

//! What a clause leaves out because a neighbour says it.

use super::lexicon::Act;
use super::syntax::{self, Clause};

/// "wash and slice the apple": the first verb's object is said with the second.
pub(super) fn share_objects(clauses: &mut [Clause<'_>]) {
    share_with_a_row_of_verbs(clauses);
    for i in 0..clauses.len().saturating_sub(1) {
        let (front, back) = clauses.split_at_mut(i + 1);
        let (first, second) = (&mut front[i], &mut back[0]);
        // "turn the light off if it is on"
        if first.condition
            && first.objects.iter().any(|phrase| matches!(phrase.head, syntax::Head::Pronoun { .. }))
            && i == 0
        {
            first.objects.clone_from(&second.objects);
        }
        let needs_object = needs_object(first);
        let bare = is_bare(first);
        let forward = first.objects.len() == 1 && is_pronoun(&first.objects[0]) && i == 0;
        let said = !second.objects.is_empty() && !second.objects.iter().any(is_pronoun);
        if needs_object && (bare && i == 0 || forward) && said {
            let plural = second.objects.len() > 1;
            first.objects.clone_from(&second.objects);
            let head = syntax::Head::Pronoun { plural };
            second.objects = vec![syntax::Phrase::bare(head, if plural { "them" } else { "it" })];
        }
    }
}

/// "wash, slice and chill the tomato": what the last verb is said of holds for all.
fn share_with_a_row_of_verbs(clauses: &mut [Clause<'_>]) {
    let row = clauses.iter().take_while(|clause| needs_object(clause) && is_bare(clause)).count();
    let Some(last) = clauses.get(row).filter(|last| row > 1 && !last.objects.is_empty()) else { return };
    if last.objects.iter().any(is_pronoun) {
        return;
    }
    let objects = last.objects.clone();
    let plural = objects.len() > 1;
    let pronoun = syntax::Phrase::bare(syntax::Head::Pronoun { plural }, if plural { "them" } else { "it" });
    for clause in &mut clauses[1..=row] {
        clause.objects = vec![pronoun.clone()];
    }
    clauses[0].objects = objects;
}

fn needs_object(clause: &Clause<'_>) -> bool {
    clause.verbs.iter().any(|verb| {
        matches!(
            verb.act,
            Act::Set
                | Act::Heat
                | Act::Cook
                | Act::Chill
                | Act::Hold
                | Act::Examine
                | Act::Place
                | Act::Discard
        )
    })
}

/// Whether a clause is a verb and nothing else.
fn is_bare(clause: &Clause<'_>) -> bool {
    clause.objects.is_empty() && clause.places.is_empty() && clause.complement.is_empty()
}

fn is_pronoun(phrase: &syntax::Phrase) -> bool {
    matches!(phrase.head, syntax::Head::Pronoun { .. })
}

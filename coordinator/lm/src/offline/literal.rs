//! Whether a clause says itself what to do, or is left to the situations.

use super::lexicon::{Act, Lexicon};
use super::scene::Scene;
use super::syntax::Clause;
use super::{effect, inflect, syntax};

/// Whether a clause says too little by itself to stand against a situation: no verb, a weak one with nothing
/// it can be done to, "everything", or a turn of phrase.
pub fn is_weak(clause: &Clause<'_>, lexicon: &Lexicon) -> bool {
    let first = clause.verb_text.split(' ').next().unwrap_or_default();
    let weak = inflect::bases(first).iter().any(|(base, _)| lexicon.is_small("weak", &[base]));
    let plain =
        |phrase: &syntax::Phrase| matches!(phrase.head, syntax::Head::Noun(_) | syntax::Head::Named(_));
    let places = clause.verbs.iter().any(|verb| verb.act == Act::Place)
        && clause
            .objects
            .iter()
            .any(|phrase| plain(phrase) || matches!(phrase.head, syntax::Head::Pronoun { .. }))
        && clause.places.iter().any(|place| matches!(place.phrase.head, syntax::Head::Noun(_)))
        || takes_from_or_to_a_light(clause);
    let said: Vec<&str> = clause.words.iter().map(String::as_str).collect();
    let idiom = (0..said.len()).any(|at| lexicon.longest_small("idioms", &said[at..]).is_some());
    clause.verbs.is_empty() || idiom || weak && !clause.verb_text.contains(' ') && !places
}

/// "take the clock off the shelf", "see the keys under the lamp": of a thing it names, whatever a situation may be.
fn takes_from_or_to_a_light(clause: &Clause<'_>) -> bool {
    let named = clause.objects.iter().any(|phrase| matches!(phrase.head, syntax::Head::Noun(_)));
    let does = |act: Act| clause.verbs.iter().any(|verb| verb.act == act);
    let from = |place: &syntax::Place| {
        place.relation == syntax::Relation::From && matches!(place.phrase.head, syntax::Head::Noun(_))
    };
    let lamp = |place: &syntax::Place| effect::is_lamp(&place.phrase);
    named
        && (does(Act::Hold) && clause.places.iter().any(from)
            || does(Act::Examine) && clause.places.iter().any(lamp))
}

/// Whether a clause says what a thing of the scene shall be like: "have the potato chopped" is no recipe.
pub fn says_state(clause: &Clause<'_>, scene: &Scene<'_>) -> bool {
    let is_here = |phrase: &syntax::Phrase| match &phrase.head {
        syntax::Head::Noun(noun) => !noun.class && noun.kinds.iter().any(|kind| scene.has(kind)),
        syntax::Head::Named(_) => true,
        _ => false,
    };
    let full = |phrase: &syntax::Phrase| phrase.with.iter().any(|with| with.liquid().is_some());
    let wished = clause.verbs.is_empty() && clause.says_any(&["like", "love", "prefer", "want", "need"]);
    clause.wants()
        && (wished || clause.verbs.iter().any(|verb| matches!(verb.act, Act::Keep | Act::Place)))
        && (!clause.complement.is_empty()
            || clause.says_any(&["filled", "full"]) && clause.objects.iter().any(full))
        && !clause.objects.is_empty()
        && clause.objects.iter().all(is_here)
}

/// Whether a clause takes a thing of the scene to a place of the scene: "take the cloth to the bath" is no bath.
pub fn says_where(clause: &Clause<'_>, scene: &Scene<'_>) -> bool {
    let is_here = |phrase: &syntax::Phrase, affordance: &str| match &phrase.head {
        syntax::Head::Noun(noun) => noun.kinds.iter().any(|kind| scene.affords(kind, affordance)),
        syntax::Head::Named(_) | syntax::Head::Pronoun { .. } | syntax::Head::Slices => {
            affordance == "pickupable"
        }
        _ => false,
    };
    let moves = clause.verbs.iter().any(|verb| matches!(verb.act, Act::Place | Act::Hold | Act::Pour));
    let wished = clause.verbs.iter().all(|verb| verb.act == Act::Keep);
    let goal = |place: &syntax::Place| {
        matches!(place.relation, syntax::Relation::In | syntax::Relation::To)
            && is_here(&place.phrase, "receptacle")
    };
    let fills = |place: &syntax::Place| {
        matches!(place.relation, syntax::Relation::In | syntax::Relation::To)
            && is_here(&place.phrase, "canFillWithLiquid")
    };
    let liquid = clause.objects.iter().any(|phrase| phrase.liquid().is_some());
    let carried = |phrase: &syntax::Phrase| is_here(phrase, "pickupable");
    effect::untrue_place(clause, scene).is_some()
        || wished
            && clause.says_any(&["want", "like"])
            && !clause.verbs.is_empty()
            && clause.objects.len() > 1
            && clause.objects.iter().all(carried)
            && clause.places.iter().any(goal)
        || wished && liquid && clause.places.iter().any(fills)
        || wished
            && clause.verb_text == "have"
            && clause.objects.iter().all(carried)
            && !clause.objects.is_empty()
            && clause.places.iter().any(goal)
        || moves
            && (clause.objects.iter().any(|phrase| is_here(phrase, "pickupable"))
                && clause.places.iter().any(goal)
                || liquid && clause.places.iter().any(fills))
}

/// Whether a clause does something to a thing of the scene that it names.
pub fn is_concrete(clause: &Clause<'_>, lexicon: &Lexicon, scene: &Scene<'_>) -> bool {
    let is_here = |phrase: &syntax::Phrase| match &phrase.head {
        syntax::Head::Noun(noun) => !noun.class && noun.kinds.iter().any(|kind| scene.has(kind)),
        syntax::Head::Named(_) => true,
        _ => false,
    };
    !is_weak(clause, lexicon)
        && (clause.carries_it() && clause.places.iter().any(|place| is_here(&place.phrase))
            || clause.objects.iter().any(is_here))
}

/// Whether a clause can only mean going somewhere: "turn left" can, "turn on the lamp" cannot.
pub fn only_goes(clause: &Clause<'_>) -> bool {
    !clause.verbs.is_empty() && clause.verbs.iter().all(|verb| verb.act == Act::Go)
}

/// Whether a clause may well have no goal of its own: going somewhere, taking what is put down later.
pub fn is_mere_step(clause: &Clause<'_>) -> bool {
    clause.negated
        || only_goes(clause)
        || clause.verbs.iter().any(|verb| {
            matches!(verb.act, Act::Use | Act::Hold) || verb.act == Act::Place && clause.places.is_empty()
        })
}

/// Whether a clause tells something of nothing here, beside clauses that say what to do: "guests are coming".
pub fn only_tells(index: usize, clauses: &[Clause<'_>], lexicon: &Lexicon, scene: &Scene<'_>) -> bool {
    let clause = &clauses[index];
    let is_here = |phrase: &syntax::Phrase| match &phrase.head {
        syntax::Head::Noun(noun) => noun.kinds.iter().any(|kind| scene.has(kind)),
        syntax::Head::Named(_) | syntax::Head::Pronoun { .. } | syntax::Head::Everything => true,
        _ => false,
    };
    let says = |clause: &Clause<'_>| is_concrete(clause, lexicon, scene) && !clause.negated;
    let others = clauses.iter().enumerate().filter(|(other, clause)| *other != index && says(clause));
    clause.verbs.is_empty()
        && clause.complement.is_empty()
        && !clause.says_any(&["want", "need", "like", "love", "fancy", "should", "must"])
        && clause.says_any(&[
            "is", "are", "will", "am", "im", "coming", "was", "were", "has", "have", "be", "theyre",
        ])
        && !clause.objects.iter().any(is_here)
        && others.count() > 1
}

/// "… and put it away": what is only done where what is said before it is done.
pub fn goes_on_about_it(clause: &Clause<'_>) -> bool {
    let it = |phrase: &syntax::Phrase| matches!(phrase.head, syntax::Head::Pronoun { .. });
    clause.words.first().is_some_and(|word| word == "and")
        && !clause.objects.is_empty()
        && clause.objects.iter().all(it)
        && !clause.says_any(&["otherwise", "else"])
}

/// "lights out": whether a clause says of things of the scene what they shall be, and nothing else.
pub fn notes_a_state(clause: &Clause<'_>, scene: &Scene<'_>) -> bool {
    let is_here = |phrase: &syntax::Phrase| match &phrase.head {
        syntax::Head::Noun(noun) => noun.kinds.iter().any(|kind| scene.has(kind)),
        syntax::Head::Named(_) => true,
        _ => false,
    };
    let shuts = ["isToggled", "isOpen"];
    !clause.objects.is_empty()
        && clause.objects.iter().all(is_here)
        && clause.places.is_empty()
        && clause.unknown.is_empty()
        && (!clause.complement.is_empty()
            || clause.words.last().is_some_and(|word| ["out", "on", "off"].contains(&word.as_str())))
        && clause.complement.keys().all(|property| shuts.contains(&property.as_str()))
}

/// How many clauses but one say what to do to a thing of the scene that they name.
pub fn others_concrete(index: usize, clauses: &[Clause<'_>], lexicon: &Lexicon, scene: &Scene<'_>) -> usize {
    let concrete = |clause: &Clause<'_>| is_concrete(clause, lexicon, scene) || notes_a_state(clause, scene);
    clauses.iter().enumerate().filter(|(other, clause)| *other != index && concrete(clause)).count()
}

/// "going to sleep now", "heading out": of somebody's own going, not of a robot's.
pub fn tells_of_going(clause: &Clause<'_>) -> bool {
    let first =
        clause.words.iter().find(|word| ![",", "and", "so", "im", "i", "we", "am"].contains(&word.as_str()));
    only_goes(clause)
        && first.is_some_and(|word| ["going", "heading", "leaving", "off"].contains(&word.as_str()))
}

/// Whether a clause tells how something is and asks for nothing in words that nobody knows: not "the gate is to be
/// painted", nor "my bike is flat, pump it up".
pub fn tells_only(clause: &Clause<'_>) -> bool {
    let told = ["i", "im", "ive", "we", "is", "are", "was", "were", "has", "nobody", "everyone", "everybody"];
    let asked = ["want", "need", "like", "love", "prefer", "should", "must", "fancy", "to", "wants", "needs"];
    let done_to_it = clause.words.windows(2).any(|two| {
        ["it", "them"].contains(&two[1].as_str()) && !syntax::is_function_word(&two[0]) && two[0].len() > 2
    });
    clause.says_any(&told) && !clause.says_any(&asked) && !done_to_it
}

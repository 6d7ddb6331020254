//! Clauses without a verb: what is told, wished for or complained of.

use super::super::clause::is_denied;
use super::super::clause::is_going;
use super::super::lexicon::Act;
use super::super::mention::Spoken;
use super::super::scene::{Scene, is_in_state};
use super::super::syntax::{Clause, Head, Link, Phrase, Place, Relation};
use super::{Interpreter, speaks_of_it};

impl<'a> Interpreter<'_, 'a> {
    /// "the lamp should be off", "the cups are in the sink", "I need a fork".
    pub(super) fn without_verb(
        &mut self,
        index: usize,
        clause: &Clause<'a>,
        next: Option<&Clause<'a>>,
    ) -> Spoken {
        let mut spoken = Spoken::default();
        let liquid = !clause.objects.is_empty() && clause.objects.iter().all(|o| o.liquid().is_some());
        if !clause.complement.is_empty() {
            // "the lamp should be off" asks for it; "the lamp is off" only says so.
            let spoken_of_next = next.is_some_and(speaks_of_it);
            let at_rest = clause.complement.values().all(|value| *value == crate::offline::no());
            let dirty = clause.complement.get("isDirty") == Some(&crate::offline::yes());
            // "the lettuce, all muddy": nobody wishes for that.
            if let Some(mended) = mended(clause).filter(|_| dirty && !wishes(clause)) {
                let only = spoken_of_next;
                spoken = if only { self.only_mention(clause) } else { self.complaint(clause, &mended) };
            } else if clause.wants() || !spoken_of_next && self.is_untrue(clause) {
                spoken = self.keep(clause);
            } else if at_rest && !spoken_of_next && index > 0 && self.is_told_of_things(clause) {
                // "… and the stove is off": whether it is so already or not, it shall be.
                spoken = self.keep(clause);
            } else if clause.link == Link::While || next.is_some_and(speaks_of_it) {
                spoken = self.only_mention(clause);
            } else if let Some(mended) = mended(clause) {
                spoken = self.complaint(clause, &mended);
            } else {
                self.discourse.problem(format!("it is not said what to do about \"{}\"", clause.text), 0.3);
            }
        } else if liquid
            && clause.places.iter().any(|place| self.runs_in(place))
            && clause.unknown.iter().all(|w| is_going(w))
        {
            let fill = self.discourse.lexicon.verbs("fill").into_iter().find(|(_, p, _)| p.is_empty());
            spoken = fill.map(|(_, _, verb)| self.fill(clause, verb)).unwrap_or_default();
        } else if !next.is_some_and(speaks_of_it) && untrue_place(clause, self.discourse.scene).is_some() {
            // "at the end all the cups are in the sink": it is told as it shall be.
            let (goal, _, at) = self.sort_places(clause);
            spoken = goal.map(|goal| self.put(clause, &at, &goal)).unwrap_or_default();
        } else if next.is_some_and(speaks_of_it) && clause.unknown.iter().all(|word| is_need(word)) {
            spoken = self.only_mention(clause);
        } else if clause.unknown.is_empty() && clause.says_any(&["want", "need", "like", "love", "fancy"]) {
            spoken = self.bring(clause);
        } else if ["stay", "stays"].iter().any(|word| clause.text.ends_with(word))
            && !clause.objects.is_empty()
            && matches!(clause.unknown.as_slice(), [word] if ["stay", "stays"].contains(&word.as_str()))
        {
            // "the forks stay": where they are.
            self.discourse.assume(format!("\"{}\" asks for nothing new", clause.text), 0.95);
            self.spoke = true;
            let all = clause.objects.iter().any(|phrase| phrase.head == Head::Everything);
            spoken = if all { Spoken::default() } else { self.only_mention(clause) };
        } else if clause.is_remark() && (next.is_some() || index > 0) {
            // Why something is wanted is no order.
            self.discourse.assume(format!("took \"{}\" as a remark", clause.text), 0.9);
            spoken = self.only_mention(clause);
            self.spoke = next.is_some_and(speaks_of_it);
        } else if !clause.objects.is_empty()
            && clause.unknown.is_empty()
            && clause.places.is_empty()
            && next.is_some_and(|next| !next.verbs.is_empty())
        {
            // "The dishes: wash the plate and the cup."
            self.discourse.assume(format!("took \"{}\" as what is spoken of", clause.text), 0.9);
            spoken = self.only_mention(clause);
        } else if !clause.objects.is_empty() || !clause.unknown.is_empty() {
            self.discourse.problem(format!("I do not know what to do for \"{}\"", clause.text), 0.25);
        }
        spoken
    }

    fn is_told_of_things(&self, clause: &Clause<'a>) -> bool {
        let is_here = |phrase: &Phrase| {
            matches!(&phrase.head, Head::Noun(noun)
                if noun.kinds.iter().any(|kind| self.discourse.scene.has(kind)))
        };
        !clause.says_any(&["left", "still", "if", "because", "since"])
            && !clause.objects.is_empty()
            && clause.objects.iter().all(is_here)
    }

    /// "the pot should not stay on the counter", "don't leave the pan on the stove": what is to go from where.
    pub(super) fn not_there(&self, clause: &Clause<'a>) -> Option<Clause<'a>> {
        const STAYS: [&str; 14] = [
            "stay", "stays", "belong", "belongs", "be", "remain", "stand", "standing", "lie", "lying",
            "leave", "left", "sit", "go",
        ];
        let stays = clause.verbs.iter().all(|verb| matches!(verb.act, Act::Keep | Act::Place | Act::Go));
        let denied = clause.negated && clause.verb_text.starts_with("leav")
            || !clause.negated && (is_denied(&clause.words) || clause.says_any(&["no"]));
        let place = clause.places.iter().position(|place| place.relation == Relation::In)?;
        let fits = denied
            && stays
            && clause.says_any(&STAYS)
            && clause.complement.is_empty()
            && !clause.objects.is_empty()
            && clause.objects.iter().all(|phrase| self.is_movable(phrase));
        fits.then(|| {
            let mut elsewhere = clause.clone();
            elsewhere.negated = false;
            elsewhere.places[place].relation = Relation::From;
            elsewhere
        })
    }

    /// What must not stay where it is goes where such things are kept, unless the next clause says where.
    pub(super) fn put_elsewhere(&mut self, clause: &Clause<'a>, next: Option<&Clause<'a>>) -> Spoken {
        let goes_on = next.is_some_and(|next| {
            speaks_of_it(next)
                && next
                    .verbs
                    .iter()
                    .any(|v| matches!(v.act, Act::Place | Act::Store | Act::Discard | Act::Hold))
        });
        let store = self.discourse.lexicon.verbs("store").into_iter().find(|(_, p, _)| p.is_empty());
        match store {
            Some((_, _, verb)) if !goes_on => {
                self.discourse.assume(format!("\"{}\": it is put away", clause.text), 0.9);
                self.place(clause, verb, next)
            }
            _ => self.only_mention(clause),
        }
    }

    /// Whether what a clause tells of things here is not so now: then it tells how it shall be.
    fn is_untrue(&self, clause: &Clause<'a>) -> bool {
        let scene = self.discourse.scene;
        let is_not_so = |kind: &str| {
            let switched = clause.complement.contains_key("isToggled");
            let switch = self.discourse.lexicon.control(kind).filter(|_| switched);
            let objects = scene.of_kind(switch.unwrap_or(kind));
            objects.iter().any(|object| !object.parents.is_empty() || !object.states.is_empty())
                && !objects.iter().any(|object| is_in_state(object, &clause.complement))
        };
        let untrue = |phrase: &Phrase| match &phrase.head {
            Head::Noun(noun) => {
                noun.kinds.iter().find(|kind| scene.has(kind)).is_some_and(|kind| is_not_so(kind))
            }
            Head::Pronoun { .. } => {
                let last = self.discourse.spoken.iter().rev().find(|spoken| !spoken.objects.is_empty());
                last.is_some_and(|s| s.objects.iter().all(|&e| is_not_so(self.discourse.entities[e].kind())))
            }
            _ => false,
        };
        !clause.says_any(&["left", "still", "if", "because", "since"])
            && !clause.objects.is_empty()
            && clause.objects.iter().all(untrue)
    }

    /// "the pan is dirty", "someone left the fridge open": to be mended.
    pub(super) fn complaint(&mut self, clause: &Clause<'a>, mended: &Clause<'a>) -> Spoken {
        let text = format!("\"{}\" is taken as a complaint", clause.text);
        self.discourse.assume(text, 0.8);
        self.keep(mended)
    }

    /// "the pan is dirty, wash it": only says what is spoken of.
    pub(super) fn only_mention(&mut self, clause: &Clause<'a>) -> Spoken {
        let mut objects = Vec::new();
        let scene = self.discourse.scene;
        let is_here = |phrase: &&Phrase| match &phrase.head {
            Head::Noun(noun) => noun.kinds.iter().any(|kind| scene.has(kind)),
            Head::Named(_) => true,
            _ => false,
        };
        for phrase in clause.objects.iter().filter(is_here) {
            objects.extend(self.discourse.mention(phrase, &clause.places, None));
        }
        self.spoke = true;
        Spoken { objects, ..Spoken::default() }
    }

    /// "I need a fork", "I want a cold apple": to be brought, or to be so.
    fn bring(&mut self, clause: &Clause<'a>) -> Spoken {
        let objects = self.objects(clause, &clause.places, Some("pickupable"));
        if objects.iter().all(|&entity| self.discourse.entities[entity].asked.is_empty()) {
            self.take(&objects);
        }
        Spoken { objects, ..Spoken::default() }
    }
}

/// "the cups are in the sink", where they are not: the place that is told of them.
pub(in crate::offline) fn untrue_place<'c>(clause: &'c Clause<'_>, scene: &Scene<'_>) -> Option<&'c Place> {
    let told = clause.says_any(&["is", "are"]) && clause.verbs.is_empty() && clause.unknown.is_empty();
    let place = clause.places.iter().find(|place| place.relation == Relation::In).filter(|_| told)?;
    let Head::Noun(home) = &place.phrase.head else { return None };
    // "the towels are on the floor" is a complaint.
    if home.kinds.iter().any(|kind| kind == "Floor") {
        return None;
    }
    let elsewhere = |phrase: &Phrase| match &phrase.head {
        Head::Noun(noun) => {
            let mut here = noun.kinds.iter().filter(|kind| scene.affords(kind, "pickupable")).peekable();
            here.peek().is_some()
                && here.any(|kind| {
                    scene.of_kind(kind).iter().any(|object| {
                        !object.parents.is_empty()
                            && !scene.lies_in(object, &|parent| home.kinds.contains(&parent.kind))
                    })
                })
        }
        _ => false,
    };
    let is_here = |phrase: &Phrase| matches!(&phrase.head, Head::Noun(noun) if noun.kinds.iter().any(|kind| scene.affords(kind, "pickupable")));
    let takes = home.kinds.iter().any(|kind| scene.affords(kind, "receptacle"));
    let listed = clause.objects.len() > 1 && clause.objects.iter().all(is_here);
    (takes
        && !clause.objects.is_empty()
        && (clause.objects.iter().all(elsewhere) || listed && clause.objects.iter().any(elsewhere)))
    .then_some(place)
}

/// "the plate should be dirty"
fn wishes(clause: &Clause<'_>) -> bool {
    clause.says_any(&["should", "must", "shall", "be", "want", "need", "needs", "like"])
}

/// "the pan needs to be washed"
fn is_need(word: &str) -> bool {
    ["need", "needs", "has", "have", "want", "wants", "ought", "had"].contains(&word)
}

/// "somebody left the lamp on": tells what was done, and asks for nothing by its words.
pub(super) fn left_so<'c, 'a>(clause: &'c Clause<'a>) -> Option<&'c Clause<'a>> {
    (clause.verb_text == "left" && !clause.complement.is_empty() && !clause.wants()).then_some(clause)
}

/// "someone left the tap running": it is to be switched off.
pub(super) fn left_running<'a>(clause: &Clause<'a>) -> Option<Clause<'a>> {
    let left = clause.verb_text.split(' ').next() == Some("left");
    let on = clause.verbs.iter().any(|verb| verb.set.get("isToggled") == Some(&crate::offline::yes()));
    (left && on && clause.complement.is_empty() && !clause.wants()).then(|| {
        let mut mended = clause.clone();
        mended.complement.insert("isToggled".to_owned(), crate::offline::no());
        mended
    })
}

/// What a complaint asks for: what is dirty is to be clean, what was left open is to be closed.
pub(super) fn mended<'a>(clause: &Clause<'a>) -> Option<Clause<'a>> {
    let complaint =
        clause.says_any(&["left", "still", "again", "always"]) || clause.complement.contains_key("isDirty");
    let bad = clause.complement.values().all(|value| *value == crate::offline::yes());
    (complaint && bad).then(|| {
        let mut mended = clause.clone();
        for value in mended.complement.values_mut() {
            *value = crate::offline::opposite(value);
        }
        mended
    })
}

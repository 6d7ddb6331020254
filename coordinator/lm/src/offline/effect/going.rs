//! Going somewhere: no goal of its own, but it says what is spoken of next, or where what is carried goes.

use super::Interpreter;
use crate::offline::mention::Spoken;
use crate::offline::syntax::{Clause, Head, Phrase, Place, Relation};

impl<'a> Interpreter<'_, 'a> {
    /// "wash the fork and return to the counter" says in the end where the fork goes.
    fn returns_it(&self, clause: &Clause<'a>, next: Option<&Clause<'a>>) -> Option<Clause<'a>> {
        let last = self.discourse.spoken.last()?;
        let carried =
            |&e: &usize| self.discourse.scene.affords(self.discourse.entities[e].kind(), "pickupable");
        let returns = clause.verb_text.starts_with("return") && next.is_none();
        (returns && !last.objects.is_empty() && last.objects.iter().all(carried)).then(|| {
            let plural = last.objects.len() > 1;
            let it = Phrase::bare(Head::Pronoun { plural }, if plural { "them" } else { "it" });
            let mut back = clause.clone();
            // "return to" takes what it goes to as its object.
            let named = std::mem::replace(&mut back.objects, vec![it]).into_iter();
            back.places.splice(0..0, named.map(|phrase| Place::new(Relation::To, "to", phrase)));
            back.places.iter_mut().take(1).for_each(|place| place.relation = Relation::To);
            back
        })
    }

    /// "go to the fridge and open it": going is no goal, but "it" is the fridge.
    pub(super) fn go(&mut self, clause: &Clause<'a>, next: Option<&Clause<'a>>) -> Spoken {
        if let Some(back) = self.returns_it(clause, next) {
            let (goal, _, at) = self.sort_places(&back);
            return goal.map(|goal| self.put(&back, &at, &goal)).unwrap_or_default();
        }
        let is_pronoun = |phrase: &Phrase| matches!(phrase.head, Head::Pronoun { .. });
        let Some(wants) = next
            .filter(|next| next.objects.iter().any(is_pronoun))
            .and_then(|next| next.verbs.iter().find_map(|verb| verb.wants.as_deref()))
            .filter(|wants| ["openable", "toggleable"].contains(wants))
        else {
            let reached = self.receptacles_spoken_of(clause);
            return Spoken { reached, ..Spoken::default() };
        };
        let scene = self.discourse.scene;
        let fits = |phrase: &Phrase| match &phrase.head {
            Head::Noun(noun) => noun.kinds.iter().any(|kind| scene.affords(kind, wants)),
            Head::Named(_) => true,
            _ => false,
        };
        let target = clause.places.iter().map(|place| &place.phrase).chain(&clause.objects).find(|p| fits(p));
        let places =
            target.map(|phrase| self.discourse.mention(phrase, &[], Some(wants))).unwrap_or_default();
        Spoken { places, ..Spoken::default() }
    }
}

//! Several things of the scene at once: a count of them, all of them, those of a class.

use super::{Discourse, Which};
use crate::offline::lexicon::Noun;
use crate::offline::syntax::{Head, Phrase, Place, Quantity};

impl Discourse<'_> {
    /// So many different objects: of one type if there are enough of it.
    pub(super) fn several(
        &mut self,
        kinds: &[String],
        count: usize,
        phrase: &Phrase,
        at: &[Place],
    ) -> Vec<usize> {
        let there: usize = kinds.iter().map(|kind| self.scene.of_kind(kind).len()).sum();
        // "two slices of bread" may be of one loaf.
        let sliced = phrase.states.contains_key("isSliced");
        let count = if sliced && there > 0 { count.min(there) } else { count.min(64) };
        let enough = kinds.iter().position(|kind| self.scene.of_kind(kind).len() >= count);
        let mut order = kinds.to_vec();
        match enough {
            Some(at) => order.swap(0, at),
            None if sliced => {}
            None => {
                if there < count
                    && let Some(alike) = self.alike(kinds, count)
                {
                    let text = format!("there are not {count} of \"{}\" here; {alike} is taken", phrase.text);
                    self.assume(text, 0.6);
                    return (0..count)
                        .map(|_| self.add(vec![alike.clone()], Which::Any, &phrase.text))
                        .collect();
                }
                if there < count {
                    self.problem(
                        format!("there are not {count} of \"{}\" here, only {there}", phrase.text),
                        0.45,
                    );
                }
                return self.spread(kinds, count.min(there), phrase);
            }
        }
        let selected = self.selected(&order[..1], phrase, at);
        if selected.len() >= count {
            let names: Vec<(String, String)> =
                selected.iter().take(count).map(|o| (o.kind.clone(), o.name.clone())).collect();
            return names
                .into_iter()
                .map(|(kind, name)| self.add(vec![kind], Which::Named(name), &phrase.text))
                .collect();
        }
        (0..count).map(|_| self.add(order.clone(), Which::Any, &phrase.text)).collect()
    }

    /// A type that is called by the name of one of the types, where there are so many of it.
    fn alike(&self, kinds: &[String], count: usize) -> Option<String> {
        let others = kinds.iter().flat_map(|kind| self.lexicon.likes(kind));
        others
            .filter(|kind| !kinds.contains(kind))
            .find(|kind| self.scene.of_kind(kind).len() >= count)
            .cloned()
    }

    /// Every object of the types that is picked out.
    pub(super) fn every(&mut self, kinds: &[String], phrase: &Phrase, at: &[Place]) -> Vec<usize> {
        let mut found = Vec::new();
        let except = self.exceptions(&phrase.except);
        for kind in kinds {
            let all = self.scene.of_kind(kind);
            let selected = self.selected(std::slice::from_ref(kind), phrase, at);
            let spared: usize = phrase.except.iter().filter_map(|left| spared(left, kind)).sum();
            if spared > 0 {
                for _ in spared..all.len() {
                    found.push(self.add(vec![kind.clone()], Which::Any, &phrase.text));
                }
            } else if all.len() == 1 {
                found.push(self.add(vec![kind.clone()], Which::Any, &phrase.text));
            } else if selected.is_empty() && except.is_empty() {
                found.push(self.add(vec![kind.clone()], Which::All, &phrase.text));
            } else {
                let chosen = if selected.is_empty() { all.to_vec() } else { selected };
                for object in chosen {
                    if !except.contains(&object.name) && !except.contains(&object.kind) {
                        found.push(self.add(
                            vec![kind.clone()],
                            Which::Named(object.name.clone()),
                            &phrase.text,
                        ));
                    }
                }
            }
        }
        found
    }

    /// Members of a class: all of them for a plural, so many of different types for a number.
    pub(super) fn class(
        &mut self,
        noun: &Noun,
        kinds: &[String],
        phrase: &Phrase,
        at: &[Place],
    ) -> Vec<usize> {
        let uncountable =
            self.lexicon.is_small("uncountable", &[&crate::offline::lexicon::squash(&noun.word)]);
        let found = match phrase.quantity {
            Quantity::Count(count) => {
                let there: usize = kinds.iter().map(|kind| self.scene.of_kind(kind).len()).sum();
                if there < count {
                    self.problem(
                        format!("there are not {count} of \"{}\" here, only {there}", phrase.text),
                        0.45,
                    );
                }
                self.spread(kinds, count.min(there), phrase)
            }
            Quantity::One if !uncountable || phrase.indefinite || phrase.states.contains_key("isSliced") => {
                vec![self.one(kinds.to_vec(), phrase, at)]
            }
            _ => self.every(&self.kinds_there(kinds, phrase, at), phrase, at),
        };
        let names: Vec<&str> = found.iter().map(|&e| self.entities[e].kind()).collect();
        let text = format!("\"{}\" here means {}", phrase.text, names.join(", "));
        self.assume(text, 0.97);
        found
    }

    /// "slice the lettuce and the tomato, and put both vegetables in the bowl", "all the sliced food", "all ingredients":
    /// those of the class that were spoken of.
    pub(super) fn members_spoken_of(&self, noun: &Noun, phrase: &Phrase) -> Option<Vec<usize>> {
        let is_member = |&entity: &usize| noun.kinds.iter().any(|kind| kind == self.entities[entity].kind());
        let mut found: Vec<usize> = self.spoken.iter().flat_map(|spoken| &spoken.objects).copied().collect();
        found.retain(is_member);
        let sliced = phrase.states.contains_key("isSliced");
        if sliced {
            found.retain(|&entity| self.entities[entity].asked.contains_key("isSliced"));
        }
        found.sort_unstable();
        found.dedup();
        let meant = match phrase.quantity {
            Quantity::Count(count) => phrase.text.starts_with("both") && found.len() == count,
            Quantity::One => false,
            _ => (sliced || noun.word.starts_with("ingredient")) && found.len() > 1,
        };
        meant.then_some(found)
    }

    /// "the rest of the dishes": without those spoken of; where all were, without those spoken of last.
    pub(super) fn without_those_spoken_of(&self, kinds: Vec<String>) -> Vec<String> {
        let left = |spoken: &dyn Fn(&String) -> bool| -> Vec<String> {
            kinds.iter().filter(|kind| !spoken(kind)).cloned().collect()
        };
        let rest = left(&|kind| self.entities.iter().any(|entity| entity.kind() == kind.as_str()));
        if !rest.is_empty() {
            return rest;
        }
        let fewer = |objects: &Vec<usize>| !objects.is_empty() && objects.len() < kinds.len();
        let last = self.spoken.iter().rev().map(|spoken| &spoken.objects).find(|objects| fewer(objects));
        let Some(last) = last else { return rest };
        left(&|kind| last.iter().any(|&entity| self.entities[entity].kind() == kind.as_str()))
    }

    /// "all dishes on the counter": of the types those that are there, if any is.
    fn kinds_there(&self, kinds: &[String], phrase: &Phrase, at: &[Place]) -> Vec<String> {
        let places: Vec<&Place> = phrase.at.iter().chain(at).collect();
        let is_there = |kind: &&String| {
            let objects = self.scene.of_kind(kind);
            objects.iter().any(|object| places.iter().all(|place| self.is_at(object, place)))
        };
        let there: Vec<String> = kinds.iter().filter(is_there).cloned().collect();
        if there.is_empty() { kinds.to_vec() } else { there }
    }

    /// So many objects, of as many types as possible.
    pub(super) fn spread(&mut self, kinds: &[String], count: usize, phrase: &Phrase) -> Vec<usize> {
        let mut found = Vec::new();
        let mut round = 0;
        while found.len() < count && round < 64 {
            for kind in kinds {
                if found.len() < count && self.scene.of_kind(kind).len() > round {
                    found.push(self.add(vec![kind.clone()], Which::Any, &phrase.text));
                }
            }
            round += 1;
        }
        found
    }
}

/// "all the cabinets except one", "all the vases but two vases": how many of a type are left out, whichever.
pub(super) fn spared(left_out: &Phrase, kind: &str) -> Option<usize> {
    match (&left_out.head, left_out.quantity) {
        (Head::Pronoun { plural: false }, _) if left_out.text.starts_with("one") => Some(1),
        (Head::Noun(noun), Quantity::Count(count)) if noun.kinds.iter().any(|of| of == kind) => Some(count),
        (Head::Noun(noun), Quantity::One)
            if left_out.text.starts_with("one ") && noun.kinds.iter().any(|of| of == kind) =>
        {
            Some(1)
        }
        _ => None,
    }
}

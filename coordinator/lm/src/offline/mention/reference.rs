//! Words that stand for what was spoken of: pronouns, "the slices", "everything", "the rest".

use std::collections::BTreeSet;

use super::super::syntax::{Phrase, Place, Quantity};
use super::{Discourse, Which};

impl Discourse<'_> {
    /// "the slices": of all that was sliced last, else of what could be.
    pub(super) fn slices(&mut self, plural: bool) -> Vec<usize> {
        let sliced = |&entity: &usize| self.entities[entity].asked.contains_key("isSliced");
        if plural {
            // "slice the apple, slice the bread; put every slice in the bowl": of all since something was put away.
            let since = self.spoken.iter().rev().take_while(|spoken| !spoken.placed);
            let mut all: Vec<usize> =
                since.flat_map(|spoken| spoken.objects.iter().copied().filter(sliced)).collect();
            all.sort_unstable();
            all.dedup();
            if all.len() > 1 {
                return all;
            }
        }
        let last = self.spoken.iter().rev().find(|spoken| spoken.objects.iter().any(sliced));
        if let Some(spoken) = last.filter(|spoken| plural && spoken.objects.len() > 1) {
            return spoken.objects.iter().copied().filter(sliced).collect();
        }
        let last = (0..self.entities.len())
            .rev()
            .find(|&e| self.entities[e].kinds.iter().any(|kind| self.scene.affords(kind, "sliceable")));
        if last.is_none() {
            self.problem("it is not said what the slices are of".to_owned(), 0.3);
        }
        last.into_iter().collect()
    }

    pub(super) fn everything(&mut self, phrase: &Phrase, at: &[Place], wants: Option<&str>) -> Vec<usize> {
        let before = if ["everything", "all"].contains(&phrase.text.as_str()) && at.is_empty() {
            self.gathered(wants)
        } else {
            Vec::new()
        };
        if before.len() > 1 && wants == Some("pickupable") {
            return before;
        }
        let fixed = wants.filter(|wants| ["openable", "toggleable"].contains(wants));
        let places: Vec<&Place> = phrase.at.iter().chain(at).collect();
        let except = self.exceptions(&phrase.except);
        let mentioned: BTreeSet<String> = if phrase.other {
            self.entities.iter().map(|e| e.kind().to_owned()).collect()
        } else {
            BTreeSet::new()
        };
        if places.is_empty() && !phrase.other {
            // Who names exceptions has thought of everything.
            let factor = if except.is_empty() { 0.45 } else { 0.7 };
            match fixed {
                Some(wants) => self.assume(format!("\"{}\" means all that is {wants}", phrase.text), 0.8),
                None => {
                    let text = format!("\"{}\" means every single thing that can be carried", phrase.text);
                    self.assume(text, factor);
                }
            }
        }
        let chosen: Vec<(String, String)> = self
            .scene
            .kinds()
            .flat_map(|kind| self.scene.of_kind(kind))
            .filter(|object| object.affordances.iter().any(|a| a == fixed.unwrap_or("pickupable")))
            .filter(|object| places.iter().all(|place| self.is_at(object, place)))
            .filter(|object| !except.contains(&object.kind) && !except.contains(&object.name))
            .filter(|object| !mentioned.contains(&object.kind))
            .map(|object| (object.kind.clone(), object.name.clone()))
            .collect();
        if chosen.is_empty() {
            self.problem(format!("there is nothing that \"{}\" could mean", phrase.text), 0.3);
        }
        chosen
            .into_iter()
            .map(|(kind, name)| self.add(vec![kind], Which::Named(name), &phrase.text))
            .collect()
    }

    /// "the former", "the latter two": the first or the last of those spoken of together.
    pub(super) fn some_of_these(&mut self, phrase: &Phrase, first: bool) -> Vec<usize> {
        let count = if let Quantity::Count(count) = phrase.quantity { count } else { 1 };
        let nearest =
            self.spoken.iter().rev().map(|spoken| &spoken.objects).find(|group| group.len() > count);
        // "the former two … the latter": of the same.
        let whole = |part: &Vec<usize>| {
            let groups = self.spoken.iter().map(|spoken| &spoken.objects);
            groups.max_by_key(|group| usize::from(part.iter().all(|e| group.contains(e))) * group.len())
        };
        let group = nearest.and_then(whole);
        let gathered = self.gathered(None);
        let group = group.unwrap_or(&gathered);
        if group.len() <= count {
            self.problem("it is not said which of them is meant".to_owned(), 0.3);
            return Vec::new();
        }
        if first { group[..count].to_vec() } else { group[group.len() - count..].to_vec() }
    }

    /// "all of them", "each": what was spoken of since something was put somewhere, or in the clause that put it.
    pub(super) fn all_of_them(&mut self, wants: Option<&str>) -> Vec<usize> {
        let found = self.gathered(wants);
        if found.len() > 1 { found } else { self.pronoun(true, wants) }
    }

    /// "one of them": one that the verb can be done to.
    pub(super) fn one_of_them(&mut self, wants: Option<&str>) -> Option<usize> {
        let all = self.all_of_them(wants);
        let able = |&&e: &&usize| wants.is_none_or(|wants| self.affords(self.entities[e].kind(), wants));
        all.iter().find(able).or(all.first()).copied()
    }

    /// What was spoken of since something was put somewhere, or in the clause that put it.
    fn gathered(&self, wants: Option<&str>) -> Vec<usize> {
        let mut found: Vec<usize> = Vec::new();
        for spoken in self.spoken.iter().rev() {
            if spoken.placed && !found.is_empty() {
                break;
            }
            let able = |&entity: &usize| {
                wants.is_none_or(|wants| self.affords(self.entities[entity].kind(), wants))
                    && !found.contains(&entity)
            };
            let able: Vec<usize> = spoken.objects.iter().copied().filter(able).collect();
            found.extend(able);
        }
        found.sort_unstable();
        found
    }

    /// "put it all on the table": whatever was spoken of and can be carried.
    pub(super) fn all_of_it(&mut self, wants: Option<&str>) -> Vec<usize> {
        let last = self.spoken.iter().rev().find(|spoken| !spoken.objects.is_empty());
        // "cut the tomato and put all of it on the plate": its slices.
        if let Some([only]) = last.map(|spoken| spoken.objects.as_slice())
            && self.entities[*only].asked.contains_key("isSliced")
        {
            return self.slices(true);
        }
        let groups: Vec<&[usize]> = match last {
            Some(spoken) if spoken.objects.len() > 1 => vec![&spoken.objects],
            _ => self.spoken.iter().map(|spoken| spoken.objects.as_slice()).collect(),
        };
        let able =
            |entity: &usize| wants.is_none_or(|wants| self.affords(self.entities[*entity].kind(), wants));
        let mut found: Vec<usize> = groups.concat().into_iter().filter(able).collect();
        found.sort_unstable();
        found.dedup();
        if found.is_empty() {
            self.problem("it is not said what \"it\" is".to_owned(), 0.3);
        }
        found
    }

    /// "all three", "the other two": so many of those spoken of last, without those spoken of since by themselves.
    pub(super) fn some_of_them(&mut self, phrase: &Phrase, wants: Option<&str>) -> Vec<usize> {
        let able = |this: &Self, entity: usize| {
            wants.is_none_or(|wants| this.affords(this.entities[entity].kind(), wants))
        };
        let wanted = match phrase.quantity {
            Quantity::Count(count) => count,
            _ => usize::MAX,
        };
        let mut found: Vec<usize> = Vec::new();
        let mut singled: BTreeSet<usize> = BTreeSet::new();
        for spoken in self.spoken.iter().rev() {
            let group: Vec<usize> =
                spoken.objects.iter().copied().filter(|&e| !found.contains(&e) && able(self, e)).collect();
            if phrase.other && group.len() < 2 {
                singled.extend(group);
                continue;
            }
            found.extend(group.into_iter().filter(|entity| !singled.contains(entity)));
            if found.len() >= wanted || phrase.other && !found.is_empty() {
                break;
            }
        }
        found.truncate(wanted);
        found.sort_unstable();
        // "put the fork in the bowl and move both of them to the sink": the bowl, with what is in it.
        let placed = self.spoken.last().filter(|last| last.placed && wanted == 2 && found.len() < 2);
        if let Some(place) = placed.and_then(|last| last.places.first().copied())
            && able(self, place)
        {
            return vec![place];
        }
        if found.is_empty() || wanted != usize::MAX && found.len() < wanted {
            self.problem(format!("it is not said what \"{}\" are", phrase.text), 0.3);
        }
        found
    }

    /// "there": where something was put last.
    pub(super) fn last_place(&self) -> Option<usize> {
        match self.spoken.iter().rev().find(|spoken| spoken.placed)?.places.as_slice() {
            [place] => Some(*place),
            _ => None,
        }
    }

    pub(super) fn pronoun(&mut self, plural: bool, wants: Option<&str>) -> Vec<usize> {
        let fits = |this: &Self, group: &[usize]| {
            !group.is_empty()
                && wants.is_none_or(|wants| {
                    group.iter().all(|&e| this.entities[e].kinds.iter().any(|kind| this.affords(kind, wants)))
                })
        };
        let last = self.spoken.iter().rev().find(|s| !s.objects.is_empty() || !s.places.is_empty());
        // "put the fork in the cup and put it in the sink": the cup goes, with the fork in it.
        if let Some(spoken) = last
            && spoken.placed
            && wants == Some("pickupable")
            && !plural
            && fits(self, &spoken.places)
        {
            return spoken.places.clone();
        }
        // "put the pen in the cup and put them on the desk": again the cup, with what is in it.
        if let Some(spoken) = last
            && spoken.placed
            && plural
            && wants == Some("pickupable")
            && spoken.objects.len() == 1
            && fits(self, &spoken.places)
        {
            return spoken.places.clone();
        }
        // "cut the bread and the tomato with the knife and wash it": the tool, where several things were cut.
        if let Some(spoken) = last.filter(|spoken| !plural && spoken.objects.len() > 1)
            && spoken.objects.iter().any(|&e| self.entities[e].text != self.entities[spoken.objects[0]].text)
            && let Some(tool) = self.tool_in_use()
            && fits(self, &[tool])
        {
            return vec![tool];
        }
        if plural {
            let mut all: Vec<usize> = Vec::new();
            for spoken in self.spoken.iter().rev() {
                for &object in &spoken.objects {
                    if fits(self, &[object]) && !all.contains(&object) {
                        all.push(object);
                    }
                }
                let many = all.len() > 1 || all.iter().any(|&e| self.entities[e].which == Which::All);
                if many {
                    break;
                }
            }
            all.sort_unstable();
            // "put them in the sink, turn on the tap and wash them": not the tap.
            let carried = |e: &usize| self.affords(self.entities[*e].kind(), "pickupable");
            if wants.is_none() && all.iter().filter(|e| carried(e)).count() > 1 {
                all.retain(carried);
            }
            if !all.is_empty() {
                return all;
            }
            // What was only used or stood by.
            let used = self.spoken.iter().rev().map(|spoken| &spoken.reached).find(|used| used.len() > 1);
            if let Some(used) = used.filter(|used| fits(self, used)) {
                return used.clone();
            }
        }
        for spoken in self.spoken.iter().rev() {
            let reached = if matches!(wants, Some("receptacle" | "openable" | "toggleable")) {
                spoken.reached.as_slice()
            } else {
                &[]
            };
            // "put the fork by the plate and the egg on it": on the plate, whatever both stand on.
            let unsaid = spoken.places.iter().all(|&place| self.entities[place].noun.is_empty());
            let [second, third] = if unsaid && spoken.placed && wants == Some("receptacle") {
                [reached, spoken.places.as_slice()]
            } else {
                [spoken.places.as_slice(), reached]
            };
            for group in [spoken.objects.as_slice(), second, third] {
                if fits(self, group) {
                    return group.to_vec();
                }
            }
        }
        // "put the mug and the laptop on the desk and open it": what of them can be opened.
        let of_them = self.spoken.iter().rev().find_map(|spoken| {
            let named = spoken.objects.iter().chain(&spoken.places).chain(&spoken.reached);
            let able = named.filter(|&&entity| wants.is_some_and(|_| fits(self, &[entity])));
            // Of a book and a laptop it is the laptop that one opens.
            let devices = |&&entity: &&usize| {
                let kind = self.entities[entity].kind();
                usize::from(self.affords(kind, "openable")) + usize::from(self.affords(kind, "toggleable"))
            };
            able.max_by_key(devices).copied()
        });
        if let Some(entity) = of_them.filter(|_| !plural) {
            return vec![entity];
        }
        let word = if plural { "them" } else { "it" };
        self.problem(format!("it is not said what \"{word}\" is"), 0.3);
        Vec::new()
    }

    /// What was used last and was named for nothing else: "cut the bread with the knife", "take the knife and cut the
    /// bread with it".
    fn tool_in_use(&self) -> Option<usize> {
        let mut clauses =
            self.spoken.iter().rev().skip_while(|s| s.objects.is_empty() && s.places.is_empty());
        let used = &clauses.next()?.reached;
        let [tool] = (if used.is_empty() { &clauses.next()?.reached } else { used }).as_slice() else {
            return None;
        };
        let kind = self.entities[*tool].kind();
        (self.affords(kind, "pickupable") && !self.affords(kind, "receptacle")).then_some(*tool)
    }
}

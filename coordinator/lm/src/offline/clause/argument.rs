//! What stands behind a verb besides its objects: particles, complements, places.

use super::super::inflect::VerbForm;
use super::super::lexicon::{Act, Settings, Verb};
use super::super::syntax::{
    Clause, Head, Phrase, Place, Relation, is_determiner, is_function_word, preposition,
};
use super::Parser;

impl<'a> Parser<'a> {
    /// "turn the lamp on", "put it away", "put it back".
    pub(super) fn particle(&mut self, clause: &mut Clause<'a>) -> bool {
        let Some(word) = self.peek() else { return false };
        if word == "back" {
            clause.back = true;
            self.position += 1;
            return true;
        }
        let first = clause.verb_text.split(' ').next().unwrap_or_default().to_owned();
        if let Some((verb, length)) = self.long_particle(&first) {
            clause.verbs = vec![verb];
            self.position += length;
            return true;
        }
        let next = self.word_at(1);
        // "turn the lamp on to see": no "onto".
        let purpose = next == Some("to")
            && self.ahead(2).verbs_here().is_some()
            && self.ahead(2).longest_noun().is_none();
        if !purpose && preposition(&self.rest()).is_some_and(|(_, length)| length > 1) {
            return false;
        }
        let free = next.is_none_or(|next| {
            [
                ",", ".", "and", "then", "before", "after", "while", "but", "again", "please", "so", "when",
                "once", "without", "if", "until", "because", "since", "unless", "too", "also",
            ]
            .contains(&next)
                || preposition(&[next]).is_some()
                || self.lexicon.is_small("polite", &[next])
        });
        if clause.verb_text.is_empty() || !free {
            return false;
        }
        let with_particle: Vec<&Verb> = self
            .lexicon
            .verbs(&first)
            .into_iter()
            .filter(|(_, particles, verb)| {
                particles.len() == 1 && particles[0] == word && self.objects_may_fit(clause, verb)
            })
            .map(|(_, _, verb)| verb)
            .collect();
        if with_particle.is_empty() || clause.verb_text.contains(' ') {
            return false;
        }
        if preposition(&[word]).is_some()
            && next.is_some_and(|n| preposition(&[n]).is_none() && n != "," && n != "." && n != "and")
        {
            let known_end = next.is_some_and(|n| {
                is_function_word(n) && !is_determiner(n) || self.lexicon.is_small("polite", &[n])
            });
            if !known_end {
                return false;
            }
        }
        clause.verbs = with_particle;
        clause.verb_text = format!("{first} {word}");
        self.position += 1;
        true
    }

    /// "put the wine in the fridge to cool": what it is put there for.
    pub(super) fn purpose(&mut self, clause: &mut Clause<'a>) -> bool {
        if self.peek() != Some("to") || !places_something(clause) {
            return false;
        }
        let Some(word) = self.word_at(1) else { return false };
        let particle = usize::from(matches!(self.word_at(2), Some("up" | "down" | "off")));
        let length = 2 + particle;
        let ends = self
            .word_at(length)
            .is_none_or(|next| [",", ".", "and", "then"].contains(&next) || preposition(&[next]).is_some());
        let verbs = self.lexicon.verbs(word);
        let found = verbs.iter().find(|(form, particles, verb)| {
            *form == VerbForm::Base && particles.is_empty() && matches!(verb.act, Act::Chill | Act::Heat)
        });
        match found {
            Some((_, _, verb)) if ends => {
                for phrase in &mut clause.objects {
                    phrase.states.extend(verb.set.clone());
                }
                self.position += length;
                true
            }
            _ => false,
        }
    }

    /// "the fridge should contain the milk": it is to be put there.
    pub(super) fn contents_told(&mut self, clause: &mut Clause<'a>) -> bool {
        let [vessel] = clause.objects.as_slice() else { return false };
        let takes = matches!(&vessel.head, Head::Noun(noun) if self.has_affordance(noun, "receptacle"));
        let length = usize::from(matches!(self.peek(), Some("should" | "must" | "shall" | "to")));
        let holds = matches!(self.word_at(length), Some("contain" | "contains" | "hold" | "holds"));
        // "the kettle needs water", "has water in it"
        let has = matches!(self.word_at(length), Some("has" | "have" | "needs" | "need" | "gets" | "get"));
        if !takes || !holds && !has {
            return false;
        }
        let start = self.position;
        self.position += length + 1;
        self.position += usize::from(has && self.peek() == Some("to") && self.word_at(1) == Some("have")) * 2;
        let things = self.phrases(0);
        let liquid = things.first().and_then(Phrase::liquid);
        if let Some(liquid) = liquid {
            clause.complement.extend(super::super::mention::filled(liquid));
            let _ = self.skip_back_reference();
            return true;
        }
        if things.is_empty() || has {
            self.position = start;
            return false;
        }
        clause.places = vec![Place::new(Relation::In, "in", vessel.clone())];
        clause.objects = things;
        clause.verbs = self.putting();
        clause.verb_text = "put".to_owned();
        true
    }

    /// The verb of what is to be put somewhere, where no verb says so.
    pub(super) fn putting(&self) -> Vec<&'a Verb> {
        let put = self.lexicon.verbs("put").into_iter();
        put.filter(|(_, p, verb)| p.is_empty() && verb.act == Act::Place).map(|(_, _, verb)| verb).collect()
    }

    /// "put it where it belongs": more than one word behind the object.
    pub(super) fn long_particle(&self, first: &str) -> Option<(&'a Verb, usize)> {
        let rest = self.rest();
        self.lexicon.verbs(first).into_iter().find_map(|(_, particles, verb)| {
            let fits = particles.len() > 2 && particles.iter().zip(&rest).all(|(a, b)| a == b);
            (fits && rest.len() >= particles.len()).then_some((verb, particles.len()))
        })
    }

    pub(super) fn objects_may_fit(&self, clause: &Clause<'a>, verb: &Verb) -> bool {
        let Some(wants) = &verb.wants else { return true };
        clause.objects.is_empty()
            || clause.objects.iter().any(|phrase| match &phrase.head {
                Head::Noun(noun) => self.can_be(noun, wants),
                _ => true,
            })
    }

    /// "keep the fridge closed", "make sure the light is off", "the lamp is on".
    pub(super) fn complement(&mut self, clause: &mut Clause<'a>) -> bool {
        if clause.objects.is_empty() {
            return false;
        }
        if clause.complement.is_empty() && self.needs_doing(clause) {
            return true;
        }
        let start = self.position;
        while matches!(
            self.peek(),
            Some(
                "is" | "are"
                    | "be"
                    | "being"
                    | "stay"
                    | "stays"
                    | "remain"
                    | "remains"
                    | "were"
                    | "was"
                    | "get"
                    | "gets"
                    | "becomes"
                    | "become"
                    | "all"
                    | "to"
                    | "should"
                    | "must"
                    | "completely"
                    | "fully"
            )
        ) {
            if self.peek() == Some("to") && !matches!(self.word_at(1), Some("be" | "stay" | "remain")) {
                break;
            }
            self.position += 1;
        }
        // "the lights go off"
        let goes = matches!(self.peek(), Some("go" | "goes" | "come" | "comes"))
            && matches!(self.word_at(1), Some("on" | "off" | "out"))
            && self.word_at(2).is_none_or(|next| [",", ".", "and", "then", "again"].contains(&next));
        self.position += usize::from(goes);
        let negated = self.peek() == Some("not");
        self.position += usize::from(negated);
        while negated && matches!(self.peek(), Some("be" | "stay" | "remain" | "left" | "kept" | "still")) {
            self.position += 1;
        }
        let rest = self.rest();
        for length in (1..=2.min(rest.len())).rev() {
            let Some(adjective) = self.lexicon.adjective(&rest[..length]) else { continue };
            let behind = rest.get(length);
            let ends = behind.is_none_or(|next| {
                [",", ".", "and", "then", "before", "after", "while", "but", "so", "again", "please"]
                    .contains(next)
                    || ["when", "once", "if", "until", "as", "at"].contains(next)
                    || preposition(&[next]).is_some() && self.position > start
                    || self.position > start && self.ahead(length).clause_starts_here(false)
                    || *next == "of" && rest[..length] == ["full"]
                    || self.lexicon.longest_small("polite", &rest[length..]).is_some_and(|length| length > 1)
            });
            let particle = self.position == start && preposition(&rest[..length]).is_some();
            if !ends
                || (particle
                    && !(clause.verbs.is_empty()
                        && clause.unknown.is_empty()
                        && behind.is_none_or(|b| {
                            [
                                ",", ".", "and", "please", "when", "once", "if", "until", "at", "before",
                                "after", "while", "then",
                            ]
                            .contains(b)
                        }))
                    && clause.verbs.iter().all(|verb| verb.act != Act::Keep && verb.act != Act::Place))
            {
                continue;
            }
            // "it is cooked" is said of what was done; "a cooked potato" is first of all a hot one.
            let cooked = Settings::from([("isCooked".to_owned(), super::super::yes())]);
            let is_cooking = |(form, _, verb): &(VerbForm, &[String], &Verb)| {
                *form == VerbForm::Past && verb.act == Act::Cook
            };
            let done = self.lexicon.verbs(rest[0]).iter().any(is_cooking);
            for (property, value) in if done { &cooked } else { &adjective.set } {
                let value = if negated { super::super::opposite(value) } else { value.clone() };
                clause.complement.insert(property.clone(), value);
            }
            self.position += length;
            if adjective.set.get("isFilledWithLiquid") == Some(&super::super::yes()) && !negated {
                self.full_of_what(clause);
            }
            return true;
        }
        self.position = start;
        false
    }

    /// "on the desk but closed": a state besides the place.
    pub(super) fn but_so(&mut self, clause: &mut Clause<'a>) -> bool {
        let state = self.word_at(1).is_some_and(|word| {
            self.lexicon.adjective(&[word]).is_some() && self.longest_noun_at(self.position + 1).is_none()
        });
        let ends = self.word_at(2).is_none_or(|next| [",", ".", "and"].contains(&next));
        if self.peek() != Some("but") || !state || !ends || clause.objects.is_empty() {
            return false;
        }
        self.position += 1;
        let told = self.complement(clause);
        self.position -= usize::from(!told);
        told
    }

    /// "filled with water", "full of water"
    fn full_of_what(&mut self, clause: &mut Clause<'a>) {
        if !matches!(self.peek(), Some("with" | "of")) {
            return;
        }
        let start = self.position;
        self.position += 1;
        match self.phrase(0).and_then(|phrase| phrase.liquid().map(super::super::mention::filled)) {
            Some(filled) => clause.complement.extend(filled),
            None => self.position = start,
        }
    }

    /// "the bowl belongs on the counter", "it ends up in the fridge": where it is to be put.
    pub(super) fn belongs(&mut self, clause: &mut Clause<'a>) -> bool {
        let Some(word) = self.peek() else { return false };
        let length = match self.word_at(1) {
            Some("up") if ["ends", "end", "winds", "wind"].contains(&word) => 2,
            _ if ["belongs", "belong"].contains(&word) => 1,
            _ => return false,
        };
        let known = clause.verbs.is_empty() || clause.verbs.iter().any(|verb| verb.act == Act::Keep);
        if !known || clause.objects.is_empty() || self.ahead(length).place_length().is_none() {
            return false;
        }
        if clause.verbs.is_empty() {
            clause.unknown.push("belongs".to_owned());
        }
        self.position += length;
        true
    }

    pub(in crate::offline) fn place_length(&self) -> Option<usize> {
        preposition(&self.rest()).map(|(_, length)| length)
    }

    /// "I want the bread thrown out", "the egg should be thrown away": a participle that no adjective is.
    pub(super) fn passive(&mut self, clause: &mut Clause<'a>) -> bool {
        const AUXILIARIES: [&str; 14] = [
            "should", "must", "has", "have", "needs", "need", "ought", "shall", "to", "be", "get", "gets",
            "is", "are",
        ];
        let kept = clause.verbs.iter().any(|verb| verb.act == Act::Keep);
        if clause.objects.is_empty() || !clause.complement.is_empty() || !(kept || clause.verbs.is_empty()) {
            return false;
        }
        let length =
            (0..).take_while(|&at| self.word_at(at).is_some_and(|w| AUXILIARIES.contains(&w))).count();
        let auxiliaries: Vec<&str> = (0..length).filter_map(|at| self.word_at(at)).collect();
        let asked = ["be", "get", "gets"].iter().any(|word| auxiliaries.contains(word));
        // "I want" opens the sentence and is no verb of the clause.
        let wished =
            self.words[..self.position].iter().any(|word| ["want", "like", "need"].contains(&word.as_str()));
        let plain = auxiliaries.iter().all(|word| ["is", "are"].contains(word));
        let ahead = self.ahead(length);
        // "a hot potato is placed on the counter": told as it shall be.
        let told = plain
            && length > 0
            && matches!(ahead.peek(), Some("placed" | "put" | "moved"))
            && ahead.ahead(1).place_length().is_some();
        if !(asked || told || kept && plain || wished && auxiliaries.is_empty()) {
            return false;
        }
        let rest = ahead.rest();
        if (1..=2.min(rest.len())).any(|n| self.lexicon.adjective(&rest[..n]).is_some()) {
            return false;
        }
        let Some(word) = ahead.peek() else { return false };
        let behind = rest.get(1..).unwrap_or_default();
        let kept_there = ["kept", "left"].contains(&word) && ahead.ahead(1).place_length().is_some();
        if kept_there {
            clause.verbs = self.putting();
            clause.verb_text = "put".to_owned();
            self.wants_place = true;
            self.position += length + 1;
            return true;
        }
        let changes = |verb: &Verb| !matches!(verb.act, Act::Keep | Act::Go | Act::Use | Act::Hold);
        let found: Vec<_> = self
            .lexicon
            .verbs(word)
            .into_iter()
            .filter(|(form, particles, verb)| {
                (*form == VerbForm::Past || ["put", "set"].contains(&word))
                    && particles.len() <= behind.len()
                    && particles.iter().zip(behind).all(|(a, b)| a == b)
                    // "should be put on the plate": nothing is switched on.
                    && (particles.is_empty() || !behind.get(particles.len()).is_some_and(|w| is_determiner(w)))
                    && changes(verb)
                    && self.objects_may_fit(clause, verb)
            })
            .collect();
        let Some(particles) = found.first().map(|(_, particles, _)| particles.len()) else { return false };
        clause.verbs =
            found.into_iter().filter(|(_, p, _)| p.len() == particles).map(|(_, _, verb)| verb).collect();
        clause.verb_text = ahead.text_between(ahead.position, ahead.position + particles + 1);
        self.wants_place = clause.verbs.iter().any(|verb| verb.act == Act::Place);
        self.position += length + particles + 1;
        true
    }

    /// "the pan needs washing"
    fn needs_doing(&mut self, clause: &mut Clause<'a>) -> bool {
        if !clause.verbs.is_empty() || !matches!(self.peek(), Some("needs" | "need" | "requires")) {
            return false;
        }
        // "needs a (good) wash"
        let article = usize::from(self.word_at(1) == Some("a"));
        let good = usize::from(
            article == 1
                && self.word_at(2).is_some_and(|w| ["good", "quick", "proper", "thorough"].contains(&w)),
        );
        let at = 1 + article + good;
        let Some(word) = self.word_at(at) else { return false };
        let wanted = if article == 1 { VerbForm::Base } else { VerbForm::Gerund };
        let doing = |(form, particles, verb): &(VerbForm, &[String], &Verb)| {
            *form == wanted
                && particles.is_empty()
                && (verb.act != Act::Place
                    || self.word_at(at + 1).is_some_and(|w| preposition(&[w]).is_some()))
                && verb.act != Act::Go
        };
        clause.verbs = self.lexicon.verbs(word).into_iter().filter(doing).map(|(_, _, verb)| verb).collect();
        if clause.verbs.is_empty() {
            return false;
        }
        clause.verb_text = word.to_owned();
        self.position += at + 1;
        true
    }

    pub(super) fn is_movable(&self, phrase: &Phrase) -> bool {
        match &phrase.head {
            Head::Noun(noun) => self.has_affordance(noun, "pickupable"),
            _ => false,
        }
    }

    /// "turn it on and then off": the verb is that of the clause before.
    pub(super) fn particle_alone(&mut self, clause: &mut Clause<'a>, previous: Option<&Clause<'a>>) {
        let (Some(previous), Some(word)) = (previous, self.peek()) else { return };
        let first = previous.verb_text.split(' ').next().unwrap_or_default();
        let verbs: Vec<&Verb> = self
            .lexicon
            .verbs(first)
            .into_iter()
            .filter(|(_, particles, _)| particles.len() == 1 && particles[0] == word)
            .map(|(_, _, verb)| verb)
            .collect();
        let alone = self.word_at(1).is_none_or(|next| !is_determiner(next))
            && self.longest_noun_at(self.position + 1).is_none();
        if !verbs.is_empty() && alone {
            clause.verbs = verbs;
            clause.verb_text = format!("{first} {word}");
            clause.unknown.clear();
            self.position += 1;
        }
    }
}

/// Whether a clause puts something somewhere, as far as it is read.
fn places_something(clause: &Clause<'_>) -> bool {
    !clause.objects.is_empty() && clause.verbs.iter().any(|verb| verb.act == Act::Place)
}

//! Verbs: which one stands here, with which particle, and whether it begins a clause.

use super::super::inflect::{self, VerbForm};
use super::super::lexicon::{Act, DICTIONARY, Noun, Verb};
use super::super::syntax::{is_determiner, is_function_word, preposition};
use super::Parser;

impl<'a> Parser<'a> {
    /// The verbs at the position and how many words they take, the particle-rich first.
    pub(in crate::offline) fn verbs_here(&self) -> Option<(VerbForm, Vec<&'a Verb>, usize)> {
        let word = self.peek()?;
        let candidates = self.lexicon.verbs(word);
        let behind: Vec<&str> = self.rest().into_iter().skip(1).collect();
        let contiguous = candidates.iter().find(|(_, particles, verb)| {
            particles.len() <= behind.len()
                && particles.iter().zip(&behind).all(|(a, b)| a == b)
                && self.object_may_fit(particles, verb)
        });
        let Some((form, particles, _)) = contiguous else { return self.verb_apart(&candidates) };
        let (form, length) = (*form, particles.len());
        let verbs = candidates
            .iter()
            .filter(|(_, other, _)| other.len() == length && other.iter().zip(&behind).all(|(a, b)| a == b))
            .map(|(_, _, verb)| *verb)
            .collect();
        Some((form, verbs, length + 1))
    }

    /// Whether a word can only say what was done.
    pub(super) fn is_past(&self, word: &str) -> bool {
        let forms = self.lexicon.verbs(word);
        !forms.is_empty() && forms.iter().all(|(form, _, _)| *form == VerbForm::Past)
    }

    /// "switch the light on": a verb that needs its particle, which stands behind the object.
    fn verb_apart(
        &self,
        candidates: &[(VerbForm, &'a [String], &'a Verb)],
    ) -> Option<(VerbForm, Vec<&'a Verb>, usize)> {
        let behind: Vec<&str> = self.words[self.position + 1..]
            .iter()
            .map(String::as_str)
            .take(8)
            .take_while(|word| ![".", ",", "then", "if"].contains(word))
            .collect();
        let stands = |particles: &[String]| match particles {
            [particle] => behind.iter().position(|word| word == particle),
            _ => None,
        };
        // "switch the kettle on and the lights off": the nearest is the verb's.
        // "shut the fridge and the lights off": the fridge is not shut off.
        let first = (1..5).find_map(|at| self.longest_noun_at(self.position + at));
        let fits = |verb: &Verb| match (&verb.wants, &first) {
            (Some(wants), Some((noun, _, _))) => self.can_be(noun, wants) || self.is_absent(noun),
            _ => true,
        };
        let nearest =
            candidates.iter().filter(|(_, particles, verb)| stands(particles).is_some() && fits(verb));
        let (form, particles, _) = nearest.min_by_key(|(_, particles, _)| stands(particles))?;
        let verbs =
            candidates.iter().filter(|(_, other, _)| other == particles).map(|(_, _, verb)| *verb).collect();
        Some((*form, verbs, 1))
    }

    /// "put on the light" switches; "put on the table" puts: what follows decides.
    fn object_may_fit(&self, particles: &[String], verb: &Verb) -> bool {
        let (Some(wants), [particle]) = (&verb.wants, particles) else { return true };
        if preposition(&[particle]).is_none() {
            return true;
        }
        let nouns: Vec<_> = (self.position + 2..self.position + 8)
            .take_while(|&at| {
                self.words.get(at).is_some_and(|word| {
                    preposition(&[word]).is_none() && !["and", ",", ".", "while"].contains(&word.as_str())
                })
            })
            .filter_map(|at| self.longest_noun_at(at))
            .collect();
        // What is not here can be anything, unless the bare verb would put things there.
        let puts =
            |word| self.lexicon.verbs(word).iter().any(|(_, p, v)| p.is_empty() && v.act == Act::Place);
        let open = !self.peek().is_some_and(puts);
        nouns.is_empty()
            || nouns.iter().any(|(noun, _, _)| self.can_be(noun, wants) || open && self.is_absent(noun))
    }

    pub(in crate::offline) fn can_be(&self, noun: &Noun, wants: &str) -> bool {
        self.has_affordance(noun, wants)
            || wants == "toggleable" && noun.kinds.iter().any(|kind| self.lexicon.control(kind).is_some())
    }

    /// Whether a clause rather than another noun phrase starts at the position.
    pub(in crate::offline) fn clause_starts_here(&self, first: bool) -> bool {
        let Some(word) = self.peek() else { return true };
        if [".", "then", "before", "after", "while", "when", "once", "until", "but", "dont", "without"]
            .contains(&word)
        {
            return true;
        }
        if word == "that" && self.word_at(1).is_some_and(|next| is_determiner(next) && next != "one") {
            return true;
        }
        // "water should be in the bowl"
        if let Some((_, _, length)) = self.longest_noun()
            && matches!(self.word_at(length), Some("should" | "must" | "shall" | "goes" | "is" | "needs"))
        {
            return false;
        }
        // "slices of tomato and slices of potato"
        if self.lexicon.is_small("slices", &[word.trim_end_matches('s')]) && self.word_at(1) == Some("of") {
            return false;
        }
        let rest = self.rest();
        let negation =
            word == "never" || rest.starts_with(&["do", "not"]) || rest.starts_with(&["do", "the", "same"]);
        if negation
            || self.robot_opens()
            || self.lexicon.longest_small("sequence", &rest).is_some()
            || self.lexicon.longest_small("parallel", &rest).is_some()
        {
            return true;
        }
        if self.is_unknown_verb(word, self.position + 1) {
            return true;
        }
        let Some((form, verbs, length)) = self.verbs_here() else {
            return self.lexicon.longest_small("polite", &rest).is_some();
        };
        let next = self.word_at(length);
        if self.is_switched_thing() {
            return false;
        }
        let determined =
            next.is_some_and(|next| is_determiner(next) || ["it", "them", "everything"].contains(&next));
        // "the leftmost, lower drawer": which drawer.
        if !first && !determined && word == "lower" && self.noun_follows(1) {
            return false;
        }
        let noun = self.longest_noun();
        if noun.as_ref().is_some_and(|(_, _, noun_length)| *noun_length > length)
            && !(first && self.noun_begins(length))
        {
            return false;
        }
        if form == VerbForm::Past {
            // "to be sliced and put in the pan": the passive goes on.
            let to_somewhere = next.is_some_and(|next| preposition(&[next]).is_some());
            return first || determined || to_somewhere && noun.is_none();
        }
        // "watch, keys and card go in the box": things, not something to be done.
        let listed = matches!(next, Some("," | "and"))
            && noun
                .as_ref()
                .is_some_and(|(noun, _, _)| noun.word != "water" && self.has_affordance(noun, "pickupable"));
        if listed {
            return false;
        }
        if noun.is_some() {
            // A word that is noun and verb is a verb when something to do it to follows at once.
            return first || determined || self.noun_begins(length);
        }
        if self.lexicon.adjective(&[word]).is_some() {
            // "…, chill in the fridge, …"
            let there = matches!(next, Some("in" | "inside" | "with" | "using"));
            return first || determined || there || (!self.wants_place && self.noun_begins(length));
        }
        !verbs.is_empty()
    }

    /// "bung the egg …": a word nobody knows where a verb is due.
    pub(super) fn is_unknown_verb(&self, word: &str, next: usize) -> bool {
        let next = self.words.get(next).map(String::as_str).unwrap_or_default();
        word.len() > 2
            && word.chars().all(|c| c.is_ascii_lowercase())
            && (is_determiner(next) && !["other", "another"].contains(&next))
            && !super::super::text::is_known(word, self.lexicon, self.scene)
            && self.lexicon.longest_small("polite", &[word]).is_none()
    }

    /// "lights off", "microwave on please": a thing and its switch, not a verb and its particle.
    fn is_switched_thing(&self) -> bool {
        let Some((_, _, length)) = self.longest_noun() else { return false };
        let ends = self.word_at(length + 1).is_none_or(|next| {
            [".", ",", "and", "please", "before", "after", "while", "then", "once", "when"].contains(&next)
        });
        matches!(self.word_at(length), Some("on" | "off")) && ends
    }

    /// Whether a noun phrase without a determiner starts behind some words.
    fn noun_begins(&self, offset: usize) -> bool {
        let at = self.position + offset;
        let Some(word) = self.words.get(at).map(String::as_str) else { return false };
        if preposition(&[word]).is_some() || word == "and" || word == "," {
            return false;
        }
        self.longest_noun_at(at).is_some()
            || inflect::number(word).is_some()
            || self.lexicon.adjective(&[word]).is_some()
            || self.lexicon.is_small("slices", &[word])
    }

    /// A word that is no verb where one is due, a letter away from one: "was the spoon", "pit it on the desk".
    pub(super) fn miswritten_verb(&mut self) -> Option<(String, Vec<&'a Verb>)> {
        let word = self.peek()?;
        let next = self.word_at(1)?;
        let due = is_determiner(next) || next == "it" || next == "them" || self.noun_begins(1);
        if !due
            || word.len() < 2
            || self.longest_noun().is_some()
            || is_function_word(word) && word != "was"
            || self.lexicon.adjective(&[word]).is_some()
            || self.lexicon.is_small("real", &[word])
        {
            return None;
        }
        let (meant, verbs) = self.lexicon.near_verb(word)?;
        // "head a potato": a word, but none that fits; so it is one for what is said most.
        let slip = is_determiner(next) && self.lexicon.is_small("common", &[meant]);
        let known = self.lexicon.vocabulary().contains(word) || self.lexicon.is_small(DICTIONARY, &[word]);
        if word != "was" && known && !slip {
            return None;
        }
        self.choices.push(format!("read \"{word}\" as \"{meant}\""));
        Some((meant.to_owned(), verbs))
    }

    /// "give the cup a quick rinse": the verb is the noun.
    pub(super) fn give_a_doing(&self) -> Option<(Vec<&'a Verb>, String)> {
        if !matches!(self.peek(), Some("give" | "giving")) {
            return None;
        }
        let at = (2..8).find(|&at| self.word_at(at) == Some("a"))?;
        let at = if self.lexicon.is_small("modifiers", &[self.word_at(at + 1)?])
            || self.word_at(at + 1) == Some("quick")
        {
            at + 2
        } else {
            at + 1
        };
        let word = self.word_at(at)?;
        let changes = |verb: &&Verb| matches!(verb.act, Act::Set | Act::Heat | Act::Chill);
        let bare = self.lexicon.verbs(word).into_iter().filter(|(_, particles, _)| particles.is_empty());
        let verbs: Vec<&Verb> = bare.map(|(_, _, verb)| verb).filter(changes).collect();
        (!verbs.is_empty()).then(|| (verbs, word.to_owned()))
    }
}

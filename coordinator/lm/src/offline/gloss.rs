//! What the words of a text may stand for, whatever the grammar: for telling an instruction that does not say
//! its goal from one that was misread.

use std::collections::BTreeSet;

use super::Offline;
use super::lexicon::{LONGEST, Lexicon};
use super::text;

/// The types and states that a text's words may stand for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Gloss {
    /// Object types, devices that verbs name included.
    pub types: BTreeSet<String>,
    /// Properties that verbs and adjectives set.
    pub properties: BTreeSet<String>,
}

impl Offline {
    /// Looks every word and phrase of a text up.
    pub fn gloss(&self, instruction: &str) -> Gloss {
        let words: Vec<String> = text::tokens(instruction).into_iter().map(|token| token.text).collect();
        let mut gloss = Gloss::default();
        for start in 0..words.len() {
            let rest: Vec<&str> = words[start..].iter().take(LONGEST).map(String::as_str).collect();
            gloss.look_up(&rest, &self.lexicon);
        }
        gloss
    }
}

impl Gloss {
    fn look_up(&mut self, rest: &[&str], lexicon: &Lexicon) {
        for length in 1..=rest.len() {
            let words = &rest[..length];
            if let Some((noun, _)) = lexicon.noun(words) {
                self.types.extend(noun.kinds.iter().cloned());
            }
            if let Some(adjective) = lexicon.adjective(words) {
                self.properties.extend(adjective.set.keys().cloned());
            }
            if lexicon.longest_small("slices", words) == Some(length) {
                self.properties.insert("isSliced".to_owned());
            }
        }
        for (_, particles, verb) in lexicon.verbs(rest[0]) {
            if particles.iter().all(|particle| rest.contains(&particle.as_str())) {
                self.properties.extend(verb.set.keys().cloned());
                self.types.extend(verb.device.iter().cloned());
                if verb.act == super::lexicon::Act::Discard {
                    self.types.insert("GarbageCan".to_owned());
                }
            }
        }
    }
}

//! Words and turns of phrase that are told by themselves.

use lamma_domains::goal::PropertyValue;

use super::doing::BEHIND_A_STATE;
use super::{Again, Chunk, Chunker, Doing, Thing};
use crate::offline::clause::is_going;
use crate::offline::inflect::VerbForm;
use crate::offline::lexicon::{Act, Settings};
use crate::offline::syntax::{is_determiner, is_function_word, preposition};
use crate::offline::text::POSSESSIVE;

const HARD: [&str; 16] = [
    "if",
    "unless",
    "except",
    "apart",
    "whichever",
    "either",
    "or",
    "everything",
    "anything",
    "rest",
    "others",
    "another",
    "nothing",
    "otherwise",
    "swap",
    "mix",
];

const DENIES: [&str; 8] = ["not", "no", "never", "nor", "neither", "without", "dont", "none"];

const JOINS: [&str; 7] = ["and", "plus", "while", "whereas", "whilst", "so", "also"];

const TELLS: [&[&str]; 21] = [
    &["that", "is"],
    &["that", "are"],
    &["that", "was"],
    &["that", "were"],
    &["which", "is"],
    &["which", "are"],
    &["there", "is"],
    &["there", "are"],
    &["you", "find"],
    &["you", "will", "find"],
    &["youll", "find"],
    &["you", "will", "see"],
    &["youll", "see"],
    &["you", "will"],
    &["youll"],
    &["you", "see"],
    &["hiding"],
    &["is"],
    &["are"],
    &["was"],
    &["were"],
];

/// Verbs and auxiliaries that say that what comes next is to be so.
pub(super) const WISHES: [&str; 38] = [
    "should", "must", "shall", "gets", "get", "goes", "go", "needs", "need", "wants", "want", "belongs",
    "belong", "be", "comes", "come", "ends", "finds", "moves", "returns", "lands", "has", "have", "to",
    "will", "lives", "live", "sits", "stands", "lies", "can", "may", "joins", "takes", "carry", "does",
    "gives", "wait",
];

/// How a thing is where it is, which says nothing of where.
pub(super) const RESTING: [&str; 16] = [
    "stand", "lie", "sit", "rest", "standing", "lying", "sitting", "resting", "waiting", "living", "hang",
    "hanging", "wait", "being", "found", "kept",
];

const STAYS: [&[&str]; 7] = [
    &["where", "it", "is"],
    &["where", "they", "are"],
    &["where", "it", "stands"],
    &["as", "it", "is"],
    &["as", "they", "are"],
    &["as", "is"],
    &["alone"],
];

/// What was said last holds for what is named here too.
const LIKEWISE: [&[&str]; 16] = [
    &["same", "with"],
    &["likewise"],
    &["too"],
    &["as", "well"],
    &["same", "for"],
    &["same", "place"],
    &["so", "does"],
    &["so", "do"],
    &["so", "should"],
    &["so", "is"],
    &["so", "are"],
    &["so", "must"],
    &["so", "goes"],
    &["as", "does"],
    &["as", "do"],
    &["as", "should"],
];

/// What says nothing here.
const NOTHING: [&[&str]; 13] = [
    &["not", "forget"],
    &["dont", "forget"],
    &["not", "forgetting"],
    &["as", "for"],
    &["either", "way"],
    &["one", "of", "you"],
    &["there", "should"],
    &["there", "must"],
    &["at", "the", "very", "least"],
    &["for", "one", "thing"],
    &["good", "idea"],
    &["whatever", "happens"],
    &["all", "in", "all"],
];

const BESIDE: [&[&str]; 3] = [&["in", "place", "of"], &["instead", "of"], &["rather", "than"]];

impl Chunker<'_> {
    /// Marks, and words that are told by themselves.
    pub(super) fn closed_class(&self, at: usize, opens: bool) -> Option<(Chunk, usize)> {
        self.turn_of_phrase(at, opens)
            .or_else(|| self.small_word(at, opens).map(|chunk| (chunk, 1)))
            .or_else(|| self.told(at))
    }

    /// Words that say something only together.
    fn turn_of_phrase(&self, at: usize, opens: bool) -> Option<(Chunk, usize)> {
        const PHRASES: [(&[&[&str]], Chunk); 5] = [
            (&BESIDE, Chunk::Beside),
            (&[&["as", "well", "as"]], Chunk::Join(true)),
            (&LIKEWISE, Chunk::Likewise),
            (&STAYS, Chunk::Stays),
            (&[&["is", "not", "to"], &["are", "not", "to"]], Chunk::Deny),
        ];
        for (phrases, chunk) in PHRASES {
            if let Some(length) = self.one_of(at, phrases) {
                return Some((chunk, length));
            }
        }
        if let Some(length) = self.one_of(at, &NOTHING) {
            return Some((Chunk::Other(self.at(at).to_owned()), length));
        }
        let word = self.at(at);
        match (word, self.at(at + 1)) {
            ("off" | "on", "with") if opens => {
                let words = vec!["turn".to_owned(), word.to_owned()];
                let wants = Some("toggleable".to_owned());
                Some((Chunk::Act(Doing { act: Act::Set, words, form: VerbForm::Base, wants }), 2))
            }
            ("someone" | "somebody" | "i" | "he" | "she", _) => {
                self.report(at + 1).map(|length| (Chunk::Tells, 1 + length))
            }
            ("water", "running" | "flowing") => self.tap().map(|tap| (Chunk::Thing(tap), 1)),
            _ => None,
        }
    }

    /// "water running": the tap is.
    fn tap(&self) -> Option<Thing> {
        let (noun, _) = self.lexicon.noun(&["faucet"])?;
        let absent = self.parser.is_absent(noun);
        let words = vec!["the".to_owned(), "faucet".to_owned()];
        Some(Thing { words, kinds: noun.kinds.clone(), plural: false, absent, full_of: None })
    }

    /// "the gizmo should be frobbed": something is asked of what nobody knows.
    fn asks_of_nothing(&self, at: usize) -> bool {
        let noun = at.checked_sub(1).map_or("", |before| self.at(before));
        let named = at > 1 && is_determiner(self.at(at - 2));
        let shall = ["should", "must", "shall", "needs"].contains(&self.at(at))
            || ["has", "have", "is", "are"].contains(&self.at(at)) && self.starts(at + 1, &["to", "be"]);
        shall
            && named
            && !is_function_word(noun)
            && self.parser.longest_noun_at(at - 1).is_none()
            && self.lexicon.adjective(&[noun]).is_none()
            && !self.lexicon.is_small("slices", &[noun.trim_end_matches('s')])
            && !self.lexicon.is_small("rooms", &[noun])
    }

    fn small_word(&self, at: usize, opens: bool) -> Option<Chunk> {
        let (word, next) = (self.at(at), self.at(at + 1));
        if self.asks_of_nothing(at) {
            return Some(Chunk::Hard);
        }
        let unnamed = || self.thing(at).is_none();
        Some(match word {
            "." => Chunk::Stop,
            "," => Chunk::Join(false),
            "but" => Chunk::But,
            "shine" | "glow" | "glowing" | "shining" | "playing" | "ablaze" | "blazing" => Self::on(),
            "burn" if !self.object_follows(at + 1) => Self::on(),
            POSSESSIVE if self.describes(at + 1) => Chunk::Tells,
            "found" | "noticed" | "saw" if at == 0 || self.at(at - 1) == "." => Chunk::Tells,
            "is" | "are" if next == "for" => Chunk::Wish,
            "water" | "coffee" | "wine" if next == "filled" => return None,
            "then" => Chunk::But,
            "water" | "coffee" | "wine" if self.is_liquid(at, opens) => Chunk::Liquid(word.to_owned()),
            "stays" | "stay" | "remain" | "remains" => Chunk::Stays,
            "stop" if ["where", "put"].contains(&next) => Chunk::Stays,
            word if RESTING.contains(&word) && !(opens && self.object_follows(at + 1)) => Chunk::Wish,
            word if is_going(word) && next != "the" => Chunk::Wish,
            "go" | "goes" => Chunk::Wish,
            "itself" => Chunk::Which,
            "holding" | "containing" | "carrying" if at > 0 && self.at(at - 1) != "." => Chunk::Holds,
            "namely" => Chunk::Hard,
            "loaded" | "stocked" if next == "with" => Chunk::Hard,
            "see" => Chunk::Moves(None),
            "one" if self.starts(at + 1, &["of", "them"]) => Chunk::Hard,
            "which" if at > 0 && self.one_of(at, &TELLS).is_none() => Chunk::Which,
            "why" | "how" | "prepare" | "fix" => Chunk::Hard,
            "no" if next == "," => Chunk::Hard,
            "make" | "mix" if ["a", "some", "an"].contains(&next) => Chunk::Hard,
            "give" if ["me", "us"].contains(&next) => Chunk::Moves(None),
            "give" | "hand" | "pass" | "hold" | "use" | "only" if unnamed() => Chunk::Hard,
            "the" if next == "same" && unnamed() => Chunk::Hard,
            "can" if unnamed() || !BEHIND_A_STATE.contains(&next) => Chunk::Wish,
            word if HARD.contains(&word) => Chunk::Hard,
            word if DENIES.contains(&word) => Chunk::Deny,
            word if JOINS.contains(&word) => Chunk::Join(true),
            _ => return None,
        })
    }

    /// "is to be", "is turned on", "make sure that it is on": wished; else told.
    fn told(&self, at: usize) -> Option<(Chunk, usize)> {
        let (word, next) = (self.at(at), self.at(at + 1));
        let shall = ["is", "are", "has", "have", "wants"].contains(&word) && next == "to"
            || ["is", "are"].contains(&word) && ["wanted", "needed"].contains(&next);
        if shall {
            return Some((Chunk::Wish, 2));
        }
        if ["that", "which"].contains(&word) && next == "has" {
            return Some((Chunk::Hard, 2));
        }
        let stands = ["sits", "stands", "lies", "rests", "sit", "stand", "lie", "hangs"];
        if ["that", "which"].contains(&word) && stands.contains(&next) {
            return Some((Chunk::Tells, 2));
        }
        if self.lies_there(at) {
            return Some((Chunk::Tells, 1));
        }
        let length = self.one_of(at, &TELLS)?;
        if ["is", "are", "was", "were"].contains(&word) && length == 1 && self.thing(at + 1).is_some() {
            // "supper is the egg"
            return Some((Chunk::Other(word.to_owned()), 1));
        }
        let is = length == 1 && ["is", "are"].contains(&word);
        let wished = is && (self.is_past(at + 1) || self.is_made_sure(at));
        Some((if wished { Chunk::Wish } else { Chunk::Tells }, length))
    }

    /// "the dishes left in the sink must be …": which of them.
    fn lies_there(&self, at: usize) -> bool {
        let lies = ["left", "lying", "standing", "sitting", "found", "stored", "sat"].contains(&self.at(at));
        let named = at > 0 && !is_function_word(self.at(at - 1)) && !",.".contains(self.at(at - 1));
        let place = self.place(at + 1, None).filter(|(chunk, _)| matches!(chunk, Chunk::Place(..)));
        let wished = |at: usize| WISHES[..3].contains(&self.at(at)) || is_going(self.at(at));
        lies && named && place.is_some_and(|(_, length)| wished(at + 1 + length))
    }

    /// "has left", "put": how many words report what somebody did.
    pub(super) fn report(&self, at: usize) -> Option<usize> {
        let has = usize::from(["has", "have", POSSESSIVE, "is"].contains(&self.at(at)));
        ["left", "put", "dumped", "forgot", "dropped", "stuck"]
            .contains(&self.at(at + has))
            .then_some(has + 1)
    }

    pub(super) fn on() -> Chunk {
        let set = Settings::from([("isToggled".to_owned(), PropertyValue::Flag(true))]);
        Chunk::State(vec!["on".to_owned()], set)
    }

    /// "the phone's in a drawer", "the telly's on"
    pub(super) fn describes(&self, at: usize) -> bool {
        preposition(&self.rest(at)).is_some() || self.lexicon.adjective(&[self.at(at)]).is_some()
    }

    pub(super) fn object_follows(&self, at: usize) -> bool {
        is_determiner(self.at(at)) || ["it", "them"].contains(&self.at(at))
    }

    pub(super) fn is_past(&self, at: usize) -> bool {
        if ["cut", "put", "set"].contains(&self.at(at)) {
            return true;
        }
        // "is dirty", "is broken" is told
        let told = self.lexicon.adjective(&[self.at(at)]).is_some_and(|state| state.selects);
        !told && self.lexicon.verbs(self.at(at)).iter().any(|(form, _, _)| *form == VerbForm::Past)
    }

    /// Whether what is told is to be made sure of.
    pub(super) fn is_made_sure(&self, at: usize) -> bool {
        let start = (0..at).rev().find(|&at| self.at(at) == ".").unwrap_or(0);
        let part = (0..at).rev().find(|&at| [",", "."].contains(&self.at(at))).unwrap_or(0);
        let brought_about = (part..at).any(|at| ["once", "after", "before"].contains(&self.at(at)));
        brought_about
            || (start..at).any(|at| {
                ["sure", "ensure", "certain", "check"].contains(&self.at(at))
                    || self.starts(at, &["see", "that"])
            })
    }

    /// "water" is what runs, not "water the plant", nor the coffee table, nor the wine in the fridge.
    pub(super) fn is_liquid(&self, at: usize, opens: bool) -> bool {
        let next = self.at(at + 1);
        let order = opens && (is_determiner(next) || ["it", "them"].contains(&next));
        if order || self.parser.longest_noun_at(at).is_some_and(|(_, _, length)| length > 1) {
            return false;
        }
        let before = self.words[..at].last().map_or("", String::as_str);
        let poured = ["of", "with", "some", "pour", "holding", "brew", "make", "full"].contains(&before);
        let goes = preposition(&self.rest(at + 1)).and_then(|(_, length)| self.thing(at + 1 + length));
        let fills =
            |thing: &Thing| thing.kinds.iter().any(|kind| self.scene.affords(kind, "canFillWithLiquid"));
        let bottle = self.at(at) == "wine" && self.scene.has("WineBottle");
        poured || !bottle || goes.is_some_and(|(thing, _)| fills(&thing))
    }

    pub(super) fn again(&self, at: usize) -> Option<(Chunk, usize)> {
        let next = self.at(at + 1);
        let alone = self.thing(at).is_none();
        let (again, length) = match (self.at(at), next) {
            ("the", "former") => (Again::First, 2),
            ("the", "latter") => (Again::Last, 2),
            ("the", "first") if alone => (Again::First, 2),
            ("the", "second" | "other") if alone => (Again::Last, 2),
            ("one", _)
                if alone
                    && (at == 0 || is_function_word(self.at(at - 1)) || ",.".contains(self.at(at - 1))) =>
            {
                (Again::First, 1)
            }
            ("the", number) if counted(number) > 1 && self.starts(at + 2, &["of", "them"]) => {
                (Again::All(counted(number)), 4)
            }
            ("the" | "all", number) if alone && counted(number) > 1 => (Again::All(counted(number)), 2),
            ("every" | "each", "piece" | "item") => (Again::All(0), 2),
            ("every", "single") if self.at(at + 2) == "one" => (Again::All(0), 3),
            ("the", "lot") => (Again::All(0), 2),
            ("the", "whole") if self.at(at + 2) == "lot" => (Again::All(0), 3),
            ("them" | "they" | "these" | "those", "both" | "all") => (Again::All(counted(next)), 2),
            ("both" | "all" | "each", "of") if ["them", "these", "those"].contains(&self.at(at + 2)) => {
                (Again::All(counted(self.at(at))), 3)
            }
            ("it", "all") => (Again::All(0), 2),
            ("them" | "they" | "both" | "these" | "those" | "all" | "each", _) if alone => {
                (Again::All(counted(self.at(at))), 1)
            }
            ("it" | "him", _) => (Again::One, 1),
            ("this" | "that", "one") if alone => (Again::One, 2),
            ("this" | "that", _) if alone && (is_function_word(next) || ",.".contains(next)) => {
                (Again::One, 1)
            }
            _ => return None,
        };
        Some((Chunk::Again(again), length))
    }
}

/// How many a word for several means; 0 where it does not say.
fn counted(word: &str) -> usize {
    match word {
        "both" | "two" | "pair" => 2,
        "three" => 3,
        "four" => 4,
        _ => 0,
    }
}

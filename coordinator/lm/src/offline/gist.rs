//! The gist of what is said: its parts, put together again in the plainest sentences.
//!
//! The grammar reads a sentence by its structure, and asks where it meets one that it does not know. Most of what
//! people say beside that structure is the same few parts in another order: things, and what shall be so of them.
//! Here those parts are told one by one ([`chunk`]), each place, state and doing is given to the thing it is said of,
//! and all of it is said again in sentences that the grammar knows: "the bowl should be clean. put it on the shelf."
//! It stands only where nothing known is left over, so that nothing said is lost, and where nothing in the
//! sentence ("if", "except", "otherwise") makes more of it than its parts say.

use std::ops::Range;

use super::lexicon::Lexicon;
use super::scene::Scene;
use super::situation;
use super::syntax::{is_determiner, is_function_word};
use chunk::{Again, Chunk, Chunker, Doing, Thing};
use placing::at_thing;
use saying::{Last, Saying};

mod changing;
mod chunk;
mod naming;
mod placing;
mod saying;

/// The words of an instruction in plainest sentences, if all its parts can be told.
pub fn gist(words: &[String], lexicon: &Lexicon, scene: &Scene<'_>) -> Option<Vec<String>> {
    let (chunks, spans) = Chunker::new(words, lexicon, scene).chunks();
    let mut gist = Gist::new(&chunks, scene, lexicon);
    let parts = vague_parts(words, &chunks, &spans, lexicon);
    for at in 0..chunks.len() {
        gist.take(at)?;
    }
    (gist.nothing_is_open() && !gist.saying.said.is_empty()).then(|| {
        let mut said = gist.saying.said;
        said.extend(parts);
        said
    })
}

/// The parts that name nothing and yet say what is wanted: "and finally darkness".
fn vague_parts(words: &[String], chunks: &[Chunk], spans: &[Range<usize>], lexicon: &Lexicon) -> Vec<String> {
    let mut parts = Vec::new();
    let mut start = 0;
    for end in 0..=chunks.len() {
        if end < chunks.len() && !chunks[end].ends_part() {
            continue;
        }
        let first = spans.get(start).map_or("", |span| words[span.start].as_str());
        let why = ["for", "to", "so", "before", "after", "when", "because", "since", "as"].contains(&first);
        let heads = start == 0 || matches!(chunks[start - 1], Chunk::Stop);
        let ordered = chunks[start..end].iter().any(|chunk| matches!(chunk, Chunk::Moves(_)));
        let told = !why
            && (ordered || !heads)
            && chunks[start..end].iter().all(|chunk| {
                matches!(chunk, Chunk::Other(_) | Chunk::Wish | Chunk::Moves(None) | Chunk::Again(Again::One))
            });
        if told && start < end {
            let said = &words[spans[start].start..spans[end - 1].end];
            if !situation::ranked(lexicon, &situation::words_of(said), true).is_empty() {
                parts.extend(said.iter().cloned());
                parts.push(".".to_owned());
            }
        }
        start = end + 1;
    }
    parts
}

/// What has been taken in, and what is open.
struct Gist<'a> {
    scene: &'a Scene<'a>,
    lexicon: &'a Lexicon,
    chunks: &'a [Chunk],
    /// What is spoken of.
    topic: Vec<Thing>,
    /// Whether nothing has been said of it yet.
    fresh: bool,
    /// Whether more things may be added to it.
    listing: bool,
    /// Whether nothing more is to be said of it: it stays.
    frozen: bool,
    /// What was spoken of before.
    before: Vec<Thing>,
    /// What was named last.
    named: Option<Thing>,
    /// What was spoken of, for "all three", since that was last said.
    recent: Vec<Thing>,
    /// What was listed last, for "the former".
    listed: Vec<Thing>,
    /// What the next thing is to get.
    pending: Option<Doing>,
    /// Whether the next thing gets what the last one got.
    same: bool,
    /// What the next thing has got before anything else: "once rinsed, the lettuce …"
    leading: Option<Doing>,
    /// Whether what is pending was done to nothing yet.
    unapplied: bool,
    /// Where the next things go: said first.
    front: Option<Vec<String>>,
    /// Where the last thing went.
    place: Option<(Vec<String>, Option<Thing>)>,
    /// A liquid that is not yet in anything.
    liquid: Option<String>,
    /// The liquids that something was filled with, by their places.
    taken: Vec<usize>,
    /// Whether a verb that puts things somewhere waits for where.
    homeless: Option<String>,
    /// Whether the next things are in what was named last: "the plate with the egg"
    contents: bool,
    /// Whether the last verb does something to things.
    acted: bool,
    /// Whether something is carried or wanted in this part.
    moved: bool,
    denied: bool,
    /// Whether something is left or kept behind "but".
    leaves: bool,
    /// Whether what comes next only says which thing is meant.
    tells: bool,
    saying: Saying,
}

impl<'a> Gist<'a> {
    fn new(chunks: &'a [Chunk], scene: &'a Scene<'a>, lexicon: &'a Lexicon) -> Self {
        Self {
            scene,
            lexicon,
            chunks,
            topic: Vec::new(),
            fresh: false,
            listing: false,
            frozen: false,
            before: Vec::new(),
            named: None,
            recent: Vec::new(),
            listed: Vec::new(),
            pending: None,
            same: false,
            unapplied: false,
            front: None,
            place: None,
            liquid: None,
            taken: Vec::new(),
            homeless: None,
            contents: false,
            acted: false,
            moved: false,
            leading: None,
            denied: false,
            leaves: false,
            tells: false,
            saying: Saying::default(),
        }
    }

    fn nothing_is_open(&self) -> bool {
        !self.fresh && self.homeless.is_none() && self.leading.is_none() && self.liquid.is_none()
    }

    fn chunk(&self, at: usize) -> Option<&'a Chunk> {
        self.chunks.get(at)
    }

    fn chunk_before(&self, at: usize) -> Option<&'a Chunk> {
        self.chunks.get(at.wrapping_sub(1))
    }

    /// Whether a part of the sentence ends behind a place.
    fn ends_behind(&self, at: usize) -> bool {
        self.chunk(at + 1).is_none_or(Chunk::ends_part)
    }

    /// Whether a part of the sentence begins at a place.
    fn opens(&self, at: usize) -> bool {
        self.chunk_before(at).is_none_or(Chunk::ends_part)
    }

    /// Takes in the part at a place; nothing if it cannot be told what it belongs to.
    fn take(&mut self, at: usize) -> Option<()> {
        match &self.chunks[at] {
            Chunk::Thing(thing) => self.thing(at, thing),
            Chunk::Again(again) => self.again(at, *again),
            Chunk::Place(relation, preposition, place) => self.placed(at, *relation, preposition, place),
            Chunk::State(words, set) => self.state(at, words, set),
            Chunk::Act(doing) => self.doing(at, doing),
            Chunk::Liquid(liquid) => self.liquid(at, liquid),
            Chunk::Likewise => self.likewise(at),
            Chunk::Moves(somewhere) => self.moves(somewhere.clone()),
            Chunk::Other(word) => self.other(at, word),
            Chunk::Stop => self.stop(),
            Chunk::Hard => None,
            Chunk::Deny => {
                self.denied = true;
                Some(())
            }
            Chunk::Beside => {
                self.tells = matches!(self.chunk(at + 1), Some(Chunk::Place(..)));
                self.listing = false;
                Some(())
            }
            Chunk::With(_) => {
                self.with(at);
                Some(())
            }
            Chunk::Holds => {
                let thing = self.topic.last()?.clone();
                if !matches!(self.chunk(at + 1), Some(Chunk::Liquid(_))) {
                    self.front = Some(at_thing(&["in".to_owned()], &thing));
                    (self.fresh, self.listing) = (false, false);
                }
                Some(())
            }
            Chunk::But => {
                self.leaves = matches!(self.chunk(at + 1), Some(Chunk::Moves(None)));
                self.ends_in_denial();
                (self.tells, self.denied) = (false, false);
                Some(())
            }
            Chunk::Join(_) => {
                // "is foggy and smeared"
                self.tells &= matches!(self.chunk(at + 1), Some(Chunk::State(..) | Chunk::Act(_)));
                self.ends_in_denial();
                Some(())
            }
            // "should not stay out"
            Chunk::Stays if self.denied => {
                self.denied = !matches!(self.chunk(at + 1), Some(Chunk::Other(_) | Chunk::Stop));
                Some(())
            }
            Chunk::Stays if matches!(self.chunk(at + 1), Some(Chunk::Place(..) | Chunk::State(..))) => {
                Some(())
            }
            Chunk::Stays => {
                (self.frozen, self.fresh, self.homeless) = (true, false, None);
                Some(())
            }
            Chunk::Tells => {
                // "the tomato is old": told of it, and no more.
                let whole = !matches!(self.chunk(at + 1), Some(Chunk::Place(..) | Chunk::State(..)));
                self.fresh &= !whole;
                (self.tells, self.listing) = (true, false);
                Some(())
            }
            Chunk::Wish => {
                (self.tells, self.listing, self.acted, self.pending) = (false, false, false, None);
                Some(())
            }
            Chunk::Which => {
                let named = self.named.clone()?;
                self.change_topic(vec![named]);
                Some(())
            }
        }
    }

    fn moves(&mut self, somewhere: Option<String>) -> Option<()> {
        (self.pending, self.same, self.moved, self.acted, self.contents) = (None, false, true, false, false);
        let lost = std::mem::replace(&mut self.homeless, somewhere);
        self.listing = false;
        lost.is_none().then_some(())
    }

    /// "lay the table with the plate and the fork": they go there.
    fn with(&mut self, at: usize) {
        self.listing = self.homeless.is_some();
        let things = matches!(self.chunk(at + 1), Some(Chunk::Thing(_)));
        let vessel = matches!(self.chunk_before(at), Some(Chunk::Thing(thing))
            if self.affords(thing, "receptacle") && self.affords(thing, "pickupable"));
        self.contents = vessel && things && self.homeless.is_some();
        if let [table] = self.topic.as_slice()
            && self.fresh
            && self.moved
            && things
            && self.is_fixed_holder(table)
        {
            self.front = Some(at_thing(&["on".to_owned()], table));
            (self.fresh, self.homeless) = (false, None);
            self.change_topic(Vec::new());
        }
    }

    fn stop(&mut self) -> Option<()> {
        self.ends_in_denial();
        self.put_with_the_rest();
        (self.tells, self.denied, self.pending, self.front, self.same) = (false, false, None, None, false);
        (self.moved, self.listing, self.leaves) = (false, false, false);
        self.homeless.is_none().then_some(())
    }

    /// "put the dishes on the table: the plate and the cup."
    fn put_with_the_rest(&mut self) {
        let place = self.saying.place_of_them(&self.topic).filter(|_| self.fresh).map(<[String]>::to_vec);
        if let Some(place) = place {
            self.put(&place);
        }
    }

    /// "the desk lamp lit, the floor lamp not"
    fn ends_in_denial(&mut self) {
        if self.denied && self.fresh && self.listing {
            if matches!(self.saying.last, Some(Last::State(_))) {
                self.saying.not_so(&self.topic);
                self.said();
            } else if self.topic.iter().all(|thing| self.affords(thing, "toggleable")) {
                // "no lights"
                self.saying.so(&self.topic, &["on".to_owned()], true);
                self.said();
            }
        }
        self.denied &= self.fresh;
    }

    /// A word nobody knows where an order would stand, with something to do it to, is an order nobody knows.
    fn other(&mut self, at: usize, word: &str) -> Option<()> {
        if let Some(verb) = self.homeless.clone()
            && self.ends_behind(at)
            && self.has_particle(&verb, word)
            && !self.topic.is_empty()
        {
            // "throw the apple away"
            self.saying.done(&self.topic, &[verb, word.to_owned()]);
            self.said();
            return Some(());
        }
        let opens = self.opens(at);
        let object = match self.chunk(at + 1) {
            Some(Chunk::Thing(thing)) => !thing.absent && is_determiner(&thing.words[0]),
            Some(Chunk::Again(_)) => true,
            Some(Chunk::Other(next)) => ["the", "my", "our", "a", "an"].contains(&next.as_str()),
            _ => false,
        };
        self.listing &= opens || word.ends_with("ly");
        let known = is_function_word(word)
            || !self.lexicon.verbs(word).is_empty()
            || ["namely", "including", "yes"].contains(&word)
            || ["polite", "asides", "sequence", "parallel", "modifiers", "real"]
                .iter()
                .any(|list| self.lexicon.is_small(list, &[word]));
        (!opens || !object || known).then_some(())
    }

    /// Whether a thing stands where it is and other things go in or on it.
    fn is_fixed_holder(&self, thing: &Thing) -> bool {
        self.affords(thing, "receptacle") && !self.affords(thing, "pickupable")
    }

    fn affords(&self, thing: &Thing, affordance: &str) -> bool {
        thing.kinds.iter().any(|kind| self.scene.affords(kind, affordance))
            || affordance == "toggleable"
                && thing.kinds.iter().any(|kind| self.lexicon.control(kind).is_some())
            || affordance == "pickupable" && thing.kinds.is_empty()
    }

    /// "the statue likewise", "same for the lettuce"
    fn likewise(&mut self, at: usize) -> Option<()> {
        if self.fresh && self.listing && matches!(self.chunk_before(at), Some(Chunk::Thing(_))) {
            return self.as_before();
        }
        // "and a cup of water too"
        if let (Some(Chunk::Liquid(_)), Some((place, _))) = (self.chunk_before(at), self.place.clone()) {
            self.put(&place);
        }
        self.same = matches!(self.chunk(at + 1), Some(Chunk::Thing(_)));
        Some(())
    }

    /// Says of the topic what was said last.
    fn as_before(&mut self) -> Option<()> {
        self.saying.last_of(&self.topic)?;
        self.said();
        Some(())
    }

    fn said(&mut self) {
        (self.fresh, self.denied, self.homeless) = (false, false, None);
        self.listing &= self.pending.is_some();
    }
}

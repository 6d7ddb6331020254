//! The plainest sentences: "wash the cup . put it in the sink . it should be open ."

use super::super::inflect;
use super::super::syntax::is_determiner;
use super::chunk::Thing;

/// What was said last of something.
#[derive(Clone, Debug, PartialEq)]
pub enum Last {
    /// Where it goes.
    Place(Vec<String>),
    /// What it should be.
    State(Vec<String>),
    /// What is done to it.
    Done(Vec<String>),
}

/// What has been said.
#[derive(Default)]
pub struct Saying {
    /// In words.
    pub said: Vec<String>,
    /// Of what the last sentence is.
    of: Vec<Thing>,
    /// What was put somewhere last, and where.
    placed: Option<(Vec<Thing>, Vec<String>)>,
    /// What was named: "a drawer" is "the drawer" from then on.
    known: Vec<Thing>,
    /// What it says.
    pub last: Option<Last>,
}

impl Saying {
    /// "put it in the sink"
    pub fn put(&mut self, things: &[Thing], place: &[String]) {
        self.say("put");
        self.name(things, true);
        self.said.extend(place.iter().cloned());
        self.placed = Some((things.to_vec(), place.to_vec()));
        self.end(things, Last::Place(place.to_vec()));
    }

    /// "wash it", "turn it off"
    pub fn done(&mut self, things: &[Thing], verb: &[String]) {
        let (first, particles) = verb.split_first().map_or((None, verb), |(first, rest)| (Some(first), rest));
        self.said.extend(first.cloned());
        self.name(things, true);
        self.said.extend(particles.iter().cloned());
        self.end(things, Last::Done(verb.to_vec()));
    }

    /// "cook it in the pan": where what was said last is done.
    pub fn there(&mut self, place: &[String]) {
        self.said.pop();
        self.said.extend(place.iter().cloned());
        self.say(".");
    }

    /// "fill it with water"
    pub fn filled(&mut self, things: &[Thing], liquid: &str) {
        self.say("fill");
        self.name(things, true);
        self.say("with");
        self.say(liquid);
        self.end(things, Last::Done(vec!["fill".to_owned()]));
    }

    /// "it should (not) be clean"
    pub fn so(&mut self, things: &[Thing], state: &[String], denied: bool) {
        self.name(things, false);
        self.say("should");
        if denied {
            self.say("not");
        }
        self.say("be");
        self.said.extend(state.iter().cloned());
        self.end(things, Last::State(state.to_vec()));
    }

    /// Says of other things that they should not be what was said last.
    pub fn not_so(&mut self, things: &[Thing]) {
        if let Some(Last::State(state)) = self.last.clone() {
            self.so(things, &state, true);
        }
    }

    /// Says of other things what was said last.
    pub fn last_of(&mut self, things: &[Thing]) -> Option<()> {
        match self.last.clone()? {
            Last::Place(place) => self.put(things, &place),
            Last::State(state) => self.so(things, &state, false),
            Last::Done(verb) => self.done(things, &verb),
        }
        Some(())
    }

    /// "put the dishes on the table: the plate and the cup": where they go, if they are some of what was put there.
    pub fn place_of_them(&self, things: &[Thing]) -> Option<&[String]> {
        let (put, place) = self.placed.as_ref()?;
        let kinds = || put.iter().flat_map(|thing| &thing.kinds);
        let member = |thing: &Thing| {
            !put.contains(thing) && thing.kinds.first().is_some_and(|kind| kinds().any(|of| of == kind))
        };
        (kinds().count() > 1 && things.iter().all(member)).then_some(place)
    }

    fn say(&mut self, word: &str) {
        self.said.push(word.to_owned());
    }

    fn end(&mut self, things: &[Thing], last: Last) {
        self.say(".");
        self.of = things.to_vec();
        self.last = Some(last);
    }

    fn name(&mut self, things: &[Thing], object: bool) {
        if self.of == things {
            let several = things.len() > 1 || things.iter().any(|thing| thing.plural);
            self.say(match (several, object) {
                (true, true) => "them",
                (true, false) => "they",
                _ => "it",
            });
            return;
        }
        for (number, thing) in things.iter().enumerate() {
            if number > 0 {
                self.say("and");
            }
            let thing = if self.known.contains(thing) { &again(thing) } else { thing };
            self.said.extend(name(thing));
        }
        self.known.extend(things.iter().cloned());
    }
}

/// A thing as it is named again: "a drawer", then "the drawer".
pub fn again(thing: &Thing) -> Thing {
    let mut thing = thing.clone();
    if ["a", "an", "one"].contains(&thing.words[0].as_str()) && thing.words.len() > 1 {
        thing.words[0] = "the".to_owned();
    }
    thing
}

/// A thing's name, with an article.
pub fn name(thing: &Thing) -> Vec<String> {
    let first = &thing.words[0];
    let bare = !is_determiner(first) && inflect::number(first).is_none();
    // "cell phones" are some of them, "the cell phones" all.
    let article = (bare && !thing.plural).then(|| "the".to_owned());
    article.into_iter().chain(thing.words.iter().cloned()).collect()
}

//! Whether words tell something or order it.

use super::super::inflect::VerbForm;
use super::super::lexicon::{LONGEST, Lexicon};
use super::super::syntax::{is_determiner, is_function_word, preposition};
use super::super::text::{POSSESSIVE, Token};

/// What is and has been, and what will be.
const AUXILIARIES: [&str; 24] = [
    "is", "are", "am", "was", "were", "has", "have", "had", "been", "will", "wont", "can", "cant", "cannot",
    "could", "couldnt", "does", "doesnt", "did", "didnt", "isnt", "arent", "might", "may",
];

/// What asks for something.
const WISHES: [&str; 20] = [
    "want", "wants", "need", "needs", "prefer", "prefers", "rather", "require", "requires", "fancy",
    "should", "must", "shall", "ought", "shouldnt", "mustnt", "expect", "insist", "deserves", "wish",
];

/// What says no.
const DENIALS: [&str; 6] = ["dont", "doesnt", "not", "never", "didnt", "wont"];

/// What may stand before what is told, beside the subordinators.
const JOINS: [&str; 7] = ["and", "but", "so", "that", "or", "then", "though"];

fn joins(word: &str) -> bool {
    JOINS.contains(&word) || super::SUBORDINATORS.contains(&word)
}

/// Somebody, by no name.
const PERSONS: [&str; 14] = [
    "i",
    "we",
    "he",
    "she",
    "nobody",
    "noone",
    "somebody",
    "someone",
    "everybody",
    "everyone",
    "people",
    "anybody",
    "anyone",
    "who",
];

/// The words of a part and what is known of them.
pub(super) struct Said<'w> {
    pub(super) words: &'w [String],
    pub(super) named: Vec<bool>,
    /// A thing of the scene is named, or things of a sort.
    pub(super) thing: bool,
    /// A thing of the scene is named by its own name.
    pub(super) own_name: bool,
    /// A colon stands behind it.
    pub(super) colon: bool,
    /// It begins a sentence.
    pub(super) sentence: bool,
    /// It ends with more than a comma.
    pub(super) ends: bool,
}

/// Contractions in full: "I'm" is "i am", "it's" is "it is".
pub(super) fn spelled_out(tokens: &[Token]) -> Vec<String> {
    let mut words = Vec::with_capacity(tokens.len() + 2);
    for (index, token) in tokens.iter().enumerate() {
        if [",", "."].contains(&token.text.as_str()) {
            break;
        }
        let next = tokens.get(index + 1).map_or("", |next| next.text.as_str());
        let typed = token.typed.to_lowercase().replace('\u{2019}', "'");
        let opens = index == 0 || joins(&tokens[index - 1].text);
        let said: &[&str] = match token.text.as_str() {
            "im" => &["i", "am"],
            "ive" => &["i", "have"],
            "ill" if typed == "i'll" || opens => &["i", "will"],
            "id" => &["i", "would"],
            "were" if typed == "we're" => &["we", "are"],
            "well" if typed == "we'll" => &["we", "will"],
            "weve" => &["we", "have"],
            "wed" if typed == "we'd" => &["we", "would"],
            "theyre" => &["they", "are"],
            "theyve" => &["they", "have"],
            "theyll" => &["they", "will"],
            "thatll" => &["that", "will"],
            "itll" => &["it", "will"],
            "therell" => &["there", "will"],
            "youre" => &["you", "are"],
            "youve" => &["you", "have"],
            "youll" => &["you", "will"],
            "hed" => &["he", "would"],
            "shed" if typed == "she'd" => &["she", "would"],
            "hell" if typed == "he'll" => &["he", "will"],
            "shell" if typed == "she'll" => &["she", "will"],
            "s" | POSSESSIVE
                if index > 0 && ["left", "taken", "been", "gone", "got", "put"].contains(&next) =>
            {
                &["has"]
            }
            "s" | POSSESSIVE if index > 0 && !next.is_empty() => &["is"],
            _ => &[],
        };
        if said.is_empty() {
            words.push(token.text.clone());
            if typed.ends_with("'s") && token.text != POSSESSIVE && next != POSSESSIVE && token.text != "let"
            {
                words.push("is".to_owned());
            }
        } else {
            words.extend(said.iter().map(|&word| word.to_owned()));
        }
    }
    words
}

/// How many words at the start name somebody who is no robot: "my wife", "the kids", "Mrs Doyle", "we".
pub(super) fn person(words: &[String], named: &[bool], lexicon: &Lexicon) -> Option<usize> {
    let first = words.first()?.as_str();
    if PERSONS.contains(&first) {
        return Some(1);
    }
    let people = |at: usize| {
        let rest: Vec<&str> = words[at.min(words.len())..].iter().take(LONGEST).map(String::as_str).collect();
        if rest.is_empty() { None } else { lexicon.longest_small("people", &rest) }
    };
    if let Some(length) = people(0) {
        let titled = ["mr", "mrs", "ms", "miss", "dr", "aunt", "uncle"].contains(&first);
        return Some(length + usize::from(titled && words.len() > length));
    }
    let owned = is_determiner(first) || ["both", "all"].contains(&first);
    if owned {
        // "my older sister", "the two kids"
        return (1..3).find_map(|at| people(at).map(|length| at + length));
    }
    named.first().is_some_and(|named| *named).then_some(1)
}

/// Whether what stands behind a thing tells something of it that is no wish: "stinks", "has gone a bit funny", "is
/// still fine".
pub(super) fn tells_of_a_thing(words: &[String], lexicon: &Lexicon) -> bool {
    let Some(first) = words.first() else { return false };
    let has = |any: &[&str]| words.iter().any(|word| any.contains(&word.as_str()));
    let going = super::is_placed(first);
    let be = first == POSSESSIVE || ["is", "are", "was", "were", "has", "have"].contains(&first.as_str());
    let verb = first.ends_with('s') && !first.ends_with("ss") && first.len() > 3
        || ["stink", "smell", "look", "creep", "annoy", "bother", "scare"].contains(&first.as_str());
    !has(&WISHES)
        && !has(&["to", "be", "nicer", "better", "gets", "takes", "can", "not"])
        && !going
        && (be || verb)
        && lexicon.longest_small("idioms", &[first]).is_none()
}

/// "get the room ready for it", "sort that out": of what was said before.
pub(super) fn refers_back(words: &[String]) -> bool {
    let vague = ["get", "sort", "see", "deal", "fix", "prepare"].contains(&words[0].as_str())
        || words.len() > 1 && ["and", "so"].contains(&words[0].as_str());
    vague
        && words.iter().any(|word| ["it", "that", "this"].contains(&word.as_str()))
        && !words.iter().any(|word| ["make", "turn", "want", "need"].contains(&word.as_str()))
}

impl Said<'_> {
    fn at(&self, index: usize) -> &str {
        self.words.get(index).map_or("", String::as_str)
    }

    fn has(&self, from: usize, any: &[&str]) -> bool {
        self.words.iter().skip(from).any(|word| any.contains(&word.as_str()))
    }

    /// How many words join it to what is said before: "that" in "that is how I like it" does not.
    fn joins(&self) -> usize {
        let that = |at: usize| self.at(at) == "that" && AUXILIARIES.contains(&self.at(at + 1));
        (0..self.words.len()).take_while(|&at| joins(self.at(at)) && !that(at)).count()
    }

    /// Whether something is wished for, from a place on.
    fn wishes(&self, from: usize) -> bool {
        let wisher = ["would", "i", "we", "he", "she", "they", "really", "also", "d"];
        self.has(from, &WISHES)
            || (from.max(1)..self.words.len())
                .any(|at| ["like", "love"].contains(&self.at(at)) && wisher.contains(&self.at(at - 1)))
    }

    /// Whether it tells something and orders nothing.
    pub(super) fn is_remark(&self, lexicon: &Lexicon) -> bool {
        if self.only_calls(lexicon) {
            return true;
        }
        let joins = self.joins();
        let joined = (0..joins).any(|at| !["and", "but", "then", "or", "that", "so"].contains(&self.at(at)))
            || self.at(0) == "so" && self.at(1) == "that";
        let start = joins + self.fillers(joins, lexicon);
        match self.at(start) {
            "you" => joined && self.says_when_you_are_done(start),
            "it" | "that" | "this" | "there" | "they" | "these" | "those" => {
                let when = joined && !["because", "since", "as", "so"].contains(&self.at(0));
                !when && self.is_of_a_thing(start, lexicon)
            }
            _ => self.is_of_somebody(start, joined, lexicon) || self.is_of_something_else(start, lexicon),
        }
    }

    /// "do whatever needs doing", "see what you can do": an order that leaves open what to do, and names nothing.
    pub(super) fn is_vague(&self, lexicon: &Lexicon) -> bool {
        let start = self.joins();
        let start = start + self.fillers(start, lexicon);
        let opens = |from: usize| {
            let rest: Vec<&str> = self.words.iter().skip(from).take(LONGEST).map(String::as_str).collect();
            !rest.is_empty() && lexicon.longest_small("vague", &rest).is_some()
        };
        // "anything that cheers him up is welcome"
        let welcome = ["anything", "whatever", "everything", "any"].iter().any(|any| self.at(start) == *any)
            && self.words.last().is_some_and(|word| ["welcome", "appreciated"].contains(&word.as_str()));
        !self.thing && (welcome || (0..=start).any(opens))
    }

    /// "well", "oh", "also": how many words.
    fn fillers(&self, from: usize, lexicon: &Lexicon) -> usize {
        (from..self.words.len()).take_while(|&at| lexicon.is_small("chatter", &[self.at(at)])).count()
    }

    /// "Thanks", "poor thing", "hello robots", "movie time": words that only greet, thank, call or head.
    fn only_calls(&self, lexicon: &Lexicon) -> bool {
        let joins = self
            .words
            .iter()
            .take_while(|word| ["and", "but", "or", "then"].contains(&word.as_str()))
            .count();
        let mut at = joins;
        while at < self.words.len() {
            let rest: Vec<&str> = self.words[at..].iter().take(LONGEST).map(String::as_str).collect();
            match lexicon.longest_small("chatter", &rest) {
                Some(length) => at += length,
                None => break,
            }
        }
        let named = |at: usize| lexicon.is_small("headings", &[self.at(at)]);
        let heading = (self.sentence || self.ends)
            && self.words.len() <= 4
            && !self.own_name
            && (1..self.words.len()).any(named)
            && !self.has(0, &["it", "of", "for", "in", "on", "at", "with"])
            && (lexicon.verbs(self.at(0)).is_empty() || self.words.len() == 2)
            || self.sentence && self.at(0) == "for" && self.words.len() <= 4 && !self.own_name && !self.ends
            || self.sentence && self.words.concat() == "goodnight";
        let time = self.sentence
            && self.at(1) == "time"
            && (self.words.len() == 2
                || ["for", "everyone", "everybody", "guys", "people", "folks", "kids"].contains(&self.at(2)))
            && self.words.len() <= 5;
        let anyone = self.at(0) == "if"
            && ["anyone", "anybody", "someone", "somebody"].contains(&self.at(1))
            && !self.thing;
        // "To wrap up after the party, …"
        let purpose = self.sentence && self.at(0) == "to" && !self.ends && !self.own_name;
        at >= self.words.len() && at > joins
            || heading
            || purpose
            || time
            || anyone
            || !self.own_name && self.opens_a_remark(lexicon)
    }

    /// "off to Spain for a week", "don't care who does it": by its first words.
    fn opens_a_remark(&self, lexicon: &Lexicon) -> bool {
        let rest: Vec<&str> = self.words.iter().take(LONGEST).map(String::as_str).collect();
        lexicon.longest_small("remarks", &rest).is_some()
    }

    /// "when you get a minute", "once you've done that", "while you are up": no more than when.
    fn says_when_you_are_done(&self, start: usize) -> bool {
        const DONE: [&str; 20] = [
            "get", "have", "are", "go", "leave", "can", "find", "got", "done", "finished", "finish", "do",
            "come", "head", "pass", "wake", "think", "like", "please", "feel",
        ];
        !self.thing
            && self.words.len() - start <= 7
            && DONE.contains(&self.at(start + 1))
            && !self.has(start + 2, &["it", "them", "everything", "slices"])
    }

    /// "it's a hot day", "that's it", "there's space": of no thing that is named, nor what shall be.
    fn is_of_a_thing(&self, start: usize, lexicon: &Lexicon) -> bool {
        const TELLS: [&str; 12] = [
            "is", "are", "was", "were", "has", "have", "look", "distract", "hurt", "bother", "stink", "smell",
        ];
        const ASKS: [&str; 9] =
            ["needs", "gets", "wants", "contains", "holds", "receives", "requires", "ends", "does"];
        const ADVERBS: [&str; 8] = ["never", "always", "just", "still", "really", "only", "also", "already"];
        let start = start + usize::from(ADVERBS.contains(&self.at(start + 1)));
        let (verb, next) = (self.at(start + 1), self.at(start + 2));
        // "that is how I like it", "that will do"
        let says_how = ["is", "was"].contains(&verb)
            && ["how", "what", "why", "where", "when"].contains(&next)
            || verb == "will" && ["do", "be"].contains(&next);
        if says_how && !self.thing && !self.has(start, &["should", "must", "shall"]) {
            return true;
        }
        let does = self.third_person(start + 1, lexicon) && !super::is_placed(verb) && !ASKS.contains(&verb);
        let perfect = ["has", "have", "is"].contains(&verb) && next == "been";
        (TELLS.contains(&verb) || does)
            && (!self.own_name || perfect)
            && !self.wishes(start)
            && !self.has(start, &["to", "you", "if"])
    }

    /// "my doctor says more veg", "I'm packing", "nobody is watching".
    fn is_of_somebody(&self, start: usize, joined: bool, lexicon: &Lexicon) -> bool {
        let named = self.named.get(start..).unwrap_or_default();
        let Some(length) = person(&self.words[start..], named, lexicon) else { return false };
        let verb = self.behind_place(start + length, lexicon);
        let speaker = ["i", "we"].contains(&self.at(start));
        let negated = self.has(verb, &DENIALS);
        let wished = self.wishes(verb) && (!negated || self.own_name)
            || self.has(verb, &["have", "has"]) && self.at(verb + 1) == "to";
        let asked = self.has(verb, &["you", "robots", "robot", "if"]);
        let told = verb < self.words.len()
            && self.finite(verb, lexicon)
            && !["mean", "meant", "else"].contains(&self.at(verb));
        // "somebody wash the cup": an order.
        let anybody =
            ["somebody", "someone", "anybody", "anyone", "everyone", "everybody"].contains(&self.at(start));
        let order = anybody && !AUXILIARIES.contains(&self.at(verb)) && !self.is_past(verb, lexicon)
            || anybody && ["can", "could", "will"].contains(&self.at(verb));
        let needless = !speaker && negated && self.has(verb, &["need"]);
        // "Grandma wants her tea", "the dog has to be walked": it is asked for; "she wants me to rest" is not.
        let asks = ["wants", "want", "needs", "need", "would"].contains(&self.at(verb))
            && !negated
            && !(["me", "us", "him", "her"].contains(&self.at(verb + 1)) && self.at(verb + 2) == "to")
            || ["has", "have"].contains(&self.at(verb))
                && self.at(verb + 1) == "to"
                && self.at(verb + 2) == "be";
        if asks && !needless {
            return false;
        }
        if !told || asked || order || wished && !needless && (speaker || self.own_name) {
            return false;
        }
        // "my brother left his laptop on the table": it is told of what is to be brought.
        // "I think it is in some drawer"
        let thinks = speaker
            && ["think", "know", "believe", "guess", "suppose", "reckon", "bet", "hope"]
                .contains(&self.at(verb))
            && self.has(verb, &["it", "they", "theyre", "its", "he", "she"]);
        // "I'm packing the box", not "I'm sick of that box"
        let next = self.at(verb + 1);
        let going = next.ends_with("ing") || ["off", "about", "just", "not", "still", "only"].contains(&next);
        let under_way = ["am", "are"].contains(&self.at(verb)) && going;
        let later = thinks
            || needless
            || speaker && (self.at(verb) == "will" || under_way)
            || self.has(verb, &["myself", "ourselves", "later", "tomorrow", "already", "again"]) && speaker;
        !self.own_name || later || joined
    }

    /// The verb behind "(the lady) from the charity".
    fn behind_place(&self, at: usize, lexicon: &Lexicon) -> usize {
        if !["from", "of", "with", "next", "at", "in"].contains(&self.at(at)) {
            return at;
        }
        let found = (at + 2..self.words.len().min(at + 6))
            .find(|&at| AUXILIARIES.contains(&self.at(at)) || self.third_person(at, lexicon));
        found.unwrap_or(at)
    }

    /// "Camp starts tomorrow", "the sun is killing me": of nothing that is here.
    fn is_of_something_else(&self, start: usize, lexicon: &Lexicon) -> bool {
        let determined = is_determiner(self.at(start));
        if self.thing || self.wishes(start) || self.has(start, &["you", "please", "to", "it", "them"]) {
            return false;
        }
        let furthest = (start + 5).min(self.words.len());
        let verb = (start + 1..furthest).find(|&at| {
            AUXILIARIES.contains(&self.at(at))
                || determined && at > start + 1 && self.third_person(at, lexicon)
        });
        let when =
            self.has(start, &["tomorrow", "today", "tonight", "later", "soon", "monday", "noon", "weekend"]);
        let verb = verb.or_else(|| {
            (when && self.third_person(start + 1, lexicon) && !self.orders_first(start, lexicon))
                .then_some(start + 1)
        });
        verb.is_some() && !self.orders_first(start, lexicon)
    }

    /// Whether its first word is an order: known as one, or followed by what it is done to.
    fn orders_first(&self, start: usize, lexicon: &Lexicon) -> bool {
        let word = self.at(start);
        !is_determiner(word)
            && (lexicon.verbs(word).iter().any(|(form, _, _)| *form == VerbForm::Base)
                || is_determiner(self.at(start + 1)))
    }

    fn is_past(&self, at: usize, lexicon: &Lexicon) -> bool {
        let word = self.at(at);
        word.ends_with("ed")
            || [
                "left", "went", "came", "made", "got", "forgot", "took", "told", "said", "put", "broke",
                "spilt", "let",
            ]
            .contains(&word)
            || lexicon.verbs(word).iter().any(|(form, _, _)| *form == VerbForm::Past)
    }

    fn third_person(&self, at: usize, lexicon: &Lexicon) -> bool {
        let word = self.at(at);
        word.ends_with('s')
            && !word.ends_with("ss")
            && word.len() > 3
            && !is_function_word(word)
            && !["things", "pieces", "slices", "items", "halves", "both"].contains(&word)
            && (lexicon.noun(&[word]).is_none() || !lexicon.verbs(word).is_empty())
    }

    /// Whether somebody does or is something here.
    fn finite(&self, at: usize, lexicon: &Lexicon) -> bool {
        let speaks =
            ["i", "we", "people", "who"].contains(&self.at(at - 1)) || self.at(at - 1).ends_with('s');
        let word = self.at(at);
        AUXILIARIES.contains(&word)
            || self.third_person(at, lexicon)
            || self.is_past(at, lexicon)
            || speaks && word.len() > 1 && !is_determiner(word) && preposition(&[word]).is_none()
            || DENIALS.contains(&word)
            || ["just", "always", "actually", "really", "still", "already", "both", "only"].contains(&word)
                && at + 1 < self.words.len()
                && self.finite_behind(at + 1, lexicon)
    }

    fn finite_behind(&self, at: usize, lexicon: &Lexicon) -> bool {
        AUXILIARIES.contains(&self.at(at)) || self.third_person(at, lexicon) || self.at(at).len() > 2
    }
}

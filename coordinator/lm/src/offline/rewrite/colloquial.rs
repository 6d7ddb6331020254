//! Small turns of everyday speech, said plainly: "smells off", "up to the brim", "before it gets wet", "the lamp of the
//! desk", "two of the three rolls", "what I'm hungry for is …".

use super::{Rewriting, SHALL};
use crate::offline::clause::is_going;
use crate::offline::syntax::{LIQUIDS, is_determiner};
use crate::offline::text::POSSESSIVE;

/// What wishes for something, and is said first: "what I'm hungry for is …".
const HUNGRY_FOR: [&[&str]; 6] = [
    &["hungry", "for"],
    &["in", "the", "mood", "for"],
    &["longing", "for"],
    &["dying", "for"],
    &["looking", "for"],
    &["after"],
];

/// Said of food that nobody wants any more.
const SPOILT: [&str; 7] = ["smells", "smelled", "smelt", "tastes", "looks", "gone", "went"];

impl Rewriting<'_> {
    /// All of them.
    pub(super) fn colloquialisms(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            self.two_adjectives(index);
            self.gone_off(index);
            self.of_today(index);
            self.filled_to_the_brim(index);
            self.hungry_for(index);
            self.why_not(index);
            self.whichever(index);
            self.of_the_desk(index);
            self.let_it_lie(index);
            self.want_to_have(index);
            self.some_of_so_many(index);
            self.while_it_shines(index);
            self.loaded_with(index);
            self.among(index);
            self.room_is_made(index);
            self.left_where_it_is_found(index);
            self.plate_them(index);
            self.made_from(index);
            self.before_a_meal(index);
            self.plate_at_the_table(index);
            self.each_of_them_so(index);
            self.too_much(index);
            self.needed_there(index);
            self.keeps_holding(index);
            self.filled_by_the_machine(index);
            self.until_cold(index);
            self.done_beforehand(index);
            self.slice_of_toast(index);
            self.finally_rest(index);
            index += 1;
        }
    }

    /// "cold, sliced tomato": cold sliced tomato.
    fn two_adjectives(&mut self, index: usize) {
        let state = |at: usize| self.lexicon.adjective(&[self.at(at)]).is_some();
        let noun = |at: usize| self.lexicon.noun(&[self.at(at)]).is_some() && !state(at);
        let before = self.at(index.wrapping_sub(2)).to_owned();
        let opens = index > 1 && (is_determiner(&before) || self.is_order(index - 2));
        if self.at(index) == "," && opens && state(index - 1) && state(index + 1) && noun(index + 2) {
            self.say(index, index + 1, &[]);
        }
    }

    /// "the egg smells off": bad.
    fn gone_off(&mut self, index: usize) {
        if index > 0 && self.at(index) == "off" && SPOILT.contains(&self.at(index - 1)) {
            self.say(index, index + 1, &["bad"]);
        }
    }

    /// "today's newspaper": the newspaper.
    fn of_today(&mut self, index: usize) {
        let day = ["today", "yesterday", "tonight", "tomorrow"].contains(&self.at(index));
        if day && self.at(index + 1) == POSSESSIVE && self.lexicon.noun(&[self.at(index + 2)]).is_some() {
            self.say(index, index + 2, &["the"]);
        }
    }

    /// "fill it (right up) to the brim": fill it.
    fn filled_to_the_brim(&mut self, index: usize) {
        let brim = ["brim", "top", "rim"].contains(&self.at(index + 2)) && self.starts(index, &["to", "the"]);
        let start = self.clause_start(index);
        let pours = |at: usize| LIQUIDS.contains(&self.at(at)) || self.at(at).starts_with("fill");
        let before = self.clause_start(start.saturating_sub(1));
        if !brim || !(before..index).any(pours) {
            return;
        }
        let how = (start..index)
            .rev()
            .take_while(|&at| ["right", "up", "all", "the", "way", "almost"].contains(&self.at(at)))
            .count();
        let alone = index - how == start && start > 0 && self.is_mark(index + 3);
        self.say(index - how - usize::from(alone), index + 3, &[]);
    }

    /// "the wine needs chilling before dinner": only when.
    fn before_a_meal(&mut self, index: usize) {
        const MEALS: [&str; 8] =
            ["dinner", "lunch", "breakfast", "supper", "bed", "bedtime", "school", "work"];
        let when = ["before", "after"].contains(&self.at(index)) && MEALS.contains(&self.at(index + 1));
        let start = self.clause_start(index);
        let told = (start..index).any(|at| {
            let things = at > 0 && ["things", "items", "they", "it"].contains(&self.at(at - 1));
            ["need", "needs", "should", "must"].contains(&self.at(at))
                && (things || self.noun_before(at).is_some())
        });
        if when && told && self.is_mark(index + 2) {
            self.say(index, index + 2, &[]);
        }
    }

    /// "what I am hungry for is …": I want it.
    fn hungry_for(&mut self, index: usize) {
        let who = match (self.at(index + 1), self.at(index + 2)) {
            ("i", "am") | ("we", "are") => 3,
            ("im" | "were", _) => 2,
            _ => return,
        };
        let Some(length) = self.one_of(index + who, &HUNGRY_FOR) else { return };
        let is = index + who + length;
        if self.at(index) == "what" && self.at(is) == "is" {
            self.say(index, is + 1, &["i", "want"]);
        }
    }

    /// "why not try a warm apple?": I want it.
    fn why_not(&mut self, index: usize) {
        let tries = ["try", "have", "get", "eat", "drink"].contains(&self.at(index + 2));
        if self.starts(index, &["why", "not"]) {
            let wish: &[&str] = if tries { &["i", "want"] } else { &[] };
            self.say(index, index + 2 + usize::from(tries), wish);
        }
    }

    /// "in whichever drawer it is in": in the drawer; ", whichever it fits": no matter.
    fn whichever(&mut self, index: usize) {
        if !["whichever", "whatever"].contains(&self.at(index)) {
            return;
        }
        let it = (index + 1..index + 5).find(|&at| ["it", "they", "its", "theyre"].contains(&self.at(at)));
        let end = self.next_mark(index, &[",", "."]);
        if let Some(it) = it.filter(|&it| it > index + 1 && self.noun_before(it).is_some()) {
            let inside = (it..end.min(it + 4)).find(|&at| ["in", "on", "inside"].contains(&self.at(at)));
            if let Some(inside) = inside {
                self.say(it, inside + 1, &[]);
                self.say(index, index + 1, &["the"]);
            }
        } else if index > 0 && self.at(index - 1) == "," && self.at(index) == "whichever" {
            self.say(index - 1, end, &[]);
        }
    }

    /// "the lamp of the desk": the desk lamp.
    fn of_the_desk(&mut self, index: usize) {
        let of = self.at(index) == "of" && is_determiner(self.at(index + 1)) && index > 0;
        let name = [self.at(index + 2).to_owned(), self.at(index.wrapping_sub(1)).to_owned()];
        let known = self.lexicon.noun(&[&name[0], &name[1]]).is_some();
        if of && known && !self.is_part(index - 1) {
            self.say(index - 1, index + 3, &[&name[0], &name[1]]);
        }
    }

    /// "let it lie in there": leave it.
    fn let_it_lie(&mut self, index: usize) {
        let it = ["it", "them"].contains(&self.at(index + 1));
        let lies = ["lie", "sit", "rest", "stay", "stand", "be", "remain"].contains(&self.at(index + 2));
        if self.at(index) == "let"
            && it
            && lies
            && (self.is_place(index + 3) || self.at(index + 3) == "there")
        {
            self.say(index + 2, index + 3, &[]);
            self.say(index, index + 1, &["leave"]);
        }
    }

    /// "I want to have it on the table", "I want to find the egg there": put it there, I want it there.
    fn want_to_have(&mut self, index: usize) {
        let wants = ["want", "like", "love", "need", "wish", "prefer"].contains(&self.at(index));
        let has = ["have", "find", "see"].contains(&self.at(index + 2)) && self.at(index + 1) == "to";
        if !wants || !has || index == 0 {
            return;
        }
        let it = ["it", "them"].contains(&self.at(index + 3)) && self.is_place(index + 4);
        let who = (0..index).rev().find(|&at| ["i", "we", "id", "wed"].contains(&self.at(at)));
        if let Some(who) = who.filter(|&who| it && index - who <= 2) {
            self.say(who, index + 3, &["put"]);
        } else if self.at(index + 2) == "find" && is_determiner(self.at(index + 3)) {
            self.say(index + 1, index + 3, &[]);
        }
    }

    /// "two of the three rolls": two rolls.
    fn some_of_so_many(&mut self, index: usize) {
        if self.starts(index, &["any", "one", "of"]) {
            self.say(index, index + 1, &[]);
        }
        let number = |at: usize| crate::offline::inflect::number(self.at(at)).is_some();
        if number(index) && self.starts(index + 1, &["of", "the"]) && number(index + 3) {
            let noun = (index + 5..index + 9).any(|at| self.noun_before(at).is_some());
            if noun {
                self.say(index + 1, index + 4, &[]);
            }
        }
    }

    /// "hold it while the lamp is shining": turn the lamp on.
    fn while_it_shines(&mut self, index: usize) {
        let start = self.sentence_start(index);
        let held = (start..index).any(|at| {
            ["hold", "examine", "inspect", "look", "pick", "study", "view", "read"].contains(&self.at(at))
        });
        let is = (index + 2..index + 6).find(|&at| self.at(at) == "is");
        let Some(is) = is.filter(|_| self.at(index) == "while" && held) else { return };
        let lamp = ["lamp", "light", "lights", "candle"].contains(&self.at(is - 1));
        let on =
            ["on", "shining", "lit", "burning", "glowing", "switched", "turned"].contains(&self.at(is + 1));
        let two = usize::from(["switched", "turned"].contains(&self.at(is + 1)));
        if lamp && on && self.is_mark(is + 2 + two) && self.names_only(index + 1, is) {
            self.say(is, is + 2 + two, &[]);
            self.say(index, index + 1, &["and", "turn", "on"]);
        }
    }

    /// "the toaster loaded with sliced bread": sliced bread in the toaster.
    fn loaded_with(&mut self, index: usize) {
        let loaded =
            ["loaded", "stocked", "packed"].contains(&self.at(index)) && self.at(index + 1) == "with";
        let start = self.clause_start(index);
        let first = start + usize::from(self.at(start) == "and");
        let end = self.next_mark(index, &[",", "."]);
        if loaded && first < index && self.names_only(first, index) && self.names_only(index + 2, end) {
            let mut plain = self.words(index + 2..end);
            plain.extend(["should", "be", "in"].map(str::to_owned));
            plain.extend(self.words(first..index));
            self.say_all(first, end, &plain);
        }
    }

    /// "among the drawers": in one or the other of them.
    fn among(&mut self, index: usize) {
        let among = ["among", "amongst", "between"].contains(&self.at(index)) && self.at(index + 1) == "the";
        let start = self.clause_start(index);
        let sentence = self.sentence_start(index);
        let shared = (sentence..index).any(|at| {
            ["distribute", "spread", "divide", "share", "split", "put", "sort"].contains(&self.at(at))
        });
        let noun = self.at(index + 2).trim_end_matches('s').to_owned();
        let places = ["drawer", "cabinet", "cupboard", "shelf", "shelve", "box"].contains(&noun.as_str());
        if among && shared && places && start < index {
            let noun = if noun == "shelve" { "shelf" } else { &noun };
            self.say(index, index + 3, &["in", "a", noun]);
        }
    }

    /// "move a roll to the counter to make room": why it is done.
    fn room_is_made(&mut self, index: usize) {
        const WHY: [&[&str]; 6] = [
            &["to", "make", "room"],
            &["to", "make", "space"],
            &["to", "free", "up", "space"],
            &["to", "free", "some", "space"],
            &["to", "save", "space"],
            &["to", "make", "some", "room"],
        ];
        let Some(length) = self.one_of(index, &WHY) else { return };
        if index > 0 && !self.is_mark(index - 1) && self.is_mark(index + length) {
            self.say(index, index + length, &[]);
        }
    }

    /// "all dishes left in the sink must be washed": those in the sink.
    fn left_where_it_is_found(&mut self, index: usize) {
        let left =
            ["left", "lying", "standing", "sitting", "found", "stored", "sat"].contains(&self.at(index));
        let place = ["in", "on"].contains(&self.at(index + 1)) && is_determiner(self.at(index + 2));
        let shall = (index + 4..index + 7).find(|&at| self.noun_before(at).is_some());
        let told = shall.is_some_and(|at| SHALL[..3].contains(&self.at(at)) || is_going(self.at(at)));
        if left && place && told && index > 0 && self.noun_before(index).is_some() {
            self.say(index, index + 1, &[]);
        }
    }

    /// "slice the loaf and plate both": put both on the plate.
    fn plate_them(&mut self, index: usize) {
        let them = ["both", "all", "everything"].contains(&self.at(index + 1)) && self.is_mark(index + 2)
            || self.at(index + 1) == "the" && self.names_only(index + 1, self.next_mark(index, &[",", "."]));
        if self.at(index) == "plate" && self.opens_part(index) && index > 0 && them {
            let end = self.next_mark(index, &[",", "."]);
            self.say(end, end, &["on", "the", "plate"]);
            self.say(index, index + 1, &["put"]);
        }
    }

    /// "make a mix in the bowl from the slices": put them in the bowl; "prepare coffee in the mug": make it.
    fn made_from(&mut self, index: usize) {
        if ["prepare", "fix", "get"].contains(&self.at(index)) {
            let some = usize::from(["some", "a"].contains(&self.at(index + 1)));
            let liquid = self.at(index + 1 + some) == "coffee";
            if liquid && ["in", "into"].contains(&self.at(index + 2 + some)) {
                self.say(index, index + 1, &["make"]);
            }
            return;
        }
        let made =
            ["make", "create"].contains(&self.at(index)) && ["a", "some"].contains(&self.at(index + 1));
        let vessel = (index + 3..index + 6)
            .find(|&at| ["in", "on"].contains(&self.at(at)) && is_determiner(self.at(at + 1)));
        let Some(vessel) = vessel.filter(|_| made) else { return };
        let from = (vessel + 3..vessel + 5).find(|&at| ["from", "of", "with"].contains(&self.at(at)));
        let end = self.next_mark(index, &["."]);
        if let Some(from) = from.filter(|&from| self.noun_before(from).is_some()) {
            let mut plain = vec!["put".to_owned()];
            plain.extend(self.words(from + 1..end));
            plain.extend(self.words(vessel..from));
            self.say_all(index, end, &plain);
        }
    }

    /// "on a plate at the table": the plate is on the table.
    fn plate_at_the_table(&mut self, index: usize) {
        let vessel = ["plate", "bowl", "mug", "cup", "pan", "pot", "box"];
        let held =
            index > 2 && vessel.contains(&self.at(index - 1)) && ["on", "in"].contains(&self.at(index - 3));
        let noun = (index + 3..index + 5).find(|&at| self.noun_before(at).is_some() && !self.is_part(at));
        let table = noun.is_some_and(|end| ["table", "desk", "counter"].contains(&self.at(end - 1)));
        if self.at(index) == "at" && held && table && is_determiner(self.at(index + 1)) {
            self.say(index, index + 1, &["on"]);
        }
    }

    /// "the bowl, the mug and the cup, each of them clean": they should be.
    fn each_of_them_so(&mut self, index: usize) {
        let each =
            ["each", "all", "both"].contains(&self.at(index)) && index > 0 && self.at(index - 1) == ",";
        let of = match (self.at(index + 1), self.at(index + 2)) {
            ("of", "them" | "these") => 3,
            ("one" | "piece", _) => 2,
            _ => 1,
        };
        let freshly = usize::from(["freshly", "nicely", "properly"].contains(&self.at(index + of)));
        let state = index + of + freshly;
        let known = self.lexicon.adjective(&[self.at(state)]).is_some() && self.is_mark(state + 1);
        let listed = self.noun_before(index.wrapping_sub(1)).is_some();
        if each && known && listed {
            self.say(index - 1, state, &[".", "they", "should", "be"]);
        }
    }

    /// "too much junk on my desk: the phone goes …": why.
    fn too_much(&mut self, index: usize) {
        let opens = index == 0 || self.at(index - 1) == ".";
        let much = matches!(
            (self.at(index), self.at(index + 1)),
            ("too" | "so", "much" | "many") | ("such" | "what", "a")
        );
        let end = self.next_mark(index, &[",", "."]);
        let colon = self.tokens.get(end).is_some_and(|token| token.typed == ":");
        if opens && much && colon {
            self.say(index, end + 1, &[]);
        }
    }

    /// "he works at the desk so he needs the pen there": put it on the desk.
    fn needed_there(&mut self, index: usize) {
        let needs = ["needs", "need", "wants", "want"].contains(&self.at(index));
        let end = self.next_mark(index, &["."]);
        let there = (index + 2..end).find(|&at| self.at(at) == "there");
        let who = ["he", "she", "i", "we", "they", "you"].contains(&self.at(index.wrapping_sub(1)));
        let Some(there) = there
            .filter(|&there| needs && who && self.names_only(index + 1, there) && self.is_mark(there + 1))
        else {
            return;
        };
        let start = self.sentence_start(index);
        let place = (start..index)
            .rev()
            .find(|&at| ["at", "on", "from", "in"].contains(&self.at(at)) && is_determiner(self.at(at + 1)));
        let ends = place.and_then(|at| (at + 3..at + 6).find(|&end| self.noun_before(end).is_some()));
        if let (Some(place), Some(ends)) = (place, ends) {
            let mut said = vec![if self.at(place) == "in" { "in" } else { "on" }.to_owned()];
            said.extend(self.words(place + 1..ends));
            self.say_all(there, there + 1, &said);
            self.say(start, index + 1, &["put"]);
        }
    }

    /// "keep holding it": hold it.
    fn keeps_holding(&mut self, index: usize) {
        if self.starts(index, &["keep", "holding"]) {
            self.say(index, index + 2, &["hold"]);
        }
    }

    /// "let the coffee machine fill the mug": fill it with coffee.
    fn filled_by_the_machine(&mut self, index: usize) {
        let machine = self.starts(index, &["let", "the", "coffee"])
            && ["machine", "maker"].contains(&self.at(index + 3))
            && ["fill", "brew"].contains(&self.at(index + 4));
        if machine {
            let end = self.next_mark(index, &[",", "."]);
            let end = (index..end).find(|&at| self.at(at) == "and").unwrap_or(end);
            self.say(end, end, &["with", "coffee"]);
            self.say(index, index + 5, &["fill"]);
        }
    }

    /// "keep it in the fridge until it is cold": and chill it.
    fn until_cold(&mut self, index: usize) {
        let (it, length) = match (self.at(index + 1), self.at(index + 2)) {
            ("it", "is") => ("it", 3),
            ("they", "are") => ("them", 3),
            ("theyre", _) => ("them", 2),
            _ => return,
        };
        let until = ["until", "till"].contains(&self.at(index));
        let cold = ["cold", "chilled", "cool"].contains(&self.at(index + length));
        let kept = (self.clause_start(index)..index)
            .any(|at| ["keep", "leave", "put", "store", "place"].contains(&self.at(at)));
        if until && cold && kept {
            self.say(index, index + length + 1, &["and", "chill", it]);
        }
    }

    /// "but before doing so wash it", "wash it beforehand": wash it.
    fn done_beforehand(&mut self, index: usize) {
        let doing = self.starts(index, &["before", "doing"]) && ["so", "that"].contains(&self.at(index + 2));
        if doing {
            let but = usize::from(index > 0 && self.at(index - 1) == "but");
            self.say(index - but, index + 3, &[]);
        } else if self.at(index) == "beforehand" && (self.is_mark(index + 1) || self.at(index + 1) == "and") {
            self.say(index, index + 1, &[]);
        }
    }

    /// "a slice of toast": of toasted bread.
    fn slice_of_toast(&mut self, index: usize) {
        let of = index > 1 && self.at(index - 1) == "of" && self.is_part(index - 2);
        if self.at(index) == "toast" && of {
            self.say(index, index + 1, &["toasted", "bread"]);
        }
    }

    /// "both vegetables finally rest in that pot": they go there.
    fn finally_rest(&mut self, index: usize) {
        let finally = ["finally", "then", "eventually", "should"].contains(&self.at(index.wrapping_sub(1)));
        let rest = ["rest", "rests"].contains(&self.at(index)) && ["in", "on"].contains(&self.at(index + 1));
        if index > 1 && finally && rest {
            let should = self.at(index - 1) == "should";
            let from = index - usize::from(!should);
            let wish: &[&str] = if should { &["be"] } else { &["should", "be"] };
            self.say(from, index + 1, wish);
        }
    }
}

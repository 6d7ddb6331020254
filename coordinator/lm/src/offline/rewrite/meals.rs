//! Meals that are only the name of what other orders make: "serve a salad: slice the lettuce …", "… to assemble a
//! snack", "… and set everything aside".

use super::Rewriting;
use crate::offline::syntax::is_determiner;

/// What is made of food.
const MEALS: [&str; 15] = [
    "salad",
    "snack",
    "lunch",
    "dinner",
    "breakfast",
    "supper",
    "meal",
    "sandwich",
    "dish",
    "platter",
    "plate",
    "bowl",
    "appetizer",
    "starter",
    "vegetables",
];

/// What makes a meal of something, or brings it to the table.
const SERVES: [&str; 16] = [
    "assemble", "serve", "arrange", "provide", "combine", "present", "compose", "build", "stock", "load",
    "mix", "offer", "create", "make", "prepare", "form",
];

/// What says that nothing more is done with it.
const SET_ASIDE: [&[&str]; 8] = [
    &["set", "everything", "aside"],
    &["set", "it", "aside"],
    &["set", "it", "all", "aside"],
    &["set", "them", "aside"],
    &["leave", "everything", "in", "place"],
    &["leave", "everything", "there"],
    &["leave", "it", "all", "there"],
    &["leave", "all", "of", "it", "there"],
];

/// What it is there for.
const TO_BE_SERVED: [&[&str]; 6] = [
    &["to", "be", "served"],
    &["ready", "to", "serve"],
    &["ready", "to", "be", "served"],
    &["ready", "for", "serving"],
    &["for", "serving"],
    &["to", "serve"],
];

impl Rewriting<'_> {
    /// All of them.
    pub(super) fn meals(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            self.heading_of_a_meal(index);
            self.meal_is_served(index);
            self.set_aside(index);
            index += 1;
        }
    }

    /// "Serve a salad: slice the lettuce …": what comes says how.
    fn heading_of_a_meal(&mut self, index: usize) {
        if index > 0 && self.at(index - 1) != "." {
            return;
        }
        let end = self.next_mark(index, &[".", ","]);
        let Some(length) = self.meal_named(index) else { return };
        let Some(mark) = self.tokens.get(end).filter(|_| end == index + length) else { return };
        let colon = mark.typed == ":";
        let close = self.next_mark(end + 1, &["."]);
        let made = (end + 1..close).any(|at| {
            let cuts = ["slice", "cut", "chop", "dice", "sliced", "chopped"].contains(&self.at(at));
            cuts || colon && (self.is_order(at) || ["should", "must"].contains(&self.at(at)))
        });
        if made && (colon || mark.text == ".") && !["make", "prepare", "create"].contains(&self.at(index)) {
            self.say(index, end + 1, &[]);
        }
    }

    /// How many words at a place say to make or serve a meal: "serve up a fresh salad", "put a salad together".
    fn meal_named(&self, index: usize) -> Option<usize> {
        let put = self.at(index) == "put";
        let together = usize::from(put && self.at(index + 1) == "together");
        let up = usize::from(["up", "out"].contains(&self.at(index + 1)));
        if !SERVES.contains(&self.at(index)) && !put {
            return None;
        }
        let first = index + 1 + together + up;
        let meal = (first..first + 5).find(|&at| {
            MEALS.contains(&self.at(at)) && !MEALS.contains(&self.at(at + 1)) && self.at(at + 1) != "and"
        })?;
        let plain = (first..meal)
            .all(|at| !self.is_mark(at) && !["the", "in", "on", "of", "with"].contains(&self.at(at)));
        let behind = usize::from(put && together == 0 && self.at(meal + 1) == "together");
        (plain && (!put || together + behind > 0)).then_some(meal + 1 + behind - index)
    }

    /// "… to assemble a salad", "… to be served", "… and serve a salad": no more than what was done.
    fn meal_is_served(&mut self, index: usize) {
        let placed = index > 3 && (0..index).any(|at| self.is_place(at)) && !self.is_mark(index - 1);
        if !placed {
            return;
        }
        let meal = ["to", "and"].contains(&self.at(index)).then(|| self.meal_named(index + 1)).flatten();
        let served = self.one_of(index, &TO_BE_SERVED);
        let length = meal.map(|length| length + 1).or(served);
        let article = meal.is_none() || (index + 2..index + 5).any(|at| is_determiner(self.at(at)));
        if let Some(length) = length.filter(|_| article)
            && self.is_mark(index + length)
            && (self.at(index) != "and" || self.at(index + 1) != "make")
        {
            self.say(index, index + length, &[]);
        }
    }

    /// "… and set everything aside": it stays where it was put.
    fn set_aside(&mut self, index: usize) {
        let Some(length) = self.one_of(index, &SET_ASIDE) else { return };
        let and = index > 0 && self.at(index - 1) == "and";
        if and && index > 3 && self.is_mark(index + length) {
            self.say(index - 1, index + length, &[]);
        }
    }
}

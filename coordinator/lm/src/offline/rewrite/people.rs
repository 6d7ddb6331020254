//! Who is to do it, where that changes nothing of what is to be done: "would somebody please …", "have another robot …".

use super::Rewriting;

/// Somebody, and no matter who.
const SOMEBODY: [&[&str]; 26] = [
    &["somebody", "else"],
    &["someone", "else"],
    &["somebody"],
    &["someone"],
    &["anybody"],
    &["anyone"],
    &["one", "of", "you"],
    &["one", "of", "the", "robots"],
    &["the", "others"],
    &["a", "second", "one"],
    &["a", "third", "one"],
    &["another", "of", "you"],
    &["another", "robot"],
    &["one", "robot"],
    &["a", "robot"],
    &["the", "other", "robot"],
    &["a", "second", "robot"],
    &["a", "third", "robot"],
    &["another", "person"],
    &["one", "person"],
    &["a", "first", "person"],
    &["a", "second", "person"],
    &["a", "third", "person"],
    &["a", "fourth", "person"],
    &["the", "second", "person"],
    &["the", "third", "person"],
];

impl Rewriting<'_> {
    /// Leaves out who does it where an order follows.
    pub(super) fn people(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            let opens =
                index == 0 || [",", ".", "and", "while", "then", "that"].contains(&self.at(index - 1));
            if opens && let Some(length) = self.names_somebody(index) {
                self.say(index, index + length, &[]);
            }
            index += 1;
        }
    }

    /// How many words say before an order that somebody does it.
    fn names_somebody(&self, index: usize) -> Option<usize> {
        let asks =
            ["would", "could", "can", "will", "have", "let", "get", "ask", "tell"].contains(&self.at(index));
        let start = index + usize::from(asks);
        let who = self.one_of(start, &SOMEBODY)?;
        let person = ["person", "robots", "others"].contains(&self.at(start + who - 1));
        let mut end = start + who;
        let shall = ["should", "must", "can", "could", "will", "to", "shall"].contains(&self.at(end));
        end += usize::from(shall);
        end += usize::from(["please", "kindly"].contains(&self.at(end)));
        ((asks || person && shall) && self.is_base_verb(end)).then_some(end - index)
    }
}

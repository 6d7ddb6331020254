//! What others wish, as one's own wish: "Mrs Doyle would like the cup on the table", "his card he wants in the box".

use super::super::text::Token;
use super::Remarks;
use super::telling;

/// What they would do with it.
const WISHED: [&[&str]; 8] = [
    &["would", "like"],
    &["would", "love"],
    &["would", "prefer"],
    &["would", "appreciate"],
    &["wants"],
    &["needs"],
    &["prefers"],
    &["likes"],
];

impl Remarks<'_> {
    /// "Mr Lee says the book should be on the desk": it should be there.
    pub(super) fn say_what_others_say(&mut self) {
        const SAYS: [&str; 9] =
            ["says", "said", "thinks", "insists", "reckons", "suggests", "suggested", "insisted", "asked"];
        let mut index = 0;
        while index < self.tokens.len() {
            // "the recipe says to chop the lettuce": chop it.
            let says = ["says", "said"].contains(&self.at(index)) && self.at(index + 1) == "to";
            if says && self.is_order(index + 2) {
                let start = (0..index).rev().find(|&at| self.is_mark(at)).map_or(0, |at| at + 1);
                if !(start..index).any(|at| self.thing(at).is_some()) {
                    self.tokens.drain(start..index + 2);
                    index = start;
                    continue;
                }
            }
            let opens =
                index == 0 || self.is_mark(index - 1) || ["and", "so", "but"].contains(&self.at(index - 1));
            let words: Vec<String> =
                self.tokens[index..].iter().take(6).map(|token| token.text.clone()).collect();
            let person = telling::person(&words, &self.named_persons(index), self.lexicon).filter(|_| opens);
            if let Some(length) = person
                && SAYS.contains(&self.at(index + length))
            {
                let that = usize::from(self.at(index + length + 1) == "that");
                let first = index + length + 1 + that;
                let end =
                    (first..self.tokens.len()).find(|&at| self.is_mark(at)).unwrap_or(self.tokens.len());
                let asks = (first + 1..end).any(|at| {
                    ["should", "must", "shall", "goes", "go", "belongs", "belong", "needs", "has"]
                        .contains(&self.at(at))
                });
                if asks && (first..end).any(|at| self.thing(at).is_some()) {
                    self.tokens.drain(index..first);
                }
            }
            index += 1;
        }
    }

    /// Says "I want" for it, where a thing of the scene is wished for.
    pub(super) fn wish_for_others(&mut self) {
        let mut index = 0;
        while index < self.tokens.len() {
            if let Some((length, behind)) = self.wish_of_another(index) {
                self.tokens.splice(index..index + length, ["i", "want"].map(Token::said));
                index += 1;
                debug_assert!(behind > 0, "a wish has words");
            }
            index += 1;
        }
    }

    /// How many tokens say here that somebody else wishes for something that is here, and how many words they are.
    fn wish_of_another(&self, index: usize) -> Option<(usize, usize)> {
        let end = (index..self.tokens.len()).find(|&at| self.is_mark(at)).unwrap_or(self.tokens.len());
        let first = self.at(index);
        if ["i", "we", "someone", "somebody", "who", "people"].contains(&first) {
            return None;
        }
        let words = telling::spelled_out(&self.tokens[index..end]);
        let person = telling::person(&words, &self.named_persons(index), self.lexicon)?;
        let rest: Vec<&str> = words[person..].iter().map(String::as_str).collect();
        let also = usize::from(["also", "really", "just", "only"].contains(rest.first().unwrap_or(&"")));
        let wished = also + WISHED.iter().find(|wished| rest[also..].starts_with(wished))?.len();
        let from = (0..index).rev().find(|&at| self.is_mark(at)).map_or(0, |at| at + 1);
        let named = (from..end).any(|at| self.thing(at).is_some());
        let words = person + wished;
        // As many tokens as say those words: "he'd" is two of them.
        let tokens = (1..=end - index)
            .find(|&length| telling::spelled_out(&self.tokens[index..index + length]).len() >= words)?;
        named.then_some((tokens, words))
    }
}

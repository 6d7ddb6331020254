//! From an instruction as it was typed to the plain words that are read.

use super::lexicon::Lexicon;
use super::scene::Scene;
use super::text::Token;
use super::{complaint, everyday, remark, rewrite, slang, text};

/// An instruction in plainer words.
pub struct Plain {
    /// The words.
    pub words: Vec<String>,
    /// What was taken for a slip of the pen, in words.
    pub repairs: Vec<String>,
    /// What was said without the remarks.
    left: Vec<Token>,
    /// What was said, remarks and all.
    whole: Vec<Token>,
    /// What was taken for remarks.
    pub remarks: Vec<String>,
    /// Mended words as they were typed, and as they are read.
    pub typed: Vec<(String, String)>,
    /// Where the instruction was cut off for its length.
    pub cut: usize,
}

/// Mends the spelling of an instruction, leaves out its remarks and puts it in plainer words.
pub fn plain(instruction: &str, lexicon: &Lexicon, scene: &Scene<'_>) -> Plain {
    let cut = instruction
        .char_indices()
        .map(|(at, _)| at)
        .find(|&at| at >= text::LONGEST_INSTRUCTION)
        .unwrap_or(instruction.len());
    let tokens = slang::spelled_out(text::without_list_numbers(text::tokens(&instruction[..cut])));
    let mut tokens = text::split_articles(tokens, lexicon, scene);
    let repairs = text::repair_spelling(&mut tokens, lexicon, scene);
    let typed: Vec<(String, String)> = tokens
        .iter()
        .filter(|token| repairs.contains(&text::repair_note(token)))
        .map(|token| (token.typed.clone(), token.text.clone()))
        .collect();
    let tokens = rewrite::with_lights_off(tokens, lexicon);
    let tokens = everyday::plainer(tokens, lexicon);
    let (tokens, mut remarks) = complaint::mended(tokens, lexicon, scene);
    let (left, told) = remark::set_apart(&tokens, lexicon, scene);
    remarks.extend(told);
    let words = plainer(left.clone(), lexicon);
    Plain { words, left, whole: tokens, repairs, remarks, typed, cut }
}

impl Plain {
    /// The words as they were said, without the remarks.
    pub fn said(&self, lexicon: &Lexicon) -> Vec<String> {
        rewrite::written_out(self.left.clone(), lexicon).into_iter().map(|token| token.text).collect()
    }

    /// The same with things named that pronouns stand for, and as it was said, remarks and all, where that differs;
    /// each is put in plainer words only when it is asked for.
    pub fn others<'a>(
        &'a self,
        lexicon: &'a Lexicon,
        scene: &'a Scene<'_>,
    ) -> impl Iterator<Item = Vec<String>> + 'a {
        let named =
            || Some(remark::told_apart(&self.left, lexicon, scene)).filter(|named| *named != self.left);
        let whole = || Some(self.whole.clone()).filter(|whole| *whole != self.left);
        let others = std::iter::once_with(named).chain(std::iter::once_with(whole));
        others.flatten().map(|tokens| plainer(tokens, lexicon))
    }
}

fn plainer(tokens: Vec<Token>, lexicon: &Lexicon) -> Vec<String> {
    let tokens = rewrite::rewritten(tokens, lexicon);
    text::without_asides(tokens.into_iter().map(|token| token.text).collect(), lexicon)
}

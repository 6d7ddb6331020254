//! From an instruction as it was typed to the plain words that are read.

use super::lexicon::Lexicon;
use super::scene::Scene;
use super::{remark, rewrite, slang, text};

/// An instruction in plainer words.
pub struct Plain {
    /// The words.
    pub words: Vec<String>,
    /// The words as they were said.
    pub said: Vec<String>,
    /// What was taken for a slip of the pen, in words.
    pub repairs: Vec<String>,
    /// The same with things named that pronouns stand for, and as it was said, remarks and all, where that differs.
    pub others: Vec<Vec<String>>,
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
    let (left, remarks) = remark::set_apart(&tokens, lexicon, scene);
    let plainer = |tokens| {
        let tokens = rewrite::rewritten(tokens, lexicon);
        text::without_asides(tokens.into_iter().map(|token| token.text).collect(), lexicon)
    };
    let said = rewrite::written_out(left.clone(), lexicon).into_iter().map(|token| token.text).collect();
    let named = remark::told_apart(&left, lexicon, scene);
    let named = (named != left).then(|| plainer(named));
    let whole = (left != tokens).then(|| plainer(tokens));
    Plain {
        words: plainer(left),
        said,
        others: named.into_iter().chain(whole).collect(),
        repairs,
        remarks,
        typed,
        cut,
    }
}

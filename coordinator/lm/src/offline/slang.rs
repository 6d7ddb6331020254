//! Short and sloppy spellings that are no slips: "thats", "pen n pencil", "w/ it", "gimme", "cos".

use super::text::Token;

/// Words without the apostrophe that makes "is" of their end.
const WITHOUT_APOSTROPHE: [(&str, &str); 12] = [
    ("thats", "that"),
    ("theres", "there"),
    ("heres", "here"),
    ("wheres", "where"),
    ("whats", "what"),
    ("whos", "who"),
    ("hes", "he"),
    ("shes", "she"),
    ("nobodys", "nobody"),
    ("somebodys", "somebody"),
    ("someones", "someone"),
    ("everyones", "everyone"),
];

/// What is said for them.
const SHORT: [(&str, &[&str]); 22] = [
    ("tho", &["though"]),
    ("cos", &["because"]),
    ("coz", &["because"]),
    ("cuz", &["because"]),
    ("gimme", &["give", "me"]),
    ("lemme", &["let", "me"]),
    ("wanna", &["want", "to"]),
    ("gonna", &["going", "to"]),
    ("gotta", &["have", "to"]),
    ("outta", &["out", "of"]),
    ("ya", &["you"]),
    ("u", &["you"]),
    ("ur", &["your"]),
    ("r", &["are"]),
    ("tmrw", &["tomorrow"]),
    ("tonite", &["tonight"]),
    ("em", &["them"]),
    ("dunno", &["dont", "know"]),
    ("lil", &["little"]),
    ("bc", &["because"]),
    ("kinda", &[]),
    ("sorta", &[]),
];

/// What stands before a name with a full stop that ends no sentence.
const TITLES: [&str; 5] = ["mr", "mrs", "ms", "dr", "prof"];

/// Says them in full: "thats" as "that's", "n" as "and", "w/" as "with"; no sentence ends behind "Mr.".
pub fn spelled_out(tokens: Vec<Token>) -> Vec<Token> {
    let mut found: Vec<Token> = Vec::with_capacity(tokens.len());
    let is_mark = |token: &Token| [",", "."].contains(&token.text.as_str());
    let mut index = 0;
    while index < tokens.len() {
        let token = &tokens[index];
        let next = tokens.get(index + 1);
        let word = |text: &str, typed: &str| Token { text: text.to_owned(), typed: typed.to_owned() };
        let within = !found.is_empty() && next.is_some_and(|next| !is_mark(next));
        let title = TITLES.contains(&token.text.as_str());
        if token.text == "w" && next.is_some_and(|next| next.typed == "/") {
            found.push(word("with", "w/"));
            index += 1;
        } else if token.text == "n" && within {
            found.push(word("and", &token.typed));
        } else if let Some((short, full)) = WITHOUT_APOSTROPHE.iter().find(|(short, _)| *short == token.text)
        {
            found.push(word(full, &format!("{}'s", short.trim_end_matches('s'))));
        } else if token.text == "its" && token.typed == "its" && is_it_is(&tokens[index + 1..]) {
            found.push(word("it", "it's"));
            if tokens
                .get(index + 1)
                .is_some_and(|next| ["done", "finished", "ready", "over"].contains(&next.text.as_str()))
            {
                found.push(word("is", "is"));
            }
        } else if token.text == "it" && token.typed.len() > 2 && next.is_some_and(|next| next.text == "done")
        {
            found.extend([token.clone(), word("is", "is")]);
        } else if token.text == "youve"
            && next.is_some_and(|next| ["finished", "done"].contains(&next.text.as_str()))
        {
            found.extend([word("you", "you"), word("have", "have")]);
        } else if let Some((_, full)) = SHORT.iter().find(|(short, _)| *short == token.text) {
            found.extend(full.iter().map(|text| word(text, &token.typed)));
        } else {
            found.push(token.clone());
            index += usize::from(title && next.is_some_and(|next| next.text == "."));
        }
        index += 1;
    }
    found
}

/// Whether "its" without an apostrophe is "it is": "its a hot day", "its been there", "its done", not "its holder".
fn is_it_is(behind: &[Token]) -> bool {
    const SAID: [&str; 22] = [
        "a", "an", "the", "been", "so", "too", "not", "all", "my", "in", "on", "just", "very", "really",
        "time", "getting", "gone", "still", "always", "done", "for", "no",
    ];
    behind.first().is_some_and(|next| SAID.contains(&next.text.as_str()))
}

#[cfg(test)]
mod tests {
    use super::super::text::tokens;
    use super::*;

    #[test]
    fn short_words_are_said_in_full() {
        let said = |text: &str| -> Vec<String> {
            spelled_out(tokens(text)).into_iter().map(|token| token.text).collect()
        };
        assert_eq!(said("pen n cup w/ it"), ["pen", "and", "cup", "with", "it"]);
        assert_eq!(said("thats its holder"), ["that", "its", "holder"]);
        assert_eq!(said("Mr. Poe rests."), ["mr", "poe", "rests", "."]);
    }
}

//! A reader of text that was meant to be JSON: repairs what is certain and notes each repair.

use std::iter::Peekable;
use std::str::Chars;

/// A value. Objects keep their keys in order, since the released files are read by position.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    Null,
    Number(f64),
    Text(String),
    List(Vec<Value>),
    Object(Vec<(String, Value)>),
}

impl Value {
    /// The text, if it is one and says something.
    pub fn word(&self) -> Option<&str> {
        match self {
            Value::Text(text) if !text.trim().is_empty() && text.trim() != "None" => Some(text.trim()),
            _ => None,
        }
    }
}

/// Deeper nesting is not meant.
const MAX_DEPTH: usize = 16;

/// Reads one record. The notes say what was repaired.
pub(super) fn read(text: &str) -> Result<(Value, Vec<String>), String> {
    let mut reader = Reader { text: text.chars().peekable(), notes: Vec::new(), comma_read: false };
    reader.space();
    let value = reader.value(0)?;
    reader.space();
    let rest: String = reader.text.collect();
    if !rest.trim_matches([',', ']', '}', ' ', '\t', '\r']).is_empty() {
        return Err(format!("cannot read from here on: `{}`", clip(&rest)));
    }
    if !rest.trim().is_empty() {
        reader.notes.push(format!("left out `{}` at the end", rest.trim()));
    }
    Ok((value, reader.notes))
}

fn clip(text: &str) -> String {
    text.chars().take(40).collect()
}

struct Reader<'t> {
    text: Peekable<Chars<'t>>,
    notes: Vec<String>,
    /// The comma after a list that lacks its `]` was read as one between its items.
    comma_read: bool,
}

/// How a list or object goes on.
enum Next {
    Item,
    End,
}

impl Reader<'_> {
    fn space(&mut self) {
        while self.text.next_if(|c| c.is_whitespace()).is_some() {}
    }

    fn eat(&mut self, wanted: char) -> bool {
        self.space();
        self.text.next_if_eq(&wanted).is_some()
    }

    fn note(&mut self, what: impl Into<String>) {
        self.notes.push(what.into());
    }

    fn value(&mut self, depth: usize) -> Result<Value, String> {
        if depth > MAX_DEPTH {
            return Err("nested too deep".to_string());
        }
        self.space();
        match self.text.peek() {
            Some('{') => self.object(depth),
            Some('[') => self.list(depth),
            Some('"' | '\'') => Ok(Value::Text(self.quoted()?)),
            Some(c) if c.is_ascii_alphanumeric() || *c == '-' => Ok(self.bare()),
            Some(c) => Err(format!("a value is missing before `{c}`")),
            None => Err("ends where a value is missing".to_string()),
        }
    }

    fn quoted(&mut self) -> Result<String, String> {
        let quote = self.text.next().unwrap_or('"');
        let mut out = String::new();
        while let Some(c) = self.text.next() {
            match c {
                '\\' => out.extend(self.text.next()),
                c if c == quote => return Ok(out),
                c => out.push(c),
            }
        }
        Err(format!("a quotation is not closed: `{}`", clip(&out)))
    }

    fn bare(&mut self) -> Value {
        let mut word = String::new();
        while let Some(c) = self.text.next_if(|c| c.is_ascii_alphanumeric() || "-+._".contains(*c)) {
            word.push(c);
        }
        match (word.as_str(), word.parse::<f64>()) {
            (_, Ok(number)) if number.is_finite() => Value::Number(number),
            ("null", _) => Value::Null,
            ("None", _) => {
                self.note("read Python's `None` as null");
                Value::Null
            }
            _ => {
                self.note(format!("read the word `{word}` as a text without quotation marks"));
                Value::Text(word)
            }
        }
    }

    fn object(&mut self, depth: usize) -> Result<Value, String> {
        self.text.next();
        let mut entries = Vec::new();
        loop {
            self.space();
            match self.text.peek() {
                Some('}') => {
                    self.text.next();
                    return Ok(Value::Object(entries));
                }
                Some('"' | '\'') => {
                    let key = self.quoted()?;
                    if !self.eat(':') {
                        return Err(format!("`:` is missing after \"{key}\""));
                    }
                    entries.push((key, self.value(depth + 1)?));
                    if let Next::End = self.after('}', "an object") {
                        return Ok(Value::Object(entries));
                    }
                }
                Some(']') | None => {
                    self.note("closed an object that lacks `}`");
                    return Ok(Value::Object(entries));
                }
                Some(c) => return Err(format!("a key is missing before `{c}`")),
            }
        }
    }

    fn list(&mut self, depth: usize) -> Result<Value, String> {
        self.text.next();
        let mut items = Vec::new();
        loop {
            self.space();
            match self.text.peek().copied() {
                Some(']') => {
                    self.text.next();
                    return Ok(Value::List(items));
                }
                // A key where an item should be: the list ended before and nobody closed it.
                Some('"' | '\'') if self.key_ahead() => {
                    self.note("closed a list that lacks `]`");
                    self.comma_read = !items.is_empty();
                    return Ok(Value::List(items));
                }
                Some('}') | None => {
                    self.note("closed a list that lacks `]`");
                    return Ok(Value::List(items));
                }
                _ => {
                    items.push(self.value(depth + 1)?);
                    if let Next::End = self.after(']', "a list") {
                        return Ok(Value::List(items));
                    }
                }
            }
        }
    }

    /// What follows an item: a comma, the end, or neither, which is then repaired by the caller's loop.
    fn after(&mut self, end: char, of: &str) -> Next {
        if std::mem::take(&mut self.comma_read) {
            return Next::Item;
        }
        if self.eat(end) {
            return Next::End;
        }
        if !self.eat(',') && self.text.peek().is_some_and(|c| !"}]".contains(*c)) {
            self.note(format!("put the missing `,` into {of}"));
        }
        Next::Item
    }

    /// Whether a quotation followed by a colon comes next.
    fn key_ahead(&self) -> bool {
        let mut ahead = self.text.clone();
        let Some(quote) = ahead.next() else { return false };
        let closed = ahead.by_ref().any(|c| c == quote);
        closed && ahead.find(|c| !c.is_whitespace()) == Some(':')
    }
}

/// The records of a file: each begins with `{"task"`, wherever its line begins. A line without one is a record
/// of its own, so that it is reported rather than lost. With each, the line it begins in.
pub(super) fn records(text: &str) -> Vec<(usize, &str)> {
    let mut found = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let mut starts = starts(line);
        if starts.first() != Some(&0) {
            starts.insert(0, 0);
        }
        starts.push(line.len());
        for pair in starts.windows(2) {
            let part = line[pair[0]..pair[1]].trim();
            if !part.is_empty() {
                found.push((index + 1, part));
            }
        }
    }
    found
}

fn starts(line: &str) -> Vec<usize> {
    let begins = |(at, _): &(usize, &str)| {
        let after = line[at + 1..].trim_start();
        after.starts_with("\"task\"") || after.starts_with("'task'")
    };
    line.match_indices('{').filter(begins).map(|(at, _)| at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn broken_records_are_read_and_each_repair_is_noted() {
        for (text, notes) in [
            (r#"{"a": [1, 2], "b": "x"}"#, vec![]),
            (r#"{"a": None}"#, vec!["read Python's `None` as null"]),
            (r#"{"a": [{"n": "x"}, "b": 0}"#, vec!["closed a list that lacks `]`"]),
            (r#"{"a": [1, 2"#, vec!["closed a list that lacks `]`", "closed an object that lacks `}`"]),
            (r#"{"a": 1 "b": 2}"#, vec!["put the missing `,` into an object"]),
            (r#"{"a": 1}]"#, vec!["left out `]` at the end"]),
            (r#"{"a": Off}"#, vec!["read the word `Off` as a text without quotation marks"]),
        ] {
            assert_eq!(read(text).unwrap_or_else(|e| panic!("{text}: {e}")).1, notes, "{text}");
        }
        for text in ["{\"a\"}", "{\"a\": \"x", "{\"a\": }", "{\"a\": 1} more", "nonsense!", ""] {
            assert!(read(text).is_err(), "{text}");
        }
        assert!(read(&"[".repeat(100_000)).is_err());
    }

    #[test]
    fn several_records_on_a_line_are_several() {
        let text = "{\"task\": 1} {\"task\": 2}\n\njunk {\"task\": 3}\n";
        assert_eq!(
            records(text),
            [(1, "{\"task\": 1}"), (1, "{\"task\": 2}"), (3, "junk"), (3, "{\"task\": 3}")]
        );
    }
}

//! Text to spanned s-expressions. No recursion: nesting comes from outside and is limited.

use crate::codes;
use crate::diagnostic::{Diagnostic, Report};
use crate::name::Span;
use crate::source::{MAX_SOURCE_BYTES, Source};

const MAX_NESTING: usize = 256;
const MAX_WORD_BYTES: usize = 1024;
pub(crate) const MAX_TOKENS: usize = 8 << 20;

/// A word or a list.
#[derive(Debug)]
pub(crate) enum Sexpr<'s> {
    Word(Word<'s>),
    List(List<'s>),
}

/// Anything between delimiters.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Word<'s> {
    pub text: &'s str,
    pub span: Span,
}

/// `( … )`
#[derive(Debug)]
pub(crate) struct List<'s> {
    pub items: Vec<Sexpr<'s>>,
    pub span: Span,
}

impl<'s> Sexpr<'s> {
    /// A short span that shows where this is: the word, or a list's parenthesis and first word.
    pub fn place(&self) -> Span {
        match self {
            Sexpr::Word(word) => word.span,
            Sexpr::List(list) => list.place(),
        }
    }

    pub fn as_word(&self) -> Option<Word<'s>> {
        match self {
            Sexpr::Word(word) => Some(*word),
            Sexpr::List(_) => None,
        }
    }

    pub fn as_list(&self) -> Option<&List<'s>> {
        match self {
            Sexpr::Word(_) => None,
            Sexpr::List(list) => Some(list),
        }
    }
}

impl Word<'_> {
    /// Words of the language do not distinguish case.
    pub fn is(&self, keyword: &str) -> bool {
        self.text.eq_ignore_ascii_case(keyword)
    }

    pub fn is_variable(&self) -> bool {
        self.text.starts_with('?')
    }

    pub fn is_keyword(&self) -> bool {
        self.text.starts_with(':')
    }

    /// Whether it has the form of a number, finite or not.
    pub fn is_number(&self) -> bool {
        let unsigned = self.text.strip_prefix(['-', '+']).unwrap_or(self.text);
        unsigned.starts_with(|c: char| c.is_ascii_digit() || c == '.')
            && unsigned.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'.' | b'e' | b'E' | b'-' | b'+'))
            && unsigned.parse::<f64>().is_ok()
    }
}

impl<'s> List<'s> {
    /// The first item, if it is a word.
    pub fn head(&self) -> Option<Word<'s>> {
        self.items.first().and_then(Sexpr::as_word)
    }

    /// Whether the first item is this word.
    pub fn head_is(&self, keyword: &str) -> bool {
        self.head().is_some_and(|head| head.is(keyword))
    }

    /// The items after the first.
    pub fn rest(&self) -> &[Sexpr<'s>] {
        self.items.get(1..).unwrap_or_default()
    }

    pub fn place(&self) -> Span {
        let open = Span { start: self.span.start, end: self.span.start + 1 };
        self.head().map_or(open, |head| open.to(head.span))
    }

    /// Its closing parenthesis.
    pub fn close(&self) -> Span {
        Span { start: self.span.end.saturating_sub(1), end: self.span.end }
    }
}

/// The expressions at the top level. Unbalanced parentheses are reported and mended; `None` where the text
/// exceeds a limit.
pub(crate) fn read<'s>(source: &'s Source, report: &mut Report) -> Option<Vec<Sexpr<'s>>> {
    Reader { source, report, top: Vec::new(), open: Vec::new(), tokens: 0 }.run()
}

struct Reader<'s, 'r> {
    source: &'s Source,
    report: &'r mut Report,
    top: Vec<Sexpr<'s>>,
    open: Vec<List<'s>>,
    tokens: usize,
}

impl<'s> Reader<'s, '_> {
    fn run(mut self) -> Option<Vec<Sexpr<'s>>> {
        let text: &'s str = &self.source.text;
        if text.len() > MAX_SOURCE_BYTES {
            let message = format!("the text has {} bytes; the limit is {MAX_SOURCE_BYTES}", text.len());
            self.report.push(Diagnostic::error(codes::TOO_LARGE, Span::NONE, message));
            return None;
        }
        let bytes = text.as_bytes();
        let mut at = 0;
        while let Some(&byte) = bytes.get(at) {
            let start = at;
            at += 1;
            match byte {
                b' ' | b'\t' | b'\n' | b'\r' | 0x0b | 0x0c => continue,
                b';' => {
                    at = bytes[start..].iter().position(|b| *b == b'\n').map_or(bytes.len(), |n| start + n);
                    continue;
                }
                b'(' => self.open_list(start)?,
                b')' => self.close_list(start),
                _ => {
                    // A variable's mark begins a word too: `(aircraft?a)` stands in an IPC domain.
                    let ends = |b: &u8| is_delimiter(*b) || *b == b'?';
                    at = bytes[at..].iter().position(ends).map_or(bytes.len(), |n| at + n);
                    self.word(Word { text: &text[start..at], span: Span::new(start, at) })?;
                }
            }
            self.tokens += 1;
            if self.tokens > MAX_TOKENS {
                let message = format!("the text has more than {MAX_TOKENS} words and parentheses");
                self.report.push(Diagnostic::error(codes::TOO_LARGE, Span::new(start, at), message));
                return None;
            }
        }
        if !self.open.is_empty() {
            self.report_unclosed(
                Span::new(text.trim_end().len().saturating_sub(1), text.trim_end().len()),
                "the text ends here",
                0,
            );
            self.close_down_to(0, text.len());
        }
        Some(self.top)
    }

    fn open_list(&mut self, at: usize) -> Option<()> {
        if self.open.len() == MAX_NESTING {
            let message = format!("parentheses are nested more than {MAX_NESTING} deep");
            let help = "write nested `and`s as one: `(and a b c)`";
            self.report.push(Diagnostic::error(codes::TOO_DEEP, Span::new(at, at + 1), message).help(help));
            return None;
        }
        self.open.push(List { items: Vec::new(), span: Span::new(at, at + 1) });
        Some(())
    }

    fn close_list(&mut self, at: usize) {
        let Some(mut list) = self.open.pop() else {
            let place = Span::new(at, at + 1);
            let message = "this parenthesis closes nothing";
            // Behind everything else a `)` too many does no harm, and files in use have it.
            let mut found = Diagnostic::warning(codes::STRAY, place, message).help("remove it");
            found.label = "nothing is open here".to_owned();
            self.report.push(found);
            return;
        };
        list.span.end = Span::new(at, at + 1).end;
        self.put(Sexpr::List(list));
    }

    fn word(&mut self, word: Word<'s>) -> Option<()> {
        if word.text.len() > MAX_WORD_BYTES {
            let message = format!("this name has {} bytes; the limit is {MAX_WORD_BYTES}", word.text.len());
            let place = Span { end: word.span.start + 1, ..word.span };
            self.report.push(Diagnostic::error(codes::NAME_TOO_LONG, place, message));
            return None;
        }
        // A section inside a section means that the one before was not closed: mend it there, so that the rest
        // of the text is still understood.
        let begins_list = self.open.last().is_some_and(|list| list.items.is_empty());
        let is_section = begins_list && SECTIONS.iter().any(|section| word.is(section));
        if is_section
            && self.open.len() > 2
            && let Some(list) = self.open.pop()
        {
            self.report_unclosed(list.span.to(word.span), "this section begins inside another one", 1);
            self.close_down_to(1, list.span.start as usize);
            self.open.push(list);
        }
        self.put(Sexpr::Word(word));
        Some(())
    }

    fn put(&mut self, sexpr: Sexpr<'s>) {
        match self.open.last_mut() {
            Some(list) => list.items.push(sexpr),
            None => self.top.push(sexpr),
        }
    }

    fn report_unclosed(&mut self, found_at: Span, label: &str, depth: usize) {
        let missing = self.open.len() - depth;
        let message = match missing {
            1 => "a `)` is missing".to_owned(),
            n => format!("{n} `)` are missing"),
        };
        let mut found = Diagnostic::error(codes::UNCLOSED, found_at, message).label(label);
        if let Some(list) = self.open.get(depth) {
            found = found.also(list.place(), "this is not closed before");
        }
        if missing > 1
            && let Some(list) = self.open.last()
        {
            found = found.also(list.place(), "nor is this, the innermost");
        }
        self.report.push(found.help("close every `(` before the next section begins"));
    }

    fn close_down_to(&mut self, depth: usize, at: usize) {
        while self.open.len() > depth
            && let Some(mut list) = self.open.pop()
        {
            list.span.end = Span::new(at, at).end;
            self.put(Sexpr::List(list));
        }
    }
}

fn is_delimiter(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\n' | b'\r' | 0x0b | 0x0c | b';' | b'(' | b')')
}

/// What can only stand directly inside a `(define …)`.
const SECTIONS: &[&str] = &[
    ":action",
    ":durative-action",
    ":derived",
    ":predicates",
    ":functions",
    ":types",
    ":constants",
    ":requirements",
    ":domain",
    ":objects",
    ":init",
    ":goal",
    ":metric",
];

#[cfg(test)]
mod tests {
    use super::*;

    fn read_all(text: &str) -> (String, Vec<&'static str>) {
        let source = Source::new("x", text);
        let mut report = Report::new(&source);
        let top = read(&source, &mut report);
        let shown =
            top.map_or("refused".to_owned(), |top| top.iter().map(show).collect::<Vec<_>>().join(" "));
        (shown, report.diagnostics().iter().map(|d| d.code).collect())
    }

    fn show(sexpr: &Sexpr<'_>) -> String {
        match sexpr {
            Sexpr::Word(word) => word.text.to_owned(),
            Sexpr::List(list) => format!("({})", list.items.iter().map(show).collect::<Vec<_>>().join(" ")),
        }
    }

    #[test]
    fn blanks_and_comments_separate_words() {
        let (shown, codes) = read_all("; x (\n(a\tb?c;y)\n)\x0c\r(-1.5e3) ; end");
        assert_eq!((shown.as_str(), codes.len()), ("(a b ?c) (-1.5e3)", 0));
    }

    #[test]
    fn a_section_inside_a_section_is_mended() {
        let (shown, codes) = read_all("(define (domain d) (:types a (:action b :effect (c)) (:action e))");
        assert_eq!(shown, "(define (domain d) (:types a) (:action b :effect (c)) (:action e))");
        assert_eq!(codes, [codes::UNCLOSED]);
        let (shown, codes) = read_all("(a (b");
        assert_eq!((shown.as_str(), codes), ("(a (b))", vec![codes::UNCLOSED]));
        let (shown, codes) = read_all("(a)) b");
        assert_eq!((shown.as_str(), codes), ("(a) b", vec![codes::STRAY]));
    }

    #[test]
    fn limits_hold() {
        let deep = "(".repeat(MAX_NESTING) + &")".repeat(MAX_NESTING);
        assert_eq!(read_all(&deep).1, [""; 0]);
        assert_eq!(read_all(&format!("({deep})")), ("refused".into(), vec![codes::TOO_DEEP]));
        assert_eq!(read_all(&"x".repeat(MAX_WORD_BYTES + 1)).1, [codes::NAME_TOO_LONG]);
        assert_eq!(read_all(&"x ".repeat(MAX_TOKENS + 1)).1, [codes::TOO_LARGE]);
        assert_eq!(read_all(&" ".repeat(MAX_SOURCE_BYTES + 1)).1, [codes::TOO_LARGE]);
    }
}

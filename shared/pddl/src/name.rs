//! Names and where they stood in the text.

use std::cmp::Ordering;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

/// A byte range of the source text. `Span::NONE` marks what no text says (built by a program).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// The span of things built by a program.
    pub const NONE: Span = Span { start: 0, end: 0 };

    /// The range from `start` up to, not including, `end`.
    pub fn new(start: usize, end: usize) -> Self {
        let clamp = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        Span { start: clamp(start), end: clamp(end) }
    }

    /// The smallest span that covers both.
    pub fn to(self, other: Span) -> Span {
        Span { start: self.start.min(other.start), end: self.end.max(other.end) }
    }
}

/// A PDDL name. Two names are equal when they are equal without regard to ASCII case, as PDDL demands
/// (McDermott et al., "PDDL: the Planning Domain Definition Language", 1998, section 3); the spelling and
/// the span of this occurrence are kept for people to read and do not take part in comparisons.
#[derive(Clone)]
pub struct Name {
    text: Arc<str>,
    span: Span,
}

impl Name {
    /// A name that stands nowhere in a text.
    pub fn new(text: impl AsRef<str>) -> Self {
        Name { text: Arc::from(text.as_ref()), span: Span::NONE }
    }

    /// A name read at `span`.
    pub fn at(text: impl AsRef<str>, span: Span) -> Self {
        Name { text: Arc::from(text.as_ref()), span }
    }

    /// A name read at `span` whose spelling is shared with its other occurrences.
    pub fn shared(text: Arc<str>, span: Span) -> Self {
        Name { text, span }
    }

    /// The name as it was spelt.
    pub fn as_str(&self) -> &str {
        &self.text
    }

    /// Where this occurrence stood.
    pub fn span(&self) -> Span {
        self.span
    }
}

impl PartialEq for Name {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.text, &other.text) || self.text.eq_ignore_ascii_case(&other.text)
    }
}
impl Eq for Name {}

impl Hash for Name {
    fn hash<H: Hasher>(&self, state: &mut H) {
        for byte in self.text.bytes() {
            state.write_u8(byte.to_ascii_lowercase());
        }
        // As `str` does it: ("ab", "c") and ("a", "bc") shall differ.
        state.write_u8(0xff);
    }
}

impl Ord for Name {
    fn cmp(&self, other: &Self) -> Ordering {
        if Arc::ptr_eq(&self.text, &other.text) {
            return Ordering::Equal;
        }
        let (a, b) = (self.text.as_bytes(), other.text.as_bytes());
        // Names are mostly spelt the same way: up to where they differ as they stand, case does not matter.
        let eights = a.as_chunks::<8>().0.iter().zip(b.as_chunks::<8>().0);
        let same = 8 * eights.take_while(|(x, y)| x == y).count();
        for (x, y) in a[same..].iter().zip(&b[same..]).filter(|(x, y)| x != y) {
            let order = x.to_ascii_lowercase().cmp(&y.to_ascii_lowercase());
            if order.is_ne() {
                return order;
            }
        }
        a.len().cmp(&b.len())
    }
}
impl PartialOrd for Name {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq<str> for Name {
    fn eq(&self, other: &str) -> bool {
        self.text.eq_ignore_ascii_case(other)
    }
}
impl PartialEq<&str> for Name {
    fn eq(&self, other: &&str) -> bool {
        self.text.eq_ignore_ascii_case(other)
    }
}

impl From<&str> for Name {
    fn from(text: &str) -> Self {
        Name::new(text)
    }
}
impl From<String> for Name {
    fn from(text: String) -> Self {
        Name::new(text)
    }
}
impl From<&String> for Name {
    fn from(text: &String) -> Self {
        Name::new(text)
    }
}

impl AsRef<str> for Name {
    fn as_ref(&self) -> &str {
        &self.text
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
impl fmt::Debug for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

// There is deliberately no `Borrow<str>`: a `str` hashes with case, a name does not.

//! Laying out parenthesised text: on one line where it fits, else one part a line.

use std::fmt::{self, Display, Formatter};

const WIDTH: usize = 100;
const INDENT: usize = 2;

pub(crate) enum Doc {
    /// Stays together.
    Text(String),
    /// `(head part part …)`
    List { head: String, parts: Vec<Doc>, broken: bool },
    /// `:keyword value`
    Field(&'static str, Box<Doc>),
}

impl Doc {
    pub fn text(text: impl Display) -> Doc {
        Doc::Text(text.to_string())
    }

    pub fn list(head: impl Into<String>, parts: Vec<Doc>) -> Doc {
        Doc::List { head: head.into(), parts, broken: false }
    }

    pub fn field(keyword: &'static str, value: Doc) -> Doc {
        Doc::Field(keyword, Box::new(value))
    }

    /// One part a line even where it would fit on one.
    pub fn broken(mut self) -> Doc {
        if let Doc::List { broken, parts, .. } = &mut self {
            *broken = !parts.is_empty();
        }
        self
    }

    pub fn flat(&self) -> String {
        struct Flat<'a>(&'a Doc);
        impl Display for Flat<'_> {
            fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
                self.0.write_flat(f)
            }
        }
        Flat(self).to_string()
    }

    pub fn write_flat(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Doc::Text(text) => f.write_str(text),
            Doc::Field(keyword, value) => {
                write!(f, "{keyword} ")?;
                value.write_flat(f)
            }
            Doc::List { head, parts, .. } => {
                write!(f, "({head}")?;
                for (index, part) in parts.iter().enumerate() {
                    f.write_str(if index == 0 && head.is_empty() { "" } else { " " })?;
                    part.write_flat(f)?;
                }
                f.write_str(")")
            }
        }
    }

    /// Starts at column `column`; lines after the first are indented from there.
    pub fn write_laid_out(&self, f: &mut Formatter<'_>, column: usize) -> fmt::Result {
        if self.fits(WIDTH.saturating_sub(column)).is_some() {
            return self.write_flat(f);
        }
        match self {
            Doc::Text(text) => f.write_str(text),
            Doc::Field(keyword, value) => {
                write!(f, "{keyword} ")?;
                value.write_laid_out(f, column)
            }
            Doc::List { head, parts, .. } => {
                write!(f, "({head}")?;
                for (index, part) in parts.iter().enumerate() {
                    let follows = index == 0 && head.is_empty();
                    if !follows {
                        write!(f, "\n{:1$}", "", column + INDENT)?;
                    }
                    part.write_laid_out(f, column + INDENT)?;
                }
                f.write_str(")")
            }
        }
    }

    /// What of `room` is left after this on one line; `None` if it does not fit or must not.
    fn fits(&self, room: usize) -> Option<usize> {
        match self {
            Doc::Text(text) => room.checked_sub(text.len()),
            Doc::Field(keyword, value) => value.fits(room.checked_sub(keyword.len() + 1)?),
            Doc::List { broken: true, .. } => None,
            Doc::List { head, parts, .. } => {
                let room = room.checked_sub(head.len() + 2)?;
                parts.iter().try_fold(room, |room, part| part.fits(room.checked_sub(1)?))
            }
        }
    }
}

//! The text a tree was read from, and where in it a byte stands.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;

/// The longest text that is read: 64 MiB.
pub const MAX_SOURCE_BYTES: usize = 64 << 20;

/// A named text. Cloning shares the text.
#[derive(Clone, Debug)]
pub struct Source {
    /// What diagnostics call it: a path, or a name in angle brackets.
    pub name: Arc<str>,
    /// The text.
    pub text: Arc<str>,
}

impl Source {
    /// `text`, called `name`.
    pub fn new(name: impl AsRef<str>, text: impl AsRef<str>) -> Self {
        Source { name: Arc::from(name.as_ref()), text: Arc::from(text.as_ref()) }
    }

    /// Bytes of any encoding. What is not UTF-8 becomes U+FFFD: harmless in a comment, an error in a name.
    pub fn from_bytes(name: impl AsRef<str>, bytes: &[u8]) -> Self {
        let text = String::from_utf8_lossy(bytes);
        Source::new(name, text.strip_prefix('\u{feff}').unwrap_or(&text))
    }

    /// The file at `path`. Of a file above the size limit just enough is read to report that.
    pub fn read(path: impl AsRef<Path>) -> io::Result<Self> {
        let path = path.as_ref();
        let file = File::open(path)?;
        let most = MAX_SOURCE_BYTES as u64 + 1;
        // One byte more than the file has, so that its end is seen without growing. A pipe says zero.
        let expected = file.metadata().map_or(0, |metadata| metadata.len().min(most) + 1);
        let mut bytes = Vec::with_capacity(expected as usize);
        file.take(most).read_to_end(&mut bytes)?;
        Ok(Source::from_bytes(path.to_string_lossy(), &bytes))
    }

    /// Line and column of the byte `offset`, both from 1; columns count characters.
    pub fn position(&self, offset: usize) -> (usize, usize) {
        let mut offset = offset.min(self.text.len());
        while !self.text.is_char_boundary(offset) {
            offset -= 1;
        }
        let before = &self.text[..offset];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = 1 + before.bytes().filter(|byte| *byte == b'\n').count();
        (line, 1 + before[line_start..].chars().count())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_count_lines_and_characters_from_one() {
        let source = Source::new("x", "ab\nç(d)");
        assert_eq!(source.position(0), (1, 1));
        assert_eq!(source.position(3), (2, 1));
        assert_eq!(source.position(5), (2, 2), "ç is two bytes and one column");
        assert_eq!(source.position(4), (2, 1), "inside a character means at it");
        assert_eq!(source.position(999), (2, 5));
    }

    #[test]
    fn bytes_that_are_not_utf8_are_replaced() {
        assert_eq!(&*Source::from_bytes("x", b"\xef\xbb\xbf(a) ; caf\xe9").text, "(a) ; caf\u{fffd}");
    }
}

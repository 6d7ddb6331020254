//! Reports as text with carets, through `miette`.

use std::fmt;
use std::ops::Range;

use miette::{
    GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteError, MietteSpanContents, SourceCode,
    SourceSpan, SpanContents,
};

use crate::diagnostic::{Diagnostic, Report, Severity};
use crate::name::Span;
use crate::source::Source;

/// A snippet of more bytes than this is cut to a window around what it shows: some files are one line.
const MAX_SNIPPET_BYTES: usize = 2000;
const WINDOW_BYTES: usize = 60;
const LABELS_SHOWN: usize = 4;

impl Report {
    /// The report as plain text, without colour or line drawing.
    pub fn render(&self) -> String {
        self.render_with(GraphicalTheme::none())
    }

    /// The report for a terminal: colour and line drawing.
    pub fn render_coloured(&self) -> String {
        self.render_with(GraphicalTheme::unicode())
    }

    fn render_with(&self, theme: GraphicalTheme) -> String {
        let handler = GraphicalReportHandler::new_themed(theme).with_links(false).with_width(100);
        let mut text = String::new();
        for diagnostic in self.diagnostics() {
            if !text.is_empty() {
                text.push('\n');
            }
            let rendered = Rendered { diagnostic, source: self.source() };
            // Writing to a string does not fail; a snippet that cannot be shown shows its message at least.
            if handler.render_report(&mut text, &rendered).is_err() {
                text.push_str(&format!("{}: {}\n", diagnostic.code, rendered));
            }
        }
        if self.omitted() > 0 {
            text.push_str(&format!("... and {} more findings\n", self.omitted()));
        }
        text
    }
}

/// One diagnostic with its source, as `miette` wants to see it.
#[derive(Debug)]
struct Rendered<'a> {
    diagnostic: &'a Diagnostic,
    source: &'a Source,
}

impl Rendered<'_> {
    fn source_span(&self, span: Span) -> Option<SourceSpan> {
        let text = &self.source.text;
        let (start, end) = (span.start as usize, span.end as usize);
        let inside = end <= text.len() && start <= end && span != Span::NONE;
        (inside && text.is_char_boundary(start) && text.is_char_boundary(end))
            .then(|| SourceSpan::from((start, end - start)))
    }
}

impl fmt::Display for Rendered<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.diagnostic.message)
    }
}

impl std::error::Error for Rendered<'_> {}

impl miette::Diagnostic for Rendered<'_> {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(self.diagnostic.code))
    }

    fn severity(&self) -> Option<miette::Severity> {
        Some(match self.diagnostic.severity {
            Severity::Error => miette::Severity::Error,
            Severity::Warning => miette::Severity::Warning,
        })
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.diagnostic.help.as_ref().map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.labels().map(|_| self.source as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let main = self.source_span(self.diagnostic.span)?;
        let text = Some(self.diagnostic.label.clone()).filter(|label| !label.is_empty());
        let others = self.diagnostic.secondary.iter().take(LABELS_SHOWN).filter_map(|label| {
            Some(LabeledSpan::new_with_span(Some(label.text.clone()), self.source_span(label.span)?))
        });
        Some(Box::new(std::iter::once(LabeledSpan::new_primary_with_span(text, main)).chain(others)))
    }
}

impl SourceCode for Source {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        context_before: usize,
        context_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        // `miette` looks at every byte from the first one on.
        let near = self.lines_around(span, context_before, context_after);
        let inside = SourceSpan::from((span.offset() - near.start, span.len()));
        let contents = self.text[near.clone()].read_span(&inside, context_before, context_after)?;
        let place = contents.span();
        let mut shown = SourceSpan::from((near.start + place.offset(), place.len()));
        let (mut data, mut column) = (contents.data(), contents.column());
        let before = self.text[..near.start].bytes().filter(|byte| *byte == b'\n').count();
        let mut line = before + contents.line();
        if data.len() > MAX_SNIPPET_BYTES {
            (shown, data) = self.window(span);
            let (line_from_1, column_from_1) = self.position(shown.offset());
            (line, column) = (line_from_1 - 1, column_from_1 - 1);
        }
        let lines = data.iter().filter(|byte| **byte == b'\n').count() + 1;
        Ok(Box::new(MietteSpanContents::new_named(self.name.to_string(), data, shown, line, column, lines)))
    }
}

impl Source {
    /// The lines of `span` with so many before and after them, and one more.
    fn lines_around(&self, span: &SourceSpan, before: usize, after: usize) -> Range<usize> {
        let bytes = self.text.as_bytes();
        let start = span.offset().min(bytes.len());
        let end = (start + span.len()).min(bytes.len());
        let newline = |(_, byte): &(usize, &u8)| **byte == b'\n';
        let first = bytes[..start].iter().enumerate().rev().filter(newline).nth(before + 1);
        let last = bytes[end..].iter().enumerate().filter(newline).nth(after + 1);
        first.map_or(0, |(at, _)| at + 1)..last.map_or(bytes.len(), |(at, _)| end + at + 1)
    }

    /// Some bytes around the start of `span`, within its line.
    fn window(&self, span: &SourceSpan) -> (SourceSpan, &[u8]) {
        let bytes = self.text.as_bytes();
        let boundary = |mut at: usize| {
            while !self.text.is_char_boundary(at) {
                at -= 1;
            }
            at
        };
        let offset = span.offset().min(bytes.len());
        let from = boundary(offset.saturating_sub(WINDOW_BYTES));
        let from = bytes[from..offset].iter().rposition(|b| *b == b'\n').map_or(from, |at| from + at + 1);
        let end = (offset + span.len().min(MAX_SNIPPET_BYTES)).min(bytes.len());
        let to = boundary((end + WINDOW_BYTES).min(bytes.len()));
        (SourceSpan::from((from, to - from)), &bytes[from..to])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_snippet_is_the_one_that_reading_everything_gives() {
        let text = "a\nbc\r\n\nd(\u{e9})\n\n\nef\n g";
        let source = Source::new("x", text);
        for start in 0..=text.len() {
            for length in 0..=text.len() - start {
                for (before, after) in [(0, 0), (1, 1), (2, 0)] {
                    let span = SourceSpan::from((start, length));
                    let whole = text.read_span(&span, before, after).expect("it is inside");
                    let part = source.read_span(&span, before, after).expect("it is inside");
                    assert_eq!((part.data(), part.span()), (whole.data(), whole.span()));
                    assert_eq!((part.line(), part.column()), (whole.line(), whole.column()));
                }
            }
        }
    }
}

//! What a person sees while a team works: a line per phase and per action.

use std::io::Write;

use anstyle::{AnsiColor, Style};
use lamma_protocol::message::{Event, EventKind};

/// Sees events as they happen.
pub trait Watcher {
    /// Something happened.
    fn event(&mut self, event: &Event);
}

/// Nobody looks.
pub struct Silent;

impl Watcher for Silent {
    fn event(&mut self, _event: &Event) {}
}

/// Lines on a stream; `anstream` takes the colours out where they would not be seen.
pub struct Lines<W: Write> {
    out: W,
}

const DIM: Style = Style::new().dimmed();
const PHASE: Style = AnsiColor::Cyan.on_default().bold();
const STEP: Style = AnsiColor::Green.on_default();
const FAULT: Style = AnsiColor::Yellow.on_default().bold();

impl<W: Write> Lines<W> {
    /// Lines on `out`.
    pub fn new(out: W) -> Self {
        Lines { out }
    }
}

impl<W: Write> Watcher for Lines<W> {
    fn event(&mut self, event: &Event) {
        let ms = event.tick_us as f64 / 1e3;
        let text = &event.text;
        let line = match event.kind {
            EventKind::Phase => format!("{PHASE}{text}{PHASE:#}"),
            EventKind::Note => format!("  {text}"),
            EventKind::Step { done, total } => {
                let width = total.to_string().len();
                format!("  {STEP}[{done:>width$}/{total}]{STEP:#} {text}")
            }
            EventKind::Fault => format!("{FAULT}! {text}{FAULT:#}"),
        };
        // A closed pipe is the reader's wish, not an error of the run.
        let _ = writeln!(self.out, "{DIM}{ms:>8.1} ms{DIM:#}  {line}");
    }
}

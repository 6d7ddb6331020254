//! When to say again what was said: the cure for a lost message, thinned so that a large team at rest is
//! quiet.

use crate::id::Tick;

/// The shortest pause, in microseconds: what is new is repeated this often.
const FIRST_US: u64 = 100_000;

/// The longest pause, in microseconds: what has long been known is still repeated for who has come late.
const LAST_US: u64 = 2_000_000;

/// The schedule of one statement. The pause grows with the age of the news, to a quarter of it: within the
/// first four seconds there are fourteen repeats, and after them one in two seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Repeat {
    since: Tick,
    due: Tick,
}

impl Repeat {
    /// Something new was said.
    pub fn news(&mut self, now: Tick) {
        *self = Repeat { since: now, due: now.after_us(FIRST_US) };
    }

    /// When to say it again; at once, if it was not said yet.
    pub fn due(&self) -> Tick {
        self.due
    }

    /// Whether it is time to say it again; if so, the next time is set.
    pub fn take(&mut self, now: Tick) -> bool {
        let due = self.due <= now;
        if due {
            let pause = (now.since_us(self.since) / 4).clamp(FIRST_US, LAST_US);
            self.due = now.after_us(pause);
        }
        due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn repeats(seconds: u64) -> usize {
        let mut repeat = Repeat::default();
        repeat.news(Tick(0));
        (1..=seconds * 1000).filter(|ms| repeat.take(Tick(0).after_ms(*ms))).count()
    }

    #[test]
    fn news_is_repeated_often_and_what_is_known_seldom() {
        assert_eq!(repeats(4), 14);
        assert!(repeats(60) - repeats(40) <= 11, "one in two seconds at most");
        assert!(repeats(60) > repeats(40), "and never silent");
    }

    #[test]
    fn what_was_never_said_is_due_at_once() {
        assert!(Repeat::default().take(Tick(0)));
    }
}

//! When to say again what was said: the cure for a lost message, thinned so that a large team at rest is
//! quiet.

use crate::id::{AgentId, Tick};

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

/// What was said last to each member of a team, and when to say it again.
#[derive(Clone, Debug)]
pub struct SaidToEach<T>(Vec<Option<(T, Repeat)>>);

impl<T: Clone> SaidToEach<T> {
    /// Nothing yet.
    pub fn nothing(agents: usize) -> Self {
        SaidToEach(vec![None; agents])
    }

    /// The size of the team.
    pub fn agents(&self) -> usize {
        self.0.len()
    }

    /// What was said last to `agent`.
    pub fn last(&self, agent: AgentId) -> Option<&T> {
        self.0.get(agent.index())?.as_ref().map(|(said, _)| said)
    }

    /// Something new is said to `agent`.
    pub fn news(&mut self, agent: AgentId, said: T, now: Tick) {
        if let Some(slot) = self.0.get_mut(agent.index()) {
            let mut repeat = Repeat::default();
            repeat.news(now);
            *slot = Some((said, repeat));
        }
    }

    /// It is all void.
    pub fn forget(&mut self) {
        self.0.fill(None);
    }

    /// What is to be said again now; the next time is set.
    pub fn due(&mut self, now: Tick) -> impl Iterator<Item = (AgentId, T)> {
        (0..).map(AgentId).zip(&mut self.0).filter_map(move |(agent, said)| {
            let (said, repeat) = said.as_mut()?;
            repeat.take(now).then(|| (agent, said.clone()))
        })
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
    fn each_is_told_again_what_it_was_told_last() {
        let mut said = SaidToEach::nothing(3);
        said.news(AgentId(1), "go", Tick(0));
        said.news(AgentId(1), "stop", Tick(0));
        said.news(AgentId(9), "nobody", Tick(0));
        assert_eq!(said.due(Tick(1)).count(), 0, "it is too early");
        assert_eq!(said.due(Tick(FIRST_US)).collect::<Vec<_>>(), [(AgentId(1), "stop")]);
        assert_eq!(said.last(AgentId(1)), Some(&"stop"));
        said.forget();
        assert_eq!(said.due(Tick(9 * LAST_US)).count(), 0);
    }

    #[test]
    fn what_was_never_said_is_due_at_once() {
        assert!(Repeat::default().take(Tick(0)));
    }
}

//! Levels over a bad link, many at once: each parcel states all that has changed since the last one the other side
//! is known to have, so a parcel lost costs time and nothing else. After P. S. Almeida, A. Shoker, C. Baquero,
//! "Delta state replicated data types" (JPDC 2018), section 6: delta intervals, with acknowledgements.
//!
//! No clock and no socket in here: times are given, parcels are returned.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use lamma_protocol::Topic;

use super::Parcel;
use crate::content::Content;

/// How soon a parcel that is not acknowledged is followed by another, and how seldom in the end.
const FIRST_REPEAT: Duration = Duration::from_millis(100);
const LAST_REPEAT: Duration = Duration::from_secs(1);

/// One end of a link between two hosts.
#[derive(Debug)]
pub struct Link {
    session: u64,
    /// Counts the statements made here.
    version: u64,
    /// What the other side is known to have of them.
    acked: u64,
    levels: BTreeMap<Topic, (u64, Content)>,
    /// The other side's session, and what has come of it.
    peer: u64,
    seen: u64,
    owes_ack: bool,
    /// When to speak again if nothing comes back.
    again: Option<Instant>,
    pause: Duration,
}

impl Link {
    /// A link that knows nothing of the other side. A later start of the same end has a greater `session`; none is 0.
    pub fn new(session: u64) -> Link {
        Link {
            session,
            version: 0,
            acked: 0,
            levels: BTreeMap::new(),
            peer: 0,
            seen: 0,
            owes_ack: false,
            again: None,
            pause: FIRST_REPEAT,
        }
    }

    /// Something was said here. Saying the same again changes nothing.
    pub fn put(&mut self, topic: Topic, content: Content) {
        if self.levels.get(&topic).is_some_and(|(_, old)| *old == content) {
            return;
        }
        self.version += 1;
        self.levels.insert(topic, (self.version, content));
    }

    /// A parcel has come; gives what is new, to be said on this host.
    pub fn receive(&mut self, parcel: Parcel) -> Vec<(Topic, Content)> {
        if parcel.session < self.peer {
            // From before the other side's last start.
            return Vec::new();
        }
        if parcel.session > self.peer {
            // It has begun anew and has nothing.
            (self.peer, self.seen, self.acked) = (parcel.session, 0, 0);
            (self.again, self.pause) = (None, FIRST_REPEAT);
        }
        // An acknowledgement that was overtaken makes more be said than need be, which does no harm.
        let heard_of_this = parcel.heard_session == self.session && parcel.heard <= self.version;
        if heard_of_this && parcel.heard != self.acked {
            self.acked = parcel.heard;
            (self.again, self.pause) = (None, FIRST_REPEAT);
        }
        // News, news of what has happened since something that never came, or one who does not know of this side:
        // say what is known here.
        let stranger = parcel.heard_session != self.session;
        self.owes_ack |= !parcel.levels.is_empty() || parcel.base > self.seen || stranger;
        if parcel.upto <= self.seen || parcel.base > self.seen {
            return Vec::new();
        }
        self.seen = parcel.upto;
        parcel.levels
    }

    /// What to send now. While a parcel is under way nothing is sent, so that what is said in the meantime goes
    /// together in the next.
    pub fn poll(&mut self, now: Instant) -> Option<Parcel> {
        let news = self.has_news();
        let waiting = self.again.is_some_and(|again| again > now);
        if !self.owes_ack && (!news || waiting) {
            return None;
        }
        self.owes_ack = false;
        let mut levels = Vec::new();
        if news && !waiting {
            let new = self.levels.iter().filter(|(_, (version, _))| *version > self.acked);
            levels.extend(new.map(|(topic, (_, content))| (*topic, content.clone())));
            self.again = Some(now + self.pause);
            self.pause = (self.pause * 2).min(LAST_REPEAT);
        }
        Some(Parcel {
            session: self.session,
            base: self.acked,
            upto: if levels.is_empty() { self.acked } else { self.version },
            heard_session: self.peer,
            heard: self.seen,
            levels,
        })
    }

    /// Whether the other side lacks something, be it only that this side is there.
    fn has_news(&self) -> bool {
        self.version > self.acked || self.peer == 0
    }

    /// When to poll again if nothing happens before.
    pub fn due(&self) -> Option<Instant> {
        self.again.filter(|_| self.has_news())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn bytes(n: u8) -> Content {
        Content::Bytes(vec![n])
    }

    /// One of two hosts: what it said, and what it has heard of the other.
    struct Host {
        link: Link,
        said: BTreeMap<Topic, Content>,
        heard: BTreeMap<Topic, Content>,
    }

    impl Host {
        fn new(session: u64) -> Host {
            Host { link: Link::new(session), said: BTreeMap::new(), heard: BTreeMap::new() }
        }

        fn say(&mut self, topic: Topic, content: Content) {
            self.said.insert(topic, content.clone());
            self.link.put(topic, content);
        }

        fn restart(&mut self, session: u64) {
            *self = Host { said: self.said.clone(), ..Host::new(session) };
            // The local bus hands a late joiner all that was said.
            self.said.iter().for_each(|(topic, content)| self.link.put(*topic, content.clone()));
        }
    }

    proptest! {
        /// Whatever is lost, repeated or overtaken, and whoever starts again: once the link is good, both sides
        /// have all that the other said last, and then it is quiet.
        #[test]
        fn both_sides_agree_in_the_end(steps in proptest::collection::vec((0u8..7, any::<bool>(), 0u8..4, any::<u8>()), 0..200)) {
            let topics = [Topic::Grant, Topic::Command, Topic::Outcome, Topic::Vocabulary];
            let mut hosts = [Host::new(1), Host::new(2)];
            let mut way: Vec<(usize, Parcel)> = Vec::new();
            let (mut now, mut sessions) = (Instant::now(), 3);
            for (kind, who, topic, n) in steps {
                let who = usize::from(who);
                match kind {
                    0 | 1 => hosts[who].say(topics[usize::from(topic)], bytes(n)),
                    2 | 3 => way.extend(hosts[who].link.poll(now).map(|p| (1 - who, p))),
                    4 if !way.is_empty() => {
                        // Delivered, out of order, and perhaps once more later.
                        let at = usize::from(n) % way.len();
                        let (to, parcel) = if topic == 0 { way[at].clone() } else { way.remove(at) };
                        let news = hosts[to].link.receive(parcel);
                        hosts[to].heard.extend(news);
                    }
                    5 => { way.pop(); }
                    6 if n < 40 => { hosts[who].restart(sessions); sessions += 1; }
                    _ => now += Duration::from_millis(u64::from(n)),
                }
            }
            // What is still under way is lost; from here on all arrives.
            let mut quiet = 0;
            for _ in 0..100 {
                now += LAST_REPEAT;
                for who in [0, 1] {
                    match hosts[who].link.poll(now) {
                        Some(parcel) => {
                            quiet = 0;
                            let news = hosts[1 - who].link.receive(parcel);
                            hosts[1 - who].heard.extend(news);
                        }
                        None => quiet += 1,
                    }
                }
            }
            prop_assert!(quiet > 20, "the link does not come to rest");
            prop_assert_eq!(&hosts[0].heard, &hosts[1].said);
            prop_assert_eq!(&hosts[1].heard, &hosts[0].said);
        }
    }

    #[test]
    fn a_barrier_of_many_costs_few_parcels() {
        let (mut near, mut far) = (Link::new(1), Link::new(2));
        let now = Instant::now();
        let topics = Topic::all(256).into_iter().filter(|t| matches!(t, Topic::Request(_)));
        let mut parcels = Vec::new();
        for topic in topics {
            far.put(topic, bytes(1));
            parcels.extend(far.poll(now));
        }
        assert_eq!(parcels.len(), 1, "the first goes at once, the others wait for its acknowledgement");
        near.receive(parcels.remove(0));
        far.receive(near.poll(now).expect("an acknowledgement"));
        let rest = far.poll(now).expect("the rest");
        assert_eq!(near.receive(rest).len(), 255);
    }
}

//! The machines of one driver: who hears what, when each wants to be woken, and what they have asked for.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::time::{Duration, Instant};

use lamma_protocol::{AgentId, Awaits, Envelope, Frame, Input, Machine, Node, Output, Revision, Tick, Topic};

use super::{Recorder, Settings, Stop};

/// The machines of a driver.
pub(super) struct Crowd<'a, M: Machine> {
    seats: Vec<Seat<'a, M>>,
    places: BTreeMap<Node, usize>,
    /// When which machine wants its timeout.
    timers: BTreeSet<(Tick, usize)>,
    /// What they have asked for and was not done yet, and who.
    pub(super) pending: VecDeque<(usize, Output<M::Job>)>,
    /// The newest frame they want published: it replaces the one before it, and readers need only the last.
    pub(super) newest_frame: Option<(usize, Vec<u64>)>,
    /// The newest frame that many have been shown, without its facts, and how many there were.
    frame: Vec<u64>,
    frames: u64,
    unfinished: usize,
    start: Instant,
    record: Option<Recorder<'a, M::Done>>,
    pub(super) stop: Stop,
}

/// One machine.
struct Seat<'a, M> {
    machine: &'a mut M,
    node: Node,
    revision: Revision,
    timer: Option<Tick>,
    finished: bool,
    /// How many frames there were when it was shown one.
    shown: u64,
}

impl<'a, M: Machine> Crowd<'a, M> {
    pub(super) fn new(
        machines: impl IntoIterator<Item = (Node, &'a mut M)>,
        settings: Settings<'a, M::Done>,
    ) -> Self {
        let revision = Revision { incarnation: settings.incarnation, number: 0 };
        let seat = |(node, machine)| Seat { machine, node, revision, timer: None, finished: false, shown: 0 };
        let seats: Vec<_> = machines.into_iter().map(seat).collect();
        Crowd {
            places: seats.iter().enumerate().map(|(i, seat)| (seat.node, i)).collect(),
            timers: BTreeSet::new(),
            pending: VecDeque::new(),
            newest_frame: None,
            frame: Vec::new(),
            frames: 0,
            unfinished: seats.len(),
            seats,
            start: settings.start,
            record: settings.record,
            stop: settings.stop,
        }
    }

    pub(super) fn node(&self, machine: usize) -> Node {
        self.seats[machine].node
    }

    fn now(&self) -> Tick {
        Tick(u64::try_from(self.start.elapsed().as_micros()).unwrap_or(u64::MAX))
    }

    /// Takes what the machines want before they have heard anything.
    pub(super) fn begin(&mut self) {
        (0..self.seats.len()).for_each(|machine| self.drain(machine));
    }

    /// One mutation of one machine, then drain. If it waits for a frame now that was there before, it is shown it.
    pub(super) fn handle(&mut self, machine: usize, input: Input<'_, M::Done>) {
        self.feed(machine, input);
        if self.seats[machine].shown < self.frames && self.wants(machine) {
            self.show(machine);
        }
    }

    fn feed(&mut self, machine: usize, input: Input<'_, M::Done>) {
        let now = self.now();
        let seat = &mut self.seats[machine];
        if seat.finished {
            return;
        }
        if let Some(record) = &mut self.record {
            record(now, seat.node, &input);
        }
        seat.machine.handle(now, input);
        self.drain(machine);
    }

    fn drain(&mut self, machine: usize) {
        let seat = &mut self.seats[machine];
        while let Some(output) = seat.machine.poll_output() {
            match output {
                Output::PublishFrame(words) => self.newest_frame = Some((machine, words)),
                output => self.pending.push_back((machine, output)),
            }
        }
        self.set_timer(machine);
    }

    fn set_timer(&mut self, machine: usize) {
        let seat = &mut self.seats[machine];
        let wanted = seat.machine.poll_timeout().filter(|_| !seat.finished);
        if wanted == seat.timer {
            return;
        }
        if let Some(old) = std::mem::replace(&mut seat.timer, wanted) {
            self.timers.remove(&(old, machine));
        }
        self.timers.extend(wanted.map(|tick| (tick, machine)));
    }

    /// A message goes to whom the topic is for; who is alone hears all that the bus hands over.
    pub(super) fn message(&mut self, topic: Topic, envelope: Envelope) {
        match topic {
            _ if self.seats.len() == 1 => self.handle(0, Input::Message(topic, envelope)),
            Topic::Directive(a) | Topic::Ack(a) => {
                if let Some(&machine) = self.places.get(&Node::Robot(a)) {
                    self.handle(machine, Input::Message(topic, envelope));
                }
            }
            _ => {
                for machine in 0..self.seats.len() {
                    if topic.read_by(self.seats[machine].node) {
                        self.handle(machine, Input::Message(topic, envelope.clone()));
                    }
                }
            }
        }
    }

    /// Who is alone is shown each frame. Of many, those who wait for it: a team of thousands makes thousands of
    /// frames, and most concern few.
    pub(super) fn frame(&mut self, frame: Frame<'_>) {
        if self.seats.len() == 1 {
            return self.handle(0, Input::Frame(frame));
        }
        self.frame = frame.without_facts();
        self.frames += 1;
        for machine in 0..self.seats.len() {
            if self.wants(machine) {
                self.seats[machine].shown = self.frames;
                self.feed(machine, Input::Frame(frame));
            }
        }
    }

    /// Whether a machine waits for a frame like the newest.
    fn wants(&self, machine: usize) -> bool {
        match self.seats[machine].machine.awaits() {
            Awaits::AnyFrame => true,
            Awaits::Opening(gate) => Frame::new(&self.frame).is_ok_and(|frame| frame.open(gate)),
            Awaits::NoFrame => false,
        }
    }

    fn show(&mut self, machine: usize) {
        self.seats[machine].shown = self.frames;
        let words = std::mem::take(&mut self.frame);
        if let Ok(frame) = Frame::new(&words) {
            self.feed(machine, Input::Frame(frame));
        }
        self.frame = words;
    }

    pub(super) fn hint(&mut self, agent: AgentId) {
        (0..self.seats.len()).for_each(|machine| self.handle(machine, Input::PeerHint(agent)));
    }

    /// Feeds a timeout to each machine that is due; false if none was.
    pub(super) fn handle_timeouts(&mut self) -> bool {
        let now = self.now();
        let due: Vec<usize> = self.timers.range(..=(now, usize::MAX)).map(|(_, machine)| *machine).collect();
        due.iter().for_each(|machine| self.handle(*machine, Input::Timeout));
        !due.is_empty()
    }

    /// How long there is nothing to do by itself; None: for ever.
    pub(super) fn idle_time(&self) -> Option<Duration> {
        self.timers.first().map(|(tick, _)| Duration::from_micros(tick.since_us(self.now())))
    }

    /// Which frames are worth waking up for.
    pub(super) fn awaits(&self) -> Awaits {
        match &self.seats[..] {
            [one] => one.machine.awaits(),
            many if many.iter().all(|seat| seat.machine.awaits() == Awaits::NoFrame) => Awaits::NoFrame,
            _ => Awaits::AnyFrame,
        }
    }

    pub(super) fn next_revision(&mut self, machine: usize) -> Revision {
        let seat = &mut self.seats[machine];
        seat.revision = seat.revision.next();
        seat.revision
    }

    pub(super) fn finish(&mut self, machine: usize) {
        let seat = &mut self.seats[machine];
        if !std::mem::replace(&mut seat.finished, true) {
            self.unfinished -= 1;
            self.set_timer(machine);
        }
    }

    /// Whether all have.
    pub(super) fn finished(&self) -> bool {
        self.unfinished == 0
    }
}

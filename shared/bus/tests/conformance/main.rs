//! One suite of promises, run on every transport.

mod suite;

use lamma_bus::iceoryx::{Endpoint, Run, Scope, sweep};
use lamma_bus::inproc::{Hub, Inproc};
use lamma_protocol::Node;

/// A transport under test: the bus of one run.
trait Fixture: Sync {
    /// Its endpoints.
    type Endpoint: lamma_bus::Bus;
    /// The bus of a team of `agents`.
    fn new(agents: u16) -> Self;
    /// The endpoint of `node`.
    fn open(&self, node: Node) -> Self::Endpoint;
}

struct InprocFixture(Hub);

impl Fixture for InprocFixture {
    type Endpoint = Inproc;

    fn new(agents: u16) -> Self {
        InprocFixture(Hub::new(agents))
    }

    fn open(&self, node: Node) -> Inproc {
        self.0.open(node).expect("a node of the team")
    }
}

/// The run's owner, which must stay in its thread, waits on one of its own.
struct IceoryxFixture {
    scope: Scope,
    end: Option<std::sync::mpsc::Sender<()>>,
    owner: Option<std::thread::JoinHandle<()>>,
}

impl Fixture for IceoryxFixture {
    type Endpoint = Endpoint;

    fn new(agents: u16) -> Self {
        let (end, ended) = std::sync::mpsc::channel();
        let (tell, told) = std::sync::mpsc::channel();
        let owner = std::thread::spawn(move || {
            let run = Run::create(agents).expect("shared memory");
            tell.send(run.scope().clone()).expect("the fixture waits");
            // Ends when the fixture is dropped.
            let _ = ended.recv();
            run.end().expect("all is removed");
        });
        let scope = told.recv().expect("the owner's thread tells");
        IceoryxFixture { scope, end: Some(end), owner: Some(owner) }
    }

    fn open(&self, node: Node) -> Endpoint {
        Endpoint::open(&self.scope, node).expect("an endpoint")
    }
}

impl Drop for IceoryxFixture {
    fn drop(&mut self) {
        drop(self.end.take());
        let _ = self.owner.take().map(std::thread::JoinHandle::join);
        sweep(&self.scope).expect("sweeping twice does nothing");
    }
}

/// Every promise of the suite as a test of one fixture.
macro_rules! conformance {
    ($name:ident, $fixture:ty) => {
        conformance!($name, $fixture,
            newest_wins newest_wins_for_frames every_topic_reaches_exactly_its_readers
            statements_come_in_order_or_not_at_all nothing_new_is_nothing_received
            a_late_joiner_gets_the_newest a_reader_may_be_there_before_the_publisher
            a_restarted_reader_gets_the_newest a_restarted_publisher_is_heard
            last_words_are_heard_after_a_publisher_has_left
            only_the_publisher_publishes foreign_bytes_are_dropped_and_counted
            another_version_is_refused_by_name a_message_too_large_is_refused_at_the_sender
            foreign_words_are_no_frame a_large_message_and_a_large_frame_arrive
            a_reader_that_never_reads_blocks_nobody a_publication_ends_a_wait_in_another_thread
            a_waker_ends_a_wait a_waker_used_before_the_wait_is_not_lost a_wait_ends_with_its_time
        );
    };
    ($name:ident, $fixture:ty, $($test:ident)*) => {
        mod $name {
            $(#[test]
            fn $test() {
                super::suite::$test::<$fixture>();
            })*
        }
    };
}

conformance!(inproc, super::InprocFixture);
conformance!(iceoryx, super::IceoryxFixture);

//! One suite of promises, run on every transport.

mod bad_network;
mod suite;
mod wakes;

use lamma_bus::faulty::{FaultyBus, Plan};
use lamma_bus::iceoryx::{Endpoint, Run, Scope, sweep};
use lamma_bus::inproc::{Hub, Inproc};
use lamma_protocol::Node;

/// A transport under test: the bus of one run.
trait Fixture: Sync {
    /// Its endpoints.
    type Endpoint: lamma_bus::Bus;
    /// Whether what was published can be received when `publish` returns. Where it is still on its way, a reader
    /// that looks early sees more of what is replaced.
    const IMMEDIATE: bool = true;
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

#[cfg(feature = "zenoh")]
struct ZenohFixture {
    join: lamma_bus::zenoh::Join,
    _router: lamma_bus::zenoh::Router,
}

#[cfg(feature = "zenoh")]
impl Fixture for ZenohFixture {
    type Endpoint = lamma_bus::zenoh::Endpoint;
    const IMMEDIATE: bool = false;

    fn new(agents: u16) -> Self {
        let router = lamma_bus::zenoh::Router::local().expect("a router");
        let join = lamma_bus::zenoh::Join {
            run: "conformance".parse().expect("a run's id"),
            agents,
            connect: router.endpoint(),
            identity: None,
            patience: std::time::Duration::from_secs(5),
        };
        ZenohFixture { join, _router: router }
    }

    fn open(&self, node: Node) -> Self::Endpoint {
        lamma_bus::zenoh::Endpoint::open(&self.join, node).expect("an endpoint")
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
            a_reader_that_never_reads_blocks_nobody;
            a_publication_ends_a_wait_in_another_thread an_awaited_frame_ends_a_wait_in_another_thread
            what_is_not_awaited_comes_with_what_is a_waker_ends_a_wait
            a_waker_used_before_the_wait_is_not_lost a_wait_ends_with_its_time
        );
    };
    ($name:ident, $fixture:ty, $($test:ident)*; $($wake:ident)*) => {
        mod $name {
            #[test]
            fn levels_converge_through_a_bad_network() {
                super::bad_network::levels_converge::<$fixture>();
            }
            #[test]
            fn a_partition_swallows_and_heals() {
                super::bad_network::a_partition_heals::<$fixture>();
            }
            $(#[test]
            fn $test() {
                super::suite::$test::<$fixture>();
            })*
            $(#[test]
            fn $wake() {
                super::wakes::$wake::<$fixture>();
            })*
        }
    };
}

/// Any of them behind a [`FaultyBus`] that injects nothing: it must not be noticed.
struct Behind<F>(F);

impl<F: Fixture> Fixture for Behind<F> {
    type Endpoint = FaultyBus<F::Endpoint>;
    const IMMEDIATE: bool = F::IMMEDIATE;

    fn new(agents: u16) -> Self {
        Behind(F::new(agents))
    }

    fn open(&self, node: Node) -> Self::Endpoint {
        FaultyBus::new(self.0.open(node), Plan::default(), 0)
    }
}

conformance!(inproc, super::InprocFixture);
conformance!(inproc_behind_a_faultless_network, super::Behind<super::InprocFixture>);
conformance!(iceoryx, super::IceoryxFixture);
#[cfg(feature = "zenoh")]
conformance!(zenoh, super::ZenohFixture);

//! A bridge's parcels over Zenoh: one session, one key from each host to each.

use std::collections::BTreeMap;
use std::sync::Arc;

use zenoh::key_expr::KeyExpr;
use zenoh::pubsub::Subscriber;
use zenoh::qos::CongestionControl;
use zenoh::sample::Sample;
use zenoh::{Session, Wait};

use super::keys::Keys;
use super::{Join, OpenError, Router, RunId, config};
use crate::bridge::Bridge;

/// The session of one host.
pub struct Wire {
    session: Session,
    to: BTreeMap<String, KeyExpr<'static>>,
    _subscriber: Subscriber<()>,
}

impl Wire {
    /// The session of the hub, which is the router's own.
    pub fn of_router(
        router: &Router,
        run: &RunId,
        host: &str,
        bridge: &Arc<Bridge>,
    ) -> Result<Wire, OpenError> {
        Wire::new(router.session(), run, host, bridge)
    }

    /// The session of another host.
    pub fn join(join: &Join, host: &str, bridge: &Arc<Bridge>) -> Result<Wire, OpenError> {
        let refused = |e: zenoh::Error| OpenError::Bridge { host: host.into(), reason: e.to_string() };
        let session = zenoh::open(config::client(join, config::Room::Awaited)?).wait().map_err(refused)?;
        Wire::new(session, &join.run, host, bridge)
    }

    fn new(session: Session, run: &RunId, host: &str, bridge: &Arc<Bridge>) -> Result<Wire, OpenError> {
        let refused = |e: zenoh::Error| OpenError::Bridge { host: host.into(), reason: e.to_string() };
        let keys = Keys::new(run);
        let mut to = BTreeMap::new();
        for other in bridge.hosts() {
            let key = session.declare_keyexpr(keys.key(&format!("bridge/{host}/{other}"))).wait();
            to.insert(other.to_owned(), key.map_err(refused)?);
        }
        let takes = Arc::clone(bridge);
        let take = move |sample: Sample| {
            if let Some(from) = sample.key_expr().rsplit('/').nth(1) {
                takes.receive(from, &sample.payload().to_bytes());
            }
        };
        let heard = session.declare_subscriber(keys.key(&format!("bridge/*/{host}"))).callback(take).wait();
        Ok(Wire { session, to, _subscriber: heard.map_err(refused)? })
    }

    /// Sends to a host. What does not arrive is sent again by the link.
    pub fn send(&self, host: &str, bytes: Vec<u8>) {
        let Some(key) = self.to.get(host) else { return };
        let put = self.session.put(key, bytes).congestion_control(CongestionControl::Drop).express(true);
        if let Err(error) = put.wait() {
            tracing::debug!("to {host}: {error}");
        }
    }
}

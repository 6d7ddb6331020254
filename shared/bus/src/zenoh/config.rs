//! Settings of Zenoh sessions: what is not said here is Zenoh's default.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::Duration;

use lamma_protocol::codec;
use thiserror::Error;
use zenoh::Config;

use super::OpenError;

/// A run's name on the network: one chunk of a key.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct RunId(String);

/// Text that is not a [`RunId`].
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("`{0}` cannot name a run: 1 to 100 letters, digits, `-`, `_` or `.` are expected")]
pub struct RunIdError(String);

impl RunId {
    /// The name nearest to any text: what does not fit becomes `_`.
    pub fn lossy(text: &str) -> RunId {
        let name: String = text.chars().take(100).map(|c| if fits(c) { c } else { '_' }).collect();
        RunId(if name.is_empty() { "_".into() } else { name })
    }
}

fn fits(c: char) -> bool {
    c.is_ascii_alphanumeric() || "-_.".contains(c)
}

impl FromStr for RunId {
    type Err = RunIdError;

    fn from_str(text: &str) -> Result<RunId, RunIdError> {
        match (1..=100).contains(&text.len()) && text.chars().all(fits) {
            true => Ok(RunId(text.into())),
            false => Err(RunIdError(text.into())),
        }
    }
}

impl fmt::Display for RunId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Who a session is to its other end: files as `lamma new --secure` writes them, all of one folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identity {
    /// The folder with `ca.pem`, `NAME.pem` and `NAME-key.pem`.
    pub folder: PathBuf,
    /// The name in the certificate: a node's (`robot-0`), or `router`.
    pub name: String,
}

impl Identity {
    fn file(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    fn authority(&self) -> PathBuf {
        self.file("ca.pem")
    }

    fn certificate(&self) -> PathBuf {
        self.file(&format!("{}.pem", self.name))
    }

    fn key(&self) -> PathBuf {
        self.file(&format!("{}-key.pem", self.name))
    }
}

/// Where and as what to join a run.
#[derive(Clone, Debug)]
pub struct Join {
    /// Which run.
    pub run: RunId,
    /// The size of its team.
    pub agents: u16,
    /// The router, as Zenoh writes endpoints: `tcp/hub:7447`, `tls/hub:7447`, `unixsock-stream//path`.
    pub connect: String,
    /// For `tls`.
    pub identity: Option<Identity>,
    /// How long to try before giving up; zero: once.
    pub patience: Duration,
}

/// The largest message that is put together from its parts: ours with some room for Zenoh's own head.
const LARGEST: usize = codec::MAX_MESSAGE_BYTES + (64 << 10);

/// From this size on a message is large: the queue of a link may well have no room for all its parts at once.
pub(super) const LARGE: usize = 256 << 10;

/// What a session does with a message for which the queue of its link has no room.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Room {
    /// It drops it. On a busy host who sleeps for a moment gets its turn again after milliseconds, and what is
    /// dropped is said again.
    AtOnce,
    /// It waits for room, as a large message must on a slow link.
    Awaited,
}

/// How long a message may wait for room before it is dropped, in microseconds; and in all for the parts of a
/// large one.
const WAIT: &str = "transport/link/tx/queue/congestion_control/drop/wait_before_drop";
const WAIT_BEFORE_DROP: u64 = 100;
const WAIT_BEFORE_DROP_LARGE: u64 = 500_000;

/// Batches of 64 KiB that wait in the queue of a link: memory is taken only when they are needed.
const QUEUE: usize = 16;

/// Whether what is said to or by a team of this size goes out at once instead of being batched with what follows. It
/// is a batch of its own then, so all that a team says at once must fit into the queue of one link.
pub(super) fn at_once(agents: u16) -> bool {
    2 * usize::from(agents) <= QUEUE
}

/// Sessions that a router takes, and such as may be about to.
const SESSIONS: usize = 16_384;

/// The settings of a session that joins a run.
pub(super) fn client(join: &Join, room: Room) -> Result<Config, OpenError> {
    let mut config = common(join.identity.as_ref())?;
    set(&mut config, "mode", "client")?;
    if room == Room::AtOnce {
        set(&mut config, WAIT, 0)?;
    }
    set(&mut config, "connect/endpoints", [&join.connect])?;
    let patience = i64::try_from(join.patience.as_millis()).unwrap_or(i64::MAX);
    set(&mut config, "connect/timeout_ms", patience)?;
    set(&mut config, "connect/exit_on_failure", true)?;
    // Also after a lost connection: soon, and never too seldom.
    let retry =
        serde_json::json!({ "period_init_ms": 100, "period_max_ms": 1_000, "period_increase_factor": 2.0 });
    set(&mut config, "connect/retry", retry)?;
    if let Some(identity) = &join.identity {
        set(&mut config, "transport/link/tls/connect_certificate", identity.certificate())?;
        set(&mut config, "transport/link/tls/connect_private_key", identity.key())?;
    }
    Ok(config)
}

/// The settings of a router that others join at `listen` and that joins other routers at `connect`.
pub(super) fn router(
    listen: &[String],
    connect: &[String],
    identity: Option<&Identity>,
    rules: Option<&Path>,
) -> Result<Config, OpenError> {
    let mut config = common(identity)?;
    set(&mut config, "mode", "router")?;
    set(&mut config, "listen/endpoints", listen)?;
    set(&mut config, "listen/exit_on_failure", true)?;
    set(&mut config, "connect/endpoints", connect)?;
    set(&mut config, "transport/unicast/max_sessions", SESSIONS)?;
    set(&mut config, "transport/unicast/accept_pending", SESSIONS)?;
    if let Some(identity) = identity {
        for (key, path) in [
            ("listen_certificate", identity.certificate()),
            ("listen_private_key", identity.key()),
            ("connect_certificate", identity.certificate()),
            ("connect_private_key", identity.key()),
        ] {
            set(&mut config, &format!("transport/link/tls/{key}"), path)?;
        }
    }
    if let Some(rules) = rules {
        let fail = |reason: String| OpenError::Setting { key: rules.display().to_string(), reason };
        let text = std::fs::read_to_string(rules).map_err(|e| fail(e.to_string()))?;
        config.insert_json5("access_control", &text).map_err(|e| fail(e.to_string()))?;
    }
    Ok(config)
}

fn common(identity: Option<&Identity>) -> Result<Config, OpenError> {
    let mut config = Config::default();
    set(&mut config, "scouting/multicast/enabled", false)?;
    set(&mut config, "scouting/gossip/enabled", false)?;
    set(&mut config, "timestamping/enabled", false)?;
    set(&mut config, "transport/link/rx/max_message_size", LARGEST)?;
    for priority in ["data", "interactive_high"] {
        set(&mut config, &format!("transport/link/tx/queue/size/{priority}"), QUEUE)?;
    }
    let drop = "transport/link/tx/queue/congestion_control/drop";
    set(&mut config, WAIT, WAIT_BEFORE_DROP)?;
    set(&mut config, &format!("{drop}/max_wait_before_drop_fragments"), WAIT_BEFORE_DROP_LARGE)?;
    if let Some(identity) = identity {
        set(&mut config, "transport/link/tls/root_ca_certificate", identity.authority())?;
        set(&mut config, "transport/link/tls/enable_mtls", true)?;
        set(&mut config, "transport/link/tls/verify_name_on_connect", true)?;
    }
    Ok(config)
}

fn set(config: &mut Config, key: &str, value: impl serde::Serialize) -> Result<(), OpenError> {
    let fail = |reason: String| OpenError::Setting { key: key.to_owned(), reason };
    let text = serde_json::to_string(&value).map_err(|e| fail(e.to_string()))?;
    config.insert_json5(key, &text).map_err(|e| fail(e.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_runs_id_is_one_chunk_of_a_key() {
        for good in ["20261122-190507-77-00ff", "a.b_c"] {
            assert_eq!(good.parse::<RunId>().map(|id| id.to_string()), Ok(good.to_owned()));
        }
        for bad in ["", "a/b", "*", "a$b", "ä", &"x".repeat(101)] {
            assert!(bad.parse::<RunId>().is_err(), "{bad}");
            assert!(RunId::lossy(bad).to_string().parse::<RunId>().is_ok(), "{bad}");
        }
    }

    #[test]
    fn every_setting_is_one_that_zenoh_knows() {
        let identity = Identity { folder: "certs".into(), name: "robot-0".into() };
        let join = Join {
            run: "r".parse().expect("a run's id"),
            agents: 1,
            connect: "tls/hub:7447".into(),
            identity: Some(identity.clone()),
            patience: Duration::from_secs(3),
        };
        client(&join, Room::AtOnce).expect("a client's settings");
        client(&join, Room::Awaited).expect("a client's settings");
        let listen = ["tls/[::]:7447".to_owned()];
        let connect = ["tcp/other:7447".to_owned()];
        router(&listen, &connect, Some(&identity), None).expect("a router's settings");
        let wrong = Join { connect: "nonsense".into(), ..join };
        assert!(matches!(client(&wrong, Room::Awaited), Err(OpenError::Setting { .. })));
    }
}

//! Where the shared memory of one run lies and how it is called.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use iceoryx2::prelude::{Config, FileName, Path as IoxPath, SemanticString};
use lamma_protocol::AgentId;
use thiserror::Error;

use super::layout::{Layout, Party};

/// All POSIX shared memory of a host is here, as files.
pub(super) const SHARED_MEMORY: &str = "/dev/shm";

/// Publishers that have left and whose last words a robot has not read yet, at most.
const EXPIRED_AT_SEATS: usize = 8;

/// Letters in a tag.
const TAG: usize = 12;

/// What all processes of a run must agree on to meet: it is handed to them as text, on the command line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Scope {
    tag: String,
    agents: u16,
    per_seat: u16,
    root: PathBuf,
}

impl Scope {
    pub(super) fn new(tag: String, layout: Layout, root: PathBuf) -> Scope {
        Scope { tag, agents: layout.agents, per_seat: layout.per_seat, root }
    }

    /// The shape of the run.
    pub(super) fn layout(&self) -> Layout {
        Layout { agents: self.agents, per_seat: self.per_seat }
    }

    /// The robots that one process hosts, for each such process: one each, unless the run was created with
    /// more to a seat.
    pub fn seats(&self) -> Vec<Range<u16>> {
        (0..self.layout().seats()).map(|s| self.layout().agents_of(s)).collect()
    }

    /// The robots that are hosted where this one is.
    pub fn seat_mates(&self, agent: AgentId) -> Range<u16> {
        self.layout().agents_of(agent.0 / self.per_seat)
    }

    /// Twelve hexadecimal digits that no other run on this host has.
    pub fn tag(&self) -> &str {
        &self.tag
    }

    /// The size of the team.
    pub fn agents(&self) -> u16 {
        self.agents
    }

    /// The folder of everything that is not shared memory itself.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The file of the page that wakes its parties.
    pub(super) fn bells(&self) -> PathBuf {
        self.root.join("bells")
    }

    /// With what the name of every file of the run begins.
    pub(super) fn prefix(tag: &str) -> String {
        format!("lamma-{tag}_")
    }

    /// The file that the owner of the run keeps locked while it lives.
    pub(super) fn owner_file(tag: &str) -> PathBuf {
        Path::new(SHARED_MEMORY).join(Scope::prefix(tag) + "owner")
    }

    /// A folder for the run in `base`.
    pub(super) fn root_in(base: &Path, tag: &str) -> PathBuf {
        base.join(Scope::prefix(tag) + "root")
    }

    /// The tag in the name of a file of some run.
    pub(super) fn tag_of(file_name: &str) -> Option<&str> {
        let rest = file_name.strip_prefix("lamma-")?;
        let (tag, rest) = rest.split_at_checked(TAG)?;
        (rest.starts_with('_') && is_tag(tag)).then_some(tag)
    }

    /// The transport's configuration for one party: the run's names, and no clean-up by members.
    pub(super) fn config(&self, party: Party) -> Result<Config, String> {
        let mut config = Config::default();
        let root = self.root.to_str().ok_or("the path is not UTF-8")?;
        let root = IoxPath::new(root.as_bytes()).map_err(|e| format!("the path cannot be used: {e:?}"))?;
        let prefix = FileName::new(Scope::prefix(&self.tag).as_bytes()).map_err(|e| format!("{e:?}"))?;
        config.global.set_root_path(&root);
        config.global.prefix = prefix;
        config.global.node.cleanup_dead_nodes_on_creation = false;
        config.global.node.cleanup_dead_nodes_on_destruction = false;
        config.global.service.cleanup_dead_nodes_on_open = false;
        if let Party::Seat(_) = party {
            // Connections of publishers that have left are kept for their last words. Room for the default of 128
            // is a third of what a robot costs, and nobody but three others ever publishes to it.
            config.defaults.publish_subscribe.subscriber_expired_connection_buffer = EXPIRED_AT_SEATS;
        }
        Ok(config)
    }
}

pub(super) fn is_tag(text: &str) -> bool {
    text.len() == TAG && text.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'))
}

impl fmt::Display for Scope {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}:{}", self.tag, self.agents, self.per_seat, self.root.display())
    }
}

/// Text that is not a [`Scope`].
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error(
    "`{0}` is not a shared-memory scope (`<12 hex digits>:<agents>:<agents per process>:<folder>`): pass on what the launcher gave"
)]
pub struct ScopeParseError(String);

impl FromStr for Scope {
    type Err = ScopeParseError;

    fn from_str(text: &str) -> Result<Scope, ScopeParseError> {
        let mut parts = text.splitn(4, ':');
        let mut part = || parts.next().filter(|p| !p.is_empty()).ok_or_else(|| ScopeParseError(text.into()));
        let (tag, agents, per_seat, root) = (part()?, part()?, part()?, part()?);
        let number = |part: &str| part.parse::<u16>().map_err(|_| ScopeParseError(text.into()));
        let (agents, per_seat) = (number(agents)?, number(per_seat)?);
        if !is_tag(tag) || per_seat == 0 {
            return Err(ScopeParseError(text.into()));
        }
        Ok(Scope { tag: tag.into(), agents, per_seat, root: root.into() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scope_survives_the_command_line() {
        let layout = Layout { agents: 7, per_seat: 3 };
        let scope = Scope::new("0123456789ab".into(), layout, "/dev/shm/a:b".into());
        assert_eq!(scope.to_string().parse(), Ok(scope));
        for bad in [
            "",
            "x",
            "0123456789ab:7:1",
            "0123456789ab::1:r",
            "0123456789ag:7:1:r",
            "0123456789ab:70000:1:r",
            "0123456789ab:7:0:r",
        ] {
            assert!(bad.parse::<Scope>().is_err(), "{bad}");
        }
    }

    #[test]
    fn only_our_own_files_have_a_tag() {
        assert_eq!(Scope::tag_of("lamma-0123456789ab_owner"), Some("0123456789ab"));
        for foreign in ["lamma-", "lamma-0123456789abc_x", "lamma-0123456789äb_", "iox2_123", ""] {
            assert_eq!(Scope::tag_of(foreign), None, "{foreign}");
        }
    }
}

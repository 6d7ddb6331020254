//! Where the shared memory of one run lies and how it is called.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use iceoryx2::prelude::{Config, FileName, Path as IoxPath, SemanticString};
use thiserror::Error;

/// All POSIX shared memory of a host is here, as files.
pub(super) const SHARED_MEMORY: &str = "/dev/shm";

/// Letters in a tag.
const TAG: usize = 12;

/// What all processes of a run must agree on to meet: it is handed to them as text, on the command line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Scope {
    tag: String,
    agents: u16,
    root: PathBuf,
}

impl Scope {
    pub(super) fn new(tag: String, agents: u16, root: PathBuf) -> Scope {
        Scope { tag, agents, root }
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

    /// The transport's configuration: the run's names, and no clean-up by members.
    pub(super) fn config(&self) -> Result<Config, String> {
        let mut config = Config::default();
        let root = self.root.to_str().ok_or("the path is not UTF-8")?;
        let root = IoxPath::new(root.as_bytes()).map_err(|e| format!("the path cannot be used: {e:?}"))?;
        let prefix = FileName::new(Scope::prefix(&self.tag).as_bytes()).map_err(|e| format!("{e:?}"))?;
        config.global.set_root_path(&root);
        config.global.prefix = prefix;
        config.global.node.cleanup_dead_nodes_on_creation = false;
        config.global.node.cleanup_dead_nodes_on_destruction = false;
        config.global.service.cleanup_dead_nodes_on_open = false;
        Ok(config)
    }
}

pub(super) fn is_tag(text: &str) -> bool {
    text.len() == TAG && text.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'))
}

impl fmt::Display for Scope {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.tag, self.agents, self.root.display())
    }
}

/// Text that is not a [`Scope`].
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error(
    "`{0}` is not a shared-memory scope (`<12 hex digits>:<agents>:<folder>`): pass on what the launcher gave"
)]
pub struct ScopeParseError(String);

impl FromStr for Scope {
    type Err = ScopeParseError;

    fn from_str(text: &str) -> Result<Scope, ScopeParseError> {
        let mut parts = text.splitn(3, ':');
        let mut part = || parts.next().filter(|p| !p.is_empty()).ok_or_else(|| ScopeParseError(text.into()));
        let (tag, agents, root) = (part()?, part()?, part()?);
        let agents = agents.parse().map_err(|_| ScopeParseError(text.into()))?;
        if !is_tag(tag) {
            return Err(ScopeParseError(text.into()));
        }
        Ok(Scope { tag: tag.into(), agents, root: root.into() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scope_survives_the_command_line() {
        let scope = Scope::new("0123456789ab".into(), 7, "/dev/shm/a:b".into());
        assert_eq!(scope.to_string().parse(), Ok(scope));
        for bad in ["", "x", "0123456789ab:7", "0123456789ab::r", "0123456789ag:7:r", "0123456789ab:70000:r"]
        {
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

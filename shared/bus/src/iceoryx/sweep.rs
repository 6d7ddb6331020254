//! Claiming the memory of a run, and leaving nothing of it behind.
//!
//! The owner of a run holds a lock on one file for as long as it lives; the kernel drops the lock however
//! it ends. So a left-over run is one whose file can be locked, in whatever namespace its owner lived, and
//! no process number has to be trusted.

use std::collections::BTreeSet;
use std::collections::hash_map::RandomState;
use std::fs::{self, DirBuilder, File, OpenOptions, TryLockError};
use std::hash::BuildHasher;
use std::io::{self, ErrorKind, Read, Write};
use std::os::unix::fs::{DirBuilderExt, MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use thiserror::Error;

use super::OpenError;
use super::layout::Layout;
use super::scope::{SHARED_MEMORY, Scope};

/// The longest path of a folder in which the transport's sockets still have room (a socket's path has 108
/// bytes in Linux).
const MAX_ROOT: usize = 42;

/// Names that are tried in one folder.
const TRIES: usize = 8;

/// A process takes microseconds from the name of a file to its size, but on a busy host it may have to wait for its
/// turn between the two: taking the file from a living maker would cut it off from all others for good.
const HALF_MADE: Duration = Duration::from_secs(2);
const LOOK_AGAIN: Duration = Duration::from_millis(5);

/// Something of a run could not be removed.
#[derive(Debug, Error)]
#[error("cannot remove {path} of an ended run ({reason}): remove it by hand, or as its owner")]
pub struct SweepError {
    /// What is left.
    pub path: PathBuf,
    /// What the system said.
    pub reason: String,
}

/// The right to a run's memory: while it is held, no other process takes it for left over.
#[derive(Debug)]
pub(crate) struct Claim {
    pub(crate) scope: Scope,
    _lock: File,
}

impl Claim {
    /// Makes a folder for something else than shared memory, found and swept the same way.
    #[cfg(feature = "zenoh")]
    pub(crate) fn bare() -> Result<Claim, OpenError> {
        Claim::new(Layout { agents: 0, per_seat: 1 })
    }

    /// Makes a new scope for a run of this shape, with its folder.
    pub(super) fn new(layout: Layout) -> Result<Claim, OpenError> {
        let mut tried = Vec::new();
        let mut reason = String::from("no such folder");
        for base in bases() {
            // A sweeper may look at the new file before it is locked, and take it: then another name.
            for _ in 0..TRIES {
                match Claim::in_base(&base, layout) {
                    Ok(claim) => return Ok(claim),
                    Err(error) => reason = error.to_string(),
                }
            }
            tried.push(base);
        }
        Err(OpenError::NoRoot { tried, reason })
    }

    fn in_base(base: &Path, layout: Layout) -> io::Result<Claim> {
        let tag = fresh_tag();
        let root = Scope::root_in(base, &tag);
        if root.as_os_str().len() > MAX_ROOT {
            return Err(io::Error::new(ErrorKind::InvalidFilename, "the path is too long for sockets"));
        }
        let mut options = OpenOptions::new();
        let mut file = options.write(true).create_new(true).mode(0o600).open(Scope::owner_file(&tag))?;
        file.try_lock()?;
        let scope = Scope::new(tag, layout, root);
        let claim = Claim { scope, _lock: file.try_clone()? };
        writeln!(file, "{}\n{}", claim.scope.root().display(), std::process::id())?;
        let made = DirBuilder::new().mode(0o700).create(claim.scope.root());
        if made.is_err() {
            let _ = fs::remove_file(Scope::owner_file(claim.scope.tag()));
        }
        made.map(|()| claim)
    }
}

/// Whether the owner of the run lives. Joining one that has ended would leave files that nobody removes.
pub(super) fn is_owned(scope: &Scope) -> bool {
    let file = File::open(Scope::owner_file(scope.tag()));
    file.is_ok_and(|f| matches!(f.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

/// Folders that may hold a run, the best first: memory that the kernel forgets when the host restarts.
fn bases() -> Vec<PathBuf> {
    let runtime = std::env::var_os("XDG_RUNTIME_DIR").map(PathBuf::from);
    let runtime = runtime.filter(|p| p.is_absolute());
    [Some(PathBuf::from(SHARED_MEMORY)), runtime, Some(std::env::temp_dir())].into_iter().flatten().collect()
}

/// Twelve hexadecimal digits. `create_new` makes them unique; chance only keeps tries few.
fn fresh_tag() -> String {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_nanos());
    let hash = RandomState::new().hash_one((now, std::process::id()));
    format!("{:012x}", hash & 0xffff_ffff_ffff)
}

/// Removes everything of a run. Its processes must have ended. Done twice, it does nothing.
pub fn sweep(scope: &Scope) -> Result<(), SweepError> {
    sweep_tag(scope.tag(), &[scope.root().to_owned()])
}

fn sweep_tag(tag: &str, roots: &[PathBuf]) -> Result<(), SweepError> {
    let owner = Scope::owner_file(tag);
    roots.iter().try_for_each(|root| remove(root))?;
    let ours = shared_memory().into_iter().filter(|(t, path)| t == tag && *path != owner);
    ours.into_iter().try_for_each(|(_, path)| remove(&path))?;
    remove(&owner)
}

/// What is still there of a run, to check that a sweep has left nothing.
pub fn left_over(scope: &Scope) -> Vec<PathBuf> {
    let files = shared_memory().into_iter().filter(|(tag, _)| tag == scope.tag()).map(|(_, path)| path);
    let root = scope.root().exists().then(|| scope.root().to_owned());
    let all: BTreeSet<PathBuf> = files.chain(root).collect();
    all.into_iter().collect()
}

fn remove(path: &Path) -> Result<(), SweepError> {
    let removed = match fs::symlink_metadata(path) {
        Ok(meta) if meta.is_dir() => fs::remove_dir_all(path),
        Ok(_) => fs::remove_file(path),
        Err(error) => Err(error),
    };
    match removed {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(SweepError { path: path.into(), reason: error.to_string() })
        }
        _ => Ok(()),
    }
}

/// All that is in shared memory and carries the tag of a run, with it.
fn shared_memory() -> Vec<(String, PathBuf)> {
    let entries = fs::read_dir(SHARED_MEMORY).into_iter().flatten().flatten();
    let tagged = entries.filter_map(|entry| {
        let name = entry.file_name();
        Some((Scope::tag_of(name.to_str()?)?.to_owned(), entry.path()))
    });
    tagged.collect()
}

/// Removes shared memory that a process has named but not given a size, if that lasts: its maker was killed
/// between the two. iceoryx2 0.10.0 waits for such a file without end wherever it opens one
/// (`dynamic_storage/posix_shared_memory.rs`, `MappingSizeIsZero`); once it is gone the wait ends too.
pub(super) fn remove_half_made(tag: &str) {
    let empty = || -> BTreeSet<(PathBuf, u64)> {
        let ours = shared_memory().into_iter().filter(|(t, _)| t == tag);
        let files = ours.filter_map(|(_, path)| Some((fs::metadata(&path).ok()?, path)));
        files.filter(|(meta, _)| meta.is_file() && meta.len() == 0).map(|(m, path)| (path, m.ino())).collect()
    };
    let mut lasting = empty();
    let end = Instant::now() + HALF_MADE;
    while !lasting.is_empty() && Instant::now() < end {
        std::thread::sleep(LOOK_AGAIN);
        let now = empty();
        lasting.retain(|file| now.contains(file));
    }
    for (path, _) in lasting {
        tracing::debug!("removing {}: its maker has died", path.display());
        let _ = fs::remove_file(path);
    }
}

/// Removes all runs on this host whose owner has died, and gives their tags. Runs of other users, which
/// it may not remove, are left alone.
pub fn sweep_stale() -> Result<Vec<String>, SweepError> {
    let tags: BTreeSet<String> = shared_memory().into_iter().map(|(tag, _)| tag).collect();
    let mut swept = Vec::new();
    for tag in tags {
        if sweep_if_stale(&tag)? {
            swept.push(tag);
        }
    }
    Ok(swept)
}

fn sweep_if_stale(tag: &str) -> Result<bool, SweepError> {
    let mut file = match File::open(Scope::owner_file(tag)) {
        Ok(file) => file,
        // The owner's file is made first and removed last: without it nobody owns the rest.
        Err(error) if error.kind() == ErrorKind::NotFound => {
            let roots: Vec<_> = bases().iter().map(|base| Scope::root_in(base, tag)).collect();
            return sweep_tag(tag, &roots).map(|()| true);
        }
        Err(_) => return Ok(false),
    };
    match file.try_lock() {
        Ok(()) => {}
        Err(TryLockError::WouldBlock | TryLockError::Error(_)) => return Ok(false),
    }
    let mut text = String::new();
    let _ = file.read_to_string(&mut text);
    // The file is only believed about a folder that carries the tag.
    let expected = Scope::prefix(tag) + "root";
    let root = text.lines().next().map(PathBuf::from);
    let root = root.filter(|r| r.file_name().is_some_and(|n| n == expected.as_str()));
    sweep_tag(tag, root.as_slice()).map(|()| true)
}

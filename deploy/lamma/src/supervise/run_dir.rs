//! The folder of a run: what it was told, what its processes said, what came of it.

use std::collections::hash_map::RandomState;
use std::hash::BuildHasher;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use thiserror::Error;

/// Where runs go when nobody says otherwise, below the current folder.
const DEFAULT: &str = ".lamma/runs";

/// Names that are tried before giving up: two runs in the same second with the same random digits are
/// already unlikely.
const TRIES: usize = 8;

/// The folder of a run cannot be made.
#[derive(Debug, Error)]
#[error("cannot make the run folder {path} ({reason}): choose another with `--run-dir`")]
pub struct RunDirError {
    /// Which.
    pub path: PathBuf,
    /// What the system said.
    pub reason: String,
}

/// The folder of one run, which exists.
#[derive(Clone, Debug)]
pub struct RunDir {
    id: String,
    path: PathBuf,
}

impl RunDir {
    /// Makes the folder: the one `given`, or a new one below the current folder.
    pub fn create(given: Option<&Path>) -> Result<RunDir, RunDirError> {
        let run = match given {
            Some(path) => RunDir { id: fresh_id(), path: path.into() },
            None => RunDir::fresh(Path::new(DEFAULT))?,
        };
        let logs = run.path.join("logs");
        std::fs::create_dir_all(&logs).map_err(|e| error(&logs, &e))?;
        let path = std::path::absolute(&run.path).map_err(|e| error(&run.path, &e))?;
        Ok(RunDir { path, ..run })
    }

    fn fresh(runs: &Path) -> Result<RunDir, RunDirError> {
        std::fs::create_dir_all(runs).map_err(|e| error(runs, &e))?;
        let mut last = error(runs, &"no name is free");
        for _ in 0..TRIES {
            let id = fresh_id();
            let path = runs.join(&id);
            match std::fs::create_dir(&path) {
                Ok(()) => return Ok(RunDir { id, path }),
                Err(e) if e.kind() == ErrorKind::AlreadyExists => last = error(&path, &e),
                Err(e) => return Err(error(&path, &e)),
            }
        }
        Err(last)
    }

    /// When it began (UTC), the launcher's process number, and four random digits.
    pub fn id(&self) -> &str {
        &self.id
    }

    /// The folder, from the root.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// Where the process called `name` of the run in `folder` writes what it has to say.
pub fn log_file(folder: &Path, name: &str) -> PathBuf {
    folder.join("logs").join(format!("{name}.log"))
}

fn error(path: &Path, reason: &dyn std::fmt::Display) -> RunDirError {
    RunDirError { path: path.into(), reason: reason.to_string() }
}

fn fresh_id() -> String {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let random = RandomState::new().hash_one(now) & 0xffff;
    format!("{}-{}-{random:04x}", utc(now.as_secs()), std::process::id())
}

/// `20261122-190507`, from seconds since 1970. The date follows H. Hinnant, "chrono-compatible low-level
/// date algorithms" (2013), `civil_from_days`.
fn utc(seconds: u64) -> String {
    let (days, rest) = (seconds / 86_400 + 719_468, seconds % 86_400);
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted_month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * shifted_month + 2) / 5 + 1;
    let month = if shifted_month < 10 { shifted_month + 3 } else { shifted_month - 9 };
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    let (hour, minute, second) = (rest / 3_600, rest / 60 % 60, rest % 60);
    format!("{year:04}{month:02}{day:02}-{hour:02}{minute:02}{second:02}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_become_dates() {
        for (seconds, date) in [
            (0, "19700101-000000"),
            (951_782_400, "20000229-000000"),
            (1_709_251_199, "20240229-235959"),
            (1_735_689_600, "20250101-000000"),
            (4_107_542_400, "21000301-000000"),
        ] {
            assert_eq!(utc(seconds), date, "{seconds}");
        }
    }

    #[test]
    fn a_given_folder_is_used_and_an_impossible_one_is_named() {
        let path = std::env::temp_dir().join(format!("lamma-test-{}", fresh_id()));
        let run = RunDir::create(Some(&path)).unwrap();
        assert!(log_file(run.path(), "robot-0").parent().unwrap().is_dir());
        let beneath_a_file = path.join("file");
        std::fs::write(&beneath_a_file, "").unwrap();
        let error = RunDir::create(Some(&beneath_a_file)).unwrap_err().to_string();
        assert!(error.contains("--run-dir") && error.contains("file"), "{error}");
        std::fs::remove_dir_all(&path).unwrap();
    }
}

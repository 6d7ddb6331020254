//! Running the command and looking at what it leaves.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

pub const README: &str = "Put the tomato and the lettuce in the fridge, then switch off the light";

/// A folder of its own for a test, removed at the end.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("lamma-e2e-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    pub fn file(&self, name: &str, text: &str) -> String {
        let path = self.0.join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

pub fn lamma(folder: &Folder, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamma"));
    command.args(args).current_dir(&folder.0).stdin(Stdio::null());
    command
}

pub fn output(folder: &Folder, args: &[&str]) -> Output {
    lamma(folder, args).output().unwrap()
}

pub fn run_args<'a>(instruction: &'a str, team: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut args = vec!["run", instruction, "--scene", "FloorPlan6", "--team", team, "--format", "json"];
    args.extend(more);
    args
}

/// The one object on standard output, with the exit code.
pub fn json(output: &Output) -> (i32, Value) {
    let text = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    let value = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e}\n{text}\n{errors}"));
    (output.status.code().unwrap_or(-1), value)
}

/// Starts a run in the background.
pub fn start(folder: &Folder, args: &[&str]) -> Child {
    lamma(folder, args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Waits for the end, at most that long.
pub fn finish(mut child: Child, limit: Duration) -> Output {
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if start.elapsed() > limit {
            let _ = child.kill();
            panic!("the run has not ended within {limit:?}");
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    child.wait_with_output().unwrap()
}

/// Waits until the condition gives something.
pub fn eventually<T>(limit: Duration, what: &str, mut condition: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(value) = condition() {
            return value;
        }
        assert!(start.elapsed() < limit, "{what}: not within {limit:?}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Processes whose command line names the folder, with their command lines.
pub fn processes_of(folder: &Folder) -> Vec<(u32, String)> {
    let name = folder.0.display().to_string();
    let mut found = Vec::new();
    for entry in std::fs::read_dir("/proc").unwrap().flatten() {
        let Some(pid) = entry.file_name().to_str().and_then(|n| n.parse().ok()) else { continue };
        let line = std::fs::read(entry.path().join("cmdline")).unwrap_or_default();
        let line = String::from_utf8_lossy(&line).replace('\0', " ");
        if line.contains(&name) && pid != std::process::id() {
            found.push((pid, line));
        }
    }
    found
}

/// The tags of runs that have something in shared memory.
pub fn tag_of(folder: &Folder) -> Option<String> {
    processes_of(folder).into_iter().find_map(|(_, line)| {
        let scope = line.split("--scope ").nth(1)?;
        Some(scope.split(':').next()?.to_string())
    })
}

/// Files in shared memory of the run with that tag.
pub fn shared_memory_of(tag: &str) -> Vec<PathBuf> {
    let files = std::fs::read_dir("/dev/shm").into_iter().flatten().flatten();
    files.map(|f| f.path()).filter(|f| f.display().to_string().contains(tag)).collect()
}

/// Whether the folder of the run says which robot of the team has that process.
pub fn pid_of(folder: &Folder, role: &str, agent: Option<u16>) -> Option<u32> {
    processes_of(folder).into_iter().find_map(|(pid, line)| {
        let mine = line.contains(&format!(" {role} --run-dir"))
            && agent.is_none_or(|a| line.trim_end().ends_with(&format!("--agent {a}")));
        mine.then_some(pid)
    })
}

pub fn signal(pid: u32, name: &str) {
    let status = Command::new("kill").args([&format!("-{name}"), &pid.to_string()]).status().unwrap();
    assert!(status.success(), "kill -{name} {pid}");
}

pub fn workspace_data() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = std::env::var_os("LAMMA_SHARED").map_or_else(|| root.join("../shared/data"), PathBuf::from);
    folder.is_dir().then_some(folder)
}

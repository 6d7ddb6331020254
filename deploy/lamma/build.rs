//! How the binary is linked.

use std::env;
use std::path::PathBuf;
use std::process::Command;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let is = |key: &str, value: &str| env::var(key).is_ok_and(|given| given == value);
    if !is("CARGO_CFG_TARGET_OS", "linux") {
        return;
    }
    // A position-independent executable of this size has 47,000 addresses to correct at each start, all over its
    // data: nearly a millisecond, and a planner's whole call takes two.
    println!("cargo:rustc-link-arg-bin=lamma=-no-pie");
    // As a library to load, the unwinder takes a tenth of a millisecond of each start.
    if is("CARGO_CFG_TARGET_ENV", "gnu")
        && env::var_os("TARGET") == env::var_os("HOST")
        && let Some(folder) = unwinder()
    {
        println!("cargo:rustc-link-search=native={}", folder.display());
        println!("cargo:rustc-link-lib=static=gcc_eh");
    }
}

/// Where the C compiler has the unwinder as an archive. Without it, or with a linker that passes over archives named
/// before they are needed, it is loaded as a library, as usual.
fn unwinder() -> Option<PathBuf> {
    let answer = Command::new("cc").arg("-print-file-name=libgcc_eh.a").output().ok()?;
    let path = PathBuf::from(String::from_utf8(answer.stdout).ok()?.trim());
    // A compiler that does not have it repeats the bare name.
    (path.is_absolute() && path.is_file()).then(|| path.parent().map(PathBuf::from))?
}

//! What the processes of a run need from the operating system: a child must never outlive its parent,
//! inherit nothing by accident, and have descriptors enough.
#![expect(
    unsafe_code,
    reason = "between fork and exec, for close_range and for a thread's clock, only the C interface can be used"
)]

use std::io::{self, Read};
use std::os::unix::process::CommandExt;
use std::process::Command;
use std::time::Duration;

use rustix::io::Errno;
use rustix::process::{Pid, Resource, Rlimit, Signal};

/// How a process ends when what it belongs to is gone.
const ORPHANED: i32 = 30;

/// Prepares `command` to start a member of a run: in a process group of its own (a Ctrl-C at the terminal
/// reaches only the launcher, which ends the others in order), killed by the kernel when the *thread* that
/// spawns it ends, and without any descriptor of the parent beyond the standard three.
pub fn tie_to_parent(command: &mut Command) -> &mut Command {
    let parent = Pid::from_raw(std::process::id().cast_signed());
    command.process_group(0);
    // SAFETY: runs in the child between fork and exec, where only async-signal-safe functions may be
    // called and nothing may be allocated: it makes three system calls and builds errors from numbers.
    unsafe {
        command.pre_exec(move || {
            rustix::process::set_parent_process_death_signal(Some(Signal::KILL))?;
            // The parent may have died before the line above.
            if rustix::process::getppid() != parent {
                return Err(Errno::SRCH.into());
            }
            // The transport's files are not close-on-exec. An old kernel without this call costs
            // descriptors, not correctness.
            libc::syscall(libc::SYS_close_range, 3u32, u32::MAX, libc::CLOSE_RANGE_CLOEXEC);
            Ok(())
        })
    }
}

/// As [`tie_to_parent`], for a program that calls [`tie_self_to_parent`] itself. Without code between fork and exec
/// the system need not copy this process's map of memory for each child, which in the owner of a large run costs
/// more than all the rest of a start.
pub fn tie_own_program(command: &mut Command) -> &mut Command {
    // The transport's files are not close-on-exec; see above. SAFETY: a system call without pointers that changes
    // what happens to descriptors at an exec, and nothing in this process.
    unsafe { libc::syscall(libc::SYS_close_range, 3u32, u32::MAX, libc::CLOSE_RANGE_CLOEXEC) };
    command.process_group(0)
}

/// Has the kernel kill this process when the thread that spawned it ends. Between the spawn and this call, and where
/// the kernel's signal has no effect, [`exit_when_stdin_closes`] takes its place.
pub fn tie_self_to_parent() -> io::Result<()> {
    Ok(rustix::process::set_parent_process_death_signal(Some(Signal::KILL))?)
}

/// Processor time that the calling thread has used, for benchmarks.
pub fn thread_time() -> Duration {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the pointer is of a value that outlives the call. The call cannot fail: the clock is there.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &raw mut time) };
    Duration::new(time.tv_sec.cast_unsigned(), u32::try_from(time.tv_nsec).unwrap_or(0))
}

/// Ends this process when its standard input closes: the launcher holds the other end, so this is the
/// second line of defence after [`tie_to_parent`], for where that has no effect.
pub fn exit_when_stdin_closes() -> io::Result<()> {
    let watch = || {
        let mut stdin = io::stdin().lock();
        let mut byte = [0];
        loop {
            match stdin.read(&mut byte) {
                Ok(1..) => {}
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Ok(0) | Err(_) => {
                    tracing::error!("the launcher has gone: this process ends");
                    std::process::exit(ORPHANED);
                }
            }
        }
    };
    std::thread::Builder::new().name("orphan-watch".into()).spawn(watch).map(|_| ())
}

/// Raises the limit on open files as far as this user may, and gives it. Children inherit it.
pub fn raise_open_files_limit() -> io::Result<u64> {
    let limit = rustix::process::getrlimit(Resource::Nofile);
    rustix::process::setrlimit(Resource::Nofile, Rlimit { current: limit.maximum, maximum: limit.maximum })?;
    Ok(open_files_limit())
}

/// How many files this process may have open.
pub fn open_files_limit() -> u64 {
    rustix::process::getrlimit(Resource::Nofile).current.unwrap_or(u64::MAX)
}

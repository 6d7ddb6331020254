//! Many pieces of work, some at once, with a bar that shows how far they are.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use indicatif::{ProgressBar, ProgressStyle};

use crate::supervise::Interrupts;

/// What came of a batch.
pub struct Batch<T> {
    /// Which pieces were done, in their order, and what came of each.
    pub done: Vec<(usize, T)>,
    /// Whether the user has ended it before all were.
    pub interrupted: bool,
}

/// Does all of `names`, at most `jobs` at once; prints a line for each when it is done. Ctrl-C ends the pieces
/// under way, which do not count, and no other is begun.
pub fn each<T: Send>(
    names: &[String],
    jobs: usize,
    work: impl Fn(usize) -> T + Sync,
    line: impl Fn(usize, &T) -> String + Sync,
) -> Batch<T> {
    let interrupted = Arc::new(AtomicBool::new(false));
    let _interrupts = Interrupts::noted_in(&interrupted);
    let bar = progress(names.len() as u64);
    let next = Mutex::new(0usize);
    let done: Mutex<Vec<(usize, T)>> = Mutex::new(Vec::new());
    let worker = || {
        while !interrupted.load(Ordering::Acquire) {
            let index = {
                let mut next = next.lock().unwrap_or_else(|e| e.into_inner());
                let index = *next;
                *next += 1;
                index
            };
            let Some(name) = names.get(index) else { return };
            bar.set_message(name.clone());
            let finished = work(index);
            if interrupted.load(Ordering::Acquire) {
                return;
            }
            // A bar that nobody sees prints nothing either.
            match bar.is_hidden() {
                true => eprintln!("{}", line(index, &finished)),
                false => bar.println(line(index, &finished)),
            }
            bar.inc(1);
            done.lock().unwrap_or_else(|e| e.into_inner()).push((index, finished));
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..jobs.clamp(1, 64) {
            scope.spawn(worker);
        }
    });
    bar.finish_and_clear();
    let mut done = done.into_inner().unwrap_or_else(|e| e.into_inner());
    done.sort_by_key(|(index, _)| *index);
    let interrupted = interrupted.load(Ordering::Acquire);
    if interrupted {
        eprintln!("interrupted: {} of {} were done", done.len(), names.len());
    }
    Batch { done, interrupted }
}

fn progress(total: u64) -> ProgressBar {
    let bar = ProgressBar::new(total);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} {elapsed} {msg}") {
        bar.set_style(style);
    }
    bar
}

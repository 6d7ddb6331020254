//! Many pieces of work, some at once, with a bar that shows how far they are.

use std::sync::Mutex;

use indicatif::{ProgressBar, ProgressStyle};

/// Does all of `names`, at most `jobs` at once; prints a line for each when it is done. The results are in the
/// order of the names.
pub fn each<T: Send>(
    names: &[String],
    jobs: usize,
    work: impl Fn(usize) -> T + Sync,
    line: impl Fn(usize, &T) -> String + Sync,
) -> Vec<T> {
    let bar = progress(names.len() as u64);
    let next = Mutex::new(0usize);
    let done: Mutex<Vec<(usize, T)>> = Mutex::new(Vec::new());
    let worker = || {
        loop {
            let index = {
                let mut next = next.lock().unwrap_or_else(|e| e.into_inner());
                let index = *next;
                *next += 1;
                index
            };
            let Some(name) = names.get(index) else { return };
            bar.set_message(name.clone());
            let finished = work(index);
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
    done.into_iter().map(|(_, finished)| finished).collect()
}

fn progress(total: u64) -> ProgressBar {
    let bar = ProgressBar::new(total);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} {elapsed} {msg}") {
        bar.set_style(style);
    }
    bar
}

//! Processor time of this process and of the children it has waited for.

/// Clock ticks of `/proc` in a second: fixed by the kernel's interface (`USER_HZ`).
const TICKS: f64 = 100.0;

/// Seconds so far; `None` where the system does not tell.
pub fn used() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The name of the process stands in parentheses and may hold anything.
    let (_, rest) = stat.rsplit_once(')')?;
    // utime, stime, cutime and cstime are the fields 14 to 17; the rest begins with field 3.
    let ticks: Vec<f64> = rest.split_whitespace().skip(11).take(4).filter_map(|t| t.parse().ok()).collect();
    (ticks.len() == 4).then(|| ticks.iter().sum::<f64>() / TICKS)
}

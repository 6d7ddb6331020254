//! The figures of a scale run as a picture.

use lamma_plot::{Chart, Series};

use super::Level;

/// The plot of these levels as SVG.
pub fn svg(levels: &[Level]) -> String {
    let of = |y: fn(&Level) -> f64| levels.iter().map(|l| (f64::from(l.agents), y(l))).collect();
    let series = |name, colour, y: fn(&Level) -> f64| Series { name, colour, points: of(y) };
    let chart = |title, series| Chart { title, over: "robots", series };
    lamma_plot::svg(&[
        chart(
            "from meeting to meeting, µs",
            vec![
                series("p50", "#1f77b4", |l| l.barrier_us.p50),
                series("p99", "#9ec5e8", |l| l.barrier_us.p99),
            ],
        ),
        chart(
            "time, s",
            vec![series("all ready", "#2ca02c", |l| l.start_s), series("in all", "#98df8a", |l| l.total_s)],
        ),
        chart("private memory of a robot, KiB", vec![series("median", "#d62728", |l| l.private_kib.p50)]),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scale::Spread;

    fn level(agents: u16) -> Level {
        let spread = |v: f64| Spread { p50: v, p99: 2.0 * v, max: 3.0 * v };
        let n = f64::from(agents);
        Level {
            agents,
            processes: agents.into(),
            start_s: n / 100.0,
            plan_s: 0.1,
            act_s: 0.1,
            private_kib: spread(900.0),
            barrier_us: spread(5.0 * n),
            barriers: 20,
            actions: 100,
            actions_per_s: 1000.0,
            total_s: n / 50.0,
            cpu_s: 1.0,
            processes_left: 0,
            files_left: 0,
        }
    }

    #[test]
    fn every_level_is_a_point_of_every_line() {
        let text = svg(&[level(2), level(64), level(1000)]);
        assert_eq!(text.matches("<circle").count(), 5 * 3, "five lines of three points");
    }
}

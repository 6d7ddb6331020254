//! The figures of a scale run as a picture: three charts side by side, both axes logarithmic, so that what
//! grows linearly is a straight line of slope one.

use std::fmt::Write;

use super::Level;

const WIDTH: f64 = 320.0;
const HEIGHT: f64 = 260.0;
/// Around a chart: room for the labels.
const MARGIN: f64 = 56.0;

/// A line in a chart.
struct Series<'a> {
    name: &'a str,
    colour: &'a str,
    points: Vec<(f64, f64)>,
}

/// The plot of these levels as SVG.
pub fn svg(levels: &[Level]) -> String {
    let of = |y: fn(&Level) -> f64| levels.iter().map(|l| (f64::from(l.agents), y(l))).collect();
    let series = |name, colour, y: fn(&Level) -> f64| Series { name, colour, points: of(y) };
    let charts = [
        (
            "from meeting to meeting, µs",
            vec![
                series("p50", "#1f77b4", |l| l.barrier_us.p50),
                series("p99", "#9ec5e8", |l| l.barrier_us.p99),
            ],
        ),
        (
            "time, s",
            vec![series("all ready", "#2ca02c", |l| l.start_s), series("in all", "#98df8a", |l| l.total_s)],
        ),
        ("private memory of a robot, KiB", vec![series("median", "#d62728", |l| l.private_kib.p50)]),
    ];
    let (width, height) = (charts.len() as f64 * (WIDTH + MARGIN) + MARGIN, HEIGHT + 2.0 * MARGIN);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    for (i, (title, series)) in charts.iter().enumerate() {
        let left = MARGIN + i as f64 * (WIDTH + MARGIN);
        // Writing to a string does not fail.
        let _ = writeln!(out, "<g transform=\"translate({left},{MARGIN})\">{}</g>", chart(title, series));
    }
    out + "</svg>\n"
}

/// The powers of ten that enclose the figures.
fn decades(figures: impl Iterator<Item = f64>) -> (i32, i32) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for figure in figures.filter(|f| *f > 0.0) {
        (low, high) = (low.min(figure), high.max(figure));
    }
    if low > high {
        return (0, 1);
    }
    let (low, high) = (low.log10().floor() as i32, high.log10().ceil() as i32);
    (low, high.max(low + 1))
}

fn chart(title: &str, series: &[Series<'_>]) -> String {
    let points = || series.iter().flat_map(|s| s.points.iter());
    let (xs, ys) = (decades(points().map(|p| p.0)), decades(points().map(|p| p.1)));
    let scale = |v: f64, (low, high): (i32, i32), size: f64| {
        (v.max(f64::MIN_POSITIVE).log10() - f64::from(low)) / f64::from(high - low) * size
    };
    let x = |v: f64| scale(v, xs, WIDTH);
    let y = |v: f64| HEIGHT - scale(v, ys, HEIGHT).clamp(0.0, HEIGHT);
    let mut out = format!(
        "<text x=\"0\" y=\"-18\" font-size=\"13\">{title}</text>\
         <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"none\" stroke=\"#888\"/>"
    );
    for decade in xs.0..=xs.1 {
        let at = x(10f64.powi(decade));
        let _ = write!(
            out,
            "<line x1=\"{at:.1}\" x2=\"{at:.1}\" y1=\"0\" y2=\"{HEIGHT}\" stroke=\"#ddd\"/>\
             <text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            HEIGHT + 16.0,
            10f64.powi(decade)
        );
    }
    for decade in ys.0..=ys.1 {
        let at = y(10f64.powi(decade));
        let _ = write!(
            out,
            "<line x1=\"0\" x2=\"{WIDTH}\" y1=\"{at:.1}\" y2=\"{at:.1}\" stroke=\"#ddd\"/>\
             <text x=\"-6\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            at + 4.0,
            10f64.powi(decade)
        );
    }
    let _ = write!(out, "<text x=\"{:.1}\" y=\"{:.1}\">robots</text>", WIDTH / 2.0, HEIGHT + 34.0);
    for (i, series) in series.iter().enumerate() {
        let path: Vec<String> =
            series.points.iter().map(|(px, py)| format!("{:.1},{:.1}", x(*px), y(*py))).collect();
        let colour = series.colour;
        let _ = write!(
            out,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>",
            path.join(" ")
        );
        for (px, py) in &series.points {
            let _ =
                write!(out, "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"3\" fill=\"{colour}\"/>", x(*px), y(*py));
        }
        let _ = write!(
            out,
            "<text x=\"8\" y=\"{:.1}\" fill=\"{colour}\">{}</text>",
            16.0 + 14.0 * i as f64,
            series.name
        );
    }
    out
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
    fn every_level_is_a_point_inside_the_frame() {
        let text = svg(&[level(2), level(64), level(1000)]);
        assert_eq!(text.matches("<circle").count(), 5 * 3, "five lines of three points");
        let inside = |key: &str, size: f64| {
            let mut values = text.split(key).skip(1).filter_map(|t| t.split('"').next()?.parse::<f64>().ok());
            values.all(|v| (-0.1..=size + 0.1).contains(&v))
        };
        assert!(inside("cx=\"", WIDTH) && inside("cy=\"", HEIGHT), "{text}");
        assert_eq!(text.matches("<g ").count(), text.matches("</g>").count());
    }

    #[test]
    fn no_levels_and_zeros_are_no_trouble() {
        assert!(svg(&[]).ends_with("</svg>\n"));
        let zero = Level { start_s: 0.0, total_s: 0.0, ..level(1) };
        assert!(!svg(&[zero]).contains("NaN"));
    }
}

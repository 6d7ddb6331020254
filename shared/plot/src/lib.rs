//! Figures of a measurement as a picture: charts side by side, both axes logarithmic, so that what grows linearly
//! is a straight line of slope one.

use std::fmt::Write;

const WIDTH: f64 = 320.0;
const HEIGHT: f64 = 260.0;
/// Around a chart: room for the labels.
const MARGIN: f64 = 56.0;

/// Lines over one pair of axes.
pub struct Chart<'a> {
    /// Above it: what the lines show, with the unit.
    pub title: &'a str,
    /// Below it: what they are drawn over.
    pub over: &'a str,
    /// The lines.
    pub series: Vec<Series<'a>>,
}

/// A line in a chart.
pub struct Series<'a> {
    /// What it is called in the legend.
    pub name: &'a str,
    /// As SVG writes it.
    pub colour: &'a str,
    /// Where it goes.
    pub points: Vec<(f64, f64)>,
}

/// The charts as SVG.
pub fn svg(charts: &[Chart<'_>]) -> String {
    let (width, height) = (charts.len() as f64 * (WIDTH + MARGIN) + MARGIN, HEIGHT + 2.0 * MARGIN);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    for (i, of) in charts.iter().enumerate() {
        let left = MARGIN + i as f64 * (WIDTH + MARGIN);
        // Writing to a string does not fail.
        let _ = writeln!(out, "<g transform=\"translate({left},{MARGIN})\">{}</g>", chart(of));
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

fn chart(Chart { title, over, series }: &Chart<'_>) -> String {
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
    let _ = write!(out, "<text x=\"{:.1}\" y=\"{:.1}\">{over}</text>", WIDTH / 2.0, HEIGHT + 34.0);
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

    fn line(points: Vec<(f64, f64)>) -> Series<'static> {
        Series { name: "p50", colour: "#1f77b4", points }
    }

    #[test]
    fn every_figure_is_a_point_inside_the_frame() {
        let points = vec![(2.0, 0.3), (64.0, 7.0), (1000.0, 9000.0)];
        let charts = ["time, s", "memory, KiB"].map(|title| Chart {
            title,
            over: "robots",
            series: vec![line(points.clone()), line(points.clone())],
        });
        let text = svg(&charts);
        assert_eq!(text.matches("<circle").count(), 2 * 2 * 3);
        let inside = |key: &str, size: f64| {
            let mut values = text.split(key).skip(1).filter_map(|t| t.split('"').next()?.parse::<f64>().ok());
            values.all(|v| (-0.1..=size + 0.1).contains(&v))
        };
        assert!(inside("cx=\"", WIDTH) && inside("cy=\"", HEIGHT), "{text}");
        assert_eq!(text.matches("<g ").count(), text.matches("</g>").count());
    }

    #[test]
    fn no_figures_and_zeros_are_no_trouble() {
        assert!(svg(&[]).ends_with("</svg>\n"));
        let zero = Chart { title: "t", over: "n", series: vec![line(vec![(1.0, 0.0)]), line(Vec::new())] };
        assert!(!svg(&[zero]).contains("NaN"));
    }
}

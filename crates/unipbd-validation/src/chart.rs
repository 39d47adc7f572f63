//! Error against cost as SVG, log-log, without dependencies.

use std::fmt::Write;

/// A point of a curve.
#[derive(Clone, Debug)]
pub struct Point {
    /// Cost.
    pub x: f64,
    /// Error.
    pub y: f64,
    /// Whether it is judged; otherwise it is only drawn.
    pub counts: bool,
    /// Whether nothing else that counts is both cheaper and better.
    pub best: bool,
}

/// A curve with its name.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Name of the quantity shown.
    pub name: String,
    /// Its points, in order.
    pub points: Vec<Point>,
}

const SIZE: (f64, f64) = (800.0, 480.0);
const LEFT: f64 = 70.0;
const RIGHT: f64 = 260.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 50.0;
const COLORS: [&str; 15] = [
    "#000000", "#1f77b4", "#ff7f0e", "#2ca02c", "#d62728", "#9467bd", "#8c564b", "#e377c2", "#ffbb00", "#bcbd22",
    "#17becf", "#7f7f7f", "#c5b0d5", "#aec7e8", "#0a7d55",
];

/// Draws curves on two logarithmic axes; points on the front of all are filled.
pub fn log_log(title: &str, x_label: &str, y_label: &str, curves: &[Curve]) -> String {
    let good = |point: &&Point| point.x > 0.0 && point.y > 0.0 && point.x.is_finite() && point.y.is_finite();
    let all: Vec<&Point> = curves.iter().flat_map(|curve| &curve.points).filter(good).collect();
    let (x0, x1) = decades(all.iter().map(|point| point.x));
    let (y0, y1) = decades(all.iter().map(|point| point.y));
    let x = |value: f64| LEFT + (value.log10() - x0) / (x1 - x0) * (SIZE.0 - LEFT - RIGHT);
    let y = |value: f64| SIZE.1 - BOTTOM - (value.log10() - y0) / (y1 - y0) * (SIZE.1 - TOP - BOTTOM);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n<text x=\"{LEFT}\" y=\"24\" font-size=\"16\">{title}</text>\n",
        SIZE.0, SIZE.1
    );
    for decade in (x0 as i32)..=(x1 as i32) {
        let at = x(10f64.powi(decade));
        line(&mut svg, (at, TOP), (at, SIZE.1 - BOTTOM), "#ddd");
        text(&mut svg, (at, SIZE.1 - BOTTOM + 16.0), "middle", &format!("1e{decade}"));
    }
    for decade in (y0 as i32)..=(y1 as i32) {
        let at = y(10f64.powi(decade));
        line(&mut svg, (LEFT, at), (SIZE.0 - RIGHT, at), "#ddd");
        text(&mut svg, (LEFT - 6.0, at + 4.0), "end", &format!("1e{decade}"));
    }
    text(&mut svg, (0.5 * (LEFT + SIZE.0 - RIGHT), SIZE.1 - 12.0), "middle", x_label);
    text(&mut svg, (LEFT, TOP - 4.0), "start", y_label);
    for (index, curve) in curves.iter().enumerate() {
        let color = COLORS[index % COLORS.len()];
        let path: Vec<String> =
            curve.points.iter().filter(good).map(|p| format!("{:.1},{:.1}", x(p.x), y(p.y))).collect();
        let _ = writeln!(svg, "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\"/>", path.join(" "));
        for point in curve.points.iter().filter(good) {
            let fill = if point.best { color } else { "white" };
            let (cx, cy) = (x(point.x), y(point.y));
            let _ = writeln!(svg, "<circle cx=\"{cx:.1}\" cy=\"{cy:.1}\" r=\"4\" fill=\"{fill}\" stroke=\"{color}\"/>");
        }
        let at = TOP + 18.0 * index as f64 + 8.0;
        line(&mut svg, (SIZE.0 - RIGHT + 12.0, at), (SIZE.0 - RIGHT + 32.0, at), color);
        text(&mut svg, (SIZE.0 - RIGHT + 38.0, at + 4.0), "start", &curve.name);
    }
    svg.push_str("</svg>\n");
    svg
}

/// The powers of ten around some values.
fn decades(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(low, high), value| (low.min(value), high.max(value)));
    if low > high {
        return (0.0, 1.0);
    }
    let (low, high) = (low.log10().floor(), high.log10().ceil());
    (low, high.max(low + 1.0))
}

fn line(svg: &mut String, from: (f64, f64), to: (f64, f64), color: &str) {
    let _ = writeln!(
        svg,
        "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"{color}\"/>",
        from.0, from.1, to.0, to.1
    );
}

fn text(svg: &mut String, at: (f64, f64), anchor: &str, text: &str) {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    let _ = writeln!(svg, "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{text}</text>", at.0, at.1);
}

/// Marks the points that no other point beats: by more than this part, the scatter of the measurement, in cost or in
/// error, while it is no worse in the other.
pub fn mark_front(curves: &mut [Curve], scatter: f64) {
    let counted = curves.iter().flat_map(|curve| &curve.points).filter(|point| point.counts);
    let all: Vec<(f64, f64)> = counted.map(|point| (point.x, point.y)).collect();
    let beaten = |p: &Point| {
        let (cheap, exact) = (p.x * (1.0 - scatter), p.y * (1.0 - scatter));
        all.iter().any(|&(x, y)| x <= p.x && y <= p.y && (x < cheap || y < exact))
    };
    for point in curves.iter_mut().flat_map(|curve| &mut curve.points) {
        point.best = point.counts && point.y.is_finite() && !beaten(point);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_holds_what_nothing_beats_in_both() {
        let point = |x, y| Point { x, y, counts: true, best: false };
        let mut curves = vec![
            Curve { name: "a".into(), points: vec![point(1.0, 4.0), point(2.0, 2.0)] },
            Curve { name: "b".into(), points: vec![point(2.0, 3.0), point(4.0, 1.0), point(5.0, f64::NAN)] },
        ];
        mark_front(&mut curves, 0.0);
        let best = |curve: &Curve| curve.points.iter().map(|p| p.best).collect::<Vec<_>>();
        assert_eq!(best(&curves[0]), [true, true]);
        assert_eq!(best(&curves[1]), [false, true, false]);
        assert!(log_log("t", "x", "y", &curves).contains("<polyline"));
    }

    #[test]
    fn points_within_the_scatter_of_the_front_count_as_on_it() {
        let point = |x, y| Point { x, y, counts: true, best: false };
        let mut curves =
            [Curve { name: "a".into(), points: vec![point(1.0, 1.0), point(1.05, 1.05), point(1.2, 1.05)] }];
        mark_front(&mut curves, 0.1);
        assert_eq!(curves[0].points.iter().map(|p| p.best).collect::<Vec<_>>(), [true, true, false]);
    }

    #[test]
    fn points_that_do_not_count_beat_nobody() {
        let point = |x, counts| Point { x, y: 1.0, counts, best: false };
        let mut curves =
            [Curve { name: "a".into(), points: vec![point(1.0, false), point(2.0, true), point(3.0, true)] }];
        mark_front(&mut curves, 0.1);
        assert_eq!(curves[0].points.iter().map(|p| p.best).collect::<Vec<_>>(), [false, true, false]);
    }

    #[test]
    fn names_are_written_so_that_a_picture_is_well_formed() {
        let curves = [Curve { name: "Macklin & Müller <2013>".into(), points: Vec::new() }];
        let svg = log_log("t", "x", "y", &curves);
        assert!(svg.contains(">Macklin &amp; Müller &lt;2013></text>"), "{svg}");
    }
}

//! Time against error on log axes, as SVG.

use super::html::escaped;
use super::point::Point;
use super::report::Report;

const WIDTH: f64 = 860.0;
const HEIGHT: f64 = 500.0;
/// Left, top, right, bottom.
const MARGIN: [f64; 4] = [78.0, 16.0, 18.0, 52.0];
/// Margin at each end of an axis, decades.
const AIR: f64 = 0.08;

/// A log axis between two places on the page.
struct Axis {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Axis {
    fn of(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Self {
        let (low, high) =
            values.filter(|v| *v > 0.0).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
                (l.min(v.log10()), h.max(v.log10()))
            });
        let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
        // At least half a decade, so that it has ticks.
        let more = AIR.max(0.25 - (high - low) / 2.0);
        Self { low: low - more, high: high + more, from, to }
    }

    /// Position of a value; values below the axis are at its low end.
    fn at(&self, value: f64) -> f64 {
        let log = if value > 0.0 { value.log10() } else { self.low };
        self.from + (self.to - self.from) * ((log - self.low) / (self.high - self.low)).max(0.0)
    }

    /// 1, 2 and 5 in each decade; on a short axis all have labels.
    fn ticks(&self) -> Vec<(f64, bool)> {
        let short = self.high - self.low < 4.0;
        (self.low.floor() as i32..=self.high.ceil() as i32)
            .flat_map(|d| [1.0, 2.0, 5.0].map(|m| (m * 10_f64.powi(d), m == 1.0 || short)))
            .filter(|(v, _)| (self.low..=self.high).contains(&v.log10()))
            .collect()
    }
}

/// A power of ten times 1, 2 or 5, without trailing digits.
fn number(value: f64) -> String {
    let places = (-value.log10().floor()).max(0.0) as usize;
    if places > 6 { format!("{value:.0e}") } else { format!("{value:.places$}") }
}

pub fn svg(report: &Report) -> String {
    let points = &report.walk.points;
    let own = report.ground_truth.floor();
    let [left, top, right, bottom] = MARGIN;
    let x = Axis::of(points.iter().map(|p| report.time_ns(p) * 1e-6), left, WIDTH - right);
    let errors = points.iter().map(|p| 100.0 * report.error(p)).chain([100.0 * own]);
    let y = Axis::of(errors, HEIGHT - bottom, top);
    let mut svg = format!(
        "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"time against error\">\n"
    );
    let (base, edge) = (HEIGHT - bottom, WIDTH - right);
    for (value, shown) in x.ticks() {
        let at = x.at(value);
        svg += &format!("<line class=grid x1={at:.1} x2={at:.1} y1={base} y2={top} />");
        if shown {
            let (text, low) = (number(value), base + 18.0);
            svg += &format!("<text x={at:.1} y={low} text-anchor=middle>{text}</text>\n");
        }
    }
    for (value, shown) in y.ticks() {
        let at = y.at(value);
        svg += &format!("<line class=grid x1={left} x2={edge} y1={at:.1} y2={at:.1} />");
        if shown {
            let (text, x, y) = (number(value), left - 8.0, at + 4.0);
            svg += &format!("<text x={x} y={y:.1} text-anchor=end>{text}</text>\n");
        }
    }
    let (middle, low) = ((left + edge) / 2.0, HEIGHT - 12.0);
    svg += &format!("<text class=name x={middle} y={low} text-anchor=middle>ms per frame</text>\n");
    let half = (top + base) / 2.0;
    svg += &format!(
        "<text class=name transform=\"translate(16 {half}) rotate(-90)\" text-anchor=middle>relative \
         RMSE, %</text>\n"
    );
    if own > 0.0 {
        let (at, low) = (y.at(100.0 * own), y.at(100.0 * own) + 14.0);
        svg += &format!(
            "<line class=own x1={left} x2={edge} y1={at:.1} y2={at:.1} /><text class=small \
                x={edge} y={low:.1} text-anchor=end>the ground truth's own error</text>\n"
        );
    }
    let place = |p: &Point| (x.at(report.time_ns(p) * 1e-6), y.at(100.0 * report.error(p)));
    let front = report.frontier();
    let mut path = String::new();
    for (i, point) in front.iter().enumerate() {
        let (px, py) = place(point);
        // Steps: between two points the faster one's error holds.
        path += &if i == 0 { format!("M{px:.1} {py:.1}") } else { format!("H{px:.1}V{py:.1}") };
    }
    svg += &format!("<path class=front d=\"{path}\" />\n");
    let is_front = |p: &Point| front.iter().any(|f| f.place == p.place);
    let best = report.recommended();
    let baseline = points.iter().find(|p| p.place == report.walk.baseline);
    let mut named = vec![(best, "name", "recommended", -10.0)];
    // The defaults' label goes below its point, which may be next to the recommended one.
    let other = baseline.filter(|b| b.place != best.place);
    named.extend(other.map(|b| (b, "small", "the defaults", 20.0)));
    // Draws the frontier on top.
    let mut order: Vec<&Point> = points.iter().collect();
    order.sort_by_key(|p| is_front(p));
    for point in order {
        let (px, py) = place(point);
        let is_base = point.place == report.walk.baseline;
        let (kind, size) = match (is_front(point), is_base) {
            (true, false) => ("on", 5.5),
            (true, true) => ("on base", 5.5),
            (false, true) => ("off base", 5.0),
            (false, false) => ("off", 4.0),
        };
        let (time, error) = (report.time_text(point), report.error_text(point));
        let label = escaped(&format!("{}: {time}, {error}", report.flags(point.place)));
        if point.place == best.place {
            svg += &format!("<circle class=ring cx={px:.1} cy={py:.1} r=11 />");
        }
        svg += &format!(
            "<circle class=\"point {kind}\" cx={px:.1} cy={py:.1} r={size} tabindex=0><title>{label}</title></circle>\n"
        );
    }
    // The frontier has no point above and to the right; at the page's edge labels go to the left.
    for (point, class, name, down) in named {
        let (px, py) = place(point);
        let (dx, anchor) = if px > edge - 120.0 { (-12.0, "end") } else { (12.0, "start") };
        let (x, y) = (px + dx, py + down);
        svg += &format!(
            "<text class=\"{class} halo\" x={x:.1} y={y:.1} text-anchor={anchor}>{name}</text>\n"
        );
    }
    svg + "</svg>\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_logarithmic() {
        let axis = Axis::of([1.0, 10.0, 100.0].into_iter(), 0.0, 216.0);
        let [a, b, c] = [1.0, 10.0, 100.0].map(|v| axis.at(v));
        assert!((a - 8.0).abs() < 1e-9 && (b - 108.0).abs() < 1e-9 && (c - 208.0).abs() < 1e-9);
        let upwards = Axis::of([1.0, 100.0].into_iter(), 216.0, 0.0);
        assert!(upwards.at(100.0) < upwards.at(1.0) && upwards.at(0.0) == 216.0);
        let ticks: Vec<f64> = axis.ticks().iter().map(|t| t.0).collect();
        assert_eq!(ticks, [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]);
    }

    /// An axis of one value, of none, or of none above 0 still has a tick.
    #[test]
    fn an_axis_is_never_empty() {
        for values in [vec![3.0], vec![], vec![0.0]] {
            let axis = Axis::of(values.iter().copied(), 0.0, 1.0);
            assert!(axis.high > axis.low && !axis.ticks().is_empty(), "{values:?}");
            assert!(axis.at(3.0).is_finite());
        }
    }

    #[test]
    fn ticks_read_as_written() {
        let shown = [0.001, 0.05, 1.0, 20.0, 500.0, 1e-8].map(number);
        assert_eq!(shown, ["0.001", "0.05", "1", "20", "500", "1e-8"]);
    }
}

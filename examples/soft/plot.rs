//! Curves on log axes, as one SVG of panels side by side.

use std::fmt::Write as _;

/// One curve: its name, where it stands, and which of [`COLOURS`] it has; dashed for floors.
pub struct Curve {
    pub name: String,
    pub points: Vec<[f64; 2]>,
    pub colour: usize,
    pub is_floor: bool,
}

pub struct Panel {
    pub title: String,
    pub x: &'static str,
    pub y: &'static str,
    pub curves: Vec<Curve>,
}

/// FileNotes apart without red and green.
const COLOURS: [&str; 5] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#444444"];
const SIZE: [f64; 2] = [430.0, 420.0];
/// Left, top, right, bottom: names stand below.
const MARGIN: [f64; 4] = [58.0, 34.0, 12.0, 132.0];

/// Decimal logarithms that an axis spans.
fn span(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let all = values.filter(|v| *v > 0.0).map(f64::log10);
    let [low, high] = all.fold([f64::MAX, f64::MIN], |[l, h], v| [l.min(v), h.max(v)]);
    let air = 0.05_f64.max(0.2 - (high - low) / 2.0);
    [low - air, high + air]
}

/// 1, 2 and 5 of each decade.
fn ticks([low, high]: [f64; 2]) -> Vec<f64> {
    let decades = low.floor() as i32..=high.ceil() as i32;
    let all = decades.flat_map(|d| [1.0, 2.0, 5.0].map(|m| m * 10_f64.powi(d)));
    all.filter(|v| (low..=high).contains(&v.log10())).collect()
}

fn number(value: f64) -> String {
    format!("{value:.*}", (-value.log10().floor()).max(0.0) as usize)
}

fn draw(svg: &mut String, panel: &Panel, left: f64) -> std::fmt::Result {
    let all = || panel.curves.iter().flat_map(|c| &c.points);
    let spans = [span(all().map(|p| p[0])), span(all().map(|p| p[1]))];
    let [from_x, to_x] = [left + MARGIN[0], left + SIZE[0] - MARGIN[2]];
    let [from_y, to_y] = [SIZE[1] - MARGIN[3], MARGIN[1]];
    let part = |v: f64, [low, high]: [f64; 2]| ((v.log10() - low) / (high - low)).clamp(0.0, 1.0);
    let x = |v: f64| from_x + (to_x - from_x) * part(v, spans[0]);
    let y = |v: f64| from_y + (to_y - from_y) * part(v, spans[1]);
    let middle = (from_x + to_x) / 2.0;
    writeln!(svg, "<text x='{middle:.1}' y='20' class='title'>{}</text>", panel.title)?;
    for v in ticks(spans[0]) {
        let at = x(v);
        writeln!(svg, "<path class='grid' d='M{at:.1} {from_y}V{to_y}'/>")?;
        writeln!(svg, "<text x='{at:.1}' y='{}'>{}</text>", from_y + 15.0, number(v))?;
    }
    for v in ticks(spans[1]) {
        let at = y(v);
        writeln!(svg, "<path class='grid' d='M{from_x} {at:.1}H{to_x}'/>")?;
        let (x, y) = (from_x - 5.0, at + 4.0);
        writeln!(svg, "<text x='{x}' y='{y:.1}' class='end'>{}</text>", number(v))?;
    }
    writeln!(svg, "<text x='{middle:.1}' y='{}'>{}</text>", from_y + 32.0, panel.x)?;
    let (at, half) = (left + 14.0, (from_y + to_y) / 2.0);
    writeln!(svg, "<text transform='translate({at} {half}) rotate(-90)'>{}</text>", panel.y)?;
    for (i, curve) in panel.curves.iter().enumerate() {
        let colour = COLOURS[curve.colour];
        let dash = if curve.is_floor { " stroke-dasharray='5 4'" } else { "" };
        let style = format!("fill='none' stroke='{colour}' stroke-width='2'{dash}");
        let line: Vec<String> =
            curve.points.iter().map(|p| format!("{:.1} {:.1}", x(p[0]), y(p[1]))).collect();
        writeln!(svg, "<path d='M{}' {style}/>", line.join("L"))?;
        for p in curve.points.iter().filter(|_| !curve.is_floor) {
            let (x, y) = (x(p[0]), y(p[1]));
            writeln!(svg, "<circle cx='{x:.1}' cy='{y:.1}' r='3' fill='{colour}'/>")?;
        }
        let low = from_y + 50.0 + 15.0 * i as f64;
        writeln!(svg, "<path d='M{from_x} {}H{}' {style}/>", low - 4.0, from_x + 22.0)?;
        writeln!(svg, "<text x='{}' y='{low}' class='begin'>{}</text>", from_x + 28.0, curve.name)?;
    }
    Ok(())
}

/// All panels side by side.
pub fn svg(panels: &[Panel]) -> String {
    let [width, height] = [SIZE[0] * panels.len() as f64, SIZE[1]];
    let mut svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width} {height}' width='{width}' height='{height}'>\n\
         <style>text{{font:12px sans-serif;text-anchor:middle;fill:#222}}.end{{text-anchor:end}}\
         .begin{{text-anchor:start}}.title{{font-weight:bold;font-size:13px}}.grid{{stroke:#ddd;fill:none}}</style>\n\
         <rect width='{width}' height='{height}' fill='#fff'/>\n"
    );
    for (i, panel) in panels.iter().enumerate() {
        draw(&mut svg, panel, SIZE[0] * i as f64).expect("text");
    }
    svg + "</svg>\n"
}

//! Pictures: curves as one SVG of panels side by side, texels as one PNG of panels in rows.

use std::fmt::Write as _;
use std::path::Path;

use ridgelight::Result;
use ridgelight::scene::Tone;
use ridgelight_io as files;

/// How a curve is drawn.
#[derive(Clone, Copy, PartialEq)]
pub enum Style {
    /// A line with a dot at each point.
    Dotted,
    Line,
    Dashes,
    Circles,
}

pub struct Curve {
    pub name: String,
    pub points: Vec<[f64; 2]>,
    /// An index of [`COLOURS`].
    pub colour: usize,
    pub style: Style,
}

pub struct Panel {
    pub title: String,
    pub x: &'static str,
    pub y: &'static str,
    pub curves: Vec<Curve>,
    /// Where linear axes end, from 0; else both are logarithmic.
    pub linear: Option<[f64; 2]>,
}

impl Panel {
    /// With logarithmic axes.
    pub fn new(title: impl Into<String>, [x, y]: [&'static str; 2], curves: Vec<Curve>) -> Self {
        Self { title: title.into(), x, y, curves, linear: None }
    }
}

/// A curve of these points.
pub fn curve(name: &str, colour: usize, style: Style, points: Vec<[f64; 2]>) -> Curve {
    Curve { name: name.to_owned(), points, colour, style }
}

/// Distinct without red and green.
const COLOURS: [&str; 5] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#444444"];
const SIZE: [f64; 2] = [430.0, 420.0];
/// Left, top, right, bottom: names stand below.
const MARGIN: [f64; 4] = [58.0, 34.0, 12.0, 132.0];

/// One axis: its ends, in logarithms where it has them, and its ticks.
struct Axis {
    is_log: bool,
    ends: [f64; 2],
    ticks: Vec<f64>,
}

impl Axis {
    /// A tenth of the end apart.
    fn linear(end: f64) -> Self {
        let ticks = (0..=10).map(|k| f64::from(k) * end / 10.0).collect();
        Self { is_log: false, ends: [0.0, end], ticks }
    }

    /// 1, 2 and 5 of each decade.
    fn log(values: impl Iterator<Item = f64>) -> Self {
        let all = values.filter(|v| *v > 0.0).map(f64::log10);
        let [low, high] = all.fold([f64::MAX, f64::MIN], |[l, h], v| [l.min(v), h.max(v)]);
        let air = 0.05_f64.max(0.2 - (high - low) / 2.0);
        let ends = [low - air, high + air];
        let decades = ends[0].floor() as i32..=ends[1].ceil() as i32;
        let all = decades.flat_map(|d| [1.0, 2.0, 5.0].map(|m| m * 10_f64.powi(d)));
        let ticks = all.filter(|v| (ends[0]..=ends[1]).contains(&v.log10())).collect();
        Self { is_log: true, ends, ticks }
    }

    fn share(&self, v: f64) -> f64 {
        let v = if self.is_log { v.log10() } else { v };
        ((v - self.ends[0]) / (self.ends[1] - self.ends[0])).clamp(0.0, 1.0)
    }

    fn text(&self, v: f64) -> String {
        if self.is_log {
            format!("{v:.*}", (-v.log10().floor()).max(0.0) as usize)
        } else {
            format!("{:.4}", v).trim_end_matches('0').trim_end_matches('.').to_owned()
        }
    }
}

fn draw(svg: &mut String, panel: &Panel, left: f64) -> std::fmt::Result {
    let all = |k: usize| panel.curves.iter().flat_map(|c| &c.points).map(move |p| p[k]);
    let axes = [0, 1].map(|k| match panel.linear {
        Some(ends) => Axis::linear(ends[k]),
        None => Axis::log(all(k)),
    });
    let [from_x, to_x] = [left + MARGIN[0], left + SIZE[0] - MARGIN[2]];
    let [from_y, to_y] = [SIZE[1] - MARGIN[3], MARGIN[1]];
    let x = |v: f64| from_x + (to_x - from_x) * axes[0].share(v);
    let y = |v: f64| from_y + (to_y - from_y) * axes[1].share(v);
    let middle = (from_x + to_x) / 2.0;
    writeln!(svg, "<text x='{middle:.1}' y='20' class='title'>{}</text>", panel.title)?;
    for v in &axes[0].ticks {
        let (at, text) = (x(*v), axes[0].text(*v));
        writeln!(svg, "<path class='grid' d='M{at:.1} {from_y}V{to_y}'/>")?;
        writeln!(svg, "<text x='{at:.1}' y='{}'>{text}</text>", from_y + 15.0)?;
    }
    for v in &axes[1].ticks {
        let (at, text) = (y(*v), axes[1].text(*v));
        writeln!(svg, "<path class='grid' d='M{from_x} {at:.1}H{to_x}'/>")?;
        writeln!(svg, "<text x='{}' y='{:.1}' class='end'>{text}</text>", from_x - 5.0, at + 4.0)?;
    }
    writeln!(svg, "<text x='{middle:.1}' y='{}'>{}</text>", from_y + 32.0, panel.x)?;
    let (at, half) = (left + 14.0, (from_y + to_y) / 2.0);
    writeln!(svg, "<text transform='translate({at} {half}) rotate(-90)'>{}</text>", panel.y)?;
    for (i, curve) in panel.curves.iter().enumerate() {
        let colour = COLOURS[curve.colour];
        let dash = if curve.style == Style::Dashes { " stroke-dasharray='5 4'" } else { "" };
        let style = format!("fill='none' stroke='{colour}' stroke-width='2'{dash}");
        let low = from_y + 50.0 + 15.0 * i as f64;
        if curve.style != Style::Circles {
            let line: Vec<String> =
                curve.points.iter().map(|p| format!("{:.1} {:.1}", x(p[0]), y(p[1]))).collect();
            writeln!(svg, "<path d='M{}' {style}/>", line.join("L"))?;
            writeln!(svg, "<path d='M{from_x} {}H{}' {style}/>", low - 4.0, from_x + 22.0)?;
        }
        let fill = if curve.style == Style::Circles { "none" } else { colour };
        let mut dot = |x: f64, y: f64| {
            writeln!(svg, "<circle cx='{x:.1}' cy='{y:.1}' r='3' fill='{fill}' stroke='{colour}'/>")
        };
        if matches!(curve.style, Style::Dotted | Style::Circles) {
            curve.points.iter().try_for_each(|p| dot(x(p[0]), y(p[1])))?;
            dot(from_x + 11.0, low - 4.0)?;
        }
        writeln!(svg, "<text x='{}' y='{low}' class='begin'>{}</text>", from_x + 28.0, curve.name)?;
    }
    Ok(())
}

/// All panels side by side, where a path is given.
pub fn write(path: Option<&Path>, panels: &[Panel]) -> Result<()> {
    let Some(path) = path else { return Ok(()) };
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
    files::write_text(path, &(svg + "</svg>\n"))
}

/// White pixels between pictures.
const GAP: usize = 4;

pub type Texels = Vec<[f32; 3]>;

/// Pictures of `cols` columns and one size, in rows; `zoom` pixels per texel.
pub fn png(
    path: &Path,
    rows: &[Vec<Texels>],
    cols: usize,
    zoom: usize,
    exposure: f32,
) -> Result<()> {
    let size = [rows[0][0].len() / cols * zoom, cols * zoom];
    let across = rows.iter().map(Vec::len).max().unwrap_or(0);
    let [height, width] = [rows.len() * (size[0] + GAP) - GAP, across * (size[1] + GAP) - GAP];
    let mut all = vec![[1.0 / exposure; 3]; width * height];
    for (j, row) in rows.iter().enumerate() {
        for (i, texels) in row.iter().enumerate() {
            for (y, x) in (0..size[0]).flat_map(|y| (0..size[1]).map(move |x| (y, x))) {
                let at = (j * (size[0] + GAP) + y) * width + i * (size[1] + GAP) + x;
                all[at] = texels[y / zoom * cols + x / zoom];
            }
        }
    }
    files::write_png(path, height, width, &all, None, Tone { exposure, ..Tone::default() }, &[])
}

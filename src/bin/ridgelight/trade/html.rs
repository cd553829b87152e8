//! One page that needs nothing else: the template with its places filled.

use super::point::Point;
use super::report::{Report, ms};
use super::truth::percent;

const TEMPLATE: &str = include_str!("page.html");
/// Groups of ruled-out settings, and settings not tried, that are spelt out; all are in the JSON.
const GROUPS: usize = 40;
const EXAMPLES: usize = 6;

pub fn page(report: &Report) -> String {
    let of = |name: &str| report.about.iter().find(|(k, _)| k == name).map_or("", |(_, v)| v);
    let input = of("input").rsplit(['/', '\\']).next().unwrap_or_default();
    let about = report
        .about
        .iter()
        .map(|(k, v)| format!("<tr><th>{}<td>{}\n", escaped(k), escaped(v)))
        .collect::<String>();
    let lines =
        |all: Vec<String>| all.iter().map(|l| format!("<li>{}\n", escaped(l))).collect::<String>();
    let breaks: Vec<String> =
        report.walk.search.breaks().iter().map(|b| report.break_text(b)).collect();
    let broken = if breaks.is_empty() {
        "<p>No ladder was found the wrong way round.".to_owned()
    } else {
        let held = "<p>Ladders found the wrong way round, which ruled nothing out from then on:";
        format!("{held}<ul>{}</ul>", lines(breaks))
    };
    let recommended = report.recommended();
    let headline = format!("{}, {}", report.time_text(recommended), report.error_text(recommended));
    let why = report.why().iter().map(|l| format!("<p>{}\n", escaped(l))).collect::<String>();
    let text = |text: String| escaped(&text);
    filled(
        TEMPLATE,
        &[
            ("title", text(format!("{input}: speed against accuracy"))),
            ("flags", text(report.flags(recommended.place))),
            ("headline", text(headline)),
            ("why", why),
            ("plot", super::plot::svg(report)),
            ("truth", text(report.truth_text())),
            ("drift", text(report.drift_text())),
            ("summary", text(report.summary())),
            ("cards", cards(report)),
            ("rows", rows(report)),
            ("assumption", text(Report::assumption())),
            ("broken", broken),
            ("ruled_out", ruled_out(report)),
            ("not_tried", not_tried(report)),
            ("knobs", knobs(report)),
            ("about", about),
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
        ],
    )
}

/// Replaces each {{name}}; what is filled in is not looked at again.
fn filled(template: &str, values: &[(&str, String)]) -> String {
    let mut parts = template.split("{{");
    let mut page = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (name, rest) = part.split_once("}}").expect("every {{ has its }}");
        let value = values.iter().find(|(n, _)| *n == name);
        page += &value.unwrap_or_else(|| panic!("{name} is filled")).1;
        page += rest;
    }
    page
}

/// A picture and its difference for each point of the frontier, after the truth's.
fn cards(report: &Report) -> String {
    let picture = |png: &[u8], alt: &str| {
        format!("<img src=\"data:image/png;base64,{}\" alt=\"{}\">", base64(png), escaped(alt))
    };
    let mut all = format!(
        "<figure>{}<figcaption><b>truth</b><br>{}</figcaption></figure>\n",
        picture(&report.truth_png, "truth"),
        escaped(&report.truth.about)
    );
    for point in report.frontier() {
        let Some(pictures) = &point.pictures else { continue };
        let flags = report.flags(point.place);
        let is_it = point.place == report.recommended().place;
        all += &format!(
            "<figure{}>{}{}<figcaption><b>{}, {}</b><br><code>{}</code><br>full colour: {} too bright \
             <i class=bright></i> or too dark <i class=dark></i></figcaption></figure>\n",
            if is_it { " class=best" } else { "" },
            picture(&pictures.light, &flags),
            picture(&pictures.difference, &format!("difference of {flags}")),
            escaped(&report.time_text(point)),
            escaped(&report.error_text(point)),
            escaped(&flags),
            escaped(&percent(pictures.scale)),
        );
    }
    all
}

fn rows(report: &Report) -> String {
    let front = report.walk.search.frontier();
    let mut points: Vec<&Point> = report.walk.points.iter().collect();
    points.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
    let row = |p: &&Point| {
        let kind = match (p.place == report.recommended().place, front.contains(&p.place)) {
            (true, _) => "best",
            (_, true) => "on",
            _ => "",
        };
        let (t, d) = (&p.total_ns, &p.distance);
        let passes: Vec<String> =
            p.passes.iter().map(|(name, ns)| format!("{name}: {}", ms(*ns))).collect();
        let cells = [
            report.time_text(p),
            format!("{}, {} – {}", ms(t.median), ms(t.p10), ms(t.p90)),
            p.draws.to_string(),
            report.error_text(p),
            percent(d.mean_shift),
            percent(d.p99),
            format!("{} at row {}, column {}", percent(d.worst), d.worst_row, d.worst_col),
            format!("{:.1} MiB", p.bytes as f64 / 1_048_576.0),
            ms(p.baseline_median()),
        ];
        let cells: String = cells.iter().map(|c| format!("<td>{}", escaped(c))).collect();
        format!(
            "<tr class=\"{kind}\"><td><details><summary><code>{}</code></summary>{}</details>{cells}\n",
            escaped(&report.flags(p.place)),
            escaped(&passes.join("; "))
        )
    };
    points.iter().map(row).collect()
}

fn ruled_out(report: &Report) -> String {
    let groups = report.skipped();
    let mut all: String = groups
        .iter()
        .take(GROUPS)
        .map(|g| {
            let some: Vec<String> =
                g.places.iter().take(EXAMPLES).map(|i| escaped(&report.flags(*i))).collect();
            let more = g.places.len().saturating_sub(EXAMPLES);
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            format!(
                "<li>{} ({}): <code>{}</code>{more}\n",
                escaped(&g.why),
                g.places.len(),
                some.join("</code>, <code>")
            )
        })
        .collect();
    let rest = groups.len().saturating_sub(GROUPS);
    if rest > 0 {
        all += &format!("<li>{rest} more reasons: all are in trade.json\n");
    }
    if all.is_empty() { "<li>nothing\n".to_owned() } else { all }
}

fn not_tried(report: &Report) -> String {
    let open = report.not_tried();
    let mut all: String = open
        .iter()
        .take(GROUPS)
        .map(|i| {
            let flags = escaped(&report.flags(*i));
            format!("<li><code>{flags}</code>: expected {}\n", escaped(&report.expected_text(*i)))
        })
        .collect();
    let rest = open.len().saturating_sub(GROUPS);
    if rest > 0 {
        all += &format!("<li>{rest} more: all are in trade.json\n");
    }
    if all.is_empty() {
        "<li>nothing: every setting was measured, ruled out or given up\n".to_owned()
    } else {
        all
    }
}

fn knobs(report: &Report) -> String {
    let row = |knob: &ridgelight::measure::trade::Knob| {
        format!(
            "<tr><th>{}<td><code>{}</code><td>{}\n",
            escaped(knob.name),
            escaped(&knob.steps.join("  ")),
            escaped(knob.dearer)
        )
    };
    report.knobs.iter().map(row).collect()
}

/// Text that stands for itself in HTML, in quoted attributes too.
pub fn escaped(text: &str) -> String {
    text.chars()
        .map(|c| match c {
            '&' => "&amp;".to_owned(),
            '<' => "&lt;".to_owned(),
            '>' => "&gt;".to_owned(),
            '"' => "&quot;".to_owned(),
            c => c.to_string(),
        })
        .collect()
}

/// RFC 4648, section 4.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let byte = |i: usize| u32::from(three.get(i).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for digit in 0..4 {
            let is_there = digit <= three.len();
            let value = (bits >> (18 - 6 * digit)) & 63;
            text.push(if is_there { DIGITS[value as usize] as char } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// RFC 4648, section 10.
    #[test]
    fn base64_is_the_standards() {
        let texts = ["", "f", "fo", "foo", "foob", "fooba", "foobar"];
        let expected = ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"];
        assert_eq!(texts.map(|t| base64(t.as_bytes())), expected);
        assert_eq!(base64(&[0xFB, 0xFF]), "+/8=");
    }

    #[test]
    fn values_are_filled_in_once() {
        let values = [("a", "{{b}}".to_owned()), ("b", "2".to_owned())];
        assert_eq!(filled("1 {{a}} {{b}} 3", &values), "1 {{b}} 2 3");
        assert_eq!(escaped("<a href=\"x\">&"), "&lt;a href=&quot;x&quot;&gt;&amp;");
    }
}

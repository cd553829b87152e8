//! The report as one self-contained HTML page.

use super::left_out::{EXAMPLES, GROUPS};
use super::point::Point;
use super::report::{Report, ms};
use crate::setup::terminal::{digits, percent};

const TEMPLATE: &str = include_str!("page.html");

pub fn page(report: &Report) -> String {
    let of = |name: &str| report.about.iter().find(|(k, _)| k == name).map_or("", |(_, v)| v);
    let input = of("input").rsplit(['/', '\\']).next().unwrap_or_default();
    let about = |(k, v): &(String, String)| format!("<tr><th>{}<td>{}\n", escaped(k), escaped(v));
    let lines =
        |all: &[String]| all.iter().map(|l| format!("<li>{}\n", escaped(l))).collect::<String>();
    let held = "<p>Ladders that were not monotonic, and ruled nothing out from then on:";
    let broken = match lines(&report.breaks()) {
        none if none.is_empty() => "<p>All ladders were monotonic.".to_owned(),
        lines => format!("{held}<ul>{lines}</ul>"),
    };
    let recommended = report.recommended();
    let headline = format!(
        "{} per frame, error {} (RMSE over the mean)",
        report.time_text(recommended),
        report.error_text(recommended)
    );
    let why = report.why().iter().map(|l| format!("<p>{}\n", escaped(l))).collect::<String>();
    let text = |text: String| escaped(&text);
    filled(
        TEMPLATE,
        &[
            ("title", text(format!("{input}: speed against accuracy"))),
            ("flags", code(&report.flags(recommended.place))),
            ("headline", text(headline)),
            ("why", why),
            ("plot", super::plot::svg(report)),
            ("ground_truth", text(report.ground_truth_text())),
            ("drift", text(report.drift_text())),
            ("summary", text(report.summary())),
            ("tones", text(report.ground_truth.tones.text())),
            ("cards", cards(report)),
            ("rows", rows(report)),
            ("assumption", text(Report::assumption())),
            ("broken", broken),
            ("ruled_out", ruled_out(report)),
            ("not_tried", not_tried(report)),
            ("settings", ladders(report)),
            ("about", report.about.iter().map(about).collect()),
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
        ],
    )
}

/// Replaces each {{name}} once; values are not expanded again.
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

/// A picture and its difference for each point of the frontier, after the ground truth's.
fn cards(report: &Report) -> String {
    let picture = |png: &[u8], alt: &str| {
        format!("<img src=\"data:image/png;base64,{}\" alt=\"{}\">", base64(png), escaped(alt))
    };
    let mut all = format!(
        "<figure>{}<figcaption><b>the ground truth</b><br>{}</figcaption></figure>\n",
        picture(&report.ground_truth_png, "the ground truth"),
        escaped(&report.ground_truth.about)
    );
    for point in report.frontier() {
        let Some(pictures) = &point.pictures else { continue };
        let flags = report.flags(point.place);
        let is_it = point.place == report.recommended().place;
        all += &format!(
            "<figure{}>{}{}<figcaption><b>{}, {}</b>{}<br>{}<br>mean ꟻLIP {}, 99th percentile \
                {}<br>difference: <span class=scale>−{scale} too dark <i></i> {scale} too \
                bright</span></figcaption></figure>\n",
            if is_it { " class=best" } else { "" },
            picture(&pictures.light, &flags),
            picture(&pictures.difference, &format!("difference of {flags}")),
            escaped(&report.time_text(point)),
            escaped(&report.error_text(point)),
            if is_it { ", recommended" } else { "" },
            code(&flags),
            digits(pictures.flip.mean),
            digits(pictures.flip.p99),
            scale = short_percent(pictures.scale),
        );
    }
    all
}

fn rows(report: &Report) -> String {
    let front = report.walk.search.frontier();
    let mut points: Vec<&Point> = report.walk.points.iter().collect();
    points.sort_by(|a, b| a.ratio().total_cmp(&b.ratio()));
    let row = |p: &&Point| {
        let kind = match (p.place == report.recommended().place, front.contains(&p.place)) {
            (true, _) => "best",
            (_, true) => "on",
            _ => "",
        };
        let (t, d) = (p.total_ns(), &p.distance);
        let drawn = format!(
            "{} draws: median {}, {} – {}; the baseline paired with them {}. ",
            p.totals_ns.len(),
            ms(t.median),
            ms(t.p10),
            ms(t.p90),
            ms(p.baseline_median())
        );
        let passes: Vec<String> =
            p.passes.iter().map(|(name, ns)| format!("{name}: {}", ms(*ns))).collect();
        let cells = [
            report.time_text(p),
            report.error_text(p),
            percent(d.relative_mean_shift),
            percent(d.relative_p99),
            percent(d.relative_worst),
            format!("{}, {}", d.worst_row, d.worst_col),
            p.pictures.as_ref().map_or_else(String::new, |p| digits(p.flip.mean)),
            format!("{:.1} MiB", p.bytes as f64 / 1_048_576.0),
        ];
        let cells: String = cells.iter().map(|c| format!("<td>{}", escaped(c))).collect();
        format!(
            "<tr class=\"{kind}\"><td><details><summary>{}</summary>{}{}</details>{cells}\n",
            code(&report.flags(p.place)),
            escaped(&drawn),
            escaped(&passes.join("; "))
        )
    };
    points.iter().map(row).collect()
}

fn ruled_out(report: &Report) -> String {
    let groups = report.walk.skipped();
    let mut all: String = groups
        .iter()
        .take(GROUPS)
        .map(|(why, places)| {
            let some = places.iter().take(EXAMPLES).map(|i| code(&report.flags(*i)));
            let some = some.collect::<Vec<_>>().join(", ");
            let more = places.len().saturating_sub(EXAMPLES);
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            format!("<li>{} ({}): {some}{more}\n", escaped(why), places.len())
        })
        .collect();
    let rest = groups.len().saturating_sub(GROUPS);
    if rest > 0 {
        let count: usize = groups[GROUPS..].iter().map(|g| g.1.len()).sum();
        all += &format!("<li>{rest} more reasons, for {count} settings\n");
    }
    if all.is_empty() { "<li>nothing\n".to_owned() } else { all }
}

fn not_tried(report: &Report) -> String {
    let open = report.walk.not_tried();
    let mut all: String = open
        .iter()
        .take(GROUPS)
        .map(|i| {
            let flags = code(&report.flags(*i));
            format!("<li>{flags}: expected {}\n", escaped(&report.walk.expected_text(*i)))
        })
        .collect();
    let rest = open.len().saturating_sub(GROUPS);
    if rest > 0 {
        all += &format!("<li>{rest} more; trade.json counts them by setting and value\n");
    }
    match all.is_empty() {
        true => "<li>none: every setting was measured, ruled out or given up\n".to_owned(),
        false => all,
    }
}

fn ladders(report: &Report) -> String {
    let row = |ladder: &ridgelight_trade::trade::Ladder| {
        let range = ladder.range.as_ref();
        format!(
            "<tr><th>{}<td>{}<td>{}<td>{}<td>{}\n",
            escaped(ladder.name),
            ladder.steps.iter().map(|s| code(s)).collect::<Vec<_>>().join(" "),
            code(&ladder.steps[ladder.default]),
            range.map_or("as listed".into(), |r| format!("{} to {}", r.start(), r.end())),
            escaped(ladder.slower)
        )
    };
    report.walk.ladders.iter().map(row).collect()
}

/// Flags that wrap between flags only.
fn code(flags: &str) -> String {
    let each: Vec<String> =
        flags.split(" --").map(|f| escaped(f.trim_start_matches("--"))).collect();
    format!("<code><span>--{}</span></code>", each.join("</span> <span>--"))
}

/// A round number without trailing zeros.
fn short_percent(share: f64) -> String {
    let text = digits(100.0 * share);
    let is_plain = text.contains('.') && !text.contains('e');
    let text = if is_plain { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    format!("{text} %")
}

/// Escapes text for HTML content and quoted attributes.
pub fn escaped(text: &str) -> String {
    let marks = [("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ("\"", "&quot;")];
    marks.iter().fold(text.to_owned(), |text, (mark, escape)| text.replace(mark, escape))
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
        assert_eq!(code("--a 1 --b"), "<code><span>--a 1</span> <span>--b</span></code>");
        assert_eq!(
            [0.02, 0.1, 2.0, 1e-12].map(short_percent),
            ["2 %", "10 %", "200 %", "1.00e-10 %"]
        );
        assert_eq!(escaped("<a href=\"x\">&"), "&lt;a href=&quot;x&quot;&gt;&amp;");
    }
}

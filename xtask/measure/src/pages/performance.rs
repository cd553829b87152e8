//! The tables of docs/measured/performance.md.

use std::path::Path;

use serde_json::Value;

use super::Result;
use super::figures::{Figures, RESULTS, wrong};
use crate::performance::{FORMS, reports};

/// Published figures of 1024 × 1024 points on a GTX 280: the place in TW10, the work, and the figure as it stands there.
const PUBLISHED: [[&str; 3]; 3] = [
    ["section 8", "horizons of one azimuth, of 128", "0.30 ms"],
    ["table 1", "a frame under a uniform sky, 64 azimuths", "24 frames/s"],
    ["table 1", "a frame under an environment, 64 azimuths", "23 frames/s"],
];

pub fn performance() -> Result<String> {
    if !Path::new(RESULTS).join("performance.json").exists() {
        return Ok("Not measured on a quiet machine since the page was made.\n".to_owned());
    }
    let figures = Figures::read("performance")?;
    let (frame, forms) = (&figures.all["reports"]["frame"], &figures.all["reports"]["forms"]);
    let mut out = format!(
        "## One frame\n\n1024 × 1024 texels, 64 azimuths, `--fuse aimed-around`, uniform sky, a fractal. Each pass alone; {}.\n\n\
         | pass | ms, median | 10th to 90th percentile | cold caches | of the copy's rate |\n|---|---|---|---|---|\n",
        command("frame")
    );
    for row in rows(frame).iter().filter(|row| is(row, "isolated") && row["pass"] != "total") {
        let label = label(row);
        let cold = rows(frame).iter().find(|r| is(r, "cold") && self::label(r) == label);
        let cold = cold.map(|r| ms(&figures, r, "median_ns")).transpose()?;
        out += &format!(
            "| {label} | {:.2} | {:.2} to {:.2} | {} | {} |\n",
            ms(&figures, row, "median_ns")?,
            ms(&figures, row, "p10_ns")?,
            ms(&figures, row, "p90_ns")?,
            cold.map_or("-".into(), |cold| format!("{cold:.2}")),
            row["copy_share"].as_f64().map_or("-".into(), |s| format!("{:.0} %", 100.0 * s)),
        );
    }
    for (mode, what) in [
        ("overlapped", "whole frame, no timestamps between passes"),
        ("in_flow", "whole frame, a timestamp after each pass"),
        ("cold", "whole frame, cold caches"),
    ] {
        let total = whole(frame, mode, &figures)?;
        out += &format!(
            "| {what} | {:.2} | {:.2} to {:.2} | | |\n",
            ms(&figures, total, "median_ns")?,
            ms(&figures, total, "p10_ns")?,
            ms(&figures, total, "p90_ns")?
        );
    }
    out += "\nPeak rates of the device, in the same call: ";
    let peaks = frame["peaks"].as_array().map_or(&[][..], Vec::as_slice);
    let rate = |part: &str, key: &str, unit: &str, scale: f64| -> Result<String> {
        let row = peaks.iter().find(|row| row["part"] == part);
        let row = row.ok_or_else(|| missing(&figures, part))?;
        Ok(format!("{:.2} {unit}", scale * figures.number(row, key)?))
    };
    out += &format!(
        "copy {}, texel fetches {}, reads of shared memory {}, arithmetic {}.\n",
        rate("copy", "gb_per_s", "GB/s", 1.0)?,
        rate("fetch", "texels_per_s", "G/s", 1e-9)?,
        rate("shared", "reads_per_s", "G/s of 8 bytes", 1e-9)?,
        rate("fma", "flop_per_s", "GFLOP/s", 1e-9)?
    );
    out += "\n## Over a scalar sweep\n\nThe scalar sweep is a hull sweep in Rust on all cores of the processor, one line at a time, in turn \
            with each row's frames.\n\n\
            | work | time over the scalar sweep |\n|---|---|\n";
    let what = [
        "horizon sweep",
        "sky shading, `aimed-nearest`",
        "sky shading, `aimed-around`",
        "exact lines",
        "pyramid",
        "brute force",
    ];
    for (what, name) in what.into_iter().zip(FORMS) {
        let ours = rows(forms).iter().find(|row| label(row) == name);
        let ours = ours.ok_or_else(|| missing(&figures, name))?;
        let beside = ours["settings"]["scalar_beside"].as_str().unwrap_or_default();
        let scalar = rows(forms).iter().find(|row| label(row) == beside);
        let scalar = scalar.ok_or_else(|| missing(&figures, beside))?;
        let each = |row: &Value| -> Result<f64> {
            Ok(ms(&figures, row, "median_ns")? / figures.number(row, "azimuths")?)
        };
        out += &format!("| {what} | {:.2} |\n", each(ours)? / each(scalar)?);
    }
    out += "\nFigures of [TW10](../methods.md), the paper of the method, for 1024 × 1024 points on an Nvidia GTX 280:\n\n\
            | place in TW10 | work | figure |\n|---|---|---|\n";
    for [place, work, figure] in PUBLISHED {
        out += &format!("| {place} | {work} | {figure} |\n");
    }
    out += "\n## Environment\n\n| pass, 64 azimuths | ms, median |\n|---|---|\n";
    for row in rows(&figures.all["reports"]["environment"]) {
        if is(row, "isolated") || row["pass"] == "total" && is(row, "overlapped") {
            let name = if is(row, "overlapped") { "whole frame" } else { &label(row) };
            if name != "total" {
                out += &format!("| {name} | {:.2} |\n", ms(&figures, row, "median_ns")?);
            }
        }
    }
    out += "\n## Time against size, azimuths and bounces\n\n\
            ![Time of a frame against the side of the field, azimuths and bounces](../pictures/performance.svg)\n\n\
            Whole frames of a fractal under a uniform sky, no timestamps between passes.\n";
    let mut shared = vec![ms(&figures, whole(frame, "overlapped", &figures)?, "median_ns")?];
    for name in ["sizes", "azimuths"] {
        out += &format!(
            "\n{}:\n\n| field | azimuths | frame, ms | 95 % interval of the median | ms per azimuth and 2^20 texels |\n\
             |---|---|---|---|---|\n",
            command(name)
        );
        for row in rows(&figures.all["reports"][name]) {
            let [cols, azimuths] = figures.numbers(row, "cols azimuths")?;
            let ms = ms(&figures, row, "median_ns")?;
            let each = ms / azimuths / (cols * cols / f64::from(1 << 20));
            let interval = interval(&figures, row)?;
            out += &format!("| {cols}² | {azimuths} | {ms:.1} | {interval} | {each:.2} |\n");
            if [cols, azimuths] == [1024.0, 64.0] {
                shared.push(ms);
            }
        }
    }
    let text: Vec<String> = shared.iter().map(|ms| format!("{ms:.1}")).collect();
    out += &format!(
        "\nThree calls time the frame of 1024² and 64 azimuths: {} ms. They ran one after the other on the same machine, so they \
         show how much processes differ.\n",
        text.join(", ")
    );
    out += "\n| bounces, 512 × 512, 64 azimuths, 32 bounce azimuths, every 2nd texel | frame, ms | 95 % interval of the median |\n|---|---|---|\n";
    for count in 0..=4 {
        let report = &figures.all["reports"][format!("bounces{count}")];
        let total = whole(report, "overlapped", &figures)?;
        let interval = interval(&figures, total)?;
        out += &format!("| {count} | {:.1} | {interval} |\n", ms(&figures, total, "median_ns")?);
    }
    out += "\nWhere an interval spans more than a tenth of its median, the machine was noisy.\n";
    let [device, driver, cpu, load, ended, commit] =
        ["device", "driver", "cpu", "load", "ended", "commit"]
            .map(|key| figures.word(&figures.all, key));
    out += &format!(
        "\n*{}, {}; {}, load {} at the start; {}; commit {}*\n",
        device?, driver?, cpu?, load?, ended?, commit?
    );
    Ok(out)
}

fn rows(report: &Value) -> &[Value] {
    report["rows"].as_array().map_or(&[], Vec::as_slice)
}

/// The row of a whole frame.
fn whole<'a>(report: &'a Value, mode: &str, figures: &Figures) -> Result<&'a Value> {
    let total = rows(report).iter().find(|row| row["pass"] == "total" && is(row, mode));
    total.ok_or_else(|| missing(figures, mode))
}

/// The command of a report, as a user writes it.
fn command(report: &str) -> String {
    let found = reports().into_iter().find(|(name, _)| name == report);
    let words = found.map_or(String::new(), |(_, words)| words);
    format!("`bench {}`", words.replace(',', " ").replace(';', ","))
}

fn is(row: &Value, mode: &str) -> bool {
    row["mode"] == mode
}

/// Pass and part.
fn label(row: &Value) -> String {
    let word = |key: &str| row[key].as_str().unwrap_or_default();
    format!("{} {}", word("pass"), word("part")).trim_end().to_owned()
}

fn ms(figures: &Figures, row: &Value, key: &str) -> Result<f64> {
    Ok(figures.number(row, key)? * 1e-6)
}

/// Ends of the median's interval, ms.
fn interval(figures: &Figures, row: &Value) -> Result<String> {
    let [low, high] = figures.numbers::<2>(row, "median_low_ns median_high_ns")?;
    Ok(format!("{:.1} to {:.1}", low * 1e-6, high * 1e-6))
}

fn missing(figures: &Figures, name: &str) -> String {
    wrong(&figures.path, &format!("no row {name}"), "one, as cargo xtask performance writes it")
}

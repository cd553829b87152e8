//! Puts the figures of benches/results into README.md, between `<!-- begin NAME -->` and
//! `<!-- end NAME -->`: what stands there is made, never typed. See `tools/readme`.
//!
//! `cargo run --example readme` writes README.md; with `-- --check` it changes nothing and fails where
//! README.md is not what would be written.

#[path = "readme/brdf.rs"]
mod brdf;
#[path = "readme/figures.rs"]
mod figures;
#[path = "readme/splice.rs"]
mod splice;

use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

use figures::{Figures, RESULTS, made, percent, text, wrong};
use ridgelight_io as files;
use serde_json::Value;
use splice::{broken, with};

/// Or a sentence for the user.
type Result<T> = std::result::Result<T, String>;

/// A real field of more than a million samples; others lie beside it.
const ACCURACY: &str = "accuracy_N44W072.txt";

fn picture() -> Result<String> {
    let figures = Figures::read("picture")?;
    let of = |key| figures.number(&figures.all, key);
    let mut out = String::from(
        "![A mountain without shadows, as Ridgelight lights it, and its reference](docs/demo.png)\n\n",
    );
    let (azimuths, true_azimuths) = (of("azimuths")?, of("reference_azimuths")?);
    writeln!(out, "| without shadows | Ridgelight, {azimuths} azimuths | brute force, {true_azimuths} azimuths |").unwrap();
    writeln!(out, "|:-:|:-:|:-:|").unwrap();
    writeln!(out, "| | {:.1} ms | {:.1} ms |", of("ours_ms")?, of("reference_ms")?).unwrap();
    let (off, ours) = (of("off_error")?, of("ours_error")?);
    writeln!(out, "| {} off | {} off | the reference |", percent(Some(off)), percent(Some(ours)))
        .unwrap();
    writeln!(
        out,
        "\n{} × {} samples (SRTM) under the bundled sky and a sun ten degrees high; off: RMSE relative to the mean.",
        of("cols")?,
        of("rows")?
    )
    .unwrap();
    writeln!(out, "{}", figures.caption()?).unwrap();
    Ok(out)
}

fn camera() -> Result<String> {
    let figures = Figures::read("terrain")?;
    let of = |key| figures.number(&figures.all, key);
    let (lit, drawn) = (of("lit_ms")?, of("drawn_ms")?);
    let mut out =
        String::from("![A mountain range under a low sun, from a camera](docs/terrain.png)\n\n");
    writeln!(
        out,
        "Mt Washington and the Presidential Range, {} × {} samples (SRTM), under the bundled sky and a low sun, {} azimuths and \
         {} bounce: lit in {lit:.1} ms, drawn at {} × {}, {} samples a pixel, in {drawn:.1} ms. Coloured by height; heights \
         are as they are (`examples/terrain`).",
        of("field_cols")?,
        of("field_rows")?,
        of("azimuths")?,
        of("bounces")?,
        of("cols")?,
        of("rows")?,
        of("samples")?,
    )
    .unwrap();
    writeln!(out, "{}", figures.caption()?).unwrap();
    Ok(out)
}

/// Programs that an integrator would write, whole.
const HOSTS: [(&str, &str, &str); 3] = [
    ("Rust, `ash`", "examples/ash_host.rs", "the code above and an engine around it"),
    (
        "C, plain Vulkan",
        "capi/tests/c/host.c",
        "the shared and the static library, under the address sanitizer too",
    ),
    (
        "Rust, `wgpu`",
        "examples/wgpu/src/main.rs",
        "wgpu's device and textures, the light sampled in a wgpu pass",
    ),
];

/// Where a program's own engine begins, if it says so.
const ENGINE: &str = "// What follows an engine has already.";

/// Lines of code: neither empty nor a comment alone.
fn code_lines(text: &str) -> usize {
    let is_comment = |line: &str| line.starts_with("//") || line.starts_with("/*");
    text.lines().map(str::trim).filter(|line| !line.is_empty() && !is_comment(line)).count()
}

fn hosts() -> Result<String> {
    let mut out = String::from("| host | lines of code | what it is |\n|---|---|---|\n");
    for (name, path, what) in HOSTS {
        let program = text(Path::new(path))?;
        let of_engine = program.split_once(ENGINE);
        let own = of_engine.map(|(own, _)| format!(", {} without the engine", code_lines(own)));
        let own = own.unwrap_or_default();
        writeln!(out, "| [{name}]({path}) | {}{own} | {what} |", code_lines(&program)).unwrap();
    }
    let tests = "Tests run each and hold it to the command line's bytes, with no word of validation \
                 (`tests/gpu/ash_host.rs`, `capi/tests/c`, `tools/wgpu`).";
    writeln!(out, "\n{tests}").unwrap();
    Ok(out)
}

fn sizes() -> Result<String> {
    let figures = Figures::read("sizes")?;
    let key = |row: &Value, key| figures.number(row, key).map(|v| v as u64);
    let (mut sides, mut counts) = (Vec::new(), Vec::new());
    for row in figures.rows() {
        sides.push(key(row, "cols")?);
        counts.push(key(row, "azimuths")?);
    }
    for all in [&mut sides, &mut counts] {
        all.sort_unstable();
        all.dedup();
    }
    let mut out = String::from("| field |");
    counts.iter().for_each(|m| write!(out, " {m} azimuths |").unwrap());
    writeln!(out, "\n|---|{}", "---|".repeat(counts.len())).unwrap();
    for side in &sides {
        write!(out, "| {side}² |").unwrap();
        for count in &counts {
            let is = |row: &&Value| row["cols"] == *side && row["azimuths"] == *count;
            let Some(row) = figures.rows().iter().find(is) else {
                write!(out, " not measured |").unwrap();
                continue;
            };
            let settings = &row["settings"];
            let mb = figures.number(settings, "device_bytes")? * 1e-6;
            let ms = figures.number(row, "median_ns")? * 1e-6;
            let error = percent(settings["light_error"].as_f64());
            write!(out, " {ms:.1} ms, {mb:.1} MB, {error} |").unwrap();
        }
        out.push('\n');
    }
    writeln!(
        out,
        "\nA whole frame under a uniform sky, memory of all images and buffers, RMSE of the light beside the f64 oracle."
    )
    .unwrap();
    writeln!(out, "{}", figures.caption()?).unwrap();
    Ok(out)
}

fn forms() -> Result<String> {
    let figures = Figures::read("forms_1024")?;
    let mut out = String::from(
        "| form | azimuths | ms an azimuth | × scalar sweep on all cores |\n|---|---|---|---|\n",
    );
    let an_azimuth = |row: &Value| -> Result<f64> {
        Ok(figures.number(row, "median_ns")? * 1e-6 / figures.number(row, "azimuths")?)
    };
    for row in figures.rows() {
        let Some(beside) = row["settings"]["scalar_beside"].as_str() else { continue };
        let scalar = figures.rows().iter().find(|r| r["pass"] == beside);
        let scalar = scalar
            .ok_or_else(|| wrong(&figures.path, &format!("no row {beside}"), "the scalar's row"))?;
        let (ms, azimuths) = (an_azimuth(row)?, figures.number(row, "azimuths")?);
        let pass = figures.word(row, "pass")?;
        writeln!(out, "| {pass} | {azimuths} | {ms:.3} | {:.3} |", ms / an_azimuth(scalar)?)
            .unwrap();
    }
    writeln!(out, "\n{}", figures.caption()?).unwrap();
    Ok(out)
}

/// The tables of [`ACCURACY`], as examples/accuracy printed them.
fn accuracy() -> Result<String> {
    let path = Path::new(RESULTS).join(ACCURACY);
    let text = text(&path)?;
    let (_, tables) = text
        .split_once('\n')
        .filter(|(_, tables)| tables.contains(" samples, ") && tables.contains("\n| "))
        .ok_or_else(|| wrong(&path, "no table", "the text of examples/accuracy"))?;
    let name = ACCURACY.trim_start_matches("accuracy_").trim_end_matches(".txt");
    Ok(format!("{name}{}: {}\n", made(&path)?, tables.trim()))
}

/// The last paragraph of examples/edits.
fn edits() -> Result<String> {
    let path = Path::new(RESULTS).join("edits.txt");
    let text = text(&path)?;
    let missing = || wrong(&path, "no summary", "the text of examples/edits");
    let summary = text.trim_end().rsplit_once("\n\n").ok_or_else(missing)?.1;
    // After the date: the device, the sizes.
    let device = text.lines().nth(1).and_then(|line| line.rsplit_once(": ")).ok_or_else(missing)?.0;
    Ok(format!("{summary}\n*{device}{}*\n", made(&path)?))
}

/// What bounces add to a frame, as `examples/bounce table` printed it.
fn bounces() -> Result<String> {
    let path = Path::new(RESULTS).join("bounce_table.txt");
    let text = text(&path)?;
    let table = text.split("\n\n").find(|part| part.starts_with("| engine | bounce azimuths |"));
    let table =
        table.ok_or_else(|| wrong(&path, "no table", "the text of examples/bounce table"))?;
    Ok(format!("{table}\n\n*{}*\n", made(&path)?.trim_start_matches("; ")))
}

/// How often `render --max-error` holds with bounces, as `examples/goals` counts it.
fn goals() -> Result<String> {
    let path = Path::new(RESULTS).join("goals.txt");
    let text = text(&path)?;
    let counted = text.trim_end().rsplit_once("\n\n").filter(|(_, last)| last.ends_with("refused"));
    let (_, counted) =
        counted.ok_or_else(|| wrong(&path, "no count", "the text of examples/goals"))?;
    Ok(format!("{counted}.\n\n*{}*\n", made(&path)?.trim_start_matches("; ")))
}

/// What examples/auto found of `render --max-error`.
fn auto() -> Result<String> {
    let figures = Figures::read("auto")?;
    let whole = |key| figures.number(&figures.all, key);
    let of = |key| figures.number(&figures.all["summary"], key);
    let (held, chosen) = (of("held")?, of("chosen")?);
    let mut different: Vec<(&str, &str)> = figures
        .rows()
        .iter()
        .filter_map(|row| Some((row["scene"].as_str()?, row["settings"].as_str()?)))
        .collect();
    different.sort_unstable();
    different.dedup();
    let mut out = String::new();
    writeln!(
        out,
        "5, 2, 1, 0.5 and 0.2 % asked of {} pairs of a field (its middle {}²) and lights that nothing was \
         fitted on (other pairs of each were): {held} of {chosen} choices hold ({:.1} %; {} of them differ, \
         {} are within the bound that they state), {} of {} are refused ({} of them though \
         settings that hold were drawn). Time over the cheapest that truly holds of all that a `trade` walk of {} s \
         and the choices drew, in turn: \
         median {:.2}, 90 % {:.2}, worst {:.2}; at most 1.3 in {} of {}.",
        whole("pairs")?,
        whole("side")?,
        100.0 * held / chosen,
        different.len(),
        of("within_stated_bound")?,
        of("refused")?,
        of("asked")?,
        of("refused_though_found")?,
        whole("trade_seconds")?,
        of("ratio_median")?,
        of("ratio_90")?,
        of("ratio_worst")?,
        of("within_1.3")?,
        of("ratios")?
    )
    .unwrap();
    writeln!(out, "\n{}", figures.caption()?).unwrap();
    Ok(out)
}

/// What each kind of `bake` is packed in and may be off by; angles in degrees.
fn bake() -> Result<String> {
    let figures = Figures::read("bake")?;
    let mut out = String::from(
        "| kind | channels | packed as | bytes | stated error | worst here |\n|---|---|---|---|---|---|\n",
    );
    for row in figures.rows() {
        let word = |key| figures.word(row, key);
        let (mut stated, mut worst) = (Vec::new(), Vec::new());
        for bound in row["bounds"].as_array().map_or(&[][..], Vec::as_slice) {
            let number = |key| figures.number(bound, key);
            let is_angle = figures.word(bound, "unit")? == "rad";
            let shown = |v: f64| match is_angle {
                _ if v == 0.0 => "0".to_owned(),
                true => format!("{:.4}°", v.to_degrees()),
                false => format!("{v:.2e}"),
            };
            let (most, share) = (number("at_most")?, number("and_of_the_value")?);
            let of_value = format!("{share:.1e} of it");
            let most = match (most > 0.0, share > 0.0) {
                (true, true) => format!("{} + {of_value}", shown(most)),
                (false, true) => of_value,
                _ => shown(most),
            };
            stated.push(format!("{}: {most}", figures.word(bound, "of")?));
            worst.push(shown(number("worst")?));
        }
        let (bytes, each) = (figures.number(row, "bytes")?, word("each")?);
        writeln!(
            out,
            "| {} | {} | {} | {bytes} {each} | {} | {} |",
            word("kind")?,
            word("channels")?,
            word("encoding")?,
            stated.join("; "),
            worst.join("; ")
        )
        .unwrap();
    }
    writeln!(
        out,
        "\nOf decoding a .ktx2 or .png; worst of the bundled mountain, {} times as steep, {} azimuths; of light its middle {side}² samples, \
         which repeat (`examples/bake`).",
        figures.number(&figures.all, "steeper")?,
        figures.number(&figures.all, "azimuths")?,
        side = figures.number(&figures.all, "lit_side")?
    )
    .unwrap();
    writeln!(out, "{}", figures.caption()?).unwrap();
    Ok(out)
}

/// What examples/curved found: the bases that are not refused.
fn curved() -> Result<String> {
    let path = Path::new(RESULTS).join("curved.txt");
    let text = text(&path)?;
    let missing = || wrong(&path, "no table", "the text of examples/curved");
    let device = text.lines().nth(1).ok_or_else(missing)?;
    let is_refused = |row: &&str| row.ends_with(" refused |");
    let tables: Vec<&str> = text.split("\n\n").filter(|part| part.starts_with('|')).collect();
    let [shadows, light] = tables[..] else { return Err(missing()) };
    let told = |table: &str| {
        let rows: Vec<&str> = table.lines().filter(|row| !is_refused(row)).collect();
        if rows.len() < 3 { Err(missing()) } else { Ok(rows.join("\n")) }
    };
    let radius = |row: &str| row.split('|').nth(1).unwrap_or_default().trim().to_owned();
    let refused: Vec<String> = shadows.lines().filter(is_refused).map(radius).collect();
    Ok(format!(
        "{}\n\n{}\n\nThree V-shaped grooves, 16 by 8 cells each, bent across their length; rays at the bent mesh are the truth \
         ([all of it](benches/results/curved.txt)). A radius above 0 widens them. \
         Said: what plans say of lights and of light, %. Off: RMSE over the mean. Refused: {}.\n*{device}{}*\n",
        told(shadows)?,
        told(light)?,
        refused.join(", "),
        made(&path)?
    ))
}

fn run(check: bool) -> Result<bool> {
    let path = Path::new("README.md");
    let mut readme = text(path)?;
    let mut stale = Vec::new();
    type Section = (&'static str, fn() -> Result<String>);
    let sections: [Section; 13] = [
        ("camera", camera),
        ("picture", picture),
        ("sizes", sizes),
        ("hosts", hosts),
        ("accuracy", accuracy),
        ("auto", auto),
        ("forms", forms),
        ("edits", edits),
        ("bounces", bounces),
        ("goals", goals),
        ("bake", bake),
        ("brdf", brdf::brdf),
        ("curved", curved),
    ];
    for (name, section) in sections {
        let new = with(&readme, name, &section()?)?;
        if new != readme {
            stale.push(name);
        }
        readme = new;
    }
    if check && !stale.is_empty() {
        eprintln!(
            "README.md is not what {RESULTS} says (section {}): run tools/readme",
            stale.join(", ")
        );
        return Ok(false);
    }
    if !check {
        files::write_text(path, &readme).map_err(|e| e.to_string())?;
    }
    if let Some(link) = broken(&readme) {
        eprintln!("README.md links to {link}, which is not there");
        return Ok(false);
    }
    Ok(true)
}

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let check = match args.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        [] => false,
        ["--check"] => true,
        _ => {
            eprintln!("usage: readme [--check]");
            return ExitCode::from(2);
        }
    };
    match run(check) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("readme: {error}");
            ExitCode::FAILURE
        }
    }
}

//! Puts the figures of benches/results into README.md and docs/*.md, between `<!-- begin NAME -->` and
//! `<!-- end NAME -->`: what stands there is made, never typed. Also checks README.md's size, the links of every
//! page, that docs/SUMMARY.md lists every page and that some page shows every picture. See `tools/readme`.
//!
//! `cargo run --example readme` writes the pages; with `-- --check` it changes nothing and fails where a page
//! is not what would be written.

#[path = "readme/brdf.rs"]
mod brdf;
#[path = "readme/features.rs"]
mod features;
#[path = "readme/figures.rs"]
mod figures;
#[path = "readme/pages.rs"]
mod pages;
#[path = "readme/splice.rs"]
mod splice;

use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

use figures::{Figures, RESULTS, made, percent, text, wrong};
use ridgelight_io as files;
use serde_json::Value;
use splice::with;

/// Or a sentence for the user.
type Result<T> = std::result::Result<T, String>;

/// A real field of more than a million samples; others lie beside it.
const ACCURACY: &str = "accuracy_N44W072.txt";

fn picture() -> Result<String> {
    let figures = Figures::read("picture")?;
    let of = |key| figures.number(&figures.all, key);
    let mut out = String::from(
        "![A mountain without shadows, as Ridgelight lights it, and its reference](docs/pictures/demo.png)\n\n",
    );
    let (azimuths, true_azimuths) = (of("azimuths")?, of("reference_azimuths")?);
    writeln!(
        out,
        "| without shadows | Ridgelight, {azimuths} azimuths | brute force, {true_azimuths} azimuths |"
    )
    .unwrap();
    writeln!(out, "|:-:|:-:|:-:|").unwrap();
    writeln!(out, "| | {:.1} ms | {:.1} ms |", of("ours_ms")?, of("reference_ms")?).unwrap();
    let (off, ours) = (of("off_error")?, of("ours_error")?);
    writeln!(
        out,
        "| error {} | error {} | the reference |",
        percent(Some(off)),
        percent(Some(ours))
    )
    .unwrap();
    writeln!(
        out,
        "\n{} × {} grid points (SRTM) under the bundled sky and a sun 10° high. Error: RMSE relative to the mean.",
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
    let mut out = String::from(
        "![A mountain range under a low sun, from a camera](pictures/terrain.png)\n\n",
    );
    writeln!(
        out,
        "Mt Washington and the Presidential Range, {} × {} grid points (SRTM), under the bundled sky and a low sun. \
         {} azimuths, {} bounce. Lit in {lit:.1} ms; drawn at {} × {} with {} MSAA samples in {drawn:.1} ms. \
         Coloured by height; no vertical exaggeration (`examples/terrain`).",
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
        "crates/capi/tests/c/host.c",
        "the shared and the static library, also under the address sanitizer",
    ),
    (
        "Rust, `wgpu`",
        "examples/wgpu/src/main.rs",
        "wgpu's device and textures; a wgpu pass samples the light",
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
        writeln!(out, "| [{name}](../{path}) | {}{own} | {what} |", code_lines(&program)).unwrap();
    }
    let tests = "Tests run each one and compare its bytes with the command line's, without a validation message \
                 (`tests/gpu/embedding/ash_host.rs`, `crates/capi/tests/c`, `tools/wgpu`).";
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
        "\nA whole frame under a uniform sky; memory of all images and buffers; RMSE of the light relative to its mean, \
         against the f64 oracle."
    )
    .unwrap();
    writeln!(out, "{}", figures.caption()?).unwrap();
    Ok(out)
}

fn forms() -> Result<String> {
    let figures = Figures::read("forms_1024")?;
    let mut out = String::from(
        "| form | azimuths | ms per azimuth | time over a scalar CPU sweep on all cores |\n|---|---|---|---|\n",
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
    let tables = tables
        .trim()
        .replace(" samples, ", " grid points, ")
        .replace("the angle is at most", "the angle error is at most")
        .replace("° off", "°")
        .replace("ms an azimuth and megasample", "ms per azimuth and million grid points");
    Ok(format!("{name}{}: {tables}\n", made(&path)?))
}

/// The last paragraph of examples/edits.
fn edits() -> Result<String> {
    let path = Path::new(RESULTS).join("edits.txt");
    let text = text(&path)?;
    let missing = || wrong(&path, "no summary", "the text of examples/edits");
    let summary = text.trim_end().rsplit_once("\n\n").ok_or_else(missing)?.1;
    // After the date: the device, the sizes.
    let device = text.lines().nth(1).and_then(|line| line.rsplit_once(": ")).ok_or_else(missing)?.0;
    let summary = summary
        .replace("all line samples swept", "all points on lines swept")
        .replace("of the samples lit again", "of the texels shaded again")
        .replace(
            "faster than everything, and each time the same bits",
            "faster than a whole frame, with the same bits",
        );
    Ok(format!("{summary}\n*{device}{}*\n", made(&path)?))
}

/// What bounces add to a frame, as `examples/bounce table` printed it.
fn bounces() -> Result<String> {
    let path = Path::new(RESULTS).join("bounce_table.txt");
    let text = text(&path)?;
    let table = text.split("\n\n").find(|part| part.starts_with("| engine | bounce azimuths |"));
    let table =
        table.ok_or_else(|| wrong(&path, "no table", "the text of examples/bounce table"))?;
    let table = with_head(
        &path,
        table,
        "| engine | bounce azimuths | MB | no bounces, ms | time of 1 | 2 | 3 bounces | third over first | error of the \
         indirect light, % | error of all light, % |",
    )?;
    let table = table
        .replace("| brute |", "| brute-force |")
        .replace("the paper, GTX 285", "NS09 table 1, GTX 285");
    let table = table.replace("| not told |", "| not stated |");
    Ok(format!("{table}\n\n*{}*\n", made(&path)?.trim_start_matches("; ")))
}

/// A table under another first line of as many cells.
fn with_head(path: &Path, table: &str, head: &str) -> Result<String> {
    let (old, rows) = table.split_once('\n').ok_or_else(|| wrong(path, "a line", "a table"))?;
    let cells = |line: &str| line.trim().matches('|').count();
    if cells(old) != cells(head) {
        let expected = format!("as many as here: {head}");
        return Err(wrong(path, &format!("the columns {old}"), &expected));
    }
    Ok(format!("{head}\n{rows}"))
}

/// How often `render --max-error` holds with bounces, as `examples/goals` counts it.
fn goals() -> Result<String> {
    let path = Path::new(RESULTS).join("goals.txt");
    let text = text(&path)?;
    let counted = text.trim_end().rsplit_once("\n\n").filter(|(_, last)| last.ends_with("refused"));
    let (_, counted) =
        counted.ok_or_else(|| wrong(&path, "no count", "the text of examples/goals"))?;
    let counted = counted.replace("chosen hold", "chosen settings meet the goal");
    let counted = counted.replace(" refused", " requests were refused");
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
        "Errors of 5, 2, 1, 0.5 and 0.2 % were requested for {} pairs of a field (its middle {}²) and lights. No \
         constant was fitted on these pairs. {held} of {chosen} choices meet the goal ({:.1} %). {} of them differ from \
         each other; {} are within the bound that they state. {} of {} requests were refused, {} of them although \
         settings that meet the goal had been drawn. The rival is the cheapest setting that truly meets the goal, of all \
         that a `trade` walk of {} s and the choices drew. Time over that of the rival: median {:.2}, 90th percentile \
         {:.2}, worst {:.2}; at most 1.3 in {} of {}.",
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
        "| map | channels | encoding | bytes | stated error | worst measured |\n|---|---|---|---|---|---|\n",
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
            let of_value = format!("{share:.1e} of the value");
            let most = match (most > 0.0, share > 0.0) {
                (true, true) => format!("{} + {of_value}", shown(most)),
                (false, true) => of_value,
                _ => shown(most),
            };
            stated.push(format!("{}: {most}", figures.word(bound, "of")?));
            worst.push(shown(number("worst")?));
        }
        let bytes = figures.number(row, "bytes")?;
        let each = word("each")?
            .replace("a sample", "a texel")
            .replace("an angle", "a direction")
            .replace("angle", "direction");
        writeln!(
            out,
            "| {} | {} | {} | {bytes} {each} | {} | {} |",
            word("kind")?,
            word("channels")?.replace("angles", "directions"),
            word("encoding")?,
            stated.join("; "),
            worst.join("; ")
        )
        .unwrap();
    }
    writeln!(
        out,
        "\nErrors of decoding a .ktx2 or .png. Worst measured: on the bundled mountain, {} times as steep, {} azimuths; for \
         maps of light on its middle {side}² texels, repeated (`examples/bake`).",
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
    let shown = |table: &str, head: &str| {
        // The last column is for what is refused.
        let rows = table.lines().filter(|row| !is_refused(row)).map(|row| {
            let row = row.strip_suffix('|').unwrap_or(row);
            &row[..=row.rfind('|').unwrap_or(0)]
        });
        let rows: Vec<&str> = rows.collect();
        if rows.len() < 3 { Err(missing()) } else { with_head(&path, &rows.join("\n"), head) }
    };
    let radius = |row: &str| row.split('|').nth(1).unwrap_or_default().trim().to_owned();
    let refused: Vec<String> = shadows.lines().filter(is_refused).map(radius).collect();
    Ok(format!(
        "{}\n\n{}\n\nThree V-shaped grooves, 16 by 8 cells each, bent across their length. Ground truth: rays against the bent \
         mesh ([all rows](../benches/results/curved.txt)). A radius above 0 widens the grooves. Errors of scattered light: \
         RMSE relative to the mean, %. Refused radii: {}.\n*{device}{}*\n",
        shown(shadows, SHADOW_HEAD)?,
        shown(light, LIGHT_HEAD)?,
        refused.join(", "),
        made(&path)?
    ))
}

const SHADOW_HEAD: &str = "| radius, cells | lit, % | wrongly lit, %: flat directions | adapted directions | predicted by \
                           the plan | flat ellipses | five ellipses | ellipses fitted at this radius |";
const LIGHT_HEAD: &str = "| radius, cells | scattered once, over flat | error: flat directions | rotated | rotated and \
                          reweighted | between three bases | predicted by the plan | up to 3 times, over flat | error: \
                          flat directions | rotated | rotated and reweighted | between three bases | device |";

type Section = (&'static str, fn() -> Result<String>);

/// Which page holds which sections.
const PAGES: [(&str, &[Section]); 7] = [
    ("README.md", &[("picture", picture), ("sizes", sizes), ("features", features::features)]),
    ("docs/getting-started.md", &[("camera", camera)]),
    ("docs/embedding.md", &[("hosts", hosts), ("edits", edits)]),
    ("docs/methods.md", &[("forms", forms)]),
    ("docs/accuracy.md", &[("accuracy", accuracy), ("bounces", bounces)]),
    ("docs/choosing-settings.md", &[("auto", auto), ("goals", goals)]),
    ("docs/baking.md", &[("brdf", brdf::brdf), ("bake", bake), ("curved", curved)]),
];

fn run(check: bool) -> Result<bool> {
    let mut is_right = true;
    for (page, sections) in PAGES {
        let path = Path::new(page);
        let mut all = text(path)?;
        let mut stale = Vec::new();
        for (name, section) in sections {
            let new = with(path, &all, name, &section()?)?;
            if new != all {
                stale.push(*name);
            }
            all = new;
        }
        if check && !stale.is_empty() {
            let stale = stale.join(", ");
            eprintln!("{page} is not what {RESULTS} says (section {stale}): run tools/readme");
            is_right = false;
        }
        if !check {
            files::write_text(path, &all).map_err(|e| e.to_string())?;
        }
    }
    for complaint in pages::complaints()? {
        eprintln!("{complaint}");
        is_right = false;
    }
    Ok(is_right)
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

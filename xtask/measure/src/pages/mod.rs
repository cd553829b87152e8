//! Puts the figures of benches/results into README.md and docs/*.md, between `<!-- begin NAME -->` and
//! `<!-- end NAME -->`. Also checks README.md's size, the links of every page, that docs/SUMMARY.md lists
//! every page and that some page shows every picture. See `tools/readme`.

mod features;
mod figures;
mod links;
mod performance;

use std::path::Path;

use figures::{Figures, RESULTS, cells, result, text, wrong};
use ridgelight_io as files;
use serde_json::Value;

use crate::common::Outcome;
use crate::common::args::Args;

/// Or a sentence for the user.
type Result<T> = std::result::Result<T, String>;

/// A real field of more than a million grid points; others lie beside it.
const ACCURACY: &str = "accuracy_N44W072.txt";

fn picture() -> Result<String> {
    let figures = Figures::read("picture")?;
    figures.fill(
        &figures.all,
        "![A mountain without shadows, as Ridgelight lights it, and its reference](docs/pictures/demo.png)\n\n\
         | without shadows | Ridgelight, {azimuths} azimuths | brute force, {reference_azimuths} azimuths |\n|:-:|:-:|:-:|\n\
         | | {ours_ms:1} ms | {reference_ms:1} ms |\n| error {off_error%2} % | error {ours_error%2} % | the reference |\n\n\
         {cols} × {rows} grid points (SRTM) under the bundled sky and a sun 10° high; [How fast](#how-fast) times \
         another scene. Error: RMSE relative to the mean.\n",
    )
}

fn camera() -> Result<String> {
    let figures = Figures::read("terrain")?;
    figures.fill(
        &figures.all,
        "![A mountain range under a low sun, from a camera](pictures/terrain.png)\n\n\
         Mt Washington and the Presidential Range, {field_cols} × {field_rows} grid points (SRTM), under the bundled sky and a \
         low sun. {azimuths} azimuths, {bounces} bounce. Lit in {lit_ms:1} ms; drawn at {cols} × {rows} with {samples} MSAA \
         samples in {drawn_ms:1} ms. Coloured by height; no vertical exaggeration (`cargo measure terrain`).\n", // MSAA
    )
}

/// Programs that an integrator would write, whole.
const HOSTS: [(&str, &str, &str); 6] = [
    ("Rust, `ash`", "examples/ash_host.rs", "the code above and an engine around it"),
    (
        "C, plain Vulkan",
        "crates/capi/tests/c/host.c",
        "the shared and the static library, also under the address sanitizer",
    ),
    (
        "C++, `vulkan.hpp`",
        "crates/capi/tests/c/host.cpp",
        "`ridgelight.hpp` and an allocator of its own; the static library, and the shared one under the address sanitizer; `tools/installed` also links both by CMake",
    ),
    (
        "Rust, `wgpu`",
        "hosts/ridgelight-wgpu/examples/wgpu_light.rs",
        "wgpu's device and textures, through the crate `ridgelight-wgpu`; a wgpu pass samples the light",
    ),
    (
        "Rust, `vulkano`",
        "hosts/vulkano/src/main.rs",
        "vulkano's device, images, buffer and command buffer",
    ),
    (
        "Rust, Bevy",
        "hosts/bevy_ridgelight/examples/dunes.rs",
        "a window with travelling dunes, through the crate `bevy_ridgelight`",
    ),
];

/// The line that begins a program's own engine.
const ENGINE: &str = "// What follows an engine has already.";

/// Lines of code: neither empty nor a comment alone.
fn code_lines(text: &str) -> usize {
    let is_comment = |line: &str| line.starts_with("//") || line.starts_with("/*");
    text.lines().map(str::trim).filter(|line| !line.is_empty() && !is_comment(line)).count()
}

fn hosts() -> Result<String> {
    let (body, made) = result("hosts.txt")?;
    let (about, table) = found("hosts.txt", body.split_once("\n\n"), "a text and a table")?;
    let mut out = String::from(
        "| host | lines of code | crates added | ms per frame, median (lowest to highest run) | what it is |\n|---|---|---|---|---|\n",
    );
    for (name, path, what) in HOSTS {
        let program = text(Path::new(path))?;
        let own = program.split_once(ENGINE);
        let own = own.map(|(own, _)| format!(", {} without the engine", code_lines(own)));
        let (lines, own) = (code_lines(&program), own.unwrap_or_default());
        let row = table.lines().map(cells).find(|row| row.first() == Some(&name));
        let row = row.filter(|row| row.len() == 4);
        let row = found("hosts.txt", row, &format!("a row of {name}"))?;
        let [added, ms, spread] = [row[1], row[2], row[3]];
        out += &format!(
            "| [{name}](../{path}) | {lines}{own} | {added} | {ms} ({spread}) | {what} |\n"
        );
    }
    Ok(out
        + &format!(
            "\nNo host needs to enable a device feature or an extension. \"Crates added\" counts Ridgelight and those of its dependencies that the host's API crate or engine does not already compile. For `ash` it counts all of them, `ash` included; so does the number of crates at the top of this page, at its own commit. C and C++ link the finished library and compile no crate. {about}\n\n*{}*\n",
            made.trim_start_matches("; ")
        )
        + "\nTests run all but the last and compare their bytes with the command line's, without a validation message \
           (`tests/gpu/embedding/ash_host.rs`, `crates/capi/tests/c`, `hosts/same_light`). `hosts/bevy_ridgelight/check` \
           runs the Bevy example, and tests that compare the plugin's bytes with the core's.\n")
}

fn package() -> Result<String> {
    let (body, made) = result("package.txt")?;
    Ok(format!("{} (`tools/bench --only package`{made}).\n", body.trim_end()))
}

/// Rounds to three significant digits and at most one decimal. Confidence intervals of times are wider than that.
fn three(value: f64) -> String {
    let decimals = if value < 100.0 { 1 } else { 0 };
    let scale = 10_f64.powi(value.log10().floor() as i32 - 2);
    format!("{:.decimals$}", (value / scale).round() * scale)
}

fn sizes() -> Result<String> {
    let figures = Figures::read("sizes")?;
    let distinct = |key: &str| {
        let mut all: Vec<u64> = figures.rows().iter().filter_map(|r| r[key].as_u64()).collect();
        all.sort_unstable();
        all.dedup();
        all
    };
    let (sides, counts) = (distinct("cols"), distinct("azimuths"));
    let heads: String = counts.iter().map(|m| format!(" {m} azimuths |")).collect();
    let mut out = format!("| field |{heads}\n|---|{}\n", "---|".repeat(counts.len()));
    let mut widest = 0.0;
    for side in &sides {
        out += &format!("| {side}² |");
        for count in &counts {
            let is = |row: &&Value| row["cols"] == *side && row["azimuths"] == *count;
            let Some(row) = figures.rows().iter().find(is) else {
                out += " not measured |";
                continue;
            };
            let settings = &row["settings"];
            let mb = figures.number(settings, "device_bytes")? * 1e-6;
            let ms = figures.number(row, "median_ns")? * 1e-6;
            let error = settings["light_error"].as_f64().map(|v| format!("{:.2} %", 100.0 * v));
            let error = error.as_deref().unwrap_or("error not measured");
            if let [Some(low), Some(high)] =
                ["median_low_ns", "median_high_ns"].map(|key| row[key].as_f64())
            {
                widest = f64::max(widest, 1e-6 * (high - low) / ms);
            }
            out += &format!(" {} ms, {} MB, {error} |", three(ms), three(mb));
        }
        out.push('\n');
    }
    let about = format!(
        "Medians of whole frames of a fractal under a uniform sky (95 % intervals up to {:.0} % wide); memory of images and \
         buffers; RMSE over mean light, against the f64 oracle.",
        100.0 * widest
    );
    Ok(format!("{out}\n{about}\n{}", figures.caption()?))
}

/// From the kit's report.
fn gpu() -> Result<String> {
    let path = Path::new(RESULTS).join("nvidia_h200.md");
    let report = text(&path)?;
    let sizes = report.split("## Sizes").nth(1).unwrap_or_default();
    let commit = report.split(", commit ").nth(1).and_then(|rest| rest.get(..8));
    let commit =
        commit.ok_or_else(|| wrong(&path, "no commit", "one, as tools/gpu-kit writes it"))?;
    let frame_ms = |side: &str| {
        let rows = sizes.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
        let found = rows.filter(|words| words.len() == 8).find(|w| w[..2] == [side, "64"]);
        found.map(|words| words[2].to_owned()).ok_or_else(|| {
            wrong(
                &path,
                &format!("no frame of {side}²"),
                "one of 64 azimuths, as tools/gpu-kit writes it",
            )
        })
    };
    Ok(format!(
        "NVIDIA [H200](benches/results/nvidia_h200.md), 64 azimuths, `--fuse aimed-nearest` (not the default): {} ms at 256², {} ms \
         at 1024², {} ms at 4096² (commit {commit}).\n",
        frame_ms("256")?,
        frame_ms("1024")?,
        frame_ms("4096")?
    ))
}

fn forms() -> Result<String> {
    let figures = Figures::read("forms_1024")?;
    let mut out = String::from(
        "| form | azimuths | ms per azimuth | time over a scalar CPU sweep on all cores |\n|---|---|---|---|\n",
    );
    let label = |row: &Value| -> Result<String> {
        let (pass, part) = (figures.word(row, "pass")?, row["part"].as_str().unwrap_or_default());
        Ok(format!("{pass} {part}").trim_end().to_owned())
    };
    let an_azimuth = |row: &Value| -> Result<f64> {
        Ok(figures.number(row, "median_ns")? * 1e-6 / figures.number(row, "azimuths")?)
    };
    for row in figures.rows() {
        let Some(beside) = row["settings"]["scalar_beside"].as_str() else { continue };
        let is_beside = |row: &&Value| label(row).is_ok_and(|label| label == beside);
        let scalar = figures.rows().iter().find(is_beside);
        let missing = || wrong(&figures.path, &format!("no row {beside}"), "the scalar's row");
        let scalar = an_azimuth(scalar.ok_or_else(missing)?)?;
        let (ms, azimuths) = (an_azimuth(row)?, figures.number(row, "azimuths")?);
        let pass = label(row)?;
        out += &format!("| {pass} | {azimuths} | {ms:.3} | {:.3} |\n", ms / scalar);
    }
    Ok(format!("{out}\n{}", figures.caption()?))
}

fn found<T>(name: &str, part: Option<T>, expected: &str) -> Result<T> {
    part.ok_or_else(|| wrong(&Path::new(RESULTS).join(name), "another text", expected))
}

/// The tables of [`ACCURACY`], as `cargo measure accuracy` printed them.
fn accuracy() -> Result<String> {
    let (tables, made) = result(ACCURACY)?;
    let is_right = tables.contains(" grid points, ") && tables.contains("\n| ");
    found(ACCURACY, is_right.then_some(()), "the text of cargo measure accuracy")?;
    let name = ACCURACY.trim_start_matches("accuracy_").trim_end_matches(".txt");
    Ok(format!("{name}{made}: {}\n", tables.trim()))
}

/// The last paragraph of examples/edits.
fn edits() -> Result<String> {
    let (body, made) = result("edits.txt")?;
    let expected = "the text of examples/edits";
    let (_, summary) = found("edits.txt", body.trim_end().rsplit_once("\n\n"), expected)?;
    let device = body.lines().next().and_then(|line| line.rsplit_once(": "));
    let (device, _) = found("edits.txt", device, expected)?;
    Ok(format!("{summary}\n*{device}{made}*\n"))
}

/// What bounces add to a frame, as `cargo measure bounce-table` printed it.
fn bounces() -> Result<String> {
    let (body, made) = result("bounce_table.txt")?;
    let table = body.split("\n\n").find(|part| part.starts_with("| engine | bounce azimuths |"));
    let head = "| engine | bounce azimuths | MB | no bounces, ms | time of 1 | 2 | 3 bounces | third over first | error of the \
                indirect light, % | error of all light, % |";
    let table = with_head("bounce_table.txt", table.unwrap_or_default(), head)?;
    Ok(format!("{table}\n\n*{}*\n", made.trim_start_matches("; ")))
}

/// Suns by default and by hull sweeps over one border, as `cargo measure suns` printed it.
fn suns() -> Result<String> {
    let (body, made) = result("suns.txt")?;
    let table = body.split("\n\n").find(|part| part.starts_with("| field | border |"));
    let table = found("suns.txt", table, "the table of cargo measure suns")?;
    let device = body.lines().next().and_then(|line| line.split_once(": "));
    let (device, _) = found("suns.txt", device, "a device in its first line")?;
    let is_shown = |line: &&str| !line.contains("| open |") && !line.contains("| periodic |");
    let rows: Vec<&str> = table.lines().filter(is_shown).collect();
    Ok(format!("{}\n\n*{device}{made}*\n", rows.join("\n")))
}

/// What the default reaches, as `cargo measure defaults` printed it last.
fn defaults() -> Result<String> {
    let (body, made) = result("defaults.txt")?;
    let table = body.split("\n\n").find(|part| part.starts_with("| light | ground |"));
    let table = found("defaults.txt", table, "the summary of cargo measure defaults")?;
    let device = body.lines().next().and_then(|line| line.split_once(": "));
    let (device, _) = found("defaults.txt", device, "a device in its first line")?;
    Ok(format!("{}\n\n*{device}{made}*\n", table.trim_end()))
}

/// The frontiers of the kept runs of `ridgelight trade`, without rows whose error is less than 10 % below that of the row above.
fn trade() -> Result<String> {
    const SHOWN: f64 = 0.9;
    const RUNS: [(&str, &str); 3] = [
        (
            "mountain_sky",
            "Mt Washington, 256², under a uniform sky; all light is compared with brute force",
        ),
        (
            "mountain_sun",
            "Mt Rainier, under a sun 0.53° wide and 25° high; compared with a path-traced reference",
        ),
        ("moss_windows", "Moss under the windows of a room; compared with a path-traced reference"),
    ];
    let mut out = String::new();
    for (run, scene) in RUNS {
        let name = format!("trade_{run}.txt");
        let (body, made) = result(&name)?;
        let mut least = f64::INFINITY;
        let row = |line: &str| {
            let mut words = line.split_whitespace();
            let [time, unit] = [words.next()?, words.next()?];
            let rest = words.collect::<Vec<_>>().join(" ");
            let (error, settings) = rest.split_once(" % ")?;
            let value: f64 = error.trim_start_matches("≤ ").parse().ok()?;
            let is_shown = value < SHOWN * least;
            least = if is_shown { value } else { least };
            let settings = settings.trim_end_matches(" <- recommended");
            is_shown.then(|| format!("| {time} {unit} | {error} % | `{settings}` |\n"))
        };
        let rows: String = body.lines().filter_map(row).collect();
        found(&name, (!rows.is_empty()).then_some(()), "the frontier of ridgelight trade")?;
        out += &format!(
            "{scene} ([all rows](../benches/results/trade_{run}.csv)):\n\n| time | error | settings |\n|---|---|---|\n{rows}\n*llvmpipe{made}*\n\n"
        );
    }
    Ok(out.trim_end().to_owned() + "\n")
}

/// Errors of Fourier series of horizons, as `cargo measure fourier` printed it.
fn fourier() -> Result<String> {
    let (body, made) = result("fourier.txt")?;
    let (device, _) = found("fourier.txt", body.split_once(": "), "a device in its first line")?;
    let is_shown =
        |line: &&str| line.starts_with('|') && !line.contains("| 8 |") && !line.contains("| 32 |");
    let rows: Vec<&str> = body.lines().filter(is_shown).collect();
    Ok(format!("{}\n\n*{device}{made}*\n", rows.join("\n")))
}

/// A table under another first line of as many cells.
fn with_head(name: &str, table: &str, head: &str) -> Result<String> {
    let parts = table.split_once('\n').filter(|(old, _)| cells(old).len() == cells(head).len());
    let (_, rows) = found(name, parts, &format!("a table with as many columns as {head}"))?;
    Ok(format!("{head}\n{rows}"))
}

/// How often `render --max-error` holds with bounces, as `cargo measure goals` counts it.
fn goals() -> Result<String> {
    let (body, made) = result("goals.txt")?;
    let counted = body.trim_end().rsplit_once("\n\n").map(|(_, last)| last);
    let counted = counted.filter(|last| last.ends_with("refused"));
    let counted = found("goals.txt", counted, "the text of cargo measure goals")?;
    Ok(format!("{counted}.\n\n*{}*\n", made.trim_start_matches("; ")))
}

/// What `cargo measure auto` found of `render --max-error`.
fn auto() -> Result<String> {
    let figures = Figures::read("auto")?;
    let mut of = figures.all.clone();
    for (key, value) in figures.all["summary"].as_object().into_iter().flatten() {
        of[key] = value.clone();
    }
    of["share"] = (figures.number(&of, "held")? / figures.number(&of, "chosen")?).into();
    let choice =
        |row: &Value| Some((row["scene"].to_string(), row["settings"].as_str()?.to_owned()));
    let different: std::collections::BTreeSet<_> =
        figures.rows().iter().filter_map(choice).collect();
    of["different"] = different.len().into();
    let refused = match figures.number(&of, "refused")? {
        0.0 => "None of the {asked} requests was refused.",
        _ => {
            "{refused} of {asked} requests were refused, {refused_though_found} of them although settings that meet the goal \
             had been drawn."
        }
    };
    let text = [
        "Errors of 5, 2, 1, 0.5 and 0.2 % were requested for {pairs} pairs of a field (its middle {side}²) and lights. The \
         model of errors was not fitted on these pairs. {held} of {chosen} choices meet the goal ({share%1} %). {different} of them differ from \
         each other; {within_stated_bound} are within the bound that they state. ",
        refused,
        " Each choice is compared with the fastest setting that meets the goal, of all that a `trade` search of \
         {trade_seconds} s and the choices drew. Time of the choice over that setting's: median {ratio_median:2}, 90th percentile \
         {ratio_90:2}, worst {ratio_worst:2}; at most 1.3 in {within_1.3} of {ratios}.\n\n",
    ];
    figures.fill(&of, &text.concat())
}

/// Geometry against its aggregates, of brdf.txt: mean radiance and errors for each field and light.
fn brdf() -> Result<String> {
    let (body, made) = result("brdf.txt")?;
    let mut out = String::from(
        "| field | light | mean radiance of the geometry | error of its triangles, % | of the table, % | of 8 factors, % | \
         reflected, at most % | not reciprocal, % | table between its directions, % | 8 factors between them, % |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
    );
    let (mut name, mut first) = ("", Vec::new());
    for row in body.lines().filter(|line| line.starts_with("| ")).map(cells) {
        match (row[0], row.len()) {
            ("direct" | "all", 8) => {
                let own = first.iter().find(|own: &&Vec<&str>| own[0] == row[0]);
                let own = found("brdf.txt", own, "a table before its pairs")?;
                let all = [row[1], row[2], row[4], row[6], own[3], own[1], own[5], own[9]];
                out += &format!("| {name} | {} | {} |\n", row[0], all.join(" | "));
            }
            ("direct" | "all", 14) => first.push(row),
            ("direct" | "all", _) => found("brdf.txt", None, "rows of 8 or 14 cells")?,
            (head, _) if head.ends_with("pairs") => {}
            (head, _) => (name, first) = (head, Vec::new()),
        }
    }
    found("brdf.txt", first.first(), "rows of pairs")?;
    let device = body.lines().next().unwrap_or_default();
    Ok(out + &format!("\n50 pairs of light and view (`cargo measure brdf`). {device}{made}.\n"))
}

/// The encoding of each map of `bake` and its error; angles in degrees.
fn bake() -> Result<String> {
    let figures = Figures::read("bake")?;
    let mut out = String::from(
        "| map | channels | encoding | bytes | stated error | worst measured |\n|---|---|---|---|---|---|\n",
    );
    for row in figures.rows() {
        let word = |key| figures.word(row, key);
        let (mut stated, mut worst) = (Vec::new(), Vec::new());
        for bound in row["bounds"].as_array().map_or(&[][..], Vec::as_slice) {
            let is_angle = figures.word(bound, "unit")? == "rad";
            let shown = |v: f64| match is_angle {
                _ if v == 0.0 => "0".to_owned(),
                true => format!("{:.4}°", v.to_degrees()),
                false => format!("{v:.2e}"),
            };
            let [most, share, measured] =
                figures.numbers(bound, "at_most and_of_the_value worst")?;
            let of_value = format!("{share:.1e} of the value");
            let most = match (most > 0.0, share > 0.0) {
                (true, true) => format!("{} + {of_value}", shown(most)),
                (false, true) => of_value,
                _ => shown(most),
            };
            stated.push(format!("{}: {most}", figures.word(bound, "of")?));
            worst.push(shown(measured));
        }
        out += &format!(
            "| {} | {} | {} | {} {} | {} | {} |\n",
            word("kind")?,
            word("channels")?,
            word("encoding")?,
            figures.number(row, "bytes")?,
            figures.now(word("each")?),
            stated.join("; "),
            worst.join("; ")
        );
    }
    figures.fill(
        &figures.all,
        &format!(
            "{out}\nErrors of decoding a .ktx2 or .png. Worst measured: on the bundled mountain, {{steeper}} times as steep, \
             {{azimuths}} azimuths; for maps of light on its middle {{lit_side}}² texels, repeated (`cargo measure bake`).\n"
        ),
    )
}

/// The table of `tools/mitsuba/compare`.
fn mitsuba() -> Result<String> {
    let (body, made) = result("mitsuba.txt")?;
    let is_whole = body.starts_with("| field | light | default, error % |");
    found("mitsuba.txt", is_whole.then_some(()), "the table of tools/mitsuba/compare")?;
    Ok(format!("{}\n\n*{}*\n", body.trim_end(), made.trim_start_matches("; ")))
}

/// What `cargo measure curved` found: the bases that are not refused.
fn curved() -> Result<String> {
    let (body, made) = result("curved.txt")?;
    let is_refused = |row: &&str| row.ends_with(" refused |");
    let tables: Vec<&str> = body.split("\n\n").filter(|part| part.starts_with('|')).collect();
    let two = <[&str; 2]>::try_from(tables).ok();
    let [shadows, light] = found("curved.txt", two, "the text of cargo measure curved")?;
    let shown = |table: &str, head: &str| {
        // The last column is for what is refused.
        let rows = table.lines().filter(|row| !is_refused(row)).map(|row| {
            let row = row.strip_suffix('|').unwrap_or(row);
            &row[..=row.rfind('|').unwrap_or(0)]
        });
        with_head("curved.txt", &rows.collect::<Vec<_>>().join("\n"), head)
    };
    let refused: Vec<&str> = shadows.lines().filter(is_refused).map(|row| cells(row)[0]).collect();
    Ok(format!(
        "{}\n\n{}\n\nThree V-shaped grooves, 16 by 8 cells each, bent across their length. Ground truth: rays against the bent \
         mesh ([all rows](../benches/results/curved.txt)). A radius above 0 widens the grooves. Errors of scattered light: \
         RMSE relative to the mean, %. Refused radii: {}.\n*{}{made}*\n",
        shown(shadows, SHADOW_HEAD)?,
        shown(light, LIGHT_HEAD)?,
        refused.join(", "),
        body.lines().next().unwrap_or_default()
    ))
}

const SHADOW_HEAD: &str = "| radius, cells | lit, % | wrongly lit, %: flat directions | adapted directions | predicted by \
                           the plan | flat ellipses | five ellipses | ellipses fitted at this radius |";
const LIGHT_HEAD: &str = "| radius, cells | scattered once, over flat | error: flat directions | rotated | rotated and \
                          reweighted | between three bases | predicted by the plan | up to 3 times, over flat | error: \
                          flat directions | rotated | rotated and reweighted | between three bases | device |";

type Section = (&'static str, fn() -> Result<String>);

/// Which page holds which sections.
const PAGES: [(&str, &[Section]); 9] = [
    (
        "README.md",
        &[("picture", picture), ("sizes", sizes), ("gpu", gpu), ("features", features::features)],
    ),
    ("docs/getting-started.md", &[("camera", camera)]),
    ("docs/embedding.md", &[("package", package), ("hosts", hosts), ("edits", edits)]),
    ("docs/embedding/bevy.md", &[("fourier", fourier)]),
    ("docs/methods.md", &[("forms", forms)]),
    (
        "docs/accuracy.md",
        &[
            ("mitsuba", mitsuba),
            ("accuracy", accuracy),
            ("defaults", defaults),
            ("suns", suns),
            ("bounces", bounces),
        ],
    ),
    ("docs/choosing-settings.md", &[("auto", auto), ("goals", goals), ("trade", trade)]),
    ("docs/measured/performance.md", &[("performance", performance::performance)]),
    ("docs/baking.md", &[("brdf", brdf), ("bake", bake), ("curved", curved)]),
];

/// `page` with the text between the marks of `name` replaced.
pub fn with(path: &Path, page: &str, name: &str, new: &str) -> Result<String> {
    let (begin, end) = (format!("<!-- begin {name} -->\n"), format!("<!-- end {name} -->"));
    let parts = page.split_once(&begin).and_then(|(before, rest)| {
        let (_, after) = rest.split_once(&end)?;
        (!after.contains(&begin)).then_some((before, after))
    });
    let expected = format!("{} and {end}, once each", begin.trim_end());
    let (before, after) = parts.ok_or_else(|| wrong(path, "no marks", &expected))?;
    Ok(format!("{before}{begin}\n{new}\n{end}{after}"))
}

pub fn run(mut args: Args) -> Outcome {
    let check = args.has("--check");
    args.end()?;
    let mut complaints = Vec::new();
    for (page, sections) in PAGES {
        let path = Path::new(page);
        let mut all = text(path)?;
        for (name, section) in sections {
            let new = with(path, &all, name, &section()?)?;
            if check && new != all {
                complaints.push(format!(
                    "{page} is not what {RESULTS} says (section {name}): run tools/readme"
                ));
            }
            all = new;
        }
        if !check {
            files::write_text(path, &all)?;
        }
    }
    complaints.extend(links::complaints()?);
    if complaints.is_empty() { Ok(()) } else { Err(complaints.join("\n").into()) }
}

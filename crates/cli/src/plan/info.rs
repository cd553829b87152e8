//! `info`: what a file of heights holds, and what common jobs on it need.

use ridgelight::Result;
use ridgelight::plan::{self, Limits, Picture};
use ridgelight::scene::{HeightField, Lights, Quality, Scene, Surface};
use ridgelight_io as files;
use ridgelight_io::FieldFile;
use serde_json::{Value, json};

use std::path::Path;

use crate::args::{FieldArgs, InfoArgs};
use crate::plan::start::{self, Start};
use crate::setup::{self, Outcome};

/// Slopes beyond this are counted.
const STEEP_DEG: f64 = 45.0;

/// The name of `--json` that stands for standard output.
const STANDARD_OUTPUT: &str = "-";

pub fn run(args: &InfoArgs) -> Result<Outcome> {
    let json = args.global.json.as_deref();
    let is_printed = json == Some(Path::new(STANDARD_OUTPUT));
    let file = json.filter(|_| !is_printed);
    setup::check_outputs(&[("--json", file, &["json"])], &args.input.paths())?;
    let read = setup::read(&args.input.path, &args.surface)?;
    let facts = facts(&read)?;
    if let Some(file) = file {
        files::write_json(file, &facts)?;
    }
    if is_printed {
        crate::say!("{facts:#}");
    }
    if !args.global.quiet && !is_printed {
        say(args, &facts);
        say_start(args, &read)?;
    } else {
        let path = args.input.names();
        read.warnings
            .iter()
            .for_each(|text| setup::warning(&format!("{path}: {}", setup::flags_in(text))));
    }
    Ok(Outcome::Done)
}

/// A number; NaN and infinities, which JSON lacks, as text.
fn any_number(number: f64) -> Value {
    if number.is_finite() { json!(number) } else { json!(number.to_string()) }
}

fn facts(read: &FieldFile) -> Result<Value> {
    let FieldFile { field, georeference, stored, notes, warnings } = read;
    let at = georeference.as_ref();
    let in_flags =
        |all: &[String]| all.iter().map(|text| setup::flags_in(text)).collect::<Vec<_>>();
    let (rows, cols) = (field.rows(), field.cols());
    let [cell_x, cell_y] = field.cell_m();
    let is_void = |i: usize| field.voids().is_some_and(|v| v[i]);
    let heights = field.heights_m().iter().enumerate().filter(|(i, _)| !is_void(*i));
    let [lowest, highest] =
        heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (_, h)| {
            let height = field.base_m() + f64::from(*h);
            [low.min(height), high.max(height)]
        });
    let slopes = (0..rows * cols).filter(|i| !is_void(*i));
    let [count, steep] = slopes.fold([0_u64; 2], |[count, steep], i| {
        let is_steep = setup::tint::slope_deg(field, i) > STEEP_DEG;
        [count + 1, steep + u64::from(is_steep)]
    });
    let voids = (rows * cols) as u64 - count;
    let memory = jobs(field).map(|(name, bytes)| (name.to_owned(), Value::from(bytes)));
    let extent = at.map(|at| at.extent(rows, cols));
    Ok(json!({
        "rows": rows,
        "cols": cols,
        "crs": at.and_then(|at| at.keys.crs()),
        "cell_m": [cell_x, cell_y],
        "size_m": [cell_x * cols as f64, cell_y * rows as f64],
        "extent": extent,
        "data_type": stored.data_type,
        "nodata": stored.nodata.map(any_number),
        "scale": stored.scale[0],
        "offset": stored.scale[1],
        "vertical_unit_m": stored.unit_m,
        "heights_m": [lowest, highest],
        "void_share": voids as f64 / (rows * cols) as f64,
        "steep_share": steep as f64 / count.max(1) as f64,
        "device_bytes": serde_json::Map::from_iter(memory),
        "warnings": in_flags(warnings),
        "notes": in_flags(notes),
    }))
}

/// Device memory of common jobs, as the planner counts it for a device without limits. None of a field that is too large for
/// any.
fn jobs(field: &HeightField) -> [(&'static str, Option<u64>); 3] {
    let sky = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let scene = Scene { field: field.clone(), surface: Surface::default(), lights: sky };
    let limits = Limits::boundless(true, 1 << 50);
    let wanted = Picture { sky_view: true, still: true, ..Picture::default() };
    let sky_view = plan::picture(&scene, &Quality::default(), &limits, wanted).ok();
    let render = |count| start::bytes_of(field, count, &limits).ok();
    [
        ("render", render(0)),
        ("sky_view", sky_view.map(|plan| plan.bytes())),
        ("render_bounces_1", render(1)),
    ]
}

fn say(args: &InfoArgs, facts: &Value) {
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let pair = |name: &str| [number(&facts[name][0]), number(&facts[name][1])];
    let path = args.input.names();
    let [rows, cols] = ["rows", "cols"].map(|name| facts[name].as_u64().unwrap_or(0));
    crate::say!("{path}: {cols} x {rows} grid points");
    let line = |name: &str, text: String| crate::say!("  {name:<10} {text}");
    line("CRS", facts["crs"].as_str().unwrap_or("not stated").to_owned());
    let [x, y] = pair("cell_m");
    line("cell", format!("{x:.6} x {y:.6} m"));
    let [width, height] = pair("size_m");
    line("size", format!("{:.3} x {:.3} km", width / 1e3, height / 1e3));
    if let Some(extent) = facts["extent"].as_array() {
        let [west, south, east, north] = [0, 1, 2, 3].map(|i| number(&extent[i]));
        line("extent", format!("{west} to {east} east, {south} to {north} north"));
    }
    line("values", values(facts));
    let [lowest, highest] = pair("heights_m");
    line("heights", format!("{lowest:.3} to {highest:.3} m"));
    line("voids", format!("{:.3} %", 100.0 * number(&facts["void_share"])));
    line("steep", format!("{:.3} % beyond 45 degrees", 100.0 * number(&facts["steep_share"])));
    let memory = |name: &str| match facts["device_bytes"][name].as_u64() {
        Some(bytes) => format!("{:.0} MiB", bytes as f64 / f64::from(1 << 20)),
        None => "too large for any device".to_owned(),
    };
    line(
        "memory",
        format!(
            "render --bounces 0 {}, render --bounces 1 {}, sky view {}",
            memory("render"),
            memory("render_bounces_1"),
            memory("sky_view")
        ),
    );
    for (name, key) in [("warning", "warnings"), ("note", "notes")] {
        for text in facts[key].as_array().into_iter().flatten() {
            line(name, text.as_str().unwrap_or_default().to_owned());
        }
    }
}

/// How the file stores its heights: "int16, no data -32768, unit 1 m".
fn values(facts: &Value) -> String {
    let mut text = facts["data_type"].as_str().unwrap_or_default().to_owned();
    match &facts["nodata"] {
        Value::Null => {}
        Value::String(nodata) => text += &format!(", no data {nodata}"),
        nodata => text += &format!(", no data {}", nodata.as_f64().unwrap_or(f64::NAN)),
    }
    let [scale, offset] = ["scale", "offset"].map(|name| facts[name].as_f64().unwrap_or(f64::NAN));
    if [scale, offset] != [1.0, 0.0] {
        text += &format!(", scale {scale}, offset {offset}");
    }
    match facts["vertical_unit_m"].as_f64() {
        Some(unit_m) => text + &format!(", unit {unit_m} m"),
        None => text + ", unit not stated",
    }
}

/// Prints a command that the present device can run, and why it is not the plainest one. Where the file has no cell size, the command
/// has a placeholder, which a sentence explains.
fn say_start(args: &InfoArgs, read: &FieldFile) -> Result<()> {
    let (device, limits) = super::limits(&args.global)?;
    let is_given = args.global.memory_budget.is_some();
    let (start, why) = start::start(&read.field, read.georeference.as_ref(), &limits, is_given);
    if let Some(why) = why {
        let why = setup::in_flags(why);
        crate::say!("  {:<10} {device} cannot render the whole field by default: {why}", "note");
    }
    if start == Start::Nothing {
        crate::say!(
            "Reduce the grid first: gdal_translate -outsize 25% 25% -r average INPUT OUTPUT.tif"
        );
        return Ok(());
    }
    let mut command = "Start with: ridgelight render".to_owned();
    for path in &args.input.path {
        command += &format!(" {}", setup::terminal::quoted(&path.display().to_string()));
    }
    let FieldArgs { cell, z_scale, nodata, band, bbox, .. } = args.surface;
    let unknown = (!read.stored.has_cell_size).then(|| "X,Y".to_owned());
    let (bbox, budget) = match (start, args.global.memory_budget) {
        (Start::Part(part), bytes) => (Some(part), bytes.map(|bytes| bytes.to_string())),
        (Start::Budget(gib), _) => (bbox, Some(format!("{gib}GiB"))),
        (_, bytes) => (bbox, bytes.map(|bytes| bytes.to_string())),
    };
    for (flag, value) in [
        ("cell", cell.map(|cell| cell.map(|side| side.to_string()).join(",")).or(unknown)),
        ("z-scale", z_scale.map(|factor| factor.to_string())),
        ("nodata", nodata.map(|height| height.to_string())),
        ("band", band.map(|number| number.to_string())),
        ("bbox", bbox.map(|bbox| bbox.map(|side| side.to_string()).join(","))),
        ("device", args.global.device.as_deref().map(setup::terminal::quoted)),
        ("memory-budget", budget),
    ] {
        command += &value.map_or_else(String::new, |value| format!(" --{flag} {value}"));
    }
    crate::say!("{command} -o picture.png");
    if cell.is_none() && !read.stored.has_cell_size {
        crate::say!("where X,Y is the grid spacing in metres, west to east and south to north.");
    }
    Ok(())
}

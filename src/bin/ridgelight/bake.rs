//! `bake`: maps for engines, of a field that does not move.

mod kinds;
mod map;

use std::io::Write as _;
use std::path::{Path, PathBuf};

use ridgelight::bake::{Encoding, Ray, encoding_named, normals};
use ridgelight::gpu::{Headless, Timing};
use ridgelight::plan::{self, Limits, Plan};
use ridgelight::scene::{Border, Directions, HeightField, Lines, Method, Quality};
use ridgelight::{Error, Result, files};
use serde_json::json;

use crate::args::{BakeArgs, MethodName};
use crate::setup::{self, Outcome};
use crate::{horizon, idle};
pub use kinds::Kind;
use kinds::{Asked, KINDS, Looked, Making, OfDirections, Source};
pub use map::Format;
use map::{MapFiles, Wanted};

/// What the folder's contents are told by; written last.
const SHEET: &str = "bake.json";

/// A kind and how it is to be packed.
#[derive(Clone, Copy)]
pub struct Packing {
    kind: &'static Kind,
    encoding: &'static Encoding,
}

/// What `--what` takes.
pub fn kind_named(name: &str) -> std::result::Result<&'static Kind, String> {
    KINDS.into_iter().find(|kind| kind.name == name).ok_or_else(|| {
        let all: Vec<&str> = KINDS.iter().map(|kind| kind.name).collect();
        format!("expected one of {}", all.join(", "))
    })
}

/// What `--encoding` takes: `KIND=ENCODING`.
pub fn packing(text: &str) -> std::result::Result<Packing, String> {
    let (kind, name) = text.split_once('=').ok_or("expected KIND=ENCODING")?;
    let kind = kind_named(kind)?;
    let encoding = encoding_named(kind.encodings, name).ok_or_else(|| {
        let all: Vec<&str> = kind.encodings.iter().map(|e| e.name).collect();
        format!("{} is packed as {}", kind.name, all.join(", "))
    })?;
    Ok(Packing { kind, encoding })
}

/// The list below the flags.
pub fn help() -> String {
    let mut text = String::from("Kinds, and how each can be packed:\n");
    for kind in KINDS {
        let names: Vec<&str> = kind.encodings.iter().map(|e| e.name).collect();
        let formats: Vec<&str> = kind.formats.iter().map(|f| f.name()).collect();
        text += &format!(
            "  {}: {}\n      {}; as {} by default\n",
            kind.name,
            kind.about,
            names.join(", "),
            formats.join(" and ")
        );
    }
    text += "\n\
Each .ktx2 is one level, an array where there are several layers (a horizon's azimuth, four coefficients), its first row \
in the north. --method auto is brute here, exact in every azimuth; --method sweep is faster, and its \
horizons are near. Vulkan does not ask devices to sample unorm16 and snorm16: 8 bits, f16 and f32 all devices sample.

Examples:
  ridgelight bake heights.png --cell 30 --what sky-view,bent-normal -o baked
  ridgelight bake dem.tif --what horizon --encoding horizon=unorm16-sin -o baked
  ridgelight bake moss.png --what ellipse --directions 512 -o baked
  ridgelight bake moss.png --border periodic --what sh-transfer --sh-order 3 -o baked
  ridgelight bake dem.tif --what horizon,sky-view,visible-sky --plan -o baked";
    text
}

/// What is asked for, each kind once.
fn wanted(args: &BakeArgs) -> Result<Vec<Wanted>> {
    let mut all: Vec<Wanted> = Vec::new();
    for kind in &args.what {
        if all.iter().any(|w| w.kind.name == kind.name) {
            return Err(Error::setting("--what", format!("{} twice", kind.name), "each kind once"));
        }
        let mut packings = args.encoding.iter().filter(|p| p.kind.name == kind.name);
        let encoding = packings.next().map_or(&kind.encodings[0], |p| p.encoding);
        if packings.next().is_some() {
            let found = format!("two of {}", kind.name);
            return Err(Error::setting("--encoding", found, "one of each kind"));
        }
        let mut formats = if args.format.is_empty() { kind.formats } else { &args.format }.to_vec();
        let takes = |format: &Format| format.takes(encoding);
        if args.format.is_empty() {
            formats.retain(takes);
        } else if let Some(format) = formats.iter().find(|f| !takes(f)) {
            return Err(Error::setting(
                "--format",
                format!("{} with {} of {}", format.name(), encoding.name, kind.name),
                "exr, npy or ktx2: a picture holds up to three components of 8 or 16 bits",
            ));
        }
        if let Some(twice) = (1..formats.len()).find(|i| formats[..*i].contains(&formats[*i])) {
            let found = format!("{} twice", formats[twice].name());
            return Err(Error::setting("--format", found, "each once"));
        }
        all.push(Wanted { kind, encoding, formats });
    }
    if let Some(idle) =
        args.encoding.iter().find(|p| all.iter().all(|w| w.kind.name != p.kind.name))
    {
        let found = format!("one of {}", idle.kind.name);
        return Err(Error::setting("--encoding", found, "only kinds of --what"));
    }
    Ok(all)
}

fn quality(args: &BakeArgs) -> Result<Quality> {
    let mut quality = setup::quality(&args.quality)?;
    if matches!(args.quality.method, MethodName::Auto) {
        quality.method = Method::Brute;
    }
    if quality.lines == Lines::Exact && quality.method != Method::Brute {
        return Err(Error::setting(
            "--lines",
            "exact",
            "--method brute, which is exact in every azimuth: grid vectors are not even",
        ));
    }
    Ok(quality)
}

/// Of kinds that look along directions: ellipses spend none below horizontal.
fn directions(args: &BakeArgs) -> Result<Directions> {
    let has_points = args.what.iter().any(|kind| kind.name == "visible-points");
    let lowest_z = if has_points { -1.0 } else { 0.0 };
    Directions::fibonacci(args.directions.unwrap_or(256), lowest_z, 0)
}

/// The kinds that a sheet tells of, each with its files; of what is no sheet nothing.
fn told(sheet: &Path) -> Vec<(String, Vec<String>)> {
    let text = std::fs::read(sheet).unwrap_or_default();
    let sheet: serde_json::Value = serde_json::from_slice(&text).unwrap_or_default();
    let word = |value: &serde_json::Value| value.as_str().unwrap_or_default().to_owned();
    let maps = sheet["maps"].as_array().into_iter().flatten();
    maps.map(|map| {
        let files = map["files"].as_array().into_iter().flatten();
        (word(&map["kind"]), files.map(|file| word(&file["file"])).collect())
    })
    .collect()
}

/// Where files go: a folder that is there, or can be made. A bake of other kinds there would lose its sheet.
fn check_folder(path: &Path, wanted: &[Wanted]) -> Result<()> {
    let shown = || path.display().to_string();
    if path.is_dir() {
        let is_other = |kind: &String| wanted.iter().all(|w| w.kind.name != kind);
        let told = told(&path.join(SHEET));
        if let Some((kind, _)) = told.iter().find(|(kind, _)| is_other(kind)) {
            let found = format!("{} with {kind} in its {SHEET}", shown());
            let expected = "a folder without another bake, or all its kinds among --what";
            return Err(Error::setting("-o", found, expected));
        }
        return files::check_writable(&path.join(SHEET));
    }
    if path.exists() {
        return Err(Error::setting("-o", format!("the file {}", shown()), "a folder"));
    }
    let parent = parent(path);
    if !parent.is_dir() {
        let expected = format!("a folder {} that exists", parent.display());
        return Err(Error::setting("-o", shown(), expected));
    }
    files::check_writable(path)
}

/// Refuses what this machine has no memory for, before it is begun.
fn check_memory(bytes: u64) -> Result<()> {
    let wanted = usize::try_from(bytes).unwrap_or(usize::MAX);
    Vec::<u8>::new().try_reserve_exact(wanted).map_err(|_| Error::Limit {
        what: "a bake of --what".into(),
        needs: format!("{bytes} bytes of this program's memory, see --plan"),
        limit: "what this machine gives".into(),
    })
}

fn parent(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// What is known before anything runs.
struct Job<'a> {
    field: &'a HeightField,
    border: Border,
    quality: &'a Quality,
    directions: &'a Directions,
    wanted: Vec<Wanted>,
    making: Vec<Making>,
}

impl Job<'_> {
    fn samples(&self) -> usize {
        self.field.rows() * self.field.cols()
    }

    /// Every file and the most bytes that it may take.
    fn files(&self) -> Vec<(String, u64)> {
        let pairs = self.wanted.iter().zip(&self.making);
        let mut all: Vec<_> = pairs.flat_map(|(w, m)| w.files(&m.map, self.samples())).collect();
        // Of each file what it is and how it is decoded, of each plane a name, of each direction three numbers.
        let planes: usize = self.making.iter().map(|m| m.map.planes.len()).sum();
        let told = 2048 * all.len() + 80 * planes + 160 * self.directions.count();
        all.push((SHEET.into(), 65_536 + told as u64));
        all
    }

    /// Bytes on this side: sums, planes that wait for their files, normals, and azimuths as they come.
    fn host_bytes(&self, limits: &Limits) -> u64 {
        let samples = self.samples();
        let of = |(w, m): (&Wanted, &Making)| {
            m.source.bytes(self.directions, samples) + w.held_bytes(&m.map, samples)
        };
        let pairs = self.wanted.iter().zip(&self.making);
        let azimuths = u64::from(horizon::at_once(self.field, limits).min(self.quality.azimuths));
        pairs.map(of).sum::<u64>() + (24 + 4 * azimuths) * samples as u64
    }

    /// Kinds of directions.
    fn of_directions(&self) -> impl Iterator<Item = OfDirections> {
        self.making.iter().filter_map(|m| match m.source {
            Source::Directions(of) => Some(of),
            Source::Horizons(_) => None,
        })
    }

    fn has_horizons(&self) -> bool {
        self.of_directions().count() < self.making.len()
    }

    /// Of the horizons, a batch of azimuths, where there are any; then of each kind of directions.
    fn plans(&self, limits: &Limits) -> Result<Vec<Plan>> {
        let (field, border) = (self.field, self.border);
        let mut all = Vec::new();
        if self.has_horizons() {
            let most = horizon::at_once(field, limits);
            all.push(horizon::plan_from(field, border, self.quality, limits, (0, most), false)?);
        }
        for of in self.of_directions() {
            all.push((of.plan)(field, border, self.directions, limits)?);
        }
        Ok(all)
    }
}

pub fn run(args: &BakeArgs) -> Result<Outcome> {
    let wanted = wanted(args)?;
    check_folder(&args.output, &wanted)?;
    if let Some(json) = &args.global.json {
        setup::check_output("--json", json, &["json"])?;
    }
    let quality = quality(args)?;
    let field = setup::field(&args.input.path, &args.surface, &args.global)?;
    let border = setup::border(&args.surface);
    let samples = field.rows() * field.cols();
    let directions = directions(args)?;
    let making = wanted.iter().map(|w| {
        let (quality, directions, encoding) = (&quality, &directions, w.encoding);
        (w.kind.begin)(&Asked { border, quality, directions, encoding, samples })
    });
    let making = making.collect::<Result<Vec<_>>>()?;
    let job =
        Job { field: &field, border, quality: &quality, directions: &directions, wanted, making };
    if let Some(count) = args.directions.filter(|_| job.of_directions().next().is_none()) {
        let expected = "--what ellipse or visible-points, which alone look along directions";
        return Err(Error::setting("--directions", count.to_string(), expected));
    }
    let files = job.files();
    let paths: Vec<PathBuf> = files.iter().map(|(name, _)| args.output.join(name)).collect();
    let mut outputs: Vec<_> = paths.iter().map(|path| ("-o", Some(path.as_path()))).collect();
    outputs.push(("--json", args.global.json.as_deref()));
    setup::check_distinct(&outputs, &[&args.input.path])?;
    let first = |plans: Vec<Plan>| plans.into_iter().next().expect("--what has a kind");
    setup::check_plan(&args.global, |limits| job.plans(limits).map(first))?;
    if args.plan {
        return say_plan(args, &job);
    }
    let on_disk = if args.output.is_dir() { args.output.as_path() } else { parent(&args.output) };
    let room: Vec<_> = files.iter().map(|(name, bytes)| (on_disk.join(name), *bytes)).collect();
    let room: Vec<_> = room.iter().map(|(path, bytes)| (path.as_path(), *bytes)).collect();
    files::check_room(&room)?;
    let (mut gpu, limits) = setup::device(&args.global)?;
    check_memory(job.host_bytes(&limits))?;
    let mut used = match job.has_horizons() {
        true => horizon::used(&field, border, &quality, &limits, false)?,
        false => job.plans(&limits).map(first)?.settings,
    };
    if args.what.iter().any(|kind| kind.name.starts_with("sh-")) {
        used.push(("sh_order".into(), quality.sh_order.to_string()));
    }
    idle::say(args.global.quiet, &args.quality.written, &used);
    let made = std::fs::create_dir(&args.output);
    match &made {
        Err(error) if error.kind() != std::io::ErrorKind::AlreadyExists => {
            let source = std::io::Error::new(error.kind(), error.to_string());
            return Err(Error::Io { path: args.output.clone(), source });
        }
        _ => {}
    }
    let done = bake(args, job, &mut gpu, &limits, &used);
    if done.is_err() && made.is_ok() {
        // Nothing was finished: what was made for it goes, too, unless somebody has put something there.
        let _ = std::fs::remove_dir(&args.output);
    }
    done
}

fn bake(
    args: &BakeArgs,
    job: Job<'_>,
    gpu: &mut Headless,
    limits: &Limits,
    used: &[(String, String)],
) -> Result<Outcome> {
    let (has_horizons, looks_along) = (job.has_horizons(), job.of_directions().next().is_some());
    let Job { field, border, quality, directions, wanted, making } = job;
    let hash = format!("{:016x}", field.hash(border));
    let count = wanted.len();
    let mut all = Vec::new();
    for (wanted, making) in wanted.into_iter().zip(making) {
        let files = MapFiles::create(&args.output, wanted, making.map, field, &hash)?;
        all.push((making.source, files));
    }
    let normals = normals(field, border);
    let bar = crate::terminal::progress(args.global.quiet, "baking");
    let azimuths = plan::circle_rad(quality, field.cell_m())?;
    let width_rad = std::f64::consts::TAU / azimuths.len() as f64;
    let started = std::time::Instant::now();
    let (mut times, mut plan) = (Vec::new(), None);
    if has_horizons {
        let mut each = |k: u32, elevations: &[f32], _: &[f32]| {
            bar.set_message(format!("baking: azimuth {} of {}", k + 1, azimuths.len()));
            let ray = Ray { azimuth_rad: azimuths[k as usize], width_rad };
            all.iter_mut().try_for_each(|(source, files)| match source {
                Source::Horizons(maker) => maker.add(ray, elevations, &normals, files),
                Source::Directions(_) => Ok(()),
            })
        };
        let found = horizon::for_each(gpu, field, border, quality, limits, false, &mut each)?;
        (times, plan) = (found.0, Some(found.1));
    }
    for (source, files) in &mut all {
        let Source::Directions(of) = source else { continue };
        bar.set_message("baking: what samples see".to_owned());
        let own = (of.plan)(field, border, directions, limits)?;
        let count = own.outputs().count();
        plan.get_or_insert_with(|| own.clone());
        let outputs = gpu.with_frame(own, &[field.heights_m()], |gpu, frame| {
            times.extend(gpu.draw(frame)?);
            let outputs = (0..count).map(|output| Ok(gpu.pixels(frame, output)?.values));
            outputs.collect::<Result<Vec<_>>>()
        })?;
        (of.take)(&Looked { field, border, directions, outputs: &outputs }, files)?;
    }
    let plan = plan.expect("--what has a kind");
    let mut metadata = setup::metadata(gpu, field, &plan, &times);
    metadata
        .extend(used.iter().filter(|(name, _)| name == "azimuths" || name == "sh_order").cloned());
    metadata.extend(setup::asked(&args.input.path, &args.surface, None));
    metadata.push(("field_hash".into(), hash));
    let mut sheets = Vec::new();
    for (i, (source, mut files)) in all.into_iter().enumerate() {
        bar.set_message(format!("writing {} of {count}", i + 1));
        if let Source::Horizons(maker) = source {
            maker.end(&normals, &mut files)?;
        }
        if let Some(note) = files.note().filter(|_| !args.global.quiet) {
            // A closed stderr is no panic.
            let _ = bar.suspend(|| writeln!(std::io::stderr(), "{note}"));
        }
        sheets.push(files.finish(&metadata)?);
    }
    bar.finish_and_clear();
    let seconds = started.elapsed().as_secs_f64();
    metadata.push(("seconds".into(), format!("{seconds:.3}")));
    let mut sheet = sheet(&metadata, &times, field, quality, &sheets);
    if !has_horizons {
        sheet["horizons"] = serde_json::Value::Null;
    }
    if looks_along {
        let vectors = directions.vectors().iter();
        sheet["directions"] = vectors.map(|e| json!([e.x, e.y, e.z])).collect();
    }
    let path = args.output.join(SHEET);
    let before = told(&path);
    files::write_json(&path, &sheet)?;
    // Of an earlier bake what is not written again: azimuths beyond the last, other formats.
    let now: Vec<String> = told(&path).into_iter().flat_map(|(_, files)| files).collect();
    for (kind, names) in before {
        let is_own = |name: &&String| name.starts_with(&kind.replace('-', "_"));
        for name in names.iter().filter(is_own).filter(|name| !now.contains(name)) {
            if Path::new(name).file_name().is_some_and(|own| *own == **name) {
                // What cannot be removed stays, untold of.
                let _ = std::fs::remove_file(args.output.join(name));
            }
        }
    }
    if let Some(json) = &args.global.json {
        files::write_json(json, &sheet)?;
    }
    if !args.global.quiet {
        let ms: f64 = times.iter().map(|t| t.ns).sum::<f64>() / 1e6;
        crate::say!(
            "{}: {count} of {} × {}, {}, {seconds:.1} s, {ms:.1} ms of them on {}",
            args.output.display(),
            field.cols(),
            field.rows(),
            match has_horizons {
                true => format!("{} azimuths", quality.azimuths),
                false => format!("{} directions", directions.count()),
            },
            gpu.report().name
        );
    }
    Ok(Outcome::Done)
}

/// What the folder holds.
fn sheet(
    metadata: &[(String, String)],
    times: &[Timing],
    field: &HeightField,
    quality: &Quality,
    maps: &[serde_json::Value],
) -> serde_json::Value {
    let voids = field.voids().map_or(0, |v| v.iter().filter(|v| **v).count());
    let horizons = match quality.method {
        Method::Brute => {
            "every crossing of a sample's own line along each azimuth: exact there but for rounding in f32"
        }
        _ => {
            "found by the method of the settings, whose own error is besides what is stated of files"
        }
    };
    let mut sheet = setup::as_json(metadata, times);
    let hash = sheet["settings"]["field_hash"].clone();
    sheet["field"] = json!({
        "rows": field.rows(), "cols": field.cols(), "cell_m": field.cell_m(), "base_m": field.base_m(),
        "voids": voids, "hash": hash,
        "hash_is": "FNV-1a of 64 bits of the text ridgelight field 1, rows and columns (u64), cells (f64), the border (a \
                    byte: 0 plane, 1 open, 2 periodic), heights above the base (f32, -0 as 0) and, if any sample is \
                    void, a byte a sample, 1 where it is; little-endian",
        "first_row": "north", "first_column": "west",
    });
    sheet["horizons"] = horizons.into();
    sheet["error_is"] = "of decoding a file: what was computed is in it within at_most plus and_of_the_value times the \
                         value; between the azimuths nothing is looked at, which is besides"
        .into();
    sheet["maps"] = maps.into();
    sheet
}

/// What would be written and what it takes.
fn say_plan(args: &BakeArgs, job: &Job) -> Result<Outcome> {
    let (name, limits) = crate::plan::limits(&args.global)?;
    let plans = job.plans(&limits)?;
    if args.global.quiet {
        return Ok(Outcome::Done);
    }
    crate::say!("{:>14}  at most, bytes of {}", "file", args.output.display());
    for (name, bytes) in job.files() {
        crate::say!("{bytes:>14}  {name}");
    }
    let device = plans.iter().map(Plan::bytes).max().unwrap_or(0);
    crate::say!("{device:>14}  memory of {name}, a batch of azimuths or a kind at a time");
    crate::say!("{:>14}  memory of this program", job.host_bytes(&limits));
    Ok(Outcome::Done)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_the_machine_has_is_refused() {
        assert!(check_memory(1 << 16).is_ok());
        let said = check_memory(1 << 62).expect_err("beyond any machine").to_string();
        assert!(said.contains("needs 4611686018427387904 bytes"), "{said}");
    }
}

//! docs/gallery/index.md: pictures made by the command lines on the page. `cargo xtask gallery` runs the commands and
//! writes the pictures and their times; to change a picture, edit its command on the page.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::process::Command;

use image::codecs::jpeg::JpegEncoder;
use image::{Rgb, RgbImage};
use ridgelight::Result;
use ridgelight::scene::{Border, HeightField, fractal};
use ridgelight_io as files;
use ridgelight_testing::terrain;

use crate::common::Outcome;
use crate::common::args::Args;
use crate::common::inputs::mountain;

const FOLDER: &str = "docs/gallery";
const PAGE: &str = "docs/gallery/index.md";
const QUALITY: u8 = 88;
const MOUNTAINS: &str = "assets/mt_washington_256.png --cell 66,92.6";

type Fallible<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// A section of the page.
struct Entry<'a> {
    name: &'a str,
    /// The extension of the command's output.
    ending: &'a str,
    /// Synthetic terrain, its side and its file.
    made: Option<[&'a str; 3]>,
    /// The words of the command, without its output.
    command: Vec<String>,
}

impl<'a> Entry<'a> {
    /// None without a command.
    fn of(section: &'a str) -> Option<Self> {
        let shell = section.split_once("```sh\n")?.1.split_once("```")?.0;
        let made = shell.lines().find_map(|line| line.strip_prefix("cargo measure field "));
        let made = made.map(|words| words.split(' ').collect::<Vec<_>>());
        let made: Option<[&str; 3]> = made.and_then(|words| words.try_into().ok());
        let command = shell.lines().find_map(|line| line.strip_prefix("ridgelight "))?;
        let (command, output) = command.rsplit_once(" -o ")?;
        let (name, ending) = output.split_once('.')?;
        // Every second part is quoted.
        let parts = command.split('"').enumerate().flat_map(|(i, part)| match i % 2 {
            0 => part.split_whitespace().map(str::to_owned).collect(),
            _ => vec![part.to_owned()],
        });
        Some(Self { name, ending, made, command: parts.collect() })
    }

    /// Writes its synthetic terrain.
    fn make(&self, time_s: f64) -> Fallible<()> {
        let Some([name, side, path]) = self.made else { return Ok(()) };
        let field = terrain_of(name, side.parse()?, time_s)?;
        Ok(files::write_npy_heights(Path::new(path), &field)?)
    }
}

/// A synthetic terrain by its name.
fn terrain_of(name: &str, side: usize, time_s: f64) -> Result<HeightField> {
    match name {
        "city" => terrain::city(side),
        "coast" => terrain::coast(side),
        "craters" => terrain::craters(side),
        "dunes" => terrain::dunes(side),
        "escarpment" => terrain::escarpment(side),
        "fractal" => fractal(side, 1),
        "waves" => terrain::waves(side, time_s),
        _ => Err(ridgelight::Error::setting(
            "NAME",
            name,
            "city, coast, craters, dunes, escarpment, fractal or waves",
        )),
    }
}

/// Writes a field as a file: a synthetic one, or the bundled mountain with its triangles cut to about a side.
pub fn field(mut args: Args) -> Outcome {
    let (Some(name), Some(side), Some(path)) = (args.word(), args.word(), args.word()) else {
        return Err("expected NAME SIDE FIELD.npy".into());
    };
    let side: usize = side.parse()?;
    let made = if name == "mountain" {
        let coarse = mountain(1.0)?;
        coarse.finer(Border::Plane, (side / coarse.cols()).max(1))?
    } else {
        terrain_of(&name, side, 0.0)?
    };
    if let Some(folder) = Path::new(&path).parent() {
        std::fs::create_dir_all(folder)?;
    }
    files::write_npy_heights(Path::new(&path), &made)?;
    let [x, y] = made.cell_m();
    println!("--cell {x},{y}");
    Ok(())
}

/// Runs the page's commands, and writes the pictures and the page with the new times.
pub fn run(mut args: Args) -> Outcome {
    let program = args.folder().ok_or("expected the program")?;
    let data = args.folder();
    args.end()?;
    let scratch = PathBuf::from("out/gallery");
    std::fs::create_dir_all(&scratch)?;
    let page = std::fs::read_to_string(PAGE)?;
    let (pictures, _) = page.split_once(CONTRAST).ok_or("no section of contrast")?;
    let mut sections: Vec<String> = pictures.split("\n## ").map(str::to_owned).collect();
    let mut device = String::new();
    for section in sections.iter_mut().skip(1) {
        let entry =
            Entry::of(section.as_str()).ok_or_else(|| format!("no command in: {section}"))?;
        entry.make(0.0)?;
        let output = scratch.join(entry.name).with_extension(entry.ending);
        let (ms, name) = drawn(&program, &entry.command, &output, &scratch)?;
        device = name;
        let picture = match entry.name {
            // A hillshade without shadows to the left of it: the same file and cell.
            "hillshade" => {
                let command = [&["hillshade".to_owned()][..], &entry.command[1..4]].concat();
                let shade = scratch.join("shade.png");
                drawn(&program, &command, &shade, &scratch)?;
                beside(&image::open(shade)?.to_rgb8(), &image::open(&output)?.to_rgb8())
            }
            // The direction of the highest horizon is a hue, its elevation the brightness.
            "horizons" => wheel(&output)?,
            // Four frames of moving heights in a row.
            "waves" => {
                let mut strip = image::open(&output)?.to_rgb8();
                for frame in 1..4 {
                    entry.make(0.5 * f64::from(frame))?;
                    drawn(&program, &entry.command, &output, &scratch)?;
                    strip = beside(&strip, &image::open(&output)?.to_rgb8());
                }
                strip
            }
            _ => image::open(&output)?.to_rgb8(),
        };
        let path = Path::new(FOLDER).join(entry.name).with_extension("jpg");
        let file = std::io::BufWriter::new(std::fs::File::create(&path)?);
        picture.write_with_encoder(JpegEncoder::new_with_quality(file, QUALITY))?;
        println!("{}: {ms:.0} ms", entry.name);
        let (before, after) = section.split_once(" ms.\n").ok_or("a section without a time")?;
        let (about, _) = before.rsplit_once(' ').ok_or("a section without a time")?;
        *section = format!("{about} {ms:.0} ms.\n{after}");
    }
    let mut page = sections.join("\n## ") + CONTRAST;
    page += &contrast(&program, &scratch, data.as_deref())?;
    let commit = Command::new("git").args(["log", "-1", "--format=%h, %cs"]).output()?;
    let commit = String::from_utf8(commit.stdout)?;
    page += &format!("\n*{device}; commit {}*\n", commit.trim());
    std::fs::write(PAGE, page)?;
    Ok(())
}

/// The heading of the table after the pictures.
const CONTRAST: &str = "\n## Contrast of default pictures\n";

/// Percentiles of luminance in the table.
const TAILS: [f64; 2] = [0.05, 0.95];

/// A table of the luminance of pictures without flags: of the bundled mountain, of synthetic fields, and of each file in a folder.
fn contrast(program: &Path, scratch: &Path, data: Option<&Path>) -> Fallible<String> {
    const SIDE: usize = 640;
    let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let mut fields = vec![("Mt Washington, 256²".to_owned(), words(MOUNTAINS))];
    for name in ["fractal", "escarpment", "dunes", "coast", "city"] {
        let path = scratch.join(format!("{name}_{SIDE}.npy"));
        let made = terrain_of(name, SIDE, 0.0)?;
        files::write_npy_heights(&path, &made)?;
        let input = format!("{} --cell {}", path.display(), made.cell_m()[0]);
        fields.push((format!("synthetic: {name}, {SIDE}²"), words(&input)));
    }
    let mut real: Vec<_> = data.map_or(Ok(Vec::new()), |folder| {
        std::fs::read_dir(folder)?.map(|file| Ok(file?.path())).collect::<std::io::Result<_>>()
    })?;
    real.sort();
    // Without PNGs: the bundled mountain is already in the list, and a displacement map has no cell size.
    real.retain(|path| {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        ["asc", "hgt", "npz", "tif"].contains(&ending.as_ref())
    });
    for path in real {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        fields.push((name, vec![path.display().to_string()]));
    }
    let mut table = "\nLuminance in codes of 0 to 255 of `render FIELD -o out.png`, from \
        above, at the 5th and the 95th percentile of the pixels.\n\n| field | 5th | 95th | black, % | white, % |\n|---|---|---|---|---|\n"
        .to_owned();
    let output = scratch.join("contrast.png");
    for (name, input) in fields {
        let command = [vec!["render".to_owned()], input].concat();
        drawn(program, &command, &output, scratch)?;
        let picture = image::open(&output)?.to_rgba8();
        let visible = picture.pixels().filter(|pixel| pixel.0[3] > 0);
        let luminance = |pixel: &image::Rgba<u8>| {
            let weights = [0.2126, 0.7152, 0.0722];
            (0..3).map(|c| weights[c] * f64::from(pixel.0[c])).sum::<f64>()
        };
        let mut codes: Vec<f64> = visible.map(luminance).collect();
        codes.sort_by(f64::total_cmp);
        let last = codes.len().checked_sub(1).ok_or("a picture without pixels")? as f64;
        let [dark, light] = TAILS.map(|share| codes[(share * last).round() as usize]);
        let share = |is: fn(f64) -> bool| {
            100.0 * codes.iter().filter(|code| is(**code)).count() as f64 / codes.len() as f64
        };
        let [black, white] = [share(|code| code < 0.5), share(|code| code > 254.5)];
        table += &format!("| {name} | {dark:.0} | {light:.0} | {black:.2} | {white:.2} |\n");
    }
    Ok(table)
}

/// Runs the program; returns its GPU milliseconds and the device.
fn drawn(
    program: &Path,
    command: &[String],
    output: &Path,
    scratch: &Path,
) -> Fallible<(f64, String)> {
    let json = scratch.join("settings.json");
    let [to, report] = [output, &json].map(Path::as_os_str);
    let mut ran = Command::new(program);
    ran.args(command).args(["-o".as_ref(), to, "--json".as_ref(), report, "--quiet".as_ref()]);
    let ran = ran.output()?;
    if !ran.status.success() {
        return Err(
            format!("{}: {}", command.join(" "), String::from_utf8_lossy(&ran.stderr)).into()
        );
    }
    let settings: serde_json::Value = serde_json::from_slice(&std::fs::read(&json)?)?;
    let settings = &settings["settings"];
    let word = |key: &str| settings[key].as_str().unwrap_or_default().to_owned();
    let ms = settings["gpu_ms"].as_f64().unwrap_or(f64::NAN);
    Ok((ms, format!("{}, {}", word("device"), word("driver"))))
}

/// Pictures side by side, four white pixels between them.
fn beside(left: &RgbImage, right: &RgbImage) -> RgbImage {
    const GAP: u32 = 4;
    let width = left.width() + GAP + right.width();
    let mut both = RgbImage::from_pixel(width, left.height().max(right.height()), Rgb([255; 3]));
    image::imageops::replace(&mut both, left, 0, 0);
    image::imageops::replace(&mut both, right, i64::from(left.width() + GAP), 0);
    both
}

/// Hues of the highest horizons.
fn wheel(path: &Path) -> Fallible<RgbImage> {
    const BRIGHTEST_DEG: f64 = 30.0;
    let all = files::read_planes(path)?;
    let count = all.planes.len();
    Ok(RgbImage::from_fn(all.cols as u32, all.rows as u32, |x, y| {
        let i = y as usize * all.cols + x as usize;
        let elevation = |k: &usize| all.planes[*k][i];
        let highest = (0..count).max_by(|a, b| elevation(a).total_cmp(&elevation(b))).unwrap_or(0);
        let share = (f64::from(elevation(&highest)).to_degrees() / BRIGHTEST_DEG).clamp(0.0, 1.0);
        let turn = highest as f64 / count as f64;
        // Three cosines a third of a turn apart.
        Rgb([0.0, 1.0, 2.0].map(|third: f64| {
            let hue = 0.5 + 0.5 * (TAU * (turn - third / 3.0)).cos();
            (255.0 * share.sqrt() * (0.25 + 0.75 * hue)).round() as u8
        }))
    }))
}

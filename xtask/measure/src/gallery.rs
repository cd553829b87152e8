//! docs/gallery/index.md: twelve pictures, each of one command line. `cargo xtask gallery`.

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

/// What becomes of the command's output.
#[derive(Clone, Copy)]
enum Shown {
    Picture,
    /// A hillshade without shadows to the left of it.
    BesideHillshade,
    /// Horizons: the direction of the highest is a hue, its elevation the brightness.
    Wheel,
    /// Four frames of moving heights in a row.
    Frames,
}

struct Entry {
    name: &'static str,
    title: &'static str,
    about: &'static str,
    /// Synthetic terrain and its side, written as out/gallery/NAME.npy.
    made: Option<(&'static str, usize)>,
    /// With FIELD for the heights and their cell size.
    command: &'static str,
    shown: Shown,
}

const ENTRIES: [Entry; 12] = [
    Entry {
        name: "dawn",
        title: "Mountains at dawn",
        about: "Mt Washington (SRTM). The sun is 6 degrees high; the sky is the clear sky around it.",
        made: None,
        command: "render FIELD --sun 80,6,0.53,3,2,1 --sky clear --camera \"from 150 up 20\" --size 1024x576",
        shown: Shown::Picture,
    },
    Entry {
        name: "craters",
        title: "Craters",
        about: "Synthetic. A point-like sun 12 degrees high and no sky: shadows are black.",
        made: Some(("craters", 640)),
        command: "render FIELD --sun 100,12,0.53 --tint none",
        shown: Shown::Picture,
    },
    Entry {
        name: "city",
        title: "City roofs, sky view",
        about: "Synthetic. A uniform sky: each roof and street has the share of the sky that is visible from it.",
        made: Some(("city", 640)),
        command: "render FIELD --sky 1 --tint none",
        shown: Shown::Picture,
    },
    Entry {
        name: "moss",
        title: "Moss with bounces",
        about: "A displacement map of moss (ambientCG), each pixel half a millimetre. Two bounces light the gaps.",
        made: None,
        command: "render assets/moss_384.png --cell 0.0005 --z-scale 6e-7 --sun 315,25,4,2.2,2,1.6 --sky 0.35,0.4,0.5 --albedo 0.16,0.22,0.06 --bounces 2 --exposure 3.4",
        shown: Shown::Picture,
    },
    Entry {
        name: "dunes",
        title: "Dunes",
        about: "Synthetic. The default sun and sky on sand.",
        made: Some(("dunes", 640)),
        command: "render FIELD --albedo 0.75,0.55,0.35",
        shown: Shown::Picture,
    },
    Entry {
        name: "hillshade",
        title: "Hillshade, and Ridgelight",
        about: "Left: a hillshade by Horn's slopes, the cosine to the sun, without shadows and sky; `cargo xtask gallery` adds it. Right: the default of Ridgelight, plain ground.",
        made: None,
        command: "render FIELD --tint none",
        shown: Shown::BesideHillshade,
    },
    Entry {
        name: "horizons",
        title: "Horizon map",
        about: "The command writes elevations; `cargo xtask gallery` colours them. The hue is the direction of the highest horizon, the brightness its elevation up to 30 degrees.",
        made: None,
        command: "horizon FIELD --azimuths 64",
        shown: Shown::Wheel,
    },
    Entry {
        name: "sky-view",
        title: "Sky-view factor",
        about: "Synthetic dunes. Exit radiance under a uniform sky is the factor.",
        made: Some(("dunes", 640)),
        command: "render FIELD --sky 1 --tint none --exposure 0.8",
        shown: Shown::Picture,
    },
    Entry {
        name: "soft-sun",
        title: "A soft sun",
        about: "Synthetic city. A sun 12 degrees wide: shadows blur with distance.",
        made: Some(("city", 384)),
        command: "render FIELD --sun 300,30,12,3 --sky 0.25 --tint none --sun-azimuths 24",
        shown: Shown::Picture,
    },
    Entry {
        name: "environment",
        title: "Light of an environment",
        about: "A photographed sky with a veiled sun lights the mountain (assets/sky_512x256.hdr).",
        made: None,
        command: "render FIELD --env assets/sky_512x256.hdr --camera \"from 230 up 25\" --size 1024x576",
        shown: Shown::Picture,
    },
    Entry {
        name: "specular",
        title: "Specular ground",
        about: "Synthetic waves with Phong specular of exponent 12, viewed from above.",
        made: Some(("waves", 512)),
        command: "render FIELD --albedo 0.03,0.07,0.09 --specular 12,0.35 --sun 315,60,8,3 --sky 0.4,0.55,0.8",
        shown: Shown::Picture,
    },
    Entry {
        name: "waves",
        title: "Animated waves",
        about: "Synthetic. Four frames, half a second apart, of heights that change every frame; the command draws the first.",
        made: Some(("waves", 256)),
        command: "render FIELD --albedo 0.1,0.2,0.25 --sun 315,14,0.53,4 --sky 0.5,0.6,0.7 --exposure 1.6",
        shown: Shown::Frames,
    },
];

/// A synthetic terrain by its name.
pub fn terrain_of(name: &str, side: usize, time_s: f64) -> Result<HeightField> {
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

/// Renders all and writes the page.
pub fn run(mut args: Args) -> Outcome {
    let program = args.folder().ok_or("expected the program")?;
    let data = args.folder();
    args.end()?;
    let scratch = PathBuf::from("out/gallery");
    std::fs::create_dir_all(&scratch)?;
    std::fs::create_dir_all(FOLDER)?;
    let mut page = "# Gallery\\n\\nEach picture is of one command line; `cargo xtask gallery` makes them again. The mountain is \
        real: Mt Washington,\\n256 x 256 grid points (SRTM). Other terrains are synthetic; `cargo measure field` writes \
        them.\\nTimes are GPU time of all passes.\\n"
        .replace("\\n", "\n");
    let mut device = String::new();
    for entry in &ENTRIES {
        let (input, command) = prepared(entry, &scratch, 0.0)?;
        let output = scratch.join(entry.name).with_extension(match entry.shown {
            Shown::Wheel => "npy",
            _ => "png",
        });
        let (ms, name) = drawn(&program, &command, &output, &scratch)?;
        device = name;
        let picture = match entry.shown {
            Shown::Picture => image::open(&output)?.to_rgb8(),
            Shown::BesideHillshade => beside(&hillshade(&input)?, &image::open(&output)?.to_rgb8()),
            Shown::Wheel => wheel(&output)?,
            Shown::Frames => {
                let mut strip = image::open(&output)?.to_rgb8();
                for frame in 1..4 {
                    let (_, command) = prepared(entry, &scratch, 0.5 * f64::from(frame))?;
                    drawn(&program, &command, &output, &scratch)?;
                    strip = beside(&strip, &image::open(&output)?.to_rgb8());
                }
                strip
            }
        };
        let path = Path::new(FOLDER).join(entry.name).with_extension("jpg");
        let file = std::io::BufWriter::new(std::fs::File::create(&path)?);
        picture.write_with_encoder(JpegEncoder::new_with_quality(file, QUALITY))?;
        let ending = if matches!(entry.shown, Shown::Wheel) { "npy" } else { "png" };
        let words = command.join(" ").replace("from 150 up 20", "\"from 150 up 20\"");
        let words = words.replace("from 230 up 25", "\"from 230 up 25\"");
        let Entry { name, title, about, made, .. } = entry;
        let made = made.map_or_else(String::new, |(of, side)| {
            format!("cargo measure field {of} {side} out/gallery/{of}.npy\n")
        });
        page += &format!(
            "\n## {title}\n\n![{title}]({name}.jpg)\n\n{about} {ms:.0} ms.\n\n\
             ```sh\n{made}ridgelight {words} -o {name}.{ending}\n```\n"
        );
        println!("{name}: {ms:.0} ms");
    }
    page += &contrast(&program, &scratch, data.as_deref())?;
    let commit = Command::new("git").args(["log", "-1", "--format=%h, %cs"]).output()?;
    let commit = String::from_utf8(commit.stdout)?;
    page += &format!("\n*{device}; commit {}*\n", commit.trim());
    std::fs::write(PAGE, page)?;
    Ok(())
}

/// Percentiles of luminance in the table.
const TAILS: [f64; 2] = [0.05, 0.95];

/// A table of the luminance of pictures without flags: of the bundled mountain, of synthetic fields, and of each file in a folder.
fn contrast(
    program: &Path,
    scratch: &Path,
    data: Option<&Path>,
) -> std::result::Result<String, Box<dyn std::error::Error>> {
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
    let mut table = "\n## Contrast of default pictures\n\nLuminance in codes of 0 to 255 of `render FIELD -o out.png`, from \
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

/// The file of the heights, and the command's words with the heights in place.
fn prepared(
    entry: &Entry,
    scratch: &Path,
    time_s: f64,
) -> std::result::Result<(String, Vec<String>), Box<dyn std::error::Error>> {
    let input = match entry.made {
        None => MOUNTAINS.to_owned(),
        Some((name, side)) => {
            let path = scratch.join(format!("{name}.npy"));
            let made = terrain_of(name, side, time_s)?;
            files::write_npy_heights(&path, &made)?;
            format!("{} --cell {}", path.display(), made.cell_m()[0])
        }
    };
    let command = entry.command.replace("FIELD", &input);
    // Every second part stands in quotes.
    let parts = command.split('"').enumerate().flat_map(|(i, part)| match i % 2 {
        0 => part.split_whitespace().map(str::to_owned).collect(),
        _ => vec![part.to_owned()],
    });
    let words = parts.collect();
    Ok((input, words))
}

/// Runs the program; returns its GPU milliseconds and the device.
fn drawn(
    program: &Path,
    command: &[String],
    output: &Path,
    scratch: &Path,
) -> std::result::Result<(f64, String), Box<dyn std::error::Error>> {
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

/// The usual hillshade: sun at azimuth 315, elevation 45; slopes by Horn's weights (B. K. P. Horn, Hill shading and the
/// reflectance map, 1981).
fn hillshade(input: &str) -> std::result::Result<RgbImage, Box<dyn std::error::Error>> {
    let mut words = input.split_whitespace();
    let path = PathBuf::from(words.next().ok_or("a field")?);
    let cell: Vec<f64> = words
        .nth(1)
        .ok_or("a cell")?
        .split(',')
        .map(str::parse)
        .collect::<std::result::Result<_, _>>()?;
    let cell_m = [cell[0], *cell.last().ok_or("a cell")?];
    let options = files::HeightOptions { cell_m: Some(cell_m), ..Default::default() };
    let field = files::read_heights(&path, &options)?;
    let (rows, cols) = (field.rows(), field.cols());
    let at = |row: i64, col: i64| {
        let (row, col) = (row.clamp(0, rows as i64 - 1), col.clamp(0, cols as i64 - 1));
        f64::from(field.heights_m()[row as usize * cols + col as usize])
    };
    let half = std::f64::consts::FRAC_1_SQRT_2;
    // North-west, 45 degrees up.
    let sun = [-0.5, 0.5, half];
    Ok(RgbImage::from_fn(cols as u32, rows as u32, |x, y| {
        let (row, col) = (i64::from(y), i64::from(x));
        let column = |c: i64| at(row - 1, c) + 2.0 * at(row, c) + at(row + 1, c);
        let line = |r: i64| at(r, col - 1) + 2.0 * at(r, col) + at(r, col + 1);
        let east = (column(col + 1) - column(col - 1)) / (8.0 * cell_m[0]);
        let north = (line(row - 1) - line(row + 1)) / (8.0 * cell_m[1]);
        let length = (1.0 + east * east + north * north).sqrt();
        let cosine = (sun[2] - east * sun[0] - north * sun[1]) / length;
        Rgb([(255.0 * cosine.clamp(0.0, 1.0)).round() as u8; 3])
    }))
}

/// Hues of the highest horizons.
fn wheel(path: &Path) -> std::result::Result<RgbImage, Box<dyn std::error::Error>> {
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

//! Pictures of a command line without flags.

use ridgelight::scene::{HeightField, fractal};
use ridgelight_testing::terrain;

use crate::{Folder, succeeded};

/// Shares of the pixels with less light.
const TAILS: [f64; 2] = [0.05, 0.95];
/// Least difference of codes between them.
const SPAN: f64 = 120.0;

/// Rec. 709 luminance of each pixel, in codes; transparent pixels do not count.
fn luminances(folder: &Folder, name: &str) -> Vec<f64> {
    let picture = image::open(folder.path(name)).unwrap().to_rgba8();
    let visible = picture.pixels().filter(|pixel| pixel.0[3] > 0);
    let weights = [0.2126, 0.7152, 0.0722];
    visible.map(|pixel| (0..3).map(|c| weights[c] * f64::from(pixel.0[c])).sum()).collect()
}

/// The codes at the tails, and the shares of black and white.
fn spread(mut codes: Vec<f64>) -> ([f64; 2], [f64; 2]) {
    codes.sort_by(f64::total_cmp);
    let tails = TAILS.map(|share| codes[(share * (codes.len() - 1) as f64).round() as usize]);
    let share =
        |is: fn(f64) -> bool| codes.iter().filter(|v| is(**v)).count() as f64 / codes.len() as f64;
    (tails, [share(|v| v < 0.5), share(|v| v > 254.5)])
}

fn write(folder: &Folder, name: &str, field: &HeightField) -> String {
    ridgelight_io::write_npy_heights(&folder.path(name), field).unwrap();
    format!("{name} --cell {},{}", field.cell_m()[0], field.cell_m()[1])
}

/// Default pictures of every terrain have contrast, and a bounce where it changes them. Mountains are the bundled field, the others
/// are synthetic.
#[test]
fn gpu_default_pictures_have_contrast() {
    const SIDE: usize = 256;
    let folder = Folder::new();
    let mountains = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/mt_washington_256.png");
    std::fs::copy(mountains, folder.path("mountains.png")).unwrap();
    let made = [
        ("hills.npy", fractal(SIDE, 4)),
        ("escarpment.npy", terrain::escarpment(SIDE)),
        ("dunes.npy", terrain::dunes(SIDE)),
        ("coast.npy", terrain::coast(SIDE)),
        ("city.npy", terrain::city(SIDE)),
    ];
    let mut inputs = vec!["mountains.png --cell 66,92.6".to_owned()];
    inputs.extend(made.map(|(name, field)| write(&folder, name, &field.unwrap())));
    for input in inputs {
        let run = succeeded(&folder, &format!("render {input} -o out.png"));
        assert!(run.out.contains("Light: --sun 315,35,3,"), "{}", run.out);
        let is_steep = ["mountains", "hills", "city"].iter().any(|name| input.starts_with(name));
        let bounce = if is_steep { " --bounces 1 --bounce-azimuths 8" } else { "" };
        assert!(run.out.contains(&format!("--sky clear{bounce} (default)")), "{}", run.out);
        assert!(run.out.contains("Picture: --tint land --exposure "), "{}", run.out);
        let ([dark, light], clipped) = spread(luminances(&folder, "out.png"));
        println!("{input}: {dark:.0} to {light:.0}, {clipped:?} black and white");
        assert!(light - dark >= SPAN, "{input}: {dark} to {light}");
        assert!(clipped.iter().all(|share| *share < 0.01), "{input}: {clipped:?}");
    }
    // The measure can fail: a uniform sky on level ground.
    succeeded(&folder, "render coast.npy --cell 30 --sky 1 --tint none -o out.png");
    let ([dark, light], _) = spread(luminances(&folder, "out.png"));
    assert!(light - dark < 10.0, "{dark} to {light}");
}

/// Level ground keeps the lightness of its tint, and the sky behind it its colours.
#[test]
fn gpu_level_ground_is_not_white() {
    let folder = Folder::new();
    let field = HeightField::new(64, 64, &[500.0; 64 * 64], [30.0; 2], None).unwrap();
    let input = write(&folder, "level.npy", &field);
    for camera in ["", " --camera 150,20 --size 320x180"] {
        succeeded(&folder, &format!("render {input}{camera} -o out.png"));
        let codes = luminances(&folder, "out.png");
        let [dark, light] = spread(codes).0;
        assert!(dark > 60.0 && light < 200.0, "{camera}: {dark} to {light}");
    }
}

/// `render` adds no bounce with a light, `--bounces` or `--max-error`; to an `.exr`; where the picture would not change; where brute
/// force would be used.
#[test]
fn gpu_only_default_light_gets_a_bounce() {
    let folder = Folder::new();
    let input = write(&folder, "city.npy", &terrain::city(64).unwrap());
    let added = |flags: &str| {
        let output = if flags.contains("-o ") { "" } else { " -o a.png" };
        let run = succeeded(&folder, &format!("render {input}{flags}{output} --json a.json"));
        let report = std::fs::read_to_string(folder.path("a.json")).unwrap();
        let report: serde_json::Value = serde_json::from_str(&report).unwrap();
        let has_bounce = report["settings"]["bounces"] == 1;
        assert_eq!(has_bounce, run.out.contains("--bounces 1"), "{flags}: {}", run.out);
        has_bounce
    };
    assert!(added("") && added(" --camera west --size 96x54") && added(" --azimuths 8"));
    for flags in [
        " --bounces 0",
        " --sun 315,35",
        " --sky 1",
        " -o a.exr",
        " --albedo 0.02",
        " --lines exact",
        " --method brute-force",
        " --max-error 0.5 --no-cache",
    ] {
        assert!(!added(flags), "{flags}");
    }
}

/// The estimate agrees with bounces that are computed: where `render` adds one, 5 % of the ground gains at least half of the 2 % that it
/// asks for, elsewhere at most twice as much. Ground is brighter or darker than the level ground of the estimate by its cosine to the
/// sun, 1 / sin 35° = 1.7 times at most.
#[test]
fn gpu_a_bounce_is_added_where_it_adds_light() {
    let folder = Folder::new();
    let made = [
        ("hills", fractal(128, 4), true),
        ("city", terrain::city(128), true),
        ("dunes", terrain::dunes(128), false),
        ("coast", terrain::coast(128), false),
    ];
    for (name, field, is_added) in made {
        let input = write(&folder, &format!("{name}.npy"), &field.unwrap());
        let run = succeeded(&folder, &format!("render {input} --albedo 0.3 -o out.png"));
        assert_eq!(run.out.contains("--bounces 1"), is_added, "{name}: {}", run.out);
        let [with, without] = [1, 0].map(|bounces| {
            let args =
                format!("render {input} --albedo 0.3 --bounces {bounces} -o out.exr --quiet");
            succeeded(&folder, &args);
            ridgelight_io::read_planes(&folder.path("out.exr")).unwrap().planes
        });
        let planes = with.iter().zip(&without).map(|(with, without)| {
            let gains = with.iter().zip(without).map(|(a, b)| f64::from(a - b) / 0.3);
            gains.collect::<Vec<_>>()
        });
        let planes: Vec<Vec<f64>> = planes.collect();
        let mean =
            |i: usize| planes.iter().map(|plane| plane[i]).sum::<f64>() / planes.len() as f64;
        let mut gains: Vec<f64> = (0..planes[0].len()).map(mean).collect();
        gains.sort_by(f64::total_cmp);
        let least = gains[gains.len() * 95 / 100];
        println!("{name}: {least:.4}");
        assert!(if is_added { least >= 0.01 } else { least <= 0.04 }, "{name}: {least}");
    }
}

/// The printed flags give the same picture, as a map and before a camera.
#[test]
fn gpu_default_light_is_that_of_its_flags() {
    let folder = Folder::new();
    let input = write(&folder, "city.npy", &terrain::city(64).unwrap());
    for view in ["", " --camera west --size 96x54"] {
        let run = succeeded(&folder, &format!("render {input}{view} -o default.png"));
        let line = |name: &str| {
            let line = run.out.lines().find_map(|line| line.strip_prefix(name)).unwrap();
            line.split(" (").next().unwrap().trim().to_owned()
        };
        let flags = format!("{} {}{view}", line("Light: "), line("Picture: "));
        succeeded(&folder, &format!("render {input} {flags} -o asked.png --quiet"));
        let [default, asked] = ["default.png", "asked.png"]
            .map(|name| image::open(folder.path(name)).unwrap().to_rgb8());
        assert!(default == asked, "{flags}");
    }
}

/// A level field of albedo 1 under a sky of radiance 1 has radiance 1: 0.8 at any exposure that is not given.
#[test]
fn gpu_exposure_is_of_the_99th_percentile() {
    let folder = Folder::new();
    let field = HeightField::new(8, 8, &[3.0; 64], [1.0; 2], None).unwrap();
    let input = write(&folder, "level.npy", &field);
    for sky in ["1", "1e-6", "3e7"] {
        let args = format!("render {input} --sky {sky} --tint none -o out.png --quiet");
        succeeded(&folder, &args);
        // sRGB of 0.8 is 230.9; the exposure has four digits.
        let codes = luminances(&folder, "out.png");
        assert!(codes.iter().all(|code| (*code - 231.0).abs() <= 1.0), "{sky}: {codes:?}");
    }
}

/// A sun below the horizontal is night: no error, and no light but a sky of a millionth of its irradiance. The most exit
/// radiance under a sky is its radiance.
#[test]
fn gpu_a_sun_that_has_set_is_night() {
    let folder = Folder::new();
    let input = write(&folder, "dunes.npy", &terrain::dunes(32).unwrap());
    for sky in ["", " --sky clear"] {
        let run = succeeded(&folder, &format!("render {input} --sun 10,-5{sky} -o night.exr"));
        assert!(run.notes.starts_with("note: night: 1 sun is below"), "{}", run.notes);
        let night = ridgelight_io::read_planes(&folder.path("night.exr")).unwrap();
        let all = night.planes.concat();
        assert!(all.iter().all(|v| *v > 0.0 && *v < 1.01e-6), "{sky}");
    }
    succeeded(&folder, &format!("render {input} --sun 10,-5 --sky 0.5 -o dusk.exr --quiet"));
    succeeded(&folder, &format!("render {input} --sky 0.5 -o sky.exr --quiet"));
    let [dusk, sky] = ["dusk.exr", "sky.exr"]
        .map(|name| ridgelight_io::read_planes(&folder.path(name)).unwrap().planes);
    assert!(dusk == sky);
    let run = folder.run_str(&format!("render {input} --sun 10,-95 -o wrong.exr"));
    assert_eq!((run.status, run.notes.as_str()), (Some(2), ""), "{}", run.err);
    // A sun at elevation 0 does not light level ground.
    for (flags, is_black) in [("--sun 100,0,0", true), ("--sun 100,30", false)] {
        let run = succeeded(&folder, &format!("render {input} {flags} -o low.png"));
        assert_eq!(run.notes.contains("% of the picture is lit"), is_black, "{}", run.notes);
        // The drivers of the tests are software.
        assert!(run.out.contains(", compiling its shaders included.\n"), "{}", run.out);
    }
    // A picture of the night is dark. 0.8 is code 231 of sRGB, 0.08 code 80.
    for (flags, brightest) in [("--sun 10,-5", 80), ("--sun 10,-5 --sky 0.5", 231)] {
        succeeded(&folder, &format!("render {input} {flags} --tint none -o night.png --quiet"));
        let mut codes = image::open(folder.path("night.png")).unwrap().into_luma8().into_raw();
        codes.sort_unstable();
        let found = codes[99 * codes.len() / 100];
        assert!(found.abs_diff(brightest) <= 1, "{flags}: {found}");
    }
}

/// The default tint and any scale of specular make a picture.
#[test]
fn gpu_a_tint_leaves_room_for_specular() {
    let folder = Folder::new();
    let input = write(&folder, "dunes.npy", &terrain::dunes(16).unwrap());
    for flags in ["--specular 5,0.5", "--specular 5,0.5 --tint slope", "--specular 5,1 --tint land"]
    {
        succeeded(&folder, &format!("render {input} --sky 1 {flags} -o out.png --quiet"));
    }
}

/// A .png states the tint that it has.
#[test]
fn gpu_the_tint_is_in_the_metadata() {
    let folder = Folder::new();
    let input = write(&folder, "dunes.npy", &terrain::dunes(16).unwrap());
    for (flags, tint, albedo) in [
        ("", Some("land"), None),
        (" --tint none", None, Some("1")),
        (" --albedo 0.5", None, Some("0.5")),
    ] {
        succeeded(&folder, &format!("render {input}{flags} -o out.png --quiet"));
        let file = std::io::BufReader::new(std::fs::File::open(folder.path("out.png")).unwrap());
        let png = png::Decoder::new(file).read_info().unwrap();
        let texts = &png.info().uncompressed_latin1_text;
        let text = |name: &str| texts.iter().find(|t| t.keyword == name).map(|t| t.text.as_str());
        assert_eq!((text("tint"), text("albedo")), (tint, albedo), "{flags}");
    }
}

//! The decoders that `bake` writes beside its maps, run unchanged on the device over the files of a real field: each
//! within its manifest's stated error of the packed values.

mod harmonics;
mod light;
mod run;
mod turns;

use std::path::Path;
use std::process::Command;

use ridgelight_bake as bake;
use ridgelight_bake::Encoding;
use ridgelight_io::{Planes, read_planes};
use std::f64::consts::{FRAC_PI_2, PI};

use crate::Device;
use run::decode;

const AZIMUTHS: u32 = 8;
const ORDER: usize = 3;
const DIRECTIONS: usize = 8;
/// Radii of 100 and 400 km, outwards and inwards.
const CURVATURES: [f64; 2] = [1e-5, 2.5e-6];

/// A shader of `decoders/shaders/`, its decoder, and the decoder's named constants.
struct Decoder {
    kind: &'static str,
    spirv: &'static [u8],
    body: &'static str,
    encodings: &'static [Encoding],
    is_array: bool,
    /// Planes of its output.
    planes: usize,
    constants: fn(&Encoding) -> Vec<(&'static str, Constant)>,
}

#[derive(Clone, Copy)]
enum Constant {
    Int(i32),
    Float(f64),
    Bool(bool),
}

impl Constant {
    /// The specialisation constant's bits.
    fn bits(self) -> u32 {
        match self {
            Constant::Int(v) => v as u32,
            Constant::Float(v) => (v as f32).to_bits(),
            Constant::Bool(v) => u32::from(v),
        }
    }

    /// The line of the written decoder.
    fn line(self, name: &str) -> String {
        match self {
            Constant::Int(v) => format!("const int {name} = {v};\n"),
            Constant::Float(v) => format!("const float {name} = {v:?};\n"),
            Constant::Bool(v) => format!("const bool {name} = {v};\n"),
        }
    }
}

macro_rules! decoder {
    ($name:literal, $kind:literal, $encodings:expr, $is_array:literal, $planes:expr, $constants:expr) => {
        Decoder {
            kind: $kind,
            spirv: include_bytes!(concat!(env!("OUT_DIR"), "/", $name, ".spv")),
            body: include_str!(concat!(
                env!("CARGO_MANIFEST_DIR"),
                "/shaders_glsl/decode/",
                $name,
                ".glsl"
            )),
            encodings: &$encodings,
            is_array: $is_array,
            planes: $planes,
            constants: $constants,
        }
    };
}

use decoder;

fn count(_: &Encoding) -> Vec<(&'static str, Constant)> {
    vec![("SH_COUNT", Constant::Int((ORDER * ORDER) as i32))]
}

fn all() -> [Decoder; 9] {
    let horizon = |encoding: &Encoding| {
        let is_angle = encoding.name.ends_with("-angle");
        let scale = if is_angle { FRAC_PI_2 } else { 1.0 };
        let azimuths = ("HORIZON_AZIMUTHS", Constant::Int(AZIMUTHS as i32));
        vec![azimuths, ("HORIZON_SCALE", Constant::Float(scale))]
    };
    let bent = |encoding: &Encoding| {
        let is_octahedral = encoding.name.ends_with("-octahedral");
        let scale = if encoding.name == "f32" { 1.0 } else { PI };
        let octahedral = ("BENT_OCTAHEDRAL", Constant::Bool(is_octahedral));
        vec![
            octahedral,
            ("BENT_CONE_SCALE", Constant::Float(scale)),
            ("BENT_Y", Constant::Float(1.0)),
        ]
    };
    let curved = |_: &Encoding| {
        let [outwards, inwards] = CURVATURES.map(Constant::Float);
        vec![("CURVATURE_OUTWARDS", outwards), ("CURVATURE_INWARDS", inwards)]
    };
    let (none, squared) = (|_: &Encoding| Vec::new(), ORDER * ORDER);
    [
        decoder!("horizon", "horizon", bake::HORIZON, true, AZIMUTHS as usize, horizon),
        decoder!("sky_view", "sky-view", bake::SHARE, false, 1, none),
        decoder!("visible_sky", "visible-sky", bake::SHARE, false, 1, none),
        decoder!("bent_normal", "bent-normal", bake::BENT_NORMAL, false, 4, bent),
        decoder!("sh_visibility", "sh-visibility", bake::COEFFICIENTS, true, squared, count),
        decoder!("sh_transfer", "sh-transfer", bake::COEFFICIENTS, true, squared, count),
        decoder!("ellipse", "ellipse", bake::ELLIPSE, true, 7, none),
        decoder!("curved_ellipse", "curved-ellipse", bake::CURVED_ELLIPSE, true, 26, curved),
        decoder!("visible_points", "visible-points", bake::POINTS, true, 2 * DIRECTIONS + 1, none),
    ]
}

/// Kinds with a larger range under border `open`: horizons below horizontal, where they can be packed, and cones
/// beyond π/2.
fn is_lower(decoder: &Decoder, number: usize) -> bool {
    match decoder.kind {
        "horizon" => numbered(decoder, number).component.is_signed(),
        kind => kind == "bent-normal",
    }
}

/// Bakes the middle of the bundled field, 96 × 96 of its 256 × 256 texels, each kind with its encoding of this number
/// (or its last), beside its values. `more` are further words of the command line.
fn baked(folder: &Path, number: usize, more: &[&str], wanted: &[Decoder]) -> serde_json::Value {
    let (mut kinds, mut encodings) = (Vec::new(), Vec::new());
    for decoder in wanted {
        kinds.push(decoder.kind);
        encodings.push(format!("{}={}", decoder.kind, numbered(decoder, number).name));
    }
    let bundled = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/mt_washington_256.png");
    let field = folder.join("field.png");
    let bundled = image::open(bundled).expect("the bundled field");
    bundled.crop_imm(80, 80, 96, 96).save(&field).expect("a field");
    let done = Command::new(crate::program())
        .arg("bake")
        .arg(&field)
        .args("--cell 66,92.6 --z-scale 3 --method sweep --format ktx2,npy --quiet".split(' '))
        .args(
            wanted
                .iter()
                .any(|d| d.kind == "ellipse")
                .then_some(format!("--directions={DIRECTIONS}")),
        )
        .args(
            wanted.iter().any(|d| d.kind == "curved-ellipse").then_some("--curvature=1e-5,2.5e-6"),
        )
        .args(more)
        .args(["--azimuths", &AZIMUTHS.to_string(), "--sh-order", &ORDER.to_string()])
        .args(["--what", &kinds.join(","), "--encoding", &encodings.join(",")])
        .arg("-o")
        .arg(folder)
        .output()
        .expect("the binary");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let manifest = std::fs::read(folder.join("manifest.json")).expect("a manifest");
    serde_json::from_slice(&manifest).expect("JSON")
}

fn numbered(decoder: &Decoder, number: usize) -> &'static Encoding {
    &decoder.encodings[number.min(decoder.encodings.len() - 1)]
}

/// The manifest's stated errors of a map's texture: for what, at most, and a share of the value.
fn promised(manifest: &serde_json::Value, kind: &str) -> Vec<(String, f64, f64)> {
    let maps = manifest["maps"].as_array().expect("maps");
    let map = maps.iter().find(|map| map["kind"] == kind).expect("the map");
    assert!(map["beyond_range"].is_null(), "{kind}: values beyond what is encoded");
    let files = map["files"].as_array().expect("files");
    let texture = files.iter().find(|file| file["format"] == "ktx2").expect("a texture");
    let errors = texture["error"].as_array().expect("errors").iter();
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let of = |e: &serde_json::Value| e["of"].as_str().expect("a text").to_owned();
    errors.map(|e| (of(e), number(&e["at_most"]), number(&e["and_of_the_value"]))).collect()
}

/// The largest error of the decoded values as a share of the stated one, and where.
fn worst(
    promised: &[(String, f64, f64)],
    found: &[f32],
    ground_truth: &Planes,
    slack: f64,
) -> (f64, String) {
    let texels = ground_truth.rows * ground_truth.cols;
    let at = |plane: usize, i: usize| {
        (f64::from(found[plane * texels + i]), f64::from(ground_truth.planes[plane][i]))
    };
    let mut worst = (0.0, String::new());
    for (of, absolute, relative) in promised {
        let mut hold = |is: f64, was: f64| {
            let share = (is - was).abs() / (absolute + relative * was.abs() + slack);
            // An error of 0 where none is allowed; and NaN.
            let share = if is == was { 0.0 } else { share };
            let share = if share.is_nan() { f64::INFINITY } else { share };
            if share > worst.0 {
                worst = (share, of.clone());
            }
        };
        for i in 0..texels {
            let each = |plane| at(plane, i);
            match of.as_str() {
                "direction" => {
                    let [a, b] = [0, 1].map(|side| {
                        glam::DVec3::from_array([0, 1, 2].map(|p| [each(p).0, each(p).1][side]))
                    });
                    hold(a.cross(b).length().atan2(a.dot(b)), 0.0);
                }
                "cone's half-angle" => hold(each(3).0, each(3).1),
                "components of the direction" => (0..3).for_each(|p| hold(each(p).0, each(p).1)),
                "sine of the elevation" => (0..ground_truth.planes.len()).for_each(|p| {
                    let (sine, elevation) = each(p);
                    hold(sine, elevation.sin());
                }),
                "elevation" | "share" | "coefficient" | "number" | "row and column" | "colour" => {
                    (0..ground_truth.planes.len()).for_each(|p| hold(each(p).0, each(p).1));
                }
                other => panic!("no test of {other}"),
            }
        }
    }
    worst
}

/// Whether a written decoder is `text` after lines of comment.
fn is_after_comments(written: &str, text: &str) -> bool {
    let comments = written.strip_suffix(text);
    comments.is_some_and(|lines| lines.lines().all(|line| line.starts_with("//")))
}

/// Every decoder with every encoding of its kind.
#[test]
fn decoders_keep_the_errors_that_manifests_state() {
    let device = Device::new();
    let gpu = device.gpu.as_ref().expect("alive");
    let most = all().iter().map(|d| d.encodings.len()).max().expect("some");
    let mut lowest = f32::INFINITY;
    let mut widest = f32::NEG_INFINITY;
    for (number, border) in (0..most).flat_map(|number| [(number, "plane"), (number, "open")]) {
        let is_open = border == "open";
        let folder = tempfile::tempdir().expect("a folder");
        let wanted: Vec<Decoder> =
            all().into_iter().filter(|d| !is_open || is_lower(d, number)).collect();
        let manifest = baked(folder.path(), number, &["--border", border], &wanted);
        for decoder in wanted.iter().filter(|d| number < d.encodings.len()) {
            let encoding = numbered(decoder, number);
            let stem = decoder.kind.replace('-', "_");
            let path = |extension: &str| folder.path().join(format!("{stem}.{extension}"));
            // The written decoder is the compiled one, after comments and its specialisation constants.
            let constants = (decoder.constants)(encoding);
            let lines: String = constants.iter().map(|(name, c)| c.line(name)).collect();
            let written = std::fs::read_to_string(path("glsl")).expect("a decoder");
            assert!(is_after_comments(&written, &(lines + decoder.body)), "{stem}.glsl: {written}");
            let bits: Vec<u32> = constants.iter().map(|(_, c)| c.bits()).collect();

            let mut ground_truth = read_planes(&path("npy")).expect("values");
            if decoder.kind == "horizon" {
                // An .npy has azimuths clockwise from north, a texture counter-clockwise from east.
                ground_truth.planes.reverse();
                ground_truth.planes.rotate_right(AZIMUTHS as usize / 4 + 1);
            }
            let texture = std::fs::read(path("ktx2")).expect("a texture");
            let promised = promised(&manifest, decoder.kind);
            // An azimuth is within m 2^-22 of a step of the requested one, across which horizons change by no more
            // than a right angle, two where they may be below horizontal.
            let is_horizon = decoder.kind == "horizon";
            let across = if is_open { PI } else { FRAC_PI_2 };
            let slack =
                if is_horizon { across * f64::from(AZIMUTHS) / f64::from(1 << 22) } else { 0.0 };
            match decoder.kind {
                "horizon" => {
                    lowest = ground_truth.planes.iter().flatten().copied().fold(lowest, f32::min)
                }
                "bent-normal" => {
                    widest = ground_truth.planes[3].iter().copied().fold(widest, f32::max)
                }
                _ => {}
            }
            let found = decode(gpu, decoder, &bits, &texture, 0.0);
            let (share, of) = worst(&promised, &found, &ground_truth, slack);
            println!("{} {}: {share:.3} of the bound of the {of}", decoder.kind, encoding.name);
            assert!(share <= 1.0, "{} {}: {share} of {of}", decoder.kind, encoding.name);

            // The comparison fails for an error of three bounds.
            let mut off = found.clone();
            let (_, absolute, relative) = promised[promised.len() - 1].clone();
            let last = ground_truth.planes.len() * ground_truth.rows * ground_truth.cols - 1;
            let is_sine = promised[0].0.starts_with("sine");
            let value = f64::from(
                ground_truth.planes[ground_truth.planes.len() - 1].last().copied().expect("some"),
            );
            let value = if is_sine { value.sin() } else { value };
            off[last] = (value
                + 3.0 * (absolute + relative * value.abs() + slack)
                + 1e-6 * value.abs().max(1.0)) as f32;
            assert!(
                worst(&promised, &off, &ground_truth, slack).0 > 1.0,
                "{}: cannot fail",
                decoder.kind
            );

            if decoder.kind == "ellipse" {
                lit_as_stated(&found, &ground_truth, promised[0].2);
            }
            if decoder.kind == "curved-ellipse" {
                curved_as_stated(&found, &ground_truth, promised[0].2);
            }
            if decoder.kind == "visible-points" {
                shared_as_stated(&found, &ground_truth);
            }
            // Between two azimuths both count equally.
            if is_horizon && !is_sine {
                let found = decode(gpu, decoder, &bits, &texture, 0.5);
                let first = ground_truth.planes.clone();
                for (k, plane) in ground_truth.planes.iter_mut().enumerate() {
                    let next = &first[(k + 1) % first.len()];
                    plane.iter_mut().zip(next).for_each(|(a, b)| *a = 0.5 * (*a + b));
                }
                let (share, of) = worst(&promised, &found, &ground_truth, slack);
                assert!(share <= 1.0, "between azimuths, {}: {share} of {of}", encoding.name);
            }
        }
    }
    // Values that only an open border has are among them.
    assert!(lowest < 0.0 && f64::from(widest) > FRAC_PI_2, "{lowest}, {widest}");
}

/// Textures whose y points south (DirectX) have the directions of the .npy, whose y points north, by the same decoder with
/// the other sign; with the sign of OpenGL it fails.
#[test]
fn decoders_turn_the_normals_of_directx() {
    let device = Device::new();
    let gpu = device.gpu.as_ref().expect("alive");
    let of_normals = || all().into_iter().filter(|d| d.kind == "bent-normal").collect::<Vec<_>>();
    for number in 0..bake::BENT_NORMAL.len() {
        let folder = tempfile::tempdir().expect("a folder");
        let wanted = of_normals();
        let manifest = baked(folder.path(), number, &["--normals", "directx"], &wanted);
        assert_eq!(manifest["maps"][0]["normals"]["convention"], "DirectX, -Y");
        let (decoder, encoding) = (&wanted[0], numbered(&wanted[0], number));
        let path = |extension: &str| folder.path().join(format!("bent_normal.{extension}"));
        let ground_truth = read_planes(&path("npy")).expect("values");
        let texture = std::fs::read(path("ktx2")).expect("a texture");
        let promised = promised(&manifest, decoder.kind);
        let share = |y: f64| {
            let mut constants = (decoder.constants)(encoding);
            let own = constants.iter_mut().find(|(name, _)| *name == "BENT_Y").expect("a constant");
            own.1 = Constant::Float(y);
            let bits: Vec<u32> = constants.iter().map(|(_, c)| c.bits()).collect();
            let lines: String = constants.iter().map(|(name, c)| c.line(name)).collect();
            let written = std::fs::read_to_string(path("glsl")).expect("a decoder");
            let is_own = is_after_comments(&written, &(lines + decoder.body));
            assert_eq!(is_own, y < 0.0, "bent_normal.glsl");
            worst(&promised, &decode(gpu, decoder, &bits, &texture, 0.0), &ground_truth, 0.0)
        };
        let (found, of) = share(-1.0);
        assert!(found <= 1.0, "{}: {found} of {of}", encoding.name);
        let (other, _) = share(1.0);
        assert!(other > 1.0, "{}: the sign changes nothing", encoding.name);
    }
}

/// The last plane is the ellipses' test for a light, except where the stated error of a number (centre up to 4, radii)
/// may move the light over the edge: 1 / radius times that of the centre and the axis' 1.6 at most, and of itself,
/// squared.
fn lit_as_stated(found: &[f32], ground_truth: &Planes, share: f64) {
    let (texels, light) =
        (ground_truth.rows * ground_truth.cols, glam::DVec3::new(0.6, 0.48, 0.64));
    let mut counts = [0; 2];
    for i in 0..texels {
        let of = |plane: usize| ground_truth.planes[plane][i];
        let ellipse = bake::Ellipse::of_texels([0, 1, 2, 3].map(of), [of(4), of(5)]);
        let [a, b] = ellipse.inverse_radii;
        let centre = ellipse.centre.length();
        let place = (1.0 + 3.0 * centre) * (a + b);
        if (ellipse.reach(light) - 1.0).abs() > 4.0 * share * (1.0 + place) {
            let is_lit = ellipse.holds(light);
            assert_eq!(found[6 * texels + i], f32::from(u8::from(is_lit)), "{i}: {ellipse:?}");
            counts[usize::from(is_lit)] += 1;
        }
    }
    assert!(counts[0] > 0 && counts[1] > 0, "{counts:?}");
}

/// The last plane is the test between five ellipses on a base with half of their curvature: |adj P v| ≤ det P, except
/// where the stated error of a number n may move it over the edge: three numbers move each of P's by 2 n at most and
/// the centre's, so that |adj P v| errs by 2 n (|v| + 2 max P) and det P by 4 n max P.
fn curved_as_stated(found: &[f32], ground_truth: &Planes, share: f64) {
    let (texels, light) =
        (ground_truth.rows * ground_truth.cols, glam::DVec3::new(0.6, 0.48, 0.64));
    let curvature =
        ridgelight::scene::Curvature { per_m: [0.5 * CURVATURES[0], -0.5 * CURVATURES[1]] };
    let mut counts = [0; 2];
    for i in 0..texels {
        let of = |plane: usize| f64::from(ground_truth.planes[plane][i]);
        let numbers = std::array::from_fn(|k| {
            [of(4 * k), of(4 * k + 1), of(4 * k + 2), of(4 * k + 3), of(20 + k)]
        });
        let five = bake::CurvedEllipses { numbers, steps_per_m: CURVATURES };
        let [x, y, xx, yy, xy] = five.at(curvature);
        let v = [light.x - x, light.y - y];
        let largest = numbers.iter().flatten().fold(0.0_f64, |m, n| m.max(n.abs()));
        let (length, area) =
            ((yy * v[0] - xy * v[1]).hypot(xx * v[1] - xy * v[0]), xx * yy - xy * xy);
        let n = 2.0 * (share + 1e-6) * largest;
        let off = 2.0 * n * (v[0].hypot(v[1]) + 4.0 * largest);
        if (length - area).abs() > off && area.abs() > off {
            let is_lit = five.holds(curvature, light);
            assert_eq!(found[25 * texels + i], f32::from(u8::from(is_lit)), "{i}: {five:?}");
            counts[usize::from(is_lit)] += 1;
        }
    }
    assert!(counts[0] > 0 && counts[1] > 0, "{counts:?}");
}

/// The last plane is the visible share of a light between the first three directions with weights 0.5, 0.3 and 0.2:
/// sums over those that see the sky, a rounding each.
fn shared_as_stated(found: &[f32], ground_truth: &Planes) {
    let texels = ground_truth.rows * ground_truth.cols;
    let mut stated = std::collections::BTreeSet::new();
    for i in 0..texels {
        let shows_sky = |k: &usize| ground_truth.planes[2 * k][i] == -1.0;
        let want: f64 = (0..3).filter(shows_sky).map(|k| [0.5, 0.3, 0.2][k]).sum();
        let got = f64::from(found[2 * DIRECTIONS * texels + i]);
        assert!((got - want).abs() <= 3.0 / f64::from(1 << 24), "{i}: {got} {want}");
        stated.insert((10.0 * want).round() as u32);
    }
    assert!(stated.len() > 1, "all alike: {stated:?}");
}

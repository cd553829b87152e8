//! Decoders of baked light: of a small periodic field, each with both of its encodings.

use std::f64::consts::FRAC_PI_2;
use std::path::Path;
use std::process::Command;

use ridgelight_bake as bake;
use ridgelight_bake::{Angles, Encoding};
use ridgelight_io::{Planes, read_planes};

use super::{Constant, Decoder, decode, decoder, is_after_comments, numbered, promised, worst};
use crate::Device;

const ANGLES: Angles = Angles { zeniths: 2, azimuths: 4 };
const FACTORS: usize = 8;
const ORDER: i32 = 2;

fn angles(prefix: &'static [&'static str; 2]) -> Vec<(&'static str, Constant)> {
    let counts = [ANGLES.zeniths, ANGLES.azimuths];
    prefix.iter().zip(counts).map(|(name, n)| (*name, Constant::Int(n as i32))).collect()
}

fn all() -> [Decoder; 6] {
    let none = |_: &Encoding| Vec::new();
    let of_btf = |_: &Encoding| angles(&["BTF_THETAS", "BTF_PHIS"]);
    let of_field = |_: &Encoding| angles(&["LIGHT_FIELD_THETAS", "LIGHT_FIELD_PHIS"]);
    let of_brdf = |_: &Encoding| angles(&["BRDF_THETAS", "BRDF_PHIS"]);
    let of_factors = |_: &Encoding| {
        let mut all = angles(&["BRDF_THETAS", "BRDF_PHIS"]);
        all.push(("BRDF_FACTORS", Constant::Int(FACTORS as i32)));
        all.push(("BRDF_VIEWS", Constant::Int(0)));
        all
    };
    let of_harmonics = |_: &Encoding| {
        vec![("BRDF_ORDER", Constant::Int(ORDER)), ("BRDF_TERMS", Constant::Int(ORDER * ORDER))]
    };
    [
        decoder!("scatter", "scatter", bake::RADIANCE, true, 6, none),
        decoder!("btf", "btf", bake::TEXELS, true, 4 * ANGLES.count().pow(2), of_btf),
        decoder!("light_field", "light-field", bake::TEXELS, true, 4 * ANGLES.count(), of_field),
        decoder!("brdf", "brdf", bake::REFLECTED, false, 3, of_brdf),
        decoder!(
            "brdf_factors",
            "brdf-factors",
            bake::REFLECTED,
            true,
            3 * FACTORS + 3,
            of_factors
        ),
        decoder!(
            "brdf_harmonics",
            "brdf-harmonics",
            bake::HARMONIC_WEIGHTS,
            false,
            5,
            of_harmonics
        ),
    ]
}

/// All kinds of one field, beside their values.
fn baked(folder: &Path, number: usize) -> serde_json::Value {
    let heights: Vec<f32> = (0..7 * 6).map(|i| (i * 5 % 7) as f32 * 0.4).collect();
    let field = folder.join("field.npy");
    ridgelight_io::write_npy_f32(&field, &[7, 6], [heights.as_slice()]).expect("a field");
    let all = all();
    let kinds: Vec<&str> = all.iter().map(|d| d.kind).collect();
    let encodings = all.iter().map(|d| format!("{}={}", d.kind, numbered(d, number).name));
    let words = "--border periodic --format ktx2,exr --quiet --sun 200,50 --sky 0.2 --albedo 0.7,0.5,0.2 \
                 --directions 16 --bounces 2 --paths 16 --azimuths 8 --sh-order 2";
    let done = Command::new(crate::program())
        .arg("bake")
        .arg(&field)
        .args(words.split_whitespace())
        .args(["--angles", &format!("{}x{}", ANGLES.zeniths, ANGLES.azimuths)])
        .args(["--what", &kinds.join(",")])
        .args(["--encoding", &encodings.collect::<Vec<_>>().join(",")])
        .arg("-o")
        .arg(folder.join("out"))
        .output()
        .expect("the binary");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let manifest = std::fs::read(folder.join("out/manifest.json")).expect("a manifest");
    serde_json::from_slice(&manifest).expect("JSON")
}

/// Planes of an .exr, which sorts them by name, in the order of the manifest.
fn in_order(manifest: &serde_json::Value, kind: &str, mut read: Planes) -> Planes {
    let maps = manifest["maps"].as_array().expect("maps");
    let map = maps.iter().find(|map| map["kind"] == kind).expect("the map");
    let names = map["planes"].as_array().expect("names");
    let names: Vec<String> = names.iter().map(|n| n.as_str().expect("a name").into()).collect();
    let of = |name: &String| {
        let at = read.names.iter().position(|n| n == name);
        read.planes[at.unwrap_or_else(|| panic!("{name} in {:?}", read.names))].clone()
    };
    read.planes = names.iter().map(of).collect();
    Planes { names, ..read }
}

/// Error of a value read between two angles instead of at one: places are within 8 roundings of a count of steps,
/// along four axes, and no difference is larger than the largest value.
fn beside(ground_truth: &Planes) -> f64 {
    let most = ground_truth.planes.iter().flatten().fold(0.0_f32, |m, v| m.max(v.abs()));
    4.0 * 8.0 * ANGLES.azimuths as f64 / f64::from(1 << 24) * f64::from(most)
}

#[test]
fn decoders_of_light_keep_the_errors_that_manifests_state() {
    let device = Device::new();
    let gpu = device.gpu.as_ref().expect("alive");
    for number in 0..2 {
        let folder = tempfile::tempdir().expect("a folder");
        let manifest = baked(folder.path(), number);
        for decoder in all() {
            let encoding = numbered(&decoder, number);
            let stem = decoder.kind.replace('-', "_");
            let path = |extension: &str| folder.path().join(format!("out/{stem}.{extension}"));
            let constants = (decoder.constants)(encoding);
            let lines: String = constants.iter().map(|(name, c)| c.line(name)).collect();
            let written = std::fs::read_to_string(path("glsl")).expect("a decoder");
            assert!(is_after_comments(&written, &(lines + decoder.body)), "{stem}.glsl: {written}");
            let is_code = |line: &&str| !line.is_empty() && !line.starts_with("//");
            assert!(decoder.body.lines().filter(is_code).count() <= 20, "{stem}");
            let bits: Vec<u32> = constants.iter().map(|(_, c)| c.bits()).collect();
            let ground_truth =
                in_order(&manifest, decoder.kind, read_planes(&path("exr")).expect("values"));
            let texture = std::fs::read(path("ktx2")).expect("a texture");
            let promised = promised(&manifest, decoder.kind);
            let is_between = ["brdf", "brdf-factors"].contains(&decoder.kind);
            let slack = if is_between { beside(&ground_truth) } else { 0.0 };
            let found = decode(gpu, &decoder, &bits, &texture, 0.0);
            let (share, of) = worst(&promised, &found, &ground_truth, slack);
            println!("{} {}: {share:.3} of the bound of the {of}", decoder.kind, encoding.name);
            assert!(share <= 1.0, "{} {}: {share} of {of}", decoder.kind, encoding.name);
            // The comparison can fail, and not everything is 0.
            let mut off = found.clone();
            let most = (0..ground_truth.planes.len() * ground_truth.rows * ground_truth.cols)
                .max_by(|a, b| found[*a].total_cmp(&found[*b]))
                .expect("values");
            off[most] *= 1.01;
            assert!(
                worst(&promised, &off, &ground_truth, slack).0 > 1.0,
                "{}: cannot fail",
                decoder.kind
            );
            match decoder.kind {
                "brdf" => between(
                    &decode(gpu, &decoder, &bits, &texture, 0.5),
                    &ground_truth,
                    promised[0].2,
                ),
                "brdf-factors" => products(&found, &ground_truth, promised[0].2),
                _ => {}
            }
        }
    }
}

/// Halfway to the next azimuths of light and view the table is the mean of four pairs.
fn between(found: &[f32], ground_truth: &Planes, share: f64) {
    let count = ANGLES.count();
    let next = |i: usize| i / ANGLES.azimuths * ANGLES.azimuths + (i + 1) % ANGLES.azimuths;
    for (light, view) in (0..count * count).map(|i| (i / count, i % count)) {
        for (c, plane) in ground_truth.planes.iter().enumerate() {
            let corners = [
                (light, view),
                (next(light), view),
                (light, next(view)),
                (next(light), next(view)),
            ];
            let sum: f64 = corners.iter().map(|(l, v)| f64::from(plane[l * count + v])).sum();
            let got = f64::from(found[c * count * count + light * count + view]);
            let allowed = 0.25 * sum * (share + 1e-6) + beside(ground_truth);
            assert!((got - 0.25 * sum).abs() <= allowed, "{light} {view}: {got} {}", 0.25 * sum);
        }
    }
}

/// The sum over factors of a light of the grid and a view between: products of decoded values, each with its share of
/// error.
fn products(found: &[f32], ground_truth: &Planes, share: f64) {
    let (size, view) = (ANGLES.count(), [0.5_f64, 2.0]);
    let e = glam::DVec3::new(
        view[0].sin() * view[1].cos(),
        view[0].sin() * view[1].sin(),
        view[0].cos(),
    );
    let around = ANGLES.around(e);
    assert!(view[0] < FRAC_PI_2);
    for (i, c) in (0..3 * size).map(|i| (i / 3, i % 3)) {
        let (mut sum, mut all) = (0.0, 0.0);
        for k in 0..FACTORS {
            let plane = &ground_truth.planes[3 * k + c];
            let of_view: f64 = around.iter().map(|(i, part)| part * f64::from(plane[*i])).sum();
            let most = around.iter().map(|(i, _)| plane[*i].abs()).fold(0.0, f32::max);
            sum += f64::from(plane[i]) * of_view;
            all += f64::from(plane[i].abs() * most);
        }
        let got = f64::from(found[(3 * FACTORS + c) * size + i]);
        let slack = beside(ground_truth)
            * ground_truth.planes.iter().flatten().fold(0.0_f32, |m, v| m.max(v.abs())) as f64;
        let allowed = 3.0 * (share + 1e-6) * all + 2.0 * FACTORS as f64 * slack;
        assert!((got - sum).abs() <= allowed, "{i}: {got} {sum} {allowed}");
    }
}

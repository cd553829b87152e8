//! Baked light, loaded by independent readers: against closed forms and against each other.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::path::Path;

use glam::DVec3;
use serde_json::Value;

use crate::formats::npy;
use crate::needs_vulkan::{done, json};
use crate::v_grooves::{groove_bound, groove_brdf};
use crate::{Folder, refused, succeeded};

/// Reads an f32 array by NumPy's header: shape, and values with the last axis fastest.
pub fn load(path: &Path) -> (Vec<usize>, Vec<f32>) {
    let bytes = std::fs::read(path).unwrap();
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    let end = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = std::str::from_utf8(&bytes[10..end]).unwrap();
    assert!(header.contains("'<f4'") && header.contains("False"), "{header}");
    let shape = header.split(['(', ')']).nth(1).unwrap();
    let shape = shape.split(',').filter_map(|n| n.trim().parse().ok()).collect();
    let values = bytes[end..].as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b));
    (shape, values.collect())
}

/// A table and its angles from the manifest: f(channel, light, view), light and view by their (θ, φ) indices.
pub struct Table {
    thetas: Vec<f64>,
    phis: Vec<f64>,
    values: Vec<f32>,
}

impl Table {
    pub fn load(folder: &Path) -> Self {
        let manifest = json(&folder.join("manifest.json"));
        let map =
            manifest["maps"].as_array().unwrap().iter().find(|m| m["kind"] == "brdf").unwrap();
        let radians = |name: &str| -> Vec<f64> {
            let all = map["angles"][name].as_array().unwrap().iter();
            all.map(|v| v.as_f64().unwrap().to_radians()).collect()
        };
        let (thetas, phis) = (radians("thetas_deg"), radians("phis_deg"));
        let (shape, values) = load(&folder.join("brdf.npy"));
        assert_eq!(shape, [3, thetas.len(), phis.len(), thetas.len(), phis.len()]);
        let axes: Vec<&str> =
            map["axes"].as_array().unwrap().iter().map(|a| a["axis"].as_str().unwrap()).collect();
        assert_eq!(axes, ["channel", "theta_i", "phi_i", "theta_o", "phi_o"]);
        Self { thetas, phis, values }
    }

    pub fn directions(&self) -> Vec<DVec3> {
        let of = |theta: &f64, phi: &f64| {
            DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
        };
        self.thetas.iter().flat_map(|t| self.phis.iter().map(move |p| of(t, p))).collect()
    }

    pub fn at(&self, channel: usize, light: usize, view: usize) -> f64 {
        let count = self.thetas.len() * self.phis.len();
        f64::from(self.values[(channel * count + light) * count + view])
    }
}

pub fn write(
    folder: &Folder,
    name: &str,
    [rows, cols]: [usize; 2],
    height: impl Fn(usize, usize) -> f32,
) {
    let data: Vec<u8> =
        (0..rows * cols).flat_map(|i| height(i / cols, i % cols).to_le_bytes()).collect();
    folder.write(name, &npy("<f4", false, &format!("({rows}, {cols})"), &data));
}

/// Level ground is ρ/π. Grooves match their closed form within the error of the triangles: columns of a wall are cut
/// eightfold. The BRDF is reciprocal up to f32.
#[test]
fn gpu_tables_are_loaded_back() {
    const WALL: usize = 8;
    let folder = Folder::new();
    write(&folder, "level.npy", [3, 4], |_, _| 2.0);
    write(&folder, "grooves.npy", [2, 2 * WALL], |_, c| c.abs_diff(WALL) as f32);
    let words =
        "--border periodic --what brdf --bounces 0 --angles 6x8 --albedo 0.8,0.5,0.1 --format npy";
    let albedo = [0.8, 0.5, 0.1];
    for name in ["level", "grooves"] {
        // Level ground scatters nothing, whatever the bounces.
        let words = if name == "level" {
            words.replace("--bounces 0", "--bounces 2")
        } else {
            words.into()
        };
        done(&folder, &format!("bake {name}.npy -o {name} {words}"));
        let table = Table::load(&folder.path(name));
        let directions = table.directions();
        for (k, theta) in table.thetas.iter().enumerate() {
            assert!((theta - (k as f64 + 0.5) * FRAC_PI_2 / 6.0).abs() < 1e-9);
        }
        assert!(
            table.phis.iter().enumerate().all(|(j, phi)| (phi - TAU * j as f64 / 8.0).abs() < 1e-9)
        );
        let (mut worst, mut turned) = (0.0_f64, 0.0_f64);
        for (l, light) in directions.iter().enumerate() {
            for (v, view) in directions.iter().enumerate() {
                let (known, bound) = match name {
                    "level" => (1.0 / PI, 0.0),
                    _ => (groove_brdf(*light, *view), groove_bound(8 * WALL, *light, *view)),
                };
                for (c, albedo) in albedo.iter().enumerate() {
                    let (got, known) = (table.at(c, l, v), albedo * known);
                    // Rounding of the table to f32, and of the finer heights: their slopes err by 2⁻²⁴ of 8 over an eighth.
                    let allowed = known * (bound + 1e-4) + 1e-9;
                    worst = worst.max((got - known).abs() / allowed);
                    assert!((got - table.at(c, v, l)).abs() <= 1e-6 * got, "{name}: {l} {v}");
                }
                let mirrored = groove_brdf(*light, DVec3::new(-view.x, view.y, view.z));
                turned = turned.max((table.at(0, l, v) - 0.8 * mirrored).abs());
            }
        }
        println!("{name}: {worst:.3} of what is allowed");
        assert!(worst <= 1.0, "{name}: {worst}");
        // Swapped or reversed axes would fail.
        assert!(name == "level" || turned > 0.1, "{turned}");
    }
}

/// Pictures of all pairs average to the table: view shares average to cos θ, and radiance over the shares and over the light's
/// cos θ is the table, scattered light included. A light field has the same shares; its light does not depend on the view.
#[test]
fn gpu_pictures_are_the_table_in_the_mean() {
    pictures_are_the_table("--albedo 0.9,0.6,0.2", false);
}

/// The same with specular, whose light depends on the view.
#[test]
fn gpu_pictures_with_specular_are_the_table_in_the_mean() {
    pictures_are_the_table("--albedo 0.5,0.4,0.2 --specular 4,0.4", true);
}

fn pictures_are_the_table(surface: &str, turns: bool) {
    const SIDE: usize = 6;
    let folder = Folder::new();
    write(&folder, "field.npy", [SIDE, SIDE], |r, c| ((r * 5 + c * 3) % 7) as f32 * 0.5);
    let words = "--border periodic --angles 3x4 --bounces 2 --paths 32 --directions 64 --format npy --sun 200,40 --sky 0.1";
    done(
        &folder,
        &format!("bake field.npy -o out --quiet {words} {surface} --what brdf,btf,light-field"),
    );
    let table = Table::load(&folder.path("out"));
    let directions = table.directions();
    let (count, texels) = (directions.len(), SIDE * SIDE);
    let (shape, btf) = load(&folder.path("out/btf.npy"));
    assert_eq!(shape, [4 * count * count, SIDE, SIDE]);
    let (_, lit) = load(&folder.path("out/light_field.npy"));
    let plane = |of: &[f32], n: usize| -> Vec<f64> {
        of[n * texels..(n + 1) * texels].iter().map(|v| f64::from(*v)).collect()
    };
    let (mut brightest, mut turned) = ([0.0_f64; SIDE * SIDE], 0);
    for (l, v) in (0..count * count).map(|i| (i / count, i % count)) {
        let shares = plane(&btf, 4 * (l * count + v) + 3);
        let whole: f64 = shares.iter().sum();
        let z = directions[v].z;
        // Rounding of f32 sums.
        assert!((whole / texels as f64 - z).abs() < 1e-6, "{l} {v}: {whole}");
        for c in 0..3 {
            let light = plane(&btf, 4 * (l * count + v) + c);
            let mean = light.iter().zip(&shares).map(|(l, s)| l * s).sum::<f64>() / whole;
            let (got, known) = (mean / directions[l].z, table.at(c, l, v));
            assert!((got - known).abs() <= 1e-5 * known, "{l} {v} {c}: {got} {known}");
        }
        let own = plane(&lit, 4 * v + 3);
        assert!(own.iter().zip(&shares).all(|(a, b)| (a - b).abs() < 1e-6), "shares of {v}");
        for (texel, light) in plane(&lit, 4 * v).into_iter().enumerate() {
            if own[texel] > 0.0 {
                let first = brightest[texel];
                assert!(turns || first == 0.0 || first == light, "{v}: {first} {light}");
                turned += usize::from(first != 0.0 && first != light);
                brightest[texel] = light;
            } else {
                assert_eq!(light, 0.0, "hidden texel {texel} of {v}");
            }
        }
    }
    assert!(brightest.iter().all(|l| *l > 0.0), "{brightest:?}");
    assert!((turned > 0) == turns, "{turned}");
}

pub fn noise(folder: &Folder, out: &str) -> Value {
    let manifest = json(&folder.path(out).join("manifest.json"));
    manifest["maps"][0]["monte_carlo_noise"].clone()
}

/// Seeds differ by the Monte Carlo noise of the manifest: two differ by √2 σ. All texels share their directions, so the mean
/// square of six pairs of four seeds has few degrees of freedom: within a factor of three. Sixteen times as many paths leave a
/// quarter of the noise, or less where each part takes every direction once; surely less than three quarters.
#[test]
fn gpu_scattered_light_reports_its_noise() {
    let folder = Folder::new();
    write(&folder, "field.npy", [8, 8], |r, c| ((r * 5 + c * 3) % 7) as f32);
    let of = |out: &str, more: &str| {
        let words = "--border periodic --albedo 0.8 --sun 200,50 --what scatter --bounces 2 --directions 128 --format npy,exr";
        done(&folder, &format!("bake field.npy -o {out} {words} {more}"));
        load(&folder.path(out).join("scatter.npy"))
    };
    let seeds: Vec<_> = (0..4)
        .map(|seed| of(&format!("s{seed}"), &format!("--paths 64 --seed {seed}")).1)
        .collect();
    let (mut apart, mut pairs) = (0.0, 0.0);
    for (a, b) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
        // Radiance: the first three planes.
        let squares =
            seeds[a][..192].iter().zip(&seeds[b][..192]).map(|(a, b)| f64::from(a - b).powi(2));
        apart += squares.sum::<f64>() / 192.0;
        pairs += 1.0;
    }
    let found = f64::sqrt(apart / pairs / 2.0);
    let said = noise(&folder, "s0")["rms_standard_error"].as_f64().unwrap();
    println!("{found:.5} found, {said:.5} said");
    assert!(found > said / 3.0 && found < 3.0 * said, "{found} {said}");
    let (shape, _) = of("more", "--paths 1024");
    assert_eq!(shape, [6, 8, 8]);
    let less = noise(&folder, "more")["rms_standard_error"].as_f64().unwrap();
    assert!(less < 0.75 * said, "{less} {said}");
    assert_eq!(noise(&folder, "more")["paths"], 1024);
    write(&folder, "level.npy", [3, 4], |_, _| 2.0);
    done(&folder, "bake level.npy -o level --what scatter --sun 0,90,0,2 --format npy");
    let (_, level) = load(&folder.path("level/scatter.npy"));
    assert!(
        level[..36].iter().all(|v| (v - std::f32::consts::FRAC_2_PI).abs() < 1e-6),
        "{level:?}"
    );
    assert!(level[36..].iter().all(|v| *v == 0.0), "{level:?}");
    // The same seed gives the same light.
    assert!(of("again", "--paths 64 --seed 2").1 == seeds[2]);
}

/// A ramp rises towards the east by 10 a cell and ends. Of θ 22.5° and 67.5° and four φ, only back faces are visible from the
/// east. These hold 0, not 0/0, and a note reports them.
#[test]
fn gpu_views_of_back_faces_hold_0() {
    let folder = Folder::new();
    write(&folder, "ramp.npy", [16, 16], |_, c| 10.0 * c as f32);
    let words =
        "bake ramp.npy -o out --what light-field,btf --angles 2x4 --bounces 0 --format npy,ktx2";
    let run = folder.run_str(words);
    assert_eq!(run.status, Some(0), "{}", run.err);
    let said =
        "note: light-field, btf: 2 of 8 directions of --angles do not face the field's front";
    assert!(run.err.contains(said), "{}", run.err);
    let manifest = json(&folder.path("out/manifest.json"));
    for (at, name) in ["light_field", "btf"].into_iter().enumerate() {
        let (_, values) = load(&folder.path("out").join(format!("{name}.npy")));
        assert!(values.iter().all(|v| v.is_finite()), "{name}");
        // φ 0 of both zenith angles.
        assert_eq!(manifest["maps"][at]["blind"], serde_json::json!([0, 4]), "{name}");
        let last = &values[values.len() - 4 * 4 * 256..];
        assert!(last[..4 * 256].iter().all(|v| *v == 0.0), "{name}");
        assert!(last[4 * 256..].iter().any(|v| *v > 0.0), "{name}");
    }
}

/// The manifest holds the requested settings and the paths of all parts. Flags without effect are reported with reasons. Light
/// beyond f16 is reported; in f32 there is none.
#[test]
fn gpu_requested_settings_of_scattered_light_are_listed() {
    let folder = Folder::new();
    write(&folder, "field.npy", [6, 6], |r, c| ((r * 5 + c * 3) % 7) as f32 * 0.5);
    let words = "bake field.npy --what scatter --paths 20 --seed 3 --directions 64 --sky 1e8 --format ktx2 -o";
    let of = |more: &str| {
        let run = folder.run_str(&format!("{words} {more}"));
        assert_eq!(run.status, Some(0), "{}", run.err);
        run.err
    };
    let said = of("half --lines exact --bounces 2 --bounce-engine pyramid");
    for what in [
        "--lines exact changes nothing with --method brute-force",
        "--bounce-engine pyramid changes nothing for these kinds",
        "textures store f16; use --encoding scatter=f32",
    ] {
        assert!(said.contains(what), "{said}");
    }
    let settings = &json(&folder.path("half/manifest.json"))["settings"];
    // Eight parts of three.
    for (name, known) in [("paths", 20), ("paths_used", 24), ("seed", 3), ("bounces", 2)] {
        assert_eq!(settings[name], known, "{name}");
    }
    assert_eq!(noise(&folder, "half")["paths"], 24);
    assert_eq!(of("single --encoding scatter=f32"), "");
    // Maps without f16 have no such bound.
    for format in ["npy", "png", "exr", "png,npy"] {
        let out = format.replace(',', "_");
        let words = words.replace("--format ktx2", &format!("--format {format}"));
        succeeded(&folder, &format!("{words} {out}"));
        let map = &json(&folder.path(&format!("{out}/manifest.json")))["maps"][0];
        assert!(map["beyond_range"].is_null(), "{map}");
        let largest = map["values"][0]["range"][1].as_f64().unwrap();
        assert!(largest > 1e38, "{largest}");
    }
    assert!(json(&folder.path("half/manifest.json"))["maps"][0]["beyond_range"].is_object());
    // Teeth of 30 over four cells: the centres of west faces are occluded from a nearly level view.
    write(&folder, "teeth.npy", [4, 8], |_, c| 10.0 * (c % 4) as f32);
    let words = "bake teeth.npy -o teeth --border periodic --what brdf --bounces 0 --angles 45x4";
    let run = folder.run_str(words);
    assert!(run.err.starts_with("ridgelight: --angles: found 45x4 with direction"), "{}", run.err);
}

/// Level ground is ρ/π everywhere: the first harmonic alone. The ridge regression takes at most half a thousandth times the
/// order for lights, and as much for views.
#[test]
fn gpu_level_ground_is_one_harmonic() {
    let folder = Folder::new();
    write(&folder, "field.npy", [4, 4], |_, _| 2.0);
    let words = "--border periodic --what brdf-harmonics --sh-order 3 --angles 4x8 --bounces 0 \
                 --albedo 0.8,0.5,0.1";
    done(&folder, &format!("bake field.npy -o out {words} --format npy,ktx2"));
    let (shape, values) = load(&folder.path("out/brdf_harmonics.npy"));
    assert_eq!(shape, [3, 9, 9]);
    let ridge = 1e-3 * 3.0;
    let first = 1.0 / (4.0 * PI).sqrt();
    for (c, albedo) in [0.8, 0.5, 0.1].into_iter().enumerate() {
        // Straight above, of light and view: harmonics of m = 0 alone, √(2l + 1) times the first.
        let above = [(0, 1.0), (2, 3_f64.sqrt()), (6, 5_f64.sqrt())];
        let mut sum = 0.0;
        for (i, a) in above {
            for (j, b) in above {
                sum += a * b * first * first * f64::from(values[(c * 9 + i) * 9 + j]);
            }
        }
        assert!((sum - albedo / PI).abs() <= ridge * albedo / PI, "{c}: {sum}");
    }
    let manifest = json(&folder.path("out/manifest.json"));
    let map = &manifest["maps"][0];
    assert!(map["residual_of_table"].as_f64().unwrap() <= ridge, "{map}");
    assert!(map["between"]["residual"].as_f64().unwrap() <= ridge, "{map}");
    assert_eq!(manifest["settings"]["sh_order"], 3);
}

#[test]
fn light_that_cannot_be_baked_is_refused() {
    let folder = Folder::new();
    write(&folder, "line.npy", [1, 9], |_, c| (c % 3) as f32);
    folder.write("none.json", br#"{"quality": {"bounces": 0}}"#);
    std::fs::create_dir(folder.path("damaged")).unwrap();
    folder.write("damaged/manifest.json", br#"{"maps": ["#);
    std::fs::create_dir(folder.path("other")).unwrap();
    folder.write("other/manifest.json", br#"{"maps": [{"kind": "btf"}]}"#);
    refused(
        &folder,
        &[
            ("bake a.asc -o damaged --what sky-view", 1, &["damaged/manifest.json", "maps"]),
            ("bake a.asc -o other --what sky-view", 1, &["other/manifest.json", "maps"]),
            // The smallest limit that Vulkan 1.3 allows.
            (
                "bake a.asc -o out --what btf --angles 4x16 --plan",
                1,
                &["4096 layers", "2048", "--angles"],
            ),
            (
                "bake a.asc -o out --what visible-points --directions 4096 --plan",
                1,
                &["--directions"],
            ),
            (
                "bake a.asc -o out --what scatter --scene none.json",
                1,
                &["none.json", "quality.bounces"],
            ),
            ("bake line.npy -o out --what btf", 2, &["a field of 9 × 1,"]),
            (
                "bake line.npy -o out --border periodic --what btf --cell 1e-12",
                2,
                &["--cell: found 1e-12 × 1e-12"],
            ),
        ],
    );
}

//! What `bake` makes of light: loaded back by readers of its own, against what is known and against each other.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::path::Path;

use glam::DVec3;
use serde_json::Value;

use crate::Folder;
use crate::common::npy;
use crate::groove::{groove_bound, groove_brdf};
use crate::needs_vulkan::{done, json};

/// An array of f32 by NumPy's own description of the file: shape and values, the last axis the fastest.
fn load(path: &Path) -> (Vec<usize>, Vec<f32>) {
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

/// A table and the angles that its sheet says of it: f(channel, light, view), each of those (θ, φ) by their numbers.
struct Table {
    thetas: Vec<f64>,
    phis: Vec<f64>,
    values: Vec<f32>,
}

impl Table {
    fn load(folder: &Path) -> Self {
        let sheet = json(&folder.join("bake.json"));
        let map = sheet["maps"].as_array().unwrap().iter().find(|m| m["kind"] == "brdf").unwrap();
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

    fn directions(&self) -> Vec<DVec3> {
        let of = |theta: &f64, phi: &f64| {
            DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
        };
        self.thetas.iter().flat_map(|t| self.phis.iter().map(move |p| of(t, p))).collect()
    }

    fn at(&self, channel: usize, light: usize, view: usize) -> f64 {
        let count = self.thetas.len() * self.phis.len();
        f64::from(self.values[(channel * count + light) * count + view])
    }
}

fn write(
    folder: &Folder,
    name: &str,
    [rows, cols]: [usize; 2],
    height: impl Fn(usize, usize) -> f32,
) {
    let data: Vec<u8> =
        (0..rows * cols).flat_map(|i| height(i / cols, i % cols).to_le_bytes()).collect();
    folder.write(name, &npy("<f4", false, &format!("({rows}, {cols})"), &data));
}

/// Level ground is ρ/π, and grooves their closed form within what triangles err by: columns of a wall are cut eightfold. Light
/// and view exchanged are the same number, but for f32.
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
        // Nothing is scattered on level ground, however often it may be.
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
                    // f32 of the table, and of finer heights, whose slopes err by 2⁻²⁴ of 8 over an eighth.
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
        // Axes exchanged or turned would be seen.
        assert!(name == "level" || turned > 0.1, "{turned}");
    }
}

/// Pictures of all pairs are the table's once they are averaged: shares of the view are cos θ in the mean, and radiance over
/// them, over the light's cos θ, the table; scattered light and all. A light field has the same shares, and its light does not
/// turn with the view.
#[test]
fn gpu_pictures_are_the_table_in_the_mean() {
    const SIDE: usize = 6;
    let folder = Folder::new();
    write(&folder, "field.npy", [SIDE, SIDE], |r, c| ((r * 5 + c * 3) % 7) as f32 * 0.5);
    let words = "--border periodic --angles 3x4 --albedo 0.9,0.6,0.2 --bounces 2 --paths 32 --directions 64 --format npy \
                 --sun 200,40 --sky 0.1";
    done(&folder, &format!("bake field.npy -o out {words} --what brdf,btf,light-field"));
    let table = Table::load(&folder.path("out"));
    let directions = table.directions();
    let (count, texels) = (directions.len(), SIDE * SIDE);
    let (shape, btf) = load(&folder.path("out/btf.npy"));
    assert_eq!(shape, [4 * count * count, SIDE, SIDE]);
    let (_, lit) = load(&folder.path("out/light_field.npy"));
    let plane = |of: &[f32], n: usize| -> Vec<f64> {
        of[n * texels..(n + 1) * texels].iter().map(|v| f64::from(*v)).collect()
    };
    let mut brightest = [0.0_f64; SIDE * SIDE];
    for (l, v) in (0..count * count).map(|i| (i / count, i % count)) {
        let shares = plane(&btf, 4 * (l * count + v) + 3);
        let whole: f64 = shares.iter().sum();
        let z = directions[v].z;
        // Sums of f32.
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
                assert!(first == 0.0 || first == light, "{v}: {first} {light}");
                brightest[texel] = light;
            } else {
                assert_eq!(light, 0.0, "hidden texel {texel} of {v}");
            }
        }
    }
    assert!(brightest.iter().all(|l| *l > 0.0), "{brightest:?}");
}

fn chance(folder: &Folder, out: &str) -> Value {
    let sheet = json(&folder.path(out).join("bake.json"));
    sheet["maps"][0]["chance"].clone()
}

/// Scattered light by other seeds differs by what the sheet says of chance: two are apart by √2 σ, and all samples share their
/// directions, so that the mean of squares of six pairs of four seeds has few chances alone: within a factor of three. Sixteen
/// times as many paths leave a quarter of it, or less where each part takes every direction once; surely less than three quarters.
#[test]
fn gpu_scattered_light_tells_of_its_chance() {
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
    let said = chance(&folder, "s0")["rms_standard_error"].as_f64().unwrap();
    println!("{found:.5} found, {said:.5} said");
    assert!(found > said / 3.0 && found < 3.0 * said, "{found} {said}");
    let (shape, _) = of("more", "--paths 1024");
    assert_eq!(shape, [6, 8, 8]);
    let less = chance(&folder, "more")["rms_standard_error"].as_f64().unwrap();
    assert!(less < 0.75 * said, "{less} {said}");
    assert_eq!(chance(&folder, "more")["paths"], 1024);
    write(&folder, "level.npy", [3, 4], |_, _| 2.0);
    done(&folder, "bake level.npy -o level --what scatter --sun 0,90,0,2 --format npy");
    let (_, level) = load(&folder.path("level/scatter.npy"));
    assert!(
        level[..36].iter().all(|v| (v - std::f32::consts::FRAC_2_PI).abs() < 1e-6),
        "{level:?}"
    );
    assert!(level[36..].iter().all(|v| *v == 0.0), "{level:?}");
    // The same seed is the same light.
    assert!(of("again", "--paths 64 --seed 2").1 == seeds[2]);
}

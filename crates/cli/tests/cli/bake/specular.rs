//! `bake` with Phong specular: closed forms, notes, and sums with diffuse light.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;
use serde_json::Value;

use super::light::{Table, load, noise, write};
use crate::Folder;
use crate::formats::npy;
use crate::needs_vulkan::{done, json};

/// ρ/π plus s p / cos θ for the density p of the Phong lobe about the mirror direction: level ground scatters nothing, with or
/// without bounces. f32 rounds the albedo and the table by half an ulp each, and f64 in between n times as much as there. Two sets
/// of eight functions leave the residual that the manifest states. A note reports once that the lobes are too narrow for these
/// angles, so that their sums bound nothing; the manifest states the energy of a low light and of a view.
#[test]
fn gpu_specular_of_level_ground_is_loaded_back() {
    let folder = Folder::new();
    write(&folder, "level.npy", [3, 4], |_, _| 2.0);
    let words = "bake level.npy -o out --border periodic --what brdf,brdf-factors,brdf-harmonics --angles 6x8 --albedo 0.4 --specular 12,0.5 \
                 --format npy";
    let run = folder.run(&words.split_whitespace().collect::<Vec<_>>());
    assert_eq!(run.status, Some(0), "{}", run.err);
    let line = "note: brdf, brdf-factors, brdf-harmonics: specular lobes fall to half at 19.3°, but --angles 6x8 are up to \
                45.0° apart: too coarse, unless slopes widen the highlights";
    let notes: Vec<&str> = run.err.lines().filter(|line| line.starts_with("note: brdf")).collect();
    assert_eq!(notes, [line], "{}", run.err);
    let table = Table::load(&folder.path("out"));
    let e = table.directions();
    let known = |l: usize, v: usize| {
        let along = (DVec3::new(-e[v].x, -e[v].y, e[v].z)).dot(e[l]).max(0.0);
        0.4 / PI + 0.5 * 13.0 / TAU * along.powf(12.0) / e[l].z
    };
    let (_, factors) = load(&folder.path("out/brdf_factors.npy"));
    assert_eq!(factors.len(), 16 * 3 * e.len());
    // The middle channel.
    let factor = |k: usize, i: usize| f64::from(factors[(3 * k + 1) * e.len() + i]);
    let edge = |k: usize| (k as f64 * FRAC_PI_2 / 6.0).sin().powi(2);
    let weight = |i: usize| edge(i / 8 + 1) - edge(i / 8);
    let (mut apart, mut all) = (0.0, 0.0);
    for (l, v) in (0..e.len().pow(2)).map(|i| (i / e.len(), i % e.len())) {
        let own = table.at(1, l, v);
        let allowed = (f64::from(f32::EPSILON) + 12.0 * 16.0 * f64::EPSILON) * own;
        assert!((own - known(l, v)).abs() <= allowed, "{l} {v}: {own} {}", known(l, v));
        let sum: f64 = (0..8).map(|k| factor(k, l) * factor(8 + k, v)).sum();
        apart += weight(l) * weight(v) * (own - sum).powi(2);
        all += weight(l) * weight(v) * own * own;
    }
    let manifest = json(&folder.path("out/manifest.json"));
    let maps = manifest["maps"].as_array().unwrap();
    let (found, said) = (f64::sqrt(apart / all), maps[1]["residual_of_table"].as_f64().unwrap());
    println!("{found:.4} found, {said:.4} said of the table");
    assert!((found - said).abs() < 1e-3 * said && said < 0.5, "{found} {said}");
    let half = 0.5_f64.powf(1.0 / 12.0).acos().to_degrees();
    for (map, is_linear) in maps.iter().zip([true, true, false]) {
        assert!((map["specular"]["half_width_deg"].as_f64().unwrap() - half).abs() < 1e-9, "{map}");
        assert!(map["unreciprocal"].as_f64().unwrap() > 0.1, "{map}");
        assert!(
            map["gathered"]["is"].as_str().unwrap().contains("narrower than their spacing"),
            "{map}"
        );
        // Level ground scatters nothing.
        assert!(map["specular"]["directions_deg"].is_null(), "{map}");
        for name in ["between", "specular"] {
            let said = map[name]["is"].as_str().unwrap();
            assert_eq!(said.contains("linear "), is_linear, "{said}");
        }
    }
    let broad = words.replace("-o out", "-o broad").replace("--specular 12", "--specular 1");
    let run = folder.run(&broad.split_whitespace().collect::<Vec<_>>());
    assert_eq!(run.status, Some(0), "{}", run.err);
    assert!(
        run.err.contains("is not reciprocal") && !run.err.contains("too coarse"),
        "{}",
        run.err
    );
    let manifest = json(&folder.path("broad/manifest.json"));
    for map in manifest["maps"].as_array().unwrap() {
        assert!(map["gathered"]["is"].as_str().unwrap().contains("at most what"), "{map}");
        assert!(map["reflected"]["most"].as_f64().unwrap() > 1.0, "{map}");
    }
}

/// Texels of scale 0 have no specular, whatever their exponent, unless a neighbour has: of eight columns of exponent 2 the fifth has
/// 1000, but only the first has a scale above 0. A Phong lobe of 2 falls to half at 45°; --angles are 36° apart.
#[test]
fn gpu_the_sharpest_exponent_of_a_map_counts() {
    let folder = Folder::new();
    write(&folder, "level.npy", [3, 8], |_, _| 2.0);
    let of = |i: usize| match (i / 24, i % 8) {
        (0, 4) => 1000.0,
        (0, _) => 2.0,
        (_, 0) => 0.5_f32,
        _ => 0.0,
    };
    let data: Vec<u8> = (0..48).flat_map(|i| of(i).to_le_bytes()).collect();
    folder.write("specular.npy", &npy("<f4", false, "(2, 3, 8)", &data));
    let words = "bake level.npy -o out --border periodic --what brdf --bounces 0 --angles 6x10 --albedo 0.4 --specular specular.npy";
    let run = folder.run(&words.split_whitespace().collect::<Vec<_>>());
    assert_eq!(run.status, Some(0), "{}", run.err);
    assert!(!run.err.contains("too coarse"), "{}", run.err);
    let phong_specular = &json(&folder.path("out/manifest.json"))["maps"][0]["specular"];
    assert_eq!(
        [phong_specular["exponent"].as_f64(), phong_specular["scale"].as_f64()],
        [Some(2.0), Some(0.5)],
        "{phong_specular}"
    );
}

/// Without bounces the specular of a light field still reflects the sky, along each of --directions once: 128 of them are 18° apart,
/// more than half the width of a Phong lobe of 100, 6.7°. With suns alone these directions reflect nothing, and --paths has no effect.
#[test]
fn gpu_light_fields_without_bounces_state_their_directions() {
    let folder = Folder::new();
    write(&folder, "field.npy", [6, 6], |r, c| ((r * 5 + c * 3) % 7) as f32 * 0.5);
    let of = |out: &str, light: &str| {
        let words = "--what light-field --angles 2x4 --bounces 0 --paths 20 --directions 128 --albedo 0.3 --specular 100,0.5";
        let words =
            format!("bake field.npy -o {out} --border periodic --format npy {words} {light}");
        let run = folder.run(&words.split_whitespace().collect::<Vec<_>>());
        assert_eq!(run.status, Some(0), "{}", run.err);
        assert!(run.err.contains("--paths 20 changes nothing with --bounces 0"), "{}", run.err);
        let manifest = json(&folder.path(&format!("{out}/manifest.json")));
        (run.err, manifest["maps"][0]["specular"]["directions_deg"].as_f64(), manifest)
    };
    let (said, apart, manifest) = of("sky", "--sky 1");
    let known = (4.0 * PI / 128.0).sqrt().to_degrees();
    assert!((apart.unwrap() - known).abs() < 1e-9, "{apart:?} {known}");
    assert!(said.contains("specular of the sky is rough"), "{said}");
    let scattered = &manifest["maps"][0]["scattered"];
    assert_eq!([&scattered["bounces"], &scattered["paths"]], [0, 128], "{scattered}");
    let (said, apart, _) = of("sun", "--sky 0 --sun 200,40");
    assert!(apart.is_none() && !said.contains("is rough"), "{apart:?} {said}");
}

/// Counts every pair of a table's lights and views, 64 pairs in between, and the repeats where views do not fit in memory at once:
/// 1024 × 1024 texels take 16 bytes each per view, and 16 views fill the 256 MiB allowed.
#[test]
fn look_ups_of_specular_are_counted() {
    let folder = Folder::new();
    write(&folder, "small.npy", [2, 16], |_, c| c.abs_diff(8) as f32);
    write(&folder, "large.npy", [1024, 1024], |_, c| c.abs_diff(512) as f32);
    let said = |words: &str| {
        let words = format!(
            "bake {words} --border periodic --paths 64 --albedo 0.5 --specular 1,0.5 --plan -o out"
        );
        let run = folder.run(&words.split_whitespace().collect::<Vec<_>>());
        assert_eq!(run.status, Some(0), "{}", run.err);
        run.out
    };
    let all = said("small.npy --what brdf,btf,light-field --angles 2x4 --bounces 3");
    // 8 lights: 3 steps and 8 views; 64 pairs: 4 steps.
    let table = 32 * 64 * (8 * (3 + 8) + 64 * 4);
    let pictures = 32 * 64 * 8 * (3 + 8);
    let views = 32 * 64 * (3 + 8);
    let of = "64 paths of 3 steps, and one more towards each of 8 views";
    for line in [
        format!(
            "{table}  rays of brdf: of 8 lights each {of}; of 64 pairs between each 64 of 4 steps"
        ),
        format!("{pictures}  rays of btf: of 8 lights each {of}"),
        format!("{views}  rays of light-field: {of}"),
    ] {
        assert!(all.lines().any(|own| own.trim() == line), "{line}: {all}");
    }
    // Each direction once.
    let none = said("small.npy --what light-field --angles 2x4 --bounces 0 --directions 100");
    let line = format!("{}  rays of light-field: 100 paths of 0 steps", 32 * 100 * 8);
    assert!(none.contains(&line), "{line}: {none}");
    let large = said("large.npy --what light-field --angles 4x16 --bounces 3 --directions 16");
    let ray_count = 1024_u64 * 1024 * 64 * (3 * 4 + 64);
    let line = format!("{ray_count}  rays of light-field: 64 paths of 3 steps, walked 4 times,");
    assert!(large.contains(&line), "{line}: {large}");
}

/// A specular scale of 1e-9 leaves the diffuse light, on the same paths: walked once per light and towards each view, and one step
/// further. Both round in f32: sums of 64 paths of four steps, a dozen roundings each. Under light of 1 from all sides, grooves that
/// reflect all of it send at most 1 to any view, whatever the bounces, and more than without bounces: sums over steps of h of a
/// function that changes within 1/(n + 2) radians err by (n + 2)² h²/24, those over N directions by as much as those of tests/bake.
#[test]
fn gpu_specular_scatters_towards_each_view() {
    let folder = Folder::new();
    write(&folder, "grooves.npy", [2, 16], |_, c| c.abs_diff(8) as f32);
    let words = "--border periodic --what brdf --angles 4x8 --albedo 0.5 --format npy --paths 64 --directions 128";
    let of = |out: &str, more: &str| {
        done(&folder, &format!("bake grooves.npy -o {out} --quiet {words} {more}"));
        (Table::load(&folder.path(out)), json(&folder.path(&format!("{out}/manifest.json"))))
    };
    let (diffuse, _) = of("diffuse", "--bounces 3");
    let (faint, _) = of("faint", "--bounces 3 --specular 1,1e-9");
    let (direct, dark) = of("direct", "--bounces 0 --specular 1,0.5");
    let (_, lit) = of("lit", "--bounces 8 --specular 1,0.5");
    let mut scattered = 0.0_f64;
    for (l, v) in (0..32 * 32).map(|i| (i / 32, i % 32)) {
        let [known, got] = [&diffuse, &faint].map(|table| table.at(0, l, v));
        let allowed = (64.0 + 12.0 * 4.0) * f64::from(f32::EPSILON) * known + 1e-9;
        assert!((got - known).abs() <= allowed, "{l} {v}: {got} {known}");
        scattered = scattered.max(known - direct.at(0, l, v));
    }
    assert!(scattered > 0.01, "deaf: {scattered}");
    let ends = |manifest: &Value| {
        ["least", "most"].map(|end| manifest["maps"][0]["gathered"][end].as_f64().unwrap())
    };
    let ([dark, _], [least, most]) = (ends(&dark), ends(&lit));
    let step = TAU / 8.0;
    let allowed = 9.0 * step * step / 24.0 + 3.0 * 1.16 * PI.powf(0.25) * 128_f64.powf(-0.75);
    println!("{dark:.3} direct, {least:.3} to {most:.3} in all, within {allowed:.3}");
    assert!(most <= 1.0 + allowed && least > 1.1 * dark, "{dark} {least} {most} {allowed}");
}

/// With specular, exit radiance is the picture of `render` from straight above plus the scattered light: in the mean, and texel by
/// texel on level ground, which scatters nothing. The manifest states the view.
#[test]
fn gpu_scattered_specular_is_added_to_its_picture() {
    let folder = Folder::new();
    write(&folder, "level.npy", [5, 4], |_, _| 2.0);
    write(&folder, "field.npy", [8, 8], |r, c| ((r * 5 + c * 3) % 7) as f32);
    let words = "--border periodic --albedo 0.4 --sun 200,70 --sky 0.5 --method brute-force";
    let shiny = &format!("{words} --specular 20,0.5");
    for name in ["level", "field"] {
        let bake = "--what scatter --bounces 2 --paths 64 --directions 64 --format npy";
        done(&folder, &format!("bake {name}.npy -o {name} {shiny} {bake}"));
        done(&folder, &format!("render {name}.npy -o {name}.specular.exr {shiny}"));
        done(&folder, &format!("render {name}.npy -o {name}.plain.exr {words}"));
        let (_, all) = load(&folder.path(name).join("scatter.npy"));
        let count = all.len() / 6;
        let picture = |end: &str| -> Vec<f32> {
            let path = folder.path(&format!("{name}.{end}.exr"));
            let planes = ridgelight_io::read_planes(&path).unwrap();
            let red = planes.names.iter().position(|name| ["R", "Y"].contains(&name.as_str()));
            planes.planes[red.unwrap()].clone()
        };
        let (own, plain) = (picture("specular"), picture("plain"));
        let sum = |of: &[f32]| of.iter().map(|v| f64::from(*v)).sum::<f64>() / of.len() as f64;
        assert!(sum(&own) > 1.02 * sum(&plain), "{name}: deaf");
        let scattered = noise(&folder, name)["mean_scattered"].as_f64().unwrap();
        let off = sum(&all[..count]) - sum(&own) - scattered;
        // Both pictures and their sum round once a texel in f32.
        assert!(off.abs() < 2.0 * f64::from(f32::EPSILON) * sum(&own), "{name}: {off}");
        if name == "level" {
            assert!(
                all[..count].iter().zip(&own).all(|(a, b)| (a - b).abs() <= 2.0 * f32::EPSILON * b),
                "{all:?}"
            );
        } else {
            assert!(scattered > 0.05 * sum(&own), "{scattered}");
        }
        let manifest = json(&folder.path(name).join("manifest.json"));
        let said = manifest["maps"][0]["values"][0]["about"].as_str().unwrap_or_default();
        assert!(said.contains("straight up"), "{manifest}");
    }
    let keys = "bake field.npy -o keys --border periodic --albedo 0.5 --specular 20,0.5 --sphere-light 3,3,9,1,5 --what";
    let said = "specular and 1 key lights and sphere lights";
    let cases = ["scatter", "light-field", "light-field --bounces 0"];
    for case in cases {
        let run = folder.run(&format!("{keys} {case}").split_whitespace().collect::<Vec<_>>());
        assert!(run.status != Some(0) && run.err.contains(said), "{case}: {}", run.err);
    }
}

//! What `bake` makes of lobes: closed forms, what is told of them, and what they are added to.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;
use serde_json::Value;

use crate::Folder;
use crate::bake_light::{Table, chance, load, write};
use crate::common::npy;
use crate::needs_vulkan::{done, json};

/// ρ/π and s p / cos θ of a lobe's density p about the mirror direction: level ground scatters nothing, with bounces or without. Of the
/// albedo and of the table f32 rounds by half an ulp each, of what there is between in f64 n times as much as there. Two sets of eight
/// functions leave of the table what the sheet says; and what is told of lobes: once that they are too narrow for these angles, whose sums
/// then bound nothing; of one that is not more than all of a low light, and what a view gathers.
#[test]
fn gpu_lobes_of_level_ground_are_loaded_back() {
    let folder = Folder::new();
    write(&folder, "level.npy", [3, 4], |_, _| 2.0);
    let words = "bake level.npy -o out --border periodic --what brdf,brdf-factors,brdf-harmonics --angles 6x8 --albedo 0.4 --phong 12,0.5 \
                 --format npy";
    let run = folder.run(&words.split_whitespace().collect::<Vec<_>>());
    assert_eq!(run.status, Some(0), "{}", run.err);
    let line = "note: brdf, brdf-factors, brdf-harmonics: lobes are half as bright 19.3° beside their middle, --angles 6x8 are up to \
                45.0° apart: too coarse to hold them, but where slopes spread them wider";
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
    // Of the channel in the middle.
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
    let sheet = json(&folder.path("out/bake.json"));
    let maps = sheet["maps"].as_array().unwrap();
    let (found, said) = (f64::sqrt(apart / all), maps[1]["residual_of_table"].as_f64().unwrap());
    println!("{found:.4} found, {said:.4} said of the table");
    assert!((found - said).abs() < 1e-3 * said && said < 0.5, "{found} {said}");
    let half = 0.5_f64.powf(1.0 / 12.0).acos().to_degrees();
    for (map, is_linear) in maps.iter().zip([true, true, false]) {
        assert!((map["lobe"]["half_width_deg"].as_f64().unwrap() - half).abs() < 1e-9, "{map}");
        assert!(map["unreciprocal"].as_f64().unwrap() > 0.1, "{map}");
        assert!(
            map["gathered"]["is"].as_str().unwrap().contains("narrower than they are"),
            "{map}"
        );
        // Nothing is scattered on level ground.
        assert!(map["lobe"]["directions_deg"].is_null(), "{map}");
        for name in ["between", "lobe"] {
            let said = map[name]["is"].as_str().unwrap();
            assert_eq!(said.contains("linear between"), is_linear, "{said}");
        }
    }
    let broad = words.replace("-o out", "-o broad").replace("--phong 12", "--phong 1");
    let run = folder.run(&broad.split_whitespace().collect::<Vec<_>>());
    assert_eq!(run.status, Some(0), "{}", run.err);
    assert!(run.err.contains("not by the light") && !run.err.contains("too coarse"), "{}", run.err);
    let sheet = json(&folder.path("broad/bake.json"));
    for map in sheet["maps"].as_array().unwrap() {
        assert!(map["gathered"]["is"].as_str().unwrap().contains("at most what"), "{map}");
        assert!(map["reflected"]["most"].as_f64().unwrap() > 1.0, "{map}");
    }
}

/// What mirrors nothing has no lobe, whatever its exponent, unless it lies beside what mirrors: of eight columns of 2 the fifth has 1000,
/// but only the first mirrors. A lobe of 2 is half as bright 45° beside its middle, --angles are 36° apart.
#[test]
fn gpu_the_sharpest_lobe_of_a_map_mirrors() {
    let folder = Folder::new();
    write(&folder, "level.npy", [3, 8], |_, _| 2.0);
    let of = |i: usize| match (i / 24, i % 8) {
        (0, 4) => 1000.0,
        (0, _) => 2.0,
        (_, 0) => 0.5_f32,
        _ => 0.0,
    };
    let data: Vec<u8> = (0..48).flat_map(|i| of(i).to_le_bytes()).collect();
    folder.write("lobes.npy", &npy("<f4", false, "(2, 3, 8)", &data));
    let words = "bake level.npy -o out --border periodic --what brdf --bounces 0 --angles 6x10 --albedo 0.4 --phong lobes.npy";
    let run = folder.run(&words.split_whitespace().collect::<Vec<_>>());
    assert_eq!(run.status, Some(0), "{}", run.err);
    assert!(!run.err.contains("too coarse"), "{}", run.err);
    let lobe = &json(&folder.path("out/bake.json"))["maps"][0]["lobe"];
    assert_eq!(
        [lobe["exponent"].as_f64(), lobe["scale"].as_f64()],
        [Some(2.0), Some(0.5)],
        "{lobe}"
    );
}

/// Without bounces a light field's lobes still mirror the sky, and look for it along --directions, each once: 128 of them are 18° apart,
/// more than half the width of a lobe of 100, 6.7°. Of suns alone nothing is mirrored along them. --paths are then nobody's.
#[test]
fn gpu_light_fields_without_bounces_tell_how_they_mirror() {
    let folder = Folder::new();
    write(&folder, "field.npy", [6, 6], |r, c| ((r * 5 + c * 3) % 7) as f32 * 0.5);
    let of = |out: &str, light: &str| {
        let words = "--what light-field --angles 2x4 --bounces 0 --paths 20 --directions 128 --albedo 0.3 --phong 100,0.5";
        let words =
            format!("bake field.npy -o {out} --border periodic --format npy {words} {light}");
        let run = folder.run(&words.split_whitespace().collect::<Vec<_>>());
        assert_eq!(run.status, Some(0), "{}", run.err);
        assert!(run.err.contains("--paths 20 changes nothing with --bounces 0"), "{}", run.err);
        let sheet = json(&folder.path(&format!("{out}/bake.json")));
        (run.err, sheet["maps"][0]["lobe"]["directions_deg"].as_f64(), sheet)
    };
    let (said, apart, sheet) = of("sky", "--sky 1");
    let known = (4.0 * PI / 128.0).sqrt().to_degrees();
    assert!((apart.unwrap() - known).abs() < 1e-9, "{apart:?} {known}");
    assert!(said.contains("what lobes mirror of the sky is rough"), "{said}");
    let scattered = &sheet["maps"][0]["scattered"];
    assert_eq!([&scattered["bounces"], &scattered["paths"]], [0, 128], "{scattered}");
    let (said, apart, _) = of("sun", "--sky 0 --sun 200,40");
    assert!(apart.is_none() && !said.contains("is rough"), "{apart:?} {said}");
}

/// Every pair of a table's lights and views, 64 pairs between them, and what does not fit beside each other again: 1024 × 1024 samples
/// have 16 bytes each towards a view, and 16 views are the 256 MiB that they may take.
#[test]
fn look_ups_of_lobes_are_counted() {
    let folder = Folder::new();
    write(&folder, "small.npy", [2, 16], |_, c| c.abs_diff(8) as f32);
    write(&folder, "large.npy", [1024, 1024], |_, c| c.abs_diff(512) as f32);
    let said = |words: &str| {
        let words = format!(
            "bake {words} --border periodic --paths 64 --albedo 0.5 --phong 1,0.5 --plan -o out"
        );
        let run = folder.run(&words.split_whitespace().collect::<Vec<_>>());
        assert_eq!(run.status, Some(0), "{}", run.err);
        run.out
    };
    let all = said("small.npy --what brdf,btf,light-field --angles 2x4 --bounces 3");
    // Of 8 lights 3 steps and 8 views; of 64 pairs 4 steps.
    let table = 32 * 64 * (8 * (3 + 8) + 64 * 4);
    let pictures = 32 * 64 * 8 * (3 + 8);
    let views = 32 * 64 * (3 + 8);
    let of = "64 paths of 3 steps, and one more towards each of 8 views";
    for line in [
        format!(
            "{table}  look-ups of brdf: of 8 lights each {of}; of 64 pairs between each 64 of 4 steps"
        ),
        format!("{pictures}  look-ups of btf: of 8 lights each {of}"),
        format!("{views}  look-ups of light-field: {of}"),
    ] {
        assert!(all.lines().any(|own| own.trim() == line), "{line}: {all}");
    }
    // Each direction once.
    let none = said("small.npy --what light-field --angles 2x4 --bounces 0 --directions 100");
    let line = format!("{}  look-ups of light-field: 100 paths of 0 steps", 32 * 100 * 8);
    assert!(none.contains(&line), "{line}: {none}");
    let large = said("large.npy --what light-field --angles 4x16 --bounces 3 --directions 16");
    let looks = 1024_u64 * 1024 * 64 * (3 * 4 + 64);
    let line = format!("{looks}  look-ups of light-field: 64 paths of 3 steps, walked 4 times,");
    assert!(large.contains(&line), "{line}: {large}");
}

/// A lobe that reflects next to nothing leaves what is diffuse: the same paths, but walked as lobes are, each light's own and towards each
/// view, and one step further; but for a lobe of 1e-9, and roundings of f32: of sums of 64 paths of four steps, a dozen each, in both. Under light of 1 from all sides grooves that reflect all of
/// it show no view more than 1, whatever the bounces, and more than without them: sums over steps of h of a function that changes
/// within 1/(n + 2) radians err by (n + 2)² h²/24, those over N directions by as much as those of tests/bake.
#[test]
fn gpu_lobes_scatter_towards_each_view() {
    let folder = Folder::new();
    write(&folder, "grooves.npy", [2, 16], |_, c| c.abs_diff(8) as f32);
    let words = "--border periodic --what brdf --angles 4x8 --albedo 0.5 --format npy --paths 64 --directions 128";
    let of = |out: &str, more: &str| {
        done(&folder, &format!("bake grooves.npy -o {out} --quiet {words} {more}"));
        (Table::load(&folder.path(out)), json(&folder.path(&format!("{out}/bake.json"))))
    };
    let (diffuse, _) = of("diffuse", "--bounces 3");
    let (faint, _) = of("faint", "--bounces 3 --phong 1,1e-9");
    let (direct, dark) = of("direct", "--bounces 0 --phong 1,0.5");
    let (_, lit) = of("lit", "--bounces 8 --phong 1,0.5");
    let mut scattered = 0.0_f64;
    for (l, v) in (0..32 * 32).map(|i| (i / 32, i % 32)) {
        let [known, got] = [&diffuse, &faint].map(|table| table.at(0, l, v));
        let allowed = (64.0 + 12.0 * 4.0) * f64::from(f32::EPSILON) * known + 1e-9;
        assert!((got - known).abs() <= allowed, "{l} {v}: {got} {known}");
        scattered = scattered.max(known - direct.at(0, l, v));
    }
    assert!(scattered > 0.01, "deaf: {scattered}");
    let ends = |sheet: &Value| {
        ["least", "most"].map(|end| sheet["maps"][0]["gathered"][end].as_f64().unwrap())
    };
    let ([dark, _], [least, most]) = (ends(&dark), ends(&lit));
    let step = TAU / 8.0;
    let allowed = 9.0 * step * step / 24.0 + 3.0 * 1.16 * PI.powf(0.25) * 128_f64.powf(-0.75);
    println!("{dark:.3} direct, {least:.3} to {most:.3} in all, within {allowed:.3}");
    assert!(most <= 1.0 + allowed && least > 1.1 * dark, "{dark} {least} {most} {allowed}");
}

/// With a lobe, exit radiance is what render draws from straight above and what paths add to it: in the mean, and of level ground, where
/// nothing is scattered, texel by texel. The sheet says from where.
#[test]
fn gpu_scattered_lobes_are_added_to_their_picture() {
    let folder = Folder::new();
    write(&folder, "level.npy", [5, 4], |_, _| 2.0);
    write(&folder, "field.npy", [8, 8], |r, c| ((r * 5 + c * 3) % 7) as f32);
    let words = "--border periodic --albedo 0.4 --sun 200,70 --sky 0.5 --method brute";
    let glossy = &format!("{words} --phong 20,0.5");
    for name in ["level", "field"] {
        let bake = "--what scatter --bounces 2 --paths 64 --directions 64 --format npy";
        done(&folder, &format!("bake {name}.npy -o {name} {glossy} {bake}"));
        done(&folder, &format!("render {name}.npy -o {name}.lobe.exr {glossy}"));
        done(&folder, &format!("render {name}.npy -o {name}.plain.exr {words}"));
        let (_, all) = load(&folder.path(name).join("scatter.npy"));
        let count = all.len() / 6;
        let picture = |end: &str| -> Vec<f32> {
            let path = folder.path(&format!("{name}.{end}.exr"));
            let planes = ridgelight_io::read_planes(&path).unwrap();
            let red = planes.names.iter().position(|name| ["R", "Y"].contains(&name.as_str()));
            planes.planes[red.unwrap()].clone()
        };
        let (own, plain) = (picture("lobe"), picture("plain"));
        let sum = |of: &[f32]| of.iter().map(|v| f64::from(*v)).sum::<f64>() / of.len() as f64;
        assert!(sum(&own) > 1.02 * sum(&plain), "{name}: deaf");
        let scattered = chance(&folder, name)["mean_scattered"].as_f64().unwrap();
        let off = sum(&all[..count]) - sum(&own) - scattered;
        // Both pictures and their sum round by f32 once a texel.
        assert!(off.abs() < 2.0 * f64::from(f32::EPSILON) * sum(&own), "{name}: {off}");
        if name == "level" {
            assert!(
                all[..count].iter().zip(&own).all(|(a, b)| (a - b).abs() <= 2.0 * f32::EPSILON * b),
                "{all:?}"
            );
        } else {
            assert!(scattered > 0.05 * sum(&own), "{scattered}");
        }
        let sheet = json(&folder.path(name).join("bake.json"));
        let said = sheet["maps"][0]["values"][0]["about"].as_str().unwrap_or_default();
        assert!(said.contains("straight above"), "{sheet}");
    }
    let keys = "bake field.npy -o keys --border periodic --albedo 0.5 --phong 20,0.5 --light 3,3,9,1,5 --what";
    let said = "a lobe and 1 key lights and balls";
    let cases = ["scatter", "light-field", "light-field --bounces 0"];
    for case in cases {
        let run = folder.run(&format!("{keys} {case}").split_whitespace().collect::<Vec<_>>());
        assert!(run.status != Some(0) && run.err.contains(said), "{case}: {}", run.err);
    }
}

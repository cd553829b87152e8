//! What `bake` makes of lobes: closed forms, what is told of them, and what they are added to.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;
use serde_json::Value;

use crate::Folder;
use crate::bake_light::{Table, chance, load, write};
use crate::needs_vulkan::{done, json};

/// ρ/π and s p / cos θ of a lobe's density p about the mirror direction: level ground scatters nothing, with bounces or without. Of the
/// angles n (1 - cos) errs in f32 of heights and the table by a few of their last digits. Two sets of eight functions leave of the table
/// what the sheet says; and what is told of lobes: too coarse for these angles, more than all of a low light, what a view gathers.
#[test]
fn gpu_lobes_of_level_ground_are_loaded_back() {
    let folder = Folder::new();
    write(&folder, "level.npy", [3, 4], |_, _| 2.0);
    let words = "bake level.npy -o out --border periodic --what brdf,brdf-factors,brdf-harmonics --angles 6x8 --albedo 0.4 --phong 12,0.5 \
                 --format npy";
    let run = folder.run(&words.split_whitespace().collect::<Vec<_>>());
    assert_eq!(run.status, Some(0), "{}", run.err);
    for what in ["half as bright 19.3", "--angles 6x8 are up to 45.0° apart", "not by the light"] {
        assert!(run.err.contains(what), "{what}: {}", run.err);
    }
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
        assert!((own - known(l, v)).abs() < 1e-5 * own, "{l} {v}: {own} {}", known(l, v));
        let sum: f64 = (0..8).map(|k| factor(k, l) * factor(8 + k, v)).sum();
        apart += weight(l) * weight(v) * (own - sum).powi(2);
        all += weight(l) * weight(v) * own * own;
    }
    let sheet = json(&folder.path("out/bake.json"));
    let maps = sheet["maps"].as_array().unwrap();
    let (found, said) = (f64::sqrt(apart / all), maps[1]["residual_of_table"].as_f64().unwrap());
    println!("{found:.4} found, {said:.4} said of the table");
    assert!((found - said).abs() < 1e-3 * said && said < 0.5, "{found} {said}");
    for map in maps {
        assert!(map["lobe"]["half_width_deg"].as_f64().unwrap() - 19.3 < 0.1, "{map}");
        assert!(map["reflected"]["most"].as_f64().unwrap() > 1.0, "{map}");
        assert!(map["unreciprocal"].as_f64().unwrap() > 0.1, "{map}");
    }
}

/// A lobe that reflects next to nothing leaves what is diffuse: the same paths, but walked as lobes are, each light's own and towards each
/// view, and one step further; but for roundings of f32, and a lobe of 1e-9. Under light of 1 from all sides grooves that reflect all of
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
        assert!((got - known).abs() <= 1e-5 * known, "{l} {v}: {got} {known}");
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
    let plan = format!("bake grooves.npy -o plan {words} --bounces 8 --phong 1,0.5 --plan");
    let said = folder.run(&plan.split_whitespace().collect::<Vec<_>>()).out;
    // 32 samples, 32 lights, 64 paths, 8 steps and 32 views.
    let looks = format!("{}  look-ups of brdf: of 32 lights each 64 paths", 32 * 32 * 64 * 40);
    assert!(said.contains(&looks), "{said}");
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
            let planes = ridgelight::files::read_planes(&path).unwrap();
            let red = planes.names.iter().position(|name| ["R", "Y"].contains(&name.as_str()));
            planes.planes[red.unwrap()].clone()
        };
        let (own, plain) = (picture("lobe"), picture("plain"));
        let sum = |of: &[f32]| of.iter().map(|v| f64::from(*v)).sum::<f64>() / of.len() as f64;
        assert!(sum(&own) > 1.02 * sum(&plain), "{name}: deaf");
        let scattered = chance(&folder, name)["mean_scattered"].as_f64().unwrap();
        let off = sum(&all[..count]) - sum(&own) - scattered;
        assert!(off.abs() < 1e-5 * sum(&own), "{name}: {off}");
        if name == "level" {
            assert!(
                all[..count].iter().zip(&own).all(|(a, b)| (a - b).abs() <= 1e-6 * b),
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

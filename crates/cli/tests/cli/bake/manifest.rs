//! Manifests of baked light: paths, passes and scales, and notes on unused lights.

use serde_json::Value;

use super::light::{load, write};
use crate::Folder;
use crate::needs_vulkan::{done, json};

/// One bounce uses each direction at most once: eight parts of 25 paths trace eight directions each, and the one part of a light
/// field traces eight. Nothing scatters where no surface is visible. Fields that end are not normalised.
#[test]
fn gpu_paths_are_those_that_were_traced() {
    let folder = Folder::new();
    write(&folder, "field.npy", [6, 6], |r, c| ((r * 5 + c * 3) % 7) as f32 * 0.5);
    write(&folder, "level.npy", [6, 6], |_, _| 0.5);
    for (field, bounces, traced) in
        [("field", 1, [64, 8]), ("field", 2, [200, 200]), ("level", 1, [0, 0])]
    {
        let words = "--what scatter,light-field --paths 200 --directions 8 --angles 2x4";
        done(
            &folder,
            &format!(
                "bake {field}.npy -o out --bounces {bounces} {words} --format npy,exr --quiet"
            ),
        );
        let manifest = json(&folder.path("out/manifest.json"));
        assert_eq!(manifest["settings"]["paths"], 200);
        assert_eq!(manifest["settings"]["paths_used"], traced[0]);
        assert_eq!(manifest["maps"][0]["monte_carlo_noise"]["paths"], traced[0]);
        assert_eq!(manifest["maps"][1]["scattered"]["paths"], traced[1]);
        let triangles = &manifest["maps"][1]["triangles"];
        assert!(triangles["worst_closure"].is_null(), "{triangles}");
        assert!(triangles["are"].as_str().unwrap().contains("not normalised"), "{triangles}");
    }
    done(&folder, "bake field.npy -o far --border periodic --what brdf --angles 2x4 --bounces 0");
    let manifest = json(&folder.path("far/manifest.json"));
    assert!(manifest["maps"][0]["triangles"]["worst_closure"].is_number(), "{manifest}");
}

/// Runs of a pass in a report; 0 for a missing pass.
fn runs(report: &Value, pass: &str) -> u32 {
    let rows = report["passes"].as_array().unwrap().iter();
    let rows = rows.inspect(|row| assert!(row["ns"].is_number(), "{row}"));
    let labels = rows.map(|row| row["pass"].as_str().unwrap());
    let own = labels.filter_map(|label| label.strip_prefix(pass)?.strip_suffix(" runs"));
    own.map(|count| count.trim().parse::<u32>().unwrap()).sum()
}

/// Both kinds of tables share the slow passes, and --json holds their times: masks of up to fifteen directions, and of the
/// ends of 64 pairs; one frame per light, and per pair.
#[test]
fn gpu_tables_are_made_once_and_timed() {
    let folder = Folder::new();
    write(&folder, "field.npy", [6, 6], |r, c| ((r * 5 + c * 3) % 7) as f32 * 0.5);
    let mut all = Vec::new();
    for kinds in ["brdf", "brdf-factors", "brdf,brdf-factors"] {
        let words = "--border periodic --angles 2x4 --bounces 1 --paths 4 --directions 8";
        let out = kinds.replace(',', "_");
        done(
            &folder,
            &format!("bake field.npy -o {out} --what {kinds} {words} --format npy --json t.json"),
        );
        let report = json(&folder.path("t.json"));
        all.push(["facet_mask", "visible_points", "scatter_gather"].map(|p| runs(&report, p)));
        assert!(report["settings"]["gpu_ms"].as_f64().unwrap() > 0.0);
    }
    // Eight lights of the table, 64 in between.
    assert_eq!(all[0], [1 + 1, 1 + 1, 8 + 64]);
    assert_eq!(all[1], all[0]);
    assert_eq!(all[2], all[0]);
    let tables = ["brdf", "brdf_brdf-factors"].map(|out| load(&folder.path(out).join("brdf.npy")));
    assert!(tables[0] == tables[1]);
    let factors = ["brdf-factors", "brdf_brdf-factors"]
        .map(|out| load(&folder.path(out).join("brdf_factors.npy")));
    assert!(factors[0] == factors[1]);
}

/// A 16-bit picture times its scale is the light within the manifest's error. Voids are transparent and do not affect the scale.
#[test]
fn gpu_pictures_of_scattered_light_are_decoded() {
    let folder = Folder::new();
    folder.write("v.asc", b"ncols 4 nrows 3 cellsize 1 nodata_value -9 0 1 0 2 0 5 -9 0 0 3 0 1");
    const VOID: usize = 4 + 2;
    let words = "--what scatter --sky 3 --sun 200,40,0.5,1e4 --paths 16 --directions 16";
    done(&folder, &format!("bake v.asc -o out {words} --format png,npy"));
    let manifest = json(&folder.path("out/manifest.json"));
    let files = manifest["maps"][0]["files"].as_array().unwrap();
    let (_, ground_truth) = load(&folder.path("out/scatter.npy"));
    for (layer, name) in ["scatter_0000.png", "scatter_0001.png"].into_iter().enumerate() {
        let file = files.iter().find(|f| f["file"] == name).unwrap();
        let number = |value: &Value| value.as_f64().unwrap();
        let scale = number(&file["scale"]);
        assert_eq!(file["texels"], "RGBA of 16 bits");
        assert!(file["decoding"].as_str().unwrap().ends_with("each times scale"));
        let bytes = std::fs::File::open(folder.path("out").join(name)).unwrap();
        let mut reader = png::Decoder::new(std::io::BufReader::new(bytes)).read_info().unwrap();
        let mut grid_points = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut grid_points).unwrap();
        let codes: Vec<u16> =
            grid_points.as_chunks::<2>().0.iter().map(|b| u16::from_be_bytes(*b)).collect();
        let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
        for (at, texel) in codes.as_chunks::<4>().0.iter().enumerate() {
            assert_eq!(texel[3], if at == VOID { 0 } else { 65535 });
            for (c, code) in texel[..3].iter().enumerate().filter(|_| at != VOID) {
                let value = f64::from(ground_truth[(3 * layer + c) * 12 + at]);
                let got = scale * f64::from(*code) / 65535.0;
                worst = worst.max((got - value).abs());
                largest = largest.max(value);
            }
        }
        let error = &file["error"][0];
        assert_eq!(error["and_of_the_value"], 0.0);
        let most = number(&error["at_most"]);
        assert!(worst <= most && most < 1e-5 * scale && worst > 0.1 * most, "{worst} of {most}");
        assert_eq!(scale, largest, "{name}");
        assert_eq!(reader.info().source_gamma, None, "browsers would change the codes");
        let texts = &reader.info().uncompressed_latin1_text;
        let text = texts.iter().find(|t| t.keyword == "ridgelight.scale").unwrap();
        assert_eq!(text.text.parse::<f64>().unwrap(), scale);
    }
}

/// Notes name lights and albedo that the requested kinds do not use.
#[test]
fn gpu_unused_lights_are_reported() {
    let folder = Folder::new();
    write(&folder, "field.npy", [4, 4], |r, c| (r * c % 3) as f32);
    let light = "--sky 0.5 --sun 200,40 --key 90,45,60,20,1 --sphere-light 1,1,9,1,1";
    let names = ["--sky 0.5", "--sun 200,40", "--key 90,45,60,20,1", "--sphere-light 1,1,9,1,1"];
    let of = |words: &str| {
        let args = format!("bake field.npy -o out --format npy {words}");
        let run = folder.run_str(&args);
        assert_eq!(run.status, Some(0), "{}", run.err);
        std::fs::remove_dir_all(folder.path("out")).unwrap();
        run.err
    };
    for (kind, more) in [("sky-view --azimuths 4", 1), ("btf --angles 2x4 --bounces 0", 0)] {
        let said = of(&format!("{light} --albedo 0.5 --what {kind}"));
        assert_eq!(said.lines().count(), names.len() + more, "{said}");
        for name in names {
            let line = format!("note: {name} changes nothing without scatter or light-field\n");
            assert!(said.contains(&line), "{said}");
        }
        let albedo = "note: --albedo 0.5 changes nothing without scatter, brdf";
        assert_eq!(said.contains(albedo), more == 1, "{said}");
    }
    assert_eq!(of(&format!("{light} --albedo 0.5 --what sky-view --azimuths 4 --quiet")), "");
    let lit = "--paths 8 --directions 8 --bounces 1 --what scatter,sky-view --azimuths 4";
    assert_eq!(of(&format!("{light} --albedo 0.5 {lit}")), "");
}

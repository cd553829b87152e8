//! Requested and used settings for metadata, and times for --json.

use ridgelight::gpu::{Headless, Timing};
use ridgelight::plan::Plan;
use ridgelight::scene::{HeightField, Scene};

use super::lights::LIGHTS;
use crate::args::{FieldArgs, Input, LightArgs, SpecularArg, SurfaceArgs};
use crate::setup::tint::Tint;

/// The program and the field.
pub fn of_field(field: &HeightField) -> Vec<(String, String)> {
    vec![
        ("ridgelight".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        ("commit".to_owned(), env!("RIDGELIGHT_COMMIT").to_owned()),
        ("rows".to_owned(), field.rows().to_string()),
        ("cols".to_owned(), field.cols().to_string()),
        ("cell_m".to_owned(), format!("{},{}", field.cell_m()[0], field.cell_m()[1])),
        ("base_m".to_owned(), field.base_m().to_string()),
    ]
}

/// Used settings. No times: two runs write the same bytes.
pub fn metadata(gpu: &Headless, field: &HeightField, plan: &Plan) -> Vec<(String, String)> {
    let report = gpu.report();
    let mut all = of_field(field);
    all.extend([
        ("device".to_owned(), report.name.clone()),
        ("driver".to_owned(), report.driver.clone()),
        ("device_bytes".to_owned(), plan.bytes().to_string()),
    ]);
    all.extend(plan.settings.iter().cloned());
    all.extend(plan.notes.iter().enumerate().map(|(i, n)| (format!("note{}", i + 1), n.clone())));
    all
}

/// Requested settings that no plan holds.
pub fn asked(
    input: &Input,
    surface: &FieldArgs,
    lit: Option<(&LightArgs, &SurfaceArgs, &Scene)>,
) -> Vec<(String, String)> {
    let numbers = |c: &[f32; 3]| format!("{},{},{}", c[0], c[1], c[2]);
    let mut all = vec![
        ("input".to_owned(), input.names()),
        ("z_scale".to_owned(), surface.factor().to_string()),
    ];
    if let Some(nodata) = surface.nodata {
        all.push(("nodata".to_owned(), nodata.to_string()));
    }
    if let Some(band) = surface.band {
        all.push(("band".to_owned(), band.to_string()));
    }
    if let Some(bbox) = surface.bbox {
        all.push(("bbox".to_owned(), bbox.map(|x| x.to_string()).join(",")));
    }
    let Some((args, surface, scene)) = lit else { return all };
    match surface.tint {
        Some(tint) if tint != Tint::None => all.push(("tint".to_owned(), tint.name())),
        _ => all.push(("albedo".to_owned(), surface.albedo().to_owned())),
    }
    let specular = surface.specular.as_ref().map(|specular| match specular {
        SpecularArg::Constant(one) => format!("{},{}", one.exponent, one.scale),
        SpecularArg::File(path) => path.display().to_string(),
    });
    all.extend(specular.map(|text| ("specular".to_owned(), text)));
    if let Some(sky) = &scene.lights.sky {
        all.push(("sky".to_owned(), numbers(sky)));
    } else if scene.lights.environment.is_some() && args.env.is_none() {
        all.push(("sky".to_owned(), "clear".to_owned()));
    }
    if let Some(path) = &args.env {
        all.push(("env".to_owned(), path.display().to_string()));
        all.push(("env_rotate_deg".to_owned(), args.env_rotate.to_string()));
    }
    for light in &LIGHTS {
        let words = light.words(&scene.lights).into_iter().enumerate();
        all.extend(words.map(|(i, words)| (format!("{}{}", light.id, i + 1), words)));
    }
    all
}

/// Settings as JSON: numbers, lists of comma-separated numbers, and text. Files, devices and `--lines` (1, 1/2, exact) are
/// always text.
pub fn typed(settings: &[(String, String)]) -> serde_json::Map<String, serde_json::Value> {
    const WORDS: [&str; 7] = ["ridgelight", "commit", "device", "driver", "input", "env", "lines"];
    let typed = |name: &str, text: &str| {
        let number = |t: &str| serde_json::from_str::<serde_json::Number>(t).ok();
        let all: Option<Vec<_>> = text.split(',').map(number).collect();
        match all {
            Some(numbers) if !WORDS.contains(&name) => match numbers.as_slice() {
                [one] => one.clone().into(),
                more => more.into(),
            },
            _ => text.into(),
        }
    };
    settings.iter().map(|(name, text)| (name.clone(), typed(name, text))).collect()
}

/// Settings and times, for `--json`.
pub fn as_json(metadata: &[(String, String)], times: &[Timing]) -> serde_json::Value {
    let mut settings = typed(metadata);
    if !times.is_empty() {
        let total: f64 = times.iter().map(|t| t.ns).sum();
        settings.insert("gpu_ms".to_owned(), ((total / 1e3).round() / 1e3).into());
    }
    let passes: Vec<_> =
        times.iter().map(|t| serde_json::json!({ "pass": t.label, "ns": t.ns })).collect();
    serde_json::json!({ "settings": settings, "passes": passes })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_numbers_and_words_are_words() {
        let settings = [
            ("azimuths", "64"),
            ("z_scale", "0.5"),
            ("nodata", "-32768"),
            ("sky", "0.25,1,1e6"),
            ("lines", "1"),
            ("input", "7"),
            ("albedo", "colours.png"),
            ("note1", "1, of 2"),
            ("until", "inf"),
            ("empty", ""),
        ]
        .map(|(name, text)| (name.to_owned(), text.to_owned()));
        let expected = serde_json::json!({
            "azimuths": 64, "z_scale": 0.5, "nodata": -32768, "sky": [0.25, 1, 1e6], "lines": "1", "input": "7",
            "albedo": "colours.png", "note1": "1, of 2", "until": "inf", "empty": "",
        });
        assert_eq!(serde_json::Value::from(typed(&settings)), expected);
    }
}

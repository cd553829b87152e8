//! Requested and used settings for metadata, and times for --json.

use ridgelight::gpu::{Headless, Timing};
use ridgelight::plan::Plan;
use ridgelight::scene::{HeightField, Scene};

use super::lights::LIGHTS;
use crate::args::{FieldArgs, Input, SceneArgs, SpecularArg};
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
    field: &FieldArgs,
    lit: Option<(&SceneArgs, &Scene)>,
) -> Vec<(String, String)> {
    let mut all = Vec::new();
    let mut add = |name: &str, value: Option<String>| {
        all.extend(value.map(|value| (name.to_owned(), value)));
    };
    add("input", Some(input.names()));
    add("z_scale", Some(field.factor().to_string()));
    add("nodata", field.nodata.map(|height| height.to_string()));
    add("band", field.band.map(|number| number.to_string()));
    add("bbox", field.bbox.map(|bbox| bbox.map(|side| side.to_string()).join(",")));
    let Some((args, scene)) = lit else { return all };
    match args.tint {
        Some(tint) if tint != Tint::None => add("tint", Some(tint.name())),
        _ => add("albedo", Some(args.albedo().to_owned())),
    }
    let specular = args.specular.as_ref().map(|specular| match specular {
        SpecularArg::Constant(one) => format!("{},{}", one.exponent, one.scale),
        SpecularArg::File(path) => path.display().to_string(),
    });
    add("specular", specular);
    let has_clear_sky = scene.lights.environment.is_some() && args.lights.env.is_none();
    let clear = has_clear_sky.then(|| "clear".to_owned());
    add("sky", scene.lights.sky.map(|sky| sky.map(|c| c.to_string()).join(",")).or(clear));
    add("env", args.lights.env.as_ref().map(|path| path.display().to_string()));
    add("env_rotate_deg", args.lights.env.as_ref().map(|_| args.lights.env_rotate.to_string()));
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

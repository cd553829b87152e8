//! The JSON schema of scene files, from the keys that read them, and the page of settings.

use clap::CommandFactory as _;
use ridgelight::scene::{Audience, Quality, SETTINGS, Values, setting};
use serde_json::{Value, json};

use super::keys::{INPUT, Key, Kind, Numbers, Or, Part, groups};
use crate::args::{Cli, flag};
use crate::setup::lights::LIGHTS;

fn list(least: usize, most: usize) -> Value {
    json!({ "type": "array", "items": { "type": "number" }, "minItems": least, "maxItems": most })
}

fn numbers(numbers: Numbers) -> Value {
    let one = json!({ "type": "number" });
    match numbers {
        Numbers::One => one,
        Numbers::Pair => json!({ "anyOf": [one, list(2, 2)] }),
        Numbers::Colour => json!({ "anyOf": [one, list(3, 3)] }),
        Numbers::Three => list(3, 3),
        Numbers::Four => list(4, 4),
        Numbers::TwoOrThree => list(2, 3),
    }
}

fn object(parts: &[Part]) -> Value {
    let with_default = |part: &Part| {
        let mut value = numbers(part.numbers);
        if let Some(default) = part.default.filter(|text| !text.is_empty()) {
            value["default"] = serde_json::from_str(default).expect("a number");
        }
        (part.name.to_owned(), value)
    };
    let members: serde_json::Map<_, _> = parts.iter().map(with_default).collect();
    let required: Vec<&str> =
        parts.iter().filter(|part| part.default.is_none()).map(|part| part.name).collect();
    json!({ "type": "object", "properties": members, "required": required, "additionalProperties": false })
}

fn value(key: &Key, render: &clap::Command) -> Value {
    let id = if key.id == INPUT { "path" } else { key.id };
    let arg = render.get_arguments().find(|arg| arg.get_id() == id).expect("a flag of ours");
    let mut value = match key.kind {
        Kind::Word => {
            let words = arg.get_possible_values();
            let words: Vec<Value> = words
                .iter()
                .flat_map(|word| {
                    let number = word.get_name().parse::<u32>().ok().map(Value::from);
                    [Some(Value::from(word.get_name())), number]
                })
                .flatten()
                .collect();
            if words.is_empty() {
                json!({ "type": ["string", "number"] })
            } else {
                json!({ "enum": words })
            }
        }
        Kind::File => json!({ "type": "string" }),
        Kind::Files => {
            let one = json!({ "type": "string" });
            json!({ "anyOf": [one, { "type": "array", "items": one, "minItems": 1 }] })
        }
        Kind::Numbers(count) => numbers(count),
        Kind::Parts(parts) => object(parts),
        Kind::Switch => json!({ "type": "boolean" }),
        Kind::List(parts) => json!({ "type": "array", "items": object(parts) }),
    };
    let text = match key.or {
        Or::Nothing => None,
        Or::File => Some(json!({ "type": "string" })),
        Or::Word(word) => Some(json!({ "const": word })),
    };
    if let Some(text) = text {
        let mut forms = match value.get_mut("anyOf").map(Value::take) {
            Some(Value::Array(forms)) => forms,
            _ => vec![value.clone()],
        };
        forms.insert(0, text);
        value = json!({ "anyOf": forms });
    }
    let help = arg.get_long_help().or(arg.get_help());
    value["description"] = help.map(ToString::to_string).unwrap_or_default().into();
    value
}

fn schema() -> Value {
    let parser = Cli::command();
    let render = parser.find_subcommand("render").expect("a command of ours");
    let group = |keys: &[Key]| {
        let members = keys.iter().map(|key| (key.name.to_owned(), value(key, render)));
        let members: serde_json::Map<_, _> = members.collect();
        json!({ "type": "object", "properties": members, "additionalProperties": false })
    };
    let groups = groups().into_iter().map(|(name, keys)| (name.to_owned(), group(&keys)));
    let mut groups: serde_json::Map<_, _> = groups.collect();
    groups.insert("$schema".into(), json!({ "type": "string" }));
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A scene for ridgelight --scene",
        "description": "Each key stands for a flag of `ridgelight render`. Paths are relative to this file's folder.",
        "type": "object",
        "properties": groups,
        "additionalProperties": false,
    })
}

/// The table of docs/settings.md.
fn settings_page() -> String {
    let mut page = "# Settings\n\nSettings trade time and memory for accuracy. One definition in `src/scene/quality.rs` gives the flag of \
                    the command line (`--sun-azimuths`), the JSON key (`sun_azimuths`), the field of `RidgelightQuality` and \
                    the viewer's entry. [Choosing settings](choosing-settings.md) explains which to change first.\n"
        .to_owned();
    let groups = [
        ("For everyone", Audience::Everyone),
        ("To compare methods", Audience::Advanced),
        ("To measure the methods themselves", Audience::Expert),
    ];
    for (title, audience) in groups {
        page += &format!(
            "\n## {title}\n\n| setting | values | default | effect |\n|---|---|---|---|\n"
        );
        for setting in SETTINGS.iter().filter(|setting| setting.audience == audience) {
            let values = match &setting.values {
                Values::Words(words) => {
                    let all = words.iter().map(|w| format!("`{}`: {}", w.name, w.summary()));
                    all.collect::<Vec<_>>().join("<br>")
                }
                Values::Whole(range) => format!("{} to {}", range.start(), range.end()),
                values => values.expected(),
            };
            let default = match &setting.values {
                Values::Share => "1/65536".to_owned(),
                _ => setting.get(&Quality::default()),
            };
            let effect = format!("{}. {}", setting.summary(), setting.trade());
            let row = [&format!("`{}`", setting.name), &values, &default, effect.trim_end()];
            page += &format!("| {} |\n", row.map(|cell| cell.replace('|', "\\|")).join(" | "));
        }
    }
    page
}

/// The table of lights in docs/command-line.md, from the one that their flags follow from.
fn lights_table() -> String {
    let mut table = "\n| flag | key in scene files | light |\n|---|---|---|\n".to_owned();
    for light in &LIGHTS {
        let name = flag(light.id);
        let row = [
            format!("`{name} {}`", light.value_name),
            format!("`{}`", light.list),
            format!(
                "{}. {}",
                light.help,
                light.long_help.split(" Repeat the flag").next().unwrap()
            ),
        ];
        table += &format!("| {} |\n", row.map(|cell| cell.replace('|', "\\|")).join(" | "));
    }
    table + "\n"
}

fn is_kept(name: &str, text: &str) {
    let path = format!("{}/../../docs/{name}", env!("CARGO_MANIFEST_DIR"));
    if std::env::var_os("RIDGELIGHT_BLESS").is_some_and(|v| v == "1") {
        std::fs::write(&path, text).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(kept == text, "docs/{name} is out of date: RIDGELIGHT_BLESS=1 writes it");
}

#[test]
fn the_schema_that_is_kept_is_of_the_keys_that_are_read() {
    is_kept("scene.schema.json", &format!("{:#}\n", schema()));
}

#[test]
fn the_page_of_the_command_line_lists_the_lights() {
    let path = format!("{}/../../docs/command-line.md", env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(path).unwrap();
    let (before, rest) = page.split_once("<!-- begin lights -->\n").unwrap();
    let (_, after) = rest.split_once("<!-- end lights -->").unwrap();
    let marked = ["<!-- begin lights -->\n", &lights_table(), "<!-- end lights -->"].concat();
    is_kept("command-line.md", &[before, &marked, after].concat());
}

#[test]
fn the_page_of_settings_follows_from_their_definitions() {
    for share in ["light_cutoff", "bounce_cutoff"] {
        assert_eq!(setting(share).unwrap().get(&Quality::default()), (1.0 / 65536.0).to_string());
    }
    is_kept("settings.md", &settings_page());
}

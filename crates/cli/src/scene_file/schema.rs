//! The JSON schema of scene files, from the keys that read them.

use clap::CommandFactory as _;
use serde_json::{Value, json};

use super::keys::{GROUPS, INPUT, Key, Kind, Numbers, Part, quality};
use crate::args::Cli;

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
        Kind::Numbers(count) => numbers(count),
        Kind::ColourOrFile => {
            json!({ "anyOf": [{ "type": "string" }, { "type": "number" }, list(3, 3)] })
        }
        Kind::PartsOrFile(parts) => json!({ "anyOf": [{ "type": "string" }, object(parts)] }),
        Kind::Parts(parts) => object(parts),
        Kind::Switch => json!({ "type": "boolean" }),
        Kind::List(parts) => json!({ "type": "array", "items": object(parts) }),
    };
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
    let mut groups: serde_json::Map<_, _> =
        GROUPS.iter().map(|(name, keys)| ((*name).to_owned(), group(keys))).collect();
    groups.insert("quality".into(), group(&quality(&parser)));
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

/// `RIDGELIGHT_BLESS=1` writes it.
#[test]
fn the_schema_that_is_kept_is_of_the_keys_that_are_read() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/scene.schema.json");
    let text = format!("{:#}\n", schema());
    if std::env::var_os("RIDGELIGHT_BLESS").is_some_and(|v| v == "1") {
        std::fs::write(path, &text).unwrap();
    }
    let kept = std::fs::read_to_string(path).unwrap();
    assert!(kept == text, "docs/scene.schema.json is out of date: RIDGELIGHT_BLESS=1 writes it");
}

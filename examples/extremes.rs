//! Measures every extreme of `tests/gpu/extremes` under every method on the devices named, and writes
//! what was found as `out/extremes.md`. See `tools/extremes`.
//!
//! `cargo run --example extremes -- llvmpipe SwiftShader`; fails where a row is beyond its bound.

#[path = "../tests/gpu/extremes/suite/mod.rs"]
mod suite;

use std::path::Path;
use std::process::ExitCode;

use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight_io as files;
use suite::methods::{self, Method};
use suite::page::{self, Column};
use suite::{Case, inputs};

fn measure(name: &str, cases: &[Case], methods: &[Method]) -> ridgelight::Result<Column> {
    let options = HeadlessOptions { device: Some(name.to_owned()), validation: false };
    let mut gpu = Headless::new(&options)?;
    let driver = format!("{}, {}", gpu.report().name, gpu.report().driver);
    let rows = suite::run(&mut gpu, cases, methods, true);
    Ok(Column { name: name.to_owned(), driver, rows })
}

fn main() -> ExitCode {
    let devices: Vec<String> = std::env::args().skip(1).collect();
    if devices.is_empty() || devices[0].starts_with('-') {
        eprintln!("usage: extremes DEVICE...");
        return ExitCode::from(2);
    }
    let (cases, methods) = (suite::cases(), methods::all());
    let mut all = Vec::new();
    for name in &devices {
        match measure(name, &cases, &methods) {
            Ok(found) => all.push(found),
            Err(error) => {
                eprintln!("extremes: {error}");
                return ExitCode::FAILURE;
            }
        }
    }
    let mut is_right = true;
    for device in &all {
        let values: usize = device.rows.iter().map(|r| r.outcome.values()).sum();
        println!("{}: {} rows, {values} values", device.name, device.rows.len());
        for said in device.rows.iter().filter_map(|r| suite::complaint(r, &cases, &methods)) {
            eprintln!("extremes: {}: {said}", device.name);
            is_right = false;
        }
    }
    for (name, offer, sentence) in inputs::ALL {
        if inputs::said(*offer) != *sentence {
            eprintln!("extremes: {name}: {}", inputs::said(*offer));
            is_right = false;
        }
    }
    let path = Path::new("out/extremes.md");
    let page = page::text(&cases, &methods, &all);
    for lack in page::missing(&page, &cases, &methods) {
        eprintln!("extremes: the page lacks {lack}");
        is_right = false;
    }
    let folder = path.parent().expect("a folder");
    let made = std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()));
    if let Err(error) =
        made.and_then(|()| files::write_text(path, &page).map_err(|e| e.to_string()))
    {
        eprintln!("extremes: {error}");
        return ExitCode::FAILURE;
    }
    if is_right { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

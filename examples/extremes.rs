//! Measures every extreme of `tests/gpu/extremes` under every method on the devices named, and writes
//! what was found as `docs/extremes.md`. See `tools/extremes`.
//!
//! `cargo run --example extremes -- llvmpipe SwiftShader`; fails where a row is beyond its bound.

#[path = "../tests/gpu/extremes/suite/mod.rs"]
mod suite;

use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight_io as files;
use suite::methods::{self, Method};
use suite::{Case, Outcome, Row, inputs, page};

/// What a device found: its name and driver, and a row for every case under every method.
struct Found {
    name: String,
    driver: String,
    rows: Vec<Row>,
}

fn measure(name: &str, cases: &[Case], methods: &[Method]) -> ridgelight::Result<Found> {
    let options = HeadlessOptions { device: Some(name.to_owned()), validation: false };
    let mut gpu = Headless::new(&options)?;
    let driver = format!("{}, {}", gpu.report().name, gpu.report().driver);
    let rows = suite::run(&mut gpu, cases, methods, true);
    Ok(Found { name: name.to_owned(), driver, rows })
}

fn text(cases: &[Case], methods: &[Method], found: &[Found]) -> String {
    let mut out = page::ABOUT.to_owned();
    for device in found {
        writeln!(out, "\n{}: *{}*", device.name, device.driver).unwrap();
    }
    for (c, case) in cases.iter().enumerate() {
        writeln!(out, "{}", page::heading(case)).unwrap();
        out += "| method |";
        found.iter().for_each(|f| write!(out, " {}: worst | bound | share |", f.name).unwrap());
        writeln!(out, "\n|---|{}", "---|---|---|".repeat(found.len())).unwrap();
        let of_case = |(_, m): &(usize, &Method)| m.about == case.about;
        for (m, method) in methods.iter().enumerate().filter(of_case) {
            write!(out, "| {} |", method.name).unwrap();
            for device in found {
                let row = device.rows.iter().find(|r| (r.case, r.method) == (c, m));
                let outcome = &row.expect("a row for every case under every method").outcome;
                out += &cells(outcome, (case.unjudged)(method));
            }
            out.push('\n');
        }
    }
    out += page::INPUTS;
    for (name, offer, _) in inputs::ALL {
        writeln!(out, "{}", page::refused(name, &inputs::said(*offer))).unwrap();
    }
    out
}

fn cells(outcome: &Outcome, unjudged: bool) -> String {
    match outcome {
        Outcome::Refused(said) => format!(" refused: *{said}* | | |"),
        Outcome::Measured { largest_error, .. } if unjudged => {
            format!(" {largest_error:.2e} | {0} | {0} |", page::UNJUDGED)
        }
        Outcome::Measured { worst, largest_error, .. } => {
            format!(" {largest_error:.2e} | {:.2e} | {:.3} |", worst.bound, worst.ratio())
        }
    }
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
    let path = Path::new("docs/extremes.md");
    let page = text(&cases, &methods, &all);
    for lack in page::missing(&page, &cases, &methods) {
        eprintln!("extremes: the page lacks {lack}");
        is_right = false;
    }
    if let Err(error) = files::write_text(path, &page) {
        eprintln!("extremes: {error}");
        return ExitCode::FAILURE;
    }
    if is_right { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

//! Every extreme of `tests/gpu/extremes` under every method on the devices named, as `out/extremes.md`.
//! Fails where a row is beyond its bound. See `tools/extremes`.

#[path = "../../../tests/gpu/extremes/suite/mod.rs"]
mod suite;

use std::path::Path;

use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight_io as files;
use suite::page::{self, Column};
use suite::{inputs, methods};

use crate::common::Outcome;
use crate::common::args::Args;

pub fn run(args: Args) -> Outcome {
    if args.0.is_empty() {
        return Err("expected a device".into());
    }
    let (cases, methods) = (suite::cases(), methods::all());
    let (mut all, mut complaints) = (Vec::new(), Vec::new());
    for name in args.0 {
        let options = HeadlessOptions { device: Some(name.clone()), validation: false };
        let mut gpu = Headless::new(&options)?;
        let driver = format!("{}, {}", gpu.report().name, gpu.report().driver);
        let rows = suite::run(&mut gpu, &cases, &methods, true);
        let values: usize = rows.iter().map(|r| r.outcome.values()).sum();
        println!("{name}: {} rows, {values} values", rows.len());
        let wrong = rows.iter().filter_map(|r| suite::complaint(r, &cases, &methods));
        complaints.extend(wrong.map(|complaint| format!("{name}: {complaint}")));
        all.push(Column { name, driver, rows });
    }
    for (name, offer, sentence) in inputs::ALL {
        if inputs::said(*offer) != *sentence {
            complaints.push(format!("{name}: {}", inputs::said(*offer)));
        }
    }
    let page = page::text(&cases, &methods, &all);
    let missing = page::missing(&page, &cases, &methods);
    complaints.extend(missing.into_iter().map(|part| format!("the page lacks {part}")));
    std::fs::create_dir_all("out")?;
    files::write_text(Path::new("out/extremes.md"), &page)?;
    if complaints.is_empty() { Ok(()) } else { Err(complaints.join("\n").into()) }
}

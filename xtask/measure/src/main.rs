//! Measures the project and makes the tables and pictures of its pages: `cargo measure NAME`.
//! `tools/bench` runs these programs and keeps what they print in `benches/results`.

mod accuracy;
mod auto;
mod bake;
mod bounce;
mod common;
mod curved;
mod defaults;
mod fourier;
mod gallery;
mod goals;
mod hosts;
mod lights;
mod pages;
mod performance;
mod pictures;
mod scatter;
mod shadow_edge;
mod shadows;
mod soft {
    //! Pyramids and SH against exact horizons and tables: errors, memory, times.
    pub mod converge;
    pub mod rivals;
    pub mod sizes;
}
mod specular;
mod suites;
mod suns;

use std::process::ExitCode;

use common::Outcome;
use common::args::Args;

type Program = (&'static str, &'static str, fn(Args) -> Outcome);

const PROGRAMS: [Program; 33] = [
    ("accuracy", "FIELD [--cell X,Y] [--env FILE] [--points N] [--pyramids]", accuracy::run),
    (
        "auto",
        "FOLDER [--fit] [--side N] [--seconds S] [--specular N] [--only TEXT] [--json FILE]",
        auto::run,
    ),
    ("bake", "-o PICTURE.png --json FILE", bake::run),
    ("bleed", "-o PICTURE.png", pictures::bleed),
    ("bounce", "[FOLDER] [--side N] [--spp N] [--rim N] [-o FILE.svg]", bounce::run),
    ("bounce-table", "[--side N] [--runs K]", bounce::table::run),
    ("brdf", "[FOLDER] [-o PICTURE.png]", scatter::brdf::run),
    ("cones", "[-o PICTURE.png]", lights::cones),
    ("curved", "[-o FILE.svg]", curved::run),
    ("defaults", "[--data FOLDER] [--side N]", defaults::run),
    ("extremes", "DEVICE...", suites::extremes),
    ("field", "NAME SIDE FIELD.npy", gallery::field),
    ("fourier", "[FOLDER]", fourier::run),
    ("gallery", "PROGRAM [FOLDER]", gallery::run),
    ("gloss", "[SIDE] [--spp N] [-o PICTURE.png]", specular::indirect),
    ("goals", "PROGRAM [FOLDER]", goals::run),
    ("hosts", "HOST=CRATES=PROGRAM...", hosts::run),
    ("lights", "[SIDE]", lights::run),
    ("lobe", "[SIDE]", specular::direct),
    ("specular-times", "", specular::times),
    ("pages", "[--check]", pages::run),
    ("performance", "PROGRAM|--redraw -o FILE.svg --json FILE", performance::run),
    ("picture", "-o PICTURE.png --json FILE", pictures::picture),
    ("reference", "DEVICE", suites::reference),
    ("rivals", "FOLDER [--side N] [--runs K] [-o FILE.svg]", soft::rivals::run),
    ("scatter", "[FOLDER] [--side N] [--spp N] [-o PICTURE.png]", scatter::run),
    ("shadow-edge", "[-o FILE.svg]", shadow_edge::run),
    ("shadows", "[FOLDER] [--side N] [-o PICTURE.png]", shadows::run),
    ("soft", "FIELD [--cell X,Y] [--env FILE] [--side N] [-o FILE.svg]", soft::converge::run),
    ("soft-sizes", "[--largest N] [--runs K]", soft::sizes::run),
    ("suns", "[FOLDER]", suns::run),
    ("terrain", "-o PICTURE.png --json FILE", pictures::terrain),
    ("town", "-o PICTURE.png", pictures::town),
];

fn main() -> ExitCode {
    let mut args = Args(std::env::args().skip(1).collect());
    let name = args.word().unwrap_or_default();
    let Some((_, usage, run)) = PROGRAMS.iter().find(|program| program.0 == name) else {
        eprintln!("usage: cargo measure NAME ..., one of");
        PROGRAMS.iter().for_each(|(name, usage, _)| eprintln!("  {name} {usage}"));
        return ExitCode::from(2);
    };
    match run(args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{name}: {error}\nusage: cargo measure {name} {usage}");
            ExitCode::FAILURE
        }
    }
}

//! The program `ridgelight`. It uses the libraries' public API only.

/// Prints a line to standard output. A closed pipe (`| head`) is no error.
macro_rules! say {
    ($($text:tt)*) => {{
        use std::io::Write as _;
        crate::said(writeln!(std::io::stdout(), $($text)*));
    }};
}
pub(crate) use say;

/// Handles an error of standard output: a closed pipe is ignored, any other ends the program with
/// 1.
fn said(written: std::io::Result<()>) {
    match written {
        Ok(()) => {}
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => {}
        Err(error) => {
            eprintln!("ridgelight: standard output: {error}");
            ridgelight_io::abandon_unfinished();
            std::process::exit(1);
        }
    }
}

mod args;
mod bake;
mod bench;
mod compare;
mod horizon;
mod idle;
mod maps;
mod plan;
mod reference;
mod render;
mod scene_file;
mod setup;
mod trade;
#[cfg(feature = "window")]
mod view;
#[cfg(not(feature = "window"))]
mod view {
    pub fn run(_: &crate::args::ViewArgs) -> ridgelight::Result<crate::setup::Outcome> {
        let expected = "a program that was built with --features window";
        Err(ridgelight::Error::setting("view", "a program without windows", expected))
    }
}

use std::io::Write as _;
use std::process::ExitCode;

/// The exit status that shells report for Ctrl-C.
const INTERRUPTED: u8 = 130;

/// Removes unfinished files when a signal ends the program.
fn end_cleanly_on_signals() {
    let end = || {
        if reference::takes_signal() {
            return;
        }
        ridgelight_io::abandon_unfinished();
        let _ = writeln!(std::io::stderr(), "ridgelight: interrupted");
        std::process::exit(INTERRUPTED.into());
    };
    // Fails where a signal is ignored (nohup, background jobs): it stays ignored, others keep their
    // defaults, and unfinished files may remain.
    let _ = ctrlc::try_set_handler(end);
}

fn main() -> ExitCode {
    let (command, scene) = match args::Cli::read() {
        Ok(cli) => (cli.command, cli.scene),
        Err(args::Refused::Value(error)) => return fail(&error),
        Err(args::Refused::Parser(error)) => {
            // Help and version are not errors. clap's status for wrong usage is 2.
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    end_cleanly_on_signals();
    let done = match &command {
        args::Command::Render(args) => render::run(args),
        args::Command::Info(args) => plan::info::run(args),
        args::Command::Horizon(args) => horizon::run(args),
        args::Command::Hillshade(args) => maps::hillshade(args),
        args::Command::Shadow(args) => maps::shadow(args),
        args::Command::Ao(args) => maps::sky_view_map(args, maps::SKY_VIEW_VALUES),
        args::Command::Svf(args) => maps::sky_view_map(args, maps::SVF_VALUES),
        args::Command::Openness(args) => maps::openness(args),
        args::Command::Plan(args) => plan::run(args),
        args::Command::Bench(args) => bench::run(args),
        args::Command::Tune(args) => bench::tune::run(args),
        args::Command::Compare(args) => compare::run(args),
        args::Command::Devices(args) => plan::devices(args),
        args::Command::Reference(args) => reference::run(args),
        args::Command::Trade(args) => trade::run(args),
        args::Command::Bake(args) => bake::run(args),
        args::Command::View(args) => view::run(args),
    };
    match done {
        Ok(setup::Outcome::Done) => ExitCode::SUCCESS,
        Ok(setup::Outcome::Beyond) => ExitCode::from(1),
        Ok(setup::Outcome::Interrupted) => ExitCode::from(INTERRUPTED),
        Err(error) => fail(&scene.place(setup::in_flags(error))),
    }
}

/// Prints an error and returns its exit status.
fn fail(error: &ridgelight::Error) -> ExitCode {
    // One line, whatever file names or drivers contain. A closed stderr must not panic.
    let line = error.to_string().replace(char::is_control, " ");
    let _ = writeln!(std::io::stderr(), "ridgelight: {line}");
    ExitCode::from(if matches!(error, ridgelight::Error::Setting { .. }) { 2 } else { 1 })
}

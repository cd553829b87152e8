//! The command line: the first embedder, through the public API alone.

/// A line on standard output; a reader that has gone (`| head`) is no error.
macro_rules! say {
    ($($text:tt)*) => {{
        use std::io::Write as _;
        crate::said(writeln!(std::io::stdout(), $($text)*));
    }};
}
pub(crate) use say;

/// Ends where standard output cannot take what is said: with 0 where nobody reads on, with 1 where it
/// is full or broken.
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
mod auto;
mod bake;
mod bench;
mod camera;
mod compare;
mod devices;
mod horizon;
mod idle;
mod plan;
mod reference;
mod render;
mod scene_file;
mod setup;
mod terminal;
mod trade;
#[cfg(feature = "window")]
mod view;
#[cfg(not(feature = "window"))]
#[path = "view/none.rs"]
mod view;

use std::io::Write as _;
use std::process::ExitCode;

/// What shells report of a command that Ctrl-C ended.
const INTERRUPTED: u8 = 130;

/// Leaves no unfinished file behind when the user, the terminal or the system asks to end.
fn end_cleanly_on_signals() {
    let end = || {
        if reference::hears_signal() {
            return;
        }
        ridgelight_io::abandon_unfinished();
        let _ = writeln!(std::io::stderr(), "ridgelight: interrupted");
        std::process::exit(INTERRUPTED.into());
    };
    // Where one of the signals is ignored (nohup, jobs in the background of a script) it stays so,
    // and the others do what they do by default: no more than tidiness is lost.
    let _ = ctrlc::try_set_handler(end);
}

fn main() -> ExitCode {
    let (command, scene) = match args::Cli::read() {
        Ok(cli) => (cli.command, cli.scene),
        Err(args::Refused::Scene(error)) => return fail(&error),
        Err(args::Refused::Parser(error)) => {
            // Help and version are not errors; clap's own exit status for wrong usage is 2.
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    end_cleanly_on_signals();
    let done = match &command {
        args::Command::Render(args) => render::run(args),
        args::Command::Horizon(args) => horizon::run(args),
        args::Command::Plan(args) => plan::run(args),
        args::Command::Bench(args) => bench::run(args),
        args::Command::Compare(args) => compare::run(args),
        args::Command::Devices(args) => devices::run(args),
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

/// Says what went wrong; the exit status that goes with it.
fn fail(error: &ridgelight::Error) -> ExitCode {
    // One line whatever a file is called or a driver says; a closed stderr is no panic.
    let line = error.to_string().replace(char::is_control, " ");
    let _ = writeln!(std::io::stderr(), "ridgelight: {line}");
    ExitCode::from(if matches!(error, ridgelight::Error::Setting { .. }) { 2 } else { 1 })
}

//! The command line: the first embedder, through the public API alone.

/// A line on standard output; a reader that has gone (`| head`) is no error.
macro_rules! say {
    ($($text:tt)*) => {{
        use std::io::Write as _;
        let _ = writeln!(std::io::stdout(), $($text)*);
    }};
}
pub(crate) use say;

mod args;
mod bench;
mod compare;
mod devices;
mod horizon;
mod plan;
mod render;
mod setup;

use clap::Parser as _;
use std::process::ExitCode;

fn main() -> ExitCode {
    let command = match args::Cli::try_parse() {
        Ok(cli) => cli.command,
        Err(error) => {
            // Help and version are not errors; clap's own exit status for wrong usage is 2.
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    let done = match &command {
        args::Command::Render(args) => render::run(args),
        args::Command::Horizon(args) => horizon::run(args),
        args::Command::Plan(args) => plan::run(args),
        args::Command::Bench(args) => bench::run(args),
        args::Command::Compare(args) => compare::run(args),
        args::Command::Devices(args) => devices::run(args),
        args::Command::Reference(_)
        | args::Command::Trade(_)
        | args::Command::Bake(_)
        | args::Command::View(_) => {
            eprintln!("ridgelight: this command is not yet there");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(setup::Outcome::Done) => ExitCode::SUCCESS,
        Ok(setup::Outcome::Beyond) => ExitCode::from(1),
        Err(error) => {
            eprintln!("ridgelight: {error}");
            ExitCode::from(if matches!(error, ridgelight::Error::Setting { .. }) { 2 } else { 1 })
        }
    }
}

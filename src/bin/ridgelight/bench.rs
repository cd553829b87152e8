use ridgelight::Result;

use crate::args::BenchArgs;
use crate::setup::Outcome;

pub fn run(args: &BenchArgs) -> Result<Outcome> {
    args.later.check()?;
    Ok(Outcome::Done)
}

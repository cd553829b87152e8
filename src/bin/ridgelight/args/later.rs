use clap::Args;

/// Flags of methods that are still to come: known, so that the answer is not "unexpected argument".
#[derive(Args)]
pub struct LaterArgs {
    #[arg(long, hide = true, allow_hyphen_values = true)]
    camera: Option<String>,
}

impl LaterArgs {
    /// Refuses them.
    pub fn check(&self) -> ridgelight::Result<()> {
        let given = [("--camera", self.camera.as_ref())];
        match given.into_iter().find_map(|(name, value)| Some((name, value?))) {
            Some((name, value)) => Err(ridgelight::Error::setting(
                name,
                value.as_str(),
                "nothing: it is not yet there",
            )),
            None => Ok(()),
        }
    }
}

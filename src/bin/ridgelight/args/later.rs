use clap::Args;

/// Flags of methods that are still to come: known, so that the answer is not "unexpected argument".
#[derive(Args)]
pub struct LaterArgs {
    #[arg(long, hide = true, allow_hyphen_values = true)]
    scene: Option<String>,
}

impl LaterArgs {
    /// Refuses them.
    pub fn check(&self) -> ridgelight::Result<()> {
        match self.scene.as_deref() {
            Some(value) => {
                Err(ridgelight::Error::setting("--scene", value, "nothing: it is not yet there"))
            }
            None => Ok(()),
        }
    }
}

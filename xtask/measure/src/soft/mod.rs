//! Soft horizons and SH beside sharp horizons and tables: errors, memory, times.

pub mod converge;
pub mod rivals;
pub mod sizes;

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::scene::{Method, Quality, Scene};

use crate::common::frames::{Colours, drawn};

/// Every crossing in 256 azimuths, by tables of 1024 elevations.
fn truth(gpu: &mut Headless, scene: &Scene) -> Result<Colours> {
    let method = Method::BruteForce;
    let quality = Quality { method, azimuths: 256, table_elevations: 1024, ..Quality::default() };
    Ok(drawn(gpu, scene, &quality, 0)?.light)
}

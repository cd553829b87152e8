//! What sub-sampled bounces are off, and what they save.

use std::path::Path;

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::scene::{Albedo, Bounces, Lights, Quality, Scene, Surface};
use ridgelight_io::{HeightOptions, read_environment, read_heights};

use crate::middle::middle;
use crate::{ENGINES, drawn, off, quality};

const SIDE: usize = 128;

pub fn run(gpu: &mut Headless) -> Result<()> {
    let options = HeightOptions { cell_m: Some([66.0, 92.6]), ..HeightOptions::default() };
    let mountain = read_heights(Path::new("assets/mt_washington_256.png"), &options)?;
    let sky = read_environment(Path::new("assets/sky_512x256.hdr"), 0.0)?;
    let scene = Scene {
        field: middle(&mountain, SIDE)?,
        surface: Surface { albedo: Albedo::Constant([0.8; 3]), ..Surface::default() },
        lights: Lights { environment: Some(sky), ..Lights::default() },
    };
    println!(
        "Sub-sampled bounces, the middle {SIDE}² samples of the bundled mountain under the bundled sky, albedo 0.8, 32 \
         azimuths: RMSE over the mean, %, beside every sample's; ms of the bounces over theirs\n"
    );
    println!("| engine | bounces | sub-sampling | bounced | whole | ms | over 1× |");
    println!("|---|---|---|---|---|---|---|");
    for engine in ENGINES {
        for count in [1, 3] {
            let bounces = Bounces { count, engine, cutoff: 0.0, ..Bounces::default() };
            let mut of = |subsample| drawn(gpu, &scene, &Quality { subsample, ..quality(bounces) });
            let every = of(1)?;
            for subsample in [1, 2, 4] {
                let got = of(subsample)?;
                println!(
                    "| {} | {count} | {subsample}× | {:.2} | {:.3} | {:.1} | {:.3} |",
                    engine.name(),
                    off(&got.bounced, &every.bounced),
                    off(&got.whole, &every.whole),
                    got.ms,
                    got.ms / every.ms
                );
            }
        }
    }
    println!();
    Ok(())
}

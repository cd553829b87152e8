//! The baked sky view of the device's horizons of real ground, against the quadrature over the oracle's.

use std::f64::consts::TAU;
use std::path::Path;

use ridgelight::scene::{Border, Method, Quality};
use ridgelight_bake::{HorizonSums, Ray, SkyView, normals};
use ridgelight_cpu::light;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::tolerance::{ShadeError, device_march_slope};
use ridgelight_io as files;
use ridgelight_io::HeightOptions;

use crate::{Device, field, random};

/// The middle of the bundled mountain. Exact horizons err by a march's slopes, as in `sky_shade`; here sum and normal
/// are in f64, so its bound is more than enough. The comparison fails with half as many azimuths.
#[test]
fn sky_view_of_bundled_terrain_is_the_oracles() {
    const SIDE: usize = 96;
    const AZIMUTHS: u32 = 16;
    let mut gpu = Device::new();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/mt_washington_256.png");
    let whole = files::read_heights(&path, &HeightOptions::default()).expect("the bundled field");
    let at = |r: usize, c: usize| f64::from(whole.heights_m()[(80 + r) * 256 + 80 + c]);
    let ground = field(SIDE, SIDE, [66.0, 92.6], at);
    let quality = Quality { azimuths: AZIMUTHS, method: Method::BruteForce, ..Quality::default() };
    let horizons = gpu.horizons(&ground, Border::Plane, &quality);
    let normals = normals(&ground, Border::Plane);
    let view = |every: usize| {
        let mut sums = HorizonSums::new(Box::new(SkyView), SIDE * SIDE);
        let width_rad = TAU / f64::from(AZIMUTHS) * every as f64;
        let azimuths = horizons.chunks_exact(SIDE * SIDE).step_by(every).enumerate();
        for (k, elevations) in azimuths {
            sums.add(Ray { azimuth_rad: width_rad * k as f64, width_rad }, elevations, &normals)
                .expect("memory");
        }
        sums.end(&normals).expect("memory").remove(0)
    };
    let (oracle, mut next) = (Oracle::new(&ground, Border::Plane), random(11));
    let picks: Vec<usize> = (0..300).map(|_| (next() * (SIDE * SIDE) as f64) as usize).collect();
    let worst = |view: &[f32]| {
        let off = |i: &usize| {
            let ground_truth = light::sky_of(&oracle, i / SIDE, i % SIDE, AZIMUTHS as usize);
            (f64::from(view[*i]) - ground_truth).abs()
        };
        picks.iter().map(off).fold(0.0, f64::max)
    };
    let heights = || ground.heights_m().iter().map(|h| f64::from(*h));
    let relief = heights().fold(f64::MIN, f64::max) - heights().fold(f64::MAX, f64::min);
    let slope = device_march_slope(relief, 66.0);
    let bound = ShadeError::new(slope, relief, 66.0, AZIMUTHS as usize).sky();
    let (all, half) = (worst(&view(1)), worst(&view(2)));
    println!("{all:.2e} of {bound:.2e}; half as many azimuths {half:.2e}");
    assert!(all <= bound, "{all} {bound}");
    assert!(half > 3.0 * bound, "cannot fail: {half} {bound}");
}

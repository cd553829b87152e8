//! Figure 9 of Heidrich et al. 2000: a strip bent across its grooves, as geometry and by its BRDF, without and with
//! scattered light.

use std::path::Path;

use glam::DVec3;
use ridgelight::Result;
use ridgelight::gpu::Headless;

use super::brdf::{ANGLES, Aggregate, SCATTER, groove};
use super::geometry::{Geometry, sun};
use crate::common::panels;

/// Patches, and pixels along the edge of each.
const PATCHES: usize = 16;
const PIXELS: usize = 48;
/// Of the first and the last patch's normal, from the middle's.
const BENT_DEG: f64 = 60.0;

/// Rows of the picture from above: geometry, its mean, and the BRDF's, of direct light; the same of all. Light comes from
/// the upper left, the view from the middle's normal; where either would lie below a patch's horizon it is black.
pub fn picture(gpu: &mut Headless, path: &Path) -> Result<()> {
    let scene = groove()?;
    let aggregate = Aggregate::of(gpu, &scene, 1)?;
    let width = PATCHES * PIXELS;
    let mut rows = vec![vec![vec![[0.0_f32; 3]; width * PIXELS]]; 6];
    let (light, view) = (DVec3::new(-0.5, 0.3, 0.8).normalize(), DVec3::Z);
    for is_scattered in [false, true] {
        let (table, _) = aggregate.table(gpu, is_scattered)?;
        let (first, bounces) = if is_scattered { (3, SCATTER.bounces) } else { (0, 0) };
        for patch in 0..PATCHES {
            let bent = (2.0 * (patch as f64 + 0.5) / PATCHES as f64 - 1.0) * BENT_DEG.to_radians();
            // Into the frame of a patch whose normal is turned by so much towards the east.
            let into = |e: DVec3| {
                let (sin, cos) = bent.sin_cos();
                DVec3::new(cos * e.x - sin * e.z, e.y, sin * e.x + cos * e.z)
            };
            let (l, v) = (into(light), into(view));
            if l.z <= 0.0 {
                continue;
            }
            let geometry = Geometry::of(gpu, (&scene, aggregate.geometry), &[v], sun(l), bounces)?;
            let drawn = geometry.look(gpu, v).and_then(|d| Ok((d, geometry.mean(gpu, v)?)));
            geometry.end(gpu);
            let ((picture, places), mean) = drawn?;
            let mut place = |row: usize, y: usize, x: usize, colour: [f32; 3]| {
                rows[first + row][0][y * width + patch * PIXELS + x] = colour;
            };
            for (colour, at) in picture.radiance.iter().zip(places) {
                let Some([x, y]) = at else { continue };
                let pixel = |p: f64| ((p * PIXELS as f64) as usize).min(PIXELS - 1);
                place(0, PIXELS - 1 - pixel(y), pixel(x), *colour);
            }
            let of_table = table.between(&ANGLES, l, v).map(|f| (f * l.z) as f32);
            for i in 0..PIXELS * PIXELS {
                place(1, i / PIXELS, i % PIXELS, mean.map(|m| m as f32));
                place(2, i / PIXELS, i % PIXELS, of_table);
            }
        }
    }
    panels::write(path, &rows, width, 1, 4.0)
}

//! The paper's figure 9: a strip bent across its grooves, as geometry and by its BRDF, without and with scattered light.

use std::path::Path;

use glam::DVec3;
use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::scene::Tone;
use ridgelight_io as files;

use crate::brdf::{ANGLES, SCATTER, Seen, groove};
use crate::geometry::{Geometry, sun};

/// Patches, pixels of each, and white between rows.
const PATCHES: usize = 16;
const PIXELS: usize = 48;
const GAP: usize = 6;
/// Of the first and the last patch's normal, from the middle's.
const BENT_DEG: f64 = 60.0;

/// Rows of the picture from above: geometry, its mean, and the BRDF's, of direct light; the same of all. Light comes from the
/// upper left, the view from the middle's normal; where either would lie below a patch's horizon it is black.
pub fn picture(gpu: &mut Headless, path: &Path) -> Result<()> {
    let scene = groove()?;
    let seen = Seen::of(gpu, &scene, 1)?;
    let (width, row) = (PATCHES * PIXELS, PIXELS + GAP);
    let height = 6 * row - GAP;
    let mut texels = vec![[1.0_f32; 3]; width * height];
    let mut place = |patch: usize, row_number: usize, tile: &[[f32; 3]]| {
        for (i, colour) in tile.iter().enumerate() {
            let (y, x) = (row_number * row + i / PIXELS, patch * PIXELS + i % PIXELS);
            texels[y * width + x] = *colour;
        }
    };
    let (light, view) = (DVec3::new(-0.5, 0.3, 0.8).normalize(), DVec3::Z);
    for is_scattered in [false, true] {
        let (table, _) = seen.table(gpu, is_scattered)?;
        let first = if is_scattered { 3 } else { 0 };
        let bounces = if is_scattered { SCATTER.bounces } else { 0 };
        for patch in 0..PATCHES {
            let bent = (2.0 * (patch as f64 + 0.5) / PATCHES as f64 - 1.0) * BENT_DEG.to_radians();
            // Into the frame of a patch whose normal is turned by so much towards the east.
            let into = |e: DVec3| {
                let (sin, cos) = bent.sin_cos();
                DVec3::new(cos * e.x - sin * e.z, e.y, sin * e.x + cos * e.z)
            };
            let (l, v) = (into(light), into(view));
            let mut tiles = vec![vec![[0.0_f32; 3]; PIXELS * PIXELS]; 3];
            if l.z > 0.0 {
                let geometry = Geometry::of(gpu, (&scene, seen.geometry), &[v], sun(l), bounces)?;
                let drawn = geometry.look(gpu, v).and_then(|d| Ok((d, geometry.mean(gpu, v)?)));
                geometry.end(gpu);
                let ((picture, places), mean) = drawn?;
                for (colour, at) in picture.radiance.iter().zip(places) {
                    let Some([x, y]) = at else { continue };
                    let pixel = |p: f64| ((p * PIXELS as f64) as usize).min(PIXELS - 1);
                    tiles[0][(PIXELS - 1 - pixel(y)) * PIXELS + pixel(x)] = *colour;
                }
                let of_table = table.between(&ANGLES, l, v).map(|f| (f * l.z) as f32);
                tiles[1].fill(mean.map(|m| m as f32));
                tiles[2].fill(of_table);
            }
            for (k, tile) in tiles.iter().enumerate() {
                place(patch, first + k, tile);
            }
        }
    }
    let tone = Tone { exposure: 4.0 };
    files::write_png(path, height, width, &texels, None, tone, &[])
}

//! The command that `info` recommends: one that the present device can run.

use ridgelight::plan::{self, Limits, Picture};
use ridgelight::scene::{Albedo, HeightField, Lights, Quality, Scene, Surface};
use ridgelight::{Error, Result};
use ridgelight_io::Georeference;

use crate::setup;
use crate::setup::lights::light;

/// How a device can render a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    Whole,
    /// With this memory budget, GiB.
    Budget(u64),
    /// A box in its middle: west, south, east and north.
    Part([f64; 4]),
    /// Neither whole nor, for want of a position, by a box.
    Nothing,
}

const GIB: u64 = 1 << 30;
/// Budgets that are tried, each 1 GiB above the one before. A plan needs more than it needs without limits, where the device
/// limits its buffers.
const TRIES: u64 = 16;

/// How to start, and why the field cannot be rendered as it is. `is_given`: the user has chosen the memory budget.
pub fn start(
    field: &HeightField,
    at: Option<&Georeference>,
    limits: &Limits,
    is_given: bool,
) -> (Start, Option<Error>) {
    let whole = match scene(field) {
        Ok(scene) => scene,
        Err(why) => return (Start::Nothing, Some(why)),
    };
    let Err(why) = bytes(&whole, 0, limits) else { return (Start::Whole, None) };
    // The budget of a software driver is no memory that exists, that of a GPU half of what exists.
    let most = match limits {
        _ if is_given => 0,
        Limits { is_cpu: true, .. } => u64::MAX,
        Limits { memory_budget, .. } => memory_budget.saturating_mul(2),
    };
    // None where no device can hold the field.
    let least = bytes(&whole, 0, &Limits::boundless(limits.is_cpu, 1 << 50)).ok();
    let first = least.map(|least| least.max(limits.memory_budget).div_ceil(GIB));
    let all = first.into_iter().flat_map(|first| first..first + TRIES);
    let fits =
        |gib: &u64| bytes(&whole, 0, &Limits { memory_budget: gib * GIB, ..*limits }).is_ok();
    if let Some(gib) = all.take_while(|gib| gib * GIB <= most).find(fits) {
        return (Start::Budget(gib), Some(why));
    }
    let part = at.and_then(|at| {
        let all = (1..usize::BITS).map_while(|halvings| middle(field, halvings));
        let fits = |(part, _): &(HeightField, [usize; 2])| bytes_of(part, 0, limits).is_ok();
        let (part, [top, left]) = all.into_iter().find(fits)?;
        let [west, north] =
            [at.corner[0] + left as f64 * at.cell[0], at.corner[1] - top as f64 * at.cell[1]];
        let [width, height] = [part.cols() as f64 * at.cell[0], part.rows() as f64 * at.cell[1]];
        Some(Start::Part([west, north - height, west + width, north]))
    });
    (part.unwrap_or(Start::Nothing), Some(why))
}

/// The middle of a field after some halvings of its sides, and its first row and column.
fn middle(field: &HeightField, halvings: u32) -> Option<(HeightField, [usize; 2])> {
    let size = [field.rows(), field.cols()].map(|side| side >> halvings);
    let [rows, cols] = size;
    let [top, left] = [(field.rows() - rows) / 2, (field.cols() - cols) / 2];
    let row = |row: usize| &field.heights_m()[row * field.cols() + left..][..cols];
    let heights: Vec<f64> = (top..top + rows).flat_map(row).map(|h| f64::from(*h)).collect();
    let part = HeightField::new(rows, cols, &heights, field.cell_m(), None).ok()?;
    Some((part, [top, left]))
}

/// Memory of `render -o picture.png` with its default light, tint and settings, with this number of bounces.
pub fn bytes_of(field: &HeightField, bounces: u32, limits: &Limits) -> Result<u64> {
    bytes(&scene(field)?, bounces, limits)
}

fn scene(field: &HeightField) -> Result<Scene> {
    let mut lights = Lights::default();
    let sun = setup::sky::default_sun(None);
    light("sun").add(&mut lights, &sun).expect("words of a sun");
    lights.environment = Some(setup::sky::clear(&lights.suns[0])?);
    // Any colours: those of a tint take as much memory.
    let albedo = Albedo::Map(vec![[0.1, 0.2, 0.3]; field.rows() * field.cols()]);
    let surface = Surface { albedo, ..Surface::default() };
    Ok(Scene { field: field.clone(), surface, lights })
}

fn bytes(scene: &Scene, bounces: u32, limits: &Limits) -> Result<u64> {
    let wanted = Picture { still: true, ..Picture::default() };
    let mut quality = Quality::default();
    quality.bounces.count = bounces;
    Ok(plan::picture(scene, &quality, limits, wanted)?.bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight_io::GeoKeys;

    #[test]
    fn a_field_starts_whole_then_with_memory_then_in_part() {
        let field = HeightField::new(96, 200, &[5.0; 96 * 200], [10.0; 2], None).unwrap();
        let at = Georeference { corner: [500.0, 960.0], cell: [10.0; 2], keys: GeoKeys::default() };
        let device = Limits::lavapipe();
        let started = |limits: &Limits, is_given| start(&field, Some(&at), limits, is_given);
        assert!(matches!(started(&device, false), (Start::Whole, None)));
        let poor = Limits { memory_budget: bytes_of(&field, 0, &device).unwrap() - 1, ..device };
        assert!(matches!(started(&poor, false), (Start::Budget(1), Some(_))));
        // Half of 200 columns and of 96 rows, a quarter from each edge.
        let middle = [1000.0, 240.0, 2000.0, 720.0];
        assert_eq!(started(&poor, true).0, Start::Part(middle));
        // A GPU with less than 1 GiB.
        assert_eq!(started(&Limits { is_cpu: false, ..poor }, false).0, Start::Part(middle));
        let small = Limits { image_side: 1024, ..device };
        let field = HeightField::new(720, 1500, &[5.0; 720 * 1500], [10.0; 2], None).unwrap();
        let part = start(&field, Some(&at), &small, false).0;
        assert_eq!(part, Start::Part([4250.0, -4440.0, 11750.0, -840.0]));
        assert_eq!(start(&field, None, &small, false).0, Start::Nothing);
    }
}

//! A scene on a coarser grid, for pictures that answer input at once.

use glam::DVec3;
use ridgelight::Result;
use ridgelight::plan::{Map, Rectangle};
use ridgelight::scene::{
    Albedo, Border, Camera, HeightField, PhongSpecular, Scene, Specular, Surface, normal,
};

use super::opening::joined;

/// The means of blocks of grid points.
#[derive(Clone, Copy)]
pub struct Blocks {
    /// Columns and rows of the full grid.
    field: [usize; 2],
    /// Grid points along a side of a block.
    pub side: usize,
}

impl Blocks {
    pub fn of(field: &HeightField, side: usize) -> Self {
        Self { field: [field.cols(), field.rows()], side }
    }

    /// Columns and rows of the coarser grid.
    fn size(&self) -> [usize; 2] {
        self.field.map(|n| n.div_ceil(self.side))
    }

    /// Positions of a block's grid points.
    fn within(&self, block: usize) -> impl Iterator<Item = usize> + use<> {
        let Self { field: [cols, rows], side } = *self;
        let [col, row] = [block % cols.div_ceil(side), block / cols.div_ceil(side)];
        let (cols_in, rows_in) =
            (col * side..((col + 1) * side).min(cols), row * side..((row + 1) * side).min(rows));
        rows_in.flat_map(move |r| cols_in.clone().map(move |c| r * cols + c))
    }

    /// The mean of some values over each block.
    pub fn means<const N: usize>(&self, value: impl Fn(usize) -> [f64; N] + Sync) -> Vec<[f64; N]> {
        let [cols, rows] = self.size();
        let mean = |block: usize| {
            let mut count = 0.0_f64;
            let sum = self.within(block).fold([0.0; N], |sum, i| {
                count += 1.0;
                let next = value(i);
                std::array::from_fn(|k| sum[k] + next[k])
            });
            sum.map(|s| s / count)
        };
        by_cores(cols * rows, mean)
    }

    /// The field on the coarser grid; a block of voids alone is one.
    pub fn field(&self, field: &HeightField) -> Result<HeightField> {
        let is_ground = |i: usize| field.voids().is_none_or(|voids| !voids[i]);
        let sums = self.means(|i| {
            let share = f64::from(u8::from(is_ground(i)));
            [share * f64::from(field.heights_m()[i]), share]
        });
        let heights: Vec<f64> = sums
            .iter()
            .map(|[sum, share]| field.base_m() + if *share > 0.0 { sum / share } else { 0.0 })
            .collect();
        let voids = field.voids().map(|_| sums.iter().map(|[_, share]| *share == 0.0).collect());
        let [cols, rows] = self.size();
        let cell_m = field.cell_m().map(|cell| cell * self.side as f64);
        HeightField::new(rows, cols, &heights, cell_m, voids)
    }

    /// The blocks that a rectangle of the full field touches.
    pub fn within_blocks(&self, at: Rectangle) -> Rectangle {
        let side = self.side as u32;
        let along = |first: u32, count: u32| {
            let begin = first / side;
            (begin, (first + count).div_ceil(side) - begin)
        };
        let ((col, cols), (row, rows)) = (along(at.col, at.cols), along(at.row, at.rows));
        Rectangle { col, row, cols, rows }
    }

    /// Takes edited heights of a rectangle of the full field.
    pub fn edit(&self, field: &HeightField, coarse: &mut HeightField, at: Rectangle) -> Result<()> {
        let Rectangle { col, row, cols, rows } = self.within_blocks(at);
        let [col, row, cols, rows] = [col, row, cols, rows].map(|n| n as usize);
        let mean = |block: usize| {
            let ground = |i: &usize| field.voids().is_none_or(|voids| !voids[*i]);
            let (sum, count) = self
                .within(block)
                .filter(ground)
                .fold((0.0, 0.0), |(sum, n), i| (sum + f64::from(field.heights_m()[i]), n + 1.0));
            (count > 0.0).then(|| (sum / count + field.base_m() - coarse.base_m()) as f32)
        };
        let [all, _] = self.size();
        let blocks = (row..row + rows).flat_map(|r| (col..col + cols).map(move |c| r * all + c));
        let heights: Vec<f32> =
            blocks.map(|block| mean(block).unwrap_or(coarse.heights_m()[block])).collect();
        coarse.replace([row, col], cols, &heights)
    }

    /// The mean unit normal of each block, as texels of four channels. Rough ground that is darker than its mean slope
    /// has a mean normal shorter than 1.
    pub fn normals(&self, field: &HeightField, border: Border) -> Vec<f32> {
        let [cols, rows] = self.size();
        by_cores(cols * rows, |block| self.normal(field, border, block)).concat()
    }

    /// Takes the normals of an edited rectangle of the full field, which reach one grid point beyond it.
    pub fn edit_normals(
        &self,
        (field, border): (&HeightField, Border),
        normals: &mut [f32],
        at: Rectangle,
    ) {
        let [all, rows] = self.size();
        let blocks = |first: u32, count: u32, most: usize| {
            let (begin, end) = (first.saturating_sub(1) as usize, (first + count + 1) as usize);
            begin / self.side..end.div_ceil(self.side).min(most)
        };
        for row in blocks(at.row, at.rows, rows) {
            for block in blocks(at.col, at.cols, all).map(|col| row * all + col) {
                let texel = self.normal(field, border, block);
                normals[4 * block..4 * block + 4].copy_from_slice(&texel);
            }
        }
    }

    fn normal(&self, field: &HeightField, border: Border, block: usize) -> [f32; 4] {
        let cols = field.cols();
        let mut count = 0.0;
        let sum = self.within(block).fold(DVec3::ZERO, |sum, i| {
            count += 1.0;
            sum + normal(field, border, i / cols, i % cols)
        });
        let [x, y, z] = (sum / count).to_array();
        [x as f32, y as f32, z as f32, 0.0]
    }

    fn surface(&self, surface: &Surface) -> Surface {
        let albedo = match &surface.albedo {
            Albedo::Map(map) => {
                let means = self.means(|i| map[i].map(f64::from));
                Albedo::Map(means.iter().map(|mean| mean.map(|c| c as f32)).collect())
            }
            constant @ Albedo::Constant(_) => constant.clone(),
        };
        let specular = surface.specular.as_ref().map(|specular| match specular {
            Specular::Map(map) => {
                let means = self.means(|i| [map[i].exponent, map[i].scale].map(f64::from));
                let specular = |[exponent, scale]: &[f64; 2]| PhongSpecular {
                    exponent: *exponent as f32,
                    scale: *scale as f32,
                };
                Specular::Map(means.iter().map(specular).collect())
            }
            constant @ Specular::Constant(_) => constant.clone(),
        });
        Surface { albedo, specular, ..surface.clone() }
    }

    /// The scene on the coarser grid.
    pub fn scene(&self, scene: &Scene) -> Result<Scene> {
        let mut smaller = Scene {
            field: self.field(&scene.field)?,
            surface: self.surface(&scene.surface),
            lights: scene.lights.clone(),
        };
        self.take_lights(scene, &mut smaller);
        Ok(smaller)
    }

    /// Gives a coarser scene the lights of the full one, at their places.
    pub fn take_lights(&self, scene: &Scene, smaller: &mut Scene) {
        smaller.lights = scene.lights.moved(self.origin_m(&scene.field).map(|v| -v));
    }

    /// The same camera over the coarser grid.
    pub fn camera(&self, field: &HeightField, camera: &Camera) -> Camera {
        let [x, y] = self.origin_m(field);
        let mut camera = *camera;
        camera.target_m[0] -= x;
        camera.target_m[1] -= y;
        camera
    }

    /// The same part of a map of the coarser field.
    pub fn map(&self, full: &Map, coarse: &HeightField) -> Map {
        let side = self.side as f32;
        Map {
            field: [coarse.cols(), coarse.rows()].map(|n| n as u32),
            has_voids: coarse.voids().is_some(),
            corner: full.corner.map(|c| c / side),
            grid_points_per_pixel: (full.grid_points_per_pixel / side).max(1e-3),
            is_smooth: true,
            ..*full
        }
    }

    /// Position of the coarser grid's origin in the full one: the centre of its south-western block, as if the field's edge
    /// did not cut the block.
    fn origin_m(&self, field: &HeightField) -> [f64; 2] {
        let [cell_x, cell_y] = field.cell_m();
        let (side, [_, rows]) = (self.side as f64, self.size());
        let to_centre = (side - 1.0) / 2.0;
        let last_row = (rows - 1) as f64 * side + to_centre;
        [to_centre * cell_x, ((field.rows() - 1) as f64 - last_row) * cell_y]
    }
}

/// The value of each block, computed on all cores of the host.
fn by_cores<T: Send>(blocks: usize, of: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let part = blocks.div_ceil(cores).max(1);
    let of = &of;
    std::thread::scope(|scope| {
        let begin = |first: usize| {
            let part = first..blocks.min(first + part);
            scope.spawn(move || part.map(of).collect::<Vec<T>>())
        };
        let begun: Vec<_> = (0..blocks).step_by(part).map(begin).collect();
        begun.into_iter().flat_map(|thread| joined(thread.join())).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::{Lights, SphereLight};

    /// A plane stays one: each block has the height of its centre, also where the grid is cut, whose centre is that of
    /// fewer grid points. Heights are stored as 24 bits over at most 100 m.
    #[test]
    fn a_plane_stays_a_plane() {
        let height = |col: f64, row: f64| 30.0 + 2.0 * col - 3.0 * row;
        let (cols, rows, side) = (11, 8, 3);
        let heights: Vec<f64> =
            (0..cols * rows).map(|i| height((i % cols) as f64, (i / cols) as f64)).collect();
        let field = HeightField::new(rows, cols, &heights, [5.0, 7.0], None).unwrap();
        let blocks = Blocks::of(&field, side);
        let coarse = blocks.field(&field).unwrap();
        assert_eq!((coarse.cols(), coarse.rows(), coarse.cell_m()), (4, 3, [15.0, 21.0]));
        let centre = |n: usize, all: usize| {
            let (first, last) = (n * side, ((n + 1) * side).min(all) - 1);
            (first + last) as f64 / 2.0
        };
        for (i, found) in coarse.heights_m().iter().enumerate() {
            let want = height(centre(i % 4, cols), centre(i / 4, rows));
            let found = f64::from(*found) + coarse.base_m();
            assert!((found - want).abs() < 100.0 * f64::from(f32::EPSILON), "{i}: {found}, {want}");
        }
    }

    /// An edited rectangle gives the heights that the whole edited field gives, to its stored bits.
    #[test]
    fn edits_reach_their_blocks() {
        let mut heights: Vec<f64> = (0..9 * 10).map(|i| f64::from(i % 7)).collect();
        let field = HeightField::new(9, 10, &heights, [1.0; 2], None).unwrap();
        let blocks = Blocks::of(&field, 4);
        let mut coarse = blocks.field(&field).unwrap();
        let before = coarse.clone();
        for (row, col) in [(3, 4), (3, 5), (4, 4), (4, 5), (5, 4), (5, 5)] {
            heights[row * 10 + col] += 2.0;
        }
        let edited = HeightField::new(9, 10, &heights, [1.0; 2], None).unwrap();
        let at = Rectangle { col: 4, row: 3, cols: 2, rows: 3 };
        blocks.edit(&edited, &mut coarse, at).unwrap();
        let want = blocks.field(&edited).unwrap();
        let apart = |a: &HeightField, b: &HeightField| {
            let of = |f: &HeightField, i: usize| f64::from(f.heights_m()[i]) + f.base_m();
            (0..9).map(|i| (of(a, i) - of(b, i)).abs()).fold(0.0, f64::max)
        };
        assert!(apart(&coarse, &want) < 16.0 * f64::from(f32::EPSILON));
        assert!(apart(&before, &want) > 0.2);
    }

    /// Of a plane every block has the plane's normal; of a gable whose sides cancel, its upward part; and an edit gives
    /// what the whole edited field gives.
    #[test]
    fn normals_are_means_of_blocks() {
        let of = |height: &dyn Fn(usize) -> f64| {
            let heights: Vec<f64> = (0..48).map(height).collect();
            HeightField::new(6, 8, &heights, [1.0; 2], None).unwrap()
        };
        let is_near = |got: &[f32], want: [f64; 3]| {
            got.iter().zip(want).all(|(g, w)| (f64::from(*g) - w).abs() < 1e-6)
        };
        let plane = of(&|i| 0.75 * (i % 8) as f64);
        let blocks = Blocks::of(&plane, 2);
        let texels = blocks.normals(&plane, Border::Plane);
        // The columns at the edge have one-sided or level slopes by the border.
        assert!(is_near(&texels[4..7], [-0.6, 0.0, 0.8]), "{texels:?}");
        // Slopes of 1 up and down meet between columns 3 and 4, where a grid point's own slope is half of that.
        let gable = of(&|i| 3.5 - ((i % 8) as f64 - 3.5).abs());
        let whole = Blocks::of(&gable, 6);
        let mean = whole.normals(&gable, Border::Plane);
        assert!(mean[2] < 0.95 && mean[2] > 0.5_f32.sqrt(), "{mean:?}");
        let mut edited = plane.clone();
        let at = Rectangle { col: 3, row: 2, cols: 2, rows: 1 };
        edited.replace([2, 3], 2, &[2.0, -1.0]).unwrap();
        let mut found = texels.clone();
        blocks.edit_normals((&edited, Border::Plane), &mut found, at);
        assert!(found == blocks.normals(&edited, Border::Plane) && found != texels);
    }

    #[test]
    fn blocks_of_voids_are_voids_and_others_are_their_ground() {
        let heights = [4.0, 4.0, 9.0, 1.0, 4.0, 4.0, 1.0, 1.0];
        let voids = [true, true, true, false, true, true, false, false];
        let field = HeightField::new(2, 4, &heights, [1.0; 2], Some(voids.to_vec())).unwrap();
        let coarse = Blocks::of(&field, 2).field(&field).unwrap();
        assert_eq!(coarse.voids(), Some(&[true, false][..]));
        assert_eq!(f64::from(coarse.heights_m()[1]) + coarse.base_m(), 1.0);
    }

    /// A light over the centre of a block is over its grid point of the coarser field.
    #[test]
    fn lights_keep_their_places() {
        let field = HeightField::new(7, 9, &[0.0; 63], [2.0, 5.0], None).unwrap();
        // The middle of columns 3 to 5 and of rows 0 to 2, 6 rows above the southernmost.
        let position_m = [4.0 * 2.0, 5.0 * 5.0, 3.0];
        let light = SphereLight { position_m, radius_m: 1.0, radiance: [1.0; 3] };
        let lights = Lights { sphere_lights: vec![light], ..Lights::default() };
        let scene = Scene { field, surface: Surface::default(), lights };
        let coarse = Blocks::of(&scene.field, 3).scene(&scene).unwrap();
        // Column 1, row 0 of 3 × 3, north first: cells of 6 m by 15 m.
        assert_eq!(coarse.lights.sphere_lights[0].position_m, [6.0, 30.0, 3.0]);
    }
}

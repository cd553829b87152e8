//! A height field as flat triangles, and the visibility of each triangle from a set of directions.
//!
//! In the far field a periodic height field is a plane. A light of irradiance 1 facing it, from l,
//! gives the plane l_z; from v, each part of the plane's area A fills A v_z of the view. An
//! area dx of the plan has the area dx / n_z on the slope. It fills (n·v)⁺ dx / n_z of the view
//! where V(x, v) = 1, that is where nothing occludes it from v. Every view ray hits the surface, so
//! ∫ V (n·v)⁺ / n_z dx = A v_z. The radiance of a view is the mean over the visible surface,
//!
//! > L(v) = ∫ L(x, v) V(x, v) (n·v)⁺ / n_z dx / (A v_z),   f(l, v) = L(v) / l_z.
//!
//! For a diffuse surface without indirect light L(x) = ρ/π V(x, l) (n·l)⁺, so
//!
//! > f(l, v) = 1/(A l_z v_z) ∫ ρ/π V(x, l) V(x, v) (n·l)⁺ (n·v)⁺ / n_z dx.
//!
//! f is reciprocal, and ∫ f v_z dv ≤ ρ, as ∫ (n·v)⁺ dv = π and ∫ V (n·l)⁺ / n_z dx = A l_z.
//!
//! [Phong specular](ridgelight::scene::PhongSpecular) of scale s and exponent k adds L(x, v) = s
//! p(l, v) V(x, l) where n·l > 0, with p = (k + 1)/2π (r·l)⁺ᵏ about the mirror direction r of v. It
//! has no cosine, so level ground has the closed form
//!
//! > f(l, v) = ρ/π + s p(l, v) / l_z.
//!
//! p is reciprocal, but s p / (n·l), the reflected share of the irradiance, is not: **f is not
//! reciprocal with Phong specular**. Nor does the irradiance bound it: at grazing angles more may
//! leave than arrives. The view bounds it: ∫ p dl ≤ 1, so under light of 1 from all sides ∫ f l_z
//! dl ≤ ρ + s for every view. [`Brdf`](super::Brdf) measures both departures, provided that its
//! directions are as dense as Phong lobes are wide: otherwise a sum does not approximate these
//! integrals.
//!
//! x runs over flat triangles, whose slopes are exact. Each is visible or occluded as a whole, by a
//! ray from its centroid. A triangle that a visibility edge crosses has an error of up to its
//! share, and the sum S(v) of all shares differs from v_z. Shares are therefore scaled by v_z /
//! S(v): a light gives the triangles the plane's irradiance l_z, and they fill v_z of a view. The
//! diffuse part stays exactly reciprocal; its reflected share is at most ρ times a triangle's sum
//! of cosines over the set of directions. The specular part is scaled by the light's factor, so a
//! view receives up to l_z / S(l) times s. [`Facets::closure`] is S(v) / v_z; finer triangles bring
//! it to 1.

mod grid_points;

use std::f64::consts::{PI, TAU};

use ridgelight::plan::DIRECTIONS_A_WORD;
use ridgelight::scene::{Albedo, Border, Directions, LOST_RAY, PhongSpecular, Scene};
use ridgelight::{Error, Result};
use ridgelight_cpu::facet_mask::cells;

/// A ray of this word exceeded the step limit.
const LOST: u32 = 1 << 31;

/// The triangles of a refined field, and their visibility from a set of directions.
#[derive(Clone, Debug)]
pub struct Facets {
    directions: Directions,
    times: usize,
    /// Columns and rows: of the field, and of the refined field's cells.
    size: [usize; 2],
    cells: [usize; 2],
    /// Slopes towards east and north, rise over run.
    slopes: Vec<[f64; 2]>,
    albedo: Vec<[f64; 3]>,
    /// Phong exponents and scales, where the surface has any.
    specular: Option<Vec<[f64; 2]>>,
    words: Vec<u32>,
    /// v_z / S(v) of each direction, infinite of those that show no front of a triangle; else of a field that ends 1.
    scales: Vec<f64>,
    repeats: bool,
}

/// Exit radiance of all triangles under one light, R, G, B.
#[derive(Clone, Debug, PartialEq)]
pub struct ExitRadiance {
    /// Diffuse: each triangle, the same towards all views.
    alike: Vec<[f64; 3]>,
    /// Index of the light direction for Phong specular, of irradiance 1 facing it.
    mirrored: Option<usize>,
    /// Indirect light of grid points towards each direction from this index on, where it depends on
    /// the view.
    towards: Option<(usize, Vec<Vec<[f32; 3]>>)>,
}

impl From<Vec<[f64; 3]>> for ExitRadiance {
    /// Diffuse radiance of each triangle.
    fn from(alike: Vec<[f64; 3]>) -> Self {
        Self { alike, mirrored: None, towards: None }
    }
}

impl ExitRadiance {
    /// Each triangle's radiance, the same towards all views.
    pub fn alike(&self) -> &[[f64; 3]] {
        &self.alike
    }

    /// Adds indirect light of grid points towards directions from index `first` on, linearly
    /// interpolated. No other view may then be evaluated.
    #[must_use]
    pub fn scattering(self, first: usize, towards: Vec<Vec<[f32; 3]>>) -> Self {
        Self { towards: Some((first, towards)), ..self }
    }
}

impl Facets {
    /// From a scene, whose lights are ignored, and the words of
    /// [`plan::facet_mask`](ridgelight::plan::facet_mask) for its field `times`
    /// [`finer`](ridgelight::scene::HeightField::finer).
    ///
    /// # Errors
    /// A direction at or below horizontal; another count than one word per cell and fifteen
    /// directions; a ray that the device lost.
    pub fn of(
        scene: &Scene,
        times: usize,
        directions: Directions,
        words: Vec<u32>,
    ) -> Result<Self> {
        if let Some(i) = directions.vectors().iter().position(|v| v.z <= 0.0) {
            let found = format!("{}", directions.vectors()[i]);
            return Err(Error::setting(
                format!("direction {i}"),
                found,
                "a direction above horizontal",
            ));
        }
        let finer = scene.finer(times)?;
        let (field, border) = (&finer.field, scene.surface.border);
        let cells = cells(field, border);
        let count = cells[0] * cells[1];
        let wanted = directions.count().div_ceil(DIRECTIONS_A_WORD) * count;
        if words.len() != wanted {
            let found = format!("{} words", words.len());
            return Err(Error::setting("visible triangles", found, format!("{wanted} words")));
        }
        if let Some(i) = words.iter().position(|word| word & LOST != 0) {
            let doing = format!("visible triangles: word {i}");
            return Err(Error::Device { doing, reason: LOST_RAY.to_owned() });
        }
        let [cell_x, cell_y] = field.cell_m();
        let surface = finer.surface.specular.as_ref().filter(|phong| phong.largest().scale > 0.0);
        let mut specular = surface.map(|_| Vec::with_capacity(2 * count));
        let (mut slopes, mut albedo) = (Vec::with_capacity(2 * count), Vec::new());
        for facet in 0..2 * count {
            let corners = corners_of(facet, cells[0], [field.cols(), field.rows()]);
            let [first, other, last] = corners.map(|i| f64::from(field.heights_m()[i]));
            slopes.push(match facet % 2 {
                0 => [(other - first) / cell_x, (other - last) / cell_y],
                _ => [(last - other) / cell_x, (first - other) / cell_y],
            });
            albedo.push(match &finer.surface.albedo {
                Albedo::Constant(colour) => colour.map(f64::from),
                Albedo::Map(map) => [0, 1, 2]
                    .map(|c| corners.iter().map(|i| f64::from(map[*i][c])).sum::<f64>() / 3.0),
            });
            if let (Some(all), Some(surface)) = (&mut specular, surface) {
                let of_corners = corners.map(|i| surface.at(i));
                let mean = |of: fn(&PhongSpecular) -> f32| -> f64 {
                    of_corners.iter().map(|phong| f64::from(of(phong))).sum::<f64>() / 3.0
                };
                all.push([mean(|phong| phong.exponent), mean(|phong| phong.scale)]);
            }
        }
        let size = [scene.field.cols(), scene.field.rows()];
        let (scales, repeats) = (Vec::new(), border == Border::Periodic);
        let mut all = Self {
            directions,
            times,
            size,
            cells,
            slopes,
            albedo,
            specular,
            words,
            scales,
            repeats,
        };
        let sums = all.of_all(|direction| all.shares(direction).map(|s| s.1).sum::<f64>());
        let facets = all.slopes.len() as f64;
        let heights = all.directions.vectors().iter().map(|v| v.z);
        let scale = |z: f64, sum: f64| if repeats || sum == 0.0 { z * facets / sum } else { 1.0 };
        all.scales = heights.zip(sums).map(|(z, sum)| scale(z, sum)).collect();
        Ok(all)
    }

    /// The directions of the visibility.
    pub fn directions(&self) -> &Directions {
        &self.directions
    }

    /// Number of triangles.
    pub fn count(&self) -> usize {
        self.slopes.len()
    }

    /// Refinement factor of the field.
    pub fn times(&self) -> usize {
        self.times
    }

    /// S(v) / v_z: the visible triangles' part of the view over the plane's. It differs from 1 by
    /// partly visible triangles, and is 0 where no front face is visible.
    pub fn closure(&self, direction: usize) -> f64 {
        1.0 / self.scales[direction]
    }

    /// Whether there is Phong specular, which makes radiance depend on the view.
    pub fn has_specular(&self) -> bool {
        self.specular.is_some()
    }

    /// The largest exponent of triangles with a scale above 0, and the largest scale with that
    /// exponent. A triangle has the mean of its corners.
    pub fn sharpest(&self) -> Option<PhongSpecular> {
        let mirrors = self.specular.iter().flatten().filter(|[_, scale]| *scale > 0.0);
        let sharpest = mirrors.max_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        sharpest.map(|[exponent, scale]| PhongSpecular {
            exponent: *exponent as f32,
            scale: *scale as f32,
        })
    }

    /// Whether any front face is visible from a direction.
    pub fn shows(&self, direction: usize) -> bool {
        self.scales[direction].is_finite()
    }

    /// Refuses a field without a far field.
    ///
    /// # Errors
    /// A field that does not repeat; a direction, by its index, from which no front face is visible
    /// (finer triangles may help).
    pub fn check(&self) -> Result<()> {
        if !self.repeats {
            let expected = "a periodic one: only repeating ground has a far field";
            return Err(Error::setting("border", "a field that ends", expected));
        }
        let Some(i) = self.scales.iter().position(|s| !s.is_finite()) else { return Ok(()) };
        let found = self.directions.vectors()[i].to_string();
        let expected = "one with a visible front face: refine the field, or raise the direction";
        Err(Error::setting(format!("direction {i}"), found, expected))
    }

    /// Whether a triangle is visible from a direction, and its part of the view over its own area
    /// of the plan, above 0. Back faces, which a bounded field may show, count for nothing.
    fn visible(&self, direction: usize) -> impl Fn(usize) -> Option<f64> {
        let e = self.directions.vectors()[direction];
        let cells = self.cells[0] * self.cells[1];
        let first = direction / DIRECTIONS_A_WORD * cells;
        let bit = 2 * (direction % DIRECTIONS_A_WORD);
        let words = &self.words[first..first + cells];
        move |facet| {
            let is_visible = words[facet / 2] >> (bit + facet % 2) & 1 == 1;
            let [east, north] = self.slopes[facet];
            let share = e.z - east * e.x - north * e.y;
            (is_visible && share > 0.0).then_some(share)
        }
    }

    /// The triangles visible from a direction, each with its [`visible`](Self::visible).
    fn shares(&self, direction: usize) -> impl Iterator<Item = (usize, f64)> {
        let visible = self.visible(direction);
        (0..self.slopes.len()).filter_map(move |facet| Some((facet, visible(facet)?)))
    }

    /// Area of a triangle over its area on the plan.
    fn area(&self, facet: usize) -> f64 {
        let [east, north] = self.slopes[facet];
        (1.0 + east * east + north * north).sqrt()
    }

    /// Exit radiance of all triangles by direct light of irradiance 1 facing direction `light`.
    pub fn lit_from(&self, light: usize) -> ExitRadiance {
        let mut alike = vec![[0.0; 3]; self.slopes.len()];
        for (facet, share) in self.shares(light) {
            let irradiance = self.scales[light] * share / self.area(facet);
            alike[facet] = self.albedo[facet].map(|albedo| albedo / PI * irradiance);
        }
        let mirrored = self.specular.is_some().then_some(light);
        ExitRadiance { alike, mirrored, towards: None }
    }

    /// Radiance of a triangle towards a direction from which it is visible and fills `share` of the
    /// view.
    fn towards(&self, (view, share): (usize, f64), facet: usize, light: &ExitRadiance) -> [f64; 3] {
        let mut sum = light.alike[facet];
        if let Some((first, towards)) = &light.towards {
            let points = &towards[view - first];
            for (point, part) in self.between(facet) {
                (0..3).for_each(|c| sum[c] += part * f64::from(points[point][c]));
            }
        }
        let (Some(specular), Some(from)) = (&self.specular, light.mirrored) else { return sum };
        let [exponent, scale] = specular[facet];
        let Some(lit) = self.visible(from)(facet) else { return sum };
        let [l, v] = [from, view].map(|i| self.directions.vectors()[i]);
        let [east, north] = self.slopes[facet];
        // r·l = 2 (n·v)(n·l) - v·l, and a share is the cosine times the area over the plan's, √(1 + slope²).
        let along = 2.0 * share * lit / (1.0 + east * east + north * north) - v.dot(l);
        if along > 0.0 {
            let density = (exponent + 1.0) / TAU * along.min(1.0).powf(exponent);
            sum = sum.map(|s| s + self.scales[from] * scale * density);
        }
        sum
    }

    /// Mean visible radiance from each direction.
    ///
    /// # Panics
    /// Indirect light that does not cover all directions: [`ExitRadiance::scattering`].
    pub fn radiance_from_all(&self, light: &ExitRadiance) -> Vec<[f64; 3]> {
        self.of_all(|view| self.radiance_from(view, light))
    }

    /// Mean visible radiance from direction `view`; 0 where nothing is visible.
    ///
    /// # Panics
    /// Indirect light that does not cover this view.
    pub fn radiance_from(&self, view: usize, light: &ExitRadiance) -> [f64; 3] {
        let (mut sum, mut whole) = ([0.0; 3], 0.0);
        for (facet, share) in self.shares(view) {
            let radiance = self.towards((view, share), facet, light);
            (0..3).for_each(|c| sum[c] += share * radiance[c]);
            whole += share;
        }
        if whole > 0.0 { sum.map(|s| s / whole) } else { sum }
    }

    /// Runs over all directions on all processors.
    fn of_all<T: Send>(&self, of: impl Fn(usize) -> T + Sync) -> Vec<T> {
        let mut all: Vec<Option<T>> = (0..self.directions.count()).map(|_| None).collect();
        crate::in_parts((&mut all, 1, 1), |first, part| {
            part.iter_mut().enumerate().for_each(|(i, one)| *one = Some(of(first + i)));
        });
        all.into_iter().flatten().collect()
    }
}

/// A triangle's grid points: the diagonal's north-western end, the corner beside it, the other end.
fn corners_of(facet: usize, cells_x: usize, [cols, rows]: [usize; 2]) -> [usize; 3] {
    let [row, col] = [facet / 2 / cells_x, facet / 2 % cells_x];
    let [below, right] = [(row + 1) % rows, (col + 1) % cols];
    let beside = if facet.is_multiple_of(2) { row * cols + right } else { below * cols + col };
    [row * cols + col, beside, below * cols + right]
}

#[cfg(test)]
mod tests {
    /// The bit of rays that exceed the step limit, as the shader states it.
    #[test]
    fn the_bit_of_lost_rays_is_the_shaders() {
        let shader = include_str!("../../../shaders_glsl/bake/facets.glsl");
        let stated = format!("const uint FACET_LOST = {:#x}u;", super::LOST);
        assert!(shader.contains(&stated), "{stated}");
    }
}

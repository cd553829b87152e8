//! A field as its flat triangles, and what each shows of itself in each of a set of directions.
//!
//! From far away a field that repeats is a plane. A light of irradiance 1 facing it, from l, brings the plane l_z; seen
//! from v, each part of the plane's area A fills A v_z of the view. Of the surface x above it, an area dx of the plan is
//! dx / n_z of slope, which fills (n·v)⁺ dx / n_z of the view where V(x, v) = 1, that is where nothing hides it from v: every
//! line of sight ends somewhere, so that ∫ V (n·v)⁺ / n_z dx = A v_z. The radiance seen is the mean over what is seen,
//!
//! > L(v) = ∫ L(x, v) V(x, v) (n·v)⁺ / n_z dx / (A v_z),   f(l, v) = L(v) / l_z.
//!
//! Of diffuse ground without scattered light L(x) = ρ/π V(x, l) (n·l)⁺, so
//!
//! > f(l, v) = 1/(A l_z v_z) ∫ ρ/π V(x, l) V(x, v) (n·l)⁺ (n·v)⁺ / n_z dx,
//!
//! the same with l and v exchanged, and ∫ f v_z dv ≤ ρ, as ∫ (n·v)⁺ dv = π and ∫ V (n·l)⁺ / n_z dx = A l_z.
//!
//! A lobe of share s and exponent k ([`Phong`](ridgelight::scene::Phong)) adds L(x, v) = s p(l, v) V(x, l) where n·l > 0, with
//! p = (k + 1)/2π (r·l)⁺ᵏ about the mirror direction r of v: no cosine in it, so that level ground has the closed form
//!
//! > f(l, v) = ρ/π + s p(l, v) / l_z.
//!
//! p is the same with l and v exchanged, s p / (n·l), which a lobe reflects of what falls on it, is not: **f is not reciprocal
//! where there are lobes**. Nor is it bounded by the light: a light at grazing angles brings little, a lobe takes no less of
//! it, and more may leave than arrives. It is bounded by the view: ∫ p dl ≤ 1, so that under light of 1 from all sides
//! ∫ f l_z dl ≤ ρ + s whatever the view. [`Brdf`](super::Brdf) says how far it is from both, where its directions are as close
//! as lobes are wide: a sum over others is no such integral.
//!
//! Here x are flat triangles, whose slopes are exact, each seen or hidden as a whole by what its middle sees. Where the
//! edge of what is hidden crosses a triangle, that errs by up to its share, and their sum S(v) is not quite v_z: shares are
//! taken times v_z / S(v), so that a light brings the triangles what it brings the plane, l_z, and they fill a view as the
//! plane does, v_z. The exchange of l and v stays exact of what is diffuse; what leaves of that is at most ρ times what sum of
//! cosines a triangle has over a set of directions. What a lobe mirrors is scaled as its light is, so that a view sees up to
//! l_z / S(l) times s. [`Facets::closure`] is how far S is off, and finer triangles bring it to 1.

mod samples;

use std::f64::consts::{PI, TAU};

use ridgelight::plan::DIRECTIONS_A_WORD;
use ridgelight::scene::{Albedo, Border, Directions, LOST_RAY, Phong, Scene};
use ridgelight::{Error, Result};
use ridgelight_cpu::facet_mask::cells;

/// A ray of a word took more steps than there can be.
const LOST: u32 = 1 << 31;

/// A field's triangles, cut so many times finer, and in which directions each is seen.
#[derive(Clone, Debug)]
pub struct Facets {
    directions: Directions,
    times: usize,
    /// Columns and rows of the field and of the finer one's cells.
    size: [usize; 2],
    cells: [usize; 2],
    /// Rise a length unit towards east and north.
    slopes: Vec<[f64; 2]>,
    albedo: Vec<[f64; 3]>,
    /// Exponents and shares, where anything is mirrored.
    lobes: Option<Vec<[f64; 2]>>,
    words: Vec<u32>,
    /// v_z / S(v) of each direction, infinite of those that show no front of a triangle; else of a field that ends 1.
    scales: Vec<f64>,
    repeats: bool,
}

/// Exit radiance of all triangles under one light, R, G, B each.
#[derive(Clone, Debug, PartialEq)]
pub struct ExitRadiance {
    /// Of each triangle, towards all views alike.
    alike: Vec<[f64; 3]>,
    /// The direction of the light that lobes mirror besides, of irradiance 1 facing it.
    mirrored: Option<usize>,
    /// What samples scatter towards each direction from the first on, where that is not alike.
    towards: Option<(usize, Vec<Vec<[f32; 3]>>)>,
}

impl From<Vec<[f64; 3]>> for ExitRadiance {
    /// Of each triangle, towards all views alike.
    fn from(alike: Vec<[f64; 3]>) -> Self {
        Self { alike, mirrored: None, towards: None }
    }
}

impl ExitRadiance {
    /// What leaves each triangle towards all views alike.
    pub fn alike(&self) -> &[[f64; 3]] {
        &self.alike
    }

    /// With what samples scatter, linear between them, towards each direction from number `first` on: no other may then look.
    #[must_use]
    pub fn scattering(self, first: usize, towards: Vec<Vec<[f32; 3]>>) -> Self {
        Self { towards: Some((first, towards)), ..self }
    }
}

impl Facets {
    /// Of a scene, whose light is none of this, and the words that [`plan::facet_mask`](ridgelight::plan::facet_mask) leaves of
    /// its field `times` [`finer`](ridgelight::scene::HeightField::finer).
    ///
    /// # Errors
    /// A direction at or below horizontal, from where no plane is seen; other than a word a cell and fifteen
    /// directions; a ray that the device has lost.
    pub fn of(
        scene: &Scene,
        times: usize,
        directions: Directions,
        words: Vec<u32>,
    ) -> Result<Self> {
        if let Some(i) = directions.vectors().iter().position(|v| v.z <= 0.0) {
            let found = format!("{}", directions.vectors()[i]);
            return Err(Error::setting(format!("direction {i}"), found, "one above horizontal"));
        }
        let finer = scene.finer(times)?;
        let (field, border) = (&finer.field, scene.surface.border);
        let cells = cells(field, border);
        let count = cells[0] * cells[1];
        let wanted = directions.count().div_ceil(DIRECTIONS_A_WORD) * count;
        if words.len() != wanted {
            let found = format!("{} words", words.len());
            return Err(Error::setting("triangles seen", found, format!("{wanted} words")));
        }
        if let Some(i) = words.iter().position(|word| word & LOST != 0) {
            let doing = format!("triangles seen: word {i}");
            return Err(Error::Device { doing, reason: LOST_RAY.to_owned() });
        }
        let [cell_x, cell_y] = field.cell_m();
        let lobe = finer.surface.phong.as_ref().filter(|lobe| lobe.largest().scale > 0.0);
        let mut lobes = lobe.map(|_| Vec::with_capacity(2 * count));
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
            if let (Some(lobes), Some(lobe)) = (&mut lobes, lobe) {
                let all = corners.map(|i| lobe.at(i));
                let mean = |of: fn(&Phong) -> f32| -> f64 {
                    all.iter().map(|phong| f64::from(of(phong))).sum::<f64>() / 3.0
                };
                lobes.push([mean(|phong| phong.exponent), mean(|phong| phong.scale)]);
            }
        }
        let size = [scene.field.cols(), scene.field.rows()];
        let (scales, repeats) = (Vec::new(), border == Border::Periodic);
        let mut all =
            Self { directions, times, size, cells, slopes, albedo, lobes, words, scales, repeats };
        let sums = all.of_all(|direction| all.shares(direction).map(|s| s.1).sum::<f64>());
        let facets = all.slopes.len() as f64;
        let heights = all.directions.vectors().iter().map(|v| v.z);
        let scale = |z: f64, sum: f64| if repeats || sum == 0.0 { z * facets / sum } else { 1.0 };
        all.scales = heights.zip(sums).map(|(z, sum)| scale(z, sum)).collect();
        Ok(all)
    }

    /// In which triangles are seen.
    pub fn directions(&self) -> &Directions {
        &self.directions
    }

    /// How many triangles.
    pub fn count(&self) -> usize {
        self.slopes.len()
    }

    /// How many finer than the field.
    pub fn times(&self) -> usize {
        self.times
    }

    /// S(v) / v_z: what the triangles that are seen from a direction fill of the view, of what the plane does; 1 but for those
    /// that are hidden in part, 0 where it shows no front of a triangle.
    pub fn closure(&self, direction: usize) -> f64 {
        1.0 / self.scales[direction]
    }

    /// Whether there are lobes: what leaves is then not alike towards all views.
    pub fn has_lobes(&self) -> bool {
        self.lobes.is_some()
    }

    /// Of the triangles that mirror anything the largest exponent, and the largest share that comes with it: a triangle has the
    /// means of its corners.
    pub fn sharpest(&self) -> Option<Phong> {
        let mirrors = self.lobes.iter().flatten().filter(|[_, scale]| *scale > 0.0);
        let sharpest = mirrors.max_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        sharpest.map(|[exponent, scale]| Phong { exponent: *exponent as f32, scale: *scale as f32 })
    }

    /// Whether a direction shows the front of any triangle.
    pub fn shows(&self, direction: usize) -> bool {
        self.scales[direction].is_finite()
    }

    /// Refuses what is no plane from afar.
    ///
    /// # Errors
    /// A field that does not repeat; a direction that shows nothing at all, by its number: finer triangles may.
    pub fn check(&self) -> Result<()> {
        if !self.repeats {
            let expected = "periodic: from afar, ground that goes on without end is a plane";
            return Err(Error::setting("border", "a field that ends", expected));
        }
        let Some(i) = self.scales.iter().position(|s| !s.is_finite()) else { return Ok(()) };
        let found = self.directions.vectors()[i].to_string();
        let expected = "one that shows a triangle: a finer field, or less near to horizontal";
        Err(Error::setting(format!("direction {i}"), found, expected))
    }

    /// Whether a direction sees a triangle, and how much of a view from there that fills over its own area of the plan, more
    /// than 0. Backs, which a field that ends may show, fill nothing: a direction that shows them alone has no scale.
    fn seen(&self, direction: usize) -> impl Fn(usize) -> Option<f64> {
        let e = self.directions.vectors()[direction];
        let cells = self.cells[0] * self.cells[1];
        let first = direction / DIRECTIONS_A_WORD * cells;
        let bit = 2 * (direction % DIRECTIONS_A_WORD);
        let words = &self.words[first..first + cells];
        move |facet| {
            let is_seen = words[facet / 2] >> (bit + facet % 2) & 1 == 1;
            let [east, north] = self.slopes[facet];
            let share = e.z - east * e.x - north * e.y;
            (is_seen && share > 0.0).then_some(share)
        }
    }

    /// The triangles that are seen from a direction, each with its [`seen`](Self::seen).
    fn shares(&self, direction: usize) -> impl Iterator<Item = (usize, f64)> {
        let seen = self.seen(direction);
        (0..self.slopes.len()).filter_map(move |facet| Some((facet, seen(facet)?)))
    }

    /// Area of a triangle over that of its plan.
    fn area(&self, facet: usize) -> f64 {
        let [east, north] = self.slopes[facet];
        (1.0 + east * east + north * north).sqrt()
    }

    /// Exit radiance of all triangles, without scattered light, under a light of irradiance 1 facing it from direction
    /// `light`.
    pub fn lit_from(&self, light: usize) -> ExitRadiance {
        let mut alike = vec![[0.0; 3]; self.slopes.len()];
        for (facet, share) in self.shares(light) {
            let irradiance = self.scales[light] * share / self.area(facet);
            alike[facet] = self.albedo[facet].map(|albedo| albedo / PI * irradiance);
        }
        let mirrored = self.lobes.is_some().then_some(light);
        ExitRadiance { alike, mirrored, towards: None }
    }

    /// What leaves a triangle towards a direction that sees it and of whose view it fills `share`.
    fn towards(&self, (view, share): (usize, f64), facet: usize, light: &ExitRadiance) -> [f64; 3] {
        let mut sum = light.alike[facet];
        if let Some((first, towards)) = &light.towards {
            let samples = &towards[view - first];
            for (sample, part) in self.between(facet) {
                (0..3).for_each(|c| sum[c] += part * f64::from(samples[sample][c]));
            }
        }
        let (Some(lobes), Some(from)) = (&self.lobes, light.mirrored) else { return sum };
        let [exponent, scale] = lobes[facet];
        let Some(lit) = self.seen(from)(facet) else { return sum };
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

    /// Mean radiance of what is seen from each direction.
    ///
    /// # Panics
    /// Where light is not scattered towards all of them: [`ExitRadiance::scattering`].
    pub fn seen_from_all(&self, light: &ExitRadiance) -> Vec<[f64; 3]> {
        self.of_all(|view| self.seen_from(view, light))
    }

    /// Mean radiance of what is seen from direction `view`; 0 where nothing is.
    ///
    /// # Panics
    /// Where light is not scattered towards that.
    pub fn seen_from(&self, view: usize, light: &ExitRadiance) -> [f64; 3] {
        let (mut sum, mut whole) = ([0.0; 3], 0.0);
        for (facet, share) in self.shares(view) {
            let radiance = self.towards((view, share), facet, light);
            (0..3).for_each(|c| sum[c] += share * radiance[c]);
            whole += share;
        }
        if whole > 0.0 { sum.map(|s| s / whole) } else { sum }
    }

    /// Runs over all directions, on as many threads as there are processors.
    fn of_all<T: Send>(&self, of: impl Fn(usize) -> T + Sync) -> Vec<T> {
        let count = self.directions.count();
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let part = count.div_ceil(threads);
        std::thread::scope(|scope| {
            let parts: Vec<_> = (0..count)
                .step_by(part)
                .map(|first| {
                    let of = &of;
                    scope.spawn(move || -> Vec<T> {
                        (first..count.min(first + part)).map(of).collect()
                    })
                })
                .collect();
            let done = parts.into_iter().flat_map(|part| part.join().expect("no part panics"));
            done.collect()
        })
    }
}

/// A triangle's samples: of its diagonal's north-western end, of the corner beside it, of the other end.
fn corners_of(facet: usize, cells_x: usize, [cols, rows]: [usize; 2]) -> [usize; 3] {
    let [row, col] = [facet / 2 / cells_x, facet / 2 % cells_x];
    let [below, right] = [(row + 1) % rows, (col + 1) % cols];
    let beside = if facet.is_multiple_of(2) { row * cols + right } else { below * cols + col };
    [row * cols + col, beside, below * cols + right]
}

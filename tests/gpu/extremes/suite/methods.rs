//! The methods for every case, and the error bound of each.

use glam::DVec3;
use ridgelight::plan::Azimuth;
use ridgelight::plan::azimuths::{along_grid_vectors, even};
use ridgelight::scene::{
    self, Basis, BounceEngine, BounceSpecular, Bounces, Directions, Fuse, Hull, Levels, LightBasis,
    Lines, Precision, Quality, Receiver, Scatter, Wedges,
};
use ridgelight_cpu::tolerance::{
    ARC_TANGENT, EPSILON, device_fused_slope, device_march_slope, device_slope, device_slope_f16,
    device_slope_packed, device_surface_slope, march_slope, pyramid_angle, pyramid_plane_slope,
    surface_slope, sweep_slope,
};

use super::About;

/// A method for horizons, by its name on the page.
pub struct Method {
    pub name: &'static str,
    pub about: About,
    pub quality: Quality,
    /// For methods along directions.
    traced: Option<Traced>,
}

/// The directions of visible points, and the settings of scattering.
pub struct Traced {
    pub directions: Directions,
    pub scatter: Scatter,
}

/// Every method. A new one is enrolled by an entry here.
pub fn all() -> Vec<Method> {
    let base = Quality { azimuths: 16, sun_azimuths: 32, ..Quality::default() };
    let pyramid = Quality { method: scene::Method::Pyramid, ..base };
    let fused = |fuse| Quality { method: scene::Method::Sweep, fuse, ..base };
    let spaced = |lines, fuse| Quality { lines, fuse, ..base };
    let kept = |precision, fuse| Quality { precision, fuse, ..base };
    let soft = |sh_order, subsample| Quality { basis: Basis::Sh, sh_order, subsample, ..base };
    [
        ("brute", Quality { method: scene::Method::BruteForce, ..base }),
        ("exact", Quality { lines: Lines::Exact, ..base }),
        ("auto", base),
        ("1, aimed", fused(Fuse::Aimed)),
        ("1, own, list", Quality { hull: Hull::OccluderList, ..fused(Fuse::Own) }),
        ("1, slopes, shared", Quality { hull: Hull::Shared, ..fused(Fuse::Slopes) }),
        ("1, nearest, private", Quality { hull: Hull::Private, ..fused(Fuse::Nearest) }),
        ("1, aimed-nearest", fused(Fuse::AimedNearest)),
        ("1, aimed-around", fused(Fuse::AimedAround)),
        ("1/4, aimed", spaced(Lines::QuarterCell, Fuse::Aimed)),
        ("1/2, aimed-nearest", spaced(Lines::HalfCell, Fuse::AimedNearest)),
        ("2, aimed-nearest", spaced(Lines::TwoCells, Fuse::AimedNearest)),
        ("4, aimed", spaced(Lines::FourCells, Fuse::Aimed)),
        ("1, slopes, f16", kept(Precision::F16, Fuse::Slopes)),
        ("1, nearest, f16", kept(Precision::F16, Fuse::Nearest)),
        ("1, nearest, packed", kept(Precision::Packed, Fuse::Nearest)),
        ("1, aimed-nearest, packed", kept(Precision::Packed, Fuse::AimedNearest)),
        ("pyramid, stack", pyramid),
        (
            "pyramid, levels, 3, 0",
            Quality { levels: Levels::Pyramid, level_step: 3, level_offset: 0, ..pyramid },
        ),
        ("harmonics, 4", soft(4, 1)),
        ("harmonics, 6, every 4th", soft(6, 4)),
        ("harmonics, 4, nlp", Quality { wedges: Wedges::Nlp, ..soft(4, 1) }),
        ("harmonics, 4, table", Quality { wedges: Wedges::Table, ..soft(4, 1) }),
    ]
    .map(|(name, quality)| Method::of(name, About::Horizons, quality))
    .into_iter()
    .chain(bounces(&base))
    .chain(soft_spheres(&base))
    .chain(phong_maps(&base))
    .chain(specular(&base))
    .chain(traced(&base))
    .collect()
}

/// Visible points along directions all over the sphere, along the grid, and slightly beside it.
fn traced(base: &Quality) -> impl Iterator<Item = Method> + use<> {
    let base = *base;
    let sphere = |count| Directions::fibonacci(count, -1.0, 3).expect("directions");
    let above = |count| Directions::fibonacci(count, 0.0, 3).expect("directions");
    let scattered = |bounces, paths| Scatter { bounces, paths, cutoff: 0.0, ..Scatter::default() };
    let mut level = sphere(14).vectors().to_vec();
    level.extend([DVec3::X, -DVec3::X]);
    let level = Directions::from_vectors(level, -1.0).expect("unit vectors");
    let none = Scatter::default;
    [
        ("16 directions", About::Points, sphere(16), none()),
        ("along the grid", About::Points, around_the_grid(0.0), none()),
        ("a hair beside the grid", About::Points, around_the_grid(1e-6), none()),
        ("of 16 directions", About::Ellipses, above(16), none()),
        ("of 64 directions, half below", About::Ellipses, sphere(64), none()),
        ("one bounce by 16 directions", About::Scattering, sphere(16), scattered(1, 24)),
        ("two bounces by 16, two of them level", About::Scattering, level, scattered(2, 16)),
        ("three bounces by 12 directions", About::Scattering, sphere(12), scattered(3, 16)),
    ]
    .into_iter()
    .map(move |(name, about, directions, scatter)| Method {
        traced: Some(Traced { directions, scatter }),
        ..Method::of(name, about, base)
    })
}

/// Straight up and down, and along rows, columns and diagonals, turned by so many radians: level, nearly, and not.
fn around_the_grid(turned_rad: f64) -> Directions {
    let mut all = vec![DVec3::Z, -DVec3::Z];
    for eighth in 0..8 {
        // By whole numbers, so that no rounding turns them.
        let towards = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];
        let [x, y] = towards[eighth].map(f64::from);
        for z in [1.0, 0.3, 1e-3, 0.0, -0.3] {
            all.push(DVec3::new(x - turned_rad * y, y + turned_rad * x, z).normalize());
        }
    }
    Directions::from_vectors(all, -1.0).expect("unit vectors")
}

/// Sphere lights by harmonics of every kind.
fn soft_spheres(base: &Quality) -> impl Iterator<Item = Method> + use<> {
    let of = |sh_order| Quality {
        light_basis: LightBasis::Sh,
        light_cutoff: 0.0,
        sun_azimuths: 8,
        sh_order,
        ..*base
    };
    let (nlp, table) = (Wedges::Nlp, Wedges::Table);
    [
        ("sphere lights by harmonics, 2", of(2)),
        ("sphere lights by harmonics, 4, lobe", Quality { receiver: Receiver::Cosine, ..of(4) }),
        ("sphere lights by harmonics, 6", of(6)),
        ("sphere lights by harmonics, 4, nlp", Quality { wedges: nlp, ..of(4) }),
        (
            "sphere lights by harmonics, 4, table",
            Quality { wedges: table, wedge_side: 33, ..of(4) },
        ),
        (
            "sphere lights by harmonics, 4, pyramid",
            Quality { method: scene::Method::Pyramid, ..of(4) },
        ),
    ]
    .into_iter()
    .map(|(name, quality)| Method::of(name, About::SoftSpheres, quality))
}

/// Phong specular by harmonics of every order, and through horizons of every kind.
fn phong_maps(base: &Quality) -> impl Iterator<Item = Method> + use<> {
    let of = |sh_order| Quality { basis: Basis::Sh, sh_order, ..*base };
    [
        ("a lobe by harmonics, 2", of(2)),
        ("a lobe by harmonics, 4, brute", Quality { method: scene::Method::BruteForce, ..of(4) }),
        ("a lobe by harmonics, 5, pyramid", Quality { method: scene::Method::Pyramid, ..of(5) }),
        ("a lobe by harmonics, 6, every 4th", Quality { subsample: 4, ..of(6) }),
    ]
    .into_iter()
    .map(|(name, quality)| Method::of(name, About::Phong, quality))
}

/// One bounce of Phong specular: by direction, of either storage of levels, and one number a texel.
fn specular(base: &Quality) -> impl Iterator<Item = Method> + use<> {
    let base = *base;
    let of = |specular, sh_order, levels| {
        let bounces = Bounces {
            count: 1,
            engine: BounceEngine::Pyramid,
            azimuths: 8,
            cutoff: 0.0,
            level_offset: 1,
            specular,
            ..Bounces::default()
        };
        Quality { basis: Basis::Sh, sh_order, levels, level_offset: 1, bounces, ..base }
    };
    [
        ("by direction, 4, stack", of(BounceSpecular::Vector, 4, Levels::Stack)),
        ("by direction, 3, levels", of(BounceSpecular::Vector, 3, Levels::Pyramid)),
        ("as visible from above, 4", of(BounceSpecular::Scalar, 4, Levels::Stack)),
    ]
    .into_iter()
    .map(|(name, quality)| Method::of(name, About::Specular, quality))
}

/// Every engine of bounces: walks along the grid, where they find all crossings; rays along cells' diagonals, and
/// along the grid and not.
fn bounces(base: &Quality) -> impl Iterator<Item = Method> + use<> {
    let base = *base;
    let of = |engine, azimuths| Bounces {
        count: 2,
        engine,
        azimuths,
        cutoff: 0.0,
        ..Bounces::default()
    };
    let bounced = |engine, azimuths| Quality { bounces: of(engine, azimuths), ..base };
    let walked = |lines| Quality { lines, ..bounced(BounceEngine::Sweep, 4) };
    let stack = bounced(BounceEngine::Pyramid, 4);
    let levels = Quality {
        levels: Levels::Pyramid,
        receiver: Receiver::Cosine,
        level_step: 3,
        level_offset: 0,
        bounces: Bounces { level_step: 2, level_offset: 1, ..of(BounceEngine::Pyramid, 5) },
        ..base
    };
    [
        ("brute force, 4 azimuths", bounced(BounceEngine::BruteForce, 4)),
        ("brute force, 5 azimuths", bounced(BounceEngine::BruteForce, 5)),
        ("walks, lines of 1", walked(Lines::Cell)),
        ("walks, lines of 4", walked(Lines::FourCells)),
        ("bounced by a pyramid, stack", stack),
        ("bounced by a pyramid, levels, 3, 0, lobe", levels),
    ]
    .into_iter()
    .map(|(name, quality)| Method::of(name, About::Bounces, quality))
}

impl Method {
    fn of(name: &'static str, about: About, quality: Quality) -> Self {
        Self { name, about, quality, traced: None }
    }

    /// Its directions.
    pub fn traced(&self) -> &Traced {
        self.traced.as_ref().expect("a method of visible points")
    }

    pub fn is_brute(&self) -> bool {
        self.quality.method == scene::Method::BruteForce
    }

    /// Whether it sweeps along grid vectors, where every crossing is on the hull.
    pub fn is_exact(&self) -> bool {
        self.has_lines() && self.quality.lines == Lines::Exact
    }

    pub fn is_pyramid(&self) -> bool {
        let bounces = &self.quality.bounces;
        self.quality.method == scene::Method::Pyramid
            || (bounces.count > 0 && bounces.engine == BounceEngine::Pyramid)
    }

    /// Whether an environment is lit by spherical harmonics.
    pub fn is_soft(&self) -> bool {
        self.quality.basis == Basis::Sh
    }

    /// Whether wedges smooth the series of visibility, whatever the horizons: to Legendre coefficients, or between a
    /// table's nodes.
    pub fn rounds_wedges(&self) -> bool {
        self.is_soft() && self.quality.wedges != Wedges::Slices
    }

    fn has_lines(&self) -> bool {
        let is_swept = !self.is_brute() && !self.is_pyramid();
        is_swept
            && (self.quality.bounces.count == 0
                || self.quality.bounces.engine == BounceEngine::Sweep)
    }

    /// Whether a line of the sweep passes through the texels of this lane in azimuths along the grid.
    pub fn has_line_at(&self, lane: usize) -> bool {
        !self.has_lines()
            || self.quality.lines.shift().is_none_or(|s| (lane << 15).is_multiple_of(1 << s))
    }

    /// Cells by which a sweep's occluder may stand aside of or beyond that of its texels: half the lines' distance and
    /// a step.
    pub fn aside(&self) -> f64 {
        let spaced = self.quality.lines.shift().filter(|_| self.has_lines());
        spaced.map_or(0.0, |shift| 1.0 + 0.5 * f64::from(shift).exp2() / 32_768.0)
    }

    /// The azimuths that it sweeps for a requested `count`, in the order of the circle.
    pub fn azimuths(&self, count: u32, cell_m: [f64; 2]) -> Vec<Azimuth> {
        if self.is_exact() {
            along_grid_vectors(count, cell_m).expect("vectors")
        } else {
            even(count, cell_m)
        }
    }

    /// Rounding of heights up to `largest_m` along a level line: their differences are exactly 0, but for packed
    /// entries, which are rounded and compared with unrounded heights, and for a pyramid's levels, whose splines
    /// round.
    pub fn level(&self, largest_m: f64) -> f64 {
        let rounds = self.quality.precision == Precision::Packed || self.is_pyramid();
        if rounds { largest_m } else { 0.0 }
    }

    /// Slope error between lines on a plane that rises by `rise_m` from lane to lane.
    ///
    /// `own` takes the occluders of two lines from the texel's height, t cells aside of the one and 1 - t of the
    /// other, and interpolates: t (1 - t) rise_m / distance, once added and once subtracted. All crossings of a line
    /// on a plane tie, and where rounding chooses other distances the two do not cancel: t (1 - t) rise_m / step at
    /// most.
    pub fn ties(&self, rise_m: f64, step_m: f64) -> f64 {
        let is_own = self.has_lines() && !self.is_exact() && self.quality.fuse == Fuse::Own;
        if is_own { 0.25 * rise_m / step_m } else { 0.0 }
    }

    /// The bound of a slope's error, for heights up to `largest_m` and no uneven ground nearer than `near_m`.
    ///
    /// The input rounds heights at both ends: 2 ε H. The errors of the CPU reference and of the device follow
    /// (`ridgelight_cpu::tolerance`, with `near_m` in place of a step): a march R ≤ 2 H; a surface sweep; a sweep and
    /// its fuse. Reduced precision adds its own: slopes as f16 2^-10 of themselves, packed heights 2^-11 of H.
    fn slope_error(&self, slope: f64, largest_m: f64, near_m: f64, azimuth: &Azimuth) -> f64 {
        let rounded = 2.0 * EPSILON * largest_m / near_m;
        if self.is_brute() {
            let relief = 2.0 * largest_m;
            return rounded + march_slope(relief, near_m) + device_march_slope(relief, near_m);
        }
        if self.is_exact() {
            let vector = [azimuth.vector_march, azimuth.vector_lane];
            let reference = device_surface_slope(largest_m, near_m, vector);
            return rounded + surface_slope(largest_m, near_m) + reference;
        }
        if self.is_pyramid() {
            return rounded + pyramid_plane_slope(largest_m, near_m);
        }
        let swept = sweep_slope(largest_m, near_m) + 2.0 * device_fused_slope(largest_m, near_m);
        let reduced = match self.quality.precision {
            Precision::F32 => device_slope(slope),
            Precision::F16 => device_slope_f16(slope),
            Precision::Packed => device_slope(slope) + device_slope_packed(largest_m, near_m),
        };
        rounded + swept + reduced
    }

    /// The same as an elevation, radians: d atan(x) = dx / (1 + x²) at the flattest that the slope may
    /// be. `arc_tangent` errs in proportion below slope 1 (Abramowitz & Stegun 4.4.49 bounds the
    /// error of atan(x) / x). An f16 beyond 65 504 is that number. `ties` as [`Method::ties`].
    pub fn angle_error(
        &self,
        slope: f64,
        (largest_m, near_m): (f64, f64),
        ties: f64,
        azimuth: &Azimuth,
    ) -> f64 {
        let error = self.slope_error(slope, largest_m, near_m, azimuth) + ties;
        let flattest = (slope.abs() - error).max(0.0);
        let saturated = match self.quality.precision {
            Precision::F16 => slope.atan() - slope.min(65_504.0).atan(),
            Precision::F32 | Precision::Packed => 0.0,
        };
        let turned = (error / (1.0 + flattest * flattest)).min(std::f64::consts::FRAC_PI_2);
        // A spline adds up a pyramid's angles, which are turned back and forth.
        let added = if self.is_pyramid() { pyramid_angle(slope.abs() + error) } else { 0.0 };
        turned + ARC_TANGENT * (slope.abs() + error).min(1.0) + saturated + added
    }
}

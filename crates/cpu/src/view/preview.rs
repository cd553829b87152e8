//! What the references of a preview's passes share: coarse grids, and how light depends on their slopes.

use ridgelight::scene::{HeightField, Sun};

/// How unoccluded light depends on the normal: `most` times a constant plus its product with a vector, and `least` or more.
#[derive(Clone, Copy)]
pub struct Unoccluded {
    /// East, north, up.
    pub vector: [f64; 3],
    /// The constant.
    pub constant: f64,
    /// R, G, B.
    pub most: [f64; 3],
    /// The least value of the sum.
    pub least: f64,
    /// The largest share of that light.
    pub ceiling: f64,
}

impl Unoccluded {
    /// A sun's light of a white texel: its irradiance times the cosine, over π.
    pub fn of_sun(sun: &Sun) -> Self {
        // f32 rounds π/2 up.
        let elevation_rad = sun.elevation_rad.min(std::f64::consts::FRAC_PI_2);
        let across = elevation_rad.cos();
        let [x, y] = [sun.azimuth_rad.cos(), sun.azimuth_rad.sin()].map(|v| across * v);
        let vector = [x, y, elevation_rad.sin()];
        let most = sun.irradiance.map(|e| f64::from(e) / std::f64::consts::PI);
        Self { vector, constant: 0.0, most, least: 1e-3, ceiling: 1.0 }
    }

    /// A uniform sky: 1 + the cosine of the slope.
    pub fn of_sky() -> Self {
        let (vector, ceiling) = ([0.0, 0.0, 1.0], f64::from(f32::MAX));
        Self { vector, constant: 1.0, most: [1.0; 3], least: 0.05, ceiling }
    }

    pub(super) fn at(&self, normal: [f64; 3]) -> f64 {
        self.constant + (0..3).map(|i| self.vector[i] * normal[i]).sum::<f64>()
    }
}

/// The light of a coarse grid, R, G, B of each grid point.
pub struct Coarse<'a> {
    /// The coarse heights.
    pub field: &'a HeightField,
    /// All light.
    pub radiance: &'a [[f32; 3]],
    /// The sun's, if it is not part of this one.
    pub without: Option<&'a [[f32; 3]]>,
    /// Its albedo.
    pub albedo: Colours<'a>,
    /// What it is divided by.
    pub unoccluded: Unoccluded,
}

/// Albedo of a grid.
#[derive(Clone, Copy)]
pub enum Colours<'a> {
    /// The same everywhere.
    Constant([f32; 3]),
    /// One per grid point.
    Map(&'a [[f32; 3]]),
}

impl Colours<'_> {
    pub(super) fn at(&self, i: usize, c: usize) -> f64 {
        f64::from(match self {
            Self::Constant(colour) => colour[c],
            Self::Map(all) => all[i][c],
        })
    }
}

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use glam::DVec3;

use crate::basis::triangles::Triangles;
use crate::{Error, Result};

/// Directions in which visibility is sampled at each grid point, each with the same solid angle.
///
/// Light arrives from the hemisphere about the normal, which on a slope reaches below the horizontal. The directions
/// therefore cover the sphere down to the height `lowest_z`; -1 covers all of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Directions {
    vectors: Vec<DVec3>,
    lowest_z: f64,
}

impl Directions {
    /// Range of the number of directions.
    pub const COUNT: RangeInclusive<usize> = 4..=4096;
    /// Range of `lowest_z`: from the whole sphere to the upper hemisphere.
    const LOWEST_Z: RangeInclusive<f64> = -1.0..=0.0;

    /// A spherical Fibonacci set: heights at the centres of equal parts from `lowest_z` to 1, each rotated from the previous
    /// one by the golden section of the circle (Hannay & Nye 2004). `seed` rotates all about the vertical.
    ///
    /// An even number N of directions over the sphere leaves none within 1/N of horizontal; an odd number has one that is
    /// horizontal.
    ///
    /// # Errors
    /// A count or a height out of range.
    pub fn fibonacci(count: usize, lowest_z: f64, seed: u32) -> Result<Self> {
        if !Self::COUNT.contains(&count) {
            let expected =
                format!("a whole number from {} to {}", Self::COUNT.start(), Self::COUNT.end());
            return Err(Error::setting("directions", count.to_string(), expected));
        }
        check_lowest(lowest_z)?;
        let golden = 0.5 * (5_f64.sqrt() - 1.0);
        // Multiples of an irrational number are spread evenly over the circle.
        let turn = f64::from(seed) * 2_f64.sqrt();
        let vectors = (0..count).map(|i| {
            let z = 1.0 - (1.0 - lowest_z) * (i as f64 + 0.5) / count as f64;
            let azimuth = TAU * (i as f64 * golden + turn).fract();
            let across = (1.0 - z * z).sqrt();
            DVec3::new(across * azimuth.cos(), across * azimuth.sin(), z)
        });
        Ok(Self { vectors: vectors.collect(), lowest_z })
    }

    /// From unit vectors that are evenly distributed over the sphere down to `lowest_z`, or that are traced only.
    ///
    /// # Errors
    /// No vector or too many; a vector whose length differs from 1 by more than 1e-6.
    pub fn from_vectors(vectors: Vec<DVec3>, lowest_z: f64) -> Result<Self> {
        if vectors.is_empty() || vectors.len() > *Self::COUNT.end() {
            let expected = format!("1 to {}", Self::COUNT.end());
            return Err(Error::setting("directions", vectors.len().to_string(), expected));
        }
        check_lowest(lowest_z)?;
        let is_unit = |v: &DVec3| (v.length() - 1.0).abs() <= 1e-6;
        if let Some(i) = vectors.iter().position(|v| !is_unit(v)) {
            let found = format!("{}", vectors[i]);
            return Err(Error::setting(format!("direction {i}"), found, "a vector of length 1"));
        }
        Ok(Self { vectors, lowest_z })
    }

    /// Unit vectors: east, north, up.
    pub fn vectors(&self) -> &[DVec3] {
        &self.vectors
    }

    /// Lowest height that they cover, [-1..0].
    pub fn lowest_z(&self) -> f64 {
        self.lowest_z
    }

    /// Number of directions.
    pub fn count(&self) -> usize {
        self.vectors.len()
    }

    /// Solid angle per direction, sr: the covered solid angle over the count. A direction chosen among them has the density
    /// 1 / (count · share) of solid angle.
    pub fn share_sr(&self) -> f64 {
        TAU * (1.0 - self.lowest_z) / self.vectors.len() as f64
    }

    /// Their triangulation. Its lower rim is ragged by about the distance between two directions; below
    /// [`lowest_z`](Self::lowest_z) there is no triangle.
    ///
    /// # Errors
    /// Fewer than four directions, two equal ones, or all on one circle.
    pub fn triangles(&self) -> Result<Triangles> {
        let net = Triangles::of(&self.vectors).ok_or_else(|| {
            let found = format!("{} that span no hull", self.vectors.len());
            Error::setting("directions", found, "four or more, no two equal, not on one circle")
        })?;
        Ok(net.above(&self.vectors, self.lowest_z))
    }
}

fn check_lowest(lowest_z: f64) -> Result<()> {
    if Directions::LOWEST_Z.contains(&lowest_z) {
        return Ok(());
    }
    let expected = "a number from -1, the whole sphere, to 0, the upper hemisphere";
    Err(Error::setting("height of the lowest direction", lowest_z.to_string(), expected))
}

/// Smallest radius of an ellipse for `count` directions: that of the disc around the zenith that one direction covers,
/// π r² = 2π / count.
pub fn least_radius(count: usize) -> f64 {
    (2.0 / count.max(1) as f64).sqrt()
}

//! Horizons as Fourier series over azimuth, in the form that bevy-clipmap 1.0.4 reads.
//!
//! Its shader (src/terrain.wgsl, `reconstruct_horizon`) sums, for a direction θ from +x (columns) towards +z (rows),
//! (c₀ + 2 Σ (aₖ cos kθ - bₖ sin kθ)) / 360, multiplies by the range of the heights and takes the arctangent. Layers are
//! c₀, a₁ … a_K, b₁ … b_K. Its own baker takes the discrete transform of 360 azimuths, so a and b are real and
//! imaginary parts.

use std::path::Path;

use ridgelight::Result;
use ridgelight_io::{Component, Ktx2Writer, TexelFormat};

/// The number of azimuths of bevy-clipmap's baker, by which its shader divides.
const SHADER_AZIMUTHS: f64 = 360.0;

/// What `--fourier` asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fourier {
    /// Coefficients besides the mean: a and b of each frequency, an even number.
    pub coefficients: u32,
    /// Range of the heights, by which the shader multiplies.
    pub range_m: f64,
}

/// Sums over azimuths.
pub struct Series {
    wanted: Fourier,
    azimuths_rad: Vec<f64>,
    size: [usize; 2],
    /// A plane for each layer.
    planes: Vec<Vec<f32>>,
    /// Sum of the squared tangents over texels and azimuths.
    energy: f64,
}

impl Series {
    pub fn new(wanted: Fourier, azimuths_rad: Vec<f64>, [rows, cols]: [usize; 2]) -> Self {
        let layers = wanted.coefficients as usize + 1;
        let planes = vec![vec![0.0; rows * cols]; layers];
        Self { wanted, azimuths_rad, size: [cols, rows], planes, energy: 0.0 }
    }

    /// Adds the elevations of an azimuth, radians. Those below the horizontal count as 0, as in bevy-clipmap's baker.
    pub fn add(&mut self, azimuth: usize, elevations: &[f32]) {
        let tangents: Vec<f32> = elevations.iter().map(|angle| angle.max(0.0).tan()).collect();
        self.energy += tangents.iter().map(|t| f64::from(*t).powi(2)).sum::<f64>();
        // Rows run southwards, azimuths counter-clockwise from east.
        let theta = -self.azimuths_rad[azimuth];
        let unit = SHADER_AZIMUTHS / self.azimuths_rad.len() as f64 / self.wanted.range_m;
        let half = self.wanted.coefficients as usize / 2;
        for (layer, plane) in self.planes.iter_mut().enumerate() {
            let weight = match layer.checked_sub(half + 1) {
                None => (layer as f64 * theta).cos(),
                Some(before) => -((before + 1) as f64 * theta).sin(),
            };
            let weight = (weight * unit) as f32;
            plane.iter_mut().zip(&tangents).for_each(|(sum, tangent)| *sum += weight * tangent);
        }
    }

    /// Root mean square of what the series leaves out of the tangents, over that of the tangents: 0 for a series that
    /// holds all.
    pub fn error(&self) -> f64 {
        let scale = self.wanted.range_m / SHADER_AZIMUTHS;
        let squares =
            |plane: &Vec<f32>| plane.iter().map(|c| (f64::from(*c) * scale).powi(2)).sum::<f64>();
        // Parseval's theorem: a frequency and its negative hold the same.
        let held =
            squares(&self.planes[0]) + 2.0 * self.planes[1..].iter().map(squares).sum::<f64>();
        let all = self.energy / self.azimuths_rad.len() as f64;
        if all > 0.0 { (1.0 - held / all).max(0.0).sqrt() } else { 0.0 }
    }

    pub fn write(&self, path: &Path, texts: &[(String, String)]) -> Result<()> {
        let format = TexelFormat { component: Component::F32, count: 1 };
        let mut file = Ktx2Writer::create(path, format, self.size, Some(self.planes.len()), texts)?;
        for plane in &self.planes {
            let bytes: Vec<u8> = plane.iter().flat_map(|value| value.to_le_bytes()).collect();
            file.write(&bytes)?;
        }
        file.finish()
    }
}

//! Horizons as Fourier series over azimuth, in the form that bevy-clipmap 1.0.4 reads.
//!
//! Its shader (src/terrain.wgsl, `reconstruct_horizon`) sums, for a direction θ from +x (columns) towards +z (rows),
//! (c₀ + 2 Σ (aₖ cos kθ - bₖ sin kθ)) / 360, multiplies by the range of the heights and takes the arctangent. Layers are
//! c₀, a₁ … a_K, b₁ … b_K. Its own baker takes the discrete transform of 360 azimuths, so a and b are real and
//! imaginary parts.

use std::ops::Range;
use std::path::Path;
use std::thread::available_parallelism;

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

/// Texels per block. A block holds the sums of all layers of a round.
const BLOCK_TEXELS: usize = 1 << 14;

/// The sums over azimuths that are the coefficients. A round computes as many layers as fit into the budget, from all azimuths. The
/// remaining layers take more rounds.
pub struct Series {
    wanted: Fourier,
    azimuths_rad: Vec<f64>,
    /// Columns, rows.
    size: [usize; 2],
    /// Layers per round.
    per_round: usize,
    /// Layers of this round.
    layers: Range<usize>,
    /// For each block of texels the sums of the round's layers, layer after layer.
    blocks: Vec<Vec<f32>>,
    /// Sum of the squared tangents over texels and azimuths.
    energy: f64,
    /// Sum over texels of the mean square of the series over azimuth, from the layers written so far (Parseval).
    series_energy: f64,
    file: Option<Ktx2Writer>,
}

impl Series {
    /// The sums of a round take at most `budget` bytes, or one layer if that is larger.
    pub fn new(
        wanted: Fourier,
        azimuths_rad: Vec<f64>,
        [rows, cols]: [usize; 2],
        budget: u64,
    ) -> Self {
        let (texels, all) = (rows * cols, wanted.coefficients as usize + 1);
        let most = usize::try_from(budget / (4 * texels as u64)).unwrap_or(all).clamp(1, all);
        // All rounds have the same number of layers; the last can have fewer.
        let per_round = all.div_ceil(all.div_ceil(most));
        let layers = 0..per_round;
        let block = |first: usize| BLOCK_TEXELS.min(texels - first) * layers.len();
        let blocks = (0..texels).step_by(BLOCK_TEXELS).map(|first| vec![0.0; block(first)]);
        let (blocks, size) = (blocks.collect(), [cols, rows]);
        let (energy, series_energy, file) = (0.0, 0.0, None);
        Self { wanted, azimuths_rad, size, per_round, layers, blocks, energy, series_energy, file }
    }

    /// Layers of the file.
    fn all(&self) -> usize {
        self.wanted.coefficients as usize + 1
    }

    /// The number of rounds, and how many are done.
    pub fn rounds(&self) -> [usize; 2] {
        [self.all(), self.layers.start].map(|layers| layers.div_ceil(self.per_round))
    }

    /// Bytes of the file's texels.
    pub fn bytes(&self) -> u64 {
        4 * (self.size[0] * self.size[1] * self.all()) as u64
    }

    /// Adds the elevations of an azimuth, radians. Those below the horizontal count as 0, as in bevy-clipmap's baker.
    pub fn add(&mut self, azimuth: usize, elevations: &[f32]) {
        // Rows run southwards, azimuths counter-clockwise from east.
        let theta = -self.azimuths_rad[azimuth];
        let unit = SHADER_AZIMUTHS / self.azimuths_rad.len() as f64 / self.wanted.range_m;
        let half = self.wanted.coefficients as usize / 2;
        let weight = |layer: usize| {
            let weight = match layer.checked_sub(half + 1) {
                None => (layer as f64 * theta).cos(),
                Some(before) => -((before + 1) as f64 * theta).sin(),
            };
            (weight * unit) as f32
        };
        let weights: Vec<f32> = self.layers.clone().map(weight).collect();
        let of_threads = self.blocks.len().div_ceil(available_parallelism().map_or(1, usize::from));
        let sums = self.blocks.chunks_mut(of_threads);
        let parts = sums.zip(elevations.chunks(of_threads * BLOCK_TEXELS));
        let weights = &weights[..];
        let energies: Vec<f64> = std::thread::scope(|scope| {
            let threads: Vec<_> = parts
                .map(|(blocks, elevations)| {
                    scope.spawn(move || add_to_blocks(blocks, elevations, weights))
                })
                .collect();
            threads.into_iter().map(|t| t.join().expect("no panic")).collect()
        });
        if self.layers.start == 0 {
            self.energy += energies.iter().sum::<f64>();
        }
    }

    /// Writes the layers of this round and begins the next. Call it when all azimuths are added. Returns false after the last round.
    pub fn end_round(&mut self, path: &Path, texts: &[(String, String)]) -> Result<bool> {
        let file = match &mut self.file {
            Some(file) => file,
            None => {
                let format = TexelFormat { component: Component::F32, count: 1 };
                let layers = Some(self.all());
                self.file.insert(Ktx2Writer::create(path, format, self.size, layers, texts)?)
            }
        };
        let scale = self.wanted.range_m / SHADER_AZIMUTHS;
        for (i, layer) in self.layers.clone().enumerate() {
            // Parseval's theorem: a frequency and its negative hold the same.
            let times = if layer == 0 { 1.0 } else { 2.0 };
            for block in &self.blocks {
                let texels = block.len() / self.layers.len();
                let sums = &block[i * texels..(i + 1) * texels];
                let squares = sums.iter().map(|c| (f64::from(*c) * scale).powi(2));
                self.series_energy += times * squares.sum::<f64>();
                let bytes: Vec<u8> = sums.iter().flat_map(|sum| sum.to_le_bytes()).collect();
                file.write(&bytes)?;
            }
        }
        let (count, end) = (self.layers.len(), self.layers.end);
        self.layers = end..(end + self.per_round).min(self.all());
        for block in &mut self.blocks {
            block.truncate(block.len() / count * self.layers.len());
            block.fill(0.0);
        }
        Ok(!self.layers.is_empty())
    }

    /// Finishes the file. Returns the RMS error of the tangents relative to their RMS; 0 if the series is exact.
    pub fn finish(self) -> Result<f64> {
        self.file.map_or(Ok(()), Ktx2Writer::finish)?;
        let all = self.energy / self.azimuths_rad.len() as f64;
        Ok(if all > 0.0 { (1.0 - self.series_energy / all).max(0.0).sqrt() } else { 0.0 })
    }
}

/// Adds the tangent of each elevation, multiplied by each layer's weight, to the sums. Returns the sum of the squared tangents,
/// unweighted.
fn add_to_blocks(blocks: &mut [Vec<f32>], elevations: &[f32], weights: &[f32]) -> f64 {
    let mut energy = 0.0;
    for (sums, elevations) in blocks.iter_mut().zip(elevations.chunks(BLOCK_TEXELS)) {
        let tangents: Vec<f32> = elevations.iter().map(|angle| angle.max(0.0).tan()).collect();
        energy += tangents.iter().map(|t| f64::from(*t).powi(2)).sum::<f64>();
        for (sums, weight) in sums.chunks_exact_mut(tangents.len()).zip(weights) {
            sums.iter_mut().zip(&tangents).for_each(|(sum, tangent)| *sum += weight * tangent);
        }
    }
    energy
}

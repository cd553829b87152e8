//! Synthetic terrains for pictures and tests: the same heights on every machine.

use ridgelight::Result;
use ridgelight::scene::HeightField;
use std::f64::consts::TAU;

/// A splitmix64 stream (S. Vigna), 0 to 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A sum of waves of random directions and phases, in -1..1 mostly.
struct Waves(Vec<[f64; 4]>);

impl Waves {
    /// Wavelengths in cells from `longest` down to `shortest`; the amplitude is proportional to the wavelength's power.
    fn new(seed: u64, [longest, shortest]: [f64; 2], power: f64) -> Self {
        const COUNT: usize = 48;
        let mut random = Random(seed);
        let waves = (0..COUNT).map(|i| {
            let share = i as f64 / (COUNT - 1) as f64;
            let length = longest * (shortest / longest).powf(share);
            let (angle, phase) = (TAU * random.next(), TAU * random.next());
            [TAU * angle.cos() / length, TAU * angle.sin() / length, phase, length.powf(power)]
        });
        let mut all: Vec<[f64; 4]> = waves.collect();
        let sum: f64 = all.iter().map(|wave| wave[3] * wave[3]).sum();
        all.iter_mut().for_each(|wave| wave[3] /= sum.sqrt());
        Self(all)
    }

    fn at(&self, x: f64, y: f64) -> f64 {
        self.0.iter().map(|[a, b, phase, size]| size * (a * x + b * y + phase).cos()).sum()
    }
}

fn field(side: usize, cell_m: f64, height: impl Fn(f64, f64) -> f64) -> Result<HeightField> {
    let heights: Vec<f64> =
        (0..side * side).map(|i| height((i % side) as f64, (i / side) as f64)).collect();
    HeightField::new(side, side, &heights, [cell_m; 2], None)
}

/// Transverse sand dunes up to about 25 m high, cells of 2 m: gentle to windward, at the angle of repose in the lee.
///
/// # Errors
/// A side of 0.
pub fn dunes(side: usize) -> Result<HeightField> {
    /// Between crests, cells.
    const SPACING: f64 = 70.0;
    /// Share of the spacing to windward.
    const WINDWARD: f64 = 0.76;
    let (bends, sizes) = (Waves::new(3, [400.0, 60.0], 1.0), Waves::new(5, [500.0, 120.0], 1.0));
    field(side, 2.0, |x, y| {
        let phase = (0.94 * x + 0.34 * y) / SPACING + 0.5 * bends.at(x, y);
        let share = phase.rem_euclid(1.0);
        let rise =
            if share < WINDWARD { share / WINDWARD } else { (1.0 - share) / (1.0 - WINDWARD) };
        let height = 11.0 * (1.0 + 0.45 * sizes.at(x, y).clamp(-1.5, 1.5));
        height * rise * rise * (3.0 - 2.0 * rise)
    })
}

/// A flat coast, cells of 30 m: sea at height 0, a plain that rises to about 20 m, and lagoons.
///
/// # Errors
/// A side of 0.
pub fn coast(side: usize) -> Result<HeightField> {
    let (shape, detail) = (Waves::new(7, [500.0, 40.0], 1.0), Waves::new(9, [40.0, 6.0], 0.7));
    field(side, 30.0, |x, y| {
        let inland = 20.0 * (x / side as f64 - 0.4) + 3.5 * shape.at(x, y);
        (inland + 0.5 * detail.at(x, y)).max(0.0)
    })
}

/// A city, cells of 1 m: blocks of 48 m with streets of 12 m, flat roofs from 6 m to about 60 m.
///
/// # Errors
/// A side of 0.
pub fn city(side: usize) -> Result<HeightField> {
    const BLOCK: usize = 48;
    const STREET: usize = 12;
    let roof = |row: usize, col: usize| {
        let (block_row, block_col) = (row / BLOCK, col / BLOCK);
        let mut random = Random(((block_row << 20) + block_col) as u64);
        let count = 1 + (random.next() * 3.0) as usize;
        let lot = (BLOCK - STREET) / count;
        let inside = [row % BLOCK, col % BLOCK].map(|at| at.checked_sub(STREET / 2));
        let [Some(down), Some(across)] = inside else { return 0.0 };
        let ([i, j], [v, u]) =
            ([down / lot, across / lot], [down % lot, across % lot].map(|at| at + 1));
        let is_gap = count > 1 && (u == lot || v == lot);
        if i >= count || j >= count || is_gap {
            return 0.0;
        }
        let mut random = Random(((block_row << 24) + (block_col << 8) + 4 * i + j) as u64 ^ 0xabcd);
        let is_yard = random.next() < 0.12;
        let tall = -7.0 * (random.next() * random.next()).max(1e-3).ln();
        if is_yard { 0.0 } else { 6.0 + tall.min(54.0) }
    };
    field(side, 1.0, |x, y| roof(y as usize, x as usize))
}

/// An escarpment, cells of 30 m: a plateau 120 m above a plain, cut by gullies.
///
/// # Errors
/// A side of 0.
pub fn escarpment(side: usize) -> Result<HeightField> {
    let (edge, rough) = (Waves::new(11, [300.0, 15.0], 1.0), Waves::new(13, [90.0, 8.0], 1.0));
    field(side, 30.0, |x, y| {
        let across = (x / side as f64 - 0.5) * 14.0 + 2.0 * edge.at(x, y);
        120.0 / (1.0 + (1.8 * across).exp()) + 4.0 * rough.at(x, y)
    })
}

/// Craters on a plain, cells of 20 m: simple bowls with raised rims, depth a fifth of the diameter (R. J. Pike, 1977), the
/// youngest last.
///
/// # Errors
/// A side of 0.
pub fn craters(side: usize) -> Result<HeightField> {
    const COUNT: usize = 220;
    let rough = Waves::new(17, [120.0, 4.0], 1.0);
    let mut random = Random(23);
    let bowls: Vec<[f64; 3]> = (0..COUNT)
        .map(|i| {
            // Areas per size fall with the square of the diameter.
            let radius = if i == COUNT - 1 { 0.22 } else { 0.012 / (random.next() + 0.02).sqrt() };
            let place = if i == COUNT - 1 { [0.46, 0.52] } else { [random.next(), random.next()] };
            [place[0] * side as f64, place[1] * side as f64, radius * side as f64]
        })
        .collect();
    field(side, 20.0, |x, y| {
        let plain = 4.0 * rough.at(x, y);
        bowls.iter().fold(plain, |height, [east, south, radius]| {
            let away = (x - east).hypot(y - south) / radius;
            let depth = 0.4 * 20.0 * radius;
            let rim = 0.18 * depth * (-((away - 1.0) / 0.25).powi(2)).exp();
            let bowl = if away < 1.0 { depth * (away * away - 1.0) } else { 0.0 };
            // A bowl replaces what was there; its rim lies upon it.
            let kept = if away < 1.0 { height * (0.2 + 0.8 * away * away) } else { height };
            kept + bowl + rim
        })
    })
}

/// Waves of deep water at a time in seconds, cells of 0.5 m: each travels with its own speed, √(g λ / 2 π).
///
/// # Errors
/// A side of 0.
pub fn waves(side: usize, time_s: f64) -> Result<HeightField> {
    const CELL_M: f64 = 0.5;
    const GRAVITY: f64 = 9.81;
    let mut random = Random(37);
    let all: Vec<[f64; 4]> = (0..40)
        .map(|i| {
            let length = 60.0 * 0.92_f64.powi(i);
            let number = TAU / length;
            // Around the wind's direction.
            let angle = 0.6 + 1.2 * (random.next() - 0.5);
            let phase = TAU * random.next() - (GRAVITY * number).sqrt() * time_s;
            [number * angle.cos(), number * angle.sin(), phase, 0.011 * length]
        })
        .collect();
    field(side, CELL_M, |x, y| {
        let wave =
            |[a, b, phase, high]: &[f64; 4]| high * (a * x * CELL_M + b * y * CELL_M + phase).sin();
        all.iter().map(wave).sum()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(field: &HeightField) -> [f64; 2] {
        let all = field.heights_m().iter().map(|h| field.base_m() + f64::from(*h));
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], h| [low.min(h), high.max(h)])
    }

    #[test]
    fn terrains_have_their_heights() {
        for (made, lowest, highest) in [
            (dunes(256), [-1e-5, 1.0], [10.0, 30.0]),
            (coast(256), [-1e-5, 1e-5], [8.0, 40.0]),
            (city(256), [-1e-5, 1e-5], [20.0, 60.1]),
            (escarpment(256), [-20.0, 10.0], [100.0, 150.0]),
            (craters(256), [-800.0, -200.0], [20.0, 300.0]),
            (waves(256, 1.5), [-6.0, -1.0], [1.0, 6.0]),
        ] {
            let [low, high] = range(&made.unwrap());
            assert!((lowest[0]..=lowest[1]).contains(&low), "{low}");
            assert!((highest[0]..=highest[1]).contains(&high), "{high}");
        }
    }

    /// The slope of the lee, by the steepest differences; sand lies at up to 34 degrees.
    #[test]
    fn dunes_have_slip_faces() {
        let made = dunes(300).unwrap();
        let heights = made.heights_m();
        let steepest = |sign: f64| {
            let rises = heights.windows(2).map(|pair| sign * f64::from(pair[1] - pair[0]) / 2.0);
            let inside = rises.enumerate().filter(|(i, _)| (i + 1) % 300 != 0);
            inside.map(|(_, rise)| rise).fold(0.0, f64::max).atan().to_degrees()
        };
        let (lee, windward) = (steepest(-1.0), steepest(1.0));
        assert!((28.0..70.0).contains(&lee) && lee > 1.3 * windward, "{lee} {windward}");
    }
}

//! Cube maps and angular maps of the whole sphere, and their resampling to the equirectangular grid
//! of [`Environment`](ridgelight::scene::Environment).
//!
//! The view is from inside: the world's +x (azimuth 0) straight ahead, +z up, and so -y to the
//! right.

use std::f64::consts::PI;
use std::ops::Range;

/// Row-major linear RGB.
pub(crate) struct Picture {
    pub rows: usize,
    pub cols: usize,
    pub texels: Vec<[f32; 3]>,
}

impl Picture {
    /// The square of `side` texels whose top left corner is at a place, rotated by 180° if
    /// requested.
    pub fn cut(&self, row: usize, col: usize, side: usize, turned: bool) -> Picture {
        let mut texels: Vec<[f32; 3]> = (row..row + side)
            .flat_map(|r| &self.texels[r * self.cols + col..r * self.cols + col + side])
            .copied()
            .collect();
        if turned {
            texels.reverse();
        }
        Picture { rows: side, cols: side, texels }
    }

    /// Bilinear lookup at a position in texels, (0, 0) the top left corner of the picture. Clamped
    /// at the edges, so that the weight of every texel sums to its own area.
    fn bilinear(&self, x: f64, y: f64) -> [f64; 3] {
        let (c0, c1, fx) = taps(x, self.cols);
        let (r0, r1, fy) = taps(y, self.rows);
        let at = |r: usize, c: usize| self.texels[r * self.cols + c];
        let corners = [at(r0, c0), at(r0, c1), at(r1, c0), at(r1, c1)];
        [0, 1, 2].map(|i| {
            let [a, b, c, d] = corners.map(|t| f64::from(t[i]));
            // a + f (b - a) keeps a constant exactly constant.
            let (top, bottom) = (a + fx * (b - a), c + fx * (d - c));
            top + fy * (bottom - top)
        })
    }
}

/// The two texels around a coordinate and the weight of the second.
fn taps(x: f64, count: usize) -> (usize, usize, f64) {
    let x = (x - 0.5).clamp(0.0, (count - 1) as f64);
    let first = x as usize;
    (first, (first + 1).min(count - 1), x - first as f64)
}

/// An equirectangular picture of `rows` and twice as many columns. Each texel is the mean of
/// `lookup` over 4 × 4 directions, evenly spaced in azimuth and in the cosine of the zenith angle
/// (equal solid angles).
fn resample(rows: usize, lookup: impl Fn([f64; 3]) -> [f64; 3] + Sync) -> Picture {
    const SUB: usize = 4;
    let cols = 2 * rows;
    let middle = |i: usize| (i as f64 + 0.5) / SUB as f64;
    let texel = |row: usize, col: usize| {
        let edge = |r: usize| (PI * r as f64 / rows as f64).cos();
        let (top, bottom) = (edge(row), edge(row + 1));
        let mut sum = [0.0; 3];
        for i in 0..SUB {
            let z = top + (bottom - top) * middle(i);
            let across = (1.0 - z * z).max(0.0).sqrt();
            for j in 0..SUB {
                let azimuth = PI - 2.0 * PI * (col as f64 + middle(j)) / cols as f64;
                let value = lookup([across * azimuth.cos(), across * azimuth.sin(), z]);
                sum = [0, 1, 2].map(|k| sum[k] + value[k]);
            }
        }
        sum.map(|s| (s / (SUB * SUB) as f64) as f32)
    };
    let band = |rows: Range<usize>| -> Vec<[f32; 3]> {
        rows.flat_map(|r| (0..cols).map(move |c| (r, c))).map(|(r, c)| texel(r, c)).collect()
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(rows);
    let texels = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|t| (t * rows / threads)..((t + 1) * rows / threads))
            .map(|rows| scope.spawn(|| band(rows)))
            .collect();
        workers
            .into_iter()
            .flat_map(|w| w.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    });
    Picture { rows, cols, texels }
}

/// Rows that resolve a cube of faces `side` texels wide at its finest.
///
/// One texel along an axis at (u, v) on a face is an angle of (2/side)·√(1+v²)/(1+u²+v²), smallest
/// at a corner: (2/side)·√2/3 = 0.943/side. Ten rows for three texels are π·3/(10·side) =
/// 0.942/side apart.
pub(crate) fn cube_rows(side: usize) -> usize {
    (10 * side).div_ceil(3)
}

/// Six faces, +X -X +Y -Y +Z -Z, as OpenGL and Vulkan define them (their +Y up), to an
/// equirectangular picture. The cube's +Z is straight ahead and its +X to the right.
pub(crate) fn from_cube(faces: &[Picture; 6]) -> Picture {
    let side = faces[0].cols as f64;
    resample(cube_rows(faces[0].cols), |[x, y, z]| {
        let (cx, cy, cz) = (-y, z, x);
        let (ax, ay, az) = (cx.abs(), cy.abs(), cz.abs());
        // The table "selection of cube map images" of both specifications.
        let (face, s, t, major) = if az >= ax && az >= ay {
            if cz > 0.0 { (4, cx, -cy, az) } else { (5, -cx, -cy, az) }
        } else if ay >= ax {
            if cy > 0.0 { (2, cx, cz, ay) } else { (3, cx, -cz, ay) }
        } else if cx > 0.0 {
            (0, -cz, -cy, ax)
        } else {
            (1, cz, -cy, ax)
        };
        let texels = |v: f64| (v / major + 1.0) / 2.0 * side;
        faces[face].bilinear(texels(s), texels(t))
    })
}

/// The six faces of a cross, folded into a cube. Straight ahead is in the centre, with left, right,
/// up and down around it. Behind is at the far right of a horizontal cross (4:3) and, upside down,
/// at the foot of a vertical one (3:4).
pub(crate) fn from_cross(cross: &Picture) -> Picture {
    let vertical = cross.rows > cross.cols;
    let side = if vertical { cross.cols / 3 } else { cross.cols / 4 };
    let at = |row: usize, col: usize| cross.cut(row * side, col * side, side, false);
    let behind = if vertical { cross.cut(3 * side, side, side, true) } else { at(1, 3) };
    from_cube(&[at(1, 2), at(1, 0), at(0, 1), at(2, 1), at(1, 1), behind])
}

/// An angular map (Debevec's light probes) to an equirectangular picture. The centre is straight
/// ahead, the rim of the inscribed circle straight behind, and the distance from the centre is the
/// angle from ahead. Texels outside the circle are ignored.
///
/// The rows keep the map's radial resolution, 2π/width. Near the rim the map's resolution around
/// the circle grows without bound; there the lookups average.
pub(crate) fn from_angular(map: &Picture) -> Picture {
    let side = map.cols as f64;
    let inside = |r: usize, c: usize| {
        let unit = |i: usize| (2.0 * i as f64 + 1.0) / side - 1.0;
        unit(r).hypot(unit(c)) <= 1.0
    };
    resample(map.cols.div_ceil(2), |[x, y, z]| {
        let (right, up) = (-y, z);
        let across = right.hypot(up);
        let radius = if across > 0.0 { across.atan2(x) / PI / across } else { 0.0 };
        let radius = [radius * right, radius * up];
        // Straight behind is the whole rim; any point of it will do.
        let [u, v] = if across == 0.0 && x < 0.0 { [1.0, 0.0] } else { radius };
        let (c0, c1, fx) = taps((1.0 + u) / 2.0 * side, map.cols);
        let (r0, r1, fy) = taps((1.0 - v) / 2.0 * side, map.rows);
        let corners = [
            (r0, c0, (1.0 - fx) * (1.0 - fy)),
            (r0, c1, fx * (1.0 - fy)),
            (r1, c0, (1.0 - fx) * fy),
            (r1, c1, fx * fy),
        ];
        let nearest = if fy < 0.5 { r0 } else { r1 } * map.cols + if fx < 0.5 { c0 } else { c1 };
        let reference = corners
            .iter()
            .filter(|(r, c, _)| inside(*r, *c))
            .max_by(|a, b| a.2.total_cmp(&b.2))
            .map_or(nearest, |(r, c, _)| r * map.cols + c);
        let reference = map.texels[reference].map(f64::from);
        // Differences to one texel, so that a constant stays exactly constant.
        let (mut sum, mut weights) = ([0.0; 3], 0.0);
        for (r, c, weight) in corners.into_iter().filter(|(r, c, _)| inside(*r, *c)) {
            let texel = map.texels[r * map.cols + c];
            sum = [0, 1, 2].map(|i| sum[i] + weight * (f64::from(texel[i]) - reference[i]));
            weights += weight;
        }
        [0, 1, 2].map(|i| reference[i] + if weights > 0.0 { sum[i] / weights } else { 0.0 })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(side: usize, value: [f32; 3]) -> Picture {
        Picture { rows: side, cols: side, texels: vec![value; side * side] }
    }

    /// The value at the centre of the texel in a world direction.
    fn fetched(picture: &Picture, [x, y, z]: [f64; 3]) -> [f32; 3] {
        let col = (PI - y.atan2(x)) / (2.0 * PI) * picture.cols as f64;
        let row = x.hypot(y).atan2(z) / PI * picture.rows as f64;
        let row = (row as usize).min(picture.rows - 1);
        picture.texels[row * picture.cols + col as usize % picture.cols]
    }

    /// ∫ L max(N·e, 0) de / π over an equirectangular picture, with the exact area of each texel
    /// and the direction of its centre.
    fn irradiance(picture: &Picture, n: [f64; 3]) -> f64 {
        let mut sum = 0.0;
        for row in 0..picture.rows {
            let edge = |r: usize| (PI * r as f64 / picture.rows as f64).cos();
            let area = (edge(row) - edge(row + 1)) * 2.0 * PI / picture.cols as f64;
            let zenith = PI * (row as f64 + 0.5) / picture.rows as f64;
            for col in 0..picture.cols {
                let azimuth = PI - 2.0 * PI * (col as f64 + 0.5) / picture.cols as f64;
                let (s, c) = zenith.sin_cos();
                let cosine = n[0] * s * azimuth.cos() + n[1] * s * azimuth.sin() + n[2] * c;
                let value = f64::from(picture.texels[row * picture.cols + col][1]);
                sum += value * cosine.max(0.0) * area / PI;
            }
        }
        sum
    }

    #[test]
    fn constants_stay_exactly_constant() {
        let value = [0.1, 1.7e-3, 65504.0];
        let faces = [0; 6].map(|_| flat(5, value));
        assert!(from_cube(&faces).texels.iter().all(|t| *t == value));
        let mut probe = flat(9, value);
        // Texels outside the circle may hold anything.
        probe.texels[0] = [f32::NAN; 3];
        assert!(from_angular(&probe).texels.iter().all(|t| *t == value));
    }

    #[test]
    fn each_face_is_where_the_convention_puts_it() {
        let faces: Vec<Picture> = (1..=6).map(|i| flat(4, [i as f32; 3])).collect();
        let faces: [Picture; 6] = faces.try_into().ok().unwrap();
        let picture = from_cube(&faces);
        for (direction, face) in [
            ([0.0, -1.0, 0.0], 1.0),
            ([0.0, 1.0, 0.0], 2.0),
            ([0.0, 0.0, 1.0], 3.0),
            ([0.0, 0.0, -1.0], 4.0),
            ([1.0, 0.0, 0.0], 5.0),
            ([-1.0, 0.01, 0.0], 6.0),
        ] {
            assert_eq!(fetched(&picture, direction), [face; 3], "{direction:?}");
        }
        // Within the face ahead, the top left quarter is left (north, +y) and up.
        let mut faces = faces.map(|f| flat(16, f.texels[0]));
        (0..64).for_each(|i| faces[4].texels[i / 8 * 16 + i % 8] = [9.0; 3]);
        let picture = from_cube(&faces);
        assert_eq!(fetched(&picture, [1.0, 0.5, 0.5]), [9.0; 3]);
        assert_eq!(fetched(&picture, [1.0, -0.5, 0.5]), [5.0; 3]);
        assert_eq!(fetched(&picture, [1.0, 0.5, -0.5]), [5.0; 3]);
    }

    #[test]
    fn crosses_fold_to_the_same_cube() {
        let n = 3;
        let value = |face: usize, i: usize| [(face * 100 + i) as f32; 3];
        let face = |f: usize| Picture {
            rows: n,
            cols: n,
            texels: (0..n * n).map(|i| value(f, i)).collect(),
        };
        let faces = [0, 1, 2, 3, 4, 5].map(face);
        let cross = |rows: usize, cols: usize, places: [(usize, usize); 6], turned: bool| {
            let mut texels = vec![[f32::NAN; 3]; rows * cols * n * n];
            for (f, (r, c)) in places.into_iter().enumerate() {
                for i in 0..n * n {
                    let from = if f == 5 && turned { n * n - 1 - i } else { i };
                    texels[(r * n + i / n) * cols * n + c * n + i % n] = value(f, from);
                }
            }
            Picture { rows: rows * n, cols: cols * n, texels }
        };
        let expected = from_cube(&faces).texels;
        let horizontal = cross(3, 4, [(1, 2), (1, 0), (0, 1), (2, 1), (1, 1), (1, 3)], false);
        assert_eq!(from_cross(&horizontal).texels, expected);
        let vertical = cross(4, 3, [(1, 2), (1, 0), (0, 1), (2, 1), (1, 1), (3, 1)], true);
        assert_eq!(from_cross(&vertical).texels, expected);
    }

    #[test]
    fn a_bright_patch_of_a_cube_keeps_its_irradiance() {
        // A patch of 4 × 4 texels of 1000 on the face above, off its centre. The ground truth is
        // the sum over 64 × 64 points per texel of dA / (1 + u² + v²)^1.5 (solid angle) times the
        // cosine 1/√(1 + u² + v²), over π.
        let (n, from) = (32, 20);
        let mut faces = [0; 6].map(|_| flat(n, [0.0; 3]));
        let (mut expected, fine) = (0.0, 64);
        for r in from..from + 4 {
            for c in from..from + 4 {
                faces[2].texels[r * n + c] = [1000.0; 3];
                for k in 0..fine * fine {
                    let unit = |i: usize, k: usize| {
                        2.0 * (i as f64 + (k as f64 + 0.5) / fine as f64) / n as f64 - 1.0
                    };
                    let (u, v) = (unit(c, k % fine), unit(r, k / fine));
                    let area = (2.0 / (n * fine) as f64).powi(2);
                    expected += 1000.0 * area / (1.0 + u * u + v * v).powi(2) / PI;
                }
            }
        }
        let got = irradiance(&from_cube(&faces), [0.0, 0.0, 1.0]);
        assert!((got / expected - 1.0).abs() < 0.01, "{got} for {expected}");
    }

    #[test]
    fn a_bright_patch_of_an_angular_map_keeps_its_irradiance() {
        // Texels at (u, v), radius ρ: angle πρ from ahead, solid angle π sin(πρ)/ρ du dv.
        let (n, from) = (64, 12);
        let mut map = flat(n, [0.0; 3]);
        let (mut expected, fine) = (0.0, 32);
        for r in from..from + 5 {
            for c in 34..39 {
                map.texels[r * n + c] = [1000.0; 3];
                for k in 0..fine * fine {
                    let unit = |i: usize, k: usize| {
                        2.0 * (i as f64 + (k as f64 + 0.5) / fine as f64) / n as f64 - 1.0
                    };
                    let (u, v) = (unit(c, k % fine), -unit(r, k / fine));
                    let rho = u.hypot(v);
                    let up = (PI * rho).sin() * v / rho;
                    let solid = PI * (PI * rho).sin() / rho * (2.0 / (n * fine) as f64).powi(2);
                    expected += 1000.0 * up.max(0.0) * solid / PI;
                }
            }
        }
        let got = irradiance(&from_angular(&map), [0.0, 0.0, 1.0]);
        assert!((got / expected - 1.0).abs() < 0.01, "{got} for {expected}");
        // Ahead is the centre, up the upper half, right (south, -y) the right half.
        let n = 32;
        let mut map = flat(n, [0.0; 3]);
        for (i, texel) in map.texels.iter_mut().enumerate() {
            let (row, col) = (i / n, i % n);
            let centre = (12..20).contains(&row) && (12..20).contains(&col);
            *texel = [f32::from(centre), f32::from(row < n / 2), f32::from(col >= n / 2)];
        }
        let picture = from_angular(&map);
        for (direction, value) in [
            ([1.0, -0.4, 0.4], [1.0, 1.0, 1.0]),
            ([1.0, 0.4, -0.4], [1.0, 0.0, 0.0]),
            ([0.0, -1.0, -0.3], [0.0, 0.0, 1.0]),
            ([0.0, 0.3, 1.0], [0.0, 1.0, 0.0]),
        ] {
            assert_eq!(fetched(&picture, direction), value, "{direction:?}");
        }
    }
}

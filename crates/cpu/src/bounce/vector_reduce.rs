//! One level of the pyramid of exit radiance as SH series: [`shade_reduce`](crate::shade_reduce) applied to each
//! coefficient.

use crate::shade_reduce::shade_reduce;
use crate::specular_gather::Series;
use ridgelight::plan::pyramid::Pyramid;

/// Series of level `number` from those of the grid points and of the texels of the levels before it.
pub fn vector_reduce(
    exit: &[Series],
    pyramid: &Pyramid,
    number: u32,
    texels: &[Series],
) -> Vec<Series> {
    let count = exit[0].len();
    let of = |all: &[Series], i: usize| all.iter().map(|s| s[i]).collect::<Vec<_>>();
    let each: Vec<_> =
        (0..count).map(|i| shade_reduce(&of(exit, i), pyramid, number, &of(texels, i))).collect();
    (0..each[0].len()).map(|texel| each.iter().map(|c| c[texel]).collect()).collect()
}

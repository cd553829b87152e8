//! The decoder of reflectance as harmonics, for every order: harmonics of directions, and sums of their products.

use glam::DVec3;
use ridgelight::basis::MAX_ORDER;
use ridgelight::basis::harmonics::evaluate;
use ridgelight_bake as bake;

use super::turns::{none, texture, whole};
use super::{Decoder, decode, decoder};
use crate::Device;

/// As in the shader.
fn direction(n: usize, terms: usize) -> DVec3 {
    let z = (n as f64 + 0.5) / terms as f64;
    let t = (2.0 * n as f64 - terms as f64) / 4.0;
    let across = (1.0 - z * z).sqrt() / (1.0 + t * t);
    DVec3::new(across * (1.0 - t * t), across * 2.0 * t, z)
}

/// The decoder's recurrences without signs: the scale of its roundings.
fn majorant(order: usize, e: DVec3) -> Vec<f64> {
    let mut all = vec![0.0; order * order];
    let (x, y) = (e.x.abs(), e.y.abs());
    let mut turn = (0.282_094_792, 0.0);
    for m in 0..order {
        let (mut own, mut below, mut root) = (if m == 0 { 1.0 } else { 2_f64.sqrt() }, 0.0, 0.0);
        for l in m..order {
            all[l * (l + 1) - m] = own * turn.1;
            all[l * (l + 1) + m] = own * turn.0;
            let k = (l + 1) as f64;
            let next = ((k * k - (m * m) as f64) / (4.0 * k * k - 1.0)).sqrt();
            (own, below, root) = ((e.z.abs() * own + root * below) / next, own, next);
        }
        let scale = ((2 * m + 3) as f64 / (2 * m + 2) as f64).sqrt();
        turn = (scale * (turn.0 * x + turn.1 * y), scale * (turn.0 * y + turn.1 * x));
    }
    all
}

/// Each of at most n steps along l and n along m divides, takes a root and rounds four sums and products, 3 + 3 + 4
/// units; a direction's components err by 8, and a harmonic is of degree n - 1 in them. Those are shares of the
/// recurrences without signs. A sum over pairs rounds three times a pair besides.
#[test]
fn harmonics_are_those_of_the_library() {
    let device = Device::new();
    let gpu = device.gpu.as_ref().expect("alive");
    let decoder =
        decoder!("brdf_harmonics", "brdf-harmonics", bake::HARMONIC_WEIGHTS, false, 5, none);
    for order in 1..=MAX_ORDER {
        let terms = order * order;
        let weight =
            |light: usize, view: usize| ((light * terms + view + 1) as f64 * 0.618).fract() - 0.5;
        let map = texture([terms, terms, 1], false, |_, light, view| {
            [weight(light, view) as f32, light as f32, view as f32, 0.0]
        });
        let found = decode(gpu, &decoder, &whole(&[order, terms]), &map, 0.0);
        let unit = 1.0 / f64::from(1 << 24);
        let steps = (2 * order * 10 + 8 * order) as f64;
        let harmonics: Vec<_> = (0..terms).map(|n| evaluate(order, direction(n, terms))).collect();
        let most: Vec<_> = (0..terms).map(|n| majorant(order, direction(n, terms))).collect();
        for (row, col) in (0..terms * terms).map(|i| (i / terms, i % terms)) {
            let got = |plane: usize| f64::from(found[(plane * terms + row) * terms + col]);
            assert_eq!([got(1), got(2)], [row as f64, col as f64], "order {order}");
            assert!((got(0) - weight(row, col)).abs() <= unit, "order {order}: {row} {col}");
            let off = (got(3) - harmonics[row][col]).abs();
            let allowed = steps * unit * most[row][col];
            assert!(off <= allowed, "order {order}: harmonic {col} of {row}: {off} of {allowed}");
            let (mut sum, mut all) = (0.0, 0.0);
            for (i, j) in (0..terms * terms).map(|k| (k / terms, k % terms)) {
                sum += weight(i, j) * harmonics[row][i] * harmonics[col][j];
                all += weight(i, j).abs() * most[row][i] * most[col][j];
            }
            let off = (got(4) - sum).abs();
            let allowed = (2.0 * steps + 3.0 * (terms * terms) as f64) * unit * all;
            assert!(off <= allowed, "order {order}: pair {row} {col}: {off} of {allowed}");
        }
    }
}

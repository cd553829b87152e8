use crate::{ORDERS, direction, noise, project_whole, within};
use glam::DVec3;
use ridgelight::basis::product::{light_matrix, triples};
use ridgelight::basis::zonal;
use ridgelight_cpu::basis::product;
use ridgelight_cpu::basis::rotate_z;
use ridgelight_cpu::basis::{reconstruct, turned};
use std::f64::consts::PI;

/// The numbers of distinct and of nonzero products match those of an independent quadrature.
#[test]
fn few_are_not_0() {
    for (order, distinct) in [(1, 1), (2, 4), (3, 25), (4, 77), (5, 238), (6, 549)] {
        let triples = triples(order);
        assert_eq!(triples.len(), distinct, "order {order}");
        assert!(triples.iter().all(|t| t.value.abs() > 1e-3), "order {order}");
        assert!(triples.iter().all(|t| t.places.is_sorted() && t.places[2] < order * order));
    }
    // Y_0 is 1/√4π: with it a product is the other factor times that.
    let y0 = 1.0 / (4.0 * PI).sqrt();
    for triple in triples(6).iter().filter(|t| t.places[0] == 0) {
        assert_eq!(triple.places[1], triple.places[2]);
        within(&[triple.value], &[y0], 1e-15);
    }
}

/// Two functions multiplied point by point, and projected by quadrature.
#[test]
fn products_are_the_functions() {
    for order in ORDERS {
        let (a, b) = (noise(5, order * order), noise(6, order * order));
        let direct = project_whole(order, |t, p| {
            reconstruct(&a, direction(t, p)) * reconstruct(&b, direction(t, p))
        });
        let got = product(&triples(order), &a, &b);
        within(&got, &direct, 1e-12);
        within(&product(&triples(order), &b, &a), &got, 1e-14);
    }
}

/// The product of turned functions is their turned product.
#[test]
fn products_turn_with_their_factors() {
    let (a, b) = (noise(7, 25), noise(8, 25));
    let triples = triples(5);
    let turned = product(&triples, &rotate_z(&a, 0.9), &rotate_z(&b, 0.9));
    within(&turned, &rotate_z(&product(&triples, &a, &b), 0.9), 1e-13);
}

/// The light's matrix gives the product with any receiver; it is symmetric.
#[test]
fn a_lights_matrix_is_its_product() {
    for order in ORDERS {
        let triples = triples(order);
        let (light, visible) = (noise(9, order * order), noise(10, order * order));
        let matrix = light_matrix(&triples, &light);
        let by_matrix: Vec<f64> =
            matrix.iter().map(|row| row.iter().zip(&visible).map(|(m, v)| m * v).sum()).collect();
        within(&by_matrix, &product(&triples, &light, &visible), 1e-13);
        for (i, row) in matrix.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                assert_eq!(entry.to_bits(), matrix[j][i].to_bits(), "{i} {j}");
            }
        }
    }
}

/// Σ Γ L V H: a sky of radiance 1 through a free half-space, on a flat diffuse receiver, is 1 up to the bands beyond
/// order 4, whichever two are multiplied first.
#[test]
fn light_through_visibility_on_a_receiver() {
    let up = |zonal: Vec<f64>| turned(&zonal, DVec3::Z);
    let (sky, visible) = (up(ridgelight_cpu::basis::sky(4)), up(ridgelight_cpu::basis::sky(4)));
    let cosine = up(zonal::clamped_cosine(4));
    let triples = triples(4);
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>() / PI;
    let exit = dot(&product(&triples, &sky, &visible), &cosine);
    within(&[dot(&product(&triples, &visible, &cosine), &sky)], &[exit], 1e-14);
    assert!((exit - 1.0).abs() < 0.05, "{exit}");
}

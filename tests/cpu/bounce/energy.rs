//! Conservation of energy, linearity and symmetry of indirect light.

use ridgelight::scene::{Albedo, Border, Environment, Lights};
use ridgelight_cpu::indirect::{Fineness, smooth_light};
use ridgelight_cpu::light::sky_of;
use ridgelight_cpu::oracle::Oracle;

use super::{COARSE, red, reds, rough, under_sky};
use crate::{BORDERS, field};

/// White ground under a white sky, flat: 1, whatever border, size and bounces.
#[test]
fn a_flat_furnace_is_one() {
    for (rows, cols) in [(1, 1), (1, 4), (4, 1), (2, 3), (5, 5)] {
        for border in BORDERS {
            let flat = field(rows, cols, [1.0, 3.0], |_, _| 100.0);
            for divisions in [1, 2] {
                let pictures = reds(
                    &under_sky(flat.clone(), border, 1.0),
                    3,
                    Fineness { divisions, ..COARSE },
                );
                for v in pictures.concat() {
                    assert!((v - 1.0).abs() < 1e-14, "{rows} × {cols} {border:?} {v}");
                }
            }
        }
    }
}

/// Bounce 0 is the sky of `cpu::light`, which finds horizons differently. Its m azimuths begin at 0 and these
/// lie between them, so both together are its 2m: this = 2·sky(2m) - sky(m), but for the scale to a whole
/// hemisphere, e^(-m·asinh(1/slope)) at slopes up to 3, below 1e-9 for 64.
#[test]
fn bounce_0_is_direct_sky_light() {
    for border in BORDERS {
        let field = rough(6, 7, [1.0, 1.5], 1.5);
        let scene = under_sky(field.clone(), border, 1.0);
        let ours = reds(&scene, 0, Fineness { azimuths: 64, ..COARSE }).remove(0);
        for (i, ours) in ours.iter().enumerate() {
            let theirs = |m| sky_of(&Oracle::one_ray(&field, border), i / 7, i % 7, m);
            let expected = 2.0 * theirs(128) - theirs(64);
            assert!((ours - expected).abs() < 1e-9, "{border:?} {i}: {ours} {expected}");
        }
    }
}

/// White rough ground under a white sky rises monotonically to 1. Under `open` and `periodic` no direction is
/// black. Each bounce leaves at most 1 - (the least share of sky) of the missing light; that share is above 0.1
/// here, and 0.9^200 is 7e-10.
#[test]
fn a_rough_furnace_tends_to_one() {
    for (border, divisions) in [(Border::Open, 1), (Border::Open, 2), (Border::Periodic, 1)] {
        let scene = under_sky(rough(6, 5, [1.0, 1.5], 1.5), border, 1.0);
        let pictures = reds(&scene, 200, Fineness { divisions, ..COARSE });
        for pair in pictures.windows(2) {
            assert!(pair[0].iter().zip(&pair[1]).all(|(a, b)| a <= b && *b <= 1.0 + 1e-12));
        }
        assert!(pictures[0].iter().all(|v| *v > 0.1));
        assert!(pictures[200].iter().all(|v| *v > 1.0 - 1e-9), "{border:?}");
    }
}

/// The same with smooth normals. The least share of sky is that of the grid points' normals, which
/// `pictures[0]` holds.
#[test]
fn a_smooth_furnace_tends_to_one() {
    for border in [Border::Open, Border::Periodic] {
        let scene = under_sky(rough(6, 5, [1.0, 1.5], 1.5), border, 1.0);
        let pictures = smooth_light(&scene, 200, COARSE.azimuths, COARSE.strips).unwrap();
        let pictures: Vec<_> = pictures.iter().map(red).collect();
        for pair in pictures.windows(2) {
            assert!(pair[0].iter().zip(&pair[1]).all(|(a, b)| a <= b && *b <= 1.0 + 1e-12));
        }
        assert!(pictures[0].iter().all(|v| *v > 0.1));
        assert!(pictures[200].iter().all(|v| *v > 1.0 - 1e-9), "{border:?}");
    }
}

/// Under `plane` directions below horizontal are black at every bounce: a tilted plane has (1 + cos tilt)/2 and
/// no indirect light. Rule over azimuths: half a squared step, as the slice's slope is continuous.
#[test]
fn a_tilted_plane_misses_what_is_below_horizontal() {
    for (east, north) in [(0.75, 0.0), (-1.0, 0.5)] {
        let tilted = field(5, 5, [1.0, 1.0], |r, c| east * c as f64 - north * r as f64);
        let scene = under_sky(tilted, Border::Plane, 1.0);
        let pictures = reds(&scene, 2, Fineness { azimuths: 128, ..COARSE });
        let cos_tilt = 1.0 / (1.0 + east * east + north * north).sqrt();
        let tolerance = 0.5 * (std::f64::consts::TAU / 128.0_f64).powi(2);
        assert!((pictures[0][12] - 0.5 * (1.0 + cos_tilt)).abs() < tolerance);
        assert!((pictures[2][12] - pictures[0][12]).abs() < 1e-12);
    }
}

/// Half a turn, and a flip over the cells' diagonal, keep the split of the cells, the circle of azimuths and so
/// every sum but for rounding: the two kinds of triangle change places.
#[test]
fn half_a_turn_and_a_flip_change_nothing() {
    let n = 5;
    let original = rough(n, n, [1.0, 1.0], 4.0);
    let h = |r: usize, c: usize| f64::from(original.heights_m()[r * n + c]);
    for border in BORDERS {
        let of =
            |field| reds(&under_sky(field, border, 0.9), 2, Fineness { divisions: 2, ..COARSE });
        let straight = of(original.clone());
        let turned = of(field(n, n, [1.0, 1.0], |r, c| h(n - 1 - r, n - 1 - c)));
        let flipped = of(field(n, n, [1.0, 1.0], |r, c| h(c, r)));
        for b in 0..=2 {
            for (i, here) in straight[b].iter().enumerate() {
                let (r, c) = (i / n, i % n);
                let there = turned[b][(n - 1 - r) * n + n - 1 - c];
                // Heights of the divided field are rounded to f32: 6e-8 of relief 4 over half a cell.
                assert!((here - there).abs() < 1e-5, "{border:?} {b} {r} {c}: {here} {there}");
                assert!((here - flipped[b][c * n + r]).abs() < 1e-5, "{border:?} {b} {r} {c}");
            }
        }
    }
}

/// Half a turn keeps smooth light, too, on a field that is not square and under an albedo map: each corner has the
/// radiance of its own grid point. Only rounding is left.
#[test]
fn half_a_turn_keeps_smooth_light() {
    let (rows, cols) = (4, 6);
    let original = rough(rows, cols, [1.0, 1.0], 4.0);
    let last = rows * cols - 1;
    let of = |turned: bool| {
        let from = |i: usize| if turned { last - i } else { i };
        let heights = |r: usize, c: usize| f64::from(original.heights_m()[from(r * cols + c)]);
        let mut scene = under_sky(field(rows, cols, [1.0, 1.0], heights), Border::Open, 1.0);
        let albedo = (0..=last).map(|i| [(from(i) * 7 % 11) as f32 / 10.0; 3]).collect();
        scene.surface.albedo = Albedo::Map(albedo);
        smooth_light(&scene, 2, 16, 1).unwrap()
    };
    let (straight, turned) = (of(false), of(true));
    for (straight, turned) in straight.iter().zip(&turned) {
        for (i, here) in straight.iter().enumerate() {
            let there = turned[last - i];
            assert!((here[0] - there[0]).abs() < 1e-9, "{i}: {here:?} {there:?}");
        }
    }
}

/// Each channel has its own albedo, at the texel and at the ground it sees.
#[test]
fn channels_do_not_mix() {
    let map: Vec<[f32; 3]> =
        (0..36_u8).map(|i| [1.0, f32::from(i % 5) / 4.0, f32::from(i % 7) / 6.0]).collect();
    let of = |map: Vec<[f32; 3]>| {
        let mut scene = under_sky(rough(6, 6, [1.0, 1.0], 4.0), Border::Plane, 1.0);
        scene.surface.albedo = Albedo::Map(map);
        ridgelight_cpu::indirect::light(&scene, 1, COARSE).unwrap().remove(1)
    };
    let together = of(map.clone());
    for i in 0..3 {
        let alone = of(map.iter().map(|albedo| [albedo[i]; 3]).collect());
        assert!(together.iter().zip(&alone).all(|(t, a)| t[i] == a[0]));
    }
}

/// However steep the ground, for albedo up to 1 and any border, no texel is brighter than the sky.
#[test]
fn no_energy_is_gained() {
    for border in BORDERS {
        for relief in [1e-6, 1.0, 30.0, 1e6] {
            let mut scene = under_sky(rough(5, 6, [1.0, 1.0], relief), border, 1.0);
            scene.surface.albedo =
                Albedo::Map((0..30).map(|i| [1.0, (i % 5) as f32 / 4.0, 0.5]).collect());
            let pictures = ridgelight_cpu::indirect::light(&scene, 30, COARSE).unwrap();
            for v in pictures.concat().as_flattened() {
                assert!((0.0..=1.0 + 1e-12).contains(v), "{border:?} {relief} {v}");
            }
        }
    }
}

/// Bounce b carries albedo b + 1 times; the light of two sources is the sum of each one's.
#[test]
fn light_is_linear() {
    let rough = || rough(6, 6, [1.0, 1.0], 4.0);
    let part = |albedo, b: usize| {
        let p = reds(&under_sky(rough(), Border::Plane, albedo), 3, COARSE);
        let before = if b > 0 { p[b - 1].clone() } else { vec![0.0; 36] };
        p[b].iter().zip(before).map(|(a, b)| a - b).collect::<Vec<f64>>()
    };
    for b in 0..=3 {
        for (half, quarter) in part(0.5, b).iter().zip(part(0.25, b)) {
            assert!((half / 2_f64.powi(b as i32 + 1) - quarter).abs() < 1e-14);
        }
    }
    let of = |lights| {
        let mut scene = under_sky(rough(), Border::Plane, 0.7);
        scene.lights = lights;
        reds(&scene, 2, COARSE).remove(2)
    };
    let env = Environment::new(4, 4, (0..16).map(|i| [i as f32; 3]).collect(), 0.4).unwrap();
    let [sky, environment] = [
        Lights { sky: Some([2.0; 3]), ..Lights::default() },
        Lights { environment: Some(env), ..Lights::default() },
    ];
    let both = Lights { sky: sky.sky, ..environment.clone() };
    let (sky, environment, both) = (of(sky), of(environment), of(both));
    for i in 0..36 {
        assert!((sky[i] + environment[i] - both[i]).abs() < 1e-12);
    }
}

//! Steps of scattered light.

use glam::DVec3;
use ridgelight::gpu::shaders::offset;
use ridgelight::plan::Pass;
use ridgelight::scene::{Curvature, Directions, VisiblePoint, VisiblePoints};
use ridgelight_cpu::scatter_gather::{Gathered, GridPoints};
use ridgelight_cpu::tolerance::{EPSILON, Land, gathered};

use super::towards;
use crate::cpu_reference::{Pair, Run, constant, pushed};

/// A value and its error.
#[derive(Clone, Copy, Default)]
struct Sum {
    light: [f64; 3],
    off: [f64; 3],
}

impl Sum {
    fn add(&mut self, light: [f64; 3], off: [f64; 3]) {
        for c in 0..3 {
            self.light[c] += light[c];
            self.off[c] += off[c] + 2.0 * EPSILON * self.light[c];
        }
    }
}

/// One look-up after the other as in the CPU reference, from the device's inputs.
pub(crate) fn scatter_gather(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let [first_link, steps, step, first_path, paths, first_sun, suns, first_view] = [
        const { offset("ScatterGatherPush", "first_link") },
        const { offset("ScatterGatherPush", "steps") },
        const { offset("ScatterGatherPush", "step") },
        const { offset("ScatterGatherPush", "first_path") },
        const { offset("ScatterGatherPush", "paths") },
        const { offset("ScatterGatherPush", "first_sun") },
        const { offset("ScatterGatherPush", "suns") },
        const { offset("ScatterGatherPush", "first_view") },
    ]
    .map(|o| pushed(pass, o) as usize);
    let weight =
        f64::from(f32::from_bits(pushed(pass, const { offset("ScatterGatherPush", "weight_sr") })));
    let (source, sums) = (constant(pass, "source"), constant(pass, "sums") == 1);
    let direct_specular = paths > 0 && constant(pass, "direct_specular") == 1;
    let points = run.points.clone().expect("a case with points");
    let texel = |i: usize| -> [f64; 4] {
        std::array::from_fn(|c| f64::from(run.plan.constants[4 * i + c]))
    };
    let vector = |t: [f64; 4]| DVec3::new(t[0], t[1], t[2]);
    let links: Vec<_> = (0..paths)
        .map(|path| {
            let at = first_link + 2 * (path * steps + step);
            let back = if sums { DVec3::ZERO } else { -vector(texel(at - 2)) };
            let [ahead, sky] = [at, at + 1].map(texel);
            (vector(ahead), ahead[3] as usize, [sky[0], sky[1], sky[2]], back)
        })
        .collect();
    // After the last step each view in turn.
    let views = if sums && paths > 0 { pass.groups[2] as usize } else { 1 };
    let of_views: Vec<_> = match sums && paths > 0 {
        true => (0..views).map(|view| vector(texel(first_view + view))).collect(),
        false => vec![DVec3::ZERO],
    };
    let shining: Vec<_> = (0..suns)
        .map(|i| [first_sun + 2 * i, first_sun + 2 * i + 1].map(texel))
        .map(|[e, light]| (vector(e), [light[0], light[1], light[2]]))
        .collect();
    let colours = |words: Option<Vec<f32>>| -> Vec<[f64; 3]> {
        let texels = words.unwrap_or_default();
        texels.chunks_exact(4).map(|t| [t[0], t[1], t[2]].map(f64::from)).collect()
    };
    let direct = colours(run.floats(pass, "direct"));
    let carried = if source == 2 { colours(run.floats(pass, "carried_in")) } else { Vec::new() };
    let sun_points = (suns > 0).then(|| {
        let e = run.scene.lights.suns.iter().map(towards).collect();
        let directions = Directions::from_vectors(e, -1.0).expect("unit vectors");
        let words = run.words(pass, "sun_points").expect("written");
        VisiblePoints::new(&run.scene.field, run.border(), directions, words).expect("whole")
    });
    let written = if sums { "scattered" } else { "carried" };
    let got = run.floats(pass, written).expect("written");
    if paths == 0 {
        let pair = |(i, got): (usize, f32)| Pair {
            got: got.into(),
            want: 0.0,
            tolerance: 0.0,
            at: [0, 0, i],
        };
        return got.into_iter().enumerate().map(pair).collect();
    }
    let curvature = Curvature {
        per_m: [
            const { offset("ScatterGatherPush", "curvature_x") },
            const { offset("ScatterGatherPush", "curvature_y") },
        ]
        .map(|o| f64::from(f32::from_bits(pushed(pass, o)))),
    };
    let grid_points = GridPoints::of(run.scene).on(curvature);
    // On a curved base, the device's own directions and weights.
    let bent = (curvature != Curvature::FLAT).then(|| {
        let aimed = super::curved::at_texels(run, pass, points.directions().count());
        (aimed, run.floats(pass, "fan_weights").expect("bound"))
    });
    let [cols, rows] = run.size();
    let count = rows * cols;
    let mut before = std::mem::take(&mut run.scattered);
    before.resize(views * count, ([0.0; 3], [0.0; 3]));
    let mut pairs = Vec::new();
    for texel_at in 0..views * count {
        let (view, at) = (texel_at / count, texel_at % count);
        let here = [at / cols, at % cols];
        // Slopes of a field that is scaled by s in height turn by as much as before, s or 1/s times; a quotient and a
        // sum more.
        let height = f64::from(run.scene.field.heights_m()[at]);
        let interval = curvature.per_m.map(|k| (1.0 + k * height).max(1.0 / (1.0 + k * height)));
        let flat = Land::normal_at(&run.scene.field, run.border(), here);
        let turned = match &bent {
            None => flat,
            Some(_) => interval[0].max(interval[1]) * (flat + 8.0 * EPSILON),
        };
        let n = grid_points.specular(at).map_or(1.0, |phong| f64::from(phong.exponent));
        let off = |of: &Gathered, e: DVec3| {
            let mut off = gathered(of, n, turned);
            // A lobe ends at the texel's own plane.
            if grid_points.normal(at).dot(e).abs() <= turned + 6.0 * EPSILON {
                off = [0, 1, 2].map(|c| off[c] + of.mirrored[c]);
            }
            off
        };
        let mut sum = Sum::default();
        for (path, (e, direction, sky, back)) in links.iter().enumerate() {
            let visible = points.point(*direction, at);
            let arrives = match (visible, source) {
                (VisiblePoint::GridPoint(there), 1) => direct[there],
                (VisiblePoint::GridPoint(there), 2) => carried[path * count + there],
                _ => [0.0; 3],
            };
            let back = if sums { &of_views[view] } else { back };
            let shows_sky = (!sums || direct_specular) && visible == VisiblePoint::Sky;
            let mirrored = if shows_sky { *sky } else { arrives };
            let (e, weight) = match &bent {
                None => (*e, weight),
                Some((aimed, weights)) => {
                    (aimed[at][*direction].0, weight * f64::from(weights[direction * count + at]))
                }
            };
            let of = grid_points.scattered(at, (e, weight), *back, [arrives, mirrored]);
            let mut of_path = Sum::default();
            of_path.add(of.light, off(&of, e));
            if !sums {
                of_path.add(direct[at], [0.0; 3]);
            }
            if !sums || direct_specular {
                for (i, (e, irradiance)) in shining.iter().enumerate() {
                    let lit = sun_points.as_ref().expect("suns").point(i, at) == VisiblePoint::Sky;
                    if lit {
                        let of =
                            grid_points.scattered(at, (*e, 1.0), *back, [[0.0; 3], *irradiance]);
                        of_path.add(of.light, off(&of, *e));
                    }
                }
            }
            if !sums {
                let texel = 4 * (path * count + at);
                for c in 0..3 {
                    let (want, tolerance) = (of_path.light[c], of_path.off[c]);
                    let got = got[texel + c].into();
                    pairs.push(Pair { got, want, tolerance, at: [path, here[0], here[1]] });
                }
            }
            sum.add(of_path.light, of_path.off);
        }
        if sums {
            // The mean of those before and these; a difference, a quotient, a sum.
            let (old, old_off) =
                if first_path > 0 { before[texel_at] } else { ([0.0; 3], [0.0; 3]) };
            let all = (first_path + paths) as f64;
            let mean = [0, 1, 2].map(|c| (first_path as f64 * old[c] + sum.light[c]) / all);
            let tolerance = [0, 1, 2].map(|c| {
                (first_path as f64 * old_off[c] + sum.off[c]) / all
                    + 12.0 * EPSILON * (old[c] + sum.light[c] / all)
            });
            before[texel_at] = (mean, tolerance);
            for c in 0..3 {
                let got = got[4 * texel_at + c].into();
                let (want, tolerance) = (mean[c], tolerance[c]);
                pairs.push(Pair { got, want, tolerance, at: [3 * view + c, here[0], here[1]] });
            }
            let counted = f64::from(got[4 * texel_at + 3]);
            pairs.push(Pair { got: counted, want: all, tolerance: 0.0, at: [3, here[0], here[1]] });
        }
    }
    run.scattered = before;
    pairs
}

//! The passes that sum light.

use std::f64::consts::PI;

use ridgelight::gpu::shaders::offset;
use ridgelight::plan::Pass;
use ridgelight::plan::azimuths::Shape;
use ridgelight::scene::{Albedo, Border, PhongSpecular, SphereLight, normal};
use ridgelight_cpu::env_tables as tables_reference;
use ridgelight_cpu::env_tables::{EnvTables, bottom_sine, wedge_of};
use ridgelight_cpu::light::Receiver;
use ridgelight_cpu::light_resolve as resolve_reference;
use ridgelight_cpu::mirror_map::{Tables, blocked, mirrored};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::shared::gather::Swept;
use ridgelight_cpu::shared::sweep::Heights;
use ridgelight_cpu::sky_shade as sky_reference;
use ridgelight_cpu::specular_tables::Tabulated;
use ridgelight_cpu::sphere_shade as sphere_reference;
use ridgelight_cpu::sun_shade as sun_reference;
use ridgelight_cpu::tolerance::{
    EPSILON, ShadeError, SphereGeometry, device_fused_slope, device_resolved, device_table,
};

use crate::cpu_reference::{Pair, Run, constant, fuse_of, pushed};
use crate::specular::cpu_reference::key::key_specular;
use crate::specular::cpu_reference::slices::{Level, Levels, table, view_from};
use crate::specular::cpu_reference::sphere;

pub(crate) type Rgb = glam::DVec3;

pub(crate) fn rgb(texel: &[f32]) -> Rgb {
    Rgb::new(texel[0].into(), texel[1].into(), texel[2].into())
}

/// Three channels of a texel.
pub(crate) fn channels(
    got: &[f32],
    want: Rgb,
    tolerance: f64,
    at: [usize; 3],
) -> impl Iterator<Item = Pair> {
    let got = rgb(got);
    (0..3).map(move |c| Pair { got: got[c], want: want[c], tolerance, at })
}

/// `wedge_rows` of the device: [azimuth][row][moment].
pub(crate) fn wedge_rows(run: &mut Run, pass: &Pass) -> Vec<[Rgb; 3]> {
    let texels = run.floats(pass, "wedge_rows").expect("bound");
    let rows = texels.chunks_exact(12);
    rows.map(|t| [rgb(t), rgb(&t[4..]), rgb(&t[8..])]).collect()
}

/// `env_tables` of the device.
fn device_tables(run: &mut Run, pass: &Pass) -> EnvTables {
    let texels = run.floats(pass, "env_tables").expect("bound");
    let [nodes, _] = run.extent(pass, "env_tables");
    let count = texels.len() / (12 * nodes);
    let alpha = |k: usize, colour: usize, node: usize| {
        f64::from(texels[((k * 3 + colour) * nodes + node) * 4 + 3])
    };
    let radiance = |i: usize| Rgb::from_array([0, 1, 2].map(|c| alpha(i / nodes, c, i % nodes)));
    EnvTables {
        nodes,
        bottom_sine: bottom_sine(run.border()),
        moments: texels.chunks_exact(4).map(rgb).collect(),
        radiances: (0..count * nodes).map(radiance).collect(),
        wedges: run.plan.azimuths[..count].iter().map(wedge_of).collect(),
    }
}

pub(crate) fn env_tables(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let rows = wedge_rows(run, pass);
    let got = device_tables(run, pass);
    let height = pushed(pass, const { offset("EnvTablesPush", "height") }) as usize;
    let count = pushed(pass, const { offset("EnvTablesPush", "azimuth_count") }) as usize;
    let wedges = (height, &run.plan.azimuths[..count]);
    let want = tables_reference::env_tables(&rows, wedges, got.nodes, got.bottom_sine);
    assert_eq!(got.moments.len(), want.moments.len());
    let (nodes, pieces) = (got.nodes, (height + got.nodes) as f64);
    let kept = rows.len() / count;
    let off = |k: usize, moment: usize| {
        let summed = rows[k * kept..(k + 1) * kept].iter().map(move |row| row[moment].abs());
        let sum: Rgb = summed.clone().sum();
        let largest = summed.fold(Rgb::ZERO, Rgb::max);
        Rgb::from_array([0, 1, 2].map(|c| device_table(sum[c], largest[c], pieces)))
    };
    let mut pairs = Vec::new();
    for (i, (got, want)) in got.moments.iter().zip(&want.moments).enumerate() {
        let (k, moment, node) = (i / (3 * nodes), i / nodes % 3, i % nodes);
        let (tolerance, at) = (off(k, moment), [k, moment, node]);
        pairs.extend([0, 1, 2].map(|c| Pair {
            got: got[c],
            want: want[c],
            tolerance: tolerance[c],
            at,
        }));
    }
    // A mean over a step sums rows times differences of sines, which err as moments do, without the π.
    let step = want.step();
    for (i, (got, want)) in got.radiances.iter().zip(&want.radiances).enumerate() {
        let (k, node) = (i / nodes, i % nodes);
        let scale = PI / (step * f64::from(wedges.1[k].wedge_rad));
        let rounded = 4.0 * EPSILON * want.abs();
        let tolerance = off(k, 2) * scale + rounded;
        pairs.extend([0, 1, 2].map(|c| Pair {
            got: got[c],
            want: want[c],
            tolerance: tolerance[c],
            at: [k, 3, node],
        }));
    }
    pairs
}

/// The azimuths of the light that a shading pass adds to, up to its own, and the error of their horizons: every batch
/// is compared as the sum so far.
pub(crate) fn so_far(
    run: &mut Run,
    pass: &Pass,
    [first, count, clears]: [usize; 3],
) -> (std::ops::Range<usize>, ShadeError) {
    let word = |offset| pushed(pass, offset) as usize;
    let (first, count) = (word(first), word(count));
    let range = run.begin_of_light(first, word(clears) == 1)..first + count;
    let [largest, relief] = run.relief();
    let steps = run.plan.azimuths[range.clone()].iter().map(|a| f64::from(a.step_m));
    let slope_error = device_fused_slope(largest, steps.fold(f64::MAX, f64::min));
    let [x, y] = run.scene.field.cell_m();
    let error = ShadeError::new(slope_error, relief, x.min(y), range.len());
    (range, error)
}

pub(crate) fn sky_shade(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const AZIMUTH_COUNT: usize = offset("ShadePush", "azimuth_count");
    const CLEARS: usize = offset("ShadePush", "clears");
    const FIRST_AZIMUTH: usize = offset("ShadePush", "first_azimuth");
    let (range, error) = so_far(run, pass, [FIRST_AZIMUTH, AZIMUTH_COUNT, CLEARS]);
    let [cols, _] = run.size();
    let at = |i: usize| [range.len(), i / cols, i % cols];
    let mut pairs = Vec::new();
    if let Some(got) = run.floats(pass, "sky_sum") {
        // Shares of ground for bounces take no horizontal for the least.
        let is_open = constant(pass, "border") == Border::Open as u32;
        let want = run.swept(range.clone(), fuse_of(pass), |swept| {
            let border = if is_open { Border::Open } else { swept.heights.border };
            let heights = Heights { border, ..swept.heights };
            sky_reference::sky_shade(&Swept { heights, ..*swept })
        });
        let tolerance = error.sky();
        pairs.extend(got.iter().zip(want).enumerate().map(|(i, (got, want))| Pair {
            got: (*got).into(),
            want,
            tolerance,
            at: at(i),
        }));
    }
    if let Some(got) = run.floats(pass, "env_sum") {
        let tables = device_tables(run, pass);
        let mut bounds = Vec::new();
        let want = run.swept(range.clone(), fuse_of(pass), |swept| {
            bounds = swept.per_grid_point(|col, row| {
                let mut bound = Rgb::ZERO;
                let right = ([Rgb::ZERO; 3], Rgb::ZERO);
                swept.add_all([col, row], true, |k, _, lowest, normal| {
                    bound += error.wedge_looked_up(&tables, (k, lowest, normal), &right);
                });
                bound
            });
            sky_reference::env_shade(swept, &tables)
        });
        for (i, ((got, want), bound)) in got.chunks_exact(4).zip(want).zip(bounds).enumerate() {
            pairs.extend([0, 1, 2].map(|c| Pair {
                got: got[c].into(),
                want: want[c],
                tolerance: bound[c],
                at: at(i),
            }));
        }
    }
    if let Some(got) = run.floats(pass, "blocked_sum") {
        pairs.extend(blocked_sum(run, pass, (&got, 0), (range.clone(), error)));
    }
    if let Some(got) = run.floats(pass, "blocked_above") {
        pairs.extend(blocked_sum(run, pass, (&got, 1), (range, error)));
    }
    pairs
}

/// What horizons hide from a lobe: each azimuth's share, from the device's own tables. Of a map, at the level of exponents at
/// or below each texel's own, or `above` it.
fn blocked_sum(
    run: &mut Run,
    pass: &Pass,
    (got, above): (&[f32], usize),
    (range, error): (std::ops::Range<usize>, ShadeError),
) -> Vec<Pair> {
    const EYE_M: usize = offset("ShadePush", "eye_m");
    const EXPONENT: usize = offset("ShadePush", "exponent");
    const LEAST_COSINE: usize = offset("ShadePush", "least_cosine");
    const LEVELS: [usize; 3] = [
        offset("ShadePush", "first_level"),
        offset("ShadePush", "level_count"),
        offset("ShadePush", "levels_per_log"),
    ];
    let float = |offset: usize| f32::from_bits(pushed(pass, offset));
    let is_map = constant(pass, "specular_is_map") == 1;
    let levels = is_map.then(|| Levels::of(run, pass, LEVELS));
    let phong = run.scene.surface.specular.clone().expect("specular");
    // Tables and least cosine of each level.
    let all: Vec<_> = match &levels {
        None => {
            let [peaks, _] = run.extent(pass, "specular_tables");
            let of = table(run, pass, float(EXPONENT).into(), [0, peaks]);
            vec![(of, f64::from(float(LEAST_COSINE)))]
        }
        Some(levels) => (0..levels.count())
            .map(|i| {
                let Level { exponent, least_cosine, peaks, .. } = levels.level(i);
                (table(run, pass, exponent, peaks), least_cosine)
            })
            .collect(),
    };
    let eye_m = [0, 1, 2, 3].map(|i| f64::from(float(EYE_M + 4 * i)));
    let [cols, _] = run.size();
    let turned = 2.0 * error.normal() + 20.0 * EPSILON;
    let off = [turned, error.lowest_slope()];
    let first = range.start;
    run.swept(range.clone(), fuse_of(pass), |swept| {
        let mut pairs = Vec::new();
        for (i, got) in got.chunks_exact(4).enumerate() {
            let (col, row) = ((i % cols) as i32, (i / cols) as i32);
            let view = view_from(&swept.heights, eye_m, i);
            let PhongSpecular { exponent, scale } = phong.at(i);
            let level = levels.as_ref().map_or(0, |levels| levels.place(exponent.into()).1[above]);
            let ((slices, texels), least) = &all[level];
            let tables = Tables { slices: *slices, texels };
            let mut sum = Tabulated::default();
            swept.add_all([col, row], true, |k, azimuth, lowest, normal| {
                // Nothing is summed where nothing is reflected.
                if scale == 0.0 {
                    return;
                }
                let mirror = mirrored(normal, view);
                let hidden = (mirror, lowest);
                // Nothing is hidden below the lowest elevation.
                if slices.bottom_rad == 0.0 && lowest <= 0.0 {
                    return;
                }
                let one = blocked(&tables, (first + k, azimuth), hidden, *least, off);
                sum.light += one.light;
                sum.tolerance += one.tolerance;
            });
            sum.tolerance += range.len() as f64 * EPSILON * sum.light;
            let at = [range.len(), i / cols, i % cols];
            let tolerance = sum.tolerance + 1e-30;
            pairs.extend((0..3).map(|c| Pair {
                got: got[c].into(),
                want: sum.light[c],
                tolerance: tolerance[c],
                at,
            }));
        }
        pairs
    })
}

pub(crate) fn sun_shade(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const AZIMUTH_COUNT: usize = offset("ShadePush", "azimuth_count");
    const CLEARS: usize = offset("ShadePush", "clears");
    const FIRST_AZIMUTH: usize = offset("ShadePush", "first_azimuth");
    let (range, error) = so_far(run, pass, [FIRST_AZIMUTH, AZIMUTH_COUNT, CLEARS]);
    let shape = [Shape::Disc, Shape::Point, Shape::Patch][constant(pass, "shape") as usize];
    let is_point = shape == Shape::Point;
    let got = run.floats(pass, "sun_sum").expect("written");
    let [cols, _] = run.size();
    let mirrored = key_specular(run, pass, &error);
    let vectors = run.vectors(pass);
    let mut pairs = run.swept(range.clone(), fuse_of(pass), |swept| {
        let tolerance = error.sun(sun_reference::weights(swept.azimuths, shape));
        // A point sun within the horizon's error may be hidden or not.
        let grazes = |col: i32, row: i32| {
            let mut any = false;
            swept.add_all([col, row], true, |_, azimuth, lowest, _| {
                let off = lowest - f64::from(azimuth.high_slope);
                any |= off.abs() <= error.lowest_slope();
            });
            is_point && any
        };
        let mut pairs = Vec::new();
        for (i, got) in got.iter().enumerate() {
            let (col, row) = ((i % cols) as i32, (i / cols) as i32);
            if !grazes(col, row) {
                let want = sun_reference::sun_at(swept, shape, col, row);
                let at = [range.len(), i / cols, i % cols];
                pairs.push(Pair { got: (*got).into(), want, tolerance, at });
                if let Some(vectors) = &vectors {
                    let want = sun_reference::vector_at(swept, col, row);
                    let tolerance = PI * tolerance;
                    let of = |c: usize| Pair { got: vectors[i][c], want: want[c], tolerance, at };
                    pairs.extend([0, 1, 2].map(of));
                }
            }
        }
        assert!(pairs.len() * 50 >= got.len() * 49, "{} of {} decided", pairs.len(), got.len());
        pairs
    });
    pairs.extend(mirrored);
    pairs
}

pub(crate) fn sphere_light_of(run: &Run, pass: &Pass) -> SphereLight {
    let name = pass.part.split(' ').next().and_then(|part| part.strip_prefix("sphere_light"));
    let number: usize = name.and_then(|n| n.parse().ok()).expect("sphere_light and its number");
    run.scene.lights.sphere_lights[number - 1]
}

/// Slices of one sphere light, paired after the last.
pub(crate) fn sphere_shade(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const LAST_SLICE: usize = offset("SphereShadePush", "last_slice");
    const RADIANCE: usize = offset("SphereShadePush", "radiance");
    const REACH_M: usize = offset("SphereShadePush", "reach_m");
    const SLICES: usize = offset("SphereShadePush", "slices");
    const SLICES_AROUND: usize = offset("SphereShadePush", "slices_around");
    sphere::begin(run, pass);
    if f32::from_bits(pushed(pass, RADIANCE + 12)) > 0.0 {
        run.sphere_lights = vec![([0.0; 3], 0.0); run.scene.field.heights_m().len()];
    }
    if pushed(pass, LAST_SLICE) < pushed(pass, SLICES_AROUND) {
        return Vec::new();
    }
    let sphere_light = sphere_light_of(run, pass);
    let reach = f64::from(f32::from_bits(pushed(pass, REACH_M)));
    let oracle = Oracle::new(&run.scene.field, run.border());
    let counts = [SLICES, SLICES_AROUND].map(|o| pushed(pass, o));
    let [cols, _] = run.size();
    let mut sphere_lights = std::mem::take(&mut run.sphere_lights);
    for (i, (sum, tolerance)) in sphere_lights.iter_mut().enumerate() {
        let visible = SphereGeometry::of(&run.scene.field, &sphere_light, i);
        if visible.distance_m > reach {
            continue;
        }
        let place = [i / cols, i % cols];
        let receivers =
            [Receiver::diffuse(normal(&run.scene.field, run.border(), place[0], place[1]))];
        let light =
            sphere_reference::sphere_with(&oracle, &sphere_light, counts, place, &receivers)[0];
        let brightest = sphere_light.radiance.iter().fold(0.0, |m: f32, v| m.max(*v));
        sum.iter_mut().zip(sphere_light.radiance).for_each(|(s, r)| *s += light * f64::from(r));
        *tolerance += f64::from(brightest) * (visible.tolerance() + 4.0 * EPSILON);
    }
    let got = run.floats(pass, "sphere_sum").expect("written");
    let texels = got.chunks_exact(4).zip(&sphere_lights).enumerate();
    let mut pairs: Vec<Pair> = texels
        .flat_map(|(i, (got, (want, tolerance)))| {
            channels(got, Rgb::from(*want), *tolerance, [0, i / cols, i % cols])
        })
        .collect();
    run.sphere_lights = sphere_lights;
    pairs.extend(sphere::specular(run, pass, &sphere_light, counts));
    pairs.extend(sphere::series(run, pass, &sphere_light, (counts, reach)));
    pairs
}

pub(crate) fn light_resolve(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const CLEARS: usize = offset("LightResolvePush", "clears");
    const COLOUR: usize = offset("LightResolvePush", "colour");
    const TEXEL: usize = offset("LightResolvePush", "texel");
    let mut colour = [0, 4, 8].map(|c| f32::from_bits(pushed(pass, COLOUR + c)));
    if constant(pass, "colour_is_texel") == 1 {
        let texels = run.floats(pass, "light_colours").expect("read");
        let texel = &texels[4 * pushed(pass, TEXEL) as usize..];
        colour = [0, 1, 2].map(|c| colour[c] * texel[c]);
    }
    let map = match &run.scene.surface.albedo {
        Albedo::Map(map) if constant(pass, "albedo_is_map") == 1 => Some(map.as_slice()),
        _ => None,
    };
    let layer = if constant(pass, "sum_has_colour") == 1 {
        let sum = run.floats(pass, "colour_sum").expect("read");
        let sum: Vec<[f64; 3]> = sum.chunks_exact(4).map(|t| rgb(t).to_array()).collect();
        resolve_reference::light_resolve(sum, colour, map)
    } else {
        let sum = run.floats(pass, "scalar_sum").expect("read");
        let sum: Vec<f64> = sum.into_iter().map(f64::from).collect();
        resolve_reference::light_resolve(sum.iter().map(|l| [*l; 3]), colour, map)
    };
    if pushed(pass, CLEARS) == 1 {
        run.radiance = vec![[0.0; 3]; layer.len()];
        run.lights = 0;
    }
    if constant(pass, "adds_to_radiance") == 1 {
        resolve_reference::add_to_radiance(&mut run.radiance, &layer);
        run.lights += 1;
    }
    let (radiance, lights) = (run.radiance.clone(), run.lights);
    let [cols, _] = run.size();
    let mut pairs = Vec::new();
    let written = [
        ("radiance", &radiance, lights, 4),
        ("radiance_grey", &radiance, lights, 1),
        ("layer", &layer, 0, 4),
        ("layer_grey", &layer, 0, 1),
    ];
    for (binding, want, lights, size) in written {
        let Some(got) = run.floats(pass, binding) else { continue };
        for (i, (got, want)) in got.chunks_exact(size).zip(want).enumerate() {
            let at = [0, i / cols, i % cols];
            pairs.extend(got.iter().zip(want).map(|(got, want)| Pair {
                got: (*got).into(),
                want: *want,
                tolerance: device_resolved(*want, lights),
                at,
            }));
        }
    }
    pairs
}

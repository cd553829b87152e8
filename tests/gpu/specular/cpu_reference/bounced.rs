//! The passes of indirect Phong specular.

use half::f16;
use ridgelight::gpu::shaders::offset;
use ridgelight::plan::pyramid::Pyramid;
use ridgelight::plan::{Format, Kind, Pass};
use ridgelight::scene::{Levels, Receiver};
use ridgelight_cpu::bounce_gather::BounceGather;
use ridgelight_cpu::pyramid_march::Stored;
use ridgelight_cpu::shared::bounced::Cast;
use ridgelight_cpu::shared::field::{field_slope, normal_of};
use ridgelight_cpu::specular_exit::{exit_series, reflected};
use ridgelight_cpu::specular_gather::{Series, SpecularGather, arriving};
use ridgelight_cpu::tolerance::{
    BounceError, CastError, EPSILON, Gathered, device_arriving, device_level, device_sh_specular,
    device_specular_exit, device_specular_visibility, stored_f16,
};
use ridgelight_cpu::{specular_visibility as visible_reference, vector_reduce as reduce_reference};

use crate::bounce::cpu_reference::indirect::{brightest, colours};
use crate::cpu_reference::{Pair, Run, constant, pushed};
use crate::horizon::cpu_reference::pyramid::numbers;
use crate::sh::cpu_reference::device_series;
use crate::specular::cpu_reference::slices::{VIEW_ERROR, eye_of, view_from};

impl Run<'_> {
    fn is_half(&self, pass: &Pass, binding: &str) -> bool {
        let id = Self::bound(pass, binding).expect("bound");
        let kind = self.plan.resources[id.0].kind;
        matches!(kind, Kind::Image { format: Format::Rgba16Float, .. })
    }

    /// Series of every texel of an image.
    pub(crate) fn all_series(&mut self, pass: &Pass, binding: &str, order: usize) -> Vec<Series> {
        let words = self.words(pass, binding).expect("bound");
        let values: Vec<f64> = if self.is_half(pass, binding) {
            let half = |bits: u32| f16::from_bits(bits as u16).to_f64();
            words.iter().flat_map(|w| [half(*w), half(*w >> 16)]).collect()
        } else {
            words.iter().map(|w| f32::from_bits(*w).into()).collect()
        };
        let [cols, rows] = self.extent(pass, binding);
        let (texels, fours) = (cols * rows, (order * order).div_ceil(4));
        let channels = values.len() / (4 * texels * fours);
        let at = |i: usize, k: usize, c: usize| {
            let layer = (c % channels) * fours + k / 4;
            values[(layer * texels + i) * 4 + k % 4]
        };
        let series =
            |i: usize| (0..order * order).map(|k| [0, 1, 2].map(|c| at(i, k, c))).collect();
        (0..texels).map(series).collect()
    }
}

/// Coefficients paired with the CPU reference's.
pub(crate) fn paired(
    (got, want): (&Series, &Series),
    tolerance: impl Fn(f64) -> f64,
    at: [usize; 2],
) -> Vec<Pair> {
    let all = got.iter().zip(want).enumerate();
    all.flat_map(|(k, (got, want))| {
        [0, 1, 2].map(|c| Pair {
            got: got[c],
            want: want[c],
            tolerance: tolerance(want[c]),
            at: [k, at[0], at[1]],
        })
    })
    .collect()
}

/// The sum of magnitudes of the largest channel.
pub(crate) fn magnitude(series: &Series) -> f64 {
    let sum = |c: usize| series.iter().map(|s| s[c].abs()).sum::<f64>();
    (0..3).map(sum).fold(0.0, f64::max)
}

pub(crate) fn specular_visibility(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let order = constant(pass, "order") as usize;
    let visible = device_series(run, pass, order);
    let texels = run.floats(pass, "light_matrix").expect("bound");
    let entries: Vec<_> =
        texels.chunks_exact(4).map(crate::direct::cpu_reference::light::rgb).collect();
    let matrix: Vec<_> = entries.chunks_exact(order * order).map(<[_]>::to_vec).collect();
    let got = run.all_series(pass, "arriving", order);
    let [cols, _] = run.size();
    let mut pairs = Vec::new();
    for (i, (got, visible)) in got.iter().zip(&visible).enumerate() {
        let want = visible_reference::specular_visibility(visible, &matrix);
        for (k, row) in matrix.iter().enumerate() {
            let summed: glam::DVec3 = row.iter().zip(visible).map(|(m, v)| m.abs() * v.abs()).sum();
            pairs.extend((0..3).map(|c| Pair {
                got: got[k][c],
                want: want[k][c],
                tolerance: device_specular_visibility(order) * summed[c],
                at: [k, i / cols, i % cols],
            }));
        }
    }
    run.arriving = got;
    pairs
}

pub(crate) fn specular_exit(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const BEGINS: usize = offset("SpecularExitPush", "begins");
    const EYE_M: usize = offset("SpecularExitPush", "eye_m");
    let [order, direct, has_bounces, vectors, halves] =
        ["order", "is_direct", "is_bounced", "vectors", "halves"]
            .map(|name| constant(pass, name) as usize);
    let (is_direct, has_bounces, has_vectors) = (direct == 1, has_bounces == 1, vectors == 1);
    let has_series = has_vectors || !is_direct;
    let arriving = if has_series { run.all_series(pass, "arriving", order) } else { Vec::new() };
    let ([cols, rows], error, heights) = (run.size(), run.normal_error(), run.heights());
    let normals: Vec<_> = (0..cols * rows)
        .map(|i| normal_of(field_slope(&heights, (i % cols) as i32, (i / cols) as i32)))
        .collect();
    let eye_m = eye_of(pass, EYE_M);
    let mut pairs = Vec::new();
    let mut visible = Vec::new();
    if is_direct {
        visible = colours(&run.floats(pass, "specular_direct").expect("bound"));
    } else {
        if pushed(pass, BEGINS) == 1 {
            run.specular = vec![[0.0; 3]; cols * rows];
        }
        let got = colours(&run.floats(pass, "specular_bounced").expect("written"));
        for (i, got) in got.iter().enumerate() {
            let view = view_from(&heights, eye_m, i);
            let own = reflected(&arriving[i], (normals[i], view), run.phong_specular(i));
            let turned = error + if eye_m[3] > 0.0 { VIEW_ERROR } else { 0.0 };
            let off = f64::from(run.phong_specular(i).scale) * device_sh_specular(order, turned);
            let tolerance = off * magnitude(&arriving[i]) + 2.0 * EPSILON * run.specular[i][0];
            pairs.extend([0, 1, 2].map(|c| {
                let want = run.specular[i][c] + own[c];
                let tolerance = tolerance + 2.0 * EPSILON * want;
                Pair { got: got[c], want, tolerance, at: [c, i / cols, i % cols] }
            }));
            visible.push([0, 1, 2].map(|c| got[c] - run.specular[i][c]));
        }
        run.specular = got;
    }
    if !has_bounces {
        return pairs;
    }
    let diffuse = run.exit(pass);
    if !has_vectors {
        let grey = run.floats(pass, "exit_upward_grey");
        let got = grey.or_else(|| run.floats(pass, "exit_upward")).expect("written");
        let channels = got.len() / (cols * rows);
        for (i, got) in got.chunks_exact(channels).enumerate() {
            for c in 0..channels.min(3) {
                let want = diffuse[i][c] + visible[i][c];
                // The specular light is a difference of sums here.
                let tolerance = 4.0 * EPSILON * (want + run.specular[i][c]);
                let at = [c, i / cols, i % cols];
                pairs.push(Pair { got: got[c].into(), want, tolerance, at });
            }
        }
        return pairs;
    }
    let got = run.all_series(pass, "exit_vectors", order);
    for (i, got) in got.iter().enumerate() {
        let phong = run.phong_specular(i);
        let want = exit_series(&arriving[i], normals[i], phong, diffuse[i]);
        let bright = diffuse[i].iter().fold(0.0, |m: f64, v| v.max(m));
        let of_specular =
            f64::from(phong.scale) * device_specular_exit(order, error) * magnitude(&arriving[i]);
        let sum = of_specular + 4.0 * EPSILON * 4.0 * bright;
        let tolerance = |want: f64| sum + if halves == 1 { stored_f16(want) } else { 0.0 };
        pairs.extend(paired((got, &want), tolerance, [i / cols, i % cols]));
    }
    pairs
}

pub(crate) fn vector_reduce(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    numbers(pass).flat_map(|number| vector_level(run, pass, number)).collect()
}

fn vector_level(run: &mut Run, pass: &Pass, number: u32) -> Vec<Pair> {
    let order = run.quality.sh_order as usize;
    let shade = run.shade();
    let level = shade.level(number);
    let exit = run.all_series(pass, "exit_vectors", order);
    let texels = run.all_series(pass, "vector_levels", order);
    let is_half = run.is_half(pass, "vector_levels");
    let want = reduce_reference::vector_reduce(&exit, &shade, number, &texels);
    let largest = exit.iter().flatten().flatten().fold(0.0, |m: f64, v| m.max(v.abs()));
    let tolerance =
        |want: f64| device_level(largest) + if is_half { stored_f16(want) } else { 0.0 };
    let across = level.size[0] as usize;
    let own = texels[level.first as usize..].iter().zip(&want).enumerate();
    own.flat_map(|(i, (got, want))| paired((got, want), tolerance, [i / across, i % across]))
        .collect()
}

/// The arriving light, from the device's own levels, in one dispatch.
pub(crate) fn specular_gather(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const AZIMUTHS: usize = offset("GatherPush", "azimuths");
    const FIRST_AZIMUTH: usize = offset("GatherPush", "first_azimuth");
    const LAST_AZIMUTH: usize = offset("GatherPush", "last_azimuth");
    let azimuths = pushed(pass, AZIMUTHS);
    assert_eq!([pushed(pass, FIRST_AZIMUTH), pushed(pass, LAST_AZIMUTH)], [0, azimuths]);
    let order = constant(pass, "order") as usize;
    let shade = run.shade();
    let pyramid = Pyramid::new(&run.quality, run.plan.size, run.border());
    let vectors = (constant(pass, "vectors") == 1).then(|| {
        let levels = match shade.levels() {
            0 => Vec::new(),
            _ => run.all_series(pass, "vector_levels", order),
        };
        [run.all_series(pass, "exit_vectors", order), levels]
    });
    let (exit, texels) = match &vectors {
        Some(_) => (Vec::new(), Vec::new()),
        None => {
            let exit = run.exit(pass);
            let texels = match run.floats(pass, "shade_levels") {
                Some(texels) => colours(&texels),
                None => ridgelight_cpu::shade_reduce::shade_levels(&exit, &shade),
            };
            (exit, texels)
        }
    };
    let stack = run.floats(pass, "height_stack");
    let levels = run.floats(pass, "height_levels").unwrap_or_default();
    let stored = stack.as_ref().map_or(Stored::Levels(&levels), |s| Stored::Stack(s));
    let got = colours(&run.floats(pass, "bounce_sum").expect("written"));
    let series = run.all_series(pass, "arriving", order);
    let field = &run.scene.field;
    let gather = BounceGather {
        field,
        heights: run.heights(),
        pyramid: &pyramid,
        stored,
        shade: &shade,
        shade_texels: &texels,
        exit: &exit,
        receiver: Receiver::Plane,
        azimuths,
    };
    let of_vectors = vectors.as_ref().map(|[exit, levels]| [&exit[..], &levels[..]]);
    let reference = SpecularGather { gather, order, vectors: of_vectors };
    let bright = match &vectors {
        Some([exit, _]) => exit.iter().map(magnitude).fold(0.0, f64::max),
        None => brightest(&exit),
    };
    let ([x, y], [cols, _]) = (field.cell_m(), run.size());
    let gathered = Gathered {
        land: run.land(),
        step_m: x.min(y),
        is_stack: pyramid.stored == Levels::Stack,
        own_levels: false,
        receiver: Receiver::Plane,
        brightest: bright,
        spread: 2.0 * bright,
    };
    // Radiance changes by n a radian of direction, whose error is an elevation's.
    let error = |cast: &Cast| {
        let here = gathered.error(cast);
        let turned = order as f64 * here.elevation_rad * bright;
        CastError { radiance: here.radiance + turned, ..here }
    };
    let mut pairs = Vec::new();
    for (i, (got, series)) in got.iter().zip(&series).enumerate() {
        let at = [i / cols, i % cols];
        let all = reference.casts_along(at);
        let want = arriving(order, &all);
        let slices = run.slices(at, 1.0, bright);
        let of_series = device_arriving(&all, |_, cast| gathered.error(cast), order, &slices);
        let off = BounceError::of(&all, |_, cast| error(cast), &slices).light;
        pairs.extend(paired((series, &want.series), |_| of_series, at));
        pairs.extend([0, 1, 2].map(|c| Pair {
            got: got[c],
            want: want.diffuse[c],
            tolerance: off[c],
            at: [c, at[0], at[1]],
        }));
    }
    pairs
}

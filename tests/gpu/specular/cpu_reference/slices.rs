//! Specular of sky and environment by slices of a Phong lobe.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use ridgelight::gpu::shaders::offset;
use ridgelight::plan::{Azimuth, Pass};
use ridgelight::scene::Border;
use ridgelight_cpu::mirror_map as map_reference;
use ridgelight_cpu::mirror_map::{Tables, mirrored};
use ridgelight_cpu::shared::field::{field_slope, normal_of};
use ridgelight_cpu::shared::sweep::Heights;
use ridgelight_cpu::specular_light as light_reference;
use ridgelight_cpu::specular_light::Map;
use ridgelight_cpu::specular_tables as tables_reference;
use ridgelight_cpu::specular_tables::{Slices, Tabulated};
use ridgelight_cpu::tolerance::EPSILON;

use crate::cpu_reference::{Pair, Run, constant, pushed};
use crate::direct::cpu_reference::light::{rgb, wedge_rows};

/// Tables of a border and an exponent.
pub(crate) fn slices(border: Border, exponent: f64, [peaks, nodes]: [usize; 2]) -> Slices {
    let is_open = border == Border::Open;
    Slices {
        exponent,
        peaks,
        first_rad: if is_open { -PI } else { -FRAC_PI_2 },
        nodes,
        bottom_rad: if is_open { -FRAC_PI_2 } else { 0.0 },
    }
}

/// The eye among a pass's push constants, from this offset: its position, and 0 for a view from straight above.
pub(crate) fn eye_of(pass: &Pass, at: usize) -> [f64; 4] {
    [0, 4, 8, 12].map(|i| float(pass, at + i))
}

/// Half the error of a direction to an eye that is at least as far away as the field is wide. A mirror direction turns by twice the
/// normal's error and by the view's.
pub(crate) const VIEW_ERROR: f64 = 10.0 * EPSILON;

/// Direction from a grid point to the eye, or straight up.
pub(crate) fn view_from(heights: &Heights, eye_m: [f64; 4], grid_point: usize) -> DVec3 {
    if eye_m[3] == 0.0 {
        return DVec3::Z;
    }
    let (col, row) = (grid_point % heights.cols, grid_point / heights.cols);
    let [x, y] = heights.cell_m.map(f64::from);
    let own = f64::from(heights.heights_m[grid_point]);
    let at = DVec3::new(col as f64 * x, (heights.rows - 1 - row) as f64 * y, own);
    (DVec3::new(eye_m[0], eye_m[1], eye_m[2]) - at).normalize()
}

fn float(pass: &Pass, offset: usize) -> f64 {
    f32::from_bits(pushed(pass, offset)).into()
}

fn texels(run: &mut Run, pass: &Pass, binding: &str) -> Vec<DVec3> {
    run.floats(pass, binding).expect("bound").chunks_exact(4).map(rgb).collect()
}

/// The azimuths that a pass reads: swept ones, or the fine ones among the constants.
pub(crate) fn azimuths_of(run: &mut Run, pass: &Pass, count: usize) -> Vec<Azimuth> {
    let words = run.words(pass, "azimuths").expect("bound");
    bytemuck::cast_slice::<u32, Azimuth>(&words[..16 * count]).to_vec()
}

fn three(got: &[DVec3], want: &[Tabulated], at: impl Fn(usize) -> [usize; 3]) -> Vec<Pair> {
    assert_eq!(got.len(), want.len());
    let pairs = got.iter().zip(want).enumerate().flat_map(|(i, (got, want))| {
        let at = at(i);
        [0, 1, 2].map(|c| Pair {
            got: got[c],
            want: want.light[c],
            tolerance: want.tolerance[c] + 1e-30,
            at,
        })
    });
    pairs.collect()
}

/// Every layer of the swept azimuths, and each sixteenth of the fine ones.
pub(crate) fn specular_tables(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const EXPONENT: usize = offset("SpecularTablesPush", "exponent");
    const HEIGHT: usize = offset("SpecularTablesPush", "height");
    const LAYERS: usize = offset("SpecularTablesPush", "layers");
    const ROWS: usize = offset("SpecularTablesPush", "rows");
    const SKY: usize = offset("SpecularTablesPush", "sky");
    const WEDGE_RAD: usize = offset("SpecularTablesPush", "wedge_rad");
    let [height, rows, layers] = [HEIGHT, ROWS, LAYERS].map(|o| pushed(pass, o) as usize);
    let [peaks, nodes] = run.extent(pass, "specular_tables");
    let slices = slices(run.border(), float(pass, EXPONENT), [peaks, nodes]);
    let sky = DVec3::from_array([0, 4, 8].map(|c| float(pass, SKY + c)));
    let width = |a: &Azimuth| match float(pass, WEDGE_RAD) {
        shared if shared > 0.0 => shared,
        _ => f64::from(a.wedge_rad),
    };
    let sky_light: Vec<DVec3> =
        azimuths_of(run, pass, layers).iter().map(|a| sky * width(a)).collect();
    let has_environment = constant(pass, "has_environment") == 1;
    let lit = has_environment.then(|| wedge_rows(run, pass));
    let got = texels(run, pass, "specular_tables");
    let stride = if nodes == 1 { 16 } else { 1 };
    let mut pairs = Vec::new();
    for k in (0..layers).step_by(stride) {
        let own = lit.as_ref().map(|all| &all[k * rows..(k + 1) * rows]);
        let sky = &sky_light[k..=k];
        let want = tables_reference::specular_tables(&slices, sky, (height, rows), own);
        let first = k * nodes * peaks;
        let at = |i: usize| [k, i / peaks, i % peaks];
        pairs.extend(three(&got[first..first + nodes * peaks], &want, at));
    }
    pairs
}

/// From the device's own tables, at 8,192 texels or fewer; 1,021 is prime, so that they lie in all columns.
pub(crate) fn mirror_map(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const AZIMUTH_COUNT: usize = offset("MirrorMapPush", "azimuth_count");
    const COLUMNS: usize = offset("MirrorMapPush", "columns");
    const EXPONENT: usize = offset("MirrorMapPush", "exponent");
    let count = pushed(pass, AZIMUTH_COUNT) as usize;
    let azimuths = azimuths_of(run, pass, count);
    let all = texels(run, pass, "specular_tables");
    let [peaks, nodes] = run.extent(pass, "specular_tables");
    let slices = slices(run.border(), float(pass, EXPONENT), [peaks, nodes]);
    let size = run.extent(pass, "mirror_map");
    let got = texels(run, pass, "mirror_map");
    let tables = Tables { slices, texels: &all };
    let count = got.len();
    let places: Vec<usize> = (0..count.min(8192)).map(|i| i * 1021 % count).collect();
    let of = (size[0], [pushed(pass, COLUMNS) as usize, size[1]]);
    let want = map_reference::mirror_map(&tables, &azimuths, of, places.iter().copied());
    let got: Vec<DVec3> = places.iter().map(|i| got[*i]).collect();
    three(&got, &want, |i| [0, places[i] / size[0], places[i] % size[0]])
}

/// From the device's own maps and sums.
pub(crate) fn specular_light(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const EYE_M: usize = offset("SpecularLightPush", "eye_m");
    const SCALE: usize = offset("SpecularLightPush", "scale");
    const SWEPT_COLUMNS: usize = offset("SpecularLightPush", "swept_columns");
    const UNOCCLUDED_COLUMNS: usize = offset("SpecularLightPush", "unoccluded_columns");
    let eye_m = eye_of(pass, EYE_M);
    let scale = float(pass, SCALE);
    let [cols, _] = run.size();
    let (heights, off) = (run.heights(), 2.0 * (run.normal_error() + VIEW_ERROR));
    let mut map = |binding: &str, columns: usize| {
        let texels = texels(run, pass, binding);
        (run.extent(pass, binding), pushed(pass, columns) as usize, texels)
    };
    let whole = map("unoccluded_map", UNOCCLUDED_COLUMNS);
    let swept = map("swept_map", SWEPT_COLUMNS);
    let blocked = texels(run, pass, "blocked_sum");
    let got = texels(run, pass, "specular_sum");
    let want: Vec<Tabulated> = (0..blocked.len())
        .map(|i| {
            let normal = normal_of(field_slope(&heights, (i % cols) as i32, (i / cols) as i32));
            let mirror = mirrored(normal, view_from(&heights, eye_m, i));
            let of = |(size, columns, texels): &([usize; 2], usize, Vec<DVec3>)| {
                Map { size: *size, columns: *columns, texels }.looked_up(mirror, off)
            };
            let one = light_reference::specular_light(&of(&whole), &of(&swept), blocked[i]);
            Tabulated { light: scale * one.light, tolerance: scale * one.tolerance }
        })
        .collect();
    run.specular = want.iter().zip(&got).map(|(_, got)| got.to_array()).collect();
    three(&got, &want, |i| [0, i / cols, i % cols])
}

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

/// The columns `first..first + count` of all rows of an image's layers.
fn columns_of(all: &[DVec3], width: usize, first: usize, count: usize) -> Vec<DVec3> {
    all.chunks_exact(width).flat_map(|row| row[first..first + count].iter().copied()).collect()
}

/// One exponent's tables, of those that lie side by side.
pub(crate) fn table(
    run: &mut Run,
    pass: &Pass,
    exponent: f64,
    [first_peak, peaks]: [usize; 2],
) -> (Slices, Vec<DVec3>) {
    let all = texels(run, pass, "specular_tables");
    let [width, nodes] = run.extent(pass, "specular_tables");
    let own = columns_of(&all, width, first_peak, peaks);
    (slices(run.border(), exponent, [peaks, nodes]), own)
}

/// Exponents with tables of their own, as a pass reads them from its constants.
pub(crate) struct Levels {
    texels: Vec<f32>,
    per_log: f64,
}

/// A level: its exponent, its least cosine, its table's first peak and their number, and first row, height and columns of its maps:
/// the unoccluded one, and that of the swept azimuths.
pub(crate) struct Level {
    pub exponent: f64,
    pub least_cosine: f64,
    pub peaks: [usize; 2],
    maps: [[usize; 3]; 2],
}

/// What horizons hide is summed at every second level.
const SWEPT_EVERY: usize = 2;

impl Levels {
    /// Of the push constants `first_level`, `level_count` and `levels_per_log` at these offsets.
    pub(crate) fn of(run: &mut Run, pass: &Pass, [first, count, per_log]: [usize; 3]) -> Self {
        let [first, count] = [first, count].map(|at| pushed(pass, at) as usize);
        let words = run.words(pass, "constants").expect("bound");
        let own = &words[4 * first..][..12 * count];
        let texels = own.iter().map(|word| f32::from_bits(*word)).collect();
        Self { texels, per_log: float(pass, per_log) }
    }

    pub(crate) fn count(&self) -> usize {
        self.texels.len() / 12
    }

    pub(crate) fn level(&self, i: usize) -> Level {
        let of = |at: usize| self.texels[12 * i + at];
        let whole = |at: usize| of(at) as usize;
        Level {
            exponent: of(0).into(),
            least_cosine: of(1).into(),
            peaks: [whole(2), whole(3) + 1],
            maps: [4, 8].map(|at| [whole(at), whole(at + 1), whole(at + 2)]),
        }
    }

    /// Error of an index of levels: a logarithm errs by 2^-21 between 1/2 and 2, else by 3 ulp, and a product rounds.
    fn place_error(&self, place: f64) -> f64 {
        self.per_log * 0.5_f64.powi(21) + 8.0 * EPSILON * place
    }

    /// Where an exponent is among the levels, the swept level at or below it, and the one above.
    pub(crate) fn place(&self, exponent: f64) -> (f64, [usize; 2]) {
        let last = self.count() - 1;
        let place = ((exponent + 1.0).ln() * self.per_log).clamp(0.0, last as f64);
        let below =
            (place as usize / SWEPT_EVERY * SWEPT_EVERY).min(last.saturating_sub(SWEPT_EVERY));
        (place, [below, (below + SWEPT_EVERY).min(last)])
    }
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
    const FIRST_PEAK: usize = offset("SpecularTablesPush", "first_peak");
    const HEIGHT: usize = offset("SpecularTablesPush", "height");
    const LAYERS: usize = offset("SpecularTablesPush", "layers");
    const PEAKS: usize = offset("SpecularTablesPush", "peaks");
    const ROWS: usize = offset("SpecularTablesPush", "rows");
    const SKY: usize = offset("SpecularTablesPush", "sky");
    const WEDGE_RAD: usize = offset("SpecularTablesPush", "wedge_rad");
    let [height, rows, layers] = [HEIGHT, ROWS, LAYERS].map(|o| pushed(pass, o) as usize);
    let place = [FIRST_PEAK, PEAKS].map(|at| pushed(pass, at) as usize);
    let (slices, got) = table(run, pass, float(pass, EXPONENT), place);
    let Slices { peaks, nodes, .. } = slices;
    let sky = DVec3::from_array([0, 4, 8].map(|c| float(pass, SKY + c)));
    let width = |a: &Azimuth| match float(pass, WEDGE_RAD) {
        shared if shared > 0.0 => shared,
        _ => f64::from(a.wedge_rad),
    };
    let sky_light: Vec<DVec3> =
        azimuths_of(run, pass, layers).iter().map(|a| sky * width(a)).collect();
    let has_environment = constant(pass, "has_environment") == 1;
    let lit = has_environment.then(|| wedge_rows(run, pass));
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
    const FIRST_PEAK: usize = offset("MirrorMapPush", "first_peak");
    const FIRST_ROW: usize = offset("MirrorMapPush", "first_row");
    const HEIGHT: usize = offset("MirrorMapPush", "height");
    const PEAKS: usize = offset("MirrorMapPush", "peaks");
    const STORED: usize = offset("MirrorMapPush", "stored");
    let count = pushed(pass, AZIMUTH_COUNT) as usize;
    let azimuths = azimuths_of(run, pass, count);
    let place = [FIRST_PEAK, PEAKS].map(|at| pushed(pass, at) as usize);
    let (slices, all) = table(run, pass, float(pass, EXPONENT), place);
    let size = [STORED, HEIGHT].map(|at| pushed(pass, at) as usize);
    let [width, _] = run.extent(pass, "mirror_map");
    let rows = columns_of(&texels(run, pass, "mirror_map"), width, 0, size[0]);
    let got = &rows[size[0] * pushed(pass, FIRST_ROW) as usize..][..size[0] * size[1]];
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
    const LEVELS: [usize; 3] = [
        offset("SpecularLightPush", "first_level"),
        offset("SpecularLightPush", "level_count"),
        offset("SpecularLightPush", "levels_per_log"),
    ];
    const REPEATS: [usize; 2] = [
        offset("SpecularLightPush", "unoccluded_repeats"),
        offset("SpecularLightPush", "swept_repeats"),
    ];
    let eye_m = eye_of(pass, EYE_M);
    let scale = float(pass, SCALE);
    let [cols, _] = run.size();
    let (heights, off) = (run.heights(), 2.0 * (run.normal_error() + VIEW_ERROR));
    let levels = Levels::of(run, pass, LEVELS);
    // Of each level, the unoccluded and the swept map: stored size, columns of a turn, texels.
    let maps: Vec<_> = (0..2)
        .map(|which| {
            let binding = ["unoccluded_map", "swept_map"][which];
            let all = texels(run, pass, binding);
            let [width, _] = run.extent(pass, binding);
            let of = |i: usize| {
                let [first, height, columns] = levels.level(i).maps[which];
                let stored = columns / pushed(pass, REPEATS[which]) as usize;
                let own = columns_of(&all, width, 0, stored);
                ([stored, height], columns, own[stored * first..][..stored * height].to_vec())
            };
            (0..levels.count()).map(of).collect::<Vec<_>>()
        })
        .collect();
    let is_map = constant(pass, "specular_is_map") == 1;
    let mut blocked = vec![texels(run, pass, "blocked_sum")];
    if is_map {
        blocked.push(texels(run, pass, "blocked_above"));
    }
    let phong = run.scene.surface.specular.clone().expect("specular");
    let got = texels(run, pass, "specular_sum");
    let want: Vec<Tabulated> = (0..blocked[0].len())
        .map(|i| {
            let normal = normal_of(field_slope(&heights, (i % cols) as i32, (i / cols) as i32));
            let mirror = mirrored(normal, view_from(&heights, eye_m, i));
            let of = |which: usize, level: usize| {
                let (size, columns, texels): &([usize; 2], usize, Vec<DVec3>) = &maps[which][level];
                Map { size: *size, columns: *columns, texels }.looked_up(mirror, off)
            };
            let (place, level) =
                levels.place(if is_map { phong.at(i).exponent.into() } else { 0.0 });
            let off_place = levels.place_error(place);
            let whole =
                light_reference::between_levels((place, off_place), levels.count(), |i| of(0, i));
            let hidden: Vec<_> = (blocked.iter().enumerate())
                .map(|(k, blocked)| light_reference::hidden_share(&of(1, level[k]), blocked[i]))
                .collect();
            let t = (place - level[0] as f64) / SWEPT_EVERY as f64;
            let t = (t, off_place / SWEPT_EVERY as f64);
            let one = light_reference::specular_light(&whole, &hidden, t);
            let scale = if is_map { f64::from(phong.at(i).scale) } else { scale };
            Tabulated { light: scale * one.light, tolerance: scale * one.tolerance }
        })
        .collect();
    run.specular = want.iter().zip(&got).map(|(_, got)| got.to_array()).collect();
    three(&got, &want, |i| [0, i / cols, i % cols])
}

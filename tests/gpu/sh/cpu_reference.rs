//! The passes of spherical harmonics.

use ridgelight::gpu::shaders::offset;
use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DVec2, DVec3};
use ridgelight::basis::wedge::WedgeTable;
use ridgelight::plan::{Azimuth, Nodes, Pass};
use ridgelight::scene::{Border, Environment, Receiver, Wedges};
use ridgelight_cpu::env_rotation as turns_reference;
use ridgelight_cpu::env_wedges as env_wedges_reference;
use ridgelight_cpu::harmonics::{Visibility, matrix_magnitudes};
use ridgelight_cpu::light_matrix as matrix_reference;
use ridgelight_cpu::sh_shade::{light_at, nodes_around, specular_on};
use ridgelight_cpu::sh_visibility::{Series, sh_visibility as visibility_reference};
use ridgelight_cpu::sh_wedges::sh_wedges as wedges_reference;
use ridgelight_cpu::shared::field::{field_slope, normal_of};
use ridgelight_cpu::shared::gather::Swept;
use ridgelight_cpu::tolerance::{
    device_light_matrix, device_sh_shade, device_sh_specular, device_turn, device_wedge_row,
};

use crate::cpu_reference::{Pair, Reference, Run, constant, fuse_of, pushed};
use crate::direct::cpu_reference::light::{rgb, so_far, wedge_rows};
use crate::specular::cpu_reference::slices::{VIEW_ERROR, azimuths_of, eye_of, view_from};

/// The passes of this room and their CPU references.
pub(crate) const REFERENCES: &[Reference] = &[
    ("env_wedges", env_wedges),
    ("env_rotation", env_rotation),
    ("light_matrix", light_matrix),
    ("sh_visibility", sh_visibility),
    ("sh_shade", sh_shade),
    ("sh_wedges", sh_wedges),
];

fn environment<'a>(run: &Run<'a>) -> &'a Environment {
    run.scene.lights.environment.as_ref().expect("an environment")
}

fn texels(run: &mut Run, pass: &Pass, binding: &str) -> Vec<DVec3> {
    run.floats(pass, binding).expect("bound").chunks_exact(4).map(rgb).collect()
}

fn three(got: DVec3, want: DVec3, tolerance: DVec3, at: [usize; 3]) -> [Pair; 3] {
    [0, 1, 2].map(|c| Pair { got: got[c], want: want[c], tolerance: tolerance[c], at })
}

pub(crate) fn env_wedges(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let got = wedge_rows(run, pass);
    let environment = run.scene.lights.environment.as_ref().expect("an environment");
    let azimuths = &azimuths_of(run, pass, pass.groups[1] as usize);
    let want = env_wedges_reference::env_wedges(environment, run.scene.surface.border, azimuths);
    assert_eq!(got.len(), want.len());
    let rows = got.len() / azimuths.len();
    let mut pairs = Vec::new();
    for (i, (got, want)) in got.iter().zip(&want).enumerate() {
        let (k, row) = (i / rows, i % rows);
        let wedge = f64::from(azimuths[k].wedge_rad);
        let columns = wedge / std::f64::consts::TAU * environment.width() as f64 + 2.0;
        let texels = environment.texels().chunks_exact(environment.width()).nth(row);
        let of_row = texels.into_iter().flatten().flatten().fold(0.0_f32, |m, v| m.max(*v));
        let tolerance = device_wedge_row(of_row.into(), wedge, columns);
        for (moment, (got, want)) in got.iter().zip(want).enumerate() {
            let at = [k, row, moment];
            pairs.extend((0..3).map(|c| Pair { got: got[c], want: want[c], tolerance, at }));
        }
    }
    pairs
}

pub(crate) fn env_rotation(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const ROWS: usize = offset("EnvRotationPush", "rows");
    const TURNS: usize = offset("EnvRotationPush", "turns");
    let [rows, turns] = [ROWS, TURNS].map(|at| pushed(pass, at) as usize);
    let got = texels(run, pass, "env_rotation");
    let environment = environment(run);
    let want = turns_reference::env_rotation(environment, rows, turns.div_ceil(2));
    let width = environment.width();
    let mut pairs = Vec::new();
    for (i, got) in got.into_iter().enumerate() {
        let (row, turn) = (i / turns, i % turns);
        let of_row = environment.texels()[row * width..].iter().take(width);
        let all: DVec3 = of_row.map(|l| DVec3::from_array(l.map(f64::from))).sum();
        let tolerance = device_turn(width) * all / width as f64;
        pairs.extend(three(got, want[row][turn], tolerance, [0, row, turn]));
    }
    pairs
}

pub(crate) fn light_matrix(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const LIGHT_ORDER: usize = offset("LightMatrixPush", "light_order");
    const ORDER: usize = offset("LightMatrixPush", "order");
    const ROWS: usize = offset("LightMatrixPush", "rows");
    const SKY: usize = offset("LightMatrixPush", "sky");
    let [rows, light_order, order] = [ROWS, LIGHT_ORDER, ORDER].map(|at| pushed(pass, at) as usize);
    let turns: Vec<Vec<DVec3>> = if rows > 0 {
        let all = texels(run, pass, "env_rotation");
        all.chunks_exact(2 * light_order - 1).map(<[_]>::to_vec).collect()
    } else {
        Vec::new()
    };
    assert_eq!(turns.len(), rows);
    let (quality, fitted) = (run.quality, matrix_reference::is_fitted(&run.quality, run.border()));
    let height = run.scene.lights.environment.as_ref().map_or(1, Environment::height);
    let mut series = matrix_reference::series(&turns, height, light_order, fitted);
    let sky = [0, 4, 8].map(|at| f32::from_bits(pushed(pass, SKY + at)));
    matrix_reference::add_sky(&mut series, sky);
    let specular = (pass.part == "specular").then_some(sky);
    let want = match specular {
        None => matrix_reference::light_matrix(&quality, &series),
        Some(_) => matrix_reference::specular_matrix(&quality, &series),
    };
    let summed = matrix_magnitudes(&quality, run.border(), height, &turns, specular);
    let got = texels(run, pass, "light_matrix");
    assert_eq!(got.len(), want.len() * order * order);
    let mut pairs = Vec::new();
    for (entry, got) in got.into_iter().enumerate() {
        let (receiver, k) = (entry / (order * order), entry % (order * order));
        let tolerance = device_light_matrix(height) * summed[receiver][k];
        pairs.extend(three(got, want[receiver][k], tolerance, [0, receiver, k]));
    }
    pairs
}

/// Coefficients of every texel, from the device.
pub(crate) fn device_series(run: &mut Run, pass: &Pass, order: usize) -> Vec<Vec<f64>> {
    let floats = run.floats(pass, "visibility").expect("bound");
    let [cols, rows] = run.extent(pass, "visibility");
    let at = |i: usize, k: usize| floats[((k / 4) * cols * rows + i) * 4 + k % 4];
    let series = |i| (0..order * order).map(|k| f64::from(at(i, k))).collect();
    (0..cols * rows).map(series).collect()
}

pub(crate) fn sh_visibility(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const AZIMUTH_COUNT: usize = offset("ShadePush", "azimuth_count");
    const CLEARS: usize = offset("ShadePush", "clears");
    const FIRST_AZIMUTH: usize = offset("ShadePush", "first_azimuth");
    let (range, error) = so_far(run, pass, [FIRST_AZIMUTH, AZIMUTH_COUNT, CLEARS]);
    let order = constant(pass, "order") as usize;
    let series = Series {
        order,
        wedges: if constant(pass, "by_nlp") == 1 { Wedges::Nlp } else { Wedges::Slices },
        receiver: if constant(pass, "own_plane_hides") == 1 {
            Receiver::Plane
        } else {
            Receiver::Cosine
        },
    };
    let got = device_series(run, pass, order);
    let reference = |swept: &Swept| visibility_reference(swept, series);
    let want = run.swept(range.clone(), fuse_of(pass), reference);
    let (size, nodes) = (run.plan.size, Nodes { stride: constant(pass, "lane_stride") });
    let [cols, rows] = nodes.size(size);
    assert_eq!(got.len(), (cols * rows) as usize);
    let mut pairs = Vec::new();
    for (i, got) in got.iter().enumerate() {
        let node = [i as u32 % cols, i as u32 / cols];
        let [col, row] = [0, 1].map(|axis| nodes.place(node[axis], size[axis]) as usize);
        let want = &want[row * size[0] as usize + col];
        let at = [range.len(), row, col];
        let bands = ridgelight::basis::bands(order);
        pairs.extend(bands.zip(got.iter().zip(want)).map(|((l, _), (got, want))| Pair {
            got: *got,
            want: *want,
            tolerance: error.series(l, series.wedges),
            at,
        }));
    }
    pairs.extend(node_surfaces(run, pass, nodes));
    pairs
}

/// From the device's own horizons.
pub(crate) fn sh_wedges(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let order = constant(pass, "order") as usize;
    let (size, nodes) = (run.plan.size, Nodes { stride: constant(pass, "lane_stride") });
    let [cols, rows] = nodes.size(size);
    let plane = (size[0] * size[1]) as usize;
    let angles = run.floats(pass, "horizon_angles").expect("bound");
    let count = angles.len() / plane;
    let azimuths = run.plan.azimuths[..count].to_vec();
    let is_open = run.border() == Border::Open;
    let lowest_rad = if is_open { -FRAC_PI_2 } else { 0.0 };
    let side = run.quality.wedge_side as usize;
    let table = WedgeTable::new(order, side, lowest_rad, TAU / count as f64);
    let got = device_series(run, pass, order);
    assert_eq!(got.len(), (cols * rows) as usize);
    let (heights, error) = (run.heights(), run.texel_error());
    let mut pairs = Vec::new();
    for (i, got) in got.iter().enumerate() {
        let node = [i as u32 % cols, i as u32 / cols];
        let [col, row] = [0, 1].map(|axis| nodes.place(node[axis], size[axis]) as usize);
        let slope = field_slope(&heights, col as i32, row as i32);
        let lowest = |azimuth: &Azimuth| {
            let k = azimuth.horizon_layer as usize;
            // π/2 as f32 is more than π/2.
            let angle = f64::from(angles[k * plane + row * size[0] as usize + col]);
            let horizon = angle.clamp(-FRAC_PI_2, FRAC_PI_2).tan();
            let towards = DVec2::new(azimuth.cos_phi.into(), azimuth.sin_phi.into());
            let hides = constant(pass, "own_plane_hides") == 1;
            let own = if hides { slope.dot(towards) } else { f64::NEG_INFINITY };
            (*azimuth, horizon.max(own))
        };
        let lowest: Vec<_> = azimuths.iter().map(lowest).collect();
        let want = wedges_reference(&table, &lowest);
        let at = [count, row, col];
        let bands = ridgelight::basis::bands(order);
        pairs.extend(bands.zip(got.iter().zip(&want)).map(|((l, _), (got, want))| Pair {
            got: *got,
            want: *want,
            tolerance: error.series(l, Wedges::Table),
            at,
        }));
    }
    pairs.extend(node_surfaces(run, pass, nodes));
    pairs
}

/// The surface at nodes, where there are fewer than texels.
fn node_surfaces(run: &mut Run, pass: &Pass, nodes: Nodes) -> Vec<Pair> {
    let Some(got) = run.floats(pass, "nodes") else { return Vec::new() };
    let (size, heights, tolerance) = (run.plan.size, run.heights(), run.normal_error());
    let [cols, _] = nodes.size(size);
    let mut pairs = Vec::new();
    for (i, got) in got.chunks_exact(4).enumerate() {
        let node = [i as u32 % cols, i as u32 / cols];
        let [col, row] = [0, 1].map(|axis| nodes.place(node[axis], size[axis]) as i32);
        let slope = field_slope(&heights, col, row);
        let want = [f64::from(heights.at(col, row)), slope.x, slope.y];
        let at = [0, row as usize, col as usize];
        pairs.extend(want.iter().zip(got).zip([0.0, tolerance, tolerance]).map(
            |((want, got), tolerance)| Pair { got: (*got).into(), want: *want, tolerance, at },
        ));
    }
    pairs
}

pub(crate) fn sh_shade(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const EYE_M: usize = offset("ShShadePush", "eye_m");
    let order = constant(pass, "order") as usize;
    let visible = device_series(run, pass, order);
    let matrix = texels(run, pass, "light_matrix");
    let matrix: Vec<Vec<DVec3>> = matrix.chunks_exact(order * order).map(<[_]>::to_vec).collect();
    let got = run.floats(pass, "env_sum").expect("written");
    if constant(pass, "receiver") == 2 {
        run.specular = got.chunks_exact(4).map(|t| rgb(t).to_array()).collect();
    }
    let [cols, _] = run.size();
    let heights = run.heights();
    let error = run.texel_error();
    let eye_m = eye_of(pass, EYE_M);
    let view_error = if eye_m[3] > 0.0 { VIEW_ERROR } else { 0.0 };
    let nodes = Nodes { stride: constant(pass, "node_stride") };
    let across = nodes.size(run.plan.size)[0];
    let none = vec![0.0; order * order];
    let visible: Vec<Visibility> =
        visible.into_iter().map(|values| Visibility { values, errors: none.clone() }).collect();
    let mut pairs = Vec::new();
    for (i, got) in got.chunks_exact(4).enumerate() {
        let at = [0, i / cols, i % cols];
        let place = [(i % cols) as i32, (i / cols) as i32];
        let between;
        let visible = if nodes.stride == 1 {
            &visible[i]
        } else {
            let around = nodes_around(&heights, nodes, place);
            let node = |[col, row]: [u32; 2]| &visible[(row * across + col) as usize];
            between = Visibility::between(around.iter().map(|(at, w)| (node(*at), *w)), &error);
            &between
        };
        let is_specular = constant(pass, "receiver") == 2;
        let want = if is_specular {
            let normal = normal_of(field_slope(&heights, place[0], place[1]));
            let view = view_from(&heights, eye_m, i);
            specular_on((normal, view), run.phong_specular(i), &visible.values, &matrix)
        } else {
            light_at(&heights, &visible.values, &matrix, place)
        };
        // The sum of magnitudes, where every polynomial of the normal is 2 at most.
        let summed: DVec3 = matrix
            .iter()
            .flat_map(|row| row.iter().zip(&visible.values).map(|(m, v)| m.abs() * v.abs()))
            .sum();
        // The weights of nodes err, too, times polynomials of 2.
        let counted: DVec3 = matrix
            .iter()
            .flat_map(|row| row.iter().zip(&visible.errors).map(|(m, e)| 2.0 * m.abs() * *e))
            .sum();
        let of_sum = if is_specular { device_sh_specular } else { device_sh_shade };
        let tolerance = of_sum(order, error.normal() + view_error) * summed + counted;
        pairs.extend(three(rgb(got), want.max(DVec3::ZERO), tolerance, at));
        let is_decided = (0..3).all(|c| want[c].abs() > tolerance[c]);
        let below = f64::from(u8::from(want.min_element() < 0.0));
        pairs.extend(is_decided.then(|| Pair {
            got: got[3].into(),
            want: below,
            tolerance: 0.0,
            at,
        }));
    }
    pairs
}

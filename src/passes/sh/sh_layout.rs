//! Inputs of the SH passes: a buffer of constants, computed in f64.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::basis::light::{cosine_lobe, fit_above_ground, plane};
use crate::basis::product::{light_matrix, triples};
use crate::basis::slice::{Slices, parts, slice_index};
use crate::basis::wedge::WedgeTable;
use crate::basis::{bands, index, window};
use crate::passes::azimuths::Azimuth;
use crate::passes::nodes::Nodes;
use crate::scene::{Border, Environment, Quality, Receiver, Window};

/// The receiver that turns visibility into light. Numbered as in `sh_shade.comp`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lit {
    /// A clamped cosine of three bands.
    Cosine = 0,
    /// The cosine of a surface whose plane hides the light below it.
    Plane = 1,
    /// A Phong lobe. Its incoming light is an SH series of its own.
    Specular = 2,
}

impl Lit {
    /// The receiver of diffuse ground.
    pub(crate) fn diffuse(receiver: Receiver) -> Self {
        match receiver {
            Receiver::Plane => Lit::Plane,
            Receiver::Cosine => Lit::Cosine,
        }
    }
}

/// Sizes and offsets in [`Plan::constants`](crate::plan::Plan::constants), in texels of four.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Sh {
    /// SH order of visibility.
    pub order: usize,
    /// SH order of the environment.
    pub light_order: usize,
    pub lit: Lit,
    /// Whether each grid point's own plane hides the directions below it.
    pub own_plane_hides: bool,
    /// Nodes at which visibility is found.
    pub nodes: Nodes,
    /// Rows of the light's matrix.
    pub receivers: usize,
    /// Rows of the environment, from the zenith down, that count.
    pub rows: usize,
    pub column_first: usize,
    pub row_first: usize,
    pub matrix_first: usize,
}

impl Sh {
    /// Sizes for an environment, or for a uniform sky where there is none; adds the constants. For the specular
    /// receiver, or the diffuse one of the quality.
    ///
    /// Where ground hides everything below horizontal, the light for the plane receiver is fitted to the
    /// directions above: the rest of its series is never visible. An SH window needs a series of all
    /// directions. The specular receiver uses all bands of visibility, so its light has as many.
    pub(crate) fn of(
        environment: Option<&Environment>,
        border: Border,
        quality: &Quality,
        is_specular: bool,
        constants: &mut Vec<f32>,
    ) -> Self {
        let order = quality.sh_order as usize;
        let is_fitted = quality.receiver == Receiver::Plane
            && quality.window == Window::None
            && border != Border::Open;
        let lit = if is_specular { Lit::Specular } else { Lit::diffuse(quality.receiver) };
        let light_order = if lit == Lit::Plane { order - 1 } else { order };
        let column_first = constants.len() / 4;
        constants.extend(environment.iter().flat_map(|e| columns(e, light_order)));
        let row_first = constants.len() / 4;
        let mut rows = 0;
        if let Some(e) = environment {
            let lowest_rad = if is_fitted { 0.0 } else { -FRAC_PI_2 };
            rows = if is_fitted { e.height().div_ceil(2) } else { e.height() };
            let fit = is_fitted.then(|| fit_above_ground(light_order));
            constants.extend(elevations((e.height(), rows), light_order, lowest_rad, fit));
        }
        let matrix_first = constants.len() / 4;
        let entries = matrix(quality, light_order, lit);
        let receivers = entries.len() / (order * order);
        constants.extend(entries.iter().flat_map(|entry| by_fours(entry)));
        let nodes = Nodes { stride: quality.subsample };
        Self {
            order,
            light_order,
            lit,
            own_plane_hides: quality.receiver == Receiver::Plane,
            nodes,
            receivers,
            rows,
            column_first,
            row_first,
            matrix_first,
        }
    }

    /// The part in the labels of the passes before the shading, where there are two of each.
    pub(crate) fn part(&self) -> &'static str {
        if self.lit == Lit::Specular { "specular" } else { "" }
    }

    /// Layers of four coefficients.
    pub(crate) fn layers(self) -> usize {
        (self.order * self.order).div_ceil(4)
    }
}

/// A table of wedges among the constants, and the circle for look-up, in texels of four.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WedgeTexels {
    pub side: usize,
    pub lowest_rad: f64,
    pub azimuths: usize,
    pub azimuth_first: usize,
    pub table_first: usize,
}

impl WedgeTexels {
    /// Appends the circle and the table to the constants. The azimuths must be evenly spaced and in the order of the circle.
    pub(crate) fn of(
        border: Border,
        quality: &Quality,
        circle: &[Azimuth],
        constants: &mut Vec<f32>,
    ) -> Self {
        let azimuth_first = constants.len() / 4;
        constants.extend(circle.iter().flat_map(|a| [a.cos_phi, a.sin_phi, 0.0, 0.0]));
        let table_first = constants.len() / 4;
        let order = quality.sh_order as usize;
        let (side, lowest_rad) = (quality.wedge_side as usize, lowest_rad(border));
        let table = WedgeTable::new(order, side, lowest_rad, TAU / circle.len() as f64);
        constants.extend(table.texels.iter().flat_map(|texel| by_fours(texel)));
        Self { side, lowest_rad, azimuths: circle.len(), azimuth_first, table_first }
    }
}

/// The lowest horizon of a table of wedges: the nadir where light comes from below.
pub fn lowest_rad(border: Border) -> f64 {
    if border == Border::Open { -FRAC_PI_2 } else { 0.0 }
}

/// Numbers as texels of four f32, padded with zeros.
pub(crate) fn by_fours(values: &[f64]) -> Vec<f32> {
    let mut all: Vec<f32> = values.iter().map(|v| *v as f32).collect();
    all.resize(values.len().next_multiple_of(4), 0.0);
    all
}

/// ∫ over each column of 1/√2π, cos mφ/√π, sin mφ/√π: `[turn][column]`.
fn columns(environment: &Environment, order: usize) -> Vec<f32> {
    let width = environment.width();
    let step = TAU / width as f64;
    let weight = |turn: isize, col: usize| {
        // Column 0 begins at azimuth π, rotated; columns run clockwise.
        let middle = PI + environment.rotation_rad() - step * (col as f64 + 0.5);
        let m = turn.unsigned_abs() as f64;
        let chord = if turn == 0 { step } else { 2.0 * (0.5 * m * step).sin() / m };
        match turn {
            0 => chord / TAU.sqrt(),
            1.. => chord * (m * middle).cos() / PI.sqrt(),
            _ => chord * (m * middle).sin() / PI.sqrt(),
        }
    };
    let turns = 1 - order as isize..order as isize;
    turns.flat_map(|t| by_fours(&(0..width).map(|c| weight(t, c)).collect::<Vec<_>>())).collect()
}

/// ∫ over each row above `lowest_rad` of Θ_lm dz, or of the fitted function, m ≥ 0: `[(l, m)][row]`.
fn elevations(
    (height, rows): (usize, usize),
    order: usize,
    lowest_rad: f64,
    fit: Option<Vec<Vec<f64>>>,
) -> Vec<f32> {
    let slices = Slices::new(order);
    let edge = |row: usize| (FRAC_PI_2 - PI * row as f64 / height as f64).max(lowest_rad);
    let all: Vec<Vec<f64>> =
        (0..rows).map(|row| slices.between(edge(row + 1), edge(row))).collect();
    let weight = |(l, m): (usize, usize), slice: &[f64]| match &fit {
        None => slice[slice_index(l, m)],
        Some(fit) => {
            let row = &fit[index(l, m as isize)];
            (m..order).map(|k| row[index(k, m as isize)] * slice[slice_index(k, m)]).sum()
        }
    };
    parts(order)
        .flat_map(|part| by_fours(&all.iter().map(|s| weight(part, s)).collect::<Vec<_>>()))
        .collect()
}

/// How each entry of the light's matrix follows from the environment's series: `[entry][coefficient]`. Each
/// column is the light of one coefficient alone.
pub(crate) fn matrix(quality: &Quality, light_order: usize, lit: Lit) -> Vec<Vec<f64>> {
    let order = quality.sh_order as usize;
    let triples = triples(order);
    let factors = factors(quality.window, light_order);
    let columns: Vec<Vec<f64>> = bands(light_order)
        .enumerate()
        .map(|(i, (l, _))| {
            let mut light = vec![0.0; light_order * light_order];
            light[i] = factors[l];
            match lit {
                Lit::Specular => light_matrix(&triples, &light).concat(),
                Lit::Plane => plane(&triples, order, &light).concat(),
                Lit::Cosine => cosine_lobe(&triples, order, &light).concat(),
            }
        })
        .collect();
    (0..columns[0].len()).map(|entry| columns.iter().map(|c| c[entry]).collect()).collect()
}

/// Factors of the bands; as wide as the series, so that the last band is not 0.
fn factors(window: Window, order: usize) -> Vec<f64> {
    match window {
        Window::None => vec![1.0; order],
        Window::Lanczos => window::lanczos(order, order as f64),
        Window::Hann => window::hann(order, order as f64),
        Window::Nonnegative => window::nonnegative(order),
    }
}

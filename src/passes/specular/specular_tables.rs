use std::f32::consts::{FRAC_PI_2, PI};

use crate::graph::{Builder, Format, Owner, ResourceId, shaders};
use crate::scene::{Border, Environment};

/// Where a lobe is less than this share of its peak, it counts as dark.
pub(super) const LEAST_SHARE: f32 = 1e-7;

/// Tables of light below each elevation, weighted by a Phong lobe.
#[derive(Clone, Copy)]
pub(crate) struct SpecularTables {
    pub exponent: f32,
    /// Share of its peak that a lobe may have in the nearest azimuth: it may point between two.
    pub nearest_share: f32,
    /// Elevations of the lobe's peak, from `first_rad` to π.
    pub(super) peaks: u32,
    /// Elevations up to which light is hidden, from the lowest to the zenith; 1 for the zenith alone.
    pub(super) nodes: u32,
    /// One for each azimuth; one for all of them under a sky alone.
    layers: u32,
    border: Border,
    pub tables: ResourceId,
}

impl SpecularTables {
    /// For an exponent, and azimuths whose neighbours are up to twice `gap_rad` apart. `nodes`: see the field.
    ///
    /// Peaks lie a quarter of the lobe's deviation apart, 1/√n radians; at least 192 of them resolve the edges of an
    /// environment's brightest spots, whatever the lobe is. There are at most 1024: from n = 2,950 on they lie farther apart.
    /// Those of whole slices lie a sixteenth apart. The unoccluded reflection is linear between two, which errs by up to h²/8 of the
    /// lobe's peak, h apart in deviations: 1/2,048 instead of 1/128. There are at most 2,048: from n = 738 on, 415 with an open
    /// border, they lie farther apart.
    pub(crate) fn make(
        builder: &mut Builder,
        name: &str,
        (exponent, gap_rad): (f32, f32),
        border: Border,
        [nodes, layers]: [u32; 2],
    ) -> Self {
        let nearest_share = gap_rad.min(1.5).cos().powf(exponent).max(1e-30);
        let mut it = Self {
            exponent,
            nearest_share,
            peaks: 0,
            nodes,
            layers,
            border,
            tables: ResourceId(0),
        };
        // Whole slices have one node: more peaks cost little.
        let [per_deviation, most] = if nodes == 1 { [16.0, 2048.0] } else { [4.0, 1024.0] };
        let wanted = (per_deviation * exponent.sqrt() * it.range_rad()).min(most).ceil() as u32;
        let widened = if border == Border::Open { 256 } else { 192 };
        it.peaks = wanted.max(widened).next_multiple_of(4) + 1;
        let extent = [it.peaks, nodes, layers];
        it.tables = builder.image(name, Owner::Internal, Format::Rgba32Float, extent, true);
        it
    }

    /// Where light may come from below horizontal, a lobe may peak anywhere in a slice.
    pub(super) fn first_rad(&self) -> f32 {
        if self.is_open() { -PI } else { -FRAC_PI_2 }
    }

    /// Whether light may come from below horizontal.
    pub(super) fn is_open(&self) -> bool {
        self.border == Border::Open
    }

    pub(super) fn range_rad(&self) -> f32 {
        PI - self.first_rad()
    }

    pub(crate) fn is_shared(&self) -> bool {
        self.layers == 1
    }

    /// Fills the tables from a sky's radiance and an environment's `wedge_rows`.
    pub(crate) fn plan(
        &self,
        builder: &mut Builder,
        part: &str,
        sky: Option<[f32; 3]>,
        rows: Option<(&Environment, ResourceId)>,
        (azimuths, is_swept): (ResourceId, bool),
    ) {
        let is_open = self.is_open();
        let [r, g, b] = sky.unwrap_or_default();
        // A sky is even: one row above horizontal, and one below.
        let [height, kept] = match rows {
            Some((environment, _)) => {
                [environment.height() as u32, environment.rows_above_ground(self.border) as u32]
            }
            None => [2, if is_open { 2 } else { 1 }],
        };
        let mut bound = vec![("specular_tables", self.tables), ("azimuths", azimuths)];
        bound.extend(rows.map(|(_, rows)| ("wedge_rows", rows)));
        let values = u64::from(self.layers) * u64::from(self.peaks) * u64::from(self.nodes);
        let read = u64::from(self.layers) * u64::from(kept) * 16;
        let pass = builder.pass(
            shaders::SpecularTables { has_environment: rows.is_some() },
            part,
            format!(
                "light below each of {} elevations in a lobe of exponent {}",
                self.nodes, self.exponent
            ),
            shaders::SPECULAR_TABLES.groups([self.peaks.div_ceil(4), self.layers, 1]),
            &shaders::SpecularTablesPush {
                height: height as i32,
                rows: kept as i32,
                peaks: self.peaks as i32,
                nodes: self.nodes as i32,
                layers: self.layers as i32,
                bottom_rad: if is_open { -FRAC_PI_2 } else { 0.0 },
                first_rad: self.first_rad(),
                step_rad: self.range_rad() / (self.peaks - 1) as f32,
                exponent: self.exponent,
                wedge_rad: if self.is_shared() { 1.0 } else { 0.0 },
                reach_rad: 1e-4 + LEAST_SHARE.powf(1.0 / self.exponent.max(1e-3)).acos(),
                sky: [r, g, b, 0.0],
            },
            &bound,
            values * 16 + read,
            values,
        );
        // One for all under a sky, or the fine ones, which are constants.
        if is_swept {
            pass.azimuths = 0..self.layers;
        }
    }
}

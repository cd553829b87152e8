use super::specular_tables::{LEAST_SHARE, SpecularTables};
use crate::graph::{Builder, Format, Owner, ResourceId, shaders};
use crate::passes::azimuths::Azimuth;

/// Light in a Phong lobe by its direction.
#[derive(Clone, Copy)]
pub(crate) struct MirrorMap {
    pub image: ResourceId,
    /// Columns of a whole turn, a multiple of 4; the stored ones repeat.
    pub columns: u32,
    stored: u32,
    height: u32,
}

impl MirrorMap {
    /// For a lobe about `exponent`, and light that repeats `repeats` times in a turn.
    ///
    /// Texels are at most a quarter of the lobe's deviation apart, 1/√n radians, up to an exponent of 6,640.
    pub(crate) fn make(builder: &mut Builder, name: &str, exponent: f32, repeats: u32) -> Self {
        let wanted = (4.0 * std::f32::consts::TAU * exponent.sqrt()).ceil() as u32;
        let wanted = wanted.next_power_of_two().clamp(64, 2048);
        let mut stored = wanted.div_ceil(repeats);
        if !(stored * repeats).is_multiple_of(4) {
            stored = stored.next_multiple_of(4);
        }
        let (columns, height) = (stored * repeats, wanted / 2 + 1);
        let extent = [stored, height, 1];
        let image = builder.image(name, Owner::Internal, Format::Rgba32Float, extent, false);
        Self { image, columns, stored, height }
    }

    /// Fills the map from the whole slices of tables. `first_rad`: azimuth 0, where all are even and in order.
    pub(crate) fn plan(
        &self,
        builder: &mut Builder,
        tables: &SpecularTables,
        (part, why): (&str, &str),
        (azimuths, count): (ResourceId, u32),
        first_rad: Option<f64>,
    ) {
        let texels = u64::from(self.stored) * u64::from(self.height);
        let least = LEAST_SHARE * tables.nearest_share;
        // aⁿ is least; the shader compares aⁿ too.
        let farthest = 1.0 - f64::from(least).powf(2.0 / f64::from(tables.exponent));
        let farthest = 1e-5 + farthest.max(0.0).sqrt() as f32;
        let pass = builder.pass(
            shaders::MirrorMap {},
            part,
            why,
            [self.stored.div_ceil(8), self.height.div_ceil(8), 1],
            &shaders::MirrorMapPush {
                columns: self.columns as i32,
                height: self.height as i32,
                azimuth_count: count as i32,
                node: (tables.nodes - 1) as i32,
                first_rad: tables.first_rad(),
                per_rad: (tables.peaks - 1) as f32 / tables.range_rad(),
                exponent: tables.exponent,
                least,
                farthest,
                first_turn: first_rad
                    .map_or(-1.0, |rad| (rad / std::f64::consts::TAU).rem_euclid(1.0) as f32),
                lowest_up: if tables.is_open() { -2.0 } else { -farthest },
            },
            &[
                ("azimuths", azimuths),
                ("specular_tables", tables.tables),
                ("mirror_map", self.image),
            ],
            texels * 16 + u64::from(count) * u64::from(tables.peaks) * 16,
            texels,
        );
        if first_rad.is_none() {
            pass.azimuths = 0..count;
        }
    }
}

/// How many times a turn repeats: as often as there are azimuths, if they are even, from east on.
pub(crate) fn repeats(circle: &[Azimuth]) -> u32 {
    let per_turn = circle.len() as f64 / std::f64::consts::TAU;
    let is_even = circle.iter().all(|a| {
        let place = f64::from(a.sin_phi).atan2(f64::from(a.cos_phi)) * per_turn;
        (place - place.round()).abs() < 1e-3
    });
    if is_even { circle.len() as u32 } else { 1 }
}

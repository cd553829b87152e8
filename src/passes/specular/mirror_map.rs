use super::specular_tables::{LEAST_SHARE, SpecularTables};
use crate::graph::{Builder, Format, Owner, ResourceId, shaders};
use crate::passes::azimuths::Azimuth;

/// Light weighted by a Phong lobe, for each direction of the lobe.
#[derive(Clone, Copy)]
pub(crate) struct MirrorMap {
    pub image: ResourceId,
    /// Columns of a whole turn, a multiple of 4; the stored ones repeat.
    pub columns: u32,
    stored: u32,
    pub height: u32,
    /// Row within the image: maps of several exponents lie one above the other.
    pub first_row: u32,
}

impl MirrorMap {
    /// For a lobe of each exponent, and light that repeats `repeats` times in a turn.
    ///
    /// Up to an exponent n of 6,640, texels are at most a quarter of the lobe's standard deviation, 1/√n radians, apart.
    pub(crate) fn make(
        builder: &mut Builder,
        name: &str,
        levels: &[f32],
        repeats: u32,
    ) -> Vec<Self> {
        let mut extent = [0, 0, 1];
        let mut of = |exponent: f32| {
            let wanted = (4.0 * std::f32::consts::TAU * exponent.sqrt()).ceil() as u32;
            let wanted = wanted.next_power_of_two().clamp(64, 2048);
            let mut stored = wanted.div_ceil(repeats);
            if !(stored * repeats).is_multiple_of(4) {
                stored = stored.next_multiple_of(4);
            }
            let (columns, height, first_row) = (stored * repeats, wanted / 2 + 1, extent[1]);
            extent = [stored.max(extent[0]), first_row + height, 1];
            Self { image: ResourceId(0), columns, stored, height, first_row }
        };
        let mut all: Vec<Self> = levels.iter().map(|exponent| of(*exponent)).collect();
        let image = builder.image(name, Owner::Internal, Format::Rgba32Float, extent, false);
        all.iter_mut().for_each(|it| it.image = image);
        all
    }

    /// Periods in a turn.
    pub(crate) fn repeats(&self) -> u32 {
        self.columns / self.stored
    }

    /// Fills the map from the whole slices of tables. `first_azimuth_rad`: direction of azimuth 0 if the azimuths are equally
    /// spaced and in order; `None` for the swept ones.
    pub(crate) fn plan(
        &self,
        builder: &mut Builder,
        tables: &SpecularTables,
        (part, why): (&str, &str),
        (azimuths, count): (ResourceId, u32),
        first_azimuth_rad: Option<f64>,
    ) {
        let texels = u64::from(self.stored) * u64::from(self.height);
        let least = LEAST_SHARE * tables.nearest_share;
        // |p| at which aⁿ = `least`. 1e-5 is added because the shader makes the exact comparison of aⁿ.
        let farthest = 1.0 - f64::from(least).powf(2.0 / f64::from(tables.exponent.max(1e-3)));
        let farthest = 1e-5 + farthest.max(0.0).sqrt() as f32;
        let pass = builder.pass(
            shaders::MirrorMap {},
            part,
            why,
            shaders::MIRROR_MAP.groups([self.stored, self.height, 1]),
            &shaders::MirrorMapPush {
                columns: self.columns as i32,
                stored: self.stored as i32,
                height: self.height as i32,
                first_row: self.first_row as i32,
                first_peak: tables.first_peak as i32,
                peaks: tables.peaks as i32,
                azimuth_count: count as i32,
                node: (tables.nodes - 1) as i32,
                first_rad: tables.first_rad(),
                per_rad: (tables.peaks - 1) as f32 / tables.range_rad(),
                exponent: tables.exponent,
                least,
                farthest,
                first_turn: first_azimuth_rad
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
        if first_azimuth_rad.is_none() {
            pass.azimuths = 0..count;
        }
    }
}

/// Periods in a turn: the number of azimuths if they are equally spaced from east, else 1.
pub(crate) fn repeats(circle: &[Azimuth]) -> u32 {
    let width = std::f64::consts::TAU / circle.len() as f64;
    // Directions and widths are f32.
    let is_near = |rad: f64| rad.abs() < 5e-7;
    let is_even = circle.iter().all(|a| {
        let azimuth = f64::from(a.sin_phi).atan2(f64::from(a.cos_phi));
        is_near(azimuth - width * (azimuth / width).round())
            && is_near(f64::from(a.wedge_rad) - width)
    });
    if is_even { circle.len() as u32 } else { 1 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::Limits;
    use crate::passes::azimuths::{along_grid_vectors, even};

    #[test]
    fn only_even_azimuths_repeat() {
        for count in [4, 5, 7, 9, 63, 64, 511, 512, 1023, 1024] {
            assert_eq!(repeats(&even(count, [3.0, 2.0])), count);
        }
        let of = |cell_m| repeats(&along_grid_vectors(8, cell_m).expect("vectors"));
        assert_eq!(of([1.0, 1.0]), 8);
        // The diagonals turn by 5e-4 and by 5e-6 rad.
        assert_eq!([of([1.0, 1.001]), of([1.0, 1.000_01])], [1, 1]);
    }

    /// The columns of a turn are a multiple of 4, for its quarters, and hold each period in whole columns, as many in all as
    /// without periods or more.
    #[test]
    fn periods_are_whole_columns() {
        for exponent in [0.0, 20.0, 1000.0, 6640.0, 1e4] {
            let mut builder = Builder::new(&Limits::lavapipe());
            let mut make = |repeats| MirrorMap::make(&mut builder, "map", &[exponent], repeats)[0];
            let whole = make(1);
            assert_eq!(whole.columns, whole.stored);
            for repeats in [2, 3, 4, 5, 7, 9, 63, 64, 511, 512, 1023, 1024] {
                let map = make(repeats);
                assert_eq!([map.columns % 4, map.height], [0, whole.height]);
                assert_eq!([map.columns, map.repeats()], [map.stored * repeats, repeats]);
                assert!(map.columns >= whole.columns && map.stored <= whole.stored.max(4));
            }
        }
    }
}

//! The default number of azimuths for a scene.

use glam::DVec3;

use crate::basis::random::{STEP, mixed, unit};
use crate::scene::{HeightField, Quality, Scene, Specular, Surface, normal};

/// Default azimuths where horizons may cut lobes: (largest exponent, azimuths).
///
/// Measured under a uniform sky on 96² grid points of the Jacksboro fault, of Mt Washington and N44W072 three times as high, and of moss:
/// with 32 azimuths the RMSE of the specular layer is 0.7 to 2 % at exponent 20, 1.6 to 4.4 % at 100, and 3.6 to 12 % at 1,000.
const BY_EXPONENT: [(f32, u32); 3] = [(50.0, 64), (3000.0, 128), (f32::INFINITY, 256)];

/// Largest default under an environment, where each azimuth has its own tables. A specular map needs several times the memory. The
/// tables take 1 GiB at most.
const UNDER_ENVIRONMENT: u32 = 128;
const UNDER_ENVIRONMENT_BY_MAP: [(f32, u32); 2] = [(1000.0, 64), (f32::INFINITY, 32)];

/// The default has more azimuths if a horizon may cut at least this share of the lobes. On ten fields viewed from above it is 9 %
/// or less where 32 azimuths are enough, and 22 % or more elsewhere.
const SHARE_CUT: f64 = 0.125;

/// At most this many texels along each side are examined.
const EXAMINED: usize = 256;

impl Quality {
    /// The defaults for a scene. With specular under a sky or an environment, steep ground gets 64 to 256 azimuths: where at least an
    /// eighth of the texels that reflect and face the eye have a mirror direction below the mean slope. `eye_m` is
    /// [`Picture::eye_m`](crate::plan::Picture::eye_m). If the heights are unknown, this is the same as [`default`](Self::default).
    ///
    /// With [`Basis::Sh`](crate::scene::Basis::Sh), which blurs lobes, keep the azimuths of [`default`](Self::default).
    pub fn for_scene(scene: &Scene, eye_m: Option<[f64; 3]>) -> Self {
        let default = Self::default();
        let Scene { field, surface, lights } = scene;
        let has_sky = lights.sky.is_some_and(|sky| sky.iter().any(|v| *v > 0.0));
        let has_environment = lights.environment.is_some();
        let Some(specular) = surface.specular.as_ref().filter(|_| has_sky || has_environment)
        else {
            return default;
        };
        if field.is_unknown() {
            return default;
        }
        let cut = shares_cut(field, (surface, specular), eye_m);
        let found = BY_EXPONENT.iter().zip(cut).rev().find(|(_, share)| *share >= SHARE_CUT);
        let count = found.map_or(default.azimuths, |((_, count), _)| *count);
        let by_map = || {
            let exponent = specular.largest().exponent;
            let found = UNDER_ENVIRONMENT_BY_MAP.iter().find(|(most, _)| exponent <= *most);
            found.map_or(default.azimuths, |(_, count)| *count)
        };
        let most = match specular {
            _ if !has_environment => count,
            Specular::Constant(_) => UNDER_ENVIRONMENT,
            Specular::Map(_) => by_map(),
        };
        Self { azimuths: count.min(most), ..default }
    }
}

/// Of the texels that reflect and face the eye, the shares whose mirror direction is lower than the mean slope of the field: of
/// all exponents, and of those above the first two of [`BY_EXPONENT`].
fn shares_cut(
    field: &HeightField,
    (surface, specular): (&Surface, &Specular),
    eye_m: Option<[f64; 3]>,
) -> [f64; 3] {
    let cols = field.cols();
    let examined: Vec<(usize, DVec3)> = places([field.rows(), cols])
        .filter(|[row, col]| field.voids().is_none_or(|voids| !voids[row * cols + col]))
        .map(|[row, col]| (row * cols + col, normal(field, surface.border, row, col)))
        .collect();
    let slopes_rad = examined.iter().map(|(_, normal)| normal.z.min(1.0).acos());
    let mean_slope_rad = slopes_rad.sum::<f64>() / examined.len() as f64;
    let [cell_x, cell_y] = field.cell_m();
    let (mut front, mut cut) = (0.0, [0.0; 3]);
    for (texel, normal) in &examined {
        let phong = specular.at(*texel);
        if phong.scale <= 0.0 {
            continue;
        }
        let height_m = f64::from(field.heights_m()[*texel]) + field.base_m();
        let [row, col] = [field.rows() - 1 - texel / cols, texel % cols].map(|i| i as f64);
        let place = DVec3::new(col * cell_x, row * cell_y, height_m);
        let view = eye_m.map_or(DVec3::Z, |eye| (DVec3::from(eye) - place).normalize_or(DVec3::Z));
        let facing = normal.dot(view);
        if facing > 0.0 {
            front += 1.0;
            let mirror_up = 2.0 * facing * normal.z - view.z;
            if mirror_up < mean_slope_rad.sin() {
                let below = BY_EXPONENT.iter().filter(|(most, _)| phong.exponent > *most).count();
                cut[..=below].iter_mut().for_each(|count| *count += 1.0);
            }
        }
    }
    cut.map(|count| if front > 0.0 { count / front } else { 0.0 })
}

/// All texels of a small field. Of a large one, one at a random place in each cell of a grid: even steps would miss what repeats.
fn places([rows, cols]: [usize; 2]) -> impl Iterator<Item = [usize; 2]> {
    let [down, across] = [rows, cols].map(|count| count.min(EXAMINED));
    let at = |i: usize, cells: usize, count: usize, bits: u64| {
        let place = (i as f64 + unit(bits)) * count as f64 / cells as f64;
        if cells == count { i } else { (place as usize).min(count - 1) }
    };
    (0..down * across).map(move |i| {
        let bits = mixed(STEP.wrapping_mul(i as u64));
        [at(i / across, down, rows, bits), at(i % across, across, cols, mixed(bits))]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Border, Environment, Lights, PhongSpecular, Sun};

    /// A plane that rises towards the north at this slope, with specular under a sky.
    fn slope(degrees: f64, exponent: f32) -> Scene {
        let rise = degrees.to_radians().tan();
        let heights: Vec<f64> = (0..64).map(|i| 2.0 * rise * f64::from(7 - i / 8)).collect();
        let specular = Some(Specular::Constant(PhongSpecular { exponent, scale: 0.4 }));
        Scene {
            field: HeightField::new(8, 8, &heights, [2.0; 2], None).unwrap(),
            surface: Surface { specular, border: Border::Open, ..Surface::default() },
            lights: Lights { sky: Some([1.0; 3]), ..Lights::default() },
        }
    }

    fn azimuths(scene: &Scene, eye_m: Option<[f64; 3]>) -> u32 {
        let suited = Quality::for_scene(scene, eye_m);
        assert_eq!(Quality { azimuths: 32, ..suited }, Quality::DEFAULT);
        suited.azimuths
    }

    /// Viewed from above, a plane mirrors the view at 90° minus twice its slope: lower than its slope from 30° on.
    #[test]
    fn narrow_lobes_on_steep_ground_have_more_azimuths_by_default() {
        assert_eq!([29.0, 31.0].map(|degrees| azimuths(&slope(degrees, 20.0), None)), [32, 64]);
        for (exponent, wanted) in
            [(0.0, 64), (50.0, 64), (51.0, 128), (3000.0, 128), (3001.0, 256), (1e4, 256)]
        {
            assert_eq!(azimuths(&slope(40.0, exponent), None), wanted, "{exponent}");
            assert_eq!(azimuths(&slope(10.0, exponent), None), 32, "{exponent}");
        }
        let steep = slope(40.0, 1e3);
        let lit = |lights: Lights| Scene { lights, ..steep.clone() };
        let environment = Some(Environment::new(2, 4, vec![[1.0; 3]; 8], 0.0).unwrap());
        let under_environment = Lights { environment, ..Lights::default() };
        assert_eq!(azimuths(&lit(under_environment.clone()), None), 128);
        let narrow = Scene { lights: under_environment.clone(), ..slope(40.0, 1e4) };
        assert_eq!(azimuths(&narrow, None), 128);
        let sun =
            Sun { azimuth_rad: 0.0, elevation_rad: 0.5, diameter_rad: 0.0, irradiance: [1.0; 3] };
        for lights in [
            Lights::default(),
            Lights { sky: Some([0.0; 3]), ..Lights::default() },
            Lights { suns: vec![sun], ..Lights::default() },
        ] {
            assert_eq!(azimuths(&lit(lights.clone()), None), 32, "{lights:?}");
        }
        let with = |specular| Scene {
            surface: Surface { specular, ..steep.surface.clone() },
            ..steep.clone()
        };
        let of = |exponent, scale| PhongSpecular { exponent, scale };
        assert_eq!(azimuths(&with(None), None), 32);
        assert_eq!(azimuths(&with(Some(Specular::Constant(of(1e3, 0.0)))), None), 32);
        let map = |narrow: usize, rest: PhongSpecular| {
            let mut map = vec![rest; 64];
            map[..narrow].fill(of(5e3, 0.1));
            with(Some(Specular::Map(map)))
        };
        // An eighth of the texels decides.
        assert_eq!(azimuths(&map(8, of(5.0, 0.4)), None), 256);
        assert_eq!(azimuths(&map(7, of(5.0, 0.4)), None), 64);
        // Only texels that reflect count.
        assert_eq!(azimuths(&map(1, of(5.0, 0.0)), None), 256);
        assert_eq!(azimuths(&map(0, of(5.0, 0.0)), None), 32);
        let under = |scene: Scene| Scene { lights: under_environment.clone(), ..scene };
        assert_eq!(azimuths(&under(map(8, of(5.0, 0.4))), None), 32);
        assert_eq!(azimuths(&under(map(0, of(1e3, 0.4))), None), 64);
        let unknown = HeightField::unknown(8, 8, [2.0; 2]).unwrap();
        assert_eq!(azimuths(&Scene { field: unknown, ..steep }, None), 32);
    }

    /// Half of a field is steep. What it reflects decides, and voids do not count.
    #[test]
    fn texels_that_reflect_decide() {
        let all = slope(40.0, 20.0);
        let height_m = |h: &f32| (f64::from(*h) + all.field.base_m()).max(6.0);
        let heights: Vec<f64> = all.field.heights_m().iter().map(height_m).collect();
        let is_steep = |i: usize| heights[i] > 6.0;
        assert_eq!((0..64).filter(|i| is_steep(*i)).count(), 32);
        let of = |steep: f32, flat: f32| {
            let scale = |i| if is_steep(i) { steep } else { flat };
            let at = |i| PhongSpecular { exponent: 20.0, scale: scale(i) };
            Some(Specular::Map((0..64).map(at).collect()))
        };
        let with = |specular, voids| Scene {
            field: HeightField::new(8, 8, &heights, [2.0; 2], voids).unwrap(),
            surface: Surface { specular, ..all.surface.clone() },
            lights: all.lights.clone(),
        };
        assert_eq!(azimuths(&with(of(0.4, 0.0), None), None), 64);
        assert_eq!(azimuths(&with(of(0.0, 0.4), None), None), 32);
        let steep: Vec<bool> = (0..64).map(is_steep).collect();
        assert_eq!(azimuths(&with(of(0.4, 0.4), Some(steep)), None), 32);
    }

    /// Ridges four texels apart: every second row is flat.
    #[test]
    fn what_repeats_is_not_missed() {
        let heights: Vec<f64> = (0..512 * 4).map(|i| [0.0, 10.0, 20.0, 10.0][i / 4 % 4]).collect();
        let field = HeightField::new(512, 4, &heights, [10.0; 2], None).unwrap();
        assert_eq!(azimuths(&Scene { field, ..slope(0.0, 20.0) }, None), 64);
    }

    /// A plane that falls to the south at 10°. For an eye in the north at 20° elevation, the mirror direction is horizontal, to the
    /// south. For one in the south it is 40° up, to the north. An eye in the north at 5° is behind the plane; its texels do not count.
    #[test]
    fn the_eye_decides_which_lobes_a_horizon_cuts() {
        let eye = |north: f64, degrees: f64| {
            let [across, up] = [north, 1.0].map(|sign| sign * 1e6);
            Some([7.0, across * degrees.to_radians().cos(), up * degrees.to_radians().sin()])
        };
        let scene = slope(10.0, 20.0);
        assert_eq!(azimuths(&scene, eye(1.0, 20.0)), 64);
        assert_eq!(azimuths(&scene, eye(1.0, 50.0)), 32);
        assert_eq!(azimuths(&scene, eye(-1.0, 20.0)), 32);
        assert_eq!(azimuths(&scene, eye(1.0, 5.0)), 32);
    }
}

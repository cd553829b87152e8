use ridgelight::scene::{
    Albedo, Border, Environment, HeightField, KeyLight, Lights, PhongSpecular, Scene, Specular,
    SphereLight, Sun, Surface,
};

use crate::errors::{Done, Failure};
use crate::plan::RidgelightOuter;
use crate::read::{SizeFirst, numbers, pick, read, read_all};

/// A disc of uniform radiance at infinity.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightSun {
    /// sizeof(RidgelightSun).
    pub struct_size: u32,
    /// Irradiance on a surface that faces it, unoccluded, linear RGB.
    pub irradiance: [f32; 3],
    /// Direction of the centre in the plane, radians counter-clockwise from east.
    pub azimuth_rad: f64,
    /// Elevation of the centre, radians, [0..pi/2]; pi/2 rounded to float counts as pi/2.
    pub elevation_rad: f64,
    /// Angular diameter, radians, [0..pi/2] like the elevation; below 0.01 degrees a point with hard shadows.
    pub diameter_rad: f64,
}

// SAFETY: numbers; the size is first.
unsafe impl SizeFirst for RidgelightSun {}

/// A patch of uniform radiance at infinity, between two azimuths and two elevations.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightKeyLight {
    /// sizeof(RidgelightKeyLight).
    pub struct_size: u32,
    /// Radiance, linear RGB.
    pub radiance: [f32; 3],
    /// Direction of its middle in the plane, radians counter-clockwise from east.
    pub azimuth_rad: f64,
    /// Extent in azimuth, radians, above 0 up to 2 pi; 2 pi rounded to float counts as 2 pi.
    pub width_rad: f64,
    /// Its lowest and its highest elevation, radians, [-pi/2..pi/2]; pi/2 rounded to float counts as pi/2.
    pub elevations_rad: [f64; 2],
}

// SAFETY: numbers; the size is first.
unsafe impl SizeFirst for RidgelightKeyLight {}

/// A sphere light: a sphere of uniform radiance near the field.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightSphereLight {
    /// sizeof(RidgelightSphereLight).
    pub struct_size: u32,
    /// Radiance, linear RGB.
    pub radiance: [f32; 3],
    /// Centre: x east from the westernmost column, y north from the southernmost row, z as heights.
    pub position_m: [f64; 3],
    /// Radius, above 0.
    pub radius_m: f64,
}

// SAFETY: numbers; the size is first.
unsafe impl SizeFirst for RidgelightSphereLight {}

/// Beyond the field's edge the ground continues at horizontal forever: the default.
pub const RIDGELIGHT_BORDER_PLANE: u32 = 1;
/// Nothing is beyond the edge: light may come from below horizontal.
pub const RIDGELIGHT_BORDER_OPEN: u32 = 2;
/// The field repeats.
pub const RIDGELIGHT_BORDER_PERIODIC: u32 = 3;

/// A field, its surface, and its lights. Heights come from an image with each frame, in the unit of `cell_m`,
/// never NaN; the host need not know them. Data behind pointers is copied.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightScene {
    /// sizeof(RidgelightScene).
    pub struct_size: u32,
    /// Rows of grid points, row 0 in the north.
    pub rows: u32,
    /// Columns of grid points, column 0 in the west.
    pub cols: u32,
    /// The ground beyond the field's edge, a RIDGELIGHT_BORDER_; 0: PLANE.
    pub border: u32,
    /// Spacing of columns and of rows, in the unit of heights; 0, 0: 1, 1.
    pub cell_m: [f64; 2],
    /// Radiance of a uniform sky, linear RGB; 0, 0, 0: none.
    pub sky: [f32; 3],
    /// Diffuse reflectance, linear RGB, [0..1]; 0, 0, 0: 1, 1, 1.
    pub albedo: [f32; 3],
    /// VK_TRUE for an image of reflectance instead.
    pub albedo_is_map: u32,
    /// VK_TRUE for an environment: an image whose centre is east, its left quarter north, row 0 the zenith.
    pub has_environment: u32,
    /// The map's texels, RGB; null where only the device has them.
    pub albedo_map: *const f32,
    /// The environment's texels, RGB; null where only the device has them: azimuths are even then.
    pub environment: *const f32,
    /// Texels around the full circle.
    pub environment_width: u32,
    /// Texels from zenith to nadir.
    pub environment_height: u32,
    /// Counter-clockwise rotation of the environment, radians.
    pub environment_rotation_rad: f64,
    /// Phong specular: exponent of the lobe about the mirror direction of the view (`eye_m`), [0..1e4].
    pub specular_exponent: f32,
    /// Phong specular: share of light that it reflects, [0..1]; 0: none.
    pub specular_scale: f32,
    /// Suns, consecutive.
    pub suns: *const RidgelightSun,
    /// Key lights, consecutive.
    pub keys: *const RidgelightKeyLight,
    /// Sphere lights, consecutive.
    pub spheres: *const RidgelightSphereLight,
    /// Number of suns.
    pub sun_count: u32,
    /// Number of key lights.
    pub key_count: u32,
    /// Number of sphere lights.
    pub sphere_count: u32,
    /// VK_TRUE where the field has voids: camera pictures then take a mask and leave holes. Heights must still
    /// be filled there: ridgelight_fill_voids.
    pub has_voids: u32,
    /// Eye position for specular, metres; read if `has_eye` is VK_TRUE: x east from the westernmost column, y north from the
    /// southernmost row, z as heights, each within +-1e15. With bounces it needs a `bounce_specular` other than scalar.
    /// Diffuse light does not depend on it.
    pub eye_m: [f64; 3],
    /// VK_TRUE where specular is viewed from `eye_m`; 0: from straight above.
    pub has_eye: u32,
    /// 0.
    pub reserved: u32,
}

// SAFETY: numbers and pointers that may be null; the size is first.
unsafe impl SizeFirst for RidgelightScene {}

/// The scene that a struct describes.
///
/// # Safety
/// As [`read`]; its pointers are null or point to data of the given sizes and counts.
pub(crate) unsafe fn scene(from: *const RidgelightScene) -> Done<Scene> {
    // SAFETY: as the caller says, here and below.
    let scene = unsafe { read(from, "scene") }?;
    if scene.reserved != 0 {
        return Err(Failure::argument("scene: reserved", scene.reserved, "0"));
    }
    let samples = scene.rows as usize * scene.cols as usize;
    let field = field([scene.rows, scene.cols], scene.cell_m, "scene")?;
    let borders = [Border::Plane, Border::Open, Border::Periodic];
    let surface = Surface {
        // SAFETY: as the caller says.
        albedo: unsafe { albedo(&scene, samples) },
        border: pick("scene: border", scene.border, Border::Plane, &borders)?,
        specular: (scene.specular_scale != 0.0)
            .then_some(PhongSpecular {
                exponent: scene.specular_exponent,
                scale: scene.specular_scale,
            })
            .map(Specular::Constant),
    };
    // SAFETY: as the caller says.
    Ok(Scene { field, surface, lights: unsafe { lights(&scene) }? })
}

/// A field whose heights only the device has.
fn field([rows, cols]: [u32; 2], cell_m: [f64; 2], name: &str) -> Done<HeightField> {
    if !(1..=1 << 30).contains(&(u64::from(rows) * u64::from(cols))) {
        let found = format!("{rows} x {cols}");
        let expected = "at least one sample, at most 2^30";
        return Err(Failure::argument(&format!("{name}: rows and cols"), found, expected));
    }
    let cell_m = if cell_m == [0.0; 2] { [1.0; 2] } else { cell_m };
    Ok(HeightField::unknown(rows as usize, cols as usize, cell_m)?)
}

/// The coarser field that a struct describes, and the place of the other in its grid.
///
/// # Safety
/// As [`read`].
pub(crate) unsafe fn outer(from: *const RidgelightOuter) -> Done<(HeightField, [f64; 2])> {
    // SAFETY: as the caller says.
    let outer = unsafe { read(from, "outer") }?;
    if outer.reserved != 0 {
        return Err(Failure::argument("outer: reserved", outer.reserved, "0"));
    }
    Ok((field([outer.rows, outer.cols], outer.cell_m, "outer")?, outer.place))
}

fn texels(values: &[f32]) -> Vec<[f32; 3]> {
    values.as_chunks::<3>().0.to_vec()
}

unsafe fn albedo(scene: &RidgelightScene, samples: usize) -> Albedo {
    if scene.albedo_is_map != 0 {
        // SAFETY: as the caller of `scene` guarantees.
        let known = unsafe { numbers(scene.albedo_map, 3 * samples) };
        return known.map_or_else(|| Albedo::unknown(samples), |m| Albedo::Map(texels(m)));
    }
    Albedo::Constant(if scene.albedo == [0.0; 3] { [1.0; 3] } else { scene.albedo })
}

unsafe fn lights(scene: &RidgelightScene) -> Done<Lights> {
    let sky = (scene.sky != [0.0; 3]).then_some(scene.sky);
    let mut lights = Lights { sky, ..Lights::default() };
    if scene.has_environment != 0 {
        let (width, height) = (scene.environment_width, scene.environment_height);
        let count = u64::from(width) * u64::from(height);
        if !(1..=1 << 28).contains(&count) {
            let found = format!("{width} x {height}");
            let name = "scene: environment_width and environment_height";
            return Err(Failure::argument(name, found, "at least one texel, at most 2^28"));
        }
        let (width, height) = (width as usize, height as usize);
        let turn = scene.environment_rotation_rad;
        // SAFETY: as the caller of `scene` guarantees.
        let known = unsafe { numbers(scene.environment, 3 * count as usize) };
        lights.environment = Some(match known {
            Some(values) => Environment::new(width, height, texels(values), turn)?,
            None => Environment::unknown(width, height, turn)?,
        });
    }
    // SAFETY: as the caller of `scene` guarantees.
    let (suns, keys, spheres) = unsafe {
        (
            read_all(scene.suns, scene.sun_count, "sun")?,
            read_all(scene.keys, scene.key_count, "key light")?,
            read_all(scene.spheres, scene.sphere_count, "sphere light")?,
        )
    };
    lights.suns = suns
        .into_iter()
        .map(|s| Sun {
            azimuth_rad: s.azimuth_rad,
            elevation_rad: s.elevation_rad,
            diameter_rad: s.diameter_rad,
            irradiance: s.irradiance,
        })
        .collect();
    lights.keys = keys
        .into_iter()
        .map(|k| KeyLight {
            azimuth_rad: k.azimuth_rad,
            width_rad: k.width_rad,
            elevations_rad: k.elevations_rad,
            radiance: k.radiance,
        })
        .collect();
    lights.sphere_lights = spheres
        .into_iter()
        .map(|s| SphereLight {
            position_m: s.position_m,
            radius_m: s.radius_m,
            radiance: s.radiance,
        })
        .collect();
    Ok(lights)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All but `has_voids`, which the view reads: `voids_of_c_are_filled_and_masked`.
    #[test]
    fn every_field_of_a_scene_arrives() {
        let suns = [RidgelightSun {
            struct_size: size_of::<RidgelightSun>() as u32,
            irradiance: [1.0, 2.0, 3.0],
            azimuth_rad: 0.1,
            elevation_rad: 0.2,
            diameter_rad: 0.3,
        }; 2];
        let keys = [RidgelightKeyLight {
            struct_size: size_of::<RidgelightKeyLight>() as u32,
            radiance: [4.0, 5.0, 6.0],
            azimuth_rad: 0.4,
            width_rad: 0.5,
            elevations_rad: [0.6, 0.7],
        }; 3];
        let spheres = [RidgelightSphereLight {
            struct_size: size_of::<RidgelightSphereLight>() as u32,
            radiance: [7.0, 8.0, 9.0],
            position_m: [10.0, 11.0, 12.0],
            radius_m: 0.8,
        }; 4];
        let numbers: Vec<f32> = (1..=3 * 8 * 4).map(|i| i as f32 / 128.0).collect();
        let [albedo, environment] = [&numbers[..3 * 5 * 3], &numbers[..]];
        let given = RidgelightScene {
            struct_size: size_of::<RidgelightScene>() as u32,
            rows: 5,
            cols: 3,
            border: RIDGELIGHT_BORDER_PERIODIC,
            cell_m: [13.0, 14.0],
            sky: [0.11, 0.12, 0.13],
            albedo: [0.14, 0.15, 0.16],
            albedo_is_map: 1,
            has_environment: 1,
            albedo_map: albedo.as_ptr(),
            environment: environment.as_ptr(),
            environment_width: 8,
            environment_height: 4,
            environment_rotation_rad: 0.9,
            specular_exponent: 15.0,
            specular_scale: 0.17,
            suns: suns.as_ptr(),
            keys: keys.as_ptr(),
            spheres: spheres.as_ptr(),
            sun_count: 2,
            key_count: 3,
            sphere_count: 4,
            has_voids: 0,
            eye_m: [0.0; 3],
            has_eye: 0,
            reserved: 0,
        };
        // SAFETY: arrays of this function, of these sizes, or null.
        let of = |given: &RidgelightScene| unsafe { scene(given) }.ok().expect("a scene");
        let found = of(&given);
        let (field, surface, lights) = (&found.field, &found.surface, &found.lights);
        assert_eq!((field.rows(), field.cols(), field.cell_m()), (5, 3, [13.0, 14.0]));
        let map = albedo.chunks(3).map(|c| [c[0], c[1], c[2]]).collect();
        assert_eq!(surface.albedo, Albedo::Map(map));
        let phong = PhongSpecular { exponent: 15.0, scale: 0.17 };
        assert_eq!(surface.specular, Some(Specular::Constant(phong)));
        assert_eq!(lights.sky, Some([0.11, 0.12, 0.13]));
        let around = lights.environment.as_ref().expect("an environment");
        assert_eq!((around.width(), around.height(), around.rotation_rad()), (8, 4, 0.9));
        assert_eq!(around.texels().as_flattened(), environment);
        let sun = Sun {
            azimuth_rad: 0.1,
            elevation_rad: 0.2,
            diameter_rad: 0.3,
            irradiance: [1.0, 2.0, 3.0],
        };
        assert_eq!(lights.suns, [sun; 2]);
        let key = KeyLight {
            azimuth_rad: 0.4,
            width_rad: 0.5,
            elevations_rad: [0.6, 0.7],
            radiance: [4.0, 5.0, 6.0],
        };
        assert_eq!(lights.keys, [key; 3]);
        let sphere = SphereLight {
            position_m: [10.0, 11.0, 12.0],
            radius_m: 0.8,
            radiance: [7.0, 8.0, 9.0],
        };
        assert_eq!(lights.sphere_lights, [sphere; 4]);

        let constant = of(&RidgelightScene { albedo_is_map: 0, ..given });
        assert_eq!(constant.surface.albedo, Albedo::Constant([0.14, 0.15, 0.16]));
        let borders = [
            (0, Border::Plane),
            (RIDGELIGHT_BORDER_PLANE, Border::Plane),
            (RIDGELIGHT_BORDER_OPEN, Border::Open),
            (RIDGELIGHT_BORDER_PERIODIC, Border::Periodic),
        ];
        assert_eq!(borders.map(|(value, _)| value), [0, 1, 2, 3]);
        for (border, wanted) in borders {
            let found = of(&RidgelightScene { border, ..given });
            assert_eq!(found.surface.border, wanted, "{border}");
        }
    }
}

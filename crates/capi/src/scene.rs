use ridgelight::scene::{
    Albedo, Border, Environment, HeightField, KeyLight, Lights, PhongSpecular, Quality, Scene,
    Specular, SphereLight, Sun, Surface, Values, setting,
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

/// Speed against accuracy. In every field 0 is the default.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightQuality {
    /// sizeof(RidgelightQuality).
    pub struct_size: u32,
    /// How horizons are found: 1 auto (default), 2 sweep, 3 pyramid, 4 brute-force.
    pub method: u32,
    /// Azimuths of sky and environment, [4..1024], default 64. Fewer: faster, banding at sharp silhouettes.
    pub azimuths: u32,
    /// Slices across a sun's disc, a key light or a sphere light, [1..256], default 8. Fewer: faster, steps in
    /// soft shadows.
    pub sun_azimuths: u32,
    /// Distance between the lines of a sweep: 1 exact, 2 a quarter of a cell, 3 half a cell, 4 a cell (default),
    /// 5 two cells, 6 four cells. Wider: faster, small occluders missed between lines.
    pub lines: u32,
    /// How the results of lines are interpolated to grid points: 1 nearest, 2 slopes, 3 own, 4 aimed-nearest
    /// (default), 5 aimed, 6 aimed-around. aimed-nearest is as fast as nearest and more exact than the first three
    /// (measured on llvmpipe, lines one cell apart).
    /// aimed and aimed-around are slower and more exact.
    pub fuse: u32,
    /// Precision of stored sweep results: 1 f32 (default), 2 f16. (A packed hull would need the heights
    /// beforehand.)
    pub precision: u32,
    /// Hull storage: 1 auto (default), 2 private, 3 shared, 4 occluder-list. Never changes the result.
    pub hull: u32,
    /// Levels per doubling of distance in a height pyramid, [1..16], default 4. Fewer: faster, smeared
    /// horizons.
    pub level_step: u32,
    /// One more than the doublings of resolution by which a pyramid march reads finer levels, [1..5], default
    /// 3. Fewer: blurred distant horizons.
    pub level_offset_plus_1: u32,
    /// How a pyramid's levels are stored: 1 stack (default), 2 pyramid: less memory, slower.
    pub levels: u32,
    /// Elevations of an environment table, [8..4096], default 256. Fewer: faster, small bright places smeared.
    pub table_elevations: u32,
    /// How an environment is evaluated: 1 auto (default), 2 table, 3 sh.
    pub basis: u32,
    /// SH order of visibility, [2..6], default 4.
    pub sh_order: u32,
    /// How visibility becomes SH: 1 slices (default), 2 nlp, 3 table.
    pub wedges: u32,
    /// Receiver: how visibility becomes light: 1 plane (default), 2 cosine.
    pub receiver: u32,
    /// SH window: 1 none (default), 2 lanczos, 3 hann, 4 nonnegative.
    pub window: u32,
    /// Visibility is found at every nth grid point, n = 1, 2 or 4, default 1. More: faster, blurred shadows.
    pub subsample: u32,
    /// Horizons per side of a table of wedges, [4..256], default 64.
    pub wedge_side: u32,
    /// Basis of sphere lights: 1 exact (default), 2 sh.
    pub light_basis: u32,
    /// Largest light that a texel may lose from all sphere lights together, as a share of the brightest light
    /// that one of them would give to level ground at height 0, [0..1], default 1/65536; below 0: none.
    pub light_cutoff: f64,
    /// Number of bounces of light, [0..64].
    pub bounces: u32,
    /// How bounced light is found: 1 brute-force, 2 sweep, 3 pyramid, 4 auto (default).
    pub bounce_engine: u32,
    /// Azimuths of bounced light per grid point, [4..1024], default 32.
    pub bounce_azimuths: u32,
    /// As level_step, for the pyramid of exit radiance, [1..16], default 4.
    pub bounce_level_step: u32,
    /// As level_offset_plus_1, for the pyramid of exit radiance, [1..5], default 3.
    pub bounce_level_offset_plus_1: u32,
    /// Share of the direct light's energy that bounces may leave out, [0..1], default 1/65536; below 0: none.
    pub bounce_cutoff: f64,
    /// Storage of specular light between bounces: 1 vector (default), 2 vector-f16, 3 scalar.
    pub bounce_specular: u32,
}

// SAFETY: numbers; the size is first.
unsafe impl SizeFirst for RidgelightQuality {}

/// Calls a macro with every setting's field.
macro_rules! each_field {
    ($call:ident) => {
        $call! {
            method azimuths sun_azimuths lines fuse precision hull level_step level_offset_plus_1
            levels table_elevations basis sh_order wedges receiver window subsample wedge_side
            light_basis light_cutoff bounces bounce_engine bounce_azimuths bounce_level_step
            bounce_level_offset_plus_1 bounce_cutoff bounce_specular
        }
    };
}

/// The quality that a struct describes; null is the default.
///
/// # Safety
/// As [`read`].
pub(crate) unsafe fn quality(from: *const RidgelightQuality) -> Done<Quality> {
    let default = Quality::default();
    if from.is_null() {
        return Ok(default);
    }
    // SAFETY: as the caller says.
    let q = unsafe { read(from, "quality") }?;
    // 0 is the default. Words count from 1. Numbers that may be 0 have 1 added; a share below 0 is 0.
    macro_rules! values {
        ($($field:ident)*) => { [$((stringify!($field), f64::from(q.$field))),*] };
    }
    let mut quality = default;
    for (field, value) in each_field!(values).into_iter().filter(|(_, value)| *value != 0.0) {
        let name = field.strip_suffix("_plus_1");
        let setting = setting(name.unwrap_or(field)).expect("a field for each setting");
        let text = match &setting.values {
            // NaN stays NaN, which the setting refuses.
            Values::Share if value < 0.0 => "0".to_owned(),
            Values::Share => value.to_string(),
            Values::Words(words) => {
                // A packed hull would need the heights beforehand.
                let count = words.len() - usize::from(field == "precision");
                let word = words[..count].get(value as usize - 1).ok_or_else(|| {
                    let expected = format!("one of its constants, 0 to {count}");
                    Failure::argument(&format!("quality: {field}"), value, &expected)
                })?;
                word.name.to_owned()
            }
            _ => (value - if name.is_some() { 1.0 } else { 0.0 }).to_string(),
        };
        setting.set(&mut quality, &text)?;
    }
    Ok(quality)
}

#[cfg(test)]
mod tests;

use std::ffi::c_char;

use ash::vk;
use ridgelight::gpu;
use ridgelight::plan::{self, Format, Kind, Owner, Picture, Plan, Resource};
use ridgelight::scene::{Border, Quality};

use crate::errors::{Done, Failure, RidgelightResult, done};
use crate::quality::{RidgelightQuality, quality};
use crate::read::{SizeFirst, hand_out, handle, handle_mut, read, write};
use crate::scene::{RidgelightScene, outer, scene};
use crate::types::{RidgelightHost, host};

/// The passes that light one scene, in order, and their resources; plain data. Threads may share it, except
/// during ridgelight_plan_take_buffer.
pub struct RidgelightPlan(pub(crate) Plan);

impl RidgelightPlan {
    /// The settings in use, as (name, value): for Rust.
    pub fn settings(&self) -> &[(String, String)] {
        &self.0.settings
    }
}

/// Also an image for each light and each bounce.
pub const RIDGELIGHT_PICTURE_LIGHT_LAYERS: u32 = 1;
/// Also the light of a sky of radiance 1 on albedo 1.
pub const RIDGELIGHT_PICTURE_SKY_VIEW: u32 = 2;
/// Keeps the horizons, so that lights alone may change, and rectangles of heights may be edited.
pub const RIDGELIGHT_PICTURE_KEEPS_HORIZONS: u32 = 4;
/// Radiances of the sky and of key lights and irradiances of suns come from the caller's image on the device.
/// It is the last input, "light_colours", a row of texels: the sky's where the scene's is not 0, then each
/// sun's, then each key light's. The scene's own colours then do not matter, except the sky's beside an
/// environment, which affects the choice of azimuths. Not with sphere lights or specular.
pub const RIDGELIGHT_PICTURE_COLOURS_ON_DEVICE: u32 = 8;

/// Plans a picture of a scene for a host's device. `quality` may be null; `picture` is flags
/// RIDGELIGHT_PICTURE_; `memory_budget` is bytes of all images and buffers, 0: half of the largest heap, all
/// of a software driver's.
///
/// Returns OK, ARGUMENT, SETTING or LIMIT.
///
/// # Safety
/// Pointers are null, or to structs whose struct_size is set and whose pointers and handles are as their fields
/// require; `plan` may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_plan_create(
    host: *const RidgelightHost,
    scene: *const RidgelightScene,
    quality: *const RidgelightQuality,
    picture: u32,
    memory_budget: u64,
    plan: *mut *mut RidgelightPlan,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        hand_out(plan, || {
            let host = self::host(host)?;
            let given = read(scene, "scene")?;
            let scene = self::scene(scene)?;
            let mut picture = wanted(picture)?;
            picture.eye_m = (given.has_eye != 0).then_some(given.eye_m);
            let default = Quality::for_scene(&scene, picture.eye_m);
            let quality = self::quality(quality, default)?;
            let mut limits = gpu::limits(&host.instance, host.physical_device);
            if memory_budget != 0 {
                limits.memory_budget = memory_budget;
            }
            Ok(RidgelightPlan(plan::picture(&scene, &quality, &limits, picture)?))
        })
    })
}

/// An outer field: a coarser field that contains another one.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightOuter {
    /// sizeof(RidgelightOuter).
    pub struct_size: u32,
    /// Rows of grid points.
    pub rows: u32,
    /// Columns of grid points.
    pub cols: u32,
    /// 0.
    pub reserved: u32,
    /// Spacing of columns and of rows, in the unit of heights; 0, 0: 1, 1.
    pub cell_m: [f64; 2],
    /// Column and row, in the grid of this outer field, of the inner field's first grid point.
    pub place: [f64; 2],
}

// SAFETY: numbers; the size is first.
unsafe impl SizeFirst for RidgelightOuter {}

/// Plans the shadow heights of the scene's one sun over its field. The rest of the scene is ignored.
///
/// Outputs, R32F: "lit_above", the height from which the whole sun is visible, in the unit and from the zero of
/// "heights". "penumbra", the distance from there down to the height at which its occluder hides the whole sun. "sun_share", the
/// visible share of the sun's disc at the ground, [0..1]. Inputs: "heights". With `outer` (may be null) also
/// "outer_lit_above" and "outer_penumbra", the outputs of a renderer of `outer` for the same sun.
///
/// The plan has `parts` passes (0 means 1), each for some lines of the field. Record them in order, in one frame or in
/// several (ridgelight_record_passes). The plan of any other sun can replace it.
///
/// Returns OK, ARGUMENT, SETTING or LIMIT.
///
/// # Safety
/// As ridgelight_plan_create.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_shadow_heights_create(
    host: *const RidgelightHost,
    scene: *const RidgelightScene,
    outer: *const RidgelightOuter,
    parts: u32,
    plan: *mut *mut RidgelightPlan,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        hand_out(plan, || {
            let host = self::host(host)?;
            let scene = self::scene(scene)?;
            let [sun] = scene.lights.suns[..] else {
                let found = scene.lights.suns.len().to_string();
                return Err(Failure::argument("scene: sun_count", found, "1"));
            };
            if scene.surface.border == Border::Periodic {
                return Err(Failure::argument("scene: border", "PERIODIC", "PLANE or OPEN"));
            }
            let around = if outer.is_null() { None } else { Some(self::outer(outer)?) };
            let around = around.as_ref().map(|(field, place)| (field, *place));
            let limits = gpu::limits(&host.instance, host.physical_device);
            let parts = parts.max(1);
            let made = plan::shadow_heights(&scene.field, &sun, around, parts, &limits)?;
            Ok(RidgelightPlan(made))
        })
    })
}

fn wanted(flags: u32) -> Done<Picture> {
    let all = RIDGELIGHT_PICTURE_LIGHT_LAYERS
        | RIDGELIGHT_PICTURE_SKY_VIEW
        | RIDGELIGHT_PICTURE_KEEPS_HORIZONS
        | RIDGELIGHT_PICTURE_COLOURS_ON_DEVICE;
    if flags & !all != 0 {
        return Err(Failure::argument("picture", flags, "flags RIDGELIGHT_PICTURE_"));
    }
    Ok(Picture {
        light_layers: flags & RIDGELIGHT_PICTURE_LIGHT_LAYERS != 0,
        sky_view: flags & RIDGELIGHT_PICTURE_SKY_VIEW != 0,
        keeps_horizons: flags & RIDGELIGHT_PICTURE_KEEPS_HORIZONS != 0,
        colours_on_device: flags & RIDGELIGHT_PICTURE_COLOURS_ON_DEVICE != 0,
        ..Picture::default()
    })
}

/// Destroys a plan; renderers made for it keep a copy. Null is allowed.
///
/// # Safety
/// It came from ridgelight_plan_create and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_plan_destroy(plan: *mut RidgelightPlan) {
    if !plan.is_null() {
        // SAFETY: as the caller says.
        drop(unsafe { Box::from_raw(plan) });
    }
}

/// Sizes of a plan.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightPlanInfo {
    /// sizeof(RidgelightPlanInfo).
    pub struct_size: u32,
    /// Number of input images.
    pub inputs: u32,
    /// Number of output images.
    pub outputs: u32,
    /// Number of passes, and of timings.
    pub passes: u32,
    /// Bytes of a renderer's own images and buffers.
    pub internal_bytes: u64,
}

// SAFETY: numbers; the size is first.
unsafe impl SizeFirst for RidgelightPlanInfo {}

/// Writes the sizes of a plan.
///
/// Returns OK, or ARGUMENT.
///
/// # Safety
/// `plan` is alive or null; `info` is null or points at a struct whose struct_size is set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_plan_info(
    plan: *const RidgelightPlan,
    info: *mut RidgelightPlanInfo,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        let plan = &handle(plan, "plan")?.0;
        let value = RidgelightPlanInfo {
            struct_size: 0,
            inputs: plan.inputs().count() as u32,
            outputs: plan.outputs().count() as u32,
            passes: plan.passes.len() as u32,
            internal_bytes: plan.internal_bytes(),
        };
        write(info, &value, "info")
    })
}

/// An image that the caller provides for a plan.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightImageInfo {
    /// sizeof(RidgelightImageInfo).
    pub struct_size: u32,
    /// Its format; for inputs the one without loss, see RidgelightImage.
    pub format: vk::Format,
    /// Columns, rows and layers.
    pub extent: [u32; 3],
    /// Its required usage: SAMPLED of an input, STORAGE and SAMPLED of an output; 0 where a buffer is taken instead.
    pub usage: vk::ImageUsageFlags,
    /// "heights", "environment", "albedo", "light_colours"; "radiance", "direct.sky", ...: UTF-8,
    /// nul-terminated.
    pub name: [c_char; 32],
}

// SAFETY: numbers; the size is first.
unsafe impl SizeFirst for RidgelightImageInfo {}

/// Describes input `index` of a plan.
///
/// Returns OK; ARGUMENT, also beyond the last.
///
/// # Safety
/// `plan` is alive or null; `info` is null or points at a struct whose struct_size is set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_plan_input(
    plan: *const RidgelightPlan,
    index: u32,
    info: *mut RidgelightImageInfo,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        let image = handle(plan, "plan")?.0.inputs().nth(index as usize);
        describe(image.map(|(_, r)| r), index, vk::ImageUsageFlags::SAMPLED, info)
    })
}

/// Takes input `index` from a caller's buffer instead of an image, as rows of texels of `format`, 0: that of
/// ridgelight_plan_input. Heights may be R32F, R16F or R16_UNORM; environment, albedo and light colours
/// RGBA32F, RGBA16F, RGBA8 UNORM or SRGB. Each recording then begins with one copy to an image of the
/// renderer's own. Call it before a renderer is made, while nobody else uses the plan.
///
/// Returns OK; ARGUMENT, also beyond the last; SETTING for a format that the input cannot have.
///
/// # Safety
/// `plan` is alive or null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_plan_take_buffer(
    plan: *mut RidgelightPlan,
    index: u32,
    format: vk::Format,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        let plan = &mut handle_mut(plan, "plan")?.0;
        let input = plan.inputs().nth(index as usize).map(|(_, r)| r.clone());
        let input = input
            .ok_or_else(|| Failure::argument("index", index, "less than the plan has of them"))?;
        let known = [
            Format::R32Float,
            Format::R16Float,
            Format::R16Unorm,
            Format::Rgba32Float,
            Format::Rgba16Float,
            Format::Rgba8Unorm,
            Format::Rgba8Srgb,
        ];
        let texels = match format {
            vk::Format::UNDEFINED => input.format(),
            _ => known.into_iter().find(|known| known.vk() == format),
        };
        let found = format!("{format:?}");
        let texels = texels.ok_or_else(|| {
            Failure::argument("format", found, "R32F, R16F, R16_UNORM, RGBA32F, RGBA16F or RGBA8")
        })?;
        Ok(plan.take_buffer(&input.name, texels)?)
    })
}

/// Describes output `index` of a plan.
///
/// Returns OK; ARGUMENT, also beyond the last.
///
/// # Safety
/// `plan` is alive or null; `info` is null or points at a struct whose struct_size is set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_plan_output(
    plan: *const RidgelightPlan,
    index: u32,
    info: *mut RidgelightImageInfo,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        let image = handle(plan, "plan")?.0.outputs().nth(index as usize);
        // Later passes sample outputs of earlier ones: bounces read the direct light.
        let usage = vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::SAMPLED;
        describe(image.map(|(_, r)| r), index, usage, info)
    })
}

unsafe fn describe(
    image: Option<&Resource>,
    index: u32,
    usage: vk::ImageUsageFlags,
    info: *mut RidgelightImageInfo,
) -> Done {
    let resource =
        image.ok_or_else(|| Failure::argument("index", index, "less than the plan has of them"))?;
    let Kind::Image { format, width, height, layers, .. } = resource.kind else {
        return Err(Failure(RidgelightResult::Internal, "a buffer, where images are".to_owned()));
    };
    let is_buffer = resource.owner == Owner::InputBuffer;
    let usage = if is_buffer { vk::ImageUsageFlags::empty() } else { usage };
    let mut value = RidgelightImageInfo {
        struct_size: 0,
        format: format.vk(),
        extent: [width, height, layers],
        usage,
        name: [0; 32],
    };
    text(&mut value.name, &resource.name);
    // SAFETY: as the callers' callers guarantee.
    unsafe { write(info, &value, "info") }
}

/// Copies a text to C, cut off where it does not fit.
pub(crate) fn text<const N: usize>(to: &mut [c_char; N], from: &str) {
    for (to, byte) in to[..N - 1].iter_mut().zip(from.bytes()) {
        *to = byte as c_char;
    }
}

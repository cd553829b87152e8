use ash::vk;
use ridgelight::gpu::{self, ImageArg, InputArg, ViewInputs, ViewOutputs, ViewRenderer};
use ridgelight::plan::{Limits, Plan, Resource, View, ViewOptions};
use ridgelight::scene::{Camera, Lens, Scene};

use crate::allocator::RidgelightAllocator;
use crate::errors::{Done, Failure, RidgelightResult, done};
use crate::plan::RidgelightPlan;
use crate::read::{SizeFirst, hand_out, handle, handle_mut, read, write};
use crate::renderer::{RidgelightRenderer, RidgelightTiming, callbacks, write_timings};
use crate::scene::{RidgelightScene, scene};
use crate::types::{RidgelightHost, RidgelightImage, host};

/// The camera of a picture of a lit field. North is up on the map.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightCamera {
    /// sizeof(RidgelightCamera).
    pub struct_size: u32,
    /// MSAA samples per pixel, 1, 2, 4 or 8, where the device supports them; 0: 4.
    pub samples: u32,
    /// Columns and rows of the picture.
    pub size: [u32; 2],
    /// Azimuth of the eye from the target, in the plane, radians counter-clockwise from east.
    pub azimuth_rad: f64,
    /// Elevation of the eye from the target above horizontal, radians, [-pi/2..pi/2]; pi/2 rounded to float counts
    /// as pi/2.
    pub elevation_rad: f64,
    /// The target in the middle of the picture: x east of the westernmost column, y north of the southernmost
    /// row, z as heights.
    pub target_m: [f64; 3],
    /// Distance from the target to the eye, [1e-9..1e15]. 0: a level field at height 0 just fits the picture,
    /// about its middle, whatever target_m.
    pub distance_m: f64,
    /// Angle between the lower and the upper edge of the picture, radians, [0.001..3]; 0: 40 degrees.
    pub fov_rad: f64,
    /// Above 0, [1e-9..1e15]: parallel rays, and the distance that the picture spans from its lower to its
    /// upper edge.
    pub ortho_height_m: f64,
    /// The mesh has a vertex at every nth grid point, [1..1024], default 1. Larger: faster, coarser.
    pub mesh_step: u32,
    /// Factor before the tone curve, for screen formats; 0: 1.
    pub exposure: f32,
    /// Radiance, linear RGB, of pixels without ground and sky.
    pub background: [f32; 3],
    /// Height of the base of a plinth, metres, with `has_plinth`: walls extend down to it where the edge of the
    /// field is higher. Finite, as heights.
    pub plinth_base_m: f64,
    /// VK_TRUE draws a plinth. A ridgelight_view draws one with every camera or with none.
    pub has_plinth: u32,
    /// 0; any other value is an error.
    pub reserved: u32,
}

// SAFETY: numbers; the size is first.
unsafe impl SizeFirst for RidgelightCamera {}

/// Camera pictures of a lit field, on a device. Any thread may use it, one at a time.
pub struct RidgelightView {
    renderer: ViewRenderer,
    scene: Scene,
    lit: Plan,
    limits: Limits,
    /// The last recorded camera.
    view: View,
    exposure: f32,
    format: vk::Format,
}

/// # Safety
/// As [`read`].
unsafe fn camera_view(
    from: *const RidgelightCamera,
    (scene, has_voids): (&Scene, bool),
    lit: &Plan,
    limits: &Limits,
) -> Done<(View, f32)> {
    // SAFETY: as the caller says.
    let given = unsafe { read(from, "camera") }?;
    if given.reserved != 0 {
        return Err(Failure::argument("camera: reserved", given.reserved.to_string(), "0"));
    }
    let or = |found: f64, default: f64| if found == 0.0 { default } else { found };
    let options = ViewOptions {
        size: given.size,
        samples: if given.samples == 0 { 4 } else { given.samples },
        mesh_step: given.mesh_step.max(1),
        background: given.background,
        plinth_base_m: (given.has_plinth != 0).then_some(given.plinth_base_m),
    };
    options.check()?;
    let lens = match given.ortho_height_m {
        0.0 => Lens::Perspective { fov_rad: or(given.fov_rad, 40_f64.to_radians()) },
        height_m => Lens::Orthographic { height_m },
    };
    let RidgelightCamera { target_m, azimuth_rad, elevation_rad, distance_m, .. } = given;
    let angles = [azimuth_rad, elevation_rad];
    let camera = match distance_m {
        0.0 => {
            Camera { lens, ..Camera::around(&scene.field, None, angles, lens, options.aspect()) }
        }
        _ => Camera { target_m, azimuth_rad, elevation_rad, distance_m, lens },
    };
    let exposure = if given.exposure == 0.0 { 1.0 } else { given.exposure };
    let mut view = View::new(scene, lit, &camera, &options, limits)?;
    view.has_voids = has_voids;
    Ok((view, exposure))
}

/// Makes the resources for pictures of a scene's light, for `slots` frames in flight (0: 1); `plan` lights it.
/// `format` is R32G32B32A32 or R16G16B16A16 SFLOAT for linear radiance; or a screen format of 8 or 10 bits per
/// colour, UNORM or SRGB, which gets exposure, tone curve and sRGB. `allocator` may be null.
///
/// The host's family needs graphics.
///
/// Returns OK, ARGUMENT, SETTING, LIMIT or DEVICE.
///
/// # Safety
/// As ridgelight_renderer_create; `scene` and `camera` are null or structs whose struct_size is set, `scene`'s
/// pointers are as their fields require.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_view_create(
    host: *const RidgelightHost,
    scene: *const RidgelightScene,
    plan: *const RidgelightPlan,
    camera: *const RidgelightCamera,
    format: vk::Format,
    slots: u32,
    allocator: *const RidgelightAllocator,
    view: *mut *mut RidgelightView,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        hand_out(view, || {
            let host = self::host(host)?;
            let has_voids = read(scene, "scene")?.has_voids != 0;
            let (scene, lit) = (self::scene(scene)?, handle(plan, "plan")?.0.clone());
            let limits = gpu::limits(&host.instance, host.physical_device);
            let (view, exposure) = camera_view(camera, (&scene, has_voids), &lit, &limits)?;
            let slots = slots.max(1) as usize;
            let renderer = match callbacks(allocator)? {
                Some(memory) => {
                    ViewRenderer::with_memory(&host, (&view, format), slots, Box::new(memory))
                }
                None => ViewRenderer::new(&host, &view, format, slots),
            }?;
            Ok(RidgelightView { renderer, scene, lit, limits, view, exposure, format })
        })
    })
}

/// Frees everything. All recorded commands must have finished. Null is allowed.
///
/// # Safety
/// It came from ridgelight_view_create and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_view_destroy(view: *mut RidgelightView) {
    if !view.is_null() {
        // SAFETY: as the caller says.
        unsafe { Box::from_raw(view) }.renderer.destroy();
    }
}

/// Images of one picture. Those that are read are left as before.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightViewImages {
    /// sizeof(RidgelightViewImages).
    pub struct_size: u32,
    /// Heights: the plan's input, or the image of ridgelight_taken for a buffer.
    pub heights: *const RidgelightImage,
    /// Exit radiance: the plan's output "radiance", also with usage SAMPLED.
    pub radiance: *const RidgelightImage,
    /// The environment, where the scene has one.
    pub environment: *const RidgelightImage,
    /// The picture, of the format of ridgelight_view_create, with usage COLOR_ATTACHMENT. Its old contents are
    /// lost.
    pub picture: *const RidgelightImage,
    /// D32_SFLOAT, with usage DEPTH_STENCIL_ATTACHMENT; null: no depths. ridgelight_view_distance converts
    /// them.
    pub depth: *const RidgelightImage,
    /// The mask of voids, where the scene has any: one texel per grid point, of R32F, R16F or R16_UNORM, 0 on
    /// ground, 1 on voids.
    pub voids: *const RidgelightImage,
}

// SAFETY: pointers that may be null; the size is first.
unsafe impl SizeFirst for RidgelightViewImages {}

/// Appends a picture to `commands`, which is being recorded outside rendering for the host's family; call it
/// after ridgelight_record. `camera` may change each time, with the same picture size and MSAA samples; null:
/// the last one. All arguments are checked first: after an error nothing has been recorded.
///
/// Returns OK, ARGUMENT, SETTING, or LIMIT for a camera whose picture is beyond the device's.
///
/// # Safety
/// As ridgelight_record, for `images` and `camera`, which are null or structs whose struct_size is set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_view_record(
    view: *mut RidgelightView,
    commands: vk::CommandBuffer,
    slot: u32,
    camera: *const RidgelightCamera,
    images: *const RidgelightViewImages,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        if commands == vk::CommandBuffer::null() {
            return Err(Failure::argument("commands", "null", "a command buffer"));
        }
        let of = handle_mut(view, "view")?;
        let given = read(images, "images")?;
        let (view, exposure) = match camera.is_null() {
            true => (of.view.clone(), of.exposure),
            false => camera_view(camera, (&of.scene, of.view.has_voids), &of.lit, &of.limits)?,
        };
        let resource = |name: &str| of.lit.find(name).map(|id| &of.lit.resources[id.0]);
        let wanted = |from: *const RidgelightImage, name, like| match from.is_null() {
            true => Ok(None),
            false => image(from, name, resource(like)).map(Some),
        };
        let inputs = ViewInputs {
            heights: image(given.heights, "heights", resource("heights"))?,
            radiance: image(given.radiance, "radiance", resource("radiance"))?,
            environment: wanted(given.environment, "environment", "environment")?,
            voids: wanted(given.voids, "voids", "heights")?,
        };
        let drawn = |from, name, format| -> Done<ImageArg> {
            let mut arg = image(from, name, None)?;
            if arg.format == vk::Format::UNDEFINED {
                arg.format = format;
            }
            if arg.extent == [0; 3] {
                arg.extent = [view.size[0], view.size[1], 1];
            }
            Ok(arg)
        };
        let outputs = ViewOutputs {
            picture: drawn(given.picture, "picture", of.format)?,
            depth: match given.depth.is_null() {
                true => None,
                false => Some(drawn(given.depth, "depth", vk::Format::D32_SFLOAT)?),
            },
        };
        of.renderer.record(commands, slot as usize, (&view, exposure), &inputs, &outputs)?;
        (of.view, of.exposure) = (view, exposure);
        Ok(())
    })
}

/// An image, never a buffer.
///
/// # Safety
/// As [`read`].
unsafe fn image(
    from: *const RidgelightImage,
    name: &str,
    resource: Option<&Resource>,
) -> Done<ImageArg> {
    // SAFETY: as the caller says.
    match unsafe { read(from, name) }?.input(resource) {
        InputArg::Image(image) => Ok(image),
        InputArg::Buffer(_) => Err(Failure::argument(name, "a buffer", "an image")),
    }
}

/// Converts a value of the depth image to a distance along the view direction from the plane of the eye,
/// infinite where no ground is visible; for the camera that was recorded last.
///
/// Returns OK, or ARGUMENT.
///
/// # Safety
/// `view` is alive or null; `distance_m` is null or may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_view_distance(
    view: *const RidgelightView,
    depth: f32,
    distance_m: *mut f64,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        let converted = handle(view, "view")?.view.distance_m(depth);
        *handle_mut(distance_m, "distance_m")? = converted;
        Ok(())
    })
}

/// GPU times of the passes of a picture, as ridgelight_timings.
///
/// Returns OK, or ARGUMENT.
///
/// # Safety
/// As there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_view_timings(
    view: *const RidgelightView,
    slot: u32,
    timings: *mut RidgelightTiming,
    count: *mut u32,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        let times = handle(view, "view")?.renderer.timings(slot as usize).unwrap_or_default();
        write_timings(&times, timings, count)
    })
}

/// The image that input `index`, of a plan that takes a buffer for it, is copied to, as each recording leaves
/// it: for your own passes, and for ridgelight_view_record. Leave it in that state.
///
/// Returns OK; ARGUMENT, for an input in an image too.
///
/// # Safety
/// `renderer` is alive or null; `image` is null or points at a struct whose struct_size is set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_taken(
    renderer: *const RidgelightRenderer,
    index: u32,
    image: *mut RidgelightImage,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        let renderer = &handle(renderer, "renderer")?.0;
        let input = renderer.plan().inputs().nth(index as usize).map(|(_, r)| &r.name);
        let taken = input.and_then(|name| renderer.taken(name));
        let taken = taken
            .ok_or_else(|| Failure::argument("index", index, "an input that comes in a buffer"))?;
        write(image, &RidgelightImage::of(&taken), "image")
    })
}

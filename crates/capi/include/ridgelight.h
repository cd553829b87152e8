/* Ridgelight for C: lights height fields that change every frame, recorded into your own Vulkan command buffer.
 *
 * Structs with a struct_size begin with it, so that a library reads one of an older header as far as it goes; what is 0
 * is the default. Functions that can fail return a RidgelightResult, and leave a sentence for
 * ridgelight_last_error. Plans are data and may be shared by threads; a renderer is used by one thread at a time.
 *
 * x east = column, y north = decreasing row, z up; azimuths in radians, counter-clockwise from east; lengths in
 * one unit, that of heights; radiance linear.
 *
 * Made by cbindgen from capi/src: a test compares.
 */

#ifndef RIDGELIGHT_H
#define RIDGELIGHT_H

#include <stdint.h>
#include <vulkan/vulkan.h>

// The version of this header: major << 16 | minor << 8 | patch.
#define RIDGELIGHT_VERSION 256

// Who reads and writes a piece of memory: the device only, device-local where available.
#define RIDGELIGHT_MEMORY_DEVICE 0

// The host writes, the device reads: host-visible, host-coherent, mapped.
#define RIDGELIGHT_MEMORY_UPLOAD 1

// The device writes, the host reads: host-visible, host-coherent, mapped.
#define RIDGELIGHT_MEMORY_READBACK 2

// Beyond the field's edge the ground continues at horizontal forever: the default.
#define RIDGELIGHT_BORDER_PLANE 1

// Nothing is beyond the edge: light may come from below horizontal.
#define RIDGELIGHT_BORDER_OPEN 2

// The field repeats.
#define RIDGELIGHT_BORDER_PERIODIC 3

// Also an image for each light and each bounce.
#define RIDGELIGHT_PICTURE_LIGHT_LAYERS 1

// Also the light of a sky of radiance 1 on albedo 1.
#define RIDGELIGHT_PICTURE_SKY_VIEW 2

// Keeps the horizons, so that lights alone may change, and rectangles of heights may be edited.
#define RIDGELIGHT_PICTURE_KEEPS_HORIZONS 4

// Radiances of the sky and of key lights and irradiances of suns come from the caller's image on the device.
// It is the last input, "light_colours", a row of texels: the sky's where the scene's is not 0, then each
// sun's, then each key light's. The scene's own colours then do not matter, except the sky's beside an
// environment, which affects the choice of azimuths. Not with sphere lights or specular.
#define RIDGELIGHT_PICTURE_COLOURS_ON_DEVICE 8

// How a call ended.
typedef enum RidgelightResult {
    // Success.
    RIDGELIGHT_RESULT_OK = 0,
    // A null pointer, a struct_size or an undefined constant.
    RIDGELIGHT_RESULT_ARGUMENT = 1,
    // A value out of range, or an image that does not match the plan.
    RIDGELIGHT_RESULT_SETTING = 2,
    // A scene that exceeds the device or the memory budget.
    RIDGELIGHT_RESULT_LIMIT = 3,
    // A device that lacks something, or a Vulkan call that failed.
    RIDGELIGHT_RESULT_DEVICE = 4,
    // A bug in Ridgelight: please report it.
    RIDGELIGHT_RESULT_INTERNAL = 5,
} RidgelightResult;

// The passes that light one scene, in order, and their resources; plain data. Threads may share it, except
// during ridgelight_plan_take_buffer.
typedef struct RidgelightPlan RidgelightPlan;

// A plan on a device. Any thread may use it, one at a time.
typedef struct RidgelightRenderer RidgelightRenderer;

// Camera pictures of a lit field, on a device. Any thread may use it, one at a time.
typedef struct RidgelightView RidgelightView;

// What a device needs. No extension or feature has to be enabled on the instance or the device.
typedef struct RidgelightRequirements {
    // sizeof(RidgelightRequirements).
    uint32_t struct_size;
    // The Vulkan version of instance and device, and the instance's apiVersion.
    uint32_t api_version;
    // Capabilities of the queue's family.
    VkQueueFlags queue_flags;
} RidgelightRequirements;

// A borrowed device, never destroyed by Ridgelight: it must outlive every renderer made on it.
typedef struct RidgelightHost {
    // sizeof(RidgelightHost).
    uint32_t struct_size;
    // The family of the queue that runs the commands; it must support compute. Images of exclusive sharing
    // belong to it before and after a recording.
    uint32_t queue_family;
    // The instance of the device, for Vulkan 1.1 or higher.
    VkInstance instance;
    // The physical device.
    VkPhysicalDevice physical_device;
    // The device.
    VkDevice device;
    // The loader's vkGetInstanceProcAddr, through which all functions are loaded.
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;
    // Cache for compiled pipelines, or null; not created as externally synchronised.
    VkPipelineCache pipeline_cache;
    // VK_TRUE where the instance has VK_EXT_debug_utils enabled: for names and labels.
    VkBool32 debug_utils;
} RidgelightHost;

// A disc of uniform radiance at infinity.
typedef struct RidgelightSun {
    // sizeof(RidgelightSun).
    uint32_t struct_size;
    // Irradiance on a surface that faces it, unoccluded, linear RGB.
    float irradiance[3];
    // Direction of the centre in the plane, radians counter-clockwise from east.
    double azimuth_rad;
    // Elevation of the centre, radians, [0..pi/2]; pi/2 rounded to float counts as pi/2.
    double elevation_rad;
    // Angular diameter, radians, [0..pi/2] like the elevation; below 0.01 degrees a point with hard shadows.
    double diameter_rad;
} RidgelightSun;

// A patch of uniform radiance at infinity, between two azimuths and two elevations.
typedef struct RidgelightKeyLight {
    // sizeof(RidgelightKeyLight).
    uint32_t struct_size;
    // Radiance, linear RGB.
    float radiance[3];
    // Direction of its middle in the plane, radians counter-clockwise from east.
    double azimuth_rad;
    // Extent in azimuth, radians, above 0 up to 2 pi; 2 pi rounded to float counts as 2 pi.
    double width_rad;
    // Its lowest and its highest elevation, radians, [-pi/2..pi/2]; pi/2 rounded to float counts as pi/2.
    double elevations_rad[2];
} RidgelightKeyLight;

// A sphere light: a sphere of uniform radiance near the field.
typedef struct RidgelightSphereLight {
    // sizeof(RidgelightSphereLight).
    uint32_t struct_size;
    // Radiance, linear RGB.
    float radiance[3];
    // Centre: x east from the westernmost column, y north from the southernmost row, z as heights.
    double position_m[3];
    // Radius, above 0.
    double radius_m;
} RidgelightSphereLight;

// A field, its surface, and its lights. Heights come from an image with each frame, in the unit of `cell_m`,
// never NaN; the host need not know them. Data behind pointers is copied.
typedef struct RidgelightScene {
    // sizeof(RidgelightScene).
    uint32_t struct_size;
    // Rows of grid points, row 0 in the north.
    uint32_t rows;
    // Columns of grid points, column 0 in the west.
    uint32_t cols;
    // The ground beyond the field's edge, a RIDGELIGHT_BORDER_; 0: PLANE.
    uint32_t border;
    // Spacing of columns and of rows, in the unit of heights; 0, 0: 1, 1.
    double cell_m[2];
    // Radiance of a uniform sky, linear RGB; 0, 0, 0: none.
    float sky[3];
    // Diffuse reflectance, linear RGB, [0..1]; 0, 0, 0: 1, 1, 1.
    float albedo[3];
    // VK_TRUE for an image of reflectance instead.
    uint32_t albedo_is_map;
    // VK_TRUE for an environment: an image whose centre is east, its left quarter north, row 0 the zenith.
    uint32_t has_environment;
    // The map's texels, RGB; null where only the device has them.
    const float *albedo_map;
    // The environment's texels, RGB; null where only the device has them: azimuths are even then.
    const float *environment;
    // Texels around the full circle.
    uint32_t environment_width;
    // Texels from zenith to nadir.
    uint32_t environment_height;
    // Counter-clockwise rotation of the environment, radians.
    double environment_rotation_rad;
    // Phong specular: exponent of the lobe about the mirror direction of the view (`eye_m`), [0..1e4].
    float specular_exponent;
    // Phong specular: share of light that it reflects, [0..1]; 0: none.
    float specular_scale;
    // Suns, consecutive.
    const struct RidgelightSun *suns;
    // Key lights, consecutive.
    const struct RidgelightKeyLight *keys;
    // Sphere lights, consecutive.
    const struct RidgelightSphereLight *spheres;
    // Number of suns.
    uint32_t sun_count;
    // Number of key lights.
    uint32_t key_count;
    // Number of sphere lights.
    uint32_t sphere_count;
    // VK_TRUE where the field has voids: camera pictures then take a mask and leave holes. Heights must still
    // be filled there: ridgelight_fill_voids.
    uint32_t has_voids;
    // Eye position for specular, metres; read if `has_eye` is VK_TRUE: x east from the westernmost column, y north from the
    // southernmost row, z as heights, each within +-1e15. With bounces it needs a `bounce_specular` other than scalar.
    // Diffuse light does not depend on it.
    double eye_m[3];
    // VK_TRUE where specular is viewed from `eye_m`; 0: from straight above.
    uint32_t has_eye;
    // 0.
    uint32_t reserved;
} RidgelightScene;

// Speed against accuracy. In every field 0 is the default.
typedef struct RidgelightQuality {
    // sizeof(RidgelightQuality).
    uint32_t struct_size;
    // How horizons are found: 1 auto (default), 2 sweep, 3 pyramid, 4 brute-force.
    uint32_t method;
    // Azimuths of sky and environment, [4..1024], default 32. Fewer: faster, banding at sharp silhouettes. With specular under a
    // sky or an environment on steep ground the default is 64 to 256. With unknown heights, and with basis sh, it is 32.
    uint32_t azimuths;
    // Slices across a sun's disc, a key light or a sphere light, [1..256], default 8. Fewer: faster, steps in
    // soft shadows. A key light has sun_azimuths * width / 25 degrees of them, between half and 4 * sun_azimuths.
    uint32_t sun_azimuths;
    // Distance between the lines of a sweep: 1 exact, 2 a quarter of a cell, 3 half a cell, 4 a cell (default),
    // 5 two cells, 6 four cells. Wider: faster, small occluders missed between lines.
    uint32_t lines;
    // How the results of lines are interpolated to grid points: 1 nearest, 2 slopes, 3 own, 4 aimed-nearest,
    // 5 aimed, 6 aimed-around (default). aimed-around is the most exact. On llvmpipe, with lines one
    // cell apart, a frame with aimed-nearest takes 0.4 to 0.8 times as long, and aimed-nearest is as fast as
    // nearest and more exact than the first three.
    uint32_t fuse;
    // Precision of stored sweep results: 1 f32 (default), 2 f16. (A packed hull would need the heights
    // beforehand.)
    uint32_t precision;
    // Hull storage: 1 auto (default), 2 private, 3 shared, 4 occluder-list. Never changes the result.
    uint32_t hull;
    // Levels per doubling of distance in a height pyramid, [1..16], default 4. Fewer: faster, smeared
    // horizons.
    uint32_t level_step;
    // One more than the doublings of resolution by which a pyramid march reads finer levels, [1..5], default
    // 3. Fewer: blurred distant horizons.
    uint32_t level_offset_plus_1;
    // How a pyramid's levels are stored: 1 stack (default), 2 pyramid: less memory, slower.
    uint32_t levels;
    // Elevations of an environment table, [8..4096], default 256. Fewer: faster, small bright places smeared.
    uint32_t table_elevations;
    // How an environment is evaluated: 1 auto (default), 2 table, 3 sh.
    uint32_t basis;
    // SH order of visibility, [2..6], default 4.
    uint32_t sh_order;
    // How visibility becomes SH: 1 slices (default), 2 nlp, 3 table.
    uint32_t wedges;
    // Receiver: how visibility becomes light: 1 plane (default), 2 cosine.
    uint32_t receiver;
    // SH window: 1 none (default), 2 lanczos, 3 hann, 4 nonnegative.
    uint32_t window;
    // Visibility is found at every nth grid point, n = 1, 2 or 4, default 1. More: faster, blurred shadows.
    uint32_t subsample;
    // Horizons per side of a table of wedges, [4..256], default 64.
    uint32_t wedge_side;
    // Basis of sphere lights: 1 exact (default), 2 sh.
    uint32_t light_basis;
    // Largest light that a texel may lose from all sphere lights together, as a share of the brightest light
    // that one of them can give to its nearest grid point, [0..1], default 1/65536; below 0: none.
    double light_cutoff;
    // Number of bounces of light, [0..64].
    uint32_t bounces;
    // How bounced light is found: 1 brute-force, 2 sweep, 3 pyramid, 4 auto (default).
    uint32_t bounce_engine;
    // Azimuths of bounced light per grid point, [4..1024], default 16.
    uint32_t bounce_azimuths;
    // As level_step, for the pyramid of exit radiance, [1..16], default 4.
    uint32_t bounce_level_step;
    // As level_offset_plus_1, for the pyramid of exit radiance, [1..5], default 3.
    uint32_t bounce_level_offset_plus_1;
    // Share of the direct light's energy that bounces may leave out, [0..1], default 1/65536; below 0: none.
    double bounce_cutoff;
    // Storage of specular light between bounces: 1 vector (default), 2 vector-f16, 3 scalar.
    uint32_t bounce_specular;
} RidgelightQuality;

// An outer field: a coarser field that contains another one.
typedef struct RidgelightOuter {
    // sizeof(RidgelightOuter).
    uint32_t struct_size;
    // Rows of grid points.
    uint32_t rows;
    // Columns of grid points.
    uint32_t cols;
    // 0.
    uint32_t reserved;
    // Spacing of columns and of rows, in the unit of heights; 0, 0: 1, 1.
    double cell_m[2];
    // Column and row, in the grid of this outer field, of the inner field's first grid point.
    double place[2];
} RidgelightOuter;

// Sizes of a plan.
typedef struct RidgelightPlanInfo {
    // sizeof(RidgelightPlanInfo).
    uint32_t struct_size;
    // Number of input images.
    uint32_t inputs;
    // Number of output images.
    uint32_t outputs;
    // Number of passes, and of timings.
    uint32_t passes;
    // Bytes of a renderer's own images and buffers.
    uint64_t internal_bytes;
} RidgelightPlanInfo;

// An image that the caller provides for a plan.
typedef struct RidgelightImageInfo {
    // sizeof(RidgelightImageInfo).
    uint32_t struct_size;
    // Its format; for inputs the one without loss, see RidgelightImage.
    VkFormat format;
    // Columns, rows and layers.
    uint32_t extent[3];
    // Its required usage: SAMPLED of an input, STORAGE and SAMPLED of an output; 0 where a buffer is taken instead.
    VkImageUsageFlags usage;
    // "heights", "environment", "albedo", "light_colours"; "radiance", "direct.sky", ...: UTF-8,
    // nul-terminated.
    char name[32];
} RidgelightImageInfo;

// Requirements of an image or buffer.
typedef struct RidgelightMemoryRequest {
    // sizeof(RidgelightMemoryRequest).
    uint32_t struct_size;
    // Who reads and writes it: RIDGELIGHT_MEMORY_DEVICE, _UPLOAD or _READBACK.
    uint32_t used_by;
    // Name of the image or buffer; valid during the call.
    const char *name;
    // Size, alignment and permitted memory types.
    VkMemoryRequirements requirements;
    // VK_TRUE for a buffer; else an image of optimal tiling, which bufferImageGranularity separates from
    // buffers.
    VkBool32 is_linear;
} RidgelightMemoryRequest;

// A piece of memory for one image or buffer.
typedef struct RidgelightAllocation {
    // The memory object.
    VkDeviceMemory memory;
    // Offset of its first byte, in bytes.
    uint64_t offset;
    // Host address of that byte; null for RIDGELIGHT_MEMORY_DEVICE.
    void *mapped;
    // The allocator's own key.
    uint64_t key;
} RidgelightAllocation;

// An engine's own memory. It is called by the thread that makes, changes or destroys a renderer, one call at a
// time.
//
// `allocate` must return what was requested: one of the memory types, the alignment, at least the size, owned
// by nobody else until `free`, and mapped for as long unless it is for the device only.
typedef struct RidgelightAllocator {
    // sizeof(RidgelightAllocator).
    uint32_t struct_size;
    // Passed back with every call.
    void *user;
    // Fills `allocation`; VK_FALSE where no such memory is left.
    VkBool32 (*allocate)(void *user,
                         const struct RidgelightMemoryRequest *request,
                         struct RidgelightAllocation *allocation);
    // Frees what `allocate` returned, after its image or buffer was destroyed.
    void (*free)(void *user, const struct RidgelightAllocation *allocation);
} RidgelightAllocator;

// The use of an image at a point of a command buffer.
typedef struct RidgelightImageState {
    // Stages of its last or next use.
    VkPipelineStageFlags2 stage;
    // Accesses of its last or next use.
    VkAccessFlags2 access;
    // Its layout. VK_IMAGE_LAYOUT_UNDEFINED is allowed for outputs before a recording: their contents are not
    // kept.
    VkImageLayout layout;
} RidgelightImageState;

// A caller's image for one recording: its mip level 0, array layers from 0.
typedef struct RidgelightImage {
    // sizeof(RidgelightImage).
    uint32_t struct_size;
    // Its format, 0: the plan's. Heights may be R32F, R16F or R16_UNORM (0 to 1: cells and lights are then in
    // units of the range); environment, albedo and light colours RGBA32F, RGBA16F, RGBA8 UNORM or SRGB;
    // outputs have the plan's.
    VkFormat format;
    // The image: of usage SAMPLED for an input, STORAGE and SAMPLED for an output.
    VkImage image;
    // A view of its colour aspect, 2D.
    VkImageView view;
    // Columns, rows and layers; 0, 0, 0 or the plan's.
    uint32_t extent[3];
    // State before the recording.
    struct RidgelightImageState before;
    // State after the recording. Ignored for inputs, which are left as before.
    struct RidgelightImageState after;
    // Replaces image and view for an input of ridgelight_plan_take_buffer: its texels, row after row, of usage
    // TRANSFER_SRC. Only stage and access of `before` are used; it is left in that use.
    VkBuffer buffer;
    // Size of the buffer, bytes: nothing beyond is read.
    uint64_t buffer_bytes;
    // Offset of the first texel, bytes: a multiple of the texel size.
    uint64_t buffer_offset;
    // Distance between the starts of rows, bytes: a multiple of the texel size, less than 2^31. 0: rows are
    // consecutive.
    uint64_t row_bytes;
} RidgelightImage;

// A rectangle of texels.
typedef struct RidgelightRectangle {
    // The first column.
    uint32_t col;
    // The first row.
    uint32_t row;
    // Number of columns, 1 or more.
    uint32_t cols;
    // Number of rows, 1 or more.
    uint32_t rows;
} RidgelightRectangle;

// GPU time of one pass.
typedef struct RidgelightTiming {
    // sizeof(RidgelightTiming).
    uint32_t struct_size;
    // The pass's name and part: UTF-8, nul-terminated.
    char label[60];
    // Nanoseconds.
    double ns;
} RidgelightTiming;

// The camera of a picture of a lit field. North is up on the map.
typedef struct RidgelightCamera {
    // sizeof(RidgelightCamera).
    uint32_t struct_size;
    // MSAA samples per pixel, 1, 2, 4 or 8, where the device supports them; 0: 4.
    uint32_t samples;
    // Columns and rows of the picture.
    uint32_t size[2];
    // Azimuth of the eye from the target, in the plane, radians counter-clockwise from east.
    double azimuth_rad;
    // Elevation of the eye from the target above horizontal, radians, [-pi/2..pi/2]; pi/2 rounded to float counts
    // as pi/2.
    double elevation_rad;
    // The target in the middle of the picture: x east of the westernmost column, y north of the southernmost
    // row, z as heights.
    double target_m[3];
    // Distance from the target to the eye, [1e-9..1e15]. 0: a level field at height 0 just fits the picture,
    // about its middle, whatever target_m.
    double distance_m;
    // Angle between the lower and the upper edge of the picture, radians, [0.001..3]; 0: 40 degrees.
    double fov_rad;
    // Above 0, [1e-9..1e15]: parallel rays, and the distance that the picture spans from its lower to its
    // upper edge.
    double ortho_height_m;
    // The mesh has a vertex at every nth grid point, [1..1024], default 1. Larger: faster, coarser.
    uint32_t mesh_step;
    // Factor before the tone curve, for screen formats; 0: 1.
    float exposure;
    // Radiance, linear RGB, of pixels without ground and sky.
    float background[3];
    // Height of the base of a plinth, metres, with `has_plinth`: walls extend down to it where the edge of the
    // field is higher. Finite, as heights.
    double plinth_base_m;
    // VK_TRUE draws a plinth. A ridgelight_view draws one with every camera or with none.
    uint32_t has_plinth;
    // 0; any other value is an error.
    uint32_t reserved;
} RidgelightCamera;

// Images of one picture. Those that are read are left as before.
typedef struct RidgelightViewImages {
    // sizeof(RidgelightViewImages).
    uint32_t struct_size;
    // Heights: the plan's input, or the image of ridgelight_taken for a buffer.
    const struct RidgelightImage *heights;
    // Exit radiance: the plan's output "radiance", also with usage SAMPLED.
    const struct RidgelightImage *radiance;
    // The environment, where the scene has one.
    const struct RidgelightImage *environment;
    // The picture, of the format of ridgelight_view_create, with usage COLOR_ATTACHMENT. Its old contents are
    // lost.
    const struct RidgelightImage *picture;
    // D32_SFLOAT, with usage DEPTH_STENCIL_ATTACHMENT; null: no depths. ridgelight_view_distance converts
    // them.
    const struct RidgelightImage *depth;
    // The mask of voids, where the scene has any: one texel per grid point, of R32F, R16F or R16_UNORM, 0 on
    // ground, 1 on voids.
    const struct RidgelightImage *voids;
} RidgelightViewImages;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// One sentence on why the last failing call on this thread failed: UTF-8, nul-terminated, valid until another
// call on this thread fails. Empty before the first failure.
const char *ridgelight_last_error(void);

// The version of the library: major << 16 | minor << 8 | patch.
uint32_t ridgelight_version(void);

// Whether the library is compatible with a program compiled against the version `header`, its
// RIDGELIGHT_VERSION. The major version must be equal, before 1.0 also the minor, and the library must not be
// older.
//
// Returns OK, or ARGUMENT.
enum RidgelightResult ridgelight_check_version(uint32_t header);

// Writes what Ridgelight needs from a device. Call it before the device exists.
//
// Returns OK, or ARGUMENT.
//
// # Safety
// `requirements` is null or points to a struct whose struct_size is set.
enum RidgelightResult ridgelight_requirements(struct RidgelightRequirements *requirements);

// Whether a physical device is suitable. Call it before the VkDevice exists.
//
// Returns OK; DEVICE where it lacks something, which ridgelight_last_error names; ARGUMENT.
//
// # Safety
// `get_instance_proc_addr` is the loader's, the others are of its instance.
enum RidgelightResult ridgelight_check_device(PFN_vkGetInstanceProcAddr get_instance_proc_addr,
                                              VkInstance instance,
                                              VkPhysicalDevice physical_device);

// Plans a picture of a scene for a host's device. `quality` may be null; `picture` is flags
// RIDGELIGHT_PICTURE_; `memory_budget` is bytes of all images and buffers, 0: half of the largest heap, all
// of a software driver's.
//
// Returns OK, ARGUMENT, SETTING or LIMIT.
//
// # Safety
// Pointers are null, or to structs whose struct_size is set and whose pointers and handles are as their fields
// require; `plan` may be written to.
enum RidgelightResult ridgelight_plan_create(const struct RidgelightHost *host,
                                             const struct RidgelightScene *scene,
                                             const struct RidgelightQuality *quality,
                                             uint32_t picture,
                                             uint64_t memory_budget,
                                             struct RidgelightPlan **plan);

// Plans the shadow heights of the scene's one sun over its field. The rest of the scene is ignored.
//
// Outputs, R32F: "lit_above", the height from which the whole sun is visible, in the unit and from the zero of
// "heights". "penumbra", the distance from there down to the height at which its occluder hides the whole sun. "sun_share", the
// visible share of the sun's disc at the ground, [0..1]. Inputs: "heights". With `outer` (may be null) also
// "outer_lit_above" and "outer_penumbra", the outputs of a renderer of `outer` for the same sun.
//
// The plan has `parts` passes (0 means 1), each for some lines of the field. Record them in order, in one frame or in
// several (ridgelight_record_passes). The plan of any other sun can replace it.
//
// Returns OK, ARGUMENT, SETTING or LIMIT.
//
// # Safety
// As ridgelight_plan_create.
enum RidgelightResult ridgelight_shadow_heights_create(const struct RidgelightHost *host,
                                                       const struct RidgelightScene *scene,
                                                       const struct RidgelightOuter *outer,
                                                       uint32_t parts,
                                                       struct RidgelightPlan **plan);

// Destroys a plan; renderers made for it keep a copy. Null is allowed.
//
// # Safety
// It came from ridgelight_plan_create and is not used again.
void ridgelight_plan_destroy(struct RidgelightPlan *plan);

// Writes the sizes of a plan.
//
// Returns OK, or ARGUMENT.
//
// # Safety
// `plan` is alive or null; `info` is null or points at a struct whose struct_size is set.
enum RidgelightResult ridgelight_plan_info(const struct RidgelightPlan *plan,
                                           struct RidgelightPlanInfo *info);

// Describes input `index` of a plan.
//
// Returns OK; ARGUMENT, also beyond the last.
//
// # Safety
// `plan` is alive or null; `info` is null or points at a struct whose struct_size is set.
enum RidgelightResult ridgelight_plan_input(const struct RidgelightPlan *plan,
                                            uint32_t index,
                                            struct RidgelightImageInfo *info);

// Takes input `index` from a caller's buffer instead of an image, as rows of texels of `format`, 0: that of
// ridgelight_plan_input. Heights may be R32F, R16F or R16_UNORM; environment, albedo and light colours
// RGBA32F, RGBA16F, RGBA8 UNORM or SRGB. Each recording then begins with one copy to an image of the
// renderer's own. Call it before a renderer is made, while nobody else uses the plan.
//
// Returns OK; ARGUMENT, also beyond the last; SETTING for a format that the input cannot have.
//
// # Safety
// `plan` is alive or null.
enum RidgelightResult ridgelight_plan_take_buffer(struct RidgelightPlan *plan,
                                                  uint32_t index,
                                                  VkFormat format);

// Describes output `index` of a plan.
//
// Returns OK; ARGUMENT, also beyond the last.
//
// # Safety
// `plan` is alive or null; `info` is null or points at a struct whose struct_size is set.
enum RidgelightResult ridgelight_plan_output(const struct RidgelightPlan *plan,
                                             uint32_t index,
                                             struct RidgelightImageInfo *info);

// Makes everything that a plan needs on a host's device, for `slots` frames in flight (0: 1); recording
// allocates nothing on it. `allocator` may be null: memory then comes in blocks of 4 MiB.
//
// Internal images serve all slots: command buffers of different slots must run one after the other on one
// queue.
//
// Returns OK, ARGUMENT, SETTING or DEVICE.
//
// # Safety
// Pointers are null, or to structs whose struct_size is set, and whose handles are alive until the renderer is
// destroyed, as is the data that `allocator` uses through `user`; `renderer` may be written to.
enum RidgelightResult ridgelight_renderer_create(const struct RidgelightHost *host,
                                                 const struct RidgelightPlan *plan,
                                                 uint32_t slots,
                                                 const struct RidgelightAllocator *allocator,
                                                 struct RidgelightRenderer **renderer);

// Frees everything. All recorded commands must have finished. Null is allowed.
//
// # Safety
// It came from ridgelight_renderer_create and is not used again.
void ridgelight_renderer_destroy(struct RidgelightRenderer *renderer);

// Appends a plan to `commands`: no submit, no wait, no allocation on the device. All arguments are checked
// first: after an error nothing has been recorded.
//
// `commands` is being recorded outside a render pass, for the host's family. `slot` is the frame in flight;
// its last command buffer must have run. `inputs` and `outputs` are the plan's, in its order.
//
// Returns OK, ARGUMENT or SETTING.
//
// # Safety
// `renderer` is alive or null, and used only by this thread meanwhile; arrays have the given lengths, and each
// struct's struct_size is set; images and views are alive until the command buffer has run.
enum RidgelightResult ridgelight_record(struct RidgelightRenderer *renderer,
                                        VkCommandBuffer commands,
                                        uint32_t slot,
                                        const struct RidgelightImage *inputs,
                                        uint32_t input_count,
                                        const struct RidgelightImage *outputs,
                                        uint32_t output_count);

// Appends only some passes of a plan: `passes` are their indices, 0 to RidgelightPlanInfo.passes - 1, ascending,
// each once. The images that they read must hold what an earlier recording of this renderer left in them.
// Outputs that they do not write keep their contents, unless their layout before is UNDEFINED.
//
// You can record all passes of a new renderer, or those that ridgelight_replace_plan returned, in parts over several
// frames. Start with the first of them and skip none. Each part needs a slot of its own, or one whose last command
// buffer has run.
//
// Returns OK, ARGUMENT or SETTING, as ridgelight_record; SETTING also for passes that do not exist, are repeated
// or out of order, or come after one that must be recorded first.
//
// # Safety
// As ridgelight_record; `passes` is null or points at `pass_count` numbers.
enum RidgelightResult ridgelight_record_passes(struct RidgelightRenderer *renderer,
                                               VkCommandBuffer commands,
                                               uint32_t slot,
                                               const struct RidgelightImage *inputs,
                                               uint32_t input_count,
                                               const struct RidgelightImage *outputs,
                                               uint32_t output_count,
                                               const uint32_t *passes,
                                               uint32_t pass_count);

// Appends the edit of a rectangle of heights, for a plan with RIDGELIGHT_PICTURE_KEEPS_HORIZONS. Every output
// gets the same bits as from ridgelight_record. Outputs must hold what the last recording left in them.
//
// Returns OK, ARGUMENT or SETTING.
//
// # Safety
// As ridgelight_record; `rectangle` is null or points at one.
enum RidgelightResult ridgelight_record_edit(struct RidgelightRenderer *renderer,
                                             VkCommandBuffer commands,
                                             uint32_t slot,
                                             const struct RidgelightImage *inputs,
                                             uint32_t input_count,
                                             const struct RidgelightImage *outputs,
                                             uint32_t output_count,
                                             const struct RidgelightRectangle *rectangle);

// Replaces the plan by one with the same passes, images and buffers but other values: another colour of a
// light, a sun that moved a little. Frames in flight finish with the plan of their recording; do not wait for
// them.
//
// `passes` receives the indices of the passes that must run next if the inputs are unchanged; pass them to
// ridgelight_record_passes. They include passes that earlier calls returned and that have not been recorded since.
// `count` holds the capacity of `passes` before the call and the number of these passes after it. If `count` is null,
// nothing is written. A capacity of RidgelightPlanInfo.passes is always enough; indices beyond the capacity are not
// written.
//
// Returns OK; ARGUMENT if a handle is null, or if `passes` is null and the capacity is not 0; SETTING if the plan needs
// a renderer of its own. After an error the old plan stays.
//
// # Safety
// The renderer and the plan are alive or null; only this thread uses the renderer meanwhile. `count` is null or points
// at the capacity; `passes` is null or points at that many numbers.
enum RidgelightResult ridgelight_replace_plan(struct RidgelightRenderer *renderer,
                                              const struct RidgelightPlan *plan,
                                              uint32_t *passes,
                                              uint32_t *count);

// Writes to `passes` the indices of the passes to record next with ridgelight_record_passes, if only the inputs `changed`
// have new contents since the last recording. `changed` holds positions in the plan's list of inputs. The result includes
// passes that have not been recorded since the renderer was created or ridgelight_replace_plan changed them.
//
// In a series of frames with new heights, only the first frame then computes the tables of an environment.
// ridgelight_record computes them in every frame. What is recorded counts as run: after a command buffer that
// was not submitted, call ridgelight_record.
//
// `count` is as in ridgelight_replace_plan.
//
// Returns OK, or ARGUMENT.
//
// # Safety
// `renderer` is alive or null, and used only by this thread meanwhile. `changed` is null or points at `changed_count`
// numbers. `count` is null or points at the capacity; `passes` is null or points at that many numbers.
enum RidgelightResult ridgelight_passes_after(const struct RidgelightRenderer *renderer,
                                              const uint32_t *changed,
                                              uint32_t changed_count,
                                              uint32_t *passes,
                                              uint32_t *count);

// Sets whether later recordings write a timestamp after every pass (`each` VK_TRUE, the default) or only one
// after the last (VK_FALSE). A timestamp after every pass can keep a GPU from overlapping passes.
//
// Returns OK, or ARGUMENT.
//
// # Safety
// `renderer` is alive or null, and used only by this thread meanwhile.
enum RidgelightResult ridgelight_time_passes(struct RidgelightRenderer *renderer, VkBool32 each);

// GPU times of the passes that `slot` recorded last, in order; after ridgelight_time_passes with VK_FALSE one
// time, labelled "all passes". Never waits: `count` becomes 0 while some are not available, and where the queue
// family has no timestamps.
//
// `count` is the capacity of `timings`, and becomes their number; those beyond the capacity are left out.
//
// Returns OK, or ARGUMENT.
//
// # Safety
// `renderer` is alive or null; `timings` has `count` structs, each with its struct_size set.
enum RidgelightResult ridgelight_timings(const struct RidgelightRenderer *renderer,
                                         uint32_t slot,
                                         struct RidgelightTiming *timings,
                                         uint32_t *count);

// Makes the resources for pictures of a scene's light, for `slots` frames in flight (0: 1); `plan` lights it.
// `format` is R32G32B32A32 or R16G16B16A16 SFLOAT for linear radiance; or a screen format of 8 or 10 bits per
// colour, UNORM or SRGB, which gets exposure, tone curve and sRGB. `allocator` may be null.
//
// The host's family needs graphics.
//
// Returns OK, ARGUMENT, SETTING, LIMIT or DEVICE.
//
// # Safety
// As ridgelight_renderer_create; `scene` and `camera` are null or structs whose struct_size is set, `scene`'s
// pointers are as their fields require.
enum RidgelightResult ridgelight_view_create(const struct RidgelightHost *host,
                                             const struct RidgelightScene *scene,
                                             const struct RidgelightPlan *plan,
                                             const struct RidgelightCamera *camera,
                                             VkFormat format,
                                             uint32_t slots,
                                             const struct RidgelightAllocator *allocator,
                                             struct RidgelightView **view);

// Frees everything. All recorded commands must have finished. Null is allowed.
//
// # Safety
// It came from ridgelight_view_create and is not used again.
void ridgelight_view_destroy(struct RidgelightView *view);

// Appends a picture to `commands`, which is being recorded outside rendering for the host's family; call it
// after ridgelight_record. `camera` may change each time, with the same picture size and MSAA samples; null:
// the last one. All arguments are checked first: after an error nothing has been recorded.
//
// Returns OK, ARGUMENT, SETTING, or LIMIT for a camera whose picture is beyond the device's.
//
// # Safety
// As ridgelight_record, for `images` and `camera`, which are null or structs whose struct_size is set.
enum RidgelightResult ridgelight_view_record(struct RidgelightView *view,
                                             VkCommandBuffer commands,
                                             uint32_t slot,
                                             const struct RidgelightCamera *camera,
                                             const struct RidgelightViewImages *images);

// Converts a value of the depth image to a distance along the view direction from the plane of the eye,
// infinite where no ground is visible; for the camera that was recorded last.
//
// Returns OK, or ARGUMENT.
//
// # Safety
// `view` is alive or null; `distance_m` is null or may be written to.
enum RidgelightResult ridgelight_view_distance(const struct RidgelightView *view,
                                               float depth,
                                               double *distance_m);

// GPU times of the passes of a picture, as ridgelight_timings.
//
// Returns OK, or ARGUMENT.
//
// # Safety
// As there.
enum RidgelightResult ridgelight_view_timings(const struct RidgelightView *view,
                                              uint32_t slot,
                                              struct RidgelightTiming *timings,
                                              uint32_t *count);

// The image that input `index`, of a plan that takes a buffer for it, is copied to, as each recording leaves
// it: for your own passes, and for ridgelight_view_record. Leave it in that state.
//
// Returns OK; ARGUMENT, for an input in an image too.
//
// # Safety
// `renderer` is alive or null; `image` is null or points at a struct whose struct_size is set.
enum RidgelightResult ridgelight_taken(const struct RidgelightRenderer *renderer,
                                       uint32_t index,
                                       struct RidgelightImage *image);

// Fills heights without data before they go to the device: those that are NaN, and those whose byte in `voids`
// is not 0, where `voids` is not null. They are filled smoothly from the heights around them, as on the
// command line; the others keep their bits. Every byte of `voids` becomes 1 or 0: whether it is a
// void. Filled texels are lit too; the caller masks that light. For camera pictures the mask goes to the
// device, see RidgelightScene's has_voids.
//
// Returns OK; ARGUMENT; SETTING for an infinite height, which is named, and for a field of voids only: then
// nothing is changed.
//
// # Safety
// `heights` is null or points to rows times cols numbers, `voids` to as many bytes, row after row from the
// north-west; nobody else uses them meanwhile.
enum RidgelightResult ridgelight_fill_voids(uint32_t rows,
                                            uint32_t cols,
                                            float *heights,
                                            uint8_t *voids);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* RIDGELIGHT_H */

/* Ridgelight for C: lights height fields that change every frame, recorded into your own Vulkan command buffer.
 *
 * Every struct begins with its size, so that a library reads one of an older header as far as it goes; what is 0
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

// Who reads and writes a piece of memory: the device alone, device-local where there is such memory.
#define RIDGELIGHT_MEMORY_DEVICE 0

// The host writes, the device reads: host-visible, host-coherent, mapped.
#define RIDGELIGHT_MEMORY_UPLOAD 1

// The device writes, the host reads: host-visible, host-coherent, mapped.
#define RIDGELIGHT_MEMORY_READBACK 2

// Beyond the field's edge the ground goes on forever at horizontal: the default.
#define RIDGELIGHT_BORDER_PLANE 1

// Nothing lies there: light may come from below horizontal.
#define RIDGELIGHT_BORDER_OPEN 2

// The field repeats.
#define RIDGELIGHT_BORDER_PERIODIC 3

// Besides the whole, an image for each light and each bounce.
#define RIDGELIGHT_PICTURE_LIGHT_LAYERS 1

// Besides, what a sky of radiance 1 gives to albedo 1.
#define RIDGELIGHT_PICTURE_SKY_VIEW 2

// Horizons are kept, so that light alone may change, and rectangles of heights be edited.
#define RIDGELIGHT_PICTURE_KEEPS_HORIZONS 4

// Radiances of the sky and of key lights and irradiances of suns are the caller's, on the device: one more input, the
// last, "light_colours", a row of texels, the sky's where the scene's is not 0, then each sun's, then each key light's.
// Those of the scene then count for nothing but, the sky's beside an environment, for where azimuths lie. Not with balls of light or a lobe.
#define RIDGELIGHT_PICTURE_COLOURS_ON_DEVICE 8

// How a call ended.
typedef enum RidgelightResult {
    // It did what it should.
    RIDGELIGHT_RESULT_OK = 0,
    // A null pointer, a struct_size or a number that stands for nothing.
    RIDGELIGHT_RESULT_ARGUMENT = 1,
    // A value out of its range, or an image that is not what the plan says.
    RIDGELIGHT_RESULT_SETTING = 2,
    // A scene that the device or the memory budget cannot hold.
    RIDGELIGHT_RESULT_LIMIT = 3,
    // A device that lacks something, or a Vulkan call that failed.
    RIDGELIGHT_RESULT_DEVICE = 4,
    // A fault of Ridgelight's own: please report it.
    RIDGELIGHT_RESULT_INTERNAL = 5,
} RidgelightResult;

// The passes that light one scene, in order, and everything that they touch: data alone. Threads may share it,
// but for ridgelight_plan_take_buffer.
typedef struct RidgelightPlan RidgelightPlan;

// A plan on a device. One thread at a time uses it, any thread.
typedef struct RidgelightRenderer RidgelightRenderer;

// Pictures of a lit field before a camera, on a device. One thread at a time uses it, any thread.
typedef struct RidgelightView RidgelightView;

// What a device must be made with. No extension, of instance or device.
typedef struct RidgelightRequirements {
    // sizeof(RidgelightRequirements).
    uint32_t struct_size;
    // The Vulkan version of instance and device, and the apiVersion that the instance is made for.
    uint32_t api_version;
    // What the family of the queue must offer.
    VkQueueFlags queue_flags;
    // Core features to enable.
    VkPhysicalDeviceFeatures features;
    // Features of Vulkan 1.2 to enable: chain it, pNext is null.
    VkPhysicalDeviceVulkan12Features features12;
    // Features of Vulkan 1.3 to enable: chain it, pNext is null.
    VkPhysicalDeviceVulkan13Features features13;
} RidgelightRequirements;

// A device that is borrowed, never destroyed: it outlives every renderer made on it.
typedef struct RidgelightHost {
    // sizeof(RidgelightHost).
    uint32_t struct_size;
    // The family of the queue that commands go to: it offers compute. Images of exclusive sharing belong to it
    // when a recording runs, and still do afterwards.
    uint32_t queue_family;
    // The instance that the device came from, for Vulkan 1.3.
    VkInstance instance;
    // Its physical device.
    VkPhysicalDevice physical_device;
    // The device, with what ridgelight_requirements asks for enabled.
    VkDevice device;
    // The loader's vkGetInstanceProcAddr: all functions are looked up through it.
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;
    // Where compiled pipelines are looked for and kept, or null; not created as externally synchronised.
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
    // Elevation of the centre, radians, [0..pi/2].
    double elevation_rad;
    // Angular diameter, radians, [0..pi/2]; below 0.01 degrees a point with hard shadows.
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
    // Extent in azimuth, radians, above 0 up to 2 pi.
    double width_rad;
    // Its lowest and its highest elevation, radians, [-pi/2..pi/2].
    double elevations_rad[2];
} RidgelightKeyLight;

// A ball of uniform radiance near the field.
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

// A field, what it is made of, and the light that falls on it. Heights are the image's that is handed in with
// each frame, in the unit of `cell_m`, none of them NaN: the host need not know them. All that pointers point at is
// copied.
typedef struct RidgelightScene {
    // sizeof(RidgelightScene).
    uint32_t struct_size;
    // Rows of samples, row 0 in the north.
    uint32_t rows;
    // Columns of samples, column 0 in the west.
    uint32_t cols;
    // What lies beyond the field's edge, a RIDGELIGHT_BORDER_; 0: PLANE.
    uint32_t border;
    // Spacing of columns and of rows, in the unit of heights; 0, 0: 1, 1.
    double cell_m[2];
    // Radiance of a uniform sky, linear RGB; 0, 0, 0: none.
    float sky[3];
    // Diffuse reflectance, linear RGB, [0..1]; 0, 0, 0: 1, 1, 1.
    float albedo[3];
    // VK_TRUE for an image of reflectance instead.
    uint32_t albedo_is_map;
    // VK_TRUE for an environment: an image whose middle looks east, its left quarter north, row 0 the zenith.
    uint32_t has_environment;
    // The map's texels, RGB; null where only the device knows them.
    const float *albedo_map;
    // The environment's texels, RGB; null where only the device knows them: azimuths are even then.
    const float *environment;
    // Texels around the full circle.
    uint32_t environment_width;
    // Texels from zenith to nadir.
    uint32_t environment_height;
    // Counter-clockwise turn of the environment, radians.
    double environment_rotation_rad;
    // Exponent of a lobe about the mirror direction of the view from straight above, [0..1e4].
    float phong_exponent;
    // Share of light that the lobe reflects, [0..1]; 0: no lobe.
    float phong_scale;
    // Suns, one after the other.
    const struct RidgelightSun *suns;
    // Key lights, one after the other.
    const struct RidgelightKeyLight *keys;
    // Balls of light, one after the other.
    const struct RidgelightSphereLight *spheres;
    // How many suns.
    uint32_t sun_count;
    // How many key lights.
    uint32_t key_count;
    // How many balls of light.
    uint32_t sphere_count;
    // VK_TRUE where some samples hold no ground: pictures before a camera then take an image of marks and leave holes.
    // Heights there are filled all the same: ridgelight_fill_voids.
    uint32_t has_voids;
} RidgelightScene;

// What speed is traded against accuracy with. In every field 0 is the default.
typedef struct RidgelightQuality {
    // sizeof(RidgelightQuality).
    uint32_t struct_size;
    // How horizons are found: 1 auto (default), 2 sweep, 3 pyramid, 4 brute.
    uint32_t method;
    // Azimuths of sky and environment, [4..1024], default 64. Fewer: faster, banding at sharp silhouettes.
    uint32_t azimuths;
    // Slices across a sun's disc, a key light or a ball of light, [1..256], default 8. Fewer: faster, steps in
    // soft shadows.
    uint32_t sun_azimuths;
    // Distance between the lines of a sweep: 1 exact, 2 a quarter of a cell, 3 half a cell, 4 a cell (default),
    // 5 two cells, 6 four cells. Wider: faster, small occluders missed between lines.
    uint32_t lines;
    // How the lines' results come back to samples: 1 nearest, 2 slopes, 3 own, 4 aimed-nearest (default),
    // 5 aimed, 6 aimed-around. Later: nearer to the truth, slower.
    uint32_t fuse;
    // Bits of what the sweep keeps: 1 f32 (default), 2 f16. (Packed ones would have to know heights beforehand.)
    uint32_t precision;
    // Where the sweep's hull lives: 1 auto (default), 2 private, 3 shared, 4 list. Never changes the result.
    uint32_t hull;
    // Levels a doubling of distance in a height pyramid, [1..16], default 4. Fewer: faster, smeared horizons.
    uint32_t level_step;
    // One more than the doublings of resolution by which a march over a pyramid looks at finer levels, [1..5],
    // default 3. Fewer: soft distant horizons.
    uint32_t level_offset_plus_1;
    // What is stored of a pyramid's levels: 1 stack (default), 2 pyramid: less memory, slower.
    uint32_t levels;
    // Elevations of an environment table, [8..4096], default 256. Fewer: faster, small bright places smeared.
    uint32_t table_elevations;
    // What an environment is looked up in: 1 auto (default), 2 table, 3 sh.
    uint32_t basis;
    // Order of what samples see as spherical harmonics, [2..6], default 4.
    uint32_t sh_order;
    // How what is seen becomes harmonics: 1 slices (default), 2 nlp, 3 table.
    uint32_t wedges;
    // How a surface turns what it sees into light: 1 plane (default), 2 lobe.
    uint32_t receiver;
    // What tames the ringing of harmonics: 1 none (default), 2 lanczos, 3 hann, 4 nonnegative.
    uint32_t window;
    // What is seen is found at every so many samples, 1, 2 or 4, default 1. More: faster, blurred shadows.
    uint32_t subsample;
    // Horizons of either side of a table of wedges, [4..256], default 64.
    uint32_t wedge_side;
    // What balls of light are lit by: 1 exact (default), 2 sh.
    uint32_t light_basis;
    // What a sample may lose, all balls of light together, of the brightest that one of them would give to
    // level ground at height 0, [0..1], default 1/65536; below 0: nothing.
    double light_cutoff;
    // Times that light may be reflected on its way to a sample, [0..64].
    uint32_t bounces;
    // How what a sample sees of the surface is found: 1 brute (default), 2 sweep, 3 pyramid.
    uint32_t bounce_engine;
    // Azimuths that each sample looks along for them, [4..1024], default 32.
    uint32_t bounce_azimuths;
    // As level_step, for the pyramid of exit radiance, [1..16], default 4.
    uint32_t bounce_level_step;
    // As level_offset_plus_1, for the pyramid of exit radiance, [1..5], default 3.
    uint32_t bounce_level_offset_plus_1;
    // Share of the direct light's energy that may be left out of bounces, [0..1], default 1/65536; below 0: none.
    double bounce_cutoff;
} RidgelightQuality;

// How much of what a plan has.
typedef struct RidgelightPlanInfo {
    // sizeof(RidgelightPlanInfo).
    uint32_t struct_size;
    // Images that are handed in to be read.
    uint32_t inputs;
    // Images that are handed in to be written.
    uint32_t outputs;
    // Passes: as many timings.
    uint32_t passes;
    // Bytes of a renderer's own images and buffers.
    uint64_t internal_bytes;
} RidgelightPlanInfo;

// An image that a plan asks its caller for.
typedef struct RidgelightImageInfo {
    // sizeof(RidgelightImageInfo).
    uint32_t struct_size;
    // Its format; of inputs the one of which no bit is lost, see RidgelightImage.
    VkFormat format;
    // Columns, rows and layers.
    uint32_t extent[3];
    // What it must be made for: SAMPLED or STORAGE; 0 where a buffer is taken instead.
    VkImageUsageFlags usage;
    // "heights", "environment", "albedo", "light_colours"; "radiance", "direct.sky", ...: UTF-8, ended by a nul.
    char name[32];
} RidgelightImageInfo;

// What an image or buffer needs.
typedef struct RidgelightMemoryRequest {
    // sizeof(RidgelightMemoryRequest).
    uint32_t struct_size;
    // Who reads and writes it: RIDGELIGHT_MEMORY_DEVICE, _UPLOAD or _READBACK.
    uint32_t used_by;
    // Of the image or buffer; good during the call.
    const char *name;
    // Size, alignment and the types of memory that will do.
    VkMemoryRequirements requirements;
    // VK_TRUE for a buffer; else an image of optimal tiling, which bufferImageGranularity keeps apart.
    VkBool32 is_linear;
} RidgelightMemoryRequest;

// A piece of memory for one image or buffer.
typedef struct RidgelightAllocation {
    // The memory that it lies in.
    VkDeviceMemory memory;
    // Its first byte there.
    uint64_t offset;
    // Where the host sees that byte; null for RIDGELIGHT_MEMORY_DEVICE.
    void *mapped;
    // The allocator's own mark.
    uint64_t key;
} RidgelightAllocation;

// An engine's own memory: called by the thread that makes, changes or destroys a renderer, one call at a time.
//
// What `allocate` gives is what the request asks for: of one of its types of memory, at its alignment, as
// large, nobody else's until `free`, and mapped as long unless it is for the device alone.
typedef struct RidgelightAllocator {
    // sizeof(RidgelightAllocator).
    uint32_t struct_size;
    // Handed back with every call.
    void *user;
    // Fills `allocation`; VK_FALSE where there is no such memory left.
    VkBool32 (*allocate)(void *user,
                         const struct RidgelightMemoryRequest *request,
                         struct RidgelightAllocation *allocation);
    // Takes back what `allocate` gave: its image or buffer has been destroyed.
    void (*free)(void *user, const struct RidgelightAllocation *allocation);
} RidgelightAllocator;

// What an image is being used for at a point of a command buffer.
typedef struct RidgelightImageState {
    // Stages that used it last, or will next.
    VkPipelineStageFlags2 stage;
    // How they did, or will.
    VkAccessFlags2 access;
    // Its layout. VK_IMAGE_LAYOUT_UNDEFINED is allowed for outputs on entry: their contents are not kept.
    VkImageLayout layout;
} RidgelightImageState;

// An image of the caller's, handed in for one recording: its mip level 0, array layers from 0.
typedef struct RidgelightImage {
    // sizeof(RidgelightImage).
    uint32_t struct_size;
    // Its format, 0: the plan's. Heights may be R32F, R16F or R16_UNORM (0 to 1: cells and lights are told in
    // units of the range); environment, albedo and colours of lights RGBA32F, RGBA16F, RGBA8 UNORM or SRGB; outputs are
    // the plan's.
    VkFormat format;
    // The image: of usage SAMPLED for an input, STORAGE for an output.
    VkImage image;
    // A view of its colour, 2D.
    VkImageView view;
    // Columns, rows and layers; 0, 0, 0: the plan's, which they must be.
    uint32_t extent[3];
    // How it comes.
    struct RidgelightImageState before;
    // How it is left. Inputs are left as they came, whatever stands here.
    struct RidgelightImageState after;
    // Instead of image and view, for an input that ridgelight_plan_take_buffer said it of: its texels, row after
    // row, of usage TRANSFER_SRC. Of `before` stage and access count; it is left so.
    VkBuffer buffer;
    // How long all of the buffer is, bytes: nothing beyond is read.
    uint64_t buffer_bytes;
    // Where its first texel stands, bytes: whole texels.
    uint64_t buffer_offset;
    // From a row's begin to the next one's, bytes: whole texels, less than 2^31. 0: rows follow one another.
    uint64_t row_bytes;
} RidgelightImage;

// A rectangle of a field's samples.
typedef struct RidgelightRectangle {
    // The first column.
    uint32_t col;
    // The first row.
    uint32_t row;
    // How many columns, 1 or more.
    uint32_t cols;
    // How many rows, 1 or more.
    uint32_t rows;
} RidgelightRectangle;

// GPU time of one pass.
typedef struct RidgelightTiming {
    // sizeof(RidgelightTiming).
    uint32_t struct_size;
    // The pass's name and part: UTF-8, ended by a nul.
    char label[60];
    // Nanoseconds.
    double ns;
} RidgelightTiming;

// From where a lit field is seen, and how. North is up on the map.
typedef struct RidgelightCamera {
    // sizeof(RidgelightCamera).
    uint32_t struct_size;
    // Samples a pixel, 1, 2, 4 or 8, where the device has them; 0: 4.
    uint32_t samples;
    // Columns and rows of the picture.
    uint32_t size[2];
    // Where the eye stands as seen from what it looks at: in the plane, radians counter-clockwise from east.
    double azimuth_rad;
    // And above horizontal, radians, [-pi/2..pi/2].
    double elevation_rad;
    // What stands in the middle of the picture: x east of the westernmost column, y north of the southernmost row,
    // z as heights.
    double target_m[3];
    // From there to the eye, [1e-9..1e15]. 0: so far that all of a level field at height 0 is just seen, about its
    // middle, whatever target_m.
    double distance_m;
    // Angle between the lower and the upper edge of the picture, radians, [0.001..3]; 0: 40 degrees.
    double fov_rad;
    // Above 0, [1e-9..1e15]: parallel rays, and what the picture spans from its lower to its upper edge.
    double ortho_height_m;
    // The mesh has a vertex at every so many samples, [1..1024], default 1. Larger: faster, coarser.
    uint32_t mesh_step;
    // Factor before the tone curve, where the picture is of codes; 0: 1.
    float exposure;
    // Radiance, linear RGB, where neither ground nor sky is seen.
    float background[3];
} RidgelightCamera;

// Images of one picture. Those that are read are left as they came.
typedef struct RidgelightViewImages {
    // sizeof(RidgelightViewImages).
    uint32_t struct_size;
    // Heights: the plan's input, or what ridgelight_taken says of a buffer.
    const struct RidgelightImage *heights;
    // Exit radiance: the plan's output "radiance", of usage SAMPLED too.
    const struct RidgelightImage *radiance;
    // The environment, where the scene has one.
    const struct RidgelightImage *environment;
    // Drawn into, of the format of ridgelight_view_create, of usage COLOR_ATTACHMENT. What it held is lost.
    const struct RidgelightImage *picture;
    // D32_SFLOAT, of usage DEPTH_STENCIL_ATTACHMENT; null: no depths. ridgelight_view_distance tells what they are.
    const struct RidgelightImage *depth;
    // Where the scene has voids: a texel a sample, of R32F, R16F or R16_UNORM, 0 where there is ground, 1 where there is
    // none.
    const struct RidgelightImage *voids;
} RidgelightViewImages;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// One sentence on why the last call on this thread that failed did: UTF-8, ended by a nul, good until
// another call on this thread fails. Empty before any has.
const char *ridgelight_last_error(void);

// The version of the library: major << 16 | minor << 8 | patch.
uint32_t ridgelight_version(void);

// Whether the library does for a program that was compiled with a header of a version: with
// RIDGELIGHT_VERSION. The major must be the same, and before 1.0 the minor; else the library may not be older.
//
// Returns OK, or ARGUMENT.
enum RidgelightResult ridgelight_check_version(uint32_t header);

// Writes what a device must be made with, beside what its engine wants itself: before there is one.
//
// Returns OK, or ARGUMENT.
//
// # Safety
// `requirements` is null or points at a struct whose struct_size is set.
enum RidgelightResult ridgelight_requirements(struct RidgelightRequirements *requirements);

// Whether a device will do: before one is made, so that `device` may be anything.
//
// Returns OK; DEVICE where it lacks something, which ridgelight_last_error names; ARGUMENT.
//
// # Safety
// `get_instance_proc_addr` is the loader's, the others are of its instance.
enum RidgelightResult ridgelight_check_device(PFN_vkGetInstanceProcAddr get_instance_proc_addr,
                                              VkInstance instance,
                                              VkPhysicalDevice physical_device);

// Plans a picture of a scene for a host's device. `quality` may be null; `picture` is flags
// RIDGELIGHT_PICTURE_; `memory_budget` is bytes of all images and buffers, 0: half of the largest heap.
//
// Returns OK, ARGUMENT, SETTING or LIMIT.
//
// # Safety
// Pointers are null, or to structs whose struct_size is set and whose pointers and handles are what their
// fields say; `plan` may be written to.
enum RidgelightResult ridgelight_plan_create(const struct RidgelightHost *host,
                                             const struct RidgelightScene *scene,
                                             const struct RidgelightQuality *quality,
                                             uint32_t picture,
                                             uint64_t memory_budget,
                                             struct RidgelightPlan **plan);

// Gives a plan up; renderers made for it keep theirs. Null is allowed.
//
// # Safety
// It came from ridgelight_plan_create and is not used again.
void ridgelight_plan_destroy(struct RidgelightPlan *plan);

// Says how much of what a plan has.
//
// Returns OK, or ARGUMENT.
//
// # Safety
// `plan` is alive or null; `info` is null or points at a struct whose struct_size is set.
enum RidgelightResult ridgelight_plan_info(const struct RidgelightPlan *plan,
                                           struct RidgelightPlanInfo *info);

// Describes input number `index` of a plan.
//
// Returns OK; ARGUMENT, beyond the last too.
//
// # Safety
// `plan` is alive or null; `info` is null or points at a struct whose struct_size is set.
enum RidgelightResult ridgelight_plan_input(const struct RidgelightPlan *plan,
                                            uint32_t index,
                                            struct RidgelightImageInfo *info);

// Has input number `index` come in a buffer of the caller's instead of an image, as rows of texels of `format`,
// 0: that of ridgelight_plan_input. Heights may be R32F, R16F or R16_UNORM; environment, albedo and colours of lights
// RGBA32F, RGBA16F, RGBA8 UNORM or SRGB. Each recording then begins with one copy to an image of the renderer's own.
// Before a renderer is made; nobody else uses the plan meanwhile.
//
// Returns OK; ARGUMENT, beyond the last too; SETTING for texels that it cannot have.
//
// # Safety
// `plan` is alive or null.
enum RidgelightResult ridgelight_plan_take_buffer(struct RidgelightPlan *plan,
                                                  uint32_t index,
                                                  VkFormat format);

// Describes output number `index` of a plan.
//
// Returns OK; ARGUMENT, beyond the last too.
//
// # Safety
// `plan` is alive or null; `info` is null or points at a struct whose struct_size is set.
enum RidgelightResult ridgelight_plan_output(const struct RidgelightPlan *plan,
                                             uint32_t index,
                                             struct RidgelightImageInfo *info);

// Makes all that a plan needs on a host's device, for `slots` frames in flight (0: 1): recording takes nothing
// more of it. `allocator` may be null: memory is then taken in blocks of 4 MiB.
//
// Internal images serve all slots: command buffers of different slots run one after the other on one queue.
//
// Returns OK, ARGUMENT, SETTING or DEVICE.
//
// # Safety
// Pointers are null, or to structs whose struct_size is set, and whose handles are alive until the renderer is
// destroyed, as is what `allocator` points at through `user`; `renderer` may be written to.
enum RidgelightResult ridgelight_renderer_create(const struct RidgelightHost *host,
                                                 const struct RidgelightPlan *plan,
                                                 uint32_t slots,
                                                 const struct RidgelightAllocator *allocator,
                                                 struct RidgelightRenderer **renderer);

// Frees everything. The device must be done with all that was recorded. Null is allowed.
//
// # Safety
// It came from ridgelight_renderer_create and is not used again.
void ridgelight_renderer_destroy(struct RidgelightRenderer *renderer);

// Appends a plan to `commands`: no submit, no wait, nothing allocated on the device. Checks everything first:
// after an error nothing has been recorded.
//
// `commands` is being recorded outside a render pass, for the host's family. `slot` is the frame in flight,
// whose last command buffer has run. `inputs` and `outputs` are the plan's, in its order.
//
// Returns OK, ARGUMENT or SETTING.
//
// # Safety
// `renderer` is alive or null, and used by this thread alone meanwhile; arrays are as long as said, and each
// struct's struct_size is set; images and views are alive until the command buffer has run.
enum RidgelightResult ridgelight_record(struct RidgelightRenderer *renderer,
                                        VkCommandBuffer commands,
                                        uint32_t slot,
                                        const struct RidgelightImage *inputs,
                                        uint32_t input_count,
                                        const struct RidgelightImage *outputs,
                                        uint32_t output_count);

// Appends what an edit of a rectangle of heights needs, to a plan of RIDGELIGHT_PICTURE_KEEPS_HORIZONS: the same
// bits in every output as ridgelight_record. Outputs hold what the last recording left in them.
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

// Goes over to a plan that differs in what its passes are told, not in which there are nor in images and
// buffers: another colour of a light, a sun that has moved a little. What is in flight goes on with the plan that
// it was recorded with, and need not be waited for; what is recorded next is a whole recording.
//
// Returns OK, ARGUMENT; SETTING where the plan needs a renderer of its own: the old one stays.
//
// # Safety
// Both are alive or null; the renderer is used by this thread alone meanwhile.
enum RidgelightResult ridgelight_replace_plan(struct RidgelightRenderer *renderer,
                                              const struct RidgelightPlan *plan);

// GPU times of the passes that `slot` recorded last, in order. Never waits: `count` becomes 0 while they are not
// all in, and where the queue family has no timestamps.
//
// `count` is how many `timings` has room for, and becomes how many there are; more than fit are left out.
//
// Returns OK, or ARGUMENT.
//
// # Safety
// `renderer` is alive or null; `timings` has `count` structs, each with its struct_size set.
enum RidgelightResult ridgelight_timings(const struct RidgelightRenderer *renderer,
                                         uint32_t slot,
                                         struct RidgelightTiming *timings,
                                         uint32_t *count);

// Makes what pictures of a scene's light need, for `slots` frames in flight (0: 1): `plan` lights it. `format` is
// R32G32B32A32 or R16G16B16A16 SFLOAT, which get linear radiance, or of a screen, 8 or 10 bits a colour, UNORM or SRGB,
// which get exposure, clip and sRGB. `allocator` may be null.
//
// The device needs dynamicRendering of Vulkan 1.3 besides what ridgelight_requirements asks for, and the host's family
// graphics.
//
// Returns OK, ARGUMENT, SETTING, LIMIT or DEVICE.
//
// # Safety
// As ridgelight_renderer_create; `scene` and `camera` are null or structs whose struct_size is set, `scene`'s pointers
// what their fields say.
enum RidgelightResult ridgelight_view_create(const struct RidgelightHost *host,
                                             const struct RidgelightScene *scene,
                                             const struct RidgelightPlan *plan,
                                             const struct RidgelightCamera *camera,
                                             VkFormat format,
                                             uint32_t slots,
                                             const struct RidgelightAllocator *allocator,
                                             struct RidgelightView **view);

// Frees everything. The device must be done with all that was recorded. Null is allowed.
//
// # Safety
// It came from ridgelight_view_create and is not used again.
void ridgelight_view_destroy(struct RidgelightView *view);

// Appends a picture to `commands`, which is being recorded outside rendering for the host's family: a second call,
// after ridgelight_record. `camera` may be another each time, of the same picture size and samples; null: the last.
// Checks everything first: after an error nothing has been recorded.
//
// Returns OK, ARGUMENT, SETTING, or LIMIT for a camera whose picture is beyond the device's.
//
// # Safety
// As ridgelight_record: of `images` and `camera`, which are null or structs whose struct_size is set.
enum RidgelightResult ridgelight_view_record(struct RidgelightView *view,
                                             VkCommandBuffer commands,
                                             uint32_t slot,
                                             const struct RidgelightCamera *camera,
                                             const struct RidgelightViewImages *images);

// What a value of the depth image stands for: distance along the direction of view from the plane of the eye, infinite
// where no ground is seen; of the camera that was recorded last.
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

// The image that input number `index`, of a plan that takes a buffer for it, is copied to, as each recording leaves it:
// for passes of one's own, and for ridgelight_view_record. It is to be left so.
//
// Returns OK; ARGUMENT, for an input in an image too.
//
// # Safety
// `renderer` is alive or null; `image` is null or points at a struct whose struct_size is set.
enum RidgelightResult ridgelight_taken(const struct RidgelightRenderer *renderer,
                                       uint32_t index,
                                       struct RidgelightImage *image);

// Fills heights that hold no data, before they go to the device: those that are NaN, and where `voids` is not null those
// whose byte is not 0. Each takes the mean of its neighbours that are known, from the rim inwards, as the command line has
// it; the others keep their bits. Of `voids` every byte becomes 1 or 0: whether there is no ground. Light is found for
// filled samples, too, and is the caller's to mask; for pictures before a camera the marks go to the device, see
// RidgelightScene's has_voids.
//
// Returns OK; ARGUMENT; SETTING for an infinite height, which is named, and for nothing but voids: then nothing is changed.
//
// # Safety
// `heights` is null or points at rows times cols numbers, `voids` at as many bytes, row after row from the north-west;
// nobody else uses them meanwhile.
enum RidgelightResult ridgelight_fill_voids(uint32_t rows,
                                            uint32_t cols,
                                            float *heights,
                                            uint8_t *voids);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* RIDGELIGHT_H */

/* Updates the shadows of a terrain with several levels of detail under a moving sun, a few parts of a level per frame, within
 * a budget in milliseconds. Writes `sun_share` of the finest level, row by row, as floats. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ridgelight.h"

/* All levels have the same number of grid points. Each covers the middle half, along each side, of the next coarser level.
 * SETS: one set of maps is shown while the other is filled. */
enum { SIDE = 128, TEXELS = SIDE * SIDE, LEVELS = 3, PARTS = 2, MAPS = 3, SETS = 2, CYCLES = 3 };

static void must(int ok, const char *what) {
    if (!ok) {
        fprintf(stderr, "%s: %s\n", what, ridgelight_last_error());
        exit(1);
    }
}
#define VK(call) must((call) == VK_SUCCESS, #call)
#define RL(call) must((call) == RIDGELIGHT_RESULT_OK, #call)

static VkPhysicalDevice physical_device;
static VkDevice device;

static VkDeviceMemory allocate(VkMemoryRequirements needs, VkMemoryPropertyFlags flags) {
    VkPhysicalDeviceMemoryProperties all;
    vkGetPhysicalDeviceMemoryProperties(physical_device, &all);
    VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = needs.size};
    for (; info.memoryTypeIndex < all.memoryTypeCount; info.memoryTypeIndex++)
        if (needs.memoryTypeBits >> info.memoryTypeIndex & 1 &&
            (all.memoryTypes[info.memoryTypeIndex].propertyFlags & flags) == flags) break;
    VkDeviceMemory memory;
    VK(vkAllocateMemory(device, &info, NULL, &memory));
    return memory;
}

/* In layout GENERAL whenever no commands run. */
static const RidgelightImageState KEPT = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_COPY_BIT,
    VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_TRANSFER_READ_BIT |
        VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL};

static RidgelightImage image(void) {
    VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO, .imageType = VK_IMAGE_TYPE_2D,
        .format = VK_FORMAT_R32_SFLOAT, .extent = {SIDE, SIDE, 1}, .mipLevels = 1, .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT, .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
            VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    RidgelightImage made = {.struct_size = sizeof made, .before = KEPT, .after = KEPT};
    VK(vkCreateImage(device, &info, NULL, &made.image));
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device, made.image, &needs);
    VK(vkBindImageMemory(device, made.image, allocate(needs, 0), 0));
    VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, .image = made.image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D, .format = info.format,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    VK(vkCreateImageView(device, &view, NULL, &made.view));
    return made;
}

static VkQueue queue;
static VkCommandBuffer commands;

static void begin(void) {
    VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    VK(vkBeginCommandBuffer(commands, &info));
}

/* The end of a frame. An engine has a slot and a command buffer for each frame in flight, and waits for the oldest one. */
static void end(void) {
    VK(vkEndCommandBuffer(commands));
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands};
    VK(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE));
    VK(vkQueueWaitIdle(queue));
}

/* A ridge every `width`: from 0 up to half of it. */
static int ridge(int at, int width) { return abs((at % width + width) % width - width / 2); }

/* The plan of a level under the sun of a cycle. */
static RidgelightPlan *plan_of(const RidgelightHost *host, int level, int cycle) {
    double cell = 10 * (1 << level);
    RidgelightSun sun = {.struct_size = sizeof sun, .irradiance = {1, 1, 1}, .azimuth_rad = 0.3 + 0.9 * cycle,
        .elevation_rad = 0.2, .diameter_rad = 0.0093};
    RidgelightScene scene = {.struct_size = sizeof scene, .rows = SIDE, .cols = SIDE, .cell_m = {cell, cell},
        .suns = &sun, .sun_count = 1};
    RidgelightOuter outer = {.struct_size = sizeof outer, .rows = SIDE, .cols = SIDE, .cell_m = {2 * cell, 2 * cell},
        .place = {SIDE / 4, SIDE / 4}};
    RidgelightPlan *plan;
    RL(ridgelight_shadow_heights_create(host, &scene, level + 1 < LEVELS ? &outer : NULL, PARTS, &plan));
    return plan;
}

/* How many of the `left` parts the next frame records: as many as fit the budget at the last measured time per part, but at least
 * one. One if no time is known. */
static int parts_within(double budget_ms, double part_ms, int left) {
    int parts = 1;
    while (parts < left && part_ms > 0 && (parts + 1) * part_ms <= budget_ms) parts++;
    return parts;
}

int main(int argc, char **argv) {
    must(argc == 2, "usage: distant OUT");
    RL(ridgelight_check_version(RIDGELIGHT_VERSION));
    const char *given = getenv("BUDGET_MS");
    double budget_ms = given ? atof(given) : 1.0;

    /* The engine's own: an instance and a device with what Ridgelight needs, a queue, a command buffer. */
    RidgelightRequirements needs = {.struct_size = sizeof needs};
    RL(ridgelight_requirements(&needs));
    VkApplicationInfo app = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = needs.api_version};
    VkInstanceCreateInfo instance_info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &app};
    VkInstance instance;
    VK(vkCreateInstance(&instance_info, NULL, &instance));
    VkResult found = vkEnumeratePhysicalDevices(instance, &(uint32_t){1}, &physical_device);
    must(found == VK_SUCCESS || found == VK_INCOMPLETE, "vkEnumeratePhysicalDevices");
    RL(ridgelight_check_device(vkGetInstanceProcAddr, instance, physical_device));
    VkQueueFamilyProperties families[16];
    uint32_t count = 16, family = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical_device, &count, families);
    while (family < count && !(families[family].queueFlags & needs.queue_flags)) family++;
    VkDeviceQueueCreateInfo queue_info = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = family, .queueCount = 1, .pQueuePriorities = &(float){1}};
    VkDeviceCreateInfo device_info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .queueCreateInfoCount = 1, .pQueueCreateInfos = &queue_info};
    VK(vkCreateDevice(physical_device, &device_info, NULL, &device));
    vkGetDeviceQueue(device, family, 0, &queue);
    VkCommandPoolCreateInfo pool_info = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT, .queueFamilyIndex = family};
    VkCommandPool pool;
    VK(vkCreateCommandPool(device, &pool_info, NULL, &pool));
    VkCommandBufferAllocateInfo commands_info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = pool, .commandBufferCount = 1};
    VK(vkAllocateCommandBuffers(device, &commands_info, &commands));
    VkBufferCreateInfo buffer_info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = 4 * TEXELS,
        .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    VkBuffer buffer;
    VK(vkCreateBuffer(device, &buffer_info, NULL, &buffer));
    VkMemoryRequirements buffer_needs;
    vkGetBufferMemoryRequirements(device, buffer, &buffer_needs);
    VkDeviceMemory memory = allocate(buffer_needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    VK(vkBindBufferMemory(device, buffer, memory, 0));
    float *texels;
    VK(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, (void **)&texels));

    /* Once: for each level a renderer, its heights, and two sets of maps. */
    RidgelightHost host = {.struct_size = sizeof host, .queue_family = family, .instance = instance,
        .physical_device = physical_device, .device = device, .get_instance_proc_addr = vkGetInstanceProcAddr};
    RidgelightRenderer *renderers[LEVELS];
    RidgelightImage heights[LEVELS], maps[LEVELS][SETS][MAPS];
    VkBufferImageCopy region = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, .imageExtent = {SIDE, SIDE, 1}};
    for (int level = 0; level < LEVELS; level++) {
        RidgelightPlan *plan = plan_of(&host, level, 0);
        RL(ridgelight_renderer_create(&host, plan, 1, NULL, &renderers[level]));
        ridgelight_plan_destroy(plan);
        heights[level] = image();
        VkImageMemoryBarrier made[1 + SETS * MAPS];
        for (int i = 0; i < 1 + SETS * MAPS; i++) {
            RidgelightImage *of = i ? &maps[level][(i - 1) / MAPS][(i - 1) % MAPS] : &heights[level];
            if (i) *of = image();
            made[i] = (VkImageMemoryBarrier){.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER, .image = of->image,
                .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT, .newLayout = VK_IMAGE_LAYOUT_GENERAL,
                .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
        }
        /* The same hills on all levels, at every 1st, 2nd or 4th grid point of the finest spacing. */
        for (int i = 0; i < TEXELS; i++) {
            int step = 1 << level, first = SIDE / 2 - SIDE / 2 * step;
            int x = first + i % SIDE * step, y = first + i / SIDE * step;
            texels[i] = (float)(4 * ridge(3 * x + y, 100) + 3 * ridge(x - 2 * y, 140));
        }
        begin();
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, NULL, 0,
            NULL, 1 + SETS * MAPS, made);
        vkCmdCopyBufferToImage(commands, buffer, heights[level].image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
        end();
    }

    /* A cycle updates all levels from the coarsest to the finest; the sun moves between cycles. */
    int frames = 0, level = LEVELS - 1, part = 0, cycle = 0;
    double part_ms[LEVELS] = {0}, longest_ms = 0, shortest_part_ms = 0, predicted_ms = 0;
    for (; cycle < CYCLES; frames++) {
        int in_frame = parts_within(budget_ms, part_ms[level], PARTS - part);
        uint32_t passes[PARTS] = {0};
        if (in_frame > 1 && in_frame * part_ms[level] > predicted_ms) predicted_ms = in_frame * part_ms[level];
        begin();
        if (part == 0 && cycle > 0) {
            RidgelightPlan *plan = plan_of(&host, level, cycle);
            RL(ridgelight_replace_plan(renderers[level], plan, NULL, NULL));
            ridgelight_plan_destroy(plan);
        }
        for (int i = 0; i < in_frame; i++) passes[i] = (uint32_t)part++;
        RidgelightImage inputs[MAPS] = {heights[level]}, *written = maps[level][cycle % SETS];
        if (level + 1 < LEVELS) memcpy(inputs + 1, maps[level + 1][cycle % SETS], 2 * sizeof *inputs);
        RL(ridgelight_record_passes(renderers[level], commands, 0, inputs, level + 1 < LEVELS ? 3 : 1, written, MAPS, passes,
            (uint32_t)in_frame));
        end();
        RidgelightTiming times[PARTS];
        for (int i = 0; i < PARTS; i++) times[i].struct_size = sizeof *times;
        uint32_t timed = PARTS;
        RL(ridgelight_timings(renderers[level], 0, times, &timed));
        double ms = 0;
        for (uint32_t i = 0; i < timed && i < PARTS; i++) ms += times[i].ns / 1e6;
        /* Without a time the next frame records one part. */
        part_ms[level] = ms / in_frame;
        if (ms > longest_ms) longest_ms = ms;
        if (shortest_part_ms == 0 || part_ms[level] < shortest_part_ms) shortest_part_ms = part_ms[level];
        if (part == PARTS) {
            part = 0;
            level = (level + LEVELS - 1) % LEVELS;
            cycle += level == LEVELS - 1;
        }
    }
    printf("%d cycles of %d levels in %d frames; the longest took %.3f ms\n", CYCLES, LEVELS, frames, longest_ms);
    printf("the shortest part took %.17g ms; frames of several parts were predicted to take at most %.17g ms\n", shortest_part_ms,
        predicted_ms);

    begin();
    VkMemoryBarrier reading = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT, .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    vkCmdCopyImageToBuffer(commands, maps[0][(CYCLES - 1) % SETS][2].image, VK_IMAGE_LAYOUT_GENERAL, buffer, 1, &region);
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &reading, 0, NULL,
        0, NULL);
    end();
    FILE *out = fopen(argv[1], "wb");
    must(out && fwrite(texels, 4, TEXELS, out) == TEXELS && !fclose(out), argv[1]);
    for (level = 0; level < LEVELS; level++) ridgelight_renderer_destroy(renderers[level]);
    return 0;
}

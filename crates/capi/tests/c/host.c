/* Ridgelight in a Vulkan program of its own, by C. Writes the light of every texel, row by row, as floats. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ridgelight.h"

enum { ROWS = 48, COLS = 64, TEXELS = ROWS * COLS };

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

/* An image as the plan asks for it, in the state that it comes in and the one that it is to be left in. */
static RidgelightImage image(RidgelightImageInfo wanted, VkImageUsageFlags usage) {
    VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO, .imageType = VK_IMAGE_TYPE_2D,
        .format = wanted.format, .extent = {wanted.extent[0], wanted.extent[1], 1}, .mipLevels = 1,
        .arrayLayers = 1, .samples = VK_SAMPLE_COUNT_1_BIT, .usage = wanted.usage | usage};
    RidgelightImage made = {.struct_size = sizeof made};
    VK(vkCreateImage(device, &info, NULL, &made.image));
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device, made.image, &needs);
    VK(vkBindImageMemory(device, made.image, allocate(needs, 0), 0));
    VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, .image = made.image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D, .format = wanted.format,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    VK(vkCreateImageView(device, &view, NULL, &made.view));
    return made;
}

int main(int argc, char **argv) {
    int frames = argc == 3 ? atoi(argv[2]) : 1;
    must((argc == 2 || argc == 3) && frames > 0, "usage: host OUT [FRAMES]");
    RL(ridgelight_check_version(RIDGELIGHT_VERSION));

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
    VkQueue queue;
    vkGetDeviceQueue(device, family, 0, &queue);
    VkCommandPoolCreateInfo pool_info = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT, .queueFamilyIndex = family};
    VkCommandPool pool;
    VK(vkCreateCommandPool(device, &pool_info, NULL, &pool));
    VkCommandBufferAllocateInfo commands_info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = pool, .commandBufferCount = 1};
    VkCommandBuffer commands;
    VK(vkAllocateCommandBuffers(device, &commands_info, &commands));
    VkBufferCreateInfo buffer_info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = 8 * TEXELS,
        .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    VkBuffer buffer;
    VK(vkCreateBuffer(device, &buffer_info, NULL, &buffer));
    VkMemoryRequirements buffer_needs;
    vkGetBufferMemoryRequirements(device, buffer, &buffer_needs);
    VkDeviceMemory memory = allocate(buffer_needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    VK(vkBindBufferMemory(device, buffer, memory, 0));
    float *texels;
    VK(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, (void **)&texels));
    for (int i = 0; i < TEXELS; i++) texels[i] = (i / COLS * 31 + i % COLS * 17) % 7 - 3;

    /* Once for a scene: a plan, its renderer, and the engine's images. */
    RidgelightHost host = {.struct_size = sizeof host, .queue_family = family, .instance = instance,
        .physical_device = physical_device, .device = device, .get_instance_proc_addr = vkGetInstanceProcAddr};
    RidgelightSun sun = {.struct_size = sizeof sun, .irradiance = {3, 3, 3},
        .elevation_rad = 30 * (3.14159265358979323846 / 180), .diameter_rad = 0.5 * (3.14159265358979323846 / 180)};
    RidgelightScene scene = {.struct_size = sizeof scene, .rows = ROWS, .cols = COLS, .sky = {0.5f, 0.5f, 0.5f},
        .suns = &sun, .sun_count = 1};
    RidgelightPlan *plan;
    RidgelightRenderer *renderer;
    RL(ridgelight_plan_create(&host, &scene, NULL, 0, 0, &plan));
    RL(ridgelight_renderer_create(&host, plan, 1, NULL, &renderer));
    RidgelightImageInfo wanted = {.struct_size = sizeof wanted};
    RL(ridgelight_plan_input(plan, 0, &wanted));
    RidgelightImage heights = image(wanted, VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    RL(ridgelight_plan_output(plan, 0, &wanted));
    RidgelightImage light = image(wanted, VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    heights.before = (RidgelightImageState){VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
        VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
    light.after = (RidgelightImageState){VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
        VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};

    /* Each frame: what the engine does before, Ridgelight, what the engine does after. */
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    VkImageMemoryBarrier filling = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT, .newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
        .image = heights.image, .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    VkMemoryBarrier reading = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT, .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    VkBufferImageCopy from = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, .imageExtent = {COLS, ROWS, 1}};
    VkBufferImageCopy to = from;
    to.bufferOffset = 4 * TEXELS;
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands};
    for (int frame = 0; frame < frames; frame++) {
        memset(texels + TEXELS, 0, 4 * TEXELS);
        VK(vkBeginCommandBuffer(commands, &begin));
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, NULL, 0,
            NULL, 1, &filling);
        vkCmdCopyBufferToImage(commands, buffer, heights.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &from);
        RL(ridgelight_record(renderer, commands, 0, &heights, 1, &light, 1));
        vkCmdCopyImageToBuffer(commands, light.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &to);
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &reading, 0, NULL,
            0, NULL);
        VK(vkEndCommandBuffer(commands));
        VK(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE));
        VK(vkQueueWaitIdle(queue));
    }

    FILE *out = fopen(argv[1], "wb");
    must(out && fwrite(texels + TEXELS, 4, TEXELS, out) == TEXELS && !fclose(out), argv[1]);
    ridgelight_renderer_destroy(renderer);
    ridgelight_plan_destroy(plan);
    return 0;
}

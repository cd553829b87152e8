// Ridgelight in a Vulkan program of its own, by C++. Writes the light of every texel, row by row, as floats.
#include <algorithm>
#include <array>
#include <fstream>
#include <iostream>
#include <map>
#include <stdexcept>

#include <vulkan/vulkan_raii.hpp>

#include "ridgelight.hpp"

constexpr uint32_t ROWS = 48, COLS = 64, TEXELS = ROWS * COLS;
constexpr double DEGREE = 3.14159265358979323846 / 180;

static void rl(RidgelightResult result) {
    if (result != RIDGELIGHT_RESULT_OK) throw std::runtime_error(ridgelight_last_error());
}

// The engine's memory, Ridgelight's too.
struct Memory {
    const vk::raii::PhysicalDevice &physical_device;
    const vk::raii::Device &device;
    std::map<VkDeviceMemory, vk::raii::DeviceMemory> held;

    VkDeviceMemory take(const vk::MemoryRequirements &needs, vk::MemoryPropertyFlags flags) {
        auto all = physical_device.getMemoryProperties();
        for (uint32_t type = 0; type < all.memoryTypeCount; type++) {
            if (!(needs.memoryTypeBits >> type & 1) || (all.memoryTypes[type].propertyFlags & flags) != flags) continue;
            vk::raii::DeviceMemory made(device, {needs.size, type});
            VkDeviceMemory handle = *made;
            held.emplace(handle, std::move(made));
            return handle;
        }
        throw std::runtime_error("no such memory");
    }
    bool allocate(const RidgelightMemoryRequest &request, RidgelightAllocation &allocation) noexcept {
        try {
            bool is_mapped = request.used_by != RIDGELIGHT_MEMORY_DEVICE;
            vk::MemoryPropertyFlags flags = {};
            if (is_mapped) flags = vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent;
            allocation = {take(request.requirements, flags), 0, nullptr, 0};
            if (is_mapped) allocation.mapped = held.at(allocation.memory).mapMemory(0, VK_WHOLE_SIZE);
            return true;
        } catch (...) {
            return false;
        }
    }
    void free(const RidgelightAllocation &allocation) noexcept { held.erase(allocation.memory); }
};

// An image as the plan asks for it.
struct Image {
    vk::raii::Image image;
    vk::raii::ImageView view = nullptr;

    Image(Memory &memory, const RidgelightImageInfo &wanted, vk::ImageUsageFlags usage)
        : image(memory.device, {{}, vk::ImageType::e2D, vk::Format(wanted.format), {wanted.extent[0], wanted.extent[1], 1},
                                1, 1, vk::SampleCountFlagBits::e1, vk::ImageTiling::eOptimal,
                                vk::ImageUsageFlags(wanted.usage) | usage}) {
        image.bindMemory(memory.take(image.getMemoryRequirements(), {}), 0);
        view = {memory.device, {{}, *image, vk::ImageViewType::e2D, vk::Format(wanted.format), {}, whole()}};
    }
    static vk::ImageSubresourceRange whole() { return {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1}; }
    RidgelightImage lent() const {
        auto made = ridgelight::sized<RidgelightImage>();
        made.image = *image;
        made.view = *view;
        return made;
    }
};

static void run(const char *out, int frames) {
    // The engine's own: an instance and a device with what Ridgelight needs, a queue, a command buffer.
    rl(ridgelight_check_version(RIDGELIGHT_VERSION));
    auto needs = ridgelight::sized<RidgelightRequirements>();
    rl(ridgelight_requirements(&needs));
    vk::raii::Context context;
    vk::ApplicationInfo app({}, 0, {}, 0, needs.api_version);
    vk::raii::Instance instance(context, {{}, &app});
    vk::raii::PhysicalDevice physical_device = std::move(vk::raii::PhysicalDevices(instance).front());
    rl(ridgelight_check_device(vkGetInstanceProcAddr, *instance, *physical_device));
    auto families = physical_device.getQueueFamilyProperties();
    uint32_t family = 0;
    while (!(VkQueueFlags(families.at(family).queueFlags) & needs.queue_flags)) family++;
    constexpr float priority = 1;
    vk::DeviceQueueCreateInfo queues({}, family, 1, &priority);
    vk::raii::Device device(physical_device, {{}, queues});
    vk::raii::Queue queue(device, family, 0);
    vk::raii::CommandPool pool(device, {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, family});
    vk::raii::CommandBuffer commands = std::move(vk::raii::CommandBuffers(device, {*pool, {}, 1}).front());
    Memory memory{physical_device, device, {}};
    vk::raii::Buffer buffer(device, {{}, 8 * TEXELS, vk::BufferUsageFlagBits::eTransferSrc | vk::BufferUsageFlagBits::eTransferDst});
    auto visible = vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent;
    VkDeviceMemory staging = memory.take(buffer.getMemoryRequirements(), visible);
    buffer.bindMemory(staging, 0);
    auto texels = static_cast<float *>(memory.held.at(staging).mapMemory(0, VK_WHOLE_SIZE));
    for (uint32_t i = 0; i < TEXELS; i++) texels[i] = float((i / COLS * 31 + i % COLS * 17) % 7) - 3;

    // Once for a scene: a plan, its renderer, and the engine's images.
    auto host = ridgelight::sized<RidgelightHost>();
    host.instance = *instance, host.physical_device = *physical_device, host.device = *device, host.queue_family = family;
    host.get_instance_proc_addr = vkGetInstanceProcAddr;
    auto sun = ridgelight::sized<RidgelightSun>();
    for (float &channel : sun.irradiance) channel = 3;
    sun.elevation_rad = 30 * DEGREE, sun.diameter_rad = 0.5 * DEGREE;
    auto scene = ridgelight::sized<RidgelightScene>();
    scene.rows = ROWS, scene.cols = COLS, scene.suns = &sun, scene.sun_count = 1;
    for (float &channel : scene.sky) channel = 0.5f;
    ridgelight::Plan plan;
    rl(ridgelight::create(plan, host, scene));
    RidgelightAllocator allocator = ridgelight::allocator(memory);
    ridgelight::Renderer renderer;
    rl(ridgelight::create(renderer, host, plan, 1, &allocator));
    auto wanted = ridgelight::sized<RidgelightImageInfo>();
    rl(ridgelight_plan_input(plan.get(), 0, &wanted));
    Image heights(memory, wanted, vk::ImageUsageFlagBits::eTransferDst);
    rl(ridgelight_plan_output(plan.get(), 0, &wanted));
    Image light(memory, wanted, vk::ImageUsageFlagBits::eTransferSrc);
    std::array<RidgelightImage, 1> inputs{heights.lent()}, outputs{light.lent()};
    inputs[0].before = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
    outputs[0].after = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};

    // Each frame: what the engine does before, Ridgelight, what the engine does after.
    vk::BufferImageCopy from(0, 0, 0, {vk::ImageAspectFlagBits::eColor, 0, 0, 1}, {}, {COLS, ROWS, 1}), to = from;
    to.bufferOffset = 4 * TEXELS;
    vk::ImageMemoryBarrier filling({}, vk::AccessFlagBits::eTransferWrite, vk::ImageLayout::eUndefined,
        vk::ImageLayout::eTransferDstOptimal, VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, *heights.image, Image::whole());
    vk::MemoryBarrier reading(vk::AccessFlagBits::eTransferWrite, vk::AccessFlagBits::eHostRead);
    for (int frame = 0; frame < frames; frame++) {
        std::fill_n(texels + TEXELS, TEXELS, 0.0f);
        commands.begin(vk::CommandBufferBeginInfo());
        commands.pipelineBarrier(vk::PipelineStageFlagBits::eTopOfPipe, vk::PipelineStageFlagBits::eTransfer, {}, {}, {}, filling);
        commands.copyBufferToImage(*buffer, *heights.image, vk::ImageLayout::eTransferDstOptimal, from);
        rl(ridgelight::record(renderer, *commands, 0, inputs, outputs));
        commands.copyImageToBuffer(*light.image, vk::ImageLayout::eTransferSrcOptimal, *buffer, to);
        commands.pipelineBarrier(vk::PipelineStageFlagBits::eTransfer, vk::PipelineStageFlagBits::eHost, {}, reading, {}, {});
        commands.end();
        queue.submit(vk::SubmitInfo({}, {}, *commands));
        queue.waitIdle();
    }
    std::ofstream(out, std::ios::binary).write(reinterpret_cast<const char *>(texels + TEXELS), 4 * TEXELS);
}

int main(int argc, char **argv) try {
    int frames = argc > 2 ? std::stoi(argv[2]) : 1;
    run(argc > 1 && frames > 0 ? argv[1] : throw std::runtime_error("usage: host OUT [FRAMES]"), frames);
} catch (const std::exception &error) {
    return std::cerr << error.what() << '\n', 1;
}

/* Ridgelight for C++11 and later: owners over ridgelight.h. No exception leaves a function, and none may pass through one.
 *
 * A function that can fail returns a RidgelightResult; ridgelight_last_error() then has its sentence. After an
 * error the owner that it would have filled is empty. `create` destroys what the owner held before. For a renderer or a
 * view in flight, create into a new owner and keep the old one until its commands have run.
 */

#ifndef RIDGELIGHT_HPP
#define RIDGELIGHT_HPP

#include <memory>
#include <utility>

#include "ridgelight.h"

namespace ridgelight {

struct Destroy {
    void operator()(RidgelightPlan *plan) const noexcept { ridgelight_plan_destroy(plan); }
    void operator()(RidgelightRenderer *renderer) const noexcept { ridgelight_renderer_destroy(renderer); }
    void operator()(RidgelightView *view) const noexcept { ridgelight_view_destroy(view); }
};

// Owners. All commands that were recorded with a renderer or a view must have finished when it ends.
using Plan = std::unique_ptr<RidgelightPlan, Destroy>;
using Renderer = std::unique_ptr<RidgelightRenderer, Destroy>;
using View = std::unique_ptr<RidgelightView, Destroy>;

// A struct of ridgelight.h with its size set and every other field 0, which is its default.
template <class Struct> Struct sized() noexcept {
    Struct made{};
    made.struct_size = sizeof(Struct);
    return made;
}

// The callbacks of a memory allocator, which must outlive every renderer and view that uses them. `Memory` has
//   bool allocate(const RidgelightMemoryRequest &, RidgelightAllocation &) noexcept;
//   void free(const RidgelightAllocation &) noexcept;
template <class Memory> RidgelightAllocator allocator(Memory &memory) noexcept {
    static_assert(noexcept(memory.allocate(std::declval<const RidgelightMemoryRequest &>(),
                                           std::declval<RidgelightAllocation &>())) &&
                      noexcept(memory.free(std::declval<const RidgelightAllocation &>())),
                  "an exception must not leave a callback: declare both functions noexcept");
    RidgelightAllocator made = sized<RidgelightAllocator>();
    made.user = &memory;
    made.allocate = [](void *user, const RidgelightMemoryRequest *request, RidgelightAllocation *allocation) -> VkBool32 {
        return static_cast<Memory *>(user)->allocate(*request, *allocation) ? VK_TRUE : VK_FALSE;
    };
    made.free = [](void *user, const RidgelightAllocation *allocation) {
        static_cast<Memory *>(user)->free(*allocation);
    };
    return made;
}

// As ridgelight_plan_create.
inline RidgelightResult create(Plan &plan, const RidgelightHost &host, const RidgelightScene &scene,
                               const RidgelightQuality *quality = nullptr, uint32_t picture = 0,
                               uint64_t memory_budget = 0) noexcept {
    RidgelightPlan *made = nullptr;
    RidgelightResult result = ridgelight_plan_create(&host, &scene, quality, picture, memory_budget, &made);
    plan.reset(made);
    return result;
}

// As ridgelight_shadow_heights_create.
inline RidgelightResult create_shadow_heights(Plan &plan, const RidgelightHost &host, const RidgelightScene &scene,
                                              const RidgelightOuter *outer = nullptr, uint32_t parts = 1) noexcept {
    RidgelightPlan *made = nullptr;
    RidgelightResult result = ridgelight_shadow_heights_create(&host, &scene, outer, parts, &made);
    plan.reset(made);
    return result;
}

// As ridgelight_renderer_create.
inline RidgelightResult create(Renderer &renderer, const RidgelightHost &host, const Plan &plan, uint32_t slots = 1,
                               const RidgelightAllocator *allocator = nullptr) noexcept {
    RidgelightRenderer *made = nullptr;
    RidgelightResult result = ridgelight_renderer_create(&host, plan.get(), slots, allocator, &made);
    renderer.reset(made);
    return result;
}

// As ridgelight_view_create.
inline RidgelightResult create(View &view, const RidgelightHost &host, const RidgelightScene &scene, const Plan &plan,
                               const RidgelightCamera &camera, VkFormat format, uint32_t slots = 1,
                               const RidgelightAllocator *allocator = nullptr) noexcept {
    RidgelightView *made = nullptr;
    RidgelightResult result =
        ridgelight_view_create(&host, &scene, plan.get(), &camera, format, slots, allocator, &made);
    view.reset(made);
    return result;
}

// As ridgelight_record, for containers of RidgelightImage with data() and size().
template <class Inputs, class Outputs>
RidgelightResult record(const Renderer &renderer, VkCommandBuffer commands, uint32_t slot, const Inputs &inputs,
                        const Outputs &outputs) noexcept {
    return ridgelight_record(renderer.get(), commands, slot, inputs.data(), static_cast<uint32_t>(inputs.size()),
                             outputs.data(), static_cast<uint32_t>(outputs.size()));
}

// As ridgelight_record_passes, likewise; `passes` is a container of uint32_t.
template <class Inputs, class Outputs, class Passes>
RidgelightResult record_passes(const Renderer &renderer, VkCommandBuffer commands, uint32_t slot,
                               const Inputs &inputs, const Outputs &outputs, const Passes &passes) noexcept {
    return ridgelight_record_passes(renderer.get(), commands, slot, inputs.data(),
                                    static_cast<uint32_t>(inputs.size()), outputs.data(),
                                    static_cast<uint32_t>(outputs.size()), passes.data(),
                                    static_cast<uint32_t>(passes.size()));
}

// As ridgelight_record_edit, likewise.
template <class Inputs, class Outputs>
RidgelightResult record_edit(const Renderer &renderer, VkCommandBuffer commands, uint32_t slot, const Inputs &inputs,
                             const Outputs &outputs, const RidgelightRectangle &rectangle) noexcept {
    return ridgelight_record_edit(renderer.get(), commands, slot, inputs.data(), static_cast<uint32_t>(inputs.size()),
                                  outputs.data(), static_cast<uint32_t>(outputs.size()), &rectangle);
}

} // namespace ridgelight

#endif /* RIDGELIGHT_HPP */

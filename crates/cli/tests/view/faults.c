// A Vulkan layer that makes one function fail. RIDGELIGHT_FAULT is "NAME FIRST COUNT RESULT": COUNT calls from number FIRST
// on, counted from 1, return RESULT and do not reach the driver. vkQueueSubmit2 counts only calls that wait for a semaphore,
// which a window makes. vkGetPhysicalDeviceSurfaceCapabilitiesKHR with RESULT 0 reports a window without area.
// Supports one instance and one device.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

static PFN_vkGetInstanceProcAddr next_of_instance;
static PFN_vkGetDeviceProcAddr next_of_device;
static VkInstance instance;
static VkDevice device;

// Whether a call of this name must fail, and the result.
static int fails(const char *name, VkResult *result) {
    static char wanted[64];
    static int first, count, code, calls;
    if (!wanted[0] && sscanf(getenv("RIDGELIGHT_FAULT"), "%63s %d %d %d", wanted, &first, &count, &code) != 4) {
        abort();
    }
    if (strcmp(name, wanted) != 0) {
        return 0;
    }
    calls++;
    *result = (VkResult)code;
    return calls >= first && calls - first < count;
}

static VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, uint32_t count, const VkSubmitInfo2 *all, VkFence fence) {
    VkResult result;
    if (count > 0 && all[0].waitSemaphoreInfoCount > 0 && fails("vkQueueSubmit2", &result)) {
        return result;
    }
    return ((PFN_vkQueueSubmit2)next_of_device(device, "vkQueueSubmit2"))(queue, count, all, fence);
}

static VKAPI_ATTR VkResult VKAPI_CALL reset(VkDevice of, VkCommandPool pool, VkCommandPoolResetFlags flags) {
    VkResult result;
    if (fails("vkResetCommandPool", &result)) {
        return result;
    }
    return ((PFN_vkResetCommandPool)next_of_device(device, "vkResetCommandPool"))(of, pool, flags);
}

static VKAPI_ATTR VkResult VKAPI_CALL acquire(VkDevice of, VkSwapchainKHR chain, uint64_t patience, VkSemaphore semaphore,
                                              VkFence fence, uint32_t *image) {
    VkResult result;
    if (fails("vkAcquireNextImageKHR", &result)) {
        return result;
    }
    PFN_vkAcquireNextImageKHR next = (PFN_vkAcquireNextImageKHR)next_of_device(device, "vkAcquireNextImageKHR");
    return next(of, chain, patience, semaphore, fence, image);
}

static VKAPI_ATTR VkResult VKAPI_CALL present(VkQueue queue, const VkPresentInfoKHR *info) {
    VkResult result;
    if (fails("vkQueuePresentKHR", &result)) {
        return result;
    }
    return ((PFN_vkQueuePresentKHR)next_of_device(device, "vkQueuePresentKHR"))(queue, info);
}

static VKAPI_ATTR VkResult VKAPI_CALL capabilities(VkPhysicalDevice of, VkSurfaceKHR surface, VkSurfaceCapabilitiesKHR *reported) {
    const char *name = "vkGetPhysicalDeviceSurfaceCapabilitiesKHR";
    VkResult result;
    int is_faulty = fails(name, &result);
    if (is_faulty && result != VK_SUCCESS) {
        return result;
    }
    VkResult known = ((PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR)next_of_instance(instance, name))(of, surface, reported);
    if (is_faulty) {
        reported->currentExtent = (VkExtent2D){0, 0};
    }
    return known;
}

// The next layer's entry in the loader's chain.
static void *link_of(const void *chain, VkStructureType type) {
    const VkLayerInstanceCreateInfo *info = chain;
    while (info && !(info->sType == type && info->function == VK_LAYER_LINK_INFO)) {
        info = info->pNext;
    }
    return (void *)info;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo *info, const VkAllocationCallbacks *host,
                                                      VkInstance *made) {
    VkLayerInstanceCreateInfo *link = link_of(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    next_of_instance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    VkResult result = ((PFN_vkCreateInstance)next_of_instance(NULL, "vkCreateInstance"))(info, host, made);
    instance = *made;
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice of, const VkDeviceCreateInfo *info,
                                                    const VkAllocationCallbacks *host, VkDevice *made) {
    VkLayerDeviceCreateInfo *link = link_of(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    next_of_device = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    VkResult result = ((PFN_vkCreateDevice)next_of_instance(instance, "vkCreateDevice"))(of, info, host, made);
    device = *made;
    return result;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL of_device(VkDevice of, const char *name);

// The layer's own function of a name, or none.
static PFN_vkVoidFunction own(const char *name) {
    const struct {
        const char *name;
        PFN_vkVoidFunction function;
    } all[] = {
        {"vkCreateInstance", (PFN_vkVoidFunction)create_instance},
        {"vkCreateDevice", (PFN_vkVoidFunction)create_device},
        {"vkGetDeviceProcAddr", (PFN_vkVoidFunction)of_device},
        {"vkQueueSubmit2", (PFN_vkVoidFunction)submit},
        {"vkResetCommandPool", (PFN_vkVoidFunction)reset},
        {"vkAcquireNextImageKHR", (PFN_vkVoidFunction)acquire},
        {"vkQueuePresentKHR", (PFN_vkVoidFunction)present},
        {"vkGetPhysicalDeviceSurfaceCapabilitiesKHR", (PFN_vkVoidFunction)capabilities},
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        if (strcmp(name, all[i].name) == 0) {
            return all[i].function;
        }
    }
    return NULL;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL of_device(VkDevice of, const char *name) {
    PFN_vkVoidFunction found = own(name);
    return found ? found : next_of_device(of, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetInstanceProcAddr(VkInstance of, const char *name) {
    PFN_vkVoidFunction found = own(name);
    return found ? found : of ? next_of_instance(of, name) : NULL;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetDeviceProcAddr(VkDevice of, const char *name) {
    return of_device(of, name);
}

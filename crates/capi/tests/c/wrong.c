/* What Ridgelight refuses before it looks at any device: a code, and a sentence that names the field. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ridgelight.h"

static int failures;

static void refuses(RidgelightResult found, RidgelightResult code, const char *named) {
    if (found == code && strstr(ridgelight_last_error(), named)) return;
    fprintf(stderr, "%s: code %d: %s\n", named, (int)found, ridgelight_last_error());
    failures++;
}

int main(void) {
    refuses(ridgelight_check_version(RIDGELIGHT_VERSION), RIDGELIGHT_RESULT_OK, "");
    refuses(ridgelight_check_version(RIDGELIGHT_VERSION + 1), RIDGELIGHT_RESULT_ARGUMENT, "header: found");
    refuses(ridgelight_check_version(RIDGELIGHT_VERSION + 0x100), RIDGELIGHT_RESULT_ARGUMENT, "header: found");
    refuses(ridgelight_check_version(RIDGELIGHT_VERSION + 0x10000), RIDGELIGHT_RESULT_ARGUMENT, "header: found");
    refuses(ridgelight_requirements(NULL), RIDGELIGHT_RESULT_ARGUMENT, "requirements: found a null pointer");

    /* A size of none, of more than the library knows, and of an older header: only as much is written. */
    RidgelightRequirements needs = {0};
    refuses(ridgelight_requirements(&needs), RIDGELIGHT_RESULT_ARGUMENT, "requirements: struct_size: found 0");
    needs.struct_size = sizeof needs + 1;
    refuses(ridgelight_requirements(&needs), RIDGELIGHT_RESULT_ARGUMENT, "requirements: struct_size");
    needs.struct_size = 8;
    refuses(ridgelight_requirements(&needs), RIDGELIGHT_RESULT_OK, "");
    if (needs.struct_size != 8 || needs.api_version != VK_API_VERSION_1_1 || needs.queue_flags) {
        fprintf(stderr, "an older header's struct was written beyond its size\n");
        failures++;
    }

    RidgelightPlan *plan = (RidgelightPlan *)&needs;
    RidgelightHost host = {.struct_size = sizeof host};
    RidgelightScene scene = {.struct_size = sizeof scene};
    refuses(ridgelight_plan_create(&host, &scene, NULL, 0, 0, NULL), RIDGELIGHT_RESULT_ARGUMENT, "out: found a null");
    refuses(ridgelight_plan_create(NULL, &scene, NULL, 0, 0, &plan), RIDGELIGHT_RESULT_ARGUMENT, "host: found a null");
    if (plan) {
        fprintf(stderr, "a handle where there is no plan\n");
        failures++;
    }
    refuses(ridgelight_plan_create(&host, &scene, NULL, 0, 0, &plan), RIDGELIGHT_RESULT_ARGUMENT, "host: instance");
    host.instance = (VkInstance)&needs;
    refuses(ridgelight_plan_create(&host, &scene, NULL, 0, 0, &plan), RIDGELIGHT_RESULT_ARGUMENT, "host: physical_device");
    host.physical_device = (VkPhysicalDevice)&needs;
    refuses(ridgelight_plan_create(&host, &scene, NULL, 0, 0, &plan), RIDGELIGHT_RESULT_ARGUMENT, "host: device");
    host.device = (VkDevice)&needs;
    refuses(ridgelight_plan_create(&host, &scene, NULL, 0, 0, &plan), RIDGELIGHT_RESULT_ARGUMENT,
            "host: get_instance_proc_addr");
    refuses(ridgelight_plan_info(NULL, NULL), RIDGELIGHT_RESULT_ARGUMENT, "plan: found a null");
    refuses(ridgelight_record(NULL, NULL, 0, NULL, 0, NULL, 0), RIDGELIGHT_RESULT_ARGUMENT, "commands: found null");
    refuses(ridgelight_record_passes(NULL, NULL, 0, NULL, 0, NULL, 0, NULL, 0), RIDGELIGHT_RESULT_ARGUMENT,
            "commands: found null");
    refuses(ridgelight_time_passes(NULL, VK_TRUE), RIDGELIGHT_RESULT_ARGUMENT, "renderer: found a null");
#ifdef BEYOND
    RidgelightRequirements *shorter = malloc(8);
    shorter->struct_size = sizeof *shorter;
    ridgelight_requirements(shorter);
#endif
    refuses(ridgelight_view_record(NULL, NULL, 0, NULL, NULL), RIDGELIGHT_RESULT_ARGUMENT, "commands: found null");
    refuses(ridgelight_taken(NULL, 0, NULL), RIDGELIGHT_RESULT_ARGUMENT, "renderer: found a null");
    ridgelight_view_destroy(NULL);
    ridgelight_plan_destroy(NULL);
    ridgelight_renderer_destroy(NULL);
    return failures != 0;
}

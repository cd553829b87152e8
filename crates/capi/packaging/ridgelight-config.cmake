# find_package(ridgelight) makes the targets ridgelight::ridgelight (shared) and ridgelight::static.
get_filename_component(ridgelight_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
include(CMakeFindDependencyMacro)
find_dependency(Vulkan)
find_dependency(Threads)

if(NOT TARGET ridgelight::ridgelight)
    add_library(ridgelight::ridgelight SHARED IMPORTED)
    set_target_properties(ridgelight::ridgelight PROPERTIES
        IMPORTED_LOCATION "${ridgelight_prefix}/lib/libridgelight_c.so"
        IMPORTED_NO_SONAME TRUE
        INTERFACE_INCLUDE_DIRECTORIES "${ridgelight_prefix}/include"
        INTERFACE_LINK_LIBRARIES Vulkan::Vulkan)

    add_library(ridgelight::static STATIC IMPORTED)
    set_target_properties(ridgelight::static PROPERTIES
        IMPORTED_LOCATION "${ridgelight_prefix}/lib/libridgelight_c.a"
        INTERFACE_INCLUDE_DIRECTORIES "${ridgelight_prefix}/include"
        INTERFACE_LINK_LIBRARIES "Vulkan::Vulkan;Threads::Threads;${CMAKE_DL_LIBS};m;gcc_s")
endif()

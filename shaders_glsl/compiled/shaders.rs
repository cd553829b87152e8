// Written by build.rs from the SPIR-V of shaders_glsl/; committed by tools/shaders. Not edited by hand.

shader! {
    /// `shaders_glsl/bake/bent_directions.comp`.
    BENT_DIRECTIONS: "bent_directions", push BentDirectionsPush, words 0 8171,
    0 reads "visible_points" SampledImage { uint: true, layered: true },
    1 reads "ground" SampledImage { uint: false, layered: false },
    2 reads "directions" TexelBuffer,
    3 reads "fans" TexelBuffer,
    4 writes "bent" StorageImage { format: "Rgba32f", uint: false, layered: true },
    BentDirections {
        0 border: u32 = 0,
        1 small: bool = false,
        2 reach: i32 = 16384,
    }
}

shader! {
    /// `shaders_glsl/bounce/bounce_gather.comp`.
    BOUNCE_GATHER: "bounce_gather", push GatherPush, words 8171 11650,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 reads "height_levels" SampledImage { uint: false, layered: false },
    2 reads "level_table" SampledImage { uint: true, layered: false },
    3 reads "height_stack" SampledImage { uint: false, layered: true },
    4 reads "ground" SampledImage { uint: false, layered: false },
    5 reads "exit_radiance" SampledImage { uint: false, layered: false },
    6 reads "shade_levels" SampledImage { uint: false, layered: false },
    7 reads "shade_table" SampledImage { uint: true, layered: false },
    8 writes "bounce_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    9 reads "shade_stack" SampledImage { uint: false, layered: true },
    BounceGather {
        0 periodic: bool = false,
        1 stack: bool = false,
        2 levels: i32 = 0,
        3 shade_levels: i32 = 0,
        4 grey: bool = false,
        5 is_plane: bool = true,
        6 node_stride: i32 = 1,
    }
}

shader! {
    /// `shaders_glsl/bounce/bounce_ground.comp`.
    BOUNCE_GROUND: "bounce_ground", push BounceGroundPush, words 19821 767,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 reads "exit_radiance" StorageImage { format: "Rgba32f", uint: false, layered: false },
    2 reads "exit_grey" StorageImage { format: "R32f", uint: false, layered: false },
    3 writes "bounce_ground" StorageImage { format: "Rgba32f", uint: false, layered: false },
    4 writes "grey_ground" StorageImage { format: "Rgba16ui", uint: true, layered: false },
    BounceGround {
        0 grey: bool = false,
    }
}

shader! {
    /// `shaders_glsl/bounce/bounce_march.comp`.
    BOUNCE_MARCH: "bounce_march", push BounceMarchPush, words 20588 12391,
    0 reads "cells" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "maxima" StorageImage { format: "R32f", uint: false, layered: false },
    2 reads "ground" SampledImage { uint: false, layered: false },
    3 reads "exit_radiance" SampledImage { uint: false, layered: false },
    4 writes "bounce_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    BounceMarch {
        0 border: u32 = 0,
        1 thin_rows: bool = false,
        2 thin_cols: bool = false,
        3 most_steps: i32 = 60000,
        4 grey: bool = false,
        5 node_stride: i32 = 1,
    }
}

shader! {
    /// `shaders_glsl/bounce/bounce_shade.comp`.
    BOUNCE_SHADE: "bounce_shade", push BounceShadePush, words 32979 2678,
    0 reads "ground" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "sky_share" StorageImage { format: "R32f", uint: false, layered: false },
    2 reads "node_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    3 writes "bounce_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    BounceShade {
        0 node_stride: i32 = 2,
    }
}

shader! {
    /// `shaders_glsl/bounce/bounce_walk.comp`.
    BOUNCE_WALK: "bounce_walk", push BounceWalkPush, words 35657 14591,
    1 reads "azimuths" TexelBuffer,
    2 reads "occluders" StorageImage { format: "Rgba16ui", uint: true, layered: true },
    3 reads "bounce_ground" StorageImage { format: "Rgba32f", uint: false, layered: false },
    4 reads "grey_ground" StorageImage { format: "Rgba16ui", uint: true, layered: false },
    5 writes "bounce_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    6 writes "visibility_cache" StorageImage { format: "Rgba32ui", uint: true, layered: true },
    7 reads "line_blocks" StorageImage { format: "Rgba32ui", uint: true, layered: true },
    8 reads "grey_blocks" StorageImage { format: "Rgba16ui", uint: true, layered: true },
    BounceWalk {
        0 line_shift: i32 = 15,
        1 border: u32 = 0,
        2 marches_rows: bool = false,
        3 grey: bool = false,
        4 node_stride: i32 = 1,
        5 from: u32 = 0,
        40 layer_shift: i32 = 5,
    }
}

shader! {
    /// `shaders_glsl/bounce/cache_gather.comp`.
    CACHE_GATHER: "cache_gather", push CacheGatherPush, words 50248 3727,
    0 reads "visibility_cache" StorageImage { format: "Rgba32ui", uint: true, layered: true },
    1 reads "azimuths" TexelBuffer,
    2 reads "exit_radiance" StorageImage { format: "Rgba32f", uint: false, layered: false },
    3 reads "exit_grey" StorageImage { format: "R32f", uint: false, layered: false },
    4 reads "node_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    5 writes "bounce_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    CacheGather {
        0 border: u32 = 0,
        1 grey: bool = false,
        2 node_stride: i32 = 4,
    }
}

shader! {
    /// `shaders_glsl/view/depth_resolve.frag`.
    DEPTH_RESOLVE_FRAG: "depth_resolve_frag", push (), words 53975 193,
    0 reads "picture_depth" SampledImage { uint: false, layered: false },
    DepthResolveFrag;
}

shader! {
    /// `shaders_glsl/device/device_peak.comp`.
    DEVICE_PEAK: "device_peak", push DevicePeakPush, words 54168 1812,
    0 writes "source" StorageBuffer,
    1 writes "result" StorageBuffer,
    2 writes "filled" StorageImage { format: "R32f", uint: false, layered: false },
    3 reads "texels" SampledImage { uint: false, layered: false },
    DevicePeak {
        0 part: i32 = 0,
    }
}

shader! {
    /// `shaders_glsl/edit/dirty_list.comp`.
    DIRTY_LIST: "dirty_list", push DirtyListPush, words 55980 874,
    0 reads "dirty_texels" StorageBuffer,
    1 writes "edit_list" StorageBuffer,
    DirtyList;
}

shader! {
    /// `shaders_glsl/edit/dirty_mark.comp`.
    DIRTY_MARK: "dirty_mark", push DirtyMarkPush, words 56854 1323,
    0 writes "dirty_texels" StorageBuffer,
    1 writes "edit_list" StorageBuffer,
    DirtyMark;
}

shader! {
    /// `shaders_glsl/bake/ellipse_fit.comp`.
    ELLIPSE_FIT: "ellipse_fit", push EllipseFitPush, words 58177 5049,
    0 reads "visible_points" SampledImage { uint: true, layered: true },
    1 reads "directions" TexelBuffer,
    2 writes "ellipse_axes" StorageImage { format: "Rgba32f", uint: false, layered: false },
    3 writes "ellipse_radii" StorageImage { format: "Rgba32f", uint: false, layered: false },
    4 reads "bent" SampledImage { uint: false, layered: true },
    EllipseFit {
        0 small: bool = false,
        1 bent: bool = false,
    }
}

shader! {
    /// `shaders_glsl/sh/env_rotation.comp`.
    ENV_ROTATION: "env_rotation", push EnvRotationPush, words 63226 949,
    0 reads "environment" SampledImage { uint: false, layered: false },
    1 reads "constants" TexelBuffer,
    2 writes "env_rotation" StorageBuffer,
    EnvRotation;
}

shader! {
    /// `shaders_glsl/direct/env_tables.comp`.
    ENV_TABLES: "env_tables", push EnvTablesPush, words 64175 3357,
    0 reads "wedge_rows" StorageBuffer,
    1 writes "env_tables" StorageImage { format: "Rgba32f", uint: false, layered: true },
    2 reads "azimuths" TexelBuffer,
    EnvTables;
}

shader! {
    /// `shaders_glsl/sh/env_wedges.comp`.
    ENV_WEDGES: "env_wedges", push EnvWedgesPush, words 67532 2236,
    0 reads "environment" SampledImage { uint: false, layered: false },
    1 reads "azimuths" TexelBuffer,
    2 writes "wedge_rows" StorageBuffer,
    EnvWedges;
}

shader! {
    /// `shaders_glsl/bake/facet_mask.comp`.
    FACET_MASK: "facet_mask", push FacetMaskPush, words 69768 9176,
    0 reads "cells" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "maxima" StorageImage { format: "R32f", uint: false, layered: false },
    2 reads "directions" TexelBuffer,
    3 writes "facet_mask" StorageImage { format: "R32ui", uint: true, layered: true },
    FacetMask {
        0 border: u32 = 0,
        1 most_steps: i32 = 60000,
    }
}

shader! {
    /// `shaders_glsl/bake/fan_weights.comp`.
    FAN_WEIGHTS: "fan_weights", push FanWeightsPush, words 78944 1842,
    0 reads "bent" SampledImage { uint: false, layered: true },
    1 reads "fans" TexelBuffer,
    2 writes "fan_weights" StorageImage { format: "R32f", uint: false, layered: true },
    FanWeights;
}

shader! {
    /// `shaders_glsl/rays/height_bounds.comp`.
    HEIGHT_BOUNDS: "height_bounds", push HeightBoundsPush, words 80786 1680,
    0 reads "cells" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 writes "maxima" StorageImage { format: "R32f", uint: false, layered: false },
    2 reads "heights" SampledImage { uint: false, layered: false },
    HeightBounds {
        0 source: u32 = 0,
    }
}

shader! {
    /// `shaders_glsl/rays/height_cells.comp`.
    HEIGHT_CELLS: "height_cells", push HeightCellsPush, words 82466 2514,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 writes "cells" StorageImage { format: "Rgba32f", uint: false, layered: false },
    2 writes "ground" StorageImage { format: "Rgba32f", uint: false, layered: false },
    3 writes "batch_mean" StorageImage { format: "Rgba32f", uint: false, layered: false },
    4 writes "lost_rays" StorageBuffer,
    HeightCells {
        0 periodic: bool = false,
        1 begins_paths: bool = false,
    }
}

shader! {
    /// `shaders_glsl/horizon/height_expand.comp`.
    HEIGHT_EXPAND: "height_expand", push HeightExpandPush, words 84980 2496,
    0 reads "height_levels" SampledImage { uint: false, layered: false },
    1 reads "level_table" SampledImage { uint: true, layered: false },
    2 writes "height_stack" StorageImage { format: "R32f", uint: false, layered: true },
    HeightExpand {
        0 periodic: bool = false,
    }
}

shader! {
    /// `shaders_glsl/horizon/height_reduce.comp`.
    HEIGHT_REDUCE: "height_reduce", push ReducePush, words 87476 3600,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 writes "height_levels" StorageImage { format: "R32f", uint: false, layered: false },
    2 writes "level_table" StorageImage { format: "Rgba32ui", uint: true, layered: false },
    3 reads "constants" TexelBuffer,
    HeightReduce {
        0 periodic: bool = false,
        1 from_field: bool = false,
    }
}

shader! {
    /// `shaders_glsl/horizon/height_transpose.comp`.
    HEIGHT_TRANSPOSE: "height_transpose", push HeightTransposePush, words 91076 1113,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 writes "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    2 writes "lane_buffer" StorageBuffer,
    HeightTranspose {
        0 marches_rows: bool = false,
        1 periodic: bool = false,
        2 writes_buffer: bool = false,
    }
}

shader! {
    /// `shaders_glsl/horizon/horizon_march.comp`.
    HORIZON_MARCH: "horizon_march", push MarchPush, words 92189 6867,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "azimuths" TexelBuffer,
    2 writes "slopes" StorageImage { format: "R32ui", uint: true, layered: true },
    HorizonMarch {
        0 periodic: bool = false,
        1 writes_distances: bool = false,
        2 node_stride: i32 = 1,
    }
}

shader! {
    /// `shaders_glsl/edit/horizon_resweep.comp`.
    HORIZON_RESWEEP: "horizon_resweep", push HorizonResweepPush, words 99056 9024,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 reads "azimuths" TexelBuffer,
    2 writes "occluders" StorageImage { format: "Rgba16ui", uint: true, layered: true },
    3 writes "dirty_texels" StorageBuffer,
    4 writes "edit_list" StorageBuffer,
    HorizonResweep {
        0 line_shift: i32 = 15,
        1 hull_packed: bool = false,
        40 layer_shift: i32 = 5,
    }
}

shader! {
    /// `shaders_glsl/horizon/horizon_sweep.comp`.
    HORIZON_SWEEP: "horizon_sweep", push HorizonSweepPush, words 108080 16278,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    2 reads "azimuths" TexelBuffer,
    3 writes "occluders" StorageImage { format: "Rgba16ui", uint: true, layered: true },
    4 writes "slopes" StorageImage { format: "Rgba32ui", uint: true, layered: true },
    5 writes "lost_lines" StorageBuffer,
    6 reads "lane_buffer" StorageBuffer,
    7 writes "slopes_f16" StorageImage { format: "Rgba16ui", uint: true, layered: true },
    HorizonSweep {
        0 local_size_x: u32 = 1,
        1 hull_place: u32 = 0,
        2 hull_depth: i32 = 1,
        3 private_entries: i32 = 1,
        4 private_words: i32 = 1,
        5 shared_words: i32 = 1,
        6 hull_holds_line: bool = true,
        7 hull_packed: bool = false,
        8 writes_occluders: bool = true,
        9 slope_format: u32 = 0,
        10 periodic: bool = false,
        11 line_shift: i32 = 15,
        12 redoes_lost: bool = false,
        13 one_line: bool = false,
        14 line_private_entries: i32 = 1,
        15 line_shared_entries: i32 = 1,
        16 written_words: i32 = 1,
        40 layer_shift: i32 = 5,
    }
}

shader! {
    /// `shaders_glsl/sh/light_matrix.comp`.
    LIGHT_MATRIX: "light_matrix", push LightMatrixPush, words 124358 1854,
    0 reads "env_rotation" StorageBuffer,
    1 reads "constants" TexelBuffer,
    2 writes "light_matrix" StorageImage { format: "Rgba32f", uint: false, layered: false },
    LightMatrix;
}

shader! {
    /// `shaders_glsl/direct/light_resolve.comp`.
    LIGHT_RESOLVE: "light_resolve", push LightResolvePush, words 126212 1966,
    0 reads "scalar_sum" SampledImage { uint: false, layered: false },
    1 reads "colour_sum" SampledImage { uint: false, layered: false },
    2 reads "albedo_map" SampledImage { uint: false, layered: false },
    3 writes "radiance" StorageImage { format: "Rgba32f", uint: false, layered: false },
    4 writes "layer" StorageImage { format: "Rgba32f", uint: false, layered: false },
    5 writes "radiance_grey" StorageImage { format: "R32f", uint: false, layered: false },
    6 writes "layer_grey" StorageImage { format: "R32f", uint: false, layered: false },
    7 reads "dirty_texels" StorageBuffer,
    8 reads "edit_list" StorageBuffer,
    9 reads "light_colours" SampledImage { uint: false, layered: false },
    LightResolve {
        0 sum_has_colour: bool = false,
        1 albedo_is_map: bool = false,
        2 adds_to_radiance: bool = true,
        3 writes_layer: bool = false,
        4 grey: bool = false,
        5 relights: bool = false,
        6 colour_is_texel: bool = false,
    }
}

shader! {
    /// `shaders_glsl/bounce/line_blocks.comp`.
    LINE_BLOCKS: "line_blocks", push LineBlocksPush, words 128178 6699,
    0 reads "bounce_ground" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "grey_ground" StorageImage { format: "Rgba16ui", uint: true, layered: false },
    2 reads "azimuths" TexelBuffer,
    3 writes "line_blocks" StorageImage { format: "Rgba32ui", uint: true, layered: true },
    4 writes "grey_blocks" StorageImage { format: "Rgba16ui", uint: true, layered: true },
    LineBlocks {
        0 line_shift: i32 = 15,
        1 border: u32 = 0,
        2 marches_rows: bool = false,
        3 grey: bool = false,
    }
}

shader! {
    /// `shaders_glsl/view/map_draw.comp`.
    MAP_DRAW: "map_draw", push MapDrawPush, words 134877 3812,
    0 reads "radiance" SampledImage { uint: false, layered: false },
    1 reads "tone_steps" SampledImage { uint: false, layered: false },
    2 reads "voids" SampledImage { uint: false, layered: false },
    3 writes "picture" StorageImage { format: "R32ui", uint: true, layered: false },
    MapDraw {
        0 grey: bool = false,
        1 has_voids: bool = false,
    }
}

shader! {
    /// `shaders_glsl/specular/mirror_map.comp`.
    MIRROR_MAP: "mirror_map", push MirrorMapPush, words 138689 4425,
    0 reads "azimuths" TexelBuffer,
    1 reads "specular_tables" StorageImage { format: "Rgba32f", uint: false, layered: true },
    2 writes "mirror_map" StorageImage { format: "Rgba32f", uint: false, layered: false },
    MirrorMap;
}

shader! {
    /// `shaders_glsl/reference/path_trace.comp`.
    PATH_TRACE: "path_trace", push PathTracePush, words 143114 24280,
    0 reads "cells" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "maxima" StorageImage { format: "R32f", uint: false, layered: false },
    2 reads "ground" SampledImage { uint: false, layered: false },
    3 reads "lights" SampledImage { uint: false, layered: false },
    4 reads "environment" SampledImage { uint: false, layered: false },
    5 reads "environment_cdf" SampledImage { uint: false, layered: false },
    6 reads "albedo_map" SampledImage { uint: false, layered: false },
    7 writes "batch_mean" StorageImage { format: "Rgba32f", uint: false, layered: false },
    8 writes "batch_spread" StorageImage { format: "Rgba32f", uint: false, layered: false },
    9 writes "radiance" StorageImage { format: "Rgba32f", uint: false, layered: false },
    10 writes "standard_error" StorageImage { format: "Rgba32f", uint: false, layered: false },
    11 writes "lost_rays" StorageBuffer,
    12 writes "part_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    13 reads "phong_map" SampledImage { uint: false, layered: false },
    14 reads "places" SampledImage { uint: false, layered: false },
    PathTrace {
        0 border: u32 = 0,
        1 thin_rows: bool = false,
        2 set_bits: u32 = 4,
        3 albedo_is_map: bool = false,
        4 has_environment: bool = false,
        5 has_specular: bool = false,
        6 thin_cols: bool = false,
        7 has_lights: bool = false,
        8 has_sphere_lights: bool = false,
        9 has_bounces: bool = false,
        10 most_steps: i32 = 60000,
        11 has_keys: bool = false,
        12 in_parts: bool = false,
        13 specular_is_map: bool = false,
        14 at_places: bool = false,
        15 smooth_normals: bool = false,
    }
}

shader! {
    /// `shaders_glsl/view/picture_tone.frag`.
    PICTURE_TONE_FRAG: "picture_tone_frag", push PictureTonePush, words 167394 565,
    0 reads "radiance" SampledImage { uint: false, layered: false },
    PictureToneFrag {
        0 encodes: bool = true,
    }
}

shader! {
    /// `shaders_glsl/view/picture_tone.vert`.
    PICTURE_TONE_VERT: "picture_tone_vert", push (), words 167959 266,
    PictureToneVert;
}

shader! {
    /// `shaders_glsl/view/plinth_draw.frag`.
    PLINTH_DRAW_FRAG: "plinth_draw_frag", push PlinthDrawPush, words 168225 939,
    2 reads "voids" SampledImage { uint: false, layered: false },
    PlinthDrawFrag {
        1 has_voids: bool = false,
    }
}

shader! {
    /// `shaders_glsl/view/plinth_draw.vert`.
    PLINTH_DRAW_VERT: "plinth_draw_vert", push PlinthDrawPush, words 169164 2082,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 reads "radiance" SampledImage { uint: false, layered: false },
    2 reads "voids" SampledImage { uint: false, layered: false },
    PlinthDrawVert {
        0 is_grey: bool = false,
        1 has_voids: bool = false,
    }
}

shader! {
    /// `shaders_glsl/view/preview_gather.comp`.
    PREVIEW_GATHER: "preview_gather", push PreviewGatherPush, words 171246 1069,
    0 reads "normals" SampledImage { uint: false, layered: false },
    1 reads "coarse_radiance" SampledImage { uint: false, layered: false },
    2 reads "coarse_sun" SampledImage { uint: false, layered: false },
    3 reads "coarse_albedo" SampledImage { uint: false, layered: false },
    4 writes "gathered" StorageImage { format: "Rgba32f", uint: false, layered: false },
    PreviewGather {
        0 grey: bool = false,
        1 without_sun: bool = false,
        2 albedo_is_map: bool = false,
    }
}

shader! {
    /// `shaders_glsl/view/preview_shade.comp`.
    PREVIEW_SHADE: "preview_shade", push PreviewShadePush, words 172315 1740,
    0 reads "normals" SampledImage { uint: false, layered: false },
    1 reads "albedo" SampledImage { uint: false, layered: false },
    2 reads "sky" StorageImage { format: "Rgba32f", uint: false, layered: false },
    3 reads "sun" StorageImage { format: "Rgba32f", uint: false, layered: false },
    4 writes "radiance" StorageImage { format: "Rgba32f", uint: false, layered: false },
    PreviewShade {
        0 has_sun: bool = false,
        1 albedo_is_map: bool = false,
    }
}

shader! {
    /// `shaders_glsl/horizon/pyramid_march.comp`.
    PYRAMID_MARCH: "pyramid_march", push PyramidMarchPush, words 174055 9080,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 reads "azimuths" TexelBuffer,
    2 writes "slopes" StorageImage { format: "R32ui", uint: true, layered: true },
    3 reads "height_levels" SampledImage { uint: false, layered: false },
    4 reads "level_table" SampledImage { uint: true, layered: false },
    5 reads "height_stack" SampledImage { uint: false, layered: true },
    PyramidMarch {
        0 periodic: bool = false,
        1 stack: bool = false,
        2 levels: i32 = 0,
        3 node_stride: i32 = 1,
    }
}

shader! {
    /// `shaders_glsl/bake/scatter_gather.comp`.
    SCATTER_GATHER: "scatter_gather", push ScatterGatherPush, words 183135 4664,
    0 reads "ground" SampledImage { uint: false, layered: false },
    1 reads "direct" SampledImage { uint: false, layered: false },
    2 reads "visible_points" SampledImage { uint: true, layered: true },
    3 reads "links" TexelBuffer,
    4 reads "carried_in" SampledImage { uint: false, layered: true },
    5 reads "sun_points" SampledImage { uint: true, layered: true },
    6 reads "albedo_map" SampledImage { uint: false, layered: false },
    7 reads "phong_map" SampledImage { uint: false, layered: false },
    8 writes "carried" StorageImage { format: "Rgba32f", uint: false, layered: true },
    9 writes "scattered" StorageImage { format: "Rgba32f", uint: false, layered: true },
    10 reads "bent" SampledImage { uint: false, layered: true },
    11 reads "fan_weights" SampledImage { uint: false, layered: true },
    ScatterGather {
        0 source: u32 = 1,
        1 sums: bool = false,
        2 small: bool = false,
        3 albedo_is_map: bool = false,
        4 has_specular: bool = false,
        5 specular_is_map: bool = false,
        6 bent: bool = false,
        7 direct_specular: bool = false,
    }
}

shader! {
    /// `shaders_glsl/sh/sh_shade.comp`.
    SH_SHADE: "sh_shade", push ShShadePush, words 187799 13927,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "visibility" SampledImage { uint: false, layered: true },
    2 reads "light_matrix" SampledImage { uint: false, layered: false },
    3 writes "env_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    4 reads "nodes" StorageImage { format: "Rgba32f", uint: false, layered: false },
    5 reads "phong_map" SampledImage { uint: false, layered: false },
    ShShade {
        0 border: u32 = 0,
        1 marches_rows: bool = false,
        2 order: i32 = 4,
        3 receiver: u32 = 1,
        4 node_stride: i32 = 1,
        5 specular_is_map: bool = false,
    }
}

shader! {
    /// `shaders_glsl/sh/sh_visibility.comp`.
    SH_VISIBILITY: "sh_visibility", push ShadePush, words 201726 32300,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "lattice" StorageImage { format: "Rgba16ui", uint: true, layered: true },
    2 reads "azimuths" TexelBuffer,
    3 writes "visibility" StorageImage { format: "Rgba32f", uint: false, layered: true },
    4 writes "nodes" StorageImage { format: "Rgba32f", uint: false, layered: false },
    6 reads "dirty_texels" StorageBuffer,
    7 reads "lattice_words" SampledImage { uint: true, layered: true },
    8 reads "edit_list" StorageBuffer,
    ShVisibility {
        0 fuse: u32 = 5,
        1 lattice: u32 = 0,
        2 line_shift: i32 = 15,
        3 border: u32 = 0,
        4 order: i32 = 4,
        5 by_nlp: bool = false,
        6 marches_rows: bool = false,
        7 own_plane_hides: bool = true,
        8 lane_stride: i32 = 1,
        9 lattice_stride: i32 = 1,
        40 layer_shift: i32 = 5,
    }
}

shader! {
    /// `shaders_glsl/sh/sh_wedges.comp`.
    SH_WEDGES: "sh_wedges", push ShWedgesPush, words 234026 7826,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "horizon_angles" SampledImage { uint: false, layered: true },
    2 reads "constants" TexelBuffer,
    3 writes "visibility" StorageImage { format: "Rgba32f", uint: false, layered: true },
    4 writes "nodes" StorageImage { format: "Rgba32f", uint: false, layered: false },
    ShWedges {
        0 border: u32 = 0,
        1 marches_rows: bool = false,
        2 order: i32 = 4,
        3 own_plane_hides: bool = true,
        4 lane_stride: i32 = 1,
    }
}

shader! {
    /// `shaders_glsl/bounce/shade_expand.comp`.
    SHADE_EXPAND: "shade_expand", push ShadeExpandPush, words 241852 2489,
    0 reads "shade_levels" SampledImage { uint: false, layered: false },
    1 reads "shade_table" SampledImage { uint: true, layered: false },
    2 writes "shade_stack" StorageImage { format: "Rgba32f", uint: false, layered: true },
    3 writes "shade_stack_grey" StorageImage { format: "R32f", uint: false, layered: true },
    ShadeExpand {
        0 periodic: bool = false,
        1 grey: bool = false,
    }
}

shader! {
    /// `shaders_glsl/bounce/shade_reduce.comp`.
    SHADE_REDUCE: "shade_reduce", push ReducePush, words 244341 3656,
    0 reads "exit_radiance" SampledImage { uint: false, layered: false },
    1 writes "shade_levels" StorageImage { format: "Rgba32f", uint: false, layered: false },
    2 writes "shade_table" StorageImage { format: "Rgba32ui", uint: true, layered: false },
    3 reads "constants" TexelBuffer,
    ShadeReduce {
        0 periodic: bool = false,
        1 from_field: bool = false,
        2 grey: bool = false,
    }
}

shader! {
    /// `shaders_glsl/direct/shadow_height.comp`.
    SHADOW_HEIGHT: "shadow_height", push ShadowHeightPush, words 247997 7491,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 reads "outer_lit_above" SampledImage { uint: false, layered: false },
    2 reads "outer_penumbra" SampledImage { uint: false, layered: false },
    3 writes "lit_above" StorageImage { format: "R32f", uint: false, layered: false },
    4 writes "penumbra" StorageImage { format: "R32f", uint: false, layered: false },
    5 writes "sun_share" StorageImage { format: "R32f", uint: false, layered: false },
    ShadowHeight {
        0 has_outer: bool = false,
        1 local_size_y: u32 = 1,
        2 at_once: i32 = 4,
        3 line_words: i32 = 512,
        4 segment_words: i32 = 64,
    }
}

shader! {
    /// `shaders_glsl/direct/shadow_settle.comp`.
    SHADOW_SETTLE: "shadow_settle", push ShadowSettlePush, words 255488 18232,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "maxima" StorageImage { format: "R32f", uint: false, layered: false },
    2 reads "azimuths" TexelBuffer,
    3 reads "doubtful" StorageImage { format: "R32ui", uint: true, layered: false },
    4 writes "sun_sum" StorageImage { format: "R32f", uint: false, layered: false },
    5 reads "shadows" StorageImage { format: "Rgba32ui", uint: true, layered: true },
    ShadowSettle {
        0 border: u32 = 0,
        1 marches_rows: bool = false,
        2 shape: u32 = 0,
        3 most_steps: i32 = 60000,
        4 tile_fours: i32 = 8,
        5 branches: bool = false,
        40 layer_shift: i32 = 5,
    }
}

shader! {
    /// `shaders_glsl/direct/shadow_shade.comp`.
    SHADOW_SHADE: "shadow_shade", push ShadowShadePush, words 273720 11288,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "azimuths" TexelBuffer,
    2 reads "shadows" StorageImage { format: "Rgba32ui", uint: true, layered: true },
    3 writes "sun_sum" StorageImage { format: "R32f", uint: false, layered: false },
    4 writes "doubtful" StorageImage { format: "R32ui", uint: true, layered: false },
    ShadowShade {
        0 border: u32 = 0,
        1 marches_rows: bool = false,
        2 shape: u32 = 0,
        40 layer_shift: i32 = 5,
    }
}

shader! {
    /// `shaders_glsl/direct/shadow_sweep.comp`.
    SHADOW_SWEEP: "shadow_sweep", push ShadowSweepPush, words 285008 12905,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "azimuths" TexelBuffer,
    2 writes "shadows" StorageImage { format: "Rgba32ui", uint: true, layered: true },
    3 reads "lane_buffer" StorageBuffer,
    ShadowSweep {
        0 local_size_x: u32 = 1,
        1 periodic: bool = false,
        2 one_line: bool = false,
        3 written_words: i32 = 1,
        4 local_size_y: u32 = 1,
        5 segment_words: i32 = 1,
        40 layer_shift: i32 = 5,
    }
}

shader! {
    /// `shaders_glsl/view/sky_draw.frag`.
    SKY_DRAW_FRAG: "sky_draw_frag", push SkyDrawPush, words 297913 1372,
    0 reads "environment" SampledImage { uint: false, layered: false },
    SkyDrawFrag {
        0 has_environment: bool = false,
    }
}

shader! {
    /// `shaders_glsl/view/sky_draw.vert`.
    SKY_DRAW_VERT: "sky_draw_vert", push (), words 299285 289,
    SkyDrawVert;
}

shader! {
    /// `shaders_glsl/direct/sky_shade.comp`.
    SKY_SHADE: "sky_shade", push ShadePush, words 299574 30156,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "lattice" StorageImage { format: "Rgba16ui", uint: true, layered: true },
    2 reads "azimuths" TexelBuffer,
    3 writes "sky_sum" StorageImage { format: "R32f", uint: false, layered: false },
    4 writes "env_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    5 reads "env_tables" StorageImage { format: "Rgba32f", uint: false, layered: true },
    6 reads "dirty_texels" StorageBuffer,
    7 reads "lattice_words" SampledImage { uint: true, layered: true },
    8 reads "edit_list" StorageBuffer,
    9 reads "specular_tables" StorageImage { format: "Rgba32f", uint: false, layered: true },
    10 writes "blocked_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    11 reads "lane_buffer" StorageBuffer,
    12 reads "azimuth_buffer" StorageBuffer,
    SkyShade {
        0 fuse: u32 = 5,
        1 lattice: u32 = 0,
        2 line_shift: i32 = 15,
        3 border: u32 = 0,
        4 has_sky: bool = true,
        5 has_environment: bool = false,
        6 marches_rows: bool = false,
        7 has_specular: bool = false,
        8 specular_is_shared: bool = false,
        9 reads_lane_buffer: bool = false,
        40 layer_shift: i32 = 5,
    }
}

shader! {
    /// `shaders_glsl/specular/specular_exit.comp`.
    SPECULAR_EXIT: "specular_exit", push SpecularExitPush, words 329730 7531,
    0 reads "arriving" SampledImage { uint: false, layered: true },
    1 reads "ground" SampledImage { uint: false, layered: false },
    2 reads "exit_radiance" SampledImage { uint: false, layered: false },
    3 reads "specular_direct" SampledImage { uint: false, layered: false },
    4 reads "phong_map" SampledImage { uint: false, layered: false },
    5 reads "constants" TexelBuffer,
    6 writes "specular_bounced" StorageImage { format: "Rgba32f", uint: false, layered: false },
    7 writes "exit_vectors" StorageImage { format: "Rgba32f", uint: false, layered: true },
    8 writes "exit_upward" StorageImage { format: "Rgba32f", uint: false, layered: false },
    9 writes "exit_vectors_f16" StorageImage { format: "Rgba16f", uint: false, layered: true },
    10 writes "exit_upward_grey" StorageImage { format: "R32f", uint: false, layered: false },
    SpecularExit {
        0 order: i32 = 4,
        1 grey: bool = false,
        2 specular_is_map: bool = false,
        3 is_direct: bool = false,
        4 is_bounced: bool = true,
        5 vectors: bool = true,
        6 halves: bool = false,
    }
}

shader! {
    /// `shaders_glsl/bounce/specular_gather.comp`.
    SPECULAR_GATHER: "specular_gather", push GatherPush, words 337261 20442,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 reads "height_levels" SampledImage { uint: false, layered: false },
    2 reads "level_table" SampledImage { uint: true, layered: false },
    3 reads "height_stack" SampledImage { uint: false, layered: true },
    4 reads "ground" SampledImage { uint: false, layered: false },
    5 reads "exit_radiance" SampledImage { uint: false, layered: false },
    6 reads "shade_levels" SampledImage { uint: false, layered: false },
    7 reads "shade_table" SampledImage { uint: true, layered: false },
    8 writes "bounce_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    9 reads "shade_stack" SampledImage { uint: false, layered: true },
    10 reads "exit_vectors" SampledImage { uint: false, layered: true },
    11 reads "vector_levels" SampledImage { uint: false, layered: true },
    12 writes "arriving" StorageImage { format: "Rgba32f", uint: false, layered: true },
    SpecularGather {
        0 periodic: bool = false,
        1 stack: bool = false,
        2 levels: i32 = 0,
        3 shade_levels: i32 = 0,
        4 grey: bool = false,
        5 vectors: bool = true,
        6 order: i32 = 4,
        7 most_knots: i32 = 64,
    }
}

shader! {
    /// `shaders_glsl/specular/specular_light.comp`.
    SPECULAR_LIGHT: "specular_light", push SpecularLightPush, words 357703 7680,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "blocked_sum" SampledImage { uint: false, layered: false },
    2 reads "unoccluded_map" SampledImage { uint: false, layered: false },
    3 reads "swept_map" SampledImage { uint: false, layered: false },
    4 writes "specular_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    SpecularLight {
        0 border: u32 = 0,
        1 marches_rows: bool = false,
    }
}

shader! {
    /// `shaders_glsl/specular/specular_tables.comp`.
    SPECULAR_TABLES: "specular_tables", push SpecularTablesPush, words 365383 4943,
    0 reads "azimuths" TexelBuffer,
    1 reads "wedge_rows" StorageBuffer,
    2 writes "specular_tables" StorageImage { format: "Rgba32f", uint: false, layered: true },
    SpecularTables {
        0 has_environment: bool = false,
    }
}

shader! {
    /// `shaders_glsl/specular/specular_visibility.comp`.
    SPECULAR_VISIBILITY: "specular_visibility", push SpecularVisibilityPush, words 370326 1238,
    0 reads "visibility" SampledImage { uint: false, layered: true },
    1 reads "light_matrix" SampledImage { uint: false, layered: false },
    2 writes "arriving" StorageImage { format: "Rgba32f", uint: false, layered: true },
    SpecularVisibility {
        0 order: i32 = 4,
        1 grey: bool = false,
    }
}

shader! {
    /// `shaders_glsl/direct/sphere_sh_shade.comp`.
    SPHERE_SH_SHADE: "sphere_sh_shade", push SphereShShadePush, words 371564 27760,
    0 reads "cells" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "maxima" StorageImage { format: "R32f", uint: false, layered: false },
    2 reads "ground" SampledImage { uint: false, layered: false },
    3 writes "sphere_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    4 reads "constants" TexelBuffer,
    5 reads "heights" SampledImage { uint: false, layered: false },
    6 reads "height_levels" SampledImage { uint: false, layered: false },
    7 reads "level_table" SampledImage { uint: true, layered: false },
    8 reads "height_stack" SampledImage { uint: false, layered: true },
    SphereShShade {
        0 border: u32 = 0,
        1 thin_rows: bool = false,
        2 thin_cols: bool = false,
        3 most_steps: i32 = 60000,
        4 order: i32 = 4,
        5 wedges: u32 = 0,
        6 own_plane_hides: bool = true,
        7 by_pyramid: bool = false,
        8 stack: bool = false,
        9 levels: i32 = 0,
    }
}

shader! {
    /// `shaders_glsl/direct/sphere_shade.comp`.
    SPHERE_SHADE: "sphere_shade", push SphereShadePush, words 399324 19174,
    0 reads "cells" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "maxima" StorageImage { format: "R32f", uint: false, layered: false },
    2 reads "ground" SampledImage { uint: false, layered: false },
    3 writes "sphere_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    4 writes "specular_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    5 reads "phong_map" SampledImage { uint: false, layered: false },
    SphereShade {
        0 border: u32 = 0,
        1 thin_rows: bool = false,
        2 thin_cols: bool = false,
        3 most_steps: i32 = 60000,
        4 has_specular: bool = false,
        5 specular_is_map: bool = false,
    }
}

shader! {
    /// `shaders_glsl/direct/sun_shade.comp`.
    SUN_SHADE: "sun_shade", push ShadePush, words 418498 29168,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "lattice" StorageImage { format: "Rgba16ui", uint: true, layered: true },
    2 reads "azimuths" TexelBuffer,
    3 writes "sun_sum" StorageImage { format: "R32f", uint: false, layered: false },
    4 writes "specular_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    5 reads "phong_map" SampledImage { uint: false, layered: false },
    6 reads "dirty_texels" StorageBuffer,
    7 reads "lattice_words" SampledImage { uint: true, layered: true },
    8 reads "edit_list" StorageBuffer,
    SunShade {
        0 fuse: u32 = 5,
        1 lattice: u32 = 0,
        2 line_shift: i32 = 15,
        3 border: u32 = 0,
        4 shape: u32 = 0,
        5 marches_rows: bool = false,
        6 has_specular: bool = false,
        7 specular_is_map: bool = false,
        40 layer_shift: i32 = 5,
    }
}

shader! {
    /// `shaders_glsl/specular/sun_specular.comp`.
    SUN_SPECULAR: "sun_specular", push SunSpecularPush, words 447666 10753,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "sun_sum" SampledImage { uint: false, layered: false },
    2 writes "specular_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    3 reads "phong_map" SampledImage { uint: false, layered: false },
    4 writes "arriving" StorageImage { format: "Rgba32f", uint: false, layered: true },
    SunSpecular {
        0 border: u32 = 0,
        1 marches_rows: bool = false,
        2 specular_is_map: bool = false,
        3 order: i32 = 0,
        4 grey: bool = false,
    }
}

shader! {
    /// `shaders_glsl/horizon/surface_sweep.comp`.
    SURFACE_SWEEP: "surface_sweep", push MarchPush, words 458419 7745,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "azimuths" TexelBuffer,
    2 writes "slopes" StorageImage { format: "R32ui", uint: true, layered: true },
    3 writes "hull_buffer" StorageBuffer,
    SurfaceSweep {
        0 local_size_x: u32 = 1,
        1 private_entries: i32 = 1,
        2 periodic: bool = false,
        3 writes_distances: bool = false,
        4 hull_in_buffer: bool = false,
    }
}

shader! {
    /// `shaders_glsl/horizon/sweep_fuse.comp`.
    SWEEP_FUSE: "sweep_fuse", push SweepFusePush, words 466164 20375,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "lattice" StorageImage { format: "Rgba16ui", uint: true, layered: true },
    2 reads "azimuths" TexelBuffer,
    3 writes "horizon_angles" StorageImage { format: "R32f", uint: false, layered: true },
    4 writes "horizon_distances" StorageImage { format: "R32f", uint: false, layered: true },
    7 reads "lattice_words" SampledImage { uint: true, layered: true },
    SweepFuse {
        0 fuse: u32 = 5,
        1 lattice: u32 = 0,
        2 line_shift: i32 = 15,
        3 border: u32 = 0,
        4 writes_distances: bool = false,
        5 lattice_has_distances: bool = false,
        6 marches_rows: bool = false,
        40 layer_shift: i32 = 5,
    }
}

shader! {
    /// `shaders_glsl/view/terrain_draw.frag`.
    TERRAIN_DRAW_FRAG: "terrain_draw_frag", push TerrainDrawPush, words 486539 1129,
    1 reads "radiance" SampledImage { uint: false, layered: false },
    2 reads "voids" SampledImage { uint: false, layered: false },
    TerrainDrawFrag {
        0 is_grey: bool = false,
        1 has_voids: bool = false,
    }
}

shader! {
    /// `shaders_glsl/view/terrain_draw.vert`.
    TERRAIN_DRAW_VERT: "terrain_draw_vert", push TerrainDrawPush, words 487668 994,
    0 reads "heights" SampledImage { uint: false, layered: false },
    TerrainDrawVert;
}

shader! {
    /// `shaders_glsl/bounce/vector_reduce.comp`.
    VECTOR_REDUCE: "vector_reduce", push ReducePush, words 488662 3811,
    0 reads "exit_vectors" SampledImage { uint: false, layered: true },
    1 reads "vector_source" SampledImage { uint: false, layered: true },
    2 writes "vector_levels" StorageImage { format: "Rgba32f", uint: false, layered: true },
    3 writes "shade_table" StorageImage { format: "Rgba32ui", uint: true, layered: false },
    4 reads "constants" TexelBuffer,
    5 writes "vector_levels_f16" StorageImage { format: "Rgba16f", uint: false, layered: true },
    VectorReduce {
        0 periodic: bool = false,
        1 from_field: bool = false,
        2 halves: bool = false,
    }
}

shader! {
    /// `shaders_glsl/bake/visible_points.comp`.
    VISIBLE_POINTS: "visible_points", push VisiblePointsPush, words 492473 9745,
    0 reads "cells" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "maxima" StorageImage { format: "R32f", uint: false, layered: false },
    2 reads "ground" SampledImage { uint: false, layered: false },
    3 reads "directions" TexelBuffer,
    4 writes "visible_points" StorageImage { format: "R32ui", uint: true, layered: true },
    VisiblePoints {
        0 border: u32 = 0,
        1 thin_rows: bool = false,
        2 thin_cols: bool = false,
        3 most_steps: i32 = 60000,
        4 small: bool = false,
    }
}

/// Every compute shader, by name.
pub static ALL: &[Shader] = &[
    BENT_DIRECTIONS,
    BOUNCE_GATHER,
    BOUNCE_GROUND,
    BOUNCE_MARCH,
    BOUNCE_SHADE,
    BOUNCE_WALK,
    CACHE_GATHER,
    DEVICE_PEAK,
    DIRTY_LIST,
    DIRTY_MARK,
    ELLIPSE_FIT,
    ENV_ROTATION,
    ENV_TABLES,
    ENV_WEDGES,
    FACET_MASK,
    FAN_WEIGHTS,
    HEIGHT_BOUNDS,
    HEIGHT_CELLS,
    HEIGHT_EXPAND,
    HEIGHT_REDUCE,
    HEIGHT_TRANSPOSE,
    HORIZON_MARCH,
    HORIZON_RESWEEP,
    HORIZON_SWEEP,
    LIGHT_MATRIX,
    LIGHT_RESOLVE,
    LINE_BLOCKS,
    MAP_DRAW,
    MIRROR_MAP,
    PATH_TRACE,
    PREVIEW_GATHER,
    PREVIEW_SHADE,
    PYRAMID_MARCH,
    SCATTER_GATHER,
    SH_SHADE,
    SH_VISIBILITY,
    SH_WEDGES,
    SHADE_EXPAND,
    SHADE_REDUCE,
    SHADOW_HEIGHT,
    SHADOW_SETTLE,
    SHADOW_SHADE,
    SHADOW_SWEEP,
    SKY_SHADE,
    SPECULAR_EXIT,
    SPECULAR_GATHER,
    SPECULAR_LIGHT,
    SPECULAR_TABLES,
    SPECULAR_VISIBILITY,
    SPHERE_SH_SHADE,
    SPHERE_SHADE,
    SUN_SHADE,
    SUN_SPECULAR,
    SURFACE_SWEEP,
    SWEEP_FUSE,
    VECTOR_REDUCE,
    VISIBLE_POINTS,
];

/// Every vertex and fragment shader, by name.
pub static GRAPHICS: &[Shader] = &[
    DEPTH_RESOLVE_FRAG,
    PICTURE_TONE_FRAG,
    PICTURE_TONE_VERT,
    PLINTH_DRAW_FRAG,
    PLINTH_DRAW_VERT,
    SKY_DRAW_FRAG,
    SKY_DRAW_VERT,
    TERRAIN_DRAW_FRAG,
    TERRAIN_DRAW_VERT,
];

layouts! {
    push BentDirectionsPush 36 {
        0 cols: i32, 4 rows: i32, 8 first_texel: i32, 12 first_fan: i32, 16 first_direction: i32,
        20 cell_x_m: f32, 24 cell_y_m: f32, 28 curvature_x: f32, 32 curvature_y: f32,
    }
    push BounceGroundPush 8 {
        0 cols: i32, 4 rows: i32,
    }
    push BounceMarchPush 48 {
        0 land: LandPush, 32 azimuths: i32, 36 first_azimuth: i32, 40 last_azimuth: i32,
        44 first_row: i32,
    }
    push BounceShadePush 16 {
        0 cols: i32, 4 rows: i32, 8 cell_x_m: f32, 12 cell_y_m: f32,
    }
    push BounceWalkPush 44 {
        0 cols: i32, 4 rows: i32, 8 cell_x_m: f32, 12 cell_y_m: f32, 16 warm_up: i32,
        20 first_azimuth: u32, 24 azimuth_count: u32, 28 clears: u32, 32 is_last: u32,
        36 begin: u32, 40 block_layers: u32,
    }
    push CacheGatherPush 16 {
        0 cols: i32, 4 rows: i32, 8 begin: u32, 12 count: u32,
    }
    push DevicePeakPush 20 {
        0 invocations: i32, 4 rounds: i32, 8 side: i32, 12 factor: f32, 16 summand: f32,
    }
    push DirtyListPush 8 {
        0 cols: i32, 4 rows: i32,
    }
    push DirtyMarkPush 24 {
        0 cols: i32, 4 rows: i32, 8 first_col: i32, 12 first_row: i32, 16 last_col: i32,
        20 last_row: i32,
    }
    push EllipseFitPush 24 {
        0 cols: i32, 4 rows: i32, 8 first_direction: i32, 12 end_direction: i32, 16 first_row: i32,
        20 least_radius: f32,
    }
    push EnvRotationPush 16 {
        0 width: i32, 4 rows: i32, 8 turns: i32, 12 column_first: i32,
    }
    push EnvTablesPush 20 {
        0 height: i32, 4 rows: i32, 8 nodes: i32, 12 azimuth_count: i32, 16 bottom_sine: f32,
    }
    push EnvWedgesPush 12 {
        0 width: i32, 4 rows: i32, 8 rotation_rad: f32,
    }
    push FacetMaskPush 48 {
        0 land: LandPush, 32 highest_m: f32, 36 first_layer: i32, 40 first_direction: i32,
        44 end_direction: i32,
    }
    push FanWeightsPush 16 {
        0 cols: i32, 4 rows: i32, 8 first_fan: i32, 12 first_direction: i32,
    }
    push GatherPush 68 {
        0 cols: i32, 4 rows: i32, 8 cell_x_m: f32, 12 cell_y_m: f32, 16 azimuths: i32,
        20 first_azimuth: i32, 24 last_azimuth: i32, 28 warm_up_cols: i32, 32 warm_up_rows: i32,
        36 fine_samples: i32, 40 width_shift: i32, 44 growth: f32, 48 shade_fine: i32,
        52 shade_shift: i32, 56 step_shade: i32, 60 step_height: i32, 64 first_row: i32,
    }
    push HeightBoundsPush 24 {
        0 cells_x: i32, 4 cells_y: i32, 8 padded_rows: i32, 12 level: i32, 16 tilt: [f32; 2],
    }
    push HeightCellsPush 16 {
        0 cols: i32, 4 rows: i32, 8 cell_x_m: f32, 12 cell_y_m: f32,
    }
    push HeightExpandPush 12 {
        0 cols: i32, 4 rows: i32, 8 width_shift: i32,
    }
    push HeightTransposePush 24 {
        0 lanes: i32, 4 steps: i32, 8 first_col: i32, 12 first_row: i32, 16 last_col: i32,
        20 last_row: i32,
    }
    push HorizonResweepPush 32 {
        0 lanes: i32, 4 steps: i32, 8 first_azimuth: u32, 12 height_scale: f32, 16 first_col: i32,
        20 first_row: i32, 24 last_col: i32, 28 last_row: i32,
    }
    push HorizonSweepPush 20 {
        0 lanes: i32, 4 steps: i32, 8 warm_up: i32, 12 first_azimuth: u32, 16 height_scale: f32,
    }
    push LandPush 32 {
        0 cols: i32, 4 rows: i32, 8 cells_x: i32, 12 cells_y: i32, 16 padded_rows: i32,
        20 top_level: i32, 24 cell_x_m: f32, 28 cell_y_m: f32,
    }
    push LightMatrixPush 48 {
        0 rows: i32, 4 light_order: i32, 8 order: i32, 12 receivers: i32, 16 row_first: i32,
        20 matrix_first: i32, 24 pads: [i32; 2], 32 sky: [f32; 4],
    }
    push LightResolvePush 32 {
        0 cols: i32, 4 rows: i32, 8 clears: u32, 12 texel: i32, 16 colour: [f32; 4],
    }
    push LineBlocksPush 20 {
        0 cols: i32, 4 rows: i32, 8 warm_up: i32, 12 first_azimuth: u32, 16 block_layers: i32,
    }
    push MapDrawPush 44 {
        0 width: i32, 4 height: i32, 8 cols: i32, 12 rows: i32, 16 first_col: f32,
        20 first_row: f32, 24 grid_points_per_pixel: f32, 28 swaps: u32, 32 beyond: u32,
        36 places: i32, 40 is_smooth: u32,
    }
    push MarchPush 20 {
        0 lanes: i32, 4 steps: i32, 8 warm_up: i32, 12 first_azimuth: u32, 16 first: i32,
    }
    push MirrorMapPush 44 {
        0 columns: i32, 4 height: i32, 8 azimuth_count: i32, 12 node: i32, 16 first_rad: f32,
        20 per_rad: f32, 24 exponent: f32, 28 least: f32, 32 farthest: f32, 36 first_turn: f32,
        40 lowest_up: f32,
    }
    push PathTracePush 128 {
        0 land: LandPush, 32 highest_m: f32, 36 rotation_turns: f32, 40 bounces: i32, 44 suns: i32,
        48 light_count: i32, 52 seed: u32, 56 first_row: i32, 60 keys: i32,
        64 albedo_exponent: [f32; 4], 80 sky_scale: [f32; 4], 96 eye_m: [f32; 4],
        112 first_path: i32, 116 last_path: i32, 120 first_light: i32, 124 last_light: i32,
    }
    push PictureTonePush 4 {
        0 exposure: f32,
    }
    push PlinthDrawPush 112 {
        0 clip_per_col: [f32; 4], 16 clip_per_row: [f32; 4], 32 clip_per_metre: [f32; 4],
        48 clip_at_origin: [f32; 4], 64 origin_col: i32, 68 origin_row: i32, 72 origin_m: f32,
        76 cols: i32, 80 rows: i32, 84 mesh_step: i32, 88 base_m: f32, 92 base_tone: f32,
        96 wall_tones: [f32; 4],
    }
    push PreviewGatherPush 56 {
        0 by_normal: [f32; 4], 16 most: [f32; 4], 32 colour: [f32; 4], 48 cols: i32, 52 rows: i32,
    }
    push PreviewShadePush 96 {
        0 sky_by_normal: [f32; 4], 16 sun_by_normal: [f32; 4], 32 most: [f32; 4],
        48 colour: [f32; 4], 64 cols: i32, 68 rows: i32, 72 sky_cols: i32, 76 sky_rows: i32,
        80 sun_cols: i32, 84 sun_rows: i32, 88 sky_ratio: f32, 92 sun_ratio: f32,
    }
    push PyramidMarchPush 36 {
        0 lanes: i32, 4 steps: i32, 8 warm_up: i32, 12 first_azimuth: u32, 16 azimuth_count: u32,
        20 first_row: i32, 24 fine_samples: i32, 28 width_shift: i32, 32 growth: f32,
    }
    push ReducePush 84 {
        0 level: i32, 4 levels: i32, 8 levels_at: i32, 12 width_shift: i32, 16 groups: i32,
        20 first_group: [i32; 16],
    }
    push ScatterGatherPush 80 {
        0 cols: i32, 4 rows: i32, 8 first_link: i32, 12 steps: i32, 16 step: i32,
        20 first_path: i32, 24 paths: i32, 28 first_direction: i32, 32 first_sun: i32, 36 suns: i32,
        40 weight_sr: f32, 44 exponent: f32, 48 specular_scale: f32, 52 first_view: i32,
        56 curvature_x: f32, 60 curvature_y: f32, 64 albedo: [f32; 4],
    }
    push ShShadePush 40 {
        0 cols: i32, 4 rows: i32, 8 cell_x_m: f32, 12 cell_y_m: f32, 16 eye_m: [f32; 4],
        32 specular: [f32; 2],
    }
    push ShWedgesPush 36 {
        0 cols: i32, 4 rows: i32, 8 cell_x_m: f32, 12 cell_y_m: f32, 16 azimuth_count: i32,
        20 azimuth_first: i32, 24 table_first: i32, 28 side: i32, 32 lowest_rad: f32,
    }
    push ShadeExpandPush 12 {
        0 cols: i32, 4 rows: i32, 8 width_shift: i32,
    }
    push ShadePush 76 {
        0 cols: i32, 4 rows: i32, 8 cell_x_m: f32, 12 cell_y_m: f32, 16 warm_up: i32,
        20 first_azimuth: u32, 24 azimuth_count: u32, 28 clears: u32, 32 eye_m: [f32; 4],
        48 colour: [f32; 4], 64 exponent: f32, 68 least_cosine: f32, 72 relights: u32,
    }
    push ShadowHeightPush 64 {
        0 size: [i32; 2], 8 outer_size: [i32; 2], 16 outer_origin: [f32; 2],
        24 outer_step: [f32; 2], 32 edges: [f32; 2], 40 diameter_rad: f32, 44 step_m: f32,
        48 outer_base: f32, 52 shear: i32, 56 flags: u32, 60 first_group: i32,
    }
    push ShadowSettlePush 56 {
        0 land: LandPush, 32 first_azimuth: u32, 36 azimuth_count: u32, 40 clears: u32,
        44 warm_up: i32, 48 tilt: [f32; 2],
    }
    push ShadowShadePush 32 {
        0 cols: i32, 4 rows: i32, 8 cell_x_m: f32, 12 cell_y_m: f32, 16 warm_up: i32,
        20 first_azimuth: u32, 24 azimuth_count: u32, 28 clears: u32,
    }
    push ShadowSweepPush 16 {
        0 lanes: i32, 4 steps: i32, 8 warm_up: i32, 12 first_azimuth: u32,
    }
    push SkyDrawPush 84 {
        0 forward: [f32; 4], 16 right: [f32; 4], 32 down: [f32; 4], 48 above: [f32; 4],
        64 below: [f32; 4], 80 rotation_turns: f32,
    }
    push SpecularExitPush 52 {
        0 cols: i32, 4 rows: i32, 8 cell_x_m: f32, 12 cell_y_m: f32, 16 eye_m: [f32; 4],
        32 begins: u32, 36 first_texel: i32, 40 fours: i32, 44 exponent: f32, 48 scale: f32,
    }
    push SpecularLightPush 44 {
        0 cols: i32, 4 rows: i32, 8 cell_x_m: f32, 12 cell_y_m: f32, 16 eye_m: [f32; 4],
        32 scale: f32, 36 unoccluded_columns: i32, 40 swept_columns: i32,
    }
    push SpecularTablesPush 60 {
        0 sky: [f32; 4], 16 height: i32, 20 rows: i32, 24 peaks: i32, 28 nodes: i32, 32 layers: i32,
        36 bottom_rad: f32, 40 first_rad: f32, 44 step_rad: f32, 48 exponent: f32,
        52 wedge_rad: f32, 56 reach_rad: f32,
    }
    push SpecularVisibilityPush 8 {
        0 cols: i32, 4 rows: i32,
    }
    push SphereShShadePush 128 {
        0 land: LandPush, 32 first: [i32; 2], 40 base: [i32; 2], 48 offset: [f32; 2], 56 up_m: f32,
        60 radius_m: f32, 64 reach_m: f32, 68 azimuths: i32, 72 first_azimuth: i32,
        76 last_azimuth: i32, 80 entry_first: i32, 84 entry_count: i32, 88 table_first: i32,
        92 side: i32, 96 fine_samples: i32, 100 width_shift: i32, 104 growth: f32,
        108 level_step: f32, 112 radiance: [f32; 4],
    }
    push SphereShadePush 128 {
        0 land: LandPush, 32 first: [i32; 2], 40 base: [i32; 2], 48 offset: [f32; 2], 56 up_m: f32,
        60 radius_m: f32, 64 reach_m: f32, 68 slices: i32, 72 slices_around: i32,
        76 first_slice: i32, 80 last_slice: i32, 84 exponent: f32, 88 scale: f32,
        92 specular_begins: f32, 96 radiance: [f32; 4], 112 eye_m: [f32; 4],
    }
    push SunSpecularPush 88 {
        0 cols: i32, 4 rows: i32, 8 cell_x_m: f32, 12 cell_y_m: f32, 16 towards: [f32; 4],
        32 level: [f32; 4], 48 colour: [f32; 4], 64 eye_m: [f32; 4], 80 specular: [f32; 2],
    }
    push SweepFusePush 16 {
        0 cols: i32, 4 rows: i32, 8 warm_up: i32, 12 first_azimuth: u32,
    }
    push TerrainDrawPush 92 {
        0 clip_per_col: [f32; 4], 16 clip_per_row: [f32; 4], 32 clip_per_metre: [f32; 4],
        48 clip_at_origin: [f32; 4], 64 origin_col: i32, 68 origin_row: i32, 72 origin_m: f32,
        76 cols: i32, 80 rows: i32, 84 mesh_step: i32, 88 tiles_across: i32,
    }
    push VisiblePointsPush 48 {
        0 land: LandPush, 32 highest_m: f32, 36 first_layer: i32, 40 first_direction: i32,
        44 end_direction: i32,
    }
    other AzimuthBuffer {
        0 azimuth_buffer,
    }
    other DirtyTexels {
        0 dirty_texels,
    }
    other EditList {
        32 dirty_words, 8 light_groups, 20 resolve_groups, 0 swept_steps, 4 word_count,
    }
    other EnvRotation {
        0 env_rotation,
    }
    other HullBuffer {
        0 hull_buffer,
    }
    other LaneBuffer {
        0 lane_buffer,
    }
    other LostLines {
        0 lost_lines,
    }
    other LostRays {
        0 lost_rays,
    }
    other Result {
        0 result,
    }
    other Source {
        0 source,
    }
    other WedgeRows {
        0 wedge_rows,
    }
}

/// Words of all shaders together.
const WORD_COUNT: usize = 502218;

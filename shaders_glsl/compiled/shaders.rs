// Written by build.rs from the SPIR-V of shaders_glsl/; committed by tools/shaders. Not edited by hand.

shader! {
    /// `shaders_glsl/bake/bent_directions.comp`.
    BENT_DIRECTIONS: "bent_directions", push 36, words 0 8160,
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
    BOUNCE_GATHER: "bounce_gather", push 64, words 8160 11636,
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
    /// `shaders_glsl/bounce/bounce_march.comp`.
    BOUNCE_MARCH: "bounce_march", push 44, words 19796 12304,
    0 reads "cells" SampledImage { uint: false, layered: false },
    1 reads "maxima" SampledImage { uint: false, layered: false },
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
    BOUNCE_SHADE: "bounce_shade", push 16, words 32100 2678,
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
    BOUNCE_WALK: "bounce_walk", push 40, words 34778 13812,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "azimuths" TexelBuffer,
    2 reads "occluders" StorageImage { format: "Rg32ui", uint: true, layered: true },
    3 reads "exit_radiance" StorageImage { format: "Rgba32f", uint: false, layered: false },
    4 reads "exit_grey" StorageImage { format: "R32f", uint: false, layered: false },
    5 writes "bounce_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    6 writes "visibility_cache" StorageImage { format: "Rgba32ui", uint: true, layered: true },
    BounceWalk {
        0 line_shift: i32 = 15,
        1 border: u32 = 0,
        2 marches_rows: bool = false,
        3 grey: bool = false,
        4 node_stride: i32 = 1,
        5 from: u32 = 0,
    }
}

shader! {
    /// `shaders_glsl/bounce/cache_gather.comp`.
    CACHE_GATHER: "cache_gather", push 16, words 48590 3639,
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
    /// `shaders_glsl/edit/dirty_list.comp`.
    DIRTY_LIST: "dirty_list", push 8, words 52229 874,
    0 reads "dirty_texels" StorageBuffer,
    1 writes "edit_list" StorageBuffer,
    DirtyList;
}

shader! {
    /// `shaders_glsl/edit/dirty_mark.comp`.
    DIRTY_MARK: "dirty_mark", push 24, words 53103 1323,
    0 writes "dirty_texels" StorageBuffer,
    1 writes "edit_list" StorageBuffer,
    DirtyMark;
}

shader! {
    /// `shaders_glsl/bake/ellipse_fit.comp`.
    ELLIPSE_FIT: "ellipse_fit", push 24, words 54426 5049,
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
    ENV_ROTATION: "env_rotation", push 16, words 59475 949,
    0 reads "environment" SampledImage { uint: false, layered: false },
    1 reads "constants" TexelBuffer,
    2 writes "env_rotation" StorageBuffer,
    EnvRotation;
}

shader! {
    /// `shaders_glsl/direct/env_tables.comp`.
    ENV_TABLES: "env_tables", push 20, words 60424 1463,
    0 reads "wedge_rows" StorageBuffer,
    1 writes "env_tables" StorageImage { format: "Rgba32f", uint: false, layered: true },
    EnvTables;
}

shader! {
    /// `shaders_glsl/sh/env_wedges.comp`.
    ENV_WEDGES: "env_wedges", push 12, words 61887 2151,
    0 reads "environment" SampledImage { uint: false, layered: false },
    1 reads "azimuths" TexelBuffer,
    2 writes "wedge_rows" StorageBuffer,
    EnvWedges;
}

shader! {
    /// `shaders_glsl/bake/facet_mask.comp`.
    FACET_MASK: "facet_mask", push 48, words 64038 9115,
    0 reads "cells" SampledImage { uint: false, layered: false },
    1 reads "maxima" SampledImage { uint: false, layered: false },
    2 reads "directions" TexelBuffer,
    3 writes "facet_mask" StorageImage { format: "R32ui", uint: true, layered: true },
    FacetMask {
        0 border: u32 = 0,
        1 most_steps: i32 = 60000,
    }
}

shader! {
    /// `shaders_glsl/bake/fan_weights.comp`.
    FAN_WEIGHTS: "fan_weights", push 16, words 73153 1842,
    0 reads "bent" SampledImage { uint: false, layered: true },
    1 reads "fans" TexelBuffer,
    2 writes "fan_weights" StorageImage { format: "R32f", uint: false, layered: true },
    FanWeights;
}

shader! {
    /// `shaders_glsl/rays/height_bounds.comp`.
    HEIGHT_BOUNDS: "height_bounds", push 16, words 74995 1109,
    0 reads "cells" SampledImage { uint: false, layered: false },
    1 writes "maxima" StorageImage { format: "R32f", uint: false, layered: false },
    HeightBounds;
}

shader! {
    /// `shaders_glsl/rays/height_cells.comp`.
    HEIGHT_CELLS: "height_cells", push 16, words 76104 2514,
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
    HEIGHT_EXPAND: "height_expand", push 12, words 78618 2496,
    0 reads "height_levels" SampledImage { uint: false, layered: false },
    1 reads "level_table" SampledImage { uint: true, layered: false },
    2 writes "height_stack" StorageImage { format: "R32f", uint: false, layered: true },
    HeightExpand {
        0 periodic: bool = false,
    }
}

shader! {
    /// `shaders_glsl/horizon/height_reduce.comp`.
    HEIGHT_REDUCE: "height_reduce", push 48, words 81114 2860,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 writes "height_levels" StorageImage { format: "R32f", uint: false, layered: false },
    2 writes "level_table" StorageImage { format: "Rgba32ui", uint: true, layered: false },
    HeightReduce {
        0 periodic: bool = false,
        1 from_field: bool = false,
    }
}

shader! {
    /// `shaders_glsl/horizon/height_transpose.comp`.
    HEIGHT_TRANSPOSE: "height_transpose", push 24, words 83974 978,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 writes "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    HeightTranspose {
        0 marches_rows: bool = false,
        1 periodic: bool = false,
    }
}

shader! {
    /// `shaders_glsl/horizon/horizon_march.comp`.
    HORIZON_MARCH: "horizon_march", push 16, words 84952 5456,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 reads "azimuths" TexelBuffer,
    2 writes "slopes" StorageImage { format: "Unknown", uint: true, layered: true },
    HorizonMarch {
        0 all_crossings: bool = true,
        1 periodic: bool = false,
        2 writes_distances: bool = false,
        3 node_stride: i32 = 1,
    }
}

shader! {
    /// `shaders_glsl/edit/horizon_resweep.comp`.
    HORIZON_RESWEEP: "horizon_resweep", push 32, words 90408 8882,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 reads "azimuths" TexelBuffer,
    2 writes "occluders" StorageImage { format: "Rg32ui", uint: true, layered: true },
    3 writes "dirty_texels" StorageBuffer,
    4 writes "edit_list" StorageBuffer,
    HorizonResweep {
        0 line_shift: i32 = 15,
        1 hull_packed: bool = false,
    }
}

shader! {
    /// `shaders_glsl/horizon/horizon_sweep.comp`.
    HORIZON_SWEEP: "horizon_sweep", push 20, words 99290 9430,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 reads "lane_heights" SampledImage { uint: false, layered: false },
    2 reads "azimuths" TexelBuffer,
    3 writes "occluders" StorageImage { format: "Rg32ui", uint: true, layered: true },
    4 writes "slopes" StorageImage { format: "Unknown", uint: true, layered: true },
    5 writes "lost_lines" StorageBuffer,
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
    }
}

shader! {
    /// `shaders_glsl/sh/light_matrix.comp`.
    LIGHT_MATRIX: "light_matrix", push 48, words 108720 1843,
    0 reads "env_rotation" StorageBuffer,
    1 reads "constants" TexelBuffer,
    2 writes "light_matrix" StorageImage { format: "Rgba32f", uint: false, layered: false },
    LightMatrix;
}

shader! {
    /// `shaders_glsl/direct/light_resolve.comp`.
    LIGHT_RESOLVE: "light_resolve", push 32, words 110563 1991,
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
    /// `shaders_glsl/view/map_draw.comp`.
    MAP_DRAW: "map_draw", push 36, words 112554 1576,
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
    /// `shaders_glsl/reference/path_trace.comp`.
    PATH_TRACE: "path_trace", push 120, words 114130 22914,
    0 reads "cells" SampledImage { uint: false, layered: false },
    1 reads "maxima" SampledImage { uint: false, layered: false },
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
    }
}

shader! {
    /// `shaders_glsl/view/picture_tone.frag`.
    PICTURE_TONE_FRAG: "picture_tone_frag", push 4, words 137044 455,
    0 reads "radiance" SampledImage { uint: false, layered: false },
    PictureToneFrag {
        0 encodes: bool = true,
    }
}

shader! {
    /// `shaders_glsl/view/picture_tone.vert`.
    PICTURE_TONE_VERT: "picture_tone_vert", push 0, words 137499 266,
    PictureToneVert;
}

shader! {
    /// `shaders_glsl/horizon/pyramid_march.comp`.
    PYRAMID_MARCH: "pyramid_march", push 32, words 137765 9025,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 reads "azimuths" TexelBuffer,
    2 writes "slopes" StorageImage { format: "Unknown", uint: true, layered: true },
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
    SCATTER_GATHER: "scatter_gather", push 80, words 146790 4664,
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
    SH_SHADE: "sh_shade", push 24, words 151454 12958,
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
    SH_VISIBILITY: "sh_visibility", push 32, words 164412 29808,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "lattice" StorageImage { format: "Rg32ui", uint: true, layered: true },
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
    }
}

shader! {
    /// `shaders_glsl/sh/sh_wedges.comp`.
    SH_WEDGES: "sh_wedges", push 36, words 194220 7777,
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
    SHADE_EXPAND: "shade_expand", push 12, words 201997 2397,
    0 reads "shade_levels" SampledImage { uint: false, layered: false },
    1 reads "shade_table" SampledImage { uint: true, layered: false },
    2 writes "shade_stack" StorageImage { format: "Unknown", uint: false, layered: true },
    ShadeExpand {
        0 periodic: bool = false,
    }
}

shader! {
    /// `shaders_glsl/bounce/shade_reduce.comp`.
    SHADE_REDUCE: "shade_reduce", push 48, words 204394 2919,
    0 reads "exit_radiance" SampledImage { uint: false, layered: false },
    1 writes "shade_levels" StorageImage { format: "Rgba32f", uint: false, layered: false },
    2 writes "shade_table" StorageImage { format: "Rgba32ui", uint: true, layered: false },
    ShadeReduce {
        0 periodic: bool = false,
        1 from_field: bool = false,
        2 grey: bool = false,
    }
}

shader! {
    /// `shaders_glsl/view/sky_draw.frag`.
    SKY_DRAW_FRAG: "sky_draw_frag", push 84, words 207313 1269,
    0 reads "environment" SampledImage { uint: false, layered: false },
    SkyDrawFrag {
        0 has_environment: bool = false,
    }
}

shader! {
    /// `shaders_glsl/view/sky_draw.vert`.
    SKY_DRAW_VERT: "sky_draw_vert", push 0, words 208582 289,
    SkyDrawVert;
}

shader! {
    /// `shaders_glsl/direct/sky_shade.comp`.
    SKY_SHADE: "sky_shade", push 32, words 208871 22806,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "lattice" StorageImage { format: "Rg32ui", uint: true, layered: true },
    2 reads "azimuths" TexelBuffer,
    3 writes "sky_sum" StorageImage { format: "R32f", uint: false, layered: false },
    4 writes "env_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    5 reads "env_tables" StorageImage { format: "Rgba32f", uint: false, layered: true },
    6 reads "dirty_texels" StorageBuffer,
    7 reads "lattice_words" SampledImage { uint: true, layered: true },
    8 reads "edit_list" StorageBuffer,
    SkyShade {
        0 fuse: u32 = 5,
        1 lattice: u32 = 0,
        2 line_shift: i32 = 15,
        3 border: u32 = 0,
        4 has_sky: bool = true,
        5 has_environment: bool = false,
        6 marches_rows: bool = false,
        7 relights: bool = false,
    }
}

shader! {
    /// `shaders_glsl/specular/specular_exit.comp`.
    SPECULAR_EXIT: "specular_exit", push 28, words 231677 6438,
    0 reads "arriving" SampledImage { uint: false, layered: true },
    1 reads "ground" SampledImage { uint: false, layered: false },
    2 reads "exit_radiance" SampledImage { uint: false, layered: false },
    3 reads "specular_direct" SampledImage { uint: false, layered: false },
    4 reads "phong_map" SampledImage { uint: false, layered: false },
    5 reads "constants" TexelBuffer,
    6 writes "specular_bounced" StorageImage { format: "Rgba32f", uint: false, layered: false },
    7 writes "exit_vectors" StorageImage { format: "Unknown", uint: false, layered: true },
    8 writes "exit_upward" StorageImage { format: "Unknown", uint: false, layered: false },
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
    SPECULAR_GATHER: "specular_gather", push 64, words 238115 20114,
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
    /// `shaders_glsl/specular/specular_visibility.comp`.
    SPECULAR_VISIBILITY: "specular_visibility", push 8, words 258229 1238,
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
    SPHERE_SH_SHADE: "sphere_sh_shade", push 128, words 259467 27590,
    0 reads "cells" SampledImage { uint: false, layered: false },
    1 reads "maxima" SampledImage { uint: false, layered: false },
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
    SPHERE_SHADE: "sphere_shade", push 112, words 287057 14302,
    0 reads "cells" SampledImage { uint: false, layered: false },
    1 reads "maxima" SampledImage { uint: false, layered: false },
    2 reads "ground" SampledImage { uint: false, layered: false },
    3 writes "sphere_sum" StorageImage { format: "Rgba32f", uint: false, layered: false },
    SphereShade {
        0 border: u32 = 0,
        1 thin_rows: bool = false,
        2 thin_cols: bool = false,
        3 most_steps: i32 = 60000,
    }
}

shader! {
    /// `shaders_glsl/direct/sun_shade.comp`.
    SUN_SHADE: "sun_shade", push 32, words 301359 22088,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "lattice" StorageImage { format: "Rg32ui", uint: true, layered: true },
    2 reads "azimuths" TexelBuffer,
    3 writes "sun_sum" StorageImage { format: "R32f", uint: false, layered: false },
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
        6 relights: bool = false,
    }
}

shader! {
    /// `shaders_glsl/specular/sun_specular.comp`.
    SUN_SPECULAR: "sun_specular", push 56, words 323447 7945,
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
    SURFACE_SWEEP: "surface_sweep", push 16, words 331392 6812,
    0 reads "heights" SampledImage { uint: false, layered: false },
    1 reads "azimuths" TexelBuffer,
    2 writes "slopes" StorageImage { format: "Unknown", uint: true, layered: true },
    SurfaceSweep {
        0 local_size_x: u32 = 1,
        1 hull_depth: i32 = 1,
        2 periodic: bool = false,
        3 writes_distances: bool = false,
    }
}

shader! {
    /// `shaders_glsl/horizon/sweep_fuse.comp`.
    SWEEP_FUSE: "sweep_fuse", push 20, words 338204 18089,
    0 reads "lane_heights" StorageImage { format: "Rgba32f", uint: false, layered: false },
    1 reads "lattice" StorageImage { format: "Rg32ui", uint: true, layered: true },
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
    }
}

shader! {
    /// `shaders_glsl/view/terrain_draw.frag`.
    TERRAIN_DRAW_FRAG: "terrain_draw_frag", push 92, words 356293 1129,
    1 reads "radiance" SampledImage { uint: false, layered: false },
    2 reads "voids" SampledImage { uint: false, layered: false },
    TerrainDrawFrag {
        0 is_grey: bool = false,
        1 has_voids: bool = false,
    }
}

shader! {
    /// `shaders_glsl/view/terrain_draw.vert`.
    TERRAIN_DRAW_VERT: "terrain_draw_vert", push 92, words 357422 916,
    0 reads "heights" SampledImage { uint: false, layered: false },
    TerrainDrawVert;
}

shader! {
    /// `shaders_glsl/bounce/vector_reduce.comp`.
    VECTOR_REDUCE: "vector_reduce", push 48, words 358338 2966,
    0 reads "exit_vectors" SampledImage { uint: false, layered: true },
    1 reads "vector_source" SampledImage { uint: false, layered: true },
    2 writes "vector_levels" StorageImage { format: "Unknown", uint: false, layered: true },
    3 writes "shade_table" StorageImage { format: "Rgba32ui", uint: true, layered: false },
    VectorReduce {
        0 periodic: bool = false,
        1 from_field: bool = false,
    }
}

shader! {
    /// `shaders_glsl/bake/visible_points.comp`.
    VISIBLE_POINTS: "visible_points", push 48, words 361304 9659,
    0 reads "cells" SampledImage { uint: false, layered: false },
    1 reads "maxima" SampledImage { uint: false, layered: false },
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
    BOUNCE_MARCH,
    BOUNCE_SHADE,
    BOUNCE_WALK,
    CACHE_GATHER,
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
    MAP_DRAW,
    PATH_TRACE,
    PYRAMID_MARCH,
    SCATTER_GATHER,
    SH_SHADE,
    SH_VISIBILITY,
    SH_WEDGES,
    SHADE_EXPAND,
    SHADE_REDUCE,
    SKY_SHADE,
    SPECULAR_EXIT,
    SPECULAR_GATHER,
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
    PICTURE_TONE_FRAG,
    PICTURE_TONE_VERT,
    SKY_DRAW_FRAG,
    SKY_DRAW_VERT,
    TERRAIN_DRAW_FRAG,
    TERRAIN_DRAW_VERT,
];

/// Byte offsets of struct members as the shaders see them.
#[allow(missing_docs, reason = "each is the offset of the member it names")]
pub mod offsets {
    /// `BentDirectionsPush`.
    pub mod bent_directions_push {
        pub const CELL_X_M: usize = 20;
        pub const CELL_Y_M: usize = 24;
        pub const COLS: usize = 0;
        pub const CURVATURE_X: usize = 28;
        pub const CURVATURE_Y: usize = 32;
        pub const FIRST_DIRECTION: usize = 16;
        pub const FIRST_FAN: usize = 12;
        pub const FIRST_TEXEL: usize = 8;
        pub const ROWS: usize = 4;
    }
    /// `BounceGatherPush`.
    pub mod bounce_gather_push {
        pub const AZIMUTHS: usize = 16;
        pub const CELL_X_M: usize = 8;
        pub const CELL_Y_M: usize = 12;
        pub const COLS: usize = 0;
        pub const FINE_SAMPLES: usize = 36;
        pub const FIRST_AZIMUTH: usize = 20;
        pub const GROWTH: usize = 44;
        pub const LAST_AZIMUTH: usize = 24;
        pub const ROWS: usize = 4;
        pub const SHADE_FINE: usize = 48;
        pub const SHADE_SHIFT: usize = 52;
        pub const STEP_HEIGHT: usize = 60;
        pub const STEP_SHADE: usize = 56;
        pub const WARM_UP_COLS: usize = 28;
        pub const WARM_UP_ROWS: usize = 32;
        pub const WIDTH_SHIFT: usize = 40;
    }
    /// `BounceMarchPush`.
    pub mod bounce_march_push {
        pub const AZIMUTHS: usize = 32;
        pub const CELL_X_M: usize = 24;
        pub const CELL_Y_M: usize = 28;
        pub const CELLS_X: usize = 8;
        pub const CELLS_Y: usize = 12;
        pub const COLS: usize = 0;
        pub const FIRST_AZIMUTH: usize = 36;
        pub const LAST_AZIMUTH: usize = 40;
        pub const PADDED_ROWS: usize = 16;
        pub const ROWS: usize = 4;
        pub const TOP_LEVEL: usize = 20;
    }
    /// `BounceShadePush`.
    pub mod bounce_shade_push {
        pub const CELL_X_M: usize = 8;
        pub const CELL_Y_M: usize = 12;
        pub const COLS: usize = 0;
        pub const ROWS: usize = 4;
    }
    /// `BounceWalkPush`.
    pub mod bounce_walk_push {
        pub const AZIMUTH_COUNT: usize = 24;
        pub const BEGIN: usize = 36;
        pub const CELL_X_M: usize = 8;
        pub const CELL_Y_M: usize = 12;
        pub const CLEARS: usize = 28;
        pub const COLS: usize = 0;
        pub const FIRST_AZIMUTH: usize = 20;
        pub const IS_LAST: usize = 32;
        pub const ROWS: usize = 4;
        pub const WARM_UP: usize = 16;
    }
    /// `CacheGatherPush`.
    pub mod cache_gather_push {
        pub const BEGIN: usize = 8;
        pub const COLS: usize = 0;
        pub const COUNT: usize = 12;
        pub const ROWS: usize = 4;
    }
    /// `DirtyListPush`.
    pub mod dirty_list_push {
        pub const COLS: usize = 0;
        pub const ROWS: usize = 4;
    }
    /// `DirtyMarkPush`.
    pub mod dirty_mark_push {
        pub const COLS: usize = 0;
        pub const FIRST_COL: usize = 8;
        pub const FIRST_ROW: usize = 12;
        pub const LAST_COL: usize = 16;
        pub const LAST_ROW: usize = 20;
        pub const ROWS: usize = 4;
    }
    /// `DirtyTexels`.
    pub mod dirty_texels {
        pub const DIRTY_TEXELS: usize = 0;
    }
    /// `EditList`.
    pub mod edit_list {
        pub const DIRTY_WORDS: usize = 32;
        pub const LIGHT_GROUPS: usize = 8;
        pub const RESOLVE_GROUPS: usize = 20;
        pub const SWEPT_STEPS: usize = 0;
        pub const WORD_COUNT: usize = 4;
    }
    /// `EllipseFitPush`.
    pub mod ellipse_fit_push {
        pub const COLS: usize = 0;
        pub const END_DIRECTION: usize = 12;
        pub const FIRST_DIRECTION: usize = 8;
        pub const FIRST_ROW: usize = 16;
        pub const LEAST_RADIUS: usize = 20;
        pub const ROWS: usize = 4;
    }
    /// `EnvRotation`.
    pub mod env_rotation {
        pub const ENV_ROTATION: usize = 0;
    }
    /// `EnvRotationPush`.
    pub mod env_rotation_push {
        pub const COLUMN_FIRST: usize = 12;
        pub const ROWS: usize = 4;
        pub const TURNS: usize = 8;
        pub const WIDTH: usize = 0;
    }
    /// `EnvTablesPush`.
    pub mod env_tables_push {
        pub const AZIMUTH_COUNT: usize = 12;
        pub const BOTTOM_RAD: usize = 16;
        pub const HEIGHT: usize = 0;
        pub const NODES: usize = 8;
        pub const ROWS: usize = 4;
    }
    /// `EnvWedgesPush`.
    pub mod env_wedges_push {
        pub const ROTATION_RAD: usize = 8;
        pub const ROWS: usize = 4;
        pub const WIDTH: usize = 0;
    }
    /// `FacetMaskPush`.
    pub mod facet_mask_push {
        pub const CELL_X_M: usize = 24;
        pub const CELL_Y_M: usize = 28;
        pub const CELLS_X: usize = 8;
        pub const CELLS_Y: usize = 12;
        pub const COLS: usize = 0;
        pub const END_DIRECTION: usize = 44;
        pub const FIRST_DIRECTION: usize = 40;
        pub const FIRST_LAYER: usize = 36;
        pub const HIGHEST_M: usize = 32;
        pub const PADDED_ROWS: usize = 16;
        pub const ROWS: usize = 4;
        pub const TOP_LEVEL: usize = 20;
    }
    /// `FanWeightsPush`.
    pub mod fan_weights_push {
        pub const COLS: usize = 0;
        pub const FIRST_DIRECTION: usize = 12;
        pub const FIRST_FAN: usize = 8;
        pub const ROWS: usize = 4;
    }
    /// `HeightBoundsPush`.
    pub mod height_bounds_push {
        pub const CELLS_X: usize = 0;
        pub const CELLS_Y: usize = 4;
        pub const LEVEL: usize = 12;
        pub const PADDED_ROWS: usize = 8;
    }
    /// `HeightCellsPush`.
    pub mod height_cells_push {
        pub const CELL_X_M: usize = 8;
        pub const CELL_Y_M: usize = 12;
        pub const COLS: usize = 0;
        pub const ROWS: usize = 4;
    }
    /// `HeightExpandPush`.
    pub mod height_expand_push {
        pub const COLS: usize = 0;
        pub const ROWS: usize = 4;
        pub const WIDTH_SHIFT: usize = 8;
    }
    /// `HeightReducePush`.
    pub mod height_reduce_push {
        pub const COLS: usize = 0;
        pub const FIRST: usize = 8;
        pub const LEVEL: usize = 40;
        pub const PER_GRID_POINT_X: usize = 32;
        pub const PER_GRID_POINT_Y: usize = 36;
        pub const RATIO_X: usize = 24;
        pub const RATIO_Y: usize = 28;
        pub const ROWS: usize = 4;
        pub const SOURCE_COLS: usize = 12;
        pub const SOURCE_FIRST: usize = 20;
        pub const SOURCE_ROWS: usize = 16;
        pub const WIDTH_SHIFT: usize = 44;
    }
    /// `HeightTransposePush`.
    pub mod height_transpose_push {
        pub const FIRST_COL: usize = 8;
        pub const FIRST_ROW: usize = 12;
        pub const LANES: usize = 0;
        pub const LAST_COL: usize = 16;
        pub const LAST_ROW: usize = 20;
        pub const STEPS: usize = 4;
    }
    /// `HorizonResweepPush`.
    pub mod horizon_resweep_push {
        pub const FIRST_AZIMUTH: usize = 8;
        pub const FIRST_COL: usize = 16;
        pub const FIRST_ROW: usize = 20;
        pub const HEIGHT_SCALE: usize = 12;
        pub const LANES: usize = 0;
        pub const LAST_COL: usize = 24;
        pub const LAST_ROW: usize = 28;
        pub const STEPS: usize = 4;
    }
    /// `HorizonSweepPush`.
    pub mod horizon_sweep_push {
        pub const FIRST_AZIMUTH: usize = 12;
        pub const HEIGHT_SCALE: usize = 16;
        pub const LANES: usize = 0;
        pub const STEPS: usize = 4;
        pub const WARM_UP: usize = 8;
    }
    /// `LightMatrixPush`.
    pub mod light_matrix_push {
        pub const LIGHT_ORDER: usize = 4;
        pub const MATRIX_FIRST: usize = 20;
        pub const ORDER: usize = 8;
        pub const RECEIVERS: usize = 12;
        pub const ROW_FIRST: usize = 16;
        pub const ROWS: usize = 0;
        pub const SKY: usize = 32;
    }
    /// `LightResolvePush`.
    pub mod light_resolve_push {
        pub const CLEARS: usize = 8;
        pub const COLOUR: usize = 16;
        pub const COLS: usize = 0;
        pub const ROWS: usize = 4;
        pub const TEXEL: usize = 12;
    }
    /// `LostLines`.
    pub mod lost_lines {
        pub const LOST_LINES: usize = 0;
    }
    /// `LostRays`.
    pub mod lost_rays {
        pub const LOST_RAYS: usize = 0;
    }
    /// `MapDrawPush`.
    pub mod map_draw_push {
        pub const BEYOND: usize = 32;
        pub const COLS: usize = 8;
        pub const FIRST_COL: usize = 16;
        pub const FIRST_ROW: usize = 20;
        pub const GRID_POINTS_PER_PIXEL: usize = 24;
        pub const HEIGHT: usize = 4;
        pub const ROWS: usize = 12;
        pub const SWAPS: usize = 28;
        pub const WIDTH: usize = 0;
    }
    /// `MarchPush`.
    pub mod march_push {
        pub const FIRST_AZIMUTH: usize = 12;
        pub const LANES: usize = 0;
        pub const STEPS: usize = 4;
        pub const WARM_UP: usize = 8;
    }
    /// `PathTracePush`.
    pub mod path_trace_push {
        pub const ALBEDO: usize = 64;
        pub const BOUNCES: usize = 48;
        pub const CELL_X_M: usize = 24;
        pub const CELL_Y_M: usize = 28;
        pub const CELLS_X: usize = 8;
        pub const CELLS_Y: usize = 12;
        pub const COLS: usize = 0;
        pub const EXPONENT: usize = 40;
        pub const FIRST_LIGHT: usize = 112;
        pub const FIRST_PATH: usize = 104;
        pub const FIRST_ROW: usize = 96;
        pub const HIGHEST_M: usize = 32;
        pub const KEYS: usize = 100;
        pub const LAST_LIGHT: usize = 116;
        pub const LAST_PATH: usize = 108;
        pub const LIGHT_COUNT: usize = 56;
        pub const PADDED_ROWS: usize = 16;
        pub const ROTATION_TURNS: usize = 36;
        pub const ROWS: usize = 4;
        pub const SEED: usize = 60;
        pub const SKY: usize = 80;
        pub const SPECULAR_SCALE: usize = 44;
        pub const SUNS: usize = 52;
        pub const TOP_LEVEL: usize = 20;
    }
    /// `PictureTonePush`.
    pub mod picture_tone_push {
        pub const EXPOSURE: usize = 0;
    }
    /// `PyramidMarchPush`.
    pub mod pyramid_march_push {
        pub const AZIMUTH_COUNT: usize = 16;
        pub const FINE_SAMPLES: usize = 20;
        pub const FIRST_AZIMUTH: usize = 12;
        pub const GROWTH: usize = 28;
        pub const LANES: usize = 0;
        pub const STEPS: usize = 4;
        pub const WARM_UP: usize = 8;
        pub const WIDTH_SHIFT: usize = 24;
    }
    /// `ScatterGatherPush`.
    pub mod scatter_gather_push {
        pub const ALBEDO: usize = 64;
        pub const COLS: usize = 0;
        pub const CURVATURE_X: usize = 56;
        pub const CURVATURE_Y: usize = 60;
        pub const EXPONENT: usize = 44;
        pub const FIRST_DIRECTION: usize = 28;
        pub const FIRST_LINK: usize = 8;
        pub const FIRST_PATH: usize = 20;
        pub const FIRST_SUN: usize = 32;
        pub const FIRST_VIEW: usize = 52;
        pub const PATHS: usize = 24;
        pub const ROWS: usize = 4;
        pub const SPECULAR_SCALE: usize = 48;
        pub const STEP: usize = 16;
        pub const STEPS: usize = 12;
        pub const SUNS: usize = 36;
        pub const WEIGHT_SR: usize = 40;
    }
    /// `ShShadePush`.
    pub mod sh_shade_push {
        pub const CELL_X_M: usize = 8;
        pub const CELL_Y_M: usize = 12;
        pub const COLS: usize = 0;
        pub const ROWS: usize = 4;
        pub const SPECULAR: usize = 16;
    }
    /// `ShWedgesPush`.
    pub mod sh_wedges_push {
        pub const AZIMUTH_COUNT: usize = 16;
        pub const AZIMUTH_FIRST: usize = 20;
        pub const CELL_X_M: usize = 8;
        pub const CELL_Y_M: usize = 12;
        pub const COLS: usize = 0;
        pub const LOWEST_RAD: usize = 32;
        pub const ROWS: usize = 4;
        pub const SIDE: usize = 28;
        pub const TABLE_FIRST: usize = 24;
    }
    /// `ShadeExpandPush`.
    pub mod shade_expand_push {
        pub const COLS: usize = 0;
        pub const ROWS: usize = 4;
        pub const WIDTH_SHIFT: usize = 8;
    }
    /// `ShadePush`.
    pub mod shade_push {
        pub const AZIMUTH_COUNT: usize = 24;
        pub const CELL_X_M: usize = 8;
        pub const CELL_Y_M: usize = 12;
        pub const CLEARS: usize = 28;
        pub const COLS: usize = 0;
        pub const FIRST_AZIMUTH: usize = 20;
        pub const ROWS: usize = 4;
        pub const WARM_UP: usize = 16;
    }
    /// `ShadeReducePush`.
    pub mod shade_reduce_push {
        pub const COLS: usize = 0;
        pub const FIRST: usize = 8;
        pub const LEVEL: usize = 40;
        pub const PER_GRID_POINT_X: usize = 32;
        pub const PER_GRID_POINT_Y: usize = 36;
        pub const RATIO_X: usize = 24;
        pub const RATIO_Y: usize = 28;
        pub const ROWS: usize = 4;
        pub const SOURCE_COLS: usize = 12;
        pub const SOURCE_FIRST: usize = 20;
        pub const SOURCE_ROWS: usize = 16;
        pub const WIDTH_SHIFT: usize = 44;
    }
    /// `SkyDrawPush`.
    pub mod sky_draw_push {
        pub const ABOVE: usize = 48;
        pub const BELOW: usize = 64;
        pub const DOWN: usize = 32;
        pub const FORWARD: usize = 0;
        pub const RIGHT: usize = 16;
        pub const ROTATION_TURNS: usize = 80;
    }
    /// `SpecularExitPush`.
    pub mod specular_exit_push {
        pub const BEGINS: usize = 8;
        pub const COLS: usize = 0;
        pub const EXPONENT: usize = 20;
        pub const FIRST_TEXEL: usize = 12;
        pub const FOURS: usize = 16;
        pub const ROWS: usize = 4;
        pub const SCALE: usize = 24;
    }
    /// `SpecularGatherPush`.
    pub mod specular_gather_push {
        pub const AZIMUTHS: usize = 16;
        pub const CELL_X_M: usize = 8;
        pub const CELL_Y_M: usize = 12;
        pub const COLS: usize = 0;
        pub const FINE_SAMPLES: usize = 36;
        pub const FIRST_AZIMUTH: usize = 20;
        pub const GROWTH: usize = 44;
        pub const LAST_AZIMUTH: usize = 24;
        pub const ROWS: usize = 4;
        pub const SHADE_FINE: usize = 48;
        pub const SHADE_SHIFT: usize = 52;
        pub const STEP_HEIGHT: usize = 60;
        pub const STEP_SHADE: usize = 56;
        pub const WARM_UP_COLS: usize = 28;
        pub const WARM_UP_ROWS: usize = 32;
        pub const WIDTH_SHIFT: usize = 40;
    }
    /// `SpecularVisibilityPush`.
    pub mod specular_visibility_push {
        pub const COLS: usize = 0;
        pub const ROWS: usize = 4;
    }
    /// `SphereShShadePush`.
    pub mod sphere_sh_shade_push {
        pub const AZIMUTHS: usize = 68;
        pub const BASE: usize = 40;
        pub const CELL_X_M: usize = 24;
        pub const CELL_Y_M: usize = 28;
        pub const CELLS_X: usize = 8;
        pub const CELLS_Y: usize = 12;
        pub const COLS: usize = 0;
        pub const ENTRY_COUNT: usize = 84;
        pub const ENTRY_FIRST: usize = 80;
        pub const FINE_SAMPLES: usize = 96;
        pub const FIRST: usize = 32;
        pub const FIRST_AZIMUTH: usize = 72;
        pub const GROWTH: usize = 104;
        pub const LAST_AZIMUTH: usize = 76;
        pub const LEVEL_STEP: usize = 108;
        pub const OFFSET: usize = 48;
        pub const PADDED_ROWS: usize = 16;
        pub const RADIANCE: usize = 112;
        pub const RADIUS_M: usize = 60;
        pub const REACH_M: usize = 64;
        pub const ROWS: usize = 4;
        pub const SIDE: usize = 92;
        pub const TABLE_FIRST: usize = 88;
        pub const TOP_LEVEL: usize = 20;
        pub const UP_M: usize = 56;
        pub const WIDTH_SHIFT: usize = 100;
    }
    /// `SphereShadePush`.
    pub mod sphere_shade_push {
        pub const BASE: usize = 40;
        pub const CELL_X_M: usize = 24;
        pub const CELL_Y_M: usize = 28;
        pub const CELLS_X: usize = 8;
        pub const CELLS_Y: usize = 12;
        pub const COLS: usize = 0;
        pub const FIRST: usize = 32;
        pub const FIRST_SLICE: usize = 76;
        pub const LAST_SLICE: usize = 80;
        pub const OFFSET: usize = 48;
        pub const PADDED_ROWS: usize = 16;
        pub const RADIANCE: usize = 96;
        pub const RADIUS_M: usize = 60;
        pub const REACH_M: usize = 64;
        pub const ROWS: usize = 4;
        pub const SLICES: usize = 68;
        pub const SLICES_AROUND: usize = 72;
        pub const TOP_LEVEL: usize = 20;
        pub const UP_M: usize = 56;
    }
    /// `SunSpecularPush`.
    pub mod sun_specular_push {
        pub const CELL_X_M: usize = 8;
        pub const CELL_Y_M: usize = 12;
        pub const COLOUR: usize = 32;
        pub const COLS: usize = 0;
        pub const ROWS: usize = 4;
        pub const SPECULAR: usize = 48;
        pub const TOWARDS: usize = 16;
    }
    /// `SweepFusePush`.
    pub mod sweep_fuse_push {
        pub const COLS: usize = 0;
        pub const FIRST_AZIMUTH: usize = 12;
        pub const FIRST_LAYER: usize = 16;
        pub const ROWS: usize = 4;
        pub const WARM_UP: usize = 8;
    }
    /// `TerrainDrawPush`.
    pub mod terrain_draw_push {
        pub const CLIP_AT_ORIGIN: usize = 48;
        pub const CLIP_PER_COL: usize = 0;
        pub const CLIP_PER_METRE: usize = 32;
        pub const CLIP_PER_ROW: usize = 16;
        pub const COLS: usize = 76;
        pub const MESH_STEP: usize = 84;
        pub const ORIGIN_COL: usize = 64;
        pub const ORIGIN_M: usize = 72;
        pub const ORIGIN_ROW: usize = 68;
        pub const ROWS: usize = 80;
        pub const TILES_ACROSS: usize = 88;
    }
    /// `VectorReducePush`.
    pub mod vector_reduce_push {
        pub const COLS: usize = 0;
        pub const FIRST: usize = 8;
        pub const LEVEL: usize = 40;
        pub const PER_GRID_POINT_X: usize = 32;
        pub const PER_GRID_POINT_Y: usize = 36;
        pub const RATIO_X: usize = 24;
        pub const RATIO_Y: usize = 28;
        pub const ROWS: usize = 4;
        pub const SOURCE_COLS: usize = 12;
        pub const SOURCE_FIRST: usize = 20;
        pub const SOURCE_ROWS: usize = 16;
        pub const WIDTH_SHIFT: usize = 44;
    }
    /// `VisiblePointsPush`.
    pub mod visible_points_push {
        pub const CELL_X_M: usize = 24;
        pub const CELL_Y_M: usize = 28;
        pub const CELLS_X: usize = 8;
        pub const CELLS_Y: usize = 12;
        pub const COLS: usize = 0;
        pub const END_DIRECTION: usize = 44;
        pub const FIRST_DIRECTION: usize = 40;
        pub const FIRST_LAYER: usize = 36;
        pub const HIGHEST_M: usize = 32;
        pub const PADDED_ROWS: usize = 16;
        pub const ROWS: usize = 4;
        pub const TOP_LEVEL: usize = 20;
    }
    /// `WedgeRows`.
    pub mod wedge_rows {
        pub const WEDGE_ROWS: usize = 0;
    }
}

/// Words of all shaders together.
const WORD_COUNT: usize = 370963;

// Written by build.rs from the SPIR-V of shaders_glsl/; committed by tools/shaders. Not edited by hand.

/// `shaders_glsl/bake/bent_directions.comp`.
pub const BENT_DIRECTIONS: Shader = Shader {
    name: "bent_directions",
    push_bytes: 36,
    bindings: &[
        Binding { binding: 0, name: "visible_points", kind: BindingKind::SampledImage { uint: true, layered: true }, written: false },
        Binding { binding: 1, name: "ground", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "directions", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 3, name: "fans", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 4, name: "bent", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: true }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "border" },
        Constant { id: 1, name: "small" },
        Constant { id: 2, name: "reach" },
    ],
    words: words_at(0, 8160),
};

/// `shaders_glsl/bake/bent_directions.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BentDirections {
    /// `BORDER`, by default 0.
    pub border: u32,
    /// `SMALL`, by default false.
    pub small: bool,
    /// `REACH`, by default 16384.
    pub reach: i32,
}

impl Default for BentDirections {
    fn default() -> Self {
        Self {
            border: 0,
            small: false,
            reach: 16384,
        }
    }
}

impl From<BentDirections> for Specialised {
    fn from(of: BentDirections) -> Self {
        Self { shader: &BENT_DIRECTIONS, constants: vec![
            of.border,
            u32::from(of.small),
            of.reach as u32,
        ] }
    }
}

/// `shaders_glsl/bounce/bounce_gather.comp`.
pub const BOUNCE_GATHER: Shader = Shader {
    name: "bounce_gather",
    push_bytes: 64,
    bindings: &[
        Binding { binding: 0, name: "heights", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "height_levels", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "level_table", kind: BindingKind::SampledImage { uint: true, layered: false }, written: false },
        Binding { binding: 3, name: "height_stack", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
        Binding { binding: 4, name: "ground", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 5, name: "exit_radiance", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 6, name: "shade_levels", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 7, name: "shade_table", kind: BindingKind::SampledImage { uint: true, layered: false }, written: false },
        Binding { binding: 8, name: "bounce_sum", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 9, name: "shade_stack", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
    ],
    constants: &[
        Constant { id: 0, name: "periodic" },
        Constant { id: 1, name: "stack" },
        Constant { id: 2, name: "levels" },
        Constant { id: 3, name: "shade_levels" },
        Constant { id: 4, name: "grey" },
        Constant { id: 5, name: "is_plane" },
        Constant { id: 6, name: "node_stride" },
    ],
    words: words_at(8160, 11636),
};

/// `shaders_glsl/bounce/bounce_gather.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BounceGather {
    /// `PERIODIC`, by default false.
    pub periodic: bool,
    /// `STACK`, by default false.
    pub stack: bool,
    /// `LEVELS`, by default 0.
    pub levels: i32,
    /// `SHADE_LEVELS`, by default 0.
    pub shade_levels: i32,
    /// `GREY`, by default false.
    pub grey: bool,
    /// `IS_PLANE`, by default true.
    pub is_plane: bool,
    /// `NODE_STRIDE`, by default 1.
    pub node_stride: i32,
}

impl Default for BounceGather {
    fn default() -> Self {
        Self {
            periodic: false,
            stack: false,
            levels: 0,
            shade_levels: 0,
            grey: false,
            is_plane: true,
            node_stride: 1,
        }
    }
}

impl From<BounceGather> for Specialised {
    fn from(of: BounceGather) -> Self {
        Self { shader: &BOUNCE_GATHER, constants: vec![
            u32::from(of.periodic),
            u32::from(of.stack),
            of.levels as u32,
            of.shade_levels as u32,
            u32::from(of.grey),
            u32::from(of.is_plane),
            of.node_stride as u32,
        ] }
    }
}

/// `shaders_glsl/bounce/bounce_march.comp`.
pub const BOUNCE_MARCH: Shader = Shader {
    name: "bounce_march",
    push_bytes: 44,
    bindings: &[
        Binding { binding: 0, name: "cells", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "maxima", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "ground", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 3, name: "exit_radiance", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 4, name: "bounce_sum", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "border" },
        Constant { id: 1, name: "thin_rows" },
        Constant { id: 2, name: "thin_cols" },
        Constant { id: 3, name: "most_steps" },
        Constant { id: 4, name: "grey" },
        Constant { id: 5, name: "node_stride" },
    ],
    words: words_at(19796, 12304),
};

/// `shaders_glsl/bounce/bounce_march.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BounceMarch {
    /// `BORDER`, by default 0.
    pub border: u32,
    /// `THIN_ROWS`, by default false.
    pub thin_rows: bool,
    /// `THIN_COLS`, by default false.
    pub thin_cols: bool,
    /// `MOST_STEPS`, by default 60000.
    pub most_steps: i32,
    /// `GREY`, by default false.
    pub grey: bool,
    /// `NODE_STRIDE`, by default 1.
    pub node_stride: i32,
}

impl Default for BounceMarch {
    fn default() -> Self {
        Self {
            border: 0,
            thin_rows: false,
            thin_cols: false,
            most_steps: 60000,
            grey: false,
            node_stride: 1,
        }
    }
}

impl From<BounceMarch> for Specialised {
    fn from(of: BounceMarch) -> Self {
        Self { shader: &BOUNCE_MARCH, constants: vec![
            of.border,
            u32::from(of.thin_rows),
            u32::from(of.thin_cols),
            of.most_steps as u32,
            u32::from(of.grey),
            of.node_stride as u32,
        ] }
    }
}

/// `shaders_glsl/bounce/bounce_shade.comp`.
pub const BOUNCE_SHADE: Shader = Shader {
    name: "bounce_shade",
    push_bytes: 16,
    bindings: &[
        Binding { binding: 0, name: "ground", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "sky_share", kind: BindingKind::StorageImage { format: "R32f", uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "node_sum", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: false },
        Binding { binding: 3, name: "bounce_sum", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "node_stride" },
    ],
    words: words_at(32100, 2678),
};

/// `shaders_glsl/bounce/bounce_shade.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BounceShade {
    /// `NODE_STRIDE`, by default 2.
    pub node_stride: i32,
}

impl Default for BounceShade {
    fn default() -> Self {
        Self {
            node_stride: 2,
        }
    }
}

impl From<BounceShade> for Specialised {
    fn from(of: BounceShade) -> Self {
        Self { shader: &BOUNCE_SHADE, constants: vec![
            of.node_stride as u32,
        ] }
    }
}

/// `shaders_glsl/bounce/bounce_walk.comp`.
pub const BOUNCE_WALK: Shader = Shader {
    name: "bounce_walk",
    push_bytes: 40,
    bindings: &[
        Binding { binding: 0, name: "lane_heights", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "azimuths", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 2, name: "occluders", kind: BindingKind::StorageImage { format: "Rg32ui", uint: true, layered: true }, written: false },
        Binding { binding: 3, name: "exit_radiance", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: false },
        Binding { binding: 4, name: "exit_grey", kind: BindingKind::StorageImage { format: "R32f", uint: false, layered: false }, written: false },
        Binding { binding: 5, name: "bounce_sum", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 6, name: "visibility_cache", kind: BindingKind::StorageImage { format: "Rgba32ui", uint: true, layered: true }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "line_shift" },
        Constant { id: 1, name: "border" },
        Constant { id: 2, name: "marches_rows" },
        Constant { id: 3, name: "grey" },
        Constant { id: 4, name: "node_stride" },
        Constant { id: 5, name: "from" },
    ],
    words: words_at(34778, 13812),
};

/// `shaders_glsl/bounce/bounce_walk.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BounceWalk {
    /// `LINE_SHIFT`, by default 15.
    pub line_shift: i32,
    /// `BORDER`, by default 0.
    pub border: u32,
    /// `MARCHES_ROWS`, by default false.
    pub marches_rows: bool,
    /// `GREY`, by default false.
    pub grey: bool,
    /// `NODE_STRIDE`, by default 1.
    pub node_stride: i32,
    /// `FROM`, by default 0.
    pub from: u32,
}

impl Default for BounceWalk {
    fn default() -> Self {
        Self {
            line_shift: 15,
            border: 0,
            marches_rows: false,
            grey: false,
            node_stride: 1,
            from: 0,
        }
    }
}

impl From<BounceWalk> for Specialised {
    fn from(of: BounceWalk) -> Self {
        Self { shader: &BOUNCE_WALK, constants: vec![
            of.line_shift as u32,
            of.border,
            u32::from(of.marches_rows),
            u32::from(of.grey),
            of.node_stride as u32,
            of.from,
        ] }
    }
}

/// `shaders_glsl/bounce/cache_gather.comp`.
pub const CACHE_GATHER: Shader = Shader {
    name: "cache_gather",
    push_bytes: 16,
    bindings: &[
        Binding { binding: 0, name: "visibility_cache", kind: BindingKind::StorageImage { format: "Rgba32ui", uint: true, layered: true }, written: false },
        Binding { binding: 1, name: "azimuths", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 2, name: "exit_radiance", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: false },
        Binding { binding: 3, name: "exit_grey", kind: BindingKind::StorageImage { format: "R32f", uint: false, layered: false }, written: false },
        Binding { binding: 4, name: "node_sum", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: false },
        Binding { binding: 5, name: "bounce_sum", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "border" },
        Constant { id: 1, name: "grey" },
        Constant { id: 2, name: "node_stride" },
    ],
    words: words_at(48590, 3639),
};

/// `shaders_glsl/bounce/cache_gather.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CacheGather {
    /// `BORDER`, by default 0.
    pub border: u32,
    /// `GREY`, by default false.
    pub grey: bool,
    /// `NODE_STRIDE`, by default 4.
    pub node_stride: i32,
}

impl Default for CacheGather {
    fn default() -> Self {
        Self {
            border: 0,
            grey: false,
            node_stride: 4,
        }
    }
}

impl From<CacheGather> for Specialised {
    fn from(of: CacheGather) -> Self {
        Self { shader: &CACHE_GATHER, constants: vec![
            of.border,
            u32::from(of.grey),
            of.node_stride as u32,
        ] }
    }
}

/// `shaders_glsl/edit/dirty_list.comp`.
pub const DIRTY_LIST: Shader = Shader {
    name: "dirty_list",
    push_bytes: 8,
    bindings: &[
        Binding { binding: 0, name: "dirty_texels", kind: BindingKind::StorageBuffer, written: false },
        Binding { binding: 1, name: "edit_list", kind: BindingKind::StorageBuffer, written: true },
    ],
    constants: &[
    ],
    words: words_at(52229, 874),
};

/// `shaders_glsl/edit/dirty_list.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct DirtyList;

impl From<DirtyList> for Specialised {
    fn from(_: DirtyList) -> Self {
        Self { shader: &DIRTY_LIST, constants: vec![
        ] }
    }
}

/// `shaders_glsl/edit/dirty_mark.comp`.
pub const DIRTY_MARK: Shader = Shader {
    name: "dirty_mark",
    push_bytes: 24,
    bindings: &[
        Binding { binding: 0, name: "dirty_texels", kind: BindingKind::StorageBuffer, written: true },
        Binding { binding: 1, name: "edit_list", kind: BindingKind::StorageBuffer, written: true },
    ],
    constants: &[
    ],
    words: words_at(53103, 1323),
};

/// `shaders_glsl/edit/dirty_mark.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct DirtyMark;

impl From<DirtyMark> for Specialised {
    fn from(_: DirtyMark) -> Self {
        Self { shader: &DIRTY_MARK, constants: vec![
        ] }
    }
}

/// `shaders_glsl/bake/ellipse_fit.comp`.
pub const ELLIPSE_FIT: Shader = Shader {
    name: "ellipse_fit",
    push_bytes: 24,
    bindings: &[
        Binding { binding: 0, name: "visible_points", kind: BindingKind::SampledImage { uint: true, layered: true }, written: false },
        Binding { binding: 1, name: "directions", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 2, name: "ellipse_axes", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 3, name: "ellipse_radii", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 4, name: "bent", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
    ],
    constants: &[
        Constant { id: 0, name: "small" },
        Constant { id: 1, name: "bent" },
    ],
    words: words_at(54426, 5049),
};

/// `shaders_glsl/bake/ellipse_fit.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EllipseFit {
    /// `SMALL`, by default false.
    pub small: bool,
    /// `BENT`, by default false.
    pub bent: bool,
}

impl From<EllipseFit> for Specialised {
    fn from(of: EllipseFit) -> Self {
        Self { shader: &ELLIPSE_FIT, constants: vec![
            u32::from(of.small),
            u32::from(of.bent),
        ] }
    }
}

/// `shaders_glsl/sh/env_rotation.comp`.
pub const ENV_ROTATION: Shader = Shader {
    name: "env_rotation",
    push_bytes: 16,
    bindings: &[
        Binding { binding: 0, name: "environment", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "constants", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 2, name: "env_rotation", kind: BindingKind::StorageBuffer, written: true },
    ],
    constants: &[
    ],
    words: words_at(59475, 949),
};

/// `shaders_glsl/sh/env_rotation.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EnvRotation;

impl From<EnvRotation> for Specialised {
    fn from(_: EnvRotation) -> Self {
        Self { shader: &ENV_ROTATION, constants: vec![
        ] }
    }
}

/// `shaders_glsl/direct/env_tables.comp`.
pub const ENV_TABLES: Shader = Shader {
    name: "env_tables",
    push_bytes: 20,
    bindings: &[
        Binding { binding: 0, name: "wedge_rows", kind: BindingKind::StorageBuffer, written: false },
        Binding { binding: 1, name: "env_tables", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: true }, written: true },
    ],
    constants: &[
    ],
    words: words_at(60424, 1463),
};

/// `shaders_glsl/direct/env_tables.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EnvTables;

impl From<EnvTables> for Specialised {
    fn from(_: EnvTables) -> Self {
        Self { shader: &ENV_TABLES, constants: vec![
        ] }
    }
}

/// `shaders_glsl/sh/env_wedges.comp`.
pub const ENV_WEDGES: Shader = Shader {
    name: "env_wedges",
    push_bytes: 12,
    bindings: &[
        Binding { binding: 0, name: "environment", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "azimuths", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 2, name: "wedge_rows", kind: BindingKind::StorageBuffer, written: true },
    ],
    constants: &[
    ],
    words: words_at(61887, 2151),
};

/// `shaders_glsl/sh/env_wedges.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EnvWedges;

impl From<EnvWedges> for Specialised {
    fn from(_: EnvWedges) -> Self {
        Self { shader: &ENV_WEDGES, constants: vec![
        ] }
    }
}

/// `shaders_glsl/bake/facet_mask.comp`.
pub const FACET_MASK: Shader = Shader {
    name: "facet_mask",
    push_bytes: 48,
    bindings: &[
        Binding { binding: 0, name: "cells", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "maxima", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "directions", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 3, name: "facet_mask", kind: BindingKind::StorageImage { format: "R32ui", uint: true, layered: true }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "border" },
        Constant { id: 1, name: "most_steps" },
    ],
    words: words_at(64038, 9115),
};

/// `shaders_glsl/bake/facet_mask.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FacetMask {
    /// `BORDER`, by default 0.
    pub border: u32,
    /// `MOST_STEPS`, by default 60000.
    pub most_steps: i32,
}

impl Default for FacetMask {
    fn default() -> Self {
        Self {
            border: 0,
            most_steps: 60000,
        }
    }
}

impl From<FacetMask> for Specialised {
    fn from(of: FacetMask) -> Self {
        Self { shader: &FACET_MASK, constants: vec![
            of.border,
            of.most_steps as u32,
        ] }
    }
}

/// `shaders_glsl/bake/fan_weights.comp`.
pub const FAN_WEIGHTS: Shader = Shader {
    name: "fan_weights",
    push_bytes: 16,
    bindings: &[
        Binding { binding: 0, name: "bent", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
        Binding { binding: 1, name: "fans", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 2, name: "fan_weights", kind: BindingKind::StorageImage { format: "R32f", uint: false, layered: true }, written: true },
    ],
    constants: &[
    ],
    words: words_at(73153, 1842),
};

/// `shaders_glsl/bake/fan_weights.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FanWeights;

impl From<FanWeights> for Specialised {
    fn from(_: FanWeights) -> Self {
        Self { shader: &FAN_WEIGHTS, constants: vec![
        ] }
    }
}

/// `shaders_glsl/rays/height_bounds.comp`.
pub const HEIGHT_BOUNDS: Shader = Shader {
    name: "height_bounds",
    push_bytes: 16,
    bindings: &[
        Binding { binding: 0, name: "cells", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "maxima", kind: BindingKind::StorageImage { format: "R32f", uint: false, layered: false }, written: true },
    ],
    constants: &[
    ],
    words: words_at(74995, 1109),
};

/// `shaders_glsl/rays/height_bounds.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HeightBounds;

impl From<HeightBounds> for Specialised {
    fn from(_: HeightBounds) -> Self {
        Self { shader: &HEIGHT_BOUNDS, constants: vec![
        ] }
    }
}

/// `shaders_glsl/rays/height_cells.comp`.
pub const HEIGHT_CELLS: Shader = Shader {
    name: "height_cells",
    push_bytes: 16,
    bindings: &[
        Binding { binding: 0, name: "heights", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "cells", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 2, name: "ground", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 3, name: "batch_mean", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 4, name: "lost_rays", kind: BindingKind::StorageBuffer, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "periodic" },
        Constant { id: 1, name: "begins_paths" },
    ],
    words: words_at(76104, 2514),
};

/// `shaders_glsl/rays/height_cells.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HeightCells {
    /// `PERIODIC`, by default false.
    pub periodic: bool,
    /// `BEGINS_PATHS`, by default false.
    pub begins_paths: bool,
}

impl From<HeightCells> for Specialised {
    fn from(of: HeightCells) -> Self {
        Self { shader: &HEIGHT_CELLS, constants: vec![
            u32::from(of.periodic),
            u32::from(of.begins_paths),
        ] }
    }
}

/// `shaders_glsl/horizon/height_expand.comp`.
pub const HEIGHT_EXPAND: Shader = Shader {
    name: "height_expand",
    push_bytes: 12,
    bindings: &[
        Binding { binding: 0, name: "height_levels", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "level_table", kind: BindingKind::SampledImage { uint: true, layered: false }, written: false },
        Binding { binding: 2, name: "height_stack", kind: BindingKind::StorageImage { format: "R32f", uint: false, layered: true }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "periodic" },
    ],
    words: words_at(78618, 2496),
};

/// `shaders_glsl/horizon/height_expand.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HeightExpand {
    /// `PERIODIC`, by default false.
    pub periodic: bool,
}

impl From<HeightExpand> for Specialised {
    fn from(of: HeightExpand) -> Self {
        Self { shader: &HEIGHT_EXPAND, constants: vec![
            u32::from(of.periodic),
        ] }
    }
}

/// `shaders_glsl/horizon/height_reduce.comp`.
pub const HEIGHT_REDUCE: Shader = Shader {
    name: "height_reduce",
    push_bytes: 48,
    bindings: &[
        Binding { binding: 0, name: "heights", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "height_levels", kind: BindingKind::StorageImage { format: "R32f", uint: false, layered: false }, written: true },
        Binding { binding: 2, name: "level_table", kind: BindingKind::StorageImage { format: "Rgba32ui", uint: true, layered: false }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "periodic" },
        Constant { id: 1, name: "from_field" },
    ],
    words: words_at(81114, 2860),
};

/// `shaders_glsl/horizon/height_reduce.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HeightReduce {
    /// `PERIODIC`, by default false.
    pub periodic: bool,
    /// `FROM_FIELD`, by default false.
    pub from_field: bool,
}

impl From<HeightReduce> for Specialised {
    fn from(of: HeightReduce) -> Self {
        Self { shader: &HEIGHT_REDUCE, constants: vec![
            u32::from(of.periodic),
            u32::from(of.from_field),
        ] }
    }
}

/// `shaders_glsl/horizon/height_transpose.comp`.
pub const HEIGHT_TRANSPOSE: Shader = Shader {
    name: "height_transpose",
    push_bytes: 24,
    bindings: &[
        Binding { binding: 0, name: "heights", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "lane_heights", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "marches_rows" },
        Constant { id: 1, name: "periodic" },
    ],
    words: words_at(83974, 978),
};

/// `shaders_glsl/horizon/height_transpose.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HeightTranspose {
    /// `MARCHES_ROWS`, by default false.
    pub marches_rows: bool,
    /// `PERIODIC`, by default false.
    pub periodic: bool,
}

impl From<HeightTranspose> for Specialised {
    fn from(of: HeightTranspose) -> Self {
        Self { shader: &HEIGHT_TRANSPOSE, constants: vec![
            u32::from(of.marches_rows),
            u32::from(of.periodic),
        ] }
    }
}

/// `shaders_glsl/horizon/horizon_march.comp`.
pub const HORIZON_MARCH: Shader = Shader {
    name: "horizon_march",
    push_bytes: 16,
    bindings: &[
        Binding { binding: 0, name: "heights", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "azimuths", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 2, name: "slopes", kind: BindingKind::StorageImage { format: "Unknown", uint: true, layered: true }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "all_crossings" },
        Constant { id: 1, name: "periodic" },
        Constant { id: 2, name: "writes_distances" },
        Constant { id: 3, name: "node_stride" },
    ],
    words: words_at(84952, 5456),
};

/// `shaders_glsl/horizon/horizon_march.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HorizonMarch {
    /// `ALL_CROSSINGS`, by default true.
    pub all_crossings: bool,
    /// `PERIODIC`, by default false.
    pub periodic: bool,
    /// `WRITES_DISTANCES`, by default false.
    pub writes_distances: bool,
    /// `NODE_STRIDE`, by default 1.
    pub node_stride: i32,
}

impl Default for HorizonMarch {
    fn default() -> Self {
        Self {
            all_crossings: true,
            periodic: false,
            writes_distances: false,
            node_stride: 1,
        }
    }
}

impl From<HorizonMarch> for Specialised {
    fn from(of: HorizonMarch) -> Self {
        Self { shader: &HORIZON_MARCH, constants: vec![
            u32::from(of.all_crossings),
            u32::from(of.periodic),
            u32::from(of.writes_distances),
            of.node_stride as u32,
        ] }
    }
}

/// `shaders_glsl/edit/horizon_resweep.comp`.
pub const HORIZON_RESWEEP: Shader = Shader {
    name: "horizon_resweep",
    push_bytes: 32,
    bindings: &[
        Binding { binding: 0, name: "heights", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "azimuths", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 2, name: "occluders", kind: BindingKind::StorageImage { format: "Rg32ui", uint: true, layered: true }, written: true },
        Binding { binding: 3, name: "dirty_texels", kind: BindingKind::StorageBuffer, written: true },
        Binding { binding: 4, name: "edit_list", kind: BindingKind::StorageBuffer, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "line_shift" },
        Constant { id: 1, name: "hull_packed" },
    ],
    words: words_at(90408, 8882),
};

/// `shaders_glsl/edit/horizon_resweep.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HorizonResweep {
    /// `LINE_SHIFT`, by default 15.
    pub line_shift: i32,
    /// `HULL_PACKED`, by default false.
    pub hull_packed: bool,
}

impl Default for HorizonResweep {
    fn default() -> Self {
        Self {
            line_shift: 15,
            hull_packed: false,
        }
    }
}

impl From<HorizonResweep> for Specialised {
    fn from(of: HorizonResweep) -> Self {
        Self { shader: &HORIZON_RESWEEP, constants: vec![
            of.line_shift as u32,
            u32::from(of.hull_packed),
        ] }
    }
}

/// `shaders_glsl/horizon/horizon_sweep.comp`.
pub const HORIZON_SWEEP: Shader = Shader {
    name: "horizon_sweep",
    push_bytes: 20,
    bindings: &[
        Binding { binding: 0, name: "heights", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "lane_heights", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "azimuths", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 3, name: "occluders", kind: BindingKind::StorageImage { format: "Rg32ui", uint: true, layered: true }, written: true },
        Binding { binding: 4, name: "slopes", kind: BindingKind::StorageImage { format: "Unknown", uint: true, layered: true }, written: true },
        Binding { binding: 5, name: "lost_lines", kind: BindingKind::StorageBuffer, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "local_size_x" },
        Constant { id: 1, name: "hull_place" },
        Constant { id: 2, name: "hull_depth" },
        Constant { id: 3, name: "private_entries" },
        Constant { id: 4, name: "private_words" },
        Constant { id: 5, name: "shared_words" },
        Constant { id: 6, name: "hull_holds_line" },
        Constant { id: 7, name: "hull_packed" },
        Constant { id: 8, name: "writes_occluders" },
        Constant { id: 9, name: "slope_format" },
        Constant { id: 10, name: "periodic" },
        Constant { id: 11, name: "line_shift" },
        Constant { id: 12, name: "redoes_lost" },
    ],
    words: words_at(99290, 9430),
};

/// `shaders_glsl/horizon/horizon_sweep.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HorizonSweep {
    /// `LOCAL_SIZE_X`, by default 1.
    pub local_size_x: u32,
    /// `HULL_PLACE`, by default 0.
    pub hull_place: u32,
    /// `HULL_DEPTH`, by default 1.
    pub hull_depth: i32,
    /// `PRIVATE_ENTRIES`, by default 1.
    pub private_entries: i32,
    /// `PRIVATE_WORDS`, by default 1.
    pub private_words: i32,
    /// `SHARED_WORDS`, by default 1.
    pub shared_words: i32,
    /// `HULL_HOLDS_LINE`, by default true.
    pub hull_holds_line: bool,
    /// `HULL_PACKED`, by default false.
    pub hull_packed: bool,
    /// `WRITES_OCCLUDERS`, by default true.
    pub writes_occluders: bool,
    /// `SLOPE_FORMAT`, by default 0.
    pub slope_format: u32,
    /// `PERIODIC`, by default false.
    pub periodic: bool,
    /// `LINE_SHIFT`, by default 15.
    pub line_shift: i32,
    /// `REDOES_LOST`, by default false.
    pub redoes_lost: bool,
}

impl Default for HorizonSweep {
    fn default() -> Self {
        Self {
            local_size_x: 1,
            hull_place: 0,
            hull_depth: 1,
            private_entries: 1,
            private_words: 1,
            shared_words: 1,
            hull_holds_line: true,
            hull_packed: false,
            writes_occluders: true,
            slope_format: 0,
            periodic: false,
            line_shift: 15,
            redoes_lost: false,
        }
    }
}

impl From<HorizonSweep> for Specialised {
    fn from(of: HorizonSweep) -> Self {
        Self { shader: &HORIZON_SWEEP, constants: vec![
            of.local_size_x,
            of.hull_place,
            of.hull_depth as u32,
            of.private_entries as u32,
            of.private_words as u32,
            of.shared_words as u32,
            u32::from(of.hull_holds_line),
            u32::from(of.hull_packed),
            u32::from(of.writes_occluders),
            of.slope_format,
            u32::from(of.periodic),
            of.line_shift as u32,
            u32::from(of.redoes_lost),
        ] }
    }
}

/// `shaders_glsl/sh/light_matrix.comp`.
pub const LIGHT_MATRIX: Shader = Shader {
    name: "light_matrix",
    push_bytes: 48,
    bindings: &[
        Binding { binding: 0, name: "env_rotation", kind: BindingKind::StorageBuffer, written: false },
        Binding { binding: 1, name: "constants", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 2, name: "light_matrix", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
    ],
    constants: &[
    ],
    words: words_at(108720, 1843),
};

/// `shaders_glsl/sh/light_matrix.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LightMatrix;

impl From<LightMatrix> for Specialised {
    fn from(_: LightMatrix) -> Self {
        Self { shader: &LIGHT_MATRIX, constants: vec![
        ] }
    }
}

/// `shaders_glsl/direct/light_resolve.comp`.
pub const LIGHT_RESOLVE: Shader = Shader {
    name: "light_resolve",
    push_bytes: 32,
    bindings: &[
        Binding { binding: 0, name: "scalar_sum", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "colour_sum", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "albedo_map", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 3, name: "radiance", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 4, name: "layer", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 5, name: "radiance_grey", kind: BindingKind::StorageImage { format: "R32f", uint: false, layered: false }, written: true },
        Binding { binding: 6, name: "layer_grey", kind: BindingKind::StorageImage { format: "R32f", uint: false, layered: false }, written: true },
        Binding { binding: 7, name: "dirty_texels", kind: BindingKind::StorageBuffer, written: false },
        Binding { binding: 8, name: "edit_list", kind: BindingKind::StorageBuffer, written: false },
        Binding { binding: 9, name: "light_colours", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
    ],
    constants: &[
        Constant { id: 0, name: "sum_has_colour" },
        Constant { id: 1, name: "albedo_is_map" },
        Constant { id: 2, name: "adds_to_radiance" },
        Constant { id: 3, name: "writes_layer" },
        Constant { id: 4, name: "grey" },
        Constant { id: 5, name: "relights" },
        Constant { id: 6, name: "colour_is_texel" },
    ],
    words: words_at(110563, 1991),
};

/// `shaders_glsl/direct/light_resolve.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightResolve {
    /// `SUM_HAS_COLOUR`, by default false.
    pub sum_has_colour: bool,
    /// `ALBEDO_IS_MAP`, by default false.
    pub albedo_is_map: bool,
    /// `ADDS_TO_RADIANCE`, by default true.
    pub adds_to_radiance: bool,
    /// `WRITES_LAYER`, by default false.
    pub writes_layer: bool,
    /// `GREY`, by default false.
    pub grey: bool,
    /// `RELIGHTS`, by default false.
    pub relights: bool,
    /// `COLOUR_IS_TEXEL`, by default false.
    pub colour_is_texel: bool,
}

impl Default for LightResolve {
    fn default() -> Self {
        Self {
            sum_has_colour: false,
            albedo_is_map: false,
            adds_to_radiance: true,
            writes_layer: false,
            grey: false,
            relights: false,
            colour_is_texel: false,
        }
    }
}

impl From<LightResolve> for Specialised {
    fn from(of: LightResolve) -> Self {
        Self { shader: &LIGHT_RESOLVE, constants: vec![
            u32::from(of.sum_has_colour),
            u32::from(of.albedo_is_map),
            u32::from(of.adds_to_radiance),
            u32::from(of.writes_layer),
            u32::from(of.grey),
            u32::from(of.relights),
            u32::from(of.colour_is_texel),
        ] }
    }
}

/// `shaders_glsl/view/map_draw.comp`.
pub const MAP_DRAW: Shader = Shader {
    name: "map_draw",
    push_bytes: 36,
    bindings: &[
        Binding { binding: 0, name: "radiance", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "tone_steps", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "voids", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 3, name: "picture", kind: BindingKind::StorageImage { format: "R32ui", uint: true, layered: false }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "grey" },
        Constant { id: 1, name: "has_voids" },
    ],
    words: words_at(112554, 1576),
};

/// `shaders_glsl/view/map_draw.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MapDraw {
    /// `GREY`, by default false.
    pub grey: bool,
    /// `HAS_VOIDS`, by default false.
    pub has_voids: bool,
}

impl From<MapDraw> for Specialised {
    fn from(of: MapDraw) -> Self {
        Self { shader: &MAP_DRAW, constants: vec![
            u32::from(of.grey),
            u32::from(of.has_voids),
        ] }
    }
}

/// `shaders_glsl/reference/path_trace.comp`.
pub const PATH_TRACE: Shader = Shader {
    name: "path_trace",
    push_bytes: 120,
    bindings: &[
        Binding { binding: 0, name: "cells", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "maxima", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "ground", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 3, name: "lights", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 4, name: "environment", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 5, name: "environment_cdf", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 6, name: "albedo_map", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 7, name: "batch_mean", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 8, name: "batch_spread", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 9, name: "radiance", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 10, name: "standard_error", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 11, name: "lost_rays", kind: BindingKind::StorageBuffer, written: true },
        Binding { binding: 12, name: "part_sum", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 13, name: "phong_map", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 14, name: "places", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
    ],
    constants: &[
        Constant { id: 0, name: "border" },
        Constant { id: 1, name: "thin_rows" },
        Constant { id: 2, name: "set_bits" },
        Constant { id: 3, name: "albedo_is_map" },
        Constant { id: 4, name: "has_environment" },
        Constant { id: 5, name: "has_specular" },
        Constant { id: 6, name: "thin_cols" },
        Constant { id: 7, name: "has_lights" },
        Constant { id: 8, name: "has_sphere_lights" },
        Constant { id: 9, name: "has_bounces" },
        Constant { id: 10, name: "most_steps" },
        Constant { id: 11, name: "has_keys" },
        Constant { id: 12, name: "in_parts" },
        Constant { id: 13, name: "specular_is_map" },
        Constant { id: 14, name: "at_places" },
    ],
    words: words_at(114130, 22914),
};

/// `shaders_glsl/reference/path_trace.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathTrace {
    /// `BORDER`, by default 0.
    pub border: u32,
    /// `THIN_ROWS`, by default false.
    pub thin_rows: bool,
    /// `SET_BITS`, by default 4.
    pub set_bits: u32,
    /// `ALBEDO_IS_MAP`, by default false.
    pub albedo_is_map: bool,
    /// `HAS_ENVIRONMENT`, by default false.
    pub has_environment: bool,
    /// `HAS_SPECULAR`, by default false.
    pub has_specular: bool,
    /// `THIN_COLS`, by default false.
    pub thin_cols: bool,
    /// `HAS_LIGHTS`, by default false.
    pub has_lights: bool,
    /// `HAS_SPHERE_LIGHTS`, by default false.
    pub has_sphere_lights: bool,
    /// `HAS_BOUNCES`, by default false.
    pub has_bounces: bool,
    /// `MOST_STEPS`, by default 60000.
    pub most_steps: i32,
    /// `HAS_KEYS`, by default false.
    pub has_keys: bool,
    /// `IN_PARTS`, by default false.
    pub in_parts: bool,
    /// `SPECULAR_IS_MAP`, by default false.
    pub specular_is_map: bool,
    /// `AT_PLACES`, by default false.
    pub at_places: bool,
}

impl Default for PathTrace {
    fn default() -> Self {
        Self {
            border: 0,
            thin_rows: false,
            set_bits: 4,
            albedo_is_map: false,
            has_environment: false,
            has_specular: false,
            thin_cols: false,
            has_lights: false,
            has_sphere_lights: false,
            has_bounces: false,
            most_steps: 60000,
            has_keys: false,
            in_parts: false,
            specular_is_map: false,
            at_places: false,
        }
    }
}

impl From<PathTrace> for Specialised {
    fn from(of: PathTrace) -> Self {
        Self { shader: &PATH_TRACE, constants: vec![
            of.border,
            u32::from(of.thin_rows),
            of.set_bits,
            u32::from(of.albedo_is_map),
            u32::from(of.has_environment),
            u32::from(of.has_specular),
            u32::from(of.thin_cols),
            u32::from(of.has_lights),
            u32::from(of.has_sphere_lights),
            u32::from(of.has_bounces),
            of.most_steps as u32,
            u32::from(of.has_keys),
            u32::from(of.in_parts),
            u32::from(of.specular_is_map),
            u32::from(of.at_places),
        ] }
    }
}

/// `shaders_glsl/view/picture_tone.frag`.
pub const PICTURE_TONE_FRAG: Shader = Shader {
    name: "picture_tone_frag",
    push_bytes: 4,
    bindings: &[
        Binding { binding: 0, name: "radiance", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
    ],
    constants: &[
        Constant { id: 0, name: "encodes" },
    ],
    words: words_at(137044, 455),
};

/// `shaders_glsl/view/picture_tone.frag` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PictureToneFrag {
    /// `ENCODES`, by default true.
    pub encodes: bool,
}

impl Default for PictureToneFrag {
    fn default() -> Self {
        Self {
            encodes: true,
        }
    }
}

impl From<PictureToneFrag> for Specialised {
    fn from(of: PictureToneFrag) -> Self {
        Self { shader: &PICTURE_TONE_FRAG, constants: vec![
            u32::from(of.encodes),
        ] }
    }
}

/// `shaders_glsl/view/picture_tone.vert`.
pub const PICTURE_TONE_VERT: Shader = Shader {
    name: "picture_tone_vert",
    push_bytes: 0,
    bindings: &[
    ],
    constants: &[
    ],
    words: words_at(137499, 266),
};

/// `shaders_glsl/view/picture_tone.vert` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PictureToneVert;

impl From<PictureToneVert> for Specialised {
    fn from(_: PictureToneVert) -> Self {
        Self { shader: &PICTURE_TONE_VERT, constants: vec![
        ] }
    }
}

/// `shaders_glsl/horizon/pyramid_march.comp`.
pub const PYRAMID_MARCH: Shader = Shader {
    name: "pyramid_march",
    push_bytes: 32,
    bindings: &[
        Binding { binding: 0, name: "heights", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "azimuths", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 2, name: "slopes", kind: BindingKind::StorageImage { format: "Unknown", uint: true, layered: true }, written: true },
        Binding { binding: 3, name: "height_levels", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 4, name: "level_table", kind: BindingKind::SampledImage { uint: true, layered: false }, written: false },
        Binding { binding: 5, name: "height_stack", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
    ],
    constants: &[
        Constant { id: 0, name: "periodic" },
        Constant { id: 1, name: "stack" },
        Constant { id: 2, name: "levels" },
        Constant { id: 3, name: "node_stride" },
    ],
    words: words_at(137765, 9025),
};

/// `shaders_glsl/horizon/pyramid_march.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PyramidMarch {
    /// `PERIODIC`, by default false.
    pub periodic: bool,
    /// `STACK`, by default false.
    pub stack: bool,
    /// `LEVELS`, by default 0.
    pub levels: i32,
    /// `NODE_STRIDE`, by default 1.
    pub node_stride: i32,
}

impl Default for PyramidMarch {
    fn default() -> Self {
        Self {
            periodic: false,
            stack: false,
            levels: 0,
            node_stride: 1,
        }
    }
}

impl From<PyramidMarch> for Specialised {
    fn from(of: PyramidMarch) -> Self {
        Self { shader: &PYRAMID_MARCH, constants: vec![
            u32::from(of.periodic),
            u32::from(of.stack),
            of.levels as u32,
            of.node_stride as u32,
        ] }
    }
}

/// `shaders_glsl/bake/scatter_gather.comp`.
pub const SCATTER_GATHER: Shader = Shader {
    name: "scatter_gather",
    push_bytes: 80,
    bindings: &[
        Binding { binding: 0, name: "ground", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "direct", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "visible_points", kind: BindingKind::SampledImage { uint: true, layered: true }, written: false },
        Binding { binding: 3, name: "links", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 4, name: "carried_in", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
        Binding { binding: 5, name: "sun_points", kind: BindingKind::SampledImage { uint: true, layered: true }, written: false },
        Binding { binding: 6, name: "albedo_map", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 7, name: "phong_map", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 8, name: "carried", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: true }, written: true },
        Binding { binding: 9, name: "scattered", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: true }, written: true },
        Binding { binding: 10, name: "bent", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
        Binding { binding: 11, name: "fan_weights", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
    ],
    constants: &[
        Constant { id: 0, name: "source" },
        Constant { id: 1, name: "sums" },
        Constant { id: 2, name: "small" },
        Constant { id: 3, name: "albedo_is_map" },
        Constant { id: 4, name: "has_specular" },
        Constant { id: 5, name: "specular_is_map" },
        Constant { id: 6, name: "bent" },
        Constant { id: 7, name: "direct_specular" },
    ],
    words: words_at(146790, 4664),
};

/// `shaders_glsl/bake/scatter_gather.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScatterGather {
    /// `SOURCE`, by default 1.
    pub source: u32,
    /// `SUMS`, by default false.
    pub sums: bool,
    /// `SMALL`, by default false.
    pub small: bool,
    /// `ALBEDO_IS_MAP`, by default false.
    pub albedo_is_map: bool,
    /// `HAS_SPECULAR`, by default false.
    pub has_specular: bool,
    /// `SPECULAR_IS_MAP`, by default false.
    pub specular_is_map: bool,
    /// `BENT`, by default false.
    pub bent: bool,
    /// `DIRECT_SPECULAR`, by default false.
    pub direct_specular: bool,
}

impl Default for ScatterGather {
    fn default() -> Self {
        Self {
            source: 1,
            sums: false,
            small: false,
            albedo_is_map: false,
            has_specular: false,
            specular_is_map: false,
            bent: false,
            direct_specular: false,
        }
    }
}

impl From<ScatterGather> for Specialised {
    fn from(of: ScatterGather) -> Self {
        Self { shader: &SCATTER_GATHER, constants: vec![
            of.source,
            u32::from(of.sums),
            u32::from(of.small),
            u32::from(of.albedo_is_map),
            u32::from(of.has_specular),
            u32::from(of.specular_is_map),
            u32::from(of.bent),
            u32::from(of.direct_specular),
        ] }
    }
}

/// `shaders_glsl/sh/sh_shade.comp`.
pub const SH_SHADE: Shader = Shader {
    name: "sh_shade",
    push_bytes: 24,
    bindings: &[
        Binding { binding: 0, name: "lane_heights", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "visibility", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
        Binding { binding: 2, name: "light_matrix", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 3, name: "env_sum", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 4, name: "nodes", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: false },
        Binding { binding: 5, name: "phong_map", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
    ],
    constants: &[
        Constant { id: 0, name: "border" },
        Constant { id: 1, name: "marches_rows" },
        Constant { id: 2, name: "order" },
        Constant { id: 3, name: "receiver" },
        Constant { id: 4, name: "node_stride" },
        Constant { id: 5, name: "specular_is_map" },
    ],
    words: words_at(151454, 12958),
};

/// `shaders_glsl/sh/sh_shade.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShShade {
    /// `BORDER`, by default 0.
    pub border: u32,
    /// `MARCHES_ROWS`, by default false.
    pub marches_rows: bool,
    /// `ORDER`, by default 4.
    pub order: i32,
    /// `RECEIVER`, by default 1.
    pub receiver: u32,
    /// `NODE_STRIDE`, by default 1.
    pub node_stride: i32,
    /// `SPECULAR_IS_MAP`, by default false.
    pub specular_is_map: bool,
}

impl Default for ShShade {
    fn default() -> Self {
        Self {
            border: 0,
            marches_rows: false,
            order: 4,
            receiver: 1,
            node_stride: 1,
            specular_is_map: false,
        }
    }
}

impl From<ShShade> for Specialised {
    fn from(of: ShShade) -> Self {
        Self { shader: &SH_SHADE, constants: vec![
            of.border,
            u32::from(of.marches_rows),
            of.order as u32,
            of.receiver,
            of.node_stride as u32,
            u32::from(of.specular_is_map),
        ] }
    }
}

/// `shaders_glsl/sh/sh_visibility.comp`.
pub const SH_VISIBILITY: Shader = Shader {
    name: "sh_visibility",
    push_bytes: 32,
    bindings: &[
        Binding { binding: 0, name: "lane_heights", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "lattice", kind: BindingKind::StorageImage { format: "Rg32ui", uint: true, layered: true }, written: false },
        Binding { binding: 2, name: "azimuths", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 3, name: "visibility", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: true }, written: true },
        Binding { binding: 4, name: "nodes", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 6, name: "dirty_texels", kind: BindingKind::StorageBuffer, written: false },
        Binding { binding: 7, name: "lattice_words", kind: BindingKind::SampledImage { uint: true, layered: true }, written: false },
        Binding { binding: 8, name: "edit_list", kind: BindingKind::StorageBuffer, written: false },
    ],
    constants: &[
        Constant { id: 0, name: "fuse" },
        Constant { id: 1, name: "lattice" },
        Constant { id: 2, name: "line_shift" },
        Constant { id: 3, name: "border" },
        Constant { id: 4, name: "order" },
        Constant { id: 5, name: "by_nlp" },
        Constant { id: 6, name: "marches_rows" },
        Constant { id: 7, name: "own_plane_hides" },
        Constant { id: 8, name: "lane_stride" },
        Constant { id: 9, name: "lattice_stride" },
    ],
    words: words_at(164412, 29808),
};

/// `shaders_glsl/sh/sh_visibility.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShVisibility {
    /// `FUSE`, by default 5.
    pub fuse: u32,
    /// `LATTICE`, by default 0.
    pub lattice: u32,
    /// `LINE_SHIFT`, by default 15.
    pub line_shift: i32,
    /// `BORDER`, by default 0.
    pub border: u32,
    /// `ORDER`, by default 4.
    pub order: i32,
    /// `BY_NLP`, by default false.
    pub by_nlp: bool,
    /// `MARCHES_ROWS`, by default false.
    pub marches_rows: bool,
    /// `OWN_PLANE_HIDES`, by default true.
    pub own_plane_hides: bool,
    /// `LANE_STRIDE`, by default 1.
    pub lane_stride: i32,
    /// `LATTICE_STRIDE`, by default 1.
    pub lattice_stride: i32,
}

impl Default for ShVisibility {
    fn default() -> Self {
        Self {
            fuse: 5,
            lattice: 0,
            line_shift: 15,
            border: 0,
            order: 4,
            by_nlp: false,
            marches_rows: false,
            own_plane_hides: true,
            lane_stride: 1,
            lattice_stride: 1,
        }
    }
}

impl From<ShVisibility> for Specialised {
    fn from(of: ShVisibility) -> Self {
        Self { shader: &SH_VISIBILITY, constants: vec![
            of.fuse,
            of.lattice,
            of.line_shift as u32,
            of.border,
            of.order as u32,
            u32::from(of.by_nlp),
            u32::from(of.marches_rows),
            u32::from(of.own_plane_hides),
            of.lane_stride as u32,
            of.lattice_stride as u32,
        ] }
    }
}

/// `shaders_glsl/sh/sh_wedges.comp`.
pub const SH_WEDGES: Shader = Shader {
    name: "sh_wedges",
    push_bytes: 36,
    bindings: &[
        Binding { binding: 0, name: "lane_heights", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "horizon_angles", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
        Binding { binding: 2, name: "constants", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 3, name: "visibility", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: true }, written: true },
        Binding { binding: 4, name: "nodes", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "border" },
        Constant { id: 1, name: "marches_rows" },
        Constant { id: 2, name: "order" },
        Constant { id: 3, name: "own_plane_hides" },
        Constant { id: 4, name: "lane_stride" },
    ],
    words: words_at(194220, 7777),
};

/// `shaders_glsl/sh/sh_wedges.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShWedges {
    /// `BORDER`, by default 0.
    pub border: u32,
    /// `MARCHES_ROWS`, by default false.
    pub marches_rows: bool,
    /// `ORDER`, by default 4.
    pub order: i32,
    /// `OWN_PLANE_HIDES`, by default true.
    pub own_plane_hides: bool,
    /// `LANE_STRIDE`, by default 1.
    pub lane_stride: i32,
}

impl Default for ShWedges {
    fn default() -> Self {
        Self {
            border: 0,
            marches_rows: false,
            order: 4,
            own_plane_hides: true,
            lane_stride: 1,
        }
    }
}

impl From<ShWedges> for Specialised {
    fn from(of: ShWedges) -> Self {
        Self { shader: &SH_WEDGES, constants: vec![
            of.border,
            u32::from(of.marches_rows),
            of.order as u32,
            u32::from(of.own_plane_hides),
            of.lane_stride as u32,
        ] }
    }
}

/// `shaders_glsl/bounce/shade_expand.comp`.
pub const SHADE_EXPAND: Shader = Shader {
    name: "shade_expand",
    push_bytes: 12,
    bindings: &[
        Binding { binding: 0, name: "shade_levels", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "shade_table", kind: BindingKind::SampledImage { uint: true, layered: false }, written: false },
        Binding { binding: 2, name: "shade_stack", kind: BindingKind::StorageImage { format: "Unknown", uint: false, layered: true }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "periodic" },
    ],
    words: words_at(201997, 2397),
};

/// `shaders_glsl/bounce/shade_expand.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ShadeExpand {
    /// `PERIODIC`, by default false.
    pub periodic: bool,
}

impl From<ShadeExpand> for Specialised {
    fn from(of: ShadeExpand) -> Self {
        Self { shader: &SHADE_EXPAND, constants: vec![
            u32::from(of.periodic),
        ] }
    }
}

/// `shaders_glsl/bounce/shade_reduce.comp`.
pub const SHADE_REDUCE: Shader = Shader {
    name: "shade_reduce",
    push_bytes: 48,
    bindings: &[
        Binding { binding: 0, name: "exit_radiance", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "shade_levels", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 2, name: "shade_table", kind: BindingKind::StorageImage { format: "Rgba32ui", uint: true, layered: false }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "periodic" },
        Constant { id: 1, name: "from_field" },
        Constant { id: 2, name: "grey" },
    ],
    words: words_at(204394, 2919),
};

/// `shaders_glsl/bounce/shade_reduce.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ShadeReduce {
    /// `PERIODIC`, by default false.
    pub periodic: bool,
    /// `FROM_FIELD`, by default false.
    pub from_field: bool,
    /// `GREY`, by default false.
    pub grey: bool,
}

impl From<ShadeReduce> for Specialised {
    fn from(of: ShadeReduce) -> Self {
        Self { shader: &SHADE_REDUCE, constants: vec![
            u32::from(of.periodic),
            u32::from(of.from_field),
            u32::from(of.grey),
        ] }
    }
}

/// `shaders_glsl/view/sky_draw.frag`.
pub const SKY_DRAW_FRAG: Shader = Shader {
    name: "sky_draw_frag",
    push_bytes: 84,
    bindings: &[
        Binding { binding: 0, name: "environment", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
    ],
    constants: &[
        Constant { id: 0, name: "has_environment" },
    ],
    words: words_at(207313, 1269),
};

/// `shaders_glsl/view/sky_draw.frag` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SkyDrawFrag {
    /// `HAS_ENVIRONMENT`, by default false.
    pub has_environment: bool,
}

impl From<SkyDrawFrag> for Specialised {
    fn from(of: SkyDrawFrag) -> Self {
        Self { shader: &SKY_DRAW_FRAG, constants: vec![
            u32::from(of.has_environment),
        ] }
    }
}

/// `shaders_glsl/view/sky_draw.vert`.
pub const SKY_DRAW_VERT: Shader = Shader {
    name: "sky_draw_vert",
    push_bytes: 0,
    bindings: &[
    ],
    constants: &[
    ],
    words: words_at(208582, 289),
};

/// `shaders_glsl/view/sky_draw.vert` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SkyDrawVert;

impl From<SkyDrawVert> for Specialised {
    fn from(_: SkyDrawVert) -> Self {
        Self { shader: &SKY_DRAW_VERT, constants: vec![
        ] }
    }
}

/// `shaders_glsl/direct/sky_shade.comp`.
pub const SKY_SHADE: Shader = Shader {
    name: "sky_shade",
    push_bytes: 32,
    bindings: &[
        Binding { binding: 0, name: "lane_heights", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "lattice", kind: BindingKind::StorageImage { format: "Rg32ui", uint: true, layered: true }, written: false },
        Binding { binding: 2, name: "azimuths", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 3, name: "sky_sum", kind: BindingKind::StorageImage { format: "R32f", uint: false, layered: false }, written: true },
        Binding { binding: 4, name: "env_sum", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 5, name: "env_tables", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: true }, written: false },
        Binding { binding: 6, name: "dirty_texels", kind: BindingKind::StorageBuffer, written: false },
        Binding { binding: 7, name: "lattice_words", kind: BindingKind::SampledImage { uint: true, layered: true }, written: false },
        Binding { binding: 8, name: "edit_list", kind: BindingKind::StorageBuffer, written: false },
    ],
    constants: &[
        Constant { id: 0, name: "fuse" },
        Constant { id: 1, name: "lattice" },
        Constant { id: 2, name: "line_shift" },
        Constant { id: 3, name: "border" },
        Constant { id: 4, name: "has_sky" },
        Constant { id: 5, name: "has_environment" },
        Constant { id: 6, name: "marches_rows" },
        Constant { id: 7, name: "relights" },
    ],
    words: words_at(208871, 22806),
};

/// `shaders_glsl/direct/sky_shade.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SkyShade {
    /// `FUSE`, by default 5.
    pub fuse: u32,
    /// `LATTICE`, by default 0.
    pub lattice: u32,
    /// `LINE_SHIFT`, by default 15.
    pub line_shift: i32,
    /// `BORDER`, by default 0.
    pub border: u32,
    /// `HAS_SKY`, by default true.
    pub has_sky: bool,
    /// `HAS_ENVIRONMENT`, by default false.
    pub has_environment: bool,
    /// `MARCHES_ROWS`, by default false.
    pub marches_rows: bool,
    /// `RELIGHTS`, by default false.
    pub relights: bool,
}

impl Default for SkyShade {
    fn default() -> Self {
        Self {
            fuse: 5,
            lattice: 0,
            line_shift: 15,
            border: 0,
            has_sky: true,
            has_environment: false,
            marches_rows: false,
            relights: false,
        }
    }
}

impl From<SkyShade> for Specialised {
    fn from(of: SkyShade) -> Self {
        Self { shader: &SKY_SHADE, constants: vec![
            of.fuse,
            of.lattice,
            of.line_shift as u32,
            of.border,
            u32::from(of.has_sky),
            u32::from(of.has_environment),
            u32::from(of.marches_rows),
            u32::from(of.relights),
        ] }
    }
}

/// `shaders_glsl/specular/specular_exit.comp`.
pub const SPECULAR_EXIT: Shader = Shader {
    name: "specular_exit",
    push_bytes: 28,
    bindings: &[
        Binding { binding: 0, name: "arriving", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
        Binding { binding: 1, name: "ground", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "exit_radiance", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 3, name: "specular_direct", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 4, name: "phong_map", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 5, name: "constants", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 6, name: "specular_bounced", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 7, name: "exit_vectors", kind: BindingKind::StorageImage { format: "Unknown", uint: false, layered: true }, written: true },
        Binding { binding: 8, name: "exit_upward", kind: BindingKind::StorageImage { format: "Unknown", uint: false, layered: false }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "order" },
        Constant { id: 1, name: "grey" },
        Constant { id: 2, name: "specular_is_map" },
        Constant { id: 3, name: "is_direct" },
        Constant { id: 4, name: "is_bounced" },
        Constant { id: 5, name: "vectors" },
        Constant { id: 6, name: "halves" },
    ],
    words: words_at(231677, 6438),
};

/// `shaders_glsl/specular/specular_exit.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpecularExit {
    /// `ORDER`, by default 4.
    pub order: i32,
    /// `GREY`, by default false.
    pub grey: bool,
    /// `SPECULAR_IS_MAP`, by default false.
    pub specular_is_map: bool,
    /// `IS_DIRECT`, by default false.
    pub is_direct: bool,
    /// `IS_BOUNCED`, by default true.
    pub is_bounced: bool,
    /// `VECTORS`, by default true.
    pub vectors: bool,
    /// `HALVES`, by default false.
    pub halves: bool,
}

impl Default for SpecularExit {
    fn default() -> Self {
        Self {
            order: 4,
            grey: false,
            specular_is_map: false,
            is_direct: false,
            is_bounced: true,
            vectors: true,
            halves: false,
        }
    }
}

impl From<SpecularExit> for Specialised {
    fn from(of: SpecularExit) -> Self {
        Self { shader: &SPECULAR_EXIT, constants: vec![
            of.order as u32,
            u32::from(of.grey),
            u32::from(of.specular_is_map),
            u32::from(of.is_direct),
            u32::from(of.is_bounced),
            u32::from(of.vectors),
            u32::from(of.halves),
        ] }
    }
}

/// `shaders_glsl/bounce/specular_gather.comp`.
pub const SPECULAR_GATHER: Shader = Shader {
    name: "specular_gather",
    push_bytes: 64,
    bindings: &[
        Binding { binding: 0, name: "heights", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "height_levels", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "level_table", kind: BindingKind::SampledImage { uint: true, layered: false }, written: false },
        Binding { binding: 3, name: "height_stack", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
        Binding { binding: 4, name: "ground", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 5, name: "exit_radiance", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 6, name: "shade_levels", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 7, name: "shade_table", kind: BindingKind::SampledImage { uint: true, layered: false }, written: false },
        Binding { binding: 8, name: "bounce_sum", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 9, name: "shade_stack", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
        Binding { binding: 10, name: "exit_vectors", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
        Binding { binding: 11, name: "vector_levels", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
        Binding { binding: 12, name: "arriving", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: true }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "periodic" },
        Constant { id: 1, name: "stack" },
        Constant { id: 2, name: "levels" },
        Constant { id: 3, name: "shade_levels" },
        Constant { id: 4, name: "grey" },
        Constant { id: 5, name: "vectors" },
        Constant { id: 6, name: "order" },
        Constant { id: 7, name: "most_knots" },
    ],
    words: words_at(238115, 20114),
};

/// `shaders_glsl/bounce/specular_gather.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpecularGather {
    /// `PERIODIC`, by default false.
    pub periodic: bool,
    /// `STACK`, by default false.
    pub stack: bool,
    /// `LEVELS`, by default 0.
    pub levels: i32,
    /// `SHADE_LEVELS`, by default 0.
    pub shade_levels: i32,
    /// `GREY`, by default false.
    pub grey: bool,
    /// `VECTORS`, by default true.
    pub vectors: bool,
    /// `ORDER`, by default 4.
    pub order: i32,
    /// `MOST_KNOTS`, by default 64.
    pub most_knots: i32,
}

impl Default for SpecularGather {
    fn default() -> Self {
        Self {
            periodic: false,
            stack: false,
            levels: 0,
            shade_levels: 0,
            grey: false,
            vectors: true,
            order: 4,
            most_knots: 64,
        }
    }
}

impl From<SpecularGather> for Specialised {
    fn from(of: SpecularGather) -> Self {
        Self { shader: &SPECULAR_GATHER, constants: vec![
            u32::from(of.periodic),
            u32::from(of.stack),
            of.levels as u32,
            of.shade_levels as u32,
            u32::from(of.grey),
            u32::from(of.vectors),
            of.order as u32,
            of.most_knots as u32,
        ] }
    }
}

/// `shaders_glsl/specular/specular_visibility.comp`.
pub const SPECULAR_VISIBILITY: Shader = Shader {
    name: "specular_visibility",
    push_bytes: 8,
    bindings: &[
        Binding { binding: 0, name: "visibility", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
        Binding { binding: 1, name: "light_matrix", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "arriving", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: true }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "order" },
        Constant { id: 1, name: "grey" },
    ],
    words: words_at(258229, 1238),
};

/// `shaders_glsl/specular/specular_visibility.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpecularVisibility {
    /// `ORDER`, by default 4.
    pub order: i32,
    /// `GREY`, by default false.
    pub grey: bool,
}

impl Default for SpecularVisibility {
    fn default() -> Self {
        Self {
            order: 4,
            grey: false,
        }
    }
}

impl From<SpecularVisibility> for Specialised {
    fn from(of: SpecularVisibility) -> Self {
        Self { shader: &SPECULAR_VISIBILITY, constants: vec![
            of.order as u32,
            u32::from(of.grey),
        ] }
    }
}

/// `shaders_glsl/direct/sphere_sh_shade.comp`.
pub const SPHERE_SH_SHADE: Shader = Shader {
    name: "sphere_sh_shade",
    push_bytes: 128,
    bindings: &[
        Binding { binding: 0, name: "cells", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "maxima", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "ground", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 3, name: "sphere_sum", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 4, name: "constants", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 5, name: "heights", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 6, name: "height_levels", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 7, name: "level_table", kind: BindingKind::SampledImage { uint: true, layered: false }, written: false },
        Binding { binding: 8, name: "height_stack", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
    ],
    constants: &[
        Constant { id: 0, name: "border" },
        Constant { id: 1, name: "thin_rows" },
        Constant { id: 2, name: "thin_cols" },
        Constant { id: 3, name: "most_steps" },
        Constant { id: 4, name: "order" },
        Constant { id: 5, name: "wedges" },
        Constant { id: 6, name: "own_plane_hides" },
        Constant { id: 7, name: "by_pyramid" },
        Constant { id: 8, name: "stack" },
        Constant { id: 9, name: "levels" },
    ],
    words: words_at(259467, 27590),
};

/// `shaders_glsl/direct/sphere_sh_shade.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SphereShShade {
    /// `BORDER`, by default 0.
    pub border: u32,
    /// `THIN_ROWS`, by default false.
    pub thin_rows: bool,
    /// `THIN_COLS`, by default false.
    pub thin_cols: bool,
    /// `MOST_STEPS`, by default 60000.
    pub most_steps: i32,
    /// `ORDER`, by default 4.
    pub order: i32,
    /// `WEDGES`, by default 0.
    pub wedges: u32,
    /// `OWN_PLANE_HIDES`, by default true.
    pub own_plane_hides: bool,
    /// `BY_PYRAMID`, by default false.
    pub by_pyramid: bool,
    /// `STACK`, by default false.
    pub stack: bool,
    /// `LEVELS`, by default 0.
    pub levels: i32,
}

impl Default for SphereShShade {
    fn default() -> Self {
        Self {
            border: 0,
            thin_rows: false,
            thin_cols: false,
            most_steps: 60000,
            order: 4,
            wedges: 0,
            own_plane_hides: true,
            by_pyramid: false,
            stack: false,
            levels: 0,
        }
    }
}

impl From<SphereShShade> for Specialised {
    fn from(of: SphereShShade) -> Self {
        Self { shader: &SPHERE_SH_SHADE, constants: vec![
            of.border,
            u32::from(of.thin_rows),
            u32::from(of.thin_cols),
            of.most_steps as u32,
            of.order as u32,
            of.wedges,
            u32::from(of.own_plane_hides),
            u32::from(of.by_pyramid),
            u32::from(of.stack),
            of.levels as u32,
        ] }
    }
}

/// `shaders_glsl/direct/sphere_shade.comp`.
pub const SPHERE_SHADE: Shader = Shader {
    name: "sphere_shade",
    push_bytes: 112,
    bindings: &[
        Binding { binding: 0, name: "cells", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "maxima", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "ground", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 3, name: "sphere_sum", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "border" },
        Constant { id: 1, name: "thin_rows" },
        Constant { id: 2, name: "thin_cols" },
        Constant { id: 3, name: "most_steps" },
    ],
    words: words_at(287057, 14302),
};

/// `shaders_glsl/direct/sphere_shade.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SphereShade {
    /// `BORDER`, by default 0.
    pub border: u32,
    /// `THIN_ROWS`, by default false.
    pub thin_rows: bool,
    /// `THIN_COLS`, by default false.
    pub thin_cols: bool,
    /// `MOST_STEPS`, by default 60000.
    pub most_steps: i32,
}

impl Default for SphereShade {
    fn default() -> Self {
        Self {
            border: 0,
            thin_rows: false,
            thin_cols: false,
            most_steps: 60000,
        }
    }
}

impl From<SphereShade> for Specialised {
    fn from(of: SphereShade) -> Self {
        Self { shader: &SPHERE_SHADE, constants: vec![
            of.border,
            u32::from(of.thin_rows),
            u32::from(of.thin_cols),
            of.most_steps as u32,
        ] }
    }
}

/// `shaders_glsl/direct/sun_shade.comp`.
pub const SUN_SHADE: Shader = Shader {
    name: "sun_shade",
    push_bytes: 32,
    bindings: &[
        Binding { binding: 0, name: "lane_heights", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "lattice", kind: BindingKind::StorageImage { format: "Rg32ui", uint: true, layered: true }, written: false },
        Binding { binding: 2, name: "azimuths", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 3, name: "sun_sum", kind: BindingKind::StorageImage { format: "R32f", uint: false, layered: false }, written: true },
        Binding { binding: 6, name: "dirty_texels", kind: BindingKind::StorageBuffer, written: false },
        Binding { binding: 7, name: "lattice_words", kind: BindingKind::SampledImage { uint: true, layered: true }, written: false },
        Binding { binding: 8, name: "edit_list", kind: BindingKind::StorageBuffer, written: false },
    ],
    constants: &[
        Constant { id: 0, name: "fuse" },
        Constant { id: 1, name: "lattice" },
        Constant { id: 2, name: "line_shift" },
        Constant { id: 3, name: "border" },
        Constant { id: 4, name: "shape" },
        Constant { id: 5, name: "marches_rows" },
        Constant { id: 6, name: "relights" },
    ],
    words: words_at(301359, 22088),
};

/// `shaders_glsl/direct/sun_shade.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SunShade {
    /// `FUSE`, by default 5.
    pub fuse: u32,
    /// `LATTICE`, by default 0.
    pub lattice: u32,
    /// `LINE_SHIFT`, by default 15.
    pub line_shift: i32,
    /// `BORDER`, by default 0.
    pub border: u32,
    /// `SHAPE`, by default 0.
    pub shape: u32,
    /// `MARCHES_ROWS`, by default false.
    pub marches_rows: bool,
    /// `RELIGHTS`, by default false.
    pub relights: bool,
}

impl Default for SunShade {
    fn default() -> Self {
        Self {
            fuse: 5,
            lattice: 0,
            line_shift: 15,
            border: 0,
            shape: 0,
            marches_rows: false,
            relights: false,
        }
    }
}

impl From<SunShade> for Specialised {
    fn from(of: SunShade) -> Self {
        Self { shader: &SUN_SHADE, constants: vec![
            of.fuse,
            of.lattice,
            of.line_shift as u32,
            of.border,
            of.shape,
            u32::from(of.marches_rows),
            u32::from(of.relights),
        ] }
    }
}

/// `shaders_glsl/specular/sun_specular.comp`.
pub const SUN_SPECULAR: Shader = Shader {
    name: "sun_specular",
    push_bytes: 56,
    bindings: &[
        Binding { binding: 0, name: "lane_heights", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "sun_sum", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "specular_sum", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: true },
        Binding { binding: 3, name: "phong_map", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 4, name: "arriving", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: true }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "border" },
        Constant { id: 1, name: "marches_rows" },
        Constant { id: 2, name: "specular_is_map" },
        Constant { id: 3, name: "order" },
        Constant { id: 4, name: "grey" },
    ],
    words: words_at(323447, 7945),
};

/// `shaders_glsl/specular/sun_specular.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SunSpecular {
    /// `BORDER`, by default 0.
    pub border: u32,
    /// `MARCHES_ROWS`, by default false.
    pub marches_rows: bool,
    /// `SPECULAR_IS_MAP`, by default false.
    pub specular_is_map: bool,
    /// `ORDER`, by default 0.
    pub order: i32,
    /// `GREY`, by default false.
    pub grey: bool,
}

impl From<SunSpecular> for Specialised {
    fn from(of: SunSpecular) -> Self {
        Self { shader: &SUN_SPECULAR, constants: vec![
            of.border,
            u32::from(of.marches_rows),
            u32::from(of.specular_is_map),
            of.order as u32,
            u32::from(of.grey),
        ] }
    }
}

/// `shaders_glsl/horizon/surface_sweep.comp`.
pub const SURFACE_SWEEP: Shader = Shader {
    name: "surface_sweep",
    push_bytes: 16,
    bindings: &[
        Binding { binding: 0, name: "heights", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "azimuths", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 2, name: "slopes", kind: BindingKind::StorageImage { format: "Unknown", uint: true, layered: true }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "local_size_x" },
        Constant { id: 1, name: "hull_depth" },
        Constant { id: 2, name: "periodic" },
        Constant { id: 3, name: "writes_distances" },
    ],
    words: words_at(331392, 6812),
};

/// `shaders_glsl/horizon/surface_sweep.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfaceSweep {
    /// `LOCAL_SIZE_X`, by default 1.
    pub local_size_x: u32,
    /// `HULL_DEPTH`, by default 1.
    pub hull_depth: i32,
    /// `PERIODIC`, by default false.
    pub periodic: bool,
    /// `WRITES_DISTANCES`, by default false.
    pub writes_distances: bool,
}

impl Default for SurfaceSweep {
    fn default() -> Self {
        Self {
            local_size_x: 1,
            hull_depth: 1,
            periodic: false,
            writes_distances: false,
        }
    }
}

impl From<SurfaceSweep> for Specialised {
    fn from(of: SurfaceSweep) -> Self {
        Self { shader: &SURFACE_SWEEP, constants: vec![
            of.local_size_x,
            of.hull_depth as u32,
            u32::from(of.periodic),
            u32::from(of.writes_distances),
        ] }
    }
}

/// `shaders_glsl/horizon/sweep_fuse.comp`.
pub const SWEEP_FUSE: Shader = Shader {
    name: "sweep_fuse",
    push_bytes: 20,
    bindings: &[
        Binding { binding: 0, name: "lane_heights", kind: BindingKind::StorageImage { format: "Rgba32f", uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "lattice", kind: BindingKind::StorageImage { format: "Rg32ui", uint: true, layered: true }, written: false },
        Binding { binding: 2, name: "azimuths", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 3, name: "horizon_angles", kind: BindingKind::StorageImage { format: "R32f", uint: false, layered: true }, written: true },
        Binding { binding: 4, name: "horizon_distances", kind: BindingKind::StorageImage { format: "R32f", uint: false, layered: true }, written: true },
        Binding { binding: 7, name: "lattice_words", kind: BindingKind::SampledImage { uint: true, layered: true }, written: false },
    ],
    constants: &[
        Constant { id: 0, name: "fuse" },
        Constant { id: 1, name: "lattice" },
        Constant { id: 2, name: "line_shift" },
        Constant { id: 3, name: "border" },
        Constant { id: 4, name: "writes_distances" },
        Constant { id: 5, name: "lattice_has_distances" },
        Constant { id: 6, name: "marches_rows" },
    ],
    words: words_at(338204, 18089),
};

/// `shaders_glsl/horizon/sweep_fuse.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SweepFuse {
    /// `FUSE`, by default 5.
    pub fuse: u32,
    /// `LATTICE`, by default 0.
    pub lattice: u32,
    /// `LINE_SHIFT`, by default 15.
    pub line_shift: i32,
    /// `BORDER`, by default 0.
    pub border: u32,
    /// `WRITES_DISTANCES`, by default false.
    pub writes_distances: bool,
    /// `LATTICE_HAS_DISTANCES`, by default false.
    pub lattice_has_distances: bool,
    /// `MARCHES_ROWS`, by default false.
    pub marches_rows: bool,
}

impl Default for SweepFuse {
    fn default() -> Self {
        Self {
            fuse: 5,
            lattice: 0,
            line_shift: 15,
            border: 0,
            writes_distances: false,
            lattice_has_distances: false,
            marches_rows: false,
        }
    }
}

impl From<SweepFuse> for Specialised {
    fn from(of: SweepFuse) -> Self {
        Self { shader: &SWEEP_FUSE, constants: vec![
            of.fuse,
            of.lattice,
            of.line_shift as u32,
            of.border,
            u32::from(of.writes_distances),
            u32::from(of.lattice_has_distances),
            u32::from(of.marches_rows),
        ] }
    }
}

/// `shaders_glsl/view/terrain_draw.frag`.
pub const TERRAIN_DRAW_FRAG: Shader = Shader {
    name: "terrain_draw_frag",
    push_bytes: 92,
    bindings: &[
        Binding { binding: 1, name: "radiance", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "voids", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
    ],
    constants: &[
        Constant { id: 0, name: "is_grey" },
        Constant { id: 1, name: "has_voids" },
    ],
    words: words_at(356293, 1129),
};

/// `shaders_glsl/view/terrain_draw.frag` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TerrainDrawFrag {
    /// `IS_GREY`, by default false.
    pub is_grey: bool,
    /// `HAS_VOIDS`, by default false.
    pub has_voids: bool,
}

impl From<TerrainDrawFrag> for Specialised {
    fn from(of: TerrainDrawFrag) -> Self {
        Self { shader: &TERRAIN_DRAW_FRAG, constants: vec![
            u32::from(of.is_grey),
            u32::from(of.has_voids),
        ] }
    }
}

/// `shaders_glsl/view/terrain_draw.vert`.
pub const TERRAIN_DRAW_VERT: Shader = Shader {
    name: "terrain_draw_vert",
    push_bytes: 92,
    bindings: &[
        Binding { binding: 0, name: "heights", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
    ],
    constants: &[
    ],
    words: words_at(357422, 916),
};

/// `shaders_glsl/view/terrain_draw.vert` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TerrainDrawVert;

impl From<TerrainDrawVert> for Specialised {
    fn from(_: TerrainDrawVert) -> Self {
        Self { shader: &TERRAIN_DRAW_VERT, constants: vec![
        ] }
    }
}

/// `shaders_glsl/bounce/vector_reduce.comp`.
pub const VECTOR_REDUCE: Shader = Shader {
    name: "vector_reduce",
    push_bytes: 48,
    bindings: &[
        Binding { binding: 0, name: "exit_vectors", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
        Binding { binding: 1, name: "vector_source", kind: BindingKind::SampledImage { uint: false, layered: true }, written: false },
        Binding { binding: 2, name: "vector_levels", kind: BindingKind::StorageImage { format: "Unknown", uint: false, layered: true }, written: true },
        Binding { binding: 3, name: "shade_table", kind: BindingKind::StorageImage { format: "Rgba32ui", uint: true, layered: false }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "periodic" },
        Constant { id: 1, name: "from_field" },
    ],
    words: words_at(358338, 2966),
};

/// `shaders_glsl/bounce/vector_reduce.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct VectorReduce {
    /// `PERIODIC`, by default false.
    pub periodic: bool,
    /// `FROM_FIELD`, by default false.
    pub from_field: bool,
}

impl From<VectorReduce> for Specialised {
    fn from(of: VectorReduce) -> Self {
        Self { shader: &VECTOR_REDUCE, constants: vec![
            u32::from(of.periodic),
            u32::from(of.from_field),
        ] }
    }
}

/// `shaders_glsl/bake/visible_points.comp`.
pub const VISIBLE_POINTS: Shader = Shader {
    name: "visible_points",
    push_bytes: 48,
    bindings: &[
        Binding { binding: 0, name: "cells", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 1, name: "maxima", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 2, name: "ground", kind: BindingKind::SampledImage { uint: false, layered: false }, written: false },
        Binding { binding: 3, name: "directions", kind: BindingKind::TexelBuffer, written: false },
        Binding { binding: 4, name: "visible_points", kind: BindingKind::StorageImage { format: "R32ui", uint: true, layered: true }, written: true },
    ],
    constants: &[
        Constant { id: 0, name: "border" },
        Constant { id: 1, name: "thin_rows" },
        Constant { id: 2, name: "thin_cols" },
        Constant { id: 3, name: "most_steps" },
        Constant { id: 4, name: "small" },
    ],
    words: words_at(361304, 9659),
};

/// `shaders_glsl/bake/visible_points.comp` with its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VisiblePoints {
    /// `BORDER`, by default 0.
    pub border: u32,
    /// `THIN_ROWS`, by default false.
    pub thin_rows: bool,
    /// `THIN_COLS`, by default false.
    pub thin_cols: bool,
    /// `MOST_STEPS`, by default 60000.
    pub most_steps: i32,
    /// `SMALL`, by default false.
    pub small: bool,
}

impl Default for VisiblePoints {
    fn default() -> Self {
        Self {
            border: 0,
            thin_rows: false,
            thin_cols: false,
            most_steps: 60000,
            small: false,
        }
    }
}

impl From<VisiblePoints> for Specialised {
    fn from(of: VisiblePoints) -> Self {
        Self { shader: &VISIBLE_POINTS, constants: vec![
            of.border,
            u32::from(of.thin_rows),
            u32::from(of.thin_cols),
            of.most_steps as u32,
            u32::from(of.small),
        ] }
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
pub mod offsets {
    /// `BentDirectionsPush`.
    pub mod bent_directions_push {
        /// Bytes.
        pub const CELL_X_M: usize = 20;
        /// Bytes.
        pub const CELL_Y_M: usize = 24;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const CURVATURE_X: usize = 28;
        /// Bytes.
        pub const CURVATURE_Y: usize = 32;
        /// Bytes.
        pub const FIRST_DIRECTION: usize = 16;
        /// Bytes.
        pub const FIRST_FAN: usize = 12;
        /// Bytes.
        pub const FIRST_TEXEL: usize = 8;
        /// Bytes.
        pub const ROWS: usize = 4;
    }
    /// `BounceGatherPush`.
    pub mod bounce_gather_push {
        /// Bytes.
        pub const AZIMUTHS: usize = 16;
        /// Bytes.
        pub const CELL_X_M: usize = 8;
        /// Bytes.
        pub const CELL_Y_M: usize = 12;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const FINE_SAMPLES: usize = 36;
        /// Bytes.
        pub const FIRST_AZIMUTH: usize = 20;
        /// Bytes.
        pub const GROWTH: usize = 44;
        /// Bytes.
        pub const LAST_AZIMUTH: usize = 24;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const SHADE_FINE: usize = 48;
        /// Bytes.
        pub const SHADE_SHIFT: usize = 52;
        /// Bytes.
        pub const STEP_HEIGHT: usize = 60;
        /// Bytes.
        pub const STEP_SHADE: usize = 56;
        /// Bytes.
        pub const WARM_UP_COLS: usize = 28;
        /// Bytes.
        pub const WARM_UP_ROWS: usize = 32;
        /// Bytes.
        pub const WIDTH_SHIFT: usize = 40;
    }
    /// `BounceMarchPush`.
    pub mod bounce_march_push {
        /// Bytes.
        pub const AZIMUTHS: usize = 32;
        /// Bytes.
        pub const CELL_X_M: usize = 24;
        /// Bytes.
        pub const CELL_Y_M: usize = 28;
        /// Bytes.
        pub const CELLS_X: usize = 8;
        /// Bytes.
        pub const CELLS_Y: usize = 12;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const FIRST_AZIMUTH: usize = 36;
        /// Bytes.
        pub const LAST_AZIMUTH: usize = 40;
        /// Bytes.
        pub const PADDED_ROWS: usize = 16;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const TOP_LEVEL: usize = 20;
    }
    /// `BounceShadePush`.
    pub mod bounce_shade_push {
        /// Bytes.
        pub const CELL_X_M: usize = 8;
        /// Bytes.
        pub const CELL_Y_M: usize = 12;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const ROWS: usize = 4;
    }
    /// `BounceWalkPush`.
    pub mod bounce_walk_push {
        /// Bytes.
        pub const AZIMUTH_COUNT: usize = 24;
        /// Bytes.
        pub const BEGIN: usize = 36;
        /// Bytes.
        pub const CELL_X_M: usize = 8;
        /// Bytes.
        pub const CELL_Y_M: usize = 12;
        /// Bytes.
        pub const CLEARS: usize = 28;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const FIRST_AZIMUTH: usize = 20;
        /// Bytes.
        pub const IS_LAST: usize = 32;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const WARM_UP: usize = 16;
    }
    /// `CacheGatherPush`.
    pub mod cache_gather_push {
        /// Bytes.
        pub const BEGIN: usize = 8;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const COUNT: usize = 12;
        /// Bytes.
        pub const ROWS: usize = 4;
    }
    /// `DirtyListPush`.
    pub mod dirty_list_push {
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const ROWS: usize = 4;
    }
    /// `DirtyMarkPush`.
    pub mod dirty_mark_push {
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const FIRST_COL: usize = 8;
        /// Bytes.
        pub const FIRST_ROW: usize = 12;
        /// Bytes.
        pub const LAST_COL: usize = 16;
        /// Bytes.
        pub const LAST_ROW: usize = 20;
        /// Bytes.
        pub const ROWS: usize = 4;
    }
    /// `DirtyTexels`.
    pub mod dirty_texels {
        /// Bytes.
        pub const DIRTY_TEXELS: usize = 0;
    }
    /// `EditList`.
    pub mod edit_list {
        /// Bytes.
        pub const DIRTY_WORDS: usize = 32;
        /// Bytes.
        pub const LIGHT_GROUPS: usize = 8;
        /// Bytes.
        pub const RESOLVE_GROUPS: usize = 20;
        /// Bytes.
        pub const SWEPT_STEPS: usize = 0;
        /// Bytes.
        pub const WORD_COUNT: usize = 4;
    }
    /// `EllipseFitPush`.
    pub mod ellipse_fit_push {
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const END_DIRECTION: usize = 12;
        /// Bytes.
        pub const FIRST_DIRECTION: usize = 8;
        /// Bytes.
        pub const FIRST_ROW: usize = 16;
        /// Bytes.
        pub const LEAST_RADIUS: usize = 20;
        /// Bytes.
        pub const ROWS: usize = 4;
    }
    /// `EnvRotation`.
    pub mod env_rotation {
        /// Bytes.
        pub const ENV_ROTATION: usize = 0;
    }
    /// `EnvRotationPush`.
    pub mod env_rotation_push {
        /// Bytes.
        pub const COLUMN_FIRST: usize = 12;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const TURNS: usize = 8;
        /// Bytes.
        pub const WIDTH: usize = 0;
    }
    /// `EnvTablesPush`.
    pub mod env_tables_push {
        /// Bytes.
        pub const AZIMUTH_COUNT: usize = 12;
        /// Bytes.
        pub const BOTTOM_RAD: usize = 16;
        /// Bytes.
        pub const HEIGHT: usize = 0;
        /// Bytes.
        pub const NODES: usize = 8;
        /// Bytes.
        pub const ROWS: usize = 4;
    }
    /// `EnvWedgesPush`.
    pub mod env_wedges_push {
        /// Bytes.
        pub const ROTATION_RAD: usize = 8;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const WIDTH: usize = 0;
    }
    /// `FacetMaskPush`.
    pub mod facet_mask_push {
        /// Bytes.
        pub const CELL_X_M: usize = 24;
        /// Bytes.
        pub const CELL_Y_M: usize = 28;
        /// Bytes.
        pub const CELLS_X: usize = 8;
        /// Bytes.
        pub const CELLS_Y: usize = 12;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const END_DIRECTION: usize = 44;
        /// Bytes.
        pub const FIRST_DIRECTION: usize = 40;
        /// Bytes.
        pub const FIRST_LAYER: usize = 36;
        /// Bytes.
        pub const HIGHEST_M: usize = 32;
        /// Bytes.
        pub const PADDED_ROWS: usize = 16;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const TOP_LEVEL: usize = 20;
    }
    /// `FanWeightsPush`.
    pub mod fan_weights_push {
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const FIRST_DIRECTION: usize = 12;
        /// Bytes.
        pub const FIRST_FAN: usize = 8;
        /// Bytes.
        pub const ROWS: usize = 4;
    }
    /// `HeightBoundsPush`.
    pub mod height_bounds_push {
        /// Bytes.
        pub const CELLS_X: usize = 0;
        /// Bytes.
        pub const CELLS_Y: usize = 4;
        /// Bytes.
        pub const LEVEL: usize = 12;
        /// Bytes.
        pub const PADDED_ROWS: usize = 8;
    }
    /// `HeightCellsPush`.
    pub mod height_cells_push {
        /// Bytes.
        pub const CELL_X_M: usize = 8;
        /// Bytes.
        pub const CELL_Y_M: usize = 12;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const ROWS: usize = 4;
    }
    /// `HeightExpandPush`.
    pub mod height_expand_push {
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const WIDTH_SHIFT: usize = 8;
    }
    /// `HeightReducePush`.
    pub mod height_reduce_push {
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const FIRST: usize = 8;
        /// Bytes.
        pub const LEVEL: usize = 40;
        /// Bytes.
        pub const PER_GRID_POINT_X: usize = 32;
        /// Bytes.
        pub const PER_GRID_POINT_Y: usize = 36;
        /// Bytes.
        pub const RATIO_X: usize = 24;
        /// Bytes.
        pub const RATIO_Y: usize = 28;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const SOURCE_COLS: usize = 12;
        /// Bytes.
        pub const SOURCE_FIRST: usize = 20;
        /// Bytes.
        pub const SOURCE_ROWS: usize = 16;
        /// Bytes.
        pub const WIDTH_SHIFT: usize = 44;
    }
    /// `HeightTransposePush`.
    pub mod height_transpose_push {
        /// Bytes.
        pub const FIRST_COL: usize = 8;
        /// Bytes.
        pub const FIRST_ROW: usize = 12;
        /// Bytes.
        pub const LANES: usize = 0;
        /// Bytes.
        pub const LAST_COL: usize = 16;
        /// Bytes.
        pub const LAST_ROW: usize = 20;
        /// Bytes.
        pub const STEPS: usize = 4;
    }
    /// `HorizonResweepPush`.
    pub mod horizon_resweep_push {
        /// Bytes.
        pub const FIRST_AZIMUTH: usize = 8;
        /// Bytes.
        pub const FIRST_COL: usize = 16;
        /// Bytes.
        pub const FIRST_ROW: usize = 20;
        /// Bytes.
        pub const HEIGHT_SCALE: usize = 12;
        /// Bytes.
        pub const LANES: usize = 0;
        /// Bytes.
        pub const LAST_COL: usize = 24;
        /// Bytes.
        pub const LAST_ROW: usize = 28;
        /// Bytes.
        pub const STEPS: usize = 4;
    }
    /// `HorizonSweepPush`.
    pub mod horizon_sweep_push {
        /// Bytes.
        pub const FIRST_AZIMUTH: usize = 12;
        /// Bytes.
        pub const HEIGHT_SCALE: usize = 16;
        /// Bytes.
        pub const LANES: usize = 0;
        /// Bytes.
        pub const STEPS: usize = 4;
        /// Bytes.
        pub const WARM_UP: usize = 8;
    }
    /// `LightMatrixPush`.
    pub mod light_matrix_push {
        /// Bytes.
        pub const LIGHT_ORDER: usize = 4;
        /// Bytes.
        pub const MATRIX_FIRST: usize = 20;
        /// Bytes.
        pub const ORDER: usize = 8;
        /// Bytes.
        pub const RECEIVERS: usize = 12;
        /// Bytes.
        pub const ROW_FIRST: usize = 16;
        /// Bytes.
        pub const ROWS: usize = 0;
        /// Bytes.
        pub const SKY: usize = 32;
    }
    /// `LightResolvePush`.
    pub mod light_resolve_push {
        /// Bytes.
        pub const CLEARS: usize = 8;
        /// Bytes.
        pub const COLOUR: usize = 16;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const TEXEL: usize = 12;
    }
    /// `LostLines`.
    pub mod lost_lines {
        /// Bytes.
        pub const LOST_LINES: usize = 0;
    }
    /// `LostRays`.
    pub mod lost_rays {
        /// Bytes.
        pub const LOST_RAYS: usize = 0;
    }
    /// `MapDrawPush`.
    pub mod map_draw_push {
        /// Bytes.
        pub const BEYOND: usize = 32;
        /// Bytes.
        pub const COLS: usize = 8;
        /// Bytes.
        pub const FIRST_COL: usize = 16;
        /// Bytes.
        pub const FIRST_ROW: usize = 20;
        /// Bytes.
        pub const GRID_POINTS_PER_PIXEL: usize = 24;
        /// Bytes.
        pub const HEIGHT: usize = 4;
        /// Bytes.
        pub const ROWS: usize = 12;
        /// Bytes.
        pub const SWAPS: usize = 28;
        /// Bytes.
        pub const WIDTH: usize = 0;
    }
    /// `MarchPush`.
    pub mod march_push {
        /// Bytes.
        pub const FIRST_AZIMUTH: usize = 12;
        /// Bytes.
        pub const LANES: usize = 0;
        /// Bytes.
        pub const STEPS: usize = 4;
        /// Bytes.
        pub const WARM_UP: usize = 8;
    }
    /// `PathTracePush`.
    pub mod path_trace_push {
        /// Bytes.
        pub const ALBEDO: usize = 64;
        /// Bytes.
        pub const BOUNCES: usize = 48;
        /// Bytes.
        pub const CELL_X_M: usize = 24;
        /// Bytes.
        pub const CELL_Y_M: usize = 28;
        /// Bytes.
        pub const CELLS_X: usize = 8;
        /// Bytes.
        pub const CELLS_Y: usize = 12;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const EXPONENT: usize = 40;
        /// Bytes.
        pub const FIRST_LIGHT: usize = 112;
        /// Bytes.
        pub const FIRST_PATH: usize = 104;
        /// Bytes.
        pub const FIRST_ROW: usize = 96;
        /// Bytes.
        pub const HIGHEST_M: usize = 32;
        /// Bytes.
        pub const KEYS: usize = 100;
        /// Bytes.
        pub const LAST_LIGHT: usize = 116;
        /// Bytes.
        pub const LAST_PATH: usize = 108;
        /// Bytes.
        pub const LIGHT_COUNT: usize = 56;
        /// Bytes.
        pub const PADDED_ROWS: usize = 16;
        /// Bytes.
        pub const ROTATION_TURNS: usize = 36;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const SEED: usize = 60;
        /// Bytes.
        pub const SKY: usize = 80;
        /// Bytes.
        pub const SPECULAR_SCALE: usize = 44;
        /// Bytes.
        pub const SUNS: usize = 52;
        /// Bytes.
        pub const TOP_LEVEL: usize = 20;
    }
    /// `PictureTonePush`.
    pub mod picture_tone_push {
        /// Bytes.
        pub const EXPOSURE: usize = 0;
    }
    /// `PyramidMarchPush`.
    pub mod pyramid_march_push {
        /// Bytes.
        pub const AZIMUTH_COUNT: usize = 16;
        /// Bytes.
        pub const FINE_SAMPLES: usize = 20;
        /// Bytes.
        pub const FIRST_AZIMUTH: usize = 12;
        /// Bytes.
        pub const GROWTH: usize = 28;
        /// Bytes.
        pub const LANES: usize = 0;
        /// Bytes.
        pub const STEPS: usize = 4;
        /// Bytes.
        pub const WARM_UP: usize = 8;
        /// Bytes.
        pub const WIDTH_SHIFT: usize = 24;
    }
    /// `ScatterGatherPush`.
    pub mod scatter_gather_push {
        /// Bytes.
        pub const ALBEDO: usize = 64;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const CURVATURE_X: usize = 56;
        /// Bytes.
        pub const CURVATURE_Y: usize = 60;
        /// Bytes.
        pub const EXPONENT: usize = 44;
        /// Bytes.
        pub const FIRST_DIRECTION: usize = 28;
        /// Bytes.
        pub const FIRST_LINK: usize = 8;
        /// Bytes.
        pub const FIRST_PATH: usize = 20;
        /// Bytes.
        pub const FIRST_SUN: usize = 32;
        /// Bytes.
        pub const FIRST_VIEW: usize = 52;
        /// Bytes.
        pub const PATHS: usize = 24;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const SPECULAR_SCALE: usize = 48;
        /// Bytes.
        pub const STEP: usize = 16;
        /// Bytes.
        pub const STEPS: usize = 12;
        /// Bytes.
        pub const SUNS: usize = 36;
        /// Bytes.
        pub const WEIGHT_SR: usize = 40;
    }
    /// `ShShadePush`.
    pub mod sh_shade_push {
        /// Bytes.
        pub const CELL_X_M: usize = 8;
        /// Bytes.
        pub const CELL_Y_M: usize = 12;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const SPECULAR: usize = 16;
    }
    /// `ShWedgesPush`.
    pub mod sh_wedges_push {
        /// Bytes.
        pub const AZIMUTH_COUNT: usize = 16;
        /// Bytes.
        pub const AZIMUTH_FIRST: usize = 20;
        /// Bytes.
        pub const CELL_X_M: usize = 8;
        /// Bytes.
        pub const CELL_Y_M: usize = 12;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const LOWEST_RAD: usize = 32;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const SIDE: usize = 28;
        /// Bytes.
        pub const TABLE_FIRST: usize = 24;
    }
    /// `ShadeExpandPush`.
    pub mod shade_expand_push {
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const WIDTH_SHIFT: usize = 8;
    }
    /// `ShadePush`.
    pub mod shade_push {
        /// Bytes.
        pub const AZIMUTH_COUNT: usize = 24;
        /// Bytes.
        pub const CELL_X_M: usize = 8;
        /// Bytes.
        pub const CELL_Y_M: usize = 12;
        /// Bytes.
        pub const CLEARS: usize = 28;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const FIRST_AZIMUTH: usize = 20;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const WARM_UP: usize = 16;
    }
    /// `ShadeReducePush`.
    pub mod shade_reduce_push {
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const FIRST: usize = 8;
        /// Bytes.
        pub const LEVEL: usize = 40;
        /// Bytes.
        pub const PER_GRID_POINT_X: usize = 32;
        /// Bytes.
        pub const PER_GRID_POINT_Y: usize = 36;
        /// Bytes.
        pub const RATIO_X: usize = 24;
        /// Bytes.
        pub const RATIO_Y: usize = 28;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const SOURCE_COLS: usize = 12;
        /// Bytes.
        pub const SOURCE_FIRST: usize = 20;
        /// Bytes.
        pub const SOURCE_ROWS: usize = 16;
        /// Bytes.
        pub const WIDTH_SHIFT: usize = 44;
    }
    /// `SkyDrawPush`.
    pub mod sky_draw_push {
        /// Bytes.
        pub const ABOVE: usize = 48;
        /// Bytes.
        pub const BELOW: usize = 64;
        /// Bytes.
        pub const DOWN: usize = 32;
        /// Bytes.
        pub const FORWARD: usize = 0;
        /// Bytes.
        pub const RIGHT: usize = 16;
        /// Bytes.
        pub const ROTATION_TURNS: usize = 80;
    }
    /// `SpecularExitPush`.
    pub mod specular_exit_push {
        /// Bytes.
        pub const BEGINS: usize = 8;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const EXPONENT: usize = 20;
        /// Bytes.
        pub const FIRST_TEXEL: usize = 12;
        /// Bytes.
        pub const FOURS: usize = 16;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const SCALE: usize = 24;
    }
    /// `SpecularGatherPush`.
    pub mod specular_gather_push {
        /// Bytes.
        pub const AZIMUTHS: usize = 16;
        /// Bytes.
        pub const CELL_X_M: usize = 8;
        /// Bytes.
        pub const CELL_Y_M: usize = 12;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const FINE_SAMPLES: usize = 36;
        /// Bytes.
        pub const FIRST_AZIMUTH: usize = 20;
        /// Bytes.
        pub const GROWTH: usize = 44;
        /// Bytes.
        pub const LAST_AZIMUTH: usize = 24;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const SHADE_FINE: usize = 48;
        /// Bytes.
        pub const SHADE_SHIFT: usize = 52;
        /// Bytes.
        pub const STEP_HEIGHT: usize = 60;
        /// Bytes.
        pub const STEP_SHADE: usize = 56;
        /// Bytes.
        pub const WARM_UP_COLS: usize = 28;
        /// Bytes.
        pub const WARM_UP_ROWS: usize = 32;
        /// Bytes.
        pub const WIDTH_SHIFT: usize = 40;
    }
    /// `SpecularVisibilityPush`.
    pub mod specular_visibility_push {
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const ROWS: usize = 4;
    }
    /// `SphereShShadePush`.
    pub mod sphere_sh_shade_push {
        /// Bytes.
        pub const AZIMUTHS: usize = 68;
        /// Bytes.
        pub const BASE: usize = 40;
        /// Bytes.
        pub const CELL_X_M: usize = 24;
        /// Bytes.
        pub const CELL_Y_M: usize = 28;
        /// Bytes.
        pub const CELLS_X: usize = 8;
        /// Bytes.
        pub const CELLS_Y: usize = 12;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const ENTRY_COUNT: usize = 84;
        /// Bytes.
        pub const ENTRY_FIRST: usize = 80;
        /// Bytes.
        pub const FINE_SAMPLES: usize = 96;
        /// Bytes.
        pub const FIRST: usize = 32;
        /// Bytes.
        pub const FIRST_AZIMUTH: usize = 72;
        /// Bytes.
        pub const GROWTH: usize = 104;
        /// Bytes.
        pub const LAST_AZIMUTH: usize = 76;
        /// Bytes.
        pub const LEVEL_STEP: usize = 108;
        /// Bytes.
        pub const OFFSET: usize = 48;
        /// Bytes.
        pub const PADDED_ROWS: usize = 16;
        /// Bytes.
        pub const RADIANCE: usize = 112;
        /// Bytes.
        pub const RADIUS_M: usize = 60;
        /// Bytes.
        pub const REACH_M: usize = 64;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const SIDE: usize = 92;
        /// Bytes.
        pub const TABLE_FIRST: usize = 88;
        /// Bytes.
        pub const TOP_LEVEL: usize = 20;
        /// Bytes.
        pub const UP_M: usize = 56;
        /// Bytes.
        pub const WIDTH_SHIFT: usize = 100;
    }
    /// `SphereShadePush`.
    pub mod sphere_shade_push {
        /// Bytes.
        pub const BASE: usize = 40;
        /// Bytes.
        pub const CELL_X_M: usize = 24;
        /// Bytes.
        pub const CELL_Y_M: usize = 28;
        /// Bytes.
        pub const CELLS_X: usize = 8;
        /// Bytes.
        pub const CELLS_Y: usize = 12;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const FIRST: usize = 32;
        /// Bytes.
        pub const FIRST_SLICE: usize = 76;
        /// Bytes.
        pub const LAST_SLICE: usize = 80;
        /// Bytes.
        pub const OFFSET: usize = 48;
        /// Bytes.
        pub const PADDED_ROWS: usize = 16;
        /// Bytes.
        pub const RADIANCE: usize = 96;
        /// Bytes.
        pub const RADIUS_M: usize = 60;
        /// Bytes.
        pub const REACH_M: usize = 64;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const SLICES: usize = 68;
        /// Bytes.
        pub const SLICES_AROUND: usize = 72;
        /// Bytes.
        pub const TOP_LEVEL: usize = 20;
        /// Bytes.
        pub const UP_M: usize = 56;
    }
    /// `SunSpecularPush`.
    pub mod sun_specular_push {
        /// Bytes.
        pub const CELL_X_M: usize = 8;
        /// Bytes.
        pub const CELL_Y_M: usize = 12;
        /// Bytes.
        pub const COLOUR: usize = 32;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const SPECULAR: usize = 48;
        /// Bytes.
        pub const TOWARDS: usize = 16;
    }
    /// `SweepFusePush`.
    pub mod sweep_fuse_push {
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const FIRST_AZIMUTH: usize = 12;
        /// Bytes.
        pub const FIRST_LAYER: usize = 16;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const WARM_UP: usize = 8;
    }
    /// `TerrainDrawPush`.
    pub mod terrain_draw_push {
        /// Bytes.
        pub const CLIP_AT_ORIGIN: usize = 48;
        /// Bytes.
        pub const CLIP_PER_COL: usize = 0;
        /// Bytes.
        pub const CLIP_PER_METRE: usize = 32;
        /// Bytes.
        pub const CLIP_PER_ROW: usize = 16;
        /// Bytes.
        pub const COLS: usize = 76;
        /// Bytes.
        pub const MESH_STEP: usize = 84;
        /// Bytes.
        pub const ORIGIN_COL: usize = 64;
        /// Bytes.
        pub const ORIGIN_M: usize = 72;
        /// Bytes.
        pub const ORIGIN_ROW: usize = 68;
        /// Bytes.
        pub const ROWS: usize = 80;
        /// Bytes.
        pub const TILES_ACROSS: usize = 88;
    }
    /// `VectorReducePush`.
    pub mod vector_reduce_push {
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const FIRST: usize = 8;
        /// Bytes.
        pub const LEVEL: usize = 40;
        /// Bytes.
        pub const PER_GRID_POINT_X: usize = 32;
        /// Bytes.
        pub const PER_GRID_POINT_Y: usize = 36;
        /// Bytes.
        pub const RATIO_X: usize = 24;
        /// Bytes.
        pub const RATIO_Y: usize = 28;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const SOURCE_COLS: usize = 12;
        /// Bytes.
        pub const SOURCE_FIRST: usize = 20;
        /// Bytes.
        pub const SOURCE_ROWS: usize = 16;
        /// Bytes.
        pub const WIDTH_SHIFT: usize = 44;
    }
    /// `VisiblePointsPush`.
    pub mod visible_points_push {
        /// Bytes.
        pub const CELL_X_M: usize = 24;
        /// Bytes.
        pub const CELL_Y_M: usize = 28;
        /// Bytes.
        pub const CELLS_X: usize = 8;
        /// Bytes.
        pub const CELLS_Y: usize = 12;
        /// Bytes.
        pub const COLS: usize = 0;
        /// Bytes.
        pub const END_DIRECTION: usize = 44;
        /// Bytes.
        pub const FIRST_DIRECTION: usize = 40;
        /// Bytes.
        pub const FIRST_LAYER: usize = 36;
        /// Bytes.
        pub const HIGHEST_M: usize = 32;
        /// Bytes.
        pub const PADDED_ROWS: usize = 16;
        /// Bytes.
        pub const ROWS: usize = 4;
        /// Bytes.
        pub const TOP_LEVEL: usize = 20;
    }
    /// `WedgeRows`.
    pub mod wedge_rows {
        /// Bytes.
        pub const WEDGE_ROWS: usize = 0;
    }
}

/// Words of all shaders together.
const WORD_COUNT: usize = 370963;

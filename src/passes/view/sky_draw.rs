use crate::graph::shaders::same_layout;

/// The background behind a field.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct SkyDrawPush {
    pub forward: [f32; 4],
    /// Step to the picture's right edge.
    pub right: [f32; 4],
    /// Step to its lower edge.
    pub down: [f32; 4],
    /// Radiance of directions above horizontal, where the environment is not drawn.
    pub above: [f32; 4],
    /// Radiance of other directions.
    pub below: [f32; 4],
    pub rotation_turns: f32,
}

same_layout!(
    SkyDrawPush,
    sky_draw_push,
    forward = FORWARD,
    right = RIGHT,
    down = DOWN,
    above = ABOVE,
    below = BELOW,
    rotation_turns = ROTATION_TURNS,
);

use crate::graph::shaders::same_layout;

/// Tone curve: radiance to picture values.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct PictureTonePush {
    pub exposure: f32,
}

same_layout!(PictureTonePush, picture_tone_push, exposure = EXPOSURE);

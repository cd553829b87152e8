use crate::gpu::shaders::{self, same_layout};
use crate::plan::{Builder, ResourceId};
use crate::scene::Environment;

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct EnvWedgesPush {
    width: i32,
    height: i32,
    rotation_rad: f32,
}

same_layout!(
    EnvWedgesPush,
    env_wedges_push,
    width = WIDTH,
    height = HEIGHT,
    rotation_rad = ROTATION_RAD,
);

/// The environment summed over each azimuth's wedge, row by row.
pub(crate) fn plan(
    builder: &mut Builder,
    environment: &Environment,
    azimuths: u32,
    [image, directions, rows]: [ResourceId; 3],
) {
    let (width, height) = (environment.width() as u32, environment.height() as u32);
    let texels = u64::from(width) * u64::from(height);
    let turn = environment.rotation_rad().rem_euclid(std::f64::consts::TAU);
    builder.pass(
        &shaders::ENV_WEDGES,
        "",
        "the environment's light in each azimuth's wedge",
        [height.div_ceil(8), azimuths, 1],
        &[],
        &EnvWedgesPush { width: width as i32, height: height as i32, rotation_rad: turn as f32 },
        &[("environment", image), ("azimuths", directions), ("wedge_rows", rows)],
        texels * 16 + u64::from(azimuths) * u64::from(height) * 48,
        texels,
    );
}

use crate::graph::{Builder, Format, Owner, ResourceId, shaders};
use crate::passes::bounces::Bounce;

/// Height and exit radiance of every grid point, side by side for walks.
#[derive(Clone, Copy)]
pub(crate) struct BounceGround {
    image: ResourceId,
    grey: bool,
    size: [u32; 2],
}

impl BounceGround {
    pub(crate) fn make(builder: &mut Builder, size: [u32; 2], grey: bool) -> Self {
        let (format, extent) = (Self::format(grey), [size[0], size[1], 1]);
        let image = builder.image("bounce_ground", Owner::Internal, format, extent, false);
        Self { image, grey, size }
    }

    fn format(grey: bool) -> Format {
        if grey { Format::Rgba16Uint } else { Format::Rgba32Float }
    }

    /// Name and image of the binding.
    pub(crate) fn bound(&self) -> (&'static str, ResourceId) {
        (if self.grey { "grey_ground" } else { "bounce_ground" }, self.image)
    }

    /// Bytes that one grid point takes.
    pub(crate) fn texel_bytes(&self) -> u64 {
        Self::format(self.grey).bytes()
    }

    pub(crate) fn plan(&self, builder: &mut Builder, heights: ResourceId, bounce: &Bounce) {
        let [cols, rows] = self.size;
        let found = u64::from(cols) * u64::from(rows);
        builder.pass(
            shaders::BounceGround { grey: self.grey },
            &bounce.name,
            "so that one load reads height and exit radiance",
            shaders::BOUNCE_GROUND.groups([cols, rows, 1]),
            &shaders::BounceGroundPush { cols: cols as i32, rows: rows as i32 },
            &[
                ("heights", heights),
                (if self.grey { "exit_grey" } else { "exit_radiance" }, bounce.exit),
                self.bound(),
            ],
            found * (4 + if self.grey { 4 } else { 16 } + self.texel_bytes()),
            found,
        );
    }
}

//! Inputs in buffers of the caller's, and the images that they are copied to.

use ash::vk;

use super::super::memory::region;
use super::{ImageArg, ImageState, Renderer};
use crate::graph::{Kind, Owner, Rectangle, Resource, ResourceId};
use crate::{Error, Result};

/// Texels in a caller's buffer for one recording, where [`Plan::take_buffer`] allowed it: row after row, of the
/// format given there. The recording begins with one vkCmdCopyBufferToImage.
///
/// [`Plan::take_buffer`]: crate::plan::Plan::take_buffer
#[derive(Clone, Copy, Debug)]
pub struct BufferArg {
    /// The buffer, with usage TRANSFER_SRC. If of exclusive sharing, it belongs to the host's family.
    pub buffer: vk::Buffer,
    /// Size of the buffer, bytes: nothing beyond is read.
    pub bytes: u64,
    /// Offset of the first texel, bytes: a multiple of the texel size.
    pub offset: u64,
    /// Distance between the starts of rows, bytes: a multiple of the texel size, less than 2^31. 0: rows are
    /// consecutive.
    pub row_bytes: u64,
    /// Stages that used it last, and will use it next.
    pub stage: vk::PipelineStageFlags2,
    /// Accesses that used it last, and will use it next.
    pub access: vk::AccessFlags2,
}

/// An input: an image, or a buffer where the plan allows it.
#[derive(Clone, Copy, Debug)]
pub enum InputArg {
    /// Read directly.
    Image(ImageArg),
    /// Copied first.
    Buffer(BufferArg),
}

impl From<ImageArg> for InputArg {
    fn from(image: ImageArg) -> Self {
        Self::Image(image)
    }
}

impl From<BufferArg> for InputArg {
    fn from(buffer: BufferArg) -> Self {
        Self::Buffer(buffer)
    }
}

/// The renderer's use of callers' buffers.
const READ: (vk::PipelineStageFlags2, vk::AccessFlags2) =
    (vk::PipelineStageFlags2::COPY, vk::AccessFlags2::TRANSFER_READ);

/// An input in a buffer, and the renderer's image for it.
pub(super) struct Taken {
    pub arg: BufferArg,
    image: vk::Image,
    region: vk::BufferImageCopy,
    /// From the first byte to the end of the last that is read.
    range: std::ops::Range<u64>,
}

/// Columns, rows, and bytes per texel of an image.
fn measures(resource: &Resource) -> Option<[u64; 3]> {
    match resource.kind {
        Kind::Image { format, width, height, .. } => {
            Some([width.into(), height.into(), format.bytes()])
        }
        Kind::Buffer { .. } => None,
    }
}

/// The range that is read from a buffer, or why it cannot be.
pub(super) fn check_buffer(arg: &BufferArg, resource: &Resource) -> Result<std::ops::Range<u64>> {
    let name = &resource.name;
    let wrong = |field: &str, found: String, expected: String| {
        Err(Error::setting(format!("{name}: {field}"), found, expected))
    };
    let Some([cols, rows, texel]) = measures(resource) else { return Ok(0..0) };
    if arg.buffer == vk::Buffer::null() {
        return wrong("buffer", "null".into(), "a buffer".into());
    }
    let of_texels = format!("a multiple of {texel}, the bytes of a texel");
    if !arg.offset.is_multiple_of(texel) {
        return wrong("offset", format!("{} bytes", arg.offset), of_texels);
    }
    let row = if arg.row_bytes == 0 { cols * texel } else { arg.row_bytes };
    if !row.is_multiple_of(texel) || row < cols * texel || row > i32::MAX as u64 {
        let least = cols * texel;
        let expected = format!("0, or {of_texels}, from {least} of {cols} columns to 2^31 - 1");
        return wrong("row_bytes", format!("{row} bytes"), expected);
    }
    // No overflow: each factor is less than 2^32.
    let end = arg.offset.saturating_add(row * (rows - 1) + cols * texel);
    if end > arg.bytes {
        let (offset, bytes) = (arg.offset, arg.bytes);
        let expected = format!("{end} or more: {rows} rows of {row} from {offset} on");
        return wrong("bytes", format!("{bytes}"), expected);
    }
    if arg.stage == vk::PipelineStageFlags2::NONE && arg.access != vk::AccessFlags2::NONE {
        let found = format!("NONE, with access {:?}", arg.access);
        return wrong("stage", found, "the stages of this access".into());
    }
    Ok(arg.offset..end)
}

impl Renderer {
    /// The image that an input in a buffer is copied to, as each recording leaves it: for passes of your own
    /// and for a [`ViewRenderer`](crate::gpu::ViewRenderer). Leave it in that state. None for an input in an
    /// image.
    pub fn taken(&self, input: &str) -> Option<ImageArg> {
        let id = self.plan.find(input)?;
        let resource = &self.plan.resources[id.0];
        let Kind::Image { format, width, height, layers, .. } = resource.kind else { return None };
        let backed = self.internal(id).filter(|_| resource.owner == Owner::InputBuffer)?;
        let state = ImageState { access: ImageState::READ.access, ..ImageState::WRITTEN };
        Some(ImageArg {
            image: backed.image,
            view: backed.view,
            format: format.vk(),
            extent: [width, height, layers],
            before: state,
            after: state,
        })
    }

    /// What is copied: for an edit of heights, only the edited rectangle.
    pub(super) fn takes(
        &self,
        buffers: &[Option<BufferArg>],
        edited: Option<Rectangle>,
    ) -> Vec<Taken> {
        let one = |(i, arg): (usize, &Option<BufferArg>)| {
            let arg = (*arg)?;
            let resource = &self.plan.resources[i];
            let range = check_buffer(&arg, resource).ok()?;
            let [cols, rows, texel] = measures(resource)?;
            let row = if arg.row_bytes == 0 { cols * texel } else { arg.row_bytes };
            let all = Rectangle { col: 0, row: 0, cols: cols as u32, rows: rows as u32 };
            let part = edited.filter(|_| resource.name == "heights").unwrap_or(all);
            let corner = u64::from(part.row) * row + u64::from(part.col) * texel;
            let region = region([part.cols, part.rows, 1])
                .buffer_offset(arg.offset + corner)
                .buffer_row_length((row / texel) as u32)
                .image_offset(vk::Offset3D { x: part.col as i32, y: part.row as i32, z: 0 });
            let image = self.internal(ResourceId(i))?.image;
            Some(Taken { arg, image, region, range })
        };
        buffers.iter().enumerate().filter_map(one).collect()
    }
}

impl Taken {
    /// The image between copy and passes.
    pub(crate) const COPIED: ImageState = ImageState {
        stage: vk::PipelineStageFlags2::COPY,
        access: vk::AccessFlags2::TRANSFER_WRITE,
        layout: vk::ImageLayout::GENERAL,
    };

    fn barrier(&self) -> vk::BufferMemoryBarrier2<'static> {
        vk::BufferMemoryBarrier2::default()
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .buffer(self.arg.buffer)
            .offset(self.range.start)
            .size(self.range.end - self.range.start)
    }

    /// Barriers from the buffer's last use to the copy.
    pub(crate) fn entry(&self) -> vk::BufferMemoryBarrier2<'static> {
        self.barrier()
            .src_stage_mask(self.arg.stage)
            .src_access_mask(self.arg.access)
            .dst_stage_mask(READ.0)
            .dst_access_mask(READ.1)
    }

    /// Barriers from the copy back to that use.
    pub(crate) fn exit(&self) -> vk::BufferMemoryBarrier2<'static> {
        self.barrier()
            .src_stage_mask(READ.0)
            .src_access_mask(READ.1)
            .dst_stage_mask(self.arg.stage)
            .dst_access_mask(self.arg.access)
    }

    /// Barriers from the copy to the passes.
    pub(crate) fn filled(&self) -> vk::ImageMemoryBarrier2<'static> {
        super::transition(self.image, 1, Self::COPIED, ImageState::WRITTEN)
    }

    /// # Safety
    /// `commands` is being recorded outside a render pass; the image is in GENERAL; image and buffer are alive.
    pub(crate) unsafe fn copy(&self, device: &ash::Device, commands: vk::CommandBuffer) {
        let (buffer, layout) = (self.arg.buffer, Self::COPIED.layout);
        // SAFETY: as the caller guarantees; the region is within the checked range.
        unsafe {
            device.cmd_copy_buffer_to_image(commands, buffer, self.image, layout, &[self.region]);
        }
    }
}

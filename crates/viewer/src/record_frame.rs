//! Records the commands of one frame.

use ash::vk;

use super::drawer::{COPIED, Drawer};
use super::slot::{Slot, fitting};
use super::{Overlay, Pane, PresentOptions, Screen, Viewpoint};
use ridgelight::gpu::{
    Backed, Frame, Headless, ImageArg, ImageState, MemoryUse, Work, failed, region, transition,
    whole,
};
use ridgelight::plan::Rectangle;
use ridgelight::{Error, Result};

/// States of the window's picture: between the copies into it, and those before and after.
const FILLED: ImageState = ImageState {
    stage: vk::PipelineStageFlags2::ALL_TRANSFER,
    access: vk::AccessFlags2::TRANSFER_WRITE,
    layout: vk::ImageLayout::TRANSFER_DST_OPTIMAL,
};
const READ: ImageState = ImageState {
    access: vk::AccessFlags2::TRANSFER_READ,
    layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
    ..FILLED
};
/// Shapes are blended with it.
const DRAWN: ImageState = ImageState {
    stage: vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT,
    access: vk::AccessFlags2::from_raw(
        vk::AccessFlags2::COLOR_ATTACHMENT_READ.as_raw()
            | vk::AccessFlags2::COLOR_ATTACHMENT_WRITE.as_raw(),
    ),
    layout: vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
};
const NEW: ImageState =
    ImageState { access: vk::AccessFlags2::NONE, layout: vk::ImageLayout::UNDEFINED, ..FILLED };
const SHOWN: ImageState = ImageState {
    access: vk::AccessFlags2::NONE,
    layout: vk::ImageLayout::PRESENT_SRC_KHR,
    ..FILLED
};

impl Screen {
    /// Uploads the panes' data; the slot is free.
    pub(super) fn prepare(
        &mut self,
        slot: usize,
        panes: &mut [Pane<'_>],
        options: &PresentOptions<'_>,
    ) -> Result<()> {
        let chain = self.chain.as_ref().expect("draw checks");
        let (size, swaps, is_readable) = (chain.size, chain.swaps(), chain.is_readable);
        let format = chain.format;
        for pane in panes.iter_mut() {
            check(pane, size, swaps)?;
            let (inputs, outputs) = (pane.frame.inputs(), pane.frame.outputs());
            pane.frame.renderer().check_recording(slot, &inputs, &outputs, pane.work)?;
        }
        let columns: Vec<[u32; 2]> = panes.iter().map(|pane| [pane.left, pane.size()[0]]).collect();
        check_apart(&columns)?;
        let gpu = &mut self.gpu;
        let of_slot = &mut self.slots[slot];
        of_slot.heights.resize_with(of_slot.heights.len().max(panes.len()), || None);
        for (pane, place) in panes.iter().zip(&mut of_slot.heights) {
            stage(gpu, place, pane.heights, pane.frame)?;
        }
        if !options.overlay.primitives.is_empty() {
            self.painter.prepare(gpu, (of_slot.pool, format))?;
        }
        if options.keeps {
            if !is_readable {
                let reason = "the window's pictures cannot be copied".into();
                return Err(Error::Device { doing: "reading a picture back".into(), reason });
            }
            let named = ("picture of a frame", 4 * u64::from(size[0]) * u64::from(size[1]));
            fitting(gpu, &mut of_slot.readback, named, MemoryUse::Readback)?;
        }
        self.prepare_drawers(panes, options, swaps)
    }

    fn prepare_drawers(
        &mut self,
        panes: &[Pane<'_>],
        options: &PresentOptions<'_>,
        swaps: bool,
    ) -> Result<()> {
        let fit = self.drawers.len() == panes.len()
            && self
                .drawers
                .iter()
                .zip(panes)
                .all(|(drawer, pane)| drawer.fits(&self.gpu, pane.viewpoint));
        if !fit {
            self.wait()?;
            self.drawers.drain(..).for_each(|old| old.end(&mut self.gpu));
            for pane in panes {
                let of_all = (options.voids, swaps);
                self.drawers.push(Drawer::new(&mut self.gpu, pane.viewpoint, of_all)?);
            }
        }
        let mut of_panes = self.drawers.iter_mut().zip(panes);
        of_panes.try_for_each(|(drawer, pane)| drawer.set_tone(&mut self.gpu, pane.viewpoint))
    }

    pub(super) fn record(
        &mut self,
        slot: usize,
        image: usize,
        panes: &mut [Pane<'_>],
        options: &PresentOptions<'_>,
    ) -> Result<()> {
        let commands = self.begin(slot)?;
        for (n, pane) in panes.iter_mut().enumerate() {
            if let (Some((_, at)), Some(from)) = (pane.heights, &self.slots[slot].heights[n]) {
                self.copy_heights(commands, (from.buffer, at), pane.frame);
            }
            record_work(pane.frame, commands, slot, (pane.work, &[]))?;
            let shown = (&*pane.frame, pane.viewpoint);
            self.drawers[n].record(&self.gpu, commands, slot, shown)?;
        }
        self.fill(slot, image, panes, options)?;
        // SAFETY: recording was begun above.
        unsafe { self.gpu.host().device.end_command_buffer(commands) }
            .map_err(failed("recording a frame"))
    }

    /// Records work on a frame alone, without a picture.
    pub(super) fn record_light(
        &mut self,
        slot: usize,
        frame: &mut Frame,
        heights: Option<(&[f32], Rectangle)>,
        (work, borrowed): (Work<'_>, &[ImageArg]),
    ) -> Result<()> {
        check_heights(heights, frame)?;
        let (inputs, outputs) = (inputs_of(frame, borrowed)?, frame.outputs());
        frame.renderer().check_recording(slot, &inputs, &outputs, work)?;
        let of_slot = &mut self.slots[slot];
        if of_slot.heights.is_empty() {
            of_slot.heights.push(None);
        }
        stage(&mut self.gpu, &mut of_slot.heights[0], heights, frame)?;
        let commands = self.begin(slot)?;
        if let (Some((_, at)), Some(from)) = (heights, &self.slots[slot].heights[0]) {
            self.copy_heights(commands, (from.buffer, at), frame);
        }
        record_work(frame, commands, slot, (work, borrowed))?;
        // SAFETY: recording was begun above.
        unsafe { self.gpu.host().device.end_command_buffer(commands) }
            .map_err(failed("recording a frame"))
    }

    /// Begins the slot's commands.
    fn begin(&self, slot: usize) -> Result<vk::CommandBuffer> {
        let device = &self.gpu.host().device;
        let Slot { pool, commands, .. } = self.slots[slot];
        let begin = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the slot's commands have run, or were never submitted.
        unsafe {
            device
                .reset_command_pool(pool, vk::CommandPoolResetFlags::empty())
                .and_then(|()| device.begin_command_buffer(commands, &begin))
        }
        .map_err(failed("recording a frame"))?;
        Ok(commands)
    }

    /// Copies from a buffer of a rectangle into the frame's first input, which is in GENERAL. The renderer
    /// waits for its previous use, and makes it available for any next use.
    fn copy_heights(
        &self,
        commands: vk::CommandBuffer,
        (from, at): (vk::Buffer, Rectangle),
        frame: &Frame,
    ) {
        let offset = vk::Offset3D { x: at.col as i32, y: at.row as i32, z: 0 };
        let region = [region([at.cols, at.rows, 1]).image_offset(offset)];
        let general = vk::ImageLayout::GENERAL;
        let to = frame.inputs()[0].image;
        let all = vk::PipelineStageFlags2::ALL_COMMANDS;
        let any = vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE;
        let barrier = [vk::MemoryBarrier2::default()
            .src_stage_mask(all)
            .src_access_mask(any)
            .dst_stage_mask(all)
            .dst_access_mask(any)];
        let wait = vk::DependencyInfo::default().memory_barriers(&barrier);
        let device = &self.gpu.host().device;
        // SAFETY: `commands` is being recorded; the buffer holds a height per texel of the rectangle, which was
        // checked to be within the image.
        unsafe {
            device.cmd_pipeline_barrier2(commands, &wait);
            device.cmd_copy_buffer_to_image(commands, from, to, general, &region);
        }
    }

    /// Copies pictures into the window's image, draws the overlay over them, and copies back to the host where requested.
    fn fill(
        &mut self,
        slot: usize,
        image: usize,
        panes: &[Pane<'_>],
        options: &PresentOptions<'_>,
    ) -> Result<()> {
        let (device, commands) = (&self.gpu.host().device, self.slots[slot].commands);
        let chain = self.chain.as_ref().expect("acquired from");
        let to = chain.images[image];
        let change = |from, to_state| self.change(commands, to, from, to_state);
        change(NEW, FILLED);
        if !matches!(panes, [one] if one.size() == chain.size) {
            let black = vk::ClearColorValue { float32: [0.0, 0.0, 0.0, 1.0] };
            // SAFETY: `commands` is being recorded; the image is in this layout.
            unsafe {
                device.cmd_clear_color_image(commands, to, FILLED.layout, &black, &[whole(1)])
            };
            change(FILLED, FILLED);
        }
        for (pane, drawer) in panes.iter().zip(&self.drawers) {
            let [width, height] = pane.size();
            let region = region([width, height, 1]);
            let (size, layers) = (region.image_extent, region.image_subresource);
            let copy = [vk::ImageCopy::default()
                .src_subresource(layers)
                .dst_subresource(layers)
                .dst_offset(vk::Offset3D { x: pane.left as i32, y: 0, z: 0 })
                .extent(size)];
            let (from, layout) = (drawer.picture(), COPIED.layout);
            // SAFETY: `commands` is being recorded; texels of both images are four bytes; the pane was checked
            // to be within the image, and has the size of its picture.
            unsafe { device.cmd_copy_image(commands, from, layout, to, FILLED.layout, &copy) };
        }
        let (size, mut last) = (chain.size, FILLED);
        if !options.overlay.primitives.is_empty() {
            change(FILLED, DRAWN);
            self.draw_over(commands, image, options.overlay)?;
            last = DRAWN;
        }
        if let (true, Some(back)) = (options.keeps, &self.slots[slot].readback) {
            self.change(commands, to, last, READ);
            let written = [vk::MemoryBarrier2::default()
                .src_stage_mask(vk::PipelineStageFlags2::COPY)
                .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
                .dst_stage_mask(vk::PipelineStageFlags2::HOST)
                .dst_access_mask(vk::AccessFlags2::HOST_READ)];
            let info = vk::DependencyInfo::default().memory_barriers(&written);
            let device = &self.gpu.host().device;
            // SAFETY: the buffer holds a picture.
            unsafe {
                let region = [region([size[0], size[1], 1])];
                device.cmd_copy_image_to_buffer(commands, to, READ.layout, back.buffer, &region);
                device.cmd_pipeline_barrier2(commands, &info);
            }
            last = READ;
        }
        self.change(commands, to, last, SHOWN);
        Ok(())
    }

    /// Draws shapes into the window's image, which is in [`DRAWN`].
    fn draw_over(
        &mut self,
        commands: vk::CommandBuffer,
        image: usize,
        overlay: Overlay<'_>,
    ) -> Result<()> {
        let chain = self.chain.as_ref().expect("acquired from");
        let size @ [width, height] = chain.size;
        let into = [vk::RenderingAttachmentInfo::default()
            .image_view(chain.views[image])
            .image_layout(DRAWN.layout)
            .load_op(vk::AttachmentLoadOp::LOAD)
            .store_op(vk::AttachmentStoreOp::STORE)];
        let info = vk::RenderingInfo::default()
            .render_area(vk::Extent2D { width, height }.into())
            .layer_count(1)
            .color_attachments(&into);
        // SAFETY: `commands` is being recorded; the view is of the acquired image, of this size.
        unsafe { self.gpu.host().device.cmd_begin_rendering(commands, &info) };
        self.painter.record(commands, size, overlay)?;
        // SAFETY: begun above.
        unsafe { self.gpu.host().device.cmd_end_rendering(commands) };
        Ok(())
    }

    /// A barrier between uses; the first follows the wait for the picture's semaphore.
    fn change(
        &self,
        commands: vk::CommandBuffer,
        image: vk::Image,
        from: ImageState,
        to: ImageState,
    ) {
        let barrier = [transition(image, 1, from, to)];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barrier);
        // SAFETY: `commands` is being recorded; the image is the window's, acquired.
        unsafe { self.gpu.host().device.cmd_pipeline_barrier2(commands, &info) };
    }

    /// The picture of a size that the slot read back, once it has run.
    pub(super) fn read_back(
        &mut self,
        slot: usize,
        (size, swaps): ([u32; 2], bool),
    ) -> Result<Vec<[u8; 4]>> {
        let slot = &mut self.slots[slot];
        slot.settle(&self.gpu)?;
        let mapped = slot.readback.as_mut().expect("made by prepare").mapped();
        let pixels = mapped.as_chunks::<4>().0.iter().take(size[0] as usize * size[1] as usize);
        Ok(pixels.map(|&[r, g, b, a]| if swaps { [b, g, r, a] } else { [r, g, b, a] }).collect())
    }
}

/// The frame's inputs, the last of them borrowed.
fn inputs_of(frame: &Frame, borrowed: &[ImageArg]) -> Result<Vec<ImageArg>> {
    let mut inputs = frame.inputs();
    let Some(own) = inputs.len().checked_sub(borrowed.len()) else {
        let (found, most) = (borrowed.len().to_string(), inputs.len());
        return Err(Error::setting("borrowed inputs", found, format!("{most} at most")));
    };
    inputs.truncate(own);
    inputs.extend(borrowed);
    Ok(inputs)
}

fn record_work(
    frame: &mut Frame,
    commands: vk::CommandBuffer,
    slot: usize,
    (work, borrowed): (Work<'_>, &[ImageArg]),
) -> Result<()> {
    let (inputs, outputs) = (inputs_of(frame, borrowed)?, frame.outputs());
    let renderer = frame.renderer();
    match work {
        Work::Passes([]) => Ok(()),
        Work::Passes(passes) => renderer.record_passes(commands, slot, &inputs, &outputs, passes),
        Work::Edit(at) => renderer.record_edit(commands, slot, &inputs, &outputs, at),
    }
}

/// Heights of a rectangle, row after row, in a buffer that replaces none or a smaller one.
fn stage(
    gpu: &mut Headless,
    place: &mut Option<Backed>,
    heights: Option<(&[f32], Rectangle)>,
    frame: &Frame,
) -> Result<()> {
    let Some((heights, at)) = heights else { return Ok(()) };
    let cols = frame.plan().size[0] as usize;
    let bytes = 4 * u64::from(at.cols) * u64::from(at.rows);
    let named = ("heights of a frame", bytes);
    let mut to = fitting(gpu, place, named, MemoryUse::Upload)?.mapped();
    for row in at.row..at.row + at.rows {
        let from = row as usize * cols + at.col as usize;
        let row: &[u8] = bytemuck::cast_slice(&heights[from..from + at.cols as usize]);
        let (here, after) = to.split_at_mut(row.len());
        here.copy_from_slice(row);
        to = after;
    }
    Ok(())
}

impl Pane<'_> {
    /// Columns and rows of the picture that it covers.
    fn size(&self) -> [u32; 2] {
        match self.viewpoint {
            Viewpoint::Map(map) => map.size,
            Viewpoint::Camera(view, _) => view.size,
        }
    }
}

/// Whether new heights are within their frame's field.
fn check_heights(heights: Option<(&[f32], Rectangle)>, frame: &Frame) -> Result<()> {
    let Some((heights, at)) = heights else { return Ok(()) };
    let [cols, rows] = frame.plan().size;
    let within = |first: u32, count: u32, all: u32| {
        first.checked_add(count).is_some_and(|end| end <= all) && count > 0
    };
    let grid_points = cols as usize * rows as usize;
    if heights.len() == grid_points
        && within(at.col, at.cols, cols)
        && within(at.row, at.rows, rows)
    {
        return Ok(());
    }
    let found = format!("{} heights, new in {at:?}", heights.len());
    let expected = format!("{grid_points}, new within {cols} × {rows}");
    Err(Error::setting("heights", found, expected))
}

/// Whether a pane is within a picture and its heights within its field.
fn check(pane: &Pane<'_>, size: [u32; 2], swaps: bool) -> Result<()> {
    check_heights(pane.heights, pane.frame)?;
    let [width, height] = pane.size();
    let is_ordered = match pane.viewpoint {
        Viewpoint::Map(map) => map.swaps == swaps,
        Viewpoint::Camera(..) => true,
    };
    if pane.left.checked_add(width).is_none_or(|end| end > size[0]) || height > size[1] {
        let found = format!("{width} × {height} from column {}", pane.left);
        return Err(Error::setting("viewpoint: size", found, format!("within {size:?}")));
    }
    if !is_ordered {
        return Err(Error::setting("viewpoint: swaps", "another order", "that of the window"));
    }
    Ok(())
}

/// Whether panes, each its first column and its columns, do not overlap: all begin in the first row, and copies
/// into the same pixels would come in any order.
fn check_apart(columns: &[[u32; 2]]) -> Result<()> {
    let end = |[left, width]: [u32; 2]| left.saturating_add(width);
    for (later, pane) in columns.iter().enumerate() {
        let over = |other: &&[u32; 2]| pane[0] < end(**other) && other[0] < end(*pane);
        if let Some(other) = columns[..later].iter().find(over) {
            let found =
                format!("{} to {}, over {} to {}", pane[0], end(*pane), other[0], end(*other));
            return Err(Error::setting(format!("pane {later}: columns"), found, "its own"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Panes may touch, in any order; one common column is refused.
    #[test]
    fn panes_share_no_column() {
        check_apart(&[[8, 8], [0, 8], [16, 4]]).expect("apart");
        let refused = check_apart(&[[0, 8], [20, 2], [7, 8]]).unwrap_err().to_string();
        assert!(refused.contains("pane 2: columns: found 7 to 15, over 0 to 8"), "{refused}");
        assert!(check_apart(&[[3, 2], [0, 20]]).is_err());
    }
}

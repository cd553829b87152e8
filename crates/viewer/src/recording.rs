//! Records the commands of one frame.

use ash::vk;

use super::drawer::{COPIED, Drawer};
use super::slot::{Slot, fitting};
use super::{Pane, Panel, PresentOptions, Screen, Viewpoint};
use ridgelight::gpu::{Backed, Frame, MemoryUse, Work, failed, whole};
use ridgelight::plan::Rectangle;
use ridgelight::{Error, Result};

/// State of the window's picture between the copies into it.
const FILLED: (vk::ImageLayout, vk::AccessFlags2) =
    (vk::ImageLayout::TRANSFER_DST_OPTIMAL, vk::AccessFlags2::TRANSFER_WRITE);
const READ: (vk::ImageLayout, vk::AccessFlags2) =
    (vk::ImageLayout::TRANSFER_SRC_OPTIMAL, vk::AccessFlags2::TRANSFER_READ);
const NEW: (vk::ImageLayout, vk::AccessFlags2) =
    (vk::ImageLayout::UNDEFINED, vk::AccessFlags2::NONE);
const SHOWN: (vk::ImageLayout, vk::AccessFlags2) =
    (vk::ImageLayout::PRESENT_SRC_KHR, vk::AccessFlags2::NONE);

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
        for pane in panes.iter_mut() {
            check(pane, size, swaps)?;
            let (inputs, outputs) = (pane.frame.inputs(), pane.frame.outputs());
            pane.frame.renderer().check_recording(slot, &inputs, &outputs, pane.work)?;
        }
        let columns: Vec<[u32; 2]> = panes.iter().map(|pane| [pane.left, pane.size()[0]]).collect();
        check_apart(&columns)?;
        for (n, panel) in options.panels.iter().enumerate() {
            check_panel(n, panel)?;
        }
        let gpu = &mut self.gpu;
        let of_slot = &mut self.slots[slot];
        of_slot.heights.resize_with(of_slot.heights.len().max(panes.len()), || None);
        for (pane, place) in panes.iter().zip(&mut of_slot.heights) {
            let Some((heights, at)) = pane.heights else { continue };
            let cols = pane.frame.plan().size[0] as usize;
            let bytes = 4 * u64::from(at.cols) * u64::from(at.rows);
            let named = ("heights of a frame", bytes);
            let mut to = mapped(fitting(gpu, place, named, MemoryUse::Upload)?)?;
            for row in at.row..at.row + at.rows {
                let from = row as usize * cols + at.col as usize;
                let row: &[u8] = bytemuck::cast_slice(&heights[from..from + at.cols as usize]);
                let (here, after) = to.split_at_mut(row.len());
                here.copy_from_slice(row);
                to = after;
            }
        }
        let bytes: u64 = options.panels.iter().map(|panel| 4 * panel.pixels.len() as u64).sum();
        if bytes > 0 {
            let named = ("text of a frame", bytes);
            let to = mapped(fitting(gpu, &mut of_slot.text, named, MemoryUse::Upload)?)?;
            let pixels = options.panels.iter().flat_map(|panel| panel.pixels);
            for (to, pixel) in to.as_chunks_mut::<4>().0.iter_mut().zip(pixels) {
                *to = ordered(*pixel, swaps);
            }
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
            && self.drawers.iter().zip(panes).all(|(drawer, pane)| drawer.fits(pane.viewpoint));
        if !fit {
            self.wait()?;
            self.drawers.drain(..).for_each(|old| old.end(&mut self.gpu));
            for pane in panes {
                let of_all = (options.tone, options.voids, swaps);
                self.drawers.push(Drawer::new(&mut self.gpu, pane.viewpoint, of_all)?);
            }
        }
        self.drawers.iter_mut().try_for_each(|drawer| drawer.set_tone(&mut self.gpu, options.tone))
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
            let (inputs, outputs) = (pane.frame.inputs(), pane.frame.outputs());
            let renderer = pane.frame.renderer();
            match pane.work {
                Work::Passes([]) => {}
                Work::Passes(passes) => {
                    renderer.record_passes(commands, slot, &inputs, &outputs, passes)?;
                }
                Work::Edit(at) => renderer.record_edit(commands, slot, &inputs, &outputs, at)?,
            }
            let shown = (&*pane.frame, pane.viewpoint, options.tone.exposure);
            self.drawers[n].record(&self.gpu, commands, slot, shown)?;
        }
        self.fill(slot, image, panes, options);
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
        let region = [copied([at.cols, at.rows]).image_offset(offset)];
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

    /// Copies pictures and text into the window's image, and back to the host where requested.
    fn fill(&self, slot: usize, image: usize, panes: &[Pane<'_>], options: &PresentOptions<'_>) {
        let (device, slot) = (&self.gpu.host().device, &self.slots[slot]);
        let chain = self.chain.as_ref().expect("acquired from");
        let (to, commands) = (chain.images[image], slot.commands);
        let change = |from: (vk::ImageLayout, vk::AccessFlags2), to_state| {
            self.change(commands, to, from, to_state);
        };
        change(NEW, FILLED);
        if !matches!(panes, [one] if one.size() == chain.size) {
            let black = vk::ClearColorValue { float32: [0.0, 0.0, 0.0, 1.0] };
            // SAFETY: `commands` is being recorded; the image is in this layout.
            unsafe { device.cmd_clear_color_image(commands, to, FILLED.0, &black, &[whole(1)]) };
            change(FILLED, FILLED);
        }
        for (pane, drawer) in panes.iter().zip(&self.drawers) {
            let region = copied(pane.size());
            let (size, layers) = (region.image_extent, region.image_subresource);
            let copy = [vk::ImageCopy::default()
                .src_subresource(layers)
                .dst_subresource(layers)
                .dst_offset(vk::Offset3D { x: pane.left as i32, y: 0, z: 0 })
                .extent(size)];
            let (from, layout) = (drawer.picture(), COPIED.layout);
            // SAFETY: `commands` is being recorded; texels of both images are four bytes; the pane was checked
            // to be within the image, and has the size of its picture.
            unsafe { device.cmd_copy_image(commands, from, layout, to, FILLED.0, &copy) };
        }
        let mut offset = 0;
        for panel in options.panels {
            if let (Some(region), Some(from)) = (text(panel, chain.size, offset), &slot.text) {
                change(FILLED, FILLED);
                // SAFETY: the buffer holds the panel's pixels from the offset on, the region is cut to the image.
                unsafe {
                    let (from, region) = (from.buffer, [region]);
                    device.cmd_copy_buffer_to_image(commands, from, to, FILLED.0, &region);
                }
            }
            offset += 4 * panel.pixels.len() as u64;
        }
        let whole_image = copied(chain.size);
        let mut last = FILLED;
        if let (true, Some(back)) = (options.keeps, &slot.readback) {
            change(FILLED, READ);
            let written = [vk::MemoryBarrier2::default()
                .src_stage_mask(vk::PipelineStageFlags2::COPY)
                .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
                .dst_stage_mask(vk::PipelineStageFlags2::HOST)
                .dst_access_mask(vk::AccessFlags2::HOST_READ)];
            let info = vk::DependencyInfo::default().memory_barriers(&written);
            // SAFETY: the buffer holds a picture.
            unsafe {
                let region = [whole_image];
                device.cmd_copy_image_to_buffer(commands, to, READ.0, back.buffer, &region);
                device.cmd_pipeline_barrier2(commands, &info);
            }
            last = READ;
        }
        change(last, SHOWN);
    }

    /// A barrier between copies; the first follows the wait for the picture's semaphore.
    fn change(
        &self,
        commands: vk::CommandBuffer,
        image: vk::Image,
        from: (vk::ImageLayout, vk::AccessFlags2),
        to: (vk::ImageLayout, vk::AccessFlags2),
    ) {
        let barrier = [vk::ImageMemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
            .src_access_mask(from.1)
            .dst_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
            .dst_access_mask(to.1)
            .old_layout(from.0)
            .new_layout(to.0)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(image)
            .subresource_range(whole(1))];
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
        let mapped = slot.readback.as_mut().and_then(|b| b.mapped());
        let mapped =
            mapped.ok_or_else(|| failed("reading back")(vk::Result::ERROR_MEMORY_MAP_FAILED))?;
        let pixels = mapped.as_chunks::<4>().0.iter().take(size[0] as usize * size[1] as usize);
        Ok(pixels.map(|p| ordered(*p, swaps)).collect())
    }
}

fn ordered([r, g, b, a]: [u8; 4], swaps: bool) -> [u8; 4] {
    if swaps { [b, g, r, a] } else { [r, g, b, a] }
}

fn mapped(backed: &mut Backed) -> Result<&mut [u8]> {
    let mapped = backed.mapped();
    mapped.ok_or_else(|| failed("uploading")(vk::Result::ERROR_MEMORY_MAP_FAILED))
}

impl Pane<'_> {
    /// Columns and rows of the picture that it covers.
    fn size(&self) -> [u32; 2] {
        match self.viewpoint {
            Viewpoint::Map(map) => map.size,
            Viewpoint::Camera(view) => view.size,
        }
    }
}

/// Whether a pane is within a picture and its heights within its field.
fn check(pane: &Pane<'_>, size: [u32; 2], swaps: bool) -> Result<()> {
    let plan = pane.frame.plan();
    let field @ [cols, rows] = plan.size;
    if let Some((heights, at)) = pane.heights {
        let within = |first: u32, count: u32, all: u32| {
            first.checked_add(count).is_some_and(|end| end <= all) && count > 0
        };
        let grid_points = cols as usize * rows as usize;
        if heights.len() != grid_points
            || !(within(at.col, at.cols, cols) && within(at.row, at.rows, rows))
        {
            let found = format!("{} heights, new in {at:?}", heights.len());
            let expected = format!("{grid_points}, new within {} × {}", field[0], field[1]);
            return Err(Error::setting("heights", found, expected));
        }
    }
    let [width, height] = pane.size();
    let is_ordered = match pane.viewpoint {
        Viewpoint::Map(map) => map.swaps == swaps,
        Viewpoint::Camera(_) => true,
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

/// Whether a panel, by its index in the options, has a pixel per place.
fn check_panel(n: usize, panel: &Panel<'_>) -> Result<()> {
    let [width, height] = panel.size;
    let expected = u64::from(width) * u64::from(height);
    if panel.pixels.len() as u64 == expected {
        return Ok(());
    }
    let expected = format!("{expected} of {width} × {height}");
    Err(Error::setting(format!("panel {n}: pixels"), panel.pixels.len().to_string(), expected))
}

/// All of an image of one layer, rows packed.
fn copied([width, height]: [u32; 2]) -> vk::BufferImageCopy {
    vk::BufferImageCopy::default()
        .image_subresource(vk::ImageSubresourceLayers {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            mip_level: 0,
            base_array_layer: 0,
            layer_count: 1,
        })
        .image_extent(vk::Extent3D { width, height, depth: 1 })
}

/// A panel's part of a picture, from an offset of the buffer; none where it is outside.
fn text(panel: &Panel<'_>, size: [u32; 2], offset: u64) -> Option<vk::BufferImageCopy> {
    let [width, height] = panel.size;
    let left = |i: usize| size[i].saturating_sub(panel.at[i]).min(panel.size[i]);
    let shown = [left(0), left(1)];
    let [x, y] = panel.at.map(|at| at as i32);
    let region = copied(shown).buffer_row_length(width).buffer_image_height(height);
    let region = region.image_offset(vk::Offset3D { x, y, z: 0 }).buffer_offset(offset);
    (!shown.contains(&0)).then_some(region)
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

    #[test]
    fn panels_have_a_pixel_a_place() {
        let pixels = [[0_u8; 4]; 6];
        let panel = Panel { at: [0; 2], size: [3, 2], pixels: &pixels };
        check_panel(0, &panel).expect("whole");
        let refused = check_panel(1, &Panel { size: [2, 2], ..panel }).unwrap_err().to_string();
        assert!(refused.contains("panel 1: pixels: found 6, expected 4 of 2 × 2"), "{refused}");
    }
}

//! Records a view into a command buffer.

use ash::vk;

use super::super::memory::{Backed, DEPTH, whole_attachment};
use super::super::renderer::transition;
use super::pipelines::{Drawing, STAGES};
use super::{LABELS, ViewInputs, ViewOutputs, ViewRenderer};
use crate::gpu::{ImageArg, ImageState};
use crate::graph::shaders::PictureTonePush;
use crate::passes::plinth_draw;
use crate::passes::terrain_draw::TILE;
use crate::plan::View;

/// Inputs of the shaders.
const READ: ImageState = ImageState {
    stage: vk::PipelineStageFlags2::from_raw(
        vk::PipelineStageFlags2::VERTEX_SHADER.as_raw()
            | vk::PipelineStageFlags2::FRAGMENT_SHADER.as_raw(),
    ),
    access: vk::AccessFlags2::SHADER_SAMPLED_READ,
    layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
};

/// Colour attachments.
const DRAWN: ImageState = ImageState {
    stage: vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT,
    access: vk::AccessFlags2::from_raw(
        vk::AccessFlags2::COLOR_ATTACHMENT_READ.as_raw()
            | vk::AccessFlags2::COLOR_ATTACHMENT_WRITE.as_raw(),
    ),
    layout: vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
};

/// Depths: tested, and resolved with colours.
const TESTED: ImageState = ImageState {
    stage: vk::PipelineStageFlags2::from_raw(
        vk::PipelineStageFlags2::EARLY_FRAGMENT_TESTS.as_raw()
            | vk::PipelineStageFlags2::LATE_FRAGMENT_TESTS.as_raw()
            | vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT.as_raw(),
    ),
    access: vk::AccessFlags2::from_raw(
        vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
            | vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw()
            | DRAWN.access.as_raw(),
    ),
    layout: vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
};

type Barrier = vk::ImageMemoryBarrier2<'static>;

/// Barriers from an image's state, without its contents, to its use as an attachment.
fn begun(image: vk::Image, from: ImageState, to: ImageState) -> Barrier {
    let from = ImageState { layout: vk::ImageLayout::UNDEFINED, ..from };
    of_kind(transition(image, 1, from, to), to)
}

fn of_kind(barrier: Barrier, state: ImageState) -> Barrier {
    let is_depth = state.layout == TESTED.layout;
    barrier.subresource_range(whole_attachment(if is_depth { DEPTH } else { super::LINEAR }))
}

impl ViewRenderer {
    pub(super) fn append(
        &mut self,
        commands: vk::CommandBuffer,
        slot: usize,
        (view, exposure): (&View, f32),
        inputs: &ViewInputs,
        outputs: &ViewOutputs,
    ) {
        self.write_sets(slot, inputs);
        let read: Vec<&ImageArg> = [&inputs.heights, &inputs.radiance]
            .into_iter()
            .chain(inputs.environment.as_ref().filter(|_| view.environment.is_some()))
            .chain(inputs.voids.as_ref().filter(|_| view.has_voids))
            .collect();
        let device = self.host.device.clone();
        let queries = self.slots[slot].queries;
        let timestamp = |query: u32| {
            if queries != vk::QueryPool::null() {
                let stage = vk::PipelineStageFlags2::ALL_GRAPHICS;
                // SAFETY: `commands` is being recorded for a family with timestamps; the pool has one query
                // more than there are draws, reset at the start of the recording.
                unsafe { device.cmd_write_timestamp2(commands, stage, queries, query) };
            }
        };
        let barriers = |all: &[Barrier]| {
            let info = vk::DependencyInfo::default().image_memory_barriers(all);
            // SAFETY: `commands` is being recorded outside rendering; images are in the states that are stated.
            unsafe { device.cmd_pipeline_barrier2(commands, &info) };
        };
        if queries != vk::QueryPool::null() {
            let count = LABELS.len() as u32 + 1;
            // SAFETY: the slot's last command buffer has run. Now, so that earlier times are not mistaken for
            // these; and in the command buffer, in case it runs again.
            unsafe {
                device.reset_query_pool(queries, 0, count);
                device.cmd_reset_query_pool(commands, queries, 0, count);
            }
        }
        barriers(&self.entry(&read, outputs));
        timestamp(0);
        let target = self.linear.as_ref().map_or(outputs.picture.view, |linear| linear.view);
        self.begin(commands, target, outputs);
        let push = bytemuck::bytes_of(&view.terrain);
        self.labelled(commands, LABELS[0], |this| {
            this.bind(commands, &this.terrain, this.slots[slot].sets[0], push);
            this.draw_tiles(commands, view.tiles);
        });
        timestamp(1);
        self.labelled(commands, LABELS[1], |this| {
            let push = bytemuck::bytes_of(&view.sky);
            this.bind(commands, &this.sky, this.slots[slot].sets[1], push);
            this.draw_triangle(commands);
        });
        timestamp(2);
        let mut timed = 2;
        if let (Some(plinth), Some(push)) = (&self.plinth, &view.plinth) {
            self.labelled(commands, LABELS[2], |this| {
                this.bind(commands, plinth, this.slots[slot].sets[2], bytemuck::bytes_of(push));
                let vertices = plinth_draw::vertices(push);
                // SAFETY: `commands` is being recorded within rendering, a pipeline bound.
                unsafe { device.cmd_draw(commands, vertices, plinth_draw::FACES, 0, 0) };
            });
            timed += 1;
            timestamp(timed);
        }
        // SAFETY: begun above.
        unsafe { device.cmd_end_rendering(commands) };
        if let (Some(tone), Some(linear)) = (&self.tone, &self.linear) {
            barriers(&[transition(linear.image, 1, DRAWN, READ)]);
            self.labelled(commands, LABELS[3], |this| {
                this.begin_colour(commands, outputs.picture.view);
                let push = PictureTonePush { exposure };
                this.bind(commands, tone, this.slots[slot].sets[3], bytemuck::bytes_of(&push));
                this.draw_triangle(commands);
                // SAFETY: begun above.
                unsafe { device.cmd_end_rendering(commands) };
            });
            timestamp(timed + 1);
        }
        barriers(&self.exit(&read, outputs));
        self.slots[slot].is_recorded = true;
    }

    fn entry(&self, read: &[&ImageArg], outputs: &ViewOutputs) -> Vec<Barrier> {
        let mut all: Vec<Barrier> =
            read.iter().map(|arg| transition(arg.image, 1, arg.before, READ)).collect();
        let mut own = |backed: &Option<Backed>, from, to| {
            all.extend(backed.as_ref().map(|b| begun(b.image, from, to)));
        };
        own(&self.many, DRAWN, DRAWN);
        own(&self.depth, TESTED, TESTED);
        own(&self.linear, READ, DRAWN);
        all.push(begun(outputs.picture.image, outputs.picture.before, DRAWN));
        all.extend(outputs.depth.map(|depth| begun(depth.image, depth.before, TESTED)));
        all
    }

    fn exit(&self, read: &[&ImageArg], outputs: &ViewOutputs) -> Vec<Barrier> {
        let read = read.iter().map(|arg| transition(arg.image, 1, READ, arg.before));
        let picture = &outputs.picture;
        let drawn = [transition(picture.image, 1, DRAWN, picture.after)];
        let tested = |d: ImageArg| of_kind(transition(d.image, 1, TESTED, d.after), TESTED);
        read.chain(drawn).chain(outputs.depth.map(tested)).collect()
    }

    /// Begins rendering of terrain and sky.
    fn begin(&self, commands: vk::CommandBuffer, target: vk::ImageView, outputs: &ViewOutputs) {
        let (resolve, first) = (vk::ResolveModeFlags::AVERAGE, vk::ResolveModeFlags::SAMPLE_ZERO);
        let mut colour = vk::RenderingAttachmentInfo::default()
            .image_view(target)
            .image_layout(DRAWN.layout)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::STORE);
        let mut depth = vk::RenderingAttachmentInfo::default()
            .image_view(self.depth.as_ref().map_or_else(Default::default, |d| d.view))
            .image_layout(TESTED.layout)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::DONT_CARE);
        if let Some(many) = &self.many {
            colour = colour
                .image_view(many.view)
                .store_op(vk::AttachmentStoreOp::DONT_CARE)
                .resolve_mode(resolve)
                .resolve_image_view(target)
                .resolve_image_layout(DRAWN.layout);
            if let Some(arg) = &outputs.depth {
                depth = depth
                    .resolve_mode(first)
                    .resolve_image_view(arg.view)
                    .resolve_image_layout(TESTED.layout);
            }
        } else if let Some(arg) = &outputs.depth {
            depth = depth.image_view(arg.view).store_op(vk::AttachmentStoreOp::STORE);
        }
        self.begin_rendering(commands, &[colour], Some(&depth));
    }

    /// Begins rendering of the tone curve, which writes every pixel.
    fn begin_colour(&self, commands: vk::CommandBuffer, target: vk::ImageView) {
        let colour = vk::RenderingAttachmentInfo::default()
            .image_view(target)
            .image_layout(DRAWN.layout)
            .load_op(vk::AttachmentLoadOp::DONT_CARE)
            .store_op(vk::AttachmentStoreOp::STORE);
        self.begin_rendering(commands, &[colour], None);
    }

    fn begin_rendering(
        &self,
        commands: vk::CommandBuffer,
        colours: &[vk::RenderingAttachmentInfo<'_>],
        depth: Option<&vk::RenderingAttachmentInfo<'_>>,
    ) {
        let [width, height] = self.shape.size;
        let area = vk::Rect2D { extent: vk::Extent2D { width, height }, ..Default::default() };
        let mut info = vk::RenderingInfo::default()
            .render_area(area)
            .layer_count(1)
            .color_attachments(colours);
        if let Some(depth) = depth {
            info = info.depth_attachment(depth);
        }
        let viewport = [vk::Viewport {
            x: 0.0,
            y: 0.0,
            width: width as f32,
            height: height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        }];
        // SAFETY: `commands` is being recorded outside rendering; the attachments have the picture's size and
        // the stated layouts.
        unsafe {
            self.host.device.cmd_begin_rendering(commands, &info);
            self.host.device.cmd_set_viewport(commands, 0, &viewport);
            self.host.device.cmd_set_scissor(commands, 0, &[area]);
        }
    }

    fn bind(
        &self,
        commands: vk::CommandBuffer,
        drawing: &Drawing,
        set: vk::DescriptorSet,
        push: &[u8],
    ) {
        let point = vk::PipelineBindPoint::GRAPHICS;
        let push = &push[..drawing.push_bytes as usize];
        let device = &self.host.device;
        // SAFETY: `commands` is being recorded within rendering of the pipeline's formats; set and push
        // constants match its layout.
        unsafe {
            device.cmd_bind_pipeline(commands, point, drawing.pipeline);
            device.cmd_bind_descriptor_sets(commands, point, drawing.layout, 0, &[set], &[]);
            device.cmd_push_constants(commands, drawing.layout, STAGES, 0, push);
        }
    }

    fn draw_tiles(&self, commands: vk::CommandBuffer, tiles: u32) {
        let Some(indices) = &self.indices else { return };
        let device = &self.host.device;
        // SAFETY: `commands` is being recorded within rendering, with the terrain's pipeline bound; the buffer
        // holds the indices of a tile.
        unsafe {
            device.cmd_bind_index_buffer(commands, indices.buffer, 0, vk::IndexType::UINT16);
            device.cmd_draw_indexed(commands, TILE * TILE * 6, tiles, 0, 0, 0);
        }
    }

    /// A triangle that covers the picture.
    fn draw_triangle(&self, commands: vk::CommandBuffer) {
        // SAFETY: `commands` is being recorded within rendering, a pipeline bound.
        unsafe { self.host.device.cmd_draw(commands, 3, 1, 0, 0) };
    }

    fn labelled(&self, commands: vk::CommandBuffer, label: &str, record: impl FnOnce(&Self)) {
        let name = std::ffi::CString::new(label).unwrap_or_default();
        if let Some(debug) = &self.host.debug_utils {
            let info = vk::DebugUtilsLabelEXT::default().label_name(&name);
            // SAFETY: `commands` is being recorded; the name lives across the call.
            unsafe { debug.cmd_begin_debug_utils_label(commands, &info) };
        }
        record(self);
        if let Some(debug) = &self.host.debug_utils {
            // SAFETY: as above; the label is open.
            unsafe { debug.cmd_end_debug_utils_label(commands) };
        }
    }

    fn write_sets(&self, slot: usize, inputs: &ViewInputs) {
        let [terrain, sky, plinth, tone] = self.slots[slot].sets;
        // Absent inputs are not read: any image is bound for them.
        let absent = &inputs.radiance;
        let voids = inputs.voids.as_ref().unwrap_or(absent);
        let environment = inputs.environment.as_ref().unwrap_or(absent);
        let mut bound = vec![
            (terrain, 0, inputs.heights.view),
            (terrain, 1, inputs.radiance.view),
            (terrain, 2, voids.view),
            (sky, 0, environment.view),
        ];
        if self.plinth.is_some() {
            let views = [inputs.heights.view, inputs.radiance.view, voids.view];
            bound.extend((0..).zip(views).map(|(binding, view)| (plinth, binding, view)));
        }
        bound.extend(self.linear.as_ref().map(|linear| (tone, 0, linear.view)));
        let infos: Vec<_> = bound
            .iter()
            .map(|(_, _, view)| {
                let info = vk::DescriptorImageInfo::default();
                [info.image_view(*view).image_layout(READ.layout)]
            })
            .collect();
        let writes: Vec<_> = bound
            .iter()
            .zip(&infos)
            .map(|((set, binding, _), info)| {
                vk::WriteDescriptorSet::default()
                    .dst_set(*set)
                    .dst_binding(*binding)
                    .descriptor_type(vk::DescriptorType::SAMPLED_IMAGE)
                    .image_info(info)
            })
            .collect();
        // SAFETY: the sets are this slot's, whose last command buffer has run; views are alive.
        unsafe { self.host.device.update_descriptor_sets(&writes, &[]) };
    }
}

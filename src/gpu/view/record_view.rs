//! Records a view into a command buffer.

use ash::vk;

use super::super::barriers::Barriers;
use super::super::memory::{Backed, DEPTH, whole_attachment};
use super::super::pipelines::Pipeline;
use super::super::renderer::transition;
use super::targets::CLEARED;
use super::{
    DEPTH_RESOLVE, LABELS, PLINTH, SKY, Slot, TERRAIN, TONE, ViewInputs, ViewOutputs, ViewRenderer,
};
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
pub(super) const DRAWN: ImageState = ImageState {
    stage: vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT,
    access: vk::AccessFlags2::from_raw(
        vk::AccessFlags2::COLOR_ATTACHMENT_READ.as_raw()
            | vk::AccessFlags2::COLOR_ATTACHMENT_WRITE.as_raw(),
    ),
    layout: vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
};

/// Depths: tested and written.
pub(super) const TESTED: ImageState = ImageState {
    stage: vk::PipelineStageFlags2::from_raw(
        vk::PipelineStageFlags2::EARLY_FRAGMENT_TESTS.as_raw()
            | vk::PipelineStageFlags2::LATE_FRAGMENT_TESTS.as_raw(),
    ),
    access: vk::AccessFlags2::from_raw(
        vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
            | vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
    ),
    layout: vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
};

/// Multisample depths, read by a shader.
pub(super) const FETCHED: ImageState = ImageState {
    stage: vk::PipelineStageFlags2::FRAGMENT_SHADER,
    access: vk::AccessFlags2::SHADER_SAMPLED_READ,
    layout: vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
};

type Barrier = vk::ImageMemoryBarrier2<'static>;

/// Barriers from an image's state, without its contents, to its use as an attachment.
fn begun(image: vk::Image, from: ImageState, to: ImageState) -> Barrier {
    let from = ImageState { layout: vk::ImageLayout::UNDEFINED, ..from };
    of_kind(transition(image, 1, from, to), to)
}

fn of_kind(barrier: Barrier, state: ImageState) -> Barrier {
    let is_depth = [TESTED.layout, FETCHED.layout].contains(&state.layout);
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
        let mut recorded = self.drawings;
        recorded[DEPTH_RESOLVE] = recorded[DEPTH_RESOLVE].filter(|_| outputs.depth.is_some());
        let labels: Vec<_> =
            LABELS.into_iter().zip(recorded).filter_map(|(label, d)| d.map(|_| label)).collect();
        let count = labels.len() + 1;
        self.slots[slot].recorded = labels;
        if let Some(timestamps) = &mut self.slots[slot].timestamps {
            // SAFETY: `commands` is being recorded outside a render pass; the slot's last command buffer has run. There
            // is one timestamp more than there are draws.
            unsafe { timestamps.begin(&device, commands, count) };
        }
        let this = &*self;
        let at = &this.slots[slot];
        let mut timed = 0;
        let mut write_timestamp = || {
            if let Some(timestamps) = &at.timestamps {
                let stage = vk::PipelineStageFlags::BOTTOM_OF_PIPE;
                // SAFETY: as above; begun.
                unsafe { timestamps.write(&device, commands, stage, timed) };
            }
            timed += 1;
        };
        let wait = |all: &[Barrier]| {
            // SAFETY: `commands` is being recorded outside a render pass; images are in the states that are stated.
            unsafe { Barriers::default().images(all).record(&device, commands) };
        };
        // SAFETY: `commands` is being recorded within the render pass that was begun before.
        let end = || unsafe { device.cmd_end_render_pass(commands) };
        wait(&this.entry(&read, outputs));
        write_timestamp();
        let scene = this.render_passes.scene[usize::from(outputs.depth.is_some())];
        this.begin(commands, scene, at.framebuffers[0]);
        this.draw(commands, (at, TERRAIN), bytemuck::bytes_of(&view.terrain), || {
            this.draw_tiles(commands, view.tiles);
        });
        write_timestamp();
        let triangle = || this.draw_triangle(commands);
        this.draw(commands, (at, SKY), bytemuck::bytes_of(&view.sky), triangle);
        write_timestamp();
        if let (Some(_), Some(push)) = (recorded[PLINTH], &view.plinth) {
            this.draw(commands, (at, PLINTH), bytemuck::bytes_of(push), || {
                let vertices = plinth_draw::vertices(push);
                // SAFETY: `commands` is being recorded within a render pass, a pipeline bound.
                unsafe { device.cmd_draw(commands, vertices, plinth_draw::FACES, 0, 0) };
            });
            write_timestamp();
        }
        end();
        if let (Some(_), Some(depth)) = (recorded[DEPTH_RESOLVE], &this.depth) {
            wait(&[of_kind(transition(depth.image, 1, TESTED, FETCHED), FETCHED)]);
            this.begin(commands, this.render_passes.depth, at.framebuffers[1]);
            this.draw(commands, (at, DEPTH_RESOLVE), &[], triangle);
            end();
            write_timestamp();
        }
        if let Some(linear) = &this.linear {
            wait(&[transition(linear.image, 1, DRAWN, READ)]);
            this.begin(commands, this.render_passes.tone, at.framebuffers[2]);
            let push = PictureTonePush { exposure };
            this.draw(commands, (at, TONE), bytemuck::bytes_of(&push), triangle);
            end();
            write_timestamp();
        }
        wait(&this.exit(&read, outputs));
        if let Some(timestamps) = &at.timestamps {
            // SAFETY: as above; all have been written.
            unsafe { timestamps.end(&device, commands, count) };
        }
    }

    fn entry(&self, read: &[&ImageArg], outputs: &ViewOutputs) -> Vec<Barrier> {
        let mut all: Vec<Barrier> =
            read.iter().map(|arg| transition(arg.image, 1, arg.before, READ)).collect();
        let mut own = |backed: &Option<Backed>, from, to| {
            all.extend(backed.as_ref().map(|b| begun(b.image, from, to)));
        };
        own(&self.many, DRAWN, DRAWN);
        // Its last use is either.
        let both = ImageState { stage: TESTED.stage | FETCHED.stage, ..TESTED };
        own(&self.depth, both, TESTED);
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

    /// Begins a render pass over the whole picture.
    fn begin(&self, commands: vk::CommandBuffer, pass: vk::RenderPass, into: vk::Framebuffer) {
        let [width, height] = self.shape.size;
        let area = vk::Rect2D { extent: vk::Extent2D { width, height }, ..Default::default() };
        let clears: &[_] = if self.render_passes.scene.contains(&pass) { &CLEARED } else { &[] };
        let info = vk::RenderPassBeginInfo::default()
            .render_pass(pass)
            .framebuffer(into)
            .render_area(area)
            .clear_values(clears);
        let viewport = [vk::Viewport {
            x: 0.0,
            y: 0.0,
            width: width as f32,
            height: height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        }];
        // SAFETY: `commands` is being recorded outside a render pass; the attachments have the picture's size and the
        // pass's layouts.
        unsafe {
            let contents = vk::SubpassContents::INLINE;
            self.host.device.cmd_begin_render_pass(commands, &info, contents);
            self.host.device.cmd_set_viewport(commands, 0, &viewport);
            self.host.device.cmd_set_scissor(commands, 0, &[area]);
        }
    }

    /// Binds a slot's drawing, by [`LABELS`], and records its draw, labelled.
    fn draw(
        &self,
        commands: vk::CommandBuffer,
        (at, index): (&Slot, usize),
        push: &[u8],
        record: impl FnOnce(),
    ) {
        let Some(Pipeline { pipeline, layout, push: range, .. }) = self.drawings[index] else {
            return;
        };
        let point = vk::PipelineBindPoint::GRAPHICS;
        let push = &push[..range.size as usize];
        let (device, sets) = (&self.host.device, [at.sets[index]]);
        let bound = || {
            // SAFETY: `commands` is being recorded within a render pass of the pipeline's formats; set and push
            // constants match its layout.
            unsafe {
                device.cmd_bind_pipeline(commands, point, pipeline);
                device.cmd_bind_descriptor_sets(commands, point, layout, 0, &sets, &[]);
                if !push.is_empty() {
                    device.cmd_push_constants(commands, layout, range.stage_flags, 0, push);
                }
            }
            record();
        };
        self.host.labelled(commands, || LABELS[index].to_owned(), bound);
    }

    fn draw_tiles(&self, commands: vk::CommandBuffer, tiles: u32) {
        let Some(indices) = &self.indices else { return };
        let device = &self.host.device;
        // SAFETY: `commands` is being recorded within a render pass, with the terrain's pipeline bound; the buffer
        // holds the indices of a tile.
        unsafe {
            device.cmd_bind_index_buffer(commands, indices.buffer, 0, vk::IndexType::UINT16);
            device.cmd_draw_indexed(commands, TILE * TILE * 6, tiles, 0, 0, 0);
        }
    }

    /// A triangle that covers the picture.
    fn draw_triangle(&self, commands: vk::CommandBuffer) {
        // SAFETY: `commands` is being recorded within a render pass, a pipeline bound.
        unsafe { self.host.device.cmd_draw(commands, 3, 1, 0, 0) };
    }

    fn write_sets(&self, slot: usize, inputs: &ViewInputs) {
        let [terrain, sky, plinth, resolve, tone] = self.slots[slot].sets;
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
        if self.drawings[PLINTH].is_some() {
            let views = [inputs.heights.view, inputs.radiance.view, voids.view];
            bound.extend((0..).zip(views).map(|(binding, view)| (plinth, binding, view)));
        }
        bound.extend(self.linear.as_ref().map(|linear| (tone, 0, linear.view)));
        let depth = self.depth.as_ref().filter(|_| self.drawings[DEPTH_RESOLVE].is_some());
        bound.extend(depth.map(|depth| (resolve, 0, depth.view)));
        let infos: Vec<_> = bound
            .iter()
            .map(|(set, _, view)| {
                let layout = if *set == resolve { FETCHED.layout } else { READ.layout };
                [vk::DescriptorImageInfo::default().image_view(*view).image_layout(layout)]
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

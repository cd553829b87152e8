//! Render passes of a view, and framebuffers for a recording.

use ash::vk;

use super::super::memory::DEPTH;
use super::super::{Host, failed};
use super::record_view::{DRAWN, TESTED};
use super::{ViewOutputs, ViewRenderer};
use crate::Result;

/// Render passes; null until made. Barriers outside them change the layouts.
#[derive(Default)]
pub(super) struct RenderPasses {
    /// Terrain, sky and plinth. [0] discards depth, [1] stores it.
    pub scene: [vk::RenderPass; 2],
    /// Depths alone.
    pub depth: vk::RenderPass,
    /// The tone curve.
    pub tone: vk::RenderPass,
}

/// Framebuffers of a recording, for the scene, depths and the tone curve; null where there is no such pass.
pub(super) type Framebuffers = [vk::Framebuffer; 3];

fn attachment(
    format: vk::Format,
    samples: vk::SampleCountFlags,
    load: vk::AttachmentLoadOp,
    is_kept: bool,
) -> vk::AttachmentDescription {
    let layout = if format == DEPTH { TESTED.layout } else { DRAWN.layout };
    let store =
        if is_kept { vk::AttachmentStoreOp::STORE } else { vk::AttachmentStoreOp::DONT_CARE };
    vk::AttachmentDescription::default()
        .format(format)
        .samples(samples)
        .load_op(load)
        .store_op(store)
        .stencil_load_op(vk::AttachmentLoadOp::DONT_CARE)
        .stencil_store_op(vk::AttachmentStoreOp::DONT_CARE)
        .initial_layout(layout)
        .final_layout(layout)
}

/// A render pass of one subpass.
fn make(
    host: &Host,
    attachments: &[vk::AttachmentDescription],
    [colour, depth, resolve]: [Option<u32>; 3],
) -> Result<vk::RenderPass> {
    let reference = |index: Option<u32>, layout| {
        index.map(|i| vk::AttachmentReference::default().attachment(i).layout(layout))
    };
    let colours: Vec<_> = reference(colour, DRAWN.layout).into_iter().collect();
    let resolves: Vec<_> = reference(resolve, DRAWN.layout).into_iter().collect();
    let depth = reference(depth, TESTED.layout);
    let mut subpass = vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&colours);
    if resolve.is_some() {
        subpass = subpass.resolve_attachments(&resolves);
    }
    if let Some(depth) = &depth {
        subpass = subpass.depth_stencil_attachment(depth);
    }
    let subpasses = [subpass];
    let info = vk::RenderPassCreateInfo::default().attachments(attachments).subpasses(&subpasses);
    // SAFETY: the device is alive; references are to attachments of their kind.
    unsafe { host.device.create_render_pass(&info, None) }
        .map_err(failed("making a render pass of views"))
}

impl RenderPasses {
    /// Makes all, for a scene drawn in a format with that many samples, and a picture of a format; after an error
    /// [`free`](Self::free) frees what was made.
    pub(super) fn make(
        &mut self,
        host: &Host,
        (drawn, samples): (vk::Format, vk::SampleCountFlags),
        picture: vk::Format,
    ) -> Result<()> {
        let one = vk::SampleCountFlags::TYPE_1;
        let (clear, any) = (vk::AttachmentLoadOp::CLEAR, vk::AttachmentLoadOp::DONT_CARE);
        for keeps_depth in [false, true] {
            let mut all = vec![
                attachment(drawn, samples, clear, samples == one),
                attachment(DEPTH, samples, clear, keeps_depth),
            ];
            let resolve = (samples != one).then(|| {
                all.push(attachment(drawn, one, any, true));
                2
            });
            self.scene[usize::from(keeps_depth)] = make(host, &all, [Some(0), Some(1), resolve])?;
        }
        self.depth = make(host, &[attachment(DEPTH, one, any, true)], [None, Some(0), None])?;
        self.tone = make(host, &[attachment(picture, one, any, true)], [Some(0), None, None])?;
        Ok(())
    }

    /// Destroys what has been made.
    pub(super) fn free(&mut self, host: &Host) {
        for pass in self.scene.into_iter().chain([self.depth, self.tone]) {
            // SAFETY: made by this device or null; the caller guarantees that nothing in flight uses it.
            unsafe { host.device.destroy_render_pass(pass, None) };
        }
        *self = Self::default();
    }
}

impl ViewRenderer {
    /// Replaces the framebuffers of a slot, whose last command buffer has run, by those of new outputs.
    pub(super) fn make_framebuffers(&mut self, slot: usize, outputs: &ViewOutputs) -> Result<()> {
        self.free_framebuffers(slot);
        let target = self.linear.as_ref().map_or(outputs.picture.view, |linear| linear.view);
        let own_depth = self.depth.as_ref().map_or_else(Default::default, |depth| depth.view);
        let kept = outputs.depth.map(|depth| depth.view);
        let is_first = self.many.is_some();
        let scene = match &self.many {
            Some(many) => vec![many.view, own_depth, target],
            None => vec![target, kept.unwrap_or(own_depth)],
        };
        let depth = kept.filter(|_| is_first).into_iter().collect();
        let tone = self.linear.iter().map(|_| outputs.picture.view).collect();
        let passes =
            [self.render_passes.scene[0], self.render_passes.depth, self.render_passes.tone];
        for (index, (views, pass)) in [scene, depth, tone].into_iter().zip(passes).enumerate() {
            if views.is_empty() {
                continue;
            }
            let [width, height] = self.shape.size;
            let info = vk::FramebufferCreateInfo::default()
                .render_pass(pass)
                .attachments(&views)
                .width(width)
                .height(height)
                .layers(1);
            // SAFETY: the views are alive, of the pass's formats and the picture's size, as has been checked.
            let made = unsafe { self.host.device.create_framebuffer(&info, None) };
            self.slots[slot].framebuffers[index] = made.map_err(failed("making a framebuffer"))?;
        }
        Ok(())
    }

    /// Destroys the framebuffers of a slot.
    pub(super) fn free_framebuffers(&mut self, slot: usize) {
        for framebuffer in std::mem::take(&mut self.slots[slot].framebuffers) {
            // SAFETY: made by this device or null; the slot's last command buffer has run.
            unsafe { self.host.device.destroy_framebuffer(framebuffer, None) };
        }
    }
}

/// Values that attachments are cleared to: colours, and the farthest depth.
pub(super) const CLEARED: [vk::ClearValue; 2] = [
    vk::ClearValue { color: vk::ClearColorValue { float32: [0.0; 4] } },
    vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: 0.0, stencil: 0 } },
];

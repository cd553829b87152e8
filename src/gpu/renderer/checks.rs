//! Checks of arguments before anything is recorded.

use ash::vk;

use super::buffers::check_buffer;
use super::stages::check_supported;
use super::{ImageArg, ImageState, InputArg, Progress, Renderer};
use crate::graph::{Kind, Owner, Resource, ResourceId};
use crate::{Error, Result};

impl Renderer {
    /// Whether the arguments match the plan.
    pub(super) fn check(
        &self,
        slot: usize,
        inputs: &[InputArg],
        outputs: &[ImageArg],
    ) -> Result<()> {
        if slot >= self.slots.len() {
            return Err(Error::setting(
                "slot",
                slot.to_string(),
                format!("less than {}", self.slots.len()),
            ));
        }
        let check_count = |what: &str, count: usize, wanted: Vec<(ResourceId, &Resource)>| {
            let names: Vec<_> = wanted.iter().map(|w| w.1.name.as_str()).collect();
            if count == wanted.len() {
                return Ok(());
            }
            let found = format!("{count} images");
            Err(Error::setting(what, found, format!("{}: {}", names.len(), names.join(", "))))
        };
        check_count("inputs", inputs.len(), self.plan.inputs().collect())?;
        for (arg, (_, resource)) in inputs.iter().zip(self.plan.inputs()) {
            match (arg, resource.owner == Owner::InputBuffer) {
                (InputArg::Image(image), false) => {
                    self.check_image(image, resource)?;
                }
                (InputArg::Buffer(buffer), true) => {
                    check_buffer(buffer, resource)?;
                    check_supported(&resource.name, "stage", buffer.stage, self.family)?;
                }
                (InputArg::Image(_), true) => {
                    let found = "an image";
                    return Err(Error::setting(
                        &resource.name,
                        found,
                        "a buffer, as the plan says",
                    ));
                }
                (InputArg::Buffer(_), false) => {
                    let expected = "an image, or a plan that takes a buffer";
                    return Err(Error::setting(&resource.name, "a buffer", expected));
                }
            }
        }
        check_count("outputs", outputs.len(), self.plan.outputs().collect())?;
        for (arg, (_, resource)) in outputs.iter().zip(self.plan.outputs()) {
            self.check_image(arg, resource)?;
        }
        let names = self.plan.inputs().chain(self.plan.outputs()).map(|(_, r)| r.name.as_str());
        let inputs = inputs.iter().map(|input| match input {
            InputArg::Image(image) => Some(image),
            InputArg::Buffer(_) => None,
        });
        let all = names.zip(inputs.chain(outputs.iter().map(Some)));
        check_apart(all.filter_map(|(name, image)| Some((name, image?))))
    }

    fn check_image(&self, arg: &ImageArg, resource: &Resource) -> Result<()> {
        let name = resource.name.as_str();
        if let Kind::Image { width, height, layers, .. } = resource.kind {
            check_image(name, arg, &self.formats(resource), [width, height, layers])?;
        }
        let is_output = resource.owner == Owner::Output;
        match is_output {
            true => check_left(name, arg)?,
            false => check_contents(name, arg)?,
        }
        check_state(name, "before", arg.before)?;
        check_supported(name, "stage before", arg.before.stage, self.family)?;
        if is_output {
            check_state(name, "after", arg.after)?;
            check_supported(name, "stage after", arg.after.stage, self.family)?;
        }
        Ok(())
    }

    /// Formats that the caller's image may have. A [`plan::reference`](crate::plan::reference()) accepts the plan's only: other
    /// results are compared with it, and what it derives, such as how densely it samples an environment, needs f32.
    fn formats(&self, resource: &Resource) -> Vec<vk::Format> {
        let Kind::Image { format, .. } = resource.kind else { return Vec::new() };
        let may_differ = resource.may_be_narrow() && !self.plan.is_traced();
        let all = format.vk_read().iter().copied();
        all.filter(|f| *f == format.vk() || may_differ && self.readable.contains(f)).collect()
    }

    /// Requires the plan's order, each pass once, and no pending pass skipped. Otherwise the plan's own images would be empty or
    /// hold results of another plan.
    pub(super) fn check_passes(&self, passes: &[usize]) -> Result<()> {
        let count = self.plan.passes.len();
        if let Some(pass) = passes.iter().find(|p| **p >= count) {
            return Err(Error::setting("pass", pass.to_string(), format!("less than {count}")));
        }
        if let Some(pair) = passes.windows(2).find(|pair| pair[0] >= pair[1]) {
            return Err(Error::setting(
                "passes",
                format!("{} after {}", pair[1], pair[0]),
                "each once, in the plan's order",
            ));
        }
        let is_pending = |pass: usize| self.progress[pass] == Progress::Pending;
        let Some(first) = (0..count).find(|pass| is_pending(*pass)) else { return Ok(()) };
        let affected = self.affected(passes);
        let last = passes.last().copied();
        let is_missing = |pass: &usize| {
            (is_pending(*pass) || affected[*pass]) && passes.binary_search(pass).is_err()
        };
        let missing = last.map_or(Some(first), |last| (0..last).find(is_missing));
        let Some(missing) = missing else { return Ok(()) };
        let found = last.map_or("none".into(), |last| format!("{last} without {missing}"));
        let expected = format!("pass {missing} first, or a recording of all passes");
        Err(Error::setting("passes", found, expected))
    }

    /// Requires that an output has contents if these passes use it without the plan's first pass that uses it: they read it or
    /// add to it.
    pub(super) fn check_kept(&self, outputs: &[ImageArg], passes: &[usize]) -> Result<()> {
        for (arg, (id, resource)) in outputs.iter().zip(self.plan.outputs()) {
            let uses = |pass: &usize| self.plan.passes[*pass].bindings.contains(&Some(id));
            let first = (0..self.plan.passes.len()).find(uses);
            let used = passes.iter().copied().find(uses);
            if let (Some(first), Some(used)) = (first, used)
                && first != used
            {
                let expected = format!(
                    "a layout with the contents of pass {first}, which pass {used} reads or adds to"
                );
                check_layout(&resource.name, "before", arg.before.layout, &expected)?;
            }
        }
        Ok(())
    }

    /// Passes that must run because of those of `passes` that are recorded again, these included: they read what those write, add to
    /// the same sum, or their inputs were overwritten. None for a whole recording.
    pub(super) fn affected(&self, passes: &[usize]) -> Vec<bool> {
        let mut runs = vec![false; self.plan.passes.len()];
        if passes.len() < runs.len() {
            let again = passes.iter().filter(|pass| self.progress[**pass] != Progress::Pending);
            again.for_each(|pass| runs[*pass] = true);
            self.plan.add_followers(&mut runs);
        }
        runs
    }

    /// Whether an edit can continue from the last recording.
    pub(super) fn check_drawn(&self, outputs: &[ImageArg]) -> Result<()> {
        let pending = self.progress.iter().filter(|p| **p != Progress::Current).count();
        if pending > 0 {
            let count = self.plan.passes.len();
            return Err(Error::setting(
                "an edit",
                format!("{pending} of {count} passes must be recorded first"),
                "a recording of all passes, or of those that replace_plan returned",
            ));
        }
        let names = self.plan.outputs().map(|(_, r)| &r.name);
        for (name, arg) in names.zip(outputs) {
            let expected = "a layout with the contents of the last recording";
            check_layout(name, "before an edit", arg.before.layout, expected)?;
        }
        Ok(())
    }
}

/// Refuses a layout without contents.
fn check_layout(name: &str, when: &str, layout: vk::ImageLayout, expected: &str) -> Result<()> {
    if !matches!(layout, vk::ImageLayout::UNDEFINED | vk::ImageLayout::PREINITIALIZED) {
        return Ok(());
    }
    Err(Error::setting(format!("{name}: layout {when}"), format!("{layout:?}"), expected))
}

/// Refuses an image that is read and has no contents.
pub(in crate::gpu) fn check_contents(name: &str, arg: &ImageArg) -> Result<()> {
    check_layout(name, "before", arg.before.layout, "a layout with contents")
}

/// Refuses to leave an image without contents.
pub(in crate::gpu) fn check_left(name: &str, arg: &ImageArg) -> Result<()> {
    check_layout(name, "after", arg.after.layout, "a layout to be left in")
}

/// Refuses null handles, and other formats and another size than these.
pub(in crate::gpu) fn check_image(
    name: &str,
    arg: &ImageArg,
    formats: &[vk::Format],
    extent: [u32; 3],
) -> Result<()> {
    if arg.image == vk::Image::null() || arg.view == vk::ImageView::null() {
        return Err(Error::setting(name, "a null image or view", "an image"));
    }
    if !formats.contains(&arg.format) {
        let names: Vec<_> = formats.iter().map(|f| format!("{f:?}")).collect();
        let (name, found) = (format!("{name}: format"), format!("{:?}", arg.format));
        return Err(Error::setting(name, found, names.join(" or ")));
    }
    if arg.extent != extent {
        let (name, found) = (format!("{name}: extent"), format!("{:?}", arg.extent));
        return Err(Error::setting(name, found, format!("{extent:?} (columns, rows, layers)")));
    }
    Ok(())
}

/// No image is passed twice: it could not be in two states.
pub(in crate::gpu) fn check_apart<'a>(
    all: impl Iterator<Item = (&'a str, &'a ImageArg)>,
) -> Result<()> {
    let mut earlier: Vec<(&str, &ImageArg)> = Vec::new();
    for (name, arg) in all {
        if let Some((other, _)) = earlier.iter().find(|(_, earlier)| earlier.image == arg.image) {
            let found = format!("the image of {other}");
            return Err(Error::setting(name, found, "an image of its own"));
        }
        earlier.push((name, arg));
    }
    Ok(())
}

/// Refuses stages and accesses that no barrier can name.
pub(in crate::gpu) fn check_stage(name: &str, when: &str, state: ImageState) -> Result<()> {
    let ImageState { stage, access, .. } = state;
    if stage == vk::PipelineStageFlags2::NONE && access != vk::AccessFlags2::NONE {
        return Err(Error::setting(
            format!("{name}: stage {when}"),
            format!("NONE, with access {access:?}"),
            "the stages of this access",
        ));
    }
    Ok(())
}

/// The same, and layouts that no colour image can be in.
pub(in crate::gpu) fn check_state(name: &str, when: &str, state: ImageState) -> Result<()> {
    check_stage(name, when, state)?;
    let layout = state.layout;
    let of_depth = [
        vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
        vk::ImageLayout::DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL,
        vk::ImageLayout::DEPTH_ATTACHMENT_STENCIL_READ_ONLY_OPTIMAL,
        vk::ImageLayout::DEPTH_ATTACHMENT_OPTIMAL,
        vk::ImageLayout::DEPTH_READ_ONLY_OPTIMAL,
        vk::ImageLayout::STENCIL_ATTACHMENT_OPTIMAL,
        vk::ImageLayout::STENCIL_READ_ONLY_OPTIMAL,
    ];
    if of_depth.contains(&layout) {
        return Err(Error::setting(
            format!("{name}: layout {when}"),
            format!("{layout:?}"),
            "a layout of a colour image",
        ));
    }
    Ok(())
}

//! What is refused before anything is recorded.

use ash::vk;

use super::{ImageArg, Renderer};
use crate::plan::{Kind, Owner, Resource, ResourceId};
use crate::{Error, Result};

impl Renderer {
    /// Whether the arguments are what the plan says.
    pub(super) fn check(
        &self,
        slot: usize,
        inputs: &[ImageArg],
        outputs: &[ImageArg],
    ) -> Result<()> {
        if slot >= self.slots.len() {
            return Err(Error::setting(
                "slot",
                slot.to_string(),
                format!("less than {}", self.slots.len()),
            ));
        }
        let check_all = |what: &str, args: &[ImageArg], wanted: Vec<(ResourceId, &Resource)>| {
            if args.len() != wanted.len() {
                let names: Vec<_> = wanted.iter().map(|w| w.1.name.as_str()).collect();
                return Err(Error::setting(
                    what,
                    format!("{} images", args.len()),
                    format!("{}: {}", names.len(), names.join(", ")),
                ));
            }
            args.iter().zip(wanted).try_for_each(|(arg, (_, resource))| check_image(arg, resource))
        };
        check_all("inputs", inputs, self.plan.inputs().collect())?;
        check_all("outputs", outputs, self.plan.outputs().collect())
    }

    /// In the plan's order, each once; so that as many as there are, are all. Fewer only after all: the
    /// plan's own images would hold nothing.
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
        if passes.len() < count && !self.is_drawn {
            return Err(Error::setting(
                "passes",
                format!("{} of {count}, nothing recorded", passes.len()),
                "a recording of all passes before",
            ));
        }
        Ok(())
    }

    /// Whether an edit can go on from what was recorded last.
    pub(super) fn check_drawn(&self, outputs: &[ImageArg]) -> Result<()> {
        if !self.is_drawn {
            return Err(Error::setting("an edit", "nothing recorded", "a recording of all passes"));
        }
        let pending = self.pending.iter().filter(|p| **p).count();
        if pending > 0 {
            return Err(Error::setting(
                "an edit",
                format!("{pending} passes of the new plan not recorded"),
                "a recording of what replace_plan returned",
            ));
        }
        let names = self.plan.outputs().map(|(_, r)| &r.name);
        for (name, arg) in names.zip(outputs) {
            if is_without_contents(arg.before.layout) {
                return Err(Error::setting(
                    format!("{name}: layout before an edit"),
                    format!("{:?}", arg.before.layout),
                    "a layout with the contents of the last recording",
                ));
            }
        }
        Ok(())
    }
}

fn is_without_contents(layout: vk::ImageLayout) -> bool {
    matches!(layout, vk::ImageLayout::UNDEFINED | vk::ImageLayout::PREINITIALIZED)
}

fn check_image(arg: &ImageArg, resource: &Resource) -> Result<()> {
    let Kind::Image { format, width, height, layers, .. } = resource.kind else { return Ok(()) };
    let name = &resource.name;
    if arg.image == vk::Image::null() || arg.view == vk::ImageView::null() {
        return Err(Error::setting(name, "a null image or view", "an image"));
    }
    if arg.format != format.vk() {
        return Err(Error::setting(
            format!("{name}: format"),
            format!("{:?}", arg.format),
            format!("{:?}", format.vk()),
        ));
    }
    if arg.extent != [width, height, layers] {
        return Err(Error::setting(
            format!("{name}: extent"),
            format!("{:?}", arg.extent),
            format!("{:?} (columns, rows, layers)", [width, height, layers]),
        ));
    }
    if resource.owner == Owner::Input && is_without_contents(arg.before.layout) {
        return Err(Error::setting(
            format!("{name}: layout"),
            format!("{:?}", arg.before.layout),
            "a layout with contents",
        ));
    }
    if resource.owner == Owner::Output && is_without_contents(arg.after.layout) {
        return Err(Error::setting(
            format!("{name}: layout after"),
            format!("{:?}", arg.after.layout),
            "a layout to be left in",
        ));
    }
    Ok(())
}

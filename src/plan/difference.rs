//! Why a plan needs a renderer of its own.

use super::Plan;
use crate::graph::{Kind, Owner, Pass, Resource};

/// A difference: as in the new plan, and as in the old one.
type Pair = [String; 2];

impl Plan {
    /// What differs from `before` where a renderer of `before` cannot take this plan: the size of the field, or the
    /// settings that differ and the first image, buffer or pass. `None` where the renderer can take it.
    pub(crate) fn difference(&self, before: &Plan) -> Option<Pair> {
        if self.resources == before.resources && self.has_passes_of(before) {
            return None;
        }
        if self.size != before.size {
            return Some(
                [self, before].map(|p| format!("a field of {} × {}", p.size[0], p.size[1])),
            );
        }
        let mut pairs = settings(self, before);
        // What only one of the plans has explains more than what both have in different sizes.
        let only = [resource(self, before, |r| r.name.clone()), pass(self, before)];
        let is_only = only.iter().any(Option::is_some);
        pairs.extend(only.into_iter().flatten());
        if !is_only {
            pairs.extend(resource(self, before, described).or_else(|| parts(self, before)));
        }
        if pairs.is_empty() {
            pairs.push(["other images, buffers or passes", "the same ones"].map(str::to_owned));
        }
        Some([0, 1].map(|i| {
            let texts: Vec<&str> = pairs.iter().map(|pair| pair[i].as_str()).collect();
            texts.join(", ")
        }))
    }
}

fn settings(new: &Plan, old: &Plan) -> Vec<Pair> {
    let text = |plan: &Plan, name: &str| {
        let of_name = plan.settings.iter().find(|setting| setting.0 == name);
        of_name.map_or_else(|| format!("no {name}"), |(name, value)| format!("{name} {value}"))
    };
    let added = new.settings.iter().filter(|s| old.settings.iter().all(|o| o.0 != s.0));
    let names = old.settings.iter().chain(added).map(|setting| &setting.0);
    names.map(|name| [text(new, name), text(old, name)]).filter(|[new, old]| new != old).collect()
}

/// The first image or buffer of which `text`s differ.
fn resource(new: &Plan, old: &Plan, text: fn(&Resource) -> String) -> Option<Pair> {
    let text = |plan: &Plan, name: &str| {
        let of_name = plan.find(name).map(|id| text(&plan.resources[id.0]));
        of_name.unwrap_or_else(|| format!("no {name}"))
    };
    let all = old.resources.iter().chain(&new.resources);
    all.map(|r| [text(new, &r.name), text(old, &r.name)]).find(|[new, old]| new != old)
}

fn described(resource: &Resource) -> String {
    let owner = match resource.owner {
        Owner::Internal => "",
        Owner::Input => "input ",
        Owner::InputBuffer => "input in a buffer ",
        Owner::Output => "output ",
    };
    let name = &resource.name;
    match resource.kind {
        Kind::Image { format, width, height, layers, .. } => {
            format!("{owner}{name} of {width} × {height} × {layers} {}", format.spirv())
        }
        Kind::Buffer { bytes, .. } => format!("{owner}{name} of {bytes} bytes"),
    }
}

/// The first place at which the plans have passes of different shaders.
fn pass(new: &Plan, old: &Plan) -> Option<Pair> {
    let count = |plan: &Plan| plan.every_pass().count();
    let text = |plan: &Plan, i: usize| match plan.every_pass().nth(i) {
        Some(pass) => format!("pass {i} {}", pass.label()),
        None => format!("no pass {i}"),
    };
    let name = |plan: &Plan, i: usize| plan.every_pass().nth(i).map(Pass::name);
    let first = (0..count(new).max(count(old))).find(|i| name(new, *i) != name(old, *i))?;
    Some([text(new, first), text(old, first)])
}

/// The first pass whose specialisation constants or bindings differ, where the shaders are the same.
fn parts(new: &Plan, old: &Plan) -> Option<Pair> {
    let all = new.every_pass().zip(old.every_pass()).enumerate();
    all.filter_map(|(i, (a, b))| {
        let [c, d] = part((new, a), (old, b))?;
        Some([format!("pass {i} {} {c}", a.label()), format!("pass {i} {} {d}", b.label())])
    })
    .next()
}

/// The first specialisation constant or binding of a pass that differs.
fn part((new, a): (&Plan, &Pass), (old, b): (&Plan, &Pass)) -> Option<Pair> {
    let constants = a.shader.constants.iter().zip(a.constants.iter().zip(&b.constants));
    let constant = constants.clone().find(|(_, (a, b))| a != b);
    if let Some((constant, (a, b))) = constant {
        return Some([a, b].map(|value| format!("with {} {value}", constant.name)));
    }
    let name = |plan: &Plan, pass: &Pass, i: usize| {
        let id = pass.bindings.get(i).copied().flatten();
        id.map_or("nothing", |id| plan.resources[id.0].name.as_str()).to_owned()
    };
    let count = a.bindings.len().max(b.bindings.len());
    let bound = (0..count).map(|i| [name(new, a, i), name(old, b, i)]);
    let other = bound.into_iter().find(|[new, old]| new != old)?;
    Some(other.map(|name| format!("on {name}")))
}

#[cfg(test)]
mod tests {
    use crate::graph::{Limits, ResourceId};
    use crate::plan::{self, Picture, Plan};
    use crate::scene::{Lights, Quality, Scene, Sun, Surface, fractal};

    fn sun(azimuth_rad: f64) -> Sun {
        Sun { azimuth_rad, elevation_rad: 0.4, diameter_rad: 0.01, irradiance: [2.0, 1.5, 1.0] }
    }

    fn plan(side: usize, suns: &[f64], quality: &Quality) -> Plan {
        let suns = suns.iter().copied().map(sun).collect();
        let lights = Lights { sky: Some([1.0, 0.9, 0.8]), suns, ..Lights::default() };
        let scene = Scene { field: fractal(side, 1).unwrap(), surface: Surface::default(), lights };
        plan::picture(&scene, quality, &Limits::lavapipe(), Picture::default()).unwrap()
    }

    /// Each change that needs another renderer, with a word of the new plan and of the old one.
    #[test]
    fn a_refused_plan_names_what_differs() {
        let quality = Quality { azimuths: 16, ..Quality::default() };
        let old = plan(32, &[1.0], &quality);
        assert_eq!(old.difference(&old), None);
        assert_eq!(plan(32, &[1.01], &quality).difference(&old), None);
        let finer = Quality { azimuths: 24, ..quality };
        let mut renamed = old.clone();
        renamed.passes[0].constants[0] += 1;
        let mut bound = old.clone();
        let other = ResourceId(old.resources.len() - 1);
        let at = bound.passes[1].bindings.iter().position(|id| *id != Some(other)).unwrap();
        bound.passes[1].bindings[at] = Some(other);
        let mut shorter = old.clone();
        shorter.passes.pop();
        let last = format!("no pass {}", shorter.passes.len());
        let constant = old.passes[0].shader.constants[0].name;
        let with = |value: u32| format!("with {constant} {value}");
        let value = old.passes[0].constants[0];
        let cases = [
            (plan(33, &[1.0], &quality), "a field of 33 × 33".into(), "a field of 32 × 32".into()),
            (plan(32, &[1.0], &finer), "azimuths 24".into(), "azimuths 16".into()),
            (
                plan(32, &[1.0, 2.0], &quality),
                "shadow_maxima_1, pass ".into(),
                "no shadow_maxima_1".into(),
            ),
            (plan(32, &[], &quality), "no sun_sum, ".into(), "sun_sum, pass ".into()),
            (renamed, with(value + 1), with(value)),
            (bound, format!("on {}", old.resources[other.0].name), "on ".into()),
            (shorter, last, "light_resolve".into()),
        ];
        for (new, found, expected) in cases {
            let [new, old] = new.difference(&old).expect(&found);
            println!("found {new}, expected {old}");
            assert!(new.contains(&found), "{new}: {found}");
            assert!(old.contains(&expected), "{old}: {expected}");
        }
    }
}

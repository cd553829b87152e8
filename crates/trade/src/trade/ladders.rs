//! The settings that trade speed for accuracy, each as a ladder from fast to slow. To add a method
//! or a setting, add its ladder in [`ladders`]; search, frontier and report know none by name.
//!
//! Hull storage has no ladder: it costs time and never changes the result.

use ridgelight::scene::{
    Basis, Fuse, Lights, Lines, Method, Precision, Quality, Scene, Values, setting,
};
use std::ops::RangeInclusive;

/// One setting, or two that exclude each other, and the values to search.
#[derive(Clone, Debug)]
pub struct Ladder {
    /// Name of the setting.
    pub name: &'static str,
    /// Its values as settings, "`lines 1`", from fast to slow.
    pub steps: Vec<String>,
    /// The range of a count, of which the steps are a few values; none for a choice, whose steps
    /// are complete.
    pub range: Option<RangeInclusive<u32>>,
    /// Index of the default step.
    pub default: usize,
    /// What the slower end buys.
    pub slower: &'static str,
    /// The steps as "name value", one or more.
    values: Vec<String>,
    /// Whether it has no effect beside the other settings; none for one that always has.
    idle: Option<fn(&Quality) -> bool>,
}

impl Ladder {
    /// From `values` of settings: "name value value ..." each, from fast to slow.
    fn new(name: &'static str, values: &[&str], slower: &'static str) -> Self {
        let each = |of: &&str| {
            let (setting, values) = of.rsplit_once(": ").expect("a setting and its values");
            values.split(' ').map(|value| format!("{setting} {value}")).collect::<Vec<_>>()
        };
        let all: Vec<String> = values.iter().flat_map(each).collect();
        let quoted = |(name, value)| format!("`{name} {value}`");
        let steps = all.iter().map(|v| pairs(v).map(quoted).collect::<Vec<_>>().join(" "));
        let range = match pairs(&all[0]).next().and_then(|(name, _)| setting(name)) {
            Some(setting) => match &setting.values {
                Values::Whole(range) => Some(range.clone()),
                _ => None,
            },
            None => None,
        };
        Self { name, steps: steps.collect(), range, default: 0, slower, values: all, idle: None }
    }

    fn idle_if(self, idle: fn(&Quality) -> bool) -> Self {
        Self { idle: Some(idle), ..self }
    }

    /// Applies a step to a quality.
    fn set(&self, quality: &mut Quality, step: usize) {
        for (name, value) in pairs(&self.values[step]) {
            let setting = setting(name).expect("a setting");
            setting.set(quality, value).expect("a value that it takes");
        }
    }

    fn is_idle(&self, quality: &Quality) -> bool {
        self.idle.is_some_and(|idle| idle(quality))
    }
}

/// The settings and values of "name value name value".
fn pairs(text: &str) -> impl Iterator<Item = (&str, &str)> {
    let mut words = text.split(' ');
    std::iter::from_fn(move || Some((words.next()?, words.next()?)))
}

/// Whether horizons are not found along lines a distance apart.
pub(crate) fn has_no_lines(quality: &Quality) -> bool {
    matches!(quality.method, Method::BruteForce | Method::Pyramid) || quality.lines == Lines::Exact
}

/// The same, or whether suns have exact shadows, beside which fuse and precision have their defaults.
fn has_no_choice_of_lines(quality: &Quality) -> bool {
    has_no_lines(quality) || quality.method == Method::Auto
}

fn has_no_levels(quality: &Quality) -> bool {
    quality.method != Method::Pyramid
}

/// Whether some lights are integrated in slices: suns that are not points, key lights, sphere lights.
pub(crate) fn have_slices(lights: &Lights) -> bool {
    let have_others = !lights.keys.is_empty() || lights.near().next().is_some();
    have_others || lights.suns.iter().any(|s| !s.is_point())
}

/// Whether the surface has Phong specular.
pub(crate) fn has_specular(scene: &Scene) -> bool {
    scene.surface.specular.as_ref().is_some_and(|specular| specular.largest().scale > 0.0)
}

/// The ladders that affect a scene with this many bounces: no azimuths without a sky, no table
/// without an environment. Bounces of Phong specular are measured with pyramids only, at every texel.
pub fn ladders(scene: &Scene, bounces: u32) -> Vec<Ladder> {
    // No setting changes anything about lights of radiance 0.
    let (lights, has_specular) = (&scene.lights.lit(), has_specular(scene));
    let (has_sky, has_environment) = (lights.sky.is_some(), lights.environment.is_some());
    let mut all = Vec::new();
    let mut add = |is_in: bool, ladder: Ladder| all.extend(is_in.then_some(ladder));
    // Sphere lights compute their own visibility.
    let is_aimed = !lights.suns.is_empty() || !lights.keys.is_empty();
    let has_horizons = has_sky || has_environment || is_aimed;
    let has_suns = !lights.suns.is_empty();
    let methods =
        if has_suns { "method: pyramid auto brute-force" } else { "method: pyramid brute-force" };
    let sweep = Ladder::new(
        "sweep",
        &["lines: 4 2 1 1/2 1/4 exact", methods],
        "closer lines, then every grid point on a line: small occluders; a pyramid of heights, \
         slower only; exact shadows of suns; brute force",
    );
    add(has_horizons, sweep);
    let fuse = Ladder::new(
        "fuse",
        &["fuse: nearest slopes own aimed-nearest aimed aimed-around"],
        "more of the lines' results, then the surface itself, then all around there: horizons of each \
         grid point",
    );
    add(has_horizons, fuse.idle_if(has_no_choice_of_lines));
    let stored = "more bits: heights on the hull, stored slopes";
    let precision = Ladder::new("precision", &["precision: packed f16 f32"], stored);
    add(has_horizons, precision.idle_if(has_no_choice_of_lines));
    let between = "more levels of a pyramid: occluders between two grid points";
    let level_step = Ladder::new("level step", &["level_step: 1 2 4 8 16"], between);
    add(has_horizons, level_step.idle_if(has_no_levels));
    let distant = "finer levels of a pyramid: sharp distant horizons";
    let level_offset = Ladder::new("level offset", &["level_offset: 0 1 2 3 4"], distant);
    add(has_horizons, level_offset.idle_if(has_no_levels));
    let sharp = "more azimuths: sharp silhouettes";
    let azimuths = Ladder::new("azimuths", &["azimuths: 8 16 32 64 128 256"], sharp);
    add(has_sky || has_environment, azimuths);
    let soft = "more slices of a sun's disc, a key light or a sphere light: soft shadows";
    let slices = Ladder::new("sun azimuths", &["sun_azimuths: 1 2 4 8 16 32"], soft);
    add(have_slices(lights), slices);
    let exact = "each slice of a sphere light exact: sharp shadows";
    let light_basis = Ladder::new("light basis", &["light_basis: sh exact"], exact);
    add(lights.near().next().is_some() && !has_specular, light_basis);
    let bright = "more elevations per table: small bright features";
    let elevations = &["table_elevations: 32 64 128 256 512 1024"];
    let table = Ladder::new("table elevations", elevations, bright);
    add(has_environment, table.idle_if(|q| q.basis == Basis::Sh));
    let has_specular_bounces = has_specular && bounces > 0;
    // With specular and bounces, the SH order also matters beside tables: light between bounces is in SH.
    let (bases, detail): (&[&str], _) = if has_specular_bounces {
        (&["basis: sh table"], "SH, then tables: the environment's detail")
    } else {
        let detail = "higher orders of harmonics, then tables: the environment's detail";
        (&["basis sh sh_order: 2 3 4 5 6", "basis: table"], detail)
    };
    let has_light_around = has_environment || (has_sky && has_specular);
    add(has_light_around, Ladder::new("basis", bases, detail));
    let sharp = "higher SH orders: sharper lobes between bounces";
    add(has_specular_bounces, Ladder::new("SH order", &["sh_order: 2 3 4 5 6"], sharp));
    let dense = "visibility and indirect light at more texels: sharp shadows";
    let subsample = Ladder::new("sub-sampling", &["subsample: 4 2 1"], dense);
    add(
        (has_environment || bounces > 0) && !has_specular_bounces,
        subsample.idle_if(|q| q.basis != Basis::Sh && q.bounces.count == 0),
    );
    let stored = "radiance by direction, then in full precision: specular bounces";
    let by = &["bounce_specular: scalar vector-f16 vector"];
    add(bounces > 0 && has_specular, Ladder::new("bounce specular", by, stored));
    let visible = "one lookup per level of pyramids; every visible interval of the surface";
    let by = &["bounce_engine: pyramid auto brute-force"];
    add(bounces > 0 && !has_specular, Ladder::new("bounce engine", by, visible));
    let narrow = "more azimuths of bounces: narrow bright features";
    let azimuths = &["bounce_azimuths: 8 16 32 64"];
    add(bounces > 0, Ladder::new("bounce azimuths", azimuths, narrow));
    let start = start_for(scene);
    for ladder in &mut all {
        let is_default = |step: &usize| {
            let mut quality = start;
            ladder.set(&mut quality, *step);
            quality == start
        };
        let default = (0..ladder.steps.len()).find(is_default);
        ladder.default = default.expect("every default is on its ladder");
    }
    all
}

/// The start of the defaults: sweeps and tables, to which they resolve.
pub fn start() -> Quality {
    Quality { method: Method::Sweep, basis: Basis::Table, ..Quality::default() }
}

/// [`start`] with the scene's default azimuths, for a view from straight above.
pub fn start_for(scene: &Scene) -> Quality {
    Quality { azimuths: Quality::for_scene(scene, None).azimuths, ..start() }
}

/// Settings, and their step on each ladder.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// The settings.
    pub quality: Quality,
    /// A step for each ladder; none where it has no effect.
    pub steps: Vec<Option<usize>>,
}

impl Place {
    /// Its settings, as "`lines 1` `azimuths 64`".
    pub fn flags(&self, ladders: &[Ladder]) -> String {
        let each =
            ladders.iter().zip(&self.steps).filter_map(|(k, s)| Some(k.steps[(*s)?].as_str()));
        each.collect::<Vec<_>>().join(" ")
    }
}

/// Every distinct combination of steps, from fast to slow; other settings as in `start`.
pub fn places(ladders: &[Ladder], start: &Quality) -> Vec<Place> {
    // Ladders that always have an effect decide which others have one.
    let mut order: Vec<usize> = (0..ladders.len()).collect();
    order.sort_by_key(|k| ladders[*k].idle.is_some());
    let mut all = vec![Place { quality: *start, steps: vec![None; ladders.len()] }];
    for k in order {
        let ladder = &ladders[k];
        let with = |place: Place| {
            let set = |step: usize| {
                let mut place = place.clone();
                ladder.set(&mut place.quality, step);
                place.steps[k] = Some(step);
                place
            };
            match ladder.is_idle(&place.quality) {
                true => vec![place],
                false => (0..ladder.steps.len()).map(set).collect(),
            }
        };
        all = all.into_iter().flat_map(with).collect();
    }
    // Where no slopes are stored, f16 is f32.
    all.retain(|Place { quality, .. }| {
        let stores_slopes = matches!(quality.fuse, Fuse::Nearest | Fuse::Slopes);
        quality.precision != Precision::F16 || stores_slopes || has_no_lines(quality)
    });
    all.sort_by_cached_key(|p| p.steps.iter().rev().map(|s| s.unwrap_or(0)).collect::<Vec<_>>());
    all
}

/// Places that are refused whatever their counts are, with the reason.
///
/// `why` is called for places that differ from the defaults in one or two choices: no known refusal
/// needs three, and none depends on a count within its range. Every place with a refused
/// combination is refused, too.
pub fn refused(
    ladders: &[Ladder],
    places: &[Place],
    mut why: impl FnMut(&Place) -> Option<String>,
) -> Vec<(usize, String)> {
    let mut known: Vec<(Vec<(usize, usize)>, String)> = Vec::new();
    let others = |place: &Place| -> Vec<(usize, usize)> {
        let steps = place.steps.iter().enumerate().filter_map(|(k, s)| Some((k, (*s)?)));
        steps.filter(|(k, s)| ladders[*k].default != *s).collect()
    };
    let has = |place: &Place, steps: &[(usize, usize)]| {
        steps.iter().all(|(ladder, step)| place.steps[*ladder] == Some(*step))
    };
    for count in 1..=2 {
        for place in places {
            let steps = others(place);
            let is_choice = steps.iter().all(|(ladder, _)| ladders[*ladder].range.is_none());
            let is_known = known.iter().any(|(of, _)| has(place, of));
            if steps.len() == count && is_choice && !is_known {
                known.extend(why(place).map(|why| (steps, why)));
            }
        }
    }
    let of = |place: &Place| known.iter().find(|(steps, _)| has(place, steps));
    let all = places.iter().enumerate();
    all.filter_map(|(i, place)| Some((i, of(place)?.1.clone()))).collect()
}

#[cfg(test)]
mod tests;

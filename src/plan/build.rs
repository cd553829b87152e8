use super::azimuths::{self, Azimuth};
use super::batch::{self, Axis, Batch, bytes_text};
use super::pass::place_barriers;
use super::sweep::{HullPlace, LineSweep, Sweep};
use super::{Format, Kind, Limits, Owner, Pass, Plan, Resource, ResourceId};
use crate::gpu::shaders::Shader;
use crate::passes;
use crate::scene::{Albedo, Border, HeightField, Lights, Lines, Method, Quality, Scene, Surface};
use crate::{Error, Result};

/// What a picture should hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Picture {
    /// Besides the whole, an image for each light.
    pub light_layers: bool,
    /// Besides, what a sky of radiance 1 gives to albedo 1: the sky-view factor of a tilted
    /// receiver, [0..1].
    pub sky_view: bool,
}

/// Collects a plan.
pub(crate) struct Builder {
    resources: Vec<Resource>,
    passes: Vec<Pass>,
}

impl Builder {
    fn new() -> Self {
        Self { resources: Vec::new(), passes: Vec::new() }
    }

    fn image(
        &mut self,
        name: impl Into<String>,
        owner: Owner,
        format: Format,
        [width, height, layers]: [u32; 3],
        layered: bool,
    ) -> ResourceId {
        self.resources.push(Resource {
            name: name.into(),
            kind: Kind::Image { format, width, height, layers, layered },
            owner,
        });
        ResourceId(self.resources.len() - 1)
    }

    fn buffer(&mut self, name: &str, bytes: u64, texels: bool) -> ResourceId {
        self.resources.push(Resource {
            name: name.into(),
            kind: Kind::Buffer { bytes, texels },
            owner: Owner::Internal,
        });
        ResourceId(self.resources.len() - 1)
    }

    /// Adds a dispatch of `shader`; `bound` names its bindings, all others are unused.
    #[expect(clippy::too_many_arguments, reason = "a pass is all of this")]
    pub(crate) fn pass<P: bytemuck::Pod>(
        &mut self,
        shader: &'static Shader,
        part: &str,
        why: impl Into<String>,
        groups: [u32; 3],
        constants: &[(u32, u32)],
        push: &P,
        bound: &[(&str, ResourceId)],
        bytes: u64,
        samples: u64,
    ) {
        let push = bytemuck::bytes_of(push).to_vec();
        assert_eq!(push.len(), shader.push_bytes as usize, "{}: push constants", shader.name);
        for (name, id) in bound {
            let binding = shader.bindings.iter().find(|b| b.name == *name);
            let binding = binding.unwrap_or_else(|| panic!("{} binds no {name}", shader.name));
            let resource = &self.resources[id.0];
            assert!(
                resource.fits(binding.kind),
                "{}: {} is no {:?}",
                shader.name,
                resource.name,
                binding.kind
            );
        }
        let bindings = shader
            .bindings
            .iter()
            .map(|b| bound.iter().find(|(name, _)| b.name == *name).map(|(_, id)| *id))
            .collect();
        self.passes.push(Pass {
            shader,
            part: part.to_owned(),
            why: why.into(),
            groups,
            constants: constants.to_vec(),
            push,
            bindings,
            bytes,
            samples,
            barrier_before: false,
        });
    }

    fn bytes(&self) -> u64 {
        self.resources.iter().map(Resource::bytes).sum()
    }
}

/// What every sweep of a plan shares.
struct Sweeping {
    sweep: Sweep,
    heights: ResourceId,
    azimuths: ResourceId,
    /// Heights by lanes of each axis that is marched: columns', rows'.
    lane_heights: [Option<ResourceId>; 2],
    /// Whether the sweep reads its heights from them too, four lanes at a time.
    quads: bool,
    lattice: ResourceId,
    /// Where both are stored, the one that is not the lattice.
    occluders: Option<ResourceId>,
    slopes: Option<ResourceId>,
    lost_lines: Option<ResourceId>,
}

impl Sweeping {
    /// Heights by lanes of a batch's axis.
    fn lane_heights(&self, batch: &Batch) -> ResourceId {
        self.lane_heights[usize::from(batch.axis.marches_rows)].expect("made for every axis used")
    }

    fn record(&self, builder: &mut Builder, batch: &Batch, part: &str) {
        match &self.sweep {
            Sweep::Lines(lines) => {
                let images = passes::horizon_sweep::Images {
                    heights: self.heights,
                    lane_heights: self.quads.then(|| self.lane_heights(batch)),
                    azimuths: self.azimuths,
                    occluders: self.occluders,
                    slopes: self.slopes,
                    lost_lines: self.lost_lines,
                };
                passes::horizon_sweep::plan(builder, lines, batch, part, &images);
            }
            Sweep::Surface { hull_depth, distances } => {
                let ids = [self.heights, self.azimuths, self.lattice];
                passes::surface_sweep::plan(builder, batch, part, *hull_depth, *distances, ids);
            }
            Sweep::March { distances } => {
                let ids = [self.heights, self.azimuths, self.lattice];
                passes::horizon_march::plan(builder, batch, part, *distances, ids);
            }
        }
    }
}

/// Azimuth lists, one a light, in the order of the buffer; and how they are cut.
struct Lists {
    lists: Vec<Vec<Azimuth>>,
    batches: Vec<Vec<Batch>>,
}

/// Makes the sweep's own images, within what the budget leaves, and cuts the lists into batches.
fn prepare(
    builder: &mut Builder,
    field: &HeightField,
    border: Border,
    sweep: Sweep,
    heights: ResourceId,
    mut lists: Vec<Vec<Azimuth>>,
    limits: &Limits,
) -> Result<(Sweeping, Lists)> {
    let size = [field.cols() as u32, field.rows() as u32];
    let count: usize = lists.iter().map(Vec::len).sum();
    let azimuths = builder.buffer("azimuths", (count * size_of::<Azimuth>()) as u64, true);
    let axes = [false, true].map(|marches_rows| {
        let used = lists.iter().flatten().any(|a| a.marches_rows() == marches_rows);
        used.then(|| Axis::of(marches_rows, size, border))
    });
    // Lines a cell apart pass four neighbouring lanes alike.
    let quads = matches!(sweep, Sweep::Lines(LineSweep { line_shift: 15, .. }))
        && border != Border::Periodic;
    let lane_heights = axes.map(|axis| {
        let axis = axis?;
        let extent = [axis.lanes.div_ceil(4), axis.steps, 1];
        let name = format!("lane_heights_{}", axis.name());
        Some(builder.image(name, Owner::Internal, Format::Rgba32Float, extent, false))
    });
    let is_lines = matches!(sweep, Sweep::Lines(_));
    let height = |a: &Axis| if is_lines { a.steps + a.warm_up } else { a.steps };
    let tallest = axes.iter().flatten().map(height).max().unwrap_or(1);
    let widest = axes.iter().flatten().map(|a| a.lanes).max().unwrap_or(1);
    let (format_occluders, format_slopes) = match &sweep {
        Sweep::Lines(lines) => (
            lines.writes_occluders.then_some(Format::Rg32Uint),
            match lines.slope_format {
                1 => Some(Format::Rgba32Uint),
                2 => Some(Format::Rg32Uint),
                _ => None,
            },
        ),
        _ => (None, Some(Format::R32Uint)),
    };
    let width = if is_lines { 8 } else { widest };
    let texels = u64::from(width) * u64::from(tallest);
    let layer_bytes: u64 =
        [format_occluders, format_slopes].iter().flatten().map(|f| f.bytes() * texels).sum();
    let fixed = builder.bytes();
    let mut batches = Vec::new();
    let mut first = 0;
    for list in &mut lists {
        batch::sort(list);
        batches.push(batch::cut(list, first, size, border, &sweep, limits, (fixed, layer_bytes))?);
        first += list.len() as u32;
    }
    let layers = batches.iter().flatten().map(|b| b.layers).max().unwrap_or(1);
    let extent = [width, tallest, layers];
    let mut make = |name: &str, format: Option<Format>| {
        format.map(|f| builder.image(name, Owner::Internal, f, extent, true))
    };
    let occluders = make("lattice_occluders", format_occluders);
    let slopes = make("lattice_slopes", format_slopes);
    let lattice = slopes.or(occluders).expect("a sweep stores something");
    let can_lose =
        matches!(&sweep, Sweep::Lines(l) if !l.holds_line && l.hull != HullPlace::Occluders);
    let lost_lines = can_lose.then(|| builder.buffer("lost_lines", u64::from(layers) * 32, false));
    for (axis, lanes) in axes.iter().zip(lane_heights) {
        if let (Some(axis), Some(lanes)) = (axis, lanes) {
            passes::height_transpose::plan(builder, *axis, border, heights, lanes);
        }
    }
    let sweeping = Sweeping {
        sweep,
        heights,
        azimuths,
        lane_heights,
        quads,
        lattice,
        occluders,
        slopes,
        lost_lines,
    };
    Ok((sweeping, Lists { lists, batches }))
}

fn part(light: &str, batch: &Batch, only: bool) -> String {
    if only { light.to_owned() } else { format!("{light} {}+{}", batch.first, batch.count) }
}

fn check_size(field: &HeightField, limits: &Limits) -> Result<[u32; 2]> {
    let longest = field.cols().max(field.rows());
    if longest > limits.image_side as usize {
        return Err(Error::Limit {
            what: format!("a field of {} × {}", field.cols(), field.rows()),
            needs: format!("images {longest} texels long"),
            limit: format!("{} on this device", limits.image_side),
        });
    }
    Ok([field.cols() as u32, field.rows() as u32])
}

fn finish(
    builder: Builder,
    size: [u32; 2],
    lists: Lists,
    layer_azimuths: Vec<u32>,
    notes: Vec<String>,
    settings: Vec<(String, String)>,
    limits: &Limits,
) -> Result<Plan> {
    let mut plan = Plan {
        size,
        resources: builder.resources,
        passes: builder.passes,
        azimuths: lists.lists.concat(),
        layer_azimuths,
        notes,
        settings,
    };
    place_barriers(&mut plan.passes);
    if plan.bytes() > limits.memory_budget {
        return Err(Error::Limit {
            what: "images and buffers of this picture".into(),
            needs: bytes_text(plan.bytes()),
            limit: format!("{} of --memory-budget", bytes_text(limits.memory_budget)),
        });
    }
    for resource in &plan.resources {
        let limit = match resource.kind {
            Kind::Image { .. } => limits.allocation_bytes,
            Kind::Buffer { .. } => limits.allocation_bytes.min(limits.buffer_bytes),
        };
        if resource.bytes() > limit {
            return Err(Error::Limit {
                what: resource.name.clone(),
                needs: bytes_text(resource.bytes()),
                limit: format!("{} on this device", bytes_text(limit)),
            });
        }
    }
    Ok(plan)
}

/// What only the reference can light so far.
fn refuse_later(surface: &Surface, lights: &Lights) -> Result<()> {
    let expected = "none: it is not yet there for pictures, only for the reference";
    if !lights.spheres.is_empty() {
        return Err(Error::setting("light 1", "a local light", expected));
    }
    if surface.phong.is_some() {
        return Err(Error::setting("phong", "a lobe", expected));
    }
    Ok(())
}

/// Even azimuths, or the grid vectors near them.
fn circle(quality: &Quality, sweep: &Sweep, cell_m: [f64; 2]) -> Vec<Azimuth> {
    match sweep {
        Sweep::Surface { .. } => azimuths::along_grid_vectors(quality.azimuths, cell_m),
        _ => azimuths::even(quality.azimuths, cell_m),
    }
}

/// The azimuths that [`horizons`] sweeps for a quality, radians counter-clockwise from east: 2πk/M,
/// or in exact mode the grid vectors' own.
pub fn circle_rad(quality: &Quality, cell_m: [f64; 2]) -> Vec<f64> {
    let count = quality.azimuths;
    match (quality.method, quality.lines) {
        (Method::Auto | Method::Sweep, Lines::Exact) => azimuths::along_grid_vectors(count, cell_m)
            .iter()
            .map(|a| a.swept_rad(cell_m).rem_euclid(std::f64::consts::TAU))
            .collect(),
        _ => (0..count).map(|k| std::f64::consts::TAU * f64::from(k) / f64::from(count)).collect(),
    }
}

/// The settings really used, for metadata and messages.
fn settings(quality: &Quality, sweep: &Sweep, border: Border) -> Vec<(String, String)> {
    let mut all = vec![("border".to_owned(), format!("{border:?}").to_lowercase())];
    let mut add = |name: &str, value: String| all.push((name.to_owned(), value));
    match sweep {
        Sweep::Lines(lines) => {
            add("method", "sweep".into());
            add("lines", Lines::name(quality.lines).into());
            add("fuse", quality.fuse.name().into());
            add("hull", format!("{:?}", lines.hull).to_lowercase());
            add("hull_depth", lines.hull_depth.to_string());
            add("precision", quality.precision.name().into());
        }
        Sweep::Surface { .. } => {
            add("method", "sweep".into());
            add("lines", "exact".into());
        }
        Sweep::March { .. } => add("method", "brute".into()),
    }
    all
}

/// Passes that light a scene: [`Picture`] says what is wanted besides the whole.
///
/// Inputs, in order: "heights", "environment" and "albedo" where the scene has them. Outputs:
/// "radiance", then one "direct.*" image a light and "sky_view" where asked. All are images of one
/// channel where every colour is grey, else of four.
///
/// # Errors
/// Settings or lights out of range, nothing that shines, or a scene beyond the limits.
pub fn picture(scene: &Scene, quality: &Quality, limits: &Limits, wanted: Picture) -> Result<Plan> {
    let Scene { field, surface, lights } = scene;
    quality.check()?;
    lights.check()?;
    surface.check(field.rows() * field.cols())?;
    refuse_later(surface, lights)?;
    let size = check_size(field, limits)?;
    let border = surface.border;
    let cell_m = field.cell_m();
    let mut notes = Vec::new();
    let lit = |c: &[f32; 3]| c.iter().any(|v| *v > 0.0);
    let sky = lights.sky.filter(lit);
    let environment = lights.environment.as_ref();
    let suns: Vec<_> = lights.suns.iter().enumerate().filter(|(_, s)| lit(&s.irradiance)).collect();
    if lights.sky.is_none() && environment.is_none() && lights.suns.is_empty() && !wanted.sky_view {
        return Err(Error::setting("lights", "none", "at least one of sky, environment and sun"));
    }
    if lights.sky.is_some() && sky.is_none() {
        notes.push("sky dropped: its radiance is 0".into());
    }
    for (i, _) in lights.suns.iter().enumerate().filter(|(_, s)| !lit(&s.irradiance)) {
        notes.push(format!("sun {} dropped: its irradiance is 0", i + 1));
    }
    let sweep = Sweep::choose(field, border, quality, limits, false, &mut notes)?;
    let is_exact = matches!(sweep, Sweep::Surface { .. });
    if is_exact && !suns.is_empty() {
        return Err(Error::setting(
            "--lines exact with --sun",
            "a sun, whose azimuths are no grid vectors",
            "--method brute, which is exact in every azimuth",
        ));
    }
    let grey = |c: &[f32; 3]| c[0] == c[1] && c[1] == c[2];
    let is_grey = environment.is_none()
        && sky.is_none_or(|c| grey(&c))
        && suns.iter().all(|(_, s)| grey(&s.irradiance))
        && matches!(&surface.albedo, Albedo::Constant(c) if grey(c));
    if is_grey {
        notes.push("one channel: every colour is grey".into());
    }

    let mut builder = Builder::new();
    let [cols, rows] = size;
    let flat = [cols, rows, 1];
    let colour_format = if is_grey { Format::R32Float } else { Format::Rgba32Float };
    let heights = builder.image("heights", Owner::Input, Format::R32Float, flat, false);
    let env_image = environment.map(|e| {
        builder.image(
            "environment",
            Owner::Input,
            Format::Rgba32Float,
            [e.width() as u32, e.height() as u32, 1],
            false,
        )
    });
    let albedo_map = match &surface.albedo {
        Albedo::Map(_) => {
            Some(builder.image("albedo", Owner::Input, Format::Rgba32Float, flat, false))
        }
        Albedo::Constant(_) => None,
    };
    let albedo = match surface.albedo {
        Albedo::Constant(c) => c,
        Albedo::Map(_) => [1.0; 3],
    };
    let radiance = builder.image("radiance", Owner::Output, colour_format, flat, false);
    let layer = |builder: &mut Builder, name: String| {
        wanted.light_layers.then(|| builder.image(name, Owner::Output, colour_format, flat, false))
    };
    let sky_layer = sky.and_then(|_| layer(&mut builder, "direct.sky".into()));
    let env_layer = environment.and_then(|_| layer(&mut builder, "direct.env".into()));
    let sun_layers: Vec<_> =
        suns.iter().map(|(i, _)| layer(&mut builder, format!("direct.sun{}", i + 1))).collect();
    let sky_view = wanted
        .sky_view
        .then(|| builder.image("sky_view", Owner::Output, Format::R32Float, flat, false));

    let needs_sky_sum = sky.is_some() || wanted.sky_view;
    let sky_sum = needs_sky_sum
        .then(|| builder.image("sky_sum", Owner::Internal, Format::R32Float, flat, false));
    let env_sum = environment
        .map(|_| builder.image("env_sum", Owner::Internal, Format::Rgba32Float, flat, false));
    let sun_sum = (!suns.is_empty())
        .then(|| builder.image("sun_sum", Owner::Internal, Format::R32Float, flat, false));

    let has_circle = sky_sum.is_some() || environment.is_some();
    let mut lists = Vec::new();
    if has_circle {
        lists.push(circle(quality, &sweep, cell_m));
    } else {
        notes.push("no sky, no environment: only the suns' azimuths are swept".into());
    }
    lists.extend(
        suns.iter().map(|(_, sun)| azimuths::across_sun(sun, quality.sun_azimuths, cell_m)),
    );
    let env_tables = match environment {
        Some(e) => {
            let rows_bytes = u64::from(quality.azimuths) * e.height() as u64 * 48;
            let wedge_rows = builder.buffer("wedge_rows", rows_bytes, false);
            let extent = [quality.table_elevations, 3, quality.azimuths];
            let tables =
                builder.image("env_tables", Owner::Internal, Format::Rgba32Float, extent, true);
            Some((wedge_rows, tables))
        }
        None => {
            if sky.is_some() {
                notes.push("no environment: no table".into());
            }
            None
        }
    };
    let (sweeping, lists) = prepare(&mut builder, field, border, sweep, heights, lists, limits)?;
    if let (Some(e), Some(image), Some((wedge_rows, tables))) = (environment, env_image, env_tables)
    {
        passes::env_wedges::plan(
            &mut builder,
            e,
            quality.azimuths,
            [image, sweeping.azimuths, wedge_rows],
        );
        let (height, nodes) = (e.height() as u32, quality.table_elevations);
        passes::env_tables::plan(
            &mut builder,
            border,
            height,
            nodes,
            quality.azimuths,
            [wedge_rows, tables],
        );
    }
    let mut is_first = true;
    let resolve = |builder: &mut Builder,
                   is_first: &mut bool,
                   name: &str,
                   sum: ResourceId,
                   has_colour: bool,
                   colour: [f32; 3],
                   layer: Option<ResourceId>| {
        let tinted = [0, 1, 2].map(|c| colour[c] * albedo[c]);
        let light = passes::light_resolve::Light {
            sum,
            has_colour,
            colour: tinted,
            albedo_map,
            radiance: Some((radiance, std::mem::take(is_first))),
            layer,
            grey: is_grey,
        };
        passes::light_resolve::plan(builder, size, name, &light);
    };
    if has_circle {
        let batches = &lists.batches[0];
        for batch in batches {
            let part = part("sky", batch, batches.len() == 1);
            sweeping.record(&mut builder, batch, &part);
            let images = passes::sky_shade::Images {
                lane_heights: sweeping.lane_heights(batch),
                lattice: sweeping.lattice,
                azimuths: sweeping.azimuths,
                sky_sum,
                environment: env_sum.zip(env_tables).map(|(sum, (_, tables))| [sum, tables]),
            };
            passes::sky_shade::plan(
                &mut builder,
                &sweeping.sweep,
                border,
                cell_m,
                batch,
                &part,
                &images,
            );
        }
        if let (Some(sum), Some(colour)) = (sky_sum, sky) {
            resolve(&mut builder, &mut is_first, "sky", sum, false, colour, sky_layer);
        }
        if let Some(sum) = env_sum {
            resolve(&mut builder, &mut is_first, "env", sum, true, [1.0; 3], env_layer);
        }
    }
    for (s, (i, sun)) in suns.iter().enumerate() {
        let sum = sun_sum.expect("there is a sun");
        let batches = &lists.batches[s + usize::from(has_circle)];
        for batch in batches {
            let part = part(&format!("sun{}", i + 1), batch, batches.len() == 1);
            sweeping.record(&mut builder, batch, &part);
            let ids = [sweeping.lane_heights(batch), sweeping.lattice, sweeping.azimuths, sum];
            let is_point = sun.diameter_rad == 0.0;
            passes::sun_shade::plan(
                &mut builder,
                &sweeping.sweep,
                border,
                cell_m,
                batch,
                &part,
                is_point,
                ids,
            );
        }
        resolve(
            &mut builder,
            &mut is_first,
            &format!("sun{}", i + 1),
            sum,
            false,
            sun.irradiance,
            sun_layers[s],
        );
    }
    if let (Some(layer), Some(sum)) = (sky_view, sky_sum) {
        let light = passes::light_resolve::Light {
            sum,
            has_colour: false,
            colour: [1.0; 3],
            albedo_map: None,
            radiance: None,
            layer: Some(layer),
            grey: true,
        };
        passes::light_resolve::plan(&mut builder, size, "sky_view", &light);
    }
    if is_first {
        // Nothing shines: the picture is black all the same.
        let sum = sky_sum.or(env_sum).or(sun_sum);
        match sum {
            Some(sum) => resolve(&mut builder, &mut is_first, "dark", sum, false, [0.0; 3], None),
            None => {
                return Err(Error::setting(
                    "lights",
                    "all of radiance 0",
                    "at least one that shines",
                ));
            }
        }
    }
    let mut used = settings(quality, &sweeping.sweep, border);
    if has_circle {
        used.push(("azimuths".into(), quality.azimuths.to_string()));
    }
    if environment.is_some() {
        used.push(("table_elevations".into(), quality.table_elevations.to_string()));
    }
    if suns.iter().any(|(_, s)| s.diameter_rad > 0.0) {
        used.push(("sun_azimuths".into(), quality.sun_azimuths.to_string()));
    }
    finish(builder, size, lists, Vec::new(), notes, used, limits)
}

/// Passes that write the horizons of `count` azimuths from number `first` on, of the quality's
/// circle: output "horizon_angles" (f32 elevation, radians, one layer an azimuth, in the order of
/// [`Plan::layer_azimuths`]) and, where asked, "horizon_distances" (metres, 0 where nothing is met).
///
/// # Errors
/// As [`picture`].
pub fn horizons(
    field: &HeightField,
    border: Border,
    quality: &Quality,
    limits: &Limits,
    (first, count): (u32, u32),
    distances: bool,
) -> Result<Plan> {
    quality.check()?;
    let size = check_size(field, limits)?;
    let mut notes = Vec::new();
    let sweep = Sweep::choose(field, border, quality, limits, distances, &mut notes)?;
    if distances && matches!(&sweep, Sweep::Lines(l) if !l.writes_occluders || l.slope_format > 0) {
        return Err(Error::setting(
            "distances to the horizon",
            format!("--fuse {}", quality.fuse.name()),
            "a fuse that knows its occluders: own, aimed-nearest or aimed",
        ));
    }
    let mut list = circle(quality, &sweep, field.cell_m());
    let range = first as usize..(first + count) as usize;
    list = list.get(range).map(<[Azimuth]>::to_vec).unwrap_or_default();
    if list.is_empty() {
        return Err(Error::setting(
            "azimuths",
            format!("{count} from {first}"),
            format!("some of 0..{}", quality.azimuths),
        ));
    }
    let layer_azimuths = batch::sort(&mut list).iter().map(|k| k + first).collect();
    let mut builder = Builder::new();
    let [cols, rows] = size;
    let heights = builder.image("heights", Owner::Input, Format::R32Float, [cols, rows, 1], false);
    let extent = [cols, rows, list.len() as u32];
    let angles = builder.image("horizon_angles", Owner::Output, Format::R32Float, extent, true);
    let distances = distances
        .then(|| builder.image("horizon_distances", Owner::Output, Format::R32Float, extent, true));
    let (sweeping, lists) =
        prepare(&mut builder, field, border, sweep, heights, vec![list], limits)?;
    for batch in &lists.batches[0] {
        let part = part("", batch, lists.batches[0].len() == 1);
        sweeping.record(&mut builder, batch, part.trim());
        let ids = [sweeping.lane_heights(batch), sweeping.lattice, sweeping.azimuths, angles];
        passes::sweep_fuse::plan(
            &mut builder,
            &sweeping.sweep,
            border,
            batch,
            part.trim(),
            ids,
            distances,
        );
    }
    let used = settings(quality, &sweeping.sweep, border);
    finish(builder, size, lists, layer_azimuths, notes, used, limits)
}

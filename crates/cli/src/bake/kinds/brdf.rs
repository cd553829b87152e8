//! Kinds of the far field under lights from --angles: the table `brdf`, `brdf-factors` and
//! `brdf-harmonics`, which are the table in short, and `btf`.

use glam::DVec3;
use ridgelight::scene::Border;
use ridgelight::{Error, Result};
use ridgelight_bake::{self as bake, Brdf, BrdfHarmonics, Facets, Factors};
use serde_json::json;

use super::far_field::{LIGHT_UNIT, each_light, is_coarse, largest, light_work, walked};
use super::{Job, Making, Map, MapFiles, Stage, Value, Wanted, far_field, stage, take};

/// Light and view pairs at which the table is tested between its angles.
pub const PAIRS: usize = 64;

/// Factors of the table. More would remove less error than the table's own angular steps leave
/// (`cargo measure brdf`).
pub const FACTORS: usize = 8;

/// Bytes in this process.
pub fn bytes(job: &Job) -> u64 {
    let count = job.angles.count();
    far_field::bytes(job, count.max(2 * PAIRS)) + 72 * (count as u64).pow(2)
}

/// A map in red, green and blue over angles. In the far field a periodic field is a plane.
fn colours(
    job: &Job,
    wanted: &Wanted,
    (about, unit, lowest): (&'static str, &'static str, f64),
    map: Map,
) -> Result<Map> {
    if job.border() != Border::Periodic {
        let found = format!("{:?} with --what {}", job.border(), wanted.kind.name).to_lowercase();
        let expected = "periodic: the far field is of an infinite plane";
        return Err(Error::setting("--border", found, expected));
    }
    let most = largest(wanted);
    let value = |name| Value { name, about, unit, range: [lowest * most, most] };
    let names = |stem: String| ["R", "G", "B"].map(|c| format!("{stem}.{c}"));
    let stem = wanted.kind.stem();
    let planes = match map.is_array {
        true => (0..map.axes[0].1).flat_map(|k| names(format!("{stem}.{k}"))).collect(),
        false => names(stem).into(),
    };
    Ok(Map { planes, values: ["red", "green", "blue"].map(value).into(), ..map })
}

fn too_few(job: &Job, with: &str, expected: String) -> Error {
    let [zeniths, azimuths] = [job.angles.zeniths, job.angles.azimuths];
    Error::setting("--angles", format!("{zeniths}x{azimuths}{with}"), expected)
}

pub fn brdf(job: &Job, wanted: &Wanted) -> Result<Map> {
    let (angles, count) = (job.angles, job.angles.count());
    let about = "mean visible radiance over the plane's irradiance cos θ; texel (x, y) is view x \
        and light y, θ by θ and in each all φ; θ = (k + ½) π/2 / thetas, φ = 2π j / phis \
        counter-clockwise from east";
    let axes = vec![
        ("channel", 3),
        ("theta_i", angles.zeniths),
        ("phi_i", angles.azimuths),
        ("theta_o", angles.zeniths),
        ("phi_o", angles.azimuths),
    ];
    let constants = far_field::constants("BRDF", angles);
    let map = Map { constants, size: Some([count, count]), axes, ..Map::default() };
    colours(job, wanted, (about, "1/sr", 0.0), map)
}

pub fn factors(job: &Job, wanted: &Wanted) -> Result<Map> {
    let angles = job.angles;
    let about = "a function of one direction: the table is the sum over k of layer k for the \
        light times layer views + k for the view; views is 0 without --specular, else 8; \
        texel (j, k) is θ = (k + ½) π/2 / thetas, φ = 2π j / phis counter-clockwise from east";
    let mut constants = far_field::constants("BRDF", angles);
    constants.push(format!("const int BRDF_FACTORS = {FACTORS};"));
    // Specular is not symmetric in light and view.
    let views = if far_field::specular(job).is_some() { FACTORS } else { 0 };
    constants.push(format!("const int BRDF_VIEWS = {views};"));
    let size = Some([angles.azimuths, angles.zeniths]);
    let axes = vec![
        ("factor", FACTORS + views),
        ("channel", 3),
        ("theta", angles.zeniths),
        ("phi", angles.azimuths),
    ];
    let map = Map { is_array: true, constants, size, axes, ..Map::default() };
    let map = colours(job, wanted, (about, "1/√sr", -1.0), map)?;
    match angles.count() < FACTORS {
        true => Err(too_few(job, "", format!("{FACTORS} angles or more, one per factor"))),
        false => Ok(map),
    }
}

pub fn harmonics(job: &Job, wanted: &Wanted) -> Result<Map> {
    let order = job.sh_order();
    let terms = order * order;
    let about = "the table is the sum over texels (j, i) of their values times Y_i of the light \
        and Y_j of the view; real, orthonormal, x east, y north, z up, no Condon-Shortley \
        phase, index l(l+1) + m; only above horizontal";
    let constants = vec![
        format!("const int BRDF_ORDER = {order};"),
        format!("const int BRDF_TERMS = {terms};"),
    ];
    let axes = vec![("channel", 3), ("light", terms), ("view", terms)];
    let map = Map { constants, size: Some([terms, terms]), axes, ..Map::default() };
    let map = colours(job, wanted, (about, "1/sr", -1.0), map)?;
    match job.angles.count() < terms {
        true => {
            let with = format!(" with --sh-order {order}");
            Err(too_few(job, &with, format!("{terms} angles or more")))
        }
        false => Ok(map),
    }
}

/// The stage that tests the table between its angles.
const BETWEEN: &str = "pairs between the angles";
/// The stage that puts the table into a shorter form.
const SHORT: &str = "shorter form";

/// Stages of the light of all triangles towards --angles. `more` counts further
/// directions of triangle visibility; visible points are found so many times.
pub fn lights_stages(job: &Job, more: usize, times: usize) -> Result<Vec<Stage>> {
    let lights = job.angles.count();
    let mut all = vec![far_field::triangles_stage(job, lights + more)];
    if job.scatter.is_some() {
        all.push(far_field::points_stage(job, times));
    }
    all.push(Stage::new(stage::LIGHTS, lights as f64 * light_work(job, lights)?, LIGHT_UNIT));
    Ok(all)
}

pub fn table_stages(job: &Job, is_made: bool) -> Result<Vec<Stage>> {
    if is_made {
        return Ok(Vec::new());
    }
    // A pair has two ends.
    let mut all = lights_stages(job, 2 * job.pairs, 2)?;
    all.push(Stage::new(BETWEEN, job.pairs as f64 * light_work(job, 1)?, LIGHT_UNIT));
    Ok(all)
}

/// Stages of the table, and of a shorter form with `terms` terms.
pub fn shorter_stages(job: &Job, is_made: bool, terms: usize) -> Result<Vec<Stage>> {
    let values = (job.angles.count().pow(2) * terms) as f64;
    let mut all = table_stages(job, is_made)?;
    all.push(Stage::new(SHORT, values, "values of the table x terms"));
    Ok(all)
}

/// The table, which three kinds store in different ways.
pub struct Table {
    brdf: Brdf,
    facets: Facets,
    /// Seeded light and view pairs between the angles, each with the field's own value.
    between: Vec<([DVec3; 2], [f64; 3])>,
}

/// The table of this bake, computed on first use.
fn table<'a>(making: &mut Making<'a>) -> Result<&'a Table> {
    if let Some(known) = making.job.table.get() {
        return Ok(known);
    }
    let made = compute_table(making)?;
    Ok(making.job.table.get_or_init(|| made))
}

/// Every light's table row by row.
fn compute_table(making: &mut Making) -> Result<Table> {
    let (job, stages) = (making.job, making.stages);
    let directions = job.angles.directions()?;
    let count = directions.count();
    stages.begin(stage::TRIANGLES);
    let facets = far_field::facets(making.gpu, job, &directions)?;
    facets.check().map_err(|error| match error {
        Error::Setting { name, found, expected } if name.starts_with("direction ") => {
            too_few(job, &format!(" with {name}, {found}"), expected)
        }
        other => other,
    })?;
    let mut values = Vec::with_capacity(count * count);
    let of = (0..count, &(|_| 0..count) as _);
    each_light(making, &facets, of, stage::LIGHTS, &mut |light, radiance| {
        stages.show(&format!("light {} of {count}", light + 1));
        let z = directions.vectors()[light].z;
        let of_views = facets.radiance_from_all(&radiance).into_iter();
        values.extend(of_views.map(|light| light.map(|v| v / z)));
        Ok(())
    })?;
    let brdf = Brdf::from_values(directions.vectors().to_vec(), values)?;
    stages.begin(stage::TRIANGLES);
    let count = job.pairs;
    let pairs = bake::pairs(count, job.seed)?;
    let of_pairs = bake::facets(making.gpu, job.scene, facets.times(), &pairs, &job.limits)?;
    let mut between = Vec::with_capacity(count);
    let own = |light: usize| count + light..count + light + 1;
    let of = (0..count, &own as _);
    each_light(making, &of_pairs, of, BETWEEN, &mut |light, radiance| {
        let [l, v] = [light, count + light].map(|i| pairs.vectors()[i]);
        let mean = of_pairs.radiance_from(count + light, &radiance);
        between.push(([l, v], mean.map(|m| m / l.z)));
        Ok(())
    })?;
    Ok(Table { brdf, facets, between })
}

pub fn make_table(making: &mut Making, files: &mut MapFiles) -> Result<()> {
    let (job, table) = (making.job, table(making)?);
    let count = job.angles.count();
    let texels = (0..count * count).map(|i| table.brdf.at(i / count, i % count));
    take(files, &texels.collect::<Vec<_>>())?;
    add_entries(job, table, (&|l, v| table.brdf.between(&job.angles, l, v), true), files)
}

pub fn make_factors(making: &mut Making, files: &mut MapFiles) -> Result<()> {
    let (job, table) = (making.job, table(making)?);
    making.stages.begin(SHORT);
    let factors = Factors::of(&table.brdf, job.angles, FACTORS, table.facets.has_specular())?;
    let mut all = factors.values().iter().chain(factors.of_views().unwrap_or_default());
    all.try_for_each(|of_k| take(files, of_k))?;
    add_residual(job, table, factors.rows(), files);
    add_entries(job, table, (&|l, v| factors.at(l, v), true), files)
}

pub fn make_harmonics(making: &mut Making, files: &mut MapFiles) -> Result<()> {
    let (job, table) = (making.job, table(making)?);
    making.stages.begin(SHORT);
    let (order, has_specular) = (job.sh_order(), table.facets.has_specular());
    let harmonics = BrdfHarmonics::of(&table.brdf, job.angles, order, has_specular)?;
    take(files, harmonics.coefficients())?;
    add_residual(job, table, harmonics.rows(table.brdf.directions()), files);
    add_entries(job, table, (&|l, v| harmonics.at(l, v), false), files)
}

/// Squares of a difference, and of the exact value, as the root of their quotient.
fn residual(all: impl Iterator<Item = (f64, [f64; 3], [f64; 3])>) -> f64 {
    let (mut apart, mut whole) = (0.0, 0.0);
    for (weight, own, found) in all {
        for (own, found) in own.into_iter().zip(found) {
            apart += weight * (own - found).powi(2);
            whole += weight * own * own;
        }
    }
    (apart / f64::max(whole, f64::MIN_POSITIVE)).sqrt()
}

/// The error that storage adds to the table, light by light over all views, weighted by what a
/// plane receives and sends.
fn add_residual(
    job: &Job,
    table: &Table,
    rows: impl Iterator<Item = Vec<[f64; 3]>>,
    files: &mut MapFiles,
) {
    let weights = &job.angles.projected_sr();
    let all = rows.enumerate().flat_map(|(l, row)| {
        let of = move |(v, found)| (weights[l] * weights[v], table.brdf.at(l, v), found);
        row.into_iter().enumerate().map(of)
    });
    files.add_entry("residual_of_table", residual(all).into());
}

/// The stored table evaluated between all directions, and whether it is linear between its angles.
type Kept<'a> = (&'a dyn Fn(DVec3, DVec3) -> [f64; 3], bool);

/// Statistics of the table, and the error of the `kept` table between its angles.
fn add_entries(
    job: &Job,
    table: &Table,
    (kept, is_linear): Kept,
    files: &mut MapFiles,
) -> Result<()> {
    let weights = job.angles.projected_sr();
    let range = |of: &dyn Fn(usize) -> [f64; 3]| {
        let all = (0..job.angles.count()).flat_map(of);
        all.fold([f64::MAX, 0.0_f64], |[least, most], v| [least.min(v), most.max(v)])
    };
    let [least, most] = range(&|light| table.brdf.reflected(light, &weights));
    let is_coarse = is_coarse(job, &table.facets);
    let is = if is_coarse {
        "share of a light's irradiance, over all lights and colours, summed over --angles: the \
            sharpest specular lobe is narrower than their spacing, so sums do not measure what \
            it reflects"
    } else {
        "share of a light's irradiance, over all lights and colours, summed over --angles"
    };
    files.add_entry("reflected", json!({ "least": least, "most": most, "is": is }));
    files.add_entry("unreciprocal", table.brdf.unreciprocal().into());
    if table.facets.has_specular() {
        let [low, high] = range(&|view| table.brdf.gathered(view, &weights));
        let is = if is_coarse {
            "radiance of a view under light of 1 from all sides, over all views and colours, \
                summed over --angles: the sharpest specular lobe is narrower than their spacing, \
                so sums may be many times what the surface reflects"
        } else {
            "radiance of a view under light of 1 from all sides, over all views and colours, \
                summed over --angles: at most what the surface reflects, but for that sum and \
                worst_closure; at grazing angles one light may reflect more than arrives, \
                because Phong specular has no cosine"
        };
        files.add_entry("gathered", json!({ "least": low, "most": high, "is": is }));
        if most > 1.0 && !is_coarse {
            files.remark(format!(
                "at grazing angles up to {most:.2} of a light's irradiance is reflected: Phong \
                    specular is normalised over views, not lights, and is not reciprocal \
                    (difference {:.3})",
                table.brdf.unreciprocal()
            ));
        }
    }
    let between = table.between.iter().map(|([l, v], own)| (1.0, *own, kept(*l, *v)));
    files.add_entry(
        "between",
        json!({
            "residual": residual(between), "pairs": job.pairs, "seed": job.seed,
            "is": format!(
                "RMS of the stored value less the field's own, {}, over that value: seeded light \
                    and view pairs, each uniform in what a level plane receives",
                if is_linear { "linear between its angles" } else { "by harmonics over all directions" }
            ),
        }),
    );
    far_field::add_entries(files, job, &table.facets, walked(job)?.as_ref(), is_linear)
}

pub fn btf(job: &Job, wanted: &Wanted) -> Result<Map> {
    let count = job.angles.count();
    let names = (0..count * count).map(|i| format!("btf.{:04}.{:04}", i / count, i % count));
    let about = "radiance that leaves the texel towards the view under a light of irradiance 1 \
        facing it; 0 where it is not visible";
    Ok(far_field::views(job, wanted, names, about, "1/sr"))
}

pub fn make_btf(making: &mut Making, files: &mut MapFiles) -> Result<()> {
    let (job, stages) = (making.job, making.stages);
    let count = job.angles.count();
    stages.begin(stage::TRIANGLES);
    let facets = far_field::facets(making.gpu, job, &job.angles.directions()?)?;
    let of = (0..count, &(|_| 0..count) as _);
    each_light(making, &facets, of, stage::LIGHTS, &mut |light, radiance| {
        stages.show(&format!("light {} of {count}", light + 1));
        let mut views = facets.texels_from_all(&radiance).into_iter();
        views.try_for_each(|texels| take(files, &texels))
    })?;
    far_field::add_entries(files, job, &facets, walked(job)?.as_ref(), true)
}

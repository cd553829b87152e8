use glam::DVec3;
use ridgelight::gpu::Headless;
use ridgelight::scene::Border;
use ridgelight::{Error, Result};
use ridgelight_bake as bake;
use ridgelight_bake::{Brdf, Facets};
use serde_json::json;

use super::super::map::{Format, MapFiles};
use super::{Kind, Lit, Making, Map, OfLight, Request, Say, Source, Value, far_field};

pub static KIND: Kind = Kind {
    name: "brdf",
    about: "far-field reflectance of periodic ground: a table over all pairs of --angles lights \
        and views; --bounces 0 omits indirect light",
    encodings: &bake::REFLECTED,
    formats: &[Format::Ktx2, Format::Npy],
    decoder: include_str!("../../../../../shaders_glsl/decode/brdf.glsl"),
    begin,
};

/// Light and view pairs at which the table is tested between its angles.
pub const PAIRS: usize = 64;

/// In the far field a periodic field is a plane.
pub fn check(request: &Request, name: &str) -> Result<()> {
    if request.border == Border::Periodic {
        return Ok(());
    }
    let found = format!("{:?} with --what {name}", request.border).to_lowercase();
    Err(Error::setting("--border", found, "periodic: the far field is of an infinite plane"))
}

/// Bytes in this process.
pub fn bytes(lit: &Lit) -> u64 {
    let count = lit.angles.count();
    far_field::bytes(lit, count.max(2 * PAIRS)) + 72 * (count as u64).pow(2)
}

fn begin(request: &Request) -> Result<Making> {
    let (angles, count) = (request.angles, request.angles.count());
    check(request, KIND.name)?;
    let value = |name| Value {
        name,
        about: "mean visible radiance over the plane's irradiance cos θ; texel (x, y) is view x \
            and light y, θ by θ and in each all φ; θ = (k + ½) π/2 / thetas, φ = 2π j / phis \
            counter-clockwise from east",
        unit: "1/sr",
        range: [0.0, far_field::largest(request)],
    };
    let map = Map {
        planes: ["brdf.R", "brdf.G", "brdf.B"].map(String::from).into(),
        values: ["red", "green", "blue"].map(value).into(),
        is_array: false,
        constants: far_field::constants("BRDF", angles),
        size: Some([count, count]),
        axes: vec![
            ("channel", 3),
            ("theta_i", angles.zeniths),
            ("phi_i", angles.azimuths),
            ("theta_o", angles.zeniths),
            ("phi_o", angles.azimuths),
        ],
    };
    let of = OfLight { plans: far_field::plans, bytes, make };
    Ok(Making { map, source: Source::Light(of) })
}

/// The table, which three kinds store in different ways.
pub struct Table {
    pub brdf: Brdf,
    pub facets: Facets,
    /// Seeded light and view pairs between the angles, each with the field's own value.
    between: Vec<([DVec3; 2], [f64; 3])>,
}

/// The table of this bake, computed on first use.
pub fn table<'a>(gpu: &mut Headless, lit: &'a Lit, say: Say) -> Result<&'a Table> {
    if let Some(known) = lit.table.get() {
        return Ok(known);
    }
    let made = make_table(gpu, lit, say)?;
    Ok(lit.table.get_or_init(|| made))
}

/// Every light's table row by row.
fn make_table(gpu: &mut Headless, lit: &Lit, say: Say) -> Result<Table> {
    let directions = lit.angles.directions()?;
    let count = directions.count();
    let facets = far_field::facets(gpu, lit, &directions, say)?;
    facets.check().map_err(|error| match error {
        Error::Setting { name, found, expected } if name.starts_with("direction ") => {
            let angles = format!("{}x{}", lit.angles.zeniths, lit.angles.azimuths);
            Error::setting("--angles", format!("{angles} with {name}, {found}"), expected)
        }
        other => other,
    })?;
    let mut values = Vec::with_capacity(count * count);
    let of = (0..count, &(|_| 0..count) as &dyn Fn(usize) -> _);
    far_field::each_light(gpu, lit, &facets, of, &mut |light, radiance| {
        say(format!("light {} of {count}", light + 1));
        let z = directions.vectors()[light].z;
        values.extend(
            facets.radiance_from_all(&radiance).into_iter().map(|light| light.map(|v| v / z)),
        );
        Ok(())
    })?;
    let brdf = Brdf::from_values(directions.vectors().to_vec(), values)?;
    say(format!("{PAIRS} pairs between the angles"));
    let pairs = bake::pairs(PAIRS, lit.seed)?;
    let facets_between =
        ridgelight_bake::facets(gpu, lit.scene, facets.times(), &pairs, &lit.limits)?;
    let mut between = Vec::with_capacity(PAIRS);
    let own = |light| PAIRS + light..PAIRS + light + 1;
    far_field::each_light(gpu, lit, &facets_between, (0..PAIRS, &own), &mut |light, radiance| {
        let [l, v] = [light, PAIRS + light].map(|i| pairs.vectors()[i]);
        between.push((
            [l, v],
            facets_between.radiance_from(PAIRS + light, &radiance).map(|m| m / l.z),
        ));
        Ok(())
    })?;
    Ok(Table { brdf, facets, between })
}

fn make(gpu: &mut Headless, lit: &Lit, files: &mut MapFiles, say: Say) -> Result<()> {
    let table = table(gpu, lit, say)?;
    let count = lit.angles.count();
    let planes = [0, 1, 2].map(|c| -> Vec<f32> {
        (0..count * count).map(|i| table.brdf.at(i / count, i % count)[c] as f32).collect()
    });
    files.take(&planes.each_ref().map(Vec::as_slice))?;
    add_entries(lit, table, (&|l, v| table.brdf.between(&lit.angles, l, v), true), files)
}

/// The stored table evaluated between all directions, and whether it is linear between its angles.
type Kept<'a> = (&'a dyn Fn(DVec3, DVec3) -> [f64; 3], bool);

/// Like [`add_entries`], with the error that storage adds to the table, light by light over all views,
/// weighted by what a plane receives and sends.
pub fn tell_in_short(
    lit: &Lit,
    table: &Table,
    rows: impl Iterator<Item = Vec<[f64; 3]>>,
    kept: Kept,
    files: &mut MapFiles,
) -> Result<()> {
    let (mut apart, mut all) = (0.0, 0.0);
    let weights = lit.angles.projected_sr();
    for (l, row) in rows.enumerate() {
        for (v, found) in row.into_iter().enumerate() {
            for (own, found) in table.brdf.at(l, v).into_iter().zip(found) {
                apart += weights[l] * weights[v] * (own - found).powi(2);
                all += weights[l] * weights[v] * own * own;
            }
        }
    }
    files.add_entry("residual_of_table", (apart / f64::max(all, f64::MIN_POSITIVE)).sqrt().into());
    add_entries(lit, table, kept, files)
}

/// Statistics of the table, and the error of the `kept` table between its angles.
pub fn add_entries(
    lit: &Lit,
    table: &Table,
    (kept, is_linear): Kept,
    files: &mut MapFiles,
) -> Result<()> {
    let weights = lit.angles.projected_sr();
    let reflected = (0..lit.angles.count()).flat_map(|light| table.brdf.reflected(light, &weights));
    let [least, most] = reflected.fold([f64::MAX, 0.0_f64], |[l, m], r| [l.min(r), m.max(r)]);
    let is_coarse = far_field::is_coarse(lit, &table.facets);
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
        let gathered = (0..lit.angles.count()).flat_map(|view| table.brdf.gathered(view, &weights));
        let [low, high] = gathered.fold([f64::MAX, 0.0_f64], |[l, m], r| [l.min(r), m.max(r)]);
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
    let (mut apart, mut all) = (0.0, 0.0);
    for ([l, v], own) in &table.between {
        for (own, found) in own.iter().zip(kept(*l, *v)) {
            apart += (own - found).powi(2);
            all += own * own;
        }
    }
    files.add_entry(
        "between",
        json!({
            "residual": (apart / f64::max(all, f64::MIN_POSITIVE)).sqrt(), "pairs": PAIRS, "seed": lit.seed,
            "is": format!(
                "RMS of the stored value less the field's own, {}, over that value: seeded light \
                    and view pairs, each uniform in what a level plane receives",
                if is_linear { "linear between its angles" } else { "by harmonics over all directions" }
            ),
        }),
    );
    far_field::add_entries(files, lit, &table.facets, far_field::walked(lit)?.as_ref(), is_linear)
}

//! The request of `bake`: kinds, encodings, directions, angles and paths.

use ridgelight::scene::{Directions, Lines, Method, Quality, Scatter};
use ridgelight::{Error, Result};
use ridgelight_bake::{Angles, Encoding, encoding_named};
use ridgelight_io::Block;

use super::Packing;
use super::kinds::{KINDS, Kind, Source};
use super::map::{Format, Wanted};
use crate::args::BakeArgs;
use crate::idle;

/// Default of --directions.
pub const DIRECTIONS: u32 = 256;

/// Parses a name of `--what`.
pub fn kind_named(name: &str) -> std::result::Result<&'static Kind, String> {
    KINDS.iter().find(|kind| kind.name == name).ok_or_else(|| {
        let all: Vec<&str> = KINDS.iter().map(|kind| kind.name).collect();
        format!("one of {}", all.join(", "))
    })
}

/// Parses `--encoding`: `KIND=ENCODING`.
pub fn packing(text: &str) -> std::result::Result<Packing, String> {
    let (kind, name) = text.split_once('=').ok_or("KIND=ENCODING")?;
    let kind = kind_named(kind)?;
    let encoding = encoding_named(kind.encodings, name).ok_or_else(|| {
        let all: Vec<&str> = kind.encodings.iter().map(|e| e.name).collect();
        format!("{}=ENCODING, ENCODING one of {}", kind.name, all.join(", "))
    })?;
    Ok(Packing { kind, encoding })
}

/// The list of kinds below the flags.
pub fn help() -> String {
    let mut text = String::from("Kinds and their encodings:\n");
    for kind in &KINDS {
        let names: Vec<&str> = kind.encodings.iter().map(|e| e.name).collect();
        let formats: Vec<&str> = kind.formats.iter().map(|f| f.name()).collect();
        text += &format!(
            "  {}: {}\n      {}; as {} by default\n",
            kind.name,
            kind.about,
            names.join(", "),
            formats.join(" and ")
        );
    }
    text += "\n\
Each .ktx2 and .dds has one mip level, or all with --mips. It is an array where a map has several layers, such as one per azimuth or four coefficients. \
Its first row is north. --method auto is sweep here; brute-force is exact in every azimuth, and its time grows with the cube of the side.\n\n\
With --specular, the kinds brdf, brdf-factors, brdf-harmonics and btf reflect each light at the triangles. Indirect light \
towards each view reuses the paths of the light except for their last step. --plan prints the number of rays; --bounces 0 \
needs none. scatter then views the ground from straight above. light-field reflects the sky along --directions; with \
--bounces 0 along each once. Phong specular is not reciprocal; the manifest states by how much where --angles resolve it.\n\n\
Every Vulkan device can sample 8-bit, f16 and f32 textures; unorm16 and snorm16 are optional. A .png of scatter has 16 \
bits, scaled to the largest value of each picture; the manifest holds the scale.

Examples:
  ridgelight bake heights.png --cell 30 --what sky-view,bent-normal -o baked
  ridgelight bake dem.tif --what horizon --encoding horizon=unorm16-sin -o baked
  ridgelight bake moss.png --what ellipse --directions 512 -o baked
  ridgelight bake leather.png --border periodic --cell 0.001 --what curved-ellipse --curvature 20,5 -o baked
  ridgelight bake moss.png --border periodic --what sh-transfer --sh-order 3 -o baked
  ridgelight bake dem.tif --what horizon,sky-view,visible-sky --plan -o baked";
    text
}

/// The requested kinds, each once.
pub fn wanted(args: &BakeArgs) -> Result<Vec<Wanted>> {
    let mut all: Vec<Wanted> = Vec::new();
    for kind in &args.what {
        if all.iter().any(|w| w.kind.name == kind.name) {
            return Err(Error::setting("--what", format!("{} twice", kind.name), "each kind once"));
        }
        let mut packings = args.encoding.iter().filter(|p| p.kind.name == kind.name);
        let block = |e: &Encoding| Block::of(e.component, e.components);
        let fits = |e: &&Encoding| block(e).is_some() && kind.compresses();
        let default = if args.compress { kind.encodings.iter().find(fits) } else { None };
        let default = default.unwrap_or(&kind.encodings[0]);
        let encoding = packings.next().map_or(default, |p| p.encoding);
        if args.compress && !fits(&encoding) {
            let found = format!("with {} of {}", encoding.name, kind.name);
            let expected = "encodings in unorm8, or in f16 of scatter and brdf; no other kind is \
                stored in compressed blocks";
            return Err(Error::setting("--compress", found, expected));
        }
        if args.mips && !kind.has_means() {
            let expected =
                format!("kinds whose values can be averaged: {}", either(Kind::has_means));
            return Err(Error::setting("--mips", format!("with {}", kind.name), expected));
        }
        if packings.next().is_some() {
            let found = format!("two of {}", kind.name);
            return Err(Error::setting("--encoding", found, "one per kind"));
        }
        let mut formats = if args.format.is_empty() { kind.formats } else { &args.format }.to_vec();
        let takes = |format: &Format| format.takes(kind, encoding);
        if args.format.is_empty() {
            formats.retain(takes);
        } else if let Some(format) = formats.iter().find(|f| !takes(f)) {
            return Err(Error::setting(
                "--format",
                format!("{} with {} of {}", format.name(), encoding.name, kind.name),
                "exr, tif, npy, ktx2 or dds: a picture holds up to three components of 8 or 16 bits",
            ));
        }
        if let Some(twice) = (1..formats.len()).find(|i| formats[..*i].contains(&formats[*i])) {
            let found = format!("{} twice", formats[twice].name());
            return Err(Error::setting("--format", found, "each once"));
        }
        let is_texture = formats.iter().any(|format| format.is_texture());
        let block = block(encoding).filter(|_| args.compress && is_texture);
        all.push(Wanted { kind, encoding, formats, block, has_mips: args.mips });
    }
    let has_textures = all.iter().any(|w| w.formats.iter().any(|format| format.is_texture()));
    for (flag, is_set) in [("--compress", args.compress), ("--mips", args.mips)] {
        if is_set && !has_textures {
            return Err(Error::setting(flag, "no texture", "--format ktx2 or dds"));
        }
    }
    if let Some(idle) =
        args.encoding.iter().find(|p| all.iter().all(|w| w.kind.name != p.kind.name))
    {
        let found = format!("one of {}", idle.kind.name);
        return Err(Error::setting("--encoding", found, "kinds of --what only"));
    }
    Ok(all)
}

pub fn quality(args: &BakeArgs) -> Result<Quality> {
    let mut quality = args.quality.quality()?;
    if quality.method == Method::Auto && quality.lines == Lines::Exact {
        quality.method = Method::BruteForce;
    }
    if quality.lines == Lines::Exact && quality.method != Method::BruteForce {
        return Err(Error::setting(
            "--lines",
            "exact",
            "--method brute-force, which is exact in every azimuth: exact lines need unevenly \
                spaced azimuths",
        ));
    }
    Ok(quality)
}

/// Directions of the kinds that trace some. Ellipses of flat bases use none below horizontal.
pub fn directions(args: &BakeArgs, count: u32) -> Result<Directions> {
    let needs_sphere = |kind: &&Kind| match kind.source {
        Source::Horizons | Source::Sums(_) | Source::SkyView => false,
        Source::Directions(of) => of.needs_sphere,
        Source::Light(_) => true,
    };
    let lowest_z = if args.what.iter().any(needs_sphere) { -1.0 } else { 0.0 };
    Directions::fibonacci(count as usize, lowest_z, 0)
}

/// Whether a kind is one of some.
type Is = fn(&Kind) -> bool;

/// Names of some kinds, in words.
fn either(is_one: Is) -> String {
    let names: Vec<&str> = KINDS.iter().filter(|kind| is_one(kind)).map(|kind| kind.name).collect();
    let (last, others) = names.split_last().expect("a name");
    format!("{} or {last}", others.join(", "))
}

/// Kinds that are light, in words.
pub fn lights() -> String {
    either(Kind::is_light)
}

/// Whether it is light along --angles.
fn has_angles(kind: &Kind) -> bool {
    kind.is_light() && kind.name != "scatter"
}

/// Notes flags of lights and surface that the requested kinds do not use.
pub fn say_idle_light(args: &BakeArgs, scatters: bool) {
    let lights: Vec<&str> = crate::setup::lights::LIGHTS.iter().map(|light| light.id).collect();
    let lights = [&["sky", "env", "env_rotate"][..], &lights].concat();
    let groups: [(&[&str], Is); 2] =
        [(&lights, Kind::is_lit), (&["albedo", "specular"], Kind::is_light)];
    for (names, is_one) in groups.iter().filter(|(_, of)| !args.what.iter().any(|kind| of(kind))) {
        let is_own = |(name, _): &&(String, String)| names.contains(&name.as_str());
        for (name, value) in args.quality.written.iter().filter(is_own) {
            idle::note(name, value, &format!("without {}", either(*is_one)));
        }
    }
    if let (Some(paths), false) = (args.paths, scatters) {
        idle::note("paths", &paths.to_string(), "with --bounces 0");
    }
}

/// Scattered light: three bounces by default, none with --bounces 0.
pub fn scatter(args: &BakeArgs, quality: &Quality) -> Option<Scatter> {
    let default = Scatter::default();
    let bounces =
        if args.quality.gives("bounces") { quality.bounces.count } else { default.bounces };
    let (paths, seed) = (args.paths.unwrap_or(256), args.seed.unwrap_or(0));
    let cutoff = quality.bounces.cutoff;
    (bounces > 0).then_some(Scatter { bounces, paths, cutoff, seed, ..default })
}

/// Angles of lights and views; fewer by default where each pair has a picture.
pub fn angles(args: &BakeArgs) -> Result<Angles> {
    let has_pairs = args.what.iter().any(|kind| kind.name == "btf");
    let [zeniths, azimuths] = args.angles.unwrap_or(if has_pairs { [3, 8] } else { [8, 16] });
    let angles = Angles { zeniths, azimuths };
    angles.check().map_err(|error| match error {
        Error::Setting { found, expected, .. } => Error::setting("--angles", found, expected),
        other => other,
    })?;
    let pairs = angles.count().pow(2);
    if has_pairs && pairs > MOST_PICTURES {
        let found = format!("{zeniths}x{azimuths}, {pairs} pictures of btf");
        return Err(Error::setting("--angles", found, format!("at most {MOST_PICTURES}")));
    }
    Ok(angles)
}

/// Largest number of pairs, each with four named planes.
const MOST_PICTURES: usize = 1 << 16;

/// Refuses flags that none of the kinds use.
pub fn check_uses(args: &BakeArgs) -> Result<()> {
    let has = |of: Is| args.what.iter().any(|kind| of(kind));
    if let Some(count) = args.directions.filter(|_| !has(|kind| !kind.has_horizons())) {
        let expected =
            "--what ellipse, visible-points or a kind of light: only these trace directions";
        return Err(Error::setting("--directions", count.to_string(), expected));
    }
    let [curvature, angles] = [
        args.curvature.map(|[outwards, inwards]| format!("{outwards},{inwards}")),
        args.angles.map(|[zeniths, azimuths]| format!("{zeniths}x{azimuths}")),
    ];
    let normals = args.normals.map(|normals| format!("{normals:?}").to_lowercase());
    let [paths, seed] = [args.paths, args.seed].map(|value| value.map(|v| v.to_string()));
    let (is_curved, is_light) = (has(|kind| kind.name == "curved-ellipse"), has(Kind::is_light));
    for (name, value, is_used, by) in [
        ("--normals", normals, has(|kind| kind.name == "bent-normal"), "bent-normal".to_owned()),
        ("--curvature", curvature, is_curved, "curved-ellipse".to_owned()),
        ("--angles", angles, has(has_angles), either(has_angles)),
        ("--paths", paths, is_light, lights()),
        ("--seed", seed, is_light, lights()),
    ] {
        if let Some(value) = value.filter(|_| !is_used) {
            return Err(Error::setting(name, value, format!("--what {by}: no other kind uses it")));
        }
    }
    Ok(())
}

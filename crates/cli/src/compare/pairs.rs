//! Channels and pictures that two files share.

use std::path::Path;

use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::Planes;
use ridgelight_trade::flip;

use crate::args::{CompareArgs, Renamed};
use crate::setup::{self, extension};

/// A channel of both.
pub struct Pair<'a> {
    pub name: &'a str,
    pub a: &'a [f32],
    pub b: &'a [f32],
}

pub struct Pairs<'a> {
    pub rows: usize,
    pub cols: usize,
    pub channels: Vec<Pair<'a>>,
    /// Names of channels that the other file lacks.
    pub only_a: Vec<&'a str>,
    pub only_b: Vec<&'a str>,
    /// Those of `only_b` that the result should have: all except an alpha that is 1 everywhere.
    pub lost: Vec<&'a str>,
}

/// Every plane of a file, old names of layers replaced; a transparent pixel is NaN in all of them.
pub fn read(path: &Path, renamed: &mut Renamed) -> Result<Planes> {
    let mut file = files::read_planes(path)?;
    for name in &mut file.names {
        if let Some(new) = renamed.new_channel(name) {
            *name = new;
        }
    }
    if let Some(alpha) = file.names.iter().position(|name| name == "A") {
        let alpha = file.planes[alpha].clone();
        for plane in &mut file.planes {
            let transparent = |(_, a): &(_, &f32)| **a == 0.0;
            plane.iter_mut().zip(&alpha).filter(transparent).for_each(|(v, _)| *v = f32::NAN);
        }
    }
    Ok(file)
}

/// Whether a file's planes can be elevations in radians: by `horizon`'s channel names where there
/// are names, and by their range.
pub fn check_horizons(path: &Path, file: &Planes) -> Result<()> {
    let wrong = |place: String, found: String, expected: &str| {
        Err(Error::file(path, place, found, expected))
    };
    let is_azimuth = |name: &&String| {
        // Until 0.1 the names were horizon.000.000 and so on, counter-clockwise from east.
        let degrees = name.strip_prefix("azimuth_").or_else(|| name.strip_prefix("horizon."));
        let degrees = degrees.and_then(|d| d.parse::<f64>().ok());
        degrees.is_some_and(|d| (0.0..=360.0).contains(&d))
    };
    let expected = "horizon channels azimuth_000.0 and so on, with the azimuth in degrees";
    let other = file.names.iter().find(|name| !is_azimuth(name));
    match (extension(path).as_str(), other) {
        ("npy", _) | ("exr" | "tif" | "tiff", None) => {}
        ("exr" | "tif" | "tiff", Some(other)) => {
            return wrong("channels".into(), other.clone(), expected);
        }
        (kind, _) => {
            return wrong("name".into(), format!("the extension .{kind}"), "a .tif, .exr or .npy");
        }
    }
    for (name, plane) in file.names.iter().zip(&file.planes) {
        // Vulkan allows atan an error of 4096 units in the last place.
        let most = std::f32::consts::FRAC_PI_2 * (1.0 + 4096.0 * f32::EPSILON);
        let steep = |v: &f32| v.abs() > most;
        if let Some(i) = plane.iter().position(steep) {
            let (row, col) = (i / file.cols, i % file.cols);
            let place = format!("channel {name} at row {row}, column {col}");
            return wrong(place, plane[i].to_string(), "an elevation, -π/2 to π/2 radians");
        }
    }
    Ok(())
}

pub fn pixels_per_degree(args: &CompareArgs) -> f64 {
    args.pixels_per_degree.unwrap_or(flip::PIXELS_PER_DEGREE)
}

/// An error: the result does not match the reference.
pub fn unlike(args: &CompareArgs, place: &str, found: String, expected: String) -> Error {
    let expected = format!("{expected} as in {}", args.reference.display());
    Error::file(&args.result, place, found, expected)
}

impl<'a> Pairs<'a> {
    pub fn of(args: &CompareArgs, a: &'a Planes, b: &'a Planes) -> Result<Self> {
        let size = |p: &Planes| format!("{} × {}", p.cols, p.rows);
        if (a.rows, a.cols) != (b.rows, b.cols) {
            return Err(unlike(args, "size", size(a), size(b)));
        }
        // Without names, an additional plane would shift all others.
        let numbered = [&args.result, &args.reference].map(|path| extension(path) == "npy");
        let is_numbered = numbered.contains(&true);
        if args.horizons || is_numbered {
            let count = |p: &Planes| p.names.len().to_string();
            if a.names.len() != b.names.len() {
                return Err(unlike(args, "number of channels", count(a), count(b)));
            }
        }
        // One map each: `hillshade` here is `band1` of another program. Horizons of an .npy have numbers, in the order of the azimuths.
        let is_single = a.names.len() == 1 && b.names.len() == 1;
        if is_single && !args.horizons || args.horizons && is_numbered {
            let [first, second] = [&a.names[0], &b.names[0]];
            if is_single && first != second && !is_numbered && !args.quiet {
                setup::note(&format!(
                    "the only channel of each file is compared: {first} with {second}"
                ));
            }
            // A picture's name, for flags of pictures.
            let takes_names_of_reference = numbered[0] || second == "Y";
            return Self::in_order(a, b, takes_names_of_reference).checked(args);
        }
        if (args.horizons || is_numbered)
            && let Some((a, b)) = a.names.iter().zip(&b.names).find(|(a, b)| a != b)
        {
            return Err(unlike(args, "channels", a.clone(), b.clone()));
        }
        let place = |p: &Planes, name: &str| p.names.iter().position(|n| n == name);
        let only = |p: &'a Planes, other: &Planes| -> Vec<&'a str> {
            p.names.iter().filter(|n| place(other, n).is_none()).map(String::as_str).collect()
        };
        let pair = |(name, a): (&'a String, &'a Vec<f32>)| {
            Some(Pair { name, a, b: &b.planes[place(b, name)?] })
        };
        let channels: Vec<_> = a.names.iter().zip(&a.planes).filter_map(pair).collect();
        if channels.is_empty() {
            let expected = format!("at least one of {}", b.names.join(" "));
            return Err(unlike(args, "channels", a.names.join(" "), expected));
        }
        let (rows, cols) = (a.rows, a.cols);
        let (only_a, only_b) = (only(a, b), only(b, a));
        let is_opaque = |name: &str| {
            name == "A" && place(b, name).is_none_or(|i| b.planes[i].iter().all(|v| *v == 1.0))
        };
        // The reference's own statistics layers need no counterpart.
        let is_own = |name: &str| name.split('.').next() == Some("standard_error");
        let lost =
            only_b.iter().copied().filter(|name| !is_opaque(name) && !is_own(name)).collect();
        Self { rows, cols, channels, only_a, only_b, lost }.checked(args)
    }

    /// # Errors
    /// Flags of pictures without a picture.
    fn checked(self, args: &CompareArgs) -> Result<Self> {
        let of_pictures = [
            ("--max-flip", args.bounds.max_flip.is_some()),
            ("--pixels-per-degree", args.pixels_per_degree.is_some()),
            ("--exposure", args.exposure != 1.0),
        ];
        if let Some((flag, _)) = of_pictures.iter().find(|(_, given)| *given)
            && self.pictures().is_empty()
        {
            let names: Vec<_> = self.channels.iter().map(|pair| pair.name).collect();
            let found = format!("only {} in both files", names.join(" "));
            return Err(Error::setting(*flag, found, "a picture: R, G and B, or Y"));
        }
        Ok(self)
    }

    /// As many planes in both, in their order; their names are those of the reference or of the result.
    fn in_order(a: &'a Planes, b: &'a Planes, takes_names_of_reference: bool) -> Self {
        let names = if takes_names_of_reference { &b.names } else { &a.names };
        let planes = a.planes.iter().zip(&b.planes);
        let channels = names.iter().zip(planes).map(|(name, (a, b))| Pair { name, a, b });
        let [only_a, only_b, lost] = [(); 3].map(|()| Vec::new());
        Self { rows: a.rows, cols: a.cols, channels: channels.collect(), only_a, only_b, lost }
    }

    /// Layers with R, G and B, or with Y.
    pub fn pictures(&self) -> Vec<PicturePair<'_>> {
        let find = |layer: &str, channel: &str| {
            self.channels.iter().find(|p| p.name.strip_prefix(layer) == Some(channel))
        };
        let picture = |pair: &Pair| {
            let layer = pair.name.strip_suffix(['R', 'Y'])?;
            if !(layer.is_empty() || layer.ends_with('.')) {
                return None;
            }
            let colours = ["R", "G", "B"].map(|channel| find(layer, channel));
            let channels = match (colours, pair.name.ends_with('R')) {
                ([Some(r), Some(g), Some(b)], true) => [r, g, b],
                ([None, ..] | [_, None, _] | [.., None], false) => [find(layer, "Y")?; 3],
                _ => return None,
            };
            Some(PicturePair { layer: layer.trim_end_matches('.').to_owned(), channels })
        };
        self.channels.iter().filter_map(picture).collect()
    }
}

/// A picture of both.
pub struct PicturePair<'a> {
    /// Empty for the main one.
    pub layer: String,
    channels: [&'a Pair<'a>; 3],
}

impl PicturePair<'_> {
    /// ꟻLIP of every pixel; radiance as a .png of this exposure shows it.
    pub fn flip(&self, args: &CompareArgs, pairs: &Pairs) -> Result<Vec<f32>> {
        let shown = |path: &Path, planes: [&[f32]; 3]| -> Vec<[f32; 3]> {
            let exposure = if extension(path) == "png" { 1.0 } else { args.exposure };
            (0..pairs.rows * pairs.cols).map(|i| planes.map(|p| p[i] * exposure)).collect()
        };
        flip::map(
            &shown(&args.result, self.channels.map(|pair| pair.a)),
            &shown(&args.reference, self.channels.map(|pair| pair.b)),
            pairs.cols,
            pixels_per_degree(args),
        )
    }
}

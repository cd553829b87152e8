//! The kinds of map: names, help, encodings, file formats, decoders and where values come from.

mod brdf;
mod directions;
mod far_field;
mod horizons;
mod light;

use clap::ValueEnum;
use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::{Limits, Plan};
use ridgelight_bake::{self as bake, Encoding, HorizonMap};
use ridgelight_io::Band;

use super::job::Job;
use super::map::{Format, MapFiles, Wanted};
use super::stages::{Stage, Stages};
pub use brdf::{FACTORS, PAIRS, Table};
pub use far_field::{diffuse, direct_plan, rays};
pub use light::paths;

/// A kind of map.
pub struct Kind {
    /// Its name for `--what`. File names have `_` for `-`.
    pub name: &'static str,
    /// Its description in --help and the manifest.
    pub about: &'static str,
    /// Its encodings; the first is the default.
    pub encodings: &'static [Encoding],
    /// Its default file formats.
    pub formats: &'static [Format],
    /// GLSL that reads the .ktx2, without the constants of a [`Map`].
    pub decoder: &'static str,
    /// Lays out a map of this kind and refuses settings that it cannot hold.
    pub map: fn(&Job, &Wanted) -> Result<Map>,
    pub source: Source,
}

/// Which way y of a normal points in textures and pictures, as engines name it. x points along a
/// row and z out of the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Normals {
    /// y to the first row, which is north, as Unity and Godot read it.
    #[default]
    Opengl,
    /// y to the last row, which is south, as Unreal reads it.
    Directx,
}

impl Normals {
    /// The factor of y, which is north.
    pub fn y(self) -> f64 {
        match self {
            Normals::Opengl => 1.0,
            Normals::Directx => -1.0,
        }
    }

    /// The name of the convention, and where y points.
    pub fn axes(self) -> [&'static str; 2] {
        match self {
            Normals::Opengl => ["OpenGL, +Y", "north, to the first row"],
            Normals::Directx => ["DirectX, -Y", "south, to the last row"],
        }
    }

    /// For the manifest.
    pub fn describe(self) -> serde_json::Value {
        let [convention, y] = self.axes();
        let packed = Format::value_variants().iter().filter(|format| format.is_packed());
        let packed: Vec<&str> = packed.map(|format| format.name()).collect();
        let of = format!(
            "{}, before the decoder is applied; other formats hold x east, y north, z up",
            packed.join(", ")
        );
        serde_json::json!({
            "convention": convention, "x": "east, to the last column", "y": y, "z": "up, out of the ground",
            "of": of,
        })
    }
}

/// The layout of a map in its files.
#[derive(Default)]
pub struct Map {
    /// A plane per value: the channel names of an .exr. Layers of textures and pictures have this order; for files of
    /// floats see [`places`](Self::places).
    pub planes: Vec<String>,
    /// What the planes hold, in turn; one entry where all hold the same.
    pub values: Vec<Value>,
    /// Whether the .ktx2 is an array: one layer for each group of planes that its encoding packs.
    pub is_array: bool,
    /// GLSL constants that the decoder needs.
    pub constants: Vec<String>,
    /// The axes of the normals that its textures and pictures hold.
    pub normals: Option<Normals>,
    /// Columns and rows, where they are not the field's.
    pub size: Option<[usize; 2]>,
    /// Axes of an .npy other than planes, rows and columns: names and counts, the fastest last.
    pub axes: Vec<(&'static str, usize)>,
    /// f32 roundings that the values went through one after another, where they are many.
    pub roundings: u32,
}

impl Map {
    /// The place of each plane in an .npy and a .tif: azimuths are in compass order, all others in the order of planes.
    pub fn places(&self, kind: &Kind) -> Vec<usize> {
        let mut places = vec![0; self.planes.len()];
        for (place, plane) in self.order(kind).into_iter().enumerate() {
            places[plane] = place;
        }
        places
    }

    /// The inverse of [`places`](Self::places).
    pub fn order(&self, kind: &Kind) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.planes.len()).collect();
        if kind.is_of_azimuths() {
            // Their names have leading zeros.
            order.sort_by_key(|plane| &self.planes[*plane]);
        }
        order
    }

    /// Names and units of the bands of a .tif.
    pub fn bands(&self, kind: &Kind) -> Vec<Band> {
        let band = |plane: usize| Band {
            name: self.planes[plane].clone(),
            unit: self.values[plane % self.values.len()].unit.to_owned(),
        };
        self.order(kind).into_iter().map(band).collect()
    }

    /// Texels of a plane, for a field of `grid_points` grid points.
    pub fn texels(&self, grid_points: usize) -> usize {
        self.size.map_or(grid_points, |[cols, rows]| cols * rows)
    }
}

/// One value of a texel.
#[derive(Clone, Copy)]
pub struct Value {
    pub name: &'static str,
    pub about: &'static str,
    /// "rad", "radiance", "grid points", or empty.
    pub unit: &'static str,
    /// Its least and largest possible value.
    pub range: [f64; 2],
}

/// The input of a kind.
#[derive(Clone, Copy)]
pub enum Source {
    /// The horizons themselves, a layer for each azimuth.
    Horizons,
    /// A sum over the azimuths of the horizons.
    Sums(fn(&Job) -> Box<dyn HorizonMap>),
    /// The sky-view factor, which the device sums as it does for `render`.
    SkyView,
    /// Visibility along directions.
    Directions(OfDirections),
    Light(OfLight),
}

/// A kind that the device computes from visibility along directions.
#[derive(Clone, Copy)]
pub struct OfDirections {
    /// Whether directions below horizontal count: a curved base surface can raise them above.
    pub needs_sphere: bool,
    pub plan: fn(&Job, &Limits) -> Result<Plan>,
    /// Bytes per texel that wait for the files.
    pub bytes: fn(&Job) -> u64,
    /// Work that does not depend on the outputs, in a stage of its own.
    pub probe: Option<fn(&Job, &mut MapFiles)>,
    /// Writes the files from the plan's outputs, 32 bits per component.
    pub take: fn(&Job, &[Vec<f32>], &mut MapFiles) -> Result<()>,
}

/// The names of stages that several kinds have.
pub mod stage {
    /// How much occlusion a curved base surface changes.
    pub const PROBES: &str = "probes of the base surface";
    pub const DIRECT: &str = "direct light";
    pub const POINTS: &str = "visible points";
    pub const SCATTERED: &str = "scattered light";
    pub const TRIANGLES: &str = "triangle visibility";
    pub const LIGHTS: &str = "lights";
}

/// A kind that is light. It needs several plans.
#[derive(Clone, Copy)]
pub struct OfLight {
    /// Whether the scene's lights illuminate it.
    pub is_lit: bool,
    /// The plans, to state their memory.
    pub plans: fn(&Job, &Limits) -> Result<Vec<Plan>>,
    /// Bytes that it holds until the end.
    pub bytes: fn(&Job) -> u64,
    /// The stages of [`make`](Self::make), and their work; where another kind has made the table,
    /// without those of the table.
    pub stages: fn(&Job, bool) -> Result<Vec<Stage>>,
    /// Writes the files and reports each stage.
    pub make: fn(&mut Making, &mut MapFiles) -> Result<()>,
}

/// What [`Kind::make`] works with: device, job and progress stages.
pub struct Making<'a> {
    pub gpu: &'a mut Headless,
    pub job: &'a Job<'a>,
    pub stages: &'a Stages,
}

impl Kind {
    /// The stem of its file names.
    pub fn stem(&self) -> String {
        self.name.replace('-', "_")
    }

    /// Whether its planes are azimuths.
    pub fn is_of_azimuths(&self) -> bool {
        matches!(self.source, Source::Horizons)
    }

    /// Whether it is light.
    pub fn is_light(&self) -> bool {
        matches!(self.source, Source::Light(_))
    }

    /// Whether the scene's lights illuminate it.
    pub fn is_lit(&self) -> bool {
        matches!(self.source, Source::Light(of) if of.is_lit)
    }

    /// Whether it comes from horizons; the others trace directions.
    pub fn has_horizons(&self) -> bool {
        self.reads_horizons() || matches!(self.source, Source::SkyView)
    }

    /// Whether the horizons are read back for it.
    pub fn reads_horizons(&self) -> bool {
        matches!(self.source, Source::Horizons | Source::Sums(_))
    }

    /// Whether it is the table of reflectance, in full or in short.
    pub fn is_table(&self) -> bool {
        self.name.starts_with("brdf")
    }

    /// Whether compressed blocks can hold it, by the range and the meaning of its values. Factors are
    /// negative in part, and indices of points are exact.
    pub fn compresses(&self) -> bool {
        !["brdf-factors", "visible-points"].contains(&self.name)
    }

    /// Whether the mean of several texels is the value of their area.
    pub fn has_means(&self) -> bool {
        self.has_horizons() || self.name == "scatter"
    }

    /// Whether its pictures store floats with a scale each.
    pub fn is_scaled(&self) -> bool {
        self.name == "scatter"
    }
}

macro_rules! decoder {
    ($stem:literal) => {
        include_str!(concat!("../../../../shaders_glsl/decode/", $stem, ".glsl"))
    };
}

const TABLE: OfLight = OfLight {
    is_lit: false,
    plans: far_field::plans,
    bytes: brdf::bytes,
    stages: brdf::table_stages,
    make: brdf::make_table,
};

/// All kinds, in the order of --help.
pub static KINDS: [Kind; 15] = [
    Kind {
        name: "horizon",
        about: "horizon elevations along --azimuths directions: a layer each",
        encodings: &bake::HORIZON,
        formats: &[Format::Ktx2],
        decoder: decoder!("horizon"),
        map: horizons::horizon,
        source: Source::Horizons,
    },
    Kind {
        name: "sky-view",
        about: "radiance of white ground under a uniform sky of radiance 1: the unoccluded \
            cosine-weighted share of the hemisphere about the normal",
        encodings: &bake::SHARE,
        formats: &[Format::Ktx2, Format::Png],
        decoder: decoder!("sky_view"),
        map: horizons::sky_view,
        source: Source::SkyView,
    },
    Kind {
        name: "visible-sky",
        about: "unoccluded share of the upper hemisphere's solid angle, for any normal: the mean of \
            1 - sin(horizon)",
        encodings: &bake::SHARE,
        formats: &[Format::Ktx2, Format::Png],
        decoder: decoder!("visible_sky"),
        map: |_, _| Ok(horizons::share("visible_sky", "1/2π ∫ V de over the upper hemisphere")),
        source: Source::Sums(|_| Box::new(bake::VisibleSky)),
    },
    Kind {
        name: "bent-normal",
        about: "mean unoccluded direction, and the half-angle of the cone with the unoccluded solid \
            angle",
        encodings: &bake::BENT_NORMAL,
        formats: &[Format::Ktx2, Format::Png],
        decoder: decoder!("bent_normal"),
        map: horizons::bent_normal,
        source: Source::Sums(|_| Box::new(bake::BentNormal)),
    },
    Kind {
        name: "sh-visibility",
        about: "visibility as SH of --sh-order: ∫ V Y de",
        encodings: &bake::COEFFICIENTS,
        formats: &[Format::Ktx2, Format::Exr],
        decoder: decoder!("sh_visibility"),
        map: horizons::sh_visibility,
        source: Source::Sums(|job| Box::new(bake::ShVisibility::new(job.sh_order()))),
    },
    Kind {
        name: "sh-transfer",
        about: "diffuse transfer of --sh-order 2 to 5: with SH light L, Σ t L is the radiance of \
            white ground",
        encodings: &bake::COEFFICIENTS,
        formats: &[Format::Ktx2, Format::Exr],
        decoder: decoder!("sh_transfer"),
        map: horizons::sh_transfer,
        source: Source::Sums(|job| Box::new(bake::ShTransfer::new(job.sh_order()))),
    },
    Kind {
        name: "ellipse",
        about: "six numbers for a shadow test: the ellipse in the hemisphere's plan view that holds \
            the visible sky, fitted to --directions",
        encodings: &bake::ELLIPSE,
        formats: &[Format::Ktx2],
        decoder: decoder!("ellipse"),
        map: directions::ellipse,
        source: Source::Directions(directions::ELLIPSE),
    },
    Kind {
        name: "curved-ellipse",
        about: "ellipses of visible sky for any small curvature of the base surface, for shadows and \
            view visibility: five per texel, fitted to --directions on a flat base and at \
            --curvature along both axes, with linear interpolation between",
        encodings: &bake::CURVED_ELLIPSE,
        formats: &[Format::Ktx2],
        decoder: decoder!("curved_ellipse"),
        map: directions::curved_ellipse,
        source: Source::Directions(directions::CURVED_ELLIPSE),
    },
    Kind {
        name: "visible-points",
        about: "row and column of the grid point visible from each grid point in each of \
            --directions: a layer each",
        encodings: &bake::POINTS,
        formats: &[Format::Ktx2],
        decoder: decoder!("visible_points"),
        map: directions::visible_points,
        source: Source::Directions(directions::VISIBLE_POINTS),
    },
    Kind {
        name: "scatter",
        about: "exit radiance under the scene's lights with indirect light by --bounces and --paths, \
            and its standard error",
        encodings: &bake::RADIANCE,
        formats: &[Format::Ktx2, Format::Exr],
        decoder: decoder!("scatter"),
        map: light::scatter,
        source: Source::Light(light::SCATTER),
    },
    Kind {
        name: "brdf",
        about: "far-field reflectance of periodic ground: a table over all pairs of --angles lights \
            and views; --bounces 0 omits indirect light",
        encodings: &bake::REFLECTED,
        formats: &[Format::Ktx2, Format::Npy],
        decoder: decoder!("brdf"),
        map: brdf::brdf,
        source: Source::Light(TABLE),
    },
    Kind {
        name: "brdf-factors",
        about: "brdf in short: eight functions g of one direction, as layers over --angles, with \
            brdf = Σ g(light) g(view); with --specular Σ g(light) h(view), which adds eight layers; \
            the manifest states its error",
        encodings: &bake::REFLECTED,
        formats: &[Format::Ktx2, Format::Npy],
        decoder: decoder!("brdf_factors"),
        map: brdf::factors,
        source: Source::Light(OfLight {
            // Each factor is an eigenvector of the table.
            stages: |job, is_made| brdf::shorter_stages(job, is_made, FACTORS),
            make: brdf::make_factors,
            ..TABLE
        }),
    },
    Kind {
        name: "brdf-harmonics",
        about: "brdf, smooth between all directions: weights of the products of SH of --sh-order of \
            light and view; the manifest states its error",
        encodings: &bake::HARMONIC_WEIGHTS,
        formats: &[Format::Ktx2, Format::Npy],
        decoder: decoder!("brdf_harmonics"),
        map: brdf::harmonics,
        source: Source::Light(OfLight {
            stages: |job, is_made| brdf::shorter_stages(job, is_made, job.sh_order().pow(2)),
            make: brdf::make_harmonics,
            ..TABLE
        }),
    },
    Kind {
        name: "btf",
        about: "an image in the field's own texels for each pair of --angles lights and views: \
            radiance under a light of irradiance 1 facing it, and the share of the view that each \
            texel fills; --bounces 0 omits indirect light",
        encodings: &bake::TEXELS,
        formats: &[Format::Ktx2],
        decoder: decoder!("btf"),
        map: brdf::btf,
        source: Source::Light(OfLight {
            bytes: far_field::bytes_of_views,
            stages: |job, _| brdf::lights_stages(job, 0, 1),
            make: brdf::make_btf,
            ..TABLE
        }),
    },
    Kind {
        name: "light-field",
        about: "an image in the field's own texels for each of --angles views under the scene's \
            lights: radiance, and the share of the view that each texel fills; specular reflects \
            suns as points and the sky along --directions",
        encodings: &bake::TEXELS,
        formats: &[Format::Ktx2],
        decoder: decoder!("light_field"),
        map: light::light_field,
        source: Source::Light(light::LIGHT_FIELD),
    },
];

/// A whole number among a plan's settings; the plan must have it.
fn number(plan: &Plan, name: &str) -> u32 {
    let of = plan.settings.iter().find(|(known, _)| known == name);
    of.and_then(|(_, value)| value.parse().ok()).expect("plans of scattered light state it")
}

/// One channel of all texels.
fn plane<const N: usize, T: Copy + Into<f64>>(texels: &[[T; N]], channel: usize) -> Vec<f32> {
    texels.iter().map(|texel| texel[channel].into() as f32).collect()
}

/// Writes a layer of texels, a plane per channel.
fn take<const N: usize, T: Copy + Into<f64>>(
    files: &mut MapFiles,
    texels: &[[T; N]],
) -> Result<()> {
    let planes: [Vec<f32>; N] = std::array::from_fn(|channel| plane(texels, channel));
    files.take(&planes.each_ref().map(Vec::as_slice))
}

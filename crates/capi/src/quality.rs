use ridgelight::scene::{Basis, Quality, Values, setting};

use crate::errors::{Done, Failure};
use crate::read::{SizeFirst, read};

/// Speed against accuracy. In every field 0 is the default.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightQuality {
    /// sizeof(RidgelightQuality).
    pub struct_size: u32,
    /// How horizons are found: 1 auto (default), 2 sweep, 3 pyramid, 4 brute-force.
    pub method: u32,
    /// Azimuths of sky and environment, [4..1024], default 32. Fewer: faster, banding at sharp silhouettes. With specular under a
    /// sky or an environment on steep ground the default is 64 to 256. With unknown heights, and with basis sh, it is 32.
    pub azimuths: u32,
    /// Slices across a sun's disc, a key light or a sphere light, [1..256], default 8. Fewer: faster, steps in
    /// soft shadows. A key light has sun_azimuths * width / 25 degrees of them, between half and 4 * sun_azimuths.
    pub sun_azimuths: u32,
    /// Distance between the lines of a sweep: 1 exact, 2 a quarter of a cell, 3 half a cell, 4 a cell (default),
    /// 5 two cells, 6 four cells. Wider: faster, small occluders missed between lines.
    pub lines: u32,
    /// How the results of lines are interpolated to grid points: 1 nearest, 2 slopes, 3 own, 4 aimed-nearest,
    /// 5 aimed, 6 aimed-around (default). aimed-around is the most exact. On llvmpipe, with lines one
    /// cell apart, a frame with aimed-nearest takes 0.4 to 0.8 times as long, and aimed-nearest is as fast as
    /// nearest and more exact than the first three.
    pub fuse: u32,
    /// Precision of stored sweep results: 1 f32 (default), 2 f16. (A packed hull would need the heights
    /// beforehand.)
    pub precision: u32,
    /// Hull storage: 1 auto (default), 2 private, 3 shared, 4 occluder-list. Never changes the result.
    pub hull: u32,
    /// Levels per doubling of distance in a height pyramid, [1..16], default 4. Fewer: faster, smeared
    /// horizons.
    pub level_step: u32,
    /// One more than the doublings of resolution by which a pyramid march reads finer levels, [1..5], default
    /// 3. Fewer: blurred distant horizons.
    pub level_offset_plus_1: u32,
    /// How a pyramid's levels are stored: 1 stack (default), 2 pyramid: less memory, slower.
    pub levels: u32,
    /// Elevations of an environment table, [8..4096], default 256. Fewer: faster, small bright places smeared.
    pub table_elevations: u32,
    /// How an environment is evaluated: 1 auto (default), 2 table, 3 sh.
    pub basis: u32,
    /// SH order of visibility, [2..6], default 4.
    pub sh_order: u32,
    /// How visibility becomes SH: 1 slices (default), 2 nlp, 3 table.
    pub wedges: u32,
    /// Receiver: how visibility becomes light: 1 plane (default), 2 cosine.
    pub receiver: u32,
    /// SH window: 1 none (default), 2 lanczos, 3 hann, 4 nonnegative.
    pub window: u32,
    /// Visibility is found at every nth grid point, n = 1, 2 or 4, default 1. More: faster, blurred shadows.
    pub subsample: u32,
    /// Horizons per side of a table of wedges, [4..256], default 64.
    pub wedge_side: u32,
    /// Basis of sphere lights: 1 exact (default), 2 sh.
    pub light_basis: u32,
    /// Largest light that a texel may lose from all sphere lights together, as a share of the brightest light
    /// that one of them can give to its nearest grid point, [0..1], default 1/65536; below 0: none.
    pub light_cutoff: f64,
    /// Number of bounces of light, [0..64].
    pub bounces: u32,
    /// How bounced light is found: 1 brute-force, 2 sweep, 3 pyramid, 4 auto (default).
    pub bounce_engine: u32,
    /// Azimuths of bounced light per grid point, [4..1024], default 16.
    pub bounce_azimuths: u32,
    /// As level_step, for the pyramid of exit radiance, [1..16], default 4.
    pub bounce_level_step: u32,
    /// As level_offset_plus_1, for the pyramid of exit radiance, [1..5], default 3.
    pub bounce_level_offset_plus_1: u32,
    /// Share of the direct light's energy that bounces may leave out, [0..1], default 1/65536; below 0: none.
    pub bounce_cutoff: f64,
    /// Storage of specular light between bounces: 1 vector (default), 2 vector-f16, 3 scalar.
    pub bounce_specular: u32,
}

// SAFETY: numbers; the size is first.
unsafe impl SizeFirst for RidgelightQuality {}

/// Calls a macro with every setting's field.
macro_rules! each_field {
    ($call:ident) => {
        $call! {
            method azimuths sun_azimuths lines fuse precision hull level_step level_offset_plus_1
            levels table_elevations basis sh_order wedges receiver window subsample wedge_side
            light_basis light_cutoff bounces bounce_engine bounce_azimuths bounce_level_step
            bounce_level_offset_plus_1 bounce_cutoff bounce_specular
        }
    };
}

/// The quality that a struct describes. A field of 0, or a null pointer, takes the value of `default`.
///
/// # Safety
/// As [`read`].
pub(crate) unsafe fn quality(from: *const RidgelightQuality, default: Quality) -> Done<Quality> {
    if from.is_null() {
        return Ok(default);
    }
    // SAFETY: as the caller says.
    let q = unsafe { read(from, "quality") }?;
    // 0 is the default. Words count from 1. Numbers that may be 0 have 1 added; a share below 0 is 0.
    macro_rules! values {
        ($($field:ident)*) => { [$((stringify!($field), f64::from(q.$field))),*] };
    }
    let mut quality = default;
    for (field, value) in each_field!(values).into_iter().filter(|(_, value)| *value != 0.0) {
        let name = field.strip_suffix("_plus_1");
        let setting = setting(name.unwrap_or(field)).expect("a field for each setting");
        let text = match &setting.values {
            // NaN stays NaN, which the setting refuses.
            Values::Share if value < 0.0 => "0".to_owned(),
            Values::Share => value.to_string(),
            Values::Words(words) => {
                // A packed hull would need the heights beforehand.
                let count = words.len() - usize::from(field == "precision");
                let word = words[..count].get(value as usize - 1).ok_or_else(|| {
                    let expected = format!("one of its constants, 0 to {count}");
                    Failure::argument(&format!("quality: {field}"), value, &expected)
                })?;
                word.name.to_owned()
            }
            _ => (value - if name.is_some() { 1.0 } else { 0.0 }).to_string(),
        };
        setting.set(&mut quality, &text)?;
    }
    if q.azimuths == 0 && quality.basis == Basis::Sh {
        quality.azimuths = Quality::default().azimuths;
    }
    Ok(quality)
}

#[cfg(test)]
mod tests {
    use ridgelight::scene::SETTINGS;

    use super::*;

    /// A struct with one value in one field, all others 0.
    fn with(field: &str, value: f64) -> RidgelightQuality {
        // SAFETY: plain numbers, of which 0 is valid.
        let mut q: RidgelightQuality = unsafe { std::mem::zeroed() };
        q.struct_size = size_of::<RidgelightQuality>() as u32;
        macro_rules! set {
            ($($name:ident)*) => {
                match field {
                    $(stringify!($name) => q.$name = value as _,)*
                    _ => panic!("no field {field}"),
                }
            };
        }
        each_field!(set);
        q
    }

    fn arrives(q: &RidgelightQuality) -> Done<Quality> {
        // SAFETY: the struct lives and states its size.
        unsafe { quality(q, Quality::default()) }
    }

    /// A value of each setting but the default arrives from its field.
    #[test]
    fn every_setting_has_a_field() {
        for setting in SETTINGS {
            let default = setting.get(&Quality::default());
            let has_zero = matches!(&setting.values, Values::Whole(r) if *r.start() == 0);
            let is_shifted = has_zero && default != "0";
            let field = format!("{}{}", setting.name, if is_shifted { "_plus_1" } else { "" });
            let (value, wanted) = match &setting.values {
                Values::Words(words) => {
                    let other = words.iter().position(|word| word.name != default).unwrap();
                    (other as f64 + 1.0, words[other].name.to_owned())
                }
                Values::Share => (0.125, "0.125".to_owned()),
                Values::Whole(range) => {
                    let other = range.clone().find(|n| n.to_string() != default).unwrap();
                    let value = f64::from(other.max(1)) + f64::from(u8::from(is_shifted));
                    (value, other.max(1).to_string())
                }
                Values::OneOf(numbers) => {
                    let last = *numbers.last().unwrap();
                    (f64::from(last), last.to_string())
                }
            };
            let found = arrives(&with(&field, value)).ok().unwrap();
            assert_eq!(setting.get(&found), wanted, "{field}");
            let changed = SETTINGS.iter().filter(|s| s.get(&found) != s.get(&Quality::default()));
            assert_eq!(changed.map(|s| s.name).collect::<Vec<_>>(), [setting.name]);
        }
    }

    /// The caller's default stands where a field is 0, but SH needs no more azimuths for narrow lobes.
    #[test]
    fn azimuths_default_to_those_of_the_scene() {
        let default = Quality { azimuths: 128, ..Quality::default() };
        let azimuths = |q: *const RidgelightQuality| {
            // SAFETY: the struct lives and states its size, or is null.
            unsafe { quality(q, default) }.ok().unwrap().azimuths
        };
        assert_eq!(azimuths(std::ptr::null()), 128);
        assert_eq!(azimuths(&with("fuse", 1.0)), 128);
        assert_eq!(azimuths(&with("azimuths", 16.0)), 16);
        assert_eq!(azimuths(&with("basis", 3.0)), 32);
        assert_eq!(azimuths(&with("basis", 2.0)), 128);
    }

    /// A number means what ridgelight.h says, whatever the order of the library's words.
    #[test]
    fn constants_mean_what_their_words_say() {
        let header = include_str!("../include/ridgelight.h").replace("\n    //", "");
        for setting in SETTINGS {
            let Values::Words(words) = &setting.values else { continue };
            let (before, _) = header.split_once(&format!("uint32_t {};", setting.name)).unwrap();
            let (_, says) = before.rsplit_once(';').unwrap();
            for (i, word) in words.iter().enumerate() {
                let found = arrives(&with(setting.name, i as f64 + 1.0));
                if setting.name == "precision" && word.name == "packed" {
                    assert!(found.is_err());
                    continue;
                }
                assert_eq!(setting.get(&found.ok().unwrap()), word.name);
                let said = match (setting.name, word.name) {
                    ("lines", "1/4") => "a quarter of a cell",
                    ("lines", "1/2") => "half a cell",
                    ("lines", "1") => "a cell",
                    ("lines", "2") => "two cells",
                    ("lines", "4") => "four cells",
                    (_, name) => name,
                };
                let is_end = |c: char| !c.is_alphanumeric() && c != '-';
                let wanted = format!("{} {said}", i + 1);
                let is_said = says.split(&wanted).skip(1).any(|rest| rest.starts_with(is_end));
                assert!(is_said, "{}: {} {} not in {says}", setting.name, i + 1, word.name);
            }
            assert!(arrives(&with(setting.name, words.len() as f64 + 1.0)).is_err());
        }
    }

    #[test]
    fn shares_that_are_no_numbers_are_refused() {
        for field in ["light_cutoff", "bounce_cutoff"] {
            for value in [f64::NAN, f64::INFINITY, 1.5] {
                assert!(arrives(&with(field, value)).is_err(), "{field} {value}");
            }
            let none = arrives(&with(field, f64::NEG_INFINITY)).ok().unwrap();
            assert_eq!(setting(field).unwrap().get(&none), "0");
        }
    }
}

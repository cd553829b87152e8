//! What settings are held against, and how good that is itself.

mod drawn;

use std::path::Path;

use ridgelight::scene::HeightField;
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::Planes;
use ridgelight_trade::error::ImageError;

use crate::terminal::percent;

/// The layer of a reference that holds one standard deviation of its noise.
const NOISE_LAYER: &str = "standard_error";

pub struct Truth {
    /// One plane or three, row-major, NaN at voids.
    pub planes: Vec<Vec<f32>>,
    cols: usize,
    rows: usize,
    /// What it is, and how its own error was found.
    pub about: String,
    pub quality_of: String,
    /// Relative RMSE that it may have itself, where that is known.
    pub own_error: Option<f64>,
    /// Mean variance of its noise over the square of its mean.
    noise: f64,
}

/// How far settings are from the truth. Relative to the truth's mean, over all channels.
#[derive(Clone, Copy, Debug)]
pub struct Distance {
    /// RMSE, the truth's noise taken off.
    pub rmse: f64,
    pub mean_shift: f64,
    pub p99: f64,
    pub worst: f64,
    pub worst_row: usize,
    pub worst_col: usize,
}

impl Truth {
    /// What errors below it cannot be told apart by.
    pub fn floor(&self) -> f64 {
        self.own_error.unwrap_or(0.0)
    }

    /// Its own error in words.
    pub fn own_text(&self) -> String {
        self.own_error.map_or_else(|| "unknown".to_owned(), |e| format!("at most {}", percent(e)))
    }

    /// A file's.
    pub fn read(path: &Path, field: &HeightField) -> Result<Self> {
        let Planes { rows, cols, names, mut planes } = files::read_planes(path)?;
        let wrong = |place: &str, found: String, expected: String| {
            Err(Error::File { path: path.to_owned(), place: place.to_owned(), found, expected })
        };
        if (rows, cols) != (field.rows(), field.cols()) {
            let expected = format!("{} × {}, as the field", field.cols(), field.rows());
            return wrong("size", format!("{cols} × {rows}"), expected);
        }
        let mut take = |wanted: &[String]| -> Option<Vec<Vec<f32>>> {
            let at: Option<Vec<usize>> =
                wanted.iter().map(|w| names.iter().position(|n| n == w)).collect();
            Some(at?.into_iter().map(|i| std::mem::take(&mut planes[i])).collect())
        };
        let colour = |layer: &str| ["R", "G", "B"].map(|c| format!("{layer}{c}"));
        let radiance = take(&colour("")).or_else(|| take(&["Y".to_owned()]));
        let errors =
            take(&colour(&format!("{NOISE_LAYER}."))).or_else(|| take(&[NOISE_LAYER.to_owned()]));
        let Some(planes) = radiance else {
            return wrong("channels", names.join(" "), "R, G and B, or Y".to_owned());
        };
        let known = |v: &&f32| !v.is_nan();
        let count = planes[0].iter().filter(known).count().max(1) as f64;
        let mean = planes.iter().flatten().filter(known).map(|v| f64::from(*v)).sum::<f64>()
            / (count * planes.len() as f64);
        let mut truth = Self {
            planes,
            cols,
            rows,
            about: path.display().to_string(),
            quality_of: format!("it has no layer {NOISE_LAYER} and is taken as it is"),
            own_error: None,
            noise: 0.0,
        };
        if let Some(errors) = errors {
            // A texel's channels come of the same paths: they waver together.
            let variance = |i: usize| {
                errors.iter().map(|e| f64::from(e[i]).powi(2)).sum::<f64>() / errors.len() as f64
            };
            let known: Vec<f64> = (0..rows * cols).map(variance).filter(|v| !v.is_nan()).collect();
            let relative = mean.powi(2).max(f64::MIN_POSITIVE);
            truth.noise = known.iter().sum::<f64>() / count / relative;
            // The mean of squared normal noise wavers by √(2 Σσ⁴) / n: twice that is left of it.
            let fourth: f64 = known.iter().map(|v| v * v).sum();
            let left = (2.0 * (2.0 * fourth).sqrt() / count / relative).sqrt();
            let unmet = unmet(path)? / relative.sqrt();
            truth.own_error = Some(left.hypot(unmet));
            truth.quality_of = format!(
                "its noise, {} of the mean by its layer {NOISE_LAYER}, is taken off each RMSE (not \
                 off percentiles); what is left of it is twice the wavering of its mean square, {}, \
                 and light that its paths may not have met, {}",
                percent(truth.noise.sqrt()),
                percent(left),
                percent(unmet)
            );
        }
        Ok(truth)
    }

    /// How far planes are from it.
    pub fn distance(&self, planes: &[Vec<f32>]) -> Result<Distance> {
        let channels = planes.len().max(self.planes.len());
        let all = |planes: &[Vec<f32>]| -> Vec<f32> {
            (0..channels).flat_map(|c| planes[c.min(planes.len() - 1)].iter().copied()).collect()
        };
        let e = ImageError::of(&all(planes), &all(&self.planes), self.cols)?;
        if e.mismatched > 0 {
            let found = format!("{} texels with data where the other has none", e.mismatched);
            return Err(Error::setting("--reference", found, "the same scene, voids alike"));
        }
        let relative = |x: f64| if x == 0.0 { 0.0 } else { x / e.mean_reference.abs() };
        Ok(Distance {
            rmse: (e.relative_rmse.powi(2) - self.noise).max(0.0).sqrt(),
            mean_shift: e.relative_mean_shift,
            p99: relative(e.p99),
            worst: relative(e.worst),
            worst_row: e.worst_row % self.rows,
            worst_col: e.worst_col,
        })
    }
}

/// Standard error of light that no path of a `reference` may have met: the root of the mean square of its
/// channels', 0 where a file tells of none.
fn unmet(path: &Path) -> Result<f64> {
    let all = files::read_metadata(path)?;
    let Some((name, text)) = all.iter().find(|(name, _)| name == "unmet_standard_error") else {
        return Ok(0.0);
    };
    let channels: Option<Vec<f64>> = text.split(',').map(|v| v.parse().ok()).collect();
    let Some(channels) = channels.filter(|c| c.iter().all(|v| v.is_finite())) else {
        return Err(Error::File {
            path: path.to_owned(),
            place: format!("header: {name}"),
            found: text.clone(),
            expected: "finite numbers with commas between them".to_owned(),
        });
    };
    Ok((channels.iter().map(|v| v * v).sum::<f64>() / channels.len() as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(planes: Vec<Vec<f32>>, noise: f64) -> Truth {
        let (about, quality_of) = (String::new(), String::new());
        Truth { planes, cols: 2, rows: 2, about, quality_of, own_error: None, noise }
    }

    /// Mean 2; differences 0, 0, 0, 0.4 in each channel: RMSE 0.2, a tenth of the mean. Noise of a
    /// variance of 0.0036 means² leaves √(0.01 - 0.0036) = 0.08.
    #[test]
    fn noise_is_taken_off_and_grey_is_compared_with_colour() {
        let colour = vec![vec![2.0; 4]; 3];
        let grey = [vec![2.0, 2.0, 2.0, 2.4]];
        let found = truth(colour.clone(), 0.0).distance(&grey).unwrap();
        assert!((found.rmse - 0.1).abs() < 1e-7, "{found:?}");
        assert!((found.mean_shift - 0.05).abs() < 1e-7 && (found.worst - 0.2).abs() < 1e-7);
        assert_eq!([found.worst_row, found.worst_col], [1, 1]);
        let less = truth(colour.clone(), 0.0036).distance(&grey).unwrap();
        assert!((less.rmse - 0.08).abs() < 1e-7, "{less:?}");
        assert_eq!(truth(colour, 0.02).distance(&grey).unwrap().rmse, 0.0);
        let holed = [vec![2.0, f32::NAN, 2.0, 2.0]];
        let error = truth(vec![vec![2.0; 4]], 0.0).distance(&holed).unwrap_err();
        assert!(error.to_string().contains("1 texels"), "{error}");
    }

    /// Radiance 2 with a standard error of 0.2 in 64 texels: variance 0.01 of the mean², which wavers by
    /// √(2/64) of itself; the RMSE of what it may be twice off is √(2 · 0.01 · √(2/64)). Unmet light of 0.02,
    /// 0.02 and 0.04 is √(0.0008) in its mean square, √(0.0002) of the mean.
    #[test]
    fn a_references_noise_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("truth.exr");
        let (light, noise) = (vec![[2.0; 3]; 64], vec![[0.2; 3]; 64]);
        let layer = |name: &str, texels| files::Layer {
            name: name.to_owned(),
            channels: files::Channels::Rgb(texels),
        };
        let all = [layer("", &light), layer(NOISE_LAYER, &noise)];
        let field = HeightField::new(8, 8, &[0.0; 64], [1.0; 2], None).unwrap();
        files::write_exr(&path, 8, 8, &all, &[]).unwrap();
        let truth = Truth::read(&path, &field).unwrap();
        assert!((truth.noise - 0.01).abs() < 1e-7, "{}", truth.noise);
        let own = (0.02 * (2.0_f64 / 64.0).sqrt()).sqrt();
        assert!((truth.floor() - own).abs() < 1e-7, "{:?}", truth.own_error);
        let unmet = |text: &str| [("unmet_standard_error".to_owned(), text.to_owned())];
        files::write_exr(&path, 8, 8, &all, &unmet("0.02,0.02,0.04")).unwrap();
        let met = Truth::read(&path, &field).unwrap();
        assert!((met.floor() - own.hypot(0.0002_f64.sqrt())).abs() < 1e-7, "{:?}", met.own_error);
        files::write_exr(&path, 8, 8, &all, &unmet("0.02,none")).unwrap();
        let error = Truth::read(&path, &field).err().unwrap().to_string();
        assert!(error.contains("unmet_standard_error: found 0.02,none"), "{error}");
        files::write_exr(&path, 8, 8, &all[..1], &[]).unwrap();
        let bare = Truth::read(&path, &field).unwrap();
        assert_eq!((bare.noise, bare.own_error), (0.0, None));
        assert_eq!(bare.own_text(), "unknown");
        let other = HeightField::new(4, 16, &[0.0; 64], [1.0; 2], None).unwrap();
        let error = Truth::read(&path, &other).err().unwrap().to_string();
        assert!(error.contains("found 8 × 8, expected 16 × 4"), "{error}");
    }
}

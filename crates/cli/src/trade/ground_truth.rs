//! The ground truth that settings are compared with, and its own error.

mod drawn;

use std::path::Path;

use ridgelight::scene::HeightField;
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::Planes;
use ridgelight_trade::error::ImageError;

use super::picture::Tones;
use crate::setup::terminal::percent;

/// The layer of a reference that holds one standard deviation of its Monte Carlo noise.
const NOISE_LAYER: &str = "standard_error";

pub struct GroundTruth {
    /// One plane or three, row-major, NaN at voids.
    pub planes: Vec<Vec<f32>>,
    cols: usize,
    /// Its source, and how its own error was found.
    pub about: String,
    pub quality_of: String,
    /// Its own relative RMSE, where known.
    pub own_error: Option<f64>,
    /// Mean variance of its noise over the square of its mean.
    noise: f64,
    /// The grey scale of pictures.
    pub tones: Tones,
}

impl GroundTruth {
    fn new(planes: Vec<Vec<f32>>, cols: usize, about: String) -> Self {
        let (tones, quality_of) = (Tones::of(&planes), String::new());
        Self { planes, cols, about, quality_of, own_error: None, noise: 0.0, tones }
    }

    /// Smaller errors cannot be distinguished.
    pub fn floor(&self) -> f64 {
        self.own_error.unwrap_or(0.0)
    }

    /// Its own error in words.
    pub fn own_text(&self) -> String {
        self.own_error.map_or_else(|| "unknown".to_owned(), |e| format!("at most {}", percent(e)))
    }

    /// Reads a file.
    pub fn read(path: &Path, field: &HeightField) -> Result<Self> {
        let Planes { rows, cols, names, mut planes } = files::read_planes(path)?;
        let wrong = |place: &str, found: String, expected: String| {
            Err(Error::file(path, place, found, expected))
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
        let mut ground_truth = Self::new(planes, cols, path.display().to_string());
        ground_truth.quality_of = format!("it has no layer {NOISE_LAYER}, so its noise is unknown");
        if let Some(errors) = errors {
            // A texel's channels share paths, so their errors are correlated.
            let variance = |i: usize| {
                errors.iter().map(|e| f64::from(e[i]).powi(2)).sum::<f64>() / errors.len() as f64
            };
            let known: Vec<f64> = (0..rows * cols).map(variance).filter(|v| !v.is_nan()).collect();
            let relative = mean.powi(2).max(f64::MIN_POSITIVE);
            ground_truth.noise = known.iter().sum::<f64>() / count / relative;
            // The mean of squared normal noise has a standard error of √(2 Σσ⁴) / n: twice that
            // remains after subtraction.
            let fourth: f64 = known.iter().map(|v| v * v).sum();
            let left = (2.0 * (2.0 * fourth).sqrt() / count / relative).sqrt();
            let unsampled = unsampled(path)? / relative.sqrt();
            ground_truth.own_error = Some(left.hypot(unsampled));
            ground_truth.quality_of = format!(
                "its Monte Carlo noise, {} of the mean by its layer {NOISE_LAYER}, is subtracted \
                    from each RMSE (not from percentiles); what remains is twice the standard \
                    error of its mean square, {}, and unsampled light, {}",
                percent(ground_truth.noise.sqrt()),
                percent(left),
                percent(unsampled)
            );
        }
        Ok(ground_truth)
    }

    /// The error of planes over all channels, with the noise subtracted from the relative RMSE.
    pub fn distance(&self, planes: &[Vec<f32>]) -> Result<ImageError> {
        let channels = planes.len().max(self.planes.len());
        let all = |planes: &[Vec<f32>]| -> Vec<f32> {
            (0..channels).flat_map(|c| planes[c.min(planes.len() - 1)].iter().copied()).collect()
        };
        let mut e = ImageError::of(&all(planes), &all(&self.planes), self.cols)?;
        if e.mismatched > 0 {
            let found = format!("{} texels that have data in only one of the two", e.mismatched);
            let expected = "the same scene, with the same voids";
            return Err(Error::setting("--reference", found, expected));
        }
        e.relative_rmse = (e.relative_rmse.powi(2) - self.noise).max(0.0).sqrt();
        // Channels are stacked.
        e.worst_row %= self.planes[0].len() / self.cols;
        Ok(e)
    }
}

/// Standard error of unsampled light of a `reference`: the root mean square of its channels'; 0
/// where the file states none.
fn unsampled(path: &Path) -> Result<f64> {
    let all = files::read_metadata(path)?;
    // The second name is that of the first release.
    let names = ["unsampled_standard_error", "unmet_standard_error"];
    let Some((name, text)) = all.iter().find(|(name, _)| names.contains(&name.as_str())) else {
        return Ok(0.0);
    };
    let channels: Option<Vec<f64>> = text.split(',').map(|v| v.parse().ok()).collect();
    let Some(channels) = channels.filter(|c| c.iter().all(|v| v.is_finite())) else {
        let expected = "comma-separated finite numbers";
        return Err(Error::file(path, format!("header: {name}"), text, expected));
    };
    Ok((channels.iter().map(|v| v * v).sum::<f64>() / channels.len() as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ground_truth(planes: Vec<Vec<f32>>, noise: f64) -> GroundTruth {
        GroundTruth { noise, ..GroundTruth::new(planes, 2, String::new()) }
    }

    /// Mean 2; differences 0, 0, 0, 0.4 in each channel: RMSE 0.2, a tenth of the mean. Noise of
    /// variance 0.0036 means² leaves √(0.01 - 0.0036) = 0.08.
    #[test]
    fn noise_is_subtracted_and_grey_compares_with_colour() {
        let colour = vec![vec![2.0; 4]; 3];
        let grey = [vec![2.0, 2.0, 2.0, 2.4]];
        let found = ground_truth(colour.clone(), 0.0).distance(&grey).unwrap();
        assert!((found.relative_rmse - 0.1).abs() < 1e-7, "{found:?}");
        assert!(
            (found.relative_mean_shift - 0.05).abs() < 1e-7
                && (found.relative_worst - 0.2).abs() < 1e-7
        );
        assert_eq!([found.worst_row, found.worst_col], [1, 1]);
        let less = ground_truth(colour.clone(), 0.0036).distance(&grey).unwrap();
        assert!((less.relative_rmse - 0.08).abs() < 1e-7, "{less:?}");
        assert_eq!(ground_truth(colour, 0.02).distance(&grey).unwrap().relative_rmse, 0.0);
        let holed = [vec![2.0, f32::NAN, 2.0, 2.0]];
        let error = ground_truth(vec![vec![2.0; 4]], 0.0).distance(&holed).unwrap_err();
        assert!(error.to_string().contains("1 texels"), "{error}");
    }

    /// Radiance 2 with a standard error of 0.2 in 64 texels: variance 0.01 of the mean², whose own
    /// relative standard error is √(2/64); twice that leaves an RMSE of √(2 · 0.01 · √(2/64)).
    /// Unsampled light of 0.02, 0.02 and 0.04 is √(0.0008) in its mean square, √(0.0002) of the
    /// mean.
    #[test]
    fn noise_of_a_reference_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("ground_truth.exr");
        let (light, noise) = (vec![[2.0; 3]; 64], vec![[0.2; 3]; 64]);
        let layer = |name: &str, texels| files::Layer {
            name: name.to_owned(),
            channels: files::Channels::Rgb(texels),
        };
        let all = [layer("", &light), layer(NOISE_LAYER, &noise)];
        let field = HeightField::new(8, 8, &[0.0; 64], [1.0; 2], None).unwrap();
        files::write_exr(&path, 8, 8, &all, &[]).unwrap();
        let ground_truth = GroundTruth::read(&path, &field).unwrap();
        assert!((ground_truth.noise - 0.01).abs() < 1e-7, "{}", ground_truth.noise);
        let own = (0.02 * (2.0_f64 / 64.0).sqrt()).sqrt();
        assert!((ground_truth.floor() - own).abs() < 1e-7, "{:?}", ground_truth.own_error);
        let unsampled = |text: &str| [("unsampled_standard_error".to_owned(), text.to_owned())];
        files::write_exr(&path, 8, 8, &all, &unsampled("0.02,0.02,0.04")).unwrap();
        let met = GroundTruth::read(&path, &field).unwrap();
        assert!((met.floor() - own.hypot(0.0002_f64.sqrt())).abs() < 1e-7, "{:?}", met.own_error);
        files::write_exr(&path, 8, 8, &all, &unsampled("0.02,none")).unwrap();
        let error = GroundTruth::read(&path, &field).err().unwrap().to_string();
        assert!(error.contains("unsampled_standard_error: found 0.02,none"), "{error}");
        files::write_exr(&path, 8, 8, &all[..1], &[]).unwrap();
        let bare = GroundTruth::read(&path, &field).unwrap();
        assert_eq!((bare.noise, bare.own_error), (0.0, None));
        assert_eq!(bare.own_text(), "unknown");
        let other = HeightField::new(4, 16, &[0.0; 64], [1.0; 2], None).unwrap();
        let error = GroundTruth::read(&path, &other).err().unwrap().to_string();
        assert!(error.contains("found 8 × 8, expected 16 × 4"), "{error}");
    }
}

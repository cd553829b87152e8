use ridgelight::files::{self, Channels, Layer, Planes};
use ridgelight::measure::error::{HorizonError, ImageError};
use ridgelight::{Error, Result};

use crate::args::CompareArgs;
use crate::setup::{self, Outcome};

pub fn run(args: &CompareArgs) -> Result<Outcome> {
    if let Some(path) = &args.diff {
        setup::check_output("--diff", path, &["exr", "npy"])?;
    }
    if let Some(path) = &args.json {
        setup::check_output("--json", path, &["json"])?;
    }
    setup::check_distinct(
        &[("--diff", args.diff.as_deref()), ("--json", args.json.as_deref())],
        &[&args.result, &args.reference],
    )?;
    if args.max_rmse.is_some_and(|x| x.is_nan() || x < 0.0) {
        return Err(Error::setting(
            "--max-rmse",
            args.max_rmse.unwrap_or_default().to_string(),
            "0 or more",
        ));
    }
    let (result, reference) =
        (files::read_planes(&args.result)?, files::read_planes(&args.reference)?);
    let unlike = |place: &str, found: String, expected: String| Error::File {
        path: args.result.clone(),
        place: place.to_owned(),
        found,
        expected: format!("{expected} as in {}", args.reference.display()),
    };
    let size = |p: &Planes| format!("{} × {}, {} channels", p.cols, p.rows, p.planes.len());
    if size(&result) != size(&reference) {
        return Err(unlike("size", size(&result), size(&reference)));
    }
    if result.names != reference.names {
        return Err(unlike("channels", result.names.join(" "), reference.names.join(" ")));
    }
    let mut beyond = false;
    let mut rows = Vec::new();
    if args.horizons {
        let e = HorizonError::of(
            &result.planes.concat(),
            &reference.planes.concat(),
            result.rows,
            result.cols,
        )?;
        beyond |= e.mismatched > 0;
        if !args.quiet {
            crate::say!(
                "horizons: mean {:.5}°  median {:.5}°  99 % {:.4}°  99.9 % {:.4}°  worst {:.4}° at azimuth {}, row {}, column {}; {} compared, {} masked, {} masked in one only",
                e.mean,
                e.median,
                e.p99,
                e.p999,
                e.worst,
                e.worst_at[0],
                e.worst_at[1],
                e.worst_at[2],
                e.count,
                e.masked,
                e.mismatched
            );
        }
        rows.push(serde_json::json!({
            "mean_deg": e.mean, "median_deg": e.median, "p99_deg": e.p99, "p999_deg": e.p999, "worst_deg": e.worst,
            "worst_at": e.worst_at, "count": e.count, "masked": e.masked, "mismatched": e.mismatched,
        }));
    } else {
        for ((name, a), b) in result.names.iter().zip(&result.planes).zip(&reference.planes) {
            let e = ImageError::of(a, b, result.cols)?;
            beyond |= e.mismatched > 0 || args.max_rmse.is_some_and(|x| !e.within(x));
            if !args.quiet {
                crate::say!(
                    "{name}: RMSE {:.6} ({:.4} % of the mean)  mean shift {:+.4} %  99 % {:.6}  worst {:.6} at row {}, column {}; {} compared, {} masked, {} masked in one only",
                    e.rmse,
                    100.0 * e.relative_rmse,
                    100.0 * e.relative_mean_shift,
                    e.p99,
                    e.worst,
                    e.worst_row,
                    e.worst_col,
                    e.count,
                    e.masked,
                    e.mismatched
                );
            }
            rows.push(serde_json::json!({
                "channel": name, "rmse": e.rmse, "relative_rmse": e.relative_rmse, "mean_shift": e.mean_shift,
                "relative_mean_shift": e.relative_mean_shift, "p99": e.p99, "worst": e.worst,
                "worst_row": e.worst_row, "worst_col": e.worst_col, "count": e.count, "masked": e.masked, "mismatched": e.mismatched,
            }));
        }
    }
    if let Some(path) = &args.diff {
        write_difference(path, &result, &reference)?;
    }
    if let Some(path) = &args.json {
        files::write_json(path, &serde_json::json!({ "rows": rows, "beyond": beyond }))?;
    }
    if beyond && !args.quiet {
        crate::say!("beyond the bound");
    }
    Ok(if beyond { Outcome::Beyond } else { Outcome::Done })
}

fn write_difference(path: &std::path::Path, a: &Planes, b: &Planes) -> Result<()> {
    let planes: Vec<Vec<f32>> = a
        .planes
        .iter()
        .zip(&b.planes)
        .map(|(a, b)| a.iter().zip(b).map(|(a, b)| a - b).collect())
        .collect();
    if setup::extension(path) == "npy" {
        return files::write_npy_f32(
            path,
            &[planes.len(), a.rows, a.cols],
            planes.iter().map(Vec::as_slice),
        );
    }
    let layers: Vec<Layer> = planes
        .iter()
        .zip(&a.names)
        .map(|(plane, name)| Layer { name: String::new(), channels: Channels::Scalar(name, plane) })
        .collect();
    files::write_exr(path, a.rows, a.cols, &layers, &[])
}

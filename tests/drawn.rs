//! Azimuths that an environment draws, against even ones.

use std::path::Path;

use ridgelight::cpu::env_tables::{EnvTables, bottom_rad, env_tables};
use ridgelight::cpu::env_wedges::env_wedges;
use ridgelight::cpu::light::{environment_of, normal};
use ridgelight::cpu::oracle::Oracle;
use ridgelight::files::{self, HeightOptions};
use ridgelight::plan::Azimuth;
use ridgelight::plan::azimuths::{even, towards_light};
use ridgelight::scene::{Border, Environment, HeightField};

/// Elevations of the tables: enough that the azimuths alone err.
const NODES: usize = 1024;
const BORDER: Border = Border::Plane;

fn asset(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets").join(name)
}

fn tables(environment: &Environment, azimuths: &[Azimuth]) -> EnvTables {
    let rows = env_wedges(environment, BORDER, azimuths);
    let sides = (environment.height(), azimuths.len());
    env_tables(&rows, sides, NODES, bottom_rad(BORDER))
}

/// Light of samples through the true horizons in some azimuths alone, mean over channels.
fn lit(
    field: &HeightField,
    environment: &Environment,
    azimuths: &[Azimuth],
    places: &[usize],
) -> Vec<f64> {
    let tables = tables(environment, azimuths);
    let oracle = Oracle::new(field, BORDER);
    let at = |place: &usize| {
        let (row, col) = (place / field.cols(), place % field.cols());
        let normal = normal(field, BORDER, row, col);
        let wedge = |(k, azimuth): (usize, &Azimuth)| {
            let phi = azimuth.swept_rad(field.cell_m());
            let horizon = oracle.elevation_rad(row, col, phi).tan();
            let own_plane = -(normal.x * phi.cos() + normal.y * phi.sin()) / normal.z;
            tables.light(k, horizon.max(own_plane), normal).element_sum() / 3.0
        };
        azimuths.iter().enumerate().map(wedge).sum()
    };
    places.iter().map(at).collect()
}

/// By how much wedges of equal light err less than these, where each errs by the same share of its light and
/// none knows of the others: by the root of the sums of their lights' squares.
fn equal_light_gain(environment: &Environment, azimuths: &[Azimuth]) -> f64 {
    let tables = tables(environment, azimuths);
    // Over level ground.
    let lights: Vec<f64> = (0..azimuths.len()).map(|k| tables.at(k, 2, 0).element_sum()).collect();
    let squares: f64 = lights.iter().map(|l| l * l).sum();
    (squares * lights.len() as f64).sqrt() / lights.iter().sum::<f64>()
}

/// The bundled sky over the bundled terrain, whose heights are drawn out until some samples do not see the sky's
/// sun, 48 degrees high. Drawn azimuths are to gain as much as wedges of equal light would: a quarter of them is
/// spread evenly, but in narrow wedges horizons turn less and errors are a smaller share of the light.
///
/// Heights as they are hide nothing of the sun: then drawn azimuths are farther off, as all else is cut a quarter
/// as finely. A wedge four times as wide errs by 4² as much at most, where horizons turn in proportion, and
/// there are a quarter as many: 4² / √4.
#[test]
fn drawn_azimuths_beat_even_ones_where_what_is_bright_is_hidden() {
    let sky = files::read_environment(&asset("sky_512x256.hdr"), 0.0).expect("the bundled sky");
    for (z_scale, count) in [(1.0, 64), (2.0, 16), (2.0, 64), (3.0, 64)] {
        let cell_m = [66.0, 92.6];
        let options = HeightOptions { cell_m: Some(cell_m), z_scale, ..HeightOptions::default() };
        let path = asset("mt_washington_256.png");
        let field = files::read_heights(&path, &options).expect("the bundled field");
        let (cols, count_all) = (field.cols(), field.rows() * field.cols());
        let places: Vec<usize> = (0..count_all).step_by(331).collect();
        let oracle = Oracle::new(&field, BORDER);
        let truth = |p: &usize| environment_of(&oracle, p / cols, p % cols, &sky);
        let truth: Vec<f64> = places.iter().map(|p| truth(p).iter().sum::<f64>() / 3.0).collect();
        let rmse = |azimuths: &[Azimuth]| {
            let found = lit(&field, &sky, azimuths, &places);
            let squares = found.iter().zip(&truth).map(|(a, b)| (a - b).powi(2));
            (squares.sum::<f64>() / truth.len() as f64).sqrt()
        };
        let evenly = even(count, cell_m);
        let gain = rmse(&evenly) / rmse(&towards_light(&sky, 0.0, BORDER, count, cell_m));
        let factor = equal_light_gain(&sky, &evenly);
        println!("heights × {z_scale}, {count} azimuths: gain {gain:.2}, factor {factor:.2}");
        let least = if z_scale > 1.0 { factor } else { 1.0 / 8.0 };
        assert!(factor > 2.0 && gain >= least, "heights × {z_scale}: {gain} {factor}");
    }
}

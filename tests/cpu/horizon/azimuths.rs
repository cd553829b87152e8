//! Importance-sampled azimuths of an environment, against even ones.

use std::path::Path;

use ridgelight::plan::Azimuth;
use ridgelight::plan::azimuths::{even, towards_light};
use ridgelight::scene::{Border, Environment, HeightField};
use ridgelight_cpu::env_tables::{EnvTables, bottom_sine, env_tables};
use ridgelight_cpu::env_wedges::env_wedges;
use ridgelight_cpu::light::{environment_of, normal};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_io as files;
use ridgelight_io::HeightOptions;

/// Elevations of the tables: enough that the azimuths alone err.
const NODES: usize = 1024;
const BORDER: Border = Border::Plane;

fn asset(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets").join(name)
}

fn tables(environment: &Environment, azimuths: &[Azimuth]) -> EnvTables {
    let rows = env_wedges(environment, BORDER, azimuths);
    env_tables(&rows, (environment.height(), azimuths), NODES, bottom_sine(BORDER))
}

/// Light of texels by exact horizons in some azimuths alone, mean over channels.
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

/// The gain of wedges of equal light over these, where each errs independently by the same share of its light:
/// by the root of the sums of their lights' squares.
fn equal_light_gain(environment: &Environment, azimuths: &[Azimuth]) -> f64 {
    let tables = tables(environment, azimuths);
    // Over level ground.
    let lights: Vec<f64> = (0..azimuths.len()).map(|k| tables.at(k, 2, 0).element_sum()).collect();
    let squares: f64 = lights.iter().map(|l| l * l).sum();
    (squares * lights.len() as f64).sqrt() / lights.iter().sum::<f64>()
}

/// The bundled sky over the bundled terrain, whose heights are scaled until the sky's sun, 48 degrees high, is hidden
/// from some texels. Importance-sampled azimuths must gain as much over as many even ones as wedges of equal light
/// would: a quarter of them is spread evenly, but horizons turn less within narrow wedges. They must also be more
/// exact than four times as many even ones: even wedges that aim at their light, too, are not.
///
/// Unscaled heights hide nothing of the sun: importance-sampled azimuths are then less exact, as the rest is
/// cut a quarter as finely. A wedge four times as wide errs by 4² as much at most, where horizons turn in
/// proportion, and there are a quarter as many: 4² / √4.
#[test]
fn importance_sampled_azimuths_beat_even_ones_where_occlusion_cuts_bright_light() {
    const COUNT: u32 = 16;
    let sky = files::read_environment(&asset("sky_512x256.hdr"), 0.0).expect("the bundled sky");
    for z_scale in [1.0, 3.0, 4.0] {
        let cell_m = [66.0, 92.6];
        let options = HeightOptions { cell_m: Some(cell_m), z_scale, ..HeightOptions::default() };
        let path = asset("mt_washington_256.png");
        let field = files::read_heights(&path, &options).expect("the bundled field");
        let cols = field.cols();
        let places: Vec<usize> = (0..field.rows() * cols).step_by(331).collect();
        let oracle = Oracle::new(&field, BORDER);
        let ground_truth = |p: &usize| environment_of(&oracle, p / cols, p % cols, &sky);
        let ground_truth: Vec<f64> =
            places.iter().map(|p| ground_truth(p).iter().sum::<f64>() / 3.0).collect();
        let rmse = |azimuths: &[Azimuth]| {
            let found = lit(&field, &sky, azimuths, &places);
            let squares = found.iter().zip(&ground_truth).map(|(a, b)| (a - b).powi(2));
            (squares.sum::<f64>() / ground_truth.len() as f64).sqrt()
        };
        let evenly = even(COUNT, cell_m);
        let drawn = rmse(&towards_light(&sky, 0.0, BORDER, COUNT, cell_m));
        let (gain, factor) = (rmse(&evenly) / drawn, equal_light_gain(&sky, &evenly));
        let over_many = rmse(&even(4 * COUNT, cell_m)) / drawn;
        println!("heights × {z_scale}: {gain:.2}, at least {factor:.2}; over many {over_many:.2}");
        if z_scale > 1.0 {
            assert!(factor > 2.0 && gain >= factor, "heights × {z_scale}: {gain} {factor}");
            assert!(over_many > 1.0, "heights × {z_scale}: {over_many}");
        } else {
            assert!(gain >= 1.0 / 8.0, "{gain}");
        }
    }
}

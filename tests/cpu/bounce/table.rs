//! The quadrature of the scenes that the path tracer is compared on.

use ridgelight::scene::Normals;
use ridgelight_cpu::indirect::{Fineness, ground_truth as expected_light};

use crate::reference_page::{MOST_BOUNCES, closed_forms, head, light_names, quadrature};
use crate::scenes::{Agreement, scenes};

/// Figures after a row's head on the published page; none where the row is missing, or a figure is no number,
/// or there are too few.
fn figures<const N: usize>(page: &str, head: &str) -> Option<[f64; N]> {
    let row = page.lines().find_map(|line| line.strip_prefix(head))?;
    let all: Option<Vec<f64>> =
        row.trim_end_matches('|').split('|').map(|cell| cell.trim().parse().ok()).collect();
    all?.try_into().ok()
}

/// A part of docs/measured/reference.md, between its marks.
fn part(name: &str) -> String {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/measured/reference.md");
    let page = std::fs::read_to_string(path).expect("docs/measured/reference.md");
    let [begin, end] = ["begin", "end"].map(|mark| format!("<!-- {mark} {name} -->"));
    let part = page.split_once(&begin).and_then(|(_, rest)| rest.split_once(&end));
    part.unwrap_or_else(|| panic!("docs/measured/reference.md lacks {begin} or {end}")).0.to_owned()
}

/// Prints mean radiance and stated error of every scene, by smooth normals and by flat ones, and requires an RMS of the stated
/// errors below 1 % of the mean. The published tables have the same means, and their z are small enough. The table by smooth
/// normals has every number of bounces; without bounces, flat ones are the same.
#[test]
fn stated_errors_are_small_on_every_scene() {
    println!("{:34} bounces  mean radiance (sky, sun, sphere)    rms of stated error", "scene");
    for (normals, table, fewest) in
        [(Normals::Smooth, part("scenes"), 0), (Normals::Flat, part("flat scenes"), 1)]
    {
        let mut heads = 0;
        for (name, scene) in scenes() {
            let expected_light = quadrature(&scene, normals).unwrap();
            for b in fewest..=MOST_BOUNCES {
                for (channel, light) in light_names(&scene).into_iter().enumerate() {
                    let head = head(name, b, light, &expected_light, channel);
                    let Some([_, _, mean, rms, worst]) = figures(&table, &head) else {
                        panic!("run tools/reference: docs/measured/reference.md lacks {head}");
                    };
                    let count = expected_light.radiance[b].len();
                    let published = Agreement { rms, worst, mean, count };
                    assert!(published.holds(), "{head}: {published:?}");
                    heads += 1;
                }
            }
            for (b, (picture, error)) in
                expected_light.radiance.iter().zip(&expected_light.error).enumerate()
            {
                let n = picture.len() as f64;
                let mean = [0, 1, 2].map(|i| picture.iter().map(|v| v[i]).sum::<f64>() / n);
                let rms =
                    [0, 1, 2].map(|i| (error.iter().map(|v| v[i] * v[i]).sum::<f64>() / n).sqrt());
                println!("{name:34} {b} {normals:?}        {mean:.5?}  {rms:.5?}");
                for i in 0..3 {
                    assert!(rms[i] < 0.01 * mean[i] || rms[i] == 0.0, "{name} {b} {i} {normals:?}");
                }
            }
        }
        // No row of another table or of a scene that is gone.
        let rows = table.lines().filter(|line| line.starts_with("| ")).count();
        assert_eq!(rows, 1 + heads, "{normals:?}: a head line, and a row for each");
    }
}

/// Each closed form stands on the published page, and its z is below 4.
#[test]
fn closed_forms_are_published() {
    let page = part("closed forms");
    for closed in closed_forms() {
        let head = closed.head();
        let texels = closed.scene.field.heights_m().len();
        assert!(!closed.known.is_empty() && closed.known.iter().all(|k| k.0 < texels), "{head}");
        let Some([_, _, _, z]) = figures(&page, &head) else {
            panic!("run tools/reference: docs/measured/reference.md lacks {head}");
        };
        assert!(z <= 4.0, "{head}{z}");
        // A row with another value does not match.
        assert!(figures::<4>(&page.replace(&head, "| "), &head).is_none());
    }
}

/// The comparison passes a picture with its stated noise, and fails one that is 1 % too bright, one shifted by
/// a texel, one with a single wrong texel, and one that understates its noise.
#[test]
fn agreement_separates_noise_from_error() {
    let scene = scenes().remove(7).1;
    let expected_light =
        expected_light(&scene, 1, Fineness { azimuths: 24, divisions: 1, strips: 12 }).unwrap();
    let (right, stated) = (&expected_light.radiance[1], &expected_light.error[1]);
    let sigma = vec![[1e-3; 3]; right.len()];
    // Sums of twelve uniform numbers: standard deviation 1.
    let mut state = 7_u64;
    let mut normal = || {
        (0..12).fold(-6.0, |sum, _| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            sum + (state >> 11) as f64 / (1_u64 << 53) as f64
        })
    };
    let noisy: Vec<[f64; 3]> = right.iter().map(|v| v.map(|v| v + 1e-3 * normal())).collect();
    let of = |picture: &[[f64; 3]], sigma: &[[f64; 3]]| {
        Agreement::of([picture, sigma], [right, stated], f64::INFINITY, 1e-6)
    };
    assert!(of(&noisy, &sigma).holds(), "{:?}", of(&noisy, &sigma));
    let brighter: Vec<[f64; 3]> = noisy.iter().map(|v| v.map(|v| 1.01 * v)).collect();
    assert!(of(&brighter, &sigma).mean > 4.0, "{:?}", of(&brighter, &sigma));
    let mut moved = noisy.clone();
    moved.rotate_right(1);
    assert!(!of(&moved, &sigma).holds());
    let mut one = noisy.clone();
    one[70][1] += 0.02;
    assert!(of(&one, &sigma).worst > 6.0);
    one[70][1] = f64::NAN;
    assert!(!of(&one, &sigma).holds());
    let hidden = vec![[2e-4; 3]; right.len()];
    assert!(!of(&noisy, &hidden).holds());
}

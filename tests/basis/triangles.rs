//! Triangulations of directions: closed, covering the sphere once, and Delaunay.

use std::f64::consts::PI;

use glam::DVec3;
use ridgelight::basis::triangles::Triangles;
use ridgelight::scene::Directions;
use ridgelight_cpu::fan_weights::area_sr;

const COUNTS: [usize; 7] = [4, 5, 6, 7, 64, 257, 1024];

fn sphere(count: usize) -> Directions {
    Directions::fibonacci(count, -1.0, 3).expect("directions")
}

/// Solid angle of each triangle, sr.
fn areas_sr(net: &Triangles, points: &[DVec3]) -> Vec<f64> {
    net.corners().iter().map(|face| area_sr(face.map(|i| points[i as usize]))).collect()
}

/// V - E + F = 2 with three edges a face, each in two: F = 2 V - 4; and each directed edge once, its reverse once.
#[test]
fn nets_are_closed() {
    for count in COUNTS {
        let net = sphere(count).triangles().expect("a net");
        assert_eq!(net.corners().len(), 2 * count - 4, "{count}");
        let mut edges: Vec<[u32; 2]> =
            (net.corners().iter()).flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]).collect();
        edges.sort_unstable();
        assert!(edges.windows(2).all(|two| two[0] != two[1]), "{count}");
        assert!(edges.iter().all(|[a, b]| edges.binary_search(&[*b, *a]).is_ok()), "{count}");
    }
}

/// An area errs by a few roundings of its terms of about 1.
#[test]
fn triangles_cover_the_sphere_once() {
    for count in COUNTS {
        let (directions, net) = (sphere(count), sphere(count).triangles().expect("a net"));
        let areas = areas_sr(&net, directions.vectors());
        assert!(areas.iter().all(|a| *a > 0.0), "{count}");
        let tolerance = 16.0 * f64::EPSILON * areas.len() as f64;
        assert!((areas.iter().sum::<f64>() - 4.0 * PI).abs() <= tolerance, "{count}");
        let fans = net.fans_sr(directions.vectors());
        assert!((fans.iter().sum::<f64>() - 4.0 * PI).abs() <= tolerance, "{count}");
    }
}

/// No direction stands above the plane of a triangle, which cuts its circumcircle from the sphere.
#[test]
fn circumcircles_are_empty() {
    for count in COUNTS {
        let (directions, net) = (sphere(count), sphere(count).triangles().expect("a net"));
        let points = directions.vectors();
        for face in net.corners() {
            let [a, b, c] = face.map(|i| points[i as usize]);
            let normal = (b - a).cross(c - a).normalize();
            let highest = points.iter().map(|p| (*p - a).dot(normal)).fold(f64::MIN, f64::max);
            assert!(highest <= 2e-13, "{count}: {highest:e}");
        }
    }
}

/// Shares reproduce a direction on its triangle's plane and belong to the nearest three where these form a triangle; a
/// corner itself has all of it.
#[test]
fn shares_lead_back_to_the_direction() {
    let (directions, net) = (sphere(257), sphere(257).triangles().expect("a net"));
    let points = directions.vectors();
    for probe in sphere(1024).vectors() {
        let around = net.around(points, *probe).expect("covered");
        let sum: f64 = around.iter().map(|(_, share)| share).sum();
        let place: DVec3 = around.iter().map(|(i, share)| *share * points[*i as usize]).sum();
        assert!((sum - 1.0).abs() < 1e-12 && place.normalize().dot(*probe) > 1.0 - 1e-14);
    }
    for (i, corner) in points.iter().enumerate() {
        let around = net.around(points, *corner).expect("covered");
        let own = around.iter().find(|(k, _)| *k as usize == i).expect("one of the corners");
        assert!(own.1 > 1.0 - 1e-12);
    }
}

/// For a hemisphere: the same from above, nothing below; each direction stands for 2π/N.
#[test]
fn hemispheres_are_covered_from_above() {
    let directions = Directions::fibonacci(128, 0.0, 0).expect("directions");
    assert!((directions.share_sr() - 2.0 * PI / 128.0).abs() < 1e-15);
    let net = directions.triangles().expect("a net");
    let points = directions.vectors();
    assert!(net.around(points, DVec3::new(0.0, 0.6, 0.8)).is_some());
    assert!(net.around(points, -DVec3::Z).is_none());
    // Down to the lowest ring of points, which stand slightly more than 1/256 above the horizon.
    let covered: f64 = areas_sr(&net, points).iter().sum();
    assert!((0.9 * 2.0 * PI..2.0 * PI).contains(&covered), "{covered}");
}

/// For a part of the sphere: the cap that is left out stays open. Along the cap's edge the rim varies by up to two
/// roots of each direction's solid angle, the largest distance of any point from a direction.
#[test]
fn caps_without_directions_are_left_open() {
    for (count, lowest_z) in [(333, -0.4_f64), (1024, -0.4), (1024, -0.1), (4096, -0.8)] {
        let directions = Directions::fibonacci(count, lowest_z, 0).expect("directions");
        let net = directions.triangles().expect("a net");
        let points = directions.vectors();
        let covered: f64 = areas_sr(&net, points).iter().sum();
        let edge = 2.0 * PI * (1.0 - lowest_z * lowest_z).sqrt();
        let bound = edge * 2.0 * directions.share_sr().sqrt();
        let off = (covered - 2.0 * PI * (1.0 - lowest_z)).abs();
        assert!(off <= bound, "{count} {lowest_z}: {covered}, {off} of {bound}");
        assert!(2.0 * PI * (1.0 + lowest_z) > bound, "{count}: a lid would pass");
        assert!(net.around(points, -DVec3::Z).is_none());
        assert!(net.around(points, DVec3::Z).is_some());
    }
}

/// The mean vector over the sphere is 0, and the mean height over a cap is the middle of the cap's heights.
#[test]
fn directions_are_even() {
    for (count, lowest_z) in [(64, -1.0), (1024, -1.0), (100, 0.0), (333, -0.4)] {
        let directions = Directions::fibonacci(count, lowest_z, 7).expect("directions");
        let mean = directions.vectors().iter().sum::<DVec3>() / count as f64;
        assert!((mean.z - 0.5 * (1.0 + lowest_z)).abs() < 1e-12, "{mean}");
        // Azimuths are a one-dimensional point set of discrepancy about 2/N for sums of period 1.
        assert!(mean.truncate().length() < 4.0 / count as f64, "{count}: {mean}");
    }
}

#[test]
fn bad_directions_are_refused() {
    for (count, lowest_z) in [(3, -1.0), (5000, -1.0), (64, -1.1), (64, 0.1), (64, f64::NAN)] {
        let said = Directions::fibonacci(count, lowest_z, 0).unwrap_err().to_string();
        assert!(said.contains("direction"), "{said}");
    }
    assert!(Directions::from_vectors(vec![DVec3::new(0.0, 0.0, 1.1)], 0.0).is_err());
    let alike = Directions::from_vectors(vec![DVec3::X, DVec3::Y, DVec3::Z, DVec3::Z], -1.0);
    assert!(alike.expect("unit vectors").triangles().is_err());
}

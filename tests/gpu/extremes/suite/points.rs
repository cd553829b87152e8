//! Visible points at the extremes, and ellipses of visible sky: on the ground of the bounces' cases.

use glam::DVec3;
use ridgelight::scene::{Border, HeightField, Scene, VisiblePoint};
use ridgelight_cpu::ellipse_fit::{Ellipse, SkyDirection, score, start};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::tolerance::{MET_SHARE, crossing_elevation, ellipse_reach, ellipse_start};
use ridgelight_cpu::visible_points::possible_within;

use super::{About, Asks, Case, Found, Probe, bounces, none};

/// The approximate number of compared texels; the middle is one of them.
const PLACES: usize = 40;

pub fn cases() -> Vec<Case> {
    let of = |about: About, asks: fn() -> Asks, begin: &str, [expected, bound]: [&str; 2]| {
        let grounds = bounces::cases().into_iter().filter(is_ground);
        let case = |case: Case| Case {
            name: renamed(&case.name, begin),
            about,
            expected: expected.to_owned(),
            bound: bound.to_owned(),
            asks: asks(),
            probes: Box::new(if about == About::Points { visible } else { ellipses }),
            unjudged: none,
            ..case
        };
        grounds.map(case).collect::<Vec<_>>()
    };
    let points = [
        "the texel nearest to where the oracle's visible intervals of surface are met, as its number; -1 of the sky, -2 of the ground beyond",
        "none: a neighbour, or what is behind an edge, only where the elevation of a crossing d away may be off, (16 H / d + 44 g) ε of its \
         slope and 12 ε, g the triangle's own, or a place by 32 ε of the way",
    ];
    let fits = [
        "lit directions within less shadowed ones, by the oracle: of the ellipse that is found as many as it says, of the whole disc, of \
         nothing and of what the lit ones' moments say no more; the whole disc where all is lit, none where nothing is",
        "none, but for directions that may be lit or not, or lie on an edge (`ellipse_reach`)",
    ];
    let mut all = of(About::Points, || Asks::Points, "points visible", points);
    all.extend(of(About::Ellipses, || Asks::Ellipses, "ellipses of the sky", fits));
    all
}

/// "bounced by …" as another kind of answer.
pub fn renamed(name: &str, begin: &str) -> String {
    format!("{begin} {}", name.strip_prefix("bounced ").expect("so they begin"))
}

/// Visibility does not depend on lights.
fn is_ground(case: &Case) -> bool {
    !["exit radiance", "albedo 0"].iter().any(|other| case.name.contains(other))
}

fn number(point: VisiblePoint) -> f64 {
    match point {
        VisiblePoint::GridPoint(at) => at as f64,
        VisiblePoint::Sky => -1.0,
        VisiblePoint::Ground => -2.0,
    }
}

/// The possible visible points of texels.
pub struct Sight<'a> {
    oracle: Oracle<'a>,
    /// For a field one texel wide, which is a line that only rays along it hit: the same twice as wide, with the same
    /// visible points.
    doubled: Option<HeightField>,
}

impl<'a> Sight<'a> {
    pub fn of(scene: &'a Scene) -> Self {
        let (field, border) = (&scene.field, scene.surface.border);
        let [rows, cols] = [field.rows(), field.cols()];
        let is_line = border != Border::Periodic && (rows == 1) != (cols == 1);
        let heights = || field.heights_m().iter().map(|h| f64::from(*h));
        let doubled = is_line.then(|| {
            let (size, heights): ([usize; 2], Vec<f64>) = match rows {
                1 => ([2, cols], heights().chain(heights()).collect()),
                _ => ([rows, 2], heights().flat_map(|h| [h; 2]).collect()),
            };
            HeightField::new(size[0], size[1], &heights, field.cell_m(), None)
                .expect("a good field")
        });
        Self { oracle: Oracle::new(field, border), doubled }
    }

    /// All possible visible points of a texel in a direction, within the device's error; the exact one first.
    pub fn possible(&self, at: usize, e: DVec3) -> Vec<VisiblePoint> {
        let field = self.oracle.field();
        let is_along = (field.rows() == 1 && e.y == 0.0) || (field.cols() == 1 && e.x == 0.0);
        let Some(doubled) = self.doubled.as_ref().filter(|_| is_along) else {
            return possible(&self.oracle, [at / field.cols(), at % field.cols()], e);
        };
        let is_row = field.rows() == 1;
        let here = if is_row { [0, at] } else { [at, 0] };
        let mut all: Vec<VisiblePoint> = Vec::new();
        for visible in possible(&Oracle::new(doubled, self.oracle.border()), here, e) {
            let point = match visible {
                VisiblePoint::GridPoint(there) if is_row => {
                    VisiblePoint::GridPoint(there % field.cols())
                }
                VisiblePoint::GridPoint(there) => VisiblePoint::GridPoint(there / 2),
                other => other,
            };
            if !all.contains(&point) {
                all.push(point);
            }
        }
        all
    }
}

fn possible(oracle: &Oracle, here: [usize; 2], e: DVec3) -> Vec<VisiblePoint> {
    let field = oracle.field();
    let own = f64::from(field.heights_m()[here[0] * field.cols() + here[1]]);
    possible_within(
        oracle,
        here,
        e,
        |interval| crossing_elevation(oracle, interval, own),
        MET_SHARE,
    )
}

/// Some of them, and the middle, where spikes and pits stand.
pub fn places(found: &Found, about: usize) -> Vec<usize> {
    let count = found.scene.field.heights_m().len();
    (0..count).step_by((count / about).max(1) | 1).chain([count / 2]).collect()
}

fn visible(found: &Found) -> Vec<Probe> {
    let field = &found.scene.field;
    let (sight, points) = (Sight::of(found.scene), found.points());
    let (mut all, mut known) = (Vec::new(), 0);
    for at in places(found, PLACES) {
        for (i, e) in points.directions().vectors().iter().enumerate() {
            let possible = sight.possible(at, *e);
            let got = points.point(i, at);
            let want = if possible.contains(&got) { got } else { possible[0] };
            known += usize::from(possible.len() == 1);
            all.push(Probe {
                found: number(got),
                expected: [number(want); 2],
                bound: 0.0,
                at: [i, at / field.cols(), at % field.cols()],
            });
        }
    }
    // A result with any possible value tests nothing.
    assert!(2 * known > all.len(), "{}: {known} of {} are known", found.method.name, all.len());
    all
}

fn ellipses(found: &Found) -> Vec<Probe> {
    let field = &found.scene.field;
    let sight = Sight::of(found.scene);
    let [axes, radii] = [0, 1].map(|output| found.texels(output));
    places(found, PLACES)
        .into_iter()
        .flat_map(|at| {
            let texels = [&axes, &radii].map(|of| -> [f32; 4] { of[at] });
            let here = [0, at / field.cols(), at % field.cols()];
            at_texel(found, &sight, at, texels).into_iter().map(move |p| Probe { at: here, ..p })
        })
        .collect()
}

fn at_texel(found: &Found, sight: &Sight, at: usize, [axes, radii]: [[f32; 4]; 2]) -> Vec<Probe> {
    let vectors = found.traced().directions.vectors().iter().filter(|e| e.z > 0.0);
    // Lit, shadowed, or either.
    let mut visible: Vec<(DVec3, Option<bool>)> = Vec::new();
    for e in vectors {
        let possible = sight.possible(at, *e);
        let lit = possible.iter().filter(|p| **p == VisiblePoint::Sky).count();
        visible.push((*e, (lit == 0 || lit == possible.len()).then_some(lit > 0)));
    }
    let ellipse = Ellipse::of_texels(axes, [radii[0], radii[1]]);
    let (got, step) = (f64::from(radii[2]), radii[3]);
    // Each direction counts 1 or -1, or less where it lies on the edge or outside.
    let reach = ellipse_reach(&ellipse);
    let counts = |(e, lit): &(DVec3, Option<bool>)| {
        let (from, to) = (ellipse.reach(*e) - 1.0 <= reach, ellipse.reach(*e) - 1.0 < -reach);
        let least = if lit == &Some(true) { 1.0 } else { -1.0 };
        let most = if lit == &Some(false) { -1.0 } else { 1.0 };
        match (from, to) {
            (false, _) => [0.0, 0.0],
            (true, true) => [least, most],
            (true, false) => [f64::min(least, 0.0), f64::max(most, 0.0)],
        }
    };
    let sum = |all: [f64; 2], one: [f64; 2]| [all[0] + one[0], all[1] + one[1]];
    let said = visible.iter().map(counts).fold([0.0; 2], sum);
    let exact = |found: f64, expected: [f64; 2]| Probe { found, expected, bound: 0.0, at: [0; 3] };
    let count = visible.len() as f64;
    let whole = visible.iter().map(|s| if s.1 == Some(true) { 1.0 } else { -1.0 }).sum::<f64>();
    let mut probes = vec![exact(got, said), exact(got, [whole.max(0.0), count])];
    let known: Vec<SkyDirection> =
        visible.iter().filter_map(|(e, lit)| Some((*e, (*lit)?))).collect();
    let lit = known.iter().filter(|s| s.1).count();
    if known.len() < visible.len() {
        return probes;
    }
    if lit == 0 || lit == known.len() {
        let want = if lit == 0 { Ellipse::EMPTY } else { Ellipse::WHOLE };
        let numbers =
            |e: &Ellipse| [e.centre.x, e.centre.y, e.inverse_radii[0], e.inverse_radii[1]];
        let pairs = numbers(&ellipse).into_iter().zip(numbers(&want));
        probes.extend(pairs.map(|(got, want)| exact(got, [want; 2])));
    } else if step > 0.0 {
        let begun = start(&known);
        let off = ellipse_start(&begun, known.len());
        let on_edge = known.iter().filter(|(e, _)| (begun.reach(*e) - 1.0).abs() <= off).count();
        probes.push(exact(got, [score(&begun, &known) as f64 - on_edge as f64, count]));
    }
    probes
}

//! Horizons at the extremes. The heights give every method the same result: features that a line crosses at any
//! distance of lines, or that extend across the lines, or planes.

use std::f64::consts::FRAC_PI_4;

use ridgelight::scene::{Border, HeightField, Lights};
use ridgelight_cpu::oracle::Oracle;

use super::{About, Asks, Case, Found, Method, Probe, field, largest, never, none, white};

/// Odd, and one more than a multiple of the widest lines' distance: the middle is on a line in the
/// four azimuths along the grid and, in square cells, the four between. A hull of it fits in memory.
const SIDE: usize = 65;
const MIDDLE: usize = 32;

const ALL_ROUND: Asks = Asks::Horizons { of: 8, first: 0, count: 8 };
const ALONG_AXES: Asks = Asks::Horizons { of: 4, first: 0, count: 4 };

pub fn cases() -> Vec<Case> {
    let square = [1.0, 1.0];
    let mut all = vec![
        spike("8848 m ± 1 cm: a spike of 1 cm", 8848.0, 0.01, square),
        pit("8848 m ± 1 cm: a pit of 1 cm", 8848.0, 0.01),
        spike("a single-texel spike of 1e-6 cells", 0.0, 1e-6, square),
        spike("a single-texel spike of 1 cell", 0.0, 1.0, square),
        rounded_away(spike("a single-texel spike of 1e6 cells", 0.0, 1e6, square)),
        pit("a single-texel pit of 1e-6 cells", 0.0, 1e-6),
        rounded_away(pit("a single-texel pit of 1e6 cells", 0.0, 1e6)),
        spike("a spike of 1 in cells of 1 × 1000", 0.0, 1.0, [1.0, 1000.0]),
        spike("a spike of 1 in cells of 1000 × 1", 0.0, 1.0, [1000.0, 1.0]),
        voids(),
        ramp("a slope of 1e-6", 1e-6, square, 16),
        ramp("a slope of 1", 1.0, square, 16),
        ramp("a slope of 1e6", 1e6, square, 16),
        ramp("a slope of 1 in cells of 1 × 1000", 1.0, [1.0, 1000.0], 6),
        ramp("a slope of 1 in cells of 1000 × 1", 1.0, [1000.0, 1.0], 6),
        level(),
        plateau(),
        sawtooth(),
        hemisphere(),
    ];
    all.extend([[1, 1], [1, 97], [97, 1], [2, 3], [3, 2], [67, 97]].map(rough));
    all.extend([false, true].map(long_and_thin));
    all
}

fn horizons(
    name: impl Into<String>,
    (expected, bound): (impl Into<String>, impl Into<String>),
    field: HeightField,
    asks: Asks,
    probes: impl Fn(&Found) -> Vec<Probe> + 'static,
) -> Case {
    Case {
        name: name.into(),
        about: About::Horizons,
        expected: expected.into(),
        bound: bound.into(),
        scene: white(field, Border::Plane, Lights::default()),
        asks,
        probes: Box::new(probes),
        refuses: never,
        unjudged: none,
        is_long: |_| false,
    }
}

/// A pyramid uses many levels, some of them nearly level: there the rounding of 1e6 cells, 232 ε of it, is a slope of
/// 14, and its spline over their angles may have any value.
fn rounded_away(case: Case) -> Case {
    Case { unjudged: super::is_pyramid, ..case }
}

/// Rows and columns per step in azimuth k of 8.
fn towards(k: usize) -> [isize; 2] {
    [[0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0], [1, 1]][k]
}

/// From n cells away along the grid or its diagonals, a spike of height S stands at atan(S / d). The ground between is
/// level, so rounding counts at d alone.
fn sees_spike(found: &Found, height: f64) -> Vec<Probe> {
    let [x, y] = found.scene.field.cell_m();
    let largest = largest(&found.scene.field);
    let mut probes = Vec::new();
    for k in 0..found.azimuths.len() {
        let [row, col] = towards(k * 8 / found.azimuths.len());
        for n in 1..=MIDDLE as isize {
            let at = |step: isize| (MIDDLE as isize - n * step) as usize;
            let away = (n as f64) * (col as f64 * x).hypot(row as f64 * y);
            let slope = height / away;
            probes.extend(found.slope([k, at(row), at(col)], slope, (largest, away)));
        }
    }
    probes
}

fn spike(name: &str, base: f64, height: f64, cell_m: [f64; 2]) -> Case {
    let f = field([SIDE; 2], cell_m, |r, c| {
        base + if (r, c) == (MIDDLE, MIDDLE) { height } else { 0.0 }
    });
    let asks = if cell_m[0] == cell_m[1] { ALL_ROUND } else { ALONG_AXES };
    let expected =
        "visible from n cells away along the grid and, in square cells, its diagonals: atan(S / d)";
    let bound = "the method's, all else being level: at distance d";
    // The base's rounding in f64 is 1e-16 of it, on a centimetre's 1e-2 less than f32's.
    horizons(name, (expected, bound), f, asks, move |found| sees_spike(found, height))
}

/// From the bottom of a pit one texel wide the four neighbours stand at the pit's depth over a cell.
fn pit(name: &str, base: f64, depth: f64) -> Case {
    let f = field([SIDE; 2], [1.0, 1.0], |r, c| {
        base - if (r, c) == (MIDDLE, MIDDLE) { depth } else { 0.0 }
    });
    let expected = "from its bottom along the grid: atan(depth / cell); from its rim: 0";
    horizons(name, (expected, "the method's, at one cell"), f, ALONG_AXES, move |found| {
        let largest = largest(&found.scene.field);
        let bottom = (0..4).filter_map(|k| found.slope([k, MIDDLE, MIDDLE], depth, (largest, 1.0)));
        let rim = (0..4).filter_map(|k| found.slope([k, MIDDLE, MIDDLE - 1], 0.0, (0.0, 1.0)));
        bottom.chain(rim).collect()
    })
}

/// Voids are filled from the ground around them, which is level here: as if there were none. Their contents, NaN and infinities,
/// are never read.
fn voids() -> Case {
    let is_void = |r: usize, c: usize| (28..=36).contains(&r) && (4..20).contains(&c) || r < 5;
    let mut heights = vec![0.0; SIDE * SIDE];
    let mut marks = vec![false; SIDE * SIDE];
    heights[MIDDLE * SIDE + MIDDLE] = 1.0;
    for i in (0..SIDE * SIDE).filter(|i| is_void(i / SIDE, i % SIDE)) {
        heights[i] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY][i % 3];
        marks[i] = true;
    }
    let f = HeightField::new(SIDE, SIDE, &heights, [1.0, 1.0], Some(marks)).expect("a good field");
    let expected = "NaN and infinities marked as no-data, filled from level ground: as a spike of 1 cell without them";
    let bound = "the method's, at distance d";
    horizons("voids of NaN and infinities", (expected, bound), f, ALL_ROUND, |found| {
        sees_spike(found, 1.0)
    })
}

/// A plane that rises along the shorter side of its cells is its own horizon: tan ω = s cos(φ - uphill), 0 where it
/// falls. Any line on it gives that. A line follows its azimuth to half of 1/32768 cell a step; the interval reaches
/// from the requested azimuth to the one followed.
fn ramp(name: &str, slope: f64, cell_m: [f64; 2], of: u32) -> Case {
    let is_east = cell_m[0] <= cell_m[1];
    let f = field([SIDE; 2], cell_m, |r, c| {
        let north = SIDE - 1 - r;
        slope * if is_east { cell_m[0] * c as f64 } else { cell_m[1] * north as f64 }
    });
    let expected = "tan ω = s cos(φ - uphill), at least 0, in every azimuth; between the azimuth requested and the one that 1/32768 of a cell a step can follow";
    let bound = "the method's, at one step, along a contour but for packed 0; own: a quarter of the rise from lane to lane over a step besides, as all that its two lines meet ties";
    let asks = Asks::Horizons { of, first: 0, count: of };
    horizons(name, (expected, bound), f, asks, move |found| {
        let largest = largest(&found.scene.field);
        let uphill = if is_east { 0.0 } else { 2.0 * FRAC_PI_4 };
        let mut probes = Vec::new();
        for (k, azimuth) in found.azimuths.iter().enumerate() {
            let along = |phi: f64| (phi - uphill).cos();
            let asked = along(found.azimuths_rad[k]);
            let followed = along(azimuth.swept_rad(cell_m));
            // cos(π/2) is 6e-17 in f64.
            let is_contour = asked.abs() < 1e-15 && followed.abs() < 1e-15;
            let step = f64::from(azimuth.step_m);
            let slopes = [asked.min(followed), asked.max(followed)]
                .map(|a| if is_contour { 0.0 } else { (slope * a).max(0.0) });
            let counts = if is_contour { found.method.level(largest) } else { largest };
            let rises_by_lane = azimuth.marches_rows() == is_east && !is_contour;
            let rise = if rises_by_lane { slope * cell_m[0].min(cell_m[1]) } else { 0.0 };
            let ties = found.method.ties(rise, step);
            // Away from edges, so that the nearest line at any distance has made a step.
            for (row, col) in [(MIDDLE, MIDDLE), (20, 41), (37, 9), (13, 22), (50, 51)] {
                probes.extend(found.between([k, row, col], slopes, (counts, step), ties));
            }
        }
        probes
    })
}

/// Rises are differences of equal numbers: 0, exactly, at any height.
fn level() -> Case {
    let f = field([SIDE; 2], [1.0, 1.0], |_, _| 1e15);
    let expected = "0 at every texel in every azimuth";
    horizons("level ground at 1e15", (expected, "0"), f, ALL_ROUND, |found| {
        everywhere(found, 0..SIDE)
    })
}

/// Horizon 0 at every texel whose row and column are in a range.
fn everywhere(found: &Found, range: std::ops::Range<usize>) -> Vec<Probe> {
    let counts = found.method.level(largest(&found.scene.field));
    let mut probes = Vec::new();
    for k in 0..found.azimuths.len() {
        for row in range.clone() {
            let cols = range.clone();
            probes.extend(cols.filter_map(|c| found.slope([k, row, c], 0.0, (counts, 1.0))));
        }
    }
    probes
}

/// On a plateau everything ties at slope 0 and nothing is higher; before it its edge stands at atan(H / d). Four cells
/// from its edge the nearest of the widest lines is on it, too.
fn plateau() -> Case {
    let f = field([SIDE; 2], [1.0, 1.0], |r, c| {
        if (16..=48).contains(&r) && (16..=48).contains(&c) { 2.0 } else { 0.0 }
    });
    let expected = "on it, everywhere: 0; before its western edge: atan(2 / d)";
    let bound = "on it 0; before it the method's, at distance d";
    horizons("a plateau", (expected, bound), f, ALL_ROUND, |found| {
        let mut probes = everywhere(found, 20..45);
        let largest = largest(&found.scene.field);
        probes.extend((0..16).filter_map(|c| {
            let away = (16 - c) as f64;
            found.slope([0, MIDDLE, c], 2.0 / away, (largest, away))
        }));
        probes
    })
}

/// Teeth on every second column whose tips lie on one line of slope 1/4: up the slope from a tip, all tips tie; from a
/// bottom, 3 deep, the next tip hides all others. Dyadic: no height is rounded.
fn sawtooth() -> Case {
    let tip = |c: usize| 0.25 * c as f64;
    let f = field([SIDE; 2], [1.0, 1.0], |_, c| if c % 2 == 0 { tip(c) } else { tip(c) - 3.0 });
    let expected = "looking east atan(1/4) from tips, which tie, and atan(3.25) from bottoms; looking west 0 and atan(2.75); along the teeth 0";
    horizons("a sawtooth", (expected, "the method's, at one cell"), f, ALONG_AXES, |found| {
        let largest = largest(&found.scene.field);
        let counts = found.method.level(largest);
        let mut probes = Vec::new();
        for col in 0..SIDE {
            let [east, west] = match (col % 2, col == SIDE - 1) {
                (0, false) => [0.25, 0.0],
                (0, true) => [0.0, 0.0],
                _ => [3.25, 2.75],
            };
            for (k, slope) in [(0, east), (2, west)] {
                probes.extend(found.slope([k, 31, col], slope, (largest, 1.0)));
            }
            probes.extend(
                [1, 3].iter().filter_map(|&k| found.slope([k, 31, col], 0.0, (counts, 1.0))),
            );
        }
        probes
    })
}

/// A quarter of a circle that falls away from the horizon's side: every texel is lower than the tangent before it and
/// stays on the hull, 140 deep, more than any storage but the list's holds. Then a climb uncovers it vertex by vertex
/// and pops them all.
fn hemisphere() -> Case {
    const DOME: usize = 140;
    let height = |c: usize| match c.checked_sub(DOME) {
        None => ((DOME * DOME - c * c) as f64).sqrt(),
        Some(past) => 7.0 * past as f64,
    };
    let f = field([5, 161], [1.0, 1.0], |_, c| height(c));
    let expected = "looking west the largest (h(j) - h(c)) / (c - j) of all j < c, by trying all: on the dome its slope, at the foot of the climb the tangent to the circle";
    let asks = Asks::Horizons { of: 4, first: 2, count: 1 };
    let bound = "the method's, at one cell";
    horizons(
        "a hemisphere whose hull is as deep as the line",
        (expected, bound),
        f,
        asks,
        |found| {
            let heights = found.scene.field.heights_m();
            let largest = largest(&found.scene.field);
            let mut probes = Vec::new();
            for col in 0..161 {
                let rise = |j: usize| f64::from(heights[j]) - f64::from(heights[col]);
                let slopes = (0..col).map(|j| rise(j) / (col - j) as f64);
                let slope = slopes.fold(0.0, f64::max);
                probes.extend(
                    (0..5).filter_map(|row| found.slope([2, row, col], slope, (largest, 1.0))),
                );
            }
            probes
        },
    )
}

/// Rubble at every size, against the f64 oracle, along the grid: there texels are the surface's only crossings, and
/// lines pass through them.
fn rough([rows, cols]: [usize; 2]) -> Case {
    let f = field([rows, cols], [1.5, 1.0], |r, c| ((r * 37 + c * 101) % 11) as f64 * 0.5);
    let expected = "the f64 oracle's, along the grid, at texels that a line runs through";
    let name = format!("{rows} × {cols} of rubble");
    horizons(name, (expected, "the method's, at one step"), f, ALONG_AXES, move |found| {
        let f = &found.scene.field;
        let largest = largest(f);
        let mut probes = Vec::new();
        for k in 0..4 {
            let [row_step, col_step] = towards(2 * k).map(|s| s as f64);
            // Every seventh of many texels: the oracle is slow.
            let picks = (0..rows * cols).step_by(if rows * cols > 1000 { 7 } else { 1 });
            for (row, col) in picks.map(|i| (i / cols, i % cols)) {
                let lane = if k % 2 == 0 { row } else { col };
                if !found.method.has_line_at(lane) {
                    continue;
                }
                let direction = [col_step, row_step];
                let met = Oracle::one_ray(f, Border::Plane).horizon_along(row, col, direction);
                let slope = met.map_or(0.0, |m| m.slope.max(0.0));
                let step = if k % 2 == 0 { 1.5 } else { 1.0 };
                probes.extend(found.slope([k, row, col], slope, (largest, step)));
            }
        }
        probes
    })
}

/// A wall at the far end of a field 8191 long and three wide: level before it, so that rounding counts
/// at its distance.
fn long_and_thin(is_north: bool) -> Case {
    const LONG: usize = 8191;
    let wall = |place: usize| if place == LONG - 1 { 819.0 } else { 0.0 };
    let (k, sides) = if is_north { (1, [LONG, 3]) } else { (0, [3, LONG]) };
    let f = field(sides, [1.0, 1.0], |r, c| wall(if is_north { LONG - 1 - r } else { c }));
    let name = format!("{} × {}, a wall at its end", sides[0], sides[1]);
    let expected = "atan(819 / d) at every distance d up to 8190";
    let asks = Asks::Horizons { of: 4, first: k as u32, count: 1 };
    let case = horizons(name, (expected, "the method's, at distance d"), f, asks, move |found| {
        let mut probes = Vec::new();
        for place in 0..LONG - 1 {
            let away = (LONG - 1 - place) as f64;
            for lane in 0..3 {
                let at = if is_north { [k, LONG - 1 - place, lane] } else { [k, lane, place] };
                probes.extend(found.slope(at, 819.0 / away, (819.0, away)));
            }
        }
        probes
    });
    // A march of every texel to the end: 100 million steps, 20 s on two cores.
    Case { refuses: lines_too_long, is_long: Method::is_brute, ..case }
}

fn lines_too_long(method: &Method) -> Option<&'static str> {
    method.is_exact().then_some(
        "`lines exact`: needs 8191 steps per line (a periodic field is marched three times at least), the limit is 4096 steps",
    )
}

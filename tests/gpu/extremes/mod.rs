//! DESIGN §4: numbers must hold at the extremes. The table is in `suite`; `tools/extremes` writes what it
//! finds to `out/extremes.md`, and docs/accuracy.md counts what is covered.

mod cover;
mod suite;

use std::fmt::Write as _;
use std::io::Write as _;

use ridgelight::scene::{
    BounceEngine, Fuse, Hull, Levels, LightBasis, Lines, Method, Precision, Quality, Receiver,
    Wedges,
};

use cover::{Judged, cover, judged};

use suite::{About, Asks, Case, Outcome, Probe, Row, methods, page};

use crate::Device;

fn is_horizon(case: &Case) -> bool {
    !matches!(case.asks, Asks::Light)
        && !matches!(case.about, About::Points | About::Ellipses | About::Scattering)
}

fn is_light(case: &Case) -> bool {
    matches!(case.asks, Asks::Light) && case.about == About::Horizons
}

fn is_bounce(case: &Case) -> bool {
    matches!(case.about, About::Bounces | About::Specular)
}

fn is_soft_sphere_or_phong(case: &Case) -> bool {
    matches!(case.about, About::SoftSpheres | About::Phong)
}

fn is_of_points(case: &Case) -> bool {
    matches!(case.about, About::Points | About::Ellipses | About::Scattering)
}

#[test]
fn selected_horizons_hold() {
    hold(is_horizon);
}

#[test]
fn selected_lights_hold() {
    hold(is_light);
}

#[test]
fn selected_bounces_hold() {
    hold(is_bounce);
}

#[test]
fn selected_sphere_lights_and_phong_lobes_hold_by_harmonics() {
    hold(is_soft_sphere_or_phong);
}

#[test]
#[ignore = "tools/test --all"]
fn every_horizon_holds_under_every_method() {
    hold_all(is_horizon);
}

#[test]
#[ignore = "tools/test --all"]
fn every_light_holds_under_every_method() {
    hold_all(is_light);
}

#[test]
#[ignore = "tools/test --all"]
fn every_bounce_holds_under_every_engine() {
    hold_all(is_bounce);
}

#[test]
#[ignore = "tools/test --all"]
fn every_sphere_light_and_phong_lobe_holds_by_harmonics() {
    hold_all(is_soft_sphere_or_phong);
}

#[test]
fn every_visible_point_and_its_bakes_hold() {
    hold_all(is_of_points);
}

#[test]
fn a_visible_point_value_beyond_its_bound_fails() {
    hold(is_of_points);
}

#[test]
fn every_case_is_in_one_test() {
    let groups = [is_horizon, is_light, is_bounce, is_soft_sphere_or_phong, is_of_points];
    for case in suite::cases() {
        let count = groups.iter().filter(|is_such| is_such(&case)).count();
        assert_eq!(count, 1, "{}", case.name);
    }
}

/// Every such case under every method.
fn hold_all(is_such: fn(&Case) -> bool) {
    let mut device = Device::new();
    let (mut cases, methods) = (suite::cases(), methods::all());
    cases.retain(is_such);
    let rows = suite::run(device.gpu.as_mut().expect("alive"), &cases, &methods, false);
    let long = suite::put(&cases, &methods).len() - rows.len();
    println!("{} rows; {long} take too long here: tools/extremes draws them", rows.len());
    for row in &rows {
        let (case, method) = (&cases[row.case].name, methods[row.method].name);
        if let Outcome::Measured { worst, largest_error, .. } = &row.outcome {
            let (share, values) = (worst.ratio(), row.outcome.values());
            println!(
                "{case}; {method}: {largest_error:.2e}, {share:.3} of its bound, {values} values"
            );
        }
    }
    let wrong: Vec<String> =
        rows.iter().filter_map(|row| suite::complaint(row, &cases, &methods)).collect();
    assert!(wrong.is_empty(), "{} rows:\n{}", wrong.len(), wrong.join("\n"));
}

/// The rows of [`cover`] among such cases hold, and each can fail.
fn hold(is_such: fn(&Case) -> bool) {
    let mut device = Device::new();
    let (cases, methods) = (suite::cases(), methods::all());
    let of_such = |all: Vec<[usize; 2]>| -> Vec<[usize; 2]> {
        all.into_iter().filter(|[c, _]| is_such(&cases[*c])).collect()
    };
    let rows = of_such(cover(&cases, &methods));
    let left = of_such(suite::put(&cases, &methods)).len() - rows.len();
    println!("{} rows; {left} left to tools/test --all", rows.len());
    // tools/test adds these up.
    if let Some(counts) = std::env::var_os("RIDGELIGHT_ROWS") {
        let file = std::fs::OpenOptions::new().create(true).append(true).open(counts);
        let line = format!("{} {left}\n", rows.len());
        file.and_then(|mut file| file.write_all(line.as_bytes())).expect("RIDGELIGHT_ROWS");
    }
    let mut wrong = Vec::new();
    for [c, m] in rows {
        let probes = suite::probes(device.gpu.as_mut().expect("alive"), &cases[c], &methods[m]);
        let outcome = suite::outcome(probes.clone());
        let said = suite::complaint(&Row { case: c, method: m, outcome }, &cases, &methods);
        let is_right = said.is_none();
        wrong.extend(said);
        if let (Ok(probes), true) = (probes, is_right)
            && judged(&cases[c], &methods[m]) == Judged::Bound
        {
            check_failures(&probes, [c, m], &cases, &methods);
        }
    }
    assert!(wrong.is_empty(), "{} rows:\n{}", wrong.len(), wrong.join("\n"));
}

/// The comparison can fail: for a value moved slightly more than its bound beyond the expected one, for NaN, another
/// refusal and none.
fn check_failures(
    probes: &[Probe],
    [c, m]: [usize; 2],
    cases: &[Case],
    methods: &[methods::Method],
) {
    let (case, name) = (&cases[c], methods[m].name);
    let sees = |method, probes| {
        let row = Row { case: c, method, outcome: suite::outcome(probes) };
        suite::complaint(&row, cases, methods).is_some()
    };
    for picked in [0, probes.len() / 2, probes.len() - 1] {
        let [low, high] = probes[picked].expected;
        let beyond = 1.01 * probes[picked].bound + f64::MIN_POSITIVE;
        // Above the resolution of f64 beside the right answer, where the bound is 0.
        let beyond = beyond.max(high.abs() * f64::EPSILON);
        for spoiled in [low - beyond, high + beyond, f64::NAN, f64::INFINITY] {
            let mut all = probes.to_vec();
            all[picked].found = spoiled;
            assert!(sees(m, Ok(all)), "{}, {name}: passes with {spoiled} at {picked}", case.name);
        }
    }
    assert!(sees(m, Err("no".to_owned())), "{}: a refusal", case.name);
    if let Some(refused) = methods.iter().position(|m| (case.refuses)(m).is_some()) {
        assert!(sees(refused, Ok(probes.to_vec())), "{}: drawn", case.name);
    }
}

/// Few rows are only judged as finite, all of them pyramids', and no bound of another row is as wide as its value: see
/// [`suite::complaint`].
#[test]
fn unjudged_cases_are_listed() {
    let methods = methods::all();
    for case in suite::cases() {
        let unjudged: Vec<_> = methods.iter().filter(|m| (case.unjudged)(m)).collect();
        let is_known = [
            "a single-texel spike of 1e6 cells",
            "a single-texel pit of 1e6 cells",
            "bounced by a spike of 1e6 cells",
            "bounced in a pit of 1e6 cells",
            "bounced and mirrored by a spike of 1e6 cells, lobes of 0 and 1e4 in turn",
            "bounced by a slope of 1e6",
            "bounced under a hemisphere whose hull is as deep as the line",
            "a sphere light over a slope of 1e0, by harmonics",
        ]
        .contains(&case.name.as_str());
        assert_eq!(!unjudged.is_empty(), is_known, "{}", case.name);
        assert!(unjudged.iter().all(|m| m.is_pyramid()), "{}", case.name);
    }
}

/// The kinds of a method, as numbers. A new setting, or a new variant of one of these enums, does not compile until it
/// stands here, and a new variant fails until [`methods::all`] has a method of it.
fn kinds_of(quality: &Quality) -> [(usize, usize); 10] {
    let Quality {
        method,
        lines,
        fuse,
        precision,
        hull,
        levels,
        wedges,
        // Numbers, which are no kinds.
        azimuths: _,
        sun_azimuths: _,
        table_elevations: _,
        level_step: _,
        level_offset: _,
        // A number of nodes, and cutoffs.
        subsample: _,
        light_cutoff: _,
        light_basis,
        wedge_side: _,
        basis: _,
        sh_order: _,
        receiver,
        window: _,
        bounces,
    } = *quality;
    let light_basis = match light_basis {
        LightBasis::Exact => 0,
        LightBasis::Sh => 1,
    };
    let receiver = match receiver {
        Receiver::Plane => 0,
        Receiver::Cosine => 1,
    };
    let engine = match bounces.engine {
        // A method without bounces; the planner's choice stands here by its own name.
        BounceEngine::Auto => usize::MAX,
        _ if bounces.count == 0 => usize::MAX,
        BounceEngine::BruteForce => 0,
        BounceEngine::Sweep => 1,
        BounceEngine::Pyramid => 2,
    };
    let method = match method {
        Method::Auto => 0,
        Method::Sweep => 1,
        Method::BruteForce => 2,
        Method::Pyramid => 3,
    };
    let levels = match levels {
        Levels::Stack => 0,
        Levels::Pyramid => 1,
    };
    let lines = match lines {
        Lines::Exact => 0,
        Lines::QuarterCell => 1,
        Lines::HalfCell => 2,
        Lines::Cell => 3,
        Lines::TwoCells => 4,
        Lines::FourCells => 5,
    };
    let fuse = match fuse {
        Fuse::Nearest => 0,
        Fuse::Slopes => 1,
        Fuse::Own => 2,
        Fuse::AimedNearest => 3,
        Fuse::Aimed => 4,
        Fuse::AimedAround => 5,
    };
    let precision = match precision {
        Precision::F32 => 0,
        Precision::F16 => 1,
        Precision::Packed => 2,
    };
    let hull = match hull {
        Hull::Auto => 0,
        Hull::Private => 1,
        Hull::Shared => 2,
        Hull::OccluderList => 3,
    };
    let wedges = match wedges {
        Wedges::Slices => 0,
        Wedges::Nlp => 1,
        Wedges::Table => 2,
    };
    [
        (method, 4),
        (lines, 6),
        (fuse, 6),
        (precision, 3),
        (hull, 4),
        (levels, 2),
        (wedges, 3),
        (receiver, 2),
        (engine, 3),
        (light_basis, 2),
    ]
}

#[test]
fn every_kind_of_method_is_enrolled() {
    let all: Vec<[(usize, usize); 10]> =
        methods::all().iter().map(|m| kinds_of(&m.quality)).collect();
    for (kind, (_, variants)) in all[0].iter().enumerate() {
        for variant in 0..*variants {
            let is_there = all.iter().any(|m| m[kind].0 == variant);
            assert!(is_there, "no method is variant {variant} of kind {kind}");
        }
    }
}

#[test]
fn inputs_that_are_no_numbers_are_refused_by_place() {
    for (name, offer, sentence) in suite::inputs::ALL {
        assert_eq!(&suite::inputs::said(*offer), sentence, "{name}");
    }
}

/// The page has a figure or a refusal for every case under every method; a page without one of its rows fails.
#[test]
fn the_page_lacks_nothing() {
    let (cases, methods) = (suite::cases(), methods::all());
    let of_row = |[case, method]: [usize; 2]| {
        let refusal = (cases[case].refuses)(&methods[method]).map(str::to_owned);
        let measured = || suite::outcome(Ok(vec![probe()]));
        Row { case, method, outcome: refusal.map_or_else(measured, Outcome::Refused) }
    };
    let rows = suite::put(&cases, &methods).into_iter().map(of_row).collect();
    let column = page::Column { name: "a device".into(), driver: "its driver".into(), rows };
    let published = page::text(&cases, &methods, &[column]);
    let missing = page::missing(&published, &cases, &methods);
    assert!(missing.is_empty(), "{}", missing.join("\n"));
    let lines: Vec<&str> = published.lines().collect();
    // Several in each table, whose own case misses them.
    for i in (0..lines.len()).step_by(5) {
        let is_head = lines[i].starts_with("| method | ") || lines[i].starts_with("| input | ");
        let is_device = lines[i].ends_with('*');
        if is_head || is_device || lines[i].starts_with("|---") || lines[i].is_empty() {
            continue;
        }
        let without = [&lines[..i], &lines[i + 1..]].concat().join("\n");
        let heading = lines[..=i].iter().rev().find_map(|line| line.strip_prefix("## "));
        let own = heading.and_then(|name| cases.iter().position(|case| case.name == name));
        let own = own.map_or(&cases[..0], |c| &cases[c..=c]);
        let missing = page::missing(&without, own, &methods);
        assert!(!missing.is_empty(), "nothing is missed without {}", lines[i]);
    }
}

/// A probe with its expected value.
fn probe() -> suite::Probe {
    suite::Probe { found: 1.0, expected: [1.0; 2], bound: 1e-6, at: [0; 3] }
}

/// The table of docs/accuracy.md: how many scenes, methods and pairs of both each group has.
fn summary(cases: &[Case], methods: &[methods::Method]) -> String {
    let groups = [
        (About::Horizons, "horizons, and direct light shaded from them"),
        (About::Bounces, "indirect light"),
        (About::SoftSpheres, "sphere lights by spherical harmonics"),
        (About::Phong, "direct Phong specular"),
        (About::Specular, "indirect Phong specular"),
        (About::Points, "visible points"),
        (About::Ellipses, "ellipses of visible sky"),
        (About::Scattering, "light scattered over visible points"),
    ];
    let mut out = "| group | scenes | methods | pairs |\n|---|---|---|---|\n".to_owned();
    let mut all = [0, 0, 0];
    for (about, name) in groups {
        let scenes = cases.iter().filter(|c| c.about == about).count();
        let tried = methods.iter().filter(|m| m.about == about).count();
        let row = [scenes, tried, scenes * tried];
        writeln!(out, "| {name} | {} | {} | {} |", row[0], row[1], row[2]).unwrap();
        all = [0, 1, 2].map(|i| all[i] + row[i]);
    }
    writeln!(out, "| all | {} | {} | {} |", all[0], all[1], all[2]).unwrap();
    writeln!(out, "| inputs that are refused by name | {} | | |", suite::inputs::ALL.len())
        .unwrap();
    out
}

/// docs/accuracy.md counts the cases as they are.
#[test]
fn the_summary_counts_what_is_covered() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/accuracy.md");
    let page = std::fs::read_to_string(path).expect("docs/accuracy.md");
    let table = summary(&suite::cases(), &methods::all());
    assert!(page.contains(&table), "docs/accuracy.md should hold this table:\n{table}");
}

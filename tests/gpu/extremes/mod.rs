//! DESIGN §4: numbers must hold at the extremes. The table is in `suite`; what it finds is published as
//! `docs/extremes.md` by `tools/extremes`.

mod suite;

use suite::page::{self, Driver};
use suite::{Outcome, Row, methods};

use crate::Device;

#[test]
fn every_case_holds_under_every_method() {
    let mut device = Device::new();
    let (cases, methods) = (suite::cases(), methods::all());
    let rows = suite::run(device.gpu.as_mut().expect("alive"), &cases, &methods);
    for row in &rows {
        if let Outcome::Measured { worst, values, .. } = &row.outcome {
            let (case, method) = (&cases[row.case].name, methods[row.method].name);
            println!(
                "{case}; {method}: {:.3} of {:.2e}, {values} values",
                worst.ratio(),
                worst.bound
            );
        }
    }
    let wrong: Vec<String> =
        rows.iter().filter_map(|row| suite::complaint(row, &cases, &methods)).collect();
    assert!(wrong.is_empty(), "{} rows:\n{}", wrong.len(), wrong.join("\n"));
    a_page_without_a_row_is_seen(&cases, &methods, rows);
}

/// The page of what was found lacks nothing; without any of its lines it does.
fn a_page_without_a_row_is_seen(
    cases: &[suite::Case],
    methods: &[methods::Method],
    rows: Vec<Row>,
) {
    let drivers = [Driver { name: "this".to_owned(), rows }];
    let whole = page::page(cases, methods, &drivers);
    assert_eq!(page::missing(&whole, cases, methods), Vec::<String>::new());
    let lines: Vec<&str> = whole.lines().collect();
    for (i, line) in lines.iter().enumerate().filter(|(_, l)| l.starts_with("| ")) {
        // What no list has: heads of tables, and the methods' bounds, which are looked at as a whole.
        if line.starts_with("| method | this") || line.starts_with("| input |") {
            continue;
        }
        let without: Vec<&str> =
            lines.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, l)| *l).collect();
        let missing = page::missing(&without.join("\n"), cases, methods);
        assert!(!missing.is_empty(), "nothing is missed without {line}");
    }
}

/// The comparison is not deaf: any value of any case, moved by a bit more than its bound beyond what is
/// expected, is beyond it; so are a value that is no number, another refusal and none.
#[test]
fn a_value_beyond_its_bound_is_seen() {
    let mut device = Device::new();
    let (cases, mut methods) = (suite::cases(), methods::all());
    methods.truncate(3);
    for (c, case) in cases.iter().enumerate() {
        let method = &methods[2];
        let found = suite::probes(device.gpu.as_mut().expect("alive"), case, method);
        let probes = found.expect("drawn");
        let sees = |probes| {
            let row = Row { case: c, method: 2, outcome: suite::outcome(probes) };
            suite::complaint(&row, &cases, &methods).is_some()
        };
        for picked in [0, probes.len() / 2, probes.len() - 1] {
            let [low, high] = probes[picked].expected;
            let beyond = 1.01 * probes[picked].bound + f64::MIN_POSITIVE;
            // Above what f64 resolves beside the right answer, where nothing is tolerated.
            let beyond = beyond.max(high.abs() * f64::EPSILON);
            for spoiled in [low - beyond, high + beyond, f64::NAN, f64::INFINITY] {
                let mut all = probes.clone();
                all[picked].found = spoiled;
                assert!(sees(Ok(all)), "{}: deaf to {spoiled} at {picked}", case.name);
            }
        }
        assert!(sees(Err("no".to_owned())), "{}: a refusal", case.name);
        if (case.refuses)(&methods[1]).is_some() {
            let drawn = suite::outcome(Ok(probes));
            let row = Row { case: c, method: 1, outcome: drawn };
            assert!(suite::complaint(&row, &cases, &methods).is_some(), "{}: drawn", case.name);
        }
    }
}

#[test]
fn every_kind_of_method_is_enrolled() {
    let all: Vec<[(usize, usize); 5]> =
        methods::all().iter().map(|m| methods::kinds_of(&m.quality)).collect();
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

#[test]
fn the_page_lacks_nothing() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/extremes.md");
    let page = std::fs::read_to_string(&path).expect("docs/extremes.md");
    let missing = page::missing(&page, &suite::cases(), &methods::all());
    assert!(
        missing.is_empty(),
        "run tools/extremes: docs/extremes.md lacks\n{}",
        missing.join("\n")
    );
}

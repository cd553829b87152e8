//! Shader statistics of the passes of some scenes from RADV's compiler, without an AMD GPU.
//!
//! Mesa's RADV compiles for a null device (`RADV_FORCE_FAMILY`) and prints instructions and statistics, those of
//! VK_KHR_pipeline_executable_properties. The instructions of each block are multiplied by the iterations of its loops. A rise
//! above 5 % over the committed table fails until the table is written again: `RIDGELIGHT_BLESS=1 tools/test --part shader-stats`.

use std::collections::BTreeMap;
use std::ffi::c_void;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::Command;

#[path = "../common/intercepted.rs"]
mod intercepted;

use ash::vk;
use intercepted::with_function;
use ridgelight::Result;
use ridgelight::gpu::{Headless, HeadlessOptions, Host, Renderer};
use ridgelight::plan::{self, Limits, Picture, Plan};
use ridgelight::scene::{
    Albedo, Basis, BounceEngine, Bounces, Environment, Fuse, HeightField, KeyLight, LightBasis,
    Lights, Lines, Method, Normals, PhongSpecular, Precision, Quality, Scene, Specular,
    SphereLight, Sun, Surface, fractal,
};

/// Set in the process that compiles.
const CHILD: &str = "RIDGELIGHT_SHADER_STATS_CHILD";
/// Begins the passes of a scene, and names each pass in the order of its compilation.
const SCENE: &str = "stats: scene ";
const PASS: &str = "stats: pass ";
/// In place of the name of a pass whose pipeline an earlier scene has.
const AGAIN: &str = "again";
/// The name of horizon_sweep with one line per invocation.
const ONE_LINE: &str = "horizon_sweep one";
/// A rise above this share fails.
const RISE: f64 = 0.05;

/// Iterations of loops without an entry in [`iterations`].
const OTHERS: [f64; 4] = [32.0, 4.0, 4.0, 4.0];

/// Azimuths of a shading batch.
const SHADED: f64 = 32.0;

/// Assumed iterations of a pass's loops, outermost first. Deeper loops and other passes use [`OTHERS`]: weights, not
/// measurements. `deepest`: the depth of the innermost loop.
fn iterations(pass: &str, depth: usize, deepest: usize) -> f64 {
    // A sweep marches 1,024 steps, with about 1.4 iterations of the loop that pops on an elevation model.
    let known: &[f64] = match pass {
        "horizon_sweep" => &[1024.0, 1.4],
        // Four steps each; an iteration of the inner loop pops up to two.
        ONE_LINE => &[256.0, 0.8],
        // In 16 segments, which are marched twice.
        "shadow_sweep" => &[16.0],
        // With raise_beside and its three steps there is a loop for each half of the azimuths.
        "sky_shade" | "sun_shade" | "sh_visibility" if deepest > 1 => &[SHADED / 2.0, 3.0],
        "sky_shade" | "sun_shade" => &[SHADED],
        _ => &[],
    };
    (0..depth).map(|d| known.get(d).or(OTHERS.get(d)).copied().unwrap_or(4.0)).product()
}

/// Passes whose outermost loop goes over steps or azimuths, at four texels an invocation.
const BY_FOUR: [&str; 3] = ["horizon_sweep", "sky_shade", "sun_shade"];

fn scenes() -> Vec<(&'static str, Scene, Quality)> {
    let field = fractal(1024, 1).expect("a field");
    let sun =
        Sun { azimuth_rad: 1.0, elevation_rad: 0.5, diameter_rad: 0.0093, irradiance: [1.0; 3] };
    let key = KeyLight {
        azimuth_rad: 1.0,
        width_rad: 0.5,
        elevations_rad: [0.3, 0.8],
        radiance: [1.0; 3],
    };
    let sphere = SphereLight {
        position_m: [500.0, 500.0, 300.0],
        radius_m: 20.0,
        radiance: [9.0, 8.0, 7.0],
    };
    let environment = Environment::new(64, 32, vec![[1.0, 0.9, 0.8]; 64 * 32], 0.0).expect("a map");
    let sky = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let lit = |lights: Lights| Scene {
        field: field.clone(),
        surface: Surface { albedo: Albedo::Constant([0.5; 3]), ..Surface::default() },
        lights,
    };
    let shiny = |lights: Lights| {
        let mut scene = lit(lights);
        scene.surface.specular =
            Some(Specular::Constant(PhongSpecular { exponent: 20.0, scale: 0.4 }));
        scene
    };
    let map = Lights { environment: Some(environment), ..Lights::default() };
    let suns = Lights { suns: vec![sun], ..Lights::default() };
    let near = Lights { sphere_lights: vec![sphere], ..Lights::default() };
    let base = Quality::default();
    let bounced =
        |engine, count| Quality { bounces: Bounces { count, engine, ..base.bounces }, ..base };
    vec![
        ("sky", lit(sky.clone()), base),
        ("environment", lit(map.clone()), base),
        ("sun", lit(suns.clone()), base),
        ("sun by hulls", lit(suns.clone()), Quality { method: Method::Sweep, ..base }),
        ("key light", lit(Lights { keys: vec![key], ..Lights::default() }), base),
        ("sphere light", lit(near.clone()), base),
        ("sphere light by SH", lit(near), Quality { light_basis: LightBasis::Sh, ..base }),
        ("bounces", lit(sky.clone()), bounced(BounceEngine::Sweep, 2)),
        ("bounces by pyramid", lit(sky.clone()), bounced(BounceEngine::Pyramid, 1)),
        ("bounces by brute force", lit(sky.clone()), bounced(BounceEngine::BruteForce, 1)),
        ("specular", shiny(Lights { suns: vec![sun], ..sky.clone() }), base),
        ("environment by SH", lit(map), Quality { basis: Basis::Sh, ..base }),
        ("aimed-nearest", lit(sky.clone()), Quality { fuse: Fuse::AimedNearest, ..base }),
        ("packed", lit(sky.clone()), Quality { precision: Precision::Packed, ..base }),
        // With up to 256 steps the hull of exact lines is in private memory.
        (
            "exact lines",
            Scene { field: fractal(256, 1).expect("a field"), ..lit(sky.clone()) },
            Quality { lines: Lines::Exact, ..base },
        ),
        ("pyramid", lit(sky.clone()), Quality { method: Method::Pyramid, ..base }),
        ("brute force", lit(sky), Quality { method: Method::BruteForce, ..base }),
    ]
}

/// A picture plan for each scene, and plans for shadow heights, edits and the path tracer.
fn plans(limits: &Limits) -> Vec<(&'static str, Result<Plan>)> {
    let picture = |(name, scene, quality): (&'static str, Scene, Quality)| {
        (name, plan::picture(&scene, &quality, limits, Picture::default()))
    };
    let mut all: Vec<_> = scenes().into_iter().map(picture).collect();
    let scene = |wanted: &str| scenes().into_iter().find(|(name, ..)| *name == wanted);
    let (_, sunny, quality) = scene("sun").expect("listed");
    let outer = HeightField::new(64, 64, &[0.0; 64 * 64], [32.0; 2], None).expect("a field");
    let around = Some((&outer, [10.0, 10.0]));
    let heights = plan::shadow_heights(&sunny.field, &sunny.lights.suns[0], around, 1, limits);
    all.push(("shadow heights", heights));
    let (_, clear, _) = scene("sky").expect("listed");
    let kept = Picture { keeps_horizons: true, ..Picture::default() };
    all.push(("edits under a sky", plan::picture(&clear, &quality, limits, kept)));
    let hulls = Quality { method: Method::Sweep, ..quality };
    all.push(("edits under a sun", plan::picture(&sunny, &hulls, limits, kept)));
    all.push(("reference", plan::reference(&clear, 1, Normals::Smooth, None, 1, limits)));
    all
}

/// What the driver made of one pass.
#[derive(Clone, Debug, PartialEq)]
struct Figures {
    /// Instructions by the depth of the loop that they are in.
    by_depth: Vec<u64>,
    /// Instructions that an invocation executes, as weighted by [`iterations`].
    executed: f64,
    registers: u64,
    /// Spilled SGPRs and VGPRs.
    spilled: u64,
    /// Bytes of scratch per subgroup.
    scratch: u64,
    /// Subgroups that fit a SIMD at once.
    occupancy: u64,
}

/// Replaces the null driver's vkCreateImage, which crashes. The renderer has compiled its pipelines by then.
unsafe extern "system" fn no_image(
    _: vk::Device,
    _: *const vk::ImageCreateInfo<'_>,
    _: *const vk::AllocationCallbacks<'_>,
    _: *mut vk::Image,
) -> vk::Result {
    vk::Result::ERROR_OUT_OF_DEVICE_MEMORY
}

/// Compiles all scenes, each pass announced before; the driver prints what it made.
fn compile() {
    let options = HeadlessOptions { device: None, validation: false };
    let gpu = Headless::new(&options).expect("the null device");
    // The null device has no memory.
    let limits = Limits { memory_budget: 4 << 30, ..gpu.report().limits };
    // SAFETY: it has the type of that function, and only refuses.
    let device = unsafe { with_function(gpu.host(), c"vkCreateImage", no_image as *const c_void) };
    let host = Host { device, ..gpu.host().clone() };
    eprintln!("stats: driver {}", gpu.report().driver);
    let mut known = Vec::new();
    for (name, plan) in plans(&limits) {
        let plan = plan.unwrap_or_else(|error| panic!("{name}: {error}"));
        eprintln!("{SCENE}{name}");
        for key in pipelines(&plan) {
            eprintln!("{PASS}{}", if known.contains(&key) { AGAIN } else { key.0 });
            known.push(key);
        }
        assert!(Renderer::new(&host, plan, 1).is_err(), "{name}: it has no images");
    }
    // Skips teardown, which the null device does not support.
    std::process::exit(0);
}

/// Shaders and constants, in the order in which a renderer compiles them.
fn pipelines(plan: &Plan) -> Vec<(&'static str, Vec<u32>)> {
    let mut all = Vec::new();
    for pass in plan.passes.iter().chain(&plan.edit_passes) {
        let is_one_line = pass.name() == "horizon_sweep" && pass.constant("one_line") == Some(1);
        let name = if is_one_line { ONE_LINE } else { pass.name() };
        let key = (name, pass.constants.clone());
        if !all.contains(&key) {
            all.push(key);
        }
    }
    all
}

/// Instructions by loop depth. A block that branches back to an earlier one ends a loop that begins there.
fn by_depth(assembly: &str) -> Vec<u64> {
    let block = |text: &str| text.strip_prefix("BB")?.parse::<usize>().ok();
    let (mut counts, mut loops, mut current) = (BTreeMap::<usize, u64>::new(), Vec::new(), 0);
    for line in assembly.lines() {
        if let Some(number) = line.strip_suffix(':').and_then(block) {
            current = number;
            continue;
        }
        let mut words = line.split_whitespace();
        let Some(operation) = words.next().filter(|word| !word.starts_with(';')) else { continue };
        *counts.entry(current).or_default() += 1;
        if operation.contains("branch")
            && let Some(to) = words.next().and_then(block).filter(|to| *to <= current)
        {
            loops.push((to, current));
        }
    }
    // Two branches back to one block are one loop.
    let mut ends = BTreeMap::<usize, usize>::new();
    for (begin, end) in loops {
        let last = ends.entry(begin).or_insert(end);
        *last = end.max(*last);
    }
    let mut by_depth = Vec::new();
    for (block, count) in counts {
        let depth = ends.iter().filter(|(begin, end)| (**begin..=**end).contains(&block)).count();
        by_depth.resize(by_depth.len().max(depth + 1), 0);
        by_depth[depth] += count;
    }
    by_depth
}

/// Figures of each pass of each scene, in order, from what the driver printed.
fn read(said: &str) -> Vec<(String, String, Figures)> {
    let mut rows = Vec::new();
    for section in said.split(SCENE).skip(1) {
        let scene = section.lines().next().unwrap_or_default();
        let names: Vec<&str> = section.lines().filter_map(|line| line.strip_prefix(PASS)).collect();
        let compiled: Vec<&str> = section.split("\ndisasm:\n").skip(1).collect();
        assert_eq!(names.len(), compiled.len(), "{scene}: {names:?}");
        for (name, text) in names.into_iter().zip(compiled).filter(|(name, _)| *name != AGAIN) {
            let (assembly, statistics) = text.split_once("\nSGPRs:").expect("statistics");
            let assembly = assembly.split("\n\n").next().unwrap_or_default();
            let figure = |name: &str| {
                let line = statistics.lines().find_map(|line| line.strip_prefix(name));
                line.and_then(|rest| rest.trim_start_matches(':').trim().parse().ok())
                    .unwrap_or_else(|| panic!("{scene}, {name}: no statistic {name}"))
            };
            let by_depth = by_depth(assembly);
            let deepest = by_depth.len() - 1;
            let weighted =
                |(depth, count): (usize, &u64)| *count as f64 * iterations(name, depth, deepest);
            let executed = by_depth.iter().enumerate().map(weighted).sum();
            rows.push((
                scene.to_owned(),
                name.to_owned(),
                Figures {
                    by_depth,
                    executed,
                    registers: figure("VGPRs"),
                    spilled: figure("Spilled SGPRs") + figure("Spilled VGPRs"),
                    scratch: figure("Scratch size"),
                    occupancy: figure("Subgroups per SIMD"),
                },
            ));
        }
    }
    rows
}

/// Instructions of the loop over steps or azimuths for each of its four texels; none for other passes.
fn per_texel(name: &str, figures: &Figures) -> Option<f64> {
    let deepest = figures.by_depth.len() - 1;
    let inner = figures.by_depth.iter().enumerate().skip(1);
    let executed: f64 =
        inner.map(|(depth, count)| *count as f64 * iterations(name, depth, deepest)).sum();
    let outermost = if name == "horizon_sweep" { iterations(name, 1, deepest) } else { SHADED };
    BY_FOUR.contains(&name).then(|| executed / outermost / 4.0)
}

type Row = (String, String, Figures);

fn table(driver: &str, rows: &[Row]) -> String {
    let mut out = format!(
        "{driver}, RADV_FORCE_FAMILY=navi21. Written by RIDGELIGHT_BLESS=1 tools/test --part shader-stats\n\
         executed: instructions per invocation, weighted by assumed iterations; per texel: of one step or azimuth\n\
         {:<22} | {:<18} | {:>9} | {:>9} | {:>5} | {:>7} | {:>7} | {:>9} | instructions by loop depth\n",
        "scene", "pass", "executed", "per texel", "VGPRs", "spilled", "scratch", "occupancy"
    );
    for (scene, name, f) in rows {
        let each = per_texel(name, f).map_or_else(|| "-".to_owned(), |each| format!("{each:.1}"));
        let depths: Vec<String> = f.by_depth.iter().map(u64::to_string).collect();
        writeln!(
            out,
            "{scene:<22} | {name:<18} | {:>9.0} | {each:>9} | {:>5} | {:>7} | {:>7} | {:>9} | {}",
            f.executed,
            f.registers,
            f.spilled,
            f.scratch,
            f.occupancy,
            depths.join(" ")
        )
        .expect("text");
    }
    out
}

fn parsed(table: &str) -> Vec<Row> {
    let row = |line: &str| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let whole = |at: usize| cells[at].parse().expect("a whole number");
        let figures = Figures {
            by_depth: cells[8].split(' ').map(|n| n.parse().expect("a whole number")).collect(),
            executed: cells[2].parse().expect("a number"),
            registers: whole(4),
            spilled: whole(5),
            scratch: whole(6),
            occupancy: whole(7),
        };
        (cells[0].to_owned(), cells[1].to_owned(), figures)
    };
    table.lines().skip(3).map(row).collect()
}

/// What rose above the table, and rows that only one has. Registers count where fewer subgroups fit.
fn rises(kept: &[Row], now: &[Row]) -> Vec<String> {
    let names =
        |rows: &[Row]| rows.iter().map(|row| format!("{}, {}", row.0, row.1)).collect::<Vec<_>>();
    if names(kept) != names(now) {
        return vec![format!("other passes: {:?} and now {:?}", names(kept), names(now))];
    }
    let mut found = Vec::new();
    for ((scene, name, then), (.., now)) in kept.iter().zip(now) {
        let all = [
            ("executed", then.executed, now.executed),
            ("spilled", then.spilled as f64, now.spilled as f64),
            ("scratch", then.scratch as f64, now.scratch as f64),
            ("occupancy", -(then.occupancy as f64), -(now.occupancy as f64)),
        ];
        for (what, then, now) in all {
            // The table rounds what is executed.
            let rounded = if what == "executed" { 0.5 } else { 0.0 };
            if now > then + RISE * then.abs() + rounded {
                found.push(format!("{scene}, {name}: {what} {} and now {}", then.abs(), now.abs()));
            }
        }
    }
    found
}

/// Needs RADV and a table of its version: tools/test runs it where both are there.
#[test]
#[ignore = "needs RADV: tools/test --part shader-stats"]
fn statistics_stay_within_the_table() {
    if std::env::var_os(CHILD).is_some() {
        compile();
    }
    let mut child = Command::new(std::env::current_exe().expect("this test"));
    child.args(["--exact", "statistics_stay_within_the_table", "--ignored", "--nocapture"]);
    child.env(CHILD, "1").env("RADV_FORCE_FAMILY", "navi21");
    child.env("RADV_DEBUG", "shaders,shaderstats,nocache");
    let run = child.output().expect("this test again");
    let said = String::from_utf8_lossy(&run.stderr);
    let driver = said.lines().find_map(|line| line.strip_prefix("stats: driver "));
    let driver =
        driver.unwrap_or_else(|| panic!("no RADV: VK_DRIVER_FILES names its manifest\n{said}"));
    assert!(run.status.success(), "{driver}: {}", run.status);
    let rows = read(&said);
    let version = driver.split_once("Mesa ").expect("RADV").1.split(' ').next().unwrap_or_default();
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join(format!("tests/shader_stats/radv-{version}.txt"));
    let text = table(driver, &rows);
    println!("{text}");
    if std::env::var_os("RIDGELIGHT_BLESS").is_some_and(|v| v == "1") {
        std::fs::write(&path, text).expect("written");
        return;
    }
    let kept = std::fs::read_to_string(&path);
    let kept = kept.unwrap_or_else(|error| {
        panic!(
            "{}: {error}: write it with RIDGELIGHT_BLESS=1 tools/test --part shader-stats",
            path.display()
        )
    });
    let found = rises(&parsed(&kept), &rows);
    assert!(found.is_empty(), "{}", found.join("\n"));
}

const LOOPS: &str = "BB0:
\ts_mov_b32 s0, s3   ; be800303
BB1:
\tv_add_f32 v0, v1, v2
\ts_cbranch_scc0 BB4
BB2:
\tv_mul_f32 v0, v1, v2
\tv_mul_f32 v0, v1, v2
\ts_cbranch_vccnz BB2
BB3:
\ts_branch BB1
BB4:
\ts_endpgm";

/// Before and after, 2; of the outer loop, 3; of the inner one, 3.
#[test]
fn loops_are_found_by_branches_back() {
    assert_eq!(by_depth(LOOPS), [2, 3, 3]);
}

#[test]
fn tables_are_read_as_written_and_rises_are_found() {
    let statistics = "SGPRs: 128\nVGPRs: 56\nSpilled SGPRs: 1\nSpilled VGPRs: 2\nScratch size: 16\nSubgroups per SIMD: 8\n";
    let said =
        format!("{SCENE}one\n{PASS}sky_shade\nNIR\ndisasm:\n{LOOPS}\n\n\nstats\n{statistics}");
    let rows = read(&said);
    let figures = &rows[0].2;
    assert_eq!(
        (figures.registers, figures.spilled, figures.scratch, figures.occupancy),
        (56, 3, 16, 8)
    );
    // 2 + 3 · 16 + 3 · 16 · 3, of 32 azimuths.
    assert_eq!(figures.executed, 194.0);
    assert_eq!(per_texel("sky_shade", figures), Some((3.0 + 3.0 * 3.0) / 2.0 / 4.0));
    assert_eq!(parsed(&table("d", &rows)), rows);
    assert_eq!(rises(&rows, &rows), Vec::<String>::new());
    let change = |change: fn(&mut Figures)| {
        let mut changed = rows.clone();
        change(&mut changed[0].2);
        rises(&rows, &changed).len()
    };
    assert_eq!(change(|f| f.executed *= 1.06), 1);
    assert_eq!(change(|f| f.executed *= 1.04), 0);
    assert_eq!(change(|f| f.executed *= 0.5), 0);
    assert_eq!(change(|f| f.spilled += 1), 1);
    assert_eq!(change(|f| f.scratch *= 2), 1);
    assert_eq!(change(|f| f.occupancy -= 1), 1);
    assert_eq!(rises(&rows, &[]).len(), 1);
}

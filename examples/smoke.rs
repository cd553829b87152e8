use ridgelight::gpu::*;
use ridgelight::plan::*;
use ridgelight::scene::*;
use ridgelight::*;
fn main() -> Result<()> {
    let size: usize = std::env::args().nth(1).map_or(128, |s| s.parse().unwrap());
    let mut gpu =
        Headless::new(&HeadlessOptions { device: None, validation: std::env::var("VAL").is_ok() })?;
    println!("{:?}", gpu.report());
    let field = measure::fractal::fractal(size, 7)?;
    let scene = Scene {
        field: field.clone(),
        surface: Surface::default(),
        lights: Lights { sky: Some([1.0; 3]), ..Default::default() },
    };
    let limits = gpu.report().limits;
    for (lines, fuse, hull) in [
        (Lines::Cell, Fuse::AimedNearest, Hull::Auto),
        (Lines::Cell, Fuse::Aimed, Hull::Auto),
        (Lines::Cell, Fuse::AimedNearest, Hull::Shared),
        (Lines::Cell, Fuse::AimedNearest, Hull::List),
        (Lines::TwoCells, Fuse::AimedNearest, Hull::Auto),
        (Lines::HalfCell, Fuse::Aimed, Hull::Auto),
        (Lines::Cell, Fuse::Slopes, Hull::Auto),
        (Lines::Cell, Fuse::Own, Hull::Auto),
        (Lines::Cell, Fuse::Nearest, Hull::Auto),
        (Lines::Exact, Fuse::Aimed, Hull::Auto),
    ] {
        let q = Quality { lines, fuse, hull, azimuths: 32, ..Default::default() };
        let plan = picture(&scene, &q, &limits, Picture::default())?;
        if lines == Lines::Cell && fuse == Fuse::AimedNearest && hull == Hull::Auto {
            println!("{plan}");
        }
        let mut frame = gpu.frame(plan, &[field.heights_m()])?;
        let t0 = std::time::Instant::now();
        gpu.draw(&mut frame)?;
        let t1 = t0.elapsed();
        let times = gpu.draw(&mut frame)?;
        let p = gpu.pixels(&frame, 0)?;
        let mean = p.values.iter().map(|v| f64::from(*v)).sum::<f64>() / p.values.len() as f64;
        let mut worst = 0.0f64;
        let mut se = 0.0;
        let mut n = 0.0;
        if size <= 256 {
            for i in (0..size * size).step_by(size * size / 200) {
                let o = cpu::light::sky(&field, Border::Plane, i / size, i % size, 64);
                let e = f64::from(p.values[i]) - o;
                worst = worst.max(e.abs());
                se += e * e;
                n += 1.0;
            }
        }
        println!(
            "{lines:?} {fuse:?} {hull:?}: mean {mean:.5} rmse {:.6} worst {worst:.5}; first {t1:?}",
            (se / n as f64).sqrt()
        );
        for t in times {
            if t.ns > 1e5 {
                println!("    {:40} {:.3} ms", t.label, t.ns / 1e6);
            }
        }
        gpu.end(frame);
    }
    for m in gpu.take_messages().iter().take(5) {
        println!("VALIDATION {m}");
    }
    Ok(())
}

//! What the device reaches at most, for shares of it; and passes with empty caches.

use ridgelight::Result;
use ridgelight::gpu::{Frame, Headless};

use super::repeated;
use super::rows::{Row, sums};

/// The pass "fill" is the first.
const COPY: usize = 1;

/// Times of the passes of [`plan::device_peak`](ridgelight::plan::device_peak()) but its first.
pub fn measure(gpu: &Headless, frame: &mut Frame, most: usize) -> Result<Vec<Row>> {
    let plan = frame.plan().clone();
    fill(gpu, frame)?;
    let row = |i: usize| {
        let runs = repeated(gpu, frame, &[i], most, None)?;
        let pass = &plan.passes[i];
        let times = sums(&runs, |_| true);
        Ok(Row::of(pass.label(), "isolated", &plan, &[pass], 1, (runs.len(), &times)))
    };
    (COPY..plan.passes.len()).map(row).collect()
}

/// Fills its memory, before the first of the others.
pub fn fill(gpu: &Headless, frame: &mut Frame) -> Result<()> {
    gpu.draw(frame).map(|_| ())
}

/// Moves more memory than most caches hold.
pub fn flush(gpu: &Headless, frame: &mut Frame) -> Result<()> {
    gpu.draw_passes(frame, &[COPY]).map(|_| ())
}

/// Bytes per second of the copy; none without timestamps.
pub fn copy_rate(peaks: &[Row]) -> Option<f64> {
    peaks.iter().find(|row| row.pass == "device_peak copy")?.byte_rate()
}

/// One line.
pub fn text(peaks: &[Row]) -> String {
    let rate = |part: &str, unit: &str, of: fn(&Row) -> Option<f64>| {
        let row = peaks.iter().find(|row| row.pass_and_part().1 == part);
        let giga = row.and_then(of).map(|r| r * 1e-9);
        format!("{part} {}", giga.map_or("unavailable".into(), |g| format!("{g:.1} {unit}")))
    };
    [
        rate("copy", "GB/s", Row::byte_rate),
        rate("fetch", "G texels/s", Row::texel_rate),
        rate("shared", "G reads/s of 8 bytes", Row::texel_rate),
        rate("fma", "GFLOP/s", Row::texel_rate),
    ]
    .join(", ")
}

//! What the device reaches at most, for shares of it; and passes with empty caches.

use ridgelight::Result;
use ridgelight::gpu::{Frame, Headless};
use serde_json::Value;

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

/// Seconds of the peak-rate copy; a flush is the same copy. 0 without timestamps.
pub fn copy_s(peaks: &[Row]) -> f64 {
    let copy = peaks.iter().find(|row| row.pass == "device_peak copy");
    copy.and_then(|row| row.times).map_or(0.0, |times| times.median * 1e-9)
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

/// Rows for JSON. In two of them the plan's texels are reads or operations, and the key of the rate names these.
pub fn json(peaks: &[Row]) -> Vec<Value> {
    let one = |row: &Row| {
        let mut json = row.json();
        let key = match row.pass_and_part().1 {
            "shared" => "reads_per_s",
            "fma" => "flop_per_s",
            _ => return json,
        };
        json[key] = json["texels_per_s"].take();
        json.as_object_mut().expect("a row").remove("texels_per_s");
        json
    };
    peaks.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::plan::{self, Limits, Pass};

    /// Copy, fetch, shared, fma: each has its own rate, and no rate of another unit.
    #[test]
    fn each_peak_has_the_key_of_its_rate() {
        let plan = plan::device_peak(&Limits::lavapipe()).unwrap();
        let row =
            |pass: &Pass| Row::of(pass.label(), "isolated", &plan, &[pass], 1, (6, &[1e6; 6]));
        let rows: Vec<Row> = plan.passes[COPY..].iter().map(row).collect();
        let keys = ["texels_per_s", "reads_per_s", "flop_per_s"];
        let found = json(&rows);
        for (row, own) in found.iter().zip([None, Some(keys[0]), Some(keys[1]), Some(keys[2])]) {
            for key in keys {
                assert_eq!(row[key].as_f64() > Some(0.0), own == Some(key), "{key} of {row}");
            }
        }
        assert_eq!(found.len(), 4);
    }

    /// A flush reads all of one buffer and writes all of another: 64 MiB each on a processor, 256 MiB on a GPU, as
    /// docs/choosing-settings.md states. A smaller memory budget makes them smaller, but the copy still covers them.
    #[test]
    fn a_flush_covers_more_than_caches_hold() {
        let of = |limits: &Limits| {
            let plan = plan::device_peak(limits).unwrap();
            let copy = &plan.passes[COPY];
            assert_eq!(copy.label(), "device_peak copy");
            let words: Vec<u64> = copy.push[..8]
                .chunks(4)
                .map(|word| u32::from_le_bytes(word.try_into().unwrap()).into())
                .collect();
            let (invocations, rounds) = (words[0], words[1]);
            assert_eq!(u64::from(copy.groups[0]) * 64, invocations);
            let buffers = ["source", "result"].map(|name| plan.find(name).expect(name));
            for (buffer, bound) in buffers.iter().zip(copy.bindings.iter().flatten()) {
                assert_eq!(buffer, bound);
                // A vec4 in each round.
                assert_eq!(plan.resources[buffer.0].bytes(), 16 * invocations * rounds);
            }
            assert_eq!(copy.bytes, 2 * 16 * invocations * rounds);
            16 * invocations * rounds
        };
        assert_eq!(of(&Limits::lavapipe()), 64 << 20);
        assert_eq!(of(&Limits::boundless(true, 1 << 40)), 64 << 20);
        assert_eq!(of(&Limits::boundless(false, 1 << 40)), 256 << 20);
        let small = Limits { memory_budget: 64 << 20, ..Limits::lavapipe() };
        assert_eq!(of(&small), 4 << 20);
    }
}

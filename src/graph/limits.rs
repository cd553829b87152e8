use crate::{Error, Result};

/// Most loop iterations that a pass plans per invocation. llvmpipe ends the loops of an invocation after 65,535 in total.
pub(crate) const MOST_TURNS: u32 = 60_000;

/// Limits of a device, and the memory budget of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Largest side of a 2D image.
    pub image_side: u32,
    /// Largest number of image layers.
    pub image_layers: u32,
    /// Largest range of a storage buffer, bytes.
    pub buffer_bytes: u64,
    /// Largest single allocation, bytes.
    pub allocation_bytes: u64,
    /// Largest number of workgroups of a dispatch along any axis.
    pub groups: u32,
    /// Largest texel buffer, texels.
    pub texels: u32,
    /// Shared memory of a workgroup, bytes.
    pub shared_bytes: u32,
    /// Largest number of invocations of a workgroup.
    pub group_invocations: u32,
    /// Whether the device is a CPU: narrow workgroups, hulls in private memory.
    pub is_cpu: bool,
    /// Lookups that a dispatch of brute force, pyramids, sphere lights or paths should not exceed; eight rows of one azimuth, or
    /// of all paths, may. A long dispatch blocks a GPU for others, and its driver may end it.
    pub lookups: u64,
    /// Memory budget of all images and buffers of a plan, bytes.
    pub memory_budget: u64,
    /// How a sweep with `hull auto` uses the device.
    pub sweep: SweepForm,
    /// The form of the untuned device, for every hull but `auto`.
    pub untuned_sweep: SweepForm,
}

/// What changes the time of a sweep on a device, and never a bit of its result. `ridgelight tune` finds the fastest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SweepForm {
    /// Lines that an invocation sweeps: 1 or 4. Stored slopes and packed hulls always take 4.
    pub lines_each: u32,
    /// Invocations of a workgroup, up to 128, whose lines are a multiple of 32.
    pub group_size: u32,
    /// Whether hulls are in shared memory, else in private memory.
    pub shares_hull: bool,
    /// Entries of the hull of a line there, a power of two up to 1024; fewer where shared memory ends. Lines whose hull is deeper are
    /// swept again.
    pub hull_depth: u32,
    /// Older entries in private memory, likewise, with one line per invocation and hulls in shared memory; else not used.
    pub private_depth: u32,
    /// Azimuths that are swept together at most.
    pub azimuths: u32,
}

impl SweepForm {
    pub(crate) fn check(&self, name: &str) -> Result<()> {
        let Self { lines_each, group_size, shares_hull: _, hull_depth, private_depth, azimuths } =
            self;
        let is_depth = |depth: u32| depth.is_power_of_two() && depth <= 1024;
        let is_private_depth = *lines_each == 4 || is_depth(*private_depth);
        let has_whole_tiles =
            || (1..=128).contains(group_size) && lines_each * group_size % 32 == 0;
        if matches!(lines_each, 1 | 4)
            && has_whole_tiles()
            && is_depth(*hull_depth)
            && is_private_depth
            && *azimuths > 0
        {
            return Ok(());
        }
        let expected = "lines_each 1 or 4; group_size at most 128, with lines_each × group_size a multiple of 32; \
                        depths powers of two up to 1024; azimuths at least 1";
        Err(Error::setting(name, format!("{self:?}"), expected))
    }

    /// The form for a device that has not been tuned. `is_swiftshader`: whether the driver is SwiftShader.
    pub(crate) fn of_device(is_cpu: bool, is_swiftshader: bool) -> Self {
        match is_cpu {
            // Frame time with one line per invocation over that with four: 0.51 (0.47 to 0.53) on SwiftShader, 2.2 on lavapipe:
            // benches/results/tune.txt.
            true if is_swiftshader => Self {
                lines_each: 1,
                group_size: 32,
                shares_hull: false,
                hull_depth: 64,
                private_depth: 64,
                azimuths: u32::MAX,
            },
            // Measured terrain needs about 30 entries, smooth hills a thousand. Measured on lavapipe: 128 compile in 0.1 s,
            // 1024 in up to 3 s, 4096 in over 5 s, and run no faster.
            true => Self {
                lines_each: 4,
                group_size: 8,
                shares_hull: false,
                hull_depth: 128,
                private_depth: 0,
                azimuths: u32::MAX,
            },
            // 2 KiB of shared memory for 32 lines, one tile of the lattice. More entries leave room for fewer workgroups:
            // benches/results/nvidia_h200.md. A GPU reserves private memory for every invocation that can be resident: 64
            // entries take 138 MB on an NVIDIA H200, with 132 x 2,048 of them.
            false => Self {
                lines_each: 1,
                group_size: 32,
                shares_hull: true,
                hull_depth: 8,
                private_depth: 64,
                azimuths: u32::MAX,
            },
        }
    }
}

/// [`Limits::lookups`] of a GPU: 0.1 s where 10^10 take a second, as on a slow one.
pub(crate) const GPU_LOOKUPS: u64 = 1_000_000_000;

impl Limits {
    /// Lavapipe in Debian 12 (Mesa 22.3.6) with a budget of 2 GiB: for plans without a device.
    pub fn lavapipe() -> Self {
        Self {
            image_side: 16384,
            image_layers: 2048,
            buffer_bytes: 128 << 20,
            allocation_bytes: 2 << 30,
            groups: 65_535,
            texels: 1 << 27,
            shared_bytes: 32 << 10,
            group_invocations: 1024,
            is_cpu: true,
            lookups: u64::MAX,
            memory_budget: 2 << 30,
            sweep: SweepForm::of_device(true, false),
            untuned_sweep: SweepForm::of_device(true, false),
        }
    }

    /// Beyond any real device. A scene that fails here with both kinds of device, within the budget, fails on every device.
    pub fn boundless(is_cpu: bool, memory_budget: u64) -> Self {
        Self {
            image_side: 1 << 20,
            image_layers: 1 << 14,
            buffer_bytes: 1 << 50,
            allocation_bytes: 1 << 50,
            groups: 1 << 30,
            texels: 1 << 30,
            shared_bytes: 32 << 10,
            group_invocations: 1024,
            is_cpu,
            lookups: u64::MAX,
            memory_budget,
            sweep: SweepForm::of_device(is_cpu, false),
            untuned_sweep: SweepForm::of_device(is_cpu, false),
        }
    }

    /// Columns and rows of a field that fits the device's images.
    ///
    /// # Errors
    /// A field larger than an image, or whose heights alone exceed the budget.
    pub fn check_size(&self, rows: usize, cols: usize) -> Result<[u32; 2]> {
        let longest = cols.max(rows);
        let beyond = |needs: String, limit: String| {
            Err(Error::Limit { what: format!("a field of {cols} × {rows}"), needs, limit })
        };
        if longest > self.image_side as usize {
            let limit = format!("{} on this device", self.image_side);
            return beyond(format!("images {longest} texels long"), limit);
        }
        let bytes = (4 * rows as u64).saturating_mul(cols as u64);
        if bytes > self.memory_budget {
            let limit = format!("{} of `memory_budget`", bytes_text(self.memory_budget));
            return beyond(format!("{} for its heights", bytes_text(bytes)), limit);
        }
        Ok([cols as u32, rows as u32])
    }
}

/// Bytes with a readable unit.
pub(crate) fn bytes_text(bytes: u64) -> String {
    match bytes {
        0..10_240 => format!("{bytes} bytes"),
        10_240..10_485_760 => format!("{:.1} KiB", bytes as f64 / 1024.0),
        10_485_760..10_737_418_240 => format!("{:.1} MiB", bytes as f64 / 1_048_576.0),
        _ => format!("{:.2} GiB", bytes as f64 / 1_073_741_824.0),
    }
}

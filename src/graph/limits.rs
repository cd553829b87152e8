use crate::{Error, Result};

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
    /// Whether the device is a CPU: narrow workgroups, hulls in private memory.
    pub is_cpu: bool,
    /// Largest number of lookups of a dispatch of brute force or a pyramid. A long dispatch blocks a GPU for others, and its
    /// driver may end it.
    pub lookups: u64,
    /// Memory budget of all images and buffers of a plan, bytes.
    pub memory_budget: u64,
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
            is_cpu: true,
            lookups: u64::MAX,
            memory_budget: 2 << 30,
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
            is_cpu,
            lookups: u64::MAX,
            memory_budget,
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

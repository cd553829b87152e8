//! Horizons: azimuths, line sweeps, exact sweeps, brute force and height pyramids.
//! `sweep` chooses the form, `sweeping` and `batch` cut it into dispatches; the other files are one per pass.

pub mod azimuths;
pub mod batch;
/// `--method pyramid`: for a stack, all levels of heights at every grid point.
pub(crate) mod height_expand;
/// `--method pyramid`: each level of heights from the next finer one.
pub(crate) mod height_reduce;
/// Heights for sweeps, four lanes per texel.
pub(crate) mod height_transpose;
/// `--method brute-force`: the baseline and the ground truth on the device.
pub(crate) mod horizon_march;
/// Hull sweep along lines; the hull is in private memory, in shared memory or in the occluders written so far; never
/// loses an entry.
pub(crate) mod horizon_sweep;
pub mod nodes;
pub mod pyramid;
/// One value per level along every azimuth; the largest value of a B-spline over their angles.
pub(crate) mod pyramid_march;
/// `--lines exact`: every grid point on a line, every crossing on its hull.
pub(crate) mod surface_sweep;
pub mod sweep;
/// Horizons at the grid points, where they are a result themselves.
pub(crate) mod sweep_fuse;
pub mod sweeping;

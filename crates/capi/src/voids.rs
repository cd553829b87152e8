use crate::errors::{Failure, RidgelightResult, done};

/// Fills heights without data before they go to the device: those that are NaN, and those whose byte in `voids`
/// is not 0, where `voids` is not null. They are filled smoothly from the heights around them, as on the
/// command line; the others keep their bits. Every byte of `voids` becomes 1 or 0: whether it is a
/// void. Filled texels are lit too; the caller masks that light. For camera pictures the mask goes to the
/// device, see RidgelightScene's has_voids.
///
/// Returns OK; ARGUMENT; SETTING for an infinite height, which is named, and for a field of voids only: then
/// nothing is changed.
///
/// # Safety
/// `heights` is null or points to rows times cols numbers, `voids` to as many bytes, row after row from the
/// north-west; nobody else uses them meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_fill_voids(
    rows: u32,
    cols: u32,
    heights: *mut f32,
    voids: *mut u8,
) -> RidgelightResult {
    done(|| {
        if heights.is_null() {
            return Err(Failure::argument("heights", "a null pointer", "numbers"));
        }
        if !(1..=1 << 30).contains(&(u64::from(rows) * u64::from(cols))) {
            let found = format!("{rows} x {cols}");
            let expected = "at least one grid point, at most 2^30";
            return Err(Failure::argument("rows and cols", found, expected));
        }
        let size = [rows as usize, cols as usize];
        let count = size[0] * size[1];
        // SAFETY: as the caller says.
        let heights = unsafe { std::slice::from_raw_parts_mut(heights, count) };
        // SAFETY: as the caller says, where it is not null.
        let marks =
            (!voids.is_null()).then(|| unsafe { std::slice::from_raw_parts_mut(voids, count) });
        let marked = |i: usize| marks.as_ref().is_some_and(|marks| marks[i] != 0);
        let all: Vec<bool> = (0..count).map(|i| heights[i].is_nan() || marked(i)).collect();
        ridgelight::scene::fill_voids(size, heights, &all)?;
        for (mark, is_void) in marks.into_iter().flatten().zip(&all) {
            *mark = u8::from(*is_void);
        }
        Ok(())
    })
}

//! Reads the caller's structs, up to the size that they begin with.

use std::mem::{MaybeUninit, size_of};
use std::ptr;

use crate::errors::{Done, Failure};

/// A struct of C: begins with its size in bytes, a u32, and may hold any bits, zeros too.
///
/// # Safety
/// All bits are a value of the type, and its first four bytes are the size.
pub(crate) unsafe trait SizeFirst: Copy {}

/// A copy of the struct at `from`; zeros where the caller's struct is shorter.
///
/// # Safety
/// `from` is null or points to as many bytes as its first four give.
pub(crate) unsafe fn read<T: SizeFirst>(from: *const T, name: &str) -> Done<T> {
    if from.is_null() {
        return Err(Failure::argument(name, "a null pointer", "a struct"));
    }
    // SAFETY: at least its size is there, as the caller says.
    let bytes = check_size::<T>(unsafe { from.cast::<u32>().read_unaligned() }, name)?;
    let mut copy = MaybeUninit::<T>::zeroed();
    // SAFETY: `bytes` are there, as the caller says, and fit the copy; any bits are a value.
    unsafe {
        ptr::copy_nonoverlapping(from.cast::<u8>(), copy.as_mut_ptr().cast(), bytes);
        Ok(copy.assume_init())
    }
}

fn check_size<T>(found: u32, name: &str) -> Done<usize> {
    let own = size_of::<T>();
    if (size_of::<u32>()..=own).contains(&(found as usize)) {
        return Ok(found as usize);
    }
    let expected = format!("sizeof the struct, {own}, or that of an older header");
    Err(Failure::argument(&format!("{name}: struct_size"), found, &expected))
}

/// Copies of `count` consecutive structs, each with the size of the first.
///
/// # Safety
/// `from` points to that many of them, or is null.
pub(crate) unsafe fn read_all<T: SizeFirst>(
    from: *const T,
    count: u32,
    name: &str,
) -> Done<Vec<T>> {
    if count == 0 {
        return Ok(Vec::new());
    }
    // SAFETY: as the caller says.
    let first = unsafe { read(from, &format!("{name} 0")) }?;
    let all = (1..count as usize).map(|i| {
        // SAFETY: the first is there; the others follow at its own distance, as the caller says.
        unsafe {
            let stride = from.cast::<u32>().read_unaligned() as usize;
            read(from.byte_add(i * stride), &format!("{name} {i}"))
        }
    });
    std::iter::once(Ok(first)).chain(all).collect()
}

/// Writes a struct back, up to the caller's size; its size stays.
///
/// # Safety
/// As [`read`], and nobody else reads it meanwhile.
pub(crate) unsafe fn write<T: SizeFirst>(to: *mut T, value: &T, name: &str) -> Done {
    // SAFETY: as the caller says.
    unsafe {
        read(to.cast_const(), name)?;
        let size = to.cast::<u32>().read_unaligned();
        let from = ptr::from_ref(value).cast::<u8>();
        ptr::copy_nonoverlapping(from, to.cast(), size as usize);
        to.cast::<u32>().write_unaligned(size);
    }
    Ok(())
}

/// `count` numbers at a pointer.
///
/// # Safety
/// They are valid for as long as the slice is used, or the pointer is null.
pub(crate) unsafe fn numbers<'a>(from: *const f32, count: usize) -> Option<&'a [f32]> {
    // SAFETY: as the caller says.
    (!from.is_null()).then(|| unsafe { std::slice::from_raw_parts(from, count) })
}

/// Copies of `count` indices at a pointer.
///
/// # Safety
/// `from` is null or points to that many of them.
pub(crate) unsafe fn indices(from: *const u32, count: u32, name: &str) -> Done<Vec<usize>> {
    if count == 0 {
        return Ok(Vec::new());
    }
    if from.is_null() {
        return Err(Failure::argument(name, "a null pointer", &format!("{count} indices")));
    }
    // SAFETY: as the caller says.
    let all = unsafe { std::slice::from_raw_parts(from, count as usize) };
    Ok(all.iter().map(|index| *index as usize).collect())
}

/// How many indices the caller's array holds: 0 if `count` is null.
///
/// # Safety
/// `count` is null or points at a number.
pub(crate) unsafe fn room(to: *mut u32, count: *const u32, name: &str) -> Done<usize> {
    // SAFETY: as the caller says.
    let count = unsafe { count.as_ref() }.map_or(0, |count| *count as usize);
    if count > 0 && to.is_null() {
        let expected = format!("room for {count} indices");
        return Err(Failure::argument(name, "a null pointer", &expected));
    }
    Ok(count)
}

/// The object of an opaque handle.
///
/// # Safety
/// It is null, or came from the function that makes it and has not been destroyed.
pub(crate) unsafe fn handle<'a, T>(from: *const T, name: &str) -> Done<&'a T> {
    // SAFETY: as the caller says.
    unsafe { from.as_ref() }.ok_or_else(|| Failure::argument(name, "a null pointer", "a handle"))
}

/// The same, for changes by one thread at a time.
///
/// # Safety
/// As [`handle`], and nobody else uses it meanwhile.
pub(crate) unsafe fn handle_mut<'a, T>(from: *mut T, name: &str) -> Done<&'a mut T> {
    // SAFETY: as the caller says.
    unsafe { from.as_mut() }.ok_or_else(|| Failure::argument(name, "a null pointer", "a handle"))
}

/// Passes a new object out as a handle.
///
/// # Safety
/// `to` is null or may be written to.
pub(crate) unsafe fn hand_out<T>(to: *mut *mut T, make: impl FnOnce() -> Done<T>) -> Done {
    if to.is_null() {
        return Err(Failure::argument("out", "a null pointer", "a place for the handle"));
    }
    // SAFETY: as the caller says.
    unsafe {
        to.write(ptr::null_mut());
        to.write(Box::into_raw(Box::new(make()?)));
    }
    Ok(())
}

/// A constant of the caller as a Rust value: 0 is the default, others count from 1.
pub(crate) fn pick<T: Copy>(name: &str, found: u32, default: T, all: &[T]) -> Done<T> {
    match found {
        0 => Ok(default),
        _ => all.get(found as usize - 1).copied().ok_or_else(|| {
            Failure::argument(name, found, &format!("one of its constants, 0 to {}", all.len()))
        }),
    }
}

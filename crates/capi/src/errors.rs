use std::cell::RefCell;
use std::ffi::{CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

use ridgelight::Error;

/// How a call ended.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RidgelightResult {
    /// Success.
    Ok = 0,
    /// A null pointer, a struct_size or an undefined constant.
    Argument = 1,
    /// A value out of range, or an image that does not match the plan.
    Setting = 2,
    /// A scene that exceeds the device or the memory budget.
    Limit = 3,
    /// A device that lacks something, or a Vulkan call that failed.
    Device = 4,
    /// A bug in Ridgelight: please report it.
    Internal = 5,
}

/// Why a call failed: a code and a sentence.
pub(crate) struct Failure(pub RidgelightResult, pub String);

pub(crate) type Done<T = ()> = Result<T, Failure>;

impl Failure {
    pub fn argument(name: &str, found: impl std::fmt::Display, expected: &str) -> Self {
        let sentence = format!("{name}: found {found}, expected {expected}");
        Self(RidgelightResult::Argument, sentence)
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        let code = match error {
            Error::Setting { .. } => RidgelightResult::Setting,
            Error::Limit { .. } => RidgelightResult::Limit,
            _ => RidgelightResult::Device,
        };
        Self(code, error.to_string())
    }
}

thread_local! {
    static LAST: RefCell<CString> = RefCell::default();
}

/// Runs the body of a function; keeps the sentence if it fails. No panic crosses into C.
pub(crate) fn done(work: impl FnOnce() -> Done) -> RidgelightResult {
    // What a panic leaves half done is behind a handle that its caller must no longer use.
    let ended = catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| {
        Err(Failure(RidgelightResult::Internal, "a fault of Ridgelight's own".to_owned()))
    });
    match ended {
        Ok(()) => RidgelightResult::Ok,
        Err(Failure(code, sentence)) => {
            let text = CString::new(sentence.replace('\0', " ")).unwrap_or_default();
            LAST.with(|last| *last.borrow_mut() = text);
            code
        }
    }
}

/// One sentence on why the last failing call on this thread failed: UTF-8, nul-terminated, valid until another
/// call on this thread fails. Empty before the first failure.
#[unsafe(no_mangle)]
pub extern "C" fn ridgelight_last_error() -> *const c_char {
    LAST.with(|last| last.borrow().as_ptr())
}

/// The version of this header: major << 16 | minor << 8 | patch.
pub const RIDGELIGHT_VERSION: u32 = 0x0000_0100;

/// The version of the library: major << 16 | minor << 8 | patch.
#[unsafe(no_mangle)]
pub extern "C" fn ridgelight_version() -> u32 {
    RIDGELIGHT_VERSION
}

/// Whether the library is compatible with a program compiled against the version `header`, its
/// RIDGELIGHT_VERSION. The major version must be equal, before 1.0 also the minor, and the library must not be
/// older.
///
/// Returns OK, or ARGUMENT.
#[unsafe(no_mangle)]
pub extern "C" fn ridgelight_check_version(header: u32) -> RidgelightResult {
    done(|| {
        let parts = |v: u32| [v >> 16, v >> 8 & 0xff, v & 0xff];
        let [found, own] = [header, RIDGELIGHT_VERSION].map(parts);
        let is_same = if own[0] == 0 { found[..2] == own[..2] } else { found[0] == own[0] };
        if is_same && found <= own {
            return Ok(());
        }
        let text = |v: [u32; 3]| format!("{}.{}.{}", v[0], v[1], v[2]);
        let expected = format!("a version that library {} supports", text(own));
        Err(Failure::argument("header", text(found), &expected))
    })
}

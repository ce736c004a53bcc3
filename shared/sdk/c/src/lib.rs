//! A process in its group, for programs in C: the functions that `whichone_group.h` declares, over the same code as
//! the services have.
//!
//! Nothing here unwinds into C: a panic in an `extern "C"` function aborts. Functions say why they fail on standard
//! error, where the log of a service is.

#![allow(unsafe_code, reason = "pointers of the caller; each function states what they must be")]
#![allow(clippy::print_stderr, reason = "the log of a program in C")]

pub mod group;
pub mod port;
pub mod run;
pub mod topic;

use std::ffi::{CStr, c_char};

/// Says why something failed.
fn complain(error: &dyn std::fmt::Display) {
    eprintln!("{error}");
}

/// Returns the value, or none after saying why there is none.
fn or_complain<T, E: std::fmt::Display>(result: Result<T, E>) -> Option<T> {
    result.map_err(|error| complain(&error)).ok()
}

/// A text of the caller; none for a null pointer or bytes that are not UTF-8.
///
/// # Safety
/// `text` is null, or ends with a zero.
unsafe fn text<'a>(text: *const c_char) -> Option<&'a str> {
    if text.is_null() {
        return None;
    }
    // SAFETY: as the caller promises.
    let text = unsafe { CStr::from_ptr(text) };
    or_complain(text.to_str())
}

//! The C library of iceoryx2 as one archive.

pub use iceoryx2_ffi_c::*;

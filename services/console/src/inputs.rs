//! Input from browsers, as the server reads it: for the fuzz targets.

pub use crate::hub::command::{Verb, Words};
pub use crate::live::say;
pub use crate::server::message::{Do, Hello, Message, hello, message};
pub use crate::voice::PcmFrame;

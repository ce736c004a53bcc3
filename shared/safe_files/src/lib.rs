//! Files and temporary folders that no other user of the machine can prepare, redirect or block.
//!
//! The only crate that replaces files or uses the system's folders for temporary files: names of
//! new files are random and must not exist, and a file's next writer removes leftovers of a crash.

mod draft;
pub mod folders;
mod leftovers;
mod older;
mod output;
mod regular;
mod temporary;

pub use draft::{
    Draft, Readers, create_private, open_lock, probe, replace, replace_private,
    replace_private_synced,
};
pub use older::{absent_is_fine, make_room, suffixed};
pub use output::{OutputFolder, check_new_output, write_new_output, write_output};
pub use regular::{open_regular, read_folder, read_private, read_regular};
pub use temporary::TemporaryFolder;

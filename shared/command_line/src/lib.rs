//! Shared code of the verbs of the command line: [`output`], the [`configuration`] and the scene
//! files that they name, [`interrupt`]ions, and the arguments for them.

use service::exit::{Exit, Failure};

pub mod amounts;
pub mod args;
pub mod configuration;
pub mod interrupt;
pub mod output;
pub mod program;
pub mod scene_file;
pub mod shipped;

/// Result of a verb: its exit code, or a failure to report.
pub type Outcome = Result<Exit, Failure>;

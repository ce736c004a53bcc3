//! Arguments of `record`.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Subcommand};

use command_line::args::seconds;

/// What `record` does.
#[derive(Debug, Subcommand)]
pub enum RecordVerb {
    /// Start the recorder, and wait until it is ready.
    Start(RecorderArgs),
    /// Stop the recorder, which completes its file.
    Stop(RecorderArgs),
    /// List the group's recordings, oldest first.
    List,
    /// Print the path of a recording that viewers can open.
    ///
    /// Of one that is being written, this is a copy of what is recorded so far.
    Open(OpenArgs),
}

/// Arguments of `record start` and `record stop`.
#[derive(Debug, Args)]
pub struct RecorderArgs {
    /// Timeout, seconds; 0 returns at once.
    #[arg(long, value_name = "S", default_value = "30", value_parser = seconds)]
    pub timeout: Duration,
}

/// Arguments of `record open`.
#[derive(Debug, Args)]
pub struct OpenArgs {
    /// Name of the recording, as `record list` prints it, or its beginning [default: the newest].
    #[arg(value_name = "NAME")]
    pub name: Option<String>,
    /// Copy it to this file [default, where a copy is needed: the folder `opened` of the group].
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

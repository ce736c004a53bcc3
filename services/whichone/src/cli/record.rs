//! Arguments of `record` and `export`.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Subcommand};

use super::ProblemArgs;
use super::talk::seconds;

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

/// What `export` writes.
#[derive(Debug, Subcommand)]
pub enum ExportVerb {
    /// The decision problem of the planners in Cassandra's text format, which public solvers read.
    Pomdp(PomdpArgs),
    /// Recordings, journals or flights as one MCAP file, which Foxglove and other robotics tools open.
    Mcap(McapArgs),
}

/// Arguments of `export pomdp`.
#[derive(Debug, Args)]
pub struct PomdpArgs {
    /// The scene: a TOML or JSON file, or the name of a scene of the configuration.
    pub scene: PathBuf,
    /// The problem.
    #[command(flatten)]
    pub problem: ProblemArgs,
    /// Write to this file instead of standard output.
    #[arg(long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// Arguments of `export mcap`.
#[derive(Debug, Args)]
pub struct McapArgs {
    /// A recording, a journal, a flight, or a folder of one kind [default: the recordings of the group].
    ///
    /// The folder of a group has its recordings in `recordings`, its journals in `journal` and its flights in
    /// `flight`; `whichone record list` prints where that is.
    #[arg(value_name = "SOURCE")]
    pub source: Option<PathBuf>,
    /// The file to write; an existing one is not replaced.
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

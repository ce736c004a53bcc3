//! Arguments of `export`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::ProblemArgs;

/// What `export` writes.
#[derive(Debug, Subcommand)]
pub enum ExportVerb {
    /// The decision problem of the planners in Cassandra's text format, which public solvers read.
    Pomdp(PomdpArgs),
    /// Recordings, journals or flights as one MCAP file, which Foxglove and other robotics tools open.
    Mcap(McapArgs),
    /// Journals as a trace, which Perfetto opens: what was heard, decided, said and moved, and when.
    Trace(TraceArgs),
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
    /// The folder of a group has its recordings in `recordings`, its journals in `journal` and its
    /// flights in `flight`; `whichone record list` prints where that is.
    #[arg(value_name = "SOURCE")]
    pub source: Option<PathBuf>,
    /// The file to write; an existing one is not replaced.
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

/// Arguments of `export trace`.
#[derive(Debug, Args)]
pub struct TraceArgs {
    /// A journal, or a folder of journals [default: those of the group].
    #[arg(value_name = "SOURCE")]
    pub source: Option<PathBuf>,
    /// The file to write; an existing one is not replaced.
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

//! Arguments of `replay`.

use std::path::PathBuf;

use clap::Args;
use command_line::args::key_and_value;

/// Arguments of `replay`.
#[derive(Debug, Args)]
pub struct ReplayArgs {
    /// A flight, or a folder of flights [default: the folder `flight` of the group].
    #[arg(value_name = "FOLDER")]
    pub folder: Option<PathBuf>,
    /// Replay the flights of this service only.
    #[arg(long, value_name = "SERVICE")]
    pub service: Option<String>,
    /// Replay with another setting, e.g. dialogue.planner=entropy, and list the decisions that
    /// differ; may be repeated. What was heard and seen stays as it was recorded.
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_and_value)]
    pub what_if: Vec<(String, String)>,
}

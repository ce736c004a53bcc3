//! Arguments of `conform`.

use clap::Args;
use command_line::args::ConfigArgs;

/// Arguments of `conform`.
#[derive(Debug, Args)]
pub struct ConformArgs {
    /// Kind of the service: its name in a group, e.g. grounding.
    pub service: String,
    /// The program to test, and its arguments.
    #[arg(last = true, required = true, value_name = "COMMAND")]
    pub command: Vec<String>,
    /// Test this rule alone; may be repeated.
    #[arg(long = "rule", value_name = "NAME")]
    pub rules: Vec<String>,
    /// The configuration whose scene and settings the service gets.
    #[command(flatten)]
    pub config: ConfigArgs,
}

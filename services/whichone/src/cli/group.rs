//! Arguments of the verbs that operate a group.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, ValueEnum};
use command_line::args::seconds;

use super::ConfigArgs;

/// Arguments of `up`.
#[derive(Debug, Args)]
pub struct UpArgs {
    /// The configuration.
    #[command(flatten)]
    pub config: ConfigArgs,
    /// Run the group in the background; return once its supervisor runs.
    #[arg(long, short)]
    pub detach: bool,
    /// With --detach: return only in this state.
    #[arg(long, value_name = "WHAT", requires = "detach")]
    pub wait: Option<WaitFor>,
    /// Timeout, seconds.
    #[arg(long, value_name = "S", default_value = "30", value_parser = seconds)]
    pub timeout: Duration,
    /// Start with new journals; those of earlier runs are kept in `journal-EPOCH`.
    #[arg(long)]
    pub fresh: bool,
}

/// Condition that `up` can wait for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum WaitFor {
    /// Every service is ready.
    Ready,
}

/// Arguments of `down`.
#[derive(Debug, Args)]
pub struct DownArgs {
    /// Timeout, seconds; the group continues to stop after it.
    #[arg(long, value_name = "S", default_value = "60", value_parser = seconds)]
    pub timeout: Duration,
}

/// Arguments of `start`, `stop`, `hold` and `release`.
#[derive(Debug, Args)]
pub struct ServiceArgs {
    /// Name of the service.
    pub service: String,
    /// Timeout, seconds; 0 returns at once.
    #[arg(long, value_name = "S", default_value = "30", value_parser = seconds)]
    pub timeout: Duration,
}

/// Arguments of `stop`.
#[derive(Debug, Args)]
pub struct StopArgs {
    /// Name of the service; without one, the arm stops at once, as by `stop-motion`.
    pub service: Option<String>,
    /// Timeout, seconds; 0 returns at once.
    #[arg(long, value_name = "S", default_value = "30", value_parser = seconds)]
    pub timeout: Duration,
}

/// Arguments of `restart`.
#[derive(Debug, Args)]
pub struct RestartArgs {
    /// Name of the service.
    pub service: String,
    /// Restore the configured program of a swapped service.
    #[arg(long)]
    pub original: bool,
    /// Timeout, seconds; 0 returns at once.
    #[arg(long, value_name = "S", default_value = "30", value_parser = seconds)]
    pub timeout: Duration,
}

/// Arguments of `console`.
#[derive(Debug, Args)]
pub struct ConsoleArgs {
    /// Open the page in the browser, without the token in any process's arguments.
    #[arg(long)]
    pub open: bool,
    /// Replace the token first: every browser has to log in again.
    #[arg(long)]
    pub renew: bool,
    /// Serve a page for an interaction that was saved from the history, until Ctrl-C; no group is needed.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["open", "renew"])]
    pub view: Option<PathBuf>,
}

/// Arguments of `reload`.
#[derive(Debug, Args)]
pub struct ReloadArgs {
    /// Use another scene until the group ends: a name in `scenes` of the configuration, or a path from its folder.
    #[arg(long, value_name = "NAME")]
    pub scene: Option<String>,
    /// Timeout for the restarted services, seconds; 0 returns at once.
    #[arg(long, value_name = "S", default_value = "30", value_parser = seconds)]
    pub timeout: Duration,
}

/// Arguments of `swap`.
#[derive(Debug, Args)]
pub struct SwapArgs {
    /// Name of the service.
    pub service: String,
    /// The new program and its arguments.
    #[arg(last = true, required = true, value_name = "COMMAND")]
    pub command: Vec<String>,
    /// Timeout, seconds.
    #[arg(long, value_name = "S", default_value = "120", value_parser = seconds)]
    pub timeout: Duration,
}

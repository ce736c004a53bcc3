//! Arguments of the verbs that operate a group.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, ValueEnum};

use super::talk::seconds;

/// Which configuration.
#[derive(Clone, Debug, Default, Args)]
pub struct ConfigArgs {
    /// Folder of the configuration; found by itself as ./config or beside the program.
    #[arg(long, value_name = "DIR", env = "WHICHONE_CONFIG", hide_env_values = true)]
    pub config: Option<PathBuf>,
    /// A profile to lay over it, from its folder `profiles`.
    #[arg(long, value_name = "NAME")]
    pub profile: Option<String>,
    /// A value that counts more than the files', e.g. group.scene=tools; may be repeated.
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_and_value)]
    pub set: Vec<(String, String)>,
}

/// Arguments of `up`.
#[derive(Debug, Args)]
pub struct UpArgs {
    /// The configuration.
    #[command(flatten)]
    pub config: ConfigArgs,
    /// Return once the supervisor runs, and leave the group running in the background.
    #[arg(long, short)]
    pub detach: bool,
    /// With --detach: return only once this is so.
    #[arg(long, value_name = "WHAT")]
    pub wait: Option<WaitFor>,
    /// Longest wait, seconds.
    #[arg(long, value_name = "S", default_value = "30", value_parser = seconds)]
    pub timeout: Duration,
    /// Put the journals of earlier runs aside and begin anew.
    #[arg(long)]
    pub fresh: bool,
}

/// What a start can be waited for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum WaitFor {
    /// Every service is ready.
    Ready,
}

/// Arguments of `down`.
#[derive(Debug, Args)]
pub struct DownArgs {
    /// Longest wait, seconds; the group goes on stopping after it.
    #[arg(long, value_name = "S", default_value = "60", value_parser = seconds)]
    pub timeout: Duration,
}

/// Arguments of `start`, `stop`, `hold` and `release`.
#[derive(Debug, Args)]
pub struct ServiceArgs {
    /// Name of the service.
    pub service: String,
    /// Longest wait, seconds; 0 returns at once.
    #[arg(long, value_name = "S", default_value = "30", value_parser = seconds)]
    pub timeout: Duration,
}

/// Arguments of `restart`.
#[derive(Debug, Args)]
pub struct RestartArgs {
    /// Name of the service.
    pub service: String,
    /// Give a swapped service its configured program back.
    #[arg(long)]
    pub original: bool,
    /// Longest wait, seconds; 0 returns at once.
    #[arg(long, value_name = "S", default_value = "30", value_parser = seconds)]
    pub timeout: Duration,
}

/// Arguments of `logs`.
#[derive(Debug, Args)]
pub struct LogsArgs {
    /// Name of a service, or `supervisor`; all of them where nothing is said.
    pub service: Option<String>,
    /// Go on with what is logged from now on.
    #[arg(long, short)]
    pub follow: bool,
    /// Last lines to show.
    #[arg(long, short = 'n', value_name = "N", default_value_t = 40)]
    pub tail: usize,
}

/// Arguments of `reload`.
#[derive(Debug, Args)]
pub struct ReloadArgs {
    /// Longest wait for the restarted services, seconds; 0 returns at once.
    #[arg(long, value_name = "S", default_value = "30", value_parser = seconds)]
    pub timeout: Duration,
}

/// Arguments of `check`.
#[derive(Debug, Args)]
pub struct CheckArgs {
    /// The configuration.
    #[command(flatten)]
    pub config: ConfigArgs,
    /// Show every value and the file that it comes from.
    #[arg(long)]
    pub values: bool,
}

/// Arguments of `swap`.
#[derive(Debug, Args)]
pub struct SwapArgs {
    /// Name of the service.
    pub service: String,
    /// The new program and its arguments.
    #[arg(last = true, required = true, value_name = "COMMAND")]
    pub command: Vec<String>,
    /// Longest wait for the decision, seconds.
    #[arg(long, value_name = "S", default_value = "120", value_parser = seconds)]
    pub timeout: Duration,
}

fn key_and_value(text: &str) -> Result<(String, String), String> {
    let (key, value) = text.split_once('=').ok_or("write KEY=VALUE, e.g. group.scene=tools")?;
    Ok((key.trim().to_owned(), value.trim().to_owned()))
}

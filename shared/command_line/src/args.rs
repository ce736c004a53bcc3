//! Arguments of many verbs.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;

/// Selection of the configuration.
#[derive(Clone, Debug, Default, Args)]
pub struct ConfigArgs {
    /// Folder of the configuration [default: ./config, `config` beside the program,
    /// ~/.config/whichone, /etc/whichone, else the built-in one].
    #[arg(long, value_name = "DIR", env = "WHICHONE_CONFIG", hide_env_values = true)]
    pub config: Option<PathBuf>,
    /// A profile from the folder `profiles` of the configuration.
    #[arg(long, value_name = "NAME")]
    pub profile: Option<String>,
    /// Override a configuration value, e.g. group.scene=tools; may be repeated.
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_and_value)]
    pub set: Vec<(String, String)>,
}

impl ConfigArgs {
    /// Returns true if any of them is given.
    pub fn is_given(&self) -> bool {
        self.config.is_some() || self.profile.is_some() || !self.set.is_empty()
    }
}

/// Parses a setting.
///
/// # Errors
/// There is no `=`.
pub fn key_and_value(text: &str) -> Result<(String, String), String> {
    let (key, value) =
        text.split_once('=').ok_or("expected KEY=VALUE, e.g. dialogue.planner=entropy")?;
    Ok((key.trim().to_owned(), value.trim().to_owned()))
}

/// Longest timeout, a month: sums of times stay far from overflow.
const SECONDS_MAX: f64 = 2_678_400.0;

/// Parses a timeout.
///
/// # Errors
/// It is not a number of seconds, or out of range.
pub fn seconds(text: &str) -> Result<Duration, String> {
    let wrong = || "expected seconds, e.g. 30".to_owned();
    let seconds: f64 = text.trim().parse().map_err(|_| wrong())?;
    let sensible = (0.0..=SECONDS_MAX).contains(&seconds);
    sensible.then(|| Duration::from_secs_f64(seconds)).ok_or_else(wrong)
}

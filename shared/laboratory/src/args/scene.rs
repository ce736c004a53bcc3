//! Arguments of `check` and `scene`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use command_line::args::ConfigArgs;

/// Arguments of `check`.
#[derive(Debug, Args)]
pub struct CheckArgs {
    /// The configuration.
    #[command(flatten)]
    pub config: ConfigArgs,
    /// Show every value and its origin.
    #[arg(long)]
    pub values: bool,
}

/// What `scene` does.
#[derive(Debug, Subcommand)]
pub enum SceneVerb {
    /// Write a commented scene to begin with: it passes the check, and the arm reaches its objects.
    New(SceneNewArgs),
    /// Show objects, words, places, and which arm fetches what.
    Show(SceneShowArgs),
    /// Check a scene file with a configuration: list every problem at once, as `check` does.
    Check(SceneCheckArgs),
    /// Propose places for objects that have none yet or that the arm cannot fetch where they are.
    ///
    /// An object without `xyz` that has `size` and `grasp_width` gets a place on the table; one that the
    /// arm cannot fetch gets the nearest place where it can. Prints a diff, or edits the file with
    /// --write; comments and everything else in it stay. The same file gives the same places.
    Place(ScenePlaceArgs),
}

/// Arguments of `scene new`.
#[derive(Debug, Args)]
pub struct SceneNewArgs {
    /// The file to write, or a name: NAME.toml among the scenes of the configuration. An existing file
    /// is not replaced.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// The configuration with the robot and its table.
    #[command(flatten)]
    pub config: ConfigArgs,
}

/// Arguments of `scene show`.
#[derive(Debug, Args)]
pub struct SceneShowArgs {
    /// The scene: a TOML file, or the name of a scene of the configuration [default: the configured one].
    #[arg(value_name = "SCENE")]
    pub scene: Option<PathBuf>,
    /// The configuration with the robot and its table.
    #[command(flatten)]
    pub config: ConfigArgs,
}

/// Arguments of `scene check`.
#[derive(Debug, Args)]
pub struct SceneCheckArgs {
    /// The scene: a TOML file, or the name of a scene of the configuration.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// The configuration with the robot and its table.
    #[command(flatten)]
    pub config: ConfigArgs,
}

/// Arguments of `scene place`.
#[derive(Debug, Args)]
pub struct ScenePlaceArgs {
    /// The scene: a TOML file, or the name of a scene of the configuration.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Write the places into the file instead of printing a diff.
    #[arg(long)]
    pub write: bool,
    /// The configuration with the robot and its table.
    #[command(flatten)]
    pub config: ConfigArgs,
}

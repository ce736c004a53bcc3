//! Arguments of `robot`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use command_line::args::ConfigArgs;

/// What `robot` does.
#[derive(Debug, Subcommand)]
pub enum RobotVerb {
    /// Read a description that others publish, and write robot, scene and profile from it.
    ///
    /// Reads URDF, with meshes (STL, COLLADA, OBJ) by path or package://, and xacro where its program is installed. Base,
    /// arm and gripper are found by structure. Prints what was chosen, assumed and is missing; asks nothing.
    /// Writes robots/NAME.urdf, robots/NAME.srdf, scenes/NAME-blocks.toml and profiles/NAME.toml, and checks them.
    Import(ImportArgs),
    /// Show the servos of the configured arm, calibrate them by its file, or switch them off, while no group uses them.
    ///
    /// Without an option it prints position, supply, temperature and errors of each servo, and where its registers
    /// differ from the calibration.
    Servos(ServosArgs),
}

/// Arguments of `robot servos`.
#[derive(Debug, Args)]
pub struct ServosArgs {
    /// The configuration.
    #[command(flatten)]
    pub config: ConfigArgs,
    /// Write the calibration file to the servos, where it outlasts a loss of power. They must not hold.
    #[arg(long, conflicts_with = "release")]
    pub write_calibration: bool,
    /// Switch every servo off. The arm falls: support it.
    #[arg(long)]
    pub release: bool,
}

/// Arguments of `robot import`.
#[derive(Debug, Args)]
pub struct ImportArgs {
    /// Description: a URDF or a xacro. An SRDF of the same name beside it is compared.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Name of the robot and its profile [default: the file's].
    #[arg(long, value_name = "NAME")]
    pub name: Option<String>,
    /// Folder of the configuration to write to; a new one is made like `init` does [default: as for `check`].
    #[arg(long, value_name = "DIR", env = "WHICHONE_CONFIG", hide_env_values = true)]
    pub config: Option<PathBuf>,
    /// Link that the arm hangs on.
    #[arg(long, value_name = "LINK")]
    pub base: Option<String>,
    /// Link at the end of the arm.
    #[arg(long, value_name = "LINK")]
    pub tip: Option<String>,
    /// Link that carries the fingers, or none: two fingers are assumed on the flange.
    #[arg(long, value_name = "LINK")]
    pub gripper: Option<String>,
    /// Distance between the open fingers, millimetres, where the file does not say.
    #[arg(long, value_name = "N", value_parser = opening_mm)]
    pub opening_mm: Option<f64>,
    /// SRDF to compare the collision pairs with.
    #[arg(long, value_name = "FILE")]
    pub srdf: Option<PathBuf>,
    /// Replace files of that name.
    #[arg(long)]
    pub replace: bool,
}

/// Parses an opening of a gripper.
fn opening_mm(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(mm) if (15.0..=400.0).contains(&mm) => Ok(mm),
        _ => Err(format!("expected 15 to 400 mm, found {text}")),
    }
}

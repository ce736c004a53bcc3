//! Arguments of `arm`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use command_line::args::ConfigArgs;

/// Actions of the arm that need no group.
#[derive(Debug, Subcommand)]
pub enum ArmVerb {
    /// Draw the motion that fetches an object: joints over time, and the path of the gripper.
    Plot(ArmPlotArgs),
}

/// Arguments of `arm plot`.
#[derive(Debug, Args)]
pub struct ArmPlotArgs {
    /// Scene: a TOML or JSON file, or the name of one in the configuration; the configured scene
    /// by default.
    #[arg(long, value_name = "FILE")]
    pub scene: Option<PathBuf>,
    /// Object to fetch; the scene's first by default.
    #[arg(long, value_name = "NAME")]
    pub object: Option<String>,
    /// Limb by its name in the description, or auto for the one with the faster motion; the
    /// configured one by default.
    #[arg(long, value_name = "NAME")]
    pub limb: Option<String>,
    /// Picture, as SVG.
    #[arg(long, value_name = "FILE", default_value = "pick.svg")]
    pub out: PathBuf,
    /// Width of the picture, pixels.
    #[arg(long, value_name = "PIXELS", default_value = "1600", value_parser = width)]
    pub width: u32,
    /// With --json: print that many samples per second of joints, velocities, finger width and what
    /// is held, so that any physics engine can check the plan.
    #[arg(long, value_name = "N", value_parser = samples_hz)]
    pub samples_hz: Option<f64>,
    /// Configuration of the robot, its motions and the handover.
    #[command(flatten)]
    pub config: ConfigArgs,
}

fn samples_hz(text: &str) -> Result<f64, String> {
    let sensible = text.trim().parse().ok().filter(|hz| (1.0..=1000.0).contains(hz));
    sensible.ok_or_else(|| "expected a number of samples per second from 1 to 1000".to_owned())
}

fn width(text: &str) -> Result<u32, String> {
    let sensible = text.trim().parse().ok().filter(|width| (800..=4000).contains(width));
    sensible.ok_or_else(|| "expected a number of pixels from 800 to 4000".to_owned())
}

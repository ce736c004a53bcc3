//! Arguments of `arm`.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};
use manipulation::Limb;

use super::ConfigArgs;

/// Arguments of `arm`.
#[derive(Debug, Args)]
pub struct ArmVerbArgs {
    /// What to do with it.
    #[command(subcommand)]
    pub what: ArmVerb,
}

/// What can be done with the arm without a group.
#[derive(Debug, Subcommand)]
pub enum ArmVerb {
    /// Draw how an object is fetched: the robot, its postures on the way, and the motion in time.
    Plot(ArmPlotArgs),
}

/// Arguments of `arm plot`.
#[derive(Debug, Args)]
pub struct ArmPlotArgs {
    /// The scene: a file, TOML or JSON, or the name of one of the configuration's, whose own is
    /// drawn where nothing is said.
    #[arg(long, value_name = "FILE")]
    pub scene: Option<PathBuf>,
    /// The object that is fetched; the scene's first where nothing is said.
    #[arg(long, value_name = "NAME")]
    pub object: Option<String>,
    /// The limb; the configuration's where nothing is said.
    #[arg(long, value_enum)]
    pub limb: Option<AnyLimbArg>,
    /// The picture: PNG or SVG, as its name ends.
    #[arg(long, value_name = "FILE", default_value = "pick.png")]
    pub out: PathBuf,
    /// Width of the picture in pixels, as PNG.
    #[arg(long, value_name = "PIXELS", default_value = "1600", value_parser = width)]
    pub width: u32,
    /// Samples along either side of a pixel: fewer are sooner drawn, more are smoother.
    #[arg(long, value_name = "N", default_value = "3", value_parser = clap::value_parser!(u8).range(1..=6))]
    pub samples: u8,
    /// The configuration: the robot, how it moves, and where it brings things.
    #[command(flatten)]
    pub config: ConfigArgs,
}

/// A limb, or whichever is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum AnyLimbArg {
    /// The arm at the robot's left.
    Left,
    /// The arm at the robot's right.
    Right,
    /// The one that is there sooner.
    Auto,
}

impl From<AnyLimbArg> for Option<Limb> {
    fn from(arg: AnyLimbArg) -> Self {
        match arg {
            AnyLimbArg::Left => Some(Limb::Left),
            AnyLimbArg::Right => Some(Limb::Right),
            AnyLimbArg::Auto => None,
        }
    }
}

fn width(text: &str) -> Result<u32, String> {
    let sensible = text.trim().parse().ok().filter(|width| (800..=4000).contains(width));
    sensible.ok_or_else(|| "write a number of pixels from 800 to 4000".to_owned())
}

//! Arguments of the batch tools.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum};
use dialogue::{Costs, Mode};
use language::Language;
use manipulation::Limb;

use super::ConfigArgs;

/// Where the lines come from.
#[derive(Clone, Debug, Default, Args)]
pub struct InputArgs {
    /// Read this file instead of standard input.
    #[arg(long, value_name = "FILE")]
    pub input: Option<PathBuf>,
}

/// Arguments of `belief`.
#[derive(Debug, Args)]
pub struct BeliefArgs {
    /// The lines.
    #[command(flatten)]
    pub input: InputArgs,
}

/// Arguments of `ground`.
#[derive(Debug, Args)]
pub struct GroundArgs {
    /// The scene, TOML or JSON.
    #[arg(long, value_name = "FILE")]
    pub scene: PathBuf,
    /// Interpretation of utterances.
    #[arg(long, value_enum, default_value_t = LanguageArg::Careful)]
    pub language: LanguageArg,
    /// The lines.
    #[command(flatten)]
    pub input: InputArgs,
}

/// The decision problem: what the robot may do, and what it costs.
#[derive(Clone, Debug, Args)]
pub struct ProblemArgs {
    /// Whether user and robot share the room; the robot points only in mode `present`.
    #[arg(long, value_enum, default_value_t = ModeArg::Remote)]
    pub mode: ModeArg,
    /// Exclude questions like "Is it white?".
    #[arg(long)]
    pub no_attr: bool,
    /// Exclude questions like "What colour is it?".
    #[arg(long)]
    pub no_which: bool,
    /// Costs of actions and rewards of picks [default: the configuration's].
    #[arg(long, value_name = "PRESET", value_parser = cost_names())]
    pub costs: Option<String>,
    /// The configuration, for everything else.
    #[command(flatten)]
    pub config: ConfigArgs,
}

/// Arguments of `plan`.
#[derive(Debug, Args)]
pub struct PlanArgs {
    /// The scene, TOML or JSON.
    #[arg(long, value_name = "FILE")]
    pub scene: PathBuf,
    /// The planner [default: the configuration's].
    #[arg(long, value_name = "NAME", value_parser = planner_names())]
    pub planner: Option<String>,
    /// The problem.
    #[command(flatten)]
    pub problem: ProblemArgs,
    /// The lines.
    #[command(flatten)]
    pub input: InputArgs,
}

/// Arguments of `export`.
#[derive(Debug, Args)]
pub struct ExportArgs {
    /// The format.
    #[arg(value_enum)]
    pub what: Exported,
    /// The scene: a TOML or JSON file, or the name of a scene of the configuration.
    pub scene: PathBuf,
    /// The problem.
    #[command(flatten)]
    pub problem: ProblemArgs,
    /// Write to this file instead of standard output.
    #[arg(long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// What can be exported.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Exported {
    /// The decision problem of the planners in Cassandra's text format, which public solvers read.
    Pomdp,
}

/// Arguments of `fk` and `ik`.
#[derive(Debug, Args)]
pub struct ArmArgs {
    /// A robot description (URDF) [default: the built-in Baxter].
    #[arg(long, value_name = "FILE")]
    pub robot: Option<PathBuf>,
    /// The arm.
    #[command(flatten)]
    pub which: WhichArm,
    /// The lines.
    #[command(flatten)]
    pub input: InputArgs,
}

/// An arm of a robot: one of Baxter's two, or whatever ends in a link.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
pub struct WhichArm {
    /// The arm of a robot with Baxter's names.
    #[arg(long, value_enum)]
    pub limb: Option<LimbArg>,
    /// The last link of an arm with seven joints, of any robot.
    #[arg(long, value_name = "LINK")]
    pub tip: Option<String>,
}

/// [`Language`] on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LanguageArg {
    /// With synonyms, negation, corrections, and requests to stop or to start over.
    Careful,
    /// With the scene's own words and answer words only, as in the publication.
    Paper,
}

/// [`Mode`] on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ModeArg {
    /// The user does not see the robot.
    Remote,
    /// The user sees what the robot points at.
    Present,
}

/// [`Limb`] on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LimbArg {
    /// The left arm.
    Left,
    /// The right arm.
    Right,
}

impl From<LanguageArg> for Language {
    fn from(arg: LanguageArg) -> Self {
        match arg {
            LanguageArg::Careful => Self::Careful,
            LanguageArg::Paper => Self::Paper,
        }
    }
}

impl From<ModeArg> for Mode {
    fn from(arg: ModeArg) -> Self {
        match arg {
            ModeArg::Remote => Self::Remote,
            ModeArg::Present => Self::Present,
        }
    }
}

impl From<LimbArg> for Limb {
    fn from(arg: LimbArg) -> Self {
        match arg {
            LimbArg::Left => Self::Left,
            LimbArg::Right => Self::Right,
        }
    }
}

fn planner_names() -> PossibleValuesParser {
    dialogue::registry::names().to_vec().into()
}

fn cost_names() -> PossibleValuesParser {
    Costs::PRESETS.map(|(name, _)| name).into()
}

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
    /// Read this file in place of standard input.
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
    /// How utterances are read.
    #[arg(long, value_enum, default_value_t = LanguageArg::Careful)]
    pub language: LanguageArg,
    /// The lines.
    #[command(flatten)]
    pub input: InputArgs,
}

/// The decision problem: what the robot may do, and what it costs.
#[derive(Clone, Debug, Args)]
pub struct ProblemArgs {
    /// Whether person and robot share the room; the robot points only then.
    #[arg(long, value_enum, default_value_t = ModeArg::Remote)]
    pub mode: ModeArg,
    /// Do not ask "Is it white?".
    #[arg(long)]
    pub no_attr: bool,
    /// Do not ask "What colour is it?".
    #[arg(long)]
    pub no_which: bool,
    /// What actions cost and a pick is worth; the configuration's where nothing is said.
    #[arg(long, value_name = "PRESET", value_parser = cost_names())]
    pub costs: Option<String>,
    /// The configuration, for what is not said here.
    #[command(flatten)]
    pub config: ConfigArgs,
}

/// Arguments of `plan`.
#[derive(Debug, Args)]
pub struct PlanArgs {
    /// The scene, TOML or JSON.
    #[arg(long, value_name = "FILE")]
    pub scene: PathBuf,
    /// What decides; the configuration's where nothing is said.
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
    /// The form.
    #[arg(value_enum)]
    pub what: Exported,
    /// The scene: a file, TOML or JSON, or the name of one of the configuration's.
    pub scene: PathBuf,
    /// The problem.
    #[command(flatten)]
    pub problem: ProblemArgs,
    /// Write to this file in place of standard output.
    #[arg(long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// What can be exported.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Exported {
    /// The decision problem that the planners solve, in Cassandra's text form, which public
    /// solvers read.
    Pomdp,
}

/// Arguments of `fk` and `ik`.
#[derive(Debug, Args)]
pub struct ArmArgs {
    /// A robot's description (URDF); that of Baxter, which is built in, where nothing is said.
    #[arg(long, value_name = "FILE")]
    pub robot: Option<PathBuf>,
    /// Which of its arms.
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
    /// The last link of the arm of any robot; seven joints move it.
    #[arg(long, value_name = "LINK")]
    pub tip: Option<String>,
}

/// [`Language`] on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LanguageArg {
    /// Synonyms, negation, corrections, requests to stop or to start over.
    Careful,
    /// The scene's own words and the answer words, as in the publication.
    Paper,
}

/// [`Mode`] on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ModeArg {
    /// The person does not see the robot.
    Remote,
    /// The person sees what the robot points at.
    Present,
}

/// [`Limb`] on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LimbArg {
    /// The arm at the robot's left.
    Left,
    /// The arm at the robot's right.
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

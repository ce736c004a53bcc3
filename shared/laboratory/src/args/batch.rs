//! Arguments of the batch tools.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use command_line::args::ConfigArgs;
use vocabulary::{Announce, Costs, Language, Mode};

/// Where the lines come from.
#[derive(Clone, Debug, Default, Args)]
pub struct InputArgs {
    /// Read this file instead of standard input.
    #[arg(long, value_name = "FILE")]
    pub input: Option<PathBuf>,
}

/// Arguments of `ground`.
#[derive(Debug, Args)]
pub struct GroundArgs {
    /// The scene: a TOML or JSON file, or the name of a scene of the configuration.
    #[arg(long, value_name = "FILE")]
    pub scene: PathBuf,
    /// Interpretation of utterances [default: careful; with --config, --profile or --set the
    /// configuration's].
    #[arg(long, value_parser = one_of(LANGUAGES))]
    pub language: Option<Language>,
    /// Fit the calibration of the configured language model (dialogue.model) to the labelled lines of
    /// this file, and print it with the log loss before and after, beside that of the built-in reader.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["input", "language"])]
    pub calibrate: Option<PathBuf>,
    /// The configuration.
    #[command(flatten)]
    pub config: ConfigArgs,
    /// The lines.
    #[command(flatten)]
    pub input: InputArgs,
}

/// The decision problem: what the robot may do, and what it costs.
#[derive(Clone, Debug, Args)]
pub struct ProblemArgs {
    /// Whether user and robot share the room; the robot points only in mode `present` [default:
    /// remote; with --config, --profile or --set the configuration's].
    #[arg(long, value_parser = one_of(MODES))]
    pub mode: Option<Mode>,
    /// Exclude questions like "Is it white?".
    #[arg(long)]
    pub no_attr: bool,
    /// Exclude questions like "What colour is it?".
    #[arg(long)]
    pub no_which: bool,
    /// Include questions like "White, metallic or clear?".
    #[arg(long, overrides_with = "no_choice")]
    pub choice: bool,
    /// Exclude them where the configuration allows them.
    #[arg(long)]
    pub no_choice: bool,
    /// Costs of actions and rewards of picks [default: the configuration's].
    #[arg(long, value_name = "PRESET", value_parser = cost_names())]
    pub costs: Option<String>,
    /// Probability that a user who hears the wrong object announced denies it in time, 0 to below 1
    /// [default: 0, every pick is final; with --config, --profile or --set, and in a study without
    /// a preset, the configuration's].
    #[arg(long, value_name = "C", value_parser = heard)]
    pub announce: Option<f64>,
    /// The configuration. Its parameters and costs always count; with --config, --profile or --set
    /// the robot also asks only the kinds of questions that the configuration allows.
    #[command(flatten)]
    pub config: ConfigArgs,
}

/// Arguments of `plan`.
#[derive(Debug, Args)]
pub struct PlanArgs {
    /// The scene: a TOML or JSON file, or the name of a scene of the configuration.
    #[arg(long, value_name = "FILE")]
    pub scene: PathBuf,
    /// The planner [default: the configuration's].
    #[arg(long, value_name = "NAME", value_parser = planner_names(&[]))]
    pub planner: Option<String>,
    /// The problem.
    #[command(flatten)]
    pub problem: ProblemArgs,
    /// The lines.
    #[command(flatten)]
    pub input: InputArgs,
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

/// An arm of a robot: by its name, or whatever ends in a link.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
pub struct WhichArm {
    /// The arm that ends in the link NAME_gripper: left or right of Baxter, arm of the UR5e.
    #[arg(long, value_name = "NAME")]
    pub limb: Option<String>,
    /// The last link of an arm, of any robot; with five to seven joints for ik.
    #[arg(long, value_name = "LINK")]
    pub tip: Option<String>,
}

/// A choice on the command line: its name, its help, and its value.
pub(super) type Choice<T> = (&'static str, &'static str, T);

const LANGUAGES: &[Choice<Language>] = &[
    (
        "careful",
        "With synonyms, negation, corrections, and requests to stop or to start over",
        Language::Careful,
    ),
    (
        "paper",
        "With the scene's own words and answer words only, as in the publication",
        Language::Paper,
    ),
];

const MODES: &[Choice<Mode>] = &[
    ("remote", "The user does not see the robot", Mode::Remote),
    ("present", "The user sees what the robot points at", Mode::Present),
];

/// Parses the name of one of the choices.
pub(super) fn one_of<T>(choices: &'static [Choice<T>]) -> impl TypedValueParser<Value = T>
where
    T: Copy + Send + Sync + 'static,
{
    let value = |(name, help, _): &Choice<T>| PossibleValue::new(*name).help(*help);
    let names = PossibleValuesParser::new(choices.iter().map(value));
    names.try_map(|chosen| {
        let found = choices.iter().find(|(name, ..)| *name == chosen);
        found.map(|(.., value)| *value).ok_or("not one of the choices")
    })
}

/// The planners by name, each with its description, after `others`.
pub(super) fn planner_names(others: &[PossibleValue]) -> PossibleValuesParser {
    let planners = dialogue::registry::entries();
    let planners = planners.iter().map(|entry| PossibleValue::new(entry.name).help(entry.about));
    PossibleValuesParser::new(others.iter().cloned().chain(planners))
}

fn heard(text: &str) -> Result<f64, String> {
    let heard = text.parse().map_err(|error| format!("{error}"))?;
    let fault = Announce { heard, cost_s: 0.0 }.check().into_iter().next();
    fault.map_or(Ok(heard), |(_, what, help)| Err(format!("{what}; help: {help}")))
}

fn cost_names() -> PossibleValuesParser {
    Costs::PRESETS.map(|(name, _)| name).into()
}

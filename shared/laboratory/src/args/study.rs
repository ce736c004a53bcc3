//! Arguments of `study`.

use std::num::{NonZeroU32, NonZeroU64, NonZeroUsize};
use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Args, Subcommand, ValueEnum};
use command_line::args::ConfigArgs;
use evaluation::simulation::UserKind;

use super::batch::{ProblemArgs, planner_names};

/// Arguments of `study`.
#[derive(Clone, Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct StudyArgs {
    /// Action other than a study with simulated users.
    #[command(subcommand)]
    pub verb: Option<StudyVerb>,
    /// The scene: a TOML or JSON file, or the name of a scene of the configuration. A preset has
    /// its own.
    #[arg(long, value_name = "FILE", required_unless_present = "preset")]
    pub scene: Option<PathBuf>,
    /// Policies to compare.
    #[arg(
        long, value_name = "NAME,…", value_delimiter = ',', value_parser = planner_names(&[PossibleValue::new(ALL).help("Every planner")]),
        default_value = ALL, default_value_if("preset", "paper-present", "lookahead,no-attribute")
    )]
    pub policies: Vec<String>,
    /// Models of the simulated users.
    #[arg(
        long, value_name = "NAME,…", value_delimiter = ',', value_parser = users(),
        default_value = "model,noisy,human",
        default_value_if("preset", "paper-present", "truthful,noisy,human")
    )]
    pub users: Vec<String>,
    /// Interactions per policy and user model.
    #[arg(
        long, value_name = "N", default_value = "1000",
        default_value_ifs([("preset", "paper-present", "3"), ("preset", "paper-remote", "45")])
    )]
    pub interactions: NonZeroU64,
    /// Talk in turns with people who give their name, and count the dialogues of these numbers with
    /// each of them, from 1: the robot comes to know them. A wrong object is refused until the
    /// right one comes, and counts as wrong.
    #[arg(long, value_name = "N,…", value_delimiter = ',', conflicts_with = "preset")]
    pub dialogues: Vec<NonZeroU32>,
    /// How much more often these people want some objects than others: in proportion to 1 / rank^S,
    /// in an order of each person's own.
    #[arg(long, value_name = "S", default_value_t = 0.0, requires = "dialogues")]
    pub zipf: f64,
    /// Seed of all randomness.
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub seed: u64,
    /// Also simulate dialogues in real time under these rules of turn-taking, or all: naive, onset
    /// or mixture, joined by + with same, hold, open, fast and wSECONDS.
    #[arg(
        long,
        value_name = "RULES,…",
        value_delimiter = ',',
        default_value_if("preset", "paper-remote", ALL)
    )]
    pub turns: Vec<String>,
    /// Start without a request: the robot begins, knowing nothing.
    #[arg(long, default_value_if("preset", "paper-present", "true"))]
    pub no_request: bool,
    /// Write study.csv, study.json and plots into this folder.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// One of the paper's evaluations; other arguments override its values.
    #[arg(long, value_enum)]
    pub preset: Option<Preset>,
    /// Threads [default: one per core].
    #[arg(long, value_name = "N")]
    pub threads: Option<NonZeroUsize>,
    /// Use the durations of the robot's voice and arm as the costs of the questions.
    #[arg(long)]
    pub measured_costs: bool,
    /// Decision problem.
    #[command(flatten)]
    pub problem: ProblemArgs,
}

/// Name that stands for all names of a list.
pub const ALL: &str = "all";

/// The paper's evaluations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Preset {
    /// Section 5: face to face, from a confused start, with attribute questions and without.
    PaperPresent,
    /// Section 6: six bowls in another room, 45 interactions.
    PaperRemote,
}

fn users() -> PossibleValuesParser {
    UserKind::ALL.map(|(name, _)| name).into()
}

/// Actions other than a simulated study.
#[derive(Clone, Debug, Subcommand)]
pub enum StudyVerb {
    /// Report the results of a study with people.
    ///
    /// People take part on the console's page /study. Prints the success rate, the duration in
    /// seconds and the number of questions of each policy, each with its 95 % interval, and the
    /// differences between policies within participants who met several.
    Report(ReportArgs),
}

/// Arguments of `study report`.
#[derive(Clone, Debug, Args)]
pub struct ReportArgs {
    /// Folder of the data [default: the group's].
    pub folder: Option<PathBuf>,
    /// Write interactions.csv, participants.csv, dictionary.csv, study.json, report.json and plots
    /// into this folder.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// The configuration that names the data's folder.
    #[command(flatten)]
    pub config: ConfigArgs,
}

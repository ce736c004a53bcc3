//! Verbs for evaluation of the robot, for development of its services, and for authors of scenes and
//! configurations, without a running robot.
//!
//! [`recordings`] has two verbs for the files of a recorder. The table of verbs lists [`Verb`] whole, [`conform`], [`replay`], [`check`] and [`scene`] singly; [`run`] runs it.

use clap::Subcommand;
use command_line::Outcome;
use command_line::output::Output;
use service::exit::Failure;
use service::group::{GroupError, GroupPaths};

use args::{
    ArmArgs, ArmVerb, ExportVerb, GroundArgs, InputArgs, PlanArgs, RobotVerb, StudyArgs, StudyVerb,
};
use described_arm::DescribedArm;

pub mod args;
mod arm;
pub mod batch;
mod check;
mod conform;
pub mod described_arm;
mod export;
mod planning;
mod progress;
pub mod recordings;
mod replay;
mod robot;
mod scene;
pub mod scene_file;
mod servos;
mod study;
mod truthful_user;

pub use check::check;
pub use conform::conform;
pub use replay::replay;
pub use scene::scene;
pub use truthful_user::TruthfulUser;

/// The verbs that stand together in the list.
#[derive(Debug, Subcommand)]
pub enum Verb {
    /// Read test cases, one JSON object per line, and print the belief after each.
    Belief(InputArgs),
    /// Read utterances, one JSON object per line, and print the meaning of each in the scene.
    ///
    /// Input: `id`, `text`, and optionally `last_question`, the question that the utterance may
    /// answer: {"type":"point","object":ID}, {"type":"attr","attribute":K,"value":V},
    /// {"type":"which","attribute":K} or {"type":"none"}.
    Ground(GroundArgs),
    /// Read beliefs, one JSON object per line, and print the robot's next action for each.
    Plan(PlanArgs),
    /// Write the decision problem of a scene, recordings or journals for other programs.
    Export {
        /// The format.
        #[command(subcommand)]
        what: ExportVerb,
    },
    /// Compare policies with simulated users, or report the results of a study with people.
    ///
    /// With simulated users it prints, per policy and user model, the success rate, the number of
    /// questions, the duration in seconds and the return, each with its 95 % interval.
    /// The same seed gives the same table, byte for byte, on any number of threads.
    Study(Box<StudyArgs>),
    /// Show the arm's motions without a group.
    Arm {
        /// Action.
        #[command(subcommand)]
        what: ArmVerb,
    },
    /// Bring in a robot that others have described, or look after the servos of one.
    Robot {
        /// Action.
        #[command(subcommand)]
        what: RobotVerb,
    },
    /// Read joint positions, one JSON object per line, and print the pose of every link.
    Fk(ArmArgs),
    /// Read poses of an arm's last link, one JSON object per line, and print joint positions.
    Ik(ArmArgs),
}

/// Executes a verb; `paths` are those of the group that the command line names.
///
/// # Errors
/// The verb failed.
pub fn run(
    verb: Verb,
    paths: impl FnOnce() -> Result<GroupPaths, GroupError>,
    out: &mut Output<'_>,
) -> Outcome {
    match verb {
        Verb::Belief(args) => batch::belief(batch::open(&args)?, out),
        Verb::Ground(GroundArgs { calibrate: Some(file), scene, config, .. }) => {
            batch::calibrate(&planning::calibrator(&scene, &config)?, &file, out)
        }
        Verb::Ground(args) => {
            let grounder = planning::grounder(&args)?;
            batch::ground(&grounder, batch::open(&args.input)?, out)
        }
        Verb::Plan(args) => {
            batch::plan(&mut planning::decider(&args)?, batch::open(&args.input)?, out)
        }
        Verb::Export { what } => export::export(paths, &what, out),
        Verb::Study(args) => match &args.verb {
            Some(StudyVerb::Report(report)) => study::report(&paths()?, report, out),
            None => study::study(&args, out),
        },
        Verb::Arm { what: ArmVerb::Plot(args) } => arm::plot(&args, out),
        Verb::Robot { what: RobotVerb::Import(args) } => robot::import(&args, out),
        Verb::Robot { what: RobotVerb::Servos(args) } => servos::servos(&args, out),
        Verb::Fk(args) => batch::fk(&described_arm(&args)?, batch::open(&args.input)?, out),
        Verb::Ik(args) => {
            let chain = described_arm(&args)?.chain()?;
            batch::ik(&chain, batch::open(&args.input)?, out)
        }
    }
}

fn described_arm(args: &ArmArgs) -> Result<DescribedArm, Failure> {
    DescribedArm::load(args.robot.as_deref(), &args.which)
}

//! The command surface: every verb, its arguments and their help.

use clap::{Parser, Subcommand};
use service::group::{ENV_GROUP, GroupName};

mod arm;
mod batch;
mod group;
mod study;
mod talk;

pub use arm::{AnyLimbArg, ArmPlotArgs, ArmVerb, ArmVerbArgs};
pub use batch::{
    ArmArgs, BeliefArgs, ExportArgs, Exported, GroundArgs, InputArgs, LanguageArg, LimbArg,
    ModeArg, PlanArgs, ProblemArgs, WhichArm,
};
pub use group::{
    CheckArgs, ConfigArgs, DownArgs, LogsArgs, ReloadArgs, RestartArgs, ServiceArgs, SwapArgs,
    UpArgs, WaitFor,
};
pub use study::{ALL as STUDY_ALL, Preset, ReportArgs, StudyArgs, StudyVerb};
pub use talk::{AwaitArgs, Awaited, ChatArgs, CompletionsArgs, JournalArgs, ListenArgs};
pub use talk::{MotionArgs, PointArgs, SayArgs, TalkArgs, WatchArgs};

/// A robot that asks which one you mean before it fetches it.
///
/// A group of services hears you, works out which object you want, asks when
/// it is worth asking, and fetches it. `whichone chat` is the quickest way to try it.
#[derive(Debug, Parser)]
#[command(
    verbatim_doc_comment,
    name = "whichone",
    version,
    subcommand_required = true,
    arg_required_else_help = true,
    after_help = EXIT_CODES
)]
pub struct Cli {
    /// The group that is meant: each name is a robot of its own.
    #[arg(
        long,
        global = true,
        env = ENV_GROUP,
        hide_env_values = true,
        value_name = "NAME",
        default_value = GroupName::DEFAULT
    )]
    pub group: GroupName,
    /// Print JSON in place of text for people.
    #[arg(long, global = true)]
    pub json: bool,
    /// What to do.
    #[command(subcommand)]
    pub verb: Verb,
}

const EXIT_CODES: &str = "\
Exit codes: 0 done; 1 not reached; 64 called wrongly; 70 an invariant is broken; 74 a file cannot
be read or written; 78 the configuration is wrong.";

/// What the program does.
#[derive(Debug, Subcommand)]
pub enum Verb {
    /// Start the group and stay, until Ctrl-C or `whichone down`.
    Up(UpArgs),
    /// Stop the group in order, and report what did not end by itself.
    Down(DownArgs),
    /// Show what the group does.
    ///
    /// The exit code is 0 if every service that is wanted up is ready, else 1.
    Status,
    /// Start a service, or lift a hold on it, and wait until it is ready.
    Start(ServiceArgs),
    /// Stop a service and wait for its end.
    Stop(ServiceArgs),
    /// Stop a service, start it again, and wait until it is ready.
    Restart(RestartArgs),
    /// Stop a service and keep it from running until it is released.
    Hold(ServiceArgs),
    /// Let a held service run again.
    Release(ServiceArgs),
    /// Show what the services log.
    Logs(LogsArgs),
    /// Read the configuration anew and restart the services that it concerns.
    Reload(ReloadArgs),
    /// Check a configuration: tell every problem, or what would run.
    Check(CheckArgs),
    /// Replace a service's program while the dialogue goes on.
    ///
    /// The old one comes back if the new one does not become ready.
    Swap(SwapArgs),
    /// Say something to the robot.
    Say(SayArgs),
    /// Point at a place, as the person whom the robot sees.
    ///
    /// Metres in frame `base` of the robot: x forward, y left, z up. Taken where
    /// `dialogue.gesture.enabled` is set.
    Point(PointArgs),
    /// Let the robot listen to a WAV file.
    Listen(ListenArgs),
    /// Talk to the robot through the microphone of its computer.
    ///
    /// The robot falls silent and listens until you have paused, and what it understood is printed.
    /// Taken where `speech.microphone.mode` is not `off`.
    Talk(TalkArgs),
    /// See what the robot believes, asks and does, live.
    Watch(WatchArgs),
    /// Talk to the robot in this terminal; starts a group if none runs.
    Chat(ChatArgs),
    /// Wait for an outcome and print it.
    Await(AwaitArgs),
    /// Stop the arm at once, and keep it stopped.
    StopMotion(MotionArgs),
    /// Let the arm move again.
    ResumeMotion(MotionArgs),
    /// Show what a service has recorded, or check it.
    Journal(JournalArgs),
    /// Print a completion script for a shell.
    Completions(CompletionsArgs),
    /// Look for what is missing on this machine, and tell the cure.
    ///
    /// It looks at programs, the configuration, folders, shared memory, what killed groups have
    /// left, the recogniser, the voice and the microphone.
    Doctor(ConfigArgs),
    /// Read test cases, one JSON object a line, and print the belief after each.
    Belief(BeliefArgs),
    /// Read utterances, one JSON object a line, and print what each says about the scene.
    Ground(GroundArgs),
    /// Read beliefs, one JSON object a line, and print the robot's next action for each.
    Plan(PlanArgs),
    /// Print a scene's decision problem for other programs.
    Export(ExportArgs),
    /// Compare the policies: with simulated people, or report what real ones have given.
    ///
    /// With simulated people it prints, per policy and kind of people, how often the wanted object is brought, with how
    /// many questions, in how many seconds, and what that is worth, each with its 95 % interval.
    /// The same seed gives the same table, byte for byte, on any number of threads.
    Study(StudyArgs),
    /// See what the arm would do, without a group.
    Arm(ArmVerbArgs),
    /// Read joint positions, one JSON object a line, and print the pose of every link.
    Fk(ArmArgs),
    /// Read poses of an arm's last link, one JSON object a line, and print joint positions.
    Ik(ArmArgs),
}

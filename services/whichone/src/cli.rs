//! The command surface: every verb, its arguments and their help.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::error::{ContextKind, ContextValue};
use clap::{Args, Command, CommandFactory, FromArgMatches, Parser, Subcommand};
use clap_complete::Shell;
use diagnostics::nearest;
use service::group::{ENV_GROUP, GroupName};

mod group;
mod headings;
mod other_program;
mod people;
mod talk;

pub use command_line::args::ConfigArgs;
pub use group::{
    ConsoleArgs, DownArgs, ReloadArgs, RestartArgs, ServiceArgs, StopArgs, SwapArgs, UpArgs,
    WaitFor,
};
pub use other_program::OtherProgramArgs;
pub use people::{PeopleArgs, PeopleVerb};
pub use talk::{AwaitArgs, Awaited, ChatArgs, JournalAction, JournalArgs, ListenArgs};
pub use talk::{MotionArgs, PointArgs, SayArgs, TalkArgs, WatchArgs};

/// A robot that asks which one you mean before it fetches it.
///
/// A group of services understands your request, infers which object you want, asks when
/// a question is worth its time, and fetches the object. Try it with `whichone chat`.
#[derive(Debug, Parser)]
#[command(
    verbatim_doc_comment,
    name = "whichone",
    version,
    subcommand_required = true,
    arg_required_else_help = true,
    args_override_self = true,
    after_help = EXIT_CODES
)]
pub struct Cli {
    /// What every verb has.
    #[command(flatten)]
    pub common: Common,
    /// The verb.
    #[command(subcommand)]
    pub verb: Verb,
}

/// Arguments of every verb.
#[derive(Debug, Args)]
pub struct Common {
    /// Name of the group; each group is a robot of its own.
    #[arg(
        long,
        global = true,
        env = ENV_GROUP,
        hide_env_values = true,
        value_name = "NAME",
        default_value = GroupName::DEFAULT
    )]
    pub group: GroupName,
    /// Print JSON instead of text.
    #[arg(long, global = true)]
    pub json: bool,
}

/// Verbs for which `--group` is meaningless: it is accepted there, and not listed.
const WITHOUT_GROUP: [&str; 14] = [
    "check",
    "licences",
    "conform",
    "init",
    "scene",
    "completions",
    "complete",
    "man",
    "belief",
    "ground",
    "plan",
    "arm",
    "fk",
    "ik",
];

impl Cli {
    /// Returns the definition of the command line, from which help and completions are made.
    pub fn definition() -> Command {
        let command = Self::command();
        let group = command.get_arguments().find(|argument| argument.get_id() == "group");
        let listed = group.expect("an argument of every verb").clone();
        let command = command.mut_subcommands(|verb| match verb.get_name() {
            // The results of a study with people are a group's.
            "study" => verb
                .arg(listed.clone().hide(true))
                .mut_subcommands(|report| report.arg(listed.clone())),
            // So are recordings, journals and flights.
            "export" => verb
                .arg(listed.clone().hide(true))
                .mut_subcommand("mcap", |mcap| mcap.arg(listed.clone())),
            name if WITHOUT_GROUP.contains(&name) => verb.arg(listed.clone().hide(true)),
            _ => verb,
        });
        headings::with_headings(command)
    }

    /// Parses a command line, program name first.
    ///
    /// # Errors
    /// A usage error, or a request for help or the version.
    pub fn parse_line(line: impl IntoIterator<Item = OsString>) -> Result<Self, clap::Error> {
        let line: Vec<OsString> = line.into_iter().collect();
        let mut definition = Self::definition();
        let matches = definition.try_get_matches_from_mut(&line);
        let matches = matches.map_err(|error| with_nearest_verb(error, &line, &definition))?;
        Self::from_arg_matches(&matches).map_err(|error| error.format(&mut definition))
    }
}

/// Suggests the verb that differs least from an unknown one: clap's own measure prefers `swap` to `say` for `sya`.
fn with_nearest_verb(
    mut error: clap::Error,
    line: &[OsString],
    definition: &Command,
) -> clap::Error {
    let is_verb =
        |word: &OsString| definition.get_subcommands().any(|verb| verb.get_name() == word);
    let Some(ContextValue::String(wrong)) = error.get(ContextKind::InvalidSubcommand) else {
        return error;
    };
    let verbs = definition.get_subcommands().map(Command::get_name);
    // An unknown action of a known verb is none of these.
    if let Some(nearest) = nearest(wrong, verbs).filter(|_| !line.iter().any(is_verb)) {
        let nearest = ContextValue::Strings(vec![nearest.to_owned()]);
        error.insert(ContextKind::SuggestedSubcommand, nearest);
    }
    error
}

const EXIT_CODES: &str = "\
Exit codes: 0 success; 1 goal not reached; 64 usage error; 70 broken invariant; 74 storage error;
78 configuration error.";

/// Verbs of the program.
#[derive(Debug, Subcommand)]
pub enum Verb {
    /// Start the group and run it until Ctrl-C or `whichone down`.
    Up(UpArgs),
    /// Stop the group in order and report processes that had to be killed.
    Down(DownArgs),
    /// Show the state of the group and its services.
    ///
    /// The exit code is 0 if every service that should run is ready and short of nothing, else 1.
    Status,
    /// Start a service or release its hold, and wait until it is ready.
    Start(ServiceArgs),
    /// Stop a service and wait for its end; without a name, stop the arm's motion.
    Stop(StopArgs),
    /// Stop a service, start it again, and wait until it is ready.
    Restart(RestartArgs),
    /// Stop a service and keep it stopped until it is released.
    Hold(ServiceArgs),
    /// Let a held service run again.
    Release(ServiceArgs),
    /// Print the link to the console's page, with the token that lets you in.
    Console(ConsoleArgs),
    /// Make, list or revoke tokens with which programs talk to the robot over HTTP (docs/http.md).
    Token(http_api::verb::TokenArgs),
    /// Show the logs of the services.
    Logs(bug_report::LogsArgs),
    /// Reload the configuration and restart the affected services.
    Reload(ReloadArgs),
    /// Check a configuration: list every problem, or the services that would run.
    Check(laboratory::args::CheckArgs),
    /// Write the shipped configuration into a folder, to be edited: each key is explained there.
    ///
    /// A configuration is looked for in this order: `--config`, `$WHICHONE_CONFIG`, `./config`, `config` beside
    /// the program or above it, `~/.config/whichone`, `/etc/whichone`, and last the shipped one, which is
    /// built in.
    Init {
        /// The folder, which is created. Files that are there are not replaced.
        #[arg(value_name = "DIR")]
        folder: PathBuf,
    },
    /// Write, show, check or complete a scene file.
    Scene {
        /// Action.
        #[command(subcommand)]
        what: laboratory::args::SceneVerb,
    },
    /// Replace the program of a service while the dialogue continues.
    ///
    /// Rolls back to the old program if the new one does not become ready.
    Swap(SwapArgs),
    /// Test a service of your own against the contract, in a group of its own.
    ///
    /// Prints a line for each rule: readiness, heartbeats, identity, topics, messages that make no sense,
    /// restart, end; for a grounder also its answers, and their time. The exit code is 0 if every rule
    /// holds. Nothing of it touches a running group.
    Conform(laboratory::args::ConformArgs),
    /// Say something to the robot.
    Say(SayArgs),
    /// Point at a place, as the user in front of the robot.
    ///
    /// Metres in frame `base` of the robot: x forward, y left, z up. Requires
    /// `dialogue.gesture.enabled`.
    Point(PointArgs),
    /// List or change the objects on the table, where they come from perception.
    Objects(detections::args::ObjectsArgs),
    /// List, export or forget what was learned about people who gave their name.
    People(PeopleArgs),
    /// Play a WAV file to the robot's speech recogniser.
    Listen(ListenArgs),
    /// Talk to the robot through the microphone of its computer.
    ///
    /// The robot stops speaking, listens until you pause, and prints the recognised text. Requires
    /// `speech.microphone.mode` other than `off`.
    Talk(TalkArgs),
    /// Show the belief, the dialogue, the arm and the services, live.
    ///
    /// Keys: q quits, s, space and Esc stop the arm's motion, r and the typed word `resume` release the stop, t types
    /// to the robot. Ctrl-S stops motion also while you type.
    Watch(WatchArgs),
    /// Talk to the robot in this terminal; starts a group if none is running.
    Chat(ChatArgs),
    /// Wait for the outcome of an interaction and print it.
    Await(AwaitArgs),
    /// Stop the arm at once and latch the stop.
    #[command(visible_alias = "halt")]
    StopMotion(MotionArgs),
    /// Release the motion stop.
    ResumeMotion(MotionArgs),
    /// Show a robot elsewhere as a group of this machine, make keys, run the router.
    ///
    /// `whichone link --help` lists the arguments. Requires the program whichone-link (docs/remote.md).
    #[command(disable_help_flag = true)]
    Link(OtherProgramArgs),
    /// List the robots that are connected to the router.
    ///
    /// Requires the program whichone-link (docs/remote.md).
    #[command(disable_help_flag = true)]
    Fleet(OtherProgramArgs),
    /// Serve the pages of many robots under one address, with people's rights and an audit.
    ///
    /// `whichone gateway --help` lists the arguments (docs/fleet.md).
    #[command(disable_help_flag = true)]
    Gateway(OtherProgramArgs),
    /// Have something happen to the simulated Baxter, or to the objects on its table.
    ///
    /// `whichone baxter --help` lists the arguments (docs/baxter.md).
    #[command(disable_help_flag = true)]
    Baxter(OtherProgramArgs),
    /// Start or stop the recorder, list its recordings, or open one.
    Record {
        /// Action.
        #[command(subcommand)]
        what: laboratory::args::RecordVerb,
    },
    /// Replay what the services were given, and compare what they state with what they stated.
    ///
    /// The exit code is 0 if every record and every output is as recorded, and 70 at the first one that is
    /// not: it is shown with its pass, time and field, and with the events before it. With --what-if, the
    /// decisions that differ are listed instead.
    Replay(laboratory::args::ReplayArgs),
    /// List, verify or set aside the journals.
    Journal(JournalArgs),
    /// Print a completion script for a shell.
    ///
    /// It completes verbs and options; in bash, zsh and fish also the names of groups, services, scenes,
    /// profiles, settings and objects, as the running group or the configuration has them.
    Completions {
        /// The shell.
        #[arg(value_enum)]
        shell: Shell,
    },
    /// Print the names that the last word of a command line may be, for those scripts.
    #[command(hide = true)]
    Complete {
        /// The line so far, the word that is being written last.
        #[arg(last = true, required = true)]
        line: Vec<String>,
    },
    /// Write pages for `man`, one per verb.
    #[command(hide = true)]
    Man {
        /// The folder of the pages, which is created.
        #[arg(value_name = "DIR")]
        folder: PathBuf,
    },
    /// Check this machine for missing dependencies and suggest fixes.
    ///
    /// Checks programs, configuration, folders, shared memory, leftovers of killed groups, the
    /// recogniser, the voice and the microphone.
    Doctor(ConfigArgs),
    /// Collect diagnostics for a maintainer in one archive: version, machine, configuration, logs, journals.
    ///
    /// Keys, passwords, tokens and people's words are left out; --with-words adds the words. The archive lists its
    /// contents and omissions. The group need not run.
    Report(bug_report::ReportArgs),
    /// Print the licences of the libraries in this program.
    Licences,
    /// Verbs of the laboratory.
    #[command(flatten)]
    Laboratory(Box<laboratory::Verb>),
}

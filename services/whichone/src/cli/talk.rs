//! Arguments of the verbs that talk to the robot and look at it.

use std::path::PathBuf;
use std::time::Duration;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Subcommand, ValueEnum};
use command_line::args::seconds;
use messages::Service;
use vocabulary::{NotAPerson, PersonId};

use super::ConfigArgs;

/// Arguments of `say`.
#[derive(Debug, Args)]
pub struct SayArgs {
    /// Words of the utterance.
    #[arg(required = true, value_name = "TEXT")]
    pub text: Vec<String>,
    /// Age of the utterance's beginning, seconds: it was spoken and recognised elsewhere.
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub began_ago: Option<Duration>,
    /// Age of the utterance's end, seconds: it was spoken and recognised elsewhere.
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub ended_ago: Option<Duration>,
    /// An alternative hypothesis with its weight; TEXT itself has the rest of 1. May be repeated.
    #[arg(long = "or", value_name = "TEXT=WEIGHT", value_parser = alternative)]
    pub alternatives: Vec<(String, f64)>,
    /// Name of the person who speaks, at most 64 bytes: the robot learns from deliveries how they speak (`whichone people`).
    #[arg(long, value_name = "NAME", default_value = "", hide_default_value = true, value_parser = person)]
    pub from: PersonId,
    /// Number of the robot's line that the person was shown last, `prompt` of `status --json`: the words answer that
    /// question and no later one.
    #[arg(long, value_name = "PROMPT")]
    pub seen: Option<u64>,
    /// Confidence of each word of TEXT, 0 to 1, separated by commas.
    #[arg(long, value_name = "P,P,…", value_delimiter = ',')]
    pub confidence: Vec<f32>,
    /// Timeout for the receipt, and after words that stop the arm for its confirmation, seconds.
    #[arg(long, value_name = "S", default_value = "10", value_parser = seconds)]
    pub timeout: Duration,
}

/// Arguments of `point`.
#[derive(Debug, Args)]
pub struct PointArgs {
    /// Forward from the robot, metres.
    #[arg(value_name = "X", allow_negative_numbers = true)]
    pub x: f64,
    /// To the robot's left, metres.
    #[arg(value_name = "Y", allow_negative_numbers = true)]
    pub y: f64,
    /// Up from the robot's base, metres.
    #[arg(value_name = "Z", allow_negative_numbers = true)]
    pub z: f64,
    /// Words that accompany the gesture.
    #[arg(long, value_name = "TEXT", default_value = "", hide_default_value = true)]
    pub say: String,
    /// Timeout for the receipt, seconds.
    #[arg(long, value_name = "S", default_value = "10", value_parser = seconds)]
    pub timeout: Duration,
}

/// Arguments of `listen`.
#[derive(Debug, Args)]
pub struct ListenArgs {
    /// A WAV file with speech, or - for a stream on standard input: one channel of signed 16-bit
    /// samples, low byte first, at 16 kHz, with a WAV header or without.
    #[arg(value_name = "FILE.wav")]
    pub file: PathBuf,
    /// Stream the file in real time, like live speech.
    #[arg(long)]
    pub live: bool,
    /// The stream is free of the robot's own voice (a headset), so that speech interrupts the robot.
    /// Otherwise the stream is ignored while the robot speaks.
    #[arg(long)]
    pub echo_free: bool,
    /// Timeout for the result, seconds.
    #[arg(long, value_name = "S", default_value = "60", value_parser = seconds)]
    pub timeout: Duration,
}

/// Arguments of `talk`.
#[derive(Debug, Args)]
pub struct TalkArgs {
    /// Longest utterance, seconds.
    #[arg(long, value_name = "S", default_value = "10", value_parser = seconds)]
    pub seconds: Duration,
    /// Timeout for the result, seconds.
    #[arg(long, value_name = "S", default_value = "20", value_parser = seconds)]
    pub timeout: Duration,
}

/// Arguments of `watch`.
#[derive(Debug, Args)]
pub struct WatchArgs {
    /// Print one snapshot and exit.
    #[arg(long)]
    pub once: bool,
    /// Show text only, without keys; so it is, too, where input or output is no terminal.
    #[arg(long)]
    pub plain: bool,
}

/// Arguments of `chat`.
#[derive(Debug, Args)]
pub struct ChatArgs {
    /// The configuration of a group to be started.
    #[command(flatten)]
    pub config: ConfigArgs,
    /// Name of the person who speaks, at most 64 bytes: the robot learns from deliveries how they speak (`whichone people`).
    #[arg(long, value_name = "NAME", default_value = "", hide_default_value = true, value_parser = person)]
    pub from: PersonId,
    /// Keep a group running that was started for this chat.
    #[arg(long)]
    pub keep: bool,
}

/// Arguments of `await`.
#[derive(Debug, Args)]
pub struct AwaitArgs {
    /// The event to wait for.
    #[arg(value_enum)]
    pub what: Awaited,
    /// Timeout, seconds.
    #[arg(long, value_name = "S", default_value = "120", value_parser = seconds)]
    pub timeout: Duration,
    /// Answer the robot's questions truthfully, as a user who wants this object.
    #[arg(long, value_name = "OBJECT")]
    pub answer_as: Option<String>,
}

/// Condition to wait for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Awaited {
    /// The end of an interaction, or words that open none; printed at once if no earlier `await` has printed it.
    Pick,
}

/// Arguments of `stop-motion` and `resume-motion`.
#[derive(Debug, Args)]
pub struct MotionArgs {
    /// Timeout for the arm's confirmation, seconds. Without it a stop is repeated until the arm confirms it, and a
    /// release is given up after 5 s.
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub timeout: Option<Duration>,
}

/// Arguments of `journal`.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true)]
pub struct JournalArgs {
    /// What is done besides listing and verifying.
    #[command(subcommand)]
    pub action: Option<JournalAction>,
    /// Name of the service: the policy's journal is listed, and all are verified, where none is named.
    #[arg(value_parser = journaled())]
    pub service: Option<Service>,
    /// Verify the journals' invariants; exit code 70 if one is broken, 74 if one is lost or damaged.
    ///
    /// For the policy: every utterance is applied once and in order, every state is reproduced bit for
    /// bit from the one before, and no interaction delivers twice. For all together: they belong
    /// together, nothing was applied that was not accepted, and the arm took on what was ordered.
    #[arg(long)]
    pub verify: bool,
    /// First record to list; older files of the journal are read as far as needed.
    ///
    /// Without it the newest file is listed. A journal continues in a new file from 1 MiB on, and four
    /// older files are kept.
    #[arg(long, value_name = "RECORD", conflicts_with = "verify", requires = "service")]
    pub since: Option<u64>,
}

/// Change of the journals.
#[derive(Debug, Subcommand)]
pub enum JournalAction {
    /// Put journals that are lost or damaged aside, and let the others continue without them.
    ///
    /// The files are kept in a folder `set-aside-TIME`. At the next start what was in progress ends,
    /// utterances from before count no more, and numbers continue above all earlier ones. Without its
    /// own journal the arm starts with its motion stop latched. The group must be down.
    SetAside {
        /// Services whose journals are set aside.
        #[arg(required = true, value_name = "SERVICE", value_parser = journaled())]
        services: Vec<Service>,
    },
}

/// Parses the name of a service that keeps a journal.
fn journaled() -> impl TypedValueParser<Value = Service> {
    PossibleValuesParser::new(Service::JOURNALED.map(Service::name))
        .try_map(|name| Service::from_name(&name).ok_or("no such service"))
}

/// Reads the name of a person.
pub(crate) fn person(name: &str) -> Result<PersonId, NotAPerson> {
    PersonId::new(name)
}

/// A text with its weight.
fn alternative(text: &str) -> Result<(String, f64), String> {
    let wrong = || "expected TEXT=WEIGHT with a weight between 0 and 1, e.g. `the red one=0.3`";
    let (text, weight) = text.rsplit_once('=').ok_or_else(wrong)?;
    let weight: f64 = weight.trim().parse().map_err(|_| wrong())?;
    let is_share = weight > 0.0 && weight < 1.0;
    is_share.then(|| (text.to_owned(), weight)).ok_or_else(|| wrong().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alternatives_have_a_weight() {
        assert_eq!(alternative("a=b=0.25"), Ok(("a=b".to_owned(), 0.25)));
        for wrong in ["a", "a=", "a=0", "a=1", "a=-0.5", "a=NaN"] {
            assert!(alternative(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn timeouts_are_finite_and_not_negative() {
        assert_eq!(seconds("0.5"), Ok(Duration::from_millis(500)));
        assert_eq!(seconds("0"), Ok(Duration::ZERO));
        for wrong in ["", "-1", "soon", "NaN", "inf", "1e300"] {
            assert!(seconds(wrong).is_err(), "{wrong}");
        }
    }
}

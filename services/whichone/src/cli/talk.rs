//! Arguments of the verbs that talk to the robot and look at it.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, ValueEnum};
use clap_complete::Shell;

use super::ConfigArgs;

/// Arguments of `say`.
#[derive(Debug, Args)]
pub struct SayArgs {
    /// The words.
    #[arg(required = true, value_name = "TEXT")]
    pub text: Vec<String>,
    /// It was spoken, and began so many seconds ago; another recogniser made text of it.
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub began_ago: Option<Duration>,
    /// It was spoken, and ended so many seconds ago.
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub ended_ago: Option<Duration>,
    /// What may have been said instead, with its weight; TEXT itself has what is left of 1. Can be
    /// repeated.
    #[arg(long = "or", value_name = "TEXT=WEIGHT", value_parser = alternative)]
    pub alternatives: Vec<(String, f64)>,
    /// How sure each word of TEXT is, 0 to 1, with commas between.
    #[arg(long, value_name = "P,P,…", value_delimiter = ',')]
    pub confidence: Vec<f32>,
    /// Longest wait until it is accepted, seconds.
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
    /// What is said meanwhile.
    #[arg(long, value_name = "TEXT", default_value = "", hide_default_value = true)]
    pub say: String,
    /// Longest wait until it is accepted, seconds.
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
    /// Stream the file as fast as it was spoken, as if somebody spoke just now.
    #[arg(long)]
    pub live: bool,
    /// The stream does not hold the robot's own voice (a headset): whoever speaks interrupts the
    /// robot. Without it nothing is listened to while the robot speaks.
    #[arg(long)]
    pub echo_free: bool,
    /// Longest wait until it is recognised, seconds.
    #[arg(long, value_name = "S", default_value = "60", value_parser = seconds)]
    pub timeout: Duration,
}

/// Arguments of `talk`.
#[derive(Debug, Args)]
pub struct TalkArgs {
    /// Longest time until you have said it, seconds.
    #[arg(long, value_name = "S", default_value = "10", value_parser = seconds)]
    pub seconds: Duration,
    /// Longest wait for what was understood, seconds.
    #[arg(long, value_name = "S", default_value = "20", value_parser = seconds)]
    pub timeout: Duration,
}

/// Arguments of `watch`.
#[derive(Debug, Args)]
pub struct WatchArgs {
    /// Print one picture and end.
    #[arg(long)]
    pub once: bool,
}

/// Arguments of `chat`.
#[derive(Debug, Args)]
pub struct ChatArgs {
    /// The configuration, where a group has to be started.
    #[command(flatten)]
    pub config: ConfigArgs,
    /// Leave a group that was started for this chat running.
    #[arg(long)]
    pub keep: bool,
}

/// Arguments of `await`.
#[derive(Debug, Args)]
pub struct AwaitArgs {
    /// What to wait for.
    #[arg(value_enum)]
    pub what: Awaited,
    /// Longest wait, seconds.
    #[arg(long, value_name = "S", default_value = "120", value_parser = seconds)]
    pub timeout: Duration,
    /// Answer the robot's questions meanwhile, truthfully, as somebody who wants this object.
    #[arg(long, value_name = "OBJECT")]
    pub answer_as: Option<String>,
}

/// What can be waited for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Awaited {
    /// The end of an interaction; told at once if no earlier `await` has told of it.
    Pick,
}

/// Arguments of `stop-motion` and `resume-motion`.
#[derive(Debug, Args)]
pub struct MotionArgs {
    /// Longest wait until the arm confirms, seconds.
    #[arg(long, value_name = "S", default_value = "5", value_parser = seconds)]
    pub timeout: Duration,
}

/// Arguments of `journal`.
#[derive(Debug, Args)]
pub struct JournalArgs {
    /// Name of the service.
    #[arg(default_value = "policy", value_parser = ["speech", "policy", "arm"])]
    pub service: String,
    /// Check that it holds together; exit code 70 if not.
    ///
    /// Of the policy: every utterance applied once and in order, every state the one that follows
    /// from the one before it, bit for bit, and no interaction with two deliveries.
    #[arg(long)]
    pub verify: bool,
    /// The configuration that the journal was written with, where the group does not run.
    #[command(flatten)]
    pub config: ConfigArgs,
}

/// Arguments of `completions`.
#[derive(Debug, Args)]
pub struct CompletionsArgs {
    /// The shell.
    #[arg(value_enum)]
    pub shell: Shell,
}

/// A length of time that people wait.
pub(super) fn seconds(text: &str) -> Result<Duration, String> {
    let wrong = || "write seconds, e.g. 30".to_owned();
    let seconds: f64 = text.trim().parse().map_err(|_| wrong())?;
    let sensible = (0.0..=SECONDS_MAX).contains(&seconds);
    sensible.then(|| Duration::from_secs_f64(seconds)).ok_or_else(wrong)
}

/// A text with its weight.
fn alternative(text: &str) -> Result<(String, f64), String> {
    let wrong = || "write TEXT=WEIGHT with a weight between 0 and 1, e.g. `the red one=0.3`";
    let (text, weight) = text.rsplit_once('=').ok_or_else(wrong)?;
    let weight: f64 = weight.trim().parse().map_err(|_| wrong())?;
    let is_share = weight > 0.0 && weight < 1.0;
    is_share.then(|| (text.to_owned(), weight)).ok_or_else(|| wrong().to_owned())
}

/// A month: nobody waits longer, and sums of times stay far from overflow.
const SECONDS_MAX: f64 = 2_678_400.0;

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
    fn seconds_are_numbers_that_somebody_would_wait() {
        assert_eq!(seconds("0.5"), Ok(Duration::from_millis(500)));
        assert_eq!(seconds("0"), Ok(Duration::ZERO));
        for wrong in ["", "-1", "soon", "NaN", "inf", "1e300"] {
            assert!(seconds(wrong).is_err(), "{wrong}");
        }
    }
}

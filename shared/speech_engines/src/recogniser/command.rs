//! A recogniser that is a separate program, kept running: samples to its standard input, one line
//! of JSON back for each utterance. `docs/speech.md` describes the protocol.
//!
//! Invariant: an utterance waits at most for the deadline, an answer is never attributed to another
//! utterance, and the program's output is bounded. A program that exits or is late is killed and
//! restarted.

use std::io::{BufRead, BufReader, Read, Write};
use std::ops::Range;
use std::process::{Command as Process, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};
use serde::Deserialize;

use super::{N_BEST_MAX, RecogniseError, Recogniser, RecogniserUnavailable, Recognition};
use crate::audio::RATE_HZ;
use crate::child_process::ChildProcess;
use crate::language_model;
use messages::Hypothesis;

/// Program and limits.
#[derive(Clone, Debug, PartialEq)]
pub struct CommandOptions {
    /// Program of the recogniser, with arguments.
    pub command: Vec<String>,
    /// Time limit from the last sample to the answer; doubled for the first answer, because the
    /// program loads its model meanwhile.
    pub deadline: Duration,
}

impl CommandOptions {
    /// Returns options for the program with the default limits.
    pub fn new(command: Vec<String>) -> Self {
        Self { command, deadline: Duration::from_secs(10) }
    }
}

/// A recogniser behind a pipe.
pub struct Command {
    options: CommandOptions,
    program: Option<Program>,
}

const HELP: &str = "help: set speech.recogniser_command to a program and its arguments";
/// Longest line of an answer, bytes.
const LINE_MAX: u64 = 64 * 1024;

impl Command {
    /// Starts the program.
    ///
    /// # Errors
    /// If no program is named, or it cannot be started.
    pub fn open(options: CommandOptions) -> Result<Self, RecogniserUnavailable> {
        let program = Program::start(&options.command)
            .map_err(|reason| RecogniserUnavailable::Missing(format!("{reason}; {HELP}")))?;
        Ok(Self { options, program: Some(program) })
    }

    fn ask(&mut self, pcm: &[i16]) -> Result<Answer, String> {
        let (program, deadline) = match &mut self.program {
            Some(program) => (program, self.options.deadline),
            // A program that is started for this utterance loads its model first.
            none => {
                (none.insert(Program::start(&self.options.command)?), 2 * self.options.deadline)
            }
        };
        let line = program.ask(pcm, deadline)?;
        serde_json::from_str(&line).map_err(|error| format!("invalid answer: {error}"))
    }
}

impl Recogniser for Command {
    fn recognise(&mut self, pcm: &[i16], _: Range<usize>) -> Recognition {
        let answer = self.ask(pcm).map_err(|reason| {
            // Further output belongs to this utterance; the next one gets a new program.
            self.program = None;
            let name = self.options.command.first().cloned().unwrap_or_default();
            RecogniseError(format!("{name}: {reason}"))
        })?;
        match answer.error {
            Some(reason) => Err(RecogniseError(reason)),
            None => Ok(hypotheses(answer.hypotheses).into()),
        }
    }
}

/// A line of the program's output.
#[derive(Debug, Deserialize)]
struct Answer {
    #[serde(default)]
    hypotheses: Vec<AnswerHypothesis>,
    error: Option<String>,
}

#[derive(Debug, Deserialize)]
struct AnswerHypothesis {
    text: String,
    /// Relative to the others'.
    weight: Option<f64>,
    /// Confidence of each word of the text, 0 to 1.
    #[serde(default)]
    confidence: Vec<f32>,
}

/// Returns the answer as hypotheses, heaviest first, with weights that sum to one. Without word
/// confidences the weight of the hypothesis is used.
fn hypotheses(answers: Vec<AnswerHypothesis>) -> Vec<Hypothesis> {
    let weight =
        |answer: &AnswerHypothesis| answer.weight.filter(|w| w.is_finite()).unwrap_or(1.0).max(0.0);
    let total: f64 = answers.iter().map(weight).sum::<f64>().max(f64::MIN_POSITIVE);
    let hypothesis = |answer: AnswerHypothesis| {
        let share = weight(&answer) / total;
        let words = language_model::words(&answer.text);
        let given = answer.confidence.len() == words.len();
        let confidence =
            |n: usize| if given { answer.confidence[n].clamp(0.0, 1.0) } else { share as f32 };
        let words = words.into_iter().enumerate().map(|(n, word)| (word, confidence(n)));
        Hypothesis::of_words(words, share)
    };
    let mut found: Vec<Hypothesis> = answers.into_iter().map(hypothesis).collect();
    found.retain(|hypothesis| !hypothesis.text.is_empty());
    found.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    found.truncate(N_BEST_MAX);
    found
}

/// The running program.
struct Program {
    /// The program's process, killed on drop.
    _process: ChildProcess,
    samples: Sender<Vec<u8>>,
    lines: Receiver<std::io::Result<String>>,
}

impl Program {
    fn start(command: &[String]) -> Result<Self, String> {
        let [name, arguments @ ..] = command else {
            return Err("no program is configured (speech.recogniser_command)".to_owned());
        };
        let mut command = Process::new(name);
        command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut process = ChildProcess::spawn(command).map_err(|error| error.to_string())?;
        // Each end has a thread of its own, so that a program that neither reads nor writes blocks
        // nothing. The threads end with the pipes.
        let (samples, to_write) = bounded::<Vec<u8>>(1);
        let (read, lines) = bounded(1);
        let (stdin, stdout) = (process.child.stdin.take(), process.child.stdout.take());
        thread::spawn(move || {
            let Some(mut stdin) = stdin else { return };
            while let Ok(bytes) = to_write.recv() {
                if stdin.write_all(&bytes).and_then(|()| stdin.flush()).is_err() {
                    return;
                }
            }
        });
        thread::spawn(move || {
            let Some(mut stdout) = stdout.map(BufReader::new) else { return };
            loop {
                let line = next_line(&mut stdout);
                let over = !matches!(&line, Ok(line) if line.ends_with('\n'));
                if read.send(line).is_err() || over {
                    return;
                }
            }
        });
        Ok(Self { _process: process, samples, lines })
    }

    fn ask(&mut self, pcm: &[i16], deadline: Duration) -> Result<String, String> {
        let due = Instant::now() + deadline;
        if let Ok(line) = self.lines.try_recv() {
            let line = line.unwrap_or_default();
            return Err(match line.is_empty() {
                true => "it exited".to_owned(),
                false => format!("unexpected output: {}", line.trim()),
            });
        }
        let mut bytes = format!("{{\"rate\":{RATE_HZ},\"samples\":{}}}\n", pcm.len()).into_bytes();
        bytes.extend(pcm.iter().flat_map(|sample| sample.to_le_bytes()));
        self.samples.send_deadline(bytes, due).map_err(|_| "it exited".to_owned())?;
        match self.lines.recv_deadline(due) {
            Ok(Ok(line)) if line.ends_with('\n') => Ok(line),
            Ok(Ok(line)) if line.len() as u64 >= LINE_MAX => {
                Err(format!("expected an answer of at most {LINE_MAX} bytes"))
            }
            Ok(Ok(_)) | Err(RecvTimeoutError::Disconnected) => {
                Err("it exited without an answer".to_owned())
            }
            Ok(Err(error)) => Err(format!("the answer cannot be read: {error}")),
            Err(RecvTimeoutError::Timeout) => Err(format!("no answer within {deadline:?}")),
        }
    }
}

/// Reads a line; without its end if the program exited or the line is too long.
fn next_line(from: &mut impl BufRead) -> std::io::Result<String> {
    let mut line = String::new();
    from.take(LINE_MAX).read_line(&mut line)?;
    Ok(line)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Starts a shell that reads an utterance whole, then runs `answer`; `$samples` is its length.
    fn shell(answer: &str) -> Command {
        let script = format!(
            "while read -r head; do samples=${{head##*:}}; samples=${{samples%\\}}}}; \
             head -c $((2 * samples)) >/dev/null; {answer}; done"
        );
        let command = ["bash", "-c", &script].map(str::to_owned).into();
        // A limit for the tests that wait for it; the others need far less.
        let deadline = Duration::from_secs(20);
        Command::open(CommandOptions { deadline, ..CommandOptions::new(command) }).unwrap()
    }

    fn recognise(command: &mut Command, samples: usize) -> Result<Vec<Hypothesis>, RecogniseError> {
        command.recognise(&vec![1; samples], 0..samples).map(|view| view.hypotheses)
    }

    #[test]
    fn command_recogniser_answers_each_utterance_with_one_program() {
        let mut program = shell(
            r#"n=$((n + 1)); echo "{\"hypotheses\": [{\"text\": \"no\", \"weight\": 1}, {\"text\": \"Yes, number $n of $samples\", \"weight\": 3}]}""#,
        );
        for (n, samples) in [(1, 100), (2, 40_000), (3, 0)] {
            let found = recognise(&mut program, samples).unwrap();
            assert_eq!(found[0].text, format!("yes number {n} of {samples}"));
            assert_eq!((found[0].weight, found[1].weight), (0.75, 0.25));
            assert_eq!(
                (found[1].text.as_str(), &found[1].word_confidence[..]),
                ("no", &[0.25][..])
            );
        }
    }

    #[test]
    fn command_recogniser_uses_word_confidences_that_fit() {
        for (text, confidence, expected) in [
            ("The WHITE one", &[0.5, 2.0, 0.9][..], Some(&[0.5, 1.0, 0.9][..])),
            ("The WHITE one", &[0.5], Some(&[1.0, 1.0, 1.0])),
            (" ", &[], None),
        ] {
            let (text, confidence) = (text.to_owned(), confidence.to_vec());
            let found = hypotheses(vec![AnswerHypothesis { text, weight: None, confidence }]);
            assert_eq!(found.first().map(|h| &h.word_confidence[..]), expected);
        }
    }

    #[test]
    fn command_recogniser_restarts_a_program_that_exits() {
        let mut program = shell("[ $samples = 1 ] && exit 3; echo '{\"hypotheses\": []}'");
        assert_eq!(recognise(&mut program, 2), Ok(Vec::new()));
        let error = recognise(&mut program, 1).unwrap_err().to_string();
        assert!(error.contains("exited without an answer"), "{error}");
        assert_eq!(recognise(&mut program, 2), Ok(Vec::new()));
    }

    #[test]
    fn command_recogniser_reports_errors_invalid_and_late_answers() {
        for (answer, expected) in [
            ("echo '{\"error\": \"no model\"}'", "no model"),
            ("echo hello", "bash: invalid answer"),
            ("head -c 100000 /dev/zero | tr '\\0' x; echo", "at most 65536 bytes"),
        ] {
            let error = recognise(&mut shell(answer), 1).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
        let mut late = shell("read -r -t 600 never; echo '{\"hypotheses\": []}'");
        late.options.deadline = Duration::from_millis(50);
        let error = recognise(&mut late, 1).unwrap_err().to_string();
        assert!(error.contains("no answer within 50ms"), "{error}");
        for (command, expected) in [
            (vec!["no-such-program".to_owned()], "no-such-program"),
            (vec![], "recogniser_command"),
        ] {
            let error = Command::open(CommandOptions::new(command)).err().unwrap().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}

//! A recogniser that is a program of its own, kept running: samples to its standard input, one line
//! of JSON back for each utterance. The protocol stands in `docs/speech.md`.
//!
//! Invariant: no utterance is waited for longer than the deadline, no answer is taken for that of
//! another utterance, and what the program writes is bounded. A program that dies or is late is
//! ended and started anew.

use std::io::{BufRead, BufReader, Read, Write};
use std::ops::Range;
use std::process::{Child, Command as Process, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};
use serde::Deserialize;

use super::{Hypothesis, RecogniseError, Recogniser, RecogniserUnavailable};
use crate::devices::audio::RATE_HZ;
use crate::devices::language_model;

/// Which program, and how long it may take.
#[derive(Clone, Debug, PartialEq)]
pub struct CommandOptions {
    /// The program and its arguments.
    pub command: Vec<String>,
    /// From the last sample to the answer at most; the first answer may take as long again, since
    /// the program loads its model meanwhile.
    pub deadline: Duration,
    /// Hypotheses that are taken of an answer.
    pub n_best_max: usize,
}

impl CommandOptions {
    /// The program with the usual limits.
    pub fn new(command: Vec<String>) -> Self {
        Self { command, deadline: Duration::from_secs(10), n_best_max: 5 }
    }
}

/// A recogniser behind a pipe.
pub struct Command {
    options: CommandOptions,
    program: Option<Program>,
}

/// Longest line of an answer, bytes.
const LINE_MAX: u64 = 64 * 1024;

impl Command {
    /// Starts the program.
    ///
    /// # Errors
    /// If no program is named, or the system does not start it.
    pub fn open(options: CommandOptions) -> Result<Self, RecogniserUnavailable> {
        let program = Program::start(&options.command)
            .map_err(|reason| RecogniserUnavailable::Command { reason })?;
        Ok(Self { options, program: Some(program) })
    }

    fn ask(&mut self, pcm: &[i16]) -> Result<Answer, String> {
        let (program, deadline) = match &mut self.program {
            Some(program) => (program, self.options.deadline),
            // A program that was started for this utterance loads its model first.
            none => {
                (none.insert(Program::start(&self.options.command)?), 2 * self.options.deadline)
            }
        };
        let line = program.ask(pcm, deadline)?;
        serde_json::from_str(&line)
            .map_err(|error| format!("its answer is not understood: {error}"))
    }
}

impl Recogniser for Command {
    fn recognise(
        &mut self,
        pcm: &[i16],
        _: Range<usize>,
    ) -> Result<Vec<Hypothesis>, RecogniseError> {
        let answer = self.ask(pcm).map_err(|reason| {
            // Whatever it still says belongs to this utterance; the next one gets a new program.
            self.program = None;
            let name = self.options.command.first().cloned().unwrap_or_default();
            RecogniseError::Told { reason: format!("{name}: {reason}") }
        })?;
        match answer.error {
            Some(reason) => Err(RecogniseError::Told { reason }),
            None => Ok(hypotheses(answer.hypotheses, self.options.n_best_max)),
        }
    }
}

/// A line of the program's.
#[derive(Debug, Deserialize)]
struct Answer {
    #[serde(default)]
    hypotheses: Vec<Told>,
    error: Option<String>,
}

#[derive(Debug, Deserialize)]
struct Told {
    text: String,
    /// Relative to the others'.
    weight: Option<f32>,
    /// Of each word of the text, 0 to 1.
    #[serde(default)]
    confidence: Vec<f32>,
}

/// The answer as hypotheses, heaviest first, with weights that sum to one. A word of which nothing
/// is said is as sure as its hypothesis.
fn hypotheses(told: Vec<Told>, at_most: usize) -> Vec<Hypothesis> {
    let weight = |told: &Told| told.weight.filter(|w| w.is_finite()).unwrap_or(1.0).max(0.0);
    let total: f32 = told.iter().map(weight).sum::<f32>().max(f32::MIN_POSITIVE);
    let one = |told: Told| {
        let share = weight(&told) / total;
        let words = language_model::words(&told.text);
        let aligned = told.confidence.len() == words.len();
        let sure = |n: usize| if aligned { told.confidence[n].clamp(0.0, 1.0) } else { share };
        let words: Vec<_> = words.into_iter().enumerate().map(|(n, w)| (w, sure(n))).collect();
        let text = words.iter().map(|(word, _)| word.as_str()).collect::<Vec<_>>().join(" ");
        Hypothesis { text, confidence: share, words }
    };
    let mut found: Vec<Hypothesis> = told.into_iter().map(one).collect();
    found.retain(|hypothesis| !hypothesis.text.is_empty());
    found.sort_by(|a, b| b.confidence.total_cmp(&a.confidence));
    found.truncate(at_most);
    found
}

/// The running program; dropping it kills and reaps it.
struct Program {
    child: Child,
    samples: Sender<Vec<u8>>,
    lines: Receiver<std::io::Result<String>>,
}

impl Program {
    fn start(command: &[String]) -> Result<Self, String> {
        let [name, arguments @ ..] = command else {
            return Err("no program is named (speech.recogniser_command)".to_owned());
        };
        let mut process = Process::new(name);
        process.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = process.spawn().map_err(|e| format!("{name} does not start: {e}"))?;
        // Both ends have a thread of their own, so that a program that neither reads nor writes
        // holds up nothing. They end with the pipes.
        let (samples, to_write) = bounded::<Vec<u8>>(1);
        let (read, lines) = bounded(1);
        let (stdin, stdout) = (child.stdin.take(), child.stdout.take());
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
        Ok(Self { child, samples, lines })
    }

    fn ask(&mut self, pcm: &[i16], deadline: Duration) -> Result<String, String> {
        let due = Instant::now() + deadline;
        if let Ok(line) = self.lines.try_recv() {
            let line = line.unwrap_or_default();
            return Err(match line.is_empty() {
                true => "it has ended".to_owned(),
                false => format!("it spoke without being asked: {}", line.trim()),
            });
        }
        let mut bytes = format!("{{\"rate\":{RATE_HZ},\"samples\":{}}}\n", pcm.len()).into_bytes();
        bytes.extend(pcm.iter().flat_map(|sample| sample.to_le_bytes()));
        self.samples.send_deadline(bytes, due).map_err(|_| "it has ended".to_owned())?;
        match self.lines.recv_deadline(due) {
            Ok(Ok(line)) if line.ends_with('\n') => Ok(line),
            Ok(Ok(line)) if line.len() as u64 >= LINE_MAX => {
                Err(format!("its answer is longer than {LINE_MAX} bytes"))
            }
            Ok(Ok(_)) | Err(RecvTimeoutError::Disconnected) => {
                Err("it has ended without an answer".to_owned())
            }
            Ok(Err(error)) => Err(format!("its answer cannot be read: {error}")),
            Err(RecvTimeoutError::Timeout) => Err(format!("no answer within {deadline:?}")),
        }
    }
}

/// A line with its end, or without where the program ended or the line is too long.
fn next_line(from: &mut impl BufRead) -> std::io::Result<String> {
    let mut line = String::new();
    from.take(LINE_MAX).read_line(&mut line)?;
    Ok(line)
}

impl Drop for Program {
    fn drop(&mut self) {
        // Both fail only if it has ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A shell that reads each utterance whole, then does as told; `$samples` is its length.
    fn shell(answer: &str) -> Command {
        let script = format!(
            "while read -r head; do samples=${{head##*:}}; samples=${{samples%\\}}}}; \
             head -c $((2 * samples)) >/dev/null; {answer}; done"
        );
        let command = ["bash", "-c", &script].map(str::to_owned).into();
        // A limit for the tests that wait for it; the others need far less.
        Command::open(CommandOptions {
            deadline: Duration::from_secs(20),
            ..CommandOptions::new(command)
        })
        .unwrap()
    }

    fn hear(command: &mut Command, samples: usize) -> Result<Vec<Hypothesis>, RecogniseError> {
        command.recognise(&vec![1; samples], 0..samples)
    }

    fn reason(heard: Result<Vec<Hypothesis>, RecogniseError>) -> String {
        heard.unwrap_err().to_string()
    }

    #[test]
    fn each_utterance_gets_its_answer_from_one_program() {
        let mut ear = shell(
            r#"n=$((n + 1)); echo "{\"hypotheses\": [{\"text\": \"no\", \"weight\": 1}, {\"text\": \"Yes, number $n of $samples\", \"weight\": 3}]}""#,
        );
        for (n, samples) in [(1, 100), (2, 40_000), (3, 0)] {
            let heard = hear(&mut ear, samples).unwrap();
            assert_eq!(heard[0].text, format!("yes number {n} of {samples}"));
            assert_eq!((heard[0].confidence, heard[1].confidence), (0.75, 0.25));
            assert_eq!(heard[1].words, [("no".to_owned(), 0.25)]);
        }
    }

    #[test]
    fn words_keep_their_confidence_where_it_fits() {
        let told = |confidence: &[f32]| Told {
            text: "The WHITE one".to_owned(),
            weight: None,
            confidence: confidence.to_vec(),
        };
        let sure =
            |told| hypotheses(vec![told], 5)[0].words.iter().map(|w| w.1).collect::<Vec<_>>();
        assert_eq!(sure(told(&[0.5, 2.0, 0.9])), [0.5, 1.0, 0.9]);
        assert_eq!(sure(told(&[0.5])), [1.0, 1.0, 1.0]);
        assert_eq!(hypotheses(vec![Told { text: " ".into(), ..told(&[]) }], 5), []);
    }

    #[test]
    fn a_program_that_dies_is_started_anew() {
        let mut ear = shell("[ $samples = 1 ] && exit 3; echo '{\"hypotheses\": []}'");
        assert_eq!(hear(&mut ear, 2), Ok(Vec::new()));
        assert!(reason(hear(&mut ear, 1)).contains("ended without an answer"));
        assert_eq!(hear(&mut ear, 2), Ok(Vec::new()));
    }

    #[test]
    fn what_it_complains_about_and_nonsense_are_told() {
        let mut ear = shell("echo '{\"error\": \"no model\"}'");
        assert!(reason(hear(&mut ear, 1)).contains("no model"));
        let mut ear = shell("echo hello");
        assert!(reason(hear(&mut ear, 1)).contains("bash: its answer is not understood"));
        let mut ear = shell("head -c 100000 /dev/zero | tr '\\0' x; echo");
        assert!(reason(hear(&mut ear, 1)).contains("longer than 65536 bytes"));
    }

    #[test]
    fn an_answer_that_comes_too_late_is_not_waited_for() {
        let mut ear = shell("read -r -t 600 never; echo '{\"hypotheses\": []}'");
        ear.options.deadline = Duration::from_millis(50);
        assert!(reason(hear(&mut ear, 1)).contains("no answer within 50ms"));
    }

    #[test]
    fn a_program_that_is_not_there_is_named() {
        for (command, told) in [
            (vec!["no-such-program".to_owned()], "no-such-program"),
            (vec![], "recogniser_command"),
        ] {
            let Err(error) = Command::open(CommandOptions::new(command)) else {
                panic!("it started")
            };
            assert!(error.to_string().contains(told), "{error}");
        }
    }
}

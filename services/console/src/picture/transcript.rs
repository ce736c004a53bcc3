//! Who said what, and what has happened: the latest lines, each under a number of its own.

use std::collections::{BTreeSet, VecDeque};

use messages::{Ended, Outcome, PresentationState, Presented, Receipt, ReceiptStatus, Source};
use scene::{ObjectId, Question, Scene, question_to_json};
use service::Time;
use service::status::ServiceStatus;

use super::line::{Line, Who};
use super::speech::Prompt;
use super::understood::Understood;
use super::{Now, scene as places};
use crate::hub::board::LINES_MAX;
use crate::hub::ms;

/// Utterances that were understood before they were told to be accepted.
const EARLY_MAX: usize = 16;

/// The latest lines.
#[derive(Debug)]
pub struct Transcript {
    lines: VecDeque<Line>,
    next: u64,
    changed: BTreeSet<u64>,
    /// What was understood of utterances whose receipt has not come yet.
    early: VecDeque<(u64, Understood)>,
    /// The latest interaction whose end was told.
    ended: u64,
}

impl Transcript {
    /// Goes on with the lines of an earlier console; without any, numbers begin above those of every
    /// earlier transcript, as time has passed since.
    pub fn after(lines: Vec<Line>, unix_ms: u64) -> Self {
        let last = lines.iter().map(|line| line.id).max();
        Self {
            next: last.map_or(unix_ms.max(1), |last| last + 1),
            changed: lines.iter().map(|line| line.id).collect(),
            lines: lines.into(),
            early: VecDeque::new(),
            ended: 0,
        }
    }

    /// All lines that are kept.
    pub fn lines(&self) -> impl Iterator<Item = &Line> {
        self.lines.iter()
    }

    /// Lines that are new or have changed since this was asked last.
    pub fn take_changed(&mut self) -> Vec<Line> {
        let changed = std::mem::take(&mut self.changed);
        self.lines.iter().filter(|line| changed.contains(&line.id)).cloned().collect()
    }

    /// What became of somebody's words. Whether that is news.
    pub(super) fn receipt(&mut self, receipt: &Receipt, now: Now) -> bool {
        let text = receipt.note.as_str().unwrap_or_default();
        let spoken = receipt.snr_db > 0.0 || receipt.confidence < 1.0;
        let line = match ReceiptStatus::from_code(receipt.status) {
            Ok(ReceiptStatus::Accepted) => Line {
                seq: Some(receipt.seq),
                source: source(receipt).to_owned(),
                confidence: spoken.then_some(receipt.confidence),
                snr_db: (receipt.snr_db > 0.0).then_some(receipt.snr_db),
                ..self.blank(Who::Person, text, now)
            },
            Ok(ReceiptStatus::NotForMe) => Line {
                source: source(receipt).to_owned(),
                snr_db: (receipt.snr_db > 0.0).then_some(receipt.snr_db),
                ..self.blank(Who::Unmeant, text, now)
            },
            _ => return false,
        };
        let began = ms(Time(receipt.onset_ns));
        let line = Line { at_ms: if receipt.onset_ns > 0 { began } else { line.at_ms }, ..line };
        let is_known = self.lines.iter().any(|other| match line.seq {
            Some(_) => other.seq == line.seq,
            None => other.who == line.who && other.at_ms == line.at_ms,
        });
        if is_known {
            return false;
        }
        let seq = line.seq;
        self.push(line);
        if let Some(seq) = seq
            && let Some(at) = self.early.iter().position(|(early, _)| *early == seq)
            && let Some((_, understood)) = self.early.remove(at)
        {
            self.understood(seq, understood);
        }
        true
    }

    /// What an utterance was understood to say.
    pub(super) fn understood(&mut self, seq: u64, understood: Understood) {
        let Some(line) = self.lines.iter_mut().rfind(|line| line.seq == Some(seq)) else {
            if self.early.len() == EARLY_MAX {
                self.early.pop_front();
            }
            return self.early.push_back((seq, understood));
        };
        let Understood { meanings, answers } = understood;
        if line.understood != meanings || line.answers != answers {
            (line.understood, line.answers) = (meanings, answers);
            self.changed.insert(line.id);
        }
    }

    /// A line of the robot's. Whether that is news.
    pub(super) fn robot(
        &mut self,
        scene: &Scene,
        presented: &Presented,
        prompt: &Prompt,
        now: Now,
    ) -> bool {
        let said = (presented.prompt, presented.presentation);
        let has_begun =
            PresentationState::from_code(presented.state).is_ok_and(PresentationState::has_begun);
        let is_known = self.lines.iter().any(|line| line.said == Some(said));
        if is_known || !has_begun {
            return false;
        }
        let asks = prompt.question != Question::None
            && prompt.scene_key == scene.key()
            && scene.contains(prompt.question);
        let line = Line {
            at_ms: ms(Time(presented.started_ns)),
            said: Some(said),
            question: asks.then(|| question_to_json(scene, prompt.question)),
            ..self.blank(Who::Robot, &prompt.text, now)
        };
        self.push(line);
        true
    }

    /// An interaction has ended. Whether that is news.
    pub(super) fn ended(&mut self, scene: &Scene, ended: &Ended, now: Now) -> bool {
        let first_look = self.ended == 0;
        if ended.interaction.0 <= self.ended {
            return false;
        }
        self.ended = ended.interaction.0;
        // One that ended before this console looked is no news, nor one that it has told already.
        if first_look && self.lines.iter().any(|line| line.outcome.is_some()) {
            return false;
        }
        let object = ended.name.as_deref().map(|name| {
            let place = scene.object_named(name).map(ObjectId::index);
            place.and_then(|at| places::label(scene, at)).unwrap_or_else(|| name.to_owned())
        });
        let object = object.as_deref().unwrap_or("nothing");
        let what = match ended.outcome {
            Outcome::Delivered => format!("Handed over: {object}"),
            Outcome::Failed => format!("Could not fetch: {object}"),
            Outcome::Cancelled => "The request was withdrawn".to_owned(),
            Outcome::Abandoned => "Given up: nobody answered, or no question helped".to_owned(),
            Outcome::SceneChanged => {
                "The scene was changed, and nothing of the request was left".to_owned()
            }
            Outcome::NotHere => "The robot thinks that it is not here".to_owned(),
        };
        let questions = match ended.questions {
            1 => "1 question".to_owned(),
            n => format!("{n} questions"),
        };
        let text = format!("{what} ({questions}, {:.1} s)", ended.seconds);
        let outcome = serde_json::to_value(ended.outcome).ok();
        let outcome = outcome.and_then(|outcome| outcome.as_str().map(str::to_owned));
        let line = Line { outcome, ..self.blank(Who::System, &text, now) };
        self.push(line);
        true
    }

    /// The motion stop was latched or released.
    pub(super) fn motion(&mut self, stopped: bool, now: Now) {
        let text = if stopped { "The arm was stopped" } else { "The arm may move again" };
        self.tell(text, now);
    }

    /// A service was lost or is back.
    pub(super) fn service(&mut self, service: &ServiceStatus, is_back: bool, now: Now) {
        let name = &service.name;
        let exit = service.last_exit.as_ref();
        let how = exit.map(|exit| format!(" (it had ended with {})", exit.text));
        let text = match is_back {
            true => format!("{name} is back{}", how.unwrap_or_default()),
            false => format!("{name} is not there"),
        };
        self.tell(&text, now);
    }

    /// A line about what has happened.
    pub fn tell(&mut self, text: &str, now: Now) {
        let line = self.blank(Who::System, text, now);
        self.push(line);
    }

    fn blank(&self, who: Who, text: &str, now: Now) -> Line {
        let seconds = now.unix_ms / 1_000 % 86_400;
        let (hours, minutes) = (seconds / 3_600, seconds / 60 % 60);
        Line {
            id: self.next,
            at_ms: ms(now.at),
            unix_ms: now.unix_ms,
            clock: format!("{hours:02}:{minutes:02}:{:02}", seconds % 60),
            who,
            text: text.to_owned(),
            source: String::new(),
            seq: None,
            confidence: None,
            snr_db: None,
            understood: Vec::new(),
            answers: None,
            question: None,
            outcome: None,
            said: None,
        }
    }

    fn push(&mut self, line: Line) {
        self.next = line.id + 1;
        self.changed.insert(line.id);
        if self.lines.len() == LINES_MAX {
            self.lines.pop_front();
        }
        self.lines.push_back(line);
    }
}

/// How an utterance came.
fn source(receipt: &Receipt) -> &'static str {
    match Source::from_code(receipt.source) {
        Ok(Source::Text) => "typed",
        Ok(Source::Wav) => "file",
        // Pieces of a stream are not counted before it is over.
        Ok(Source::Microphone) if receipt.segments == 0 => "stream",
        Ok(Source::Microphone) => "microphone",
        Ok(Source::Browser) => "browser",
        Ok(Source::Gesture) => "gesture",
        Err(_) => "",
    }
}

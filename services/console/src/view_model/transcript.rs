//! The transcript: the latest lines of the dialogue, each under a number of its own.

use std::collections::{BTreeSet, VecDeque};

use messages::{Ended, Outcome, Presented, Receipt, ReceiptStatus, SecondState, Source};
use scene::Scene;
use scene::view::Labels;
use service::Time;
use service::bounded::push_bounded;
use service::status::ServiceStatus;
use service::view::{Speaker, Understood};

use super::line::{Line, Note, Recognisers};
use super::prompts::Prompt;
use crate::hub::board::LINES_MAX;
use crate::hub::ms;
use page_part::Now;

/// Utterances whose meaning has come before their receipt.
const EARLY_MAX: usize = 16;

#[derive(Debug)]
pub struct Transcript {
    lines: VecDeque<Line>,
    next: u64,
    changed: BTreeSet<u64>,
    /// Meanings of utterances whose receipt has not come yet.
    early: VecDeque<(u64, Understood)>,
    /// The latest interaction whose end was noted.
    ended: u64,
}

impl Transcript {
    /// Continues the lines of an earlier console. Without any, numbers begin above those of every
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

    pub fn lines(&self) -> impl Iterator<Item = &Line> {
        self.lines.iter()
    }

    /// Takes the lines that are new or have changed since the last call.
    pub fn take_changed(&mut self) -> Vec<Line> {
        let changed = std::mem::take(&mut self.changed);
        self.lines.iter().filter(|line| changed.contains(&line.id)).cloned().collect()
    }

    /// Takes in the receipt of an utterance; returns whether it is new.
    pub(super) fn on_receipt(&mut self, receipt: &Receipt, now: Now) -> bool {
        let text = receipt.note.as_str().unwrap_or_default();
        let spoken = receipt.snr_db > 0.0 || receipt.confidence < 1.0;
        let line = match receipt.status.get() {
            ReceiptStatus::Accepted => Line {
                seq: Some(receipt.seq),
                source: source(receipt).to_owned(),
                confidence: spoken.then_some(receipt.confidence),
                recognisers: recognisers(receipt),
                ..self.blank(Speaker::Person, text, now)
            },
            ReceiptStatus::NotForMe => Line {
                source: source(receipt).to_owned(),
                recognisers: recognisers(receipt),
                verdict: Some(receipt.verdict.get()),
                ..self.blank(Speaker::Unmeant, text, now)
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
            self.on_understood(seq, understood);
        }
        true
    }

    pub(super) fn on_understood(&mut self, seq: u64, understood: Understood) {
        let Some(line) = self.lines.iter_mut().rfind(|line| line.seq == Some(seq)) else {
            return push_bounded(&mut self.early, EARLY_MAX, (seq, understood));
        };
        let Understood { meanings, answers } = understood;
        if line.understood != meanings || line.answers != answers {
            (line.understood, line.answers) = (meanings, answers);
            self.changed.insert(line.id);
        }
    }

    /// Takes in a line of the robot; returns whether it is new.
    pub(super) fn on_presented(
        &mut self,
        presented: &Presented,
        prompt: &Prompt,
        now: Now,
    ) -> bool {
        let said = (presented.prompt, presented.presentation);
        let has_begun = presented.state.get().has_begun();
        let is_known = self.lines.iter().any(|line| line.said == Some(said));
        if is_known || !has_begun {
            return false;
        }
        let at_ms = ms(Time(presented.started_ns));
        let line = self.blank(Speaker::Robot, &prompt.text, now);
        self.push(Line { at_ms, said: Some(said), ..line });
        true
    }

    pub(super) fn on_end(&mut self, scene: &Scene, labels: &Labels, ended: &Ended, now: Now) {
        let is_first = self.ended == 0;
        if ended.interaction.0 <= self.ended {
            return;
        }
        self.ended = ended.interaction.0;
        // A pick that ended before this console, or that its predecessor noted, is not new.
        if is_first && self.lines.iter().any(|line| line.outcome.is_some()) {
            return;
        }
        let object = ended.name.as_deref().map(|name| {
            scene.object_named(name).map_or(name, |object| labels.unique(scene, object, name))
        });
        let note = Note::Ended {
            object: object.map(str::to_owned),
            questions: ended.questions,
            seconds: ended.seconds,
        };
        let object = object.unwrap_or("nothing");
        let what = match ended.outcome {
            Outcome::Delivered => format!("Handed over: {object}"),
            Outcome::Refused => format!("Refused: {object}"),
            Outcome::Failed => format!("Could not fetch: {object}"),
            Outcome::Cancelled => "The request was withdrawn".to_owned(),
            Outcome::Abandoned => "Given up: no answer came, or no question helped".to_owned(),
            Outcome::SceneChanged => {
                "The scene was changed, and none of the candidates is left".to_owned()
            }
            Outcome::NotHere => "The robot concluded that the object is not here".to_owned(),
        };
        let questions = scene::count(ended.questions, "question");
        let text = format!("{what} ({questions}, {:.1} s)", ended.seconds);
        let line = self.blank(Speaker::System, &text, now);
        self.push(Line { outcome: Some(ended.outcome), note: Some(note), ..line });
    }

    pub(super) fn on_motion_stop(&mut self, stopped: bool, now: Now) {
        let (text, note) = match stopped {
            true => ("The arm was stopped", Note::Stopped),
            false => ("The arm may move again", Note::Released),
        };
        self.note(text, note, now);
    }

    pub(super) fn on_service(&mut self, service: &ServiceStatus, is_back: bool, now: Now) {
        let name = service.name.clone();
        if !is_back {
            let text = format!("{name} is not running");
            return self.note(&text, Note::ServiceLost { service: name }, now);
        }
        let exit = service.last_exit.as_ref().map(|exit| exit.text.clone());
        let how = exit.as_ref().map(|exit| format!(" (previous run ended with {exit})"));
        let text = format!("{name} is back{}", how.unwrap_or_default());
        self.note(&text, Note::ServiceBack { service: name, exit }, now);
    }

    fn note(&mut self, text: &str, note: Note, now: Now) {
        let line = self.blank(Speaker::System, text, now);
        self.push(Line { note: Some(note), ..line });
    }

    fn blank(&self, who: Speaker, text: &str, now: Now) -> Line {
        Line {
            recognisers: None,
            verdict: None,
            id: self.next,
            at_ms: ms(now.at),
            unix_ms: now.unix_ms,
            who,
            text: text.to_owned(),
            source: String::new(),
            seq: None,
            confidence: None,
            understood: Vec::new(),
            answers: Vec::new(),
            outcome: None,
            note: None,
            said: None,
        }
    }

    fn push(&mut self, line: Line) {
        self.next = line.id + 1;
        self.changed.insert(line.id);
        push_bounded(&mut self.lines, LINES_MAX, line);
    }
}

/// Returns each recogniser's result, if two were asked.
fn recognisers(receipt: &Receipt) -> Option<Recognisers> {
    let text = |text: Result<&str, _>| text.unwrap_or_default().to_owned();
    let second = match receipt.second.get() {
        SecondState::NotAsked => return None,
        SecondState::Late => None,
        SecondState::Heard => Some(text(receipt.second_text.as_str())),
    };
    Some(Recognisers { first: text(receipt.first_text.as_str()), second })
}

fn source(receipt: &Receipt) -> &'static str {
    match receipt.source.get() {
        Source::Text => "typed",
        Source::Wav => "file",
        // Segments of a stream are not counted before it is over.
        Source::Microphone if receipt.segments == 0 => "stream",
        Source::Microphone => "microphone",
        Source::Browser => "browser",
        Source::Gesture => "gesture",
    }
}

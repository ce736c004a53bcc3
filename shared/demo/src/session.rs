//! One dialogue: the user's words and actions, and the robot's.

use dialogue::manager::{Cause, Manager, State, Utterance};
use dialogue::rendering;
use language::Reader;
use scene::view::Labels;
use scene::{Doubt, Question, Reading, Scene};
use vocabulary::ids::PromptId;
use vocabulary::time::Time;
use vocabulary::{ActKind, Interpretation, Presentation};

use crate::arm::Arm;
use crate::settings::{self, LANGUAGE, SetupError};
use crate::transcript::Transcript;
use crate::voice::Voice;

/// Longest utterance, characters; what follows is cut off.
const TEXT_CHARS_MAX: usize = 1_000;

/// A dialogue with the simulated robot in one scene. Times are the caller's, from 0 on.
#[allow(missing_debug_implementations, reason = "planners have none")]
pub struct Session {
    pub(crate) reader: Reader,
    pub(crate) manager: Manager,
    pub(crate) state: State,
    pub(crate) labels: Labels,
    pub(crate) voice: Voice,
    pub(crate) arm: Arm,
    pub(crate) transcript: Transcript,
    pub(crate) now: Time,
}

impl Session {
    /// Begins a dialogue. `unix_ms` is the time of day at time 0, milliseconds since 1970.
    ///
    /// # Errors
    /// A scene that the manager cannot decide about.
    pub fn new(scene: Scene, unix_ms: u64) -> Result<Self, SetupError> {
        let manager = settings::manager(scene.clone())?;
        let state = manager.first();
        Ok(Self {
            reader: Reader::new(&scene, LANGUAGE),
            labels: Labels::new(&scene),
            arm: Arm::new(&scene),
            manager,
            state,
            voice: Voice::default(),
            transcript: Transcript::new(unix_ms),
            // Time 0 stands for "never" in the state.
            now: Time(1),
        })
    }

    /// Hears what a user typed who was shown the prompt `seen` then, 0 for none.
    pub fn say(&mut self, text: &str, seen: u64) {
        let text: String = text.chars().take(TEXT_CHARS_MAX).collect();
        if language::is_stop(&text) {
            self.stop();
        }
        let utterance = self.read(&text, PromptId(seen));
        self.voice.interrupt(self.now);
        self.transcript.person(&text, self.now);
        self.apply(&Cause::Utterance(utterance));
        self.report_stop();
    }

    /// Latches the motion stop.
    pub fn stop(&mut self) {
        self.arm.stop(self.now);
        self.watch_arm();
    }

    /// Releases the motion stop; returns false if it is too young.
    pub fn resume(&mut self) -> bool {
        let is_released = self.arm.resume(self.now);
        self.watch_arm();
        is_released
    }

    /// Returns the scene.
    pub(crate) fn scene(&self) -> &Scene {
        self.manager.scene()
    }

    /// Reads an utterance as an answer to each question that it may answer, and to none.
    fn read(&self, text: &str, seen: PromptId) -> Utterance {
        let presentations = self.voice.answerable(seen);
        let of = |(answers, question): (Option<usize>, Question)| {
            let readings = self.reader.readings(text, &[], question).into_iter();
            readings.map(move |(weight, reading)| {
                let reading = Reading { doubt: as_in_messages(reading.doubt), ..reading };
                Interpretation { weight, answers, reading }
            })
        };
        let asked = presentations.iter().enumerate().map(|(at, put)| (Some(at), put.question));
        let interpretations = asked.chain([(None, Question::None)]).flat_map(of).collect();
        let newest = presentations.first().map_or(Question::None, |put| put.question);
        Utterance {
            seq: self.state.applied.next(),
            interpretations,
            presentations,
            typed: true,
            onset: self.now,
            end: self.now,
            accepted: self.now,
            unknown: self.reader.unknown_word(text, newest),
            ..Utterance::default()
        }
    }

    /// Advances the dialogue by a cause, and has its decision carried out.
    pub(crate) fn apply(&mut self, cause: &Cause) {
        let ended = self.state.ended.as_ref().map(|ended| ended.interaction);
        self.manager.step(&mut self.state, cause, self.now);
        if let Some(over) = self.state.ended.as_ref().filter(|it| Some(it.interaction) != ended) {
            self.transcript.ended(self.manager.scene(), &self.labels, over, self.now);
        }
        self.present();
        self.arm.on_act(&self.state.act);
    }

    /// Presents the line of the standing act.
    fn present(&mut self) {
        let act = &self.state.act;
        let is_answerable = !matches!(act.kind, ActKind::Wait | ActKind::Cancel);
        let question = match is_answerable {
            true => self.manager.answerable(&self.state),
            false => Question::None,
        };
        let text = match act.kind {
            ActKind::Wait => String::new(),
            _ => rendering::text(self.manager.scene(), act),
        };
        let line = Presentation {
            prompt: act.prompt,
            number: act.presentation,
            question,
            scene: self.state.scene_key,
            ..Presentation::default()
        };
        if self.voice.say(line, &text, self.now) {
            self.transcript.robot((line.prompt.0, line.number), &text, self.now);
        }
    }
}

/// Returns doubts in single precision, as messages between the services carry them: less decides ties of a planner.
fn as_in_messages(doubt: Doubt) -> Doubt {
    let single = |doubt: f64| f64::from(doubt as f32);
    let all = |doubts: Vec<f64>| doubts.into_iter().map(single).collect();
    Doubt { base: all(doubt.base), excluded: all(doubt.excluded), response: single(doubt.response) }
}

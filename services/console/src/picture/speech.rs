//! What the robot says and how it hears.

use std::collections::VecDeque;

use messages::{
    ActKind, EarState, Hearing, MicrophoneState, PresentationState, Presented, RobotAct,
};
use scene::Question;
use serde_json::{Value as Json, json};
use service::Time;

use crate::hub::ms;

/// Prompts whose words are remembered.
const PROMPTS_MAX: usize = 32;

/// The latest prompts and their words.
#[derive(Clone, Debug, Default)]
pub(super) struct Prompts(VecDeque<Prompt>);

/// Something that the robot says.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Prompt {
    pub(super) id: u64,
    pub(super) presentation: u32,
    pub(super) question: Question,
    pub(super) scene_key: u64,
    pub(super) interaction: u64,
    pub(super) text: String,
}

impl Prompts {
    pub(super) fn remember(&mut self, act: &RobotAct) {
        let text = act.text.as_str().unwrap_or_default();
        let question = Question::try_from(act.question).unwrap_or_default();
        let asks = act.kind() == Ok(ActKind::Ask);
        let known = self.0.iter().any(|p| (p.id, p.presentation) == (act.prompt, act.presentation));
        if act.prompt == 0 || text.is_empty() || known {
            return;
        }
        if self.0.len() == PROMPTS_MAX {
            self.0.pop_front();
        }
        self.0.push_back(Prompt {
            id: act.prompt,
            presentation: act.presentation,
            question: if asks { question } else { Question::None },
            scene_key: act.scene_key,
            interaction: act.interaction,
            text: text.to_owned(),
        });
    }

    /// The words of what is being said or was said last.
    pub(super) fn of(&self, presented: &Presented) -> Option<&Prompt> {
        self.find(presented.prompt, presented.presentation)
    }

    /// The words of one presentation of a prompt; of another one where that was not seen.
    pub(super) fn find(&self, id: u64, presentation: u32) -> Option<&Prompt> {
        let of_prompt = || self.0.iter().filter(move |prompt| prompt.id == id);
        of_prompt().find(|prompt| prompt.presentation == presentation).or(of_prompt().next_back())
    }
}

/// What is being said or was said last.
pub(super) fn speaking(prompt: &Prompt, presented: &Presented, has_sound: bool) -> Json {
    let Presented { prompt: id, presentation, started_ns, ended_ns, state, .. } = *presented;
    json!({
        "prompt": id,
        "presentation": presentation,
        "text": prompt.text,
        "url": has_sound.then(|| format!("/voice/line-{id}-{presentation}.wav")),
        "began_ms": ms(Time(started_ns)),
        "ended_ms": (ended_ns > 0).then(|| ms(Time(ended_ns))),
        "state": PresentationState::from_code(state).ok(),
    })
}

/// How well the robot hears.
pub(super) fn hearing(hearing: &Hearing) -> Json {
    json!({
        "level_db": hearing.level_db.round(),
        "snr_db": (hearing.measured != 0).then(|| hearing.snr_db.round()),
        "ear": EarState::from_code(hearing.ear).ok(),
        "microphone": MicrophoneState::from_code(hearing.microphone).ok(),
        "note": hearing.note.as_str().unwrap_or_default(),
        "pending": hearing.pending,
        "dropped": hearing.dropped,
    })
}

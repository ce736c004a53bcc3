//! Speaking: each prompt said once per presentation, and known as heard only when it was said to
//! its end.

use crate::record::{Record, Said};
use crate::{Fx, Line, Out, Spoken, VoiceEvent};
use node::{Span, Time};
use protocol::{ActId, ActKind, ArmStatus, Presentation, Presented, PromptId, RobotAct};
use scene::Question;
use std::collections::VecDeque;

/// Questions that an utterance may still refer to.
const HEARD_MAX: usize = 16;
/// How long a pointing question waits for the arm before it is asked without.
const AIM_PATIENCE: Span = Span::from_ms(6_000);

/// The speaking half of the node.
#[derive(Default)]
pub(crate) struct Mouth {
    /// Questions said to their end, oldest first.
    heard: VecDeque<Said>,
    /// The latest prompt said to its end, question or not.
    last: Option<Said>,
    saying: Option<Saying>,
    waiting: Option<Waiting>,
    /// Number of the last line given to the voice.
    last_line: u64,
}

/// A prompt to be said.
#[derive(Clone)]
struct Words {
    prompt: PromptId,
    presentation: u32,
    question: Question,
    scene_key: u64,
    text: String,
}

/// What is being said.
struct Saying {
    line: u64,
    words: Words,
    started: Option<Time>,
}

/// A pointing question that waits for the arm to aim.
struct Waiting {
    act: ActId,
    words: Words,
    until: Time,
}

impl Mouth {
    /// Takes in a prompt that the journal holds.
    pub(crate) fn remember(&mut self, said: Said) {
        self.last = Some(said);
        if said.question != Question::None {
            if self.heard.len() >= HEARD_MAX {
                self.heard.pop_front();
            }
            self.heard.push_back(said);
        }
    }

    /// The question that a person who began to speak at `onset` had heard last.
    pub(crate) fn heard_at(&self, onset: Time) -> Option<Said> {
        self.heard.iter().rev().find(|said| said.ended <= onset).copied()
    }

    /// The policy's standing decision, which comes again and again.
    pub(crate) fn act(&mut self, act: &RobotAct, now: Time, fx: &mut Fx) {
        let (Ok(kind), Ok(question), Ok(text)) =
            (act.kind(), Question::try_from(act.question), act.text.as_str())
        else {
            tracing::warn!(act = act.act, "act refused");
            return;
        };
        let (prompt, presentation) = (PromptId(act.prompt), act.presentation);
        if kind == ActKind::Wait || text.is_empty() {
            return self.hush(fx);
        }
        if self.is_known(prompt, presentation) {
            return;
        }
        let question = if kind == ActKind::Ask { question } else { Question::None };
        let scene_key = act.scene_key;
        let words = Words { prompt, presentation, question, scene_key, text: text.to_owned() };
        self.waiting = None;
        if matches!(question, Question::Point(_)) {
            let until = now + AIM_PATIENCE;
            self.waiting = Some(Waiting { act: ActId(act.act), words, until });
        } else {
            self.say(words, fx);
        }
    }

    /// Whether the presentation was said, is being said, or waits to be said.
    fn is_known(&self, prompt: PromptId, presentation: u32) -> bool {
        let is = |words: &Words| words.prompt == prompt && words.presentation == presentation;
        self.last.is_some_and(|said| (said.prompt, said.presentation) >= (prompt, presentation))
            || self.saying.as_ref().is_some_and(|saying| is(&saying.words))
            || self.waiting.as_ref().is_some_and(|waiting| is(&waiting.words))
    }

    /// The arm aims at something: a pointing question that waits for it can be asked.
    pub(crate) fn aimed(&mut self, status: &ArmStatus, _now: Time, fx: &mut Fx) {
        let aimed = |waiting: &Waiting| status.aimed_at() == Some(waiting.act);
        if self.waiting.as_ref().is_some_and(aimed) {
            self.ask_waiting(fx);
        }
    }

    /// The arm did not come round to it: the question is asked all the same.
    pub(crate) fn tick(&mut self, now: Time, fx: &mut Fx) {
        if self.waiting.as_ref().is_some_and(|waiting| now >= waiting.until) {
            self.ask_waiting(fx);
        }
    }

    pub(crate) fn deadline(&self) -> Option<Time> {
        self.waiting.as_ref().map(|waiting| waiting.until)
    }

    fn ask_waiting(&mut self, fx: &mut Fx) {
        if let Some(waiting) = self.waiting.take() {
            self.say(waiting.words, fx);
        }
    }

    fn say(&mut self, words: Words, fx: &mut Fx) {
        self.last_line += 1;
        let line = self.last_line;
        fx.publish(Out::Speak(Line { number: line, text: words.text.clone() }));
        self.saying = Some(Saying { line, words, started: None });
    }

    fn hush(&mut self, fx: &mut Fx) {
        self.waiting = None;
        if self.saying.take().is_some() {
            fx.publish(Out::Hush);
        }
    }

    /// The voice has come along.
    pub(crate) fn spoken(&mut self, event: VoiceEvent, now: Time, fx: &mut Fx) {
        // Word of a line that has been superseded meanwhile comes too late.
        let Some(saying) = self.saying.as_mut().filter(|saying| saying.line == event.line) else {
            return;
        };
        match event.what {
            Spoken::Started => saying.started = Some(now),
            Spoken::Interrupted => self.saying = None,
            Spoken::Ended => self.end(now, fx),
        }
        self.send(fx);
    }

    fn end(&mut self, now: Time, fx: &mut Fx) {
        let Some(Saying { words, started, .. }) = self.saying.take() else { return };
        let said = Said {
            prompt: words.prompt,
            presentation: words.presentation,
            question: words.question,
            scene_key: words.scene_key,
            started: started.unwrap_or(now),
            ended: now,
        };
        fx.append(Record::Presented(said));
        self.remember(said);
    }

    /// Tells the policy what is being said or was said last.
    pub(crate) fn send(&self, fx: &mut Fx) {
        let presented = match (&self.saying, &self.last) {
            (Some(Saying { words, started: Some(started), .. }), _) => Presented {
                prompt: words.prompt.0,
                presentation: words.presentation,
                started_ns: started.ns(),
                state: Presentation::Speaking.code(),
                ..Presented::default()
            },
            (_, Some(said)) => Presented {
                prompt: said.prompt.0,
                presentation: said.presentation,
                started_ns: said.started.ns(),
                ended_ns: said.ended.ns(),
                state: Presentation::Ended.code(),
                ..Presented::default()
            },
            (_, None) => Presented::default(),
        };
        fx.publish(Out::Presented(presented));
    }

    /// The prompts that a new journal must begin with.
    pub(crate) fn snapshot(&self) -> impl Iterator<Item = Said> + '_ {
        let questions = self.heard.iter().copied();
        questions.chain(self.last.filter(|last| self.heard.back() != Some(last)))
    }
}

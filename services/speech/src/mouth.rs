//! Speaking: each prompt said once per presentation, held back while a person speaks, broken off
//! when interrupted, and known as heard whole only when it was said to its end.

use crate::record::{Record, Said};
use crate::{Fx, Line, Out, Spoken, VoiceEvent};
use messages::{
    ASKED_MAX, ActId, ActKind, ArmStatus, PresentationState, Presented, PromptId, RobotAct,
};
use scene::Question;
use service::{Span, Time};
use std::collections::VecDeque;

/// Presentations of questions that are remembered.
const SAID_MAX: usize = 16;
/// How long a pointing question waits for the arm before it is asked without.
const AIM_PATIENCE: Span = Span::from_ms(6_000);

/// The speaking half of the node.
#[derive(Default)]
pub(crate) struct Mouth {
    /// Questions said, whole or not, oldest first.
    said: VecDeque<Said>,
    /// The latest prompt said to its end, question or not.
    last: Option<Said>,
    /// The latest prompt that was broken off, until another one sounds.
    broken: Option<Said>,
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

/// Words that wait to be said.
struct Waiting {
    act: ActId,
    words: Words,
    /// For a pointing question: until when it waits for the arm to aim.
    aim_until: Option<Time>,
}

impl Mouth {
    /// Takes in a prompt that the journal holds.
    pub(crate) fn remember(&mut self, said: Said) {
        if said.whole {
            self.last = Some(said);
        }
        if said.question != Question::None {
            if self.said.len() >= SAID_MAX {
                self.said.pop_front();
            }
            self.said.push_back(said);
        }
    }

    /// The questions that a person may have heard something of, newest first.
    pub(crate) fn asked(&self) -> Vec<Said> {
        let saying = self.saying.as_ref().and_then(Saying::so_far);
        let saying = saying.filter(|said| said.question != Question::None);
        saying.into_iter().chain(self.said.iter().rev().copied()).take(ASKED_MAX).collect()
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
            return self.hush(now, fx);
        }
        if self.is_known(prompt, presentation) {
            return;
        }
        let can_be_answered = matches!(kind, ActKind::Ask | ActKind::Pick);
        let question = if can_be_answered { question } else { Question::None };
        let scene_key = act.scene_key;
        let words = Words { prompt, presentation, question, scene_key, text: text.to_owned() };
        let points = kind == ActKind::Ask && matches!(question, Question::Point(_));
        let aim_until = points.then(|| now + AIM_PATIENCE);
        self.waiting = Some(Waiting { act: ActId(act.act), words, aim_until });
    }

    /// Whether the presentation was said, is being said, or waits to be said.
    fn is_known(&self, prompt: PromptId, presentation: u32) -> bool {
        let is = |words: &Words| words.prompt == prompt && words.presentation == presentation;
        self.last.is_some_and(|said| (said.prompt, said.presentation) >= (prompt, presentation))
            || self.saying.as_ref().is_some_and(|saying| is(&saying.words))
            || self.waiting.as_ref().is_some_and(|waiting| is(&waiting.words))
    }

    /// The arm aims at something: a pointing question that waits for it can be asked.
    pub(crate) fn aimed(&mut self, status: &ArmStatus) {
        if let Some(waiting) = &mut self.waiting
            && status.aimed_at() == Some(waiting.act)
        {
            waiting.aim_until = None;
        }
    }

    /// Says what waits, unless a person speaks. If the arm does not come round to aiming, the
    /// question is asked all the same.
    pub(crate) fn go_on(&mut self, somebody_speaks: bool, now: Time, fx: &mut Fx) {
        let aiming = |waiting: &Waiting| waiting.aim_until.is_some_and(|until| now < until);
        if somebody_speaks || self.waiting.as_ref().is_none_or(aiming) {
            return;
        }
        if let Some(waiting) = self.waiting.take() {
            self.say(waiting.words, now, fx);
        }
    }

    /// A person interrupts: what is being said is broken off. It is said again when the policy
    /// still wants it said after what the person has said.
    pub(crate) fn interrupted(&mut self, now: Time, fx: &mut Fx) {
        if self.saying.is_some() {
            self.break_off(now, fx);
            fx.publish(Out::Hush);
            self.send(fx);
        }
    }

    pub(crate) fn deadline(&self) -> Option<Time> {
        self.waiting.as_ref().and_then(|waiting| waiting.aim_until)
    }

    fn say(&mut self, words: Words, now: Time, fx: &mut Fx) {
        self.break_off(now, fx);
        self.last_line += 1;
        let line = self.last_line;
        let Words { prompt, presentation, text, .. } = words.clone();
        fx.publish(Out::Speak(Line { number: line, prompt, presentation, text }));
        self.saying = Some(Saying { line, words, started: None });
    }

    fn hush(&mut self, now: Time, fx: &mut Fx) {
        self.waiting = None;
        self.interrupted(now, fx);
    }

    /// What has been said of a question so far may be answered all the same.
    fn break_off(&mut self, now: Time, fx: &mut Fx) {
        let so_far = self.saying.take().and_then(|saying| saying.so_far());
        let Some(said) = so_far.map(|said| Said { ended: now, ..said }) else { return };
        self.broken = Some(said);
        if said.question != Question::None {
            self.keep(said, fx);
        }
    }

    fn keep(&mut self, said: Said, fx: &mut Fx) {
        fx.append(Record::Presented(said));
        self.remember(said);
    }

    /// The voice has come along.
    pub(crate) fn spoken(&mut self, event: VoiceEvent, now: Time, fx: &mut Fx) {
        // Word of a line that has been superseded meanwhile comes too late.
        let Some(saying) = self.saying.as_mut().filter(|saying| saying.line == event.line) else {
            return;
        };
        match event.what {
            Spoken::Started => {
                saying.started = Some(now);
                self.broken = None;
            }
            Spoken::Interrupted => self.break_off(now, fx),
            Spoken::Ended => self.end(now, fx),
        }
        self.send(fx);
    }

    fn end(&mut self, now: Time, fx: &mut Fx) {
        if let Some(mut saying) = self.saying.take() {
            self.broken = None;
            saying.started.get_or_insert(now);
            let whole = saying.so_far().map(|said| Said { ended: now, whole: true, ..said });
            whole.into_iter().for_each(|said| self.keep(said, fx));
        }
    }

    /// Tells the policy what is being said or was said last.
    pub(crate) fn send(&self, fx: &mut Fx) {
        let presented = match (&self.saying, self.broken, self.last) {
            (Some(Saying { words, started: Some(started), .. }), ..) => Presented {
                prompt: words.prompt.0,
                presentation: words.presentation,
                started_ns: started.ns(),
                state: PresentationState::Speaking.code(),
                ..Presented::default()
            },
            (_, Some(broken), _) => broken.presented(PresentationState::Interrupted),
            (_, _, Some(last)) => last.presented(PresentationState::Ended),
            (_, None, None) => Presented::default(),
        };
        fx.publish(Out::Presented(presented));
    }

    /// The prompts that a new journal must begin with.
    pub(crate) fn snapshot(&self) -> impl Iterator<Item = Said> + '_ {
        let questions = self.said.iter().copied();
        questions.chain(self.last.filter(|last| !self.said.contains(last)))
    }
}

impl Saying {
    /// What has been said, once its sound has begun.
    fn so_far(&self) -> Option<Said> {
        let started = self.started?;
        Some(Said {
            prompt: self.words.prompt,
            presentation: self.words.presentation,
            question: self.words.question,
            scene_key: self.words.scene_key,
            started,
            ended: started,
            whole: false,
        })
    }
}

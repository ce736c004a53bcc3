//! Speaking: each prompt is spoken once per presentation, delayed while a user speaks, interrupted
//! on barge-in, and counts as heard only when it was spoken to its end.

use crate::recent_lines::RecentLines;
use crate::record::Record;
use crate::{Fx, Out, PlaybackEvent, PlaybackRequest, PlaybackState};
use messages::{
    ASKED_MAX, ActId, ActKind, ArmStatus, PresentationState, Presented, PromptId, RobotAct,
};
use scene::Question;
use service::bounded::push_bounded;
use service::{Span, Time};
use std::collections::VecDeque;
use vocabulary::Presentation;

/// Presentations of questions that are remembered.
const PRESENTATIONS_MAX: usize = 16;
/// Longest time that a pointing question waits for the arm.
const AIM_TIMEOUT: Span = Span::from_ms(6_000);

/// The speaking half of the reducer.
#[derive(Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct PromptPlayer {
    /// Presentations of questions, complete or not, oldest first.
    presentations: VecDeque<Presentation>,
    /// The latest complete presentation, question or not.
    last: Option<Presentation>,
    /// The latest interrupted presentation, until another one sounds.
    interrupted: Option<Presentation>,
    /// The presentation that was repeated last because a user spoke while it sounded.
    repeated: Option<(PromptId, u32)>,
    playing: Option<Playing>,
    waiting: Option<Waiting>,
    /// Number of the last playback.
    last_playback: u64,
    /// Last in a checkpoint, absent in those of earlier builds.
    #[serde(skip)]
    lines: RecentLines,
    /// The policy's latest prompt. Behind the lines in a checkpoint.
    #[serde(skip)]
    newest: PromptId,
}

/// The prompt being spoken.
#[derive(serde::Serialize, serde::Deserialize)]
struct Playing {
    playback: u64,
    presentation: Presentation,
    has_begun: bool,
}

/// A prompt that waits to be spoken.
#[derive(serde::Serialize, serde::Deserialize)]
struct Waiting {
    act: ActId,
    /// The presentation; its times count from the first sound on.
    presentation: Presentation,
    text: String,
    /// Until when a pointing question waits for the arm.
    aim_until: Option<Time>,
}

impl PromptPlayer {
    /// Restores a presentation from the journal.
    pub(crate) fn restore(&mut self, presentation: Presentation) {
        if presentation.complete {
            self.last = Some(presentation);
        }
        if presentation.question != Question::None {
            push_bounded(&mut self.presentations, PRESENTATIONS_MAX, presentation);
        }
    }

    pub(crate) fn lines(&self) -> &RecentLines {
        &self.lines
    }

    pub(crate) fn newest(&self) -> PromptId {
        self.newest
    }

    pub(crate) fn restore_lines(&mut self, lines: RecentLines, newest: PromptId) {
        (self.lines, self.newest) = (lines, newest);
    }

    /// Returns the questions that may be answered by words whose user began at `onset` and was
    /// shown the prompt `seen` before, newest first: that prompt alone if it is a question, whether
    /// or not it sounds, otherwise those before it; all if `seen` is 0.
    pub(crate) fn answerable(
        &mut self,
        seen: PromptId,
        onset: Time,
        now: Time,
        fx: &mut Fx,
    ) -> Vec<Presentation> {
        self.note_shown(seen, now, fx);
        let mut asked = self.asked();
        if asked.iter().any(|question| question.prompt == seen) {
            asked.retain(|question| question.prompt == seen);
            // It was shown before it was answered, whenever its sound began.
            asked.iter_mut().for_each(|question| question.began = question.began.min(onset));
        } else if seen != PromptId(0) {
            asked.retain(|question| question.prompt < seen);
        }
        asked.truncate(ASKED_MAX);
        asked
    }

    /// Notes that a user was shown a question that is not sounding yet: it can be answered now.
    fn note_shown(&mut self, seen: PromptId, now: Time, fx: &mut Fx) {
        let silent = self.playing.as_ref().filter(|playing| !playing.has_begun);
        let playing = silent.map(|playing| playing.presentation);
        let waiting = self.waiting.as_ref().map(|waiting| waiting.presentation);
        let is_shown = |it: &Presentation| it.prompt == seen && it.question != Question::None;
        let shown = playing.into_iter().chain(waiting).find(is_shown);
        if let Some(shown) = shown.filter(|_| !self.presentations.iter().any(is_shown)) {
            self.append(Presentation { began: now, ended: Some(now), ..shown }, fx);
        }
    }

    /// Returns the questions that a user may have heard or seen at least in part, newest first.
    fn asked(&self) -> Vec<Presentation> {
        let playing = self.playing.as_ref().and_then(Playing::begun);
        let playing = playing.filter(|playing| playing.question != Question::None);
        let earlier = self.presentations.iter().rev().copied();
        playing.into_iter().chain(earlier).collect()
    }

    /// Returns the question that an utterance now would answer, if the last prompt is one.
    pub(crate) fn standing(&self) -> Question {
        let playing = self.playing.as_ref().and_then(Playing::begun);
        let last = playing.or(self.interrupted).or(self.last);
        last.map_or(Question::None, |presentation| presentation.question)
    }

    /// Handles the policy's current decision, which is resent periodically.
    pub(crate) fn on_act(&mut self, act: &RobotAct, now: Time, fx: &mut Fx) {
        self.newest = PromptId(act.prompt);
        let kind = act.kind.get();
        let (question, text) = match act.judge() {
            Ok(judged) => judged,
            Err(error) => {
                tracing::warn!(act = act.act, %error, "act rejected");
                return;
            }
        };
        if kind == ActKind::Wait || text.is_empty() {
            self.waiting = None;
            return self.interrupt(now, fx);
        }
        let (prompt, number) = (PromptId(act.prompt), act.presentation);
        if self.is_known(prompt, number) {
            return;
        }
        let is_answerable = !matches!(kind, ActKind::Wait | ActKind::Cancel);
        let question = if is_answerable { question } else { Question::None };
        let scene = act.scene_key;
        let presentation =
            Presentation { prompt, number, question, scene, ..Presentation::default() };
        let aim_until = act.pointed_at().map(|_| now + AIM_TIMEOUT);
        let (act, text) = (ActId(act.act), text.to_owned());
        self.waiting = Some(Waiting { act, presentation, text, aim_until });
    }

    /// Returns whether the presentation was the last one spoken, is being spoken, or waits. Acts
    /// come in order, so only equality counts: a number too high must not silence later prompts.
    fn is_known(&self, prompt: PromptId, number: u32) -> bool {
        let is = |other: &Presentation| (other.prompt, other.number) == (prompt, number);
        self.last.as_ref().is_some_and(is)
            || self.playing.as_ref().is_some_and(|playing| is(&playing.presentation))
            || self.waiting.as_ref().is_some_and(|waiting| is(&waiting.presentation))
    }

    /// Releases a pointing question once the arm aims at its object.
    pub(crate) fn on_arm_status(&mut self, status: &ArmStatus) {
        if let Some(waiting) = &mut self.waiting
            && status.aimed_at() == Some(waiting.act)
        {
            waiting.aim_until = None;
        }
    }

    /// Speaks the waiting prompt, unless the intake is busy or the prompt still waits for the arm.
    pub(crate) fn play_next(&mut self, is_busy: bool, now: Time, fx: &mut Fx) {
        let aiming = |waiting: &Waiting| waiting.aim_until.is_some_and(|until| now < until);
        if is_busy || self.waiting.as_ref().is_none_or(aiming) {
            return;
        }
        if let Some(waiting) = self.waiting.take() {
            self.play(waiting.presentation, waiting.text, now, fx);
        }
    }

    /// Makes room for a user who begins to speak: one who can interrupt the robot does, and a
    /// prompt that does not sound yet waits for everyone.
    pub(crate) fn give_way(&mut self, interrupts: bool, now: Time, fx: &mut Fx) {
        if interrupts || self.playing.as_ref().is_some_and(|playing| !playing.has_begun) {
            self.interrupt(now, fx);
        }
    }

    /// Has the latest prompt said again, once: a user spoke while it sounded.
    pub(crate) fn repeat(&mut self) {
        let last = self.last.filter(|last| self.repeated != Some((last.prompt, last.number)));
        if let Some(last) = last.filter(|_| self.playing.is_none()) {
            self.repeated = Some((last.prompt, last.number));
            (self.last, self.interrupted) = (None, Some(last));
        }
    }

    /// Interrupts the current prompt. It is repeated if the policy still wants it after the user's
    /// utterance.
    pub(crate) fn interrupt(&mut self, now: Time, fx: &mut Fx) {
        if self.playing.is_some() {
            self.break_off(now, fx);
            fx.publish(Out::StopSpeaking);
            self.send(fx);
        }
    }

    pub(crate) fn deadline(&self) -> Option<Time> {
        self.waiting.as_ref().and_then(|waiting| waiting.aim_until)
    }

    fn play(&mut self, presentation: Presentation, text: String, now: Time, fx: &mut Fx) {
        self.break_off(now, fx);
        self.lines.add(&text);
        self.last_playback += 1;
        let playback = self.last_playback;
        let Presentation { prompt, number, .. } = presentation;
        let request = PlaybackRequest { playback, prompt, presentation: number, text };
        fx.publish(Out::Speak(request));
        self.playing = Some(Playing { playback, presentation, has_begun: false });
    }

    /// Ends the current presentation early; it may be answered all the same.
    fn break_off(&mut self, now: Time, fx: &mut Fx) {
        self.lines.end(now);
        let begun = self.playing.take().and_then(|playing| playing.begun());
        let Some(mut presentation) = begun else { return };
        // A question that ended as it began was not heard.
        presentation.ended = (now > presentation.began).then_some(now);
        self.interrupted = Some(presentation);
        if presentation.question != Question::None {
            self.append(presentation, fx);
        }
    }

    fn append(&mut self, presentation: Presentation, fx: &mut Fx) {
        fx.append(Record::Presented(presentation));
        self.restore(presentation);
    }

    /// Handles the progress of a playback; events of superseded playbacks are ignored.
    pub(crate) fn on_playback(&mut self, event: PlaybackEvent, now: Time, fx: &mut Fx) {
        let is_current = |playing: &&mut Playing| playing.playback == event.playback;
        let Some(playing) = self.playing.as_mut().filter(is_current) else { return };
        match event.state {
            PlaybackState::Started => {
                playing.begin(now);
                self.lines.begin(now);
                self.interrupted = None;
            }
            PlaybackState::Interrupted => self.break_off(now, fx),
            PlaybackState::Ended => self.end(now, fx),
            PlaybackState::Failed(reason) => {
                // The consoles show the text all the same, so the question counts as asked.
                tracing::warn!(reason, "prompt shown as text only");
                self.end(now, fx);
            }
        }
        self.send(fx);
    }

    fn end(&mut self, now: Time, fx: &mut Fx) {
        self.lines.end(now);
        let Some(mut playing) = self.playing.take() else { return };
        self.interrupted = None;
        if !playing.has_begun {
            playing.begin(now);
        }
        let ended = Some(now);
        self.append(Presentation { ended, complete: true, ..playing.presentation }, fx);
    }

    /// Publishes the current or latest presentation.
    pub(crate) fn send(&self, fx: &mut Fx) {
        let playing = self.playing.as_ref().and_then(Playing::begun);
        let presented = match (playing, self.interrupted, self.last) {
            (Some(playing), ..) => presented(&playing, PresentationState::Speaking),
            (_, Some(interrupted), _) => presented(&interrupted, PresentationState::Interrupted),
            (_, _, Some(last)) => presented(&last, PresentationState::Ended),
            (None, None, None) => Presented::default(),
        };
        fx.publish(Out::Presented(presented));
    }

    /// Returns the presentations that a new journal must begin with.
    pub(crate) fn snapshot(&self) -> impl Iterator<Item = Presentation> + '_ {
        let questions = self.presentations.iter().copied();
        questions.chain(self.last.filter(|last| !self.presentations.contains(last)))
    }
}

impl Playing {
    fn begin(&mut self, now: Time) {
        (self.presentation.began, self.has_begun) = (now, true);
    }

    /// Returns the presentation once its sound has begun.
    fn begun(&self) -> Option<Presentation> {
        self.has_begun.then_some(self.presentation)
    }
}

/// Returns the presentation as published to the policy and the console.
fn presented(presentation: &Presentation, state: PresentationState) -> Presented {
    let ended = presentation.ended.unwrap_or(presentation.began);
    Presented {
        prompt: presentation.prompt.0,
        presentation: presentation.number,
        started_ns: presentation.began.ns(),
        ended_ns: if state == PresentationState::Speaking { 0 } else { ended.ns() },
        state: state.code(),
        ..Presented::default()
    }
}

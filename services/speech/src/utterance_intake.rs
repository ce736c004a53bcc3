//! Utterance intake: each utterance is accepted once, numbered without a gap, and sent until it is
//! applied.

mod accepted;
mod closing_streams;
mod hearing_status;
mod interim_results;
mod origin;
mod outgoing_messages;
mod receipts;

use crate::devices::microphone::MicrophoneStatus;
use crate::pending_sounds::PendingSounds;
use crate::prompt_player::PromptPlayer;
use crate::record::{Accepted, Record};
use crate::stream_events::StreamEvent;
use crate::utterance_content::UtteranceContent;
use crate::{Config, Fx, Hypothesis, Out, Recognised, RecognisedSegment, RecognitionInput};
use accepted::AcceptedUtterances;
use closing_streams::ClosingStreams;
use hearing_status::HearingStatus;
use interim_results::InterimResults;
use messages::{
    AppliedMark, EarState, Injection, MotionCommand, MotionOrder, ReceiptStatus, Sound, Source,
};
use origin::Origin;
use outgoing_messages::{receipt, rejection, utterance};
use receipts::Receipts;
use scene::{Intent, Question};
use service::{Span, Time};
use std::ops::RangeInclusive;

/// Longest time that a user's speech delays the robot's prompts.
const BUSY_MAX: Span = Span::from_ms(10_000);
/// Durations of a request to talk, seconds.
const TALK_S: RangeInclusive<f64> = 1.0..=60.0;

/// The hearing half of the reducer.
pub(crate) struct UtteranceIntake {
    config: Config,
    accepted: AcceptedUtterances,
    receipts: Receipts,
    pending: PendingSounds,
    status: HearingStatus,
    interim: InterimResults,
    closing: ClosingStreams,
}

impl UtteranceIntake {
    pub(crate) fn new(config: Config) -> Self {
        Self {
            config,
            accepted: AcceptedUtterances::new(),
            receipts: Receipts::default(),
            pending: PendingSounds::default(),
            status: HearingStatus::default(),
            interim: InterimResults::default(),
            closing: ClosingStreams::default(),
        }
    }

    /// Restores an utterance from the journal.
    pub(crate) fn restore(&mut self, accepted: Accepted) {
        self.receipts.record(receipt(&accepted));
        self.accepted.add(accepted);
    }

    /// Handles a client's request. Until the policy's mark is known requests are ignored; clients
    /// repeat them. Returns whether the user interrupts the robot.
    pub(crate) fn inject(
        &mut self,
        injection: Injection,
        player: &PromptPlayer,
        now: Time,
        fx: &mut Fx,
    ) -> bool {
        let key = injection.key;
        let is_pending = self.pending.contains(key);
        if is_pending || self.receipts.repeat(key, fx) || !self.accepted.is_marked() {
            return false;
        }
        let origin = Origin::whole(key, span(&injection, now));
        match injection.sound {
            Sound::Text(text) => {
                let hypotheses = vec![Hypothesis::certain(text)];
                let content = UtteranceContent::words(hypotheses, Source::Text);
                self.accept(origin, content, player, now, fx)
            }
            Sound::Point { target_m, words } => {
                let content = UtteranceContent::pointing(target_m, words);
                self.accept(origin, content, player, now, fx)
            }
            Sound::Wav(path) => {
                let sound = self.pending.add(key, Source::Wav, origin.span.0);
                fx.publish(Out::Recognise(sound, RecognitionInput::File(path)));
                false
            }
            Sound::Transcript { hypotheses } => match UtteranceContent::transcript(hypotheses) {
                Ok(content) => {
                    let origin = Origin { source: Source::Browser, ..origin };
                    self.accept(origin, content, player, now, fx)
                }
                Err(reason) => self.reject(origin, &reason, fx),
            },
            Sound::Talk { longest_s } => self.talk(origin, longest_s, now, fx),
        }
    }

    fn talk(&mut self, origin: Origin, longest_s: f64, now: Time, fx: &mut Fx) -> bool {
        if !TALK_S.contains(&longest_s) {
            let (least, most) = (TALK_S.start(), TALK_S.end());
            let reason = format!("duration {longest_s} s is out of range ({least} to {most} s)");
            return self.reject(origin, &reason, fx);
        }
        let sound = self.pending.add(origin.key, Source::Microphone, now);
        fx.publish(Out::OpenMicrophone(sound, Span::from_s(longest_s)));
        self.publish(fx);
        true
    }

    /// Handles an event of a live source.
    pub(crate) fn stream_event(&mut self, event: StreamEvent, now: Time, fx: &mut Fx) {
        match event {
            StreamEvent::Samples { sound, samples } => {
                if self.pending.in_progress(sound).is_some() {
                    fx.publish(Out::InterimSamples(sound, samples));
                }
                return;
            }
            StreamEvent::Paused { sound, segment } => {
                if self.pending.in_progress(sound).is_some() {
                    fx.publish(Out::DecodeEarly(sound, segment));
                }
                return;
            }
            StreamEvent::Began(began) => {
                self.pending.began(&began, now);
                self.status.set_onset(began.at.min(now));
            }
            StreamEvent::Ended { sound, segment } => {
                let span = (segment.onset.min(now), segment.end.min(now));
                if self.pending.ended(sound, span) {
                    fx.publish(Out::Recognise(sound, RecognitionInput::Speech(segment)));
                }
            }
            StreamEvent::Closed { stream, utterances, lost } => {
                self.closing.add(stream, utterances, lost);
                self.report_closed_streams(fx);
            }
            StreamEvent::Silent { sound, reason } => {
                if let Some(sound) = self.pending.remove(sound) {
                    self.reject(Origin::of(&sound, 0, 1), &reason, fx);
                }
            }
        }
        self.publish(fx);
    }

    /// Reports the end of streams whose utterances all have their results.
    fn report_closed_streams(&mut self, fx: &mut Fx) {
        for (origin, note) in self.closing.take_done(&self.pending) {
            self.report(origin, ReceiptStatus::Over, &note, fx);
        }
    }

    /// Publishes an interim result.
    pub(crate) fn interim_result(&mut self, sound: u64, text: &str, fx: &mut Fx) {
        if let Some(sound) = self.pending.in_progress(sound) {
            self.interim.publish(sound, text, fx);
        }
    }

    pub(crate) fn set_microphone(&mut self, status: &MicrophoneStatus, fx: &mut Fx) {
        self.status.set_microphone(status);
        self.status.publish(self.pending.len(), fx);
    }

    pub(crate) fn set_recogniser(&mut self, state: EarState, fx: &mut Fx) {
        self.status.set_recogniser(state);
        self.publish(fx);
    }

    fn publish(&self, fx: &mut Fx) {
        self.publish_activity(fx);
        self.status.publish(self.pending.len(), fx);
    }

    fn publish_activity(&self, fx: &mut Fx) {
        let pending = self.pending.len() + self.accepted.len();
        fx.publish(Out::Activity(self.status.activity(self.pending.since(), pending)));
    }

    /// Handles the result of the recogniser.
    pub(crate) fn recognised(
        &mut self,
        recognised: Recognised,
        player: &PromptPlayer,
        now: Time,
        fx: &mut Fx,
    ) {
        let Some(sound) = self.pending.remove(recognised.sound) else { return };
        self.interim.finish(&sound, fx);
        let whole = Origin::of(&sound, 0, 1);
        match recognised.segments {
            Ok(segments) if segments.is_empty() => {
                self.reject(whole, "no speech found", fx);
            }
            Ok(segments) => {
                let count = segments.len() as u32;
                for (number, segment) in (0..).zip(segments) {
                    let origin = Origin::of(&sound, number, count).measured(&segment, now);
                    self.recognised_segment(origin, segment, player, now, fx);
                }
            }
            Err(reason) => {
                self.reject(whole, &reason, fx);
            }
        }
        self.report_closed_streams(fx);
        self.publish(fx);
    }

    fn recognised_segment(
        &mut self,
        origin: Origin,
        segment: RecognisedSegment,
        player: &PromptPlayer,
        now: Time,
        fx: &mut Fx,
    ) {
        self.status.set_measured(origin.span.0, segment.snr_db);
        match segment.hypotheses {
            Ok(hypotheses) => {
                let content = UtteranceContent::words(hypotheses, origin.source);
                self.accept(origin, content, player, now, fx);
            }
            Err(text) => self.report(origin, ReceiptStatus::NotForMe, &text, fx),
        }
    }

    /// Accepts an utterance. Returns whether it is new.
    fn accept(
        &mut self,
        origin: Origin,
        content: UtteranceContent,
        player: &PromptPlayer,
        now: Time,
        fx: &mut Fx,
    ) -> bool {
        // A segment that was accepted before a restart keeps its number.
        if let Some(accepted) = self.accepted.find(origin.key, origin.segment.0) {
            fx.publish(Out::Receipt(Box::new(receipt(accepted))));
            return false;
        }
        let seq = match content.check(&self.config).and_then(|()| self.accepted.next()) {
            Ok(seq) => seq,
            Err(reason) => return self.reject(origin, &reason, fx),
        };
        if self.is_stop(&content.hypotheses) {
            let order = MotionOrder::Stop.code();
            let command = MotionCommand { given_ns: now.ns(), order, ..MotionCommand::default() };
            fx.publish(Out::Motion(command));
        }
        let accepted = Accepted {
            seq,
            key: origin.key,
            segment: origin.segment,
            hypotheses: content.hypotheses,
            gesture: content.gesture,
            source: content.source,
            asked: player.asked(),
            onset: origin.span.0,
            end: origin.span.1,
            snr_db: origin.snr_db,
            accepted: now,
        };
        fx.append(Record::Accepted(accepted.clone()));
        fx.publish(Out::Receipt(Box::new(receipt(&accepted))));
        fx.publish(Out::Utterance(Box::new(utterance(&accepted))));
        self.restore(accepted);
        self.publish_activity(fx);
        true
    }

    fn is_stop(&self, hypotheses: &[Hypothesis]) -> bool {
        hypotheses.first().is_some_and(|best| {
            self.config.reader.read(&best.text, Question::None).intent == Intent::Stop
        })
    }

    /// Reports why there is no new utterance. Returns `false`.
    fn reject(&mut self, origin: Origin, reason: &str, fx: &mut Fx) -> bool {
        self.report(origin, ReceiptStatus::Refused, reason, fx);
        false
    }

    fn report(&mut self, origin: Origin, status: ReceiptStatus, note: &str, fx: &mut Fx) {
        let receipt = rejection(&origin, status, note);
        fx.publish(Out::Receipt(Box::new(receipt)));
        self.receipts.record(receipt);
    }

    /// Handles the policy's mark. Returns whether it is new.
    pub(crate) fn acknowledge(&mut self, mark: AppliedMark) -> bool {
        self.accepted.acknowledge(mark)
    }

    pub(crate) fn pending_since(&self) -> Option<Time> {
        self.accepted.pending_since()
    }

    /// Sends the utterances that are not applied yet, and the status.
    pub(crate) fn send(&self, fx: &mut Fx) {
        for accepted in self.accepted.to_send() {
            fx.publish(Out::Utterance(Box::new(utterance(accepted))));
        }
        self.publish(fx);
    }

    /// Returns whether a user is speaking or an utterance is still being processed. A sound that never
    /// ends, or a recogniser that never answers, does not silence the robot forever.
    pub(crate) fn is_busy(&self, now: Time) -> bool {
        let since = self.pending.since().into_iter().chain(self.accepted.oldest()).min();
        since.is_some_and(|since| now < since + BUSY_MAX)
    }

    /// Returns the utterances that a new journal must begin with; none while some are not applied yet.
    pub(crate) fn snapshot(&self) -> Option<Vec<Accepted>> {
        self.accepted.snapshot()
    }
}

/// Returns when an injection was spoken: as its client reports, otherwise now.
fn span(injection: &Injection, now: Time) -> (Time, Time) {
    let reported = |ns: u64| if ns == 0 { now } else { Time(ns).min(now) };
    let onset = reported(injection.onset_ns);
    (onset, reported(injection.end_ns).max(onset))
}

/// Appends an item and drops the oldest beyond a limit.
fn push_bounded<T>(queue: &mut std::collections::VecDeque<T>, item: T) {
    const ITEMS_MAX: usize = 128;
    if queue.len() >= ITEMS_MAX {
        queue.pop_front();
    }
    queue.push_back(item);
}

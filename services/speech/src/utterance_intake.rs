//! Utterance intake: each utterance is accepted once, numbered without a gap, and sent until it is
//! applied.

mod accepted;
mod checkpoint;
mod hearing_status;
mod origin;
mod stop_order;
mod waiting_requests;

use crate::endpointing::EarlyDecoding;
use crate::hearing::Rejected;
use crate::pending_sounds::{ClosedStream, PendingSound, PendingSounds};
use crate::prompt_player::PromptPlayer;
use crate::record::{Accepted, Record};
use crate::utterance_content::UtteranceContent;
use crate::{Config, Fx, Hypothesis, Out, Recognised, RecognisedSegment, RecognitionInput};
use accepted::{AcceptedUtterances, Receipts};
use hearing_status::HearingStatus;
use language::Completeness;
use messages::{EarState, GateVerdict, Injection, PromptId, Receipt, ReceiptStatus, Sound, Source};
use origin::Origin;
use scene::Question;
use service::{Span, Time};
use speech_engines::live_events::MicrophoneStatus;
use speech_engines::stream::StreamEvent;
use speech_engines::vad::Closing;
use std::ops::RangeInclusive;
use stop_order::StopOrder;
use vocabulary::PersonId;
use waiting_requests::{Request, SHARE, WaitingRequests};

/// Longest time that a user's speech delays the robot's prompts.
const BUSY_MAX: Span = Span::from_ms(10_000);
/// Longest time that words wait for the prompt that their user was shown.
const PROMPT_WAIT: Span = Span::from_ms(1_000);
/// Durations of a request to talk, seconds.
const TALK_S: RangeInclusive<f64> = 1.0..=60.0;

/// The hearing half of the reducer.
pub(crate) struct UtteranceIntake {
    config: Config,
    pub(crate) accepted: AcceptedUtterances,
    pub(crate) stop: StopOrder,
    waiting: WaitingRequests,
    receipts: Receipts,
    pending: PendingSounds,
    status: HearingStatus,
    /// Number of the last interim result.
    last_partial: u64,
    early: EarlyDecoding,
}

impl UtteranceIntake {
    pub(crate) fn new(config: Config) -> Self {
        Self {
            config,
            accepted: AcceptedUtterances::new(),
            stop: StopOrder::default(),
            waiting: WaitingRequests::default(),
            receipts: Receipts::default(),
            pending: PendingSounds::default(),
            status: HearingStatus::default(),
            last_partial: 0,
            early: EarlyDecoding::default(),
        }
    }

    /// Restores an utterance from the journal.
    pub(crate) fn restore(&mut self, accepted: Accepted) {
        self.receipts.record(accepted.receipt());
        self.accepted.add(accepted);
    }

    /// Handles a client's request. Until the policy's mark is known requests are ignored; clients
    /// repeat them. Returns whether the user interrupts the robot.
    pub(crate) fn inject(
        &mut self,
        injection: Injection,
        player: &mut PromptPlayer,
        now: Time,
        fx: &mut Fx,
    ) -> bool {
        let key = injection.key;
        let is_pending = self.pending.contains(key) || self.waiting.contains(key);
        if is_pending || self.receipts.repeat(key, fx) {
            return false;
        }
        let origin = Origin::of_injection(&injection, now);
        if !self.accepted.is_marked() {
            // The utterance waits for the policy; a stop in it does not.
            self.obey_unmarked(&origin, injection.sound, now, fx);
            return false;
        }
        let from = match PersonId::new(&injection.from) {
            Ok(from) => from,
            Err(error) => return self.reject(&origin, &format!("from: {error}"), fx),
        };
        let (source, content) = match injection.sound {
            Sound::Text(text) => {
                (Source::Text, Ok(UtteranceContent::words(vec![Hypothesis::certain(text)])))
            }
            Sound::Point { target_m, words } => {
                (Source::Gesture, Ok(UtteranceContent::pointing(target_m, words)))
            }
            Sound::Transcript { hypotheses } => {
                (Source::Browser, UtteranceContent::transcript(hypotheses))
            }
            Sound::Wav(path) => {
                let sound = self.pending.add(key, Source::Wav, origin.span.0);
                fx.publish(Out::Recognise(sound, RecognitionInput::File(path)));
                return false;
            }
            Sound::Talk { longest_s } => {
                let origin = Origin { source: Source::Microphone, ..origin };
                return self.talk(origin, longest_s, now, fx);
            }
        };
        self.enqueue(Origin { source, from, ..origin }, content, player, now, fx)
    }

    /// Has a request wait for its turn, which may be now. Returns whether it is new.
    fn enqueue(
        &mut self,
        origin: Origin,
        content: Result<UtteranceContent, String>,
        player: &mut PromptPlayer,
        now: Time,
        fx: &mut Fx,
    ) -> bool {
        if self.repeat(&origin, fx) {
            return false;
        }
        let content = match content.and_then(|content| content.checked(&self.config)) {
            Ok(content) => content,
            Err(reason) => return self.reject(&origin, &reason, fx),
        };
        self.obey_stop(&origin, &content, now, fx);
        let is_taken = self.waiting.push(Request { origin, content, received: now });
        self.accept_waiting(player, now, fx);
        is_taken
    }

    /// Accepts the requests whose turn it is.
    pub(crate) fn accept_waiting(&mut self, player: &mut PromptPlayer, now: Time, fx: &mut Fx) {
        while let Some(Request { origin, content, .. }) = self.next_request(player.newest(), now) {
            self.accept(origin, content, player, now, fx);
        }
    }

    /// Takes the next request. One whose user saw a later prompt than the `newest` waits for it.
    fn next_request(&mut self, newest: PromptId, now: Time) -> Option<Request> {
        self.waiting.take(|Request { origin, received, .. }| {
            let is_known = origin.seen <= newest || now >= *received + PROMPT_WAIT;
            is_known && self.accepted.of_client(origin.key.client()) < SHARE
        })
    }

    fn talk(&mut self, origin: Origin, longest_s: f64, now: Time, fx: &mut Fx) -> bool {
        if !TALK_S.contains(&longest_s) {
            let (least, most) = (TALK_S.start(), TALK_S.end());
            let reason = format!("duration {longest_s} s is out of range ({least} to {most} s)");
            return self.reject(&origin, &reason, fx);
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
                if self.pending.in_progress(sound).is_some()
                    && let Some(segment) = self.early.offer(sound, segment)
                {
                    fx.publish(Out::DecodeEarly(sound, segment));
                }
                return;
            }
            StreamEvent::Began(began) => {
                self.pending.began(&began, now);
                self.status.set_onset(began.at.min(now));
            }
            StreamEvent::Cut { sound } => return self.pending.cut(sound),
            StreamEvent::Ended { sound, segment } => {
                let span = (segment.onset.min(now), segment.end.min(now));
                if self.pending.ended(sound, span) {
                    fx.publish(Out::Recognise(sound, RecognitionInput::Speech(segment)));
                }
            }
            StreamEvent::Closed { stream, utterances, lost } => {
                self.pending.close(ClosedStream { key: stream, utterances, lost });
                self.report_closed_streams(fx);
            }
            StreamEvent::Silent { sound, reason } => {
                if let Some(sound) = self.pending.remove(sound) {
                    self.reject(&Origin::of(&sound, 0, 1), &reason, fx);
                }
            }
        }
        self.publish(fx);
    }

    /// Reports the end of streams whose utterances all have their results.
    fn report_closed_streams(&mut self, fx: &mut Fx) {
        for ClosedStream { key, utterances, lost } in self.pending.take_closed() {
            let note = match lost {
                0 => String::new(),
                lost => format!("{} lost in transit", scene::count(lost, "sample")),
            };
            self.report(Origin::closed(key, utterances).rejection(ReceiptStatus::Over, &note), fx);
        }
    }

    /// Publishes an interim result.
    pub(crate) fn interim_result(&mut self, sound: u64, text: &str, fx: &mut Fx) {
        if let Some(sound) = self.pending.in_progress(sound).copied() {
            self.publish_partial(&sound, text, false, fx);
        }
    }

    /// Handles the result for a possible end of a sound, which follows `question`: its words are an
    /// interim result, and determine the pause that ends it.
    pub(crate) fn early_result(
        &mut self,
        sound: u64,
        at: Closing,
        result: Option<&RecognisedSegment>,
        question: Question,
        fx: &mut Fx,
    ) {
        let next = self.early.decoded(sound, at);
        let Some(pending) = self.pending.in_progress(sound).copied() else { return };
        let Some(result) = result else { return };
        if let Some(text) = result.text() {
            self.publish_partial(&pending, text, false, fx);
        }
        let judged = self.config.endpointing.judge(result, question);
        let pause_s = self.config.endpointing.pause(judged, pending.interrupts).as_secs_f64();
        // The words alone end an utterance; no disk need be waited for.
        fx.publish_urgent(Out::Close(sound, Closing { pause_s, ..at }));
        // A complete utterance ends with these samples.
        if let Some(segment) = next.filter(|_| judged != Completeness::Complete) {
            fx.publish(Out::DecodeEarly(sound, segment));
            self.early.begun(sound, at);
        }
    }

    /// Publishes the words of a sound so far; `over`: it has its result.
    fn publish_partial(&mut self, sound: &PendingSound, text: &str, over: bool, fx: &mut Fx) {
        self.last_partial += 1;
        let partial = sound.partial(self.last_partial, text, over);
        fx.publish(Out::Partial(Box::new(partial)));
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

    /// Handles the result of the recogniser. Returns whether the robot's own voice covers an
    /// essential part of a user's utterance.
    pub(crate) fn recognised(
        &mut self,
        recognised: Recognised,
        player: &mut PromptPlayer,
        now: Time,
        fx: &mut Fx,
    ) -> bool {
        let Some(sound) = self.pending.remove(recognised.sound) else { return false };
        if sound.source == Source::Microphone {
            self.publish_partial(&sound, "", true, fx);
        }
        let segments = match recognised.segments {
            Ok(segments) if segments.is_empty() => Err("no speech found".to_owned()),
            segments => segments,
        };
        let segments = segments.unwrap_or_else(|reason| {
            self.reject(&Origin::of(&sound, 0, 1), &reason, fx);
            Vec::new()
        });
        let (count, mut is_covered) = (segments.len() as u32, false);
        for (number, segment) in (0..).zip(segments) {
            let origin = Origin::of(&sound, number, count).measured(&segment, now);
            self.status.set_measured(origin.span.0, segment.snr_db);
            let is_echo = |heard: &str| player.lines().is_echo(heard, origin.span.0);
            match meant(segment.hypotheses, sound.is_cut, is_echo) {
                Ok(hypotheses) => self.hear(origin, hypotheses, player, now, fx),
                Err(rejected) => {
                    is_covered |= rejected.reason == GateVerdict::Covered;
                    let receipt = Receipt {
                        gate_score: rejected.score as f32,
                        verdict: rejected.reason.code(),
                        ..origin.rejection(ReceiptStatus::NotForMe, &rejected.text)
                    };
                    self.report(receipt, fx);
                }
            }
        }
        self.report_closed_streams(fx);
        self.publish(fx);
        is_covered
    }

    /// Accepts a heard utterance, ahead of waiting requests: users are slower than the recogniser.
    fn hear(
        &mut self,
        origin: Origin,
        hypotheses: Vec<Hypothesis>,
        player: &mut PromptPlayer,
        now: Time,
        fx: &mut Fx,
    ) {
        if self.repeat(&origin, fx) {
            return;
        }
        match UtteranceContent::words(hypotheses).checked(&self.config) {
            Ok(content) => {
                self.obey_stop(&origin, &content, now, fx);
                self.accept(origin, content, player, now, fx);
            }
            Err(reason) => {
                self.reject(&origin, &reason, fx);
            }
        }
    }

    /// Publishes the receipt of a segment that was accepted before, perhaps before a restart: it
    /// keeps its number. Returns `false` if it is new.
    fn repeat(&self, origin: &Origin, fx: &mut Fx) -> bool {
        let known = self.accepted.find(origin.key, origin.segment.0);
        let receipt = known.map(|accepted| Out::Receipt(Box::new(accepted.receipt())));
        let is_known = receipt.is_some();
        receipt.into_iter().for_each(|receipt| fx.publish(receipt));
        is_known
    }

    /// Accepts an utterance if there is room for it.
    fn accept(
        &mut self,
        origin: Origin,
        content: UtteranceContent,
        player: &mut PromptPlayer,
        now: Time,
        fx: &mut Fx,
    ) {
        let seq = match self.accepted.next() {
            Ok(seq) => seq,
            Err(reason) => {
                self.reject(&origin, &reason, fx);
                return;
            }
        };
        let asked = player.answerable(origin.seen, origin.span.0, now, fx);
        let accepted = origin.accepted(seq, content, asked, now);
        fx.append(Record::Accepted(accepted.clone()));
        self.report(origin.with_views(accepted.receipt()), fx);
        fx.publish(Out::Utterance(Box::new(accepted.utterance())));
        self.accepted.add(accepted);
        self.publish_activity(fx);
    }

    /// Reports why the input makes no new utterance. Returns `false`.
    fn reject(&mut self, origin: &Origin, reason: &str, fx: &mut Fx) -> bool {
        self.report(origin.rejection(ReceiptStatus::Refused, reason), fx);
        false
    }

    fn report(&mut self, receipt: Receipt, fx: &mut Fx) {
        fx.publish(Out::Receipt(Box::new(receipt)));
        self.receipts.record(receipt);
    }

    /// Sends the utterances that are not applied yet, and the status.
    pub(crate) fn send(&self, fx: &mut Fx) {
        for accepted in self.accepted.to_send() {
            fx.publish(Out::Utterance(Box::new(accepted.utterance())));
        }
        self.publish(fx);
    }

    /// Returns whether a user is speaking or an utterance is still being processed. A sound that
    /// never ends, or a recogniser that never answers, does not silence the robot forever.
    pub(crate) fn is_busy(&self, now: Time) -> bool {
        let since = self.pending.since().into_iter().chain(self.accepted.oldest()).min();
        since.is_some_and(|since| now < since + BUSY_MAX)
    }
}

/// Returns a user's words to the robot, or those not acted on: a stop is obeyed whatever else is
/// unclear, even in the robot's own words; of anything else the part that is missing may be its
/// "not".
fn meant(
    hypotheses: Result<Vec<Hypothesis>, Rejected>,
    is_cut: bool,
    is_echo: impl FnOnce(&str) -> bool,
) -> Result<Vec<Hypothesis>, Rejected> {
    let best = match &hypotheses {
        Ok(hypotheses) => hypotheses.first().map_or("", |best| best.text.as_str()),
        Err(rejected) => &rejected.text,
    };
    let rejected = |text, reason| Err(Rejected { text, reason, score: 1.0 });
    match hypotheses {
        _ if language::is_stop(best) => {
            hypotheses.or_else(|rejected| Ok(vec![Hypothesis::certain(rejected.text)]))
        }
        Ok(_) if is_cut => rejected(format!("… {best}"), GateVerdict::Covered),
        Ok(_) if is_echo(best) => rejected(best.to_owned(), GateVerdict::Echo),
        hypotheses => hypotheses,
    }
}

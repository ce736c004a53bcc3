//! Hearing: each utterance accepted once, numbered without a gap, and sent until it is applied.

mod partials;
mod piece;
mod told;

use crate::devices::microphone::MicrophoneStatus;
use crate::listening::Listening;
use crate::live::{Began, Live};
use crate::mouth::Mouth;
use crate::record::{Accepted, Hypothesis, Record};
use crate::said::Content;
use crate::transcript;
use crate::{Config, Fx, Out, Recognised, Segment, ToRecognise};
use messages::outbox::Outbox;
use messages::{
    Activity, AppliedMark, EarState, FixedText, Hearing, Injection, MotionCommand, MotionOrder,
    Receipt, ReceiptStatus, RequestKey, Sound, Source, UtteranceSeq, topics,
};
use partials::Partials;
use piece::Piece;
use scene::{Intent, Question};
use service::{Span, Time};
use std::collections::VecDeque;
use std::ops::RangeInclusive;
use told::{receipt, utterance};

/// Utterances that wait to be applied at a time; beyond it people are asked to wait.
const WAITING_MAX: usize = 256;
/// Longest time that a person's speech holds back what the robot has to say.
const HOLD_MAX: Span = Span::from_ms(10_000);
/// Answered requests that are remembered, so that a repeated one gets the same answer.
const ANSWERED_MAX: usize = 128;
/// Streams whose end waits to be told.
const STREAMS_MAX: usize = 64;
/// How long somebody may ask to talk, seconds.
const TALK_S: RangeInclusive<f64> = 1.0..=60.0;

/// The hearing half of the node.
pub(crate) struct Ears {
    config: Config,
    outbox: Outbox<Accepted>,
    answered: VecDeque<Receipt>,
    recent: VecDeque<Accepted>,
    listening: Listening,
    state: EarState,
    hearing: Hearing,
    partials: Partials,
    /// Clients' streams that are over and of which something is still being recognised: utterances
    /// and samples lost.
    over: Vec<(RequestKey, u32, u64)>,
    /// Whether the policy's mark is known. Before that a number could be given out twice.
    marked: bool,
}

impl Ears {
    pub(crate) fn new(config: Config) -> Self {
        Self {
            config,
            outbox: Outbox::new(UtteranceSeq(0), topics::WINDOW, WAITING_MAX),
            answered: VecDeque::new(),
            recent: VecDeque::new(),
            listening: Listening::default(),
            state: EarState::Loading,
            hearing: Hearing::default(),
            partials: Partials::default(),
            over: Vec::new(),
            marked: false,
        }
    }

    /// Takes in an utterance that the journal holds.
    pub(crate) fn remember(&mut self, accepted: Accepted) {
        self.answer(receipt(&accepted));
        keep(&mut self.recent, accepted.clone());
        if accepted.seq > self.outbox.last() {
            self.outbox.push(accepted.seq, accepted);
        }
    }

    /// A client's sound. Before the policy's mark is known nothing is taken; the client asks again.
    /// Returns whether a person has something to say at this moment.
    pub(crate) fn hear(
        &mut self,
        injection: Injection,
        mouth: &Mouth,
        now: Time,
        fx: &mut Fx,
    ) -> bool {
        let listening = self.listening.has(injection.key);
        if listening || self.answer_again(injection.key, fx) || !self.marked {
            return false;
        }
        let onset = Time(injection.onset_ns).min(now);
        let onset = if onset == Time(0) { now } else { onset };
        let end = Time(injection.end_ns).min(now).max(onset);
        let end = if injection.end_ns == 0 { now } else { end };
        let whole = Piece::whole(injection.key, (onset, end));
        match injection.sound {
            Sound::Text(text) => {
                let content = Content::words(vec![Hypothesis::certain(text)], Source::Text);
                self.accept(whole, content, mouth, now, fx)
            }
            Sound::Point { target_m, words } => {
                self.accept(whole, Content::pointing(target_m, words), mouth, now, fx)
            }
            Sound::Wav(path) => {
                let sound = self.listening.take(injection.key, Source::Wav, onset);
                fx.publish(Out::Recognise(sound, ToRecognise::File(path)));
                false
            }
            Sound::Transcript { hypotheses } => match transcript::hypotheses(hypotheses) {
                Ok(hypotheses) => {
                    let content = Content::words(hypotheses, Source::Browser);
                    self.accept(Piece { source: Source::Browser, ..whole }, content, mouth, now, fx)
                }
                Err(reason) => self.refuse(whole, &reason, fx),
            },
            Sound::Talk { longest_s } if TALK_S.contains(&longest_s) => {
                let sound = self.listening.take(injection.key, Source::Microphone, now);
                fx.publish(Out::Talk(sound, Span::from_s(longest_s)));
                self.publish(fx);
                true
            }
            Sound::Talk { longest_s } => {
                let (least, most) = (TALK_S.start(), TALK_S.end());
                let reason = format!("nobody talks for {longest_s} s: use {least} to {most}");
                self.refuse(whole, &reason, fx)
            }
        }
    }

    /// What a live source has to tell.
    pub(crate) fn live(&mut self, live: Live, now: Time, fx: &mut Fx) {
        match live {
            Live::SoFar { sound, samples } => {
                return self.partials.overhear(&self.listening, sound, samples, fx);
            }
            Live::Paused { sound, cut } => {
                return self.partials.expect(&self.listening, sound, cut, fx);
            }
            Live::Began(began) => self.began(&began, now),
            Live::Ended { sound, cut } => {
                let span = (cut.onset.min(now), cut.end.min(now));
                if self.listening.ended(sound, span) {
                    fx.publish(Out::Recognise(sound, ToRecognise::Speech(cut)));
                }
            }
            Live::Over { stream, utterances, lost } => {
                self.stream_over(stream, utterances, lost, fx);
            }
            Live::Silent { sound, reason } => {
                if let Some(listened) = self.listening.remove(sound) {
                    self.refuse(Piece::of(&listened, 0, 1), &reason, fx);
                }
            }
        }
        self.publish(fx);
    }

    fn began(&mut self, began: &Began, now: Time) {
        self.listening.began(began, now);
        self.hearing.onset_ns = began.at.min(now).ns();
    }

    /// A client's stream is over. It is told so once everything said in it has its result.
    fn stream_over(&mut self, stream: RequestKey, utterances: u32, lost: u64, fx: &mut Fx) {
        // Clients repeat the end until they are told; what is said behind the first tells less.
        if self.over.iter().all(|(key, ..)| *key != stream) {
            if self.over.len() >= STREAMS_MAX {
                self.over.remove(0);
            }
            self.over.push((stream, utterances, lost));
        }
        self.tell_streams_over(fx);
    }

    fn tell_streams_over(&mut self, fx: &mut Fx) {
        let listening = &self.listening;
        let ready = self.over.extract_if(.., |(key, ..)| !listening.has(*key));
        for (key, utterances, lost) in ready.collect::<Vec<_>>() {
            let note = match lost {
                0 => String::new(),
                lost => format!("{lost} samples were lost on their way"),
            };
            let piece = Piece { segment: (u32::MAX, utterances), ..Piece::of_stream(key) };
            self.report(piece, ReceiptStatus::Over, &note, fx);
        }
    }

    /// What the recogniser makes of a sound that is being spoken.
    pub(crate) fn so_far(&mut self, sound: u64, text: &str, fx: &mut Fx) {
        self.partials.told(&self.listening, sound, text, fx);
    }

    /// How the microphone is.
    pub(crate) fn set_microphone(&mut self, status: &MicrophoneStatus, fx: &mut Fx) {
        self.hearing.microphone = status.state.code();
        self.hearing.level_db = status.level_db;
        self.hearing.restarts = status.restarts;
        self.hearing.dropped = status.dropped;
        self.hearing.note = FixedText::truncated(&status.note);
        self.publish_hearing(fx);
    }

    fn publish(&self, fx: &mut Fx) {
        fx.publish(Out::Activity(self.activity()));
        self.publish_hearing(fx);
    }

    fn publish_hearing(&self, fx: &mut Fx) {
        let (pending, ear) = (self.listening.len() as u32, self.state.code());
        fx.publish(Out::Hearing(Hearing { pending, ear, ..self.hearing }));
    }

    /// What the recogniser made of a sound.
    pub(crate) fn recognised(
        &mut self,
        recognised: Recognised,
        mouth: &Mouth,
        now: Time,
        fx: &mut Fx,
    ) {
        let Some(listened) = self.listening.remove(recognised.sound) else { return };
        self.partials.over(&listened, fx);
        match recognised.segments {
            Ok(segments) if segments.is_empty() => {
                self.refuse(Piece::of(&listened, 0, 1), "no speech in it", fx);
            }
            Ok(segments) => {
                let count = segments.len() as u32;
                for (i, segment) in segments.into_iter().enumerate() {
                    let piece = Piece::of(&listened, i as u32, count);
                    self.understood(piece.cut(&segment, now), segment, mouth, now, fx);
                }
            }
            Err(reason) => {
                self.refuse(Piece::of(&listened, 0, 1), &reason, fx);
            }
        }
        self.tell_streams_over(fx);
        self.publish(fx);
    }

    fn understood(
        &mut self,
        piece: Piece,
        segment: Segment,
        mouth: &Mouth,
        now: Time,
        fx: &mut Fx,
    ) {
        self.hearing.onset_ns = piece.span.0.ns();
        (self.hearing.snr_db, self.hearing.measured) = (segment.snr_db, 1);
        match segment.heard {
            Ok(hypotheses) => {
                let content = Content::words(hypotheses, piece.source);
                self.accept(piece, content, mouth, now, fx);
            }
            Err(text) => self.report(piece, ReceiptStatus::NotForMe, &text, fx),
        }
    }

    /// Takes in an utterance. Returns whether it is a new one.
    fn accept(
        &mut self,
        piece: Piece,
        content: Content,
        mouth: &Mouth,
        now: Time,
        fx: &mut Fx,
    ) -> bool {
        // A piece that was accepted before a restart keeps its number.
        let known = |a: &&Accepted| a.key == piece.key && a.segment.0 == piece.segment.0;
        if let Some(accepted) = self.recent.iter().find(known) {
            fx.publish(Out::Receipt(Box::new(receipt(accepted))));
            return false;
        }
        if let Some(reason) = content.fault(&self.config) {
            return self.refuse(piece, &reason, fx);
        }
        if !self.marked {
            return self.refuse(piece, "the robot is not ready yet; say it again", fx);
        }
        let seq = match self.outbox.next() {
            Ok(seq) => seq,
            Err(full) => return self.refuse(piece, &full.to_string(), fx),
        };
        if self.says_stop(&content.hypotheses) {
            let order = MotionOrder::Stop.code();
            let command = MotionCommand { given_ns: now.ns(), order, ..MotionCommand::default() };
            fx.publish(Out::Motion(command));
        }
        let accepted = Accepted {
            seq,
            key: piece.key,
            segment: piece.segment,
            hypotheses: content.hypotheses,
            gesture: content.gesture,
            source: content.source,
            asked: mouth.asked(),
            onset: piece.span.0,
            end: piece.span.1,
            snr_db: piece.snr_db,
            accepted: now,
        };
        fx.append(Record::Accepted(accepted.clone()));
        fx.publish(Out::Receipt(Box::new(receipt(&accepted))));
        fx.publish(Out::Utterance(Box::new(utterance(&accepted))));
        self.remember(accepted);
        fx.publish(Out::Activity(self.activity()));
        true
    }

    fn says_stop(&self, hypotheses: &[Hypothesis]) -> bool {
        hypotheses.first().is_some_and(|best| {
            self.config.reader.read(&best.text, Question::None).intent == Intent::Stop
        })
    }

    /// Tells why there is no new utterance.
    fn refuse(&mut self, piece: Piece, reason: &str, fx: &mut Fx) -> bool {
        self.report(piece, ReceiptStatus::Refused, reason, fx);
        false
    }

    fn report(&mut self, piece: Piece, status: ReceiptStatus, note: &str, fx: &mut Fx) {
        let receipt = Receipt {
            key: piece.key.0,
            segment: piece.segment.0,
            segments: piece.segment.1,
            onset_ns: piece.span.0.ns(),
            end_ns: piece.span.1.ns(),
            snr_db: piece.snr_db,
            status: status.code(),
            source: piece.source.code(),
            note: FixedText::truncated(note),
            ..Receipt::default()
        };
        fx.publish(Out::Receipt(Box::new(receipt)));
        self.answer(receipt);
    }

    fn answer(&mut self, receipt: Receipt) {
        keep(&mut self.answered, receipt);
    }

    /// Gives the answer to a request once more, if it has been answered in full.
    fn answer_again(&self, key: RequestKey, fx: &mut Fx) -> bool {
        let answers = || self.answered.iter().filter(|receipt| receipt.request() == key);
        let segments = answers().next().map_or(u32::MAX, |receipt| receipt.segments);
        if answers().count() < segments as usize {
            return false;
        }
        answers().for_each(|receipt| fx.publish(Out::Receipt(Box::new(*receipt))));
        true
    }

    /// The policy's mark. Returns whether it is news.
    pub(crate) fn acknowledge(&mut self, mark: AppliedMark) -> bool {
        let (before, was_marked) = (self.outbox.len(), self.marked);
        self.outbox.acknowledge(UtteranceSeq(mark.seq));
        self.marked = true;
        self.outbox.len() != before || !was_marked
    }

    pub(crate) fn set_state(&mut self, state: EarState, fx: &mut Fx) {
        self.state = state;
        self.publish(fx);
    }

    pub(crate) fn pending_since(&self) -> Option<Time> {
        self.outbox.window().next().map(|(_, accepted)| accepted.accepted)
    }

    /// Sends what is not yet applied. Without the mark all of it might be.
    pub(crate) fn send(&self, fx: &mut Fx) {
        if self.marked {
            for (_, accepted) in self.outbox.window() {
                fx.publish(Out::Utterance(Box::new(utterance(accepted))));
            }
        }
        self.publish(fx);
    }

    /// Since when somebody speaks, or was heard and is not yet understood and applied.
    fn busy_since(&self) -> Option<Time> {
        let waiting = self.outbox.window().map(|(_, accepted)| accepted.accepted);
        self.listening.since().into_iter().chain(waiting).min()
    }

    /// Whether the robot holds its tongue: a person speaks, or what was said is not applied yet. A
    /// sound that never ends, or a recogniser that never answers, does not silence it for ever.
    pub(crate) fn somebody_speaks(&self, now: Time) -> bool {
        self.busy_since().is_some_and(|since| now < since + HOLD_MAX)
    }

    fn activity(&self) -> Activity {
        Activity {
            onset_ns: self.listening.since().map_or(0, Time::ns),
            pending: (self.listening.len() + self.outbox.len()) as u32,
            ear: self.state.code(),
            ..Activity::default()
        }
    }

    /// The utterances that a new journal must begin with; none while some are not yet applied.
    pub(crate) fn snapshot(&self) -> Option<Vec<Accepted>> {
        self.outbox.is_empty().then(|| self.recent.iter().cloned().collect())
    }
}

fn keep<T>(queue: &mut VecDeque<T>, item: T) {
    if queue.len() >= ANSWERED_MAX {
        queue.pop_front();
    }
    queue.push_back(item);
}

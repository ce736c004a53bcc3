//! Hearing: each utterance accepted once, numbered without a gap, and sent until it is applied.

use crate::mouth::Mouth;
use crate::record::{Accepted, Hypothesis, Record, Said};
use crate::said::{Content, in_words};
use crate::{Config, Fx, Out, Recognised, Segment};
use node::{Span, Time};
use protocol::outbox::Outbox;
use protocol::{
    Activity, AppliedMark, AskedQuestion, EarState, FixedText, Injection, MotionCommand,
    MotionOrder, Receipt, ReceiptStatus, RequestKey, Sound, Source, Utterance, UtteranceSeq,
    topics,
};
use scene::{Intent, Question};
use std::collections::{BTreeMap, VecDeque};

/// Utterances that wait to be applied at a time; beyond it people are asked to wait.
const WAITING_MAX: usize = 256;
/// Longest time that a person's speech holds back what the robot has to say.
const HOLD_MAX: Span = Span::from_ms(10_000);
/// Answered requests that are remembered, so that a repeated one gets the same answer.
const ANSWERED_MAX: usize = 128;

/// The hearing half of the node.
pub(crate) struct Ears {
    config: Config,
    outbox: Outbox<Accepted>,
    answered: VecDeque<Receipt>,
    recent: VecDeque<Accepted>,
    /// Sounds that the recogniser is listening to: whose they are and when they began.
    listening: BTreeMap<u64, (RequestKey, Time)>,
    last_sound: u64,
    /// When the person who is speaking just now began.
    speaking: Option<Time>,
    state: EarState,
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
            listening: BTreeMap::new(),
            last_sound: 0,
            speaking: None,
            state: EarState::Loading,
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
    pub(crate) fn hear(&mut self, injection: Injection, mouth: &Mouth, now: Time, fx: &mut Fx) {
        let listening = self.listening.values().any(|(key, _)| *key == injection.key);
        if self.answer_again(injection.key, fx) || listening || !self.marked {
            return;
        }
        let onset = Time(injection.onset_ns).min(now);
        let onset = if onset == Time(0) { now } else { onset };
        let whole = Piece { key: injection.key, segment: (0, 1), span: (onset, now) };
        match injection.sound {
            Sound::Text(text) => {
                let content = Content::words(vec![Hypothesis::certain(text)], Source::Text);
                self.accept(whole, content, mouth, now, fx);
            }
            Sound::Point { target_m, words } => {
                self.accept(whole, Content::pointing(target_m, words), mouth, now, fx);
            }
            Sound::Wav(path) => {
                self.last_sound += 1;
                self.listening.insert(self.last_sound, (injection.key, onset));
                fx.publish(Out::Recognise(self.last_sound, path));
            }
            Sound::Talk { .. } => {}
        }
    }

    /// What the recogniser made of a sound.
    pub(crate) fn recognised(
        &mut self,
        recognised: Recognised,
        mouth: &Mouth,
        now: Time,
        fx: &mut Fx,
    ) {
        let Some((key, began)) = self.listening.remove(&recognised.sound) else { return };
        let segments = match recognised.segments {
            Ok(segments) if segments.is_empty() => {
                return self.refuse(key, (0, 1), "no speech in it", fx);
            }
            Ok(segments) => segments,
            Err(reason) => return self.refuse(key, (0, 1), &reason, fx),
        };
        let count = segments.len() as u32;
        for (i, Segment { span_s, heard }) in segments.into_iter().enumerate() {
            let at = |s: f64| (began + Span::from_s(s)).min(now);
            let span = (at(span_s.0), at(span_s.1));
            let piece = Piece { key, segment: (i as u32, count), span };
            match heard {
                Ok(hypotheses) => {
                    let content = Content::words(hypotheses, Source::Wav);
                    self.accept(piece, content, mouth, now, fx);
                }
                Err(text) => self.report(piece, ReceiptStatus::NotForMe, 0, &text, fx),
            }
        }
    }

    fn accept(&mut self, piece: Piece, content: Content, mouth: &Mouth, now: Time, fx: &mut Fx) {
        // A piece that was accepted before a restart keeps its number.
        let known = |a: &&Accepted| a.key == piece.key && a.segment.0 == piece.segment.0;
        if let Some(accepted) = self.recent.iter().find(known) {
            fx.publish(Out::Receipt(Box::new(receipt(accepted))));
            return;
        }
        if let Some(reason) = content.fault(&self.config) {
            return self.refuse(piece.key, piece.segment, &reason, fx);
        }
        let seq = match self.outbox.next() {
            Ok(seq) => seq,
            Err(full) => return self.refuse(piece.key, piece.segment, &full.to_string(), fx),
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
            source: content.source.code(),
            asked: mouth.asked(),
            onset: piece.span.0,
            end: piece.span.1,
            accepted: now,
        };
        fx.append(Record::Accepted(accepted.clone()));
        fx.publish(Out::Receipt(Box::new(receipt(&accepted))));
        fx.publish(Out::Utterance(Box::new(utterance(&accepted))));
        self.remember(accepted);
        fx.publish(Out::Activity(self.activity()));
    }

    fn says_stop(&self, hypotheses: &[Hypothesis]) -> bool {
        hypotheses.first().is_some_and(|best| {
            self.config.reader.read(&best.text, Question::None).reading.intent == Intent::Stop
        })
    }

    fn refuse(&mut self, key: RequestKey, segment: (u32, u32), reason: &str, fx: &mut Fx) {
        let piece = Piece { key, segment, span: (Time(0), Time(0)) };
        self.report(piece, ReceiptStatus::Refused, 0, reason, fx);
    }

    fn report(&mut self, piece: Piece, status: ReceiptStatus, seq: u64, note: &str, fx: &mut Fx) {
        let receipt = Receipt {
            key: piece.key.0,
            seq,
            segment: piece.segment.0,
            segments: piece.segment.1,
            status: status.code(),
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

    pub(crate) fn set_state(&mut self, state: EarState) {
        self.state = state;
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
        fx.publish(Out::Activity(self.activity()));
    }

    /// Somebody began to speak, or has ended.
    pub(crate) fn set_speaking(&mut self, since: Option<Time>, fx: &mut Fx) {
        self.speaking = since;
        fx.publish(Out::Activity(self.activity()));
    }

    /// Since when somebody speaks, or was heard and is not yet understood and applied.
    fn busy_since(&self) -> Option<Time> {
        let listening = self.listening.values().map(|(_, began)| *began);
        let waiting = self.outbox.window().map(|(_, accepted)| accepted.accepted);
        self.speaking.into_iter().chain(listening).chain(waiting).min()
    }

    /// Whether the robot holds its tongue: a person speaks, or what was said is not applied yet. A
    /// sound that never ends, or a recogniser that never answers, does not silence it for ever.
    pub(crate) fn somebody_speaks(&self, now: Time) -> bool {
        self.busy_since().is_some_and(|since| now < since + HOLD_MAX)
    }

    fn activity(&self) -> Activity {
        let listening = self.listening.values().map(|(_, began)| *began);
        let onset = self.speaking.into_iter().chain(listening).min();
        Activity {
            onset_ns: onset.map_or(0, Time::ns),
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

/// A piece of a client's sound.
#[derive(Clone, Copy)]
struct Piece {
    key: RequestKey,
    segment: (u32, u32),
    span: (Time, Time),
}

fn keep<T>(queue: &mut VecDeque<T>, item: T) {
    if queue.len() >= ANSWERED_MAX {
        queue.pop_front();
    }
    queue.push_back(item);
}

fn receipt(accepted: &Accepted) -> Receipt {
    let text = accepted.hypotheses.first().map_or("", |best| best.text.as_str());
    Receipt {
        key: accepted.key.0,
        seq: accepted.seq.0,
        segment: accepted.segment.0,
        segments: accepted.segment.1,
        status: ReceiptStatus::Accepted.code(),
        note: FixedText::truncated(&in_words(text, accepted.gesture)),
        ..Receipt::default()
    }
}

fn utterance(accepted: &Accepted) -> Utterance {
    let mut utterance = Utterance {
        seq: accepted.seq.0,
        gesture: accepted.gesture.into(),
        onset_ns: accepted.onset.ns(),
        end_ns: accepted.end.ns(),
        accepted_ns: accepted.accepted.ns(),
        source: accepted.source,
        ..Utterance::default()
    };
    let asked: Vec<AskedQuestion> = accepted.asked.iter().map(asked_question).collect();
    utterance.set_asked(&asked);
    let heard: Vec<protocol::Hypothesis<'_>> = (accepted.hypotheses.iter())
        .map(|Hypothesis { text, weight, confidence }| {
            let confidence = confidence.clone();
            protocol::Hypothesis { text, weight: *weight, confidence }
        })
        .collect();
    if utterance.set_hypotheses(&heard).is_err() {
        // The best one fits (it was checked when it was accepted); the others are a refinement.
        let best = heard.get(..1).unwrap_or_default();
        let fitted = utterance.set_hypotheses(best);
        debug_assert!(fitted.is_ok(), "an accepted utterance fits");
    }
    utterance
}

fn asked_question(said: &Said) -> AskedQuestion {
    AskedQuestion {
        prompt: said.prompt.0,
        scene: said.scene_key,
        began_ns: said.started.ns(),
        ended_ns: if said.whole || said.ended > said.started { said.ended.ns() } else { 0 },
        question: said.question.into(),
        presentation: said.presentation,
        whole: u8::from(said.whole),
        ..AskedQuestion::default()
    }
}

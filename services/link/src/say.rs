//! Words of people over a link, applied exactly once.
//!
//! The group's protocol is unchanged: a client repeats its [`Injection`] under one key until its
//! receipts arrive, and the speech service applies a key once. The mirror repeats the request under
//! that key, the link the injection; lost answers are repeated. Times travel as ages.

use std::collections::VecDeque;

use messages::{Injection, PromptId, Receipt, RequestKey, Sound};
use serde::{Deserialize, Serialize};
use service::bounded::push_bounded;
use service::submission::Submission;
use service::{Span, Time};

use crate::offset::{age_ns, time_ns};

/// Time that the robot's link takes for a request before the mirror asks again.
pub const PATIENCE: Span = Span::from_ms(2_000);
/// As [`PATIENCE`], for a sound file: it travels for a while, and is then understood.
pub const FILE_PATIENCE: Span = Span::from_ms(60_000);
/// Additional time after which the mirror asks again without any answer.
const GRACE: Span = Span::from_ms(500);
/// Shortest interval at which the mirror asks again.
const ASK_AGAIN: Span = Span::from_ms(250);
/// Time after which a request that its client no longer repeats is given up.
const GIVEN_UP: Span = Span::from_ms(3_000);
/// Requests whose answers are remembered.
const ANSWERED_MAX: usize = 64;
/// Requests on their way.
const WAITING_MAX: usize = messages::topics::WINDOW;
/// Callers of one request that wait for its answer; the oldest of more have asked again since.
const CALLERS_MAX: usize = 8;

/// An injection on its way to the robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Said {
    /// See [`Injection`].
    pub key: RequestKey,
    /// Time since the person began, nanoseconds.
    pub onset_age_ns: Option<u64>,
    /// Time since the person had ended, nanoseconds.
    pub end_age_ns: Option<u64>,
    /// See [`Injection`].
    pub seen_prompt: u64,
    /// See [`Injection`].
    pub from: String,
    /// The sound said. A file is sent as its contents.
    pub sound: Sent,
}

/// Input of a client under way to the robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Sent {
    /// Anything but a file.
    Sound(Sound),
    /// The contents of a WAV file.
    File(Vec<u8>),
}

impl Sent {
    /// Time that the robot's link takes for it.
    pub fn patience(&self) -> Span {
        match self {
            Self::Sound(Sound::Wav(_)) | Self::File(_) => FILE_PATIENCE,
            Self::Sound(_) => PATIENCE,
        }
    }
}

/// The robot's answer: the receipts, and when they were sent by the robot's clock.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Receipts {
    /// Time of sending.
    pub sent_ns: u64,
    /// One for text, one for every utterance in a sound file.
    pub receipts: Vec<Receipt>,
}

/// The robot's side: requests that wait for their receipts. `Q` is the way back.
#[derive(Debug)]
pub struct Asked<Q> {
    waiting: Vec<Waiting<Q>>,
    answered: VecDeque<(RequestKey, Vec<Receipt>)>,
}

#[derive(Debug)]
struct Waiting<Q> {
    submission: Submission,
    callers: Vec<Q>,
}

impl<Q> Default for Asked<Q> {
    fn default() -> Self {
        Self { waiting: Vec::new(), answered: VecDeque::new() }
    }
}

impl<Q> Asked<Q> {
    /// Takes a request, whose sound is `sound` on this machine. Returns the caller with the
    /// receipts if they are known already; a caller without room is dropped, and asks again.
    pub fn take(
        &mut self,
        said: &Said,
        sound: Sound,
        caller: Q,
        now: Time,
    ) -> Option<(Q, Vec<Receipt>)> {
        if let Some(receipts) = self.answer(said.key) {
            return Some((caller, receipts.to_vec()));
        }
        let known = self.waiting.iter_mut().find(|waiting| waiting.submission.key() == said.key);
        if let Some(waiting) = known {
            if waiting.callers.len() >= CALLERS_MAX {
                waiting.callers.remove(0);
            }
            waiting.callers.push(caller);
            return None;
        }
        if self.has_room() {
            let times = (said.onset_age_ns, said.end_age_ns);
            let times = (Time(time_ns(times.0, now)), Time(time_ns(times.1, now)));
            let submission = Submission::new(sound, times, now, said.sound.patience())
                .after(PromptId(said.seen_prompt))
                .by(&said.from)
                .under(said.key);
            self.waiting.push(Waiting { submission, callers: vec![caller] });
        }
        None
    }

    /// Drops requests that have waited too long, and returns their keys: the mirror asks again.
    pub fn expire(&mut self, now: Time) -> Vec<RequestKey> {
        let is_expired = |waiting: &mut Waiting<Q>| waiting.submission.is_expired(now);
        self.waiting.extract_if(.., is_expired).map(|waiting| waiting.submission.key()).collect()
    }

    /// Returns the injections that are due at `now`.
    pub fn due(&mut self, now: Time) -> Vec<Injection> {
        let due =
            self.waiting.iter_mut().filter_map(|waiting| waiting.submission.due(now).cloned());
        due.collect()
    }

    /// Takes a receipt of any client; returns those who wait for it once they have all of theirs.
    pub fn on_receipt(&mut self, receipt: &Receipt) -> Option<(Vec<Q>, Vec<Receipt>)> {
        let place = self
            .waiting
            .iter()
            .position(|waiting| waiting.submission.key() == receipt.request())?;
        let waiting = self.waiting.get_mut(place)?;
        waiting.submission.on_receipt(receipt);
        let receipts = waiting.submission.receipts()?.to_vec();
        let waiting = self.waiting.swap_remove(place);
        push_bounded(&mut self.answered, ANSWERED_MAX, (receipt.request(), receipts.clone()));
        Some((waiting.callers, receipts))
    }

    /// Returns whether requests wait.
    pub fn is_waiting(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// Returns whether one more request finds room.
    pub fn has_room(&self) -> bool {
        self.waiting.len() < WAITING_MAX
    }

    /// Returns the receipts of the request with this key, if it was answered lately.
    pub fn answer(&self, key: RequestKey) -> Option<&[Receipt]> {
        let found = self.answered.iter().find(|(known, _)| *known == key);
        found.map(|(_, receipts)| receipts.as_slice())
    }

    /// Returns whether the request with this key still waits.
    pub fn waits_for(&self, key: RequestKey) -> bool {
        self.waiting.iter().any(|waiting| waiting.submission.key() == key)
    }
}

/// The mirror's side: injections of local clients on their way to the robot.
#[derive(Debug, Default)]
pub struct Outbound {
    waiting: Vec<Pending>,
    answered: VecDeque<(RequestKey, Vec<Receipt>)>,
}

#[derive(Debug)]
struct Pending {
    injection: Injection,
    arrived: Time,
    repeated: Time,
    /// Time of the next request.
    due: Time,
}

impl Outbound {
    /// Takes an injection of a local client, and each repetition. Returns the receipts, if known.
    pub fn take(&mut self, injection: Injection, now: Time) -> Option<&[Receipt]> {
        let key = injection.key;
        if let Some(place) = self.answered.iter().position(|(known, _)| *known == key) {
            return self.answered.get(place).map(|(_, receipts)| receipts.as_slice());
        }
        let known = self.waiting.iter_mut().find(|pending| pending.injection.key == key);
        if let Some(pending) = known {
            pending.repeated = now;
        } else if self.waiting.len() < WAITING_MAX {
            self.waiting.push(Pending { injection, arrived: now, repeated: now, due: now });
        }
        None
    }

    /// Returns the requests due at `now`, and drops those that their clients no longer repeat.
    pub fn due(&mut self, now: Time) -> Vec<Said> {
        self.waiting.retain(|pending| now < pending.repeated + GIVEN_UP);
        let is_due = |pending: &&mut Pending| now >= pending.due;
        let due = self.waiting.iter_mut().filter(is_due).map(|pending| {
            let Pending { injection, arrived, due, .. } = pending;
            let Injection { key, onset_ns, end_ns, seen_prompt, ref from, ref sound } = *injection;
            // Words are old by the time they are sent again.
            let age = |at_ns| age_ns(at_ns, now).or_else(|| age_ns(arrived.ns(), now));
            let sent = Sent::Sound(sound.clone());
            *due = now + sent.patience() + GRACE;
            let (onset_age_ns, end_age_ns) = (age(onset_ns), age(end_ns));
            Said { key, onset_age_ns, end_age_ns, seen_prompt, from: from.clone(), sound: sent }
        });
        due.collect()
    }

    /// The request has ended at `now` without an answer: it is asked again soon.
    pub fn on_silence(&mut self, key: RequestKey, now: Time) {
        let waiting = self.waiting.iter_mut().filter(|pending| pending.injection.key == key);
        waiting.for_each(|pending| pending.due = pending.due.min(now + ASK_AGAIN));
    }

    /// Takes the receipts of a request, in this machine's time. Returns whether they are new.
    pub fn on_answer(&mut self, key: RequestKey, receipts: &[Receipt]) -> bool {
        let before = self.waiting.len();
        self.waiting.retain(|pending| pending.injection.key != key);
        let is_new = self.waiting.len() < before;
        if is_new {
            push_bounded(&mut self.answered, ANSWERED_MAX, (key, receipts.to_vec()));
        }
        is_new
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn at(ms: u64) -> Time {
        Time(0) + Span::from_ms(ms)
    }

    fn injection(key: u8, onset: Time) -> Injection {
        Injection {
            key: RequestKey([key; 16]),
            onset_ns: onset.ns(),
            end_ns: 0,
            seen_prompt: 3,
            from: "Ann".to_owned(),
            sound: Sound::Text(format!("words {key}")),
        }
    }

    /// A small generator, so that a failure is repeated by its seed.
    struct Dice(u64);

    impl Dice {
        fn roll(&mut self, sides: u64) -> u64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (self.0 >> 33) % sides
        }
    }

    /// Speech that applies a key once and repeats its receipt.
    #[derive(Default)]
    struct Speech(BTreeMap<RequestKey, (u64, u32)>);

    impl Speech {
        fn hear(&mut self, injection: &Injection) -> Receipt {
            let next = self.0.len() as u64 + 1;
            let (seq, heard) = self.0.entry(injection.key).or_insert((next, 0));
            *heard += 1;
            Receipt { key: injection.key.0, seq: *seq, segments: 1, ..Receipt::default() }
        }
    }

    /// Runs one client's words through mirror, network and robot until `end_ms`; half of all
    /// messages are lost, and each may be half a second late. Returns the receipt's time.
    fn run(seed: u64) -> (Option<u64>, Speech) {
        let (mut dice, mut speech) = (Dice(seed), Speech::default());
        let (mut mirror, mut robot) = (Outbound::default(), Asked::<()>::default());
        let mut up: Vec<(u64, Said)> = Vec::new();
        let mut down: Vec<(u64, Vec<Receipt>)> = Vec::new();
        let mut done = None;
        for ms in (0..60_000).step_by(10) {
            let now = at(ms);
            if ms % 250 == 0 && done.is_none() && mirror.take(injection(1, at(0)), now).is_some() {
                done = Some(ms);
            }
            for said in mirror.due(now) {
                (0..dice.roll(3)).for_each(|_| up.push((ms + dice.roll(500), said.clone())));
            }
            let arrived = up.extract_if(.., |(at, _)| *at <= ms).collect::<Vec<_>>();
            for (_, said) in arrived {
                let sound = Sound::Text("words 1".into());
                if let Some(((), receipts)) = robot.take(&said, sound, (), now) {
                    down.push((ms + dice.roll(500), receipts));
                }
            }
            robot.expire(now);
            for injection in robot.due(now) {
                if dice.roll(2) == 0 {
                    let receipt = speech.hear(&injection);
                    if let Some((callers, receipts)) = robot.on_receipt(&receipt) {
                        for () in callers {
                            let lost = dice.roll(2) == 0;
                            (!lost).then(|| down.push((ms + dice.roll(500), receipts.clone())));
                        }
                    }
                }
            }
            for (_, receipts) in down.extract_if(.., |(at, _)| *at <= ms).collect::<Vec<_>>() {
                mirror.on_answer(RequestKey([1; 16]), &receipts);
            }
        }
        (done, speech)
    }

    #[test]
    fn words_are_applied_once_and_answered_whatever_is_lost_doubled_or_late() {
        for seed in 0..200 {
            let (done, speech) = run(seed);
            assert!(done.is_some(), "seed {seed}: never answered");
            assert_eq!(speech.0.len(), 1, "seed {seed}");
        }
    }

    #[test]
    fn times_travel_as_ages() {
        let mut mirror = Outbound::default();
        mirror.take(injection(1, at(10_000)), at(10_700));
        let said = mirror.due(at(10_800)).remove(0);
        assert_eq!(said.onset_age_ns, Some(Span::from_ms(800).0));
        assert_eq!(said.end_age_ns, Some(Span::from_ms(100).0), "it arrived then");
        // On the robot, whose clock shows something else.
        let mut robot = Asked::default();
        assert!(robot.take(&said, Sound::Text("words 1".into()), (), at(500_000)).is_none());
        let injection = robot.due(at(500_000)).remove(0);
        assert_eq!(injection.onset_ns, at(499_200).ns());
        assert_eq!(injection.end_ns, at(499_900).ns());
        assert_eq!((injection.key, injection.seen_prompt), (said.key, 3));
        assert_eq!(injection.from, "Ann");
    }

    #[test]
    fn words_that_their_client_has_given_up_are_not_said_later() {
        let mut mirror = Outbound::default();
        mirror.take(injection(1, at(0)), at(0));
        assert_eq!(mirror.due(at(0)).len(), 1);
        mirror.on_silence(RequestKey([1; 16]), at(500));
        assert_eq!(mirror.due(at(700)).len(), 0, "not without a pause");
        assert_eq!(mirror.due(at(2_900)).len(), 1);
        mirror.on_silence(RequestKey([1; 16]), at(2_900));
        assert_eq!(mirror.due(at(3_000)).len(), 0);
    }

    #[test]
    fn sound_files_are_waited_for_before_they_are_sent_again() {
        let mut mirror = Outbound::default();
        let sound = Sound::Wav("/tmp/ask.wav".into());
        let mut sent = Vec::new();
        for ms in (0..130_000).step_by(100) {
            mirror.take(Injection { sound: sound.clone(), ..injection(1, at(0)) }, at(ms));
            sent.extend(mirror.due(at(ms)).iter().map(|_| ms));
        }
        assert_eq!(sent, [0, 60_500, 121_000]);
    }

    #[test]
    fn robot_takes_a_bounded_number_of_requests_and_callers_and_returns_what_has_expired() {
        let mut robot = Asked::default();
        let said = |key: u8| Said {
            key: RequestKey([key; 16]),
            onset_age_ns: None,
            end_age_ns: None,
            seen_prompt: 0,
            from: String::new(),
            sound: Sent::Sound(Sound::Text("words".into())),
        };
        let sound = || Sound::Text("words".into());
        for key in 0..=u8::MAX {
            robot.take(&said(key), sound(), usize::from(key), at(0));
        }
        assert!(!robot.has_room());
        for caller in 0..1_000 {
            robot.take(&said(0), sound(), caller, at(1));
        }
        let receipt = Receipt { key: [0; 16], segments: 1, ..Receipt::default() };
        let (callers, _) = robot.on_receipt(&receipt).unwrap();
        assert_eq!(callers, (1_000 - CALLERS_MAX..1_000).collect::<Vec<_>>());
        assert!(robot.expire(at(1_000)).is_empty());
        assert_eq!(robot.expire(at(2_001)).len(), WAITING_MAX - 1);
        assert!(!robot.is_waiting());
    }
}

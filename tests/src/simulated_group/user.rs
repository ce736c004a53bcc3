//! The user of a simulated group: input channel, timing and answers.

use std::collections::{BTreeMap, HashSet};

use dialogue::Model;
use evaluation::simulation::SimulatedUser;
use evaluation::simulation::users::{
    Domain, Habits, Policy, Reply, TimedUser, TimedUtterance, Timing,
};
use messages::{Hypothesis, Injection, Receipt, RequestKey, Sound};
use scene::{ObjectId, Question, Scene};
use service::{Span, Time};
use vocabulary::Rng;

/// Input channel of a user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Typed: sent when the user begins.
    Typed,
    /// As typed, but the request is a pointing gesture without a word.
    Pointing,
    /// A microphone that the robot hears live: it detects the onset at once.
    Live,
    /// A recording or transcript that arrives with its times when it is over; before people can
    /// speak they click and wait a second.
    Afterwards,
}

/// Time until an injection that was not acknowledged is sent again.
const RESEND: Span = Span::from_ms(250);
/// Reaction times of a user with good timing, seconds.
const PROMPT_S: (f64, f64) = (0.35, 2.2);
/// Delay between the decision to speak and speech with push-to-talk, seconds.
const CLICK_S: f64 = 1.0;
/// When the request begins, seconds.
pub(super) const REQUEST_S: f64 = 0.1;
/// Probability of answering by value instead of yes or no, in the study of turn-taking.
const BY_VALUE: f64 = 0.1;

/// An utterance that has begun.
#[derive(Clone, Debug)]
pub(super) struct Begun {
    pub(super) utterance: TimedUtterance,
    pub(super) text: String,
    /// True if the robot has been sent its onset.
    pub(super) onset_sent: bool,
    /// True if the robot has been sent its end, or the words.
    pub(super) end_sent: bool,
}

/// A user who wants one object, and their clients.
#[derive(Clone, Debug)]
pub struct GroupUser {
    pub(super) channel: Channel,
    timed: TimedUser,
    /// The question of each prompt, with the key of its scene.
    questions: BTreeMap<u64, (u64, Question)>,
    /// Presentations whose beginning or end was noticed.
    noticed: HashSet<(u64, u32, bool)>,
    pub(super) begun: Vec<Begun>,
    unacknowledged: Vec<(Injection, Time)>,
    /// The number of each accepted utterance, with its place in `begun`.
    numbers: BTreeMap<u64, usize>,
    /// Keys of all accepted utterances, in order.
    pub accepted: Vec<RequestKey>,
}

impl GroupUser {
    /// A truthful user who types after a short and constant reaction time.
    pub fn typing(wanted: usize) -> Self {
        let policy = Policy::Truthful { by_value: 0.0 };
        let user = SimulatedUser::new(policy, ObjectId::from(wanted), Rng::new(0));
        let timing = Timing { reaction_s: (0.7, 0.7), ..Timing::default() };
        Self::new(TimedUser::new(user, timing), Channel::Typed)
    }

    /// A truthful user who points at the object without a word, and types the answers.
    pub fn pointing(wanted: usize) -> Self {
        Self { channel: Channel::Pointing, ..Self::typing(wanted) }
    }

    /// A truthful user in real time, who wants any object.
    pub fn speaking(
        domain: Domain<'_>,
        channel: Channel,
        habits: Option<Habits>,
        window_s: f64,
        seed: u64,
    ) -> Self {
        let policy = Policy::Truthful { by_value: BY_VALUE };
        let user = SimulatedUser::wanting_any(policy, domain, Rng::new(seed));
        let timing = Timing {
            reaction_s: if habits.is_some() { (0.0, f64::INFINITY) } else { PROMPT_S },
            click_s: if channel == Channel::Afterwards { CLICK_S } else { 0.0 },
            window_s,
            habits: habits.unwrap_or_default(),
            ..Timing::default()
        };
        Self::new(TimedUser::new(user, timing), channel)
    }

    fn new(timed: TimedUser, channel: Channel) -> Self {
        Self {
            channel,
            timed,
            questions: BTreeMap::new(),
            noticed: HashSet::new(),
            begun: Vec::new(),
            unacknowledged: Vec::new(),
            numbers: BTreeMap::new(),
            accepted: Vec::new(),
        }
    }

    /// The wanted object.
    pub fn wanted(&self) -> Option<ObjectId> {
        self.timed.user().wanted()
    }

    /// Sets the wanted object, after the scene has changed.
    pub(super) fn want(&mut self, object: Option<ObjectId>) {
        self.timed.user_mut().want(object);
    }

    pub(super) fn request(&mut self, domain: Domain<'_>, at_s: f64) {
        self.timed.request(domain, at_s);
    }

    /// The robot has decided on a question.
    pub(super) fn announce(&mut self, prompt: u64, scene_key: u64, question: Question) {
        self.questions.insert(prompt, (scene_key, question));
    }

    /// The question of that prompt.
    pub(super) fn asked(&self, prompt: u64) -> Option<Question> {
        self.questions.get(&prompt).map(|(_, question)| *question)
    }

    /// The robot has begun to say a question that will end at `ends`, or has said it to its `end`.
    pub(super) fn hear(
        &mut self,
        (scene, model): (&Scene, &Model),
        presentation: (u64, u32),
        (began, ends): (Time, Time),
        ended: bool,
    ) {
        let prompt = presentation.0;
        let Some((key, question)) = self.questions.get(&prompt).copied() else { return };
        let is_new = self.noticed.insert((prompt, presentation.1, ended));
        // A client that is still sending does not type the next answer.
        if !is_new || key != scene.key() || !self.unacknowledged.is_empty() {
            return;
        }
        let (domain, asked) = (Domain { scene, model }, (prompt, question));
        if ended {
            self.timed.question_ended(domain, asked, seconds(ends));
        } else {
            self.timed.question_began(domain, asked, (seconds(began), seconds(ends)));
        }
    }

    /// Takes up the utterances that begin by `now`, and returns their description for the story.
    pub(super) fn begins(&mut self, now: Time, scene: &Scene) -> Vec<String> {
        let mut story = Vec::new();
        while let Some(utterance) = self.timed.begins(seconds(now)) {
            let Reply::Words(hypotheses) = &utterance.reply else { continue };
            let text = hypotheses[0].0.clone();
            story.push(format!("user: {text} (to {})", utterance.prompt));
            let n = self.begun.len();
            let typed = match (self.channel, utterance.prompt) {
                (Channel::Pointing, 0) => {
                    let place = self.wanted().and_then(|object| scene.object(object).placement);
                    let target_m = place.expect("a place to point at").xyz;
                    Some(Sound::Point { target_m, words: String::new() })
                }
                (Channel::Typed | Channel::Pointing, _) => Some(Sound::Text(text.clone())),
                (Channel::Live | Channel::Afterwards, _) => None,
            };
            let (onset_sent, end_sent) = (typed.is_some(), typed.is_some());
            typed.into_iter().for_each(|sound| self.inject(n, &utterance, sound, now));
            self.begun.push(Begun { utterance, text, onset_sent, end_sent });
        }
        story
    }

    /// Sends the words of utterance `n`, with their times.
    pub(super) fn send_transcript(&mut self, n: usize, now: Time) {
        let Begun { utterance, text, .. } = self.begun[n].clone();
        let hypotheses = vec![Hypothesis::certain(text)];
        self.inject(n, &utterance, Sound::Transcript { hypotheses }, now);
    }

    fn inject(&mut self, n: usize, utterance: &TimedUtterance, sound: Sound, now: Time) {
        let typed = matches!(sound, Sound::Text(_) | Sound::Point { .. });
        let end_ns = if typed { 0 } else { time(utterance.end_s).ns() };
        let onset_ns = time(utterance.onset_s).ns();
        self.unacknowledged.push((
            Injection { key: key(n), onset_ns, end_ns, seen_prompt: 0, from: String::new(), sound },
            now,
        ));
    }

    /// Returns what the clients send now: each injection again until it is acknowledged.
    pub(super) fn sends(&mut self, now: Time) -> Vec<Injection> {
        let due = self.unacknowledged.iter_mut().filter(|(_, at)| *at <= now);
        let send = |(injection, at): &mut (Injection, Time)| {
            *at = now + RESEND;
            injection.clone()
        };
        due.map(send).collect()
    }

    pub(super) fn acknowledge(&mut self, receipt: &Receipt) {
        let request = receipt.request();
        let Some(n) = (0..self.begun.len()).find(|n| key(*n) == request) else { return };
        let before = self.unacknowledged.len();
        self.unacknowledged.retain(|(injection, _)| injection.key != request);
        if self.unacknowledged.len() < before {
            assert!(receipt.utterance().is_some(), "a plain sentence is accepted: {receipt:?}");
            self.accepted.push(request);
        }
        if let Some(seq) = receipt.utterance() {
            self.numbers.insert(seq.0, n);
        }
    }

    /// The utterance of that number.
    pub(super) fn utterance(&self, seq: u64) -> Option<&TimedUtterance> {
        Some(&self.begun.get(*self.numbers.get(&seq)?)?.utterance)
    }
}

pub(super) fn key(n: usize) -> RequestKey {
    let mut key = [7; 16];
    (key[0], key[1]) = ((n % 256) as u8, (n / 256) as u8);
    RequestKey(key)
}

pub(super) fn seconds(time: Time) -> f64 {
    time.ns() as f64 / 1e9
}

pub(super) fn time(seconds: f64) -> Time {
    Time(0) + Span::from_s(seconds)
}

//! A truthful person who wants one object: asks for it vaguely, and answers what was asked after a
//! moment. Like the real client, it gives its sentence again under the same key until it is
//! acknowledged.

use dialogue::{Answer, Model};
use messages::{Injection, PresentationState, Presented, Receipt, RequestKey, Sound};
use scene::{ObjectId, Question, Scene};
use service::{Span, Time};

const REACTION: Span = Span::from_ms(700);
const RESEND: Span = Span::from_ms(250);

/// What the person is doing.
pub(crate) struct Person {
    pub(crate) wanted: ObjectId,
    saying: Option<Saying>,
    answered: Vec<(u64, u32)>,
    keys: u8,
    /// Everything that was acknowledged as accepted, in order.
    pub(crate) accepted: Vec<RequestKey>,
    /// What to answer, by prompt, as the questions were announced.
    answers: Vec<(u64, String)>,
}

struct Saying {
    injection: Injection,
    next: Time,
}

impl Person {
    /// Somebody who asks for the object vaguely, in words.
    pub(crate) fn new(wanted: usize) -> Self {
        let mut person = Self::silent(wanted);
        person.say("get me the bowl".to_owned(), Time(0));
        person
    }

    /// Somebody who points at the object without a word, and answers in words.
    pub(crate) fn pointing(wanted: usize, scene: &Scene) -> Self {
        let mut person = Self::silent(wanted);
        let place = scene.object(person.wanted).placement.expect("a place to point at");
        let (target_m, words) = (place.xyz, String::new());
        person.give(Sound::Point { target_m, words }, Time(0));
        person
    }

    fn silent(wanted: usize) -> Self {
        Self {
            wanted: ObjectId::from(wanted),
            saying: None,
            answered: Vec::new(),
            keys: 0,
            accepted: Vec::new(),
            answers: Vec::new(),
        }
    }

    fn say(&mut self, text: String, at: Time) {
        self.give(Sound::Text(text), at);
    }

    fn give(&mut self, sound: Sound, at: Time) {
        self.keys += 1;
        let key = RequestKey([self.keys; 16]);
        let injection = Injection { key, onset_ns: at.ns().max(1), end_ns: 0, sound };
        self.saying = Some(Saying { injection, next: at });
    }

    /// What the person says now, if anything.
    pub(crate) fn speak(&mut self, now: Time) -> Option<Injection> {
        let saying = self.saying.as_mut().filter(|saying| saying.next <= now)?;
        saying.next = now + RESEND;
        Some(saying.injection.clone())
    }

    pub(crate) fn acknowledge(&mut self, receipt: &Receipt) {
        let mine = |saying: &Saying| saying.injection.key == receipt.request();
        if self.saying.as_ref().is_some_and(mine) {
            assert!(receipt.utterance().is_some(), "a plain sentence is accepted: {receipt:?}");
            self.accepted.push(receipt.request());
            self.saying = None;
        }
    }

    /// The robot announces a question; it is answered once it was presented to its end.
    pub(crate) fn announce(
        &mut self,
        prompt: u64,
        question: Question,
        scene: &Scene,
        model: &Model,
    ) {
        if question != Question::None && self.answers.iter().all(|(p, _)| *p != prompt) {
            let answer = Answer::truthful(model, question, self.wanted);
            self.answers.push((prompt, answer.text(scene).to_owned()));
        }
    }

    pub(crate) fn hear(&mut self, presented: &Presented, now: Time) {
        let heard = (presented.prompt, presented.presentation);
        let ended = presented.state == PresentationState::Ended.code();
        let answer = self.answers.iter().find(|(prompt, _)| *prompt == presented.prompt);
        let Some((_, answer)) = answer.cloned() else { return };
        if !ended || self.saying.is_some() || self.answered.contains(&heard) {
            return;
        }
        self.answered.push(heard);
        self.say(answer, now + REACTION);
    }
}

//! When people answer, and when what they said is recognised.

use dialogue::{Answer, Model, Rng};
use scene::{ObjectId, Question};

use crate::simulation::draw::{chance, one_of};
use crate::simulation::interaction::Room;

/// How people answer in real time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Talker {
    /// Probability of answering a question at all.
    pub answers: f64,
    /// Probability that an answer is one at random, right or wrong.
    pub random: f64,
    /// Probability that the recogniser loses an answer.
    pub lost: f64,
    /// Before people can speak with push-to-talk: the click and the second after it, seconds.
    pub click_s: f64,
}

impl Talker {
    /// 95 % answer; of that 2 % at random, and 3 % are lost.
    pub const USUAL: Self = Self { answers: 0.95, random: 0.02, lost: 0.03, click_s: 1.4 };
    /// Answers always and rightly, and is always heard.
    pub const TRUTHFUL: Self = Self { answers: 1.0, random: 0.0, lost: 0.0, click_s: 1.4 };

    /// What is said to `question`; none for no answer.
    fn says(&self, model: &Model, question: Question, wanted: ObjectId, rng: &mut Rng) -> Answer {
        if !chance(rng, self.answers) {
            return Answer::Silence;
        }
        let truth = Answer::truthful(model, question, wanted);
        if !chance(rng, self.random) {
            return truth;
        }
        let mut all = Answer::possible(model, question);
        all.retain(|answer| *answer != Answer::Silence);
        one_of(rng, &all).copied().unwrap_or(truth)
    }
}

/// An answer on its way. Times are seconds since the interaction began.
#[derive(Clone, Copy, Debug)]
pub(super) struct Utterance {
    /// The question that it answers, by its number.
    pub(super) answers: usize,
    /// When the person makes up their mind to speak, or clicks.
    pub(super) committed_s: f64,
    /// When speech begins.
    pub(super) onset_s: f64,
    /// When speech ends.
    pub(super) end_s: f64,
    /// When the recogniser's result arrives.
    pub(super) result_s: f64,
    /// What is recognised; nothing if it was lost.
    pub(super) answer: Answer,
}

/// The person's side of a dialogue: what was said and has not yet been recognised.
pub(super) struct Person<'a> {
    room: &'a Room<'a>,
    talker: Talker,
    delay_s: f64,
    wanted: ObjectId,
    on_the_way: Vec<Utterance>,
}

impl<'a> Person<'a> {
    pub(super) fn new(room: &'a Room<'a>, talker: Talker, open: bool, rng: &mut Rng) -> Self {
        let wanted = ObjectId::from(rng.below(room.problem.model.objects()));
        let delay_s = if open { 0.0 } else { talker.click_s };
        Self { room, talker, delay_s, wanted, on_the_way: Vec::new() }
    }

    pub(super) fn wanted(&self) -> ObjectId {
        self.wanted
    }

    /// Between the wish to speak and speech, seconds.
    pub(super) fn delay_s(&self) -> f64 {
        self.delay_s
    }

    /// Draws how long the request takes until it is recognised, seconds.
    pub(super) fn request_s(&self, rng: &mut Rng) -> f64 {
        let words = 3 + self.room.scene.noun().split_whitespace().count();
        let pace = self.room.pace;
        self.delay_s + pace.speech_s(rng, words) + pace.recogniser_s(rng)
    }

    /// Question `number` has been asked to its end. People answer every question, also where the
    /// robot has gone on to the next meanwhile.
    pub(super) fn hear(&mut self, number: usize, question: Question, now_s: f64, rng: &mut Rng) {
        let answer = self.talker.says(self.room.problem.model, question, self.wanted, rng);
        let lost = chance(rng, self.talker.lost);
        let pace = self.room.pace;
        let (reaction_s, speech_s) = (pace.reaction_s(rng), pace.speech_s(rng, 1));
        let recogniser_s = pace.recogniser_s(rng);
        if answer == Answer::Silence {
            return;
        }
        let own_end = self.on_the_way.iter().map(|u| u.end_s).fold(now_s, f64::max);
        let committed_s = own_end.max(now_s + reaction_s);
        let onset_s = committed_s + self.delay_s;
        let end_s = onset_s + speech_s;
        self.on_the_way.push(Utterance {
            answers: number,
            committed_s,
            onset_s,
            end_s,
            result_s: end_s + recogniser_s,
            answer: if lost { Answer::Silence } else { answer },
        });
    }

    /// The result that arrives first, if it arrives by `until_s`.
    pub(super) fn result(&mut self, until_s: f64) -> Option<Utterance> {
        let first = (self.on_the_way.iter().enumerate())
            .min_by(|a, b| a.1.result_s.total_cmp(&b.1.result_s))
            .filter(|(_, utterance)| utterance.result_s <= until_s)?;
        let at = first.0;
        Some(self.on_the_way.remove(at))
    }

    /// Until when the person speaks or a result is pending, if so at `now_s`. A click counts.
    pub(super) fn busy_until_s(&self, now_s: f64) -> Option<f64> {
        let busy = self.on_the_way.iter().filter(|u| u.committed_s <= now_s);
        busy.map(|u| u.result_s).filter(|end_s| *end_s > now_s).reduce(f64::min)
    }
}

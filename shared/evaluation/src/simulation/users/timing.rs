//! When a user speaks: reaction times, and answers that come late, early, into the next question,
//! or twice. Times are seconds since the dialogue began.

use preflight::Pace;
use scene::Question;
use vocabulary::Rng;

use super::{Domain, Policy, Reply, SimulatedUser, Turn};
use crate::simulation::draw::chance;

/// Delay of a late answer, relative to the robot's response window, seconds.
const LATE_S: (f64, f64) = (-0.3, 2.5);
/// Pause before an answer is repeated, seconds.
const REPEAT_S: (f64, f64) = (0.5, 2.5);

/// Probabilities of the turn-taking errors. Else a question is answered after its end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Habits {
    /// Answers about when the response window closes, or later.
    pub late: f64,
    /// Answers before the question has ended.
    pub early: f64,
    /// Answers in time, and once more into the next question.
    pub overlapping: f64,
    /// Answers twice in a row.
    pub doubled: f64,
}

/// A user's timing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Reaction time, speed of speech, and delay of the recogniser.
    pub pace: Pace,
    /// Bounds of the reaction time, seconds.
    pub reaction_s: (f64, f64),
    /// Delay between the decision to speak and speech, seconds: with push-to-talk, the click and
    /// the pause after it.
    pub click_s: f64,
    /// Pause between two utterances, seconds.
    pub breath_s: f64,
    /// Time that the robot waits for an answer, seconds.
    pub window_s: f64,
    /// Probability that the recogniser loses an utterance.
    pub lost: f64,
    /// `true` if a question is still answered after the robot has asked the next one to its end.
    pub persistent: bool,
    /// Turn-taking errors.
    pub habits: Habits,
}

impl Default for Timing {
    /// Unbounded reactions, an open microphone, no errors.
    fn default() -> Self {
        Self {
            pace: Pace::default(),
            reaction_s: (0.0, f64::INFINITY),
            click_s: 0.0,
            breath_s: 0.25,
            window_s: 15.0,
            lost: 0.0,
            persistent: false,
            habits: Habits::default(),
        }
    }
}

/// A kind of user in real time, as `whichone study --turns` has them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedKind {
    /// Probability of answering a question at all.
    pub answers: f64,
    /// Probability that an answer is drawn at random, right or wrong.
    pub random: f64,
    /// Probability that the recogniser loses an answer.
    pub lost: f64,
    /// Click of push-to-talk and the pause after it, seconds.
    pub click_s: f64,
}

impl TimedKind {
    /// 95 % answer; of that 2 % at random, and 3 % are lost.
    pub const USUAL: Self = Self { answers: 0.95, random: 0.02, lost: 0.03, click_s: 1.4 };
    /// Always answers, is always right and always recognised.
    pub const TRUTHFUL: Self = Self { answers: 1.0, random: 0.0, lost: 0.0, click_s: 1.4 };

    /// Draws a user. With an `open` microphone no click is needed.
    pub fn user(&self, domain: Domain<'_>, pace: &Pace, open: bool, rng: Rng) -> TimedUser {
        let Self { answers, random, lost, click_s } = *self;
        let user = SimulatedUser::wanting_any(Policy::Unreliable { answers, random }, domain, rng);
        let click_s = if open { 0.0 } else { click_s };
        let (pace, breath_s) = (*pace, 0.0);
        let timing =
            Timing { pace, click_s, breath_s, lost, persistent: true, ..Timing::default() };
        TimedUser::new(user, timing)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Habit {
    Usual,
    Late,
    Early,
    Overlapping,
    Doubled,
}

/// An utterance of a user with its times.
#[derive(Clone, Debug, PartialEq)]
pub struct TimedUtterance {
    /// The prompt that it answers; 0 for the request.
    pub prompt: u64,
    /// The question that the utterance answers.
    pub question: Question,
    /// Recognition result; silence if the recogniser loses the utterance.
    pub reply: Reply,
    /// `true` if it repeats an earlier answer.
    pub again: bool,
    /// When the user decides to speak, or clicks.
    pub committed_s: f64,
    /// When speech begins.
    pub onset_s: f64,
    /// When speech ends.
    pub end_s: f64,
    /// When the recogniser's result arrives.
    pub result_s: f64,
}

/// A user in real time. Either [`TimedUser::begins`] or [`TimedUser::result`] takes the utterances
/// out, as the simulation needs the sound or the recognised words.
#[derive(Clone, Debug)]
pub struct TimedUser {
    user: SimulatedUser,
    timing: Timing,
    upcoming: Vec<TimedUtterance>,
    /// Treatment of each prompt.
    habits: Vec<(u64, Habit)>,
    /// An answer that is repeated into the next question.
    overlapping: Option<(u64, Question, Turn)>,
    /// Prompts whose answers have begun.
    answered: Vec<u64>,
    /// When everything planned so far has been said.
    silent_s: f64,
}

impl TimedUser {
    /// A user who has not said anything.
    pub fn new(user: SimulatedUser, timing: Timing) -> Self {
        let (upcoming, habits, answered) = (Vec::new(), Vec::new(), Vec::new());
        Self { user, timing, upcoming, habits, overlapping: None, answered, silent_s: 0.0 }
    }

    /// The user without timing.
    pub fn user(&self) -> &SimulatedUser {
        &self.user
    }

    /// The user without timing, to change the wanted object or to draw from the same generator.
    pub fn user_mut(&mut self) -> &mut SimulatedUser {
        &mut self.user
    }

    /// The user's timing.
    pub fn timing(&self) -> &Timing {
        &self.timing
    }

    /// Plans the request for `at_s` and returns when its recognition ends.
    pub fn request(&mut self, domain: Domain<'_>, at_s: f64) -> f64 {
        let turn = self.user.request(domain);
        let lost = self.is_lost();
        self.plan((0, Question::None, turn), at_s, lost, false)
    }

    /// Draws how long a request of the form "get me the …" takes until it is recognised, seconds.
    pub fn request_s(&mut self, domain: Domain<'_>) -> f64 {
        let words = 3 + domain.scene.noun().split_whitespace().count();
        let (pace, rng) = (self.timing.pace, self.user.rng());
        let speech_s = pace.speech_s(rng, words);
        self.timing.click_s + speech_s + pace.recogniser_s(self.user.rng())
    }

    /// The robot begins to ask, and will have asked at `ends_s` if it is not interrupted.
    pub fn question_began(
        &mut self,
        domain: Domain<'_>,
        (prompt, question): (u64, Question),
        (began_s, ends_s): (f64, f64),
    ) {
        if self.habits.iter().any(|(known, _)| *known == prompt) {
            return;
        }
        // The robot has understood something and asks on: the answer is not repeated, except
        // deliberately.
        let Self { upcoming, answered, .. } = self;
        upcoming.retain(|plan| plan.again || !answered.contains(&plan.prompt));
        let within =
            |rng: &mut Rng, least| began_s + (ends_s - began_s) * rng.between((least, 0.95));
        if let Some(repeated) = self.overlapping.take() {
            let at_s = within(self.user.rng(), 0.05);
            self.plan(repeated, at_s, false, true);
        }
        let habit = self.timing.habits.draw(self.user.rng());
        self.habits.push((prompt, habit));
        if habit == Habit::Early {
            let at_s = within(self.user.rng(), 0.5);
            let turn = self.user.answer(domain, question);
            let lost = self.is_lost();
            self.plan((prompt, question, turn), at_s, lost, false);
        }
    }

    /// The robot has asked to the end.
    pub fn question_ended(
        &mut self,
        domain: Domain<'_>,
        (prompt, question): (u64, Question),
        ended_s: f64,
    ) {
        if !self.timing.persistent {
            // An earlier question is moot once the next one was heard whole.
            self.upcoming.retain(|plan| plan.prompt == prompt || plan.prompt == 0);
            if self.upcoming.iter().any(|plan| plan.prompt == prompt) {
                return;
            }
        }
        let known = self.habits.iter_mut().find(|(known, _)| *known == prompt);
        let habit = known.map_or(Habit::Usual, |(_, habit)| std::mem::replace(habit, Habit::Usual));
        if habit == Habit::Early {
            return;
        }
        let turn = self.user.answer(domain, question);
        let lost = self.is_lost();
        let (pace, (least, most)) = (self.timing.pace, self.timing.reaction_s);
        let mut reaction_s = pace.reaction_s(self.user.rng()).clamp(least, most);
        if habit == Habit::Late {
            reaction_s = self.timing.window_s + self.user.rng().between(LATE_S);
        }
        let answer = (prompt, question, turn);
        self.plan(answer.clone(), ended_s + reaction_s, lost, false);
        match habit {
            Habit::Doubled => {
                let at_s = self.silent_s + self.user.rng().between(REPEAT_S);
                self.plan(answer, at_s, false, true);
            }
            Habit::Overlapping => self.overlapping = Some(answer),
            _ => {}
        }
    }

    /// Takes the next utterance that has begun by `now_s`.
    pub fn begins(&mut self, now_s: f64) -> Option<TimedUtterance> {
        let first = self.upcoming.iter().position(|plan| plan.onset_s <= now_s)?;
        let utterance = self.upcoming.remove(first);
        self.answered.push(utterance.prompt);
        Some(utterance)
    }

    /// Takes the utterance whose result arrives first, if it arrives by `until_s`.
    pub fn result(&mut self, until_s: f64) -> Option<TimedUtterance> {
        let results = self.upcoming.iter().map(|utterance| utterance.result_s).enumerate();
        let (first, _) =
            results.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, at_s)| *at_s <= until_s)?;
        Some(self.upcoming.remove(first))
    }

    /// Until when the user speaks or a result is pending, if so at `now_s`. A click counts.
    pub fn busy_until_s(&self, now_s: f64) -> Option<f64> {
        let busy = self.upcoming.iter().filter(|utterance| utterance.committed_s <= now_s);
        busy.map(|utterance| utterance.result_s).filter(|at_s| *at_s > now_s).reduce(f64::min)
    }

    fn is_lost(&mut self) -> bool {
        let lost = self.timing.lost;
        chance(self.user.rng(), lost)
    }

    /// Plans an utterance for `at_s` or when the user is free, and returns when its result arrives.
    fn plan(
        &mut self,
        (prompt, question, turn): (u64, Question, Turn),
        at_s: f64,
        lost: bool,
        again: bool,
    ) -> f64 {
        let pace = self.timing.pace;
        let speech_s = pace.speech_s(self.user.rng(), turn.reply.words().max(1));
        let recogniser_s = pace.recogniser_s(self.user.rng());
        let free_s = if self.silent_s > 0.0 { self.silent_s + self.timing.breath_s } else { 0.0 };
        let committed_s = free_s.max(at_s + turn.late_s);
        let onset_s = committed_s + self.timing.click_s;
        let end_s = onset_s + speech_s;
        let result_s = end_s + recogniser_s;
        if turn.reply == Reply::Silence {
            return committed_s;
        }
        let reply = if lost { Reply::Silence } else { turn.reply };
        self.silent_s = end_s;
        self.upcoming.push(TimedUtterance {
            prompt,
            question,
            reply,
            again,
            committed_s,
            onset_s,
            end_s,
            result_s,
        });
        result_s
    }
}

impl Habits {
    fn draw(&self, rng: &mut Rng) -> Habit {
        const HABITS: [Habit; 4] = [Habit::Late, Habit::Early, Habit::Overlapping, Habit::Doubled];
        let drawn = rng.index([self.late, self.early, self.overlapping, self.doubled]);
        drawn.map_or(Habit::Usual, |index| HABITS[index])
    }
}

//! The robot's side of a dialogue in real time.

use dialogue::user_model::Reaction;
use dialogue::{Action, Attribution, Candidate, Posterior, Rng, Shares};
use scene::Question;

use super::rules::Rules;
use crate::simulation::draw::log_normal;
use crate::simulation::interaction::{End, Outcome, Room};
use crate::simulation::memo::Memo;
use crate::simulation::users::{Reply, TimedKind, TimedUser, TimedUtterance};

/// How long the robot takes to say a question: median, seconds, and standard deviation of the
/// logarithm. The web interface's voice and its delay, not the arm's own voice.
const QUESTION_S: (f64, f64) = (1.9, 0.12);

/// Conducts one dialogue.
pub(super) fn talk(
    room: &Room<'_>,
    memo: &mut Memo<'_>,
    rules: &Rules,
    kind: &TimedKind,
    rng: Rng,
) -> Outcome {
    let mut user = kind.user(room.domain(), room.pace, rules.open, rng);
    let (median_s, log_sd) = room.pace.reaction_s;
    let mut talk = Talk {
        room,
        rules,
        reaction: Reaction::new(median_s, log_sd),
        answers: kind.answers,
        now_s: user.request_s(room.domain()),
        user,
        posterior: memo.beginning(&room.problem),
        asked: Vec::new(),
        step: 0,
        heard: 0,
        misplaced: 0,
        value: 0.0,
        discount: 1.0,
    };
    let mut answered = true;
    loop {
        let action = talk.plan(memo, answered);
        match action {
            Action::Pick(object) => {
                let right = Some(object) == talk.user.user().wanted();
                return talk.end(if right { End::Right } else { End::Wrong });
            }
            Action::Wait => return talk.end(End::Waited),
            Action::Ask(question) => {
                talk.ask(question);
                answered = talk.listen();
                talk.posterior.see_answer(answered);
            }
        }
    }
}

struct Talk<'a> {
    room: &'a Room<'a>,
    rules: &'a Rules,
    reaction: Reaction,
    /// Share of questions that people answer.
    answers: f64,
    user: TimedUser,
    now_s: f64,
    posterior: Posterior,
    asked: Vec<(Question, Candidate)>,
    step: u32,
    heard: u32,
    misplaced: u32,
    value: f64,
    discount: f64,
}

impl Talk<'_> {
    /// Decides on the belief as it is when planning begins. A robot that holds plans again where
    /// something was said meanwhile; a naive one does not notice.
    fn plan(&mut self, memo: &mut Memo<'_>, answered: bool) -> Action {
        loop {
            let action = self.decide(memo, answered);
            let done_s = self.now_s + self.rules.planner_s;
            if !self.rules.hold && self.rules.attribution == Attribution::Naive {
                self.now_s = done_s;
                return action;
            }
            let mut heard = self.take_in(done_s);
            self.now_s = done_s;
            if self.rules.hold {
                while let Some(until_s) = self.user.busy_until_s(self.now_s) {
                    heard |= self.take_in(until_s);
                    self.now_s = until_s;
                }
            }
            if !(heard && self.rules.hold) {
                return action;
            }
        }
    }

    fn decide(&mut self, memo: &mut Memo<'_>, answered: bool) -> Action {
        let choice = memo.choose(&self.room.problem, &self.posterior, self.step);
        self.step += 1;
        let last = self.asked.last().map(|asked| asked.0);
        match choice.action {
            Action::Ask(_) if self.asked.len() >= self.room.patience.questions_max as usize => {
                Action::Pick(self.posterior.belief().most_likely())
            }
            Action::Ask(question) if !answered && !self.rules.same && last == Some(question) => {
                Action::Ask(choice.instead.unwrap_or(question))
            }
            action => action,
        }
    }

    /// Says the question.
    fn ask(&mut self, question: Question) {
        let costs = self.room.problem.costs;
        self.value -= self.discount * self.room.problem.cost(Action::Ask(question));
        self.discount *= costs.discount;
        let began_s = self.now_s;
        self.now_s += log_normal(self.user.user_mut().rng(), QUESTION_S.0, QUESTION_S.1);
        self.asked.push((
            question,
            Candidate { began_s, ended_s: self.now_s, complete: true, answered_s: None },
        ));
        let asked = (self.asked.len() as u64 - 1, question);
        self.user.question_ended(self.room.domain(), asked, self.now_s);
    }

    /// Listens until something is heard, or the window has passed; whether something was.
    fn listen(&mut self) -> bool {
        // What arrived while the robot spoke ends its listening at once.
        if self.take_in(self.now_s) {
            return true;
        }
        let mut until_s = self.now_s + self.rules.window_s;
        loop {
            while let Some(utterance) = self.user.result(until_s) {
                self.now_s = utterance.result_s;
                if self.hear(&utterance) {
                    return true;
                }
            }
            self.now_s = until_s;
            match self.user.busy_until_s(self.now_s) {
                Some(busy_s) if self.rules.hold => until_s = busy_s,
                _ => return false,
            }
        }
    }

    /// Takes in what arrives until then; whether anything did.
    fn take_in(&mut self, until_s: f64) -> bool {
        let mut heard = false;
        while let Some(utterance) = self.user.result(until_s) {
            heard |= self.hear(&utterance);
        }
        heard
    }

    /// Updates the belief with an answer; whether there was one.
    fn hear(&mut self, utterance: &TimedUtterance) -> bool {
        let Reply::Answer(answer) = utterance.reply else { return false };
        let model = self.room.problem.model;
        let addressed = self.addressed(utterance);
        let reading = answer.reading(model);
        let questions = self.asked.iter().map(|asked| asked.0);
        let mut heard: Vec<_> =
            questions.zip(&addressed.questions).map(|(q, w)| (*w, q, reading.clone())).collect();
        heard.push((addressed.none, Question::None, reading));
        let likeliest = (0..heard.len()).max_by(|a, b| heard[*a].0.total_cmp(&heard[*b].0));
        self.posterior.update_mixture(model, &heard);
        self.heard += 1;
        let meant = utterance.question;
        let taken = likeliest.and_then(|at| self.asked.get_mut(at));
        self.misplaced += u32::from(taken.as_ref().is_none_or(|asked| asked.0 != meant));
        if let Some(asked) = taken {
            asked.1.answered_s = Some(utterance.end_s);
        }
        true
    }

    fn addressed(&self, utterance: &TimedUtterance) -> Shares {
        let asked: Vec<Candidate> = self.asked.iter().map(|asked| asked.1).collect();
        let asked = &asked;
        match self.rules.attribution {
            Attribution::Naive => Shares::only(asked.len().checked_sub(1), asked.len()),
            Attribution::Onset => Shares::latest_said(asked, utterance.onset_s),
            Attribution::Mixture => {
                // With push-to-talk people wait for the click before they speak.
                let delay_s = self.user.timing().click_s;
                let rate = |seconds: f64| self.reaction.rate(seconds - delay_s, self.answers);
                Shares::spoken(asked, utterance.onset_s, rate)
            }
        }
    }

    fn end(mut self, end: End) -> Outcome {
        let costs = self.room.problem.costs;
        let worth = match end {
            End::Right => costs.correct,
            End::Wrong => -costs.wrong,
            End::Waited | End::Abandoned | End::Cancelled => costs.wait_value(),
        };
        self.value += self.discount * worth;
        Outcome {
            end,
            questions: self.asked.len() as u32,
            talk_s: self.now_s,
            seconds: self.now_s,
            value: self.value,
            answers: self.heard,
            misplaced: self.misplaced,
        }
    }
}

//! Attribution of an utterance to the question that it answers, by its onset.
//!
//! An answer begins some time after the end of the question that it answers; that time is well
//! described by a log-normal distribution. The question answered is one more thing that the robot
//! does not know, and the belief sums over it: `P(o | D) = Σ_j w_j P(o | D, Q_j)`
//! ([`Belief::update_mixture`](crate::Belief::update_mixture)).
//!
//! The weights are rates of competing events: when the user begins to speak, each question that
//! waits for its answer draws one at its hazard, `p f(t) / (1 − p F(t))` with the reaction time's
//! density `f` and distribution `F` and the share `p` of questions that are answered at all. A
//! density alone would give up a slow answer to the only question there is. A question that was
//! answered draws second thoughts only, and one still being said hardly anything before its end.

/// A presentation of a question that may be answered. Times are seconds on any one clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// When the robot began to say it.
    pub began_s: f64,
    /// When it had been said, was interrupted, or is expected to have been said.
    pub ended_s: f64,
    /// Whether it was said to its end.
    pub complete: bool,
    /// When the answer to it had ended, if it was answered.
    pub answered_s: Option<f64>,
}

impl Candidate {
    /// Answers to it that begin at `onset_s`, per second.
    fn rate(&self, onset_s: f64, rate: impl Fn(f64) -> f64) -> f64 {
        let since = |then: f64| onset_s - then;
        if onset_s < self.began_s {
            0.0
        } else if let Some(answered_s) = self.answered_s {
            AGAIN * (-since(answered_s).max(0.0) / AGAIN_S).exp()
        } else if self.complete && onset_s >= self.ended_s {
            rate(since(self.ended_s))
        } else {
            let after = since(self.ended_s).max(0.0);
            EARLY * self.share_said(onset_s).powi(4) * (-after / BROKEN_OFF_S).exp()
        }
    }

    /// Share of the question that had been said by then. One that was broken off would have taken
    /// a usual question's time.
    fn share_said(&self, at_s: f64) -> f64 {
        let said_s = self.ended_s - self.began_s;
        let length_s = if self.complete { said_s } else { said_s.max(QUESTION_S) };
        (at_s.min(self.ended_s) - self.began_s) / length_s
    }
}

/// Division of an utterance among the candidates.
#[derive(Clone, Debug, PartialEq)]
pub struct Shares {
    /// Probability per candidate, in order.
    pub questions: Vec<f64>,
    /// Probability that the utterance answers no question.
    pub none: f64,
}

/// Utterances that answer no question, per second: a yes or no to another person in the room, once
/// in half an hour.
const NONE: f64 = 0.0005;
/// Answers just before a question's last word, per second; people know the question by then. The
/// essential word is at the end of the sentence, so the rate grows with the fourth power of the
/// spoken share.
const EARLY: f64 = 0.1;
/// A question's usual length, seconds.
pub(crate) const QUESTION_S: f64 = 1.5;
/// Seconds in which a user who interrupted a question still answers it.
const BROKEN_OFF_S: f64 = 1.0;
/// Second thoughts right after an answer, per second ("yes. No, wait."), and the seconds in which
/// they become fewer.
const AGAIN: f64 = 0.1;
const AGAIN_S: f64 = 2.0;

impl Shares {
    /// Returns the shares of an utterance spoken from `onset_s` on. `rate` is how many answers to a
    /// question begin per second, so many seconds after its end, while it is unanswered
    /// ([`Reaction::rate`](vocabulary::reaction::Reaction::rate)).
    pub fn spoken(asked: &[Candidate], onset_s: f64, rate: impl Fn(f64) -> f64) -> Self {
        let weights = asked.iter().map(|asked| asked.rate(onset_s, &rate)).collect();
        Self::of_weights(weights, NONE)
    }

    /// Returns the shares of an utterance typed at `at_s`. Typed words are meant for the robot and
    /// answer the question on the screen, which appears as soon as it is asked: an unanswered one
    /// if any, else the latest.
    pub fn typed(asked: &[Candidate], at_s: f64, rate: impl Fn(f64) -> f64) -> Self {
        let open = |asked: &Candidate| asked.answered_s.is_none() && asked.began_s <= at_s;
        let weight = |asked: &Candidate| if open(asked) { rate(at_s - asked.began_s) } else { 0.0 };
        let weights: Vec<f64> = asked.iter().map(weight).collect();
        if weights.iter().sum::<f64>() > 0.0 {
            return Self::of_weights(weights, 0.0);
        }
        let begun = |at: &usize| asked[*at].began_s <= at_s;
        let newest = (0..asked.len())
            .filter(begun)
            .max_by(|a, b| asked[*a].began_s.total_cmp(&asked[*b].began_s));
        Self::only(newest, asked.len())
    }

    /// Attributes an utterance to the latest question that had been said when it began.
    pub fn latest_said(asked: &[Candidate], onset_s: f64) -> Self {
        let said = |at: &usize| asked[*at].complete && asked[*at].ended_s <= onset_s;
        let newest = (0..asked.len())
            .filter(said)
            .max_by(|a, b| asked[*a].ended_s.total_cmp(&asked[*b].ended_s));
        Self::only(newest, asked.len())
    }

    /// Attributes an utterance to one candidate, or to none.
    pub fn only(question: Option<usize>, of: usize) -> Self {
        let weight = |at| if question == Some(at) { 1.0 } else { 0.0 };
        let none = if question.is_some_and(|at| at < of) { 0.0 } else { 1.0 };
        Self { questions: (0..of).map(weight).collect(), none }
    }

    fn of_weights(mut questions: Vec<f64>, none: f64) -> Self {
        let sum = questions.iter().sum::<f64>() + none;
        questions.iter_mut().for_each(|weight| *weight /= sum);
        Self { questions, none: none / sum }
    }
}

#[cfg(test)]
mod tests {
    use vocabulary::Rng;
    use vocabulary::reaction::Reaction;

    use super::*;

    fn asked(began_s: f64, ended_s: f64) -> Candidate {
        Candidate { began_s, ended_s, complete: true, answered_s: None }
    }

    fn rate(seconds: f64) -> f64 {
        Reaction::default().rate(seconds, 0.95)
    }

    fn addressed(asked: &[Candidate], onset_s: f64) -> Shares {
        Shares::spoken(asked, onset_s, rate)
    }

    #[test]
    fn shares_are_a_distribution() {
        let mut rng = Rng::new(3);
        for _ in 0..2_000 {
            let mut now = 0.0;
            let mut some: Vec<Candidate> = Vec::new();
            for _ in 0..rng.below(5) {
                let began = now + 3.0 * rng.uniform();
                now = began + 2.5 * rng.uniform();
                let complete = rng.below(3) > 0;
                let answered_s = (rng.below(3) == 0).then_some(now + rng.uniform());
                some.push(Candidate { complete, answered_s, ..asked(began, now) });
            }
            let onset = 1.5 * now * rng.uniform();
            for shares in [
                addressed(&some, onset),
                Shares::typed(&some, onset, rate),
                Shares::latest_said(&some, onset),
            ] {
                let sum = shares.questions.iter().sum::<f64>() + shares.none;
                assert!((sum - 1.0).abs() < 1e-12, "{some:?} at {onset}: {shares:?}");
                for (asked, share) in some.iter().zip(&shares.questions) {
                    assert!(onset >= asked.began_s || *share == 0.0, "{some:?} at {onset}");
                }
            }
        }
    }

    #[test]
    fn a_prompt_answer_is_meant_for_the_question_before_it() {
        let first = Candidate { answered_s: Some(3.2), ..asked(0.0, 2.0) };
        let Shares { questions, none } = addressed(&[first, asked(8.0, 10.0)], 10.9);
        assert!(questions[1] > 0.99 && none < 0.01, "{questions:?} {none}");
    }

    /// The robot falls silent at once when a user speaks: how little of the question had been said
    /// counts, and not that it was its end.
    #[test]
    fn who_breaks_off_a_question_at_its_first_words_does_not_answer_it() {
        let first = Candidate { answered_s: Some(3.2), ..asked(0.0, 2.0) };
        let broken_off = |ended_s| Candidate { complete: false, ..asked(4.0, ended_s) };
        let early = addressed(&[first, broken_off(4.6)], 4.5);
        assert!(early.questions[0] > 0.9, "{early:?}");
        let late = addressed(&[first, broken_off(5.5)], 5.4);
        assert!(late.questions[1] > 0.6, "{late:?}");
    }

    /// The answer comes just as the next question begins: no one can have heard that one.
    #[test]
    fn an_answer_into_a_new_question_is_meant_for_the_old_one() {
        let two = [asked(0.0, 2.0), asked(2.8, 4.6)];
        assert!(addressed(&two, 3.2).questions[0] > 0.98, "{:?}", addressed(&two, 3.2));
    }

    #[test]
    fn a_slow_answer_to_the_only_question_is_still_its_answer() {
        assert!(addressed(&[asked(0.0, 2.0)], 9.0).questions[0] > 0.8);
    }

    /// "Yes. … Yes!" while the next question begins.
    #[test]
    fn a_doubled_answer_is_not_an_answer_to_the_question_that_begins() {
        let first = Candidate { answered_s: Some(3.5), ..asked(0.0, 2.0) };
        let doubled = addressed(&[first, asked(3.6, 5.4)], 4.2);
        assert!(doubled.questions[0] > 0.95, "{doubled:?}");
        let answer = addressed(&[first, asked(3.6, 5.4)], 6.0);
        assert!(answer.questions[1] > 0.95, "{answer:?}");
    }

    #[test]
    fn what_no_question_fits_answers_none() {
        assert_eq!(addressed(&[], 3.0), Shares { questions: vec![], none: 1.0 });
        let later = addressed(&[asked(5.0, 6.0)], 3.0);
        assert_eq!((later.questions[0], later.none), (0.0, 1.0));
        let long_after = addressed(&[asked(0.0, 1.0)], 600.0);
        assert!(long_after.none > 0.9, "{long_after:?}");
    }

    #[test]
    fn a_question_that_was_broken_off_is_answered_by_who_broke_it_off() {
        let broken = Candidate { complete: false, ..asked(3.0, 4.0) };
        let barge_in = addressed(&[broken], 3.95);
        assert!(barge_in.questions[0] > 0.9, "{barge_in:?}");
        let next = addressed(&[broken, asked(6.0, 8.0)], 8.8);
        assert!(next.questions[1] > 0.99, "{next:?}");
    }

    #[test]
    fn typed_words_answer_what_waits_for_an_answer() {
        let answered = Candidate { answered_s: Some(1.0), ..asked(0.0, 0.5) };
        // A program answers within a millisecond.
        let quick = Shares::typed(&[answered, asked(1.0, 1.0)], 1.001, rate);
        assert_eq!(quick, Shares::only(Some(1), 2));
        let again = Shares::typed(&[answered], 30.0, rate);
        assert_eq!(again, Shares::only(Some(0), 1));
        let leisure = Shares::typed(&[asked(0.0, 1.0)], 500.0, rate);
        assert_eq!(leisure, Shares::only(Some(0), 1));
        assert_eq!(Shares::typed(&[], 1.0, rate).none, 1.0);
    }

    #[test]
    fn the_simpler_rules_choose_one_question() {
        let two = [asked(0.0, 2.0), asked(2.8, 4.6)];
        assert_eq!(Shares::latest_said(&two, 3.0), Shares::only(Some(0), 2));
        assert_eq!(Shares::latest_said(&two, 5.0), Shares::only(Some(1), 2));
        assert_eq!(Shares::latest_said(&two, 1.0), Shares::only(None, 2));
    }
}

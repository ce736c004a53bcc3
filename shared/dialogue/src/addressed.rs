//! Which question an answer is meant for, judged by when it began.
//!
//! An answer begins some time after the end of the question that it answers. How long people take
//! is well described by a log-normal distribution, so its density at the time between a question's
//! end and the answer's beginning says how well the two fit. The question that is addressed is then
//! one more thing that the robot does not know, and the belief sums over it:
//! `P(o | D) = Σ_j w_j P(o | D, Q_j)` ([`Belief::update_mixture`](crate::Belief::update_mixture)).

use scene::Question;

/// How long people take from the end of a question to the first sound of their answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReactionTime {
    /// Median, seconds; above 0.
    pub median_s: f64,
    /// Standard deviation of the logarithm; above 0.
    pub log_sd: f64,
    /// What passes before people can react at all, seconds: 0 with an open microphone, the click
    /// and the pause after it with push-to-talk.
    pub delay_s: f64,
}

/// A question as it was asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked {
    /// What was asked.
    pub question: Question,
    /// When the robot began to say it, seconds on any clock.
    pub began_s: f64,
    /// When it had been said, seconds on the same clock.
    pub ended_s: f64,
}

/// How an utterance is divided among the questions that it may answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Addressed {
    /// Probability per question, in the order they were given in.
    pub questions: Vec<f64>,
    /// Probability that it answers none of them.
    pub none: f64,
}

impl Default for ReactionTime {
    /// An open microphone.
    fn default() -> Self {
        Self { median_s: 0.9, log_sd: 0.55, delay_s: 0.0 }
    }
}

/// Weight of "answers none of them", as a density per second: what a question must fit better than
/// to be taken as addressed.
const NONE_DENSITY: f64 = 0.002;
/// Density of an answer that begins while the question is still being said: some people know by
/// then what is asked.
const EARLY_DENSITY: f64 = 0.02;

impl ReactionTime {
    /// Density at `seconds` after the question's end, per second; 0 before [`Self::delay_s`].
    pub fn density(&self, seconds: f64) -> f64 {
        let t = seconds - self.delay_s;
        if t <= 0.0 {
            return 0.0;
        }
        let z = (t / self.median_s).ln() / self.log_sd;
        (-0.5 * z * z).exp() / (t * self.log_sd * (2.0 * std::f64::consts::PI).sqrt())
    }
}

impl Addressed {
    /// Divides an utterance that began at `onset_s` among the questions that had begun before it.
    ///
    /// Weights are in proportion to `density`, that of the person's reaction time, at the seconds
    /// since each question's end ([`ReactionTime::density`], or what is known of the one person),
    /// with a small one for an utterance that answers none, which takes all where no question fits.
    pub fn of(asked: &[Asked], onset_s: f64, density: impl Fn(f64) -> f64) -> Self {
        let weight = |asked: &Asked| {
            if onset_s < asked.began_s {
                0.0
            } else if onset_s < asked.ended_s {
                EARLY_DENSITY
            } else {
                density(onset_s - asked.ended_s)
            }
        };
        let mut questions: Vec<f64> = asked.iter().map(weight).collect();
        let sum = questions.iter().sum::<f64>() + NONE_DENSITY;
        questions.iter_mut().for_each(|weight| *weight /= sum);
        Self { questions, none: NONE_DENSITY / sum }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::ObjectId;

    fn asked(n: u16, began_s: f64, ended_s: f64) -> Asked {
        Asked { question: Question::Point(ObjectId(n)), began_s, ended_s }
    }

    fn addressed(asked: &[Asked], onset_s: f64) -> Addressed {
        Addressed::of(asked, onset_s, |seconds| ReactionTime::default().density(seconds))
    }

    #[test]
    fn the_density_is_that_of_a_log_normal_distribution() {
        let reaction = ReactionTime::default();
        // 1 / (m σ √2π) at the median.
        assert!((reaction.density(0.9) - 0.805_944).abs() < 1e-5, "{}", reaction.density(0.9));
        assert_eq!((reaction.density(0.0), reaction.density(-1.0)), (0.0, 0.0));
        let step = 0.001;
        let sum: f64 = (0..60_000).map(|k| step * reaction.density(step * f64::from(k))).sum();
        assert!((sum - 1.0).abs() < 1e-4, "{sum}");
        let late = ReactionTime { delay_s: 1.0, ..reaction };
        assert_eq!(late.density(1.9), reaction.density(1.9 - 1.0));
    }

    #[test]
    fn a_prompt_answer_is_meant_for_the_question_before_it() {
        let two = [asked(0, 0.0, 2.0), asked(1, 8.0, 10.0)];
        let Addressed { questions, none } = addressed(&two, 10.9);
        assert!((questions.iter().sum::<f64>() + none - 1.0).abs() < 1e-12);
        assert!(questions[1] > 0.99 && none < 0.01, "{questions:?} {none}");
    }

    /// The answer comes just as the next question begins: nobody can have heard that one.
    #[test]
    fn an_answer_into_a_new_question_is_meant_for_the_old_one() {
        let two = [asked(0, 0.0, 2.0), asked(1, 2.8, 4.6)];
        let addressed = addressed(&two, 3.0);
        assert!(addressed.questions[0] > 0.95, "{addressed:?}");
    }

    #[test]
    fn what_no_question_fits_answers_none() {
        assert_eq!(addressed(&[], 3.0), Addressed { questions: vec![], none: 1.0 });
        let later = addressed(&[asked(0, 5.0, 6.0)], 3.0);
        assert_eq!((later.questions[0], later.none), (0.0, 1.0));
        let long_after = addressed(&[asked(0, 0.0, 1.0)], 600.0);
        assert!(long_after.none > 0.99, "{long_after:?}");
    }
}

//! Aggregate results of interactions.

use crate::simulation::interaction::{End, Outcome};
use crate::simulation::stats::{Interval, Mean, wilson};

/// Counts and means over interactions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// Interactions in which the wanted object was handed over.
    pub right: u64,
    /// Interactions in which another one was.
    pub wrong: u64,
    /// Interactions without a pick: the robot waited, was silenced or given up.
    pub without: u64,
    /// Questions asked, repetitions included.
    pub questions: Mean,
    /// Seconds from the request to the robot's decision to pick, or to its giving up.
    pub talk_s: Mean,
    /// Seconds from the request to the hand-over, or to the giving up.
    pub seconds: Mean,
    /// Discounted return.
    pub value: Mean,
    /// Answers that counted for another question than the one they were given to.
    pub misplaced: u64,
    /// Answers that counted.
    pub answers: u64,
    /// Interactions by number of questions; the last counts all with that many or more.
    pub histogram: [u64; HISTOGRAM],
}

/// Length of the histogram.
pub const HISTOGRAM: usize = 21;

impl Tally {
    /// Adds an interaction.
    pub fn add(&mut self, outcome: &Outcome) {
        match outcome.end {
            End::Right => self.right += 1,
            End::Wrong => self.wrong += 1,
            End::Waited | End::Abandoned | End::Cancelled => self.without += 1,
        }
        self.questions.add(f64::from(outcome.questions));
        self.talk_s.add(outcome.talk_s);
        self.seconds.add(outcome.seconds);
        self.value.add(outcome.value);
        self.misplaced += u64::from(outcome.misplaced);
        self.answers += u64::from(outcome.answers);
        self.histogram[(outcome.questions as usize).min(HISTOGRAM - 1)] += 1;
    }

    /// Adds all that `other` counted. Merge in the order of the interactions.
    pub fn merge(&mut self, other: &Self) {
        self.right += other.right;
        self.wrong += other.wrong;
        self.without += other.without;
        self.questions.merge(&other.questions);
        self.talk_s.merge(&other.talk_s);
        self.seconds.merge(&other.seconds);
        self.value.merge(&other.value);
        self.misplaced += other.misplaced;
        self.answers += other.answers;
        for (sum, more) in self.histogram.iter_mut().zip(other.histogram) {
            *sum += more;
        }
    }

    /// Interactions.
    pub fn interactions(&self) -> u64 {
        self.right + self.wrong + self.without
    }

    /// Share of the interactions that brought the wanted object; 0 of none.
    pub fn success(&self) -> f64 {
        share(self.right, self.interactions())
    }

    /// 95 % interval of [`Tally::success`].
    pub fn success_interval(&self) -> Interval {
        wilson(self.right, self.interactions())
    }

    /// Share of the answers that counted for another question than theirs; 0 of none.
    pub fn misplaced_share(&self) -> f64 {
        share(self.misplaced, self.answers)
    }
}

fn share(part: u64, whole: u64) -> f64 {
    if whole == 0 { 0.0 } else { part as f64 / whole as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(end: End, questions: u32) -> Outcome {
        Outcome {
            end,
            questions,
            talk_s: 1.0,
            seconds: f64::from(questions),
            value: -1.0,
            answers: questions,
            misplaced: 0,
        }
    }

    #[test]
    fn tally_counts_interactions_by_their_end() {
        let mut tally = Tally::default();
        for (end, questions) in
            [(End::Right, 1), (End::Right, 3), (End::Wrong, 0), (End::Abandoned, 99)]
        {
            tally.add(&outcome(end, questions));
        }
        assert_eq!((tally.right, tally.wrong, tally.without), (2, 1, 1));
        assert_eq!((tally.interactions(), tally.success()), (4, 0.5));
        assert_eq!((tally.histogram[0], tally.histogram[3]), (1, 1));
        assert_eq!(tally.histogram[HISTOGRAM - 1], 1);
        let mut twice = tally.clone();
        twice.merge(&tally);
        assert_eq!((twice.interactions(), twice.seconds.count()), (8, 8));
        assert_eq!(twice.histogram.iter().sum::<u64>(), 8);
        assert_eq!(Tally::default().success(), 0.0);
    }
}

//! Aggregate results of interactions.

use crate::simulation::interaction::SimulatedInteraction;
use user_study::Verdict;
use user_study::{Interval, Mean, wilson};

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
    /// Announced picks that were denied in time.
    pub denied: Mean,
    /// Seconds from the request to the robot's decision to pick, or to its giving up.
    pub talk_s: Mean,
    /// Seconds from the request to the hand-over, or to the giving up.
    pub seconds: Mean,
    /// Discounted return.
    pub value: Mean,
    /// Belief about the objects that the robot decided to pick.
    pub stated: Mean,
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
    pub fn add(&mut self, ended: &SimulatedInteraction) {
        match ended.verdict {
            Verdict::Right => self.right += 1,
            Verdict::Wrong => self.wrong += 1,
            _ => self.without += 1,
        }
        self.questions.add(f64::from(ended.questions));
        self.denied.add(f64::from(ended.denied));
        self.talk_s.add(ended.talk_s);
        self.seconds.add(ended.seconds);
        self.value.add(ended.value);
        ended.stated.into_iter().for_each(|stated| self.stated.add(stated));
        self.misplaced += u64::from(ended.misplaced);
        self.answers += u64::from(ended.answers);
        self.histogram[(ended.questions as usize).min(HISTOGRAM - 1)] += 1;
    }

    /// Adds all that `other` counted. Merge in the order of the interactions.
    pub fn merge(&mut self, other: &Self) {
        self.right += other.right;
        self.wrong += other.wrong;
        self.without += other.without;
        self.questions.merge(&other.questions);
        self.denied.merge(&other.denied);
        self.talk_s.merge(&other.talk_s);
        self.seconds.merge(&other.seconds);
        self.value.merge(&other.value);
        self.stated.merge(&other.stated);
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

    fn ended(verdict: Verdict, questions: u32) -> SimulatedInteraction {
        SimulatedInteraction {
            verdict,
            questions,
            denied: 0,
            talk_s: 1.0,
            seconds: f64::from(questions),
            value: -1.0,
            answers: questions,
            misplaced: 0,
            stated: Some(0.9),
        }
    }

    #[test]
    fn tally_counts_interactions_by_their_end() {
        let mut tally = Tally::default();
        for (verdict, questions) in [
            (Verdict::Right, 1),
            (Verdict::Right, 3),
            (Verdict::Wrong, 0),
            (Verdict::Abandoned, 99),
        ] {
            tally.add(&ended(verdict, questions));
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

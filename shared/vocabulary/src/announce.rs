//! The announced pick: "I will get the clear bowl" can be denied until the object is gripped.
//!
//! docs/pomdp.md, "The announced pick", states what announcing is worth, in this notation. With
//! `c = 0` a pick is final, as in the publication.

use serde::{Deserialize, Serialize};

use crate::{Costs, Fault};

/// Whether an announced pick can still be denied, and at which cost. By default, a pick is final.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Announce {
    /// `c`: probability that a user who sees another object announced denies it in time and is
    /// heard; at least 0 and below 1.
    pub heard: f64,
    /// Cost of a denied pick, seconds: the announcement, the reaction, the way back.
    pub cost_s: f64,
}

impl Announce {
    /// Announcement model in which a pick ends the interaction.
    pub const FINAL: Self = Self { heard: 0.0, cost_s: 0.0 };

    /// Default cost of a denied pick, seconds.
    pub const COST_S: f64 = 8.0;

    /// Whether picks are final.
    #[inline]
    pub fn is_final(&self) -> bool {
        self.heard <= 0.0
    }

    /// Every number that is out of range; empty if planners can use them. At `c = 1` announcing one
    /// object after the other would be as good as knowing.
    pub fn check(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        if !(self.heard >= 0.0 && self.heard < 1.0) {
            let what = format!("{} is not a probability below 1", self.heard);
            faults.push(("heard", what, "use a number from 0 to below 1, e.g. 0.8"));
        }
        if !(self.cost_s >= 0.0 && self.cost_s.is_finite()) {
            let what = format!("{} is not an amount of seconds", self.cost_s);
            faults.push(("cost_s", what, "use a number of at least 0, e.g. 8.0"));
        }
        faults
    }

    /// Probability of a denial if the announced object is wanted, and if another one is.
    #[inline]
    pub fn denials(&self, epsilon: f64) -> (f64, f64) {
        let odds = (epsilon / (1.0 - epsilon)).powi(2);
        let erroneous = odds / (1.0 + odds);
        (self.heard * erroneous, self.heard * (1.0 - erroneous))
    }

    /// Expected reward of announcing an object that is wanted with that probability, up to the
    /// denial and its cost; and the probability of the denial.
    #[inline]
    pub fn settle(&self, costs: &Costs, epsilon: f64, right: f64) -> (f64, f64) {
        let (own, other) = self.denials(epsilon);
        let wrong = 1.0 - right;
        let denied = right * own + wrong * other;
        let kept = right * (1.0 - own) * costs.correct - wrong * (1.0 - other) * costs.wrong;
        (kept - denied * self.cost_s, denied)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fault_is_told_at_once() {
        assert_eq!(Announce::default(), Announce::FINAL);
        assert!(Announce::FINAL.is_final() && Announce::FINAL.check().is_empty());
        let keys = |heard, cost_s| -> Vec<_> {
            Announce { heard, cost_s }.check().into_iter().map(|fault| fault.0).collect()
        };
        assert_eq!(keys(1.0, -1.0), ["heard", "cost_s"]);
        assert_eq!(keys(-0.1, f64::INFINITY), ["heard", "cost_s"]);
        assert_eq!(keys(f64::NAN, f64::NAN), ["heard", "cost_s"]);
        assert!(keys(0.99, 0.0).is_empty());
    }

    #[test]
    fn a_final_pick_is_worth_its_odds() {
        for right in [0.0, 0.3, 1.0] {
            let (kept, denied) = Announce::FINAL.settle(&Costs::SECONDS, 0.01, right);
            assert!((kept - Costs::SECONDS.pick_value(right)).abs() < 1e-12);
            assert_eq!(denied, 0.0);
        }
    }
}

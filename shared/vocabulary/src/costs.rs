//! Costs of actions and rewards of picks (section 3.5).

use serde::{Deserialize, Serialize};

use crate::Fault;

/// Costs of the actions and worth of a pick. All are positive magnitudes.
///
/// In the default, [`Costs::SECONDS`], the unit is one second of the person's time, and a wrong
/// pick costs as much as 100 of them. The other presets count in units of their own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Costs {
    /// Cost of waiting one turn, seconds.
    pub wait_s: f64,
    /// Cost of a yes/no question about an attribute, seconds.
    pub attribute_s: f64,
    /// Cost of an open question about an attribute, seconds.
    pub which_s: f64,
    /// Cost of a choice between two answers, seconds.
    pub choice_s: f64,
    /// Cost of every further answer that it offers, "neither" included, seconds.
    pub option_s: f64,
    /// Cost of pointing at an object and asking, seconds.
    pub point_s: f64,
    /// Reward of picking the wanted object.
    pub correct: f64,
    /// Penalty of picking another one (a positive number).
    pub wrong: f64,
    /// Discount per action, strictly between 0 and 1.
    pub discount: f64,
}

impl Default for Costs {
    fn default() -> Self {
        Self::SECONDS
    }
}

impl Costs {
    /// Durations of the robot's own voice and arm, in seconds.
    pub const SECONDS: Self = Self {
        wait_s: 1.0,
        attribute_s: 4.0,
        which_s: 4.5,
        choice_s: 4.0,
        option_s: 0.7,
        point_s: 6.0,
        correct: 50.0,
        wrong: 100.0,
        discount: 0.99,
    };

    /// The public configuration of the paper's predecessor (Whitney et al. 2017), with its
    /// horizon-shortening discount.
    pub const PREDECESSOR: Self = Self {
        wait_s: 1.0,
        attribute_s: 2.0,
        which_s: 2.5,
        choice_s: 2.0,
        option_s: 0.35,
        point_s: 6.0,
        correct: 10.0,
        wrong: 20.0,
        discount: 0.9,
    };

    /// Rewards of one, as solvers are usually tried with.
    pub const ABSTRACT: Self = Self {
        wait_s: 0.05,
        attribute_s: 0.1,
        which_s: 0.1,
        choice_s: 0.1,
        option_s: 0.0175,
        point_s: 0.3,
        correct: 1.0,
        wrong: 1.0,
        discount: 0.95,
    };

    /// The presets by name.
    pub const PRESETS: [(&'static str, Self); 3] = [
        ("seconds", Self::SECONDS),
        ("predecessor", Self::PREDECESSOR),
        ("abstract", Self::ABSTRACT),
    ];

    /// Returns the preset of the given name.
    pub fn preset(name: &str) -> Option<Self> {
        Self::PRESETS.iter().find(|(known, _)| *known == name).map(|(_, costs)| *costs)
    }

    /// Every cost that is out of range; empty if planners can use them.
    ///
    /// A question must cost something, or asking for ever would be free; the discount must be
    /// below 1, or waiting for ever would have no value.
    pub fn check(&self) -> Vec<Fault> {
        let positive = [
            ("wait_s", self.wait_s),
            ("attribute_s", self.attribute_s),
            ("which_s", self.which_s),
            ("choice_s", self.choice_s),
            ("option_s", self.option_s),
            ("point_s", self.point_s),
            ("correct", self.correct),
            ("wrong", self.wrong),
        ];
        let mut faults: Vec<Fault> = (positive.into_iter())
            .filter(|(_, amount)| !(*amount > 0.0 && amount.is_finite()))
            .map(|(key, amount)| {
                (key, format!("{amount} is not a positive amount"), "use a finite number above 0")
            })
            .collect();
        if !(self.discount > 0.0 && self.discount < 1.0) {
            let what = format!("{} is not a discount", self.discount);
            faults.push(("discount", what, "use a number above 0 and below 1, e.g. 0.99"));
        }
        faults
    }

    /// Expected reward of picking an object that is wanted with that probability.
    #[inline]
    pub fn pick_value(&self, probability: f64) -> f64 {
        probability * (self.correct + self.wrong) - self.wrong
    }

    /// Return of waiting for ever: the value that every other plan has to beat.
    #[inline]
    pub fn wait_value(&self) -> f64 {
        -self.wait_s / (1.0 - self.discount)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_are_usable_and_found_by_name() {
        for (name, costs) in Costs::PRESETS {
            assert_eq!(costs.check(), Vec::new(), "{name}");
            assert_eq!(Costs::preset(name), Some(costs));
        }
        assert_eq!(Costs::preset("free"), None);
    }

    #[test]
    fn every_fault_is_told_at_once() {
        let broken = Costs {
            wait_s: 0.0,
            attribute_s: -1.0,
            which_s: f64::NAN,
            choice_s: 0.0,
            option_s: -0.5,
            point_s: f64::INFINITY,
            correct: 0.0,
            wrong: -100.0,
            discount: 1.0,
        };
        let keys: Vec<_> = broken.check().into_iter().map(|fault| fault.0).collect();
        let asked = ["wait_s", "attribute_s", "which_s", "choice_s", "option_s", "point_s"];
        let all = [&asked[..], &["correct", "wrong", "discount"]].concat();
        assert_eq!(keys, all);
    }

    #[test]
    fn a_pick_is_worth_its_odds() {
        assert_eq!(Costs::SECONDS.pick_value(1.0), 50.0);
        assert_eq!(Costs::SECONDS.pick_value(0.0), -100.0);
        assert!((Costs::PREDECESSOR.wait_value() + 10.0).abs() < 1e-12);
    }
}

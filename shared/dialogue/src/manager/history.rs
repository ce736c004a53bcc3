//! Deliveries by object, and the prior that follows from them.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Most names that are counted. Beyond it the rarest is dropped.
pub(super) const NAMES_MAX: usize = 512;

/// Deliveries of each object by its name, across restarts and changes of the scene.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct History {
    delivered: BTreeMap<String, u64>,
}

impl History {
    /// Counts a delivery.
    pub fn count(&mut self, name: &str) {
        self.count_within(name, NAMES_MAX);
    }

    /// Counts a delivery, up to the given number of names.
    pub fn count_within(&mut self, name: &str, names_max: usize) {
        if !self.delivered.contains_key(name) && self.delivered.len() >= names_max {
            // Of several the last by name, so that a replay drops the same.
            let rarest = self.delivered.iter().rev().min_by_key(|(_, count)| **count);
            if let Some(rarest) = rarest.map(|(name, _)| name.clone()) {
                self.delivered.remove(&rarest);
            }
        }
        *self.delivered.entry(name.to_owned()).or_default() += 1;
    }

    /// Takes back a delivery that was refused.
    pub fn discount(&mut self, name: &str) {
        let count = self.delivered.get(name).copied().unwrap_or(0);
        match count {
            0 | 1 => drop(self.delivered.remove(name)),
            more => drop(self.delivered.insert(name.to_owned(), more - 1)),
        }
    }

    /// Deliveries by object, in the order of the names.
    pub fn iter(&self) -> impl Iterator<Item = (&str, u64)> {
        self.delivered.iter().map(|(name, count)| (name.as_str(), *count))
    }

    /// Returns the deliveries of an object.
    pub fn of(&self, name: &str) -> u64 {
        self.delivered.get(name).copied().unwrap_or(0)
    }

    /// Returns the posterior mean of a Dirichlet distribution with weight `smoothing` for each
    /// object: `(n_i + s) / Σ_j (n_j + s)`, in the order of the names.
    pub fn prior<'a>(&self, names: impl Iterator<Item = &'a str>, smoothing: f64) -> Vec<f64> {
        let weights: Vec<f64> = names.map(|name| self.of(name) as f64 + smoothing).collect();
        let sum: f64 = weights.iter().sum();
        weights.into_iter().map(|weight| weight / sum).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn history_makes_frequent_objects_more_probable() {
        let mut history = History::default();
        let names = || ["cup", "bowl", "jug"].into_iter();
        assert_eq!(history.prior(names(), 1.0), [1.0 / 3.0; 3]);
        for name in ["bowl", "bowl", "jug", "gone"] {
            history.count(name);
        }
        assert_eq!(history.prior(names(), 1.0), [1.0 / 6.0, 3.0 / 6.0, 2.0 / 6.0]);
        let smooth = history.prior(names(), 1e6);
        assert!(smooth.iter().all(|p| (p - 1.0 / 3.0).abs() < 1e-6), "{smooth:?}");
        assert_eq!(history.of("gone"), 1, "it may come back");
        ["gone", "gone", "bowl"].into_iter().for_each(|name| history.discount(name));
        assert_eq!((history.of("gone"), history.of("bowl")), (0, 1), "refused ones do not count");
    }

    #[test]
    fn history_drops_the_rarest_name() {
        let mut history = History::default();
        for n in 0..NAMES_MAX {
            history.count(&format!("often{n:04}"));
            history.count(&format!("often{n:04}"));
        }
        history.count("once");
        history.count("twice");
        history.count("twice");
        assert_eq!((history.of("once"), history.of("twice")), (0, 2));
        assert_eq!(history.delivered.len(), NAMES_MAX);
    }
}

//! Sums over some of the classes, from which everything about the belief after an answer follows.

use super::bound::Summary;

/// Sums and maxima over some classes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Block {
    /// `Σ b`.
    pub(super) mass: f64,
    /// `Σ b ln b`.
    pub(super) log: f64,
    /// `Σ b r`.
    pub(super) worth: f64,
    /// Greatest probability of a class.
    pub(super) peak: f64,
    /// Greatest probability of an object.
    pub(super) top: f64,
}

impl Block {
    /// One class: its probability, the share of its best object, and its worth `r`.
    pub(super) fn class(mass: f64, share: f64, worth: f64) -> Self {
        let log = if mass > 0.0 { mass * mass.ln() } else { 0.0 };
        Self { mass, log, worth: mass * worth, peak: mass, top: mass * share }
    }

    /// The sums of both.
    pub(super) fn plus(&self, other: &Self) -> Self {
        Self {
            mass: self.mass + other.mass,
            log: self.log + other.log,
            worth: self.worth + other.worth,
            peak: self.peak.max(other.peak),
            top: self.top.max(other.top),
        }
    }

    /// The sums without those of a part, whose other classes have these maxima.
    pub(super) fn without(&self, part: &Self, maxima: Maxima) -> Self {
        Self {
            mass: (self.mass - part.mass).max(0.0),
            log: self.log - part.log,
            worth: self.worth - part.worth,
            peak: maxima.peak,
            top: maxima.top,
        }
    }

    /// The same classes, each with `factor` times its probability.
    pub(super) fn weigh(&self, factor: f64) -> Self {
        if factor <= 0.0 {
            return Self::default();
        }
        Self {
            mass: factor * self.mass,
            log: factor * (self.log + self.mass * factor.ln()),
            worth: factor * self.worth,
            peak: factor * self.peak,
            top: factor * self.top,
        }
    }

    /// The belief over these classes alone, normalised.
    pub(super) fn summary(&self) -> Summary {
        let mass = self.mass.max(f64::MIN_POSITIVE);
        Summary {
            worth: self.worth / mass,
            entropy: (mass.ln() - self.log / mass).max(0.0),
            peak: (self.peak / mass).min(1.0),
            top: (self.top / mass).min(1.0),
        }
    }
}

/// Greatest probability of a class and of an object.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Maxima {
    peak: f64,
    top: f64,
}

/// The two greatest of each, so that the maxima of all blocks but one are known at once.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TwoGreatest {
    first: Maxima,
    second: Maxima,
}

impl TwoGreatest {
    pub(super) fn of<'a>(blocks: impl Iterator<Item = &'a Block>) -> Self {
        let mut two = Self::default();
        for block in blocks {
            two.second.peak = two.second.peak.max(block.peak.min(two.first.peak));
            two.first.peak = two.first.peak.max(block.peak);
            two.second.top = two.second.top.max(block.top.min(two.first.top));
            two.first.top = two.first.top.max(block.top);
        }
        two
    }

    /// The maxima over all blocks that were looked at but this one.
    pub(super) fn but(&self, block: &Block) -> Maxima {
        Maxima {
            peak: if block.peak < self.first.peak { self.first.peak } else { self.second.peak },
            top: if block.top < self.first.top { self.first.top } else { self.second.top },
        }
    }
}

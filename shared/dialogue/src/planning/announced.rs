//! Announced picks in the reduced problem: their rewards, and bounds on the value with them.

use vocabulary::{Announce, Costs};

use super::channel::Price;
use crate::DecisionProblem;

/// A pick that can be denied; see [`Announce`]. Every class has one object to announce.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Announced {
    announce: Announce,
    costs: Costs,
    epsilon: f64,
    /// Probability of a denial of the wanted object.
    pub(super) own: f64,
    /// Probability of a denial of another one.
    pub(super) other: f64,
}

impl Announced {
    /// Returns `None` if picks are final.
    pub(super) fn of(problem: &DecisionProblem<'_>) -> Option<Self> {
        let (announce, costs, epsilon) =
            (problem.announce, problem.costs, problem.model.params().epsilon);
        let (own, other) = announce.denials(epsilon);
        (!announce.is_final()).then_some(Self { announce, costs, epsilon, own, other })
    }

    /// Immediate reward, as a price, of announcing an object of the given probability, and the
    /// probability of a denial.
    pub(super) fn price(&self, right: f64) -> (Price, f64) {
        let (settled, denied) = self.announce.settle(&self.costs, self.epsilon, right);
        (Price { cost: -settled, discount: self.costs.discount, times: 0.0 }, denied)
    }

    /// Value of announcing, if every denial is followed by that value.
    pub(super) fn value(&self, right: f64, after: f64) -> f64 {
        let (price, denied) = self.price(right);
        price.pay(denied * after)
    }

    /// Value of announcing the same until not denied, at a belief that denials leave as it is.
    fn insisting(&self, right: f64) -> f64 {
        let (price, denied) = self.price(right);
        -price.cost / (1.0 - price.discount * denied)
    }

    /// `r`: value of knowing the wanted object.
    pub(super) fn certain(&self) -> f64 {
        self.insisting(1.0)
    }

    /// A value that no belief over that many classes goes below: that of always announcing the most
    /// probable object, whose probability `x` is at least `1/n`. If `f ≤ Q(x, f)` for all those
    /// `x`, every denial leads to `f` or more again; `Q` is linear in `x`, so its ends decide.
    pub(super) fn floor(&self, classes: usize) -> f64 {
        self.insisting(1.0).min(self.insisting(1.0 / classes as f64))
    }

    /// Upper bound on the value of knowing that the wanted object is among some that only
    /// announcing distinguishes, times their probability: `U(m)` for their probabilities `m`.
    ///
    /// An easier problem: an erroneous denial is known as such. An object that was denied is then
    /// out or known, and the rest is announced in the order of falling probability, as an exchange
    /// of neighbours shows: `U(m) = m_i v − (M−m_i) w + γ·other·U(m without i)`, where `v` is the
    /// value of knowing the object, `w` the cost of announcing a wrong one, and `M = Σ m`. Waiting
    /// and other announcements are worth at least `M` times the greater of two constants.
    pub(super) fn among(&self, mass: &[f64]) -> f64 {
        let mut mass = mass.to_vec();
        mass.sort_unstable_by(f64::total_cmp);
        let (certain, wrong, again) =
            (self.certain(), self.wrong(), self.costs.discount * self.other);
        let least = self.costs.wait_value().max(-wrong / (1.0 - again));
        let step = |(all, value): (f64, f64), m: f64| {
            let all = all + m;
            (all, f64::max(least * all, m * certain - (all - m) * wrong + again * value))
        };
        mass.into_iter().fold((0.0, 0.0), step).1
    }

    /// Cost of announcing another object than the wanted one, without later costs.
    fn wrong(&self) -> f64 {
        self.price(0.0).0.cost
    }

    /// The least `δ` for which announcing does not beat `ψ(b) = Σ_g U_g + δ − B·H(b)` at any belief
    /// over that many groups of objects that only announcing distinguishes, where `H` is the
    /// entropy over groups and `U_g ≥ b_g u` bounds the worth of knowing a group ([`Self::among`]).
    ///
    /// Let the announced object be of group `g` with probability `y`, `P` the probability of its
    /// denial, `a` that of a denial and `g`, and `b⁻` the belief after it. Since `U_g` is not
    /// beaten by announcing if the group is known, announcing beats `ψ` at most by
    ///
    /// `G = −(1−y) (w + (1 − γ·other) u) − (1 − γP) δ + B (H(b) − γ P H(b⁻))`.
    ///
    /// `P·H(b⁻)` is concave in `a`, so `G` is convex in it and greatest at an end: `own·y` (a group
    /// of one) or `other·y` (an object that is not wanted for certain). The entropy among the other
    /// groups enters with the factor `(1−y)(1 − γ·other) ≥ 0` and is at its worst where they are
    /// alike. Then the second derivative of `H(b) − γ P H(b⁻)` is, at the first end, `−(1−γ·own)/y
    /// − (1−γ·other)/(1−y) − γ(own−other)²/P < 0`, and `(1 − γ·other) H''(b) < 0` at the second:
    /// `G` is concave in `y` for every `δ`, and a climb to the top of each raises `δ` to the least
    /// one (Dinkelbach).
    pub(super) fn offset(&self, groups: usize, u: f64, price: f64) -> f64 {
        let ends = [self.own, self.other];
        ends.into_iter().map(|end| self.offset_at(end, groups, u, price)).fold(0.0, f64::max)
    }

    fn offset_at(&self, end: f64, groups: usize, u: f64, price: f64) -> f64 {
        if groups < 2 {
            return 0.0;
        }
        let among = ((groups - 1) as f64).ln();
        let discount = self.costs.discount;
        let missed = self.wrong() + (1.0 - discount * self.other) * u;
        // G for δ = 0, and 1 − γP.
        let parts = |y: f64| {
            let rest = 1.0 - y;
            let (own, other) = (y * end, rest * self.other);
            let denied = own + other;
            let before = surprise(y) + surprise(rest) + rest * among;
            let after = surprise(own) + surprise(other) - surprise(denied) + other * among;
            (price * (before - discount * after) - rest * missed, 1.0 - discount * denied)
        };
        let mut offset = 0.0;
        for _ in 0..DINKELBACH_MAX {
            let top = highest(|x| {
                let (gain, kept) = parts(x);
                gain - offset * kept
            });
            let (gain, kept) = parts(top);
            let next = (gain / kept).max(offset);
            if next - offset < ROUNDING {
                break;
            }
            offset = next;
        }
        // The climb ends next to the top, which a concave function is below by a square of that.
        offset + ROUNDING
    }
}

/// Iterations converge quadratically: a few are enough.
const DINKELBACH_MAX: usize = 20;
/// Rounding in units of the costs.
const ROUNDING: f64 = 1e-9;

/// The place of the maximum of a concave function between 0 and 1, by golden section.
fn highest(f: impl Fn(f64) -> f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    const STEPS: usize = 48;
    let (mut low, mut high) = (0.0, 1.0);
    let (mut left, mut right) = (high - GOLDEN, low + GOLDEN);
    let (mut at_left, mut at_right) = (f(left), f(right));
    for _ in 0..STEPS {
        if at_left < at_right {
            (low, left, at_left) = (left, right, at_right);
            right = low + GOLDEN * (high - low);
            at_right = f(right);
        } else {
            (high, right, at_right) = (right, left, at_left);
            left = high - GOLDEN * (high - low);
            at_left = f(left);
        }
    }
    // The ends themselves are never looked at on the way.
    [low, 0.5 * (low + high), high]
        .into_iter()
        .reduce(|best, next| if f(next) > f(best) { next } else { best })
        .unwrap_or(0.5)
}

/// `−p ln p`.
fn surprise(p: f64) -> f64 {
    if p > 0.0 { -p * p.ln() } else { 0.0 }
}

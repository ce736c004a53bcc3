//! The value of the easier problem in which all classes but one may be picked together.
//!
//! A planner that learns for free, in the end, which of the other classes is wanted cannot do
//! worse, so the value of that two-class problem bounds the real one from above, for any choice of
//! the one class. It is nearly exact when one class is nearly certain, which matters most: whether
//! to make sure or to pick is the last decision of every dialogue.
//!
//! An announced pick of a third class distinguishes the two no more than silence, and is paid as a
//! wrong one.
//!
//! Between two classes every question is a symmetric channel: an open one at best confuses two of
//! its values, and its other answers distinguish the two no more than silence.

use vocabulary::Costs;

use super::announced::Announced;
use super::channel::Price;
use super::reduced::Reduced;

/// Upper bound on the value as a function of the probability of the one class.
#[derive(Clone, Debug)]
pub(super) struct Doubt {
    /// Values at `x = 1 − u²` for equally spaced `u` from 0 (certain) to `√½` (evenly split): dense
    /// near the decision between asking and picking.
    grid: Vec<f64>,
}

/// Points of the grid, without the last.
const POINTS: usize = 64;
/// Stopping earlier leaves the bound less tight, never wrong.
const SWEEPS_MAX: usize = 100;
/// Greatest `u`.
const SPAN: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// A symmetric question about two classes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Split {
    price: Price,
    right: f64,
}

impl Doubt {
    pub(super) fn new(reduced: &Reduced, costs: &Costs) -> Self {
        let share = reduced.share.iter().copied().fold(0.0, f64::max);
        let announced = reduced.announced.as_ref();
        let is_final = announced.is_none() || reduced.absent.is_some();
        let pick = |x: f64| if is_final { costs.pick_value(share * x) } else { f64::NEG_INFINITY };
        let stop = |x: f64| pick(x).max(costs.wait_value());
        let most = announced.map_or(f64::NEG_INFINITY, Announced::certain).max(stop(1.0));
        let splits = splits(reduced, costs);
        // Starting above and improving from there stays above: the two-class value is convex, so
        // that interpolating it linearly does, too.
        let mut doubt = Self { grid: vec![most; POINTS + 1] };
        let enough = 1e-6 * (costs.correct + costs.wrong);
        for _ in 0..SWEEPS_MAX {
            let mut change = 0.0_f64;
            for point in 0..=POINTS {
                let value = doubt.backup(point, &splits, announced, &stop);
                change = change.max(doubt.grid[point] - value);
                doubt.grid[point] = value;
            }
            if change < enough {
                break;
            }
        }
        doubt
    }

    /// The bound for a class of probability `x`.
    pub(super) fn upper(&self, x: f64) -> f64 {
        let u = x.min(1.0 - x).max(0.0).sqrt() * (POINTS as f64 / SPAN);
        let below = (u as usize).min(POINTS - 1);
        // Linear in x between the two points, not in u, as convexity requires.
        let (near, far) = (below as f64, below as f64 + 1.0);
        let part = ((u * u - near * near) / (far * far - near * near)).clamp(0.0, 1.0);
        self.grid[below] + part * (self.grid[below + 1] - self.grid[below])
    }

    fn backup(
        &self,
        n: usize,
        splits: &[Split],
        announced: Option<&Announced>,
        stop: &dyn Fn(f64) -> f64,
    ) -> f64 {
        let u = n as f64 * (SPAN / POINTS as f64);
        let x = 1.0 - u * u;
        let asked = splits.iter().map(|split| {
            let confirmed = x * split.right + (1.0 - x) * (1.0 - split.right);
            let denied = 1.0 - confirmed;
            let after = confirmed * self.upper(x * split.right / confirmed)
                + denied * self.upper(x * (1.0 - split.right) / denied);
            split.price.discount * after - split.price.cost
        });
        let picked = announced.map_or(f64::NEG_INFINITY, |announced| self.announce(announced, x));
        asked.fold(stop(x).max(picked), f64::max).min(self.grid[n])
    }

    /// Value of the best announced pick: of either class, or of neither.
    fn announce(&self, announced: &Announced, x: f64) -> f64 {
        let of = |right: f64| {
            let denied = announced.price(right).1;
            announced.value(right, self.upper(right * announced.own / denied))
        };
        of(x).max(of(1.0 - x)).max(announced.value(0.0, self.upper(x)))
    }
}

fn splits(reduced: &Reduced, costs: &Costs) -> Vec<Split> {
    let mut splits: Vec<Split> = Vec::new();
    for channel in reduced.channels() {
        let answered = channel.own + channel.other;
        let unheard = 1.0 - answered / channel.price.times;
        let split = Split {
            price: Price::new(costs, channel.cost, unheard),
            right: channel.own / answered,
        };
        if !splits.contains(&split) {
            splits.push(split);
        }
    }
    splits
}

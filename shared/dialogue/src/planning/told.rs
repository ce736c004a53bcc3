//! The value for a planner that learns the wanted class, but plays for compensated stakes.
//!
//! docs/pomdp.md, "Certified bounds on hard scenes", derives the bound in this notation.

use vocabulary::Costs;

use super::channel::Channel;

/// Upper bounds `w(x)`.
#[derive(Clone, Debug)]
pub(super) struct Told {
    stakes: Stakes,
    /// `r` per cell.
    rest: Vec<f64>,
}

/// Rewards at stake.
#[derive(Clone, Copy, Debug)]
struct Stakes {
    costs: Costs,
    channel: Channel,
    /// Value of picking the class if it is wanted.
    worth: f64,
    /// `B`.
    price: f64,
    /// `K`.
    credit: f64,
    /// `−B ln Σ exp(−K_i / B)` of the other classes, whose `Σ y_i (K_i + B ln y_i)` is least if
    /// each `y_i` is proportional to `exp(−K_i / B)`.
    against: f64,
}

/// Classes whose best object has the same share of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kind {
    pub(super) share: f64,
    pub(super) classes: usize,
}

/// A question, given the probability of the classes that say yes; the first of each pair is theirs,
/// the second that of the others.
#[derive(Clone, Copy, Debug)]
pub(super) struct Split {
    /// Probability of the answer that is true of them.
    pub(super) heard: [f64; 2],
    /// Logarithm of `heard`.
    pub(super) log: [f64; 2],
    /// `B (I − d)`.
    pub(super) compensation: [f64; 2],
}

/// A range of the probability of the classes that say yes, and the bound for a question about them.
struct Step {
    /// Probability of yes at both ends.
    yes: [f64; 2],
    /// `−c + B·I − (1−γ) B d` at most.
    gain: f64,
    /// `B (I − d)` at most.
    compensation: f64,
}

/// Last computed values of a cell's questions, from its own range of yes on. They only fall from
/// sweep to sweep, so most need no second look.
struct Asked {
    worth: Vec<f64>,
    best: usize,
}

/// Cells per octave of the odds `x / (1 − x)`, as a power of two.
const CELL_BITS: u64 = 5;
/// Octaves below and above even odds.
const OCTAVES: [i32; 2] = [17, 11];
const CELLS: usize = ((OCTAVES[0] + OCTAVES[1]) as usize) << CELL_BITS;
/// Stopping earlier leaves the bound less tight, never wrong.
const SWEEPS_MAX: usize = 60;
/// Share of the reward still ahead at which `B` is the cost of a nat at full capacity.
const AHEAD: f64 = 0.5;
/// `K` falls short of the stake by that many questions.
const SHORT: f64 = 1.5;

impl Told {
    /// The bounds for the classes of the first kind among those of all, and questions like this
    /// one, the cheapest; `None` if they cannot be shown.
    pub(super) fn new(costs: &Costs, channel: &Channel, kinds: &[Kind]) -> Option<Self> {
        let (cost, discount) = (channel.price.cost, channel.price.discount);
        let price = (cost + (1.0 - discount) * AHEAD * costs.correct) / channel.capacity;
        let worth = |kind: &Kind| costs.pick_value(kind.share);
        // The stake of those who know the class: once told, they gain nothing by another pick.
        let credit = |kind: &Kind| {
            worth(kind).max(costs.wait_value()).max(-costs.wrong) + costs.wrong - SHORT * cost
        };
        let [own, others @ ..] = kinds else { return None };
        let others = others.iter().map(|kind| (kind, kind.classes)).chain([(own, own.classes - 1)]);
        let against: f64 = others.map(|(kind, n)| n as f64 * (-credit(kind) / price).exp()).sum();
        let stakes = Stakes {
            costs: *costs,
            channel: *channel,
            worth: worth(own),
            price,
            credit: credit(own),
            against: -price * against.ln(),
        };
        let rest = (0..CELLS).map(|cell| costs.correct - price * span(cell)[0].ln()).collect();
        let mut told = Self { stakes, rest };
        let steps: Vec<Step> = (0..CELLS).map(|cell| stakes.step(span(cell))).collect();
        let mut asked: Vec<Asked> = (0..CELLS).map(Asked::before_the_first_sweep).collect();
        for _ in 0..SWEEPS_MAX {
            if told.sweep(&steps, &mut asked)? < 1e-3 * cost {
                break;
            }
        }
        told.is_bounded_below_the_cells(&steps).then_some(told)
    }

    /// `w(x)`, given the logarithm too.
    pub(super) fn value(&self, x: f64, log: f64) -> f64 {
        self.value_at(cell(x), log)
    }

    /// The same for `x = joint / heard`, where `joint` is the probability of class and answer.
    pub(super) fn value_after(&self, joint: f64, heard: f64, log: f64) -> f64 {
        let odds = joint / (heard - joint).max(f64::MIN_POSITIVE);
        self.value_at(cell_of(odds), log)
    }

    fn value_at(&self, cell: Option<usize>, log: f64) -> f64 {
        cell.map_or(self.stakes.costs.correct, |cell| self.stakes.price * log + self.rest[cell])
    }

    /// `κ` of a class whose probability has that logarithm.
    pub(super) fn compensation(&self, log: f64) -> f64 {
        (self.stakes.credit + self.stakes.price * log).max(0.0)
    }

    pub(super) fn split(&self, yes: f64) -> Split {
        self.stakes.split(yes)
    }

    /// Lowers every cell to the bound given by the others; returns the largest change, `None` if a
    /// cell would rise.
    fn sweep(&mut self, steps: &[Step], asked: &mut [Asked]) -> Option<f64> {
        let mut change = 0.0_f64;
        for (cell, asked) in asked.iter_mut().enumerate().rev() {
            let span = span(cell);
            // The classes of its side are at least as probable as the class itself.
            let surest = steps[cell].yes[1];
            let of = |step: usize| self.asked(span, surest, &steps[cell + step]);
            let value = asked.best(of).max(self.stakes.stop(span));
            let before = self.rest[cell];
            if value > before + ROUNDING {
                return None;
            }
            self.rest[cell] = value.min(before);
            change = change.max(before - value);
        }
        Some(change)
    }

    fn asked(&self, [low, high]: [f64; 2], surest: f64, step: &Step) -> f64 {
        let Stakes { channel: Channel { own, other, price, .. }, price: nat, .. } = self.stakes;
        let [least, most] = step.yes;
        let right = self.most(low * own / most, high * own / least.max(surest));
        let wrong = self.most(low * other / (1.0 - least), high * other / (1.0 - most));
        step.gain - (1.0 - price.discount) * nat * low.ln()
            + price.discount * (own * right + other * wrong)
    }

    /// Greatest `r` between two probabilities.
    fn most(&self, low: f64, high: f64) -> f64 {
        let below = match cell(low) {
            None => self.stakes.costs.correct - self.stakes.price * low.ln(),
            Some(_) => f64::NEG_INFINITY,
        };
        let Some(last) = cell(high) else { return below };
        self.rest[cell(low).unwrap_or(0)..=last].iter().copied().fold(below, f64::max)
    }

    /// Whether no question makes `w` exceed the reward if it is used for `w`.
    fn is_bounded_below_the_cells(&self, steps: &[Step]) -> bool {
        let Stakes { costs, channel, price, .. } = self.stakes;
        let of_cell = |(cell, rest): (usize, &f64)| price * span(cell)[1].ln() + rest;
        let greatest = self.rest.iter().enumerate().map(of_cell).fold(costs.correct, f64::max);
        let after = channel.price.pay(greatest);
        steps.iter().all(|step| after + step.compensation <= costs.correct)
    }
}

impl Asked {
    fn before_the_first_sweep(cell: usize) -> Self {
        Self { worth: vec![f64::INFINITY; CELLS - cell], best: 0 }
    }

    /// Current value of the best question.
    fn best(&mut self, now: impl Fn(usize) -> f64) -> f64 {
        let mut greatest = now(self.best);
        self.worth[self.best] = greatest;
        for (step, worth) in self.worth.iter_mut().enumerate() {
            if *worth > greatest {
                *worth = now(step);
                if *worth > greatest {
                    (greatest, self.best) = (*worth, step);
                }
            }
        }
        greatest
    }
}

impl Stakes {
    fn split(&self, yes: f64) -> Split {
        let Channel { own, other, noise, .. } = self.channel;
        let heard = yes * own + (1.0 - yes) * other;
        let heard = [heard, 1.0 - heard];
        let log = heard.map(f64::ln);
        let informs = [0, 1].map(|side| -noise - own * log[side] - other * log[1 - side]);
        let mean = yes * informs[0] + (1.0 - yes) * informs[1];
        Split { heard, log, compensation: informs.map(|informs| self.price * (mean - informs)) }
    }

    /// Bounds for a question to which classes of a probability in that range say yes, one of them
    /// the wanted one. `I` is greatest at one half, `d` falls with the probability.
    fn step(&self, [low, high]: [f64; 2]) -> Step {
        let Channel { own, other, noise, price, .. } = self.channel;
        let yes = |p: f64| p * own + (1.0 - p) * other;
        let informs = |p: f64| {
            let heard = yes(p);
            -noise - own * heard.ln() - other * (1.0 - heard).ln()
        };
        let mean = |p: f64| p * informs(p) + (1.0 - p) * informs(1.0 - p);
        let [most, least] = [mean(0.5_f64.clamp(low, high)), informs(high)];
        Step {
            yes: [yes(low), yes(high)],
            gain: self.price * (most - (1.0 - price.discount) * least) - price.cost,
            compensation: self.price * (most - least),
        }
    }

    /// `stop − B ln x` at most. The picked class pays for the others.
    fn stop(&self, [low, high]: [f64; 2]) -> f64 {
        let log = self.price * low.ln();
        let others = self.against + self.price * (1.0 - high).ln();
        let own = self.worth - (1.0 - high) / high * others.max(0.0);
        let idle = self.costs.wait_value().max(-self.costs.wrong);
        (own.max(idle) - log).max(self.credit - self.costs.wrong)
    }
}

/// Rounding in units of the costs.
const ROUNDING: f64 = 1e-9;
/// Number of low bits cut off from the odds.
const SHIFT: u64 = 52 - CELL_BITS;
/// The bits of the least odds.
const FIRST: u64 = ((1023 - OCTAVES[0]) as u64) << CELL_BITS;

/// The cell of a probability: odds that agree in their leading bits share one.
fn cell(x: f64) -> Option<usize> {
    cell_of(x / (1.0 - x).max(f64::MIN_POSITIVE))
}

fn cell_of(odds: f64) -> Option<usize> {
    let cell = (odds.to_bits() >> SHIFT).checked_sub(FIRST)?;
    Some((cell as usize).min(CELLS - 1))
}

/// Least and greatest probability of a cell.
fn span(cell: usize) -> [f64; 2] {
    let at = |cell: usize| {
        let odds = f64::from_bits((FIRST + cell as u64) << SHIFT);
        odds / (1.0 + odds)
    };
    [at(cell), if cell + 1 < CELLS { at(cell + 1) } else { 1.0 }]
}

//! Movements of the simulated gripper: straight lines that begin and end at rest.

use std::collections::VecDeque;

/// Speed of long movements, m/s: the simulated Baxter's, about.
const SPEED_M_S: f64 = 0.4;
/// Time for which a movement accelerates and brakes, seconds.
const RAMPS_S: f64 = 0.5;

/// One movement of the gripper, or of its fingers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Leg {
    pub(crate) kind: Kind,
    /// Place at its end, metres, frame `base`.
    pub(crate) to: [f64; 3],
    pub(crate) seconds: f64,
}

/// Kind of a movement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The gripper travels.
    Travel,
    /// The fingers close.
    Close,
    /// The fingers open.
    Open,
}

/// The gripper on its way.
#[derive(Clone, Debug)]
pub(crate) struct Mover {
    at: [f64; 3],
    from: [f64; 3],
    legs: VecDeque<Leg>,
    t_s: f64,
}

impl Mover {
    /// A gripper at rest.
    pub(crate) fn new(at: [f64; 3]) -> Self {
        Self { at, from: at, legs: VecDeque::new(), t_s: 0.0 }
    }

    /// Returns the place of the gripper, metres, frame `base`.
    pub(crate) fn at(&self) -> [f64; 3] {
        self.at
    }

    /// Returns the kind of the present movement.
    pub(crate) fn kind(&self) -> Option<Kind> {
        self.legs.front().map(|leg| leg.kind)
    }

    /// Returns the seconds until the last movement ends.
    pub(crate) fn remaining_s(&self) -> f64 {
        self.legs.iter().map(|leg| leg.seconds).sum::<f64>() - self.t_s
    }

    /// Replaces the movements by ones that begin at the gripper's place.
    pub(crate) fn go(&mut self, steps: &[(Kind, [f64; 3], f64)]) {
        (self.from, self.t_s) = (self.at, 0.0);
        self.legs.clear();
        let mut from = self.at;
        for (kind, to, least_s) in steps {
            let seconds = match kind {
                Kind::Travel => least_s + distance(&from, to) / SPEED_M_S + RAMPS_S,
                Kind::Close | Kind::Open => *least_s,
            };
            self.legs.push_back(Leg { kind: *kind, to: *to, seconds });
            from = *to;
        }
    }

    /// Moves for at most `seconds`; returns those that are left once the last movement has ended.
    pub(crate) fn advance(&mut self, seconds: f64) -> Option<f64> {
        let mut left_s = seconds;
        while let Some(leg) = self.legs.front().copied() {
            self.t_s += left_s;
            if self.t_s < leg.seconds {
                self.at = between(&self.from, &leg.to, smooth(self.t_s / leg.seconds));
                return None;
            }
            left_s = self.t_s - leg.seconds;
            (self.at, self.from, self.t_s) = (leg.to, leg.to, 0.0);
            self.legs.pop_front();
        }
        Some(left_s)
    }
}

/// Share of the way after that share of the time: without a jump of the speed.
fn smooth(u: f64) -> f64 {
    u * u * (3.0 - 2.0 * u)
}

fn between(from: &[f64; 3], to: &[f64; 3], share: f64) -> [f64; 3] {
    std::array::from_fn(|axis| from[axis] + share * (to[axis] - from[axis]))
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

//! Faults drawn from a seed. They stop after a while, so that every dialogue can end: before that
//! safety must hold, after that progress must be made.

use dialogue::Rng;
use service::{Span, Time};

use super::Crash;

/// Probabilities of the faults: per pass for kills, per message for losses and duplicates.
#[derive(Clone, Debug)]
pub struct Faults {
    rng: Rng,
    kill: f64,
    loss: f64,
    double: f64,
}

/// When faults stop.
const CALM_FROM: Time = Time(20_000_000_000);

impl Faults {
    /// No faults.
    pub fn none() -> Self {
        Self { rng: Rng::new(0), kill: 0.0, loss: 0.0, double: 0.0 }
    }

    /// Processes are killed.
    pub fn kills(seed: u64) -> Self {
        Self { rng: Rng::new(seed), kill: 0.01, ..Self::none() }
    }

    /// Messages are lost and duplicated.
    pub fn losses(seed: u64) -> Self {
        Self { rng: Rng::new(seed), loss: 0.3, double: 0.1, ..Self::none() }
    }

    /// Processes are killed, and messages are lost and duplicated.
    pub fn everything(seed: u64) -> Self {
        Self { rng: Rng::new(seed), kill: 0.008, loss: 0.15, double: 0.1 }
    }

    fn happens(&mut self, probability: f64, now: Time) -> bool {
        probability > 0.0 && now < CALM_FROM && self.rng.uniform() < probability
    }

    /// Draws whether and where a process dies in this pass.
    pub(super) fn crash(&mut self, now: Time) -> Option<Crash> {
        if !self.happens(self.kill, now) {
            return None;
        }
        Some(match self.rng.below(4) {
            0 => Crash::BeforeSync,
            n => Crash::AfterOutputs(n - 1),
        })
    }

    /// Draws how long a dead process stays down.
    pub(super) fn downtime(&mut self) -> Span {
        Span::from_ms(20 + self.rng.below(400) as u64)
    }

    /// Draws how often a message arrives: 0, 1 or 2 times.
    pub(super) fn copies(&mut self, now: Time) -> usize {
        if self.happens(self.loss, now) {
            0
        } else if self.happens(self.double, now) {
            2
        } else {
            1
        }
    }
}

//! Faults drawn from a seed. They stop after a while, so that every dialogue can end: before that
//! nothing bad may happen, after that something good must.

use dialogue::Rng;
use service::{Span, Time};
use whichone_tests::Crash;

/// How often what goes wrong.
pub(crate) struct Faults {
    rng: Rng,
    kill_share: f64,
    loss_share: f64,
    double_share: f64,
}

/// When faults stop.
pub(crate) const CALM_FROM: Time = Time(20_000_000_000);

impl Faults {
    fn new(seed: u64, kill_share: f64, loss_share: f64, double_share: f64) -> Self {
        Self { rng: Rng::new(seed), kill_share, loss_share, double_share }
    }

    pub(crate) fn none() -> Self {
        Self::new(0, 0.0, 0.0, 0.0)
    }

    pub(crate) fn kills(seed: u64) -> Self {
        Self::new(seed, 0.01, 0.0, 0.0)
    }

    pub(crate) fn losses(seed: u64) -> Self {
        Self::new(seed, 0.0, 0.3, 0.1)
    }

    pub(crate) fn everything(seed: u64) -> Self {
        Self::new(seed, 0.008, 0.15, 0.1)
    }

    fn happens(&mut self, share: f64, now: Time) -> bool {
        share > 0.0 && now < CALM_FROM && self.rng.uniform() < share
    }

    /// Whether and where the process dies in this pass.
    pub(crate) fn crash(&mut self, now: Time) -> Option<Crash> {
        if !self.happens(self.kill_share, now) {
            return None;
        }
        Some(match self.rng.below(4) {
            0 => Crash::BeforeSync,
            n => Crash::AfterOutputs(n - 1),
        })
    }

    /// How long a dead process stays down.
    pub(crate) fn downtime(&mut self) -> Span {
        Span::from_ms(20 + self.rng.below(400) as u64)
    }

    /// How often a message arrives: 0, 1 or 2 times.
    pub(crate) fn copies(&mut self, now: Time) -> usize {
        if self.happens(self.loss_share, now) {
            0
        } else if self.happens(self.double_share, now) {
            2
        } else {
            1
        }
    }
}

//! Faults drawn from a seed. They stop after a while, so that every dialogue can end: before that
//! safety must hold, after that progress must be made.

use std::collections::BTreeMap;

use service::{Span, Time};
use vocabulary::Rng;

use super::Crash;

/// A kind of fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fault {
    /// A service dies before it has written its records.
    CrashBeforeWrite,
    /// A service dies while it writes them.
    CrashDuringSync,
    /// A service dies after some of its outputs.
    CrashAfterOutputs,
    /// The user's client dies.
    ClientKilled,
    /// The supervisor dies, and everything with it.
    GroupKilled,
    /// A service's disk is full for a while.
    DiskFull,
    /// A message is lost.
    Loss,
    /// A message arrives twice.
    Duplicate,
}

/// Probabilities of the faults: per pass for kills and full disks, per message for losses and
/// duplicates.
#[derive(Clone, Debug)]
pub struct Faults {
    rng: Rng,
    kill: f64,
    loss: f64,
    double: f64,
    client: f64,
    group: f64,
    full: f64,
    /// Faults so far.
    pub counts: BTreeMap<Fault, u64>,
}

/// When faults stop.
const CALM_FROM: Time = Time(20_000_000_000);

impl Faults {
    /// No faults.
    pub fn none() -> Self {
        Self {
            rng: Rng::new(0),
            kill: 0.0,
            loss: 0.0,
            double: 0.0,
            client: 0.0,
            group: 0.0,
            full: 0.0,
            counts: BTreeMap::new(),
        }
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
        Self { rng: Rng::new(seed), kill: 0.008, loss: 0.15, double: 0.1, ..Self::none() }
    }

    /// As [`Faults::everything`]; disks are full for a while, the client dies, and now and then the
    /// whole group.
    pub fn bad_day(seed: u64) -> Self {
        Self { client: 0.004, group: 0.0005, full: 0.002, ..Self::everything(seed) }
    }

    fn happens(&mut self, probability: f64, now: Time) -> bool {
        probability > 0.0 && now < CALM_FROM && self.rng.uniform() < probability
    }

    fn count(&mut self, fault: Fault) {
        *self.counts.entry(fault).or_default() += 1;
    }

    /// Random numbers for how exactly a fault happens.
    pub(super) fn rng(&mut self) -> &mut Rng {
        &mut self.rng
    }

    /// Draws whether and where a process dies in this pass.
    pub(super) fn crash(&mut self, now: Time) -> Option<Crash> {
        if !self.happens(self.kill, now) {
            return None;
        }
        let (crash, fault) = match self.rng.below(6) {
            0 => (Crash::BeforeWrite, Fault::CrashBeforeWrite),
            1 | 2 => (Crash::DuringSync, Fault::CrashDuringSync),
            n => (Crash::AfterOutputs(n - 3), Fault::CrashAfterOutputs),
        };
        self.count(fault);
        Some(crash)
    }

    /// Draws whether the client dies now.
    pub(super) fn client_dies(&mut self, now: Time) -> bool {
        let dies = self.happens(self.client, now);
        dies.then(|| self.count(Fault::ClientKilled)).is_some()
    }

    /// Draws whether the whole group dies now.
    pub(super) fn group_dies(&mut self, now: Time) -> bool {
        let dies = self.happens(self.group, now);
        dies.then(|| self.count(Fault::GroupKilled)).is_some()
    }

    /// Draws whether the disk is full now, and until when.
    pub(super) fn disk_full(&mut self, now: Time) -> Option<Time> {
        if !self.happens(self.full, now) {
            return None;
        }
        self.count(Fault::DiskFull);
        Some(now + Span::from_ms(50 + self.rng.below(3_000) as u64))
    }

    /// Draws how long a dead process stays down.
    pub(super) fn downtime(&mut self) -> Span {
        Span::from_ms(20 + self.rng.below(400) as u64)
    }

    /// Draws how long a person needs to start a client again.
    pub(super) fn client_downtime(&mut self) -> Span {
        Span::from_ms(100 + self.rng.below(4_000) as u64)
    }

    /// Draws how often a message arrives: 0, 1 or 2 times.
    pub(super) fn copies(&mut self, now: Time) -> usize {
        if self.happens(self.loss, now) {
            self.count(Fault::Loss);
            0
        } else if self.happens(self.double, now) {
            self.count(Fault::Duplicate);
            2
        } else {
            1
        }
    }
}

//! Counts of faults and times of recovery.

use crate::kind::Kind;
use std::collections::BTreeMap;
use std::fmt;
use std::time::Duration;

/// What was done and seen so far.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    pub(crate) dialogues: u64,
    /// Injected faults.
    pub(crate) faults: BTreeMap<Kind, u64>,
    /// Kills of each service.
    pub(crate) killed: BTreeMap<String, u64>,
    /// Motion stops that were confirmed during a fault.
    pub(crate) stops: u64,
    /// Time from the end of a fault until every service was ready.
    recoveries: BTreeMap<Kind, Vec<Duration>>,
}

impl Tally {
    /// Kills of services, of supervisors and of clients.
    pub(crate) fn kills(&self) -> u64 {
        let of = |kind| self.faults.get(&kind).copied().unwrap_or(0);
        self.killed.values().sum::<u64>() + of(Kind::SupervisorKill) + of(Kind::ClientKill)
    }

    pub(crate) fn killed(&mut self, service: &str) {
        *self.killed.entry(service.to_owned()).or_default() += 1;
    }

    pub(crate) fn recovered(&mut self, from: Kind, within: Duration) {
        self.recoveries.entry(from).or_default().push(within);
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} dialogues, {} kills {:?}, ", self.dialogues, self.kills(), self.killed)?;
        write!(f, "{} stops confirmed under faults; faults {:?}", self.stops, self.faults)?;
        for (kind, times) in &self.recoveries {
            let seconds = times.iter().map(Duration::as_secs_f64);
            let mean = seconds.clone().sum::<f64>() / times.len() as f64;
            let longest = seconds.fold(0.0, f64::max);
            write!(f, "\n  ready again after {kind:?}: mean {mean:.2} s, at most {longest:.2} s")?;
        }
        Ok(())
    }
}

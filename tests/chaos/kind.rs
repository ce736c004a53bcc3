//! Kinds of faults.

use clap::ValueEnum;
use vocabulary::Rng;

/// One kind of fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub(crate) enum Kind {
    /// A service is killed
    Kill,
    /// A service is stopped and continued, below its watchdog's period
    Pause,
    /// A service is restarted in order
    Restart,
    /// The user's client is killed and started again
    ClientKill,
    /// The supervisor is killed and the group started again
    SupervisorKill,
    /// The disk of the logs is full for a while
    FullLogs,
    /// The disk of the group is full for a while
    FullHome,
    /// /dev/shm is full for a while, and a service is killed meanwhile
    FullMemory,
    /// A service and its supervisor can open no further descriptor for a while
    Descriptors,
    /// Another user of the machine tries every file of the group
    HostileUser,
    /// A journal is removed, emptied or damaged while the group is down
    JournalLoss,
    /// The machine's clock is stepped forth and back: harms other programs of the machine
    ClockStep,
}

impl Kind {
    pub(crate) const ALL: [Self; 12] = [
        Self::Kill,
        Self::Pause,
        Self::Restart,
        Self::ClientKill,
        Self::SupervisorKill,
        Self::FullLogs,
        Self::FullHome,
        Self::FullMemory,
        Self::Descriptors,
        Self::HostileUser,
        Self::JournalLoss,
        Self::ClockStep,
    ];

    /// Relative frequency: kills above all.
    fn weight(self) -> f64 {
        match self {
            Self::Kill => 40.0,
            Self::Pause | Self::Restart | Self::ClientKill => 5.0,
            Self::FullLogs | Self::FullHome | Self::FullMemory => 2.0,
            Self::SupervisorKill | Self::Descriptors => 1.0,
            Self::ClockStep | Self::HostileUser | Self::JournalLoss => 1.0,
        }
    }

    /// True for a fault in the middle of a dialogue, false for one between two.
    pub(crate) fn is_during_dialogue(self) -> bool {
        !matches!(self, Self::HostileUser | Self::JournalLoss)
    }
}

/// Draws one of `kinds` by weight.
pub(crate) fn draw(kinds: &[Kind], rng: &mut Rng) -> Kind {
    let total: f64 = kinds.iter().map(|kind| kind.weight()).sum();
    let drawn = rng.index(kinds.iter().map(|kind| kind.weight() / total));
    kinds[drawn.unwrap_or(0)]
}

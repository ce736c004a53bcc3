//! Exits of services.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Exit code of a service with an invalid configuration (`EX_CONFIG`).
pub const EXIT_CONFIG: i32 = 78;

/// Exit code of a service with an invalid command line (`EX_USAGE`).
pub const EXIT_USAGE: i32 = 64;

/// Exit of one incarnation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ProcessExit {
    /// It exited with this code.
    Code(i32),
    /// This signal ended it.
    Signal(i32),
    /// It could not be started; a retry may succeed (e.g. no process slot).
    NotStarted,
    /// It could not be started; a retry cannot succeed (e.g. no such program).
    NotStartable,
}

impl ProcessExit {
    /// Returns true if a restart of the same command cannot help.
    pub fn is_permanent(self) -> bool {
        matches!(self, Self::Code(EXIT_CONFIG | EXIT_USAGE) | Self::NotStartable)
    }

    /// Returns true if it ended with exit code 0.
    pub fn is_clean(self) -> bool {
        self == Self::Code(0)
    }
}

impl fmt::Display for ProcessExit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Code(EXIT_CONFIG) => write!(f, "exit 78 (configuration or schema refused)"),
            Self::Code(EXIT_USAGE) => write!(f, "exit 64 (command line refused)"),
            Self::Code(code) => write!(f, "exit {code}"),
            Self::Signal(signal) => match signal_name(signal) {
                Some(name) => write!(f, "signal {name}"),
                None => write!(f, "signal {signal}"),
            },
            Self::NotStarted | Self::NotStartable => write!(f, "could not be started"),
        }
    }
}

/// Names of the signals that end services in practice; the same numbers on every Linux this runs on.
fn signal_name(signal: i32) -> Option<&'static str> {
    Some(match signal {
        1 => "HUP",
        2 => "INT",
        3 => "QUIT",
        4 => "ILL",
        6 => "ABRT",
        7 => "BUS",
        8 => "FPE",
        9 => "KILL",
        11 => "SEGV",
        13 => "PIPE",
        15 => "TERM",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_permanent_exits_prevent_a_restart() {
        for exit in [ProcessExit::Code(64), ProcessExit::Code(78), ProcessExit::NotStartable] {
            assert!(exit.is_permanent(), "{exit}");
        }
        for exit in [
            ProcessExit::Code(0),
            ProcessExit::Code(1),
            ProcessExit::Code(75),
            ProcessExit::Signal(9),
            ProcessExit::NotStarted,
        ] {
            assert!(!exit.is_permanent(), "{exit}");
        }
    }

    #[test]
    fn exits_are_displayed_with_signal_names() {
        assert_eq!(ProcessExit::Signal(9).to_string(), "signal KILL");
        assert_eq!(ProcessExit::Signal(40).to_string(), "signal 40");
        assert_eq!(ProcessExit::Code(3).to_string(), "exit 3");
    }
}

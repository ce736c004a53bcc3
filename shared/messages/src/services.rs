//! The services of a group.

use std::sync::{Mutex, PoisonError};

/// Name of the process that starts the services, reserved for it.
pub const SUPERVISOR: &str = "supervisor";

/// A service of a group. [`Service::BUILT_IN`] are in every group. They, the robot and the optional
/// parts have a program `whichone-NAME`; one from outside has a configured command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Service {
    /// Recognises and synthesises speech.
    Speech,
    /// Interprets utterances.
    Grounding,
    /// Tracks the belief and decides.
    Policy,
    /// Moves the arm.
    Arm,
    /// Serves the web page.
    Console,
    /// Records every topic; an observer, which the others do without.
    Recorder,
    /// Simulates a Baxter behind the robot's topics; optional.
    Robot,
    /// Any other service, by its name: an optional part, or one that does not ship with the others.
    Other(&'static str),
}

impl Service {
    /// Services of every group, in the order in which they are listed.
    pub const BUILT_IN: [Self; 6] =
        [Self::Speech, Self::Grounding, Self::Policy, Self::Arm, Self::Console, Self::Recorder];

    /// Services that a dialogue needs.
    pub const DIALOGUE: [Self; 4] = [Self::Speech, Self::Grounding, Self::Policy, Self::Arm];

    /// Services that keep a journal.
    pub const JOURNALED: [Self; 3] = [Self::Speech, Self::Policy, Self::Arm];

    /// Returns the name in configuration, journals and status.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Speech => "speech",
            Self::Grounding => "grounding",
            Self::Policy => "policy",
            Self::Arm => "arm",
            Self::Console => "console",
            Self::Recorder => "recorder",
            Self::Robot => "baxter",
            Self::Other(name) => name,
        }
    }

    /// Returns the service with this name. The names of those outside the core are
    /// kept for the life of the process, each once.
    pub fn named(name: &str) -> Self {
        static OTHERS: Mutex<Vec<&'static str>> = Mutex::new(Vec::new());
        if let Some(service) = Self::from_name(name) {
            return service;
        }
        let mut others = OTHERS.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = others.iter().find(|known| **known == name) {
            return Self::Other(known);
        }
        let kept: &'static str = name.to_owned().leak();
        others.push(kept);
        Self::Other(kept)
    }

    /// Returns the service with this name that has a variant of its own.
    pub fn from_name(name: &str) -> Option<Self> {
        let mut all = Self::BUILT_IN.into_iter().chain([Self::Robot]);
        all.find(|service| service.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn services_have_one_identity_for_each_name() {
        assert_eq!(Service::named("grounding"), Service::Grounding);
        let label = Service::named(&String::from("label"));
        assert_eq!((label, label.name()), (Service::Other("label"), "label"));
        assert_eq!(Service::named("label"), label);
        assert_eq!(Service::from_name("label"), None);
    }
}

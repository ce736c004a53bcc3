//! `link.toml`: the link to operators elsewhere.

use std::path::PathBuf;

use config::{Check, Section};
use diagnostics::Fields;

/// Name of the service.
pub(crate) const NAME: &str = "link";

/// The link to operators elsewhere.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Folder of the robot's keys, an absolute path; set if the group has a link.
    pub keys: Option<PathBuf>,
}

impl Section for Settings {
    const KEY: &'static [&'static str] = &["link"];
    const FILE: Option<&'static str> = Some(include_str!("../../../config/link.toml"));

    fn read(f: &mut Fields<'_>) -> Self {
        Self { keys: f.absolute("keys") }
    }

    fn check(&self, others: &mut Check<'_>) {
        let mut services = others.group.services.iter();
        if self.keys.is_none() && services.any(|service| service.name == NAME) {
            let help = "set it to the folder robots/NAME that `whichone link init` made";
            others.problem(&["link", "keys"], "missing: a group with a link has keys", help);
        }
    }
}

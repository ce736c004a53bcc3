//! `link.toml`: the link to operators elsewhere.

use std::path::PathBuf;

use diagnostics::{Fields, Report, Table};
use messages::Service;

use crate::group::Group;

/// The link to operators elsewhere.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Link {
    /// Folder of the robot's keys, an absolute path; set where the group has a link.
    pub keys: Option<PathBuf>,
}

/// Reads the section.
pub(crate) fn read(f: &mut Fields<'_>) -> Link {
    Link { keys: f.absolute("keys") }
}

/// Reports a link without keys.
pub(crate) fn check(link: &Link, group: &Group, tree: &Table, report: &mut Report) {
    let has_link = group.services.iter().any(|service| service.name == Service::Link.name());
    if !has_link || link.keys.is_some() {
        return;
    }
    let path = ["link", "keys"];
    let what = "missing: a group with a link has keys";
    let help = "set it to the folder robots/NAME that `whichone link init` made";
    report.add(tree.source_of(&path).diagnostic(&path.map(str::to_owned), what, help));
}

//! Planners by name.

use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::Planner;
use crate::planners::ALL;

pub use crate::planners::Entry;

/// The planner's name is unknown.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no planner \"{name}\"; the planners are {}", known.join(", "))]
pub struct UnknownPlanner {
    /// The requested name.
    pub name: String,
    /// The valid names.
    pub known: Vec<&'static str>,
}

/// Planners of the program that is built on this crate.
static ADDED: Mutex<Vec<Entry>> = Mutex::new(Vec::new());

fn added() -> MutexGuard<'static, Vec<Entry>> {
    ADDED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// There is a planner of that name already.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is a planner \"{0}\" already; help: choose another name")]
pub struct NameTaken(pub &'static str);

/// Adds a planner of the program that is built on this crate, which calls it first of all.
///
/// # Errors
/// Its name is taken.
pub fn add(entry: Entry) -> Result<(), NameTaken> {
    if known().contains(&entry.name) {
        return Err(NameTaken(entry.name));
    }
    added().push(entry);
    Ok(())
}

/// Returns the names of all planners, those that were added last.
pub fn known() -> Vec<&'static str> {
    names().into_iter().chain(added().iter().map(|entry| entry.name)).collect()
}

/// Makes the planner of the given name.
///
/// # Errors
/// If there is none.
pub fn planner(name: &str) -> Result<Box<dyn Planner + Send>, UnknownPlanner> {
    let found = ALL.iter().copied().chain(added().iter().copied()).find(|it| it.name == name);
    let unknown = || UnknownPlanner { name: name.to_owned(), known: known() };
    found.map(|entry| (entry.make)()).ok_or_else(unknown)
}

/// Returns every planner of this crate, the default first.
pub fn entries() -> [Entry; ALL.len()] {
    ALL
}

/// Returns the names of all planners of this crate, the default first.
pub fn names() -> [&'static str; ALL.len()] {
    ALL.map(|entry| entry.name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registry_finds_every_planner_by_its_own_name() {
        for name in names() {
            assert_eq!(planner(name).unwrap().name(), name);
        }
        assert_eq!(names()[0], "lookahead", "the default comes first");
        assert_eq!(
            names(),
            vocabulary::PLANNERS,
            "names of entries, and those of the list in vocabulary"
        );
    }

    #[test]
    fn registry_names_the_known_planners_in_its_error() {
        let Err(error) = planner("oracle") else { panic!("there is no oracle") };
        assert_eq!(error.known, names());
        assert!(error.to_string().contains("oracle") && error.to_string().contains("entropy"));
    }

    #[test]
    fn registry_and_docs_list_the_same_planners() {
        let page = include_str!("../../../docs/planners.md");
        for Entry { name, about, .. } in entries() {
            let row = format!("| `{name}` | {about} |");
            assert!(page.contains(&row), "expected in docs/planners.md: {row}");
        }
    }
}

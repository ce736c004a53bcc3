//! Planners by name.

use crate::Planner;
use crate::planners::ALL;

pub use crate::planners::Entry;

/// No planner has that name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no planner \"{name}\"; the planners are {}", known.join(", "))]
pub struct UnknownPlanner {
    /// The requested name.
    pub name: String,
    /// The valid names.
    pub known: Vec<&'static str>,
}

/// Makes the planner of that name.
///
/// # Errors
/// If there is none.
pub fn planner(name: &str) -> Result<Box<dyn Planner + Send>, UnknownPlanner> {
    let found = ALL.iter().find(|entry| entry.name == name);
    let unknown = || UnknownPlanner { name: name.to_owned(), known: names().to_vec() };
    found.map(|entry| (entry.make)()).ok_or_else(unknown)
}

/// Returns every planner, the default first.
pub fn entries() -> [Entry; ALL.len()] {
    ALL
}

/// Returns the names of all planners, the default first.
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

//! Planners by name.

use crate::Planner;
use crate::planners::{
    AlwaysAsk, Entropy, InformationSeeking, Lookahead, NeverAsk, NoAttribute, Optimal,
    SparseSampling,
};

/// Makes a planner with its default settings.
type Make = fn() -> Box<dyn Planner + Send>;

/// Every planner, the default first. A new planner is one file in `planners` and one line here.
const PLANNERS: [(&str, Make); 8] = [
    ("lookahead", || Box::new(Lookahead::default())),
    ("optimal", || Box::new(Optimal::default())),
    ("information-seeking", || Box::new(InformationSeeking)),
    ("entropy", || Box::new(Entropy)),
    ("sparse-sampling", || Box::new(SparseSampling::default())),
    ("no-attribute", || Box::new(NoAttribute::default())),
    ("always-ask", || Box::new(AlwaysAsk)),
    ("never-ask", || Box::new(NeverAsk)),
];

/// No planner has that name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no planner \"{name}\"; the planners are {}", known.join(", "))]
pub struct UnknownPlanner {
    /// The name that was asked for.
    pub name: String,
    /// The names that there are.
    pub known: Vec<&'static str>,
}

/// The planner of that name.
///
/// # Errors
/// If there is none.
pub fn planner(name: &str) -> Result<Box<dyn Planner + Send>, UnknownPlanner> {
    let found = PLANNERS.iter().find(|(known, _)| *known == name);
    let unknown = || UnknownPlanner { name: name.to_owned(), known: names().to_vec() };
    found.map(|(_, make)| make()).ok_or_else(unknown)
}

/// The names of all planners, the default first.
pub fn names() -> [&'static str; PLANNERS.len()] {
    PLANNERS.map(|(name, _)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_planner_is_found_under_its_own_name() {
        for name in names() {
            assert_eq!(planner(name).unwrap().name(), name);
        }
        assert_eq!(names()[0], "lookahead", "the default comes first");
    }

    #[test]
    fn an_unknown_name_is_told_the_known_ones() {
        let Err(error) = planner("oracle") else { panic!("there is no oracle") };
        assert_eq!(error.known, names());
        assert!(error.to_string().contains("oracle") && error.to_string().contains("entropy"));
    }
}

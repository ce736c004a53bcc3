//! Names that are parts of keys, addresses and files.

use serde::{Deserialize, Serialize};

/// Name of a robot or a person: 1 to 32 of `a–z 0–9 -`, beginning with a letter or digit.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Name(String);

/// Invalid name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{0:?} is not a name; help: use 1 to 32 of a-z, 0-9 and -, beginning with a letter or digit"
)]
pub struct NameError(String);

impl Name {
    /// Checks a name.
    ///
    /// # Errors
    /// The name is invalid.
    pub fn new(name: &str) -> Result<Self, NameError> {
        let allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        let fits = (1..=32).contains(&name.len()) && !name.starts_with('-');
        match fits && name.chars().all(allowed) {
            true => Ok(Self(name.to_owned())),
            false => Err(NameError(name.to_owned())),
        }
    }

    /// The name.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl std::fmt::Display for Name {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl std::str::FromStr for Name {
    type Err = NameError;

    fn from_str(name: &str) -> Result<Self, NameError> {
        Self::new(name)
    }
}

impl TryFrom<String> for Name {
    type Error = NameError;

    fn try_from(name: String) -> Result<Self, NameError> {
        Self::new(&name)
    }
}

impl From<Name> for String {
    fn from(name: Name) -> Self {
        name.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cannot_reach_beyond_their_robot() {
        assert!(Name::new("r1").is_ok());
        for bad in ["", "-a", "R1", "a/b", "*", "**", "a b", "$a", "a:b", &"x".repeat(33)] {
            assert_eq!(Name::new(bad), Err(NameError(bad.to_owned())));
        }
    }
}

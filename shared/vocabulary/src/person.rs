//! Names by which users introduce themselves.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Longest name, bytes.
pub const PERSON_BYTES_MAX: usize = 64;

/// Name of a person who wants nothing to be learned.
const GUEST: &str = "guest";

/// The name under which a person speaks: printable, without spaces around it, of at most
/// [`PERSON_BYTES_MAX`] bytes. Empty for an unnamed person, about whom nothing is learned.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct PersonId(String);

/// Settings of learning about users who give their name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Acquaintance {
    /// Whether anything is.
    pub learns: bool,
    /// Deliveries to a person after which the prior over objects follows that person's deliveries.
    pub prior_from: u64,
}

/// The shipped settings.
impl Default for Acquaintance {
    fn default() -> Self {
        Self { learns: true, prior_from: 5 }
    }
}

/// A text that is not the name of a person.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotAPerson {
    /// The name is too long: its length in bytes.
    TooLong(usize),
    /// The name has a character that is not printed, or that changes how others are.
    NotPrintable(char),
}

impl fmt::Display for NotAPerson {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLong(bytes) => write!(
                f,
                "expected a name of at most {PERSON_BYTES_MAX} bytes, found {bytes}; help: use a \
                 shorter one"
            ),
            Self::NotPrintable(odd) => {
                write!(f, "expected a printable name, found {odd:?} in it; help: leave it out")
            }
        }
    }
}

impl std::error::Error for NotAPerson {}

impl PersonId {
    /// Returns the person of that name, without the spaces around it. "guest" is unnamed.
    ///
    /// # Errors
    /// A text that is too long or not printable.
    pub fn new(name: &str) -> Result<Self, NotAPerson> {
        let name = name.trim();
        if name.len() > PERSON_BYTES_MAX {
            return Err(NotAPerson::TooLong(name.len()));
        }
        if let Some(odd) = name.chars().find(|c| is_invisible(*c)) {
            return Err(NotAPerson::NotPrintable(odd));
        }
        let is_guest = name.eq_ignore_ascii_case(GUEST);
        Ok(Self(if is_guest { String::new() } else { name.to_owned() }))
    }

    /// Returns whether the person is unnamed.
    pub fn is_nobody(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the name; empty for an unnamed person.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

/// Returns whether a character is a control character, or one of those that hide or reorder others.
fn is_invisible(c: char) -> bool {
    let hides = matches!(
        c,
        '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}'
    );
    c.is_control() || hides
}

impl fmt::Display for PersonId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_printable_and_short_and_a_guest_is_nobody() {
        let named = |text: &str| PersonId::new(text);
        assert_eq!(named(" Ann Lee ").unwrap().as_str(), "Ann Lee");
        for nobody in ["", "  ", "guest", "Guest "] {
            assert!(named(nobody).unwrap().is_nobody(), "{nobody:?}");
        }
        assert_eq!(named("a\nb"), Err(NotAPerson::NotPrintable('\n')));
        assert!(named(&"ä".repeat(32)).is_ok());
        assert_eq!(named(&"ä".repeat(33)), Err(NotAPerson::TooLong(66)));
    }
}

//! One diagnostic, a list of them, and their collection.

use std::fmt;

/// An error in a text file.
///
/// Displays as `FILE:LINE:COLUMN: KEY: WHAT; help: HELP`, without the parts that are unknown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Path of the file, or another name of the source.
    pub file: String,
    /// Line, from 1, if known.
    pub line: Option<u32>,
    /// Column, from 1, in characters, if known; only with a line.
    pub column: Option<u32>,
    /// Dotted key or element, e.g. `objects[2].attributes.color`; empty for the file as a whole.
    pub key: String,
    /// The problem: expected and found.
    pub what: String,
    /// The fix; may be empty.
    pub help: String,
}

impl Diagnostic {
    /// A diagnostic without a line.
    pub fn new(
        file: impl Into<String>,
        key: impl Into<String>,
        what: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        Self {
            file: file.into(),
            line: None,
            column: None,
            key: key.into(),
            what: what.into(),
            help: help.into(),
        }
    }

    /// Returns the diagnostic with its line, from 1.
    pub fn at(self, line: Option<u32>) -> Self {
        Self { line, ..self }
    }

    /// Returns the diagnostic with its column, from 1, in characters.
    pub fn at_column(self, column: Option<u32>) -> Self {
        Self { column, ..self }
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
            if let Some(column) = self.column {
                write!(f, ":{column}")?;
            }
        }
        if !self.key.is_empty() {
            write!(f, ": {}", self.key)?;
        }
        write!(f, ": {}", self.what)?;
        if !self.help.is_empty() {
            write!(f, "; help: {}", self.help)?;
        }
        Ok(())
    }
}

/// An error made of one or more diagnostics, in the order found. Displays one per line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostics(Vec<Diagnostic>);

impl Diagnostics {
    /// The diagnostics one by one.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.0.iter()
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (n, diagnostic) in self.0.iter().enumerate() {
            write!(f, "{}{diagnostic}", if n > 0 { "\n" } else { "" })?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostics {}

impl From<Diagnostic> for Diagnostics {
    fn from(diagnostic: Diagnostic) -> Self {
        Self(vec![diagnostic])
    }
}

/// Collected diagnostics.
#[derive(Debug, Default)]
pub struct Report(Vec<Diagnostic>);

impl Report {
    /// Adds a diagnostic.
    pub fn add(&mut self, diagnostic: Diagnostic) {
        self.0.push(diagnostic);
    }

    /// Adds every diagnostic of an error.
    pub fn extend(&mut self, diagnostics: Diagnostics) {
        self.0.extend(diagnostics.0);
    }

    /// Number of diagnostics so far.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// The diagnostics so far, in the order found.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.0.iter()
    }

    /// Sorts the diagnostics by line.
    pub fn sort_by_line(&mut self) {
        self.0.sort_by_key(|diagnostic| diagnostic.line);
    }

    /// Returns `value` without diagnostics, and these otherwise.
    ///
    /// # Errors
    /// Every diagnostic.
    ///
    /// # Panics
    /// With neither a value nor a diagnostic: a value that is withheld needs a reason.
    pub fn verdict<T>(self, value: Option<T>) -> Result<T, Diagnostics> {
        match value {
            Some(value) if self.0.is_empty() => Ok(value),
            _ => {
                assert!(!self.0.is_empty(), "a value is missing without a diagnostic");
                Err(Diagnostics(self.0))
            }
        }
    }
}

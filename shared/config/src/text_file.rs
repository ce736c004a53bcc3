//! Text files that settings name.

/// A text file and its name in diagnostics.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextFile {
    /// Path, or a description of a built-in file.
    pub label: String,
    /// Its text.
    pub text: String,
}
